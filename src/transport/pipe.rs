//! An in-memory wire, without faults.

use tokio::io::{DuplexStream, duplex};

/// Buffer size each way: several of the longest frames of any bus, so that a frame is written in one call.
pub const PIPE_LEN: usize = 4096;

/// One end of an in-memory wire. Dropping it hangs up: the other end reads zero bytes.
pub type Pipe = DuplexStream;

/// Creates both ends of an in-memory wire.
pub fn pair() -> (Pipe, Pipe) {
    duplex(PIPE_LEN)
}
