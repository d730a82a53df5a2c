//! The program in real time: a display in memory, real ports and sockets, hands in other processes.

#[cfg(all(target_os = "linux", feature = "desktop"))]
mod display;
#[cfg(target_os = "linux")]
mod ending;
#[cfg(all(target_os = "linux", feature = "desktop"))]
mod exhibit;
#[cfg(all(target_os = "linux", feature = "desktop"))]
mod mouse;
#[cfg(all(target_os = "linux", feature = "desktop"))]
mod program;
mod tuning;
#[cfg(all(target_os = "linux", feature = "desktop"))]
mod twin;
mod wires;
