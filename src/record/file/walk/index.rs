//! The records of a closed file, from its own index.

use super::found::{
    ByteRange, ChunkKind, ChunkPlace, Found, HEAD, HEAD_LEN, MAGIC, RECORD_MAX, read_at, u32_at,
    u64_at,
};
use mcap::records::op;
use std::io::{self, Read, Seek};

/// Maximum length of an index record; the index is read piece by piece.
const INDEX_RECORD_MAX: usize = 64 * 1024;
/// Bytes of the index read at once.
const INDEX_PIECE: usize = 1024 * 1024;

/// Reads the index; `None` if it is missing or damaged.
pub(super) fn by_index<F: Read + Seek>(file: &mut F, len: u64) -> io::Result<Option<Found>> {
    const TAIL: usize = 9 + 20 + 8;
    let tail_at = len.saturating_sub(TAIL as u64);
    let mut tail = [0; TAIL];
    if len < TAIL as u64 + 8 {
        return Ok(None);
    }
    read_at(file, tail_at, &mut tail)?;
    let footer = record(&tail).filter(|(op, body, _)| *op == op::FOOTER && body.len() == 20);
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
        let Some(taken) = index.parse(&piece) else {
            return Ok(None);
        };
        piece.drain(..taken);
        at += u64::try_from(len).unwrap_or_default();
    }
    index.hash.update(tail.get(..TAIL - 12).unwrap_or_default());
    let whole = index.hash.finalize() == crc && piece.is_empty();
    let mut header = [0; HEAD_LEN];
    read_at(file, MAGIC.len() as u64, &mut header)?;
    let header = MAGIC.len() as u64 + HEAD + u64_at(&header, 1).unwrap_or_default();
    // The indexed records fill the file from its header to the end of the data: nothing is missing, and the index belongs to this
    // file.
    let data = start.saturating_sub(header + HEAD + 4);
    Ok((whole && index.indexed_bytes == data).then_some(index.found))
}

/// Content of the index read so far.
struct Index {
    found: Found,
    hash: crc32fast::Hasher,
    /// Offset of the index; indexed records precede it.
    start: u64,
    /// End of the last chunk. The next one must come after it, so that none can be listed repeatedly.
    after: u64,
    /// Total bytes of the indexed records.
    indexed_bytes: u64,
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
            indexed_bytes: 0,
        }
    }

    /// Parses the whole records of some bytes; returns their length. `None` if they are invalid for this file.
    fn parse(&mut self, bytes: &[u8]) -> Option<usize> {
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
            op::CHUNK_INDEX => {
                let place = self.place(u64_at(body, 16)?, u64_at(body, 24)?)?;
                if place.offset < self.after {
                    return None;
                }
                self.after = place.offset + HEAD + place.len;
                let places = usize::try_from(u32_at(body, 32)?).ok()?;
                self.add_bytes(u64_at(body, places.checked_add(36)?)?);
                self.found.chunk(ChunkPlace {
                    kind: ChunkKind::Chunk,
                    place,
                    first_nanos: u64_at(body, 0)?,
                    last_nanos: u64_at(body, 8)?,
                });
            }
            op::ATTACHMENT_INDEX => {
                let place = self.place(u64_at(body, 0)?, u64_at(body, 8)?)?;
                self.found.attachment(place);
            }
            op::METADATA_INDEX => {
                let place = self.place(u64_at(body, 0)?, u64_at(body, 8)?)?;
                self.found.metadata(place);
            }
            op::STATISTICS => self.found.messages = u64_at(body, 0),
            _ => {}
        }
        Some(())
    }

    const fn add_bytes(&mut self, bytes: u64) {
        self.indexed_bytes = self.indexed_bytes.saturating_add(bytes);
    }

    fn place(&mut self, offset: u64, whole: u64) -> Option<ByteRange> {
        self.add_bytes(whole);
        let len = whole.checked_sub(HEAD).filter(|len| *len <= RECORD_MAX)?;
        let end = offset.checked_add(whole)?;
        (len > 0 && end <= self.start).then_some(ByteRange { offset, len })
    }
}

/// Splits off a record: operation code, content, and the remaining bytes.
pub(crate) fn record(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (op, rest) = bytes.split_first()?;
    let len = usize::try_from(u64_at(rest, 0)?).ok()?;
    let rest = rest.get(8..)?;
    Some((*op, rest.get(..len)?, rest.get(len..)?))
}
