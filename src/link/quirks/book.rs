//! Quirks of each hand, stored across program starts and compared with its present replies. Nothing stored here is ever
//! sent to a hand.

use crate::hand::register::BytePacking;
use crate::link::quirks::{GapRead, Quirks, TouchDoubt, TouchVariant};
use crate::record::quirk_sheet::QuirkSheet;
use crate::store::{read_text, replace_keeping_last};
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// File version written by this program. Books of a later version are read as far as they are understood, and never written.
pub const VERSION: u32 = 1;
/// Maximum hands in a book; the one not seen for longest is dropped first.
const SHEETS_MAX: usize = 200;
/// Maximum file length: a book is some pages of text.
const FILE_LEN_MAX: u64 = 1024 * 1024;

/// Sheet of the quirks found at an endpoint on a day.
pub fn sheet(endpoint: &Endpoint, quirks: &Quirks, day: &str) -> QuirkSheet {
    let (place, id) = endpoint.place_and_id();
    QuirkSheet {
        place,
        id,
        first_seen: day.into(),
        last_seen: day.into(),
        hand_id: quirks.hand_id,
        baud_code: quirks.baud_code,
        packing: quirks.packing.map(|packing| packing_name(packing).into()),
        gap: quirks.gap.map(|gap| gap_name(gap).into()),
        touch: quirks.touch.map(|touch| touch_name(touch).into()),
        others: toml::Table::new(),
    }
}

/// All sheets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct QuirkBook {
    /// Version of the file format.
    pub version: u32,
    /// The sheets, one per place and id.
    #[serde(rename = "hand")]
    pub hands: Vec<QuirkSheet>,
    /// Keys of a later version, preserved unchanged.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl Default for QuirkBook {
    fn default() -> Self {
        Self {
            version: VERSION,
            hands: Vec::new(),
            others: toml::Table::new(),
        }
    }
}

impl QuirkBook {
    /// Path of the book, next to the settings.
    pub fn path(settings: &Path) -> PathBuf {
        settings.with_file_name("quirks.toml")
    }

    /// Reads a book; a missing one is empty.
    ///
    /// # Errors
    /// The reason why it cannot be read. It is then left unchanged.
    pub fn load(path: &Path) -> std::io::Result<Self> {
        match read_text(path, FILE_LEN_MAX)? {
            None => Ok(Self::default()),
            Some(text) => toml::from_str(&text)
                .map_err(|error| std::io::Error::new(ErrorKind::InvalidData, error)),
        }
    }

    /// Records the sheet of a hand, and returns its previous sheet, if there was one.
    pub fn note(&mut self, now: QuirkSheet) -> Option<QuirkSheet> {
        let same = |sheet: &&mut QuirkSheet| sheet.place == now.place && sheet.id == now.id;
        if let Some(sheet) = self.hands.iter_mut().find(same) {
            let before = sheet.clone();
            sheet.update(now);
            return Some(before);
        }
        if self.hands.len() >= SHEETS_MAX {
            let oldest = (0..self.hands.len())
                .min_by_key(|at| self.hands.get(*at).map(|sheet| sheet.last_seen.clone()));
            oldest.map(|at| self.hands.remove(at));
        }
        self.hands.push(now);
        None
    }

    /// Reads the book, records a sheet and writes the book back atomically: at any moment the old or the new one exists
    /// complete. Returns the previous sheet.
    ///
    /// # Errors
    /// The system's error; a book that cannot be read or is of a later version is left unchanged.
    pub fn keep(path: &Path, now: QuirkSheet) -> std::io::Result<Option<QuirkSheet>> {
        let mut book = Self::load(path)?;
        let before = book.note(now);
        if book.version > VERSION {
            return Err(std::io::Error::new(
                ErrorKind::InvalidData,
                "the quirk sheets are of a later version",
            ));
        }
        replace_keeping_last(path, &book.to_toml())?;
        Ok(before)
    }

    /// A book with only this sheet.
    pub fn of(sheet: QuirkSheet) -> Self {
        Self {
            hands: vec![sheet],
            ..Self::default()
        }
    }

    /// The file's text.
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(self).unwrap_or_default()
    }
}

/// Name of a byte packing in quirk sheets and on the command line.
pub const fn packing_name(packing: BytePacking) -> &'static str {
    match packing {
        BytePacking::LowFirst => "low-first",
        BytePacking::HighFirst => "high-first",
        BytePacking::OnePerWord => "one-per-word",
    }
}

/// Name in sheets and in JSON.
pub const fn gap_name(gap: GapRead) -> &'static str {
    match gap {
        GapRead::Through => "through",
        GapRead::Split => "split",
    }
}

/// Name in sheets and in JSON.
pub const fn touch_name(touch: TouchVariant) -> &'static str {
    match touch {
        TouchVariant::Capacitive => "capacitive",
        TouchVariant::Resistive => "resistive",
        TouchVariant::Unknown(TouchDoubt::Empty) => "unknown: all zero",
        TouchVariant::Unknown(TouchDoubt::Force) => "unknown: impossible force",
        TouchVariant::Unknown(TouchDoubt::Direction) => "unknown: impossible direction",
        TouchVariant::Unknown(TouchDoubt::Check) => "unknown: check sum differs",
        TouchVariant::Unknown(TouchDoubt::Refused) => "unknown: not readable",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::quirk_sheet::Fact;

    fn quirks() -> Quirks {
        Quirks {
            hand_id: Some(1),
            baud_code: Some(0),
            packing: Some(BytePacking::LowFirst),
            gap: Some(GapRead::Through),
            touch: Some(TouchVariant::Capacitive),
        }
    }

    fn sheet(endpoint: &str, quirks: &Quirks, day: &str) -> QuirkSheet {
        super::sheet(&endpoint.parse().unwrap(), quirks, day)
    }

    #[test]
    fn sheets_are_kept_by_place_and_id_with_the_days_they_were_seen() {
        let folder = tempfile::tempdir().unwrap();
        let path = QuirkBook::path(&folder.path().join("deep/settings.toml"));
        let first = sheet("rtu:/dev/x?id=1", &quirks(), "2026-11-20");
        assert_eq!(QuirkBook::keep(&path, first.clone()).unwrap(), None);
        let other = sheet("rtu:/dev/x?id=2", &quirks(), "2026-11-20");
        assert_eq!(QuirkBook::keep(&path, other).unwrap(), None);
        let unlearnt = Quirks::default();
        // The user's choice of packing is part of the address, but not of the place.
        let again = sheet("rtu:/dev/x?id=1&packing=low", &unlearnt, "2026-11-21");
        assert_eq!(QuirkBook::keep(&path, again).unwrap(), Some(first));
        let book = QuirkBook::load(&path).unwrap();
        assert_eq!(book.hands.len(), 2);
        let kept = &book.hands[0];
        assert_eq!(
            (kept.first_seen.as_str(), kept.last_seen.as_str()),
            ("2026-11-20", "2026-11-21")
        );
        assert_eq!(
            kept.touch.as_deref(),
            Some("capacitive"),
            "what was known stays"
        );
    }

    #[test]
    fn another_hand_at_the_same_place_is_told_by_what_it_answers() {
        let before = sheet("tcp:h", &quirks(), "2026-11-20");
        let now = Quirks {
            hand_id: Some(2),
            gap: None,
            touch: Some(TouchVariant::Resistive),
            ..quirks()
        };
        let differences = before.differences(&sheet("tcp:h", &now, "2026-11-21"));
        let facts: Vec<Fact> = differences
            .iter()
            .map(|difference| difference.fact)
            .collect();
        assert_eq!(facts, [Fact::HandId, Fact::Touch]);
        assert_eq!(
            (differences[0].before.as_str(), differences[0].now.as_str()),
            ("1", "2")
        );
        let doubtful = Quirks {
            touch: Some(TouchVariant::Unknown(TouchDoubt::Empty)),
            ..quirks()
        };
        let same = before.differences(&sheet("tcp:h", &doubtful, "2026-11-21"));
        assert_eq!(same, [], "not knowing is no difference");
    }

    #[test]
    fn keys_of_a_later_version_survive_and_books_of_one_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("quirks.toml");
        let text = "version = 1\ncrew = 3\n[[hand]]\nplace = \"tcp:h:6000\"\nid = 255\nwarp = 9\n";
        std::fs::write(&path, text).unwrap();
        QuirkBook::keep(&path, sheet("tcp:h", &quirks(), "2026-11-21")).unwrap();
        let table: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        assert_eq!(table["crew"].as_integer(), Some(3));
        assert_eq!(table["hand"][0]["warp"].as_integer(), Some(9));
        assert_eq!(table["hand"][0]["hand_id"].as_integer(), Some(1));
        for left_alone in ["version = 2\n", "version = ", "\0"] {
            std::fs::write(&path, left_alone).unwrap();
            assert!(QuirkBook::keep(&path, sheet("tcp:h", &quirks(), "x")).is_err());
            assert_eq!(std::fs::read_to_string(&path).unwrap(), left_alone);
        }
    }

    #[test]
    fn a_book_that_is_full_forgets_the_hand_not_seen_for_longest() {
        let mut book = QuirkBook::default();
        for n in 0..=SHEETS_MAX {
            let day = format!("2026-{n:04}");
            book.note(sheet(&format!("tcp:h{n}"), &quirks(), &day));
        }
        assert_eq!(book.hands.len(), SHEETS_MAX);
        assert!(book.hands.iter().all(|sheet| sheet.place != "tcp:h0:6000"));
    }
}
