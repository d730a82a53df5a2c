//! The check-ups of one hand, one line of JSON each. The first is never removed: it is the hand's birth record.

use crate::checkup::measure::Measured;
use crate::store::{read_text, replace_keeping_last};
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Check-ups stored per hand: the first, and the most recent others.
pub const KEPT_MAX: usize = 200;
/// Maximum size of the file, bytes.
const FILE_MAX: u64 = 16 << 20;

/// One completed check-up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredCheckup {
    /// Time of the check-up, UTC.
    pub at: String,
    /// The hand, as an endpoint.
    pub hand: String,
    pub figures: Vec<Measured>,
    /// The folder of its report, if it was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<PathBuf>,
}

/// The file of the hand at an endpoint, named after its place and id.
pub fn file_of(folder: &Path, hand: &Endpoint) -> PathBuf {
    folder.join(format!("{}.jsonl", hand.file_stem()))
}

/// The check-ups in a file, oldest first; empty if there is no file.
///
/// # Errors
/// An I/O error, or a line that does not parse.
pub fn read(file: &Path) -> io::Result<Vec<StoredCheckup>> {
    let text = read_text(file, FILE_MAX)?.unwrap_or_default();
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let stored: Result<Vec<StoredCheckup>, _> = lines.map(serde_json::from_str).collect();
    stored.map_err(io::Error::from)
}

/// Appends a check-up to a file, atomically; drops the oldest but the first beyond [`KEPT_MAX`].
///
/// # Errors
/// As [`read`], or a write error.
pub fn add(file: &Path, stored: StoredCheckup) -> io::Result<()> {
    let mut all = read(file)?;
    all.push(stored);
    let old = 1..all.len().saturating_sub(KEPT_MAX - 1).max(1);
    all.drain(old);
    let lines: Result<Vec<String>, _> = all.iter().map(serde_json::to_string).collect();
    replace_keeping_last(file, &(lines?.join("\n") + "\n"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::checkup::subject::{HandPart, Subject};
    use crate::hand::{Dof, Finger};

    fn stored(nth: usize) -> StoredCheckup {
        let of = [
            HandPart::Joint(Dof::ThumbBend),
            HandPart::Fingertip(Finger::Ring),
            HandPart::Hand,
        ];
        let measured = of.map(|of| Measured::new(Subject::Backlash, of, (nth > 0).then_some(1.5)));
        StoredCheckup {
            at: format!("{nth}"),
            hand: "rtu:/dev/x?id=1".into(),
            figures: measured.into(),
            report: None,
        }
    }

    #[test]
    fn the_first_stays_and_the_oldest_of_the_others_go() {
        let folder = tempfile::tempdir().unwrap();
        let file = file_of(folder.path(), &"tcp:127.0.0.1:6000".parse().unwrap());
        assert_eq!(read(&file).unwrap(), []);
        let [left, right] = ["rtu:/tmp/a-1", "rtu:/tmp/a_1"].map(|it| it.parse().unwrap());
        assert_ne!(
            file_of(folder.path(), &left),
            file_of(folder.path(), &right)
        );
        for nth in 0..KEPT_MAX + 3 {
            add(&file, stored(nth)).unwrap();
        }
        let all = read(&file).unwrap();
        assert_eq!(all.len(), KEPT_MAX);
        assert_eq!((&all[0], all[1].at.as_str()), (&stored(0), "4"));
        assert_eq!(all[KEPT_MAX - 1], stored(KEPT_MAX + 2));
        std::fs::write(&file, "no JSON\n").unwrap();
        read(&file).unwrap_err();
        // A folder, a pipe and an endless file are rejected.
        read(folder.path()).unwrap_err();
    }
}
