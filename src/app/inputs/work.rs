//! Opens inputs and outlets, and takes in what they did.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::inputs::{InputAction, InputKind, JoinedDds, OpenRefusal};
use crate::app::notices::{NoticeKind, Notices};
use crate::app::poses::PoseState;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::inputs::dds::ctrl;
use crate::inputs::dds::source::{DdsSource, DdsSourceConfig};
use crate::inputs::pad::device::{FOLDER, PadReader};
use crate::inputs::pad::source::{PadSource, PadSourceConfig};
use crate::inputs::pad::{PadInput, file};
use crate::inputs::stream::{StreamConfig, StreamPlace, StreamSource};
use crate::record::Disarmed;
use crate::record::file::Opening;
use crate::share::dds::SharedOnDds;
use crate::share::fleet::{self, FleetCard, OtherFollowers};
use crate::share::foxglove::{FoxgloveConfig, FoxgloveServer};
use crate::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use crate::store::calendar::since_1970;
use crate::tasks::follow::FollowEnd;
use crate::transport::dds::{DdsNode, DdsPlace};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

impl State {
    /// Does what a person asked for at the shown hand.
    pub(crate) fn input_action(&mut self, action: InputAction, env: &Env) {
        let Self {
            hands, settings, ..
        } = self;
        let hand = hands.shown_mut();
        match action {
            InputAction::Listen(place) => hand.listen(place, env),
            InputAction::ReadPad(on) => hand.read_pad(on, settings, env),
            InputAction::Share(place) => hand.share(place, settings, env),
            InputAction::Show(place) => hand.show_viewers(place, env),
            InputAction::JoinDds(interface) => hand.join_dds(interface, settings, env),
            InputAction::Mirror(wanted) => self.watch_hand(wanted, env),
            InputAction::GrantMirror => self.start_mirror(env),
            InputAction::GrantStream => hand.grant_stream(settings, env),
            InputAction::GrantDds => hand.grant_dds(settings, env),
            InputAction::GrantPad => hand.grant_pad(settings, env),
            InputAction::GrantClient(client) => {
                if let Some(gateway) = hand.inputs.gateway.as_ref().filter(|_| hand.may_grant()) {
                    gateway.grant(client);
                }
            }
            InputAction::TakeBack => hand.end_outside(Disarmed::Person),
            InputAction::Limit(limits) => settings.follow = limits.within(),
            InputAction::Map(map) => {
                settings.pad_map = Some(file::write(&map));
                // What is held has to be pressed anew.
                if hand.inputs.pad.is_some() {
                    hand.read_pad(true, settings, env);
                }
            }
        }
    }
}

impl HandState {
    fn listen(&mut self, place: Option<StreamPlace>, env: &Env) {
        self.inputs.refused = None;
        self.inputs.stream = None;
        let Some((place, open)) = place.zip(self.open.as_ref()) else {
            return;
        };
        let link = open.link.clone();
        let config = StreamConfig {
            place,
            side: self.side,
            clock: env.clock,
            stop: Arc::new(move || link.stop()),
            wake: Arc::clone(&env.wake),
        };
        match StreamSource::open(config, &env.runtime) {
            Ok(source) => self.inputs.stream = Some(source),
            Err(error) => self.inputs.refused = Some((InputKind::Stream, error.into())),
        }
    }

    fn read_pad(&mut self, on: bool, settings: &Settings, env: &Env) {
        self.inputs.refused = None;
        self.inputs.pad = None;
        let Some(open) = self.open.as_ref().filter(|_| on) else {
            return;
        };
        let clock = env.clock;
        let reader = PadReader::start(PathBuf::from(FOLDER), Arc::new(move || clock.now()));
        match reader {
            Ok(reader) => {
                let _entered = env.runtime.enter();
                let link = open.link.clone();
                let source = PadSource::open(PadSourceConfig {
                    reader,
                    // Its poses are told with each frame.
                    input: PadInput::new(settings.pad_map()),
                    records: open.link.records(),
                    clock,
                    stop: Arc::new(move || link.stop()),
                    wake: Arc::clone(&env.wake),
                });
                self.inputs.pad = Some(source);
            }
            Err(error) => self.inputs.refused = Some((InputKind::Pad, OpenRefusal::Pad(error))),
        }
    }

    fn share(&mut self, place: Option<SocketAddr>, settings: &Settings, env: &Env) {
        self.inputs.refused = None;
        self.inputs.gateway = None;
        let Some((address, open)) = place.zip(self.open.as_ref()) else {
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
        match Gateway::open(open.link.clone(), config, &env.runtime) {
            Ok(gateway) => self.inputs.gateway = Some(gateway),
            Err(error) => self.inputs.refused = Some((InputKind::Gateway, error.into())),
        }
    }

    fn show_viewers(&mut self, place: Option<SocketAddr>, env: &Env) {
        self.inputs.refused = None;
        self.inputs.foxglove = None;
        let Some((address, open)) = place.zip(self.open.as_ref()) else {
            return;
        };
        let moments = (open.link.clock().now(), since_1970());
        let config = FoxgloveConfig {
            address,
            opening: Opening::begin(self.name(), moments, self.side),
        };
        match FoxgloveServer::open(config, &env.runtime) {
            Ok(mut server) => {
                server.show(&open.link);
                self.inputs.foxglove = Some(server);
            }
            Err(error) => self.inputs.refused = Some((InputKind::Viewers, error.into())),
        }
    }

    fn join_dds(&mut self, interface: Option<String>, settings: &Settings, env: &Env) {
        self.inputs.refused = None;
        self.inputs.dds = None;
        let Some((interface, open)) = interface.zip(self.open.as_ref()) else {
            return;
        };
        let _entered = env.runtime.enter();
        let place = DdsPlace {
            interface,
            domain: 0,
        };
        let config = DdsSourceConfig {
            // What a person set here is the most that a message may ask for.
            allowed: self.arm_request(),
            clock: env.clock,
            wake: Arc::clone(&env.wake),
        };
        let card = self.fleet_card(settings);
        let joined = DdsNode::open(&place).and_then(|node| {
            let messages = node.reader(&ctrl::topic(self.side), ctrl::KEPT)?;
            Ok(JoinedDds {
                others: OtherFollowers::open(&node, self.side, env.clock)?,
                source: DdsSource::open(config, messages),
                shared: SharedOnDds::open(node, &open.link, card)?,
            })
        });
        match joined {
            Ok(joined) => self.inputs.dds = Some(joined),
            Err(error) => self.inputs.refused = Some((InputKind::Dds, OpenRefusal::Dds(error))),
        }
    }

    /// What others are told of this hand.
    fn fleet_card(&self, settings: &Settings) -> FleetCard {
        FleetCard {
            host: fleet::host(),
            name: self.label.name.to_string(),
            side: self.side,
            at: self.inputs.gateway.as_ref().map(Gateway::address),
            first_may_move: settings.first_client_moves,
            follows: self.inputs.follows_dds(),
        }
    }

    /// Takes in what inputs and clients did.
    pub(crate) fn tick_inputs(
        &mut self,
        notices: &mut Notices,
        settings: &Settings,
        poses: &PoseState,
    ) {
        let terms = self.follow_terms(settings);
        if let Some(pad) = &self.inputs.pad {
            pad.set_poses(poses.on_pad(&settings.pad_map(), &settings.hidden_poses));
        }
        self.inputs.look();
        if let Some(joined) = &self.inputs.dds {
            joined.shared.say(self.fleet_card(settings));
        }
        if self.inputs.follows_dds() && self.inputs.other_follows_dds() {
            // Each hears of the other, and both stop.
            self.end_outside(Disarmed::Stop);
        }
        let Some(run) = &mut self.inputs.follow else {
            return;
        };
        let (views, end) = run.task.news();
        let owner = run.owner;
        run.terms
            .send_if_modified(|told| std::mem::replace(told, terms) != terms);
        if let Some((_, view)) = views.into_iter().last() {
            run.view = Some(view);
            self.show_sent(view.sent);
        }
        if let Some(outcome) = end {
            self.inputs.follow = None;
            if outcome.leader_stopped {
                notices.push(self.now, NoticeKind::LeaderStopped);
            }
            if matches!(outcome.end, FollowEnd::Silent | FollowEnd::Gone) {
                notices.push(self.now, NoticeKind::SourceSilent(owner));
            }
            self.follow();
        }
    }
}
