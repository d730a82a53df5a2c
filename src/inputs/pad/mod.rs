//! A gamepad as a source of motion: its controls, their assignment, and the resulting targets. Gamepads are read on Linux.

pub mod control;
pub mod device;
#[cfg(target_os = "linux")]
mod evdev;
pub mod facts;
pub mod file;
pub mod input;
pub mod map;
#[cfg(target_os = "linux")]
pub mod reader;
pub mod report;
pub mod source;
pub mod state;

pub use control::{ControlKind, PadControl};
pub use facts::{AxisRange, FaceOrder, PadFacts};
pub use input::{PadEvent, PadInput};
pub use map::{PadAction, PadMap, PadMapError};
pub use report::{KernelEvent, PadClock, PadId, PadNews, PadReport, PadTrouble};
pub use state::PadState;
