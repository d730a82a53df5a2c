//! The whole history of one hand: which reading goes to which line. How lines are kept is told in the siblings.

use crate::app::history::mark::{Mark, MarkKind, Marks};
use crate::app::history::trace::Trace;
use crate::app::history::track::{Slice, Track};
use crate::hand::{
    Dof, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger, Target, Timed,
};

/// The longest window of the plots.
pub const HISTORY_SECONDS: u32 = 600;
/// Rows kept of each group: ten minutes at 200 Hz, the most a serial line carries. About 37 MB when all are full.
pub const HISTORY_ROWS: usize = 200 * HISTORY_SECONDS as usize;
/// A longer silence than this breaks measured lines.
const GAP_AFTER_S: f64 = 0.5;
/// The same for targets, which are read about twice a second.
const TARGET_GAP_AFTER_S: f64 = 3.0;

/// What is measured of one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// ANGLE_ACT, 0..=1000.
    Angle,
    /// FORCE_ACT, g.
    Force,
    /// CURRENT, mA.
    Current,
    /// TEMP, °C.
    Temperature,
    /// ANGLE_SET as the hand holds it, 0..=1000; a joint that is left alone has none.
    TargetAngle,
}

impl Quantity {
    /// All, in the order of the variants.
    pub const ALL: [Self; 5] = [
        Self::Angle,
        Self::Force,
        Self::Current,
        Self::Temperature,
        Self::TargetAngle,
    ];
}

/// What is measured at one fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Touch {
    /// Normal force, N.
    Normal,
    /// Tangential force, N.
    Tangential,
}

/// One line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Series {
    /// Of a joint.
    Joint(Quantity, Dof),
    /// Of a fingertip.
    Tip(Touch, Finger),
}

/// What was measured over the last minutes, by the time it was received.
#[derive(Debug, Clone)]
pub struct History {
    angle: Track,
    force: Track,
    current: Track,
    temperature: Track,
    target: Track,
    tips: PerFinger<Box<Track>>,
    marks: Marks,
}

impl Default for History {
    fn default() -> Self {
        Self::new()
    }
}

impl History {
    /// Empty.
    #[must_use]
    pub fn new() -> Self {
        let joints = |gap_after_s| Track::new(Dof::ALL.len(), HISTORY_ROWS, gap_after_s);
        Self {
            angle: joints(GAP_AFTER_S),
            force: joints(GAP_AFTER_S),
            current: joints(GAP_AFTER_S),
            temperature: joints(GAP_AFTER_S),
            target: joints(TARGET_GAP_AFTER_S),
            tips: PerFinger::from_fn(|_| Box::new(Track::new(2, HISTORY_ROWS, GAP_AFTER_S))),
            marks: Marks::default(),
        }
    }

    /// Takes in what is new in a sample. Values that are not documented are not known.
    pub fn push(&mut self, sample: &HandSample, fresh: Groups) {
        let new = |group| fresh.contains(group);
        if new(Group::Angle) {
            add(&mut self.angle, sample.angle, |value| {
                value.documented().map(f32::from)
            });
        }
        if new(Group::Force) {
            add(&mut self.force, sample.force, |value| {
                value.documented().map(f32::from)
            });
        }
        if new(Group::Current) {
            add(&mut self.current, sample.current, |value| {
                value.documented().map(f32::from)
            });
        }
        if new(Group::Temperature) {
            add(&mut self.temperature, sample.temperature, |value| {
                value.documented().map(f32::from)
            });
        }
        if new(Group::AngleSet) {
            add(&mut self.target, sample.angle_set, |target| {
                target.and_then(target_angle)
            });
        }
        for finger in Finger::ALL {
            if let Some(block) = sample.tactile[finger].filter(|_| new(Group::Tactile(finger))) {
                let values = [block.value.normal(), block.value.tangential()];
                self.tips[finger].push(block.received.secs(), values);
            }
        }
    }

    /// The link is lost: all lines break here.
    pub fn gap(&mut self, at: Moment) {
        let at_s = at.secs();
        for track in [
            &mut self.angle,
            &mut self.force,
            &mut self.current,
            &mut self.temperature,
            &mut self.target,
        ] {
            track.gap(at_s);
        }
        for (_, track) in self.tips.iter_mut() {
            track.gap(at_s);
        }
    }

    /// Notes a moment worth a line across all plots.
    pub fn mark(&mut self, at: Moment, kind: MarkKind) {
        self.marks.push(Mark { at, kind });
    }

    /// The marks of a stretch of time, oldest first.
    pub fn marks(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Mark> {
        self.marks.between(from_s, to_s)
    }

    /// Fills `out` with one line over `columns` columns of pixels: at most about two points a column, and no
    /// extreme is lost. The work grows with the columns, not with the history.
    pub fn trace(&self, series: Series, from_s: f64, to_s: f64, columns: usize, out: &mut Trace) {
        let columns = u32::try_from(columns).unwrap_or(u32::MAX).max(1);
        let (track, quantity) = match series {
            Series::Joint(quantity, dof) => (self.joint(quantity), dof.index()),
            Series::Tip(Touch::Normal, finger) => (self.tips[finger].as_ref(), 0),
            Series::Tip(Touch::Tangential, finger) => (self.tips[finger].as_ref(), 1),
        };
        track.trace(
            quantity,
            Slice {
                from_s,
                to_s,
                columns,
            },
            out,
        );
    }

    /// Time of the oldest measurement that is still held, in seconds.
    #[must_use]
    pub fn first_secs(&self) -> Option<f64> {
        self.tracks().filter_map(Track::first_s).reduce(f64::min)
    }

    /// Time of the newest measurement, in seconds.
    #[must_use]
    pub fn last_secs(&self) -> Option<f64> {
        self.tracks().filter_map(Track::last_s).reduce(f64::max)
    }

    /// Memory held, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.tracks().map(Track::bytes).sum()
    }

    const fn joint(&self, quantity: Quantity) -> &Track {
        match quantity {
            Quantity::Angle => &self.angle,
            Quantity::Force => &self.force,
            Quantity::Current => &self.current,
            Quantity::Temperature => &self.temperature,
            Quantity::TargetAngle => &self.target,
        }
    }

    fn tracks(&self) -> impl Iterator<Item = &Track> {
        let tips = self.tips.iter().map(|(_, track)| track.as_ref());
        Quantity::ALL
            .into_iter()
            .map(|quantity| self.joint(quantity))
            .chain(tips)
    }
}

fn add<T: Copy>(
    track: &mut Track,
    group: Option<Timed<PerDof<T>>>,
    value: impl Fn(T) -> Option<f32>,
) {
    if let Some(group) = group {
        track.push(
            group.received.secs(),
            group.value.map(value).as_array().iter().copied(),
        );
    }
}

fn target_angle(target: Target) -> Option<f32> {
    target.angle().map(|angle| f32::from(angle.get()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used, clippy::indexing_slicing, reason = "a test may")]
    use super::*;
    use crate::app::history::mark::MARKS_MAX;
    use crate::hand::{AngleReading, ForceReading, TactileBlock};

    const FORCE: Series = Series::Joint(Quantity::Force, Dof::Index);

    fn group<T: Copy>(value: T, millis: u64) -> Option<Timed<PerDof<T>>> {
        let at = Moment::from_micros(millis * 1000);
        Some(Timed {
            value: PerDof::splat(value),
            asked: at,
            received: at,
        })
    }

    fn force(history: &mut History, millis: u64, grams: i16) {
        let sample = HandSample {
            force: group(ForceReading::new(grams), millis),
            ..HandSample::default()
        };
        let mut fresh = Groups::NONE;
        fresh.insert(Group::Force);
        history.push(&sample, fresh);
    }

    fn trace(history: &History, from_s: f64, to_s: f64) -> Trace {
        let mut out = Trace::default();
        history.trace(FORCE, from_s, to_s, 800, &mut out);
        out
    }

    #[test]
    fn one_spike_in_ten_minutes_is_still_seen() {
        let mut history = History::new();
        for tick in 0..HISTORY_ROWS as u64 {
            force(
                &mut history,
                tick * 5,
                if tick == 77_777 { 1234 } else { 10 },
            );
        }
        let seen = trace(&history, 0.0, 600.0);
        assert!(seen.decimated);
        assert_eq!(seen.segments.len(), 1);
        assert!(seen.points().count() <= 4 * 802);
        let peaks: Vec<_> = seen.points().filter(|point| point[1] > 1000.0).collect();
        assert_eq!(peaks.len(), 1);
        assert!((peaks[0][0] - 77_777.0 * 0.005).abs() < 1.0, "{peaks:?}");
        assert!(
            seen.points()
                .zip(seen.points().skip(1))
                .all(|(one, two)| one[0] <= two[0])
        );
    }

    #[test]
    fn a_short_window_shows_every_value() {
        let mut history = History::new();
        for tick in 0..100 {
            force(&mut history, tick * 10, 5);
        }
        let seen = trace(&history, 0.0, 1.0);
        assert!(!seen.decimated);
        assert_eq!(seen.points().count(), 100);
    }

    #[test]
    fn lost_links_and_long_silences_break_the_line_at_every_zoom() {
        let mut history = History::new();
        for tick in 0..10_000 {
            force(&mut history, tick * 5, 5);
        }
        history.gap(Moment::from_micros(50_000_000));
        for tick in 0..10_000 {
            force(&mut history, 50_200 + tick * 5, 5);
        }
        for tick in 0..10_000 {
            force(&mut history, 101_000 + tick * 5, 5);
        }
        for (from_s, to_s) in [(0.0, 600.0), (0.0, 160.0), (40.0, 110.0)] {
            let seen = trace(&history, from_s, to_s);
            assert_eq!(seen.segments.len(), 3, "{from_s}..{to_s}");
            assert!(seen.segments.iter().all(|segment| !segment.is_empty()));
            let ends = seen.segments[0].last().map(|point| point[0]);
            assert!(ends.is_some_and(|end| end <= 50.0));
        }
    }

    #[test]
    fn values_outside_the_manual_are_gaps_and_never_zero() {
        let mut history = History::new();
        for tick in 0..10 {
            force(&mut history, tick * 10, if tick == 5 { 9999 } else { 100 });
        }
        let seen = trace(&history, 0.0, 1.0);
        assert_eq!(seen.segments.len(), 2);
        assert!(seen.points().all(|point| (point[1] - 100.0).abs() < 1e-9));
    }

    #[test]
    fn a_tip_that_is_not_a_number_is_a_gap() {
        let mut history = History::new();
        let mut fresh = Groups::NONE;
        fresh.insert(Group::Tactile(Finger::Thumb));
        for (millis, normal_n) in [(0, 1.0), (30, f32::NAN), (60, 2.0)] {
            let mut block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
            block.normal_n = normal_n;
            let at = Moment::from_micros(millis * 1000);
            let mut sample = HandSample::default();
            sample.tactile[Finger::Thumb] = Some(Timed {
                value: block,
                asked: at,
                received: at,
            });
            history.push(&sample, fresh);
        }
        let mut out = Trace::default();
        history.trace(
            Series::Tip(Touch::Normal, Finger::Thumb),
            0.0,
            1.0,
            800,
            &mut out,
        );
        assert_eq!(out.segments, [vec![[0.0, 1.0]], vec![[0.06, 2.0]]]);
        history.trace(
            Series::Tip(Touch::Normal, Finger::Index),
            0.0,
            1.0,
            800,
            &mut out,
        );
        assert!(out.segments.is_empty());
    }

    #[test]
    fn only_fresh_groups_are_taken() {
        let mut history = History::new();
        let sample = HandSample {
            angle: group(AngleReading::new(5), 1),
            ..HandSample::default()
        };
        history.push(&sample, Groups::NONE);
        assert_eq!(history.last_secs(), None);
    }

    #[test]
    fn history_is_bounded_in_rows_and_memory() {
        let mut history = History::new();
        let block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
        let mut sample = HandSample::default();
        let mut fresh = Groups::NONE;
        for group in [
            Group::Angle,
            Group::Force,
            Group::Current,
            Group::Temperature,
            Group::AngleSet,
        ] {
            fresh.insert(group);
        }
        for finger in Finger::ALL {
            fresh.insert(Group::Tactile(finger));
        }
        for tick in 0..HISTORY_ROWS as u64 + 5000 {
            let at = Moment::from_micros(tick * 5000);
            sample.angle = group(AngleReading::new(1), tick * 5);
            sample.force = group(ForceReading::new(1), tick * 5);
            sample.current = group(crate::hand::CurrentReading::new(1), tick * 5);
            sample.temperature = group(crate::hand::TemperatureReading::new(1), tick * 5);
            sample.angle_set = group(None, tick * 5);
            sample.tactile = PerFinger::splat(Some(Timed {
                value: block,
                asked: at,
                received: at,
            }));
            history.push(&sample, fresh);
        }
        assert!(history.bytes() <= 40_000_000, "{}", history.bytes());
        assert!(
            history
                .first_secs()
                .is_some_and(|first| (first - 25.0).abs() < 0.1)
        );
    }

    #[test]
    fn marks_are_bounded_and_found_by_time() {
        let mut history = History::new();
        for second in 0..2000 {
            history.mark(Moment::from_micros(second * 1_000_000), MarkKind::Stop);
        }
        assert_eq!(history.marks(0.0, 2000.0).count(), MARKS_MAX);
        assert_eq!(history.marks(1990.0, 1994.0).count(), 5);
    }
}
