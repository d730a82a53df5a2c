//! Files that a command makes where the user says: new ones, that only their person can read.

use crate::store::write_new;
use anyhow::{Context as _, bail};
use std::io::ErrorKind;
use std::path::Path;

/// Makes sure that nothing is at a path yet, before the hand is asked for long. `option` is the one that names it.
///
/// # Errors
/// Something is there.
pub(crate) fn nothing_at(path: &Path, option: &str) -> anyhow::Result<()> {
    if path.symlink_metadata().is_ok() {
        bail!("{}", taken(path, option));
    }
    Ok(())
}

/// Writes a file where nothing is yet, which `--out` names.
///
/// # Errors
/// Something is there, or what the system says.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let error = match write_new(path, bytes) {
        Ok(()) => return Ok(()),
        Err(error) => error,
    };
    if error.kind() == ErrorKind::AlreadyExists {
        bail!("{}", taken(path, "--out"));
    }
    Err(error).with_context(|| format!("cannot write {}", path.display()))
}

fn taken(path: &Path, option: &str) -> String {
    let path = path.display();
    format!("{path} is already there and is not overwritten; name another file with {option}")
}
