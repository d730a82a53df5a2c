//! Files that `--out` names: new ones, that only their person can read.

use crate::store::write_new;
use anyhow::{Context as _, bail};
use std::io::ErrorKind;
use std::path::Path;

/// Asks before anything else is done whether a file can be made there.
pub(crate) fn is_free(path: &Path) -> anyhow::Result<()> {
    if path.symlink_metadata().is_ok() {
        bail!("{}", taken(path));
    }
    Ok(())
}

/// Writes a file where nothing is yet. One that could not be written whole is taken away again.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let Err(error) = write_new(path, bytes) else {
        return Ok(());
    };
    if error.kind() == ErrorKind::AlreadyExists {
        bail!("{}", taken(path));
    }
    // Nothing was there before.
    let _gone = std::fs::remove_file(path);
    Err(error).with_context(|| format!("cannot write {}", path.display()))
}

fn taken(path: &Path) -> String {
    let path = path.display();
    format!("{path} is already there and is not overwritten; name another file with --out")
}
