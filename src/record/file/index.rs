//! The end of a session file: what other programs find its chunks by. While the file is written this takes some twenty bytes for
//! each chunk, and it is written in pieces, because after a day it is longer than everything else that the recorder holds.

use crate::record::file::chunk_list::{ChunkList, ListedChunk, decoded, messages_len};
use crate::record::file::topic::Topic;
use crate::record::file::walk::MAGIC;
use mcap::records::{AttachmentIndex, MetadataIndex, op};
use std::collections::BTreeMap;

/// How the chunks are compressed.
const COMPRESSION: &str = "lz4";
/// Bytes of a chunk's record before what was compressed: code, length, two times, two sizes, a sum, and the compression's name.
const CHUNK_HEAD: u64 = 9 + 8 + 8 + 8 + 4 + 4 + COMPRESSION.len() as u64 + 8;

/// What was written so far.
#[derive(Debug, Default)]
pub(crate) struct FileIndex {
    /// The chunks of each block, one number after the other.
    chunks: Vec<Box<[u8]>>,
    chunk_count: u32,
    attachments: Vec<AttachmentIndex>,
    metadata: Vec<MetadataIndex>,
    /// Messages of each channel.
    messages: BTreeMap<u16, u64>,
    /// Times of the first and the last message.
    times: Option<(u64, u64)>,
}

impl FileIndex {
    /// Adds what was written since the last time; its places count from `base`.
    pub(crate) fn add(&mut self, block: mcap::Summary, base: u64) {
        let mut coded = Vec::new();
        let mut before = ListedChunk::default();
        for index in &block.chunk_indexes {
            let chunk = ListedChunk::of(index, base);
            chunk.code(&before, &mut coded);
            before = chunk;
            self.chunk_count = self.chunk_count.saturating_add(1);
        }
        self.chunks.push(coded.into());
        for mut index in block.attachment_indexes {
            index.offset += base;
            self.attachments.push(index);
        }
        for mut index in block.metadata_indexes {
            index.offset += base;
            self.metadata.push(index);
        }
        let Some(stats) = block.stats.filter(|stats| stats.message_count > 0) else {
            return;
        };
        for (channel, count) in stats.channel_message_counts {
            *self.messages.entry(channel).or_default() += count;
        }
        let (first, last) = (stats.message_start_time, stats.message_end_time);
        let times = self.times.get_or_insert((first, last));
        *times = (times.0.min(first), times.1.max(last));
    }

    /// The list of what was added last, whose last attachment is its overview.
    pub(crate) fn list(&self, before: u64, from: u64) -> ChunkList {
        ChunkList {
            before,
            from,
            overview: self.attachments.last().map_or(0, |last| last.offset),
            coded: self.chunks.last().cloned().unwrap_or_default(),
        }
    }

    /// The end of a file whose `data` are so many bytes with this sum.
    pub(crate) fn end(self, data: u64, crc: u32) -> FileEnd {
        FileEnd {
            index: self,
            stage: IndexStage::Begin { crc },
            at: data,
            start: data,
            hash: crc32fast::Hasher::new(),
            groups: Vec::new(),
        }
    }

    /// Bytes that the chunks take in memory, and how many they are.
    #[cfg(test)]
    pub(crate) fn chunk_memory(&self) -> (usize, u32) {
        let blocks = self.chunks.iter();
        let bytes = blocks.map(|block| size_of_val(block) + block.len()).sum();
        (bytes, self.chunk_count)
    }
}

/// The content of a record.
#[derive(Debug, Default)]
struct RecordBytes(Vec<u8>);

impl RecordBytes {
    fn short(&mut self, number: u16) {
        self.0.extend(number.to_le_bytes());
    }

    fn int(&mut self, number: u32) {
        self.0.extend(number.to_le_bytes());
    }

    fn long(&mut self, number: u64) {
        self.0.extend(number.to_le_bytes());
    }

    /// Bytes behind their length.
    fn long_bytes(&mut self, bytes: &[u8]) {
        self.int(u32::try_from(bytes.len()).unwrap_or_default());
        self.0.extend(bytes);
    }

    fn text(&mut self, text: &str) {
        self.long_bytes(text.as_bytes());
    }
}

/// What the end of a file says of a chunk.
fn chunk_record(chunk: &ListedChunk) -> RecordBytes {
    let mut record = RecordBytes::default();
    record.long(chunk.first_nanos);
    record.long(chunk.last_nanos);
    record.long(chunk.offset);
    record.long(chunk.len);
    let mut places = RecordBytes::default();
    let mut place = chunk.offset + chunk.len;
    for (channel, count) in &chunk.messages {
        places.short(*channel);
        places.long(place);
        place += messages_len(*count);
    }
    record.long_bytes(&places.0);
    record.long(chunk.messages_len());
    record.text(COMPRESSION);
    record.long(chunk.len.saturating_sub(CHUNK_HEAD));
    record.long(chunk.unpacked);
    record
}

/// What is written next of an end.
#[derive(Debug)]
enum IndexStage {
    /// The end of the data, whose sum this is, and what there is of which kind.
    Begin {
        crc: u32,
    },
    /// The chunks from this block on.
    Chunks {
        block: usize,
    },
    /// All else.
    Rest,
    Done,
}

/// The end of a file, in pieces. It is whole only with the last of them.
#[derive(Debug)]
pub struct FileEnd {
    index: FileIndex,
    stage: IndexStage,
    /// Where in the file the next byte goes.
    at: u64,
    /// Where the index begins.
    start: u64,
    hash: crc32fast::Hasher,
    /// Records of one kind: their code, and where they begin and end.
    groups: Vec<(u8, u64, u64)>,
}

impl Iterator for FileEnd {
    type Item = Vec<u8>;

    fn next(&mut self) -> Option<Vec<u8>> {
        let mut piece = Vec::new();
        match self.stage {
            IndexStage::Begin { crc } => {
                self.begin(crc, &mut piece);
                self.stage = IndexStage::Chunks { block: 0 };
            }
            IndexStage::Chunks { block } => {
                self.chunks(block, &mut piece);
                self.stage = if block + 1 < self.index.chunks.len() {
                    IndexStage::Chunks { block: block + 1 }
                } else {
                    IndexStage::Rest
                };
            }
            IndexStage::Rest => {
                self.rest(&mut piece);
                self.stage = IndexStage::Done;
            }
            IndexStage::Done => return None,
        }
        Some(piece)
    }
}

/// How much there is in a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Counted {
    /// Messages of each channel.
    pub(crate) messages: BTreeMap<u16, u64>,
    /// Times of the first and the last message, nanoseconds since 1970.
    pub(crate) times: Option<(u64, u64)>,
}

impl Counted {
    /// Messages of all channels.
    pub(crate) fn all(&self) -> u64 {
        self.messages.values().sum()
    }
}

impl FileEnd {
    /// How much there is in the file.
    pub(crate) fn counted(&self) -> Counted {
        Counted {
            messages: self.index.messages.clone(),
            times: self.index.times,
        }
    }

    fn put(&mut self, op: u8, record: &RecordBytes, piece: &mut Vec<u8>) {
        let begin = piece.len();
        piece.push(op);
        piece.extend(
            u64::try_from(record.0.len())
                .unwrap_or_default()
                .to_le_bytes(),
        );
        piece.extend(&record.0);
        let new = piece.get(begin..).unwrap_or_default();
        self.hash.update(new);
        let from = self.at;
        self.at += u64::try_from(new.len()).unwrap_or_default();
        match self.groups.last_mut() {
            Some((last, _, to)) if *last == op => *to = self.at,
            _ => self.groups.push((op, from, self.at)),
        }
    }

    fn begin(&mut self, crc: u32, piece: &mut Vec<u8>) {
        let mut data_end = RecordBytes::default();
        data_end.int(crc);
        self.put(op::DATA_END, &data_end, piece);
        // It does not belong to the index, which begins after it.
        self.start = self.at;
        self.groups.clear();
        self.hash.reset();
        let mut schemas: Vec<_> = Topic::all().map(Topic::schema).collect();
        schemas.sort_by_key(|schema| schema.id);
        schemas.dedup();
        for schema in &schemas {
            let mut record = RecordBytes::default();
            record.short(schema.id);
            record.text(schema.name);
            record.text("ros2msg");
            record.text(schema.text);
            self.put(op::SCHEMA, &record, piece);
        }
        for topic in Topic::all() {
            let mut record = RecordBytes::default();
            record.short(topic.channel());
            record.short(topic.schema().id);
            record.text(topic.name());
            record.text("cdr");
            record.long_bytes(&[]);
            self.put(op::CHANNEL, &record, piece);
        }
        let statistics = self.statistics(schemas.len());
        self.put(op::STATISTICS, &statistics, piece);
    }

    fn statistics(&self, schemas: usize) -> RecordBytes {
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let mut record = RecordBytes::default();
        record.long(self.index.messages.values().sum());
        record.short(u16::try_from(schemas).unwrap_or(u16::MAX));
        record.int(count(Topic::all().count()));
        record.int(count(self.index.attachments.len()));
        record.int(count(self.index.metadata.len()));
        record.int(self.index.chunk_count);
        let (first, last) = self.index.times.unwrap_or_default();
        record.long(first);
        record.long(last);
        let mut messages = RecordBytes::default();
        for (channel, count) in &self.index.messages {
            messages.short(*channel);
            messages.long(*count);
        }
        record.long_bytes(&messages.0);
        record
    }

    fn chunks(&mut self, block: usize, piece: &mut Vec<u8>) {
        let coded = self.index.chunks.get_mut(block).map(std::mem::take);
        let coded = coded.unwrap_or_default();
        for chunk in decoded(&coded) {
            self.put(op::CHUNK_INDEX, &chunk_record(&chunk), piece);
        }
    }

    fn rest(&mut self, piece: &mut Vec<u8>) {
        for index in std::mem::take(&mut self.index.attachments) {
            let mut record = RecordBytes::default();
            for number in [
                index.offset,
                index.length,
                index.log_time,
                index.create_time,
                index.data_size,
            ] {
                record.long(number);
            }
            record.text(&index.name);
            record.text(&index.media_type);
            self.put(op::ATTACHMENT_INDEX, &record, piece);
        }
        for index in std::mem::take(&mut self.index.metadata) {
            let mut record = RecordBytes::default();
            record.long(index.offset);
            record.long(index.length);
            record.text(&index.name);
            self.put(op::METADATA_INDEX, &record, piece);
        }
        let offsets_at = self.at;
        for (code, from, to) in std::mem::take(&mut self.groups) {
            let mut record = RecordBytes::default();
            record.0.push(code);
            record.long(from);
            record.long(to - from);
            self.put(op::SUMMARY_OFFSET, &record, piece);
        }
        // The sum is over all of the index and over the footer as far as the sum itself.
        let mut footer = vec![op::FOOTER];
        footer.extend(20_u64.to_le_bytes());
        footer.extend(self.start.to_le_bytes());
        footer.extend(offsets_at.to_le_bytes());
        self.hash.update(&footer);
        piece.extend(footer);
        let crc = std::mem::take(&mut self.hash).finalize();
        piece.extend(crc.to_le_bytes());
        piece.extend(MAGIC);
    }
}
