//! The readings of one trial, row by row as they arrived, and its events. Computes nothing.

pub mod csv;

use crate::hand::{Dof, Group, Groups, HandSample, Moment, PerDof, PerFinger, Timed};

/// Maximum number of rows: minutes at the rate of the fastest wire. Further rows are counted and dropped.
pub const ROWS_MAX: usize = 200_000;

/// One reply of the hand. Values it did not contain are `None`; raw numbers are unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SampleRow {
    /// Time of arrival.
    pub at: Moment,
    /// ANGLE_ACT.
    pub angle: Option<PerDof<i16>>,
    /// FORCE_ACT, g.
    pub force: Option<PerDof<i16>>,
    /// CURRENT, mA.
    pub current: Option<PerDof<i16>>,
    pub status: Option<PerDof<u8>>,
    /// ERROR.
    pub faults: Option<PerDof<u8>>,
    /// TEMP, °C.
    pub temperature: Option<PerDof<u8>>,
    /// The fingertips in this reply.
    pub tips: PerFinger<Option<TipSample>>,
}

/// Readings of one fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipSample {
    /// Normal force, N; `None` if it was not a finite number.
    pub normal_n: Option<f32>,
    /// Tangential force, N.
    pub tangential_n: Option<f32>,
    /// Direction of the tangential force, degrees; `None` without contact.
    pub direction_deg: Option<u16>,
    /// Proximity, counts.
    pub proximity: i32,
}

/// An event of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrialMark {
    /// Time at which it was handed to the link, or observed.
    pub at: Moment,
    pub what: TrialEvent,
}

/// Kinds of events in a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialEvent {
    /// The joints were sent to their starts.
    Prepare,
    /// Speed and threshold were set.
    Limits,
    /// The closing command.
    Close,
    /// A joint continued slowly.
    Slow(Dof),
    /// All joints were still: the dwell began.
    Stopped,
    /// The joints did not stop in time: the dwell began regardless.
    NotStopped,
    /// The opening command.
    Release,
    /// All joints were back at their starts.
    Released,
    /// The trial ended early.
    Aborted,
}

impl TrialEvent {
    /// Stable lower-case name in files and JSON.
    pub fn name(self) -> String {
        match self {
            Self::Prepare => "prepare".into(),
            Self::Limits => "limits".into(),
            Self::Close => "close".into(),
            Self::Slow(dof) => format!("slow_{}", dof.name()),
            Self::Stopped => "stopped".into(),
            Self::NotStopped => "not_stopped".into(),
            Self::Release => "release".into(),
            Self::Released => "released".into(),
            Self::Aborted => "aborted".into(),
        }
    }
}

/// The readings of one trial, oldest row first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrialRecording {
    rows: Vec<SampleRow>,
    marks: Vec<TrialMark>,
    lost: u64,
}

impl TrialRecording {
    /// Appends the fresh values of a sample.
    pub fn push(&mut self, sample: &HandSample, fresh: Groups) {
        let row = row(sample, fresh);
        if row.at == Moment::ZERO {
            return;
        }
        self.push_row(row);
    }

    /// Appends a row; rows come in order of time.
    pub fn push_row(&mut self, row: SampleRow) {
        if self.rows.len() >= ROWS_MAX {
            self.lost += 1;
            return;
        }
        self.rows.push(row);
    }

    /// Appends an event.
    pub fn mark(&mut self, at: Moment, what: TrialEvent) {
        self.marks.push(TrialMark { at, what });
    }

    /// A copy with its events and without its rows, which count as lost.
    pub fn without_rows(&self) -> Self {
        let rows = u64::try_from(self.rows.len()).unwrap_or(u64::MAX);
        Self {
            rows: Vec::new(),
            marks: self.marks.clone(),
            lost: self.lost.saturating_add(rows),
        }
    }

    pub fn rows(&self) -> &[SampleRow] {
        &self.rows
    }

    pub fn marks(&self) -> &[TrialMark] {
        &self.marks
    }

    /// Time of the first event of this kind.
    pub fn when(&self, what: TrialEvent) -> Option<Moment> {
        let mark = self.marks.iter().find(|mark| mark.what == what);
        mark.map(|mark| mark.at)
    }

    /// Rows dropped for lack of space.
    pub const fn lost(&self) -> u64 {
        self.lost
    }

    /// The zero of times in files: the closing command, or the first row if there was none.
    pub fn zero(&self) -> Moment {
        let first = self.rows.first().map(|row| row.at);
        self.when(TrialEvent::Close).or(first).unwrap_or_default()
    }
}

/// Seconds from `zero` to `at`, negative if `at` is earlier.
pub fn seconds(zero: Moment, at: Moment) -> f64 {
    at.since(zero).as_secs_f64() - zero.since(at).as_secs_f64()
}

fn row(sample: &HandSample, fresh: Groups) -> SampleRow {
    let mut row = SampleRow::default();
    let at = &mut row.at;
    row.angle = news(sample.angle, Group::Angle, fresh, at).map(|six| six.map(|v| v.raw()));
    row.force = news(sample.force, Group::Force, fresh, at).map(|six| six.map(|v| v.raw()));
    row.current = news(sample.current, Group::Current, fresh, at).map(|six| six.map(|v| v.raw()));
    row.status = news(sample.status, Group::Status, fresh, at).map(|six| six.map(|v| v.raw()));
    row.faults = news(sample.faults, Group::Faults, fresh, at).map(|six| six.map(|v| v.raw()));
    row.temperature =
        news(sample.temperature, Group::Temperature, fresh, at).map(|six| six.map(|v| v.raw()));
    row.tips = PerFinger::from_fn(|finger| {
        let block = news(sample.tactile[finger], Group::Tactile(finger), fresh, at)?;
        Some(TipSample {
            normal_n: block.normal(),
            tangential_n: block.tangential(),
            direction_deg: block.direction_deg(),
            proximity: block.proximity,
        })
    });
    row
}

fn news<T>(group: Option<Timed<T>>, name: Group, fresh: Groups, at: &mut Moment) -> Option<T> {
    let group = group.filter(|_| fresh.contains(name))?;
    *at = (*at).max(group.received);
    Some(group.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::AngleReading;
    use crate::trials::recording::csv;

    #[test]
    fn only_what_is_fresh_is_kept_and_the_rest_is_an_empty_cell() {
        let at = Moment::from_micros(2_000_000);
        let sample = HandSample {
            angle: Some(Timed {
                value: PerDof::splat(AngleReading::new(512)),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        };
        let mut fresh = Groups::NONE;
        let mut recording = TrialRecording::default();
        recording.push(&sample, fresh);
        assert!(recording.rows().is_empty(), "nothing is new");
        fresh.insert(Group::Angle);
        recording.push(&sample, fresh);
        recording.mark(Moment::from_micros(2_500_000), TrialEvent::Close);
        let csv = csv::write(&recording);
        let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
        assert!(lines.iter().all(|cells| cells.len() == 1 + 36 + 20 + 1));
        let column = |name: &str| lines[0].iter().position(|cell| *cell == name).unwrap();
        assert_eq!(lines[1][0], "-0.500000");
        assert_eq!(lines[1][column("angle_index")], "512");
        assert_eq!(lines[1][column("force_g_index")], "");
        assert_eq!(lines[2][0], "0.000000");
        assert_eq!(lines[2][column("event")], "close");
    }

    #[test]
    fn rows_past_the_limit_are_counted() {
        let mut recording = TrialRecording::default();
        for _ in 0..ROWS_MAX + 3 {
            recording.push_row(SampleRow::default());
        }
        assert_eq!((recording.rows().len(), recording.lost()), (ROWS_MAX, 3));
    }
}
