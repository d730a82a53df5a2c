//! What a scan tells while it runs. Plain values; decides nothing.

use crate::hand::Refusal;
use crate::transport::{Endpoint, TransportError, UsbFound};
use std::fmt;
use std::time::Duration;

/// A hand that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundHand {
    /// Endpoint that connects to it.
    pub endpoint: Endpoint,
    /// What it says its HAND_ID is (manual 2.6.1).
    pub hand_id: u8,
    /// From the question to the answer.
    pub round_trip: Duration,
    /// The adapter that it is behind, if that is on USB.
    pub usb: Option<UsbFound>,
}

/// Why there may be a hand although none answered. At most one a place, and only where no hand was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScanHint {
    /// Something answers, and is not the hand that was asked.
    OtherId {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// What its HAND_ID reads.
        hand_id: u8,
    },
    /// Something answers with the id that was asked, but its other registers are not those of this series.
    OtherSeries {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// What its HAND_ID reads.
        hand_id: u8,
    },
    /// Something answers, and will not tell its HAND_ID.
    Refuses {
        /// Endpoint that was tried.
        endpoint: Endpoint,
        /// Why it refuses to give HAND_ID.
        reason: Refusal,
    },
    /// Replies that nobody here asked for.
    OtherTalk {
        /// Where, and in which way they could be read.
        endpoint: Endpoint,
    },
    /// Bytes that are no reply.
    Garbled {
        /// Serial port or adapter.
        place: String,
        /// Speeds at which they came.
        bauds: Vec<u32>,
        /// Bytes received at all these speeds.
        bytes: usize,
    },
}

impl ScanHint {
    /// Where it was noticed.
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
                "something answers at {endpoint}, but its HAND_ID reads {hand_id}: most likely it is no hand"
            ),
            Self::OtherSeries { endpoint, hand_id } => write!(
                f,
                "what answers at {endpoint} says HAND_ID {hand_id} like a hand, but is not of this series: its registers hold other things"
            ),
            Self::Refuses { endpoint, reason } => write!(
                f,
                "something answers at {endpoint}, but does not tell its HAND_ID ({reason}): most likely it is no hand"
            ),
            Self::OtherTalk { endpoint } => write!(
                f,
                "replies to somebody else were heard on {}: another program uses this line; end it, or scan with all ids",
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

/// How a scan ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ScanSummary {
    /// Hands that answered.
    pub found: usize,
    /// Questions asked.
    pub asked: usize,
    /// Places looked at, also if nobody was there.
    pub places: usize,
    /// Places that could not be looked at.
    pub failed: usize,
    /// How long it took.
    pub took: Duration,
}

/// One step of a scan, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScanEvent {
    /// What is going to be done.
    Begun {
        /// Places to look at.
        places: usize,
        /// Questions at most.
        tries: usize,
        /// Time that it takes if nobody answers.
        estimate: Duration,
    },
    /// A hand answered.
    Found(FoundHand),
    /// A place could not be looked at, or not any more; or nobody is at an address that was named.
    Trouble {
        /// Port, interface or address.
        place: String,
        /// Why it could not be opened.
        error: TransportError,
    },
    /// Something worth a word at a place without a hand.
    Hint(ScanHint),
    /// A place was left alone: this program's own link holds it.
    Held {
        /// Port or address.
        place: String,
    },
    /// All was looked at.
    Done(ScanSummary),
}
