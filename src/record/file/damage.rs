//! What of a file is missing, and what else is to be said of how it was found.

use crate::hand::Moment;
use crate::record::file::channels::SkippedTopic;
use crate::record::file::walk::{UNPACKED_MAX, UNPACKED_TIMES};
use std::time::Duration;

/// What is to be said of a file, beside what is missing in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Remark {
    /// Not as Handscope writes it.
    Rewritten,
    /// Messages that are not read.
    Skipped(SkippedTopic),
    /// Its index was gone around.
    StaleIndex,
    /// Messages stand outside of chunks, and the sum over the file is not right.
    SumDiffers,
    /// The times of its log are so many nanoseconds after those in its messages.
    LogMoved { nanos: i64 },
    /// So many messages have no time in its log.
    Unlogged(u64),
    /// Chunks that unpack to so many megabytes were left out.
    TooMuch { megabytes: u64 },
    /// What the file says of itself is missing or damaged.
    OpeningLost,
    /// So many files of the recording do not lie where the others do.
    FilesMissing(u32),
}

impl Remark {
    /// True unless all that Handscope wrote may be there in spite of it.
    pub const fn is_loss(&self) -> bool {
        match self {
            Self::Skipped(skipped) => skipped.is_ours(),
            Self::StaleIndex | Self::LogMoved { .. } | Self::Unlogged(_) => false,
            Self::TooMuch { .. }
            | Self::Rewritten
            | Self::SumDiffers
            | Self::OpeningLost
            | Self::FilesMissing(_) => true,
        }
    }
}

impl std::fmt::Display for Remark {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Skipped(skipped) => return skipped.fmt(f),
            Self::LogMoved { nanos } => {
                let apart = Duration::from_nanos(nanos.unsigned_abs()).as_secs_f64();
                let side = if *nanos < 0 { "before" } else { "after" };
                return write!(
                    f,
                    "the times of its log are {apart:.3} s {side} those in its messages, so another program has moved them: the log is believed"
                );
            }
            Self::Unlogged(messages) => {
                return write!(
                    f,
                    "{messages} messages have no time in the file's log: theirs is that in the message"
                );
            }
            Self::TooMuch { megabytes } => {
                return write!(
                    f,
                    "chunks that unpack to {megabytes} MB were left out: of a file {} MB are unpacked, and {UNPACKED_TIMES} times its length",
                    UNPACKED_MAX / (1024 * 1024)
                );
            }
            Self::FilesMissing(1) => {
                "one file of this recording, which has one for each hour, is not in this folder or cannot be opened"
            }
            Self::FilesMissing(files) => {
                return write!(
                    f,
                    "{files} files of this recording, which has one for each hour, are not in this folder or cannot be opened"
                );
            }
            Self::Rewritten => {
                "another program wrote or changed this file, or its beginning is damaged: it is read by the names of its topics, and nobody can tell what was left out"
            }
            Self::StaleIndex => {
                "its index does not fit: the file was read from its beginning to its end"
            }
            Self::SumDiffers => {
                "the checksum over the file is wrong, and messages outside of chunks have no other: any value may be wrong"
            }
            Self::OpeningLost => {
                "what the file says of itself is missing or damaged: the beginning is that of the first message, and the hand is known only if its parameters were recorded"
            }
        })
    }
}

/// Gaps of one file that are listed; more are counted.
const GAPS_MAX: usize = 1000;

/// A stretch of time of which messages are missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// The last moment before it.
    pub from: Moment,
    /// The first after it.
    pub to: Moment,
    /// How many messages are missing; 0 if nobody counted.
    pub messages: u64,
}

/// What of a file is missing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Damage {
    /// Chunks that cannot be read; each holds about what is recorded within [`FLUSH_INTERVAL`](crate::record::file::FLUSH_INTERVAL).
    pub chunks: u64,
    /// Bytes in which no record was found.
    pub bytes: u64,
    /// Messages that are missing by their numbers.
    pub messages: u64,
    /// When they are missing, at most a thousand.
    pub gaps: Vec<Gap>,
}

impl Damage {
    pub(crate) fn gap(&mut self, gap: Gap) {
        self.messages = self.messages.saturating_add(gap.messages);
        if self.gaps.len() < GAPS_MAX {
            self.gaps.push(gap);
        }
    }

    /// Adds what is missing of another file.
    pub fn add(&mut self, other: &Self) {
        self.chunks += other.chunks;
        self.bytes += other.bytes;
        self.messages += other.messages;
        self.gaps.extend(&other.gaps);
    }

    /// The time over which anything is missing.
    pub fn length(&self) -> Duration {
        self.gaps.iter().map(|gap| gap.to.since(gap.from)).sum()
    }
}
