//! Reads a recording file, and with it the others of its recording: summary, entries by time range, and missing data.

use crate::hand::Moment;
use crate::record::file::by_time;
use crate::record::file::channels::Definitions;
use crate::record::file::clock;
pub use crate::record::file::damage::{Damage, MessageGap, Remark};
use crate::record::file::format::decode::EntryDecoder;
use crate::record::file::format::opening::{METADATA, Opening, moment_of, nanos_of};
use crate::record::file::format::topic::Topic;
use crate::record::file::overview::{Overview, SECONDS_MAX};
use crate::record::file::parts;
use crate::record::file::walk::{
    self, ByteRange, ChunkKind, ChunkMessage, ChunkPlace, ChunkRecord, Found, MAGIC, Survey,
    UNPACKED_MAX, UNPACKED_TIMES, long_records, messages, records,
};
use crate::record::file::writer::OVERVIEW;
use crate::record::{Entry, EventKind};
use crate::system::SystemError;
use mcap::records::{Record as McapRecord, op};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom};
use std::ops::{ControlFlow, RangeInclusive};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Maximum length of an overview block; the data of a longer one is recomputed.
pub(crate) const BLOCK_MAX: u64 = 1024 * 1024;

/// Time before a range from which entries are read as well, so that slowly polled groups are known in it.
const WARM_UP: Duration = Duration::from_secs(6);

/// Time within which the hand's parameters are recorded; reading them may take ten seconds.
const PARAMETERS_TIMEOUT: Duration = Duration::from_secs(60);

/// Maximum deviation from the order of time between several sources, also at the border of two files.
const APART: Duration = Duration::from_secs(1);

/// Bytes in a megabyte, as used for file sizes.
pub(crate) const MEGABYTE: u64 = 1024 * 1024;

/// Bytes read from the beginning of a file: header, opening and definitions.
const BEGINNING: u64 = 64 * 1024;
/// Library prefix in the header of our files.
const LIBRARY: &str = "handscope ";

/// Reason why a file cannot be opened as a recording.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OpenError {
    /// The system could not read it.
    #[error("{error}")]
    Unreadable { error: SystemError },
    /// A folder, a device, a pipe.
    #[error("it is not a regular file")]
    NotAFile,
    #[error("it is not an MCAP file: its first bytes are wrong")]
    NotMcap,
    /// MCAP of another program.
    #[error("it is an MCAP file of another program: none of its topics is Handscope's")]
    Foreign,
    /// Merged recordings of several hands.
    #[error("it holds recordings of several hands, whose values cannot be told apart: {hands}")]
    SeveralHands { hands: String },
    /// It unpacks to more than any recording does.
    #[error(
        "its chunks unpack to {megabytes} MB more than the limit of {} MB plus {UNPACKED_TIMES} times its length", UNPACKED_MAX / MEGABYTE
    )]
    TooMuch { megabytes: u64 },
    /// It contains nothing readable.
    #[error("nothing in it can be read: it holds no complete part of a recording")]
    Empty,
}

impl From<io::Error> for OpenError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable {
            error: error.into(),
        }
    }
}

/// An open recording file, and those that follow it in its recording.
///
/// ```no_run
/// use handscope_core::record::file::RecordingFile;
/// use handscope_core::record::file::reader::TimeRange;
/// use std::ops::ControlFlow;
///
/// let file = RecordingFile::open("recording.mcap".as_ref())?;
/// file.entries(TimeRange::WHOLE, |entry| {
///     println!("{entry:?}");
///     ControlFlow::Continue(())
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RecordingFile {
    path: PathBuf,
    file: Mutex<File>,
    found: Found,
    /// Topic of each channel.
    topics: BTreeMap<u16, Topic>,
    order: MessageOrder,
    /// Nanoseconds by which the log times are ahead of those in the messages.
    difference: i64,
    /// True if some of its messages have no log time.
    has_unlogged: bool,
    /// Missing data found when the file was opened.
    damage: Damage,
    remarks: Vec<Remark>,
    opening: Opening,
    overview: Overview,
    last: Moment,
    /// The following files, ordered by time. Remarks, overview and last moment of this file cover all of them.
    later: Vec<Self>,
}

/// Order of the messages in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MessageOrder {
    /// As Handscope wrote them: numbered consecutively, and nearly in the order of time.
    Numbered,
    /// Any order.
    Any,
}

/// Selects the entries to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeRange {
    /// Start of the time range.
    pub from: Moment,
    /// End of the time range, included.
    pub to: Moment,
    /// True if bytes on the wire are read, too.
    pub wire: bool,
}

impl TimeRange {
    /// All of a file.
    pub const WHOLE: Self = Self {
        from: Moment::ZERO,
        to: Moment::from_micros(u64::MAX / 2000),
        wire: true,
    };
}

impl RecordingFile {
    /// Opens a file, and the other files of its recording in the same folder. Those that cannot be opened count as missing. Opens
    /// a rosbag2 folder by the files that it lists.
    ///
    /// # Errors
    /// [`OpenError`] of this file.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        if let Some(files) = parts::of_bag(path) {
            let (all, refused) = Self::open_all(&files);
            let why = refused.into_iter().next().map(|(_, why)| why);
            return why.map_or(all.ok_or(OpenError::Empty), Err);
        }
        let (all, refused) = Self::open_all(&parts::of(path));
        match refused.into_iter().find(|(refused, _)| refused == path) {
            Some((_, why)) => Err(why),
            None => all.ok_or(OpenError::Empty),
        }
    }

    /// Opens the files of one recording; also returns those that cannot be opened.
    pub fn open_all(paths: &[PathBuf]) -> (Option<Self>, Vec<(PathBuf, OpenError)>) {
        let (mut all, mut refused) = (None::<Self>, Vec::new());
        for path in paths {
            match (Self::open_one(path), &mut all) {
                (Ok(file), Some(all)) => all.join(file),
                (Ok(file), None) => all = Some(file),
                (Err(why), _) => refused.push((path.clone(), why)),
            }
        }
        if let Some(all) = &mut all {
            let newest = all.parts().last().and_then(|file| file.opening.part);
            let files = u32::try_from(all.parts().count()).unwrap_or(u32::MAX);
            let missing = newest.map_or(0, |newest| newest.number.saturating_sub(files));
            if missing > 0 {
                all.remarks.push(Remark::FilesMissing(missing));
            }
        }
        (all, refused)
    }

    fn open_one(path: &Path) -> Result<Self, OpenError> {
        if !std::fs::metadata(path)?.is_file() {
            return Err(OpenError::NotAFile);
        }
        Self::of(File::open(path)?, path)
    }

    /// Opens a file from a handle; `path` is only stored for reference.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn of(mut file: File, path: &Path) -> Result<Self, OpenError> {
        file.rewind()?;
        let mut magic = [0; MAGIC.len()];
        if file.read_exact(&mut magic).is_err() || magic != MAGIC {
            return Err(OpenError::NotMcap);
        }
        let mut recording = match own(&mut file)? {
            Some(found) => Self::numbered(path, file, found),
            None => {
                let survey = walk::survey(&mut file)?;
                Self::surveyed(path, file, survey)?
            }
        };
        recording.find_opening()?;
        recording.find_overview()?;
        Ok(recording)
    }

    /// Opens a file in Handscope's own form.
    fn numbered(path: &Path, file: File, mut found: Found) -> Self {
        found.chunks.retain(|chunk| chunk.last_nanos > 0);
        let topics = Topic::all().map(|topic| (topic.channel(), topic));
        Self {
            path: path.to_owned(),
            file: Mutex::new(file),
            topics: topics.collect(),
            order: MessageOrder::Numbered,
            difference: 0,
            has_unlogged: false,
            damage: Damage {
                bytes: found.skipped,
                ..Damage::default()
            },
            remarks: Vec::from_iter(found.stale_index.then_some(Remark::StaleIndex)),
            found,
            opening: Opening::unknown(0),
            overview: Overview::default(),
            last: Moment::ZERO,
            later: Vec::new(),
        }
    }

    /// Opens a file that another program wrote or changed.
    fn surveyed(path: &Path, file: File, survey: Survey) -> Result<Self, OpenError> {
        let (topics, skipped) = survey.definitions.topics();
        let counted = survey.definitions.messages();
        let mut found = survey.found;
        if topics.values().all(|topic| topic.is_common()) {
            if survey.left_out > 0 {
                return Err(OpenError::TooMuch {
                    megabytes: survey.left_out.div_ceil(MEGABYTE),
                });
            }
            return Err(if survey.definitions.is_empty() {
                OpenError::Empty
            } else {
                OpenError::Foreign
            });
        }
        let namespaces = survey.definitions.namespaces();
        if namespaces.len() > 1 {
            let shown = |name: &&str| if name.is_empty() { "/" } else { name }.to_owned();
            let hands: Vec<String> = namespaces.iter().map(shown).collect();
            return Err(OpenError::SeveralHands {
                hands: hands.join(", "),
            });
        }
        found.chunks.sort_by_key(|chunk| chunk.first_nanos);
        let remarks = [
            (true, Remark::Rewritten),
            (found.stale_index, Remark::StaleIndex),
            (survey.sum_differs, Remark::SumDiffers),
        ];
        let remarks = remarks
            .into_iter()
            .filter_map(|(is, one)| is.then_some(one));
        let skipped = skipped.into_iter().map(Remark::Skipped);
        let difference = survey.clock.difference(&topics);
        let unlogged = survey.clock.unlogged.iter();
        let unlogged = unlogged.filter(|(channel, _)| topics.contains_key(channel));
        let unlogged: u64 = unlogged.map(|(_, messages)| messages).sum();
        let clock = [
            is_moved(difference).then_some(Remark::LogMoved { nanos: difference }),
            (unlogged > 0).then_some(Remark::Unlogged(unlogged)),
            (survey.left_out > 0).then(|| Remark::TooMuch {
                megabytes: survey.left_out.div_ceil(MEGABYTE),
            }),
        ];
        let announced = found.messages.unwrap_or_default();
        Ok(Self {
            path: path.to_owned(),
            file: Mutex::new(file),
            topics,
            order: MessageOrder::Any,
            difference,
            has_unlogged: unlogged > 0,
            damage: Damage {
                chunks: survey.damaged,
                bytes: found.skipped,
                messages: announced.saturating_sub(counted),
                gaps: Vec::new(),
            },
            remarks: remarks
                .chain(clock.into_iter().flatten())
                .chain(skipped)
                .collect(),
            found,
            opening: Opening::unknown(0),
            overview: Overview::default(),
            last: Moment::ZERO,
            later: Vec::new(),
        })
    }

    /// Appends the next file.
    fn join(&mut self, mut later: Self) {
        self.last = self.last.max(later.last);
        self.overview.add(std::mem::take(&mut later.overview));
        for remark in std::mem::take(&mut later.remarks) {
            if !self.remarks.contains(&remark) {
                self.remarks.push(remark);
            }
        }
        self.later.push(later);
    }

    /// Itself and the files after it.
    fn parts(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.later)
    }

    /// Paths of all its files, ordered by time.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.parts().map(|file| file.path.as_path())
    }

    /// Total size of its files in bytes.
    pub fn bytes(&self) -> u64 {
        let files = self.paths().map(std::fs::metadata);
        files.flatten().map(|about| about.len()).sum()
    }

    /// Path of the first file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub const fn opening(&self) -> &Opening {
        &self.opening
    }

    pub const fn overview(&self) -> &Overview {
        &self.overview
    }

    /// Time of the first entry.
    pub const fn first(&self) -> Moment {
        self.opening.began
    }

    /// Time of the last entry.
    pub const fn last(&self) -> Moment {
        self.last
    }

    /// True if the recording was closed properly, and not by a crash.
    pub fn is_closed(&self) -> bool {
        self.parts().all(|file| file.found.closed)
    }

    /// True if missing data was found when the file was opened.
    pub fn is_damaged(&self) -> bool {
        self.parts().any(|file| file.damage != Damage::default())
    }

    /// Remarks about the file's condition.
    pub fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// Passes each entry of a time range to `take`, in file order, or in order of time if another program wrote the file, until
    /// `take` breaks. A reading holds the newest of all groups that were read in the seconds before the range.
    ///
    /// # Errors
    /// The system's error.
    pub fn entries(
        &self,
        stretch: TimeRange,
        mut take: impl FnMut(Entry) -> ControlFlow<()>,
    ) -> io::Result<Damage> {
        let warm = stretch.from.since(Moment::ZERO).saturating_sub(WARM_UP);
        let warm = Moment::from_duration(warm);
        let mut decoder = EntryDecoder::of(&self.opening);
        self.each(warm, stretch.to, |topic, message| {
            if topic == Topic::Wire && !stretch.wire {
                return ControlFlow::Continue(());
            }
            let entry = decoder.decode(topic, message.times, message.data);
            let inside = |entry: &Entry| (stretch.from..=stretch.to).contains(&entry.at());
            match entry.filter(inside) {
                Some(entry) => take(entry),
                None => ControlFlow::Continue(()),
            }
        })
    }

    /// Passes on each message as stored, in file order: topic, times in nanoseconds since 1970 (received, asked), bytes.
    ///
    /// # Errors
    /// The system's error.
    pub fn messages(
        &self,
        from: Moment,
        to: Moment,
        mut take: impl FnMut(Topic, (u64, u64), &[u8]),
    ) -> io::Result<Damage> {
        let within = self.nanos(from, to);
        self.each(from, to, |topic, message| {
            if within.contains(&message.times.0) {
                take(topic, message.times, message.data);
            }
            ControlFlow::Continue(())
        })
    }

    /// Passes on each message of a known topic in the chunks that overlap a time range.
    fn each(
        &self,
        from: Moment,
        to: Moment,
        mut take: impl FnMut(Topic, &ChunkMessage<'_>) -> ControlFlow<()>,
    ) -> io::Result<Damage> {
        let mut damage = Damage::default();
        let mut flow = ControlFlow::Continue(());
        for file in self.parts() {
            let is_beside = file.last < from || file.first() > to.plus(APART);
            if flow.is_break() || is_beside && !self.later.is_empty() {
                damage.add(&file.damage);
                continue;
            }
            let known = |message: &ChunkMessage<'_>| {
                if let Some(topic) = file.topics.get(&message.channel) {
                    flow = take(*topic, message);
                }
                flow
            };
            damage.add(&file.each_of_file(from, to, known)?);
        }
        Ok(damage)
    }

    /// The messages of one file.
    fn each_of_file(
        &self,
        from: Moment,
        to: Moment,
        take: impl FnMut(&ChunkMessage<'_>) -> ControlFlow<()>,
    ) -> io::Result<Damage> {
        match self.order {
            MessageOrder::Numbered => self.each_numbered(from, to, take),
            MessageOrder::Any => {
                let within = self.nanos(from, to);
                self.each_by_time(within, take)?;
                Ok(self.damage.clone())
            }
        }
    }

    /// Passes on the messages of a time range in order of time, each with its corrected time.
    fn each_by_time(
        &self,
        within: RangeInclusive<u64>,
        take: impl FnMut(&ChunkMessage<'_>) -> ControlFlow<()>,
    ) -> io::Result<()> {
        let scan = |chunk: &ChunkPlace, take: &mut dyn FnMut(ChunkMessage<'_>)| {
            let mut ours = |message: ChunkMessage<'_>| {
                if self.topics.contains_key(&message.channel) {
                    take(self.timed(message));
                }
            };
            // Its integrity was checked when the file was opened.
            if chunk.kind == ChunkKind::Long {
                let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
                let mut file = BufReader::new(&mut *file);
                let mut chunk = walk::reader(&mut file, chunk.place)?;
                let _whole = long_records(&mut chunk, |record| {
                    if let ChunkRecord::Message(message) = record {
                        ours(message);
                    }
                })?;
            } else {
                let _whole = messages(&mut self.read(chunk.place)?, chunk.kind, ours);
            }
            Ok(())
        };
        by_time::each(&self.found.chunks, within, scan, take)
    }

    /// A message with its corrected time.
    fn timed<'a>(&self, message: ChunkMessage<'a>) -> ChunkMessage<'a> {
        let Some(topic) = self.topics.get(&message.channel) else {
            return message;
        };
        let received = clock::received(*topic, message.times.0, message.data, self.difference);
        let times = match message.times {
            (0, _) => (received, received),
            times => times,
        };
        ChunkMessage { times, ..message }
    }

    /// Times of receipt of the first and the last message, nanoseconds since 1970.
    fn span(&self) -> io::Result<Option<(u64, u64)>> {
        let mut span = None;
        let mut note = |first: u64, last: u64| {
            let (from, to) = span.unwrap_or((first, last));
            span = Some((first.min(from), last.max(to)));
        };
        if self.has_unlogged {
            let all = 0..=u64::MAX;
            self.each_by_time(all, |message| {
                if self.topics.contains_key(&message.channel) {
                    note(message.times.0, message.times.0);
                }
                ControlFlow::Continue(())
            })?;
        } else {
            let chunks = self.found.chunks.iter();
            chunks.for_each(|chunk| note(chunk.first_nanos, chunk.last_nanos));
        }
        Ok(span)
    }

    /// Passes on the messages in file order, and detects gaps in their numbers.
    fn each_numbered(
        &self,
        from: Moment,
        to: Moment,
        mut take: impl FnMut(&ChunkMessage<'_>) -> ControlFlow<()>,
    ) -> io::Result<Damage> {
        let mut damage = self.damage.clone();
        let mut numbers = NumberCheck::default();
        let at = |nanos| moment_of(self.opening.base_nanos, nanos);
        for (place, chunk) in self.reaching(from, to) {
            let mut bytes = self.read(chunk.place)?;
            let mut flow = ControlFlow::Continue(());
            numbers.chunk(place, nanos_of(self.opening.base_nanos, self.opening.began));
            let is_whole = messages(&mut bytes, chunk.kind, |message| {
                if let Some((from, missing)) = numbers.message(message.sequence, message.times.0) {
                    damage.gap(MessageGap {
                        from: at(from),
                        to: at(message.times.0),
                        messages: missing,
                    });
                }
                if flow.is_continue() {
                    flow = take(&message);
                }
            });
            damage.chunks += u64::from(!is_whole);
            if flow.is_break() {
                return Ok(damage);
            }
        }
        // A loss at the end is not followed by a message that would reveal it.
        let last = self.found.chunks.last();
        if let Some(last) = last.filter(|_| numbers.next_chunk == self.found.chunks.len()) {
            let (number, nanos) = numbers.last.unwrap_or((0, last.first_nanos));
            let written = self.found.messages.unwrap_or_default();
            let messages = written.saturating_sub(u64::from(number));
            if messages > 0 || numbers.is_open() {
                damage.gap(MessageGap {
                    from: at(nanos),
                    to: at(last.last_nanos).max(at(nanos)),
                    messages,
                });
            }
        }
        Ok(damage)
    }

    /// A time range in nanoseconds since 1970, including the whole last microsecond.
    fn nanos(&self, from: Moment, to: Moment) -> RangeInclusive<u64> {
        let base = self.opening.base_nanos;
        nanos_of(base, from)..=nanos_of(base, to).saturating_add(999)
    }

    /// The chunks that overlap a time range, with their indices.
    fn reaching(&self, from: Moment, to: Moment) -> impl Iterator<Item = (usize, &ChunkPlace)> {
        let (from, to) = self.nanos(from, to).into_inner();
        let all = self.found.chunks.as_slice();
        // The times in a chunk's header may be damaged: it spans at least from the previous chunk to the next one.
        let before = std::iter::once(0).chain(all.iter().map(|chunk| chunk.last_nanos));
        let after = all.iter().skip(1).map(|chunk| chunk.first_nanos);
        let around = before.zip(after.chain([u64::MAX]));
        let reaching = all.iter().enumerate().zip(around);
        let reaching = reaching.filter(move |((_, chunk), (before, after))| {
            chunk.last_nanos.max(*after) >= from && chunk.first_nanos.min(*before) <= to
        });
        reaching.map(|(chunk, _)| chunk)
    }

    fn read(&self, place: ByteRange) -> io::Result<Vec<u8>> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        walk::whole(&mut *file, place)
    }

    /// Reads the file's opening. If that is lost, derives what it can.
    fn find_opening(&mut self) -> Result<(), OpenError> {
        let span = self.span()?;
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        let openings = openings(file, &self.found.metadata)?;
        let hands: BTreeSet<&str> = openings
            .iter()
            .map(|opening| opening.hand.as_str())
            .collect();
        if hands.len() > 1 {
            let hands = Vec::from_iter(hands).join(", ");
            return Err(OpenError::SeveralHands { hands });
        }
        // Picks the first of merged recordings of one hand.
        let opening = openings.into_iter().min_by_key(Opening::began_since_1970);
        match opening {
            Some(opening) if is_moved(self.difference) => {
                self.opening = opening.moved(self.difference);
            }
            Some(opening) => self.opening = opening,
            None => {
                let (first, _) = span.ok_or(OpenError::Empty)?;
                self.opening = Opening::unknown(first);
                self.remarks.push(Remark::OpeningLost);
            }
        }
        let last = span.map_or(0, |(_, last)| last);
        let last = moment_of(self.opening.base_nanos, last);
        self.last = last.max(self.opening.began);
        if self.opening.hand.is_empty() {
            self.find_hand()?;
        }
        Ok(())
    }

    /// Finds the hand named in its parameters, which are recorded soon after the beginning.
    fn find_hand(&mut self) -> io::Result<()> {
        let mut hand = None;
        let stretch = TimeRange {
            from: Moment::ZERO,
            to: Moment::ZERO.plus(PARAMETERS_TIMEOUT),
            wire: false,
        };
        self.entries(stretch, |entry| {
            if let Entry::Event(event) = entry
                && event.kind == EventKind::Parameters
                && let Ok(table) = event.words.parse::<toml::Table>()
                && let Some(named) = table.get("hand").and_then(toml::Value::as_str)
            {
                hand = Some(named.to_owned());
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        if let Some(hand) = hand {
            self.opening.simulated = hand.starts_with("sim:");
            self.opening.hand = hand;
        }
        Ok(())
    }

    fn find_overview(&mut self) -> Result<(), OpenError> {
        let overview = match self.order {
            MessageOrder::Numbered => {
                let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
                overview(file, &self.found, &self.opening)?
            }
            MessageOrder::Any => {
                let mut overview = Overview::default();
                let stretch = TimeRange {
                    wire: false,
                    ..TimeRange::WHOLE
                };
                self.entries(stretch, |entry| {
                    overview.apply(&entry);
                    ControlFlow::Continue(())
                })?;
                overview.sort();
                overview
            }
        };
        debug_assert!(overview.rows.len() <= SECONDS_MAX);
        self.overview = overview;
        Ok(())
    }
}

/// True if another program has shifted the log times: the deviation between sources is smaller.
fn is_moved(difference: i64) -> bool {
    Duration::from_nanos(difference.unsigned_abs()) > APART
}

/// Checks the message numbers across chunks.
#[derive(Debug, Default)]
struct NumberCheck {
    /// Number and time of the last message.
    last: Option<(u32, u64)>,
    /// Index of the chunk after the last one.
    next_chunk: usize,
    /// True if all chunks since the last message were empty.
    empty_chunks: bool,
}

impl NumberCheck {
    /// Starts a chunk. Chunks that were skipped between two are not counted as missing.
    fn chunk(&mut self, place: usize, began_nanos: u64) {
        if place != self.next_chunk {
            self.last = None;
        }
        if place == 0 {
            self.last = Some((0, began_nanos));
        }
        self.next_chunk = place + 1;
        self.empty_chunks = true;
    }

    /// The previous message's time and the number of messages missing before this one; `None` if none is missing.
    fn message(&mut self, number: u32, nanos: u64) -> Option<(u64, u64)> {
        self.empty_chunks = false;
        let (last, at) = self.last.replace((number, nanos))?;
        let missing = number.wrapping_sub(last).wrapping_sub(1);
        (missing > 0).then_some((at, u64::from(missing)))
    }

    const fn is_open(&self) -> bool {
        self.empty_chunks
    }
}

/// The records of a file that Handscope wrote and no other program changed; `None` for any other. Such a file begins with our
/// header, the opening, and a chunk with only our own definitions.
fn own(file: &mut File) -> io::Result<Option<Found>> {
    let mut begin = Vec::new();
    file.seek(SeekFrom::Start(MAGIC.len() as u64))?;
    file.take(BEGINNING).read_to_end(&mut begin)?;
    let Some((op::HEADER, header, rest)) = walk::record(&begin) else {
        return Ok(None);
    };
    let is_ours = matches!(
        mcap::parse_record(op::HEADER, header),
        Ok(McapRecord::Header(header)) if header.library.starts_with(LIBRARY)
    );
    let Some((_, _, rest)) = walk::record(rest).filter(|_| is_ours) else {
        return Ok(None);
    };
    let mut definitions = Definitions::default();
    let mut has_messages = false;
    let mut is_whole = false;
    if walk::is_chunk(rest) {
        let place = ByteRange {
            offset: MAGIC.len() as u64 + (begin.len() - rest.len()) as u64,
            len: walk::record_len(rest),
        };
        // A chunk that extends beyond the end of the file is truncated.
        if let Ok(mut chunk) = walk::whole(file, place) {
            is_whole = records(&mut chunk, ChunkKind::Chunk, |record| match record {
                ChunkRecord::Definition(code, content) => definitions.push(code, content),
                ChunkRecord::Message(_) => has_messages = true,
            });
        }
    } else if rest.first() != Some(&op::CHUNK) {
        return Ok(None);
    }
    if has_messages || is_whole && !definitions.are_own() {
        return Ok(None);
    }
    walk::walk(file).map(Some)
}

/// The file's openings; several if recordings were merged.
fn openings(file: &mut File, places: &[ByteRange]) -> io::Result<Vec<Opening>> {
    let mut all = Vec::new();
    for place in places {
        let content = walk::content(file, *place)?;
        all.extend(Opening::of_record(&content));
    }
    if all.is_empty() {
        // Its record may be unreachable, but still be in its usual position after the header.
        let mut begin = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        file.take(BEGINNING).read_to_end(&mut begin)?;
        let name = [&[9, 0, 0, 0], METADATA.as_bytes()].concat();
        let places = begin.windows(name.len()).enumerate();
        let place = places.filter(|(_, bytes)| *bytes == name).map(|(at, _)| at);
        all.extend(
            place
                .filter_map(|at| Opening::of_record(begin.get(at..)?))
                .next(),
        );
    }
    Ok(all)
}

/// The stored overview blocks, with missing parts recomputed.
fn overview(file: &mut File, found: &Found, opening: &Opening) -> Result<Overview, OpenError> {
    let mut overview = Overview::default();
    let mut covered = Vec::new();
    let blocks = found.attachments.iter();
    for place in blocks.filter(|place| place.len <= BLOCK_MAX) {
        let content = walk::content(file, *place)?;
        if let Ok(McapRecord::Attachment { header, data, crc }) =
            mcap::parse_record(op::ATTACHMENT, &content)
            && header.name == OVERVIEW
            && is_whole(&content, crc)
            && let Some(from) = overview.apply_block(&data)
        {
            covered.push(from..place.offset);
        }
    }
    covered.sort_by_key(|stretch| stretch.start);
    let is_covered = |offset: u64| {
        let after = covered.partition_point(|stretch| stretch.start <= offset);
        let last = after.checked_sub(1).and_then(|last| covered.get(last));
        last.is_some_and(|stretch| offset < stretch.end)
    };
    let mut decoder = EntryDecoder::of(opening);
    for chunk in &found.chunks {
        if is_covered(chunk.place.offset) {
            continue;
        }
        let mut bytes = walk::whole(file, chunk.place)?;
        messages(&mut bytes, chunk.kind, |message| {
            if let Some(topic) = Topic::by_channel(message.channel)
                && topic != Topic::Wire
                && let Some(entry) = decoder.decode(topic, message.times, message.data)
            {
                overview.apply(&entry);
            }
        });
    }
    overview.sort();
    Ok(overview)
}

/// Verifies an attachment: its checksum is in its last four bytes.
fn is_whole(content: &[u8], crc: u32) -> bool {
    let body = content
        .len()
        .checked_sub(4)
        .and_then(|end| content.get(..end));
    body.is_some_and(|body| crc == 0 || crc32fast::hash(body) == crc)
}
