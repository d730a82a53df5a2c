//! Destination of files that are saved without asking: a folder per day in the user's documents. Writes nothing.

use directories::UserDirs;
use std::path::{Path, PathBuf};

/// Environment variable that overrides the user's documents folder.
const VARIABLE: &str = "HANDSCOPE_DOCUMENTS";

/// The user's documents folder; `None` if the user has no home.
pub fn documents() -> Option<PathBuf> {
    if let Some(own) = std::env::var_os(VARIABLE).filter(|own| !own.is_empty()) {
        return Some(own.into());
    }
    let user = UserDirs::new()?;
    let documents = user.document_dir().map(Path::to_owned);
    Some(documents.unwrap_or_else(|| user.home_dir().join("Documents")))
}

/// The program's folder in the documents folder.
pub fn of_all(documents: &Path) -> PathBuf {
    documents.join("Handscope")
}

/// The folder of a day, `2026-11-21`, in the documents folder.
pub fn of_day(documents: &Path, day: &str) -> PathBuf {
    of_all(documents).join(day)
}

/// Returns an unused path in this folder: the name, or the name with a number before its extension, if any.
pub fn free_path(folder: &Path, name: &str) -> PathBuf {
    let (stem, ending) = name.split_at(name.rfind('.').unwrap_or(name.len()));
    let numbered = (2..).map(|number| format!("{stem}-{number}{ending}"));
    let mut names = std::iter::once(name.to_owned()).chain(numbered);
    let free = names.find(|name| !folder.join(name).exists());
    folder.join(free.as_deref().unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_saved_before_is_never_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let mut names = Vec::new();
        for _ in 0..3 {
            let path = free_path(folder.path(), "plots.csv");
            std::fs::write(&path, "x").unwrap();
            names.push(path.file_name().unwrap().to_owned());
        }
        assert_eq!(names, ["plots.csv", "plots-2.csv", "plots-3.csv"]);
    }
}
