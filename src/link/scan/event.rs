//! Events of a running scan. Plain values; no logic.

use crate::hand::Refusal;
use crate::transport::{Endpoint, TransportError, UsbFound};
use std::fmt;
use std::time::Duration;

/// A hand that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundHand {
    /// Endpoint that connects to it.
    pub endpoint: Endpoint,
    /// HAND_ID that it reports (manual 2.6.1).
    pub hand_id: u8,
    /// Time from the request to the reply.
    pub round_trip: Duration,
    /// The adapter in front of it, if that is on USB.
    pub usb: Option<UsbFound>,
}

/// Sign of a device although no hand answered. At most one per place, and only if no hand was found there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScanHint {
    /// A device answers with another id than requested.
    OtherId {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// Value of its HAND_ID.
        hand_id: u8,
    },
    /// A device answers with the requested id, but its other registers are not those of this series.
    OtherSeries {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// Value of its HAND_ID.
        hand_id: u8,
    },
    /// A device answers, but refuses to return its HAND_ID.
    Refuses {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// Reason of the refusal.
        reason: Refusal,
    },
    /// Replies to requests that this program did not send.
    OtherTalk {
        /// Place and protocol in which they could be read.
        endpoint: Endpoint,
    },
    /// Bytes that are not a reply.
    Garbled {
        /// Serial port or adapter.
        place: String,
        /// Baud rates at which they were received.
        bauds: Vec<u32>,
        /// Bytes received at all these rates.
        bytes: usize,
    },
}

impl ScanHint {
    /// Place of the hint.
    pub fn place(&self) -> String {
        match self {
            Self::OtherId { endpoint, .. }
            | Self::OtherSeries { endpoint, .. }
            | Self::Refuses { endpoint, .. }
            | Self::OtherTalk { endpoint } => endpoint.place(),
            Self::Garbled { place, .. } => place.clone(),
        }
    }
}

impl fmt::Display for ScanHint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherId { endpoint, hand_id } => write!(
                f,
                "something answers at {endpoint}, but its HAND_ID reads {hand_id}: it is most likely not a hand"
            ),
            Self::OtherSeries { endpoint, hand_id } => write!(
                f,
                "what answers at {endpoint} reports HAND_ID {hand_id} like a hand, but is not of this series: its registers hold other things"
            ),
            Self::Refuses { endpoint, reason } => write!(
                f,
                "something answers at {endpoint}, but does not report its HAND_ID ({reason}): it is most likely not a hand"
            ),
            Self::OtherTalk { endpoint } => write!(
                f,
                "replies to another program were received on {}: it uses this line; close it, or scan with all ids",
                endpoint.place()
            ),
            Self::Garbled {
                place,
                bauds,
                bytes,
            } => {
                let bauds: Vec<String> = bauds.iter().map(u32::to_string).collect();
                write!(
                    f,
                    "something talks on {place}, but not at {} baud ({bytes} bytes that are no reply): another speed, another device, or crossed wires",
                    bauds.join(", ")
                )
            }
        }
    }
}

/// Summary of a finished scan.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ScanSummary {
    /// Hands that answered.
    pub found: usize,
    /// Probes sent.
    pub asked: usize,
    /// Places scanned, with or without a reply.
    pub places: usize,
    /// Places that could not be scanned.
    pub failed: usize,
    /// Total time.
    pub took: Duration,
}

/// One step of a scan, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScanEvent {
    /// The plan.
    Begun {
        /// Places to scan.
        places: usize,
        /// Maximum probes.
        tries: usize,
        /// Time that it takes if no probe is answered.
        estimate: Duration,
    },
    /// A hand answered.
    Found(FoundHand),
    /// A place could not be scanned, or not to its end; or a named address has no device.
    Trouble {
        /// Port, interface or address.
        place: String,
        /// Reason of the failure.
        error: TransportError,
    },
    /// A notable finding at a place without a hand.
    Hint(ScanHint),
    /// A place was skipped: this program's own link holds it.
    Held {
        /// Port or address.
        place: String,
    },
    /// The scan is complete.
    Done(ScanSummary),
}
