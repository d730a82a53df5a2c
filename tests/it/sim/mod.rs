//! The simulated hand by itself: its memory, its drives, its servers, and what the manual leaves open.

mod bodies;
mod drive;
mod hand;
mod personalities;
mod servers;
