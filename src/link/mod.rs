//! The link to one hand: wire ownership, poll plan, arming and hold, reconnecting, statistics.
//!
//! [`handle::open`] starts a session and returns the program's handle to it. The session ([`session`]) owns the wire,
//! sends one request at a time (`bus`) and decides by priority what comes next: stop, hold, setpoints, requests, reads
//! ([`poll`]). Settings, SAVE and reset are requests that end in a verdict ([`session`]). The traffic on the wire can
//! be inspected afterwards ([`tap`], [`traffic`]).
#![warn(missing_docs)]
mod bus;
pub mod clock;
pub mod config;
pub mod entries;
pub mod guard;
pub mod handle;
mod image;
pub mod lease;
pub mod poll;
pub mod priority;
pub mod quirks;
pub mod recent;
pub mod records;
pub mod request;
pub mod scan;
mod series;
pub mod session;
pub mod stats;
pub mod status;
pub mod stop;
pub mod tap;
pub mod traffic;
pub(crate) mod wanted;

pub use bus::latency::Ticks;
pub use clock::Clock;
pub use config::{LinkConfig, Wake};
pub use entries::LinkEntries;
pub use handle::{Arming, LinkHandle, LinkStopper, StopRequest, open};
pub use lease::{HoldToRun, Lease, LeaseHolder, LeaseRefusal, Owner};
pub use poll::line_time::line_time;
pub use poll::plan::{PollPriority, PollRates};
pub use quirks::{GapRead, Quirks, TouchDoubt, TouchVariant};
pub use recent::RecentReads;
pub use records::{LinkObserver, Records};
pub use request::RequestError;
pub use series::DeviceSeries;
pub use stats::{GroupUse, LineUse, LinkStats};
pub use status::{ArmRequest, Dialling, LinkStatus, LinkTrouble, Stall};
pub use stop::{STOP_PENDING, Stop};
pub use tap::WireTap;
pub use traffic::Traffic;
