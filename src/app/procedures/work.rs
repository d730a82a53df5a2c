//! Cards at work: opening one, deciding on it, and what its task tells.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::notices::Notices;
use crate::app::procedures::procedure::{
    CalibrateProcedure, PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, ResetProcedure,
    WayTo,
};
use crate::app::procedures::reach::{Asking, AtCard};
use crate::app::procedures::running::{ProcedureTask, ProcedureWork};
use crate::app::running::Running;
use crate::app::settings::Settings;
use crate::params::backups::{Backups, folder_beside};
use crate::params::danger::worse;
use crate::params::place::{Place, Places, command, new_place};
use crate::params::rows::{ParamId, Value};
use crate::store::Job;
use crate::tasks::TaskError;
use crate::tasks::calibrate::{CalibrateStep, Checks, calibrate};
use crate::tasks::place::{PlaceChange, PlaceEnd, PlaceStep, change_place};
use crate::tasks::reset::{self, ResetStep, reset};
use crate::transport::Endpoint;
use crate::transport::endpoint::DEFAULT_TCP_PORT;
use crate::transport::endpoint::route::route;
use std::sync::Arc;
use tokio::sync::{mpsc, oneshot};

impl HandState {
    /// Opens the card of a change. Where the wire could not follow the hand, there is none.
    pub(crate) fn open_place_change(&mut self, id: ParamId, wanted: Value, env: &Env) {
        let (Some(before), Some(old)) = (self.held_now(id), self.endpoint.clone()) else {
            return;
        };
        let followed = new_place(&old, id, wanted);
        let is_bus = !matches!(old, Endpoint::Tcp { .. });
        let is_possible = followed.is_some() || !is_bus || id == ParamId::IpAddress;
        let is_new = command(id, wanted).is_some() && before != wanted;
        if self.procedure.is_some() || !is_possible || !is_new {
            return;
        }
        let is_followed = followed.is_some();
        let new = followed.unwrap_or_else(|| at_address(&old, wanted));
        self.procedure_work = ProcedureWork::default();
        let mut way = None;
        if let Value::Address(address) = wanted {
            way = Some(WayTo::Asked);
            let look = async move { route(&address.to_string(), DEFAULT_TCP_PORT).await.ok() };
            self.procedure_work.way = Some(Job::start(&env.runtime, &env.wake, look));
        }
        self.procedure = Some(Procedure::Place(PlaceProcedure {
            change: PlaceChange {
                id,
                before,
                wanted,
                places: Places { old, new },
                is_followed,
            },
            stage: ProcedureStage::Asking,
            backup: None,
            way,
            dangers: Vec::new(),
        }));
    }

    /// Opens the card of a return to the factory's parameters.
    pub(crate) fn open_reset(&mut self) {
        if let Some(hand) = self.endpoint.clone().filter(|_| self.procedure.is_none()) {
            self.procedure_work = ProcedureWork::default();
            self.procedure = Some(Procedure::Reset(ResetProcedure {
                places: reset::places(&hand),
                stage: ProcedureStage::Asking,
            }));
        }
    }

    /// Opens the card of a calibration.
    pub(crate) fn open_calibration(&mut self) {
        if let Some(hand) = self.endpoint.clone().filter(|_| self.procedure.is_none()) {
            self.procedure_work = ProcedureWork::default();
            self.procedure = Some(Procedure::Calibrate(CalibrateProcedure {
                hand,
                checks: Checks::default(),
                before: None,
                stage: ProcedureStage::Asking,
            }));
        }
    }

    /// The person goes elsewhere: the card closes, and nothing more is done for it.
    pub(crate) fn close_procedure(&mut self) {
        self.procedure = None;
        self.procedure_work = ProcedureWork::default();
    }

    /// What the hand holds in a row by which it is found: as read back last, else as it said when the link began.
    #[must_use]
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

    /// A person decided.
    pub(crate) fn procedure_action(&mut self, action: ProcedureAction, env: &Env) {
        match action {
            ProcedureAction::Begin => self.begin_procedure(env),
            ProcedureAction::Keep | ProcedureAction::GoBack => {
                if let Some(ProcedureTask::Place { keeps, .. }) = &mut self.procedure_work.task {
                    let keeps = keeps.take();
                    // A task that has decided by itself hears it no more.
                    let _heard = keeps.map(|keeps| keeps.send(action == ProcedureAction::Keep));
                }
            }
            ProcedureAction::Save | ProcedureAction::LeaveUnsaved => {
                if let Some(ProcedureTask::Place { saves, .. }) = &mut self.procedure_work.task {
                    let saves = saves.take();
                    let _heard = saves.map(|saves| saves.send(action == ProcedureAction::Save));
                }
            }
            ProcedureAction::Close if self.procedure.as_ref().is_some_and(Procedure::may_close) => {
                self.close_procedure();
            }
            ProcedureAction::Close => {}
        }
    }

    fn begin_procedure(&mut self, env: &Env) {
        let now = self.now;
        if self.rest_refusal().is_some() || self.procedure_work.task.is_some() {
            return;
        }
        let folder = env.settings_path.as_deref().map(folder_beside);
        let no_folder = || TaskError::NoBackup {
            message: "there is no folder for backups".into(),
        };
        let (wishes, wished) = mpsc::unbounded_channel();
        let mut reach = Asking {
            wishes,
            wake: Arc::clone(&env.wake),
        };
        let task = match &mut self.procedure {
            Some(Procedure::Place(card)) if card.stage == ProcedureStage::Asking => {
                let Some(folder) = folder else {
                    card.stage = ProcedureStage::Over(Err(no_folder()));
                    return;
                };
                let change = card.change.clone();
                let backups = Backups::new(&folder, &change.places.old);
                let (keeps, kept) = oneshot::channel();
                let (saves, saved) = oneshot::channel();
                let mut person = AtCard {
                    keeps: Some(kept),
                    saves: Some(saved),
                };
                card.stage = ProcedureStage::Doing(PlaceStep::BackingUp, now);
                let run = Running::start(env, |steps| async move {
                    let tell = |step| steps.tell(step);
                    change_place(&mut reach, &change, &backups, &mut person, tell).await
                });
                let (keeps, saves) = (Some(keeps), Some(saves));
                ProcedureTask::Place { run, keeps, saves }
            }
            Some(Procedure::Reset(card)) if card.stage == ProcedureStage::Asking => {
                let Some(folder) = folder else {
                    card.stage = ProcedureStage::Over(Err(no_folder()));
                    return;
                };
                let places = card.places.clone();
                let backups = Backups::new(&folder, &places.old);
                card.stage = ProcedureStage::Doing(ResetStep::BackingUp, now);
                ProcedureTask::Reset(Running::start(env, |steps| async move {
                    reset(&mut reach, &places, &backups, |step| steps.tell(step)).await
                }))
            }
            Some(Procedure::Calibrate(card)) if card.stage == ProcedureStage::Asking => {
                let ready = card.checks.is_ready(&self.sample, &self.link, now);
                let Some(open) = self.open.as_ref().filter(|_| ready) else {
                    return;
                };
                card.before = card.checks.mean();
                card.stage = ProcedureStage::Doing(CalibrateStep::Calibrating, now);
                let (link, clock) = (open.link.clone(), env.clock);
                ProcedureTask::Calibrate(Running::start(env, |steps| async move {
                    calibrate(&link, clock, |step| steps.tell(step)).await
                }))
            }
            _ => return,
        };
        self.procedure_work.task = Some(task);
        self.procedure_work.wishes = Some(wished);
    }

    /// Takes in what the card's task did, and goes where it wants to be.
    pub(crate) fn tick_procedure(
        &mut self,
        env: &Env,
        settings: &mut Settings,
        notices: &mut Notices,
    ) {
        let now = self.now;
        let mut work = std::mem::take(&mut self.procedure_work);
        self.take_way(&mut work);
        let over = self.take_procedure_task(&mut work, settings);
        let wish = work
            .wishes
            .as_mut()
            .and_then(|wishes| wishes.try_recv().ok());
        if let Some(wish) = wish {
            if self.endpoint.as_ref() != Some(&wish.place) {
                self.go(Some(wish.place), env, notices);
            }
            if let Some(open) = &self.open {
                // The task may be over already.
                let _told = wish.opened.send(open.link.clone());
            }
        }
        if over {
            if !matches!(work.task, Some(ProcedureTask::Calibrate(_))) {
                // Whatever was read before it may hold no more, and is read anew by whoever looks.
                self.params.link_lost(now);
            }
            work.task = None;
            self.params.forget_files();
            self.go_home(env, notices);
        }
        self.procedure_work = work;
    }

    /// True once it is over.
    fn take_procedure_task(&mut self, work: &mut ProcedureWork, settings: &mut Settings) -> bool {
        if let Some(Procedure::Calibrate(card)) = &mut self.procedure
            && card.stage == ProcedureStage::Asking
        {
            card.checks.watch(&self.sample);
        }
        match (&mut work.task, &mut self.procedure) {
            (Some(ProcedureTask::Place { run, .. }), Some(Procedure::Place(card))) => {
                let (steps, end) = run.news();
                for (at, step) in steps {
                    match step {
                        PlaceStep::BackedUp(path, params) => {
                            card.dangers = worse(&self.params.before_changes(&params), &params);
                            card.backup = Some(path);
                        }
                        step => {
                            if matches!(step, PlaceStep::Writing(_)) {
                                self.params.outdated(at);
                            }
                            if let PlaceStep::Offering(place) = step {
                                // What was kept is remembered.
                                let there = card.change.places.endpoint(place);
                                settings.remember(there);
                            }
                            card.stage = ProcedureStage::Doing(step, at);
                        }
                    }
                }
                let Some(end) = end else { return false };
                if let Ok(report) = &end
                    && let Some(place) = report.end.place()
                    && matches!(report.end, PlaceEnd::Kept { .. })
                {
                    let there = card.change.places.endpoint(place);
                    settings.remember(there);
                    self.params.stage(card.change.id, None);
                }
                card.stage = ProcedureStage::Over(end);
                true
            }
            (Some(ProcedureTask::Reset(run)), Some(Procedure::Reset(card))) => {
                let (steps, end) = run.news();
                for (at, step) in steps {
                    if step == ResetStep::Sending {
                        self.params.outdated(at);
                    }
                    card.stage = ProcedureStage::Doing(step, at);
                }
                let Some(end) = end else { return false };
                card.stage = ProcedureStage::Over(end);
                true
            }
            (Some(ProcedureTask::Calibrate(run)), Some(Procedure::Calibrate(card))) => {
                let (steps, end) = run.news();
                for (at, step) in steps {
                    card.stage = ProcedureStage::Doing(step, at);
                }
                let Some(end) = end else { return false };
                card.stage = ProcedureStage::Over(end);
                true
            }
            _ => false,
        }
    }

    fn take_way(&mut self, work: &mut ProcedureWork) {
        if let Some(found) = Job::take_from(&mut work.way)
            && let Some(Procedure::Place(card)) = &mut self.procedure
        {
            card.way = Some(found.map_or(WayTo::None, WayTo::Known));
        }
    }

    /// To the hand, not to another one that was looked for on the way.
    fn go_home(&mut self, env: &Env, notices: &mut Notices) {
        let Some(Procedure::Place(card)) = &self.procedure else {
            return;
        };
        let home: Option<Place> = card.place();
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
