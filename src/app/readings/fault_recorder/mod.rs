//! Flight recorder: starts and ends recordings around faults, notes the events in them, and retains the newest for viewing.
//! Writes no file and sends nothing.

mod recording;

pub use crate::app::readings::fault_recorder::recording::{
    DriveState, FaultAt, FaultEvent, FaultEventKind, FaultRecording, FaultRecordingId, UserAct,
};

use crate::app::readings::faults::FaultKind;
use crate::hand::{Dof, Group, Groups, HandSample, Moment, PerDof};
use crate::history::History;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// Time recorded before a fault: long enough to show the cause of a stall or of heat, and to cover a grasp with its
/// approach.
pub const BEFORE: Duration = Duration::from_secs(45);
/// Time recorded after a fault: long enough to show the reactions of the hand and of the user.
pub const AFTER: Duration = Duration::from_secs(15);
/// A further fault extends the running recording, up to this time after the first fault.
pub const AFTER_MAX: Duration = Duration::from_secs(60);
/// Maximum number of retained recordings: about 1 MB each at 100 Hz, and 4 MB for the longest of a fast link, so 48 MB
/// in total.
pub const RECORDINGS_MAX: usize = 12;
/// Maximum number of events: forty per second over the longest recording.
pub const EVENTS_MAX: usize = 4096;
/// Maximum number of faults listed in a recording: further ones of a flickering fault add nothing.
const FAULTS_MAX: usize = 256;
/// Changes of one control within this time count as one event.
const KNOB: Duration = Duration::from_millis(250);

/// A recording in progress.
#[derive(Debug, Clone)]
struct OpenRecording {
    first: Moment,
    until: Moment,
    faults: Vec<FaultAt>,
}

#[derive(Debug, Clone, Default)]
pub struct FaultRecorder {
    events: VecDeque<FaultEvent>,
    /// Drive states before the oldest event.
    before: PerDof<DriveState>,
    now: PerDof<DriveState>,
    events_lost: u64,
    running: Option<OpenRecording>,
    recordings: VecDeque<Arc<FaultRecording>>,
    made: u64,
}

impl FaultRecorder {
    /// Notes changes of status and faults.
    pub(crate) fn sample(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        for dof in Dof::ALL {
            if let Some(status) = sample.status.filter(|_| fresh.contains(Group::Status)) {
                let status = status.value[dof];
                match self.now[dof].status.replace(status) {
                    // The first report of a hand is its initial state, not a change.
                    None => self.before[dof].status = Some(status),
                    Some(old) if old == status => {}
                    Some(_) => self.note(now, FaultEventKind::Status(dof, status)),
                }
            }
            if let Some(faults) = sample.faults.filter(|_| fresh.contains(Group::Faults)) {
                let faults = faults.value[dof];
                match self.now[dof].faults.replace(faults) {
                    None => self.before[dof].faults = Some(faults),
                    Some(old) if old == faults => {}
                    Some(_) => self.note(now, FaultEventKind::Faults(dof, faults)),
                }
            }
        }
    }

    /// Notes a user action.
    pub(crate) fn record_user_act(&mut self, act: UserAct, now: Moment) {
        let known = self.events.iter_mut().rev().take(8).find(|event| {
            let quick = now.since(event.at) < KNOB;
            quick && matches!(&event.what, FaultEventKind::UserAct(old) if old.is_same_knob(&act))
        });
        match known {
            Some(event) => event.what = FaultEventKind::UserAct(act),
            None => self.note(now, FaultEventKind::UserAct(act)),
        }
    }

    fn note(&mut self, at: Moment, what: FaultEventKind) {
        if self.events.len() >= EVENTS_MAX {
            self.drop_oldest();
            self.events_lost += 1;
        }
        self.events.push_back(FaultEvent { at, what });
    }

    /// Drops the oldest event and applies it to the initial state.
    fn drop_oldest(&mut self) {
        match self.events.pop_front().map(|event| event.what) {
            Some(FaultEventKind::Status(dof, status)) => self.before[dof].status = Some(status),
            Some(FaultEventKind::Faults(dof, faults)) => self.before[dof].faults = Some(faults),
            Some(FaultEventKind::UserAct(_)) | None => {}
        }
    }

    /// Notes a new fault, in the running recording or in a new one.
    pub(crate) fn fault(&mut self, dof: Dof, what: FaultKind, now: Moment) {
        let running = self.running.get_or_insert_with(|| OpenRecording {
            first: now,
            until: now,
            faults: Vec::new(),
        });
        running.until = now.plus(AFTER).min(running.first.plus(AFTER_MAX));
        if running.faults.len() < FAULTS_MAX {
            running.faults.push(FaultAt { at: now, dof, what });
        } else {
            self.events_lost += 1;
        }
    }

    /// Finishes the running recording when due, and drops events that no recording needs.
    pub(crate) fn tick(&mut self, history: &History, hand: &str, now: Moment) {
        if self
            .running
            .as_ref()
            .is_some_and(|running| now >= running.until)
        {
            self.cut(history, hand, now);
        }
        let first = self.running.as_ref().map_or(now, |running| running.first);
        while let Some(oldest) = self.events.front()
            && first.since(oldest.at) > BEFORE
        {
            self.drop_oldest();
        }
    }

    /// Finishes the running recording and resets the state: the next hand, if any, is a different one.
    pub(crate) fn another_hand(&mut self, history: &History, hand: &str, now: Moment) {
        self.cut(history, hand, now);
        self.events.clear();
        self.before = PerDof::default();
        self.now = self.before;
        self.events_lost = 0;
    }

    fn cut(&mut self, history: &History, hand: &str, now: Moment) {
        let Some(running) = self.running.take() else {
            return;
        };
        let first = running.first.since(Moment::ZERO);
        let from = Moment::from_duration(first.saturating_sub(BEFORE));
        let recording = FaultRecording {
            id: FaultRecordingId(self.made),
            hand: hand.to_owned(),
            faults: running.faults,
            from,
            to: now,
            history: history.slice(from.secs(), now.secs()),
            before: self.before,
            events: self.events.iter().cloned().collect(),
            events_lost: std::mem::take(&mut self.events_lost),
        };
        self.made += 1;
        if self.recordings.len() >= RECORDINGS_MAX {
            self.recordings.pop_front();
        }
        self.recordings.push_back(Arc::new(recording));
    }

    /// All retained recordings, newest first.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<FaultRecording>> {
        self.recordings.iter().rev()
    }

    /// Recording with this ID; `None` if it was dropped.
    pub fn get(&self, id: FaultRecordingId) -> Option<&Arc<FaultRecording>> {
        self.recordings.iter().find(|recording| recording.id == id)
    }

    /// Newest recording of this fault that started at this moment.
    pub fn of(&self, dof: Dof, what: FaultKind, since: Moment) -> Option<&Arc<FaultRecording>> {
        let mut recordings = self.iter();
        recordings.find(|recording| recording.holds(dof, what, since))
    }

    /// End of the running recording; `None` if none is running.
    pub fn runs_until(&self) -> Option<Moment> {
        self.running.as_ref().map(|running| running.until)
    }

    /// Number of recordings dropped for lack of space.
    pub fn lost(&self) -> u64 {
        let count = u64::try_from(self.recordings.len()).unwrap_or(u64::MAX);
        self.made.saturating_sub(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Quantity;
    use crate::hand::{Angle, Fault, Faults, ForceReading, Status, Timed};
    use crate::history::Series;

    const STALL: FaultKind = FaultKind::Fault(Fault::Stall);

    /// A hand at 100 Hz whose force equals the time in seconds.
    struct Bench {
        recorder: FaultRecorder,
        history: History,
        tick: u64,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                recorder: FaultRecorder::default(),
                history: History::new(),
                tick: 0,
            }
        }

        fn now(&self) -> Moment {
            Moment::from_micros(self.tick * 10_000)
        }

        fn run(&mut self, seconds: u64, status: Status) {
            for _ in 0..seconds * 100 {
                self.tick += 1;
                let now = self.now();
                let second = i16::try_from(self.tick / 100).unwrap_or(i16::MAX);
                let timed = |value| Timed {
                    value,
                    asked: now,
                    received: now,
                };
                let sample = HandSample {
                    force: Some(timed(PerDof::splat(ForceReading::new(second)))),
                    status: Some(Timed {
                        value: PerDof::splat(status),
                        asked: now,
                        received: now,
                    }),
                    ..HandSample::default()
                };
                let mut fresh = Groups::NONE;
                fresh.insert(Group::Force);
                fresh.insert(Group::Status);
                self.history.push(&sample, fresh);
                self.recorder.sample(&sample, fresh, now);
                self.recorder.tick(&self.history, "sim:", now);
            }
        }

        fn fault(&mut self, dof: Dof) {
            self.recorder.fault(dof, STALL, self.now());
        }

        fn newest(&self) -> Arc<FaultRecording> {
            let newest = self.recorder.iter().next().expect("a recording");
            Arc::clone(newest)
        }
    }

    #[test]
    fn a_recording_holds_what_was_before_and_after_and_outlives_the_history() {
        let mut bench = Bench::new();
        bench.run(100, Status::PositionReached);
        bench.fault(Dof::Index);
        bench.run(2, Status::Stalled);
        bench
            .recorder
            .record_user_act(UserAct::ClearErrors, bench.now());
        bench.run(12, Status::PositionReached);
        assert_eq!(bench.recorder.iter().count(), 0, "it still runs");
        assert!(bench.recorder.runs_until().is_some());
        bench.run(2, Status::PositionReached);
        let recording = bench.newest();
        assert_eq!((recording.from.secs(), recording.to.secs()), (55.0, 115.0));
        bench.history = History::new();
        let force = Series::Joint(Quantity::Force, Dof::Ring);
        let summary = recording
            .history
            .summary(force, 0.0, 1e9)
            .expect("measured");
        assert_eq!((summary.min, summary.max), (55.0, 115.0));
        assert!((5990..=6010).contains(&summary.count), "{summary:?}");
        let of_ring = recording
            .events
            .iter()
            .filter_map(|event| match event.what {
                FaultEventKind::Status(Dof::Ring, status) => Some(status),
                _ => None,
            });
        let (rest, stalled) = (Status::PositionReached, Status::Stalled);
        assert_eq!(recording.before[Dof::Ring].status, Some(rest));
        assert!(of_ring.eq([stalled, rest]));
        let table = recording.table().csv();
        assert!(
            table.contains("clear errors") && table.contains("status_ring"),
            "{}",
            &table[..900]
        );
        assert!(
            table
                .lines()
                .next()
                .is_some_and(|head| head.ends_with(",event"))
        );
        assert!(
            bench
                .recorder
                .of(Dof::Index, STALL, Moment::from_micros(100_000_000))
                .is_some()
        );
    }

    #[test]
    fn faults_that_come_together_are_one_recording_and_a_flickering_one_does_not_go_on_for_ever() {
        let mut bench = Bench::new();
        bench.run(50, Status::PositionReached);
        for dof in Dof::ALL {
            bench.fault(dof);
            bench.run(5, Status::Stalled);
        }
        bench.run(15, Status::Stalled);
        let recording = bench.newest();
        assert_eq!(recording.faults.len(), 6);
        let after = recording.to.since(recording.faults.last().expect("six").at);
        assert!(
            after >= AFTER,
            "the last one has its time after it, too: {after:?}"
        );
        for _ in 0..100 {
            bench.fault(Dof::Ring);
            bench.run(1, Status::Stalled);
        }
        let longest = bench.newest();
        assert!(longest.to.since(longest.from) <= BEFORE + AFTER_MAX);
    }

    #[test]
    fn another_hand_ends_a_recording_and_begins_with_nothing() {
        let mut bench = Bench::new();
        bench.run(10, Status::Stalled);
        bench.fault(Dof::Ring);
        bench.run(1, Status::Stalled);
        let now = bench.now();
        bench.recorder.another_hand(&bench.history, "sim:", now);
        assert_eq!(bench.newest().to, now);
        assert!(bench.recorder.events.is_empty() && bench.recorder.runs_until().is_none());
    }

    #[test]
    fn recordings_are_bounded_and_the_oldest_goes_first_and_is_counted() {
        let mut bench = Bench::new();
        for _ in 0..=RECORDINGS_MAX {
            assert_eq!(bench.recorder.lost(), 0);
            bench.fault(Dof::Ring);
            bench.run(16, Status::Stalled);
        }
        assert_eq!(bench.recorder.lost(), 1);
        assert!(bench.recorder.get(FaultRecordingId(0)).is_none());
        assert!(bench.recorder.get(FaultRecordingId(1)).is_some());
        assert_eq!(bench.recorder.iter().count(), RECORDINGS_MAX);
        let held = bench.recorder.iter().map(|own| own.history.bytes());
        let bytes: usize = held.sum();
        assert!(bytes < 48_000_000, "{bytes}");
    }

    #[test]
    fn events_are_bounded_and_a_dragged_slider_is_few_of_them() {
        let mut bench = Bench::new();
        for step in 0..200_i16 {
            bench.tick += 1;
            let act = UserAct::Target(Dof::Index, Angle::nearest(step));
            bench.recorder.record_user_act(act, bench.now());
        }
        assert_eq!(bench.recorder.events.len(), 8, "two seconds");
        for flip in 0..10_000_u64 {
            let faults = Faults::from_raw(u8::from(flip % 2 == 0));
            bench
                .recorder
                .note(bench.now(), FaultEventKind::Faults(Dof::Ring, faults));
        }
        assert_eq!(bench.recorder.events.len(), EVENTS_MAX);
        bench.fault(Dof::Ring);
        bench.run(16, Status::Stalled);
        assert!(bench.newest().events_lost > 5000, "and the loss is told");
    }
}
