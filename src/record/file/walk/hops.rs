//! The records of a file one after the other. After damage it goes on at the next place where a chunk can begin.

use super::found::{ChunkPlace, Found, HEAD, HEAD_LEN, Place, RECORD_MAX, read_at, u64_at};
use mcap::records::op;
use std::io::{self, Read, Seek};
use std::ops::Range;

/// Bytes of the head of a chunk that are looked at.
const CHUNK_HEAD: usize = 8 + 8 + 8 + 4 + 4;
/// Bytes read at once where records follow each other: the indexes of a chunk's messages, and the head of the next chunk.
const AHEAD: usize = 4096;
/// Bytes searched at once for the next chunk.
const SEARCH: usize = 64 * 1024;
/// The last code of a record of MCAP.
const OP_LAST: u8 = op::DATA_END;

/// Adds the records of a part of a file.
pub(super) fn one_by_one<F: Read + Seek>(
    file: &mut F,
    part: Range<u64>,
    found: &mut Found,
) -> io::Result<()> {
    let (mut at, len) = (part.start, part.end);
    let (mut ahead, mut ahead_at) = (Vec::new(), 0);
    let mut is_index = false;
    let mut before = None;
    while at + HEAD <= len {
        let left = usize::try_from(len - at).unwrap_or(usize::MAX);
        let wanted = left.min(HEAD_LEN + CHUNK_HEAD);
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
fn plausible(head: &[u8], at: u64, len: u64) -> Option<u64> {
    let op = *head.first()?;
    let size = u64_at(head, 1)?;
    if op == 0 || op > OP_LAST || size > RECORD_MAX {
        return None;
    }
    let end = at + HEAD + size;
    (end <= len && (op != op::CHUNK || chunk_times(head).is_some())).then_some(end)
}

/// True for what stands before the index of a file: another code there is a flipped one, and would hide what it stands before.
fn belongs_to_data(head: &[u8]) -> bool {
    let size = u64_at(head, 1).unwrap_or_default();
    match head.first() {
        Some(&op::MESSAGE_INDEX) => {
            // Of a channel, so many bytes, in pairs of a time and a place.
            let bytes = head.get(HEAD_LEN + 2..).and_then(<[u8]>::first_chunk);
            let bytes = bytes.map(|bytes| u64::from(u32::from_le_bytes(*bytes)));
            bytes.is_some_and(|bytes| bytes.checked_add(6) == Some(size) && bytes % 16 == 0)
        }
        Some(&op::DATA_END) => size == 4,
        Some(&(op::HEADER | op::CHUNK | op::ATTACHMENT | op::METADATA)) => true,
        _ => false,
    }
}

/// The times of a chunk whose head can be right. They themselves may be anything.
fn chunk_times(head: &[u8]) -> Option<(u64, u64)> {
    let size = u64_at(head, 1)?;
    let body = head.get(HEAD_LEN..)?;
    let (first, last) = (u64_at(body, 0)?, u64_at(body, 8)?);
    let whole = u64_at(body, 16)?;
    let name = body
        .get(28..)?
        .first_chunk()
        .map(|len| u32::from_le_bytes(*len))?;
    (whole <= RECORD_MAX && size >= CHUNK_HEAD as u64 && name <= 8).then_some((first, last))
}

fn note(head: &[u8], at: u64, found: &mut Found) {
    let place = Place {
        offset: at,
        len: u64_at(head, 1).unwrap_or_default(),
    };
    match head.first() {
        Some(&op::CHUNK) => {
            if let Some((first_nanos, last_nanos)) = chunk_times(head) {
                found.chunk(ChunkPlace {
                    place,
                    first_nanos,
                    last_nanos,
                });
            }
        }
        Some(&op::ATTACHMENT) => found.attachment(place),
        Some(&op::METADATA) => found.metadata(place),
        Some(&op::FOOTER) => found.closed = true,
        _ => {}
    }
}

/// The next place where a whole chunk can stand, else the end.
fn next_chunk<F: Read + Seek>(file: &mut F, from: u64, len: u64) -> io::Result<u64> {
    let head_len = HEAD_LEN + CHUNK_HEAD;
    let mut buffer = vec![0; SEARCH];
    // Most often the next chunk is near.
    let (mut at, mut step) = (from, AHEAD);
    while at + head_len as u64 <= len {
        let there = usize::try_from(len - at).unwrap_or(usize::MAX).min(step);
        step = SEARCH;
        let bytes = buffer.get_mut(..there).unwrap_or_default();
        read_at(file, at, bytes)?;
        let starts = bytes.windows(head_len).enumerate();
        for (nth, head) in starts {
            let place = at + u64::try_from(nth).unwrap_or_default();
            if head.first() == Some(&op::CHUNK)
                && chunk_times(head).is_some_and(|(first, last)| first <= last)
                && plausible(head, place, len).is_some()
            {
                return Ok(place);
            }
        }
        at += u64::try_from(there - head_len + 1).unwrap_or(1);
    }
    Ok(len)
}
