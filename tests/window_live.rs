//! The real program behind its real window, driven by labels against the simulated hand over the real link. Virtual time.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::expect_used,
    unreachable_pub,
    reason = "a test may"
)]

#[path = "window/bench.rs"]
mod bench;
#[path = "window/cards.rs"]
mod cards;
#[path = "window/compare.rs"]
mod compare;
#[path = "window/device.rs"]
mod device;
#[path = "window/faults.rs"]
mod faults;
#[path = "window/joints.rs"]
mod joints;
#[path = "window/keys.rs"]
mod keys;
#[path = "window/layout.rs"]
mod layout;
#[path = "window/motion.rs"]
mod motion;
#[path = "window/plots.rs"]
mod plots;
#[path = "window/poses.rs"]
mod poses;
#[path = "window/scan.rs"]
mod scan;
#[path = "window/start.rs"]
mod start;
#[path = "window/touch.rs"]
mod touch;
#[path = "window/traffic.rs"]
mod traffic;
#[path = "window/trouble.rs"]
mod trouble;
#[path = "window/tune.rs"]
mod tune;
