//! Opens inputs and outlets of a connection.

use crate::app::env::Env;
use crate::app::hand::Connection;
use crate::app::inputs::{HandInputs, InputKind, JoinedDds, OpenRefusal};
use crate::app::settings::Settings;
use crate::hand::kinematics::Side;
use crate::inputs::dds::source::{DdsCommands, DdsSource, DdsSourceConfig};
use crate::inputs::pad::PadInput;
use crate::inputs::pad::source::{PadSource, PadSourceConfig};
use crate::inputs::stream::{StreamConfig, StreamPlace, StreamSource};
use crate::link::ArmRequest;
use crate::record::file::Opening;
use crate::share::dds::SharedOnDds;
use crate::share::fleet::{FleetCard, OtherFollowers};
use crate::share::foxglove::{FoxgloveConfig, FoxgloveServer};
use crate::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use crate::store::calendar::since_1970;
use crate::transport::dds::{DdsNode, DdsPlace};
use std::net::SocketAddr;
use std::sync::Arc;

impl HandInputs {
    pub(crate) fn listen(
        &mut self,
        place: Option<StreamPlace>,
        connection: &Connection,
        side: Side,
        env: &Env,
    ) {
        self.refused = None;
        self.stream = None;
        let Some((place, link)) = place.zip(connection.link().cloned()) else {
            return;
        };
        let config = StreamConfig {
            place,
            side,
            clock: env.clock,
            stop: Arc::new(move || drop(link.stop())),
            wake: Arc::clone(&env.wake),
        };
        match StreamSource::open(config, &env.runtime) {
            Ok(source) => self.stream = Some(source),
            Err(error) => self.refused = Some((InputKind::Stream, error.into())),
        }
    }

    pub(crate) fn read_pad(
        &mut self,
        on: bool,
        connection: &Connection,
        settings: &Settings,
        env: &Env,
    ) {
        self.refused = None;
        self.pad = None;
        let Some(link) = connection.link().filter(|_| on).cloned() else {
            return;
        };
        let clock = env.clock;
        match (env.pads)(Arc::new(move || clock.now())) {
            Ok(reader) => {
                let _entered = env.runtime.enter();
                let source = PadSource::open(PadSourceConfig {
                    reader,
                    // Its poses are updated in each frame.
                    input: PadInput::new(settings.pad_map()),
                    records: link.records(),
                    clock,
                    stop: Arc::new(move || drop(link.stop())),
                    wake: Arc::clone(&env.wake),
                });
                self.pad = Some(source);
            }
            Err(error) => self.refused = Some((InputKind::Pad, OpenRefusal::Pad(error))),
        }
    }

    pub(crate) fn share(
        &mut self,
        place: Option<SocketAddr>,
        connection: &Connection,
        settings: &Settings,
        env: &Env,
    ) {
        self.refused = None;
        self.gateway = None;
        let Some((address, link)) = place.zip(connection.link()) else {
            return;
        };
        let config = GatewayConfig {
            address,
            writers: if settings.first_client_moves {
                Writers::First
            } else {
                Writers::Granted
            },
            silence: SILENCE,
        };
        match Gateway::open(link.clone(), config, &env.runtime) {
            Ok(gateway) => self.gateway = Some(gateway),
            Err(error) => self.refused = Some((InputKind::Gateway, error.into())),
        }
    }

    pub(crate) fn show_viewers(
        &mut self,
        place: Option<SocketAddr>,
        connection: &Connection,
        side: Side,
        env: &Env,
    ) {
        self.refused = None;
        self.foxglove = None;
        let Some((address, link)) = place.zip(connection.link()) else {
            return;
        };
        let moments = (link.clock().now(), since_1970());
        let config = FoxgloveConfig {
            address,
            opening: Opening::begin(connection.name(), moments, side),
        };
        match FoxgloveServer::open(config, &env.runtime) {
            Ok(mut server) => {
                server.show(link);
                self.foxglove = Some(server);
            }
            Err(error) => self.refused = Some((InputKind::Viewers, error.into())),
        }
    }

    /// Joins DDS at this place; `None` leaves it. `allowed` limits the requests of messages.
    pub(crate) fn join_dds(
        &mut self,
        place: Option<(DdsPlace, FleetCard)>,
        allowed: ArmRequest,
        connection: &Connection,
        env: &Env,
    ) {
        self.refused = None;
        self.dds = None;
        let Some(((place, card), link)) = place.zip(connection.link()) else {
            return;
        };
        let _entered = env.runtime.enter();
        let stops = link.clone();
        let side = card.side;
        let config = DdsSourceConfig {
            side,
            allowed,
            clock: env.clock,
            stop: Arc::new(move || drop(stops.stop())),
            wake: Arc::clone(&env.wake),
        };
        let joined = DdsNode::open(&place).map(|node| JoinedDds {
            others: OtherFollowers::open(&node, side, env.clock),
            source: DdsSource::open(config, DdsCommands::of(&node, side)),
            shared: SharedOnDds::open(node, link, card),
        });
        match joined {
            Ok(joined) => self.dds = Some(joined),
            Err(error) => self.refused = Some((InputKind::Dds, OpenRefusal::Dds(error))),
        }
    }
}
