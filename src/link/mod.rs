//! One conversation with one hand: the wire's owner, the poll plan, arming and hold, reconnecting, statistics.
//!
//! [`handle::open`] starts a session and gives the window's end of it. The session ([`session`], [`serve`])
//! owns the wire, asks one thing at a time ([`bus`]) and decides by priority what comes next: stop, hold,
//! setpoints, requests, reads ([`plan`], [`window`], [`cost`]). Settings, SAVE and reset are requests that end in a verdict
//! ([`settled`]). What went over the wire can be looked at afterwards
//! ([`tap`], [`traffic`]).

mod bus;
mod calibrate;
mod can;
mod can_port;
pub mod clock;
mod cost;
mod counters;
mod echo;
pub mod event;
mod filter;
mod follow;
pub mod handle;
mod hold;
mod identify;
mod jobs;
mod late;
pub mod latency;
mod line_meter;
pub mod line_time;
mod lost;
mod modbus;
mod modbus_rtu;
mod modbus_tcp;
pub mod motion;
mod moving;
mod packing;
pub mod plan;
#[cfg(test)]
mod plan_tests;
mod polling;
pub mod quirks;
mod rival;
mod rs485;
mod rtu_line;
mod save_watch;
#[cfg(test)]
mod save_watch_tests;
pub mod scan;
mod serve;
mod session;
mod settle;
pub mod settled;
pub mod stats;
pub mod status;
pub mod tap;
pub mod traffic;
mod window;

pub use clock::Clock;
pub use event::{LinkEvent, Outcome, Request, RequestError, Ticket};
pub use handle::{LinkConfig, LinkHandle, Setpoints, Wake, open};
pub use latency::Ticks;
pub use line_time::line_time;
pub use plan::PollRates;
pub use quirks::{GapRead, Quirks, TouchDoubt, TouchVariant};
pub use settled::{Calibrated, Doubt, NotSent, Reset, SaveDoubt, Saved, Verdict, Written};
pub use stats::{GroupUse, LineUse, LinkStats, PollGroup};
pub use status::{
    ArmEpoch, ArmRefusal, ArmRequest, Dialling, Disarmed, Hold, LinkState, LinkStatus, LinkTrouble,
};
pub use tap::{Direction, WireTap};
pub use traffic::Traffic;
