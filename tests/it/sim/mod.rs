//! The simulated hand by itself: its memory, its drives, its servers, and what the manual leaves open.

mod bodies;
mod drive;
mod grips;
mod hand;
mod personalities;
#[cfg(unix)]
mod referee;
mod referee_grip;
mod servers;
