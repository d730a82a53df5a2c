//! Readings of a hand and what is derived from them: faults and their recordings, peaks, tare, friction. Used for live hands and
//! replayed recordings alike.

pub mod fault_recorder;
pub mod faults;
pub(crate) mod friction;
pub mod tare;

use crate::app::readings::fault_recorder::FaultRecorder;
use crate::app::readings::faults::{FaultEntry, FaultList};
use crate::app::readings::tare::Tare;
use crate::hand::grip::GripEstimator;
use crate::hand::{
    Angle, AngleReading, Dof, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger,
};
use crate::history::{History, MarkKind};
use crate::transport::Endpoint;
use std::time::Duration;

/// Freshness of a shown value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freshness {
    /// Never read on this connection; shown as "-".
    Unknown,
    /// Recent, from a live link.
    Live,
    /// Older than about three reading intervals, or the link is lost; greyed out, with its age.
    Stale,
}

/// Readings of one connection.
#[derive(Debug, Default)]
pub struct Readings {
    /// Newest values from the hand, with their times. Retained, as stale values, when the link is lost.
    pub sample: HandSample,
    /// Reading interval of the angles and the other motion values.
    pub pace: ReadingPace,
    /// Reading interval of each fingertip.
    pub tip_pace: PerFinger<ReadingPace>,
    /// Zero points of the tactile channels.
    pub tare: Tare,
    /// Peak forces of the last seconds.
    pub peaks: ForcePeaks,
    /// Current and past faults.
    pub faults: FaultList,
    /// Grip estimate.
    pub grip: GripEstimator,
}

/// Measurements of a hand across connections.
#[derive(Debug, Default)]
pub struct Measurements {
    /// Measurements of the last minutes.
    pub history: History,
    /// Recordings around faults. They are retained when the hand changes.
    pub recorder: FaultRecorder,
    of: Option<Endpoint>,
}

impl Readings {
    /// Applies a sample received at `at`; returns the faults that are new with it.
    pub(crate) fn apply(
        &mut self,
        sample: &HandSample,
        fresh: Groups,
        at: Moment,
    ) -> Vec<FaultEntry> {
        self.sample = *sample;
        if let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) {
            self.pace.push(angle.asked);
        }
        for finger in Finger::ALL {
            let block = sample.tactile[finger].filter(|_| fresh.contains(Group::Tactile(finger)));
            if let Some(block) = block {
                self.tip_pace[finger].push(block.asked);
            }
        }
        self.grip.apply(sample, fresh, at);
        self.tare.begin(sample);
        if fresh.contains(Group::Force) {
            self.peaks.update(sample);
        }
        if !self.faults.update(sample, fresh, at) {
            return Vec::new();
        }
        let is_new = |entry: &&FaultEntry| entry.since == at;
        self.faults.active().filter(is_new).copied().collect()
    }

    /// Freshness of a value requested at `asked`, on a link that is live or not.
    pub fn freshness(&self, asked: Option<Moment>, is_live: bool, now: Moment) -> Freshness {
        freshness(asked, self.pace, is_live, now)
    }

    /// Freshness of a fingertip's reading.
    pub fn tip_freshness(&self, finger: Finger, is_live: bool, now: Moment) -> Freshness {
        let asked = self.sample.tactile[finger].map(|block| block.asked);
        freshness(asked, self.tip_pace[finger], is_live, now)
    }

    /// The current pose, if all six angles are known, live and fresh.
    pub fn pose_now(&self, is_live: bool, now: Moment) -> Option<PerDof<Angle>> {
        let angle = self.sample.angle?;
        let is_fresh = self.freshness(Some(angle.asked), is_live, now) == Freshness::Live;
        let angles = angle.value.map(AngleReading::hold).all();
        angles.filter(|_| is_fresh)
    }
}

fn freshness(asked: Option<Moment>, pace: ReadingPace, is_live: bool, now: Moment) -> Freshness {
    match asked {
        None => Freshness::Unknown,
        Some(at) if is_live && now.since(at) <= pace.stale_after() => Freshness::Live,
        Some(_) => Freshness::Stale,
    }
}

impl Measurements {
    /// Finishes the recording of the hand, which had this name, when it is disconnected.
    pub(crate) fn leave(&mut self, name: &str, now: Moment) {
        self.recorder.another_hand(&self.history, name, now);
    }

    /// Starts measuring this hand. If only its address has changed, the history continues.
    pub(crate) fn begin(&mut self, hand: &Endpoint, is_moved: bool) {
        if self.of.as_ref() != Some(hand) {
            self.of = Some(hand.clone());
            if !is_moved {
                self.history = History::new();
            }
        }
    }

    /// Adds a sample received at `at`, and the faults that are new with it.
    pub(crate) fn push(
        &mut self,
        sample: &HandSample,
        fresh: Groups,
        at: Moment,
        faults: &[FaultEntry],
    ) {
        self.history.push(sample, fresh);
        self.recorder.sample(sample, fresh, at);
        for entry in faults {
            let words = format!("{}: {}", entry.dof.name(), entry.what.name());
            self.history.mark(at, MarkKind::Fault(words.into()));
            self.recorder.fault(entry.dof, entry.what, at);
        }
    }
}

/// Minimum age at which a value counts as stale.
pub const STALE_AFTER_LEAST: Duration = Duration::from_millis(250);
/// Age at which every value counts as stale.
pub const STALE_AFTER_MOST: Duration = Duration::from_secs(3);
/// Number of reading intervals that may be missed.
const MISSED: u32 = 3;
/// Number of intervals considered.
const INTERVALS: usize = 4;

/// The most recent intervals between readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadingPace {
    last: Option<Moment>,
    intervals: [Duration; INTERVALS],
}

impl ReadingPace {
    /// Records a successful reading that was requested at this moment.
    pub fn push(&mut self, asked: Moment) {
        if let Some(last) = self.last.replace(asked) {
            self.intervals.rotate_left(1);
            if let Some(newest) = self.intervals.last_mut() {
                *newest = asked.since(last);
            }
        }
    }

    /// Age from which the reading counts as stale.
    pub fn stale_after(&self) -> Duration {
        let longest = self.intervals.iter().max().copied().unwrap_or_default();
        (longest * MISSED).clamp(STALE_AFTER_LEAST, STALE_AFTER_MOST)
    }
}

/// Time for which a peak is held.
pub const PEAK_HOLD: Duration = Duration::from_secs(3);

/// Peak force of each joint over the last seconds: a moving bar is too fast to read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ForcePeaks(PerDof<Option<(i16, Moment)>>);

impl ForcePeaks {
    /// Peak force of this joint in g and its time; `None` before the first reading.
    pub fn get(&self, dof: Dof) -> Option<(i16, Moment)> {
        self.0[dof]
    }

    /// Applies a new force reading. Undocumented values are ignored.
    pub(crate) fn update(&mut self, sample: &HandSample) {
        let Some(force) = sample.force else { return };
        for (dof, peak) in self.0.iter_mut() {
            let Some(grams) = force.value[dof].documented() else {
                continue;
            };
            let beaten = peak.is_none_or(|(highest, at)| {
                grams >= highest || force.received.since(at) >= PEAK_HOLD
            });
            if beaten {
                *peak = Some((grams, force.received));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{ForceReading, Timed};

    #[test]
    fn old_is_what_missed_about_three_readings() {
        let at = |ms: u64| Moment::from_micros(ms * 1000);
        let mut pace = ReadingPace::default();
        assert_eq!(pace.stale_after(), STALE_AFTER_LEAST);
        (0..9).for_each(|nth| pace.push(at(nth * 10)));
        assert_eq!(pace.stale_after(), STALE_AFTER_LEAST, "100 Hz");
        (1..9).for_each(|nth| pace.push(at(80 + nth * 300)));
        assert_eq!(pace.stale_after(), Duration::from_millis(900), "3 Hz");
        pace.push(at(60_000));
        assert_eq!(pace.stale_after(), STALE_AFTER_MOST, "after a long silence");
    }

    fn reading(grams: i16, millis: u64) -> HandSample {
        let at = Moment::from_micros(millis * 1000);
        HandSample {
            force: Some(Timed {
                value: PerDof::splat(ForceReading::new(grams)),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        }
    }

    #[test]
    fn a_peak_stays_three_seconds_and_gives_way_to_a_higher_one() {
        let mut peaks = ForcePeaks::default();
        let mut after = |grams, millis| {
            peaks.update(&reading(grams, millis));
            peaks.get(Dof::Index).map(|(grams, _)| grams)
        };
        assert_eq!(after(100, 0), Some(100));
        assert_eq!(after(900, 100), Some(900));
        assert_eq!(after(200, 200), Some(900));
        assert_eq!(after(950, 300), Some(950));
        assert_eq!(after(10, 3299), Some(950));
        assert_eq!(after(20, 3300), Some(20));
        assert_eq!(after(32767, 3400), Some(20), "not documented");
    }
}
