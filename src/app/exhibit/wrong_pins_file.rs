//! The file in which wrong PINs of an exhibition outlast a restart, next to the settings.

use crate::exhibit::pin::{TRIES, WrongPins};
use crate::store::FileText;
use crate::store::toml_file::{self, VERSION};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

const FORMAT: &str = "handscope-exhibit-pin";
/// Maximum size in bytes.
const FILE_LEN_MAX: u64 = 4096;

#[derive(Serialize, Deserialize)]
struct PinRow {
    format: String,
    version: i64,
    wrong: u32,
    waited: bool,
}

/// Path of the file.
pub(crate) fn beside(settings: &Path) -> PathBuf {
    settings.with_file_name("exhibit-pin.toml")
}

/// Loads the count. A missing file means none; an unreadable file counts as enough wrong PINs for a wait.
pub(crate) fn load(path: &Path) -> WrongPins {
    if matches!(path.try_exists(), Ok(false)) {
        return WrongPins::default();
    }
    let read = toml_file::load(path, FILE_LEN_MAX, |text| {
        FileText::of(text, FORMAT)?.parse::<PinRow>()
    });
    match read {
        Ok(row) => WrongPins {
            count: row.wrong,
            waited: row.waited,
        },
        Err(_unreadable) => WrongPins {
            count: u32::from(TRIES),
            waited: false,
        },
    }
}

/// Serializes the count.
///
/// # Errors
/// The error of the TOML serializer.
pub(crate) fn text(wrong: &WrongPins) -> io::Result<String> {
    let row = PinRow {
        format: FORMAT.into(),
        version: VERSION,
        wrong: wrong.count,
        waited: wrong.waited,
    };
    toml::to_string(&row).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    #[test]
    fn what_is_written_is_read_and_what_cannot_be_read_is_a_wait() {
        let folder = tempfile::tempdir().unwrap();
        let path = beside(&folder.path().join("settings.toml"));
        assert_eq!(load(&path), WrongPins::default());
        let wrong = WrongPins {
            count: 12,
            waited: true,
        };
        std::fs::write(&path, text(&wrong).unwrap()).unwrap();
        assert_eq!(load(&path), wrong);
        for bad in ["", "format = 3", "wrong = -1"] {
            std::fs::write(&path, bad).unwrap();
            assert!(load(&path).wait().is_some(), "{bad}");
        }
    }
}
