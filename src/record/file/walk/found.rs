//! What is found of a recording file, and how its bytes are read: no further than the longest record of ours.

use std::io::{self, Read, Seek, SeekFrom};

/// No record of ours is longer; what says so is damaged.
pub const RECORD_MAX: u64 = 8 * 1024 * 1024;
/// Other programs put pictures into a chunk, or all of a recording. One that is longer than a record of ours is read piece by piece,
/// and holds no longer message than this.
pub const LONG_MESSAGE_MAX: u64 = 32 * 1024 * 1024;
/// All chunks of a file may unpack to so many bytes, and to so many times its length; what claims more is not unpacked. A recording
/// packs to a tenth, a black picture to a thousandth.
pub const UNPACKED_MAX: u64 = 64 * 1024 * 1024;
pub const UNPACKED_TIMES: u64 = 100;
/// Chunks of one file: more than a day of one hand, in 32 MiB. A file made of tiny ones is read without those after.
pub const CHUNKS_MAX: usize = 1024 * 1024;
/// Attachments and metadata of one file; ours have one attachment a minute.
pub const PLACES_MAX: usize = 64 * 1024;
/// Begins and ends a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Operation code and length before each record.
pub(super) const HEAD: u64 = 9;
/// The same as a number of bytes in memory.
pub(super) const HEAD_LEN: usize = 9;

/// Where a record stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Of its operation code.
    pub offset: u64,
    /// Bytes after operation code and length.
    pub len: u64,
}

/// A chunk and the times of its messages, in nanoseconds since 1970. Messages that stand in a file outside of chunks are taken
/// together by the hundred kilobytes, and read as if they were one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChunkPlace {
    /// Whether it is a chunk, or records outside of chunks.
    pub kind: ChunkKind,
    pub place: Place,
    /// Of its first message.
    pub first_nanos: u64,
    /// Of its last message.
    pub last_nanos: u64,
}

/// How messages stand in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChunkKind {
    /// In a chunk of ours, whose sum protects them.
    Chunk,
    /// The same of another program, which may pack what it likes.
    Foreign,
    /// The same, too long to be held.
    Long,
    /// Outside of chunks.
    Loose,
}

/// The records of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// In the order of the file.
    pub chunks: Vec<ChunkPlace>,
    pub attachments: Vec<Place>,
    pub metadata: Vec<Place>,
    /// True if the file was ended as it should be.
    pub closed: bool,
    /// True if the file has an index that does not fit it, or that is damaged; it was gone around.
    pub stale_index: bool,
    /// How many messages were written, where the file says so.
    pub messages: Option<u64>,
    /// Bytes in which no record was found, or no room for one.
    pub skipped: u64,
}

impl Found {
    pub(super) fn chunk(&mut self, chunk: ChunkPlace) {
        if self.chunks.len() < CHUNKS_MAX {
            self.chunks.push(chunk)
        } else {
            self.skipped += HEAD + chunk.place.len
        }
    }

    pub(super) fn attachment(&mut self, place: Place) {
        if self.attachments.len() < PLACES_MAX {
            self.attachments.push(place);
        }
    }

    pub(super) fn metadata(&mut self, place: Place) {
        if self.metadata.len() < PLACES_MAX {
            self.metadata.push(place);
        }
    }
}

pub(super) fn read_at<F: Read + Seek>(
    file: &mut F,
    offset: u64,
    bytes: &mut [u8],
) -> io::Result<()> {
    file.seek(SeekFrom::Start(offset))?;
    file.read_exact(bytes)
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_le_bytes(*four))
}

pub(super) fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    let eight = bytes.get(at..)?.first_chunk()?;
    Some(u64::from_le_bytes(*eight))
}

/// The content of a record.
///
/// # Errors
/// What the system says.
pub(crate) fn content<F: Read + Seek>(file: &mut F, place: Place) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; usize::try_from(place.len.min(RECORD_MAX)).unwrap_or_default()];
    read_at(file, place.offset + HEAD, &mut bytes)?;
    Ok(bytes)
}

/// The whole of a record, operation code and length included.
///
/// # Errors
/// What the system says.
pub(crate) fn whole<F: Read + Seek>(file: &mut F, place: Place) -> io::Result<Vec<u8>> {
    let len = place.len.min(RECORD_MAX) + HEAD;
    let mut bytes = vec![0; usize::try_from(len).unwrap_or_default()];
    read_at(file, place.offset, &mut bytes)?;
    Ok(bytes)
}

/// A record to be read piece by piece.
///
/// # Errors
/// What the system says.
pub(crate) fn reader<F: Read + Seek>(file: &mut F, place: Place) -> io::Result<io::Take<&mut F>> {
    file.seek(SeekFrom::Start(place.offset))?;
    Ok(file.take(place.len + HEAD))
}
