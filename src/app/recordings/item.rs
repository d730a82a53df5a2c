//! One recording of the list: what is known of a file without reading it whole.

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

/// Columns of the strip of force.
pub const STRIP: usize = 300;

#[derive(Debug, Clone, PartialEq)]
pub struct RecordingItem {
    /// The file, or the first of several: a long recording has one for each hour.
    pub path: PathBuf,
    /// All its files, in the order of time.
    pub files: Vec<PathBuf>,
    /// The size of all.
    pub bytes: u64,
    /// What it began with.
    pub opening: Opening,
    /// The moment of its own clock that it begins at.
    pub first: Moment,
    /// How long it is.
    pub length: Duration,
    /// How much there is of what.
    pub counts: Counts,
    /// What happened.
    pub marks: Vec<FileMark>,
    /// Greatest force of any joint over its length, in grams; NaN where nothing was read.
    pub strip: Vec<f32>,
    /// Angles of the joints in the same columns; none where none was read.
    pub poses: Arc<Vec<PerDof<Option<i16>>>>,
    /// True if the recording was ended as it should be.
    pub closed: bool,
    /// What the user says of it.
    pub about: RecordingAbout,
}

impl RecordingItem {
    /// Reads what is known of the files of one recording, and tells which of them cannot be read.
    pub fn read(files: &[PathBuf]) -> (Option<Self>, Vec<(PathBuf, OpenError)>) {
        let (file, unread) = RecordingFile::open_all(files);
        let item = file.map(|file| {
            // What the user said of it must not keep the recording from being seen.
            let about = RecordingAbout::load(file.path()).unwrap_or_default();
            Self::of(&file, about)
        });
        (item, unread)
    }

    /// Of an open file.
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

    /// When it began by the clock of this computer, `2026-11-22 10:30`; `-` if nobody knows.
    pub fn began(&self) -> String {
        if self.opening.is_imported() {
            return "-".into();
        }
        let (day, time) = calendar::local(self.opening.began_since_1970());
        format!("{day} {time}")
    }

    /// Its name, or that of its file.
    pub fn title(&self) -> String {
        if !self.about.name.is_empty() {
            return self.about.name.clone();
        }
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    /// True if one of its files is among these.
    pub fn is_in(&self, paths: &[PathBuf]) -> bool {
        self.files.iter().any(|file| paths.contains(file))
    }

    /// The joints that its trials closed.
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

    /// The moment of its own clock after a part of its length.
    pub fn moment(&self, part: f64) -> Moment {
        self.first.plus(self.length.mul_f64(part.clamp(0.0, 1.0)))
    }

    /// How many marks of a kind there are.
    pub fn count(&self, kind: EventKind) -> usize {
        self.marks.iter().filter(|mark| mark.kind == kind).count()
    }

    /// The notes in force.
    pub fn notes(&self) -> Vec<RecordingNote> {
        self.about.notes(&self.marks)
    }

    /// True if these words, in small letters, stand somewhere in what is known of it.
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

/// The greatest force of all joints, column by column.
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

/// The angles of the joints, column by column: the middle of what they were in the last second there.
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

/// Which columns each second of an overview stands in.
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
