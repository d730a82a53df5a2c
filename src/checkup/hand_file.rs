//! Files with what is known of one hand as JSON, beside the settings: where they are, read and replaced. Knows no content.

use crate::store::{read_text, replace};
use crate::transport::Endpoint;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io;
use std::path::{Path, PathBuf};

/// Maximum size of such a file, bytes.
const FILE_MAX: u64 = 256 << 10;

/// The file of the hand at an endpoint in this folder beside the settings; `None` for the built-in hand, which differs on each start.
pub fn file_of(settings: &Path, folder: &str, hand: &Endpoint) -> Option<PathBuf> {
    let folder = settings.with_file_name(folder);
    (!hand.is_sim()).then(|| folder.join(format!("{}.json", hand.file_stem())))
}

/// Reads what is stored; the default if there is no file.
///
/// # Errors
/// An I/O error, or the file does not parse.
pub fn read<T: DeserializeOwned + Default>(file: &Path) -> io::Result<T> {
    let text = read_text(file, FILE_MAX)?;
    let known = text.map(|text| serde_json::from_str(&text)).transpose();
    Ok(known?.unwrap_or_default())
}

/// Replaces what is stored.
///
/// # Errors
/// The I/O error.
pub fn keep<T: Serialize>(file: &Path, known: &T) -> io::Result<()> {
    replace(file, (serde_json::to_string(known)? + "\n").as_bytes())
}
