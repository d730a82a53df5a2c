//! Hands shared by other Handscopes: their display, and the listener behind it. Never connects by itself.

use crate::app::env::Env;
use crate::share::fleet::{FleetHand, FleetList};
use crate::transport::dds::{DdsError, DdsNode, DdsPlace};
use std::net::Ipv4Addr;
use std::sync::Arc;

/// State of the fleet view.
#[derive(Debug, Default)]
pub struct FleetState {
    /// Shared hands, sorted by computer and name.
    pub hands: Vec<FleetHand>,
    /// Reason why listening failed.
    pub refused: Option<DdsError>,
    list: Option<FleetList>,
}

impl FleetState {
    /// Address of the interface that is listened on, if any.
    pub fn interface(&self) -> Option<Ipv4Addr> {
        self.list.as_ref().map(FleetList::interface)
    }

    /// Listens on this interface; `None` ends listening.
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

    /// Applies fleet updates.
    pub(crate) fn drain(&mut self) {
        if let Some(list) = &mut self.list
            && let Some(hands) = list.news()
        {
            self.hands = hands;
        }
    }
}
