//! What the user should read, as typed causes. The words, in every language, are the views'.

use crate::app::readings::faults::FaultKind;
use crate::app::slot::HandLabel;
use crate::hand::gap::BlockError;
use crate::hand::grip::GripState;
use crate::hand::{Dof, Finger, Gesture, Moment};
use crate::link::{LinkTrouble, Owner, RequestError};
use crate::record::Abort;
use crate::record::export::ExportError;
use crate::record::file::{OpenError, RecorderNotice};
use crate::record::quirk_sheet::FactDifference;
use crate::record::{ArmRefusal, Disarmed, SetpointConflict};
use crate::store::FileError;
use crate::system::SystemError;
use crate::trials::plan_settings::PlanReadError;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Duration;

/// Notices that ask for attention: more than the user reads. The oldest go first.
pub const NOTICES_MAX: usize = 64;
/// Entries of the log: a trouble a minute for a working day, with as much room again. The oldest go first.
pub const LOG_MAX: usize = 1000;

/// How much it matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// Good to know.
    Info,
    /// Something did not go as wished.
    Warn,
    /// The hand may do something that nobody wants.
    Alarm,
}

/// What was asked of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RequestKind {
    /// A stored pose.
    Gesture(Gesture),
    ClearErrors,
}

/// What happened.
#[derive(Debug, Clone, PartialEq)]
pub enum NoticeKind {
    /// The hand was live and is not any more.
    LinkLost(LinkTrouble),
    /// The hand could not be reached so far.
    NoLink(LinkTrouble),
    /// The hand answers again. It is not armed.
    Reconnected,
    /// The USB adapter keeps replies back.
    LatencyTimer {
        port: String,
        /// For how long, where the system tells; else it was seen in round trips.
        ms: Option<u16>,
    },
    /// Feedback shows that the hand rests.
    HoldConfirmed {
        /// From the press to rest.
        after: Duration,
    },
    /// Feedback does not show rest: the hand may still move.
    HoldAlarm,
    /// Stop was pressed, and there is no live link to send it over.
    StopNotSent,
    /// A fingertip that is touched was to be tared: nothing was changed.
    TareUnderLoad {
        finger: Finger,
        /// What presses it, in newtons.
        newtons: f32,
    },
    /// The hand is not armed any more, and no user asked for it.
    Disarmed(Disarmed),
    /// The hand is not armed any more, for another controller wrote this.
    DisarmedByOther(SetpointConflict),
    /// What the hand followed fell silent; the hand was stopped.
    SourceSilent(Owner),
    /// The window did not look for so long that so many steps of what goes on were left out.
    StepsLost(u64),
    /// This hand was stopped or lost while another led it, and that one was stopped, too.
    LeaderStopped,
    /// An armed hand was asked nothing for so long that it was disarmed, as the settings say.
    IdleDisarmed,
    /// The hand cannot be armed.
    ArmRefused(ArmRefusal),
    /// A joint is not well.
    Fault {
        /// The joint.
        dof: Dof,
        what: FaultKind,
    },
    /// Something was asked and did not work.
    RequestFailed {
        /// What was asked.
        what: RequestKind,
        /// Why.
        error: RequestError,
    },
    /// Something was asked and the hand acknowledged it. It does not say that it is done.
    Acknowledged {
        /// What was asked.
        what: RequestKind,
    },
    /// A gesture moves all joints, and this one is locked. Nothing was sent.
    GestureWouldMoveLocked {
        /// The first locked joint.
        dof: Dof,
    },
    /// Gestures are switched off. Nothing was sent.
    GesturesOff,
    /// A pose cannot be kept while an angle is unknown or old.
    PoseUnknown,
    /// A block was not taken to correct the sizes that are told.
    BlockNotTaken(BlockError),
    /// A file of poses was added.
    PosesImported { poses: usize, sequences: usize },
    /// A file that was chosen was not taken, not even in part.
    FileRefused {
        /// The file.
        path: PathBuf,
        /// Where and why.
        error: FileError,
    },
    /// A file of this program's own could not be read; it is left as it was, under another name.
    FileIgnored {
        /// The file.
        path: PathBuf,
        /// Where and why.
        error: FileError,
        /// Where it lies now; `None` if it could not be moved.
        kept_as: Option<PathBuf>,
    },
    /// A sequence ended, for nothing was held in time.
    NotHolding { grip: GripState },
    /// A series of trials is over.
    SeriesEnded {
        /// Trials that were measured.
        trials: usize,
        /// Why it ended early.
        aborted: Option<Abort>,
    },
    /// A check-up is over.
    CheckupEnded {
        /// Figures that are to be acted on, and to be watched.
        act: usize,
        watch: usize,
        /// Why it ended early.
        aborted: Option<Abort>,
    },
    /// Something else was asked of the hand while a series runs. Nothing was sent.
    SeriesRuns,
    /// The hand was to be armed for a series, and is not, or the plan is another by now.
    SeriesNotBegun,
    /// An exhibition needs a hand that is connected, and that nothing else is done to.
    ExhibitNotBegun,
    /// An exhibition is for one hand, and several are connected.
    ExhibitWantsOneHand,
    /// This hand, or the port that leads to it, is open in another slot. Nothing was connected.
    OpenElsewhere {
        /// What was asked for.
        endpoint: String,
        /// What the hand that has it is called.
        hand: String,
    },
    /// A recording could not be opened or read on.
    RecordingRefused {
        /// The file.
        path: PathBuf,
        why: OpenError,
    },
    /// Something happened to the file that a hand is recorded into.
    Recording(RecorderNotice),
    /// The disk does not take what is recorded, in the system's words. It is tried again.
    RecordingStalled { why: String },
    /// A recording was to be shown while something goes on at the hand that the user must see.
    NotReplayedNow,
    /// Something was asked of a hand while a recording is shown. Nothing was sent.
    Recorded,
    /// Recordings need more room than they may: the oldest are deleted when a recording begins later.
    RecordingsPlanned {
        /// How many.
        recordings: usize,
        /// Bytes that this frees.
        bytes: u64,
        /// When the first and the last of them were recorded, as days.
        days: (String, String),
        /// Not before this time, `2026-11-22 09:30`, UTC.
        due: String,
    },
    RecordingsDeleted {
        /// How many.
        recordings: usize,
    },
    /// A recording was read.
    RecordingOpened {
        /// Where it lies.
        path: PathBuf,
        trials: usize,
    },
    /// No process could be started that stops the hand if this program is killed.
    Unguarded {
        /// The system's words.
        why: String,
    },
    /// OpenGL did not start, so the program draws its window by itself.
    DrawnWithoutOpenGl {
        /// The system's words.
        reason: String,
    },
    /// A file was written.
    Saved { path: PathBuf, entries: usize },
    /// A file could not be written.
    NotSaved { path: PathBuf, error: SystemError },
    /// A recording could not be written in a format of others.
    NotExported {
        /// The recording.
        path: PathBuf,
        error: ExportError,
    },
    /// A recording could not be deleted.
    NotDeleted {
        /// The file.
        path: PathBuf,
        error: SystemError,
    },
    /// A file could not be shown in the system's file manager.
    NotRevealed {
        /// The file.
        path: PathBuf,
        error: SystemError,
    },
    /// No place was chosen for a file: the dialog was cancelled, or this desktop has none.
    NoFileChosen,
    /// The hand at this address answers otherwise than the one of last time: it may be another.
    HandDiffers {
        differences: Vec<FactDifference>,
        /// Day of last time.
        last_seen: String,
    },
    /// The plan of trials of the last time cannot be taken.
    PlanIgnored { error: PlanReadError },
    /// The remembered hand's spelling means nothing.
    EndpointIgnored {
        /// What the file says.
        text: String,
    },
}

impl NoticeKind {
    /// A file could not be written there.
    pub(crate) fn not_saved(path: PathBuf, error: &std::io::Error) -> Self {
        let error = error.into();
        Self::NotSaved { path, error }
    }

    /// A recording could not be deleted.
    pub(crate) fn not_deleted(path: PathBuf, error: &std::io::Error) -> Self {
        let error = error.into();
        Self::NotDeleted { path, error }
    }

    /// How much it matters.
    pub const fn level(&self) -> Level {
        match self {
            Self::LinkLost(_) | Self::HoldAlarm | Self::StopNotSent => Level::Alarm,
            Self::Reconnected
            | Self::HoldConfirmed { .. }
            | Self::Acknowledged { .. }
            | Self::Saved { .. }
            | Self::RecordingsDeleted { .. }
            | Self::Recorded
            | Self::PosesImported { .. }
            | Self::SeriesEnded { aborted: None, .. }
            | Self::CheckupEnded {
                act: 0,
                aborted: None,
                ..
            }
            | Self::RecordingOpened { .. }
            | Self::DrawnWithoutOpenGl { .. }
            | Self::NoFileChosen => Level::Info,
            _ => Level::Warn,
        }
    }

    /// Kinds that differ only in a measured figure are one notice, with the newest figure.
    fn is_same(&self, other: &Self) -> bool {
        let confirmed: fn(&Self) -> bool = |kind| matches!(kind, Self::HoldConfirmed { .. });
        let planned: fn(&Self) -> bool = |kind| matches!(kind, Self::RecordingsPlanned { .. });
        let alike = |is: fn(&Self) -> bool| is(self) && is(other);
        self == other || alike(confirmed) || alike(planned)
    }
}

/// One thing to read.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// To dismiss it.
    pub id: u64,
    /// When it happened last.
    pub at: Moment,
    /// How much it matters.
    pub level: Level,
    /// What happened.
    pub what: NoticeKind,
    /// The hand that it is about, where there are several, or where that is another than the one of now.
    pub hand: Option<HandLabel>,
    /// It is about a hand, named or not.
    is_of_hand: bool,
    /// Times it happened since it was dismissed last.
    pub count: u32,
}

impl Notice {
    fn new(id: u64, at: Moment, what: NoticeKind, about: About<'_>) -> Self {
        Self {
            id,
            at,
            level: what.level(),
            what,
            hand: about.name().cloned(),
            is_of_hand: !matches!(about, About::NoHand),
            count: 1,
        }
    }

    fn is_same(&self, what: &NoticeKind, about: About<'_>) -> bool {
        let slot = |hand: &HandLabel| hand.slot;
        self.what.is_same(what) && self.hand.as_ref().map(slot) == about.name().map(slot)
    }

    fn again(&mut self, at: Moment, what: NoticeKind) {
        (self.at, self.what) = (at, what);
        self.count = self.count.saturating_add(1);
    }
}

/// What a notice is about.
#[derive(Debug, Clone, Copy)]
enum About<'a> {
    NoHand,
    /// The only hand, or one of several, by name.
    Hand(Option<&'a HandLabel>),
}

impl<'a> About<'a> {
    const fn name(self) -> Option<&'a HandLabel> {
        match self {
            Self::NoHand => None,
            Self::Hand(name) => name,
        }
    }
}

/// What the user should read, and the log of all that was to be read; both bounded.
#[derive(Debug, Clone, Default)]
pub struct Notices {
    kept: VecDeque<Notice>,
    log: VecDeque<Notice>,
    pushed: u64,
    log_dropped: u64,
}

/// Where it is told what happened at one hand: of several, with its name.
pub(crate) struct HandNotices<'a> {
    notices: &'a mut Notices,
    hand: Option<HandLabel>,
}

impl HandNotices<'_> {
    /// Adds one, as [`Notices::push`] does.
    pub(crate) fn push(&mut self, at: Moment, what: NoticeKind) {
        self.notices.add(at, what, About::Hand(self.hand.as_ref()));
    }

    /// Another hand takes the place of this one, which had no name as it was the only one: what was told of it carries its name.
    pub(crate) fn name_former(&mut self, hand: &HandLabel) {
        let Notices { kept, log, .. } = &mut *self.notices;
        for notice in kept.iter_mut().chain(log) {
            if notice.is_of_hand && notice.hand.is_none() {
                notice.hand = Some(hand.clone());
            }
        }
    }

    /// Takes away those of this hand that are no longer so. The log keeps them.
    pub(crate) fn withdraw(&mut self, over: impl Fn(&NoticeKind) -> bool) {
        let slot = self.hand.as_ref().map(|hand| hand.slot);
        let is_other = |hand: &HandLabel| slot.is_some_and(|slot| slot != hand.slot);
        self.notices
            .kept
            .retain(|notice| !over(&notice.what) || notice.hand.as_ref().is_some_and(is_other));
    }
}

impl Notices {
    /// For what is about this hand of several; `None` = about the only one.
    pub(crate) fn about(&mut self, hand: Option<&HandLabel>) -> HandNotices<'_> {
        HandNotices {
            hand: hand.cloned(),
            notices: self,
        }
    }

    /// Adds one about no hand, or about the only one. The same cause again is counted, not added, and counts as the newest. A fault is only logged: the list
    /// of faults asks for attention until it was seen.
    pub fn push(&mut self, at: Moment, what: NoticeKind) {
        self.add(at, what, About::NoHand);
    }

    fn add(&mut self, at: Moment, what: NoticeKind, about: About<'_>) {
        self.pushed += 1;
        self.note(at, &what, about);
        if matches!(what, NoticeKind::Fault { .. }) {
            return;
        }
        let known = self.kept.iter().position(|own| own.is_same(&what, about));
        let known = known.and_then(|index| self.kept.remove(index));
        if let Some(mut notice) = known {
            notice.again(at, what);
            return self.kept.push_back(notice);
        }
        if self.kept.len() >= NOTICES_MAX {
            self.kept.pop_front();
        }
        let notice = Notice::new(self.pushed, at, what, about);
        self.kept.push_back(notice);
    }

    /// Writes it into the log. The same cause right again is counted; after something else it is a line of its own.
    fn note(&mut self, at: Moment, what: &NoticeKind, about: About<'_>) {
        let newest = self.log.back_mut();
        if let Some(newest) = newest.filter(|last| last.is_same(what, about)) {
            return newest.again(at, what.clone());
        }
        if self.log.len() >= LOG_MAX {
            self.log.pop_front();
            self.log_dropped += 1;
        }
        let notice = Notice::new(self.pushed, at, what.clone(), about);
        self.log.push_back(notice);
    }

    /// True if there is nothing to read.
    pub fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// It was read. The log keeps it.
    pub fn dismiss(&mut self, id: u64) {
        self.kept.retain(|notice| notice.id != id);
    }

    /// Newest first.
    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.kept.iter().rev()
    }

    /// All that was ever to be read, newest first, dismissed or not. Ids are the log's own.
    pub fn log(&self) -> impl Iterator<Item = &Notice> {
        self.log.iter().rev()
    }

    /// Entries of the log that went because there were too many.
    pub const fn log_dropped(&self) -> u64 {
        self.log_dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_cause_is_counted_and_not_repeated() {
        let mut notices = Notices::default();
        for second in 0..5 {
            let at = Moment::from_micros(second * 1_000_000);
            notices.push(
                at,
                NoticeKind::HoldConfirmed {
                    after: Duration::from_millis(second),
                },
            );
            notices.push(at, NoticeKind::HoldAlarm);
        }
        let counts: Vec<_> = notices
            .iter()
            .map(|notice| (notice.level, notice.count))
            .collect();
        assert_eq!(counts, [(Level::Alarm, 5), (Level::Info, 5)]);
    }

    #[test]
    fn notices_are_bounded() {
        let mut notices = Notices::default();
        for number in 0..100 {
            notices.push(
                Moment::ZERO,
                NoticeKind::EndpointIgnored {
                    text: number.to_string(),
                },
            );
        }
        assert_eq!(notices.iter().count(), NOTICES_MAX);
        let newest = notices
            .iter()
            .next()
            .map(|notice| notice.id)
            .unwrap_or_default();
        notices.dismiss(newest);
        assert_eq!(notices.iter().count(), NOTICES_MAX - 1);
        assert!(notices.iter().all(|notice| notice.id != newest));
    }

    #[test]
    fn the_log_keeps_what_was_dismissed_and_is_bounded_too() {
        let mut notices = Notices::default();
        let again = |millis| NoticeKind::HoldConfirmed {
            after: Duration::from_millis(millis),
        };
        for what in [again(1), again(2), NoticeKind::HoldAlarm, again(3)] {
            notices.push(Moment::ZERO, what);
        }
        for id in notices.iter().map(|notice| notice.id).collect::<Vec<_>>() {
            notices.dismiss(id);
        }
        notices.push(Moment::from_micros(9), NoticeKind::HoldAlarm);
        notices.about(None).withdraw(|_| true);
        assert_eq!(notices.iter().count(), 0);
        let log: Vec<_> = notices
            .log()
            .map(|entry| (entry.level, entry.count))
            .collect();
        let (info, alarm) = (Level::Info, Level::Alarm);
        assert_eq!(log, [(alarm, 1), (info, 1), (alarm, 1), (info, 2)]);
        for number in 0..2000 {
            let text = number.to_string();
            notices.push(Moment::ZERO, NoticeKind::EndpointIgnored { text });
        }
        assert_eq!(
            (notices.log().count(), notices.log_dropped()),
            (LOG_MAX, 1004)
        );
    }
}
