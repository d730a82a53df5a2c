//! New output files at a path given by the user, readable only by their owner.

use crate::cli::out::failure::FailureKind;
use crate::store::write_new;
use anyhow::Context as _;
use std::io::ErrorKind;
use std::path::Path;

/// Checks that nothing exists at a path. `option` is the option that names it.
///
/// # Errors
/// The path exists.
pub(crate) fn nothing_at(path: &Path, option: &str) -> anyhow::Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(taken(path, option));
    }
    Ok(())
}

/// Checks that a new file can be written at a path, before a long operation on the hand.
///
/// # Errors
/// The path exists, or the I/O error of the system.
pub(crate) fn check_new_file(path: &Path, option: &str) -> anyhow::Result<()> {
    nothing_at(path, option)?;
    let cannot = |error: std::io::Error| {
        FailureKind::File.error(format!("cannot write {}: {error}", path.display()))
    };
    match path.symlink_metadata() {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(cannot(error)),
        _ => {}
    }
    let folder = folder(path);
    // A folder that is missing is created later, where a command does so.
    if folder.is_dir() {
        tempfile::tempfile_in(folder).map_err(cannot)?;
    }
    Ok(())
}

/// Checks that the folder of a new file is there, for a command that does not create it.
///
/// # Errors
/// It is not.
pub(crate) fn check_folder(path: &Path, option: &str) -> anyhow::Result<()> {
    let folder = folder(path);
    if folder.is_dir() {
        return Ok(());
    }
    Err(FailureKind::File.error(format!(
        "there is no folder {}: make it, or name another file with {option}",
        folder.display()
    )))
}

fn folder(path: &Path) -> &Path {
    let folder = path.parent().filter(|own| *own != Path::new(""));
    folder.unwrap_or(Path::new("."))
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

/// A file that is not overwritten.
pub(crate) fn taken(path: &Path, option: &str) -> anyhow::Error {
    let path = path.display();
    FailureKind::File.error(format!(
        "{path} already exists and is not overwritten; name another file with {option}"
    ))
}
