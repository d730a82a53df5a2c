//! Lists of chunks: where each stands, its times, and how many messages of which channel it holds, in some twenty bytes. The end of a
//! file is made of them, and each minute of a file has one of its own, by which a file is read that was never ended.

use mcap::records::ChunkIndex;

/// The name of the lists among a file's attachments.
pub(crate) const CHUNK_LIST: &str = "handscope-chunks";
/// Bytes of the record that tells where the messages of one channel stand, and of each message in it.
const MESSAGES_HEAD: u64 = 9 + 2 + 4;
const MESSAGES_EACH: u64 = 8 + 8;

/// The list of one block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ChunkList {
    /// Where the list before stands; 0 for the first.
    pub(crate) before: u64,
    /// Where the block begins, right after that.
    pub(crate) from: u64,
    /// Where the block's overview stands, right before this list.
    pub(crate) overview: u64,
    /// The chunks, one number after the other.
    pub(crate) coded: Box<[u8]>,
}

impl ChunkList {
    /// For a file.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let places = [self.before, self.from, self.overview];
        let places = places.into_iter().flat_map(u64::to_le_bytes);
        places.chain(self.coded.iter().copied()).collect()
    }

    /// From a file; `None` if it is none.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Option<Self> {
        let (places, coded) = bytes.split_at_checked(24)?;
        let (places, _) = places.as_chunks::<8>();
        let [before, from, overview] = *places else {
            return None;
        };
        Some(Self {
            before: u64::from_le_bytes(before),
            from: u64::from_le_bytes(from),
            overview: u64::from_le_bytes(overview),
            coded: coded.into(),
        })
    }

    /// The chunks in the order of the file.
    pub(crate) fn chunks(&self) -> impl Iterator<Item = ListedChunk> {
        decoded(&self.coded)
    }
}

/// The chunks of a block.
pub(crate) fn decoded(coded: &[u8]) -> impl Iterator<Item = ListedChunk> {
    let (mut rest, mut before) = (coded, ListedChunk::default());
    std::iter::from_fn(move || {
        let chunk = ListedChunk::decode(&before, &mut rest)?;
        before.clone_from(&chunk);
        Some(chunk)
    })
}

/// A chunk, and how many messages of which channel it holds.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct ListedChunk {
    pub(crate) offset: u64,
    pub(crate) len: u64,
    pub(crate) unpacked: u64,
    pub(crate) first_nanos: u64,
    pub(crate) last_nanos: u64,
    pub(crate) messages: Vec<(u16, u64)>,
}

impl ListedChunk {
    /// As the crate tells of it, whose places count from `base`.
    pub(crate) fn of(index: &ChunkIndex, base: u64) -> Self {
        let end = index.chunk_start_offset + index.chunk_length + index.message_index_length;
        let places = index.message_index_offsets.values().copied();
        let ends = places.clone().skip(1).chain([end]);
        let counts = places.zip(ends).map(|(from, to)| {
            debug_assert_eq!((to - from - MESSAGES_HEAD) % MESSAGES_EACH, 0);
            to.saturating_sub(from + MESSAGES_HEAD) / MESSAGES_EACH
        });
        let channels = index.message_index_offsets.keys().copied();
        Self {
            offset: base + index.chunk_start_offset,
            len: index.chunk_length,
            unpacked: index.uncompressed_size,
            first_nanos: index.message_start_time,
            last_nanos: index.message_end_time,
            messages: channels.zip(counts).collect(),
        }
    }

    /// Where the records after it end that tell where its messages stand.
    pub(crate) fn end(&self) -> u64 {
        let end = self.offset.saturating_add(self.len);
        end.saturating_add(self.messages_len())
    }

    /// Bytes of those records.
    pub(crate) fn messages_len(&self) -> u64 {
        let counts = self.messages.iter().map(|(_, count)| *count);
        let each = counts.map(messages_len);
        each.fold(0, u64::saturating_add)
    }

    /// Adds what differs from the chunk before.
    pub(crate) fn code(&self, before: &Self, to: &mut Vec<u8>) {
        let channels = self.messages.iter();
        let channels = channels.fold(0, |all, (channel, _)| all | 1 << channel);
        debug_assert!(self.messages.iter().all(|(channel, _)| *channel < 64));
        for number in [
            self.offset.wrapping_sub(before.end()),
            self.len,
            self.unpacked,
            zigzag(self.first_nanos.wrapping_sub(before.last_nanos)),
            self.last_nanos.wrapping_sub(self.first_nanos),
            channels,
        ] {
            code(number, to);
        }
        for (_, count) in &self.messages {
            code(*count, to);
        }
    }

    /// The next of a block.
    fn decode(before: &Self, from: &mut &[u8]) -> Option<Self> {
        let offset = before.end().wrapping_add(decode(from)?);
        let (len, unpacked) = (decode(from)?, decode(from)?);
        let first_nanos = before.last_nanos.wrapping_add(unzigzag(decode(from)?));
        let last_nanos = first_nanos.wrapping_add(decode(from)?);
        let channels = decode(from)?;
        let channels = (0..64).filter(|channel| channels >> channel & 1 == 1);
        let messages = channels.map(|channel| Some((channel, decode(from)?)));
        Some(Self {
            offset,
            len,
            unpacked,
            first_nanos,
            last_nanos,
            messages: messages.collect::<Option<_>>()?,
        })
    }
}

/// Bytes of the record that tells where so many messages of one channel stand.
pub(crate) const fn messages_len(count: u64) -> u64 {
    MESSAGES_EACH
        .saturating_mul(count)
        .saturating_add(MESSAGES_HEAD)
}

/// Small numbers below zero as small numbers.
const fn zigzag(number: u64) -> u64 {
    number << 1 ^ (number.cast_signed() >> 63).cast_unsigned()
}

const fn unzigzag(coded: u64) -> u64 {
    coded >> 1 ^ (coded & 1).wrapping_neg()
}

/// Seven bits a byte, the lowest first; the last byte is below 128.
fn code(mut number: u64, to: &mut Vec<u8>) {
    loop {
        let [low, ..] = number.to_le_bytes();
        number >>= 7;
        if number == 0 {
            return to.push(low);
        }
        to.push(low | 128);
    }
}

fn decode(from: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let (byte, rest) = from.split_first()?;
        *from = rest;
        number |= u64::from(byte & 127) << shift;
        if *byte < 128 {
            return Some(number);
        }
    }
    None
}
