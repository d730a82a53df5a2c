//! The records found in a recording file, and reading of their bytes, limited to our longest record.

use std::io::{self, Read, Seek, SeekFrom};

/// Maximum length of our records; a greater length is damage.
pub const RECORD_MAX: u64 = 8 * 1024 * 1024;
/// Maximum length of a message in a long chunk. Other programs put pictures, or a whole recording, into one chunk; one that is
/// longer than our records is read piece by piece.
pub const LONG_MESSAGE_MAX: u64 = 32 * 1024 * 1024;
/// All chunks of a file may unpack to this many bytes plus this multiple of the file's length; chunks beyond that are not
/// unpacked. A recording packs to a tenth, a black picture to a thousandth.
pub const UNPACKED_MAX: u64 = 64 * 1024 * 1024;
pub const UNPACKED_TIMES: u64 = 100;
/// Maximum number of chunks of one file: more than a day of one hand, in 32 MiB. Further ones are ignored.
pub const CHUNKS_MAX: usize = 1024 * 1024;
/// Maximum number of attachments and of metadata records of one file; ours have one attachment a minute.
pub const PLACES_MAX: usize = 64 * 1024;
/// Bytes at the start and the end of a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Length of the operation code and length before each record.
pub(super) const HEAD: u64 = 9;
/// [`HEAD`] as a `usize`.
pub(super) const HEAD_LEN: usize = 9;

/// Position of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ByteRange {
    /// Offset of its operation code.
    pub offset: u64,
    /// Bytes after operation code and length.
    pub len: u64,
}

/// A chunk and the times of its messages, in nanoseconds since 1970. Messages outside of chunks are grouped, up to some hundred
/// kilobytes, and read like a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChunkPlace {
    pub kind: ChunkKind,
    pub place: ByteRange,
    /// Time of its first message.
    pub first_nanos: u64,
    /// Time of its last message.
    pub last_nanos: u64,
}

/// Form in which messages are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChunkKind {
    /// A chunk of ours, protected by a checksum.
    Chunk,
    /// A chunk of another program, with any compression ratio.
    Foreign,
    /// A chunk that is too long for memory.
    Long,
    /// Outside of chunks.
    Loose,
}

/// The records of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// In file order.
    pub chunks: Vec<ChunkPlace>,
    pub attachments: Vec<ByteRange>,
    pub metadata: Vec<ByteRange>,
    /// True if the file was closed properly.
    pub closed: bool,
    /// True if the file has an index that is damaged or does not match; it was ignored.
    pub stale_index: bool,
    /// Number of messages according to the file; `None` if it has no statistics.
    pub messages: Option<u64>,
    /// Bytes without records, or beyond the limits.
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

    pub(super) fn attachment(&mut self, place: ByteRange) {
        if self.attachments.len() < PLACES_MAX {
            self.attachments.push(place);
        }
    }

    pub(super) fn metadata(&mut self, place: ByteRange) {
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

/// Reads the content of a record.
///
/// # Errors
/// The system's error.
pub(crate) fn content<F: Read + Seek>(file: &mut F, place: ByteRange) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; usize::try_from(place.len.min(RECORD_MAX)).unwrap_or_default()];
    read_at(file, place.offset + HEAD, &mut bytes)?;
    Ok(bytes)
}

/// Reads a whole record, including operation code and length.
///
/// # Errors
/// The system's error.
pub(crate) fn whole<F: Read + Seek>(file: &mut F, place: ByteRange) -> io::Result<Vec<u8>> {
    let len = place.len.min(RECORD_MAX) + HEAD;
    let mut bytes = vec![0; usize::try_from(len).unwrap_or_default()];
    read_at(file, place.offset, &mut bytes)?;
    Ok(bytes)
}

/// A reader for a record, to be read piece by piece.
///
/// # Errors
/// The system's error.
pub(crate) fn reader<F: Read + Seek>(
    file: &mut F,
    place: ByteRange,
) -> io::Result<io::Take<&mut F>> {
    file.seek(SeekFrom::Start(place.offset))?;
    Ok(file.take(place.len + HEAD))
}
