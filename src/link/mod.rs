//! One conversation with one hand: the wire's owner, the poll plan, arming and hold, reconnecting, statistics.

pub mod event;
pub mod stats;
pub mod status;

pub use event::{LinkEvent, Outcome, Request, RequestError, Ticket};
pub use stats::LinkStats;
pub use status::{
    ArmEpoch, ArmRefusal, ArmRequest, Dialling, Disarmed, Hold, LinkState, LinkStatus, LinkTrouble,
};
