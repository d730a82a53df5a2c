//! The messages of one chunk, or of records outside of chunks.

use super::found::{ChunkKind, LONG_MESSAGE_MAX, RECORD_MAX};
use super::hops::chunk_head;
use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::io::{self, Read};

/// Maximum length of our messages. Small parts of a longer one could occupy many times its size.
const MESSAGE_MAX: usize = 1024 * 1024;
/// Maximum unpacking ratio of our chunks beyond the free amount. Ours pack to a tenth.
const PACKED_TIMES_MAX: u64 = 200;
const PACKED_FREE: u64 = 64 * 1024;
/// Bytes of a long chunk read at once.
const READ_AT_ONCE: usize = 64 * 1024;

/// One record of a chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ChunkRecord<'a> {
    /// Operation code and content of a schema or channel record.
    Definition(u8, &'a [u8]),
    Message(ChunkMessage<'a>),
}

/// One message as stored in a chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkMessage<'a> {
    pub(crate) channel: u16,
    /// Sequence number: in Handscope's files, one more than that of the previous message.
    pub(crate) sequence: u32,
    /// Times of receipt and of the request, nanoseconds since 1970.
    pub(crate) times: (u64, u64),
    pub(crate) data: &'a [u8],
}

/// Passes on each record of a chunk; false if the chunk is damaged, in which case it passes on none. Outside of chunks, which
/// have no checksum, it passes on the records before the damage.
pub(crate) fn records(
    chunk: &mut [u8],
    kind: ChunkKind,
    mut take: impl FnMut(ChunkRecord<'_>),
) -> bool {
    if kind == ChunkKind::Chunk && is_inflated(chunk) {
        return false;
    }
    if let (ChunkKind::Chunk | ChunkKind::Foreign, Some(code)) = (kind, chunk.first_mut()) {
        // Its lengths and checksum identify a chunk. A bit error in the operation code would hide it.
        *code = op::CHUNK;
    }
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(usize::try_from(RECORD_MAX).unwrap_or(usize::MAX));
    // Reading from memory cannot fail.
    let len = chunk.len().max(1);
    read(&mut &*chunk, len, options, &mut take).unwrap_or_default()
}

/// Passes on the records of a chunk that is too long for memory. Some may be passed on before damage is detected.
///
/// # Errors
/// The system's error.
pub(crate) fn long_records(
    from: &mut impl Read,
    mut take: impl FnMut(ChunkRecord<'_>),
) -> io::Result<bool> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(usize::try_from(LONG_MESSAGE_MAX).unwrap_or(usize::MAX));
    read(from, READ_AT_ONCE, options, &mut take)
}

fn read(
    from: &mut impl Read,
    at_once: usize,
    options: LinearReaderOptions,
    take: &mut impl FnMut(ChunkRecord<'_>),
) -> io::Result<bool> {
    let mut reader = LinearReader::new_with_options(options);
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let room = reader.insert(wanted.min(at_once));
                let given = from.read(room)?;
                reader.notify_read(given);
            }
            Ok(LinearReadEvent::Record { data, opcode }) => match opcode {
                op::MESSAGE => match message(data) {
                    Some(message) => take(ChunkRecord::Message(message)),
                    None => return Ok(false),
                },
                op::SCHEMA | op::CHANNEL => take(ChunkRecord::Definition(opcode, data)),
                _ => {}
            },
            Err(_damaged) => return Ok(false),
        }
    }
    Ok(true)
}

/// True if a chunk claims to unpack to far more than a recording does.
fn is_inflated(chunk: &[u8]) -> bool {
    chunk_head(chunk).is_some_and(|head| {
        let packed = head.size.saturating_mul(PACKED_TIMES_MAX);
        head.unpacked > packed.saturating_add(PACKED_FREE)
    })
}

/// Passes on the messages of a chunk only, as [`records`] does.
pub(crate) fn messages(
    chunk: &mut [u8],
    kind: ChunkKind,
    mut take: impl FnMut(ChunkMessage<'_>),
) -> bool {
    records(chunk, kind, |record| {
        if let ChunkRecord::Message(message) = record {
            take(message);
        }
    })
}

/// Parses a message record: channel number, sequence number and two times precede its content. Content that is too long to be
/// ours is omitted.
fn message(record: &[u8]) -> Option<ChunkMessage<'_>> {
    let (channel, rest) = record.split_first_chunk()?;
    let (sequence, rest) = rest.split_first_chunk()?;
    let (log, rest) = rest.split_first_chunk()?;
    let (publish, data) = rest.split_first_chunk()?;
    Some(ChunkMessage {
        channel: u16::from_le_bytes(*channel),
        sequence: u32::from_le_bytes(*sequence),
        times: (u64::from_le_bytes(*log), u64::from_le_bytes(*publish)),
        data: if data.len() <= MESSAGE_MAX { data } else { &[] },
    })
}
