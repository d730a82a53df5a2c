//! The whole history of one hand: which reading goes to which line. How lines are kept is told in the siblings.

use crate::app::history::mark::{Mark, MarkKind, Marks};
use crate::app::history::reading::{Reading, Spread, Summary};
use crate::app::history::table::{Table, TableGroup};
use crate::app::history::trace::Trace;
use crate::app::history::track::{Slice, Track};
use crate::hand::{
    Dof, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger, Target, Timed,
};

/// The longest window of the plots.
pub const HISTORY_SECONDS: u32 = 3600;
/// Rows kept of each group: an hour at 200 Hz, the most a serial line carries; a faster link holds less time. About
/// 80 MB with an hour at 100 Hz and fingertips at 30 Hz, and 230 MB when all are full.
pub const HISTORY_ROWS: usize = 200 * HISTORY_SECONDS as usize;
/// Rows kept of the fingertips' channels: ten minutes at 30 Hz, in about 6 MB for all five fingertips.
pub const CHANNEL_ROWS: usize = 30 * 600;
/// Channels of a fingertip.
const CHANNELS: usize = 8;
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

impl Touch {
    /// All, in the order of the variants.
    pub const ALL: [Self; 2] = [Self::Normal, Self::Tangential];
}

/// One line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Series {
    /// Of a joint.
    Joint(Quantity, Dof),
    /// Of a fingertip.
    Tip(Touch, Finger),
    /// Counts of one of the eight channels of a fingertip, from 0; kept for [`CHANNEL_ROWS`] only.
    Channel(u8, Finger),
}

impl Series {
    /// The head of its column in a table: what, of which part, unit. Stable.
    #[must_use]
    pub fn column_name(self) -> String {
        let (what, part, unit) = match self {
            Self::Channel(channel, finger) => {
                return format!("channel_{}_{}", channel + 1, finger.name());
            }
            Self::Joint(Quantity::Angle, dof) => ("angle", dof.name(), ""),
            Self::Joint(Quantity::Force, dof) => ("force", dof.name(), "_g"),
            Self::Joint(Quantity::Current, dof) => ("current", dof.name(), "_mA"),
            Self::Joint(Quantity::Temperature, dof) => ("temperature", dof.name(), "_C"),
            Self::Joint(Quantity::TargetAngle, dof) => ("target_angle", dof.name(), ""),
            Self::Tip(Touch::Normal, finger) => ("normal", finger.name(), "_N"),
            Self::Tip(Touch::Tangential, finger) => ("tangential", finger.name(), "_N"),
        };
        format!("{what}_{part}{unit}")
    }

    /// Which row of times it is on, and its place there.
    const fn place(self) -> (u8, usize) {
        match self {
            Self::Joint(_, dof) => (self.track(), dof.index()),
            Self::Tip(Touch::Normal, _) => (self.track(), 0),
            Self::Tip(Touch::Tangential, _) => (self.track(), 1),
            Self::Channel(channel, _) => (self.track(), channel as usize),
        }
    }

    /// Tells the rows of times apart.
    const fn track(self) -> u8 {
        match self {
            Self::Joint(Quantity::Angle, _) => 0,
            Self::Joint(Quantity::Force, _) => 1,
            Self::Joint(Quantity::Current, _) => 2,
            Self::Joint(Quantity::Temperature, _) => 3,
            Self::Joint(Quantity::TargetAngle, _) => 4,
            Self::Tip(_, Finger::Little) => 5,
            Self::Tip(_, Finger::Ring) => 6,
            Self::Tip(_, Finger::Middle) => 7,
            Self::Tip(_, Finger::Index) => 8,
            Self::Tip(_, Finger::Thumb) => 9,
            Self::Channel(_, Finger::Little) => 10,
            Self::Channel(_, Finger::Ring) => 11,
            Self::Channel(_, Finger::Middle) => 12,
            Self::Channel(_, Finger::Index) => 13,
            Self::Channel(_, Finger::Thumb) => 14,
        }
    }
}

fn channels(finger: Finger) -> Box<Track> {
    let number = Series::Channel(0, finger).track();
    Box::new(Track::new(number, CHANNELS, CHANNEL_ROWS, GAP_AFTER_S))
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
    channels: PerFinger<Box<Track>>,
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
        let joints = |quantity: Quantity, gap_after_s| {
            let number = Series::Joint(quantity, Dof::Index).track();
            Track::new(number, Dof::ALL.len(), HISTORY_ROWS, gap_after_s)
        };
        let tip = |finger| {
            let number = Series::Tip(Touch::Normal, finger).track();
            Box::new(Track::new(
                number,
                Touch::ALL.len(),
                HISTORY_ROWS,
                GAP_AFTER_S,
            ))
        };
        Self {
            angle: joints(Quantity::Angle, GAP_AFTER_S),
            force: joints(Quantity::Force, GAP_AFTER_S),
            current: joints(Quantity::Current, GAP_AFTER_S),
            temperature: joints(Quantity::Temperature, GAP_AFTER_S),
            target: joints(Quantity::TargetAngle, TARGET_GAP_AFTER_S),
            tips: PerFinger::from_fn(tip),
            channels: PerFinger::from_fn(channels),
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
                let finite = |value: Option<f32>| value.filter(|value| value.is_finite());
                let values = [
                    finite(block.value.normal()),
                    finite(block.value.tangential()),
                ];
                self.tips[finger].push(block.received.secs(), values);
                #[expect(
                    clippy::cast_precision_loss,
                    reason = "exact below 16.7 million counts"
                )]
                let counts = block.value.raw.map(|raw| Some(raw as f32));
                self.channels[finger].push(block.received.secs(), counts);
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
        for (_, track) in self.tips.iter_mut().chain(self.channels.iter_mut()) {
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
        self.track(series).trace(
            series.place().1,
            Slice {
                from_s,
                to_s,
                columns,
            },
            out,
        );
    }

    /// The measurement nearest to a time; `None` in a gap.
    #[must_use]
    pub fn reading(&self, series: Series, at_s: f64) -> Option<Reading> {
        self.track(series).reading(series.place().1, at_s)
    }

    /// What all measurements of a stretch of time come to, both ends included; `None` if there is none. The work grows
    /// with the logarithm of their number.
    #[must_use]
    pub fn summary(&self, series: Series, from_s: f64, to_s: f64) -> Option<Summary> {
        self.track(series).summary(series.place().1, from_s, to_s)
    }

    /// A copy of all measurements of some lines over a stretch of time, with the marks there.
    #[must_use]
    pub fn table(&self, series: &[Series], from_s: f64, to_s: f64) -> Table {
        let mut tracks: Vec<u8> = series.iter().map(|one| one.track()).collect();
        tracks.sort_unstable();
        tracks.dedup();
        let groups = tracks.into_iter().filter_map(|number| {
            let own = || series.iter().filter(move |one| one.track() == number);
            let track = self.track(*own().next()?);
            let rows = track.rows_within(from_s, to_s);
            let column = |one: &Series| {
                let place = one.place().1;
                let values = rows.clone().filter_map(|row| track.value(place, row));
                (one.column_name(), values.collect())
            };
            Some(TableGroup {
                times: rows.clone().filter_map(|row| track.time_s(row)).collect(),
                columns: own().map(column).collect(),
            })
        });
        let marks = self.marks(from_s, to_s);
        Table::new(
            groups.collect(),
            marks
                .map(|mark| (mark.at.secs(), mark.kind.words()))
                .collect(),
        )
    }

    /// Mean and standard deviation of a stretch of time; `None` below two values. The work grows with their number.
    #[must_use]
    pub fn spread(&self, series: Series, from_s: f64, to_s: f64) -> Option<Spread> {
        let (track, place) = (self.track(series), series.place().1);
        let values = track
            .rows_within(from_s, to_s)
            .filter_map(|row| track.value(place, row));
        Spread::of(values.filter(|value| !value.is_nan()).map(f64::from))
    }

    /// Memory held by the channels of the fingertips, in bytes.
    #[must_use]
    pub fn channel_bytes(&self) -> usize {
        self.channels.iter().map(|(_, track)| track.bytes()).sum()
    }

    /// A copy of a stretch of time that stays as it is: all measurements but the channels, and marks. The work grows with their number.
    #[must_use]
    pub fn slice(&self, from_s: f64, to_s: f64) -> Self {
        let cut = |track: &Track| track.slice(from_s, to_s);
        let mut marks = Marks::default();
        for mark in self.marks(from_s, to_s) {
            marks.push(mark.clone());
        }
        Self {
            angle: cut(&self.angle),
            force: cut(&self.force),
            current: cut(&self.current),
            temperature: cut(&self.temperature),
            target: cut(&self.target),
            tips: PerFinger::from_fn(|finger| Box::new(cut(&self.tips[finger]))),
            channels: PerFinger::from_fn(channels),
            marks,
        }
    }

    /// Measurements of some lines over a stretch of time, without copying them.
    #[must_use]
    pub fn rows(&self, series: &[Series], from_s: f64, to_s: f64) -> usize {
        let mut tracks: Vec<Series> = series.to_vec();
        tracks.sort_unstable_by_key(|one| one.track());
        tracks.dedup_by_key(|one| one.track());
        let rows = |one: &Series| self.track(*one).rows_within(from_s, to_s).len();
        tracks.iter().map(rows).sum()
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

    fn track(&self, series: Series) -> &Track {
        match series {
            Series::Joint(quantity, _) => self.joint(quantity),
            Series::Tip(_, finger) => self.tips[finger].as_ref(),
            Series::Channel(_, finger) => self.channels[finger].as_ref(),
        }
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
        let tips = self.tips.iter().chain(self.channels.iter());
        let tips = tips.map(|(_, track)| track.as_ref());
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
