//! Handscope watches, drives and tunes the FTP series tactile hand.
//!
//! # Map
//!
//! A module uses only modules of lower layers; `tests/tidy.rs` fails on any other import.
//!
//! | layer | module | what lives there |
//! |---|---|---|
//! | 0 | [`hand`] | what the device is: registers, values, samples, commands |
//! | 1 | [`codec`] | bytes on a wire to register operations and back, both sides |
//! | 1 | [`transport`] | endpoints, serial ports, sockets, CAN interfaces, in-memory wires with faults |
//! | 2 | [`link`] | one conversation with one hand: owner of the wire, poll plan, arming, stop, settings, SAVE and calibration; finding hands; what went over the wire |
//! | 2 | [`sim`] | a hand that answers on the wire |
//! | 3 | [`app`] | everything the program knows, without drawing; grasp trials and what is measured of them; what a hand keeps, in files, compared, backed up; what is done to a hand only under a card |
//! | 4 | [`ui`] | the window: reads state, returns actions |
//! | 5 | [`shell`] | program and window as one thing |
//! | 5 | [`raster`] | what egui drew as pixels, without a GPU |
//! | 6 | `desktop`, [`headless`] | the real window, with OpenGL or without; pictures without a display |
//! | 7 | [`cli`] | the command line |
//!
//! # Threads
//!
//! The window's thread owns the program's state. One tokio thread runs all links and the built-in hand. Values cross
//! between them, locks do not: samples and answers come as events, wishes go into one slot that a stop empties. The one
//! lock is around the program while a series of trials runs: then the tokio thread takes events in too, at once, because
//! limits must not wait for a window that nobody sees ([`shell::pulse`]).
//!
//! # What always holds
//!
//! * Only [`hand::HandCommand::writes`] makes register writes, and none leaves the manual's addresses and ranges.
//! * Connecting, reconnecting, scanning, examining and looking write nothing. Motion passes only while a person armed the hand; stop, faults,
//!   link loss, old feedback and sleep disarm it.
//! * A stop is the next thing on the wire, goes out again until feedback shows rest, and raises an alarm if it does not.
//! * What a hand keeps is written at rest and disarmed, read back, and told as applied, refused, otherwise or not known. A SAVE has
//!   the line for itself, one at a time, and no late frame counts for another write; flash cannot be read, and that is said.
//! * A value is never invented: what was not read is `None`, and a reply that may be late or doubled is not taken as fresh.
//! * Nothing that was asked survives a lost link.
//! * A fault stays unseen until a person says that they saw it, and what happened around it is kept in memory, bounded.

pub mod app;
pub mod cli;
pub mod codec;
#[cfg(feature = "desktop")]
pub mod desktop;
pub mod hand;
pub mod headless;
pub mod link;
pub mod raster;
pub mod shell;
pub mod sim;
pub mod transport;
pub mod ui;
