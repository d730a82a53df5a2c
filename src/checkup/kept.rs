//! The check-ups of one hand, one line of JSON each, the first for ever: its birth record.

use crate::checkup::measure::Measured;
use crate::store::replace_keeping_last;
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Check-ups kept of a hand: the first, and the last of them.
pub const KEPT_MAX: usize = 200;

/// One check-up that was done to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// When, universal time.
    pub at: String,
    /// The hand, as an endpoint.
    pub hand: String,
    pub figures: Vec<Measured>,
}

/// The file of the hand at an endpoint, told by place and id.
pub fn file_of(folder: &Path, hand: &Endpoint) -> PathBuf {
    let (place, id) = hand.place_and_id();
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '.';
    let plain = |letter| if is_plain(letter) { letter } else { '_' };
    let place: String = place.chars().map(plain).collect();
    folder.join(format!("{place}-id{id}.jsonl"))
}

/// The check-ups in a file, oldest first; none where there is no file.
///
/// # Errors
/// The system's, or that a line is none of ours.
pub fn read(file: &Path) -> io::Result<Vec<Kept>> {
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(error),
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let kept: Result<Vec<Kept>, _> = lines.map(serde_json::from_str).collect();
    kept.map_err(io::Error::from)
}

/// Adds one to those of a file, whole or not at all.
///
/// # Errors
/// The system's.
pub fn add(file: &Path, before: &[Kept], kept: Kept) -> io::Result<()> {
    let first = before.first().cloned();
    let later = before.iter().skip(1).cloned();
    let skipped = before.len().saturating_sub(KEPT_MAX - 1);
    let all = first.into_iter().chain(later.skip(skipped)).chain([kept]);
    let lines: Result<Vec<String>, _> = all.map(|kept| serde_json::to_string(&kept)).collect();
    replace_keeping_last(file, &(lines?.join("\n") + "\n"))
}
