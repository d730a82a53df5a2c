//! Missing parts of a file, and remarks about its condition.

use crate::hand::Moment;
use crate::record::file::channels::SkippedTopic;
use crate::record::file::walk::{UNPACKED_MAX, UNPACKED_TIMES};
use std::time::Duration;

/// A remark about a file's condition, apart from missing data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Remark {
    /// The file differs from Handscope's own form.
    Rewritten,
    /// Messages that are not read.
    Skipped(SkippedTopic),
    /// Its index was stale, and was ignored.
    StaleIndex,
    /// Messages are outside of chunks, and the checksum over the file is wrong.
    SumDiffers,
    /// The log times are ahead of those in the messages by this many nanoseconds.
    LogMoved { nanos: i64 },
    /// Number of messages without a log time.
    Unlogged(u64),
    /// Chunks that unpack to this many megabytes were skipped.
    TooMuch { megabytes: u64 },
    /// The file's opening is missing or damaged.
    OpeningLost,
    /// Number of the recording's files that are not in the same folder.
    FilesMissing(u32),
}

impl Remark {
    /// True if data written by Handscope may be missing.
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
                    "the times of its log are {apart:.3} s {side} those in its messages, so another program changed them: those of the log are used"
                );
            }
            Self::Unlogged(messages) => {
                return write!(
                    f,
                    "{messages} messages have no time in the file's log: the time in the message is used"
                );
            }
            Self::TooMuch { megabytes } => {
                return write!(
                    f,
                    "chunks that unpack to {megabytes} MB were left out: the limit is {} MB plus {UNPACKED_TIMES} times the length of the file",
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
                "another program wrote or changed this file, or its beginning is damaged: it is read by the names of its topics, and what was left out is unknown"
            }
            Self::StaleIndex => {
                "its index does not match: the file was read sequentially instead"
            }
            Self::SumDiffers => {
                "the checksum over the file is wrong, and messages outside chunks have no other checksum: any value may be wrong"
            }
            Self::OpeningLost => {
                "the description in the file is missing or damaged: the first message marks the beginning, and the hand is known only if its parameters were recorded"
            }
        })
    }
}

/// Maximum number of listed gaps of one file; further ones are counted.
const GAPS_MAX: usize = 1000;

/// A period with missing messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageGap {
    /// The last moment before it.
    pub from: Moment,
    /// The first moment after it.
    pub to: Moment,
    /// Number of missing messages; 0 if unknown.
    pub messages: u64,
}

/// Missing parts of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Damage {
    /// Unreadable chunks; each holds about what is recorded within [`FLUSH_INTERVAL`](crate::record::file::FLUSH_INTERVAL).
    pub chunks: u64,
    /// Bytes in which no record was found.
    pub bytes: u64,
    /// Number of messages missing by their numbers.
    pub messages: u64,
    /// Periods in which they are missing, at most a thousand.
    pub gaps: Vec<MessageGap>,
}

impl Damage {
    pub(crate) fn gap(&mut self, gap: MessageGap) {
        self.messages = self.messages.saturating_add(gap.messages);
        if self.gaps.len() < GAPS_MAX {
            self.gaps.push(gap);
        }
    }

    /// Adds the damage of another file.
    pub fn add(&mut self, other: &Self) {
        self.chunks += other.chunks;
        self.bytes += other.bytes;
        self.messages += other.messages;
        self.gaps.extend(&other.gaps);
    }

    /// Total duration of the gaps.
    pub fn length(&self) -> Duration {
        self.gaps.iter().map(|gap| gap.to.since(gap.from)).sum()
    }
}
