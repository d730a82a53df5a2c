//! ROS 2's encoding of messages: little-endian CDR behind a header of four bytes.

use byteorder::{BigEndian, LittleEndian};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// CDR, little-endian, no options.
const LITTLE: [u8; 4] = [0, 1, 0, 0];
/// Second byte of the header of big-endian CDR.
const BIG: u8 = 0;

/// Encodes a message.
pub fn encode<T: Serialize>(message: &T) -> Vec<u8> {
    let mut bytes = LITTLE.to_vec();
    // Writing to a vector cannot fail, and messages contain only types that CDR supports.
    if let Ok(body) = cdr_encoding::to_vec::<T, LittleEndian>(message) {
        bytes.extend(body);
    }
    bytes
}

/// Decodes a message; `None` if the bytes are not one.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    let ([_, order, _, _], body) = bytes.split_first_chunk()?;
    let read = match *order {
        BIG => cdr_encoding::from_bytes::<T, BigEndian>(body),
        _ => cdr_encoding::from_bytes::<T, LittleEndian>(body),
    };
    read.ok().map(|(message, _)| message)
}
