//! A wire in memory, without faults.

use tokio::io::{DuplexStream, duplex};

/// Bytes in flight each way: several of the longest frames of any bus, so that a frame is written in one go.
pub const PIPE_LEN: usize = 4096;

/// One end of a wire in memory. Dropping it is hanging up: the other end reads zero bytes.
pub type Pipe = DuplexStream;

/// Both ends of a wire in memory.
pub fn pair() -> (Pipe, Pipe) {
    duplex(PIPE_LEN)
}
