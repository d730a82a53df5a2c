//! Notices for the user, as typed causes. The views provide the texts in every language.

use crate::app::readings::faults::FaultKind;
use crate::app::slot::HandLabel;
use crate::hand::gap::BlockError;
use crate::hand::grip::GripState;
use crate::hand::{Dof, Finger, Gesture, Moment};
use crate::link::{LinkTrouble, Owner, RequestError};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::hold::HoldEnd;
use crate::motion::program::Ended;
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

/// Maximum number of open notices: more than the user reads. The oldest are dropped first.
pub const NOTICES_MAX: usize = 64;
/// Maximum number of log entries: one per minute over two working days. The oldest are dropped first.
pub const LOG_MAX: usize = 1000;

/// Severity of a notice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// For information.
    Info,
    /// A request or operation failed.
    Warn,
    /// The hand may move unexpectedly.
    Alarm,
}

/// Kind of a request to the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RequestKind {
    /// A gesture stored in the hand.
    Gesture(Gesture),
    ClearErrors,
}

/// Cause of a notice.
#[derive(Debug, Clone, PartialEq)]
pub enum NoticeKind {
    /// The hand was live and is now lost.
    LinkLost(LinkTrouble),
    /// The hand could not be reached so far.
    NoLink(LinkTrouble),
    /// The hand answers again. It is not armed.
    Reconnected,
    /// The USB adapter delays replies.
    LatencyTimer {
        port: String,
        /// Latency if the system reports it; `None` if inferred from round trips.
        ms: Option<u16>,
    },
    /// Feedback confirms that the hand is at rest.
    HoldConfirmed {
        /// Time from the press to rest.
        after: Duration,
    },
    /// Feedback does not show rest: the hand may still move.
    HoldAlarm,
    /// Stop was pressed, and there is no live link to send it over.
    StopNotSent,
    /// Taring was refused because a fingertip is touched: nothing was changed.
    TareUnderLoad {
        finger: Finger,
        /// Force on it in newtons.
        newtons: f32,
    },
    /// The hand was disarmed without a request of the user.
    Disarmed(Disarmed),
    /// The hand was disarmed because another controller wrote this.
    DisarmedByOther(SetpointConflict),
    /// The followed source fell silent; the hand was stopped.
    SourceSilent(Owner),
    /// The window did not read for too long, so this number of task steps was dropped.
    StepsLost(u64),
    /// This hand was stopped or lost while following another, which was stopped as well.
    LeaderStopped,
    /// An armed hand received no commands for the configured time and was disarmed.
    IdleDisarmed,
    /// The hand cannot be armed.
    ArmRefused(ArmRefusal),
    /// A joint has a fault.
    Fault { dof: Dof, what: FaultKind },
    /// A request failed.
    RequestFailed {
        what: RequestKind,
        error: RequestError,
    },
    /// The hand acknowledged a request. It does not report completion.
    Acknowledged { what: RequestKind },
    /// A gesture moves all joints, and this one is locked. Nothing was sent.
    GestureWouldMoveLocked {
        /// The first locked joint.
        dof: Dof,
    },
    /// Gestures are disabled. Nothing was sent.
    GesturesOff,
    /// The pose cannot be stored while an angle is unknown or stale.
    PoseUnknown,
    /// A block was rejected as a correction of the sizes shown.
    BlockNotTaken(BlockError),
    /// A pose file was imported.
    PosesImported { poses: usize, sequences: usize },
    /// A chosen file was rejected as a whole.
    FileRefused {
        path: PathBuf,
        /// Location and cause.
        error: FileError,
    },
    /// A file of this program is unreadable; it was set aside unchanged.
    FileIgnored {
        path: PathBuf,
        /// Location and cause.
        error: FileError,
        /// Its new path; `None` if it could not be moved.
        kept_as: Option<PathBuf>,
    },
    /// A sequence ended because no object was held in time.
    NotHolding { grip: GripState },
    /// A hold needs more than *at most*.
    CannotHold,
    /// A grasp of another hand is not trusted on this one.
    GraspDoubted(GraspDoubt),
    /// A hold ended by itself, or early.
    HoldEnded(Ended<HoldEnd>),
    /// A series of trials has ended.
    SeriesEnded {
        /// Number of measured trials.
        trials: usize,
        /// Reason for an early end.
        aborted: Option<Abort>,
    },
    /// A check-up has ended.
    CheckupEnded {
        /// Number of figures that require action, and of those to watch.
        act: usize,
        watch: usize,
        /// Reason for an early end.
        aborted: Option<Abort>,
    },
    /// Another request was made while a series runs. Nothing was sent.
    SeriesRuns,
    /// A series was not started: the hand is not armed, or the plan has changed since.
    SeriesNotBegun,
    /// An exhibition needs a connected hand without other activity.
    ExhibitNotBegun,
    /// An exhibition supports one hand only, and several are connected.
    ExhibitWantsOneHand,
    /// This hand, or the port that leads to it, is open in another slot. Nothing was connected.
    OpenElsewhere {
        /// Requested endpoint.
        endpoint: String,
        /// Name of the hand that has it open.
        hand: String,
    },
    /// A recording could not be opened, or reading it failed.
    RecordingRefused { path: PathBuf, why: OpenError },
    /// An event of the file that a hand is recorded into.
    Recording(RecorderNotice),
    /// Writing to the disk fails, with the error text of the system. It is retried.
    RecordingStalled { why: String },
    /// A recording was not shown because a live hand needs the user's attention.
    NotReplayedNow,
    /// A request to a hand was made while a recording is shown. Nothing was sent.
    Recorded,
    /// Recordings exceed the storage budget: the oldest are deleted when a recording starts later.
    RecordingsPlanned {
        /// Number of recordings.
        recordings: usize,
        /// Bytes that this frees.
        bytes: u64,
        /// Days of the first and the last of them.
        days: (String, String),
        /// Earliest time of the deletion, `2026-11-22 09:30`, UTC.
        due: String,
    },
    RecordingsDeleted {
        /// Number of recordings.
        recordings: usize,
    },
    /// A saved trial session was opened.
    RecordingOpened { path: PathBuf, trials: usize },
    /// The guard process that stops the hand if this program is killed could not be started.
    Unguarded {
        /// Error text of the system.
        why: String,
    },
    /// OpenGL did not start, so the program uses its software renderer.
    DrawnWithoutOpenGl {
        /// Error text of the system.
        reason: String,
    },
    /// A file was written.
    Saved { path: PathBuf, entries: usize },
    /// A file could not be written.
    NotSaved { path: PathBuf, error: SystemError },
    /// A recording could not be exported.
    NotExported {
        /// Path of the recording.
        path: PathBuf,
        error: ExportError,
    },
    /// A recording could not be deleted.
    NotDeleted { path: PathBuf, error: SystemError },
    /// A file could not be revealed in the system's file manager.
    NotRevealed { path: PathBuf, error: SystemError },
    /// No file was chosen: the dialog was cancelled, or this desktop has none.
    NoFileChosen,
    /// The hand at this address answers differently than the previous one: it may be a different hand.
    HandDiffers {
        differences: Vec<FactDifference>,
        /// Day of the previous connection.
        last_seen: String,
    },
    /// The stored plan of trials is invalid.
    PlanIgnored { error: PlanReadError },
    /// The stored endpoint is invalid.
    EndpointIgnored {
        /// Text in the settings file.
        text: String,
    },
}

impl NoticeKind {
    /// Notice that a file could not be written.
    pub(crate) fn not_saved(path: PathBuf, error: &std::io::Error) -> Self {
        let error = error.into();
        Self::NotSaved { path, error }
    }

    /// Notice that a recording could not be deleted.
    pub(crate) fn not_deleted(path: PathBuf, error: &std::io::Error) -> Self {
        let error = error.into();
        Self::NotDeleted { path, error }
    }

    /// Severity of the notice.
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

    /// Kinds that differ only in a measured value are one notice, with the newest value.
    fn is_same(&self, other: &Self) -> bool {
        let confirmed: fn(&Self) -> bool = |kind| matches!(kind, Self::HoldConfirmed { .. });
        let planned: fn(&Self) -> bool = |kind| matches!(kind, Self::RecordingsPlanned { .. });
        let alike = |is: fn(&Self) -> bool| is(self) && is(other);
        self == other || alike(confirmed) || alike(planned)
    }
}

/// A notice for the user.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// Identifies the notice for dismissal.
    pub id: u64,
    /// Time of the latest occurrence.
    pub at: Moment,
    pub level: Level,
    pub what: NoticeKind,
    /// Hand of the notice, if there are several, or if it is not the current one.
    pub hand: Option<HandLabel>,
    /// True if the notice is about a hand, named or not.
    is_of_hand: bool,
    /// Number of occurrences since it was last dismissed.
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

/// Subject of a notice.
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

/// Open notices, and the log of all notices; both bounded.
#[derive(Debug, Clone, Default)]
pub struct Notices {
    open: VecDeque<Notice>,
    log: VecDeque<Notice>,
    pushed: u64,
    log_dropped: u64,
}

/// Adds notices about one hand; if there are several, with its name.
pub(crate) struct HandNotices<'a> {
    notices: &'a mut Notices,
    hand: Option<HandLabel>,
}

impl HandNotices<'_> {
    /// Adds a notice, as [`Notices::push`] does.
    pub(crate) fn push(&mut self, at: Moment, what: NoticeKind) {
        self.notices.add(at, what, About::Hand(self.hand.as_ref()));
    }

    /// Adds the name of the former only hand to its notices, when another hand takes its place.
    pub(crate) fn name_former(&mut self, hand: &HandLabel) {
        let Notices { open, log, .. } = &mut *self.notices;
        for notice in open.iter_mut().chain(log) {
            if notice.is_of_hand && notice.hand.is_none() {
                notice.hand = Some(hand.clone());
            }
        }
    }

    /// Removes notices of this hand that no longer apply. The log keeps them.
    pub(crate) fn withdraw(&mut self, over: impl Fn(&NoticeKind) -> bool) {
        let slot = self.hand.as_ref().map(|hand| hand.slot);
        let is_other = |hand: &HandLabel| slot.is_some_and(|slot| slot != hand.slot);
        self.notices
            .open
            .retain(|notice| !over(&notice.what) || notice.hand.as_ref().is_some_and(is_other));
    }
}

impl Notices {
    /// Returns a sink for notices about this hand; `None` = the only one.
    pub(crate) fn about(&mut self, hand: Option<&HandLabel>) -> HandNotices<'_> {
        HandNotices {
            hand: hand.cloned(),
            notices: self,
        }
    }

    /// Adds a notice about no hand, or about the only one. A repeated cause is counted and becomes the newest. A fault is only logged: the
    /// list of faults shows it until it is marked as seen.
    pub fn push(&mut self, at: Moment, what: NoticeKind) {
        self.add(at, what, About::NoHand);
    }

    fn add(&mut self, at: Moment, what: NoticeKind, about: About<'_>) {
        self.pushed += 1;
        self.note(at, &what, about);
        if matches!(what, NoticeKind::Fault { .. }) {
            return;
        }
        let known = self.open.iter().position(|own| own.is_same(&what, about));
        let known = known.and_then(|index| self.open.remove(index));
        if let Some(mut notice) = known {
            notice.again(at, what);
            return self.open.push_back(notice);
        }
        if self.open.len() >= NOTICES_MAX {
            self.open.pop_front();
        }
        let notice = Notice::new(self.pushed, at, what, about);
        self.open.push_back(notice);
    }

    /// Adds a log entry. An immediate repetition is counted; otherwise it is a separate entry.
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

    /// True if there are no open notices.
    pub fn is_empty(&self) -> bool {
        self.open.is_empty()
    }

    /// Dismisses a notice. The log keeps it.
    pub fn dismiss(&mut self, id: u64) {
        self.open.retain(|notice| notice.id != id);
    }

    /// Open notices, newest first.
    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.open.iter().rev()
    }

    /// All logged notices, newest first, dismissed or not. Their IDs belong to the log.
    pub fn log(&self) -> impl Iterator<Item = &Notice> {
        self.log.iter().rev()
    }

    /// Number of log entries dropped for lack of space.
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
