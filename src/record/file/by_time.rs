//! Messages ordered by time, regardless of their order in the file, while holding at most some megabytes of them.

use crate::record::file::walk::{ChunkMessage, ChunkPlace};
use std::io;
use std::ops::{ControlFlow, RangeInclusive};

/// Maximum bytes of messages held at once: some minutes of one hand. Later ones are read again in the next pass.
const HELD_MAX: usize = 8 * 1024 * 1024;
/// Memory overhead of a message beside its content.
const EACH: usize = 128;

/// Sort key: time of receipt, number, chunk, position.
type Key = (u64, u32, usize, usize);

/// A message waiting in the buffer.
struct BufferedMessage {
    key: Key,
    channel: u16,
    asked_nanos: u64,
    data: Box<[u8]>,
}

/// Passes on the messages of a time range in order of time; `scan` reads those of a chunk. Chunks are sorted by their first
/// message.
///
/// # Errors
/// The system's error.
pub(crate) fn each(
    chunks: &[ChunkPlace],
    within: RangeInclusive<u64>,
    scan: impl Fn(&ChunkPlace, &mut dyn FnMut(ChunkMessage<'_>)) -> io::Result<()>,
    mut take: impl FnMut(&ChunkMessage<'_>) -> ControlFlow<()>,
) -> io::Result<()> {
    let mut after = None;
    loop {
        let (from, mut to) = (after, None);
        let (mut held, mut bytes) = (Vec::new(), 0);
        for (number, chunk) in chunks.iter().enumerate() {
            let last = to.map_or(*within.end(), |(time, ..): Key| time);
            if chunk.first_nanos > last {
                break;
            }
            let first = from.map_or(*within.start(), |(time, ..): Key| time);
            if chunk.last_nanos < first {
                continue;
            }
            let mut nth = 0;
            scan(chunk, &mut |message| {
                nth += 1;
                let key = (message.times.0, message.sequence, number, nth);
                let is_next = within.contains(&message.times.0)
                    && from.is_none_or(|from| key > from)
                    && to.is_none_or(|to| key <= to);
                if is_next {
                    bytes += message.data.len() + EACH;
                    held.push(BufferedMessage {
                        key,
                        channel: message.channel,
                        asked_nanos: message.times.1,
                        data: message.data.into(),
                    });
                    if bytes > HELD_MAX {
                        to = leave_out(&mut held, &mut bytes).or(to);
                    }
                }
            })?;
        }
        held.sort_unstable_by_key(|one| one.key);
        for one in &held {
            let (received, sequence, ..) = one.key;
            let flow = take(&ChunkMessage {
                channel: one.channel,
                sequence,
                times: (received, one.asked_nanos),
                data: &one.data,
            });
            if flow.is_break() {
                return Ok(());
            }
        }
        match to {
            Some(_) => after = to,
            None => return Ok(()),
        }
    }
}

/// Drops the later half, for the next pass; returns the last key that stays.
fn leave_out(held: &mut Vec<BufferedMessage>, bytes: &mut usize) -> Option<Key> {
    held.sort_unstable_by_key(|one| one.key);
    while *bytes > HELD_MAX / 2 && held.len() > 1 {
        *bytes -= held.pop().map_or(0, |one| one.data.len() + EACH);
    }
    held.last().map(|one| one.key)
}
