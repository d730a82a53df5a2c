//! Handscope watches, drives and tunes the FTP series tactile hand.

pub mod app;
pub mod codec;
pub mod hand;
pub mod headless;
pub mod link;
pub mod sim;
pub mod transport;
pub mod ui;
