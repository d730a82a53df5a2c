//! A recording as a file: MCAP whose messages are ROS 2's, so that other programs open it as it is.
//!
//! `format` says what stands in it. Written: `writer` makes bytes of entries, `tail` puts them on the disk, `recording` decides when
//! and into which file, of which there is a new one each hour, and `recorder` is the thread that does it. Read: `parts` tells which
//! files are of one recording, `walk` finds the pieces of a file that may be damaged, `channels` tells its topics apart, `clock` which
//! of its times is believed, `reader`
//! reads its entries, `by_time` those of a file that another program wrote. `damage` is what was missing, `contents` what can be
//! read, `overview` what a file tells without being read whole.

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
pub use crate::record::file::damage::{Damage, Gap, Remark};
pub use crate::record::file::disk::{Disk, DiskFile, FilePlace, SystemDisk};
pub use crate::record::file::format::opening::{Opening, Part};
pub use crate::record::file::overview::{Counts, FileMark, Overview};
pub use crate::record::file::reader::{OpenError, RecordingFile};
pub use crate::record::file::recorder::Recorder;
pub use crate::record::file::recording::{
    FLUSH_INTERVAL, GOES_ON_FROM, GOES_ON_IN, PART_LENGTH, RecorderNotice, RecorderStatus,
    RecordingPlan,
};
