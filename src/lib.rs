//! Handscope watches, drives and tunes the FTP series tactile hand.

pub mod app;
pub mod cli;
pub mod codec;
#[cfg(feature = "desktop")]
pub mod desktop;
pub mod hand;
pub mod headless;
pub mod link;
pub mod shell;
pub mod sim;
pub mod transport;
pub mod ui;
