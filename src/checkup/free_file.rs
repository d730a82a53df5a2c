//! What the joints of one hand read when they touch nothing, kept in a file of that hand: measured by its check-up and by each close
//! that touched nothing, and read by whatever tells a grip.

use crate::hand::grip::FreeForce;
use crate::store::{read_text, replace};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};

/// No file of it is larger, bytes.
const FILE_MAX: u64 = 64 << 10;

/// The file of the hand at an endpoint, beside the settings; `None` for the built-in one, which is another each time.
pub fn file_of(settings: &Path, hand: &Endpoint) -> Option<PathBuf> {
    let folder = settings.with_file_name("free-force");
    (!hand.is_sim()).then(|| folder.join(format!("{}.json", hand.file_stem())))
}

/// What a file keeps; nothing where there is none.
///
/// # Errors
/// The system's, or that it is none of ours.
pub fn read(file: &Path) -> io::Result<FreeForce> {
    let text = read_text(file, FILE_MAX)?;
    let kept = text.map(|text| serde_json::from_str(&text)).transpose();
    Ok(kept?.unwrap_or_default())
}

/// Keeps this in place of what was kept.
///
/// # Errors
/// The system's.
pub fn keep(file: &Path, free: &FreeForce) -> io::Result<()> {
    replace(file, (serde_json::to_string(free)? + "\n").as_bytes())
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
        close.take(240, 87.0);
        let mut free = FreeForce::default();
        free.put(Dof::Little, &close);
        keep(&one, &free).unwrap();
        assert_eq!(read(&one).unwrap().at(Dof::Little, 240), Some(87.0));
        assert_eq!(read(&other).unwrap(), FreeForce::default());
        std::fs::write(&one, r#"{"little":[1]}"#).unwrap();
        read(&one).unwrap_err();
    }
}
