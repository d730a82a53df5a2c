//! The records of a file one after the other. After damage it goes on at the next place where a chunk can begin.

use super::found::{
    ChunkKind, ChunkPlace, Found, HEAD, HEAD_LEN, MAGIC, Place, RECORD_MAX, read_at, u32_at, u64_at,
};
use mcap::records::op;
use std::io::{self, Read, Seek};

/// Bytes of a chunk before what was compressed, without the compression's name: two times, a length, a sum, two lengths.
const CHUNK_HEAD: usize = 8 + 8 + 8 + 4 + 4 + 8;
/// The longest name of a compression, `zstd` among them.
const NAME_MAX: usize = 8;
/// Bytes of a record that are looked at: operation code, length, and all that a chunk says of itself.
pub(super) const LOOKED_AT: usize = HEAD_LEN + CHUNK_HEAD + NAME_MAX;
/// Bytes read at once where records follow each other: the indexes of a chunk's messages, and the head of the next chunk.
const AHEAD: usize = 4096;
/// Bytes searched at once for the next chunk.
const SEARCH: usize = 64 * 1024;
/// The last code of a record of MCAP.
const OP_LAST: u8 = op::DATA_END;

/// Adds the records of a file that is so long.
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
        let wanted = left.min(LOOKED_AT);
        // What was read ahead lies after this if a search has gone back.
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
                // Perhaps the length of the record before is wrong, and chunks stand in what it claims.
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

/// Where the record ends, if one can stand here.
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

/// True for what stands before the index of a file: another code there is a flipped one, and would hide what it stands before.
fn belongs_to_data(head: &[u8]) -> bool {
    let size = u64_at(head, 1).unwrap_or_default();
    match head.first() {
        _ if chunk_times(head).is_some() => true,
        Some(&op::MESSAGE_INDEX) => {
            // Of a channel, so many bytes, in pairs of a time and a place.
            let bytes = u32_at(head, HEAD_LEN + 2).map(u64::from);
            bytes.is_some_and(|bytes| bytes.checked_add(6) == Some(size) && bytes % 16 == 0)
        }
        Some(&op::DATA_END) => size == 4,
        Some(&(op::HEADER | op::ATTACHMENT | op::METADATA)) => true,
        _ => false,
    }
}

/// The times of a chunk; `None` if this is none. They themselves may be anything, and so may its operation code: what it says of its
/// lengths agrees in no other record.
pub(super) fn chunk_times(head: &[u8]) -> Option<(u64, u64)> {
    let chunk = chunk_head(head).filter(|chunk| chunk.unpacked <= RECORD_MAX)?;
    Some((chunk.first, chunk.last))
}

/// What a chunk says of itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChunkHead {
    first: u64,
    last: u64,
    /// Bytes of its records.
    pub(super) unpacked: u64,
    /// Bytes of the chunk's own record.
    pub(super) size: u64,
}

/// What a chunk of any length says of itself; `None` if this is none.
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
    let place = Place {
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

/// The next place where a whole chunk can stand, else the end.
fn next_chunk<F: Read + Seek>(file: &mut F, from: u64, len: u64) -> io::Result<u64> {
    next_place(file, (from, len), |head, place| {
        head.first() == Some(&op::CHUNK)
            && chunk_times(head).is_some_and(|(first, last)| first <= last)
            && plausible(head, place, len).is_some()
    })
}

/// The next place whose bytes are as wanted, else the end: where a chunk or a message may begin. What is looked at ends with the part.
pub(super) fn next_place<F: Read + Seek>(
    file: &mut F,
    (from, len): (u64, u64),
    is_wanted: impl Fn(&[u8], u64) -> bool,
) -> io::Result<u64> {
    let mut buffer = vec![0; SEARCH];
    // Most often the next chunk is near.
    let (mut at, mut step) = (from, AHEAD);
    while at + HEAD < len {
        let there = usize::try_from(len - at).unwrap_or(usize::MAX).min(step);
        step = SEARCH;
        let bytes = buffer.get_mut(..there).unwrap_or_default();
        read_at(file, at, bytes)?;
        let is_end = at + there as u64 >= len;
        let places = if is_end { there } else { there - LOOKED_AT };
        let codes = bytes.iter().enumerate().take(places);
        // Most bytes are seen to be no beginning by themselves: a file may have gigabytes of zeros.
        for (nth, _) in codes.filter(|(_, code)| matches!(**code, op::CHUNK | op::MESSAGE)) {
            let head = bytes.get(nth..there.min(nth + LOOKED_AT));
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
