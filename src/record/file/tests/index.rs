//! The end of a file against what stands in the file, read by the crate's own readers, and what it takes while the file is written.

use super::{entries, opening};
use crate::record::file::topic::Topic;
use crate::record::file::writer::SessionWriter;
use mcap::Summary;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::collections::BTreeMap;

/// What a chunk may take in memory: 0.9 MiB an hour at eight a second.
const CHUNK_MEMORY: usize = 32;

/// A file of 80 s with a chunk for each 50 entries, and its end in pieces.
fn written() -> (Vec<u8>, Vec<Vec<u8>>) {
    let mut writer = SessionWriter::new(&opening()).unwrap();
    for (number, entry) in entries(1, 40_000).iter().enumerate() {
        writer.push(entry).unwrap();
        if number % 50 == 49 {
            writer.flush().unwrap();
        }
    }
    let end = writer.finish().unwrap();
    (writer.take_bytes(), end.collect())
}

/// The record at a place.
fn record_at(bytes: &[u8], at: u64) -> (u8, &[u8]) {
    let at = usize::try_from(at).unwrap();
    let len = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
    (bytes[at], &bytes[at + 9..][..usize::try_from(len).unwrap()])
}

#[test]
fn the_end_tells_of_every_chunk_and_every_message_where_it_stands() {
    let (mut bytes, end) = written();
    bytes.extend(end.concat());
    let summary = Summary::read(&bytes).unwrap().unwrap();
    let (mut places, mut messages) = (Vec::new(), BTreeMap::<u16, u64>::new());
    for index in &summary.chunk_indexes {
        let (code, content) = record_at(&bytes, index.chunk_start_offset);
        assert_eq!(code, op::CHUNK);
        assert_eq!(index.chunk_length, 9 + content.len() as u64);
        let Ok(Record::Chunk { header, data }) = mcap::parse_record(code, content) else {
            panic!("no chunk at {}", index.chunk_start_offset);
        };
        assert_eq!(header.message_start_time, index.message_start_time);
        assert_eq!(header.message_end_time, index.message_end_time);
        assert_eq!(header.compression, index.compression);
        assert_eq!(header.compressed_size, index.compressed_size);
        assert_eq!(data.len() as u64, index.compressed_size);
        assert_eq!(header.uncompressed_size, index.uncompressed_size);
        let mut at = index.chunk_start_offset + index.chunk_length;
        for (channel, place) in &index.message_index_offsets {
            assert_eq!(*place, at);
            let (code, content) = record_at(&bytes, at);
            let Ok(Record::MessageIndex(index)) = mcap::parse_record(code, content) else {
                panic!("no places of messages at {at}");
            };
            assert_eq!(index.channel_id, *channel);
            *messages.entry(*channel).or_default() += index.records.len() as u64;
            at += 9 + content.len() as u64;
        }
        let after = index.chunk_start_offset + index.chunk_length;
        assert_eq!(at, after + index.message_index_length);
        places.push(index.chunk_start_offset);
        if index.message_index_offsets.is_empty() {
            assert_eq!(places.len(), 1, "the definitions stand before all else");
            continue;
        }
        let read = summary.read_message_indexes(&bytes, index).unwrap();
        let read: usize = read.values().map(Vec::len).sum();
        let stream = summary.stream_chunk(&bytes, index).unwrap();
        assert_eq!(stream.map(Result::unwrap).count(), read);
    }
    assert!(places.is_sorted() && places.len() > 800);
    let attachments = summary.attachment_indexes.iter();
    let names = attachments.map(|index| mcap::read::attachment(&bytes, index).unwrap().name);
    let overview = "handscope-overview";
    assert_eq!(
        names.collect::<Vec<_>>(),
        [overview, "handscope-chunks", overview],
        "an overview each minute, and a list of its chunks"
    );
    assert_eq!(summary.metadata_indexes.len(), 1);
    mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap();
    let stats = summary.stats.unwrap();
    assert_eq!(stats.channel_message_counts, messages);
    assert_eq!(stats.message_count, messages.values().sum::<u64>());
    assert_eq!(stats.chunk_count as usize, places.len());
    assert_eq!((stats.attachment_count, stats.metadata_count), (3, 1));
    assert_eq!((stats.schema_count, stats.channel_count), (8, 12));
    assert_eq!(summary.schemas.len(), 8);
    for topic in Topic::all() {
        let channel = &summary.channels[&topic.channel()];
        assert_eq!(channel.topic, topic.name());
        let schema = channel.schema.as_ref().unwrap();
        assert_eq!(schema.name, topic.schema().name);
        assert_eq!(*schema.data, *topic.schema().text.as_bytes());
    }
}

#[test]
fn both_sums_of_a_file_are_right_and_each_kind_is_found_by_its_offset() {
    let (mut bytes, end) = written();
    let data = bytes.len();
    bytes.extend(end.concat());
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true);
    let mut reader = LinearReader::new_with_options(options);
    let (mut rest, mut offsets) = (bytes.as_slice(), Vec::new());
    while let Some(event) = reader.next_event() {
        match event.unwrap() {
            LinearReadEvent::ReadRequest(wanted) => {
                let (now, later) = rest.split_at(rest.len().min(wanted));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                rest = later;
            }
            LinearReadEvent::Record { data, opcode } => {
                if let Ok(Record::SummaryOffset(offset)) = mcap::parse_record(opcode, data) {
                    offsets.push(offset);
                }
            }
        }
    }
    let kinds = [
        op::SCHEMA,
        op::CHANNEL,
        op::STATISTICS,
        op::CHUNK_INDEX,
        op::ATTACHMENT_INDEX,
        op::METADATA_INDEX,
    ];
    assert_eq!(
        offsets
            .iter()
            .map(|one| one.group_opcode)
            .collect::<Vec<_>>(),
        kinds
    );
    let mut at = data as u64 + 13;
    for offset in offsets {
        assert_eq!(offset.group_start, at, "they follow each other");
        let end = at + offset.group_length;
        while at < end {
            let (code, content) = record_at(&bytes, at);
            assert_eq!(code, offset.group_opcode);
            at += 9 + content.len() as u64;
        }
        assert_eq!(at, end);
    }
}

#[test]
fn a_chunk_takes_little_memory_until_the_end_and_the_end_is_made_in_small_pieces() {
    let mut writer = SessionWriter::new(&opening()).unwrap();
    for (number, entry) in entries(2, 60_000).iter().enumerate() {
        writer.push(entry).unwrap();
        // An eighth of a second of a busy link, or two.
        if number % 125 == 124 {
            writer.flush().unwrap();
            writer.take_bytes();
        }
    }
    let (bytes, chunks) = writer.chunk_memory();
    assert!(chunks > 900, "{chunks}");
    let each = bytes / chunks as usize;
    assert!(each <= CHUNK_MEMORY, "{each} bytes a chunk");
    let largest = writer.finish().unwrap().map(|piece| piece.len()).max();
    assert!(largest.unwrap() < 512 * 1024, "{largest:?}");
}
