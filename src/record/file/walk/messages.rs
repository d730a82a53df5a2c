//! The messages of one chunk, or of records outside of chunks.

use super::found::{ChunkKind, LONG_MESSAGE_MAX, RECORD_MAX};
use super::hops::chunk_head;
use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::io::{self, Read};

/// No message of ours is longer. Small parts of a long one could take many times its room.
const MESSAGE_MAX: usize = 1024 * 1024;
/// Ours pack to a tenth. What claims to unpack to so many times its length, and more than this, is none of ours.
const PACKED_TIMES_MAX: u64 = 200;
const PACKED_FREE: u64 = 64 * 1024;
/// Bytes of a long chunk that are read at once.
const READ_AT_ONCE: usize = 64 * 1024;

/// One record of a chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ChunkRecord<'a> {
    /// The content of a schema's or a channel's record, behind its operation code.
    Definition(u8, &'a [u8]),
    Message(ChunkMessage<'a>),
}

/// One message as it stands in a chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkMessage<'a> {
    /// The number of its channel.
    pub(crate) channel: u16,
    /// Its own number: in what Handscope writes, one more than that of the message before.
    pub(crate) sequence: u32,
    /// When it was received and asked for, nanoseconds since 1970.
    pub(crate) times: (u64, u64),
    /// What stands in it.
    pub(crate) data: &'a [u8],
}

/// Gives each record of a chunk; false if the chunk is damaged, and then it gives none of it. Outside of chunks, where no sum tells,
/// it gives what stands before the damage.
pub(crate) fn records(
    chunk: &mut [u8],
    kind: ChunkKind,
    mut take: impl FnMut(ChunkRecord<'_>),
) -> bool {
    if kind == ChunkKind::Chunk && is_inflated(chunk) {
        return false;
    }
    if let (ChunkKind::Chunk | ChunkKind::Foreign, Some(code)) = (kind, chunk.first_mut()) {
        // Its length and its sum say whether it is one. A flipped bit here would hide it.
        *code = op::CHUNK;
    }
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(usize::try_from(RECORD_MAX).unwrap_or(usize::MAX));
    // Memory can always be read.
    let len = chunk.len().max(1);
    read(&mut &*chunk, len, options, &mut take).unwrap_or_default()
}

/// The same of a chunk that is too long to be held. It gives records before it can tell that the chunk is damaged.
///
/// # Errors
/// What the system says.
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

/// The same without what defines its channels.
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

/// A message's record: number of the channel, number of the message, and two times stand before its content. The content of one
/// that is too long to be ours is left out.
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
