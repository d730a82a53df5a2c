//! Finds hands: plans the probes ([`plan`]), scans one place (`lane_scan`), and provides the caller's handle (`handle`).
//! Reads HAND_ID first and, where it matches, registers that identify the series; never writes, and accesses only
//! places that were named or listed.

mod event;
mod handle;
mod hosts;
mod lane_scan;
mod lent_wire;
pub mod plan;
mod tracker;

pub use event::{FoundHand, ScanEvent, ScanHint, ScanSummary};
pub use handle::{Local, ScanConfig, ScanHandle, start};
pub use hosts::{HOSTS_MAX, Hosts, HostsError};
pub use plan::{ScanPlan, ScanPort, ScanTargets, Speaks};
pub use tracker::ScanProgress;
