//! Reads a file that another program has written or changed: its messages may be inside or outside of chunks, in any order, with
//! any numbers. The whole file is read once; its own index is only compared with the result.

use super::found::{
    ByteRange, ChunkKind, ChunkPlace, Found, HEAD, HEAD_LEN, MAGIC, RECORD_MAX, UNPACKED_MAX,
    UNPACKED_TIMES, reader, u32_at, u64_at, whole,
};
use super::hops::{ChunkHead, HEAD_READ, chunk_head, chunk_times, next_place, plausible};
use super::messages::{ChunkRecord, long_records, records};
use crate::record::file::channels::Definitions;
use crate::record::file::clock::LogClock;
use mcap::records::op;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Maximum bytes of a group of messages outside of chunks.
const LOOSE_MAX: u64 = 256 * 1024;
/// Bytes read at once.
const READ_AT_ONCE: usize = 64 * 1024;
/// Maximum time difference to the last message at which a candidate after damage is accepted.
const NEAR_NANOS: u64 = 3_600_000_000_000;
/// Channel, number, two times.
const MESSAGE_HEAD: u64 = 2 + 4 + 8 + 8;

/// Content of a file.
#[derive(Debug, Default)]
pub(crate) struct Survey {
    /// Intact chunks, and messages outside of chunks.
    pub(crate) found: Found,
    pub(crate) definitions: Definitions,
    pub(crate) clock: LogClock,
    /// Number of unreadable chunks.
    pub(crate) damaged: u64,
    /// Claimed unpacked bytes of all chunks, and of those skipped because of the limit.
    pub(crate) unpacked: u64,
    pub(crate) left_out: u64,
    /// True if messages are outside of chunks, and the checksum over the data, their only one, is wrong.
    pub(crate) sum_differs: bool,
}

/// Reads all of a file.
///
/// # Errors
/// The system's error; invalid content is not an error.
pub(crate) fn survey<F: Read + Seek>(file: &mut F) -> io::Result<Survey> {
    let len = file.seek(SeekFrom::End(0))?;
    let mut surveyor = Surveyor {
        file: BufReader::with_capacity(READ_AT_ONCE, file),
        len,
        survey: Survey::default(),
        loose: None,
        newest: 0,
    };
    surveyor.file.seek(SeekFrom::Start(0))?;
    let end = surveyor.data()?;
    if let Some((end, sum)) = end {
        surveyor.index(end + HEAD + 4)?;
        let is_loose = |chunk: &ChunkPlace| chunk.kind == ChunkKind::Loose;
        if sum != 0 && surveyor.survey.found.chunks.iter().any(is_loose) {
            surveyor.survey.sum_differs = surveyor.sum(end)? != sum;
        }
    }
    Ok(surveyor.survey)
}

/// True if the record consists of a text and a second field that fill its length, as far as its first bytes show.
fn is_pair(head: &[u8]) -> bool {
    let fits = || {
        let first = u64::from(u32_at(head, HEAD_LEN)?);
        let second = HEAD.checked_add(4)?.checked_add(first)?;
        let second = u64::from(u32_at(head, usize::try_from(second).ok()?)?);
        Some(8 + first + second == u64_at(head, 1)?)
    };
    fits().unwrap_or_else(|| u32_at(head, HEAD_LEN).is_some_and(|len| len > 30))
}

struct Surveyor<'a, F: Read + Seek> {
    file: BufReader<&'a mut F>,
    len: u64,
    survey: Survey,
    /// Range of pending messages outside of chunks: start and end.
    loose: Option<(u64, u64)>,
    /// Time of the newest message so far.
    newest: u64,
}

impl<F: Read + Seek> Surveyor<'_, F> {
    /// The first bytes of the record at this offset.
    fn head(&mut self, at: u64) -> io::Result<Vec<u8>> {
        let left = usize::try_from(self.len - at).unwrap_or(usize::MAX);
        let mut head = vec![0; left.min(HEAD_READ)];
        let here = self.file.stream_position()?;
        let step = i64::try_from(i128::from(at) - i128::from(here));
        self.file.seek_relative(step.map_err(io::Error::other)?)?;
        self.file.read_exact(&mut head)?;
        Ok(head)
    }

    /// Reads the data section; returns its end and its checksum, if it was closed.
    fn data(&mut self) -> io::Result<Option<(u64, u32)>> {
        let mut at = MAGIC.len() as u64;
        while at + HEAD <= self.len {
            let head = self.head(at)?;
            let Some(next) = self.end(&head, at) else {
                self.survey_loose()?;
                let next = self.after_damage(at + 1)?;
                self.survey.found.skipped += next - at;
                at = next;
                continue;
            };
            let code = head.first().copied().unwrap_or_default();
            let place = ByteRange {
                offset: at,
                len: next - at - HEAD,
            };
            if let Some(chunk) = chunk_head(&head) {
                self.survey_loose()?;
                self.survey_chunk(chunk, place)?;
            } else if matches!(code, op::MESSAGE | op::SCHEMA | op::CHANNEL) {
                if self.loose.is_some_and(|(_, to)| to != at) {
                    self.survey_loose()?;
                }
                let (from, _) = self.loose.unwrap_or((at, at));
                self.loose = Some((from, next));
                if next - from >= LOOSE_MAX {
                    self.survey_loose()?;
                }
            } else if code == op::METADATA {
                self.survey.found.metadata(place);
            } else if code == op::DATA_END {
                self.survey_loose()?;
                return Ok(u32_at(&head, HEAD_LEN).map(|sum| (at, sum)));
            }
            at = next;
        }
        self.survey_loose()?;
        self.survey.found.skipped += self.len.saturating_sub(at);
        Ok(None)
    }

    /// End of the record, if a valid one can begin here.
    fn end(&self, head: &[u8], at: u64) -> Option<u64> {
        let size = u64_at(head, 1)?;
        let as_told = || {
            let end = at.checked_add(HEAD)?.checked_add(size)?;
            (end <= self.len).then_some(end)
        };
        match head.first() {
            // Pictures and films may have any length.
            Some(&op::ATTACHMENT) if size > RECORD_MAX => as_told(),
            Some(&op::CHUNK) if chunk_head(head).is_some() => as_told(),
            // A wrong, longer length would hide the channel definitions.
            Some(&(op::HEADER | op::METADATA)) if !is_pair(head) => None,
            Some(&op::MESSAGE) if size < MESSAGE_HEAD => None,
            Some(&op::DATA_END) if size != 4 => None,
            // Records of the summary do not belong to the data.
            Some(&(op::FOOTER | op::CHUNK_INDEX | op::STATISTICS | op::SUMMARY_OFFSET)) => None,
            _ => plausible(head, at, self.len),
        }
    }

    /// The next position of a possible chunk or message.
    fn after_damage(&mut self, from: u64) -> io::Result<u64> {
        let (len, newest, definitions) = (self.len, self.newest, &self.survey.definitions);
        next_place(&mut self.file, (from, len), |head, at| {
            let is_message = || {
                let size = u64_at(head, 1).unwrap_or_default();
                let channel = head.get(HEAD_LEN..).and_then(<[u8]>::first_chunk);
                let time = u64_at(head, HEAD_LEN + 6).unwrap_or_default();
                size >= MESSAGE_HEAD
                    && channel.is_some_and(|two| definitions.has(u16::from_le_bytes(*two)))
                    && time.abs_diff(newest) < NEAR_NANOS
            };
            let is_wanted = match head.first() {
                Some(&op::CHUNK) => chunk_times(head).is_some(),
                Some(&op::MESSAGE) => is_message(),
                _ => false,
            };
            is_wanted && plausible(head, at, len).is_some()
        })
    }

    fn survey_loose(&mut self) -> io::Result<()> {
        let Some((from, to)) = self.loose.take() else {
            return Ok(());
        };
        let place = ByteRange {
            offset: from,
            len: to - from - HEAD,
        };
        self.survey_range(ChunkKind::Loose, place)
    }

    /// Reads a chunk, unless it claims to unpack to more than any recording does.
    fn survey_chunk(&mut self, chunk: ChunkHead, place: ByteRange) -> io::Result<()> {
        let survey = &mut self.survey;
        survey.unpacked = survey.unpacked.saturating_add(chunk.unpacked);
        let times = self.len.saturating_mul(UNPACKED_TIMES);
        if survey.unpacked > UNPACKED_MAX.saturating_add(times) {
            survey.unpacked -= chunk.unpacked;
            survey.left_out = survey.left_out.saturating_add(chunk.unpacked);
            survey.damaged += 1;
            return Ok(());
        }
        let is_long = chunk.unpacked.max(chunk.size) > RECORD_MAX;
        if !is_long {
            return self.survey_range(ChunkKind::Foreign, place);
        }
        // Its checksum is verified only at its end, and a damaged one must not count.
        let is_whole = long_records(&mut reader(&mut self.file, place)?, |_| ())?;
        if is_whole {
            self.survey_range(ChunkKind::Long, place)
        } else {
            self.survey.damaged += 1;
            Ok(())
        }
    }

    /// Reads a chunk: its definitions, its messages, and their times.
    fn survey_range(&mut self, kind: ChunkKind, place: ByteRange) -> io::Result<()> {
        let mut times: Option<(u64, u64)> = None;
        let (definitions, clock) = (&mut self.survey.definitions, &mut self.survey.clock);
        let mut has_unlogged = false;
        let take = |record: ChunkRecord<'_>| match record {
            ChunkRecord::Definition(code, content) => definitions.push(code, content),
            ChunkRecord::Message(message) => {
                definitions.count(message.channel);
                clock.push(message.channel, message.times.0, message.data);
                if message.times.0 == 0 {
                    has_unlogged = true;
                    return;
                }
                let (first, last) = times.unwrap_or((message.times.0, message.times.0));
                times = Some((first.min(message.times.0), last.max(message.times.0)));
            }
        };
        let is_whole = match kind {
            ChunkKind::Long => long_records(&mut reader(&mut self.file, place)?, take)?,
            _ => records(&mut whole(&mut self.file, place)?, kind, take),
        };
        self.survey.damaged += u64::from(!is_whole);
        if let Some((_, last)) = times {
            self.newest = last;
        }
        // The times of messages without a log time are still unknown.
        let unknown = has_unlogged.then_some((0, u64::MAX));
        if let Some((first_nanos, last_nanos)) = unknown.or(times) {
            self.survey.found.chunk(ChunkPlace {
                kind,
                place,
                first_nanos,
                last_nanos,
            });
        }
        Ok(())
    }

    /// Reads the index, and compares it with the records found.
    fn index(&mut self, from: u64) -> io::Result<()> {
        let mut at = from;
        let (mut known_chunks, mut unknown_chunks) = (0_usize, 0_usize);
        while at + HEAD <= self.len {
            let head = self.head(at)?;
            let Some(next) = plausible(&head, at, self.len) else {
                break;
            };
            match head.first() {
                Some(&op::CHUNK_INDEX) => {
                    let offset = u64_at(&head, HEAD_LEN + 16);
                    let chunks = &self.survey.found.chunks;
                    let known = chunks
                        .binary_search_by_key(&offset, |chunk| Some(chunk.place.offset))
                        .is_ok();
                    known_chunks += usize::from(known);
                    unknown_chunks += usize::from(!known);
                }
                Some(&op::STATISTICS) => self.survey.found.messages = u64_at(&head, HEAD_LEN),
                Some(&op::FOOTER) => {
                    self.survey.found.closed = true;
                    break;
                }
                _ => {}
            }
            at = next;
        }
        let survey = &mut self.survey;
        let chunks = survey.found.chunks.iter();
        let chunks = chunks.filter(|chunk| chunk.kind != ChunkKind::Loose);
        let has_index = known_chunks + unknown_chunks > 0;
        // The index also lists chunks that are empty or damaged.
        let misses = has_index && known_chunks < chunks.count();
        let points_aside = has_index && known_chunks == 0;
        let counts_others = survey.damaged == 0
            && survey.found.skipped == 0
            && survey
                .found
                .messages
                .is_some_and(|all| all != survey.definitions.messages());
        survey.found.stale_index = misses || points_aside || counts_others;
        Ok(())
    }

    /// Checksum over the first bytes of the file.
    fn sum(&mut self, to: u64) -> io::Result<u32> {
        self.file.seek(SeekFrom::Start(0))?;
        let mut hash = crc32fast::Hasher::new();
        let mut bytes = vec![0; READ_AT_ONCE];
        let mut left = to;
        while left > 0 {
            let step = usize::try_from(left)
                .unwrap_or(usize::MAX)
                .min(READ_AT_ONCE);
            let part = bytes.get_mut(..step).unwrap_or_default();
            self.file.read_exact(part)?;
            hash.update(part);
            left -= step as u64;
        }
        Ok(hash.finalize())
    }
}
