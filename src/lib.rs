//! Handscope watches, drives and tunes the FTP series tactile hand.

pub mod hand;
pub mod headless;
pub mod transport;
