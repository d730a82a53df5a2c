//! A gamepad as a source of motion: what its controls ask for, what it never asks for, and how it is read.

mod file;
mod input;
mod map;
mod random;
#[cfg(target_os = "linux")]
mod reader;
pub(crate) mod setup;
#[cfg(target_os = "linux")]
mod uinput;
