//! One hand for several programs: what is given to them, and what they may write.

pub mod dds;
pub mod fleet;
pub mod foxglove;
pub mod gateway;
mod motors;
