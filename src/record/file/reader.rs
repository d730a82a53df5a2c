//! Reads a session file: what it is at once, its entries by stretches of time, and what of it is missing.

use crate::hand::Moment;
use crate::record::Entry;
use crate::record::file::decode::EntryDecoder;
use crate::record::file::opening::{METADATA, Opening, moment_of, nanos_of};
use crate::record::file::overview::{Overview, SECONDS_MAX};
use crate::record::file::topic::Topic;
use crate::record::file::walk::{self, ChunkPlace, Found, MAGIC, Place, messages};
use crate::record::file::writer::OVERVIEW;
use mcap::records::{Record as McapRecord, op};
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::ops::{ControlFlow, RangeInclusive};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// No block of the overview is longer; what a longer one is about is made anew.
pub(crate) const BLOCK_MAX: u64 = 1024 * 1024;

/// Entries before a stretch that are read along, so that what is read seldom is known in it.
const WARM_UP: Duration = Duration::from_secs(6);

/// Why a file cannot be opened as a session.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OpenError {
    /// The system could not read it.
    #[error("it cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// A folder, a device, a pipe.
    #[error("it is no file, but a folder or a device")]
    NotAFile,
    /// Not MCAP.
    #[error("it is not an MCAP file: its first bytes are others")]
    NotMcap,
    /// MCAP of another program.
    #[error("it is an MCAP file of another program: none of its topics is Handscope's")]
    Foreign,
    /// Nothing that could be read.
    #[error("nothing in it can be read: it holds no whole piece of a recording")]
    Empty,
}

impl From<io::Error> for OpenError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable {
            message: error.to_string(),
        }
    }
}

/// An open session file.
#[derive(Debug)]
pub struct SessionFile {
    path: PathBuf,
    file: Mutex<File>,
    found: Found,
    opening: Opening,
    overview: Overview,
    last: Moment,
}

/// What of a file is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Damage {
    /// Chunks that cannot be read; each holds about what is recorded within [`FLUSH_EACH`](crate::record::file::FLUSH_EACH).
    pub chunks: u64,
    /// Bytes in which no record was found.
    pub bytes: u64,
}

/// What to read of the entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stretch {
    /// From here.
    pub from: Moment,
    /// To here, included.
    pub to: Moment,
    /// Whether bytes on the wire are read, too.
    pub wire: bool,
}

impl Stretch {
    /// All of a file.
    pub const WHOLE: Self = Self {
        from: Moment::ZERO,
        to: Moment::from_micros(u64::MAX / 2000),
        wire: true,
    };
}

impl SessionFile {
    /// Opens a file.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        if !std::fs::metadata(path)?.is_file() {
            return Err(OpenError::NotAFile);
        }
        let mut file = File::open(path)?;
        let mut magic = [0; MAGIC.len()];
        if file.read_exact(&mut magic).is_err() || magic != MAGIC {
            return Err(OpenError::NotMcap);
        }
        let mut found = walk::walk(&mut file)?;
        found.chunks.retain(|chunk| chunk.last_nanos > 0);
        let opening = opening(&mut file, &found)?;
        let overview = overview(&mut file, &found, &opening)?;
        let last_nanos = found.chunks.iter().map(|chunk| chunk.last_nanos).max();
        let last = moment_of(opening.base_nanos, last_nanos.unwrap_or_default());
        Ok(Self {
            path: path.to_owned(),
            last: last.max(opening.began),
            file: Mutex::new(file),
            found,
            opening,
            overview,
        })
    }

    /// Where it lies.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it began with.
    #[must_use]
    pub const fn opening(&self) -> &Opening {
        &self.opening
    }

    /// What it tells without being read whole.
    #[must_use]
    pub const fn overview(&self) -> &Overview {
        &self.overview
    }

    /// The first moment.
    #[must_use]
    pub const fn first(&self) -> Moment {
        self.opening.began
    }

    /// The last moment.
    #[must_use]
    pub const fn last(&self) -> Moment {
        self.last
    }

    /// True if the recording was ended as it should be, and not by a crash.
    #[must_use]
    pub const fn is_closed(&self) -> bool {
        self.found.closed
    }

    /// Bytes in which no record was found.
    #[must_use]
    pub const fn skipped(&self) -> u64 {
        self.found.skipped
    }

    /// Gives each entry of a stretch of time to `take`, in the order of the file, until it breaks off. A reading holds the newest of
    /// everything, as far as it was read in the seconds before the stretch.
    ///
    /// # Errors
    /// What the system says.
    pub fn entries(
        &self,
        stretch: Stretch,
        mut take: impl FnMut(Entry) -> ControlFlow<()>,
    ) -> io::Result<Damage> {
        let warm = stretch.from.since(Moment::ZERO).saturating_sub(WARM_UP);
        let warm = Moment::from_duration(warm);
        let mut decoder = EntryDecoder::of(&self.opening);
        let mut damage = Damage {
            chunks: 0,
            bytes: self.found.skipped,
        };
        for chunk in self.chunks(warm, stretch.to) {
            let bytes = self.read(chunk.place)?;
            let mut flow = ControlFlow::Continue(());
            let whole = messages(&bytes, |topic, _, message| {
                if topic == Topic::Wire && !stretch.wire || flow.is_break() {
                    return;
                }
                let entry = decoder.decode(topic, message);
                let inside = |entry: &Entry| (stretch.from..=stretch.to).contains(&entry.at());
                if let Some(entry) = entry.filter(inside) {
                    flow = take(entry);
                }
            });
            damage.chunks += u64::from(!whole);
            if flow.is_break() {
                break;
            }
        }
        Ok(damage)
    }

    /// Gives each message of the file as it stands, in its order: topic, times in nanoseconds since 1970 (received, asked), bytes.
    ///
    /// # Errors
    /// What the system says.
    pub fn messages(
        &self,
        from: Moment,
        to: Moment,
        mut take: impl FnMut(Topic, (u64, u64), &[u8]),
    ) -> io::Result<Damage> {
        let mut damage = Damage {
            chunks: 0,
            bytes: self.found.skipped,
        };
        let within = self.nanos(from, to);
        for chunk in self.chunks(from, to) {
            let bytes = self.read(chunk.place)?;
            let whole = messages(&bytes, |topic, times, message| {
                if within.contains(&times.0) {
                    take(topic, times, message);
                }
            });
            damage.chunks += u64::from(!whole);
        }
        Ok(damage)
    }

    /// A stretch in nanoseconds since 1970, the whole last microsecond included.
    fn nanos(&self, from: Moment, to: Moment) -> RangeInclusive<u64> {
        let base = self.opening.base_nanos;
        nanos_of(base, from)..=nanos_of(base, to).saturating_add(999)
    }

    fn chunks(&self, from: Moment, to: Moment) -> impl Iterator<Item = &ChunkPlace> {
        let (from, to) = self.nanos(from, to).into_inner();
        let all = self.found.chunks.as_slice();
        // The times in a chunk's head may be damaged: it reaches at least from the chunk before it to the one after.
        let before = std::iter::once(0).chain(all.iter().map(|chunk| chunk.last_nanos));
        let after = all.iter().skip(1).map(|chunk| chunk.first_nanos);
        let around = before.zip(after.chain([u64::MAX]));
        let reaching = all
            .iter()
            .zip(around)
            .filter(move |(chunk, (before, after))| {
                chunk.last_nanos.max(*after) >= from && chunk.first_nanos.min(*before) <= to
            });
        reaching.map(|(chunk, _)| chunk)
    }

    fn read(&self, place: Place) -> io::Result<Vec<u8>> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        walk::whole(&mut *file, place)
    }
}

/// What the file says of itself. Where that is lost, what can be known without it.
fn opening(file: &mut File, found: &Found) -> Result<Opening, OpenError> {
    for place in &found.metadata {
        let content = walk::content(file, *place)?;
        if let Ok(McapRecord::Metadata(read)) = mcap::parse_record(op::METADATA, &content)
            && read.name == METADATA
            && let Some(opening) = Opening::of_metadata(&read.metadata)
        {
            return Ok(opening);
        }
    }
    let first = found.chunks.iter().map(|chunk| chunk.first_nanos).min();
    let first = first.ok_or(OpenError::Empty)?;
    let mut begin = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(64 * 1024).read_to_end(&mut begin)?;
    let ours = b"handscope";
    if !begin.windows(ours.len()).any(|bytes| bytes == ours) {
        return Err(OpenError::Foreign);
    }
    Ok(Opening {
        base_nanos: first,
        began: Moment::ZERO,
        hand: String::new(),
        simulated: false,
        side: crate::hand::kinematics::Side::Right,
        version: String::new(),
    })
}

/// The blocks of the file, and what they miss made anew.
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
            && let Some(from) = overview.take_block(&data)
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
        let bytes = walk::whole(file, chunk.place)?;
        messages(&bytes, |topic, _, message| {
            if topic != Topic::Wire
                && let Some(entry) = decoder.decode(topic, message)
            {
                overview.take(&entry);
            }
        });
    }
    overview.sort();
    debug_assert!(overview.rows.len() <= SECONDS_MAX);
    Ok(overview)
}

/// The sum over an attachment stands in its last four bytes.
fn is_whole(content: &[u8], crc: u32) -> bool {
    let body = content
        .len()
        .checked_sub(4)
        .and_then(|end| content.get(..end));
    body.is_some_and(|body| crc == 0 || crc32fast::hash(body) == crc)
}
