//! Opens inputs and outlets of a connection.

use crate::app::connection::Connection;
use crate::app::env::Env;
use crate::app::inputs::{HandInputs, HandMirror, InputError, InputKind};
use crate::app::settings::Settings;
use crate::app::slot::SlotId;
use crate::hand::kinematics::Side;
use crate::inputs::mirror::{MirrorScale, MirrorView};
use crate::inputs::offer::SourceSite;
use crate::inputs::pad::PadInput;
use crate::inputs::pad::source::{PadSource, PadSourceConfig};
use crate::inputs::stream::{StreamPlace, StreamSource};
use crate::link::{ArmRequest, LinkHandle};
use crate::motion::source::{JoinedDds, Source, SourceKind};
use crate::record::file::Opening;
use crate::share::fleet::{FleetCard, OtherFollowers};
use crate::share::foxglove::{FoxgloveConfig, FoxgloveServer};
use crate::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use crate::store::calendar::since_1970;
use crate::transport::dds::{DdsNode, DdsPlace};
use std::net::SocketAddr;
use std::sync::Arc;

impl HandInputs {
    /// Opens a source in place of one of the same kind, or notes why it was not opened.
    fn open(
        &mut self,
        kind: SourceKind,
        opened: impl FnOnce() -> Option<Result<Source, InputError>>,
    ) {
        self.refused = None;
        self.sources.remove(&kind);
        match opened() {
            Some(Ok(source)) => drop(self.sources.insert(kind, source)),
            Some(Err(why)) => self.refused = Some((InputKind::Source(kind), why)),
            None => {}
        }
    }

    /// Listens for lines at this place; `None` ends that. `allowed` limits the holds that they request.
    pub(crate) fn listen(
        &mut self,
        place: Option<StreamPlace>,
        connection: &Connection,
        (side, allowed): (Side, ArmRequest),
        env: &Env,
    ) {
        self.open(SourceKind::Stream, || {
            let (place, link) = place.zip(connection.link())?;
            let site = SourceSite::of(link, side, Arc::clone(&env.wake));
            let source = StreamSource::open(place, site, allowed, &env.runtime);
            Some(source.map(Source::Stream).map_err(InputError::from))
        });
    }

    /// Starts or ends reading the gamepad.
    pub(crate) fn read_pad(
        &mut self,
        on: bool,
        connection: &Connection,
        (settings, side): (&Settings, Side),
        env: &Env,
    ) {
        self.open(SourceKind::Pad, || {
            let link = connection.link().filter(|_| on)?;
            let _entered = env.runtime.enter();
            let clock = env.clock;
            let reader = (env.pads)(Arc::new(move || clock.now()));
            let source = reader.map(|reader| {
                PadSource::open(PadSourceConfig {
                    reader,
                    // Its poses are updated in each frame.
                    input: PadInput::new(settings.pad_map()),
                    records: link.records(),
                    site: SourceSite::of(link, side, Arc::clone(&env.wake)),
                })
            });
            Some(source.map(Source::Pad).map_err(InputError::from))
        });
    }

    /// Joins DDS at this place; `None` leaves it. `allowed` limits the requests of messages.
    pub(crate) fn join_dds(
        &mut self,
        place: Option<(DdsPlace, FleetCard)>,
        allowed: ArmRequest,
        connection: &Connection,
        env: &Env,
    ) {
        self.open(SourceKind::Dds, || {
            let ((place, card), link) = place.zip(connection.link())?;
            let _entered = env.runtime.enter();
            let site = SourceSite::of(link, card.side, Arc::clone(&env.wake));
            let joined = DdsNode::open(&place).map(|node| {
                let others = OtherFollowers::open(&node, card.side, env.clock);
                JoinedDds::open((node, others), card, allowed, site, link)
            });
            Some(joined.map(Source::Dds).map_err(InputError::from))
        });
    }

    /// Watches the hand of this slot and link; `None` ends that. Must be called within a tokio runtime.
    pub(crate) fn watch_hand(&mut self, leader: Option<(SlotId, &LinkHandle, MirrorScale)>) {
        self.mirror = leader.map(|(leader, _, scale)| HandMirror {
            leader,
            scale,
            view: MirrorView::default(),
        });
        self.open(SourceKind::Mirror, || {
            let (_, link, scale) = leader?;
            Some(Ok(Source::mirror(link, scale)))
        });
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
}
