//! Frames decoded from recorded traffic, with their meaning and faults. For viewers only: the link itself does not use
//! this module.
pub mod can;
pub mod compose;
pub mod content;
pub mod cut;
pub mod decode;
pub mod fields;
pub mod frame;
pub mod matching;
pub mod modbus;
pub mod reader;
pub mod rs485;
pub mod values;
pub mod words;

pub use decode::Decoder;
pub use frame::{Frame, FrameFormat, Kind, Wrong};
pub use reader::{FRAMES_MAX, Traffic};
