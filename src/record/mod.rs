//! Events at a hand, as typed values that a file can hold.

pub mod abort;
pub mod entry;
pub mod export;
pub mod file;
pub(crate) mod grip;
pub mod heard;
pub mod import;
pub mod quirk_sheet;
pub mod state;
pub mod wire;
pub mod write;

pub use crate::record::abort::Abort;
pub use crate::record::entry::{Entry, Event, EventKind, LinkReport};
pub use crate::record::heard::Record;
pub use crate::record::quirk_sheet::{Fact, QuirkSheet};
pub use crate::record::state::{
    ArmRefusal, Disarmed, Hold, LinkState, Rest, SetpointConflict, SetpointRegister,
};
pub use crate::record::wire::{Direction, Piece, PieceKind};
pub use crate::record::write::{
    Calibrated, Doubt, NotSent, Reset, SaveDoubt, Saved, Verdict, WriteCause, WriteFate, Written,
    WrittenMemory,
};
