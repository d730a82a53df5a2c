//! What a session file says of itself at its beginning.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use std::collections::BTreeMap;

/// The name of what is said of a session among a file's metadata.
pub(crate) const METADATA: &str = "handscope";

/// What a session begins with.
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
    /// The hand's side, as the person said.
    pub side: Side,
    /// The program's version.
    pub version: String,
}

impl Opening {
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
        map.insert(CHECK.into(), check(&map));
        map
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
        })
    }
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
