//! DDS from the command line: its interface, and the publication of a hand.

use crate::cli::out::notify;
use crate::cli::parse::number;
use crate::hand::kinematics::Side;
use crate::share::dds::SharedOnDds;
use crate::share::fleet::{self, FleetCard};
use crate::transport::Endpoint;
use crate::transport::dds::{DOMAIN_MAX, DdsNode, DdsPlace};

/// Default interface, which restricts DDS to this computer.
pub(crate) const LOOPBACK: &str = "127.0.0.1";

#[derive(Debug, clap::Args)]
pub(crate) struct DdsArgs {
    /// Join DDS as Unitree's own driver does, and ROS 2's ('handscope help dds'), at this network interface, by name or address;
    /// without one at 127.0.0.1, which keeps it to this computer
    #[arg(long, value_name = "INTERFACE", num_args = 0..=1, require_equals = true, default_missing_value = LOOPBACK)]
    dds: Option<String>,
    /// With --dds: the domain, 0 to 232; Unitree's simulation uses 1 [default: 0]
    #[arg(long, value_name = "NUMBER", requires = "dds", value_parser = domain)]
    domain: Option<u16>,
    /// With --dds: what other Handscopes' lists call the hand [default: its URL]
    #[arg(long, value_name = "NAME", requires = "dds")]
    name: Option<String>,
}

pub(crate) fn domain(text: &str) -> Result<u16, String> {
    number(text, 0..=DOMAIN_MAX, "a domain of 0 to 232")
}

impl DdsArgs {
    /// Reason why the arguments are invalid: clap does not require --dds next to an argument that excludes it.
    pub(crate) fn wrong(&self) -> Option<&'static str> {
        let is_named = self.domain.is_some() || self.name.is_some();
        (is_named && self.dds.is_none()).then_some("--domain and --name belong to --dds")
    }

    /// Published description of this hand: a right one without a gateway.
    pub(crate) fn card(&self, hand: &Endpoint) -> FleetCard {
        FleetCard {
            host: fleet::host(),
            name: self.name.clone().unwrap_or_else(|| hand.to_string()),
            side: Side::Right,
            at: None,
            first_may_move: false,
            follows: false,
        }
    }

    /// Joins DDS if requested; publishes nothing yet. `can` describes what others on the network could do.
    pub(crate) fn join(&self, can: &str) -> anyhow::Result<Option<DdsNode>> {
        let Some(interface) = &self.dds else {
            return Ok(None);
        };
        let place = DdsPlace {
            interface: interface.clone(),
            domain: self.domain.unwrap_or_default(),
        };
        let node = DdsNode::open(&place)?;
        let address = node.address();
        if !address.is_loopback() {
            notify(&format!(
                "warning: anyone in the network of {address} can {can}; --dds alone keeps to this computer"
            ));
        }
        Ok(Some(node))
    }
}

/// Line that reports readiness.
pub(crate) fn ready(shared: &SharedOnDds) -> String {
    format!("ready dds {}", shared.node.address())
}
