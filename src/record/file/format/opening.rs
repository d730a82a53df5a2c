//! The opening of a recording file, which describes the recording.

use crate::hand::kinematics::Side;
use crate::hand::{Dof, Moment, PerDof};
use mcap::records::{Record, op};
use std::collections::BTreeMap;
use std::time::Duration;

/// Name of the opening among a file's metadata records.
pub(crate) const METADATA: &str = "handscope";

/// Number of a file within its recording: a long one continues in a new file each hour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part {
    /// Start of the recording. Together with the hand and [`Opening::base_nanos`] it identifies the recording's files.
    pub recording_began: Moment,
    /// Counted from 1.
    pub number: u32,
}

/// The opening of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// Time of [`Moment::ZERO`], nanoseconds since 1970.
    pub base_nanos: u64,
    /// Start of the file.
    pub began: Moment,
    /// Endpoint of the hand.
    pub hand: String,
    /// True for the built-in hand.
    pub simulated: bool,
    /// Side of the hand, as set by the user.
    pub side: Side,
    /// Newtons of a gram of each joint; `None` where they were not measured.
    pub newtons_per_g: PerDof<Option<f64>>,
    /// Version of the program.
    pub version: String,
    /// `None` if the file is the whole recording: from a version without parts, or not recorded, but converted.
    pub part: Option<Part>,
}

impl Opening {
    /// Time of [`Moment::ZERO`] if the date is unknown: a second after 1970, because 0 is not a valid message time.
    pub const NO_DATE: u64 = 1_000_000_000;
    /// Suffix of the version of an imported recording.
    pub const IMPORTED: &'static str = "(imported)";

    /// Opening of a file that has none and whose first message is of this time: neither the hand nor its side is known.
    pub const fn unknown(first_nanos: u64) -> Self {
        Self {
            base_nanos: first_nanos,
            began: Moment::ZERO,
            hand: String::new(),
            simulated: false,
            side: Side::Right,
            newtons_per_g: PerDof::splat(None),
            version: String::new(),
            part: None,
        }
    }

    /// True for the built-in hand; `None` if the hand is unknown.
    pub const fn is_simulated(&self) -> Option<bool> {
        if self.hand.is_empty() {
            None
        } else {
            Some(self.simulated)
        }
    }

    /// True if the recording was imported from values: its events are stored as imported, and its date is unknown.
    pub fn is_imported(&self) -> bool {
        self.version.ends_with(Self::IMPORTED)
    }

    /// Opening of a recording that starts now, at this moment of the program and this time since 1970. `hand` is its endpoint.
    pub fn begin(hand: String, (now, since_1970): (Moment, Duration), side: Side) -> Self {
        let zero = since_1970.saturating_sub(now.since(Moment::ZERO));
        Self {
            base_nanos: u64::try_from(zero.as_nanos()).unwrap_or_default(),
            began: now,
            simulated: hand.starts_with("sim:"),
            hand,
            side,
            newtons_per_g: PerDof::splat(None),
            version: env!("CARGO_PKG_VERSION").into(),
            part: None,
        }
    }

    /// The same for a hand with these newtons.
    #[must_use]
    pub fn with_newtons(self, newtons_per_g: PerDof<Option<f64>>) -> Self {
        Self {
            newtons_per_g,
            ..self
        }
    }

    /// Joints with known newtons, each with those of a gram.
    pub fn newtons(&self) -> impl Iterator<Item = (Dof, f64)> + Clone {
        let all = Dof::ALL.map(|dof| (dof, self.newtons_per_g[dof]));
        all.into_iter()
            .filter_map(|(dof, newtons)| Some((dof, newtons?)))
    }

    /// Start of the file, by the computer's clock.
    pub fn began_since_1970(&self) -> Duration {
        Duration::from_nanos(nanos_of(self.base_nanos, self.began))
    }

    /// Name of its file: the time of day from a stamp such as `2026-11-21T09:30:00Z`, and the hand's kind and address without
    /// characters that a file system might reject.
    pub fn file_name(&self, stamp: &str) -> String {
        let time = stamp.chars().skip_while(|letter| *letter != 'T');
        let time: String = time.filter(char::is_ascii_digit).collect();
        let place = self.hand.split('?').next().unwrap_or_default();
        let words = place.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '.');
        let words: Vec<&str> = words
            .filter(|word| !word.is_empty() && *word != "dev")
            .collect();
        format!("{time}-{}.mcap", words.join("-"))
    }

    /// Converts to a clock that is ahead by this many nanoseconds. Moments then count from the start, because the program may
    /// have started before the first moment of that clock.
    pub(crate) fn moved(self, nanos: i64) -> Self {
        let began = nanos_of(self.base_nanos, self.began);
        Self {
            base_nanos: began.saturating_add_signed(nanos),
            began: Moment::ZERO,
            part: None,
            ..self
        }
    }

    /// Metadata record of the opening.
    pub(crate) fn metadata(&self) -> BTreeMap<String, String> {
        let side = match self.side {
            Side::Left => "left",
            Side::Right => "right",
        };
        let mut map: BTreeMap<String, String> = [
            ("format", "1".to_owned()),
            ("version", self.version.clone()),
            ("hand", self.hand.clone()),
            ("simulated", self.simulated.to_string()),
            ("side", side.to_owned()),
            ("base_nanos", self.base_nanos.to_string()),
            ("began_micros", self.began.micros().to_string()),
        ]
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect();
        if let Some(part) = self.part {
            let began = part.recording_began.micros();
            map.insert(RECORDING.into(), began.to_string());
            map.insert(PART.into(), part.number.to_string());
        }
        if self.newtons().next().is_some() {
            let newtons = self.newtons();
            let words: Vec<String> = newtons
                .map(|(dof, newtons)| format!("{}={newtons}", dof.name()))
                .collect();
            map.insert(NEWTONS.into(), words.join(" "));
        }
        map.insert(CHECK.into(), check(&map));
        map
    }

    /// Parses the content of a metadata record; `None` if it is another record.
    pub(crate) fn of_record(content: &[u8]) -> Option<Self> {
        match mcap::parse_record(op::METADATA, content) {
            Ok(Record::Metadata(read)) if read.name == METADATA => {
                Self::of_metadata(&read.metadata)
            }
            _ => None,
        }
    }

    /// Parses a file's metadata; `None` if its checksum is wrong or a value is missing.
    pub(crate) fn of_metadata(map: &BTreeMap<String, String>) -> Option<Self> {
        // A flipped digit here would shift the whole recording in time.
        if map.get(CHECK) != Some(&check(map)) {
            return None;
        }
        let text = |key: &str| map.get(key).cloned().unwrap_or_default();
        Some(Self {
            base_nanos: map.get("base_nanos")?.parse().ok()?,
            began: Moment::from_micros(map.get("began_micros")?.parse().ok()?),
            hand: text("hand"),
            simulated: text("simulated") == "true",
            side: match text("side").as_str() {
                "left" => Side::Left,
                _ => Side::Right,
            },
            newtons_per_g: newtons(&text(NEWTONS)),
            version: text("version"),
            part: part(map),
        })
    }
}

/// A moment as nanoseconds since 1970, in a file whose moments count from `base_nanos`.
pub(crate) const fn nanos_of(base_nanos: u64, at: Moment) -> u64 {
    base_nanos.saturating_add(at.micros().saturating_mul(1000))
}

/// Nanoseconds since 1970 as a moment.
pub(crate) const fn moment_of(base_nanos: u64, nanos: u64) -> Moment {
    Moment::from_micros(nanos.saturating_sub(base_nanos) / 1000)
}

/// Keys of the recording's start and the part number.
const RECORDING: &str = "recording_micros";
const PART: &str = "part";

fn part(map: &BTreeMap<String, String>) -> Option<Part> {
    Some(Part {
        recording_began: Moment::from_micros(map.get(RECORDING)?.parse().ok()?),
        number: map.get(PART)?.parse().ok()?,
    })
}

/// Key of the newtons of a gram: `index=0.0071 thumb_bend=0.0129`.
const NEWTONS: &str = "newtons_per_g";

fn newtons(words: &str) -> PerDof<Option<f64>> {
    let mut all = PerDof::splat(None);
    for (name, value) in words.split(' ').filter_map(|word| word.split_once('=')) {
        let dof = Dof::ALL.into_iter().find(|dof| dof.name() == name);
        if let (Some(dof), Ok(value)) = (dof, value.parse::<f64>()) {
            all[dof] = Some(value).filter(|value| value.is_finite() && *value > 0.0);
        }
    }
    all
}

/// Key of the checksum over all other entries, which MCAP lacks for metadata.
const CHECK: &str = "crc32";

fn check(map: &BTreeMap<String, String>) -> String {
    let mut hash = crc32fast::Hasher::new();
    for (key, value) in map.iter().filter(|(key, _)| *key != CHECK) {
        hash.update(format!("{key}={value}\n").as_bytes());
    }
    format!("{:08x}", hash.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newtons_are_read_back_and_a_hand_without_them_has_no_key() {
        let moments = (Moment::ZERO, Duration::from_secs(1));
        let plain = Opening::begin("sim:".into(), moments, Side::Left);
        assert!(!plain.metadata().contains_key(NEWTONS));
        let mut newtons = PerDof::splat(None);
        (newtons[Dof::Index], newtons[Dof::ThumbBend]) = (Some(0.0071), Some(0.012_93));
        let known = plain.with_newtons(newtons);
        let read = Opening::of_metadata(&known.metadata()).unwrap();
        assert_eq!(read, known);
        let joints: Vec<(Dof, f64)> = read.newtons().collect();
        assert_eq!(joints, [(Dof::Index, 0.0071), (Dof::ThumbBend, 0.012_93)]);
    }

    #[test]
    fn a_file_is_named_after_the_hand_without_what_file_systems_object_to() {
        let moments = (Moment::from_micros(5), Duration::from_secs(1));
        for (url, name) in [
            ("sim:", "sim"),
            ("rs485:/dev/ttyUSB0?baud=115200&id=1", "rs485-ttyUSB0"),
            ("tcp:192.168.11.210:6000", "tcp-192.168.11.210-6000"),
            ("tcp:[::1]:6000", "tcp-1-6000"),
            ("can:can0?id=3", "can-can0"),
        ] {
            let opening = Opening::begin(url.into(), moments, Side::Left);
            let named = opening.file_name("2026-11-21T09:30:00Z");
            assert_eq!(named, format!("093000-{name}.mcap"));
            assert_eq!(opening.simulated, name == "sim");
            assert_eq!(opening.began_since_1970(), Duration::from_secs(1));
        }
    }
}
