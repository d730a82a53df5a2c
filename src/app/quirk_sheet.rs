//! What was found about each hand, kept from one start to the next and compared with what it answers now. Nothing kept here
//! is ever sent to a hand.

use crate::app::config::replace;
use crate::codec::modbus::BytePacking;
use crate::link::{GapRead, Quirks, TouchDoubt, TouchVariant};
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What this version writes. Books of a later version are read as far as they are understood, and never written.
pub const VERSION: u32 = 1;
/// Hands that a book holds; the one that was not seen for longest goes first.
const SHEETS_MAX: usize = 200;
/// A book is some pages of text; anything longer is not ours.
const FILE_LEN_MAX: u64 = 1024 * 1024;

/// What one hand was found to do. Keys of a later version survive in [`Self::others`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct QuirkSheet {
    /// The endpoint without the id.
    pub place: String,
    /// The id or unit that was asked.
    pub id: u16,
    /// Day of the first answer, `2026-11-21`; empty in a sheet that was never kept.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub first_seen: String,
    /// Day of the last answer.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub last_seen: String,
    /// HAND_ID as the hand gives it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand_id: Option<u8>,
    /// REDU_RATIO as the hand gives it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baud_code: Option<u8>,
    /// `low-first`, `high-first` or `one-per-word`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<String>,
    /// `through` or `split`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<String>,
    /// `capacitive`, `resistive`, or `unknown: ` and why.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub touch: Option<String>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl QuirkSheet {
    /// What was found at an endpoint on a day.
    #[must_use]
    pub fn new(endpoint: &Endpoint, quirks: &Quirks, day: &str) -> Self {
        let (place, id) = key(endpoint);
        Self {
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

    /// What this sheet says otherwise than a later one. What either does not know is no difference.
    #[must_use]
    pub fn differences(&self, now: &Self) -> Vec<Difference> {
        let number = |value: Option<u8>| value.map(|value| value.to_string());
        let touch = |sheet: &Self| {
            let known = |touch: &String| !touch.starts_with("unknown");
            sheet.touch.clone().filter(known)
        };
        [
            (Fact::HandId, number(self.hand_id), number(now.hand_id)),
            (
                Fact::BaudCode,
                number(self.baud_code),
                number(now.baud_code),
            ),
            (Fact::Packing, self.packing.clone(), now.packing.clone()),
            (Fact::Gap, self.gap.clone(), now.gap.clone()),
            (Fact::Touch, touch(self), touch(now)),
        ]
        .into_iter()
        .filter_map(|(fact, before, now)| {
            let (before, now) = (before?, now?);
            (before != now).then_some(Difference { fact, before, now })
        })
        .collect()
    }

    /// As a file of its own.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let book = QuirkBook {
            hands: vec![self.clone()],
            ..QuirkBook::default()
        };
        book.to_toml()
    }

    /// A later visit to the same hand: what was not learnt this time stays as it was.
    fn update(&mut self, now: Self) {
        self.last_seen = now.last_seen;
        self.hand_id = now.hand_id.or(self.hand_id);
        self.baud_code = now.baud_code.or(self.baud_code);
        self.packing = now.packing.or_else(|| self.packing.take());
        self.gap = now.gap.or_else(|| self.gap.take());
        self.touch = now.touch.or_else(|| self.touch.take());
    }
}

/// What two sheets may disagree about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fact {
    /// HAND_ID.
    HandId,
    /// REDU_RATIO.
    BaudCode,
    /// Bytes in words.
    Packing,
    /// The unused addresses.
    Gap,
    /// The fingertips.
    Touch,
}

/// One thing that a hand answered otherwise before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// What.
    pub fact: Fact,
    /// Then.
    pub before: String,
    /// Now.
    pub now: String,
}

/// All sheets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct QuirkBook {
    /// Of the file's form.
    pub version: u32,
    /// One for each place and id.
    #[serde(rename = "hand")]
    pub hands: Vec<QuirkSheet>,
    /// Keys of a later version, kept as they are.
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
    /// Where the book lies, beside the settings.
    #[must_use]
    pub fn path(settings: &Path) -> PathBuf {
        settings.with_file_name("quirks.toml")
    }

    /// Reads a book; one that is missing is empty.
    ///
    /// # Errors
    /// Why it cannot be read. It is then left alone.
    pub fn load(path: &Path) -> std::io::Result<Self> {
        match std::fs::metadata(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(error),
            Ok(about) if about.len() > FILE_LEN_MAX => {
                return Err(std::io::Error::other(
                    "the file is too long for quirk sheets",
                ));
            }
            Ok(_) => {}
        }
        toml::from_str(&std::fs::read_to_string(path)?).map_err(std::io::Error::other)
    }

    /// Notes what a hand answered, and gives back its sheet from before, if there was one.
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

    /// Reads the book, notes a sheet and writes the book back, so that at any moment the old or the new one is there,
    /// whole. Gives back the sheet from before.
    ///
    /// # Errors
    /// What the system says; a book that cannot be read or is of a later version is left alone.
    pub fn keep(path: &Path, now: QuirkSheet) -> std::io::Result<Option<QuirkSheet>> {
        let mut book = Self::load(path)?;
        let before = book.note(now);
        if book.version > VERSION {
            return Err(std::io::Error::other(
                "the quirk sheets are of a later version",
            ));
        }
        replace(path, &book.to_toml())?;
        Ok(before)
    }

    fn to_toml(&self) -> String {
        toml::to_string_pretty(self).unwrap_or_default()
    }
}

/// Where and whom: the endpoint without the id, and the id.
pub(crate) fn key(endpoint: &Endpoint) -> (String, u16) {
    let place = format!("{}:{}", endpoint.kind(), endpoint.place());
    match endpoint {
        Endpoint::Sim { seed, .. } => (format!("sim:?seed={seed}"), 1),
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
            (format!("{place}?baud={}", line.baud), u16::from(line.id))
        }
        Endpoint::Tcp { unit, .. } => (place, u16::from(*unit)),
        Endpoint::Can { id, .. } => (place, *id),
        Endpoint::Slcan { bitrate, id, .. } => (format!("{place}?bitrate={bitrate}"), *id),
    }
}

/// As it is written in sheets and in JSON.
#[must_use]
pub const fn packing_name(packing: BytePacking) -> &'static str {
    match packing {
        BytePacking::LowFirst => "low-first",
        BytePacking::HighFirst => "high-first",
        BytePacking::OnePerWord => "one-per-word",
    }
}

/// As it is written in sheets and in JSON.
#[must_use]
pub const fn gap_name(gap: GapRead) -> &'static str {
    match gap {
        GapRead::Through => "through",
        GapRead::Split => "split",
    }
}

/// As it is written in sheets and in JSON.
#[must_use]
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
    #![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]
    use super::*;

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
        QuirkSheet::new(&endpoint.parse().unwrap(), quirks, day)
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
        // The person's reading of words is part of the address, but not of the place.
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
