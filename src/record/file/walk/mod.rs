//! Finds the records of a recording file that may be truncated, damaged or malicious: every length is checked before it is used.
//!
//! `index` reads the index of a closed file, and `hops` goes from record to record if there is none; `times` corrects the times
//! that `hops` found. `survey` reads the whole of a file that another program has written or changed.

mod found;
mod hops;
mod index;
mod messages;
mod survey;
mod times;

pub use found::{
    ByteRange, CHUNKS_MAX, ChunkKind, ChunkPlace, Found, LONG_MESSAGE_MAX, PLACES_MAX, RECORD_MAX,
    UNPACKED_MAX, UNPACKED_TIMES,
};
pub(crate) use found::{MAGIC, content, reader, whole};
pub(crate) use index::record;
pub(crate) use messages::{ChunkMessage, ChunkRecord, long_records, messages, records};
pub(crate) use survey::{Survey, survey};

use hops::one_by_one;
use index::by_index;
use std::io::{self, Read, Seek, SeekFrom};
use times::mend;

/// Finds the records: by the file's own index if it is intact, else one after the other.
///
/// # Errors
/// The system's error; invalid content is not an error.
pub fn walk<F: Read + Seek>(file: &mut F) -> io::Result<Found> {
    let len = file.seek(SeekFrom::End(0))?;
    if let Some(found) = by_index(file, len)? {
        return Ok(found);
    }
    let mut found = Found::default();
    one_by_one(file, len, &mut found)?;
    mend(file, &mut found)?;
    found.stale_index = found.closed;
    Ok(found)
}

/// True if these bytes begin with the record of a chunk, regardless of the operation code.
pub(crate) fn is_chunk(bytes: &[u8]) -> bool {
    hops::chunk_times(bytes).is_some()
}

/// Length field of the record that begins here; 0 if it is missing.
pub(crate) fn record_len(bytes: &[u8]) -> u64 {
    found::u64_at(bytes, 1).unwrap_or_default()
}
