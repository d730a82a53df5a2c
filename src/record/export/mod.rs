//! Recordings in the formats of others: tables, a rosbag2 folder, a data set for learners, a cut copy. Each reads the recording as a stream, writes beside its
//! place, and takes the place only when it is whole.

pub(crate) mod arrow_schema;
pub(crate) mod columns;
pub mod csv;
pub mod cut;
pub(crate) mod frames;
pub mod lerobot;
pub mod output;
pub mod parquet;
pub mod rosbag;
pub mod source;
pub(crate) mod statistics;
pub(crate) mod targets;

pub use crate::record::export::output::{Destination, ExportError, Exported};
pub use crate::record::export::source::Source;
