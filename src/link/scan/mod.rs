//! Finding hands: what to try and in which order ([`plan`]), looking at one place (`look`), and the end that asks
//! (`handle`). Reads HAND_ID alone; never writes, and goes nowhere that was not named or listed.

mod board;
mod event;
mod handle;
mod heard;
mod hosts;
mod look;
pub mod plan;

pub use board::ScanProgress;
pub use event::{FoundHand, ScanEvent, ScanHint, ScanSummary};
pub use handle::{Local, ScanConfig, ScanHandle, start};
pub use hosts::{HOSTS_MAX, Hosts, HostsError};
pub use plan::{ScanPlan, ScanPort, ScanTargets, Speaks};
