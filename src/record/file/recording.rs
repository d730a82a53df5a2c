//! One recording, step by step: accepts entries, schedules disk writes, and starts new files. Times are arguments.

use crate::hand::Moment;
use crate::record::file::disk::{Disk, FilePlace};
use crate::record::file::format::opening::{Opening, Part};
use crate::record::file::tail::{Content, FileTail};
use crate::record::file::writer::RecordingWriter;
use crate::record::{Entry, Event, EventKind, LinkReport, Record};
use mcap::McapError;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::time::Duration;

/// Maximum bytes waiting for the disk: two minutes of one hand.
pub(crate) const PENDING_MAX: usize = 8 * 1024 * 1024;
/// Maximum interval of writes to the file, so that a killed program loses at most a quarter of a second.
pub const FLUSH_INTERVAL: Duration = Duration::from_millis(125);
/// Event text that names the next file of the same recording, whose name follows.
pub const GOES_ON_IN: &str = "the recording goes on in ";
/// Event text that names the previous file.
pub const GOES_ON_FROM: &str = "this file goes on after ";
/// Duration after which a recording continues in a new file, because memory grows with each chunk until a file is ended.
pub const PART_LENGTH: Duration = Duration::from_secs(3600);
/// Interval of the checks for a moved or removed file and a changed clock.
pub(crate) const POLL_INTERVAL: Duration = Duration::from_secs(1);
/// Clock deviation above which the clock was set, or the computer slept.
pub(crate) const CLOCK_SET: Duration = Duration::from_secs(1);
/// Time limit for ending a file; after that it is left without its end, which a reader does not need.
pub(crate) const END_TIMEOUT: Duration = Duration::from_secs(2);
/// Maximum number of notices of one recording; later ones add nothing new.
const NOTICES_MAX: usize = 20;
/// Maximum number of files started in place of unwritable ones; a disk with more of them is broken.
const REPLACED_MAX: u32 = 20;

/// Destination and parameters of a recording.
#[derive(Clone)]
pub struct RecordingPlan {
    /// Path of the first file. If it is in use, a number is appended, as to the files after it.
    pub path: PathBuf,
    /// Opening of the first file.
    pub opening: Opening,
    /// Storage of the files.
    pub disk: Arc<dyn Disk>,
    /// Length of a file: [`PART_LENGTH`], except in tests.
    pub part_length: Duration,
}

/// A notice to the user about a running recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecorderNotice {
    /// Its file or a parent folder was renamed. Writing continues.
    Moved {
        from: PathBuf,
        /// New path; `None` if the system does not report it.
        to: Option<PathBuf>,
    },
    /// Its file was removed. The recording continues in a new one.
    Removed {
        path: PathBuf,
        /// Number of lost entries.
        entries: u64,
    },
    /// The computer's clock was set, or it slept. The recording continues in another file.
    ClockSet {
        /// Name of that file.
        next: String,
    },
}

impl std::fmt::Display for RecorderNotice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Moved { from, to: None } => write!(
                f,
                "{} was renamed during recording; it continues under its new name, and nothing is lost",
                from.display()
            ),
            Self::Moved { from, to: Some(to) } => write!(
                f,
                "{} was renamed during recording; it continues as {}, and nothing is lost",
                from.display(),
                to.display()
            ),
            Self::Removed { path, entries } => write!(
                f,
                "{} was removed during recording: {entries} entries are lost; the recording continues in a new file",
                path.display()
            ),
            Self::ClockSet { next } => write!(
                f,
                "the computer's clock was set, or it slept: the recording continues in {next}"
            ),
        }
    }
}

/// Status of a recording.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RecorderStatus {
    /// The file being written, the newest of several; `None` before there is one.
    pub path: Option<PathBuf>,
    /// Bytes accepted by the system.
    pub bytes: u64,
    /// Bytes of earlier files of the same recording.
    pub earlier_bytes: u64,
    /// Accepted entries, without those that were lost since.
    pub entries: u64,
    /// Entries that are in no file.
    pub missing: u64,
    /// Reason why nothing can be written now, in the system's words.
    pub trouble: Option<String>,
    /// Notices about its files so far, in order.
    pub notices: Vec<RecorderNotice>,
    /// Duration of the recording so far.
    pub since: Duration,
    /// The recording is over; it is complete if nothing is missing and there is no trouble.
    pub ended: bool,
}

impl RecorderStatus {
    /// Megabytes per hour; `None` in the first 5 s.
    pub fn megabytes_an_hour(&self) -> Option<f64> {
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
        let bytes = (self.bytes + self.earlier_bytes) as f64;
        let seconds = self.since.as_secs_f64();
        (seconds >= 5.0).then(|| bytes / seconds * 3600.0 / 1e6)
    }
}

/// The current time, by both clocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Now {
    /// Time since the recording began; never goes back.
    pub(crate) since: Duration,
    /// Nanoseconds since 1970 by the computer's clock.
    pub(crate) wall_nanos: i64,
}

/// An entry, and the number of entries lost before it.
#[derive(Debug)]
pub struct QueuedEntry {
    pub entry: Entry,
    pub lost_before: u64,
    /// Dropped with the entry, which wakes a caller that waits for it.
    pub(crate) _taken: Option<SyncSender<()>>,
}

/// A recording and its files.
pub(crate) struct RecordingTask {
    opening: Opening,
    part_length: Duration,
    /// Time at which this file was started.
    part_since: Duration,
    writer: RecordingWriter,
    /// Content of the writer that was not passed to a file yet.
    open: Content,
    tail: FileTail,
    /// The previous file, until it is completely written.
    ending: Option<FileTail>,
    /// Lost entries not yet recorded in a file.
    unreported: u64,
    entries: u64,
    missing: u64,
    notices: Vec<RecorderNotice>,
    replaced: u32,
    earlier_bytes: u64,
    newest: Moment,
    /// Repeated at the start of the next file, so that it is complete by itself.
    link: Option<LinkReport>,
    parameters: Option<Event>,
    clock: Now,
    flushed_at: Duration,
    looked_at: Duration,
    end_by: Option<Duration>,
    ended: bool,
    pending_max: usize,
}

impl RecordingTask {
    /// Starts a recording.
    ///
    /// # Errors
    /// [`McapError`], which does not occur when writing to memory.
    pub(crate) fn new(plan: RecordingPlan, now: Now) -> Result<Self, McapError> {
        let began = plan.opening.began;
        let opening = Opening {
            part: Some(first_part(began)),
            ..plan.opening
        };
        Ok(Self {
            writer: RecordingWriter::new(&opening)?,
            newest: began,
            opening,
            part_length: plan.part_length,
            part_since: now.since,
            open: Content::default(),
            tail: FileTail::new(plan.disk, plan.path),
            ending: None,
            unreported: 0,
            entries: 0,
            missing: 0,
            notices: Vec::new(),
            replaced: 0,
            earlier_bytes: 0,
            link: None,
            parameters: None,
            clock: now,
            flushed_at: now.since,
            looked_at: now.since,
            end_by: None,
            ended: false,
            pending_max: PENDING_MAX,
        })
    }

    #[cfg(test)]
    pub(crate) const fn with_pending_max(mut self, bytes: usize) -> Self {
        self.pending_max = bytes;
        self
    }

    #[cfg(test)]
    pub(crate) const fn with_part_length(mut self, length: Duration) -> Self {
        self.part_length = length;
        self
    }

    /// Accepts an entry, or counts it as lost if too much data waits for the disk.
    pub(crate) fn accept(&mut self, queued: &QueuedEntry) {
        self.lose(queued.lost_before);
        let ending = self.ending.as_ref().map_or(0, FileTail::held);
        if self.tail.held() + ending >= self.pending_max {
            self.lose(1);
            return;
        }
        let at = queued.entry.at();
        self.newest = self.newest.max(at);
        self.report_missing(at);
        self.remember(&queued.entry);
        self.entries += 1;
        self.open.entries += 1;
        self.write(&queued.entry);
    }

    /// Counts entries as lost.
    pub(crate) const fn lose(&mut self, entries: u64) {
        self.unreported += entries;
        self.missing += entries;
    }

    /// Runs the due writes and checks.
    pub(crate) fn step(&mut self, now: Now) {
        if now.since.saturating_sub(self.flushed_at) >= FLUSH_INTERVAL {
            self.flushed_at = now.since;
            self.flush();
            self.put(now.since, false);
        }
        if now.since.saturating_sub(self.looked_at) >= POLL_INTERVAL {
            self.looked_at = now.since;
            self.check_files(now);
            let is_long = now.since.saturating_sub(self.part_since) >= self.part_length;
            if is_long && self.ending.is_none() {
                self.begin_part(now);
            }
        }
    }

    /// Begins to end the file.
    pub(crate) fn end(&mut self, now: Now) {
        self.flush();
        self.check_files(now);
        self.report_missing(self.newest);
        self.finish();
        self.end_by = Some(now.since + END_TIMEOUT);
        self.end_step(now.since);
    }

    /// Continues ending; true once it is ended or given up.
    pub(crate) fn end_step(&mut self, now: Duration) -> bool {
        self.put(now, true);
        let is_late = self.end_by.is_some_and(|by| now >= by);
        if is_late && !self.ended {
            let mut lost = self.tail.waiting();
            if let Some(ending) = &self.ending {
                lost.add(ending.waiting());
            }
            self.count_lost(lost);
        }
        self.ended = is_late || self.ending.is_none() && self.tail.is_done();
        self.ended
    }

    /// Current status.
    pub(crate) fn status(&self, since: Duration) -> RecorderStatus {
        let ending = self.ending.as_ref();
        let path = self.tail.path().or_else(|| ending?.path());
        RecorderStatus {
            path: path.map(ToOwned::to_owned),
            bytes: self.tail.written(),
            earlier_bytes: self.earlier_bytes + ending.map_or(0, FileTail::written),
            entries: self.entries,
            missing: self.missing,
            trouble: ending
                .and_then(FileTail::trouble)
                .or_else(|| self.tail.trouble()),
            notices: self.notices.clone(),
            since,
            ended: self.ended,
        }
    }

    fn write(&mut self, entry: &Entry) {
        // Writing to memory does not fail.
        let result = self.writer.push(entry);
        debug_assert!(result.is_ok());
    }

    fn note(&mut self, at: Moment, words: String) {
        self.write(&Entry::Event(Event {
            at,
            kind: EventKind::Recording,
            words,
        }));
    }

    fn report_missing(&mut self, at: Moment) {
        let lost = std::mem::take(&mut self.unreported);
        if lost > 0 {
            self.open.reported += lost;
            self.note(at, format!("{lost} entries are missing before this"));
        }
    }

    /// Counts a file's content as lost.
    const fn count_lost(&mut self, lost: Content) {
        self.entries -= lost.entries;
        self.missing += lost.entries;
        self.unreported += lost.entries + lost.reported;
    }

    fn remember(&mut self, entry: &Entry) {
        match entry {
            Entry::Link(report) if !report.status.is_empty() => {
                self.link = Some(LinkReport {
                    figures: String::new(),
                    ..report.clone()
                });
            }
            Entry::Heard(Record::State { at, state }) => {
                let report = self.link.get_or_insert_with(|| LinkReport {
                    at: *at,
                    state: *state,
                    trouble: String::new(),
                    status: String::new(),
                    figures: String::new(),
                });
                report.state = *state;
            }
            Entry::Event(event) if event.kind == EventKind::Parameters => {
                self.parameters = Some(event.clone());
            }
            _ => {}
        }
    }

    fn flush(&mut self) {
        let result = self.writer.flush();
        debug_assert!(result.is_ok());
        self.give();
    }

    fn finish(&mut self) {
        let result = self.writer.finish();
        debug_assert!(result.is_ok());
        self.give();
    }

    fn give(&mut self) {
        let bytes = self.writer.take_bytes();
        let content = std::mem::take(&mut self.open);
        if !bytes.is_empty() {
            self.tail.add(bytes, content);
        }
    }

    fn put(&mut self, now: Duration, is_last: bool) {
        if let Some(mut ending) = self.ending.take() {
            if is_last {
                ending.put_safely(now)
            } else {
                ending.put(now)
            }
            if ending.is_done() {
                self.earlier_bytes += ending.written()
            } else {
                self.ending = Some(ending)
            }
        }
        if self.ending.is_none() {
            if is_last {
                self.tail.put_safely(now)
            } else {
                self.tail.put(now)
            }
        }
    }

    /// Checks that the files still exist and are writable, and that the clock runs normally.
    fn check_files(&mut self, now: Now) {
        if let Some(mut ending) = self.ending.take() {
            match (ending.check_place(), ending.is_dead(now.since)) {
                (FilePlace::Removed, _) => self.count_lost(ending.everything()),
                (_, true) => self.count_lost(ending.waiting()),
                _ => self.ending = Some(ending),
            }
        }
        let drift = self.drift(now);
        let from = self.tail.path().map(ToOwned::to_owned).unwrap_or_default();
        let place = self.tail.check_place();
        if place == FilePlace::Removed {
            self.flush();
            let gone = self.tail.everything();
            self.notify(RecorderNotice::Removed {
                path: from,
                entries: gone.entries,
            });
            self.count_lost(gone);
            self.begin_next(now, self.tail.again(), first_part(self.newest));
            let words = "this file continues one that was removed during recording";
            self.note(self.newest, words.into());
            return;
        }
        if let FilePlace::Moved(to) = place {
            self.notify(RecorderNotice::Moved { from, to });
        }
        if drift.unsigned_abs() > CLOCK_SET.as_nanos() && self.ending.is_none() {
            self.follow_clock(now, drift);
        } else if self.tail.is_dead(now.since) {
            self.replace(now);
        }
    }

    fn notify(&mut self, notice: RecorderNotice) {
        if self.notices.len() < NOTICES_MAX {
            self.notices.push(notice);
        }
    }

    /// Nanoseconds by which the computer's clock is ahead of its expected time.
    fn drift(&self, now: Now) -> i128 {
        let passed = now.since.saturating_sub(self.clock.since).as_nanos();
        let wall = i128::from(now.wall_nanos) - i128::from(self.clock.wall_nanos);
        wall.saturating_sub_unsigned(passed)
    }

    /// Continues in another file, whose times are those of the changed clock.
    fn follow_clock(&mut self, now: Now, drift: i128) {
        let seconds = Duration::from_nanos(u64::try_from(drift.unsigned_abs()).unwrap_or(u64::MAX));
        let seconds = format!("{:.1} s", seconds.as_secs_f64());
        let what = if drift < 0 {
            format!("the computer's clock was set back by {seconds}")
        } else {
            format!("the computer slept or its clock was set forward: {seconds}")
        };
        let next = self.tail.next();
        let (name, own) = (next.name(), self.tail.name());
        self.report_missing(self.newest);
        self.note(self.newest, format!("{GOES_ON_IN}{name}: {what}"));
        self.finish();
        let old = self.begin_next(now, next, first_part(self.newest));
        self.ending = Some(old);
        self.note(self.newest, format!("{GOES_ON_FROM}{own}: {what}"));
        self.notify(RecorderNotice::ClockSet { next: name });
    }

    /// Tries another file in place of one that cannot be written; if that works, the data waiting for the old one is lost.
    fn replace(&mut self, now: Now) {
        self.tail.spare(now.since);
        if self.replaced >= REPLACED_MAX {
            return;
        }
        self.replaced += 1;
        let Ok(mut writer) = RecordingWriter::new(&self.opening) else {
            return;
        };
        let mut trial = self.tail.next();
        trial.add(writer.take_bytes(), Content::default());
        trial.put_safely(now.since);
        let works = trial.is_done();
        trial.discard();
        if works {
            self.flush();
            self.count_lost(self.tail.waiting());
            let next = self.tail.next();
            let old = self.begin_next(now, next, first_part(self.newest));
            self.earlier_bytes += old.written();
            let name = old.name();
            let words = format!("{GOES_ON_FROM}{name}: that could no longer be written");
            self.note(self.newest, words);
        }
    }

    /// Continues in the next file of the same recording.
    fn begin_part(&mut self, now: Now) {
        self.report_missing(self.newest);
        self.finish();
        let before = self.opening.part.unwrap_or(first_part(self.newest));
        let part = Part {
            number: before.number.saturating_add(1),
            ..before
        };
        self.ending = Some(self.begin_next(now, self.tail.next(), part));
    }

    /// Starts another file, and returns the previous one.
    fn begin_next(&mut self, now: Now, next: FileTail, part: Part) -> FileTail {
        let drift = self.drift(now);
        if drift.unsigned_abs() > CLOCK_SET.as_nanos() {
            let drift = i64::try_from(drift).unwrap_or_default();
            self.opening.base_nanos = self.opening.base_nanos.saturating_add_signed(drift);
            self.clock = now;
        }
        self.opening.began = self.newest;
        self.opening.part = Some(part);
        self.part_since = now.since;
        let old = std::mem::replace(&mut self.tail, next);
        if let Ok(writer) = self.writer.next(&self.opening) {
            self.writer = writer;
        }
        self.open = Content::default();
        let at = self.newest;
        if let Some(link) = self.link.clone() {
            self.write(&Entry::Link(LinkReport { at, ..link }));
        }
        if let Some(parameters) = self.parameters.clone() {
            self.write(&Entry::Event(Event { at, ..parameters }));
        }
        self.report_missing(at);
        old
    }
}

/// The first part of a recording.
const fn first_part(recording_began: Moment) -> Part {
    Part {
        recording_began,
        number: 1,
    }
}
