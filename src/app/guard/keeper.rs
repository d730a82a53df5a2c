//! Carries out what is done under a card: backup first, then one errand after the other as the flow's rules say. Draws nothing and
//! decides nothing about the hand.

use crate::app::calibration::Calibration;
use crate::app::desk::Desk;
use crate::app::guard::change::{Change, End, Follow, Next, Stage};
use crate::app::guard::errand::{Answer, Errand, Poll};
use crate::app::guard::files::GuardFiles;
use crate::app::guard::guarded::{
    Doing, Flow, GuardStep, Guarded, WayTo, command, held_now, not_now,
};
use crate::app::guard::reset::{FactoryReset, ResetStage, factory_place};
use crate::app::params::danger::worse;
use crate::app::params::guard::{Place, new_place};
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::{Params, SPANS, decoded, span_of};
use crate::hand::{Moment, Span};
use crate::link::{Outcome, Request, RequestError, Reset, SaveDoubt, Saved, Wake};
use crate::transport::Endpoint;
use crate::transport::route::{Route, route};
use std::path::Path;

use tokio::sync::oneshot;

/// One card at a time, and the work behind it.
pub(crate) struct Guarding {
    files: GuardFiles,
    runtime: tokio::runtime::Handle,
    wake: Wake,
    errand: Option<Errand>,
    way: Option<oneshot::Receiver<Option<Route>>>,
    /// What the hand held before.
    params: Params,
    /// Groups that are still to be read.
    unread: Vec<Span>,
    /// The SAVE under way was noted in its file.
    is_noted: bool,
}

impl Guarding {
    /// Keeps backups beside the settings; without settings nothing that needs one begins.
    pub(crate) fn new(
        settings: Option<&Path>,
        runtime: tokio::runtime::Handle,
        wake: Wake,
    ) -> Self {
        Self {
            files: GuardFiles::new(settings, runtime.clone(), Wake::clone(&wake)),
            runtime,
            wake,
            errand: None,
            way: None,
            params: Params::default(),
            unread: Vec::new(),
            is_noted: false,
        }
    }

    /// Opens the card of a change. Where the wire could not follow the hand, there is none.
    pub(crate) fn change(&mut self, desk: &mut Desk, id: ParamId, wanted: Value) {
        let Some(before) = held_now(&desk.state, id) else {
            return;
        };
        let Some(old) = desk.state.endpoint.clone() else {
            return;
        };
        let new = new_place(&old, id, wanted);
        let is_bus = !matches!(old, Endpoint::Tcp { .. });
        let is_possible = new.is_some() || !is_bus || id == ParamId::IpAddress;
        if !is_possible || command(id, wanted).is_none() || before == wanted {
            return;
        }
        let follow = match new {
            Some(_) => Follow::Wire,
            None => Follow::No,
        };
        let new = new.unwrap_or_else(|| at_address(&old, wanted));
        let flow = Flow::Change(Change::new(id, before, wanted, follow));
        self.open(desk, flow, old, new);
        if let (Value::Address(address), Some(guarded)) = (wanted, desk.state.guard.as_mut()) {
            guarded.way = Some(WayTo::Asked);
            self.way = Some(self.look_up(address.to_string()));
        }
    }

    /// Opens the card of a return to the factory's parameters.
    pub(crate) fn reset(&mut self, desk: &mut Desk) {
        if let Some(old) = desk.state.endpoint.clone() {
            let flow = Flow::Reset(FactoryReset::new(&old));
            let new = factory_place(&old);
            self.open(desk, flow, old, new);
        }
    }

    /// Opens the card of a calibration.
    pub(crate) fn calibrate(&mut self, desk: &mut Desk) {
        if let Some(old) = desk.state.endpoint.clone() {
            let flow = Flow::Calibration(Calibration::default());
            self.open(desk, flow, old.clone(), old);
        }
    }

    fn open(&mut self, desk: &mut Desk, flow: Flow, old: Endpoint, new: Endpoint) {
        if desk.state.guard.is_some() {
            return;
        }
        self.clear();
        desk.state.guard = Some(Guarded {
            flow,
            doing: Doing::Asking,
            old,
            new,
            backup: None,
            way: None,
            dangers: Vec::new(),
        });
    }

    fn clear(&mut self) {
        self.errand = None;
        self.files.forget();
        self.way = None;
        self.params = Params::default();
        self.unread = SPANS.to_vec();
        self.is_noted = false;
    }

    /// The person goes elsewhere: the card closes, and nothing more is asked for it.
    pub(crate) fn leave(&mut self, desk: &mut Desk) {
        self.clear();
        desk.state.guard = None;
    }

    /// A person decided.
    pub(crate) fn step(&mut self, desk: &mut Desk, step: GuardStep, now: Moment) {
        let may_begin = not_now(&desk.state).is_none();
        let state = &mut desk.state;
        let Some(guarded) = &mut state.guard else {
            return;
        };
        let may_close = may_close(guarded);
        match (step, &mut guarded.flow) {
            (GuardStep::Begin, Flow::Calibration(run)) => {
                let ready = run.is_ready(&state.sample, &state.link, now);
                if guarded.doing == Doing::Asking && may_begin && ready {
                    run.begin(now);
                    guarded.doing = Doing::Running;
                }
            }
            (GuardStep::Begin, _) if guarded.doing == Doing::Asking && may_begin => {
                guarded.doing = Doing::BackingUp;
            }
            (GuardStep::Keep, Flow::Change(change)) => {
                change.keep();
                if matches!(change.stage(), Stage::Offering(_)) {
                    state.settings.endpoint = state.endpoint.as_ref().map(ToString::to_string);
                }
                if let Stage::Offering(Place::New) = change.stage() {
                    let (old, new) = (guarded.old.clone(), guarded.new.clone());
                    self.files.adopt(&old, &new);
                }
            }
            (GuardStep::GoBack, Flow::Change(change)) => change.go_back(),
            (GuardStep::Save, Flow::Change(change)) => change.save(),
            (GuardStep::LeaveUnsaved, Flow::Change(change)) => change.leave_unsaved(),
            (GuardStep::Close, _) if may_close => self.leave(desk),
            _ => {}
        }
    }

    /// Goes on; gives where the link has to go.
    pub(crate) fn tick(&mut self, desk: &mut Desk, now: Moment) -> Option<Endpoint> {
        let mut guarded = desk.state.guard.take()?;
        self.take_way(&mut guarded);
        let go = match guarded.doing {
            Doing::Asking => {
                if let Flow::Calibration(run) = &mut guarded.flow {
                    run.watch(&desk.state.sample);
                }
                None
            }
            Doing::BackingUp => self.back_up(&mut guarded, desk, now),
            Doing::Running => self.go_on(&mut guarded, desk, now),
            Doing::NoBackup { .. } => None,
        };
        desk.state.guard = Some(guarded);
        go
    }

    /// Reads one group after the other, then writes the file.
    fn back_up(&mut self, guarded: &mut Guarded, desk: &mut Desk, now: Moment) -> Option<Endpoint> {
        if self.files.is_busy() {
            let filed = self.files.done()?;
            desk.state.device.forget_record();
            match filed {
                Ok(path) => {
                    guarded.backup = path;
                    guarded.doing = Doing::Running;
                    match &mut guarded.flow {
                        Flow::Change(change) => change.begin(),
                        Flow::Reset(reset) => reset.begin(),
                        Flow::Calibration(_) => {}
                    }
                }
                Err(why) => guarded.doing = Doing::NoBackup { why },
            }
            return None;
        }
        let Some(span) = self.unread.first().copied() else {
            let saved = desk.state.device.known.saved.as_ref();
            let saved = saved.map(|file| file.params.clone()).unwrap_or_default();
            guarded.dangers = worse(&saved, &self.params);
            self.begin_backup(guarded);
            return None;
        };
        match self.errand(guarded.old.clone(), Request::Read(span), desk, now) {
            Poll::Go(place) => return Some(place),
            Poll::Wait => {}
            Poll::Done(Answer::Ended(Ok(Outcome::Memory { span, bytes }))) => {
                self.params.take(span, &bytes);
                self.unread.remove(0);
            }
            Poll::Done(answer) => {
                let why = match answer {
                    Answer::Ended(Err(error)) => error.to_string(),
                    _ => RequestError::NotConnected.to_string(),
                };
                guarded.doing = Doing::NoBackup { why };
            }
        }
        None
    }

    fn begin_backup(&mut self, guarded: &mut Guarded) {
        let why = match guarded.flow {
            Flow::Reset(_) => "before reset",
            _ => "before apply",
        };
        let params = self.params.clone();
        let begun = self.files.begin(&guarded.old, move |record, since| {
            record.back_up(&params, why, since).map(Some)
        });
        if !begun {
            let why = "there is no folder for backups".into();
            guarded.doing = Doing::NoBackup { why };
        }
    }

    fn go_on(&mut self, guarded: &mut Guarded, desk: &mut Desk, now: Moment) -> Option<Endpoint> {
        // A file that is being written is waited for; what it says of itself is told by the file.
        if self.files.is_busy() {
            let _filed = self.files.done()?;
            desk.state.device.forget_record();
        }
        match &mut guarded.flow {
            Flow::Change(change) => {
                change.tick(now);
                let next = change.next();
                self.change_on(guarded, next, desk, now)
            }
            Flow::Reset(_) => self.reset_on(guarded, desk, now),
            Flow::Calibration(run) => {
                run.tick(&desk.state.sample, now);
                if !run.is_sending() {
                    return None;
                }
                let answer = self.errand(guarded.old.clone(), Request::Calibrate, desk, now);
                if let (Poll::Done(answer), Flow::Calibration(run)) = (answer, &mut guarded.flow) {
                    run.ended(
                        match answer {
                            Answer::Ended(Ok(Outcome::Calibrated(end))) => Some(end),
                            _ => None,
                        },
                        now,
                    );
                }
                None
            }
        }
    }

    fn change_on(
        &mut self,
        guarded: &mut Guarded,
        next: Next,
        desk: &mut Desk,
        now: Moment,
    ) -> Option<Endpoint> {
        let Flow::Change(change) = &guarded.flow else {
            return None;
        };
        let id = change.id;
        let (place, request) = match next {
            Next::Person => return None,
            Next::Nothing => return home(guarded, change, desk),
            Next::Look(place) => (place, Request::Read(span_of(id))),
            Next::Write(place, value) => (place, Request::Command(command(id, value)?)),
            Next::Save(place) => (place, Request::Save),
        };
        let at = guarded.endpoint(place).clone();
        if request == Request::Save && !std::mem::replace(&mut self.is_noted, true) {
            let mut params = self.params.clone();
            params.put(id, change.wanted);
            self.files.begin(&at, move |record, since| {
                record.attempt(&params, since).map(|()| None)
            });
            return None;
        }
        let answer = match self.errand(at.clone(), request, desk, now) {
            Poll::Go(place) => return Some(place),
            Poll::Wait => return None,
            Poll::Done(answer) => answer,
        };
        let Flow::Change(change) = &mut guarded.flow else {
            return None;
        };
        match (request, answer) {
            (Request::Read(_), answer) => {
                change.heard(held(id, answer), now);
                // SAVE may have sent it to its new place: that is what is remembered.
                if let Stage::Over(End::Kept { at, .. }) = *change.stage() {
                    let there = guarded.endpoint(at).to_string();
                    desk.state.settings.endpoint = Some(there);
                }
            }
            (Request::Save, Answer::Ended(end)) => {
                let saved = saved_by(end);
                change.saved(saved.clone());
                self.files.note_saved(guarded, place, saved);
            }
            (Request::Command(_), Answer::Ended(Err(RequestError::Refused { reason, .. }))) => {
                change.wrote(Some(reason));
            }
            (_, Answer::Unreached | Answer::Ended(Err(RequestError::Full { .. }))) => {
                change.unreached();
            }
            // A missing answer proves nothing.
            (_, Answer::Ended(_)) => change.wrote(None),
        }
        None
    }

    fn reset_on(
        &mut self,
        guarded: &mut Guarded,
        desk: &mut Desk,
        now: Moment,
    ) -> Option<Endpoint> {
        let Flow::Reset(reset) = &guarded.flow else {
            return None;
        };
        let (at, request) = match reset.stage() {
            ResetStage::Asking | ResetStage::Over(_) => return None,
            ResetStage::Sending => (guarded.old.clone(), Request::Reset),
            ResetStage::Finding(place) => {
                let unread = *self.unread.first()?;
                (guarded.endpoint(*place).clone(), Request::Read(unread))
            }
        };
        let answer = match self.errand(at, request, desk, now) {
            Poll::Go(place) => return Some(place),
            Poll::Wait => return None,
            Poll::Done(answer) => answer,
        };
        let Flow::Reset(reset) = &mut guarded.flow else {
            return None;
        };
        match (request, answer) {
            (Request::Reset, Answer::Ended(Ok(Outcome::Reset(end)))) => {
                let is_out = matches!(end, Reset::Acknowledged | Reset::Unanswered);
                reset.sent(end);
                self.begin_reading();
                if is_out {
                    let old = guarded.old.clone();
                    self.files
                        .begin(&old, |record, _| record.forget_saved().map(|()| None));
                }
            }
            (Request::Reset, Answer::Unreached) => reset.cancel(),
            // It may have gone out.
            (Request::Reset, Answer::Ended(_)) => reset.sent(Reset::Unanswered),
            (_, Answer::Ended(Ok(Outcome::Memory { span, bytes }))) => {
                self.params.take(span, &bytes);
                self.unread.remove(0);
                if self.unread.is_empty() {
                    reset.heard(Some(&self.params));
                    let (old, found) = (guarded.old.clone(), desk.state.endpoint.clone());
                    if let Some(found) = found {
                        self.files.adopt(&old, &found);
                    }
                }
            }
            _ => {
                reset.heard(None);
                self.begin_reading();
            }
        }
        None
    }

    fn begin_reading(&mut self) {
        self.params = Params::default();
        self.unread = SPANS.to_vec();
    }

    fn errand(&mut self, at: Endpoint, request: Request, desk: &mut Desk, now: Moment) -> Poll {
        let mut errand = self
            .errand
            .take()
            .unwrap_or_else(|| Errand::new(at, request));
        let poll = errand.poll(desk, now);
        if !matches!(poll, Poll::Done(_)) {
            self.errand = Some(errand);
        }
        poll
    }

    fn look_up(&self, host: String) -> oneshot::Receiver<Option<Route>> {
        let (done, way) = oneshot::channel();
        let wake = Wake::clone(&self.wake);
        self.runtime.spawn(async move {
            let found = route(&host, crate::transport::endpoint::DEFAULT_TCP_PORT).await;
            let _told = done.send(found.ok());
            wake();
        });
        way
    }

    fn take_way(&mut self, guarded: &mut Guarded) {
        let Some(way) = &mut self.way else { return };
        guarded.way = Some(match way.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return,
            Err(oneshot::error::TryRecvError::Closed) | Ok(None) => WayTo::None,
            Ok(Some(route)) => WayTo::Known(route),
        });
        self.way = None;
    }
}

/// What came of a SAVE; without a word of it nobody knows.
fn saved_by(end: Result<Outcome, RequestError>) -> Saved {
    match end {
        Ok(Outcome::Saved(saved)) => saved,
        _ => Saved::Unknown {
            why: SaveDoubt::LinkLost,
        },
    }
}

/// Where the link has to go once a change is over: to the hand, not to another one that was looked for on the way.
fn home(guarded: &Guarded, change: &Change, desk: &Desk) -> Option<Endpoint> {
    let Stage::Over(end) = change.stage() else {
        return None;
    };
    let there = guarded.endpoint(end.place()?);
    (desk.state.endpoint.as_ref() != Some(there)).then(|| there.clone())
}

/// What a hand that was looked for holds; nothing if nobody answered.
fn held(id: ParamId, answer: Answer) -> Option<Value> {
    match answer {
        Answer::Ended(Ok(Outcome::Memory { span, bytes })) => decoded(id, span, &bytes),
        _ => None,
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

/// A card closes where nothing is under way and nothing waits for a decision.
fn may_close(guarded: &Guarded) -> bool {
    match (&guarded.doing, &guarded.flow) {
        (Doing::Asking | Doing::NoBackup { .. }, _) => true,
        (Doing::BackingUp, _) => false,
        (Doing::Running, Flow::Change(change)) => matches!(change.stage(), Stage::Over(_)),
        (Doing::Running, Flow::Reset(reset)) => matches!(reset.stage(), ResetStage::Over(_)),
        (Doing::Running, Flow::Calibration(run)) => run.is_over(),
    }
}
