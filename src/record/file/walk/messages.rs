//! The messages of one chunk.

use super::found::RECORD_MAX;
use crate::record::file::topic::Topic;
use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

/// No message of ours is longer. Small parts of a long one could take many times its room.
const MESSAGE_MAX: usize = 1024 * 1024;

/// Gives each message of a chunk's record (topic, times, bytes); false if the chunk is damaged, and then it gives none of it.
pub(crate) fn messages(chunk: &[u8], mut take: impl FnMut(Topic, (u64, u64), &[u8])) -> bool {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(usize::try_from(RECORD_MAX).unwrap_or(usize::MAX));
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = chunk;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let give = rest.len().min(wanted);
                let (now, later) = rest.split_at(give);
                reader.insert(give).copy_from_slice(now);
                reader.notify_read(give);
                rest = later;
            }
            Ok(LinearReadEvent::Record { data, opcode }) if opcode == op::MESSAGE => {
                if let Some((topic, times, message)) = message(data)
                    && message.len() <= MESSAGE_MAX
                {
                    take(topic, times, message);
                }
            }
            Ok(LinearReadEvent::Record { .. }) => {}
            Err(_damaged) => return false,
        }
    }
    true
}

/// Topic, times and content of a message's record: number of the channel, number of the message, and two times stand before it.
fn message(record: &[u8]) -> Option<(Topic, (u64, u64), &[u8])> {
    let (channel, rest) = record.split_first_chunk()?;
    let (_sequence, rest) = rest.split_first_chunk::<4>()?;
    let (log, rest) = rest.split_first_chunk()?;
    let (publish, message) = rest.split_first_chunk()?;
    let topic = Topic::by_channel(u16::from_le_bytes(*channel))?;
    let times = (u64::from_le_bytes(*log), u64::from_le_bytes(*publish));
    Some((topic, times, message))
}
