//! Recordings that went on in several files: all together, and what of them is there.

use super::{Atom, atoms, entries, opening, read};
use crate::hand::Moment;
use crate::record::Entry;
use crate::record::file::damage::Remark;
use crate::record::file::disk::SystemDisk;
use crate::record::file::format::opening::Opening;
use crate::record::file::parts::recordings;
use crate::record::file::reader::{RecordingFile, TimeRange};
use crate::record::file::recording::{Now, QueuedEntry, RecordingPlan, RecordingTask};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

/// Nine seconds in files of three.
pub(crate) struct Parts {
    pub(crate) folder: TempDir,
    wanted: Vec<Atom>,
}

/// Records entries at their own times; where the last file is.
fn record(opening: Opening, path: PathBuf, entries: &[Entry]) -> PathBuf {
    let plan = RecordingPlan {
        path,
        opening: opening.clone(),
        disk: Arc::new(SystemDisk),
        part_length: Duration::from_secs(3),
    };
    let now = |at: Moment| {
        let since = at.since(opening.began);
        let wall_nanos = i64::try_from(since.as_nanos()).unwrap();
        Now { since, wall_nanos }
    };
    let mut recording = RecordingTask::new(plan, now(opening.began)).unwrap();
    let mut last = opening.began;
    for entry in entries {
        last = entry.at();
        recording.accept(&QueuedEntry {
            _taken: None,
            entry: entry.clone(),
            lost_before: 0,
        });
        recording.step(now(last));
    }
    recording.end(now(last));
    assert!(recording.end_step(now(last).since));
    recording.status(now(last).since).path.unwrap()
}

impl Parts {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let entries = entries(7, 4500);
        let last = record(opening(), folder.path().join("a.mcap"), &entries);
        assert_eq!(last, folder.path().join("a-3.mcap"));
        Self {
            folder,
            wanted: entries.iter().flat_map(atoms).collect(),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// What is opened by this name: its files, how many entries, and what is to be said.
    fn open(&self, name: &str) -> (Vec<String>, Vec<Atom>, Vec<Remark>) {
        let (all, file, damage) = read(&self.path(name)).unwrap();
        assert_eq!((damage.chunks, damage.bytes, damage.messages), (0, 0, 0));
        let names = file.paths().map(name_of).collect();
        (names, all, file.remarks().to_vec())
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

#[test]
fn each_file_opens_all_and_all_is_what_was_recorded() {
    let parts = Parts::new();
    let names = ["a.mcap", "a-2.mcap", "a-3.mcap"];
    for name in names {
        let (opened, all, remarks) = parts.open(name);
        assert_eq!(
            (opened.as_slice(), remarks),
            (names.map(String::from).as_slice(), vec![])
        );
        // The state of the link is said again in each file.
        let is_new = |atom: &&Atom| parts.wanted.contains(atom);
        let all: Vec<&Atom> = all.iter().filter(is_new).collect();
        assert!(all.len() >= parts.wanted.len(), "{}", all.len());
    }
    let file = RecordingFile::open(&parts.path("a-2.mcap")).unwrap();
    assert!(file.is_closed() && !file.is_damaged());
    assert_eq!(
        (file.first(), file.path()),
        (opening().began, parts.path("a.mcap").as_path())
    );
    let counts = file.overview().counts;
    assert_eq!((counts.writes, counts.notes), (90, 90));
    assert_eq!(file.overview().seconds(), Some((2, 10)));
    let moments: Vec<Moment> = file.overview().marks.iter().map(|mark| mark.at).collect();
    assert!(moments.is_sorted());
    let sizes = names.map(|name| std::fs::metadata(parts.path(name)).unwrap().len());
    assert_eq!(file.bytes(), sizes.iter().sum::<u64>());
}

#[test]
fn a_stretch_over_the_border_of_two_files_is_read_from_both() {
    let parts = Parts::new();
    let file = RecordingFile::open(&parts.path("a.mcap")).unwrap();
    let stretch = |from, to| {
        let (from, to) = (Moment::from_micros(from), Moment::from_micros(to));
        let mut all = Vec::new();
        let stretch = TimeRange {
            from,
            to,
            wire: true,
        };
        let damage = file.entries(stretch, |entry| {
            all.extend(atoms(&entry));
            ControlFlow::Continue(())
        });
        assert_eq!(damage.unwrap(), crate::record::file::Damage::default());
        let inside = |atom: &&Atom| match atom {
            Atom::Group(_, _, at, _) => (from..=to).contains(at),
            Atom::Other(entry) => (from..=to).contains(&entry.at()),
        };
        let wanted: Vec<Atom> = parts.wanted.iter().filter(inside).cloned().collect();
        all.retain(|atom| wanted.contains(atom));
        (all, wanted)
    };
    for (from, to) in [
        (4_500_000, 5_900_000),
        (2_000_000, 2_100_000),
        (9_000_000, 20_000_000),
    ] {
        let (all, wanted) = stretch(from, to);
        assert!(wanted.len() > 50 && all.len() >= wanted.len(), "{from}");
        assert!(all.starts_with(&wanted[..1]) && all.ends_with(&wanted[wanted.len() - 1..]));
    }
}

#[test]
fn files_are_known_by_what_they_say_and_what_is_missing_is_told() {
    let parts = Parts::new();
    let rename = |from: &str, to: &str| std::fs::rename(parts.path(from), parts.path(to)).unwrap();
    rename("a.mcap", "z first.mcap");
    assert_eq!(
        parts.open("a-3.mcap").0,
        ["z first.mcap", "a-2.mcap", "a-3.mcap"]
    );
    // A missing one amid, and one alone.
    rename("a-2.mcap", "a-2.gone");
    let (names, all, remarks) = parts.open("z first.mcap");
    assert_eq!(names, ["z first.mcap", "a-3.mcap"]);
    assert_eq!(remarks, [Remark::FilesMissing(1)]);
    assert!(all.len() > parts.wanted.len() / 2 && all.len() < parts.wanted.len());
    std::fs::remove_file(parts.path("z first.mcap")).unwrap();
    let (names, all, remarks) = parts.open("a-3.mcap");
    assert_eq!((names.len(), remarks), (1, vec![Remark::FilesMissing(2)]));
    assert!(!all.is_empty() && parts.wanted.ends_with(&all[all.len() - 1..]));
}

#[test]
fn recordings_of_one_folder_are_told_apart_and_a_copy_is_one_of_its_own() {
    let parts = Parts::new();
    let other = Opening {
        began: Moment::from_micros(2_000_001),
        ..opening()
    };
    record(other, parts.path("b.mcap"), &entries(8, 2000));
    std::fs::copy(parts.path("a.mcap"), parts.path("a (1).mcap")).unwrap();
    std::fs::write(parts.path("c.mcap"), super::bytes_of(&entries(9, 10))).unwrap();
    std::fs::write(parts.path("d.mcap"), "no recording").unwrap();
    let paths = std::fs::read_dir(parts.folder.path()).unwrap();
    let found = recordings(paths.map(|entry| entry.unwrap().path()).collect());
    let mut names: Vec<Vec<String>> = found
        .iter()
        .map(|files| files.iter().map(|path| name_of(path)).collect())
        .collect();
    names.sort();
    let wanted: [&[&str]; 5] = [
        &["a (1).mcap"],
        &["a.mcap", "a-2.mcap", "a-3.mcap"],
        &["b.mcap", "b-2.mcap"],
        &["c.mcap"],
        &["d.mcap"],
    ];
    assert_eq!(names, wanted);
    assert_eq!(parts.open("a (1).mcap").0, ["a (1).mcap"]);
}

#[test]
fn the_index_tells_the_crates_own_readers_of_every_message() {
    let parts = Parts::new();
    let bytes = std::fs::read(parts.path("a-2.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let by_index = summary.chunk_indexes.iter().flat_map(|chunk| {
        let stream = summary.stream_chunk(&bytes, chunk).unwrap();
        stream.map(Result::unwrap)
    });
    let count = mcap::MessageStream::new(&bytes).unwrap().count();
    assert!(count > 3000);
    assert_eq!(by_index.count(), count);
    assert_eq!(summary.stats.unwrap().message_count, count as u64);
    assert_eq!(summary.attachment_indexes.len(), 1);
}
