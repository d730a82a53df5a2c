//! The private RS485 framing of manual 2.2: requests `EB 90 …`, replies `90 EB …`. Modbus is in sibling modules.

pub mod client;
pub mod device;
pub mod framing;

pub use client::{ReplyDecoder, Rs485Reply, SaveResult, encode_read, encode_write};
pub use device::{
    RequestDecoder, Rs485Request, encode_calibration_end, encode_read_reply, encode_save_result,
    encode_write_ack,
};
pub use framing::{BUFFER_LEN, FramerCounts, Payload, READ_LEN_MAX, Rs485Frame};

#[cfg(test)]
mod tests;
