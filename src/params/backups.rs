//! Records of each hand's flash: the last save with its result, and dated backups. One folder per hand, all files in the form of
//! [`crate::params::file`]. Writes to no hand.

use crate::params::file;
use crate::params::file::{ParamsFile, SaveVerdict};
use crate::params::values::Params;
use crate::record::Saved;
use crate::store::calendar::stamp;
use crate::store::{FileError, replace_keeping_last};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Backups stored per hand; the oldest is removed first. Enough for one save a week for a year.
pub const BACKUPS_MAX: usize = 50;

/// The last confirmed save, and the last SAVE that was sent.
const SAVED: &str = "saved.toml";
const ATTEMPT: &str = "attempt.toml";

/// The folder of one hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Backups {
    folder: PathBuf,
    /// The folder used by an earlier version of this program; other hands could share its name.
    shared: PathBuf,
    hand: String,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Backup {
    pub path: PathBuf,
    /// The parameters, with date, origin and reason; or the error that prevents reading them.
    pub file: Result<ParamsFile, FileError>,
}

/// Knowledge of the flash.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Known {
    /// The last values saved by this program and confirmed by the hand.
    pub saved: Option<ParamsFile>,
    /// A later SAVE whose result is unknown.
    pub doubtful: Option<ParamsFile>,
}

/// The folder of all hands, beside the settings file.
pub fn folder_beside(settings: &Path) -> PathBuf {
    settings.with_file_name("params")
}

impl Backups {
    /// The folder of the hand at an endpoint, named after place and id like quirk sheets.
    pub fn new(folder: &Path, hand: &Endpoint) -> Self {
        let (place, id) = hand.place_and_id();
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '.';
        let place = place.replace(|letter| !is_plain(letter), "_");
        Self {
            folder: folder.join(hand.file_stem()),
            shared: folder.join(format!("{place}-id{id}")),
            hand: hand.to_string(),
        }
    }

    /// The folder of a hand at another endpoint, beside this one.
    pub fn beside(&self, hand: &Endpoint) -> Self {
        let folder = self.folder.parent().unwrap_or(&self.folder);
        Self::new(folder, hand)
    }

    /// Takes over the backups and the last save of the same hand from its former place. The last save recorded at this place belonged
    /// to another hand and is dropped; that hand's backups stay.
    ///
    /// # Errors
    /// The I/O error. Some files may have been taken over by then.
    pub fn adopt(&self, former: &Self) -> io::Result<()> {
        if self.folder == former.folder {
            return Ok(());
        }
        for path in former.backup_paths()? {
            let Some(name) = path.file_name() else {
                continue;
            };
            let own = self.folder.join("backups").join(name);
            if !own.exists() {
                replace_keeping_last(&own, &std::fs::read_to_string(&path)?)?;
            }
        }
        self.remove_old_backups()?;
        self.forget_saved()?;
        for name in [SAVED, ATTEMPT] {
            let (from, to) = (former.newest(name), self.folder.join(name));
            if from.exists() {
                replace_keeping_last(&to, &std::fs::read_to_string(from)?)?;
            }
        }
        Ok(())
    }

    fn remove_old_backups(&self) -> io::Result<()> {
        for old in self.backup_paths()?.iter().rev().skip(BACKUPS_MAX) {
            std::fs::remove_file(old)?;
        }
        Ok(())
    }

    /// The folder of this hand.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A file with these values and the current date.
    pub fn file(&self, params: &Params, why: &str, since_1970: Duration) -> ParamsFile {
        ParamsFile {
            hand: self.hand.clone(),
            at: stamp(since_1970),
            why: why.into(),
            params: params.clone(),
            ..ParamsFile::default()
        }
    }

    /// Writes a dated backup, and removes the oldest one if there are more than [`BACKUPS_MAX`].
    ///
    /// # Errors
    /// The I/O error. The caller should then write nothing to the hand.
    pub fn back_up(&self, params: &Params, why: &str, since_1970: Duration) -> io::Result<PathBuf> {
        let file = self.file(params, why, since_1970);
        let day_and_time = file.at.replace(':', "-");
        let why = why.replace(' ', "-");
        let backups = self.folder.join("backups");
        let earlier = self.backup_paths()?;
        let is_same_second = |path: &&PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| name.starts_with(&day_and_time))
        };
        // Names sort by date, because a dot sorts after a hyphen.
        let name = match earlier.iter().filter(is_same_second).count() {
            0 => format!("{day_and_time}-{why}.toml"),
            n => format!("{day_and_time}.{n:03}-{why}.toml"),
        };
        let path = backups.join(name);
        replace_keeping_last(&path, &file.to_toml())?;
        self.remove_old_backups()?;
        Ok(path)
    }

    /// The backups, oldest first.
    ///
    /// # Errors
    /// The I/O error; a missing folder holds no backups.
    pub fn backups(&self) -> io::Result<Vec<Backup>> {
        let paths = self.backup_paths()?.into_iter();
        let backups = paths.map(|path| Backup {
            file: file::load(&path),
            path,
        });
        Ok(backups.collect())
    }

    fn backup_paths(&self) -> io::Result<Vec<PathBuf>> {
        let mut paths = backups_in(&self.folder)?;
        if self.shared != self.folder {
            let earlier = backups_in(&self.shared)?.into_iter();
            paths.extend(earlier.filter(|path| self.is_of_this_hand(path)));
        }
        paths.sort_by(|one, other| one.file_name().cmp(&other.file_name()));
        Ok(paths)
    }

    /// Path of the file with this name; in the older folder if it exists only there.
    fn newest(&self, name: &str) -> PathBuf {
        let own = self.folder.join(name);
        let earlier = self.shared.join(name);
        if !own.exists() && earlier.exists() && self.is_of_this_hand(&earlier) {
            return earlier;
        }
        own
    }

    fn is_of_this_hand(&self, path: &Path) -> bool {
        let file = file::load(path).ok();
        let hand = file.and_then(|file| file.hand.parse::<Endpoint>().ok());
        let stem = hand.map(|hand| hand.file_stem());
        stem.is_some_and(|stem| self.folder.file_name() == Some(stem.as_ref()))
    }

    /// Records a SAVE before it is sent: if the program ends before the result, the file marks it as unknown.
    ///
    /// # Errors
    /// The I/O error. The caller should then not send the SAVE.
    pub fn note_attempt(&self, params: &Params, since_1970: Duration) -> io::Result<()> {
        let file = ParamsFile {
            verdict: Some(SaveVerdict::UnderWay),
            ..self.file(params, "save", since_1970)
        };
        replace_keeping_last(&self.attempt_path(), &file.to_toml())
    }

    /// Records the result of the last SAVE that was noted.
    ///
    /// # Errors
    /// An I/O error, or an invalid note. The SAVE then stays recorded with an unknown result.
    pub fn note_result(&self, saved: &Saved) -> io::Result<()> {
        let text = self.attempt_with(saved.into())?;
        if matches!(saved, Saved::Confirmed | Saved::ReadBack) {
            replace_keeping_last(&self.saved_path(), &text)?;
        }
        replace_keeping_last(&self.attempt_path(), &text)
    }

    /// Records that the last SAVE that was noted was not carried out.
    ///
    /// # Errors
    /// As [`Self::note_result`].
    pub fn note_not_done(&self) -> io::Result<()> {
        let text = self.attempt_with(SaveVerdict::Refused)?;
        replace_keeping_last(&self.attempt_path(), &text)
    }

    fn attempt_with(&self, verdict: SaveVerdict) -> io::Result<String> {
        let mut file = file::load(&self.attempt_path())?;
        file.verdict = Some(verdict);
        Ok(file.to_toml())
    }

    /// Drops the recorded saves, after the hand was reset to factory parameters.
    ///
    /// # Errors
    /// The I/O error.
    pub fn forget_saved(&self) -> io::Result<()> {
        for name in [SAVED, ATTEMPT] {
            // The second path is that of an earlier version.
            for path in [self.folder.join(name), self.newest(name)] {
                match std::fs::remove_file(path) {
                    Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// Knowledge of the flash, from the files.
    ///
    /// # Errors
    /// An invalid file; a missing one is no error.
    pub fn known(&self) -> Result<Known, FileError> {
        let optional = |path: PathBuf| {
            if path.exists() {
                file::load(&path).map(Some)
            } else {
                Ok(None)
            }
        };
        let attempt = optional(self.newest(ATTEMPT))?;
        Ok(Known {
            saved: optional(self.newest(SAVED))?,
            doubtful: attempt
                .filter(|file| file.verdict.as_ref().is_some_and(SaveVerdict::is_in_doubt)),
        })
    }

    /// Time since the last SAVE was sent, by the file's modification time, which all processes share. `None` if none was sent.
    pub fn since_attempt(&self, now: std::time::SystemTime) -> Option<Duration> {
        let written = std::fs::metadata(self.newest(ATTEMPT))
            .ok()?
            .modified()
            .ok()?;
        now.duration_since(written).ok()
    }

    fn attempt_path(&self) -> PathBuf {
        self.folder.join(ATTEMPT)
    }

    fn saved_path(&self) -> PathBuf {
        self.folder.join(SAVED)
    }
}

fn backups_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match std::fs::read_dir(folder.join("backups")) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let is_backup = path.extension().is_some_and(|end| end == "toml");
        if is_backup && path.is_file() {
            paths.push(path);
        }
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::rows::{ParamId, Value};
    use crate::record::{NotSent, SaveDoubt};

    fn record(folder: &tempfile::TempDir) -> Backups {
        let hand = "rtu:/dev/../x?id=7".parse().unwrap();
        Backups::new(folder.path(), &hand)
    }

    fn params(id: i32) -> Params {
        let mut params = Params::default();
        params.put(ParamId::HandId, Value::Number(id));
        params
    }

    fn at(seconds: u64) -> Duration {
        Duration::from_secs(1_795_219_200 + seconds)
    }

    #[test]
    fn each_hand_has_one_folder_inside_the_given_one() {
        let folder = tempfile::tempdir().unwrap();
        let names = [
            "tcp:h",
            "tcp:h?unit=1",
            "rtu:/dev/x?id=1",
            "rs485:/dev/x?id=1",
            "can:can0",
            "tcp:hand-1",
            "tcp:hand_1",
        ]
        .map(|hand| Backups::new(folder.path(), &hand.parse().unwrap()).folder);
        for (nth, name) in names.iter().enumerate() {
            assert_eq!(name.parent(), Some(folder.path()));
            assert_eq!(
                names.iter().filter(|other| *other == name).count(),
                1,
                "{nth}"
            );
        }
        assert_eq!(record(&folder).folder.parent(), Some(folder.path()));
    }

    #[test]
    fn what_an_earlier_version_kept_in_a_shared_folder_is_found_by_its_hand() {
        let folder = tempfile::tempdir().unwrap();
        let own = |hand: &str| Backups::new(folder.path(), &hand.parse().unwrap());
        let hands = ["tcp:hand-1", "tcp:hand_1"];
        let shared = own(hands[0]).shared;
        assert_eq!(shared, own(hands[1]).shared);
        for (nth, hand) in (1..).zip(hands) {
            let old = Backups {
                folder: shared.clone(),
                ..own(hand)
            };
            old.back_up(&params(nth), "before save", at(nth.unsigned_abs().into()))
                .unwrap();
        }
        // The second of them was saved last.
        let second = Backups {
            folder: shared,
            ..own(hands[1])
        };
        second.note_attempt(&params(2), at(9)).unwrap();
        second.note_result(&Saved::Confirmed).unwrap();
        for (nth, hand) in (1..).zip(hands) {
            let record = own(hand);
            let [old] = &record.backups().unwrap()[..] else {
                panic!("{hand}")
            };
            assert_eq!(old.file.as_ref().unwrap().params, params(nth));
            assert_eq!(record.known().unwrap().saved.is_some(), nth == 2, "{hand}");
            record.back_up(&params(7), "before save", at(100)).unwrap();
            assert_eq!(record.backups().unwrap().len(), 2);
        }
        own(hands[1]).forget_saved().unwrap();
        assert_eq!(own(hands[1]).known().unwrap(), Known::default());
    }

    #[test]
    fn backups_are_dated_listed_and_bounded() {
        let folder = tempfile::tempdir().unwrap();
        let record = record(&folder);
        assert_eq!(record.backups().unwrap(), []);
        let first = record.back_up(&params(1), "before save", at(0)).unwrap();
        assert!(first.ends_with("2026-11-21T00-00-00Z-before-save.toml"));
        let same_second = record.back_up(&params(2), "before save", at(0)).unwrap();
        assert_ne!(first, same_second);
        assert_eq!(file::load(&first).unwrap().params, params(1));
        for n in 1..u64::try_from(BACKUPS_MAX).unwrap() {
            record.back_up(&params(3), "before reset", at(n)).unwrap();
        }
        let backups = record.backups().unwrap();
        assert_eq!(backups.len(), BACKUPS_MAX);
        assert!(!first.exists() && same_second.exists(), "the oldest went");
        let newest = backups.last().unwrap().file.clone().unwrap();
        let about = [newest.at.as_str(), newest.why.as_str()];
        assert_eq!(about, ["2026-11-21T00:00:49Z", "before reset"]);
    }

    #[test]
    fn what_was_known_of_a_hand_is_found_where_it_went() {
        let folder = tempfile::tempdir().unwrap();
        let old = record(&folder);
        let new = old.beside(&"rtu:/dev/../x?id=9".parse().unwrap());
        assert_eq!(new.folder.parent(), old.folder.parent());
        // A hand that was formerly at the new place.
        new.back_up(&params(9), "before save", at(0)).unwrap();
        new.note_attempt(&params(9), at(0)).unwrap();
        new.note_result(&Saved::Confirmed).unwrap();

        old.back_up(&params(7), "before apply", at(5)).unwrap();
        old.adopt(&old).unwrap();
        new.adopt(&old).unwrap();
        assert_eq!(new.known().unwrap(), Known::default(), "it never saved");
        assert_eq!(new.backups().unwrap().len(), 2);
        assert_eq!(old.backups().unwrap().len(), 1, "nothing is taken away");

        old.note_attempt(&params(7), at(9)).unwrap();
        old.note_result(&Saved::ReadBack).unwrap();
        new.adopt(&old).unwrap();
        assert_eq!(new.known().unwrap(), old.known().unwrap());
        assert_eq!(new.backups().unwrap().len(), 2, "each is there once");
        for n in 0..u64::try_from(BACKUPS_MAX).unwrap() {
            old.back_up(&params(7), "before save", at(20 + n)).unwrap();
        }
        new.adopt(&old).unwrap();
        assert_eq!(new.backups().unwrap().len(), BACKUPS_MAX);
    }

    #[test]
    fn what_is_said_of_flash_follows_the_last_save() {
        let folder = tempfile::tempdir().unwrap();
        let record = record(&folder);
        assert_eq!(record.known().unwrap(), Known::default());
        let saved = |record: &Backups| record.known().unwrap().saved.map(|file| file.params);
        let doubtful = |record: &Backups| record.known().unwrap().doubtful.map(|file| file.params);

        record.note_attempt(&params(1), at(0)).unwrap();
        assert_eq!((saved(&record), doubtful(&record)), (None, Some(params(1))));
        record.note_result(&Saved::Confirmed).unwrap();
        assert_eq!((saved(&record), doubtful(&record)), (Some(params(1)), None));

        for (end, doubted) in [
            (Saved::Failed { code: 255 }, false),
            (Saved::NotSent(NotSent::Moving), false),
            (
                Saved::Unknown {
                    why: SaveDoubt::NoResult,
                },
                true,
            ),
        ] {
            record.note_attempt(&params(2), at(9)).unwrap();
            record.note_result(&end).unwrap();
            let expected = (Some(params(1)), doubted.then(|| params(2)));
            assert_eq!((saved(&record), doubtful(&record)), expected, "{end:?}");
        }
        record.note_attempt(&params(3), at(20)).unwrap();
        record.note_result(&Saved::ReadBack).unwrap();
        let known = record.known().unwrap().saved.unwrap();
        let expected = (Some(SaveVerdict::ReadBack), params(3));
        assert_eq!((known.verdict, known.params), expected);
        assert!(
            record.since_attempt(std::time::SystemTime::now()).unwrap() < Duration::from_secs(60)
        );
        record.forget_saved().unwrap();
        assert_eq!(record.known().unwrap(), Known::default());
    }

    #[test]
    fn the_words_of_earlier_files_say_what_is_in_doubt() {
        let folder = tempfile::tempdir().unwrap();
        let record = record(&folder);
        for (word, in_doubt) in [
            ("confirmed", false),
            ("read_back", false),
            ("failed", false),
            ("refused", false),
            ("not_sent", false),
            ("unknown: under way", true),
            ("unknown: no result", true),
            ("unknown: not acknowledged", true),
            ("unknown: not read back", true),
            ("unknown: link lost", true),
            ("unknown: of a later version", true),
            ("a word of a later version", true),
        ] {
            let text = format!(
                "format = \"handscope-params\"\nversion = 1\nverdict = \"{word}\"\nhand_id = 1\n"
            );
            std::fs::create_dir_all(record.folder()).unwrap();
            std::fs::write(record.attempt_path(), text).unwrap();
            let doubtful = record.known().unwrap().doubtful;
            assert_eq!(doubtful.is_some(), in_doubt, "{word}");
            if let Some(file) = doubtful {
                assert_eq!(file.verdict_text(), word);
            }
        }
        record.note_attempt(&params(1), at(0)).unwrap();
        let attempt = std::fs::read_to_string(record.attempt_path()).unwrap();
        assert!(attempt.contains("verdict = \"unknown: under way\""));
    }
}
