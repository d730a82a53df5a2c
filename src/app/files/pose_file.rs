//! Pose files on disk: read at start and for import, size-limited, off the window's thread. Knows no setpoint.

use crate::app::files::{put_aside, settings_file};
use crate::app::notices::NoticeKind;
use crate::poses::file;
use crate::poses::library::{LibraryPose, PoseLibrary};
use crate::poses::starter::starter;
use crate::store::{FileError, last_of, toml_file};
use std::path::{Path, PathBuf};

/// Maximum size of a pose file in bytes: four times that of five hundred poses.
const FILE_LEN_MAX: u64 = 1024 * 1024;
/// File name for export.
pub const FILE_NAME: &str = "handscope-poses.toml";

/// Path of the pose file next to these settings.
pub fn path_beside(settings: &Path) -> PathBuf {
    settings.with_file_name("poses.toml")
}

/// Reads a pose file.
///
/// # Errors
/// [`FileError`] if the file cannot be read, with the location.
pub fn read(path: &Path) -> Result<PoseLibrary, FileError> {
    toml_file::load(path, FILE_LEN_MAX, file::read)
}

/// The pose of this name, in upper or lower case: the user's own, or a shipped one; `None` if there is none.
///
/// # Errors
/// [`FileError`] if the user's file cannot be read.
pub fn named(name: &str) -> Result<Option<LibraryPose>, FileError> {
    let own = settings_file::default_path().map(|settings| path_beside(&settings));
    let own = own.filter(|path| path.exists()).map(|path| read(&path));
    let own = own.transpose()?;
    Ok([own.as_ref(), Some(starter())]
        .into_iter()
        .flatten()
        .find_map(|library| in_any_case(library, name))
        .cloned())
}

fn in_any_case<'a>(library: &'a PoseLibrary, name: &str) -> Option<&'a LibraryPose> {
    let is_same = |pose: &&LibraryPose| pose.name.to_lowercase() == name.to_lowercase();
    let exact = library.pose_named(name);
    exact.or_else(|| library.poses.iter().find(is_same))
}

/// Serializes the library.
///
/// # Errors
/// The error of the serializer.
pub fn text(library: &PoseLibrary) -> std::io::Result<String> {
    file::write(library).map_err(std::io::Error::other)
}

/// Loads the stored library, with a notice for the user about its file. An unreadable file is set aside and the last
/// good one is loaded.
pub fn load(path: &Path) -> (PoseLibrary, Option<NoticeKind>) {
    if !path.exists() {
        return (PoseLibrary::default(), None);
    }
    match read(path) {
        Ok(library) => (library, None),
        Err(error) => {
            let library = read(&last_of(path)).unwrap_or_default();
            (library, Some(put_aside(path, error)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;

    const GOOD: &str = r#"format = "handscope-poses"
version = 1

[[pose]]
name = "Pinch"
speed = 300
force = 800
angles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 }
"#;

    fn save(path: &Path, library: &PoseLibrary) -> io::Result<()> {
        crate::store::replace_keeping_last(path, &text(library)?)
    }

    #[test]
    fn a_bad_file_on_disk_is_put_aside_and_the_last_good_one_taken() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.toml");
        assert_eq!(load(&path), (PoseLibrary::default(), None));
        let good = file::read(GOOD).unwrap();
        save(&path, &good).unwrap();
        save(&path, &good).unwrap();
        std::fs::write(&path, "half a fi").unwrap();
        let (library, notice) = load(&path);
        assert_eq!(library, good);
        let Some(NoticeKind::FileIgnored {
            kept_as: Some(aside),
            ..
        }) = notice
        else {
            panic!("{notice:?}")
        };
        assert_eq!(std::fs::read_to_string(aside).unwrap(), "half a fi");
    }

    #[test]
    fn a_failed_write_leaves_the_file_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.toml");
        let good = file::read(GOOD).unwrap();
        save(&path, &good).unwrap();
        // A folder where the new file would be made: the write fails before the old file is touched.
        std::fs::create_dir(path.with_extension("new.toml")).unwrap();
        assert!(save(&path, &PoseLibrary::default()).is_err());
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            text(&good).unwrap()
        );
    }
}
