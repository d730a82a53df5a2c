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

use std::sync::{PoisonError, RwLock, RwLockReadGuard};

/// Real time wants processors that are free: a window that is drawn there takes them all.
static PROCESSORS: RwLock<()> = RwLock::new(());

/// For tests of this folder that draw a window: none of the others runs meanwhile.
#[cfg(all(target_os = "linux", feature = "desktop"))]
fn alone() -> std::sync::RwLockWriteGuard<'static, ()> {
    PROCESSORS.write().unwrap_or_else(PoisonError::into_inner)
}

/// For the others, which may run beside each other.
fn beside_others() -> RwLockReadGuard<'static, ()> {
    PROCESSORS.read().unwrap_or_else(PoisonError::into_inner)
}
