//! The hands that other Handscopes share: what the window shows of them, and the listening behind it. Never connects by itself.

use crate::app::env::Env;
use crate::share::fleet::{FleetHand, FleetList};
use crate::transport::dds::{DdsError, DdsNode, DdsPlace};
use std::net::Ipv4Addr;
use std::sync::Arc;

/// What the window shows of the fleet.
#[derive(Debug, Default)]
pub struct FleetState {
    /// The hands that are there, by computer and name.
    pub hands: Vec<FleetHand>,
    /// Why nobody listens, although the user wanted it.
    pub refused: Option<DdsError>,
    list: Option<FleetList>,
}

impl FleetState {
    /// Where it is listened, if it is.
    pub fn interface(&self) -> Option<Ipv4Addr> {
        self.list.as_ref().map(FleetList::interface)
    }

    /// Listens at this interface, or no more.
    pub(crate) fn listen(&mut self, interface: Option<String>, env: &Env) {
        *self = Self::default();
        let Some(interface) = interface else { return };
        let _entered = env.runtime.enter();
        let place = DdsPlace {
            interface,
            domain: 0,
        };
        let opened = DdsNode::open(&place)
            .map(|node| FleetList::open(&node, env.clock, Arc::clone(&env.wake)));
        match opened {
            Ok(list) => self.list = Some(list),
            Err(error) => self.refused = Some(error),
        }
    }

    /// Takes in who came, changed and went.
    pub(crate) fn drain(&mut self) {
        if let Some(list) = &mut self.list
            && let Some(hands) = list.news()
        {
            self.hands = hands;
        }
    }
}
