//! One recording of the list: its summary, without reading the file as a whole.

use crate::app::recordings::about::{RecordingAbout, RecordingNote};
use crate::hand::{Dof, Moment, PerDof, Quantity};
use crate::record::EventKind;
use crate::record::file::overview::{OverviewRow, joint_line};
use crate::record::file::{Counts, FileMark, OpenError, Opening, Overview, RecordingFile};
use crate::store::calendar;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Number of columns of the force strip.
pub const STRIP: usize = 300;

#[derive(Debug, Clone, PartialEq)]
pub struct RecordingItem {
    /// The recording's file, or the first of several: a long recording has one per hour.
    pub path: PathBuf,
    /// All files, in chronological order.
    pub files: Vec<PathBuf>,
    /// Total size of all files.
    pub bytes: u64,
    /// Header of the recording.
    pub opening: Opening,
    /// First moment, on the recording's own clock.
    pub first: Moment,
    pub length: Duration,
    /// Numbers of entries by kind.
    pub counts: Counts,
    /// Events in the recording.
    pub marks: Vec<FileMark>,
    /// Maximum force of any joint per column, in grams; NaN where nothing was read.
    pub strip: Vec<f32>,
    /// Joint angles in the same columns; `None` where no angle was read.
    pub poses: Arc<Vec<PerDof<Option<i16>>>>,
    /// True if the recording was closed properly.
    pub closed: bool,
    /// User metadata.
    pub about: RecordingAbout,
}

impl RecordingItem {
    /// Reads the summary of one recording, and returns the files that cannot be read.
    pub fn read(files: &[PathBuf]) -> (Option<Self>, Vec<(PathBuf, OpenError)>) {
        let (file, unread) = RecordingFile::open_all(files);
        let item = file.map(|file| {
            // Unreadable metadata must not hide the recording.
            let about = RecordingAbout::load(file.path()).unwrap_or_default();
            Self::of(&file, about)
        });
        (item, unread)
    }

    /// Summarizes an open file.
    pub fn of(file: &RecordingFile, about: RecordingAbout) -> Self {
        let overview = file.overview();
        let span = (file.first(), file.last());
        Self {
            path: file.path().to_owned(),
            files: file.paths().map(ToOwned::to_owned).collect(),
            bytes: file.bytes(),
            opening: file.opening().clone(),
            first: file.first(),
            length: file.last().since(file.first()),
            counts: overview.counts,
            marks: overview.marks.clone(),
            strip: strip(overview, span),
            poses: Arc::new(poses(overview, span)),
            closed: file.is_closed(),
            about,
        }
    }

    /// Start time in local time, `2026-11-22 10:30`; `-` if unknown.
    pub fn began(&self) -> String {
        if self.opening.is_imported() {
            return "-".into();
        }
        let (day, time) = calendar::local(self.opening.began_since_1970());
        format!("{day} {time}")
    }

    /// User-given name, else the file name.
    pub fn title(&self) -> String {
        if !self.about.name.is_empty() {
            return self.about.name.clone();
        }
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    /// True if `paths` contains one of its files.
    pub fn is_in(&self, paths: &[PathBuf]) -> bool {
        self.files.iter().any(|file| paths.contains(file))
    }

    /// Joints that the recorded trials closed.
    pub fn tried(&self) -> Vec<Dof> {
        let trials = self
            .marks
            .iter()
            .filter(|mark| mark.kind == EventKind::Trial);
        let named: BTreeSet<&str> = trials
            .flat_map(|mark| mark.words.split(", ").skip(1))
            .collect();
        let all = Dof::ALL.into_iter();
        all.filter(|dof| named.contains(dof.name())).collect()
    }

    /// Moment at a fraction (0 to 1) of the length, on the recording's own clock.
    pub fn moment(&self, part: f64) -> Moment {
        self.first.plus(self.length.mul_f64(part.clamp(0.0, 1.0)))
    }

    /// Number of marks of a kind.
    pub fn count(&self, kind: EventKind) -> usize {
        self.marks.iter().filter(|mark| mark.kind == kind).count()
    }

    /// Effective notes.
    pub fn notes(&self) -> Vec<RecordingNote> {
        self.about.notes(&self.marks)
    }

    /// True if the title, start time, hand, notes and marks together contain all of these words, ignoring case.
    pub fn matches(&self, words: &str) -> bool {
        let notes = self.notes().into_iter().map(|note| note.words);
        let marks = self.marks.iter().map(|mark| mark.words.clone());
        let said = [self.title(), self.began(), self.opening.hand.clone()];
        let all: Vec<String> = said.into_iter().chain(notes).chain(marks).collect();
        let all = all.join("\n").to_lowercase();
        words
            .split_whitespace()
            .all(|word| all.contains(&word.to_lowercase()))
    }
}

/// Maximum force over all joints, column by column.
pub fn strip(overview: &Overview, span: (Moment, Moment)) -> Vec<f32> {
    let mut all = vec![f32::NAN; STRIP];
    for (columns, row) in columns(overview, span) {
        let force = Dof::ALL.map(|dof| row.greatest.get(joint_line(Quantity::Force, dof)).copied());
        let force = force.into_iter().flatten().fold(f32::NAN, f32::max);
        for column in all.get_mut(columns).into_iter().flatten() {
            *column = column.max(force);
        }
    }
    all
}

/// Joint angles, column by column: the midpoint of the range in the last second of the column.
fn poses(overview: &Overview, span: (Moment, Moment)) -> Vec<PerDof<Option<i16>>> {
    let mut all = vec![PerDof::splat(None); STRIP];
    for (columns, row) in columns(overview, span) {
        let pose = PerDof::from_fn(|dof| {
            let line = joint_line(Quantity::Angle, dof);
            let middle = row.least.get(line)?.midpoint(*row.greatest.get(line)?);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "cut to what a register holds"
            )]
            let angle = middle.round() as i16;
            (!middle.is_nan()).then_some(angle)
        });
        for column in all.get_mut(columns).into_iter().flatten() {
            *column = pose;
        }
    }
    all
}

/// Maps each second of an overview to its columns.
fn columns(
    overview: &Overview,
    (first, last): (Moment, Moment),
) -> impl Iterator<Item = (Range<usize>, &OverviewRow)> {
    let second = |at: Moment| u32::try_from(at.micros() / 1_000_000).unwrap_or(u32::MAX);
    let (from, to) = (second(first), second(last));
    let whole = usize::try_from(to.saturating_sub(from)).unwrap_or(usize::MAX) + 1;
    overview.rows_within(from, to).iter().map(move |row| {
        let place = usize::try_from(row.second - from).unwrap_or(usize::MAX);
        let place = place.saturating_mul(STRIP) / whole;
        (place..(place + STRIP.div_ceil(whole)).min(STRIP), row)
    })
}
