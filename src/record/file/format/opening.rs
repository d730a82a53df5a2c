//! What a recording file says of itself at its beginning.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use mcap::records::{Record, op};
use std::collections::BTreeMap;
use std::time::Duration;

/// The name of what is said of a recording among a file's metadata.
pub(crate) const METADATA: &str = "handscope";

/// Which file of a recording it is: a long one goes on in a new file each hour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part {
    /// When the recording began. By this, the hand and [`Opening::base_nanos`] its files know each other.
    pub recording_began: Moment,
    /// The first is 1.
    pub number: u32,
}

/// What a recording begins with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opening {
    /// The time of [`Moment::ZERO`], nanoseconds since 1970.
    pub base_nanos: u64,
    /// When the recording began.
    pub began: Moment,
    /// The hand's endpoint.
    pub hand: String,
    /// Whether it is the built-in hand.
    pub simulated: bool,
    /// The hand's side, as the user said.
    pub side: Side,
    /// The program's version.
    pub version: String,
    /// `None` if it is all there is: of a version without parts, or not recorded, but made of something else.
    pub part: Option<Part>,
}

impl Opening {
    /// The time of [`Moment::ZERO`] where the day is not known: a second after 1970, because 0 is no time of a message.
    pub const NO_DATE: u64 = 1_000_000_000;
    /// Ends the version of a recording that was read from values.
    pub const IMPORTED: &'static str = "(imported)";

    /// Of a file that says nothing of itself, whose first message is of this time: neither the hand nor its side is known.
    pub const fn unknown(first_nanos: u64) -> Self {
        Self {
            base_nanos: first_nanos,
            began: Moment::ZERO,
            hand: String::new(),
            simulated: false,
            side: Side::Right,
            version: String::new(),
            part: None,
        }
    }

    /// Whether it is the built-in hand; `None` if nobody knows which hand it is.
    pub const fn is_simulated(&self) -> Option<bool> {
        if self.hand.is_empty() {
            None
        } else {
            Some(self.simulated)
        }
    }

    /// True if the recording was read from values: its events stand in it as they were written, and the day is not known.
    pub fn is_imported(&self) -> bool {
        self.version.ends_with(Self::IMPORTED)
    }

    /// Of a recording that begins now, at this moment of the program and this time since 1970. The hand is its endpoint.
    pub fn begin(hand: String, (now, since_1970): (Moment, Duration), side: Side) -> Self {
        let zero = since_1970.saturating_sub(now.since(Moment::ZERO));
        Self {
            base_nanos: u64::try_from(zero.as_nanos()).unwrap_or_default(),
            began: now,
            simulated: hand.starts_with("sim:"),
            hand,
            side,
            version: env!("CARGO_PKG_VERSION").into(),
            part: None,
        }
    }

    /// When the recording began, by the computer's clock.
    pub fn began_since_1970(&self) -> Duration {
        Duration::from_nanos(nanos_of(self.base_nanos, self.began))
    }

    /// The name of its file: the time of day out of `2026-11-21T09:30:00Z`, and the hand's kind and place without anything that a
    /// file system could object to.
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

    /// The same by another clock, which is so many nanoseconds after the one that it tells of. It counts from the beginning, as the
    /// program itself may have begun before that clock's first moment.
    pub(crate) fn moved(self, nanos: i64) -> Self {
        let began = nanos_of(self.base_nanos, self.began);
        Self {
            base_nanos: began.saturating_add_signed(nanos),
            began: Moment::ZERO,
            part: None,
            ..self
        }
    }

    /// What stands in a file.
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
        map.insert(CHECK.into(), check(&map));
        map
    }

    /// From the content of a record of metadata; `None` if it is another.
    pub(crate) fn of_record(content: &[u8]) -> Option<Self> {
        match mcap::parse_record(op::METADATA, content) {
            Ok(Record::Metadata(read)) if read.name == METADATA => {
                Self::of_metadata(&read.metadata)
            }
            _ => None,
        }
    }

    /// From what stands in a file; `None` if it is not ours.
    pub(crate) fn of_metadata(map: &BTreeMap<String, String>) -> Option<Self> {
        // A flipped digit here would put the whole recording at another time.
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

/// The keys of which file of a recording it is.
const RECORDING: &str = "recording_micros";
const PART: &str = "part";

fn part(map: &BTreeMap<String, String>) -> Option<Part> {
    Some(Part {
        recording_began: Moment::from_micros(map.get(RECORDING)?.parse().ok()?),
        number: map.get(PART)?.parse().ok()?,
    })
}

/// The key of the sum over all others: MCAP has none over metadata.
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
