//! Recordings on disks that are full, broken, slow, removed or closed to us, and under clocks that are set: 500 seeded schedules in
//! virtual time, and what only a real thread shows.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers of tests are small, and clippy.toml cannot excuse them"
)]

use crate::record::file::disk::{Disk, DiskFile, FilePlace, SystemDisk};
use crate::record::file::reader::RecordingFile;
use crate::record::file::recorder::{Recorder, RecorderInput};
use crate::record::file::recording::{
    Now, PART_LENGTH, RecorderNotice, RecorderStatus, RecordingPlan, RecordingTask,
};
use crate::record::file::tests::{Atom, atoms, entries, opening, read};
use crate::record::{Entry, EventKind};
use crate::soak;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What goes wrong with a disk.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Trouble {
    /// No space; a part of the bytes is written.
    Full,
    /// An error of the device; a part of the bytes is written.
    Broken,
    /// No new file: its folder is closed to us, gone, or cannot be written.
    Closed(ErrorKind),
    /// Everything takes so long.
    Slow(Duration),
    /// Nothing is made safe, and what was not safe is thrown away.
    Unsafe,
    /// The file system knows nothing of safety.
    Unsyncable,
    /// Files that are open now take nothing any more, for ever.
    Unplugged,
    /// The file that is being written is removed.
    Removed,
    /// The computer's clock is set by so many seconds.
    ClockSet(i64),
}

#[derive(Debug, Default)]
struct Content {
    bytes: Vec<u8>,
    safe: Vec<u8>,
    made_at: Duration,
}

#[derive(Default)]
struct State {
    now: Duration,
    wall_ahead: i64,
    troubles: Vec<(Duration, Duration, Trouble)>,
    files: Vec<(PathBuf, Arc<Mutex<Content>>)>,
    random: fastrand::Rng,
    unplugged: Option<Duration>,
}

impl State {
    fn is(&self, wanted: impl Fn(Trouble) -> bool) -> bool {
        let mut all = self.troubles.iter();
        all.any(|(from, to, trouble)| (*from..*to).contains(&self.now) && wanted(*trouble))
    }

    fn wait(&mut self) {
        for (from, to, trouble) in self.troubles.clone() {
            if let Trouble::Slow(by) = trouble
                && (from..to).contains(&self.now)
            {
                self.now += by;
            }
        }
    }
}

/// A disk in memory, on which time is virtual.
#[derive(Clone, Default)]
struct FailingDisk(Arc<Mutex<State>>);

struct FailingFile(FailingDisk, Arc<Mutex<Content>>);

impl Disk for FailingDisk {
    fn create(&self, path: &Path) -> io::Result<Box<dyn DiskFile>> {
        let mut state = self.0.lock().unwrap();
        state.wait();
        for (from, to, trouble) in state.troubles.clone() {
            if let Trouble::Closed(kind) = trouble
                && (from..to).contains(&state.now)
            {
                return Err(kind.into());
            }
        }
        if state.files.iter().any(|(taken, _)| taken == path) {
            return Err(ErrorKind::AlreadyExists.into());
        }
        let content = Content {
            made_at: state.now,
            ..Content::default()
        };
        let content = Arc::new(Mutex::new(content));
        state.files.push((path.to_owned(), Arc::clone(&content)));
        drop(state);
        Ok(Box::new(FailingFile(self.clone(), content)))
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        let mut state = self.0.lock().unwrap();
        state.files.retain(|(there, _)| there != path);
        Ok(())
    }
}

impl FailingFile {
    fn put(&self, place: u64, bytes: &[u8]) {
        let mut content = self.1.lock().unwrap();
        let from = usize::try_from(place).unwrap();
        let to = from + bytes.len();
        let whole = content.bytes.len().max(to);
        content.bytes.resize(whole, 0);
        content.bytes[from..to].copy_from_slice(bytes);
    }
}

impl DiskFile for FailingFile {
    fn place(&self, _: &Path) -> FilePlace {
        let state = self.0.0.lock().unwrap();
        let mut all = state.files.iter();
        if all.any(|(_, content)| Arc::ptr_eq(content, &self.1)) {
            FilePlace::There
        } else {
            FilePlace::Removed
        }
    }

    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        let mut state = self.0.0.lock().unwrap();
        state.wait();
        let made_at = self.1.lock().unwrap().made_at;
        let part = state.random.usize(0..=bytes.len());
        let full = state.is(|trouble| trouble == Trouble::Full);
        let broken = state.is(|trouble| trouble == Trouble::Broken)
            || state.unplugged.is_some_and(|at| made_at < at);
        drop(state);
        match (full, broken) {
            (false, false) => {
                self.put(place, bytes);
                Ok(())
            }
            (full, _) => {
                self.put(place, &bytes[..part]);
                Err(if full {
                    ErrorKind::StorageFull.into()
                } else {
                    io::Error::other("Input/output error")
                })
            }
        }
    }

    fn sync(&mut self) -> io::Result<()> {
        let mut state = self.0.0.lock().unwrap();
        state.wait();
        let mut content = self.1.lock().unwrap();
        if state.is(|trouble| trouble == Trouble::Unsafe) {
            content.bytes = content.safe.clone();
            return Err(io::Error::other("Input/output error"));
        }
        if state.is(|trouble| trouble == Trouble::Unsyncable) {
            content.safe = content.bytes.clone();
            return Err(ErrorKind::InvalidInput.into());
        }
        content.safe = content.bytes.clone();
        Ok(())
    }
}

/// One recording in virtual time: entries come at a steady rate while the disk has its troubles.
struct Schedule {
    disk: FailingDisk,
    recording: RecordingTask,
    input: RecorderInput,
    taken: std::sync::mpsc::Receiver<crate::record::file::recording::QueuedEntry>,
    entries: Vec<Entry>,
    pushed: usize,
}

/// Between two looks of the thread.
const TICK: Duration = Duration::from_millis(20);
/// Entries a second.
const RATE: f64 = 50.0;

/// Entries of which each can be found again in a file.
fn recognisable(seed: u64, count: u64) -> Vec<Entry> {
    let mut all = entries(seed, count);
    all.retain(|entry| !matches!(entry, Entry::Link(_)) && !atoms(entry).is_empty());
    all
}

impl Schedule {
    fn new(seed: u64, troubles: Vec<(Duration, Duration, Trouble)>, room: usize) -> Self {
        let disk = FailingDisk::default();
        disk.0.lock().unwrap().troubles = troubles;
        disk.0.lock().unwrap().random = fastrand::Rng::with_seed(seed);
        let (input, taken) = RecorderInput::new(room);
        let now = Now {
            since: Duration::ZERO,
            wall_nanos: 0,
        };
        let plan = plan(Path::new("a/b.mcap"), disk.clone());
        let recording = RecordingTask::new(plan, now).unwrap();
        Self {
            disk,
            recording: recording.with_pending_max(20_000 + room * 40),
            input,
            taken,
            entries: recognisable(seed, 400),
            pushed: 0,
        }
    }

    fn now(&self) -> Now {
        let state = self.disk.0.lock().unwrap();
        Now {
            since: state.now,
            wall_nanos: state.now.as_nanos() as i64 + state.wall_ahead * 1_000_000_000,
        }
    }

    /// Lets the next bit of time pass and all happen that is due in it.
    fn tick(&mut self) {
        // One that is complete may be removed by whoever likes.
        let status = self.recording.status(Duration::ZERO);
        let written = status.path.filter(|_| status.bytes > 0);
        let mut state = self.disk.0.lock().unwrap();
        let before = state.now;
        state.now += TICK;
        let after = state.now;
        for (at, _, trouble) in state.troubles.clone() {
            if (before..after).contains(&at) {
                match trouble {
                    Trouble::Removed => state
                        .files
                        .retain(|(path, _)| Some(path) != written.as_ref()),
                    Trouble::ClockSet(by) => state.wall_ahead += by,
                    Trouble::Unplugged => state.unplugged = Some(at),
                    _ => {}
                }
            }
        }
        drop(state);
        let due = (after.as_secs_f64() * RATE) as usize;
        while self.pushed < due.min(self.entries.len()) {
            self.input.push(self.entries[self.pushed].clone());
            self.pushed += 1;
        }
        while let Ok(given) = self.taken.try_recv() {
            self.recording.accept(&given);
        }
        let now = self.now();
        self.recording.step(now);
    }

    fn run(&mut self) -> RecorderStatus {
        while self.pushed < self.entries.len() {
            self.tick();
        }
        self.recording.lose(self.input.take_lost());
        let now = self.now();
        self.recording.end(now);
        while !self.recording.end_step(self.now().since) {
            self.disk.0.lock().unwrap().now += TICK * 2;
        }
        self.recording.status(self.now().since)
    }

    /// Numbers of the entries that stand in the files, and how many the files say to be missing.
    fn found(&self, folder: &Path) -> (BTreeSet<usize>, u64) {
        let mut numbers =
            self.entries.iter().enumerate().flat_map(|(number, entry)| {
                atoms(entry).into_iter().map(move |atom| (number, atom))
            });
        let (mut found, mut told) = (BTreeMap::new(), 0);
        for (_, content) in &self.disk.0.lock().unwrap().files {
            let path = folder.join("a.mcap");
            std::fs::write(&path, &content.lock().unwrap().bytes).unwrap();
            let (all, file, _) = read(&path).expect("each file opens");
            told += file.overview().counts.missing;
            for atom in all {
                match &atom {
                    Atom::Other(entry) if is_told_beside(entry) => continue,
                    _ => {}
                }
                let (number, _) = numbers
                    .by_ref()
                    .find(|(_, wanted)| *wanted == atom)
                    .unwrap_or_else(|| panic!("{atom:?} was not given, or not here"));
                *found.entry(number).or_insert(0) += 1;
            }
        }
        let is_whole = |(number, count): (usize, usize)| {
            (atoms(&self.entries[number]).len() == count).then_some(number)
        };
        (found.into_iter().filter_map(is_whole).collect(), told)
    }
}

fn is_told_beside(entry: &Entry) -> bool {
    match entry {
        Entry::Link(_) => true,
        Entry::Event(event) => event.kind == EventKind::Recording,
        _ => false,
    }
}

fn seconds(random: &mut fastrand::Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(from + random.f64() * (to - from))
}

/// Up to four troubles in the first twelve seconds.
fn troubles(random: &mut fastrand::Rng) -> Vec<(Duration, Duration, Trouble)> {
    let one = |random: &mut fastrand::Rng| {
        let trouble = match random.u8(0..10) {
            0 => Trouble::Full,
            1 => Trouble::Broken,
            2 => Trouble::Closed(ErrorKind::PermissionDenied),
            3 => Trouble::Closed(ErrorKind::NotFound),
            4 => Trouble::Slow(seconds(random, 0.01, 0.4)),
            5 => Trouble::Slow(Duration::from_secs(5)),
            6 => Trouble::Unsafe,
            7 => Trouble::Unsyncable,
            8 => Trouble::Removed,
            _ => Trouble::ClockSet(random.i64(-4000..4000)),
        };
        let from = match random.u8(0..4) {
            0 => Duration::ZERO,
            _ => seconds(random, 0.0, 10.0),
        };
        let long = match trouble {
            Trouble::Slow(by) if by.as_secs() > 1 => 0.1,
            _ => 4.0,
        };
        (from, from + seconds(random, 0.0, long), trouble)
    };
    let count = random.usize(1..=4);
    (0..count).map(|_| one(random)).collect()
}

/// Disks in a full run.
const DISKS: u64 = 500;

#[test]
fn on_disks_that_fail_no_value_differs_and_all_that_is_missing_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..soak::times(DISKS) {
        let mut random = fastrand::Rng::with_seed(seed);
        let troubles = troubles(&mut random);
        let room = if random.bool() { 16_384 } else { 100 };
        let mut schedule = Schedule::new(seed, troubles.clone(), room);
        if seed % 2 == 0 {
            // What ends a file and begins the next takes room, too.
            let recording = schedule.recording.with_pending_max(60_000 + room * 40);
            schedule.recording = recording.with_part_length(Duration::from_secs(3));
        }
        let status = schedule.run();
        let (found, told) = schedule.found(folder.path());
        let given = schedule.entries.len();
        let say = format!(
            "seed {seed}, {troubles:?}: {} of {given}, {told} told, {status:?}",
            found.len()
        );
        assert!(status.ended && status.trouble.is_none(), "{say}");
        assert_eq!(found.len() as u64, status.entries, "{say}");
        assert_eq!(given as u64 - found.len() as u64, told, "{say}");
        assert_eq!(status.missing, told, "{say}");
        assert!(found.contains(&(given - 1)), "it goes on: {say}");
    }
}

#[test]
fn a_short_trouble_costs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |from: f64, to: f64| (Duration::from_secs_f64(from), Duration::from_secs_f64(to));
    for trouble in [
        Trouble::Full,
        Trouble::Broken,
        Trouble::Closed(ErrorKind::ReadOnlyFilesystem),
        Trouble::Slow(Duration::from_secs(5)),
        Trouble::Unsafe,
        Trouble::Unsyncable,
        Trouble::ClockSet(-3600),
        Trouble::ClockSet(3600),
    ] {
        for (from, to) in [at(0.0, 1.5), at(3.0, 4.5)] {
            let mut schedule = Schedule::new(1, vec![(from, to, trouble)], 16_384);
            let status = schedule.run();
            let (found, told) = schedule.found(folder.path());
            assert_eq!(
                (found.len(), told),
                (schedule.entries.len(), 0),
                "{trouble:?} {status:?}"
            );
        }
    }
}

#[test]
fn a_file_that_takes_nothing_any_more_is_left_for_another() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..20 {
        let from = seconds(&mut fastrand::Rng::with_seed(seed), 0.5, 4.0);
        let mut schedule = Schedule::new(seed, vec![(from, from, Trouble::Unplugged)], 16_384);
        let status = schedule.run();
        let (found, told) = schedule.found(folder.path());
        let given = schedule.entries.len();
        // A part of what was being written may be whole all the same.
        assert!(given - found.len() <= told as usize, "{from:?} {status:?}");
        assert!(found.contains(&(given - 1)));
        assert_eq!(schedule.disk.0.lock().unwrap().files.len(), 2);
    }
}

#[test]
fn a_clock_that_is_set_is_said_in_both_files_and_times_are_right_in_each() {
    let folder = tempfile::tempdir().unwrap();
    let at = Duration::from_secs(5);
    let set = (at, at, Trouble::ClockSet(-3600));
    let mut schedule = Schedule::new(1, vec![set], 16_384);
    let _status = schedule.run();
    let mut said = Vec::new();
    let mut bases = Vec::new();
    for (_, content) in &schedule.disk.0.lock().unwrap().files {
        let path = folder.path().join("a.mcap");
        std::fs::write(&path, &content.lock().unwrap().bytes).unwrap();
        let file = RecordingFile::open(&path).unwrap();
        bases.push(file.opening().base_nanos);
        assert!(file.is_closed());
        let marks = file.overview().marks.iter();
        said.extend(
            marks
                .filter(|mark| mark.kind == EventKind::Recording)
                .map(|mark| mark.words.clone()),
        );
    }
    assert_eq!(
        bases,
        [
            opening().base_nanos,
            opening().base_nanos - 3_600_000_000_000
        ]
    );
    assert_eq!(
        said,
        [
            "the recording goes on in b-2.mcap: the computer's clock was set back by 3600.0 s",
            "this file goes on after b.mcap: the computer's clock was set back by 3600.0 s"
        ]
    );
}

#[test]
fn what_is_in_a_removed_file_is_told_in_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let at = Duration::from_secs(5);
    let mut schedule = Schedule::new(1, vec![(at, at, Trouble::Removed)], 16_384);
    let status = schedule.run();
    let (found, told) = schedule.found(folder.path());
    assert!(
        (225..350).contains(&told),
        "{told}: five to six seconds are gone"
    );
    assert_eq!(found.len() as u64 + told, schedule.entries.len() as u64);
    assert_eq!(status.missing, told);
}

fn plan(path: &Path, disk: impl Disk + 'static) -> RecordingPlan {
    RecordingPlan {
        path: path.to_owned(),
        opening: opening(),
        disk: Arc::new(disk),
        part_length: PART_LENGTH,
    }
}

#[test]
fn a_file_that_is_renamed_is_written_on_and_one_that_is_removed_is_told_and_begun_anew() {
    let entry = entries(1, 1).pop().unwrap();
    let until = |recorder: &Recorder, notices: usize| {
        let until = Instant::now() + Duration::from_secs(20);
        while recorder.status().notices.len() < notices {
            assert!(Instant::now() < until, "{:?}", recorder.status());
            std::thread::sleep(Duration::from_millis(20));
        }
        recorder.status()
    };
    let written = |recorder: &Recorder| {
        let until = Instant::now() + Duration::from_secs(20);
        let before = recorder.status().bytes;
        recorder.input().push(entry.clone());
        while recorder.status().bytes == before {
            assert!(Instant::now() < until);
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    for what in ["file", "folder", "removed", "folder removed"] {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("day");
        let path = own.join("a.mcap");
        let recorder = Recorder::start(plan(&path, SystemDisk)).unwrap();
        written(&recorder);
        let other = match what {
            "file" => own.join("b.mcap"),
            "folder" => folder.path().join("other/a.mcap"),
            _ => path.clone(),
        };
        match what {
            "file" => std::fs::rename(&path, &other).unwrap(),
            "folder" => std::fs::rename(&own, folder.path().join("other")).unwrap(),
            "removed" => std::fs::remove_file(&path).unwrap(),
            _ => std::fs::remove_dir_all(&own).unwrap(),
        }
        let status = until(&recorder, 1);
        let is_removed = what.ends_with("removed");
        match &status.notices[0] {
            RecorderNotice::Moved { from, to } => {
                assert_eq!((from, to), (&path, &Some(other.clone())));
                assert!(!is_removed && status.missing == 0, "{what}");
            }
            RecorderNotice::Removed { path: gone, .. } => {
                assert!(is_removed && *gone == path, "{what}");
            }
            notice => panic!("{notice:?}"),
        }
        written(&recorder);
        let status = recorder.end();
        assert_eq!(status.path.as_ref(), Some(&other), "{what}");
        assert_eq!(status.notices.len(), 1, "{what}: {:?}", status.notices);
        let file = RecordingFile::open(&other).unwrap();
        assert!(file.is_closed());
        let (all, ..) = read(&other).unwrap();
        let count = all
            .iter()
            .filter(|one| !matches!(one, Atom::Other(entry) if is_told_beside(entry)));
        assert_eq!(count.count(), if is_removed { 1 } else { 2 }, "{what}");
    }
}

/// A disk whose every call hangs.
struct HangingDisk;

impl Disk for HangingDisk {
    fn create(&self, _: &Path) -> io::Result<Box<dyn DiskFile>> {
        std::thread::sleep(Duration::from_secs(60));
        Err(ErrorKind::TimedOut.into())
    }

    fn remove(&self, _: &Path) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_disk_that_hangs_holds_nobody_up_and_the_end_comes_in_time() {
    let recorder = Recorder::start(plan(Path::new("a.mcap"), HangingDisk)).unwrap();
    let input = recorder.input();
    let entry = entries(1, 1).pop().unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    for _ in 0..30_000 {
        input.push(entry.clone());
    }
    assert!(begun.elapsed() < Duration::from_secs(2));
    assert!(recorder.status().missing >= 30_000 - 16_384);
    let status = recorder.end();
    assert!(!status.ended);
    assert!(begun.elapsed() < Duration::from_secs(6));
}

/// Waits until the recording at this path is read as ended.
fn until_ended(path: &Path) -> RecordingFile {
    let until = Instant::now() + Duration::from_secs(20);
    loop {
        match RecordingFile::open(path) {
            Ok(file) if file.is_closed() => return file,
            _ => assert!(Instant::now() < until, "it does not end"),
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_dropped_recording_ends_its_file_though_others_could_still_give_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep/er/a.mcap");
    let recorder = Recorder::start(plan(&path, SystemDisk)).unwrap();
    let input = recorder.input();
    let all = recognisable(1, 100);
    all.iter().for_each(|entry| input.push(entry.clone()));
    drop(recorder);
    drop(until_ended(&path));
    let (read, _, _) = read(&path).unwrap();
    assert_eq!(read, all.iter().flat_map(atoms).collect::<Vec<_>>());
    input.push(all[0].clone());
}

#[test]
fn two_programs_that_record_into_one_folder_at_once_have_a_file_each() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let recorders = [1, 2].map(|seed| {
        let recorder = Recorder::start(plan(&path, SystemDisk)).unwrap();
        let all = recognisable(seed, 200);
        all.iter()
            .for_each(|entry| recorder.input().push(entry.clone()));
        (recorder, all)
    });
    let mut paths = BTreeSet::new();
    for (recorder, all) in recorders {
        let status = recorder.end();
        assert!(status.ended && status.missing == 0, "{status:?}");
        let path = status.path.unwrap();
        let (read, _, _) = read(&path).unwrap();
        assert_eq!(read, all.iter().flat_map(atoms).collect::<Vec<_>>());
        paths.insert(path);
    }
    assert_eq!(paths.len(), 2);
}

#[cfg(unix)]
#[test]
fn a_recording_into_a_closed_folder_goes_on_when_it_is_opened() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    let closed = folder.path().join("closed");
    // A file where the folder should be stops root as well.
    std::fs::write(&closed, "").unwrap();
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o400)).unwrap();
    let path = closed.join("a.mcap");
    let recorder = Recorder::start(plan(&path, SystemDisk)).unwrap();
    let all = recognisable(1, 200);
    all.iter()
        .for_each(|entry| recorder.input().push(entry.clone()));
    let until = Instant::now() + Duration::from_secs(20);
    while recorder.status().trouble.is_none() {
        assert!(Instant::now() < until);
        std::thread::sleep(Duration::from_millis(10));
    }
    std::fs::remove_file(&closed).unwrap();
    let status = recorder.end();
    assert!(status.ended && status.trouble.is_none() && status.missing == 0);
    let (read, _, _) = read(&path).unwrap();
    assert_eq!(read, all.iter().flat_map(atoms).collect::<Vec<_>>());
}
