//! Handscope watches, drives and tunes the FTP series tactile hand.
//!
//! # Map
//!
//! A module uses only modules of lower layers; the layer test fails on any other import.
//!
//! | floor | module | what lives there |
//! |---|---|---|
//! | 0 | [`hand`] | what the device is: registers, values, samples, commands |
//! | 0 | [`manual`] | the pages of `handscope help TOPIC`, for the user at the hand |
//! | 0 | [`printable`] | text by others, as it may be shown |
//! | 0 | [`system`] | what the operating system said, as a value |
//! | 1 | [`codec`] | bytes on a wire to register operations and back, both sides |
//! | 1 | [`transport`] | endpoints, serial ports, sockets, CAN interfaces, DDS, in-memory wires with faults |
//! | 1 | [`record`] | what happened at a hand, as typed values; session files, one for each hour, written by a thread of its own and read back; the formats of others |
//! | 1 | [`store`] | files, and the calendar that their names use |
//! | 1 | [`model`] | the hand as a model for others: URDF, MJCF, a table of joints |
//! | 2 | [`history`] | records made cheap to draw; the one decimation of lines |
//! | 3 | [`link`] | one conversation with one hand: owner of the wire, poll plan, arming, stop, settings; finding hands; what went over the wire |
//! | 3 | [`sim`] | a hand that answers on the wire |
//! | 3 | [`params`], [`poses`], [`trials`] | the subjects: parameters that a hand keeps, poses and sequences, grasp trials |
//! | 4 | [`inputs`] | motion from elsewhere: gamepad, streams, DDS, another hand; what they ask for, checked, and how a hand follows it |
//! | 4 | [`checkup`] | a check-up of an empty hand: what is measured, what it should be, what it was at first |
//! | 4 | [`share`] | one hand for several programs: gateway, DDS, live viewers |
//! | 4 | [`exhibit`] | a hand that strangers may touch: its file, PIN, heat, what happens when, the day's report |
//! | 5 | [`tasks`] | what takes several steps at a hand, for window and command line: read, apply, save, relocate, reset, calibrate, series, check-up, play, follow, exhibit |
//! | 6 | [`app`] | everything the program knows, without drawing |
//! | 7 | [`draw`] | pictures computed point by point: the hand as a figure, plot lines, the rasteriser |
//! | 8 | [`ui`] | the window: reads state, returns actions |
//! | 9 | [`shell`] | program and window as one thing: the real window, with OpenGL or without; pictures without a display |
//! | 10 | [`cli`] | the command line |
//!
//! Floors 0 to 5 are a crate of their own, `src/core.rs`, and so is [`draw`]: they are optimised in tests, and an edit of the window
//! does not build them again.
//!
//! # Threads
//!
//! The window's thread owns the program's state. One tokio thread runs links, servers, the built-in hand and the tasks on a
//! hand; each recorded session is written by a thread of its own behind a bounded queue, and other files are read and written
//! on threads that may wait. What the command line prints is written by one thread for each of standard output and standard error,
//! behind a bounded queue. Values cross between them, locks do not: what happens at a hand comes as
//! [`record::Record`]s, setpoints go into one slot that a stop empties, and a task's steps and its end come over a channel.
//! The limits of a series are judged in its task, where the readings arrive, so no window is in their way; so is all that happens at
//! an exhibition.
//!
//! # What always holds
//!
//! * Only [`hand::HandCommand`], [`hand::Setting`] and [`hand::Trigger`] make register writes, and none leaves the manual's addresses and ranges.
//! * Connecting, reconnecting, scanning, examining and looking write nothing. Setpoints pass only while the user has armed the hand;
//!   a stop, faults, heat, link loss, old feedback, another controller and sleep disarm it.
//! * Only what several groups of its memory show to be a hand of this series is written to ([`link::DeviceSeries`]); what answers and is
//!   another is not shown. An exception of a gateway is no answer of the hand, and ends the link within a second.
//! * A stop is the next thing on the wire, is repeated until feedback shows rest, and raises an alarm if it does not. It never
//!   moves a joint back whose angle may be frozen, and ends for a joint in doubt once it had time to obey.
//! * One owner at a time may move a hand, by a [`link::Lease`] that the user granted; a stop, a fault, a lost link and silence end it,
//!   and what the one before asked for is dropped.
//! * A hand that follows another program, a gamepad or another hand begins where it is, and stays within a lead and a rate.
//! * Parameters are written at rest and disarmed, read back, and reported as applied, refused, altered or not known. A SAVE has
//!   the line to itself, one at a time, and no late frame counts for another write. Flash cannot be read, and the program says so.
//! * A value is never invented: what was not read is `None`, and a reply that may be late or doubled is not taken as fresh.
//! * Whatever ends the program stops the hands first ([`link::guard`]); where it cannot, as it is killed, a process of its own does
//!   ([`link::holder`]).
//! * No request outlives a lost link but a stop, which stays pending for [`link::STOP_PENDING`].
//! * A fault stays unseen until the user acknowledges it; what happened around it is kept in memory, bounded, and in the session.
//! * An exhibition plays what its file names, within its limits, and only after staff armed it with their PIN, or a visitor
//!   held a tile where the file allows that; a stop, a lost link, a page that is not drawn or
//!   a fault that needs the user ends that.
//! * While a recording is shown, nothing is sent but a stop of the live hand.
pub mod app;
pub mod cli;
pub mod shell;
pub mod ui;

pub use handscope_draw as draw;

pub use handscope_core::{
    checkup, codec, exhibit, hand, history, inputs, link, manual, model, motion, params, poses,
    printable, record, share, sim, store, system, tasks, transport, trials,
};
