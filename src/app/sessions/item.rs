//! One session of the list: what is known of a file without reading it whole.

use crate::app::sessions::about::{SessionAbout, SessionNote};
use crate::hand::{Dof, Moment, Quantity};
use crate::record::EventKind;
use crate::record::file::overview::joint_line;
use crate::record::file::{Counts, FileMark, OpenError, Opening, Overview, SessionFile};
use crate::store::calendar::stamp;
use std::path::PathBuf;
use std::time::Duration;

/// Columns of the strip of force.
pub const STRIP: usize = 96;

#[derive(Debug, Clone, PartialEq)]
pub struct SessionItem {
    /// The file, or the first of several: a long recording has one for each hour.
    pub path: PathBuf,
    /// All its files, in the order of time.
    pub files: Vec<PathBuf>,
    /// The size of all.
    pub bytes: u64,
    /// What it began with.
    pub opening: Opening,
    /// How long it is.
    pub length: Duration,
    /// How much there is of what.
    pub counts: Counts,
    /// What happened.
    pub marks: Vec<FileMark>,
    /// Greatest force of any joint over its length, in grams; NaN where nothing was read.
    pub strip: Vec<f32>,
    /// True if the recording was ended as it should be.
    pub closed: bool,
    /// What a person says of it.
    pub about: SessionAbout,
}

impl SessionItem {
    /// Reads what is known of the files of one recording, and tells which of them cannot be read.
    pub fn read(files: &[PathBuf]) -> (Option<Self>, Vec<(PathBuf, OpenError)>) {
        let (file, unread) = SessionFile::open_all(files);
        let item = file.map(|file| {
            // What a person said of it must not keep the recording from being seen.
            let about = SessionAbout::load(file.path()).unwrap_or_default();
            Self::of(&file, about)
        });
        (item, unread)
    }

    /// Of an open file.
    pub fn of(file: &SessionFile, about: SessionAbout) -> Self {
        let overview = file.overview();
        let span = (file.first(), file.last());
        Self {
            path: file.path().to_owned(),
            files: file.paths().map(ToOwned::to_owned).collect(),
            bytes: file.bytes(),
            opening: file.opening().clone(),
            length: file.last().since(file.first()),
            counts: overview.counts,
            marks: overview.marks.clone(),
            strip: strip(overview, span),
            closed: file.is_closed(),
            about,
        }
    }

    /// When it began, `2026-11-22T09:30:00Z`; `-` if nobody knows.
    pub fn began(&self) -> String {
        if self.opening.is_imported() {
            return "-".into();
        }
        stamp(self.opening.began_since_1970())
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

    /// How many marks of a kind there are.
    pub fn count(&self, kind: EventKind) -> usize {
        self.marks.iter().filter(|mark| mark.kind == kind).count()
    }

    /// The notes in force.
    pub fn notes(&self) -> Vec<SessionNote> {
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
pub fn strip(overview: &Overview, (first, last): (Moment, Moment)) -> Vec<f32> {
    let second = |at: Moment| u32::try_from(at.micros() / 1_000_000).unwrap_or(u32::MAX);
    let (from, to) = (second(first), second(last));
    let mut columns = vec![f32::NAN; STRIP];
    let whole = u64::from(to.saturating_sub(from)) + 1;
    for row in overview.rows_within(from, to) {
        let place = u64::from(row.second - from) * STRIP as u64 / whole;
        let width = (STRIP as u64).div_ceil(whole);
        let force = Dof::ALL.map(|dof| row.greatest.get(joint_line(Quantity::Force, dof)).copied());
        let force = force.into_iter().flatten().fold(f32::NAN, f32::max);
        for place in place..(place + width).min(STRIP as u64) {
            let column = usize::try_from(place)
                .ok()
                .and_then(|at| columns.get_mut(at));
            if let Some(column) = column {
                *column = column.max(force);
            }
        }
    }
    columns
}
