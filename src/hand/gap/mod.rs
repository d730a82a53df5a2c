//! Grips by size: the grips that this hand can do, the angles for a gap in mm, and the size of the held object. Computed by the model of
//! [`crate::hand::kinematics`], so each figure is "by the model" until blocks of known size were measured.

mod blocks;
mod kind;
mod path;

pub use blocks::{Block, BlockError, HeldSize, SizeBlocks};
pub use kind::{GripKind, NotOffered};
pub use path::{
    Gap, GapOutOfRange, PinchGap, PinchLeg, gap_on_path, held_gap, is_open_for_pinch, pad_distance,
    pinch_gap,
};
