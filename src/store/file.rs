//! Files replaced whole or not at all, and read within a limit.

use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// Unreadable files that are kept beside each other; then the last one is replaced.
const UNREADABLE_MAX: u32 = 9;

/// Writes a file so that at any moment either the old or the new one is there, whole.
///
/// # Errors
/// What the system says. Then the old file is as it was.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let end = path.extension().and_then(|end| end.to_str());
    let new = path.with_extension(format!("new.{}", end.unwrap_or_default()));
    let mut file = std::fs::File::create(&new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    drop(file);
    std::fs::rename(&new, path)
}

/// The same; the old file stays beside the new one as `….last.toml`.
///
/// # Errors
/// What the system says. Then the old file is as it was.
pub fn replace_keeping_last(path: &Path, text: &str) -> io::Result<()> {
    if path.exists() {
        std::fs::copy(path, last_of(path))?;
    }
    replace(path, text.as_bytes())
}

/// Where the file before this one stays.
#[must_use]
pub fn last_of(path: &Path) -> PathBuf {
    path.with_extension("last.toml")
}

/// Reads a text file; `None` if there is none.
///
/// # Errors
/// What the system says; a file of more than `limit` bytes, or one that is no file.
pub fn read_text(path: &Path, limit: u64) -> io::Result<Option<String>> {
    let about = match std::fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        about => about?,
    };
    if !about.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    if about.len() > limit {
        let got = about.len();
        let what = format!("it has {got} bytes; no such file has more than {limit}");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, what));
    }
    let mut text = String::new();
    let opened = std::fs::File::open(path)?;
    opened.take(limit).read_to_string(&mut text)?;
    Ok(Some(text))
}

/// Gives an unreadable file another name; the name, if that worked.
#[must_use]
pub fn set_aside(path: &Path) -> Option<PathBuf> {
    let name = |number: u32| path.with_extension(format!("unreadable-{number}.toml"));
    let free = (1..UNREADABLE_MAX).map(name).find(|aside| !aside.exists());
    let aside = free.unwrap_or_else(|| name(UNREADABLE_MAX));
    std::fs::rename(path, &aside).ok().map(|()| aside)
}
