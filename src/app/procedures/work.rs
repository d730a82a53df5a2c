//! Cards at work: opening one, deciding on it, and what its task tells.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::notices::Notices;
use crate::app::procedures::procedure::{
    CalibrateProcedure, PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, ResetProcedure,
};
use crate::app::procedures::reach::{Asking, decided};
use crate::app::running::Running;
use crate::app::settings::Settings;
use crate::params::backups::{Backups, folder_beside};
use crate::params::danger::worse;
use crate::params::place::{PlacePair, WhichPlace, new_place, setting};
use crate::params::rows::{ParamId, Value};
use crate::tasks::TaskError;
use crate::tasks::calibrate::{CalibrateStep, Checks, calibrate};
use crate::tasks::place::{Decisions, PlaceChange, PlaceEnd, PlaceStep, change_place};
use crate::tasks::reset::{self, ResetStep, reset};
use crate::transport::Endpoint;
use std::sync::Arc;
use tokio::sync::{mpsc, oneshot};

impl HandState {
    /// Opens the card of a change. Where the wire could not follow the hand, there is none.
    pub(crate) fn open_place_change(&mut self, id: ParamId, wanted: Value) {
        let (Some(before), Some(old)) = (self.held_now(id), self.endpoint.clone()) else {
            return;
        };
        let followed = new_place(&old, id, wanted);
        let is_bus = !matches!(old, Endpoint::Tcp { .. });
        let is_possible = followed.is_some() || !is_bus || id == ParamId::IpAddress;
        let is_new = setting(id, wanted).is_some() && before != wanted;
        if self.procedure.is_some() || !is_possible || !is_new {
            return;
        }
        let is_followed = followed.is_some();
        let new = followed.unwrap_or_else(|| at_address(&old, wanted));
        self.procedure = Some(Procedure::Place(PlaceProcedure {
            change: PlaceChange {
                id,
                before,
                wanted,
                places: PlacePair { old, new },
                is_followed,
            },
            stage: ProcedureStage::Asking,
            backup: None,
            dangers: Vec::new(),
            run: None,
            keeps: None,
            saves: None,
        }));
    }

    /// Opens the card of a return to the factory's parameters.
    pub(crate) fn open_reset(&mut self) {
        if let Some(hand) = self.endpoint.as_ref().filter(|_| self.procedure.is_none()) {
            self.procedure = Some(Procedure::Reset(ResetProcedure {
                places: reset::places(hand),
                stage: ProcedureStage::Asking,
                run: None,
            }));
        }
    }

    /// Opens the card of a calibration.
    pub(crate) fn open_calibration(&mut self) {
        if self.endpoint.is_some() && self.procedure.is_none() {
            self.procedure = Some(Procedure::Calibrate(CalibrateProcedure {
                checks: Checks::default(),
                before: None,
                stage: ProcedureStage::Asking,
                run: None,
            }));
        }
    }

    /// The person goes elsewhere: the card closes, and nothing more is done for it.
    pub(crate) fn close_procedure(&mut self) {
        (self.procedure, self.requested) = (None, None);
    }

    /// What the hand holds in a row by which it is found: as read back last, else as it said when the link began.
    pub fn held_now(&self, id: ParamId) -> Option<Value> {
        let told = match id {
            ParamId::HandId => self.link.quirks.hand_id,
            ParamId::ReduRatio => self.link.quirks.baud_code,
            _ => None,
        };
        let told = told.map(|byte| Value::Number(i32::from(byte)));
        let read = self.params.live(id).map(|(value, _)| value);
        read.or(told)
    }

    /// Carries out what a person decided on the card.
    pub(crate) fn procedure_action(&mut self, action: ProcedureAction, env: &Env) {
        let Some(procedure) = &mut self.procedure else {
            return;
        };
        match (action, procedure) {
            (ProcedureAction::Begin, _) => self.begin_procedure(env),
            (ProcedureAction::Close, own) if own.may_close() => self.close_procedure(),
            (ProcedureAction::Close, _) => {}
            (action, Procedure::Place(card)) => {
                let (answer, agrees) = match action {
                    ProcedureAction::Begin | ProcedureAction::Close => return,
                    ProcedureAction::Keep => (card.keeps.take(), true),
                    ProcedureAction::GoBack => (card.keeps.take(), false),
                    ProcedureAction::Save => (card.saves.take(), true),
                    ProcedureAction::LeaveUnsaved => (card.saves.take(), false),
                };
                // A task that is over has no ears.
                let _heard = answer.map(|answer| answer.send(agrees));
            }
            (_, Procedure::Reset(_) | Procedure::Calibrate(_)) => {}
        }
    }

    fn begin_procedure(&mut self, env: &Env) {
        if self.rest_refusal().is_some() {
            return;
        }
        let now = self.now;
        let folder = env.settings_path.as_deref().map(folder_beside);
        let backups = |hand: &Endpoint| match &folder {
            Some(folder) => Ok(Backups::new(folder, hand)),
            None => Err(TaskError::NoBackup {
                message: "there is no folder for backups".into(),
            }),
        };
        let (requests, requested) = mpsc::unbounded_channel();
        let mut reach = Asking {
            requests,
            wake: Arc::clone(&env.wake),
        };
        match &mut self.procedure {
            Some(Procedure::Place(card)) if card.stage == ProcedureStage::Asking => {
                let change = card.change.clone();
                let backups = backups(&change.places.old);
                let (keeps, kept) = oneshot::channel();
                let (saves, saved) = oneshot::channel();
                (card.keeps, card.saves) = (Some(keeps), Some(saves));
                let decisions = Decisions {
                    keeps: decided(kept),
                    saves: decided(saved),
                };
                card.stage = ProcedureStage::Doing(PlaceStep::BackingUp, now);
                card.run = Some(Running::start(env, |steps| async move {
                    let tell = |step| steps.tell(step);
                    change_place(&mut reach, &change, &backups?, decisions, tell).await
                }));
            }
            Some(Procedure::Reset(card)) if card.stage == ProcedureStage::Asking => {
                let places = card.places.clone();
                let backups = backups(&places.old);
                card.stage = ProcedureStage::Doing(ResetStep::BackingUp, now);
                card.run = Some(Running::start(env, |steps| async move {
                    reset(&mut reach, &places, &backups?, |step| steps.tell(step)).await
                }));
            }
            Some(Procedure::Calibrate(card)) if card.stage == ProcedureStage::Asking => {
                let ready = card.checks.is_ready(&self.sample, &self.link, now);
                let Some(open) = self.open.as_ref().filter(|_| ready) else {
                    return;
                };
                card.before = card.checks.mean();
                card.stage = ProcedureStage::Doing(CalibrateStep::Calibrating, now);
                let (link, clock) = (open.link.clone(), env.clock);
                card.run = Some(Running::start(env, |steps| async move {
                    calibrate(&link, clock, |step| steps.tell(step)).await
                }));
            }
            _ => return,
        }
        self.requested = Some(requested);
    }

    /// Takes in what the task under the card told, and goes where it has to look.
    pub(crate) fn tick_procedure(
        &mut self,
        env: &Env,
        settings: &mut Settings,
        notices: &mut Notices,
    ) {
        let is_over = self.take_procedure_news(settings);
        let requested = self.requested.as_mut();
        if let Some(request) = requested.and_then(|all| all.try_recv().ok()) {
            if self.endpoint.as_ref() != Some(&request.place) {
                self.go(Some(request.place), env, notices);
            }
            if let Some(open) = &self.open {
                let _told = request.opened.send(open.link.clone());
            }
        }
        if is_over {
            if !matches!(self.procedure, Some(Procedure::Calibrate(_))) {
                self.params.link_lost(self.now);
            }
            self.params.files = None;
            self.go_home(env, notices);
        }
    }

    /// True once the task is over.
    fn take_procedure_news(&mut self, settings: &mut Settings) -> bool {
        let params = &mut self.params;
        match &mut self.procedure {
            None => false,
            Some(Procedure::Place(card)) => {
                let is_over = card.stage.take_news(&mut card.run, |step, at| {
                    match step {
                        PlaceStep::BackedUp(path, held) => {
                            card.dangers = worse(&params.before_changes(held), held);
                            card.backup = Some(path.clone());
                        }
                        PlaceStep::Writing(_) => params.lost_at = Some(at),
                        PlaceStep::Offering(place) => {
                            settings.remember(card.change.places.endpoint(*place));
                        }
                        _ => {}
                    }
                    !matches!(step, PlaceStep::BackedUp(..))
                });
                if is_over
                    && let Some(Ok(report)) = card.stage.end()
                    && let PlaceEnd::Kept { at, .. } = &report.end
                {
                    settings.remember(card.change.places.endpoint(*at));
                    params.stage(card.change.id, None);
                }
                is_over
            }
            Some(Procedure::Reset(card)) => card.stage.take_news(&mut card.run, |step, at| {
                if *step == ResetStep::Sending {
                    params.lost_at = Some(at);
                }
                true
            }),
            Some(Procedure::Calibrate(card)) => {
                if card.stage == ProcedureStage::Asking {
                    card.checks.watch(&self.sample);
                }
                card.stage.take_news(&mut card.run, |_, _| true)
            }
        }
    }

    /// To the hand, not to another one that was looked for on the way.
    fn go_home(&mut self, env: &Env, notices: &mut Notices) {
        let Some(Procedure::Place(card)) = &self.procedure else {
            return;
        };
        let home: Option<WhichPlace> = card.place();
        let Some(there) = home.map(|place| card.change.places.endpoint(place).clone()) else {
            return;
        };
        if self.endpoint.as_ref() != Some(&there) {
            self.go(Some(there), env, notices);
        }
    }
}

/// The hand at another address on the network; as it is where its wire is none.
fn at_address(hand: &Endpoint, wanted: Value) -> Endpoint {
    let mut place = hand.clone();
    if let (Endpoint::Tcp { host, .. }, Value::Address(address)) = (&mut place, wanted) {
        *host = address.to_string();
    }
    place
}
