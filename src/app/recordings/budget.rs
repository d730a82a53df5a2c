//! Selects the recordings to delete when they exceed the storage budget: the oldest first, none that the user has marked. A
//! recording is deleted automatically only a day after its deletion was announced.

use crate::app::recordings::about::RecordingAbout;
use crate::app::recordings::item::RecordingItem;
use crate::record::file::parts;
use crate::store::toml_file::{self, FileText};
use crate::store::{calendar, replace};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Minimum time between the announcement and the automatic deletion: the user has until the next day to object.
pub const DELETION_NOTICE: Duration = Duration::from_secs(24 * 3600);
/// File next to the recordings that lists the announced deletions.
const FILE_NAME: &str = "to-delete.toml";
/// Maximum size in bytes: room for about a thousand recordings.
const FILE_LEN_MAX: u64 = 1024 * 1024;

/// A recording scheduled for deletion, and the time of the announcement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedDeletion {
    /// The recording's file, or the first of several.
    pub path: PathBuf,
    /// Total size when announced. A recording that has grown since counts as a different one.
    pub bytes: u64,
    /// Time of the announcement, in seconds since 1970.
    pub told_unix_s: u64,
}

/// File format of a folder's announced deletions.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct AnnouncedFile {
    #[serde(rename = "session")]
    recordings: Vec<PlannedDeletion>,
}

/// Storage limit, and the files that must not be deleted.
#[derive(Debug)]
pub struct RecordingRoom<'a> {
    /// Maximum total size of all recordings in bytes.
    pub limit: u64,
    /// Files that are being recorded or replayed.
    pub in_use: &'a [PathBuf],
}

impl PlannedDeletion {
    /// Earliest time of automatic deletion, in seconds since 1970.
    pub const fn due_unix_s(&self) -> u64 {
        self.told_unix_s.saturating_add(DELETION_NOTICE.as_secs())
    }

    /// The due time in local time, `2026-11-22 09:30`.
    pub fn due(&self) -> String {
        let (day, time) = calendar::local(Duration::from_secs(self.due_unix_s()));
        format!("{day} {time}")
    }

    /// Deletes the recording and its metadata, unless it has changed or the user has marked it since. Returns true if it was
    /// deleted.
    pub(crate) fn carry_out(&self) -> io::Result<bool> {
        let sizes = parts::of(&self.path).into_iter();
        let sizes = sizes.map(|file| std::fs::metadata(file).map(|about| about.len()));
        let is_same = match sizes.sum::<io::Result<u64>>() {
            Ok(bytes) => bytes == self.bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
            Err(error) => return Err(error),
        };
        let about = RecordingAbout::load(&self.path);
        // Unreadable metadata may contain a star.
        if !is_same || about.map_or(true, |about| about.is_kept(0)) {
            return Ok(false);
        }
        delete(&self.path).map(|()| true)
    }
}

/// Deletes a recording, its last file first, and its metadata.
pub(crate) fn delete(recording: &Path) -> io::Result<()> {
    for file in parts::of(recording).iter().rev() {
        std::fs::remove_file(file)?;
    }
    // Not every recording has a metadata file.
    let _removed = std::fs::remove_file(RecordingAbout::path(recording));
    Ok(())
}

/// Selects the recordings to delete until the rest fits the limit; `items` is sorted newest first. Recordings that are in use
/// or have a star, a name or notes are exempt. An earlier announcement keeps its time, unless the file has changed or the
/// clock was set back.
pub fn plan(
    items: &[RecordingItem],
    room: &RecordingRoom<'_>,
    announced: &[PlannedDeletion],
    now_unix_s: u64,
) -> Vec<PlannedDeletion> {
    let mut bytes: u64 = items.iter().map(|item| item.bytes).sum();
    let mut planned = Vec::new();
    for item in items.iter().rev() {
        if bytes <= room.limit {
            break;
        }
        if item.about.is_kept(item.counts.notes) || item.is_in(room.in_use) {
            continue;
        }
        bytes = bytes.saturating_sub(item.bytes);
        let same = |known: &&PlannedDeletion| {
            known.path == item.path && known.bytes == item.bytes && known.told_unix_s <= now_unix_s
        };
        planned.push(PlannedDeletion {
            path: item.path.clone(),
            bytes: item.bytes,
            told_unix_s: announced
                .iter()
                .find(same)
                .map_or(now_unix_s, |known| known.told_unix_s),
        });
    }
    planned
}

/// The planned deletions that are due: only those in the list of announcements read from disk.
pub fn due(
    planned: &[PlannedDeletion],
    announced: &[PlannedDeletion],
    now_unix_s: u64,
) -> Vec<PlannedDeletion> {
    let is_due = |one: &&PlannedDeletion| announced.contains(one) && one.due_unix_s() <= now_unix_s;
    planned.iter().filter(is_due).cloned().collect()
}

/// Loads the announced deletions of a folder. If the file is unreadable, the list is empty and they are announced
/// again.
pub(crate) fn load_announced(folder: &Path) -> Vec<PlannedDeletion> {
    let path = announced_path(folder);
    let read = toml_file::load(&path, FILE_LEN_MAX, |text| FileText::plain(text).parse());
    read.map(|file: AnnouncedFile| file.recordings)
        .unwrap_or_default()
}

/// Saves the announced deletions of a folder.
pub(crate) fn save_announced(folder: &Path, recordings: Vec<PlannedDeletion>) -> io::Result<()> {
    let text = toml::to_string_pretty(&AnnouncedFile { recordings }).map_err(io::Error::other)?;
    replace(&announced_path(folder), text.as_bytes())
}

/// Path of the file with the announced deletions.
pub(crate) fn announced_path(folder: &Path) -> PathBuf {
    folder.join(FILE_NAME)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Moment;
    use crate::record::file::writer::RecordingWriter;
    use crate::record::file::{Counts, Opening, Part};
    use crate::record::{Entry, LinkState, Record};
    use std::sync::Arc;

    const DAY_S: u64 = 24 * 3600;
    const NOW_S: u64 = 100 * DAY_S;

    fn item(name: &str, bytes: u64) -> RecordingItem {
        RecordingItem {
            opening: Opening::unknown(0),
            path: name.into(),
            files: vec![name.into()],
            bytes,
            first: Moment::ZERO,
            length: Duration::ZERO,
            counts: Counts::default(),
            marks: Vec::new(),
            strip: Vec::new(),
            poses: Arc::default(),
            closed: true,
            about: RecordingAbout::default(),
        }
    }

    fn announced(name: &str, bytes: u64, told_unix_s: u64) -> PlannedDeletion {
        PlannedDeletion {
            path: name.into(),
            bytes,
            told_unix_s,
        }
    }

    /// The newest first; each needs ten bytes.
    fn items() -> Vec<RecordingItem> {
        ["d", "c", "b", "a"].map(|name| item(name, 10)).into()
    }

    fn names(planned: &[PlannedDeletion]) -> Vec<&str> {
        planned.iter().filter_map(|one| one.path.to_str()).collect()
    }

    #[test]
    fn the_oldest_go_until_the_rest_fits_and_what_a_person_cares_for_stays() {
        let check = |limit, in_use: &[PathBuf], change: fn(&mut RecordingItem), wanted: &[&str]| {
            let mut items = items();
            // The oldest.
            items.last_mut().map(change).unwrap();
            let planned = plan(&items, &RecordingRoom { limit, in_use }, &[], NOW_S);
            assert_eq!(names(&planned), wanted, "{limit} {in_use:?}");
            assert!(planned.iter().all(|one| one.told_unix_s == NOW_S));
        };
        check(40, &[], |_| (), &[]);
        check(39, &[], |_| (), &["a"]);
        check(15, &[], |_| (), &["a", "b", "c"]);
        check(25, &[], |item| item.about.star = true, &["b", "c"]);
        check(
            25,
            &[],
            |item| item.about.name = "grasp".into(),
            &["b", "c"],
        );
        check(25, &[], |item| item.counts.notes = 1, &["b", "c"]);
        check(25, &["a".into()], |_| (), &["b", "c"]);
        check(0, &["d".into()], |item| item.about.star = true, &["b", "c"]);
    }

    #[test]
    fn only_what_was_told_a_day_before_and_did_not_change_is_due() {
        let check = |known: PlannedDeletion, is_due: bool, told_unix_s: u64| {
            let room = RecordingRoom {
                limit: 30,
                in_use: &[],
            };
            let known = [known];
            let planned = plan(&items(), &room, &known, NOW_S);
            assert_eq!(names(&planned), ["a"]);
            assert_eq!(planned[0].told_unix_s, told_unix_s, "{known:?}");
            let wanted: &[&str] = if is_due { &["a"] } else { &[] };
            assert_eq!(names(&due(&planned, &known, NOW_S)), wanted, "{known:?}");
        };
        check(announced("a", 10, NOW_S - DAY_S), true, NOW_S - DAY_S);
        check(
            announced("a", 10, NOW_S - DAY_S + 1),
            false,
            NOW_S - DAY_S + 1,
        );
        check(announced("a", 10, 0), true, 0);
        // Announced for another recording, with another size, or at a future time.
        check(announced("b", 10, 0), false, NOW_S);
        check(announced("a", 9, 0), false, NOW_S);
        check(announced("a", 10, NOW_S + 1), false, NOW_S);
    }

    #[test]
    fn what_was_told_is_kept_and_what_cannot_be_read_was_not_told() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(load_announced(folder.path()), []);
        let all = vec![announced("a", 10, 5), announced("捏", 7, 6)];
        save_announced(folder.path(), all.clone()).unwrap();
        assert_eq!(load_announced(folder.path()), all);
        let written = std::fs::read_to_string(folder.path().join(FILE_NAME)).unwrap();
        assert!(written.contains("[[session]]"), "{written}");
        std::fs::write(folder.path().join(FILE_NAME), "session = 3").unwrap();
        assert_eq!(load_announced(folder.path()), []);
    }

    #[test]
    fn a_file_that_changed_or_got_a_star_meanwhile_is_not_deleted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mcap");
        let mut planned = announced("", 3, 0);
        planned.path.clone_from(&path);
        std::fs::write(&path, "longer").unwrap();
        assert!(!planned.carry_out().unwrap());
        std::fs::write(&path, "abc").unwrap();
        for about in ["star = true", "name = \"x\"", "no toml at all"] {
            std::fs::write(RecordingAbout::path(&path), about).unwrap();
            assert!(!planned.carry_out().unwrap() && path.exists(), "{about}");
        }
        std::fs::write(RecordingAbout::path(&path), "star = false").unwrap();
        assert!(planned.carry_out().unwrap());
        assert!(!path.exists() && !RecordingAbout::path(&path).exists());
        assert!(!planned.carry_out().unwrap(), "it is gone already");
    }

    #[test]
    fn all_files_of_a_recording_go_and_only_if_none_changed() {
        let folder = tempfile::tempdir().unwrap();
        for (number, name) in (1..).zip(["a.mcap", "a-2.mcap", "a-3.mcap"]) {
            let at = Moment::from_micros(u64::from(number) * 1_000_000);
            let mut writer = RecordingWriter::new(&Opening {
                began: at,
                part: Some(Part {
                    recording_began: Moment::from_micros(1_000_000),
                    number,
                }),
                ..Opening::unknown(0)
            })
            .unwrap();
            let state = LinkState::Monitoring;
            writer
                .push(&Entry::Heard(Record::State { at, state }))
                .unwrap();
            writer.finish().unwrap();
            std::fs::write(folder.path().join(name), writer.take_bytes()).unwrap();
        }
        let another = folder.path().join("another.mcap");
        std::fs::write(&another, "abc").unwrap();
        let (item, unread) = RecordingItem::read(&super::parts::of(&folder.path().join("a.mcap")));
        let item = item.unwrap();
        assert_eq!((item.files.len(), unread.len()), (3, 0));
        let mut planned = announced("", item.bytes - 1, 0);
        planned.path.clone_from(&item.path);
        assert!(!planned.carry_out().unwrap(), "it grew since");
        assert!(item.files.iter().all(|file| file.exists()));
        planned.bytes = item.bytes;
        assert!(planned.carry_out().unwrap());
        assert!(item.files.iter().all(|file| !file.exists()) && another.exists());
    }
}
