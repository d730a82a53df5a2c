//! The table itself: every row against every column, and what must come of it. There is no cell without an entry.

use crate::seams::judge::Verdict;
use crate::setup::body::Protocol;
use Cell::{By, CannotBe, Tried};
use Verdict::{
    Ends, GoesOn, Held, HeldAtTheEnd, Insists, NothingMore, NothingWrong, Rests, Settled, Still,
};

/// What moves the hand or writes to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Row {
    Slider,
    Pose,
    Series,
    Trial,
    Follow,
    FollowDds,
    Leading,
    Share,
    Stdio,
    Gamepad,
    Exhibition,
    Params,
    Calibration,
}

/// What happens meanwhile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Column {
    Signal,
    Killed,
    Panic,
    Frozen,
    DisplayLost,
    Asleep,
    LinkLost,
    Replugged,
    PowerCycled,
    FeedbackFrozen,
    OddReplies,
    Disobeys,
    SecondMaster,
    SecondHandscope,
    FaultOrHeat,
    ReaderGone,
    OutputUnread,
    HolderKilled,
    HolderFrozen,
    GatewayRefuses,
    StopThenLost,
    RepliesSlow,
    RestsShort,
    Busy,
    NoDescriptors,
    JointFrozen,
    OddStop,
    GrantedAgain,
}

impl Row {
    pub(super) const ALL: [Self; 13] = [
        Self::Slider,
        Self::Pose,
        Self::Series,
        Self::Trial,
        Self::Follow,
        Self::FollowDds,
        Self::Leading,
        Self::Share,
        Self::Stdio,
        Self::Gamepad,
        Self::Exhibition,
        Self::Params,
        Self::Calibration,
    ];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Slider => "slider in the window",
            Self::Pose => "pose and sequence",
            Self::Series => "series, hold and scale in the window",
            Self::Trial => "trial, tune, grip, hold, scale",
            Self::Follow => "follow UDP and TCP",
            Self::FollowDds => "follow DDS",
            Self::Leading => "another hand leading",
            Self::Share => "share --writers",
            Self::Stdio => "share --stdio",
            Self::Gamepad => "gamepad in the window",
            Self::Exhibition => "exhibition",
            Self::Params => "params",
            Self::Calibration => "calibration",
        }
    }
}

impl Column {
    pub(super) const ALL: [Self; 28] = [
        Self::Signal,
        Self::Killed,
        Self::Panic,
        Self::Frozen,
        Self::DisplayLost,
        Self::Asleep,
        Self::LinkLost,
        Self::Replugged,
        Self::PowerCycled,
        Self::FeedbackFrozen,
        Self::OddReplies,
        Self::Disobeys,
        Self::SecondMaster,
        Self::SecondHandscope,
        Self::FaultOrHeat,
        Self::ReaderGone,
        Self::OutputUnread,
        Self::HolderKilled,
        Self::HolderFrozen,
        Self::GatewayRefuses,
        Self::StopThenLost,
        Self::RepliesSlow,
        Self::RestsShort,
        Self::Busy,
        Self::NoDescriptors,
        Self::JointFrozen,
        Self::OddStop,
        Self::GrantedAgain,
    ];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Signal => "ended by a signal",
            Self::Killed => "killed",
            Self::Panic => "panic",
            Self::Frozen => "window frozen",
            Self::DisplayLost => "display lost",
            Self::Asleep => "asleep 10 s",
            Self::LinkLost => "link lost, back",
            Self::Replugged => "adapter replugged",
            Self::PowerCycled => "hand power-cycled",
            Self::FeedbackFrozen => "feedback frozen",
            Self::OddReplies => "odd replies",
            Self::Disobeys => "hand disobeys",
            Self::SecondMaster => "second master",
            Self::SecondHandscope => "second Handscope",
            Self::FaultOrHeat => "fault 8, 70 °C",
            Self::ReaderGone => "reader of stdout gone",
            Self::OutputUnread => "output not read, SIGTERM",
            Self::HolderKilled => "holder killed, then killed",
            Self::HolderFrozen => "holder frozen, killed",
            Self::GatewayRefuses => "gateway refuses",
            Self::StopThenLost => "stop, then link lost",
            Self::RepliesSlow => "slow replies",
            Self::RestsShort => "hand rests short",
            Self::Busy => "computer busy",
            Self::NoDescriptors => "no descriptor left",
            Self::JointFrozen => "one joint's feedback frozen",
            Self::OddStop => "stop in an odd spelling",
            Self::GrantedAgain => "control taken and given twice",
        }
    }
}

/// What is to be done about one cell.
#[derive(Debug, Clone, Copy)]
pub(super) enum Cell {
    /// It is tried, and this must come of it, with these words told, divided by bars.
    Tried(Verdict, &'static str),
    /// Another test tries it: this one.
    By(&'static str),
    /// It cannot be, or cannot be tried: why.
    CannotBe(&'static str),
}

/// As [`cell`], where the wire matters: the system lets one program open a serial port, and any number a socket.
pub(super) const fn cell_on(row: Row, column: Column, protocol: Protocol) -> Cell {
    let is_port = !matches!(protocol, Protocol::Tcp | Protocol::Can);
    let is_in_the_window = match row {
        Row::Slider
        | Row::Pose
        | Row::Series
        | Row::Leading
        | Row::Gamepad
        | Row::Exhibition
        | Row::Calibration => true,
        Row::Trial | Row::Follow | Row::FollowDds | Row::Share | Row::Stdio | Row::Params => false,
    };
    match (column, row) {
        // The second master of this table writes without a wire, as one on another connection does. On a bus its frames are heard.
        (
            Column::SecondMaster,
            Row::Trial | Row::Follow | Row::FollowDds | Row::Share | Row::Stdio,
        ) if !matches!(protocol, Protocol::Tcp) => {
            CannotBe("the frames of a second master are heard on a bus: tried with the link")
        }
        (Column::GatewayRefuses, _) if !matches!(protocol, Protocol::Tcp | Protocol::Rtu) => {
            CannotBe("only Modbus has exceptions")
        }
        (Column::RepliesSlow, _) if !matches!(protocol, Protocol::Tcp) => {
            CannotBe("late replies carry no number there: that is a lost link, which is tried")
        }
        (Column::SecondHandscope, _) if is_port && is_in_the_window => {
            CannotBe("one program opens a serial port: tried with the commands")
        }
        (Column::SecondHandscope, Row::Params) if is_port => Tried(Settled, "in use"),
        // A sender may fall silent on a machine with other work, and then the hand is held.
        (Column::SecondHandscope, Row::Follow | Row::FollowDds) if is_port => {
            Tried(NothingWrong, "in use")
        }
        (Column::SecondHandscope, _) if is_port => Tried(GoesOn, "in use"),
        (_, _) => cell(row, column),
    }
}

/// What must come of one thing that moves a hand when another happens.
pub(super) const fn cell(row: Row, column: Column) -> Cell {
    match row {
        Row::Slider | Row::Pose => told_by_the_window(column),
        Row::Series => series(column),
        Row::Leading => leading(column),
        Row::Gamepad => gamepad(column),
        Row::Exhibition => exhibition(column),
        Row::Calibration => calibration(column),
        Row::Trial => trial(column),
        Row::FollowDds if matches!(column, Column::OddStop) => {
            By("speeds_of_zero_are_a_stop_whatever_else_is_in_the_message")
        }
        Row::Follow | Row::FollowDds => follow(column),
        Row::Share => share(column),
        Row::Stdio => stdio(column),
        Row::Params => params(column),
    }
}

const NO_STDOUT: Cell = CannotBe("a window prints nothing");
const HELD_BY_COMMANDS: Cell =
    CannotBe("these windows are no processes; its link starts the same holder as a command's");
const VIRTUAL: Cell = CannotBe(
    "its time is virtual and does not stall: the rule for stalls is the link's, as in commands",
);
const NO_PROCESS: Cell = CannotBe("it is no process of its own here; its link is a command's");
const ONE_SPELLING: Cell = CannotBe("a button or a signal stops it, which has one spelling");
const NOT_GRANTED: Cell = CannotBe("it begins with control, and nobody grants it again");
const NO_WINDOW: Cell = CannotBe("a command has no window");
const LINK_IS_LOST: &str = "LinkLost";
const NO_PANIC: Cell =
    CannotBe("nothing from outside makes it panic; the window's hook is the same");
const WINDOW_PANICS: Cell = By("a_panic_in_the_window_holds_the_hand_before_it_ends");
const WINDOW_ENDS: Cell = By("a_hand_is_held_whatever_ends_the_window");

/// A hand that was told where to go, once.
const fn told_by_the_window(column: Column) -> Cell {
    match column {
        Column::Signal | Column::Killed | Column::DisplayLost => WINDOW_ENDS,
        Column::Panic => WINDOW_PANICS,
        Column::Frozen => Tried(GoesOn, ""),
        Column::Asleep => Tried(NothingMore(0), "Disarmed"),
        Column::LinkLost | Column::Replugged => Tried(NothingMore(0), LINK_IS_LOST),
        Column::PowerCycled => Tried(Rests, LINK_IS_LOST),
        Column::FeedbackFrozen => Tried(Held(1500), ""),
        Column::OddReplies => Tried(NothingWrong, ""),
        Column::Disobeys => Tried(Insists, "Hold"),
        Column::SecondMaster => Tried(NothingMore(3000), "ontroller"),
        Column::SecondHandscope => Tried(NothingMore(6000), ""),
        Column::FaultOrHeat => Tried(Held(1000), "Fault"),
        Column::ReaderGone | Column::OutputUnread => NO_STDOUT,
        Column::HolderKilled | Column::HolderFrozen => HELD_BY_COMMANDS,
        Column::GatewayRefuses => Tried(NothingMore(0), LINK_IS_LOST),
        Column::StopThenLost => Tried(Held(4000), ""),
        Column::RepliesSlow | Column::RestsShort => Tried(Held(4500), ""),
        Column::Busy => VIRTUAL,
        Column::NoDescriptors => NO_PROCESS,
        Column::JointFrozen => Tried(Held(1500), ""),
        Column::OddStop => ONE_SPELLING,
        Column::GrantedAgain => NOT_GRANTED,
    }
}

const fn series(column: Column) -> Cell {
    match column {
        Column::Frozen => Tried(GoesOn, ""),
        Column::Signal
        | Column::Killed
        | Column::Panic
        | Column::DisplayLost
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::Disobeys
        | Column::SecondMaster
        | Column::SecondHandscope
        | Column::FaultOrHeat
        | Column::ReaderGone
        | Column::OutputUnread
        | Column::HolderKilled
        | Column::HolderFrozen
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::Busy
        | Column::NoDescriptors
        | Column::JointFrozen
        | Column::OddStop
        | Column::GrantedAgain => told_by_the_window(column),
    }
}

/// Another hand leads this one: in the window, or by `follow --mirror`.
const fn leading(column: Column) -> Cell {
    match column {
        Column::Signal => Tried(HeldAtTheEnd(1000), ""),
        Column::Killed => Tried(Held(1500), ""),
        Column::Panic => WINDOW_PANICS,
        Column::DisplayLost => WINDOW_ENDS,
        Column::Frozen => Tried(GoesOn, ""),
        Column::ReaderGone => Tried(HeldAtTheEnd(3000), ""),
        Column::OutputUnread => Tried(HeldAtTheEnd(4000), ""),
        Column::HolderKilled | Column::HolderFrozen => Tried(Held(3000), ""),
        Column::Busy => Tried(Held(6000), ""),
        Column::NoDescriptors => Tried(HeldAtTheEnd(4000), ""),
        // What leads is never far ahead: the hand comes to rest there by itself.
        Column::Disobeys => Tried(Insists, ""),
        Column::SecondHandscope
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::SecondMaster
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::JointFrozen
        | Column::OddStop
        | Column::FaultOrHeat => told_by_the_window(column),
        Column::GrantedAgain => Tried(Held(2500), ""),
    }
}

/// A gamepad of the window leads it.
const fn gamepad(column: Column) -> Cell {
    match column {
        Column::OddStop => Tried(Held(1000), ""),
        Column::Frozen
        | Column::Signal
        | Column::Killed
        | Column::Panic
        | Column::DisplayLost
        | Column::ReaderGone
        | Column::OutputUnread
        | Column::HolderKilled
        | Column::HolderFrozen
        | Column::Busy
        | Column::NoDescriptors => told_by_the_window(column),
        Column::Disobeys
        | Column::GrantedAgain
        | Column::SecondHandscope
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::JointFrozen
        | Column::OddReplies
        | Column::SecondMaster
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::FaultOrHeat => leading(column),
    }
}

const fn exhibition(column: Column) -> Cell {
    match column {
        Column::Frozen => Tried(Held(2500), ""),
        Column::FaultOrHeat => Tried(Held(1000), ""),
        Column::Signal
        | Column::Killed
        | Column::Panic
        | Column::DisplayLost
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::Disobeys
        | Column::SecondMaster
        | Column::SecondHandscope
        | Column::ReaderGone
        | Column::OutputUnread
        | Column::HolderKilled
        | Column::HolderFrozen
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::Busy
        | Column::NoDescriptors
        | Column::JointFrozen
        | Column::OddStop
        | Column::GrantedAgain => told_by_the_window(column),
    }
}

/// The hand does it alone; no joint moves.
const fn calibration(column: Column) -> Cell {
    match column {
        Column::RestsShort => CannotBe("no joint is told where to go"),
        Column::Signal | Column::Killed | Column::Panic | Column::DisplayLost => {
            CannotBe("the hand calibrates alone: nothing was told that could be taken back")
        }
        Column::SecondMaster => Tried(NothingMore(0), ""),
        Column::SecondHandscope => Tried(NothingMore(5000), ""),
        Column::ReaderGone | Column::OutputUnread | Column::HolderKilled | Column::HolderFrozen => {
            told_by_the_window(column)
        }
        Column::Frozen
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::JointFrozen
        | Column::FaultOrHeat => Tried(Still, ""),
        Column::OddStop => ONE_SPELLING,
        Column::GrantedAgain => NOT_GRANTED,
        Column::Busy => VIRTUAL,
        Column::NoDescriptors => NO_PROCESS,
        Column::Disobeys => By("a_stop_passes_while_the_hand_calibrates"),
    }
}

const fn trial(column: Column) -> Cell {
    match column {
        Column::Signal => Tried(HeldAtTheEnd(1000), "feedback shows rest"),
        Column::Killed => Tried(Held(1500), ""),
        Column::Panic => NO_PANIC,
        Column::Frozen | Column::DisplayLost => NO_WINDOW,
        Column::Asleep => Tried(NothingMore(500), ""),
        Column::LinkLost | Column::Replugged => Tried(NothingMore(0), "feedback shows rest"),
        Column::PowerCycled => Tried(Rests, "the link was lost"),
        Column::FeedbackFrozen => Tried(Held(1500), ""),
        Column::OddReplies => Tried(NothingWrong, ""),
        Column::Disobeys => Tried(Insists, "NOT CONFIRMED"),
        Column::SecondMaster => Tried(NothingMore(3000), "another controller wrote"),
        Column::SecondHandscope => Tried(NothingMore(6000), ""),
        Column::FaultOrHeat => Tried(HeldAtTheEnd(1000), "fault"),
        Column::ReaderGone => Tried(Ends, ""),
        Column::OutputUnread => Tried(HeldAtTheEnd(4000), ""),
        Column::HolderKilled | Column::HolderFrozen => Tried(Held(3000), ""),
        Column::GatewayRefuses => Tried(NothingMore(0), "feedback shows rest"),
        Column::StopThenLost => Tried(HeldAtTheEnd(4000), ""),
        Column::RepliesSlow | Column::RestsShort => Tried(HeldAtTheEnd(4500), ""),
        Column::Busy => Tried(HeldAtTheEnd(6000), ""),
        Column::NoDescriptors => Tried(HeldAtTheEnd(4000), ""),
        Column::JointFrozen => Tried(Held(1500), ""),
        Column::OddStop => ONE_SPELLING,
        Column::GrantedAgain => NOT_GRANTED,
    }
}

const fn follow(column: Column) -> Cell {
    match column {
        Column::Signal => Tried(HeldAtTheEnd(1000), ""),
        Column::Killed => Tried(Held(1500), ""),
        Column::Panic => NO_PANIC,
        Column::Frozen | Column::DisplayLost => NO_WINDOW,
        Column::Asleep => Tried(NothingMore(500), ""),
        Column::LinkLost | Column::Replugged => Tried(NothingMore(0), "lost"),
        Column::PowerCycled => Tried(Rests, "lost"),
        Column::FeedbackFrozen => Tried(Held(1500), ""),
        Column::OddReplies => Tried(NothingWrong, ""),
        Column::Disobeys => Tried(Insists, ""),
        Column::SecondMaster => Tried(NothingMore(3000), "ontroller"),
        Column::SecondHandscope => Tried(NothingMore(6000), ""),
        Column::FaultOrHeat => Tried(Held(1000), "fault"),
        Column::ReaderGone => Tried(HeldAtTheEnd(3000), ""),
        Column::OutputUnread => Tried(HeldAtTheEnd(4000), ""),
        Column::HolderKilled | Column::HolderFrozen => Tried(Held(3000), ""),
        Column::GatewayRefuses => Tried(NothingMore(0), "lost"),
        Column::StopThenLost => Tried(HeldAtTheEnd(4000), ""),
        Column::RepliesSlow | Column::RestsShort => Tried(HeldAtTheEnd(4500), ""),
        Column::Busy => Tried(HeldAtTheEnd(6000), ""),
        Column::NoDescriptors => Tried(HeldAtTheEnd(4000), ""),
        Column::JointFrozen => Tried(Held(1500), ""),
        Column::OddStop => Tried(Held(1000), ""),
        Column::GrantedAgain => NOT_GRANTED,
    }
}

/// A client of the gateway moves the hand.
const fn share(column: Column) -> Cell {
    match column {
        Column::Signal
        | Column::Panic
        | Column::Killed
        | Column::Frozen
        | Column::DisplayLost
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::SecondHandscope
        | Column::Asleep
        | Column::OutputUnread
        | Column::HolderKilled
        | Column::HolderFrozen
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::Busy
        | Column::NoDescriptors
        | Column::JointFrozen
        | Column::GrantedAgain
        | Column::Disobeys => follow(column),
        Column::OddStop => By("a_stop_is_obeyed_whatever_is_odd_about_its_request"),
        Column::LinkLost | Column::Replugged => Tried(NothingMore(0), "lost"),
        Column::PowerCycled => Tried(Rests, "lost"),
        Column::SecondMaster => Tried(NothingMore(3000), "ontroller"),
        Column::FaultOrHeat => Tried(Held(1000), "fault"),
        Column::ReaderGone => CannotBe("it prints nothing after its first line"),
    }
}

/// A program moves the hand by lines of JSON.
const fn stdio(column: Column) -> Cell {
    match column {
        Column::ReaderGone => Tried(HeldAtTheEnd(3000), ""),
        Column::OddStop => Tried(Held(1000), ""),
        Column::GrantedAgain => Tried(Held(2500), ""),
        Column::FaultOrHeat => Tried(Held(1000), "fault"),
        // A process that stood still did not sleep: it holds the hand, and follows again what is sent then.
        Column::Asleep => Tried(NothingWrong, ""),
        Column::Signal
        | Column::Panic
        | Column::Killed
        | Column::Frozen
        | Column::DisplayLost
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::SecondHandscope
        | Column::Disobeys
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::SecondMaster
        | Column::OutputUnread
        | Column::HolderKilled
        | Column::HolderFrozen
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::RestsShort
        | Column::Busy
        | Column::NoDescriptors
        | Column::JointFrozen => share(column),
    }
}

/// Defaults are written one after the other; nothing moves.
const fn params(column: Column) -> Cell {
    match column {
        Column::RestsShort => CannotBe("no joint is told where to go"),
        Column::Frozen | Column::DisplayLost => NO_WINDOW,
        Column::SecondMaster => CannotBe("another controller moves joints, and nothing here does"),
        Column::Panic => NO_PANIC,
        Column::HolderKilled | Column::HolderFrozen => {
            CannotBe("nothing moves, so that no process watches over it")
        }
        Column::Signal
        | Column::Killed
        | Column::OutputUnread
        | Column::Asleep
        | Column::LinkLost
        | Column::Replugged
        | Column::PowerCycled
        | Column::FeedbackFrozen
        | Column::OddReplies
        | Column::Disobeys
        | Column::SecondHandscope
        | Column::FaultOrHeat
        | Column::GatewayRefuses
        | Column::StopThenLost
        | Column::RepliesSlow
        | Column::Busy
        | Column::NoDescriptors
        | Column::JointFrozen
        | Column::ReaderGone => Tried(Settled, ""),
        Column::OddStop => ONE_SPELLING,
        Column::GrantedAgain => NOT_GRANTED,
    }
}
