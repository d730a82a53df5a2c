//! A recording as a file: MCAP with ROS 2 messages, so that other programs can open it directly.
//!
//! `format` defines the content. Writing: `writer` encodes entries, `tail` puts the bytes on the disk, `recording` decides when
//! and into which file (a new one each hour), and `recorder` is the thread that does it. Reading: `parts` finds the files of one
//! recording, `walk` finds the records of a file that may be damaged, `channels` identifies its topics, `clock` chooses among its
//! times, `reader` reads its entries, `by_time` those of a file that another program wrote. `damage` describes missing data,
//! `contents` the readable contents, `overview` the summary that is available without reading the whole file.

mod by_time;
mod channels;
mod clock;
mod contents;
mod damage;
pub mod disk;
pub mod format;
pub mod overview;
pub mod parts;
pub mod reader;
pub mod recorder;
mod recording;
mod tail;
#[cfg(test)]
pub(crate) mod tests;
pub mod walk;
pub mod writer;

pub use crate::record::file::channels::{SkipReason, SkippedTopic};
pub use crate::record::file::contents::Contents;
pub use crate::record::file::damage::{Damage, MessageGap, Remark};
pub use crate::record::file::disk::{Disk, DiskFile, FilePlace, SystemDisk};
pub use crate::record::file::format::opening::{Opening, Part};
pub use crate::record::file::overview::{Counts, FileMark, Overview};
pub use crate::record::file::reader::{OpenError, RecordingFile};
pub use crate::record::file::recorder::Recorder;
pub use crate::record::file::recording::{
    FLUSH_INTERVAL, GOES_ON_FROM, GOES_ON_IN, PART_LENGTH, RecorderNotice, RecorderStatus,
    RecordingPlan,
};
