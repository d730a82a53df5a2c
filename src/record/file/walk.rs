//! Finds the records of a session file that may be cut, damaged, or made to harm: every length is checked before it is used, and after
//! damage it goes on at the next place where a chunk can begin.

use std::io::{self, Read, Seek, SeekFrom};

/// No record of ours is longer; what says so is damaged.
pub const RECORD_MAX: u64 = 8 * 1024 * 1024;
/// Chunks of one file: more than a day of one hand, in 32 MiB. A file made of tiny ones is read without those after.
pub const CHUNKS_MAX: usize = 1024 * 1024;
/// Attachments and metadata of one file; ten hours have 600 blocks.
pub const PLACES_MAX: usize = 64 * 1024;
/// The index of a closed file is read piece by piece; none of its records is longer.
const INDEX_RECORD_MAX: usize = 64 * 1024;
/// Bytes of the index read at once.
const INDEX_PIECE: usize = 1024 * 1024;
/// Begins and ends a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Operation code and length before each record.
const HEAD: u64 = 9;
/// The same as a number of bytes in memory.
const HEAD_LEN: usize = 9;
/// Bytes of the head of a chunk that are looked at.
const CHUNK_HEAD: usize = 8 + 8 + 8 + 4 + 4;
/// Bytes read at once where records follow each other: the indexes of a chunk's messages, and the head of the next chunk.
const AHEAD: usize = 4096;
/// Bytes searched at once for the next chunk.
const SEARCH: usize = 64 * 1024;

const OP_FOOTER: u8 = 0x02;
const OP_CHUNK: u8 = 0x06;
const OP_CHUNK_INDEX: u8 = 0x08;
const OP_ATTACHMENT: u8 = 0x09;
const OP_ATTACHMENT_INDEX: u8 = 0x0A;
const OP_METADATA: u8 = 0x0C;
const OP_METADATA_INDEX: u8 = 0x0D;
const OP_LAST: u8 = 0x0F;

/// Where a record stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Of its operation code.
    pub offset: u64,
    /// Bytes after operation code and length.
    pub len: u64,
}

/// A chunk and the times of its messages, in nanoseconds since 1970.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChunkPlace {
    /// Where.
    pub place: Place,
    /// Of its first message.
    pub first_nanos: u64,
    /// Of its last message.
    pub last_nanos: u64,
}

/// The records of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// In the order of the file.
    pub chunks: Vec<ChunkPlace>,
    /// Attachments.
    pub attachments: Vec<Place>,
    /// Metadata.
    pub metadata: Vec<Place>,
    /// True if the file was ended as it should be.
    pub closed: bool,
    /// Bytes in which no record was found, or no room for one.
    pub skipped: u64,
}

impl Found {
    fn chunk(&mut self, chunk: ChunkPlace) {
        match self.chunks.len() < CHUNKS_MAX {
            true => self.chunks.push(chunk),
            false => self.skipped += HEAD + chunk.place.len,
        }
    }

    fn attachment(&mut self, place: Place) {
        if self.attachments.len() < PLACES_MAX {
            self.attachments.push(place);
        }
    }

    fn metadata(&mut self, place: Place) {
        if self.metadata.len() < PLACES_MAX {
            self.metadata.push(place);
        }
    }
}

/// Finds the records: by the file's own index where there is one that is whole, else one after the other.
///
/// # Errors
/// What the system says; nothing that stands in the file is an error.
pub fn walk<F: Read + Seek>(file: &mut F) -> io::Result<Found> {
    let len = file.seek(SeekFrom::End(0))?;
    if let Some(found) = by_index(file, len)? {
        return Ok(found);
    }
    one_by_one(file, len)
}

fn read_at<F: Read + Seek>(file: &mut F, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(offset))?;
    file.read_exact(bytes)
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    let eight = bytes.get(at..)?.first_chunk()?;
    Some(u64::from_le_bytes(*eight))
}

/// Operation code, content, and what follows it.
fn record(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (op, rest) = bytes.split_first()?;
    let len = usize::try_from(u64_at(rest, 0)?).ok()?;
    let rest = rest.get(8..)?;
    Some((*op, rest.get(..len)?, rest.get(len..)?))
}

fn by_index<F: Read + Seek>(file: &mut F, len: u64) -> io::Result<Option<Found>> {
    const TAIL: usize = 9 + 20 + 8;
    let tail_at = len.saturating_sub(TAIL as u64);
    let mut tail = [0; TAIL];
    if len < TAIL as u64 + 8 {
        return Ok(None);
    }
    read_at(file, tail_at, &mut tail)?;
    let footer = record(&tail).filter(|(op, body, _)| *op == OP_FOOTER && body.len() == 20);
    let Some((_, body, rest)) = footer.filter(|(_, _, rest)| *rest == MAGIC) else {
        return Ok(None);
    };
    debug_assert_eq!(rest.len(), MAGIC.len());
    let start = u64_at(body, 0).unwrap_or_default();
    let crc = body.get(16..).and_then(<[u8]>::first_chunk);
    let crc = crc.map_or(0, |crc| u32::from_le_bytes(*crc));
    if start == 0 || crc == 0 || start >= tail_at {
        return Ok(None);
    }
    let mut index = Index::new(start);
    let mut at = start;
    let mut piece = Vec::new();
    while at < tail_at {
        let len = usize::try_from(tail_at - at)
            .unwrap_or(usize::MAX)
            .min(INDEX_PIECE);
        let before = piece.len();
        piece.resize(before + len, 0);
        let new = piece.get_mut(before..).unwrap_or_default();
        read_at(file, at, new)?;
        index.hash.update(new);
        let Some(taken) = index.take(&piece) else {
            return Ok(None);
        };
        piece.drain(..taken);
        at += u64::try_from(len).unwrap_or_default();
    }
    index.hash.update(tail.get(..TAIL - 12).unwrap_or_default());
    let whole = index.hash.finalize() == crc && piece.is_empty();
    Ok(whole.then_some(index.found))
}

/// What the index of a closed file tells so far.
struct Index {
    found: Found,
    hash: crc32fast::Hasher,
    /// Where the index begins: what it tells of stands before.
    start: u64,
    /// Where the last chunk ends. The next comes after, else one could be told of any number of times.
    after: u64,
}

impl Index {
    fn new(start: u64) -> Self {
        Self {
            found: Found {
                closed: true,
                ..Found::default()
            },
            hash: crc32fast::Hasher::new(),
            start,
            after: 0,
        }
    }

    /// Takes the whole records of some bytes; how long they are. `None` if they do not tell of the file's own.
    fn take(&mut self, bytes: &[u8]) -> Option<usize> {
        let mut rest = bytes;
        while let Some((op, body, next)) = record(rest) {
            self.record(op, body)?;
            rest = next;
        }
        let is_short = rest.len() <= INDEX_RECORD_MAX;
        is_short.then_some(bytes.len() - rest.len())
    }

    fn record(&mut self, op: u8, body: &[u8]) -> Option<()> {
        match op {
            OP_CHUNK_INDEX => {
                let place = self.place(u64_at(body, 16)?, u64_at(body, 24)?)?;
                if place.offset < self.after {
                    return None;
                }
                self.after = place.offset + HEAD + place.len;
                self.found.chunk(ChunkPlace {
                    place,
                    first_nanos: u64_at(body, 0)?,
                    last_nanos: u64_at(body, 8)?,
                });
            }
            OP_ATTACHMENT_INDEX => {
                let place = self.place(u64_at(body, 0)?, u64_at(body, 8)?)?;
                self.found.attachment(place);
            }
            OP_METADATA_INDEX => {
                let place = self.place(u64_at(body, 0)?, u64_at(body, 8)?)?;
                self.found.metadata(place);
            }
            _ => {}
        }
        Some(())
    }

    fn place(&self, offset: u64, whole: u64) -> Option<Place> {
        let len = whole.checked_sub(HEAD).filter(|len| *len <= RECORD_MAX)?;
        let end = offset.checked_add(whole)?;
        (len > 0 && end <= self.start).then_some(Place { offset, len })
    }
}

fn one_by_one<F: Read + Seek>(file: &mut F, len: u64) -> io::Result<Found> {
    let mut found = Found::default();
    let mut at = MAGIC.len() as u64;
    let (mut ahead, mut ahead_at) = (Vec::new(), 0);
    while at + HEAD <= len {
        let left = usize::try_from(len - at).unwrap_or(usize::MAX);
        let wanted = left.min(HEAD_LEN + CHUNK_HEAD);
        let mut from = usize::try_from(at - ahead_at).unwrap_or(usize::MAX);
        if from.saturating_add(wanted) > ahead.len() {
            ahead.resize(left.min(AHEAD), 0);
            read_at(file, at, &mut ahead)?;
            (ahead_at, from) = (at, 0);
        }
        let head = ahead.get(from..from + wanted).unwrap_or_default();
        match plausible(head, at, len) {
            Some(next) => {
                note(head, at, &mut found);
                at = next;
            }
            None => {
                let next = next_chunk(file, at + 1, len)?;
                found.skipped += next - at;
                at = next;
            }
        }
    }
    found.skipped += len.saturating_sub(at);
    Ok(found)
}

/// Where the record ends, if one can stand here.
fn plausible(head: &[u8], at: u64, len: u64) -> Option<u64> {
    let op = *head.first()?;
    let size = u64_at(head, 1)?;
    if op == 0 || op > OP_LAST || size > RECORD_MAX {
        return None;
    }
    let end = at + HEAD + size;
    (end <= len && (op != OP_CHUNK || chunk_times(head).is_some())).then_some(end)
}

/// The times of a chunk whose head can be right.
fn chunk_times(head: &[u8]) -> Option<(u64, u64)> {
    let size = u64_at(head, 1)?;
    let body = head.get(HEAD_LEN..)?;
    let (first, last) = (u64_at(body, 0)?, u64_at(body, 8)?);
    let whole = u64_at(body, 16)?;
    let name = body
        .get(28..)?
        .first_chunk()
        .map(|len| u32::from_le_bytes(*len))?;
    (first <= last && whole <= RECORD_MAX && size >= CHUNK_HEAD as u64 && name <= 8)
        .then_some((first, last))
}

fn note(head: &[u8], at: u64, found: &mut Found) {
    let place = Place {
        offset: at,
        len: u64_at(head, 1).unwrap_or_default(),
    };
    match head.first() {
        Some(&OP_CHUNK) => {
            if let Some((first_nanos, last_nanos)) = chunk_times(head) {
                found.chunk(ChunkPlace {
                    place,
                    first_nanos,
                    last_nanos,
                });
            }
        }
        Some(&OP_ATTACHMENT) => found.attachment(place),
        Some(&OP_METADATA) => found.metadata(place),
        Some(&OP_FOOTER) => found.closed = true,
        _ => {}
    }
}

/// The next place where a whole chunk can stand, else the end.
fn next_chunk<F: Read + Seek>(file: &mut F, from: u64, len: u64) -> io::Result<u64> {
    let head_len = HEAD_LEN + CHUNK_HEAD;
    let mut buffer = vec![0; SEARCH];
    let mut at = from;
    while at + head_len as u64 <= len {
        let there = usize::try_from(len - at).unwrap_or(usize::MAX).min(SEARCH);
        let bytes = buffer.get_mut(..there).unwrap_or_default();
        read_at(file, at, bytes)?;
        let starts = bytes.windows(head_len).enumerate();
        for (step, head) in starts {
            let place = at + u64::try_from(step).unwrap_or_default();
            if head.first() == Some(&OP_CHUNK) && plausible(head, place, len).is_some() {
                return Ok(place);
            }
        }
        at += u64::try_from(there - head_len + 1).unwrap_or(1);
    }
    Ok(len)
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
