//! Atomic file replacement and size-limited reads. Files and folders that the program creates are accessible only to the user who
//! runs it. Existing folders keep their permissions.

use std::fs::{DirBuilder, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
#[cfg(unix)]
use std::os::unix::fs::{DirBuilderExt as _, OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

/// Maximum number of set-aside unreadable files; after that the last one is replaced.
const UNREADABLE_MAX: u32 = 9;

/// Creates a folder that only its owner can enter, including missing parents.
///
/// # Errors
/// The system's error.
pub fn create_folder(path: &Path) -> io::Result<()> {
    let mut folder = DirBuilder::new();
    folder.recursive(true);
    #[cfg(unix)]
    folder.mode(0o700);
    folder.create(path)
}

/// Creates a folder for results, which must be new or empty.
///
/// # Errors
/// The system's error, or `AlreadyExists` if the folder is not empty.
pub fn create_empty_folder(path: &Path) -> io::Result<()> {
    create_folder(path)?;
    if std::fs::read_dir(path)?.next().is_some() {
        let kind = io::ErrorKind::AlreadyExists;
        return Err(io::Error::new(kind, "the folder is not empty"));
    }
    Ok(())
}

/// Creates or truncates a file that only its owner can read.
fn create_file(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    options.mode(0o600);
    let file = options.open(path)?;
    // An earlier version may have created it with other permissions.
    #[cfg(unix)]
    file.set_permissions(std::fs::Permissions::from_mode(0o600))?;
    Ok(file)
}

/// Writes a file that only its owner can read; creates its folder if missing, equally private.
///
/// # Errors
/// The system's error.
pub fn write_private(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    create_file(path)?.write_all(bytes)
}

/// Writes a file that only its owner can read, at a path where neither a file nor a link exists.
///
/// # Errors
/// The system's error. Then the new file does not exist, and an existing one is unchanged.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    options.mode(0o600);
    let written = options.open(path)?.write_all(bytes);
    if written.is_err() {
        // A partial file would block the name for the next attempt.
        let _gone = std::fs::remove_file(path);
    }
    written
}

/// Appends to a file that only its owner can read, in one write: others may append at the same time.
///
/// # Errors
/// The system's error; part of the text may have been written.
pub fn append_private(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    let mut options = OpenOptions::new();
    options.append(true).create(true);
    #[cfg(unix)]
    options.mode(0o600);
    options.open(path)?.write_all(text.as_bytes())
}

/// Replaces a file atomically: at any moment either the whole old or the whole new file exists. Follows a symbolic link to its
/// target.
///
/// # Errors
/// The system's error. Then the old file is unchanged.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    let target = std::fs::canonicalize(path).or_else(|_none| {
        let to = std::fs::read_link(path)?;
        Ok::<_, io::Error>(path.with_file_name("").join(to))
    });
    let path = &target.unwrap_or_else(|_no_link| path.to_owned());
    let end = path.extension().and_then(|end| end.to_str());
    let new = path.with_extension(format!("new.{}", end.unwrap_or_default()));
    let mut file = create_file(&new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    drop(file);
    std::fs::rename(&new, path)
}

/// Replaces a file like [`replace`]; the old file remains beside it as `….last.toml`.
///
/// # Errors
/// The system's error. Then the old file is unchanged.
pub fn replace_keeping_last(path: &Path, text: &str) -> io::Result<()> {
    if path.exists() {
        write_private(&last_of(path), &std::fs::read(path)?)?;
    }
    replace(path, text.as_bytes())
}

/// Path of the previous version of a file.
pub fn last_of(path: &Path) -> PathBuf {
    path.with_extension("last.toml")
}

/// Reads a text file; `None` if it does not exist.
///
/// # Errors
/// The system's error; a file of more than `limit` bytes; a path that is not a regular file.
pub fn read_text(path: &Path, limit: u64) -> io::Result<Option<String>> {
    let about = match std::fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        about => about?,
    };
    if !about.is_file() {
        let kind = if about.is_dir() {
            io::ErrorKind::IsADirectory
        } else {
            io::ErrorKind::InvalidInput
        };
        return Err(io::Error::new(kind, "it is not a file"));
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

/// Renames an unreadable file; returns the new path, or `None` if that failed.
pub fn set_aside(path: &Path) -> Option<PathBuf> {
    let name = |number: u32| path.with_extension(format!("unreadable-{number}.toml"));
    let free = (1..UNREADABLE_MAX).map(name).find(|aside| !aside.exists());
    let aside = free.unwrap_or_else(|| name(UNREADABLE_MAX));
    std::fs::rename(path, &aside).ok().map(|()| aside)
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn mode(path: &Path) -> u32 {
        std::fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn a_link_goes_on_leading_to_the_file_that_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [link, elsewhere] = ["settings.toml", "elsewhere"].map(|name| folder.path().join(name));
        let file = elsewhere.join("kept.toml");
        std::fs::create_dir(&elsewhere).unwrap();
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        replace_keeping_last(&link, "new").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(std::fs::read_to_string(last_of(&link)).unwrap(), "old");
        // Also where the file is not there yet.
        std::fs::remove_file(&file).unwrap();
        replace(&link, b"newer").unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "newer");
    }

    #[test]
    fn what_is_kept_is_for_its_person_alone_and_a_folder_that_is_there_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let open = folder.path().join("open");
        std::fs::create_dir(&open).unwrap();
        std::fs::set_permissions(&open, std::fs::Permissions::from_mode(0o755)).unwrap();
        let path = open.join("new/deep/kept.toml");
        // What an earlier version wrote, also where a write of it was cut off.
        create_folder(path.parent().unwrap()).unwrap();
        for name in ["kept.toml", "kept.new.toml"] {
            let old = path.with_file_name(name);
            std::fs::write(&old, "old").unwrap();
            std::fs::set_permissions(&old, std::fs::Permissions::from_mode(0o644)).unwrap();
        }
        replace_keeping_last(&path, "new").unwrap();
        for file in [&path, &last_of(&path)] {
            assert_eq!(mode(file), 0o600, "{}", file.display());
        }
        for made in [open.join("new"), open.join("new/deep")] {
            assert_eq!(mode(&made), 0o700, "{}", made.display());
        }
        assert_eq!(mode(&open), 0o755);
    }
}
