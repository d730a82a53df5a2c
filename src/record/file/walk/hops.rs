//! Finds the records of a file one after the other. After damage it continues at the next possible start of a chunk.

use super::found::{
    ByteRange, ChunkKind, ChunkPlace, Found, HEAD, HEAD_LEN, MAGIC, RECORD_MAX, read_at, u32_at,
    u64_at,
};
use mcap::records::op;
use std::io::{self, Read, Seek};

/// Bytes of a chunk before its compressed data, without the compression's name: two times, a length, a checksum, two lengths.
const CHUNK_HEAD: usize = 8 + 8 + 8 + 4 + 4 + 8;
/// Maximum length of a compression's name, such as `zstd`.
const NAME_MAX: usize = 8;
/// Inspected bytes of a record: operation code, length, and a chunk's whole header.
pub(super) const HEAD_READ: usize = HEAD_LEN + CHUNK_HEAD + NAME_MAX;
/// Bytes read at once where records follow each other: the message indexes of a chunk, and the header of the next chunk.
const AHEAD: usize = 4096;
/// Bytes searched at once for the next chunk.
const SEARCH: usize = 64 * 1024;
/// The last operation code of an MCAP record.
const OP_LAST: u8 = op::DATA_END;

/// Adds the records of a file of length `len`.
pub(super) fn one_by_one<F: Read + Seek>(
    file: &mut F,
    len: u64,
    found: &mut Found,
) -> io::Result<()> {
    let mut at = MAGIC.len() as u64;
    let (mut ahead, mut ahead_at) = (Vec::new(), 0);
    let mut is_index = false;
    let mut before = None;
    while at + HEAD <= len {
        let left = usize::try_from(len - at).unwrap_or(usize::MAX);
        let wanted = left.min(HEAD_READ);
        // The buffer is ahead of this position if a search has gone back.
        let from = at.checked_sub(ahead_at).map(usize::try_from);
        let mut from = from.and_then(Result::ok).unwrap_or(usize::MAX);
        if from.saturating_add(wanted) > ahead.len() {
            ahead.resize(left.min(AHEAD), 0);
            read_at(file, at, &mut ahead)?;
            (ahead_at, from) = (at, 0);
        }
        let head = ahead.get(from..from + wanted).unwrap_or_default();
        let end = plausible(head, at, len);
        match end.filter(|_| is_index || belongs_to_data(head)) {
            Some(next) => {
                is_index |= head.first() == Some(&op::DATA_END);
                note(head, at, found);
                (before, at) = (Some(at), next);
            }
            None => {
                // The previous record's length may be wrong, and hide chunks in its range.
                let from = before.take().unwrap_or(at) + 1;
                let next = next_chunk(file, from, len)?;
                found.skipped += next.saturating_sub(at);
                at = next;
            }
        }
    }
    found.skipped += len.saturating_sub(at);
    Ok(())
}

/// End of the record, if a valid one can begin here.
pub(super) fn plausible(head: &[u8], at: u64, len: u64) -> Option<u64> {
    let op = *head.first()?;
    let size = u64_at(head, 1)?;
    if size > RECORD_MAX {
        return None;
    }
    let end = at + HEAD + size;
    let is_known = chunk_times(head).is_some() || op != op::CHUNK && (1..=OP_LAST).contains(&op);
    (end <= len && is_known).then_some(end)
}

/// True for records of the data section: another code there is a bit error, and would hide the records behind it.
fn belongs_to_data(head: &[u8]) -> bool {
    let size = u64_at(head, 1).unwrap_or_default();
    match head.first() {
        _ if chunk_times(head).is_some() => true,
        Some(&op::MESSAGE_INDEX) => {
            // Channel, length in bytes, then pairs of time and offset.
            let bytes = u32_at(head, HEAD_LEN + 2).map(u64::from);
            bytes.is_some_and(|bytes| bytes.checked_add(6) == Some(size) && bytes % 16 == 0)
        }
        Some(&op::DATA_END) => size == 4,
        Some(&(op::HEADER | op::ATTACHMENT | op::METADATA)) => true,
        _ => false,
    }
}

/// The times of a chunk; `None` if this is not a chunk. The times and the operation code may be wrong: only in a chunk do its
/// length fields agree.
pub(super) fn chunk_times(head: &[u8]) -> Option<(u64, u64)> {
    let chunk = chunk_head(head).filter(|chunk| chunk.unpacked <= RECORD_MAX)?;
    Some((chunk.first, chunk.last))
}

/// Header fields of a chunk.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChunkHead {
    first: u64,
    last: u64,
    /// Uncompressed size of its records in bytes.
    pub(super) unpacked: u64,
    /// Size of the chunk's own record in bytes.
    pub(super) size: u64,
}

/// Parses the header of a chunk of any length; `None` if this is not a chunk.
pub(super) fn chunk_head(head: &[u8]) -> Option<ChunkHead> {
    let size = u64_at(head, 1)?;
    let body = head.get(HEAD_LEN..)?;
    let (first, last) = (u64_at(body, 0)?, u64_at(body, 8)?);
    let unpacked = u64_at(body, 16)?;
    let name = usize::try_from(u32_at(body, 28)?).ok()?;
    let packed = u64_at(body, 32_usize.checked_add(name.min(NAME_MAX))?)?;
    let whole = packed.checked_add((CHUNK_HEAD + name.min(NAME_MAX)) as u64)?;
    (name <= NAME_MAX && whole == size).then_some(ChunkHead {
        first,
        last,
        unpacked,
        size,
    })
}

fn note(head: &[u8], at: u64, found: &mut Found) {
    let place = ByteRange {
        offset: at,
        len: u64_at(head, 1).unwrap_or_default(),
    };
    if let Some((first_nanos, last_nanos)) = chunk_times(head) {
        return found.chunk(ChunkPlace {
            kind: ChunkKind::Chunk,
            place,
            first_nanos,
            last_nanos,
        });
    }
    match head.first() {
        Some(&op::ATTACHMENT) => found.attachment(place),
        Some(&op::METADATA) => found.metadata(place),
        Some(&op::FOOTER) => found.closed = true,
        _ => {}
    }
}

/// The next position of a whole chunk, else the end.
fn next_chunk<F: Read + Seek>(file: &mut F, from: u64, len: u64) -> io::Result<u64> {
    next_place(file, (from, len), |head, place| {
        head.first() == Some(&op::CHUNK)
            && chunk_times(head).is_some_and(|(first, last)| first <= last)
            && plausible(head, place, len).is_some()
    })
}

/// The next position whose bytes satisfy the predicate, among possible starts of chunks or messages, else the end. The inspected
/// bytes are limited to the buffer.
pub(super) fn next_place<F: Read + Seek>(
    file: &mut F,
    (from, len): (u64, u64),
    is_wanted: impl Fn(&[u8], u64) -> bool,
) -> io::Result<u64> {
    let mut buffer = vec![0; SEARCH];
    // The next chunk is usually near.
    let (mut at, mut step) = (from, AHEAD);
    while at + HEAD < len {
        let there = usize::try_from(len - at).unwrap_or(usize::MAX).min(step);
        step = SEARCH;
        let bytes = buffer.get_mut(..there).unwrap_or_default();
        read_at(file, at, bytes)?;
        let is_end = at + there as u64 >= len;
        let places = if is_end { there } else { there - HEAD_READ };
        let codes = bytes.iter().enumerate().take(places);
        // Most bytes are ruled out by the operation code alone: a file may contain gigabytes of zeros.
        for (nth, _) in codes.filter(|(_, code)| matches!(**code, op::CHUNK | op::MESSAGE)) {
            let head = bytes.get(nth..there.min(nth + HEAD_READ));
            let place = at + nth as u64;
            if is_wanted(head.unwrap_or_default(), place) {
                return Ok(place);
            }
        }
        if is_end {
            break;
        }
        at += places as u64;
    }
    Ok(len)
}
