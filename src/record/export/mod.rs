//! Exports of recordings: tables, a rosbag2 folder, a data set for machine learning, a cut copy. Each reads the recording as a
//! stream, writes beside its destination, and is renamed only when complete.

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
pub use crate::record::export::source::ExportSource;
