//! What was read during one trial, row by row as it came, and what happened between. Computes nothing.

pub mod csv;

use crate::hand::{Dof, Group, Groups, HandSample, Moment, PerDof, PerFinger, Timed};

/// Rows of one recording: minutes at the rate of the fastest wire. Rows past it are counted, not kept.
pub const ROWS_MAX: usize = 200_000;

/// One answer of the hand. What it did not hold is `None`; raw numbers are kept as they came.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SampleRow {
    /// When the reply was there.
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
    /// The fingertips that this answer held.
    pub tips: PerFinger<Option<TipSample>>,
}

/// What one fingertip said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipSample {
    /// Normal force, N; `None` if it was no finite number.
    pub normal_n: Option<f32>,
    /// Tangential force, N.
    pub tangential_n: Option<f32>,
    /// Direction of the tangential force, degrees; `None` without contact.
    pub direction_deg: Option<u16>,
    /// Proximity, counts.
    pub proximity: i32,
}

/// Something that happened during a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrialMark {
    /// When it was given to the link, or seen.
    pub at: Moment,
    pub what: TrialEvent,
}

/// What may happen during a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrialEvent {
    /// The joints were sent to their starts.
    Prepare,
    /// Speed and threshold were set.
    Limits,
    /// The closing command.
    Close,
    /// A joint went on slowly.
    Slow(Dof),
    /// All joints stood still: the dwell began.
    Stopped,
    /// The joints did not stop in time: the dwell began all the same.
    NotStopped,
    /// The opening command.
    Release,
    /// All joints were back at their starts.
    Released,
    /// It was ended early.
    Aborted,
}

impl TrialEvent {
    /// Stable lower-case name for files and JSON.
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

/// One trial as it was read, oldest row first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrialRecording {
    rows: Vec<SampleRow>,
    marks: Vec<TrialMark>,
    lost: u64,
}

impl TrialRecording {
    /// Keeps what is fresh in a sample.
    pub fn push(&mut self, sample: &HandSample, fresh: Groups) {
        let row = row(sample, fresh);
        if row.at == Moment::ZERO {
            return;
        }
        self.push_row(row);
    }

    /// Keeps one row. Rows come in the order of time.
    pub fn push_row(&mut self, row: SampleRow) {
        if self.rows.len() >= ROWS_MAX {
            self.lost += 1;
            return;
        }
        self.rows.push(row);
    }

    /// Keeps what happened.
    pub fn mark(&mut self, at: Moment, what: TrialEvent) {
        self.marks.push(TrialMark { at, what });
    }

    /// The same with its events and without its rows, which count as lost.
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

    /// All that happened.
    pub fn marks(&self) -> &[TrialMark] {
        &self.marks
    }

    /// When something happened first.
    pub fn when(&self, what: TrialEvent) -> Option<Moment> {
        let mark = self.marks.iter().find(|mark| mark.what == what);
        mark.map(|mark| mark.at)
    }

    /// Rows that had no place any more.
    pub const fn lost(&self) -> u64 {
        self.lost
    }

    /// The moment that times in files are counted from: the closing command, or the first row where none was given.
    pub fn zero(&self) -> Moment {
        let first = self.rows.first().map(|row| row.at);
        self.when(TrialEvent::Close).or(first).unwrap_or_default()
    }
}

/// Seconds from one moment to another, negative if it is earlier.
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
