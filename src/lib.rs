//! Handscope monitors, drives and tunes the FTP series tactile hand.
//!
//! # Map
//!
//! A module imports only from lower floors; the layer test fails on any other import.
//!
//! | floor | module | responsibility |
//! |---|---|---|
//! | 0 | [`hand`] | the device: registers, units, samples, commands; the hand as a model for other programs: URDF, MJCF, frames, a table of joints |
//! | 0 | [`manual`] | the pages of `handscope help TOPIC`, for the user at the hand |
//! | 0 | [`printable`] | external text, made safe to display |
//! | 0 | [`system`] | errors of the operating system, as values |
//! | 1 | [`codec`] | bytes on a wire to register operations and back, for both sides of the conversation |
//! | 1 | [`transport`] | endpoints, serial ports, sockets, CAN interfaces, DDS, in-memory wires with faults |
//! | 1 | [`record`] | typed records of everything that happened at a hand; hourly files, written by a dedicated thread and read back; export formats |
//! | 1 | [`store`] | files, and the calendar that their names use |
//! | 2 | [`history`] | records prepared for drawing; the one decimation of lines |
//! | 3 | [`link`] | one conversation with one hand: owner of the wire, poll plan, arming, stop, settings; the scan for hands; traffic on the wire |
//! | 3 | [`sim`] | a hand that answers on the wire |
//! | 3 | [`params`], [`poses`], [`trials`] | the domain models: persistent parameters, poses and sequences, grasp trials |
//! | 4 | [`inputs`] | external motion sources: gamepad, streams, DDS, another hand; their requests, checked, and the limits of following |
//! | 4 | [`checkup`] | the check-up of an empty hand: its steps, measurements, limits, and comparison with earlier ones |
//! | 4 | [`share`] | one hand for several programs: gateway, DDS, live viewers |
//! | 4 | [`exhibit`] | a hand that visitors may touch: its file, PIN, heat, plan, and the day's report |
//! | 5 | [`motion`] | everything that moves an armed hand over time: one loop, `drive`, runs every `Program` (move, grip, hold, sequence, follow, exhibition, trials, search, check-up), the grasp files of holds that worked, and the sources that a hand can follow |
//! | 5 | [`tasks`] | the other operations of several steps, for window and command line, which ask the user through one question: read, apply, save, change address, reset, calibrate |
//! | 6 | [`app`] | state and actions of the program, without drawing |
//! | 7 | [`draw`] | pictures computed point by point: the hand as a figure, plot lines, the rasteriser |
//! | 8 | [`ui`] | the window: reads state, returns actions |
//! | 9 | [`shell`] | program plus window: the real window, with OpenGL or without; pictures without a display |
//! | 10 | [`cli`] | the command line |
//!
//! Floors 0 to 5 are a separate crate, `src/core.rs`, and so is [`draw`]: they are optimised in tests, and an edit of the window
//! does not rebuild them.
//!
//! # Threads
//!
//! The window's thread owns the program's state. One tokio thread runs links, servers, the built-in hand, motion and tasks; each
//! recorded session is written by a dedicated thread behind a bounded queue, and other files are read and written on threads that
//! may block. The command line's output is written by one thread each for standard output and standard error, behind a bounded
//! queue. Values cross threads, locks do not: events at a hand arrive as [`record::Record`]s, setpoints go into one slot that a stop
//! empties, and the progress and the result of a program or task arrive over a channel. The limits of a running program are checked
//! on the tokio thread, where samples arrive, independently of any window; this includes the rules of an exhibition.
//!
//! # Invariants
//!
//! * Only [`hand::HandCommand`], [`hand::Setting`] and [`hand::Trigger`] become register writes, and none leaves the manual's addresses
//!   and ranges.
//! * Connecting, reconnecting, scanning, examining and viewing write nothing. Setpoints pass only while the user has armed the hand;
//!   a stop, faults, heat, link loss, old feedback, another controller and suspend disarm it.
//! * A hand is written to only if several groups of its memory identify it as one of this series ([`link::DeviceSeries`]); any other
//!   device that answers is not shown. An exception reply of a gateway is not a reply of the hand, and ends the link within a second.
//! * A stop is the next frame on the wire, is repeated until feedback shows rest, and raises an alarm if it does not. It never
//!   moves a joint back whose angle may be frozen, and ends for a doubtful joint once it had time to obey.
//! * One owner at a time may move a hand, under a [`link::Lease`] that the user granted; a stop, a fault, a lost link and silence end
//!   it, and pending requests of the previous owner are dropped.
//! * A hand that follows another program, a gamepad or another hand starts at its current position, and its lead and rate are bounded.
//! * Parameters are written at rest and disarmed, read back, and reported as applied, refused, altered or not known. SAVE uses the
//!   line exclusively, one at a time, and no late frame counts for another write. Flash cannot be read, and the program says so.
//! * A value is never invented: a value that was not read is `None`, and a reply that may be late or duplicated does not count as fresh.
//! * Whatever ends the program stops the hands first ([`link::guard`]); if the program is killed, a separate process stops them
//!   (`link::holder`).
//! * No request outlives a lost link except a stop, which stays pending for [`link::STOP_PENDING`].
//! * A fault stays unseen until the user acknowledges it; the records around it are stored in memory, bounded, and in the session.
//! * An exhibition plays only the pieces of its file, within its limits, and only after staff armed it with their PIN, or a visitor
//!   held a tile where the file allows that; a stop, a lost link, a page that is not drawn or a fault that needs the user ends that.
//! * While a recording is shown, nothing is sent except a stop of the live hand.
pub mod app;
pub mod cli;
pub mod shell;
pub mod ui;

pub use handscope_draw as draw;

pub use handscope_core::{
    checkup, codec, exhibit, hand, history, inputs, link, manual, motion, params, poses, printable,
    record, share, sim, store, system, tasks, transport, trials,
};
