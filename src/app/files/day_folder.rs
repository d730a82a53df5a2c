//! Where files go that nobody is asked about: a folder of the day in the person's documents. Writes nothing.

use directories::UserDirs;
use std::path::{Path, PathBuf};

/// Names another folder in place of the person's documents.
const VARIABLE: &str = "HANDSCOPE_DOCUMENTS";

/// The person's documents; `None` if they have no home.
#[must_use]
pub fn documents() -> Option<PathBuf> {
    if let Some(own) = std::env::var_os(VARIABLE).filter(|own| !own.is_empty()) {
        return Some(own.into());
    }
    let user = UserDirs::new()?;
    let documents = user.document_dir().map(Path::to_owned);
    Some(documents.unwrap_or_else(|| user.home_dir().join("Documents")))
}

/// The folder of a day, `2026-11-21`, in these documents.
#[must_use]
pub fn of_day(documents: &Path, day: &str) -> PathBuf {
    documents.join("Handscope").join(day)
}
