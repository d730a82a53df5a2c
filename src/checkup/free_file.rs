//! Force readings of one hand's joints in free motion, in a file per hand: written by its check-up and by each close that touched
//! nothing, and read wherever a grip is detected.

use crate::checkup::hand_file;
use crate::hand::grip::FreeForce;
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};

/// The file of the hand at an endpoint, beside the settings; `None` for the built-in hand, which differs on each start.
pub fn file_of(settings: &Path, hand: &Endpoint) -> Option<PathBuf> {
    hand_file::file_of(settings, "free-force", hand)
}

/// Reads the stored values; the default if there is no file.
///
/// # Errors
/// An I/O error, or the file does not parse.
pub fn read(file: &Path) -> io::Result<FreeForce> {
    hand_file::read(file)
}

/// Replaces the stored values.
///
/// # Errors
/// The I/O error.
pub fn keep(file: &Path, free: &FreeForce) -> io::Result<()> {
    hand_file::keep(file, free)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::Dof;
    use crate::hand::grip::FreeClose;

    #[test]
    fn each_hand_has_its_own_and_the_built_in_one_none() {
        let folder = tempfile::tempdir().unwrap();
        let settings = folder.path().join("settings.toml");
        let of = |hand: &str| file_of(&settings, &hand.parse().unwrap());
        assert_eq!(of("sim:"), None);
        let (one, other) = (
            of("rtu:/dev/x?id=1").unwrap(),
            of("rtu:/dev/x?id=2").unwrap(),
        );
        assert_eq!(read(&one).unwrap(), FreeForce::default());
        let mut close = FreeClose::default();
        close.push(240, 87.0);
        let mut free = FreeForce::default();
        free.put(Dof::Little, &close);
        keep(&one, &free).unwrap();
        assert_eq!(read(&one).unwrap().at(Dof::Little, 240), Some(87.0));
        assert_eq!(read(&other).unwrap(), FreeForce::default());
        std::fs::write(&one, r#"{"little":[1]}"#).unwrap();
        read(&one).unwrap_err();
    }
}
