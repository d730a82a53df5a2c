//! Encodes entries as the bytes of a recording file. Writes to memory only; times are arguments.

use crate::hand::Moment;
use crate::record::Entry;
use crate::record::file::format::encode::{EncodedMessage, EntryEncoder};
use crate::record::file::format::opening::{METADATA, Opening, nanos_of};
use crate::record::file::format::topic::{QUALITY, Topic};
use crate::record::file::overview::Overview;
use crate::record::grip::GripFollower;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, McapError, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Size of a chunk before compression, at which it is closed: the loss from one flipped bit.
const CHUNK_BYTES: u64 = 32 * 1024;
/// Size of a chunk of a copy, which may have any length.
const COPY_CHUNK_BYTES: u64 = 256 * 1024;
/// Time range covered by one block of the overview.
const BLOCK_OF: Duration = Duration::from_secs(60);
/// Name of the overview blocks among a file's attachments.
pub(crate) const OVERVIEW: &str = "handscope-overview";

/// Bytes written by the mcap crate, not collected yet.
#[derive(Debug, Clone, Default)]
struct PendingBytes(Arc<Mutex<Vec<u8>>>);

impl PendingBytes {
    fn bytes(&self) -> MutexGuard<'_, Vec<u8>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for PendingBytes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Message counts and times of a finished file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Counted {
    /// Number of messages of each channel.
    pub messages: BTreeMap<u16, u64>,
    /// Times of the first and the last message, nanoseconds since 1970.
    pub times: (u64, u64),
}

impl Counted {
    /// Number of messages of all channels.
    pub fn all(&self) -> u64 {
        self.messages.values().sum()
    }
}

/// Encodes one recording file. The crate's writer retains 300 bytes for each chunk until the end.
pub struct RecordingWriter {
    mcap: mcap::Writer<NoSeek<PendingBytes>>,
    waiting: PendingBytes,
    encoder: EntryEncoder,
    /// True once the file has the model.
    has_model: bool,
    overview: Overview,
    /// Number of bytes already collected.
    given: u64,
    /// Offset of the first chunk that the next block covers, and the first moment in it.
    block_from: u64,
    block_began: Option<Moment>,
    sequence: u32,
    newest: Moment,
    base_nanos: u64,
}

impl RecordingWriter {
    /// Starts a new file.
    ///
    /// # Errors
    /// [`McapError`], which does not occur when writing to memory.
    pub fn new(opening: &Opening) -> Result<Self, McapError> {
        Self::with_chunks(opening, CHUNK_BYTES, GripFollower::default())
    }

    /// Starts a copy, which is complete or discarded: its chunks are larger, so that it may be days long. `grip` is the state of
    /// the grip before its first entry.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn copy(opening: &Opening, grip: GripFollower) -> Result<Self, McapError> {
        Self::with_chunks(opening, COPY_CHUNK_BYTES, grip)
    }

    fn with_chunks(opening: &Opening, bytes: u64, grip: GripFollower) -> Result<Self, McapError> {
        let waiting = PendingBytes::default();
        let options = WriteOptions::new()
            .profile("ros2")
            .library(format!("handscope {}", opening.version))
            .compression(Some(Compression::Lz4))
            .chunk_size(Some(bytes))
            .disable_seeking(true);
        let mut mcap = options.create(NoSeek::new(waiting.clone()))?;
        mcap.write_metadata(&Metadata {
            name: METADATA.into(),
            metadata: opening.metadata(),
        })?;
        define(&mut mcap)?;
        mcap.flush()?;
        let mut writer = Self {
            mcap,
            waiting,
            encoder: EntryEncoder::following(opening, grip),
            has_model: false,
            overview: Overview::default(),
            given: 0,
            block_from: 0,
            block_began: None,
            sequence: 0,
            newest: opening.began,
            base_nanos: opening.base_nanos,
        };
        writer.block_from = writer.length();
        Ok(writer)
    }

    /// Starts the recording's next file: ongoing states of the hand are not reported as new.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn next(&self, opening: &Opening) -> Result<Self, McapError> {
        Ok(Self {
            overview: self.overview.next(),
            encoder: self.encoder.next(opening),
            ..Self::new(opening)?
        })
    }

    /// Length of the file so far, in bytes.
    pub fn length(&self) -> u64 {
        self.given + u64::try_from(self.waiting.bytes().len()).unwrap_or_default()
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
            self.block_began = Some(at);
        }
        if !self.has_model {
            self.has_model = true;
            for message in self.encoder.lasting(at) {
                self.write(&message)?;
            }
        }
        let derived = self.overview.apply(entry);
        for message in self.encoder.encode(entry) {
            self.write(&message)?;
        }
        for mark in derived {
            let message = self.encoder.event(mark.at, mark.kind.key(), &mark.words);
            self.write(&message)?;
        }
        Ok(())
    }

    fn write(&mut self, message: &EncodedMessage) -> Result<(), McapError> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id: message.topic.channel(),
            sequence: self.sequence,
            log_time: message.log_nanos,
            publish_time: message.publish_nanos,
        };
        self.mcap.write_to_known_channel(&header, &message.bytes)
    }

    /// Closes the chunk, so that everything so far can be collected.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn flush(&mut self) -> Result<(), McapError> {
        self.mcap.flush()
    }

    /// Writes the overview of the entries since the last block.
    fn block(&mut self) -> Result<(), McapError> {
        let data = self.overview.give_block(self.block_from);
        let log_time = nanos_of(self.base_nanos, self.newest);
        self.mcap.attach(&Attachment {
            log_time,
            create_time: log_time,
            name: OVERVIEW.into(),
            media_type: "application/octet-stream".into(),
            data: Cow::Owned(data),
        })?;
        self.block_from = self.length();
        Ok(())
    }

    /// Ends the file and returns its counts. No further entry can be pushed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn finish(&mut self) -> Result<Counted, McapError> {
        self.block()?;
        let stats = self.mcap.finish()?.stats.unwrap_or_default();
        Ok(Counted {
            messages: stats.channel_message_counts,
            times: (stats.message_start_time, stats.message_end_time),
        })
    }

    /// Returns the bytes written since the last call, in sequence.
    pub fn take_bytes(&mut self) -> Vec<u8> {
        let bytes = std::mem::take(&mut *self.waiting.bytes());
        self.given += u64::try_from(bytes.len()).unwrap_or_default();
        bytes
    }
}

/// Writes the definitions of all channels and their schemas.
fn define(mcap: &mut mcap::Writer<NoSeek<PendingBytes>>) -> Result<(), McapError> {
    for topic in Topic::all() {
        let schema = topic.schema();
        mcap.add_schema_with_id(schema.id, schema.name, "ros2msg", schema.text.as_bytes())?;
        let quality = topic.quality().map(|text| (QUALITY.into(), text.into()));
        let metadata = BTreeMap::from_iter(quality);
        mcap.add_channel_with_id(topic.channel(), schema.id, topic.name(), "cdr", &metadata)?;
    }
    Ok(())
}
