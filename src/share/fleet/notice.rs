//! Announcement of a shared hand, and its wire format.

use crate::hand::kinematics::Side;
use crate::link::Owner;
use crate::printable::is_printable;
use crate::record::LinkState;
use crate::record::file::format::cdr;
use crate::transport::Endpoint;
use crate::transport::dds::DdsTopic;
use serde::{Deserialize, Serialize};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// Longest notice, bytes.
pub const NOTICE_BYTES_MAX: usize = 1024;
/// Version of the format.
const VERSION: u8 = 1;
/// Longer names are truncated: they appear in a line of a list.
const NAME_CHARS: usize = 60;

/// Announced description of a hand, set by the program that shares it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FleetCard {
    /// Name of its computer.
    pub host: String,
    /// Name of the hand there.
    pub name: String,
    /// Side of the hand.
    pub side: Side,
    /// Address of its gateway; `None` if it has none that others can reach.
    pub at: Option<SocketAddr>,
    /// True if the first client that writes gets control, without a grant by the user there.
    pub first_may_move: bool,
    /// True if it follows targets that programs send over DDS to a hand of its side.
    #[serde(default)]
    pub follows: bool,
}

/// A hand that a Handscope shares.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FleetHand {
    /// Description.
    #[serde(flatten)]
    pub card: FleetCard,
    /// State of its link.
    pub state: LinkState,
    /// Current holder of control.
    pub owner: Option<Owner>,
}

#[derive(Serialize, Deserialize)]
struct Announcement {
    v: u8,
    #[serde(flatten)]
    hand: FleetHand,
}

/// Topic of the announcements. A string, so that ROS 2 programs read it without a custom type.
pub fn topic() -> DdsTopic {
    DdsTopic {
        name: "rt/handscope/fleet".into(),
        type_name: "std_msgs::msg::dds_::String_".into(),
    }
}

/// Address at which others reach this gateway, if it is reachable from this DDS interface.
pub fn reachable(gateway: SocketAddr, interface: Ipv4Addr) -> Option<SocketAddr> {
    let interface = IpAddr::V4(interface);
    let ip = match gateway.ip() {
        ip if ip.is_unspecified() => interface,
        ip => ip,
    };
    // The loopback address means a different computer to each reader, where another hand may be.
    (ip.is_loopback() == interface.is_loopback()).then(|| SocketAddr::new(ip, gateway.port()))
}

impl FleetCard {
    fn plain(self) -> Self {
        Self {
            host: plain(&self.host),
            name: plain(&self.name),
            ..self
        }
    }
}

impl FleetHand {
    /// Encodes the message in CDR with its header.
    pub fn message(&self) -> Vec<u8> {
        let notice = Announcement {
            v: VERSION,
            hand: Self {
                card: self.card.clone().plain(),
                ..*self
            },
        };
        // Only strings and numbers: serialization cannot fail.
        cdr::encode(&serde_json::to_string(&notice).unwrap_or_default())
    }

    /// Parses a message received at this interface; `None` if it is not valid in this version.
    pub fn parse(bytes: &[u8], interface: Ipv4Addr) -> Option<Self> {
        if bytes.len() > NOTICE_BYTES_MAX {
            return None;
        }
        let text: String = cdr::decode(bytes)?;
        let notice: Announcement = serde_json::from_str(&text).ok()?;
        let mut hand = notice.hand;
        hand.card = hand.card.plain();
        hand.card.at = hand.card.at.and_then(|at| reachable(at, interface));
        (notice.v == VERSION).then_some(hand)
    }

    /// Endpoint for connecting to it, to observe it.
    pub fn endpoint(&self) -> Option<Endpoint> {
        format!("tcp:{}", self.card.at?).parse().ok()
    }
}

/// Filters a name for display in one line: no characters that break the line or change its direction.
fn plain(name: &str) -> String {
    let is_sign = |sign: &char| is_printable(*sign) && *sign != '\t';
    name.chars().filter(is_sign).take(NAME_CHARS).collect()
}
