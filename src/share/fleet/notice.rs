//! What is told of a shared hand, and how it looks on the wire.

use crate::hand::kinematics::Side;
use crate::link::Owner;
use crate::printable::is_printable;
use crate::record::LinkState;
use crate::record::file::format::cdr;
use crate::transport::Endpoint;
use crate::transport::dds::DdsTopic;
use serde::{Deserialize, Serialize};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// No notice is longer.
pub const NOTICE_BYTES_MAX: usize = 1024;
/// The version of what is told.
const VERSION: u8 = 1;
/// Longer names are cut: they stand in a line of a list.
const NAME_CHARS: usize = 60;

/// What is said of a hand by who shares it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FleetCard {
    /// The computer that it is at.
    pub host: String,
    /// What it is called there.
    pub name: String,
    /// Which hand it is.
    pub side: Side,
    /// Where its gateway is; `None` if it has none that others reach.
    pub at: Option<SocketAddr>,
    /// Whether the first client that writes may move it, without the user there who lets it.
    pub first_may_move: bool,
    /// Whether it follows what programs send here to a hand of its side.
    #[serde(default)]
    pub follows: bool,
}

/// A hand that a Handscope shares.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FleetHand {
    /// What is said of it.
    #[serde(flatten)]
    pub card: FleetCard,
    /// Where its link stands.
    pub state: LinkState,
    /// Who may move it.
    pub owner: Option<Owner>,
}

#[derive(Serialize, Deserialize)]
struct Notice {
    v: u8,
    #[serde(flatten)]
    hand: FleetHand,
}

/// Where it is told. A string, so that programs of ROS 2 read it without a type of ours.
pub fn topic() -> DdsTopic {
    DdsTopic {
        name: "rt/handscope/fleet".into(),
        type_name: "std_msgs::msg::dds_::String_".into(),
    }
}

/// Where others reach a gateway that listens here, if those are who are met on DDS at this interface.
pub fn reachable(gateway: SocketAddr, interface: Ipv4Addr) -> Option<SocketAddr> {
    let interface = IpAddr::V4(interface);
    let ip = match gateway.ip() {
        ip if ip.is_unspecified() => interface,
        ip => ip,
    };
    // The loopback of this computer is another's own, where another hand may be.
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
    /// The message in CDR with its head.
    pub fn message(&self) -> Vec<u8> {
        let notice = Notice {
            v: VERSION,
            hand: Self {
                card: self.card.clone().plain(),
                ..*self
            },
        };
        // Only strings and numbers: it can be written.
        cdr::encode(&serde_json::to_string(&notice).unwrap_or_default())
    }

    /// Reads a message that came in at this interface; `None` for what is none of this version.
    pub fn parse(bytes: &[u8], interface: Ipv4Addr) -> Option<Self> {
        if bytes.len() > NOTICE_BYTES_MAX {
            return None;
        }
        let text: String = cdr::decode(bytes)?;
        let notice: Notice = serde_json::from_str(&text).ok()?;
        let mut hand = notice.hand;
        hand.card = hand.card.plain();
        hand.card.at = hand.card.at.and_then(|at| reachable(at, interface));
        (notice.v == VERSION).then_some(hand)
    }

    /// What to connect to, to watch it.
    pub fn endpoint(&self) -> Option<Endpoint> {
        format!("tcp:{}", self.card.at?).parse().ok()
    }
}

/// A name as it may stand in a line: nothing that moves the line or turns it round.
fn plain(name: &str) -> String {
    let is_sign = |sign: &char| is_printable(*sign) && *sign != '\t';
    name.chars().filter(is_sign).take(NAME_CHARS).collect()
}
