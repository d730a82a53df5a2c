//! Operation of cards: opening, decisions, and the steps of the task.

use crate::app::connection::Connection;
use crate::app::env::Ctx;
use crate::app::env::running::Running;
use crate::app::params::{ParamsState, rest_refusal};
use crate::app::procedures::procedure::{
    CalibrateProcedure, LinkRequest, LinkRequester, PlaceProcedure, Procedure, ProcedureAction,
    ProcedureStage, Procedures, ResetProcedure,
};
use crate::app::settings::Settings;
use crate::hand::HandSample;
use crate::hand::overshoot::OvershootMap;
use crate::link::LinkStatus;
use crate::params::backups::{Backups, folder_beside};
use crate::params::danger::worse;
use crate::params::place::{PlacePair, new_place, setting};
use crate::params::rows::{ParamId, Value};
use crate::tasks::calibrate::{Checks, calibrate};
use crate::tasks::place::{PlaceChange, PlaceEnd, change_place};
use crate::tasks::reset::{self, reset};
use crate::tasks::{BackupError, Question, TaskError, TaskStep};
use crate::transport::Endpoint;
use std::sync::Arc;
use tokio::sync::mpsc;

impl Procedures {
    /// Opens the card of an address change. None is opened if the wire could not follow the hand.
    pub(crate) fn open_place_change(
        &mut self,
        id: ParamId,
        wanted: Value,
        connection: &Connection,
        params: &ParamsState,
    ) {
        let before = held_now(id, &connection.status, params);
        let (Some(before), Some(old)) = (before, connection.endpoint.clone()) else {
            return;
        };
        let followed = new_place(&old, id, wanted);
        let is_bus = !matches!(old, Endpoint::Tcp { .. });
        let is_possible = followed.is_some() || !is_bus || id == ParamId::IpAddress;
        let is_new = setting(id, wanted).is_some() && before != wanted;
        if self.card.is_some() || !is_possible || !is_new {
            return;
        }
        let is_followed = followed.is_some();
        let new = followed.unwrap_or_else(|| at_address(&old, wanted));
        self.card = Some(Procedure::Place(PlaceProcedure {
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
        }));
    }

    /// Opens the card of a reset to factory parameters.
    pub(crate) fn open_reset(&mut self, connection: &Connection) {
        if let Some(hand) = connection.endpoint.as_ref().filter(|_| self.card.is_none()) {
            self.card = Some(Procedure::Reset(ResetProcedure {
                places: reset::places(hand),
                stage: ProcedureStage::Asking,
                run: None,
            }));
        }
    }

    /// Opens the card of a calibration.
    pub(crate) fn open_calibration(&mut self, connection: &Connection) {
        if connection.endpoint.is_some() && self.card.is_none() {
            self.card = Some(Procedure::Calibrate(CalibrateProcedure {
                checks: Checks::default(),
                before: None,
                stage: ProcedureStage::Asking,
                run: None,
            }));
        }
    }

    /// Closes the card and aborts its task when the user leaves.
    pub(crate) fn close(&mut self) {
        *self = Self::default();
    }

    /// Handles the user's decision on the card.
    pub(crate) fn act(
        &mut self,
        action: ProcedureAction,
        connection: &Connection,
        sample: &HandSample,
        ctx: &Ctx<'_>,
    ) {
        match (action, &self.card) {
            (ProcedureAction::Begin, _) => self.begin(connection, sample, ctx),
            (ProcedureAction::Close, Some(card)) if card.may_close() => self.close(),
            (ProcedureAction::Close, _) => {}
        }
    }

    /// Answers a question of the card's task; true if it had asked it.
    pub(crate) fn answer(&mut self, question: &Question, yes: bool) -> bool {
        // The other procedures ask nothing.
        let Some(Procedure::Place(card)) = &mut self.card else {
            return false;
        };
        let run = card.run.as_mut();
        run.is_some_and(|run| run.answer(question, yes))
    }

    fn begin(&mut self, connection: &Connection, sample: &HandSample, ctx: &Ctx<'_>) {
        if rest_refusal(&connection.status).is_some() {
            return;
        }
        let (now, env) = (ctx.now, ctx.env);
        let folder = env.settings_path.as_deref().map(folder_beside);
        let backups = |hand: &Endpoint| match &folder {
            Some(folder) => Ok(Backups::new(folder, hand)),
            None => Err(TaskError::NoBackup(BackupError::NoFolder)),
        };
        // A task requests one address at a time and waits for its link.
        let (requests, requested) = mpsc::channel(1);
        let mut reach = LinkRequester {
            requests,
            wake: Arc::clone(&env.wake),
        };
        match &mut self.card {
            Some(Procedure::Place(card)) if card.stage == ProcedureStage::Asking => {
                let change = card.change.clone();
                let backups = backups(&change.places.old);
                card.stage = ProcedureStage::Doing(TaskStep::BackingUp, now);
                card.run = Some(Running::start(env, |steps| async move {
                    let report = |step| steps.send(step);
                    change_place(&mut reach, &change, &backups?, &mut &steps, report).await
                }));
            }
            Some(Procedure::Reset(card)) if card.stage == ProcedureStage::Asking => {
                let places = card.places.clone();
                let backups = backups(&places.old);
                card.stage = ProcedureStage::Doing(TaskStep::BackingUp, now);
                card.run = Some(Running::start(env, |steps| async move {
                    reset(&mut reach, &places, &backups?, |step| steps.send(step)).await
                }));
            }
            Some(Procedure::Calibrate(card)) if card.stage == ProcedureStage::Asking => {
                let ready = card.checks.is_ready(sample, &connection.status, now);
                let Some(link) = connection.link().filter(|_| ready) else {
                    return;
                };
                card.before = card.checks.mean();
                card.stage = ProcedureStage::Doing(TaskStep::Calibrating, now);
                let (link, clock) = (link.clone(), env.clock);
                card.run = Some(Running::start(env, |steps| async move {
                    calibrate(&link, clock, |step| steps.send(step)).await
                }));
            }
            _ => return,
        }
        self.requested = Some(requested);
    }

    /// Link request of the card's task, if pending.
    pub(crate) fn take_link_request(&mut self) -> Option<LinkRequest> {
        self.requested.as_mut()?.try_recv().ok()
    }

    /// Updates the preconditions while a calibration card waits for its start.
    pub(crate) fn watch(&mut self, sample: &HandSample) {
        if let Some(Procedure::Calibrate(card)) = &mut self.card
            && card.stage == ProcedureStage::Asking
        {
            card.checks.watch(sample);
        }
    }

    /// Applies the steps of the card's task. Returns true once it has ended.
    pub(crate) fn apply_news(
        &mut self,
        params: &mut ParamsState,
        overshoot: &OvershootMap,
        settings: &mut Settings,
    ) -> bool {
        match &mut self.card {
            None => false,
            Some(Procedure::Place(card)) => {
                let is_over = card.stage.apply_news(&mut card.run, |step, at| {
                    match step {
                        TaskStep::BackedUp(path, held) => {
                            let before = params.before_changes(held);
                            card.dangers = worse(&before, held, overshoot);
                            card.backup = Some(path.clone());
                        }
                        TaskStep::Writing(_) => params.lost_at = Some(at),
                        TaskStep::Kept(place) => {
                            settings.remember(card.change.places.endpoint(*place));
                        }
                        _ => {}
                    }
                    !matches!(step, TaskStep::BackedUp(..))
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
            Some(Procedure::Reset(card)) => card.stage.apply_news(&mut card.run, |step, at| {
                if *step == TaskStep::Resetting {
                    params.lost_at = Some(at);
                }
                true
            }),
            Some(Procedure::Calibrate(card)) => card.stage.apply_news(&mut card.run, |_, _| true),
        }
    }

    /// Address of the hand after an address change has ended; not one that was only tried on the way.
    pub(crate) fn home(&self) -> Option<Endpoint> {
        let Some(Procedure::Place(card)) = &self.card else {
            return None;
        };
        Some(card.change.places.endpoint(card.place()?).clone())
    }
}

/// Current value of an address row: as last read back, else as reported when the link was opened.
pub fn held_now(id: ParamId, link: &LinkStatus, params: &ParamsState) -> Option<Value> {
    let reported = match id {
        ParamId::HandId => link.quirks.hand_id,
        ParamId::ReduRatio => link.quirks.baud_code,
        _ => None,
    };
    let reported = reported.map(|byte| Value::Number(i32::from(byte)));
    let read = params.live(id).map(|(value, _)| value);
    read.or(reported)
}

/// Endpoint of the hand at another network address; unchanged for other wires.
fn at_address(hand: &Endpoint, wanted: Value) -> Endpoint {
    let mut place = hand.clone();
    if let (Endpoint::Tcp { host, .. }, Value::Address(address)) = (&mut place, wanted) {
        *host = address.to_string();
    }
    place
}
