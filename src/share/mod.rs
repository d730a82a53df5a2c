//! Shares one hand with several programs: publishing to them, and the writes allowed to them.

pub mod dds;
pub mod fleet;
pub mod foxglove;
pub mod gateway;
mod motors;
