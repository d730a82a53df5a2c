//! Bytes of a session file made of entries. Writes to memory only; times are arguments.

use crate::hand::Moment;
use crate::record::Entry;
use crate::record::file::chunk_list::CHUNK_LIST;
use crate::record::file::encode::{EntryEncoder, Message};
use crate::record::file::index::{FileEnd, FileIndex};
use crate::record::file::opening::{METADATA, Opening, nanos_of};
use crate::record::file::overview::Overview;
use crate::record::file::topic::Topic;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, McapError, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Seek, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A chunk is closed at this size before compression: what a flipped bit costs.
const CHUNK_BYTES: u64 = 32 * 1024;
/// How much of the recording one block of the overview is about.
const BLOCK_OF: Duration = Duration::from_secs(60);
/// The name of the blocks of the overview among a file's attachments.
pub(crate) const OVERVIEW: &str = "handscope-overview";

/// Bytes that the crate made and nobody has taken.
#[derive(Debug, Clone, Default)]
struct Waiting(Arc<Mutex<Vec<u8>>>);

impl Waiting {
    fn bytes(&self) -> MutexGuard<'_, Vec<u8>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Waiting {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Makes the bytes of one session file. The crate's writer remembers each of its chunks with a kilobyte, so each block has one of
/// its own, of which the end is left out; it begins with the definitions, which thus survive damage, too.
pub struct SessionWriter {
    mcap: mcap::Writer<NoSeek<Waiting>>,
    waiting: Waiting,
    options: WriteOptions,
    /// Where in the file stands what stands at the beginning for the crate.
    base: u64,
    index: FileIndex,
    crc: crc32fast::Hasher,
    ready: Vec<u8>,
    encoder: EntryEncoder,
    overview: Overview,
    /// Bytes given away so far.
    given: u64,
    /// Where the chunks begin that the next block is about, and the first moment in them.
    block_from: u64,
    block_began: Option<Moment>,
    /// Where the last list of chunks stands, and what follows it.
    listed: (u64, u64),
    sequence: u32,
    newest: Moment,
    base_nanos: u64,
}

impl SessionWriter {
    /// A new file.
    ///
    /// # Errors
    /// [`McapError`], which writing to memory does not bring.
    pub fn new(opening: &Opening) -> Result<Self, McapError> {
        let waiting = Waiting::default();
        let options = WriteOptions::new()
            .profile("ros2")
            .library(format!("handscope {}", opening.version))
            .compression(Some(Compression::Lz4))
            .chunk_size(Some(CHUNK_BYTES))
            .calculate_data_section_crc(false)
            .emit_summary_records(false)
            .emit_attachment_indexes(true)
            .emit_metadata_indexes(true)
            .disable_seeking(true);
        let mut mcap = options.clone().create(NoSeek::new(waiting.clone()))?;
        mcap.write_metadata(&Metadata {
            name: METADATA.into(),
            metadata: opening.metadata(),
        })?;
        let listed = (0, u64::try_from(waiting.bytes().len()).unwrap_or_default());
        define(&mut mcap)?;
        mcap.flush()?;
        let mut writer = Self {
            mcap,
            waiting,
            options,
            base: 0,
            index: FileIndex::default(),
            crc: crc32fast::Hasher::new(),
            ready: Vec::new(),
            encoder: EntryEncoder::new(opening),
            overview: Overview::default(),
            given: 0,
            block_from: 0,
            block_began: None,
            listed,
            sequence: 0,
            newest: opening.began,
            base_nanos: opening.base_nanos,
        };
        writer.block_from = writer.length();
        Ok(writer)
    }

    /// Bytes of the file so far.
    pub fn length(&self) -> u64 {
        let bytes = self.ready.len() + self.waiting.bytes().len();
        self.given + u64::try_from(bytes).unwrap_or_default()
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn push(&mut self, entry: &Entry) -> Result<(), McapError> {
        let at = entry.at();
        self.newest = self.newest.max(at);
        let began = *self.block_began.get_or_insert(at);
        if at.since(began) >= BLOCK_OF {
            self.block()?;
            self.begin_block()?;
            self.block_began = Some(at);
        }
        let derived = self.overview.take(entry);
        for message in self.encoder.encode(entry) {
            self.write(&message)?;
        }
        for mark in derived {
            let message = self.encoder.event(mark.at, mark.kind.key(), &mark.words);
            self.write(&message)?;
        }
        Ok(())
    }

    fn write(&mut self, message: &Message) -> Result<(), McapError> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id: message.topic.channel(),
            sequence: self.sequence,
            log_time: message.log_nanos,
            publish_time: message.publish_nanos,
        };
        self.mcap.write_to_known_channel(&header, &message.bytes)
    }

    /// Closes the chunk, so that everything so far can be taken.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn flush(&mut self) -> Result<(), McapError> {
        self.mcap.flush()
    }

    /// Writes the overview of what was pushed since the last block, and ends the crate's writer.
    fn block(&mut self) -> Result<(), McapError> {
        let data = self.overview.give_block(self.block_from);
        self.attach(OVERVIEW, data)?;
        self.collect();
        let block = self.mcap.finish()?;
        self.index.add(block, self.base);
        self.waiting.bytes().clear();
        Ok(())
    }

    fn attach(&mut self, name: &str, data: Vec<u8>) -> Result<(), McapError> {
        let log_time = nanos_of(self.base_nanos, self.newest);
        self.mcap.attach(&Attachment {
            log_time,
            create_time: log_time,
            name: name.into(),
            media_type: "application/octet-stream".into(),
            data: Cow::Owned(data),
        })
    }

    /// Goes on with another writer of the crate, whose beginning the file has already, and first with a list of the block before.
    fn begin_block(&mut self) -> Result<(), McapError> {
        let waiting = Waiting::default();
        let options = self.options.clone();
        self.mcap = options.create(NoSeek::new(waiting.clone()))?;
        let beginning = std::mem::take(&mut *waiting.bytes()).len();
        self.waiting = waiting;
        self.block_from = self.length();
        let beginning = u64::try_from(beginning).unwrap_or_default();
        self.base = self.block_from.saturating_sub(beginning);
        let (before, from) = self.listed;
        let list = self.index.list(before, from);
        self.attach(CHUNK_LIST, list.to_bytes())?;
        self.listed = (self.block_from, self.length());
        define(&mut self.mcap)
    }

    /// Ends the file. Its end follows the bytes that are to be taken. Nothing can be pushed any more.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn finish(&mut self) -> Result<FileEnd, McapError> {
        self.block()?;
        let index = std::mem::take(&mut self.index);
        Ok(index.end(self.length(), self.crc.clone().finalize()))
    }

    /// Bytes that the chunks of all blocks before take in memory, and how many chunks that are.
    #[cfg(test)]
    pub(crate) fn chunk_memory(&self) -> (usize, u32) {
        self.index.chunk_memory()
    }

    fn collect(&mut self) {
        let mut waiting = self.waiting.bytes();
        self.crc.update(&waiting);
        self.ready.append(&mut waiting);
    }

    /// The bytes that were made since the last call. They follow those of before.
    pub fn take_bytes(&mut self) -> Vec<u8> {
        self.collect();
        let bytes = std::mem::take(&mut self.ready);
        self.given += u64::try_from(bytes.len()).unwrap_or_default();
        bytes
    }
}

/// Says which channels there are, and of what their messages consist.
fn define<W: Write + Seek>(mcap: &mut mcap::Writer<W>) -> Result<(), McapError> {
    for topic in Topic::all() {
        let schema = topic.schema();
        mcap.add_schema_with_id(schema.id, schema.name, "ros2msg", schema.text.as_bytes())?;
        let none = BTreeMap::new();
        mcap.add_channel_with_id(topic.channel(), schema.id, topic.name(), "cdr", &none)?;
    }
    Ok(())
}
