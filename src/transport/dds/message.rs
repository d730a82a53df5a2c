//! A message, its topic and its writer.

use std::fmt;

/// Id of a writer: one writer of one process. Never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DdsWriterId(pub [u8; 16]);

impl fmt::Display for DdsWriterId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// A received message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsMessage {
    /// Its writer.
    pub from: DdsWriterId,
    /// CDR with its header of four bytes; empty if it is in another encoding.
    pub bytes: Vec<u8>,
}

/// A topic and the type of its messages, as DDS names them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DdsTopic {
    pub name: String,
    pub type_name: String,
}
