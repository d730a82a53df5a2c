//! Programs that send to a hand over DDS, as Unitree's do.

pub mod ctrl;
pub mod motors;
pub mod source;
