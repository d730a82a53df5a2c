//! Finds the files of a folder that belong to one recording, by their openings and not by their names, which users change.

use crate::record::file::format::opening::{Opening, Part};
use crate::record::file::walk::{self, MAGIC};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Maximum number of inspected files of one folder.
const FILES_MAX: usize = 4096;
/// Maximum number of inspected day folders.
const FOLDERS_MAX: usize = 4000;
/// Bytes at the start of a file that contain its opening, unless another program rewrote it.
const HEAD_BYTES: u64 = 4096;

/// The files of this file's recording, ordered by time; only itself if it belongs to none.
pub fn of(path: &Path) -> Vec<PathBuf> {
    let alone = || vec![path.to_owned()];
    if read_opening(path)
        .and_then(|opening| opening.part)
        .is_none()
    {
        return alone();
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = if folder.as_os_str().is_empty() {
        fs::read_dir(".")
    } else {
        fs::read_dir(folder)
    };
    let entries = read.into_iter().flatten().flatten().take(FILES_MAX);
    let beside = entries.map(|entry| folder.join(entry.file_name()));
    let mut paths: Vec<PathBuf> = beside
        .filter(|beside| beside != path && beside.extension().is_some_and(|end| end == "mcap"))
        .collect();
    paths.push(path.to_owned());
    let mut all = recordings(paths).into_iter();
    all.find(|files| files.iter().any(|file| file == path))
        .unwrap_or_else(alone)
}

/// Metadata file of a rosbag2 folder.
const BAG: &str = "metadata.yaml";
/// Maximum number of bytes read from it; it names few files.
const BAG_MAX: u64 = 1024 * 1024;

/// The files that a rosbag2 folder lists, in their order; `None` if it is not one.
pub fn of_bag(folder: &Path) -> Option<Vec<PathBuf>> {
    let about = folder.join(BAG);
    if !fs::metadata(&about).ok()?.is_file() {
        return None;
    }
    let mut text = String::new();
    let file = File::open(about).ok()?;
    file.take(BAG_MAX).read_to_string(&mut text).ok()?;
    let items = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- "));
    let names = items.map(|item| item.trim().trim_matches(['"', '\'']));
    // The files are listed twice, in the second list with "path: " before each path.
    let mut files: Vec<PathBuf> = Vec::new();
    for name in names.filter_map(|name| Path::new(name).file_name()) {
        let path = folder.join(name);
        let is_mcap = path.extension().is_some_and(|end| end == "mcap");
        if is_mcap && path.is_file() && !files.contains(&path) {
            files.push(path);
        }
    }
    (!files.is_empty()).then_some(files)
}

/// Groups these files by recording, ordered by time. A copy within the same folder counts as another recording.
pub fn recordings(mut paths: Vec<PathBuf>) -> Vec<Vec<PathBuf>> {
    // A copy has the longer name.
    paths.sort_by_cached_key(|path| (path.as_os_str().len(), path.clone()));
    let mut alone = Vec::new();
    let mut all: BTreeMap<_, BTreeMap<u32, PathBuf>> = BTreeMap::new();
    for path in paths {
        let Some(Opening {
            part: Some(part),
            base_nanos,
            hand,
            ..
        }) = read_opening(&path)
        else {
            alone.push(vec![path]);
            continue;
        };
        let Part {
            recording_began,
            number,
        } = part;
        let folder = path.parent().map(ToOwned::to_owned);
        let mut key = (folder, hand, base_nanos, recording_began, 0);
        while all
            .get(&key)
            .is_some_and(|files| files.contains_key(&number))
        {
            key.4 += 1;
        }
        all.entry(key).or_default().insert(number, path);
    }
    let together = all.into_values();
    alone.extend(together.map(|files| files.into_values().collect()));
    alone
}

/// Endpoint of the hand in a file's opening.
pub fn hand(path: &Path) -> Option<String> {
    read_opening(path).map(|opening| opening.hand)
}

/// The MCAP files in a folder and its direct subfolders.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = |folder: &Path| {
        let read = fs::read_dir(folder).into_iter().flatten().flatten();
        read.map(|entry| entry.path())
    };
    let (mut files, mut folders) = (Vec::new(), Vec::new());
    for path in entries(folder) {
        if path.is_dir() {
            folders.push(path);
        } else {
            files.push(path);
        }
    }
    folders.sort();
    for folder in folders.iter().rev().take(FOLDERS_MAX) {
        files.extend(entries(folder));
    }
    files.retain(|path| path.extension().is_some_and(|end| end == "mcap"));
    files
}

/// Opening of a file, as far as it can be read without opening it as a recording.
fn read_opening(path: &Path) -> Option<Opening> {
    // Opening a pipe would wait for its writer.
    if !fs::metadata(path).ok()?.is_file() {
        return None;
    }
    let mut begin = Vec::new();
    let file = File::open(path).ok()?;
    file.take(HEAD_BYTES).read_to_end(&mut begin).ok()?;
    let (_, _, after_header) = walk::record(begin.strip_prefix(&MAGIC)?)?;
    let (_, content, _) = walk::record(after_header)?;
    Opening::of_record(content)
}
