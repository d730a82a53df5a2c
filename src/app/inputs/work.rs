//! Opens inputs, lets them move the hand, and takes in what they did.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::inputs::{FollowRun, HandInputs, InputAction};
use crate::app::notices::{NoticeKind, Notices};
use crate::app::running::Running;
use crate::app::settings::Settings;
use crate::hand::{Angle, Dof, PerDof};
use crate::inputs::Offer;
use crate::inputs::follow::HOLDS_AFTER;
use crate::inputs::pad::PadInput;
use crate::inputs::pad::device::{FOLDER, PadReader};
use crate::inputs::pad::source::{PadSource, PadSourceConfig};
use crate::inputs::stream::{StreamConfig, StreamPlace, StreamSource};
use crate::link::{ArmRequest, Owner};
use crate::record::{ArmRefusal, Disarmed};
use crate::share::gateway::{Gateway, GatewayConfig, SILENCE, Writers};
use crate::tasks::follow::{FollowEnd, FollowStart, FollowTerms, follow};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use tokio::sync::{mpsc, watch};

impl HandState {
    /// Does what a person asked for.
    pub(crate) fn input_action(&mut self, action: InputAction, settings: &mut Settings, env: &Env) {
        match action {
            InputAction::Listen(place) => self.listen(place, env),
            InputAction::ReadPad(on) => self.read_pad(on, settings, env),
            InputAction::Share(place) => self.share(place, env),
            InputAction::GrantStream => self.grant_stream(settings, env),
            InputAction::GrantPad => self.grant_pad(settings, env),
            InputAction::GrantClient(client) => {
                if let Some(gateway) = self.inputs.gateway.as_ref().filter(|_| self.may_grant()) {
                    gateway.grant(client);
                }
            }
            InputAction::TakeBack => self.take_back(),
            InputAction::Limit(limits) => {
                settings.follow = limits.within();
            }
            InputAction::Map(map) => {
                settings.pad_map = Some(crate::inputs::pad::file::write(&map));
                // What is held has to be pressed anew.
                if self.inputs.pad.is_some() {
                    self.read_pad(true, settings, env);
                }
            }
        }
    }

    fn listen(&mut self, place: Option<StreamPlace>, env: &Env) {
        self.inputs.refused = None;
        self.inputs.stream = None;
        self.inputs.stream_at = None;
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
            Ok(source) => {
                self.inputs.stream_at = Some(source.local());
                self.inputs.stream = Some(source);
            }
            Err(error) => self.inputs.refused = Some(error.to_string()),
        }
    }

    fn read_pad(&mut self, on: bool, settings: &Settings, env: &Env) {
        self.inputs.refused = None;
        self.inputs.pad = None;
        self.inputs.pad_view = None;
        let Some(open) = self.open.as_ref().filter(|_| on) else {
            return;
        };
        let clock = env.clock;
        let reader = PadReader::start(PathBuf::from(FOLDER), Arc::new(move || clock.now()));
        match reader {
            Ok(reader) => {
                let _entered = env.runtime.enter();
                let link = open.link.clone();
                let poses = crate::poses::starter::starter().poses.iter();
                let mut input = PadInput::new(settings.pad_map());
                input.set_poses(
                    poses
                        .map(|pose| (pose.name.clone(), pose.targets()))
                        .collect(),
                );
                let source = PadSource::open(PadSourceConfig {
                    reader,
                    input,
                    records: open.link.records(),
                    clock,
                    stop: Arc::new(move || link.stop()),
                    wake: Arc::clone(&env.wake),
                });
                self.inputs.pad_view = Some(source.view());
                self.inputs.pad = Some(source);
            }
            Err(error) => self.inputs.refused = Some(error.to_string()),
        }
    }

    fn share(&mut self, place: Option<SocketAddr>, env: &Env) {
        self.inputs.refused = None;
        self.inputs.gateway = None;
        self.inputs.gateway_at = None;
        let Some((address, open)) = place.zip(self.open.as_ref()) else {
            return;
        };
        let config = GatewayConfig {
            address,
            writers: Writers::Granted,
            silence: SILENCE,
        };
        match Gateway::open(open.link.clone(), config, &env.runtime) {
            Ok(gateway) => {
                self.inputs.gateway_at = Some(gateway.address());
                self.inputs.gateway = Some(gateway);
            }
            Err(error) => self.inputs.refused = Some(error.to_string()),
        }
    }

    /// Nobody is given the right to move a hand that is being left, under a card, or in a series.
    fn may_grant(&self) -> bool {
        self.leaving.is_none() && self.procedure.is_none() && !self.runs_series()
    }

    fn grant_stream(&mut self, settings: &Settings, env: &Env) {
        let Some(source) = &self.inputs.stream else {
            return;
        };
        let Some((sender, last)) = self.inputs.stream_view.intake.sender else {
            return;
        };
        if self.now.since(last) < HOLDS_AFTER {
            let offers = source.follow();
            self.follow_source(Owner::Stream(sender), offers, settings, env);
        }
    }

    fn grant_pad(&mut self, settings: &Settings, env: &Env) {
        let Some(source) = &self.inputs.pad else {
            return;
        };
        if source.view().name.is_some() {
            let offers = source.follow();
            self.follow_source(Owner::Gamepad, offers, settings, env);
        }
    }

    /// Lets this source move the hand; what moved it before does not any more.
    fn follow_source(
        &mut self,
        owner: Owner,
        offers: mpsc::Receiver<Offer>,
        settings: &Settings,
        env: &Env,
    ) {
        let refusal = self.arm_refusal();
        if !self.may_grant() || refusal.is_some_and(|refusal| refusal != ArmRefusal::LetGo) {
            return;
        }
        if let Some(run) = &mut self.sequence {
            run.leave();
        }
        let Some(open) = &self.open else { return };
        let lease = open.link.grant(owner);
        let (terms, watched) = watch::channel(self.follow_terms(settings));
        let start = FollowStart {
            lease,
            terms: watched,
            arm: ArmRequest {
                speed: self.joints.map(|joint| joint.speed),
                force: self.joints.map(|joint| joint.force),
            },
            seen: self.sample,
            clock: env.clock,
        };
        let link = open.link.clone();
        let task = Running::start(env, |views| async move {
            follow(&link, start, offers, |view| views.tell(view)).await
        });
        self.inputs.follow = Some(FollowRun {
            owner,
            view: None,
            terms,
            task,
        });
    }

    /// A click here ends whoever moves the hand from outside.
    fn take_back(&mut self) {
        let Some(open) = &self.open else { return };
        if let Some(holder) = open.link.status().holder
            && holder.owner.is_outside()
        {
            // One that ended meanwhile has stopped already.
            let _done = open.link.give_back(holder.lease, Disarmed::Person);
        }
    }

    fn follow_terms(&self, settings: &Settings) -> FollowTerms {
        FollowTerms {
            limits: settings.follow,
            locked: self.joints.map(|joint| joint.locked),
            hold: self.hold_to_run(),
        }
    }

    /// Takes in what inputs and clients did.
    pub(crate) fn tick_inputs(&mut self, notices: &mut Notices, settings: &Settings) {
        let terms = self.follow_terms(settings);
        let HandInputs {
            stream,
            stream_view,
            pad,
            pad_view,
            gateway,
            clients,
            follow,
            ..
        } = &mut self.inputs;
        if let Some(source) = stream {
            *stream_view = source.view();
        }
        *pad_view = pad.as_ref().map(PadSource::view);
        *clients = gateway.as_ref().map(Gateway::clients).unwrap_or_default();
        let Some(run) = follow else { return };
        let (views, end) = run.task.news();
        let owner = run.owner;
        run.terms
            .send_if_modified(|told| std::mem::replace(told, terms) != terms);
        if let Some((_, view)) = views.into_iter().last() {
            run.view = Some(view);
            self.show_sent(view.sent);
        }
        if let Some(end) = end {
            self.inputs.follow = None;
            if matches!(end, FollowEnd::Silent | FollowEnd::Gone) {
                notices.push(self.now, NoticeKind::SourceSilent(owner));
            }
            self.follow();
        }
    }

    /// The sliders stand where the source sent the joints.
    fn show_sent(&mut self, sent: PerDof<Option<Angle>>) {
        for dof in Dof::ALL {
            if let Some(to) = sent[dof] {
                self.joints[dof].target = Some(to);
                self.steered[dof] = true;
                self.commanded = true;
            }
        }
    }

    /// Who moves the hand from outside this window, if somebody may.
    #[must_use]
    pub fn outside_owner(&self) -> Option<Owner> {
        let holder = self.link.holder.filter(|_| self.link.state.is_live())?;
        holder.owner.is_outside().then_some(holder.owner)
    }
}
