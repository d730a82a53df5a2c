//! Corrects the times of chunks found without an index. No checksum protects those in a chunk's header, so times that do not fit
//! the neighbours are replaced by those of the chunk's messages.

use super::found::{ChunkPlace, Found, whole};
use super::messages::messages;
use std::io::{self, Read, Seek};

/// Maximum deviation from the order of time between several sources.
const APART_NANOS: u64 = 1_000_000_000;
/// Maximum duration of our chunks.
const LENGTH_NANOS: u64 = 10_000_000_000;

/// Corrects implausible times.
pub(super) fn mend<F: Read + Seek>(file: &mut F, found: &mut Found) -> io::Result<()> {
    let mut before: Option<u64> = None;
    for at in 0..found.chunks.len() {
        let after = found.chunks.get(at + 1).map(|chunk| chunk.first_nanos);
        let Some(chunk) = found.chunks.get_mut(at) else {
            break;
        };
        // The definitions are in a chunk without messages, which has no times.
        let is_empty = (chunk.first_nanos, chunk.last_nanos) == (0, 0);
        if !is_empty && !fits(chunk, before, after) {
            let mut bytes = whole(file, chunk.place)?;
            let mut times = None;
            let is_whole = messages(&mut bytes, chunk.kind, |message| {
                let (time, _) = message.times;
                let (first, last) = times.get_or_insert((time, time));
                (*first, *last) = ((*first).min(time), (*last).max(time));
            });
            let unknown = if is_whole {
                (0, 0)
            } else {
                (before.unwrap_or(1), after.or(before).unwrap_or(1))
            };
            (chunk.first_nanos, chunk.last_nanos) = times.unwrap_or(unknown);
        }
        if chunk.last_nanos > 0 {
            before = Some(chunk.last_nanos);
        }
    }
    Ok(())
}

/// True if the times are plausible. The last chunk has no successor to compare with, so it is never accepted.
fn fits(chunk: &ChunkPlace, before: Option<u64>, after: Option<u64>) -> bool {
    let length = chunk.last_nanos.checked_sub(chunk.first_nanos);
    let follows = |first: u64, then: u64| then.saturating_add(APART_NANOS) >= first;
    length.is_some_and(|length| length <= LENGTH_NANOS)
        && before.is_none_or(|before| follows(before, chunk.first_nanos))
        && after.is_some_and(|after| follows(chunk.last_nanos, after))
}
