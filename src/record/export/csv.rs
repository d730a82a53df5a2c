//! A recording as comma-separated values: one line for each moment of receipt, the columns of the history's tables, the event
//! last.

use crate::hand::column::{
    channel_column, grip_columns, joint_column, newton_column, text_cell, tip_column,
};
use crate::hand::grip::Grip;
use crate::hand::newtons::newtons;
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, Quantity, Touch};
use crate::record::export::output::{Destination, ExportError, Exported, Unfinished};
use crate::record::export::source::ExportSource;
use crate::record::file::FileMark;
use crate::record::grip;
use crate::record::{Entry, EventKind, Record};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::iter::Peekable;

/// Number of channels of a fingertip.
const CHANNELS: u8 = 8;

/// The column that names values outside the manual's ranges, whose cells are empty.
pub(crate) const UNDOCUMENTED: &str = "undocumented";

/// Writes a time range. Times are seconds from the recording's start.
///
/// # Errors
/// [`ExportError`]; then there is no file.
pub(crate) fn write(source: ExportSource<'_>, to: &Destination) -> Result<Exported, ExportError> {
    let output = Unfinished::new(to)?;
    let mut to = output.file()?;
    let stretch = source.stretch;
    let marks = source.file.overview().marks.iter();
    let marks = marks.filter(|mark| (stretch.from..=stretch.to).contains(&mark.at));
    let mut lines = Lines {
        to: &mut to,
        start: source.file.first(),
        newtons_per_g: source.newtons_per_g(),
        marks: marks.peekable(),
        line: Line::default(),
        rows: 0,
    };
    let broken = |error: io::Error| output.error(&error);
    lines.head().map_err(broken)?;
    let grip = source.grip_before();
    let mut follower = grip.map_err(|error| error.of(&output))?;
    let damage = source.without_wire().entries(|entry| {
        let grip = follower.apply(&entry);
        if let Entry::Heard(Record::Reading { sample, fresh }) = &entry {
            lines.reading(entry.at(), sample, *fresh)?;
            lines.grip(&grip.unwrap_or_default());
        }
        Ok(())
    });
    let damage = damage.map_err(|error| error.of(&output))?;
    lines.end().map_err(broken)?;
    let rows = lines.rows;
    output.sync(to)?;
    output.finish(rows)?;
    Ok(Exported {
        rows,
        readings: None,
        damage,
    })
}

/// Data received at one moment.
#[derive(Default)]
struct Line {
    at: Option<Moment>,
    taken: Groups,
    cells: Vec<String>,
    undocumented: String,
}

struct Lines<'a, W: Write, M: Iterator<Item = &'a FileMark>> {
    to: &'a mut W,
    start: Moment,
    /// Joints with a column in newtons.
    newtons_per_g: Vec<(Dof, f64)>,
    marks: Peekable<M>,
    line: Line,
    rows: u64,
}

impl<'a, W: Write, M: Iterator<Item = &'a FileMark>> Lines<'a, W, M> {
    fn head(&mut self) -> io::Result<()> {
        let names: Vec<String> = columns(&self.newtons_per_g).collect();
        self.line.cells = vec![String::new(); names.len()];
        let names = names.join(",");
        writeln!(self.to, "time_s,{names},{UNDOCUMENTED},event")
    }

    fn reading(&mut self, at: Moment, sample: &HandSample, fresh: Groups) -> io::Result<()> {
        let is_again = Group::ALL
            .into_iter()
            .any(|group| fresh.contains(group) && self.line.taken.contains(group));
        if self.line.at != Some(at) || is_again {
            self.put()?;
            self.line.at = Some(at);
        }
        self.line.taken = self.line.taken.and(fresh);
        for (cell, value) in
            self.line
                .cells
                .iter_mut()
                .zip(values(sample, fresh, &self.newtons_per_g))
        {
            if let Some(value) = value {
                *cell = value;
            }
        }
        let columns = Quantity::ALL.into_iter().map(Quantity::group);
        let columns: Groups = columns.filter(|group| fresh.contains(*group)).collect();
        for value in sample.undocumented(columns) {
            let words = &mut self.line.undocumented;
            let gap = if words.is_empty() { "" } else { " " };
            // Writing to a string cannot fail.
            let _done = write!(words, "{gap}{value}");
        }
        Ok(())
    }

    /// Sets the grip after the data of the current line.
    fn grip(&mut self, grip: &Grip) {
        let states = grip::states(grip).map(|state| grip::cell(state).unwrap_or_default());
        for (cell, state) in self
            .line
            .cells
            .iter_mut()
            .rev()
            .zip(states.into_iter().rev())
        {
            state.clone_into(cell);
        }
    }

    /// Writes the collected line, preceded by earlier events.
    fn put(&mut self) -> io::Result<()> {
        let Some(at) = self.line.at.take() else {
            return Ok(());
        };
        while let Some(mark) = self.marks.next_if(|mark| mark.at < at) {
            self.mark(mark)?;
        }
        let mark = self.marks.next_if(|mark| mark.at == at);
        self.rows += 1;
        write!(self.to, "{:.6}", self.seconds(at))?;
        for cell in &mut self.line.cells {
            write!(self.to, ",{cell}")?;
            cell.clear();
        }
        self.line.taken = Groups::NONE;
        write!(self.to, ",{}", self.line.undocumented)?;
        self.line.undocumented.clear();
        let words = mark.map(words).unwrap_or_default();
        writeln!(self.to, ",{}", text_cell(&words))
    }

    /// Writes a line with an event only.
    fn mark(&mut self, mark: &FileMark) -> io::Result<()> {
        self.rows += 1;
        let empty = ",".repeat(self.line.cells.len() + 1);
        let words = text_cell(&words(mark));
        writeln!(self.to, "{:.6}{empty},{words}", self.seconds(mark.at))
    }

    fn end(&mut self) -> io::Result<()> {
        self.put()?;
        while let Some(mark) = self.marks.next() {
            self.mark(mark)?;
        }
        self.to.flush()
    }

    fn seconds(&self, at: Moment) -> f64 {
        at.since(self.start).as_secs_f64()
    }
}

/// Text of an event, as in the window's tables.
fn words(mark: &FileMark) -> String {
    let kind = match mark.kind {
        EventKind::LinkLost => "link lost",
        kind => kind.key(),
    };
    match mark.words.as_str() {
        "" => kind.to_owned(),
        words => format!("{kind}: {words}"),
    }
}

/// Headers of the columns between time and event.
fn columns(newtons_per_g: &[(Dof, f64)]) -> impl Iterator<Item = String> {
    let joints = Quantity::ALL
        .into_iter()
        .flat_map(|quantity| Dof::ALL.map(|dof| joint_column(quantity, dof)));
    let tips = Touch::ALL
        .into_iter()
        .flat_map(|touch| Finger::ALL.map(|finger| tip_column(touch, finger)));
    let channels = Finger::ALL
        .into_iter()
        .flat_map(|finger| (0..CHANNELS).map(move |channel| channel_column(channel, finger)));
    let in_newtons = newtons_per_g.iter().map(|(dof, _)| newton_column(*dof));
    joints
        .chain(tips)
        .chain(channels)
        .chain(in_newtons)
        .chain(grip_columns())
}

/// Formats a number with a decimal point, so that no reader infers a column of integers.
fn decimal(value: f32) -> String {
    let digits = value.to_string();
    if digits.contains('.') {
        digits
    } else {
        digits + ".0"
    }
}

/// Fresh and known values of those columns.
fn values(
    sample: &HandSample,
    fresh: Groups,
    newtons_per_g: &[(Dof, f64)],
) -> impl Iterator<Item = Option<String>> {
    let joints = Quantity::ALL.into_iter().flat_map(move |quantity| {
        let six = quantity.documented(sample);
        let six = six.filter(|_| fresh.contains(quantity.group()));
        Dof::ALL.map(|dof| six.and_then(|six| six.value[dof].map(|value| value.to_string())))
    });
    let block = move |finger: Finger| {
        let block = sample.tactile[finger].filter(|_| fresh.contains(Group::Tactile(finger)));
        block.map(|block| block.value)
    };
    let tips = Touch::ALL.into_iter().flat_map(move |touch| {
        Finger::ALL.map(|finger| {
            let block = block(finger)?;
            let value = match touch {
                Touch::Normal => block.normal(),
                Touch::Tangential => block.tangential(),
            };
            value.map(decimal)
        })
    });
    let channels = Finger::ALL.into_iter().flat_map(move |finger| {
        let raw = block(finger).map(|block| block.raw);
        let all = (0..usize::from(CHANNELS)).map(move |channel| raw?.get(channel).copied());
        all.map(|count| count.map(|count| count.to_string()))
    });
    let forces = Quantity::Force.documented(sample);
    let forces = forces.filter(|_| fresh.contains(Group::Force));
    let in_newtons = newtons_per_g.iter().map(move |(dof, per_g)| {
        let force_g = forces?.value[*dof]?;
        Some(format!("{:.3}", newtons(force_g.into(), *per_g)))
    });
    joints.chain(tips).chain(channels).chain(in_newtons)
}
