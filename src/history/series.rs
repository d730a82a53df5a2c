//! The whole history of one hand: assigns readings to lines. The sibling modules store the lines.

use crate::hand::column::{channel_column, joint_column, tip_column};
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, PerDof, Quantity, Timed, Touch};
use crate::history::mark::{Mark, MarkKind, Marks};
use crate::history::reading::{Reading, Summary};
use crate::history::status::{StatusRun, StatusRuns};
use crate::history::table::{Table, TableGroup};
use crate::history::trace::Trace;
use crate::history::track::{HistoryTrack, Slice};
use crate::record::WrittenMemory;
use crate::record::file::overview::{OverviewRow, joint_line, tip_line};
use std::collections::BTreeSet;

/// The longest time window of the plots.
pub const HISTORY_SECONDS: u32 = 3600;
/// Maximum rows of each group: an hour at 200 Hz, the maximum rate of a serial line; a faster link holds less time. Takes about
/// 80 MB with an hour at 100 Hz and fingertips at 30 Hz, and 230 MB when all are full.
pub const HISTORY_ROWS: usize = 200 * HISTORY_SECONDS as usize;
/// Maximum rows of the fingertips' channels: ten minutes at 30 Hz, in about 6 MB for all five fingertips.
pub const CHANNEL_ROWS: usize = 30 * 600;
/// Number of channels of a fingertip.
const CHANNELS: usize = 8;
/// Gap between samples after which measured lines break, and the state of the drives is unknown.
const GAP_AFTER_S: f64 = 0.5;
/// Gap after which lines of targets break; they are read about twice a second.
const TARGET_GAP_AFTER_S: f64 = 3.0;

/// Number of tracks: one for each quantity of the joints, one for both forces of each fingertip, one for the channels of each.
const TRACKS: usize = FIRST_CHANNELS + Finger::ALL.len();
const FIRST_TIP: usize = Quantity::ALL.len();
const FIRST_CHANNELS: usize = FIRST_TIP + Finger::ALL.len();

/// One line of a plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Series {
    Joint(Quantity, Dof),
    /// Force of a fingertip.
    Tip(Touch, Finger),
    /// Counts of one of the eight channels of a fingertip, from 0; limited to [`CHANNEL_ROWS`].
    Channel(u8, Finger),
}

impl Series {
    /// Header of its column in a table: quantity, part, unit. Stable.
    pub fn column_name(self) -> String {
        match self {
            Self::Joint(quantity, dof) => joint_column(quantity, dof),
            Self::Tip(touch, finger) => tip_column(touch, finger),
            Self::Channel(channel, finger) => channel_column(channel, finger),
        }
    }

    /// Index of its track.
    const fn track(self) -> usize {
        match self {
            Self::Joint(quantity, _) => quantity as usize,
            Self::Tip(_, finger) => FIRST_TIP + finger.index(),
            Self::Channel(_, finger) => FIRST_CHANNELS + finger.index(),
        }
    }

    /// Index within its track.
    const fn place(self) -> usize {
        match self {
            Self::Joint(_, dof) => dof.index(),
            Self::Tip(touch, _) => touch as usize,
            Self::Channel(channel, _) => channel as usize,
        }
    }
}

/// Measurements of the last minutes, by time of receipt.
#[derive(Debug, Clone)]
pub struct History {
    /// Indexed by [`Series::track`].
    tracks: Vec<HistoryTrack>,
    /// The newest targets, as sent or as read back.
    targets: PerDof<Option<f32>>,
    sent_at: Option<Moment>,
    status: StatusRuns,
    marks: Marks,
}

impl Default for History {
    fn default() -> Self {
        Self::new()
    }
}

/// Creates the empty track with this index.
fn empty_track(number: usize) -> HistoryTrack {
    let of_targets = Quantity::TargetAngle as usize;
    let gap_after_s = if number == of_targets {
        TARGET_GAP_AFTER_S
    } else {
        GAP_AFTER_S
    };
    let (quantities, rows) = match number {
        ..FIRST_TIP => (Dof::ALL.len(), HISTORY_ROWS),
        FIRST_TIP..FIRST_CHANNELS => (Touch::ALL.len(), HISTORY_ROWS),
        _ => (CHANNELS, CHANNEL_ROWS),
    };
    HistoryTrack::new(number, quantities, rows, gap_after_s)
}

impl History {
    pub fn new() -> Self {
        Self {
            tracks: (0..TRACKS).map(empty_track).collect(),
            targets: PerDof::splat(None),
            sent_at: None,
            status: StatusRuns::new(GAP_AFTER_S),
            marks: Marks::default(),
        }
    }

    /// Adds the fresh groups of a sample. Undocumented values are stored as unknown.
    pub fn push(&mut self, sample: &HandSample, fresh: Groups) {
        for quantity in Quantity::ALL {
            let Some(six) = quantity
                .documented(sample)
                .filter(|_| fresh.contains(quantity.group()))
            else {
                continue;
            };
            let six = Timed {
                value: six.value.map(|value| value.map(f32::from)),
                asked: six.asked,
                received: six.received,
            };
            match quantity {
                Quantity::TargetAngle => self.read_back(&six),
                _ => self.add(quantity as usize, six.received, six.value.as_array()),
            }
        }
        self.push_status(sample, fresh);
        for (finger, block) in sample.tactile.iter() {
            let Some(block) = block.filter(|_| fresh.contains(Group::Tactile(finger))) else {
                continue;
            };
            let finite = |value: Option<f32>| value.filter(|value| value.is_finite());
            let forces = [block.value.normal(), block.value.tangential()].map(finite);
            self.add(FIRST_TIP + finger.index(), block.received, &forces);
            #[expect(
                clippy::cast_precision_loss,
                reason = "exact below 16.7 million counts"
            )]
            let counts = block.value.raw.map(|raw| Some(raw as f32));
            self.add(FIRST_CHANNELS + finger.index(), block.received, &counts);
        }
    }

    /// Adds the drives' state, stamped with the newer of status and faults.
    fn push_status(&mut self, sample: &HandSample, fresh: Groups) {
        let status = sample.status.filter(|_| fresh.contains(Group::Status));
        let faults = sample.faults.filter(|_| fresh.contains(Group::Faults));
        let received = [
            status.map(|status| status.received),
            faults.map(|faults| faults.received),
        ];
        if let Some(at) = received.into_iter().flatten().max() {
            self.status.push(at.secs(), |dof| {
                let status = sample.status.map(|status| status.value[dof]);
                (status, sample.faults.map(|faults| faults.value[dof]))
            });
        }
    }

    fn add(&mut self, track: usize, at: Moment, values: &[Option<f32>]) {
        if let Some(track) = self.tracks.get_mut(track) {
            track.push(at.secs(), values.iter().copied());
        }
    }

    /// Adds targets read from the hand. Targets requested before the newest write are outdated and ignored.
    fn read_back(&mut self, targets: &Timed<PerDof<Option<f32>>>) {
        if self.sent_at.is_none_or(|sent| targets.asked > sent) {
            self.targets = targets.value;
            self.add_targets(targets.received, &targets.value);
        }
    }

    fn add_targets(&mut self, at: Moment, targets: &PerDof<Option<f32>>) {
        self.add(Quantity::TargetAngle as usize, at, targets.as_array());
    }

    /// Adds a write that left for the hand: targets step at the moment they were sent.
    pub fn sent(&mut self, at: Moment, write: &WrittenMemory) {
        let before = self.targets;
        for (dof, angle) in write.angle_targets().iter() {
            if let Some(angle) = angle {
                self.targets[dof] = Some(f32::from(angle.get()));
            }
        }
        if self.targets != before {
            self.sent_at = Some(at);
            self.add_targets(at, &before);
            self.add_targets(at, &self.targets.clone());
        }
    }

    /// Adds one second of a recording's overview: the minima at its start, the maxima half a second later.
    pub fn overview(&mut self, row: &OverviewRow) {
        let at = |part: u64| Moment::from_micros(u64::from(row.second) * 1_000_000 + part);
        let known = |value: f32| Some(value).filter(|value| !value.is_nan());
        for (values, at) in [(&row.least, at(0)), (&row.greatest, at(500_000))] {
            let value = |line: usize| values.get(line).copied().and_then(known);
            for quantity in Quantity::ALL {
                let six = Dof::ALL.map(|dof| value(joint_line(quantity, dof)));
                if six.iter().any(Option::is_some) {
                    self.add(quantity as usize, at, &six);
                }
            }
            for finger in Finger::ALL {
                let both = Touch::ALL.map(|touch| value(tip_line(touch, finger)));
                if both.iter().any(Option::is_some) {
                    self.add(FIRST_TIP + finger.index(), at, &both);
                }
            }
        }
    }

    /// Breaks all lines, because the link was lost.
    pub fn gap(&mut self, at: Moment) {
        (self.targets, self.sent_at) = (PerDof::splat(None), None);
        self.status.gap();
        for track in &mut self.tracks {
            track.gap(at.secs());
        }
    }

    /// Adds a mark.
    pub fn mark(&mut self, at: Moment, kind: MarkKind) {
        self.marks.push(Mark { at, kind });
    }

    pub fn remove_mark(&mut self, mark: &Mark) {
        self.marks.remove(mark);
    }

    /// The marks in a time range, oldest first.
    pub fn marks(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Mark> {
        self.marks.between(from_s, to_s)
    }

    /// Status and faults of a drive in a time range, oldest first. Seconds added by [`Self::overview`] have none.
    pub fn status(&self, dof: Dof, from_s: f64, to_s: f64) -> impl Iterator<Item = &StatusRun> {
        self.status.between(dof, from_s, to_s)
    }

    /// Fills `out` with one line over `columns` columns of pixels: at most about two points per column, with all extremes
    /// preserved. The work grows with the columns, not with the history.
    pub fn trace(&self, series: Series, from_s: f64, to_s: f64, columns: usize, out: &mut Trace) {
        let slice = Slice {
            from_s,
            to_s,
            columns: u32::try_from(columns).unwrap_or(u32::MAX).max(1),
        };
        match self.track(series) {
            Some(track) => track.trace(series.place(), slice, out),
            None => out.begin(),
        }
    }

    /// The measurement nearest to a time; `None` in a gap and before the first. The newest one stays valid until the gap limit.
    pub fn reading(&self, series: Series, at_s: f64) -> Option<Reading> {
        self.track(series)?.reading(series.place(), at_s)
    }

    /// Summary of all measurements in a time range, both ends included; `None` if there are none. The work grows with the
    /// logarithm of their number.
    pub fn summary(&self, series: Series, from_s: f64, to_s: f64) -> Option<Summary> {
        self.track(series)?.summary(series.place(), from_s, to_s)
    }

    /// Copies all measurements of some lines in a time range, with the marks there.
    pub fn table(&self, series: &[Series], from_s: f64, to_s: f64) -> Table {
        let numbers: BTreeSet<usize> = series.iter().map(|one| one.track()).collect();
        let groups = numbers.into_iter().filter_map(|number| {
            let track = self.tracks.get(number)?;
            let rows = track.rows_within(from_s, to_s);
            let own = series.iter().filter(|one| one.track() == number);
            let column = |one: &Series| {
                let values = rows.clone().filter_map(|row| track.value(one.place(), row));
                (one.column_name(), values.collect())
            };
            Some(TableGroup {
                columns: own.map(column).collect(),
                times: rows.filter_map(|row| track.time_s(row)).collect(),
            })
        });
        let mark = |mark: &Mark| (mark.at.secs(), mark.kind.words());
        let marks = self.marks(from_s, to_s).map(mark);
        Table::new(groups.collect(), marks.collect())
    }

    /// Memory held by the channels of the fingertips, in bytes.
    #[cfg(test)]
    pub(crate) fn channel_bytes(&self) -> usize {
        let channels = self.tracks.iter().skip(FIRST_CHANNELS);
        channels.map(HistoryTrack::bytes).sum()
    }

    /// An independent copy of a time range: all measurements except the channels, and the marks; no drive status. The work grows
    /// with their number.
    pub fn slice(&self, from_s: f64, to_s: f64) -> Self {
        let tracks = self.tracks.iter().take(FIRST_CHANNELS);
        let tracks = tracks.map(|track| track.slice(from_s, to_s));
        let mut marks = Marks::default();
        for mark in self.marks(from_s, to_s) {
            marks.push(mark.clone());
        }
        Self {
            tracks: tracks
                .chain((FIRST_CHANNELS..TRACKS).map(empty_track))
                .collect(),
            targets: self.targets,
            sent_at: self.sent_at,
            status: StatusRuns::new(GAP_AFTER_S),
            marks,
        }
    }

    /// Number of measurements of some lines in a time range; copies nothing.
    pub fn rows(&self, series: &[Series], from_s: f64, to_s: f64) -> usize {
        let numbers: BTreeSet<usize> = series.iter().map(|one| one.track()).collect();
        let tracks = numbers
            .into_iter()
            .filter_map(|number| self.tracks.get(number));
        tracks
            .map(|track| track.rows_within(from_s, to_s).len())
            .sum()
    }

    /// Time of the oldest held measurement, in seconds.
    pub fn first_secs(&self) -> Option<f64> {
        self.tracks
            .iter()
            .filter_map(HistoryTrack::first_s)
            .reduce(f64::min)
    }

    /// Time of the newest measurement, in seconds.
    #[cfg(test)]
    pub(crate) fn last_secs(&self) -> Option<f64> {
        self.tracks
            .iter()
            .filter_map(HistoryTrack::last_s)
            .reduce(f64::max)
    }

    /// Memory held, in bytes.
    pub fn bytes(&self) -> usize {
        self.tracks.iter().map(HistoryTrack::bytes).sum()
    }

    fn track(&self, series: Series) -> Option<&HistoryTrack> {
        self.tracks.get(series.track())
    }
}
