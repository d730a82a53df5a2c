//! Imports a recording from comma-separated values as `export::csv` writes them, with columns identified by name, in any order.
//! Data without a column stays unknown: the date, the hand, its settings, the bytes on the wire.

use crate::hand::column::{channel_column, grip_columns, joint_column, newton_column, tip_column};
use crate::hand::feedback::sample::SET_OUT_OF_RANGE;
use crate::hand::feedback::tactile::{BLOCK_LEN, TactileBlock};
use crate::hand::kinematics::Side;
use crate::hand::{
    Dof, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger, Quantity, Reply, Target,
    Touch, Undocumented,
};
use crate::record::export::csv::UNDOCUMENTED;
use crate::record::export::cut::RecordingCopy;
use crate::record::export::output::{Destination, ExportError, Unfinished};
use crate::record::export::source::Broken;
use crate::record::file::Opening;
use crate::record::import::lines::{CsvLineFault, CsvLines, LineError};
use crate::record::{Entry, Event, EventKind, LinkState, Record};
use std::collections::BTreeMap;
use std::io::{self, BufRead};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Number of channels of a fingertip.
const CHANNELS: usize = 8;
/// Maximum duration of a recording: ten years.
const SECONDS_MAX: f64 = 10.0 * 366.0 * 86_400.0;
/// Upper limit of times since 1970: the year 2286.
const SINCE_1970_MAX_S: f64 = 1e10;
/// Maximum step back in time: lines received at nearly the same time may be swapped.
const BACK_MAX_S: f64 = 0.01;
/// Lines between two checks for cancellation: some milliseconds.
const POLL_ENTRIES: u64 = 256;
/// Integers up to this are exact as floating-point numbers.
const EXACT_MAX: f64 = 9_007_199_254_740_992.0;
/// Maximum characters of a name or cell in an error.
const TEXT_MAX: usize = 40;
/// Maximum number of unknown columns that are named.
const UNKNOWN_MAX: usize = 20;
/// Temperature above the manual's range: the hand does not know it.
const TEMPERATURE_UNKNOWN: u8 = 255;
/// Raw direction that is neither an angle nor "no contact".
const DIRECTION_UNKNOWN: u16 = 65_534;

/// Reason why nothing was imported.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImportError {
    /// The system could not read it.
    #[error("{message}")]
    Unreadable {
        /// The system's error text.
        message: String,
    },
    /// A line is invalid.
    #[error("line {line}: {fault}")]
    Line {
        /// Counted from 1.
        line: u64,
        fault: CsvFault,
    },
    /// The recording file could not be written.
    #[error(transparent)]
    Output(#[from] ExportError),
}

/// Problem of a line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CsvFault {
    /// Its cells cannot be separated.
    #[error(transparent)]
    Cells(#[from] CsvLineFault),
    /// The first line is not the header of such a file.
    #[error(
        "there is no column time_s (separated by commas, semicolons or tabs), so these are not the values of a recording"
    )]
    NoTime,
    /// A line's time is earlier than the previous one's.
    #[error(
        "the time goes back from {before_s:.3} s to {time_s:.3} s; a table holds one recording: split it into one per take"
    )]
    TimeGoesBack { before_s: f64, time_s: f64 },
    /// No column but the time is known.
    #[error("it has no known column except time_s")]
    NothingKnown,
    /// Duplicate column.
    #[error("duplicate column {name}")]
    Twice { name: String },
    /// The number of cells differs from the first line's.
    #[error("it has {cells} cells, and the first line has {columns}")]
    Ragged {
        /// Cells of this line.
        cells: usize,
        /// Cells of the first line.
        columns: usize,
    },
    /// A cell that is not a valid value of its column.
    #[error("invalid value '{text}' in column {column}")]
    BadValue {
        column: String,
        /// Text of the cell, or its beginning.
        text: String,
    },
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Imported {
    /// Lines after the first.
    pub rows: u64,
    /// Skipped columns of unknown meaning; only the first ones are listed.
    pub unknown: Vec<String>,
    /// True if it has grip columns, which are ignored: the grip is derived from the readings.
    pub has_grip: bool,
    /// Skipped readings of fingertips that lack a column of a force or a channel.
    pub incomplete_tips: u64,
    /// True if its times count from 1970; the recording then begins with the first of them.
    pub counts_from_1970: bool,
}

/// Reads values, and writes them as a recording file, until `watch` cancels.
///
/// # Errors
/// [`ImportError`]; then there is no recording file.
pub fn import(
    csv: impl BufRead,
    to: &Destination,
    watch: &dyn Fn() -> ControlFlow<()>,
) -> Result<Imported, ImportError> {
    let mut values = CsvValues::new(csv)?;
    let output = Unfinished::new(to)?;
    let written = |error: Broken| error.of(&output);
    let opening = imported_opening();
    let mut copy = RecordingCopy::new(&opening, output.file()?).map_err(written)?;
    let monitoring = Entry::Heard(Record::State {
        at: opening.began,
        state: LinkState::Monitoring,
    });
    copy.push(&monitoring).map_err(written)?;
    while let Some(entries) = values.next_row()? {
        if values.imported.rows.is_multiple_of(POLL_ENTRIES) && watch().is_break() {
            return Err(ExportError::Interrupted.into());
        }
        for entry in entries {
            copy.push(&entry).map_err(written)?;
        }
    }
    let copied = copy.end().map_err(written)?;
    output.sync(copied.to)?;
    output.finish(copied.exported.rows)?;
    Ok(values.imported)
}

fn unreadable(error: &io::Error) -> ImportError {
    ImportError::Unreadable {
        message: error.to_string(),
    }
}

/// The values of a file, line by line.
#[derive(Debug)]
pub struct CsvValues<R> {
    lines: CsvLines<R>,
    cells: Vec<String>,
    columns: CsvColumns,
    sample: HandSample,
    imported: Imported,
    /// Time of the first line, if it counts from 1970, and of the last one.
    zero_s: f64,
    last_s: Option<f64>,
}

impl<R: BufRead> CsvValues<R> {
    /// Reads the names of the columns.
    ///
    /// # Errors
    /// [`ImportError`].
    pub fn new(from: R) -> Result<Self, ImportError> {
        let (mut lines, mut cells) = (CsvLines::new(from), Vec::new());
        read(&mut lines, &mut cells)?;
        let columns = CsvColumns::of(&cells);
        let columns = columns.map_err(|fault| ImportError::Line {
            line: lines.number(),
            fault,
        })?;
        Ok(Self {
            imported: Imported {
                unknown: columns.unknown.clone(),
                has_grip: columns.has_grip(),
                ..Imported::default()
            },
            lines,
            cells,
            columns,
            sample: HandSample::default(),
            zero_s: 0.0,
            last_s: None,
        })
    }

    /// The entries of the next line; `None` at the end.
    ///
    /// # Errors
    /// [`ImportError`].
    pub fn next_row(&mut self) -> Result<Option<Vec<Entry>>, ImportError> {
        if read(&mut self.lines, &mut self.cells)?.is_none() {
            return Ok(None);
        }
        let line = self.lines.number();
        let row = self
            .row()
            .map_err(|fault| ImportError::Line { line, fault })?;
        self.imported.rows += 1;
        self.imported.incomplete_tips += row.incomplete_tips();
        Ok(Some(row.entries(&mut self.sample)))
    }
}

impl<R: BufRead> CsvValues<R> {
    fn row(&mut self) -> Result<CsvRow, CsvFault> {
        if self.lines.has_free_comma() {
            self.columns.decimal_points(&mut self.cells);
        }
        let mut row = self.columns.row(&self.cells)?;
        let last_s = *self.last_s.get_or_insert_with(|| {
            if row.time_s > SECONDS_MAX {
                self.zero_s = row.time_s;
                self.imported.counts_from_1970 = true;
            }
            row.time_s
        });
        if row.time_s + BACK_MAX_S < last_s {
            return Err(CsvFault::TimeGoesBack {
                before_s: last_s - self.zero_s,
                time_s: row.time_s - self.zero_s,
            });
        }
        self.last_s = Some(last_s.max(row.time_s));
        row.at = moment(row.time_s - self.zero_s).ok_or_else(|| CsvFault::BadValue {
            column: "time_s".into(),
            text: row.time_s.to_string(),
        })?;
        Ok(row)
    }
}

fn read<R: BufRead>(
    lines: &mut CsvLines<R>,
    cells: &mut Vec<String>,
) -> Result<Option<()>, ImportError> {
    lines.next(cells).map_err(|error| match error {
        LineError::System(error) => unreadable(&error),
        LineError::Fault(fault) => ImportError::Line {
            line: lines.number(),
            fault: fault.into(),
        },
    })
}

/// Opening of an imported recording, whose date and hand are unknown.
fn imported_opening() -> Opening {
    Opening {
        base_nanos: Opening::NO_DATE,
        began: Moment::ZERO,
        hand: String::new(),
        simulated: false,
        side: Side::Right,
        newtons_per_g: PerDof::splat(None),
        version: format!("{} {}", env!("CARGO_PKG_VERSION"), Opening::IMPORTED),
        part: None,
    }
}

/// Meaning of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CsvColumn {
    Time,
    Joint(Quantity, Dof),
    Tip(Touch, Finger),
    Channel(usize, Finger),
    Undocumented,
    Event,
    /// The grip of the grasp or of a finger; ignored, as it is derived from the readings.
    Grip(usize),
    /// A force in newtons; ignored, as it is derived from the one in grams.
    Newtons(Dof),
    Unknown,
}

/// The columns of one file.
#[derive(Debug)]
struct CsvColumns {
    all: Vec<(String, CsvColumn)>,
    unknown: Vec<String>,
}

impl CsvColumns {
    fn of(names: &[String]) -> Result<Self, CsvFault> {
        let known = known();
        let (mut all, mut unknown) = (Vec::new(), Vec::new());
        for name in names {
            let column = known.get(name.trim()).copied();
            let column = column.unwrap_or(CsvColumn::Unknown);
            let is_there = |(_, other): &(String, CsvColumn)| *other == column;
            match column {
                // pandas writes its index without a name.
                CsvColumn::Unknown if name.is_empty() => unknown.push("(no name)".into()),
                CsvColumn::Unknown if unknown.len() < UNKNOWN_MAX => unknown.push(shortened(name)),
                CsvColumn::Unknown => {}
                _ if all.iter().any(is_there) => {
                    return Err(CsvFault::Twice {
                        name: shortened(name),
                    });
                }
                _ => {}
            }
            all.push((shortened(name), column));
        }
        let has = |wanted: fn(CsvColumn) -> bool| all.iter().any(|(_, column)| wanted(*column));
        if !has(|column| column == CsvColumn::Time) {
            return Err(CsvFault::NoTime);
        }
        if !has(|column| {
            !matches!(
                column,
                CsvColumn::Time | CsvColumn::Grip(_) | CsvColumn::Newtons(_) | CsvColumn::Unknown
            )
        }) {
            return Err(CsvFault::NothingKnown);
        }
        Ok(Self { all, unknown })
    }

    fn has_grip(&self) -> bool {
        let mut all = self.all.iter();
        all.any(|(_, column)| matches!(column, CsvColumn::Grip(_)))
    }

    /// Replaces decimal commas by points.
    fn decimal_points(&self, cells: &mut [String]) {
        for ((_, column), cell) in self.all.iter().zip(cells) {
            let is_text = matches!(column, CsvColumn::Event | CsvColumn::Undocumented);
            if !is_text && cell.contains(',') {
                *cell = cell.replace(',', ".");
            }
        }
    }

    fn row(&self, cells: &[String]) -> Result<CsvRow, CsvFault> {
        if cells.len() != self.all.len() {
            return Err(CsvFault::Ragged {
                cells: cells.len(),
                columns: self.all.len(),
            });
        }
        let mut row = CsvRow::default();
        for ((name, column), cell) in self.all.iter().zip(cells) {
            let is_needed = *column == CsvColumn::Time;
            let is_text = *column == CsvColumn::Event;
            row.tells_undocumented |= *column == CsvColumn::Undocumented;
            if (cell.is_empty() || is_no_number(cell) && !is_text) && !is_needed {
                continue;
            }
            if row.parse_cell(*column, cell).is_none() {
                return Err(CsvFault::BadValue {
                    column: name.clone(),
                    text: shortened(cell),
                });
            }
        }
        Ok(row)
    }
}

/// The columns that `export::csv` writes.
fn known() -> BTreeMap<String, CsvColumn> {
    let mut known = BTreeMap::new();
    known.insert("time_s".to_owned(), CsvColumn::Time);
    known.insert(UNDOCUMENTED.to_owned(), CsvColumn::Undocumented);
    let grips = grip_columns().into_iter().enumerate();
    known.extend(grips.map(|(nth, name)| (name, CsvColumn::Grip(nth))));
    known.extend(Dof::ALL.map(|dof| (newton_column(dof), CsvColumn::Newtons(dof))));
    known.insert("event".to_owned(), CsvColumn::Event);
    for quantity in Quantity::ALL {
        for dof in Dof::ALL {
            known.insert(joint_column(quantity, dof), CsvColumn::Joint(quantity, dof));
        }
    }
    for finger in Finger::ALL {
        for touch in Touch::ALL {
            known.insert(tip_column(touch, finger), CsvColumn::Tip(touch, finger));
        }
        for (number, channel) in (0..).zip(0..CHANNELS) {
            let name = channel_column(number, finger);
            known.insert(name, CsvColumn::Channel(channel, finger));
        }
    }
    known
}

/// A text shortened for an error.
fn shortened(text: &str) -> String {
    let plain = text.chars().filter(|letter| !letter.is_control());
    plain.take(TEXT_MAX).collect()
}

/// Values of a fingertip.
#[derive(Debug, Clone, Copy, Default)]
struct TipCells {
    forces: [Option<f32>; 2],
    channels: [Option<u32>; CHANNELS],
}

impl TipCells {
    fn is_there(&self) -> bool {
        let forces = self.forces.iter().any(Option::is_some);
        forces || self.channels.iter().any(Option::is_some)
    }

    /// The block as the hand would send it. Counts cannot express "unknown", so all of them are required. The check word is wrong
    /// on purpose: these bytes do not come from the hand.
    fn block(&self) -> Option<[u8; BLOCK_LEN]> {
        let [normal, tangential] = self.forces.map(|force| force.unwrap_or(f32::NAN));
        let mut bytes = Vec::with_capacity(BLOCK_LEN);
        for channel in self.channels {
            bytes.extend(channel?.to_le_bytes());
        }
        let unknown = i32::MIN.to_le_bytes();
        bytes.extend(normal.to_le_bytes());
        bytes.extend(unknown);
        bytes.extend(tangential.to_le_bytes());
        bytes.extend(unknown);
        bytes.extend(DIRECTION_UNKNOWN.to_le_bytes());
        bytes.extend(unknown);
        bytes.extend([0; 4]);
        let block = TactileBlock::decode(&bytes)?;
        let check = !block.sum;
        Some(TactileBlock { check, ..block }.as_sent())
    }
}

/// The values of one line.
#[derive(Debug, Default)]
struct CsvRow {
    at: Moment,
    /// Time as written in the file.
    time_s: f64,
    joints: [PerDof<Option<i16>>; Quantity::ALL.len()],
    /// Raw values outside the manual's ranges.
    undocumented: Vec<Undocumented>,
    /// True if there is a column for those.
    tells_undocumented: bool,
    tips: PerFinger<TipCells>,
    event: Option<(EventKind, String)>,
}

impl CsvRow {
    /// Parses one cell; `None` if its text is not valid in the column.
    fn parse_cell(&mut self, column: CsvColumn, cell: &str) -> Option<()> {
        match column {
            CsvColumn::Unknown | CsvColumn::Grip(_) | CsvColumn::Newtons(_) => {}
            CsvColumn::Time => {
                let time_s: f64 = cell.parse().ok()?;
                self.time_s =
                    Some(time_s).filter(|time_s| (0.0..SINCE_1970_MAX_S).contains(time_s))?;
            }
            CsvColumn::Event => self.event = Some(event(cell)),
            CsvColumn::Undocumented => {
                let names = cell.split_whitespace().map(Undocumented::parse);
                self.undocumented = names.collect::<Option<_>>()?;
            }
            CsvColumn::Joint(quantity, dof) => {
                let value = whole(cell)?.try_into().ok()?;
                let six = self.joints.get_mut(quantity as usize)?;
                six[dof] = Some(value);
                // Only documented values are written, so no others are accepted.
                documented(quantity, six)[dof]?;
            }
            CsvColumn::Tip(touch, finger) => {
                let value: f32 = cell.parse().ok()?;
                let force = self.tips[finger].forces.get_mut(touch as usize)?;
                *force = Some(value).filter(|value| value.is_finite());
                (*force)?;
            }
            CsvColumn::Channel(channel, finger) => {
                let count = whole(cell)?.try_into().ok()?;
                *self.tips[finger].channels.get_mut(channel)? = Some(count);
            }
        }
        Some(())
    }

    /// The six values, with the raw out-of-range ones where the cell is empty.
    fn as_sent(&self, quantity: Quantity, six: &PerDof<Option<i16>>) -> PerDof<Option<i16>> {
        let mut six = *six;
        let of_it = |one: &&Undocumented| one.group == quantity.group();
        for one in self.undocumented.iter().filter(of_it) {
            let raw = one.raw.unwrap_or(SET_OUT_OF_RANGE);
            if six[one.dof].is_none() {
                let mut alone = PerDof::splat(None);
                alone[one.dof] = Some(raw);
                // A name alone does not define a value within the range.
                let is_known = documented(quantity, &alone)[one.dof].is_some();
                six[one.dof] = Some(raw).filter(|_| !is_known);
            }
        }
        // A target that is neither given nor named is -1: no new target for the joint.
        let is_left = self.tells_undocumented && quantity == Quantity::TargetAngle;
        if is_left && six.iter().any(|(_, value)| value.is_some()) {
            six = six.map(|value| value.or(Some(Target::Leave.raw())));
        }
        six
    }

    fn incomplete_tips(&self) -> u64 {
        let tips = self.tips.iter();
        let incomplete = tips.filter(|(_, tip)| tip.is_there() && tip.block().is_none());
        u64::try_from(incomplete.count()).unwrap_or(u64::MAX)
    }

    /// The entries of the line. The request time of a reading is unknown, so it equals the time of receipt.
    fn entries(self, sample: &mut HandSample) -> Vec<Entry> {
        let mut fresh = Groups::NONE;
        for (quantity, six) in Quantity::ALL.into_iter().zip(&self.joints) {
            let six = &self.as_sent(quantity, six);
            if six.iter().any(|(_, value)| value.is_some()) {
                let bytes = memory(quantity, six);
                fresh = fresh.and(sample.apply(&reply(quantity.group(), &bytes, self.at)));
            }
        }
        for (finger, tip) in self.tips.iter() {
            if let Some(block) = tip.block() {
                let reply = reply(Group::Tactile(finger), &block, self.at);
                fresh = fresh.and(sample.apply(&reply));
            }
        }
        let reading = (!fresh.is_empty()).then(|| {
            Entry::Heard(Record::Reading {
                sample: Arc::new(*sample),
                fresh,
            })
        });
        let at = self.at;
        let event = self.event;
        let event = event.map(|(kind, words)| Entry::Event(Event { at, kind, words }));
        reading.into_iter().chain(event).collect()
    }
}

fn reply(group: Group, bytes: &[u8], at: Moment) -> Reply<'_> {
    Reply {
        span: group.span(),
        bytes,
        asked: at,
        received: at,
    }
}

/// Memory of the hand with these values. An unknown value is encoded as an undocumented one.
fn memory(quantity: Quantity, six: &PerDof<Option<i16>>) -> Vec<u8> {
    let values = six.iter().map(|(_, value)| *value);
    if quantity == Quantity::Temperature {
        let bytes = values.map(|value| value.and_then(|value| u8::try_from(value).ok()));
        return bytes
            .map(|byte| byte.unwrap_or(TEMPERATURE_UNKNOWN))
            .collect();
    }
    let shorts = values.map(|value| value.unwrap_or(SET_OUT_OF_RANGE));
    shorts.flat_map(i16::to_le_bytes).collect()
}

/// The six values as a reader of the recording will see them.
fn documented(quantity: Quantity, six: &PerDof<Option<i16>>) -> PerDof<Option<i16>> {
    let mut sample = HandSample::default();
    sample.apply(&reply(
        quantity.group(),
        &memory(quantity, six),
        Moment::ZERO,
    ));
    let read = quantity.documented(&sample);
    read.map_or_else(|| PerDof::splat(None), |read| read.value)
}

/// True for the words by which other programs mark a missing value.
fn is_no_number(cell: &str) -> bool {
    ["nan", "na", "n/a", "null", "none"]
        .iter()
        .any(|word| cell.eq_ignore_ascii_case(word))
}

/// Parses an integer, also in pandas' form for columns with missing values: `316.0`.
fn whole(cell: &str) -> Option<i64> {
    let exact = cell.parse().ok();
    exact.or_else(|| {
        let number: f64 = cell.parse().ok()?;
        let is_whole = number.fract() == 0.0 && number.abs() < EXACT_MAX;
        #[expect(clippy::cast_possible_truncation, reason = "whole, and exact")]
        is_whole.then_some(number as i64)
    })
}

/// Converts seconds from the recording's start, to the microsecond.
fn moment(seconds: f64) -> Option<Moment> {
    let seconds = seconds.max(0.0);
    if !(0.0..=SECONDS_MAX).contains(&seconds) {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not below zero, and far below 2^53"
    )]
    let micros = (seconds * 1e6).round() as u64;
    Some(Moment::from_micros(micros))
}

/// Kind and text of an event. An unknown kind becomes a note by the user.
fn event(cell: &str) -> (EventKind, String) {
    let (key, words) = cell.split_once(": ").unwrap_or((cell, ""));
    let kind = match key {
        "link lost" => Some(EventKind::LinkLost),
        key => EventKind::by_key(key).filter(|kind| kind.is_listed() && key != "link_lost"),
    };
    match kind {
        Some(kind) => (kind, words.to_owned()),
        None => (EventKind::Note, cell.to_owned()),
    }
}
