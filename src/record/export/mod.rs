//! Sessions in the formats of others: tables, a rosbag2 folder, a cut copy. Each reads the session as a stream, writes beside its
//! place, and takes the place only when it is whole.

pub(crate) mod columns;
pub mod csv;
pub mod cut;
pub mod output;
pub mod parquet;
pub mod rosbag;

pub use crate::record::export::output::{ExportError, Exported};
