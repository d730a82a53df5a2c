//! Summary of a recording file that is available without reading it whole: minimum and maximum of each quantity for each second,
//! events, and counts. The writer stores it a minute at a time; a reader recomputes missing parts.

use crate::hand::{
    Dof, Fault, Faults, Finger, Group, Groups, HandSample, Moment, PerDof, Quantity, Touch,
};
use crate::record::file::format::cdr;
use crate::record::{Entry, Event, EventKind, LinkState, Record};
use serde::{Deserialize, Serialize};

/// Number of quantities of a row: those of the six joints, and both forces of the five fingertips.
pub const LINES: usize =
    Quantity::ALL.len() * Dof::ALL.len() + Touch::ALL.len() * Finger::ALL.len();
/// Maximum number of marks of one file: more than the user reads, and a bound for a damaged file.
pub const MARKS_MAX: usize = 100_000;
/// Maximum number of seconds of one file: two days, in 56 MB; a longer one is drawn without its end.
pub const SECONDS_MAX: usize = 2 * 86_400;

/// Minimum and maximum of all quantities over one second; NaN if unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverviewRow {
    /// The second, in whole seconds of a moment.
    pub second: u32,
    pub least: [f32; LINES],
    pub greatest: [f32; LINES],
}

impl OverviewRow {
    const fn empty(second: u32) -> Self {
        Self {
            second,
            least: [f32::NAN; LINES],
            greatest: [f32::NAN; LINES],
        }
    }

    fn push(&mut self, line: usize, value: f32) {
        if let Some(least) = self.least.get_mut(line) {
            *least = least.min(value);
        }
        if let Some(greatest) = self.greatest.get_mut(line) {
            *greatest = greatest.max(value);
        }
    }

    fn merge(&mut self, other: &Self) {
        let both = self.least.iter_mut().zip(other.least);
        both.for_each(|(own, other)| *own = own.min(other));
        let both = self.greatest.iter_mut().zip(other.greatest);
        both.for_each(|(own, other)| *own = own.max(other));
    }
}

/// Index of a joint's quantity in a row.
pub const fn joint_line(quantity: Quantity, dof: Dof) -> usize {
    quantity as usize * Dof::ALL.len() + dof.index()
}

/// Index of a fingertip's quantity in a row.
pub const fn tip_line(touch: Touch, finger: Finger) -> usize {
    Quantity::ALL.len() * Dof::ALL.len() + touch as usize * Finger::ALL.len() + finger.index()
}

/// Number of entries by kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Replies with the angles of the joints.
    pub states: u64,
    /// Blocks of fingertips; five are a sweep.
    pub touch_blocks: u64,
    /// Writes that left for the hand.
    pub writes: u64,
    /// New faults.
    pub faults: u64,
    /// Notes by the user.
    pub notes: u64,
    /// Entries that the recorder lost.
    pub missing: u64,
}

impl Counts {
    /// Whole sweeps over the fingertips.
    pub const fn touch_sweeps(&self) -> u64 {
        self.touch_blocks / Finger::ALL.len() as u64
    }

    fn add(&mut self, other: Self) {
        self.states += other.states;
        self.touch_blocks += other.touch_blocks;
        self.writes += other.writes;
        self.faults += other.faults;
        self.notes += other.notes;
        self.missing += other.missing;
    }
}

/// An event, for lists and time lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileMark {
    pub at: Moment,
    pub kind: EventKind,
    pub words: String,
}

/// Summary of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overview {
    /// Ordered by time, one a second; seconds without a reading are omitted.
    pub rows: Vec<OverviewRow>,
    /// Ordered by time, at most [`MARKS_MAX`].
    pub marks: Vec<FileMark>,
    pub counts: Counts,
    faults: PerDof<u8>,
    protects: PerDof<bool>,
    state: LinkState,
    was_live: bool,
}

/// A minute of an overview as stored in a file.
#[derive(Debug, Serialize, Deserialize)]
struct OverviewBlock {
    /// Offset in the file of the first chunk that it covers.
    from: u64,
    counts: Counts,
    seconds: Vec<u32>,
    least: Vec<f32>,
    greatest: Vec<f32>,
    mark_micros: Vec<u64>,
    mark_kinds: Vec<String>,
    mark_words: Vec<String>,
}

impl Overview {
    /// Adds an entry, and returns the events that it implies.
    pub fn apply(&mut self, entry: &Entry) -> Vec<FileMark> {
        let mut derived = Vec::new();
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => {
                self.reading(sample, *fresh, &mut derived);
            }
            Entry::Heard(Record::State { at, state }) => self.state(*at, *state, &mut derived),
            Entry::Heard(Record::Sent { .. }) => self.counts.writes += 1,
            Entry::Event(event) => self.event(event),
            Entry::Heard(Record::Answered { .. } | Record::ArmRefused { .. })
            | Entry::Wire(_)
            | Entry::Link(_) => {}
        }
        for mark in &derived {
            self.mark(mark.clone());
        }
        derived
    }

    fn mark(&mut self, mark: FileMark) {
        if self.marks.len() < MARKS_MAX {
            self.marks.push(mark);
        }
    }

    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::Note => self.counts.notes += 1,
            EventKind::NoteRemoved => {
                let is_it = |mark: &FileMark| {
                    mark.kind == EventKind::Note && mark.at == event.at && mark.words == event.words
                };
                if let Some(place) = self.marks.iter().position(is_it) {
                    self.marks.remove(place);
                }
                self.counts.notes = self.counts.notes.saturating_sub(1);
                return;
            }
            EventKind::Recording => {
                let number = event
                    .words
                    .split(' ')
                    .next()
                    .and_then(|word| word.parse().ok());
                self.counts.missing += number.unwrap_or(0);
            }
            // An imported recording has them as entries, because they cannot be derived from its readings.
            EventKind::Fault => self.counts.faults += 1,
            kind if !kind.is_listed() => return,
            _ => {}
        }
        self.mark(FileMark {
            at: event.at,
            kind: event.kind,
            words: event.words.clone(),
        });
    }

    fn state(&mut self, at: Moment, state: LinkState, derived: &mut Vec<FileMark>) {
        let before = std::mem::replace(&mut self.state, state);
        let kind = match state {
            LinkState::Holding => Some(EventKind::Stop),
            LinkState::Armed => Some(EventKind::Armed),
            LinkState::Monitoring if before == LinkState::Armed => Some(EventKind::Disarmed),
            _ if before.is_live() && !state.is_live() => Some(EventKind::LinkLost),
            _ if !before.is_live() && state.is_live() && self.was_live => {
                Some(EventKind::Reconnected)
            }
            _ => None,
        };
        self.was_live |= state.is_live();
        derived.extend(kind.map(|kind| FileMark {
            at,
            kind,
            words: String::new(),
        }));
    }

    fn reading(&mut self, sample: &HandSample, fresh: Groups, derived: &mut Vec<FileMark>) {
        if fresh.contains(Group::Angle) {
            self.counts.states += 1;
        }
        for quantity in Quantity::ALL {
            let six = quantity.documented(sample);
            if let Some(six) = six.filter(|_| fresh.contains(quantity.group())) {
                for (dof, value) in six.value.iter() {
                    if let Some(value) = value {
                        let line = joint_line(quantity, dof);
                        self.value(six.received, line, f32::from(*value));
                    }
                }
            }
        }
        for (finger, block) in sample.tactile.iter() {
            let Some(block) = block.filter(|_| fresh.contains(Group::Tactile(finger))) else {
                continue;
            };
            self.counts.touch_blocks += 1;
            let both = [block.value.normal(), block.value.tangential()];
            for (touch, value) in Touch::ALL.into_iter().zip(both) {
                if let Some(value) = value {
                    self.value(block.received, tip_line(touch, finger), value);
                }
            }
        }
        self.drives(sample, fresh, derived);
    }

    /// New faults: new bits of ERROR, and protective codes of STATUS that no bit explains (manual 2.6.18, 2.6.19).
    fn drives(&mut self, sample: &HandSample, fresh: Groups, derived: &mut Vec<FileMark>) {
        let mut fault = |at: Moment, dof: Dof, what: &str| {
            derived.push(FileMark {
                at,
                kind: EventKind::Fault,
                words: format!("{}: {what}", dof.name()),
            });
        };
        if let Some(faults) = sample.faults.filter(|_| fresh.contains(Group::Faults)) {
            for dof in Dof::ALL {
                let bits = faults.value[dof].raw();
                let new = bits & !self.faults[dof];
                self.faults[dof] = bits;
                if new != 0 {
                    self.counts.faults += u64::from(new.count_ones());
                    let names: Vec<&str> = Faults::from_raw(new).iter().map(Fault::name).collect();
                    fault(faults.received, dof, &names.join(", "));
                }
            }
        }
        if let Some(statuses) = sample.status.filter(|_| fresh.contains(Group::Status)) {
            for dof in Dof::ALL {
                let status = statuses.value[dof];
                let protects = status.is_protective();
                let is_new = protects && !self.protects[dof] && self.faults[dof] == 0;
                self.protects[dof] = protects;
                if is_new {
                    self.counts.faults += 1;
                    fault(statuses.received, dof, status.name());
                }
            }
        }
    }

    fn value(&mut self, at: Moment, line: usize, value: f32) {
        let second = u32::try_from(at.micros() / 1_000_000).unwrap_or(u32::MAX);
        if let Some(row) = self.row(second) {
            row.push(line, value);
        }
    }

    /// The row of a second, which is near the end; `None` if there are too many.
    fn row(&mut self, second: u32) -> Option<&mut OverviewRow> {
        let place = self.rows.partition_point(|row| row.second < second);
        if self.rows.get(place).is_none_or(|row| row.second != second) {
            if self.rows.len() >= SECONDS_MAX {
                return None;
            }
            if self.rows.len() == self.rows.capacity() {
                // By half instead of doubling, so that the maximum is never exceeded.
                let room = (self.rows.len() / 2).max(64);
                self.rows
                    .reserve_exact(room.min(SECONDS_MAX - self.rows.len()));
            }
            self.rows.insert(place, OverviewRow::empty(second));
        }
        self.rows.get_mut(place)
    }

    /// The first and the last second with a reading.
    pub fn seconds(&self) -> Option<(u32, u32)> {
        Some((self.rows.first()?.second, self.rows.last()?.second))
    }

    /// Rows of a range of seconds, both ends included.
    pub fn rows_within(&self, from: u32, to: u32) -> &[OverviewRow] {
        let begin = self.rows.partition_point(|row| row.second < from);
        let end = self.rows.partition_point(|row| row.second <= to);
        self.rows.get(begin..end.max(begin)).unwrap_or_default()
    }

    /// Encodes and clears the data since the last call, as a block for chunks from offset `from` on.
    pub(crate) fn give_block(&mut self, from: u64) -> Vec<u8> {
        let rows = std::mem::take(&mut self.rows);
        let marks = std::mem::take(&mut self.marks);
        let block = OverviewBlock {
            from,
            counts: std::mem::take(&mut self.counts),
            seconds: rows.iter().map(|row| row.second).collect(),
            least: rows.iter().flat_map(|row| row.least).collect(),
            greatest: rows.iter().flat_map(|row| row.greatest).collect(),
            mark_micros: marks.iter().map(|mark| mark.at.micros()).collect(),
            mark_kinds: marks.iter().map(|mark| mark.kind.key().into()).collect(),
            mark_words: marks.into_iter().map(|mark| mark.words).collect(),
        };
        cdr::encode(&block)
    }

    /// Adds a block of a file; returns the offset of the first chunk that it covers. `None` for bytes that are not a block.
    pub(crate) fn apply_block(&mut self, bytes: &[u8]) -> Option<u64> {
        let block: OverviewBlock = cdr::decode(bytes)?;
        let (least, _) = block.least.as_chunks::<LINES>();
        let (greatest, _) = block.greatest.as_chunks::<LINES>();
        let rows = block.seconds.iter().zip(least.iter().zip(greatest));
        for (second, (least, greatest)) in rows {
            let read = OverviewRow {
                second: *second,
                least: *least,
                greatest: *greatest,
            };
            if let Some(row) = self.row(*second) {
                row.merge(&read);
            }
        }
        let words = block.mark_kinds.iter().zip(block.mark_words);
        for (micros, (kind, words)) in block.mark_micros.iter().zip(words) {
            if let Some(kind) = EventKind::by_key(kind) {
                self.mark(FileMark {
                    at: Moment::from_micros(*micros),
                    kind,
                    words,
                });
            }
        }
        self.counts.add(block.counts);
        Some(block.from)
    }

    /// Overview of the next file: empty, but with the state of the hand, so that ongoing states are not reported again.
    pub(crate) fn next(&self) -> Self {
        Self {
            rows: Vec::new(),
            marks: Vec::new(),
            counts: Counts::default(),
            ..*self
        }
    }

    /// Adds the overview of the next file.
    pub(crate) fn add(&mut self, later: Self) {
        for read in later.rows {
            if let Some(row) = self.row(read.second) {
                row.merge(&read);
            }
        }
        later.marks.into_iter().for_each(|mark| self.mark(mark));
        self.counts.add(later.counts);
        self.sort();
    }

    /// Sorts the marks by time, once all entries were added.
    pub(crate) fn sort(&mut self) {
        self.marks.sort_by_key(|mark| mark.at);
    }
}
