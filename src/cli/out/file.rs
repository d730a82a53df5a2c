//! New output files at a path given by the user, readable only by their owner.

use crate::cli::out::failure::FailureKind;
use crate::store::write_new;
use anyhow::Context as _;
use std::io::ErrorKind;
use std::path::Path;

/// Checks that nothing exists at a path before a long operation on the hand. `option` is the option that names it.
///
/// # Errors
/// The path exists.
pub(crate) fn nothing_at(path: &Path, option: &str) -> anyhow::Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(taken(path, option));
    }
    Ok(())
}

/// Writes a new file at the path that `--out` names.
///
/// # Errors
/// The path exists, or the I/O error of the system.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let error = match write_new(path, bytes) {
        Ok(()) => return Ok(()),
        Err(error) => error,
    };
    if error.kind() == ErrorKind::AlreadyExists {
        return Err(taken(path, "--out"));
    }
    Err(error).with_context(|| format!("cannot write {}", path.display()))
}

fn taken(path: &Path, option: &str) -> anyhow::Error {
    let path = path.display();
    FailureKind::File.error(format!(
        "{path} already exists and is not overwritten; name another file with {option}"
    ))
}
