//! Orders that programs send to a hand, and how they end, on a hand without a protocol.

mod booth;
mod drive;
mod exhibit;
mod grasp;
mod grip;
mod hold;
mod hold_finger;
mod hold_in_sequence;
mod hold_tile;
mod move_to;
mod play;
mod series;
