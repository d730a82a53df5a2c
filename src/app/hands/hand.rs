//! One hand, composed: the parts own their state and know nothing of each other; what takes several of them is here.

use crate::app::checkup::HandCheckup;
use crate::app::ctx::Ctx;
use crate::app::env::Env;
use crate::app::env::running::Running;
use crate::app::hand::connection::Leaving;
use crate::app::hand::controls::{HeldOtherwise, JointChange};
use crate::app::hand::status_news::StatusReport;
use crate::app::hand::{Activity, Connection, Controls, HoldKey, RecordedMover, SequenceRun};
use crate::app::hands::free_force::HandFreeForce;
use crate::app::hands::running::{AskedSeries, MotionRun, RunningMotion};
use crate::app::inputs::HandInputs;
use crate::app::notices::{HandNotices, NoticeKind, RequestKind};
use crate::app::params::ParamsState;
use crate::app::procedures::Procedures;
use crate::app::readings::{Measurements, Readings};
use crate::app::recordings::recording::HandRecording;
use crate::app::settings::Settings;
use crate::app::slot::{HandLabel, SlotId, place_name};
use crate::app::trials::{HandOvershoot, StartRefusal};
use crate::hand::kinematics::Side;
use crate::hand::{
    Angle, ArmEpoch, Dof, Gesture, GestureRoute, HandCommand, Moment, PerDof, Setpoints,
};
use crate::history::MarkKind;
use crate::link::session::motion::arm_refusal;
use crate::link::{LeaseRefusal, LinkStatus, Owner, RequestError};
use crate::motion::drive::Armed;
use crate::motion::play::{self, PlayCommand, PlayStart};
use crate::poses::player::{PlayMode, PlayPlan, PlayView};
use crate::record::{ArmRefusal, LinkState, Record};
use crate::transport::Endpoint;
use crate::trials::TrialPlan;
use std::time::Duration;
use tokio::sync::mpsc;

/// A hand that was told to hold gets this long to show that it rests, before its link is closed anyway: the time after
/// which the link itself gives the alarm, and a little.
pub(crate) const REST_TIMEOUT: Duration = Duration::from_millis(600);
/// Commands to a sequence that may wait: the user cannot press faster than a task takes them.
const COMMANDS_MAX: usize = 16;

/// Everything about one hand.
#[derive(Debug, Default)]
pub struct Hand {
    /// Which of several, and what it is called.
    pub label: HandLabel,
    /// Left or right, as the user says: no register does.
    pub side: Side,
    pub connection: Connection,
    pub readings: Readings,
    pub measured: Measurements,
    pub controls: Controls,
    /// The program that moves the hand.
    pub running: RunningMotion,
    /// What trials measured of it.
    pub overshoot: HandOvershoot,
    /// What its joints read when they touch nothing.
    pub(crate) free_force: HandFreeForce,
    /// The last check-up.
    pub checkup: HandCheckup,
    /// The open procedure: change of id or address, reset, calibration.
    pub procedures: Procedures,
    /// What besides the window may move the hand, and who uses it.
    pub inputs: HandInputs,
    /// What the hand keeps, and what of it is to be changed.
    pub params: ParamsState,
    /// The recording being made of it.
    pub recording: Option<HandRecording>,
    /// Who moves it, of a hand that is replayed.
    pub(crate) recorded: Option<RecordedMover>,
    /// The hand is being left: it was told to hold.
    pub(crate) leaving: Option<Leaving>,
    /// Its slot goes as soon as it is left.
    pub(crate) is_removed: bool,
}

impl Hand {
    /// What goes on, and so who may move it.
    pub fn activity(&self) -> Activity {
        if self.leaving.is_some() {
            Activity::Leaving
        } else if self.procedures.card.is_some() {
            Activity::Procedure
        } else if self.runs_series() {
            Activity::Series
        } else if let Some(owner) = self.connection.outside_owner() {
            Activity::Following(owner)
        } else if self.running.sequence().is_some_and(SequenceRun::is_running) {
            Activity::Playing
        } else {
            Activity::Idle
        }
    }

    /// Why a plan of trials cannot begin now, if it makes sense at all; without one, a check-up, which moves every joint.
    pub fn series_refusal(&self, plan: Option<&TrialPlan>) -> Option<StartRefusal> {
        if self.runs_series() {
            return Some(StartRefusal::Runs);
        }
        let locked = self.controls.locked();
        let locked = match plan {
            Some(plan) => plan.locked(&locked),
            None => Dof::ALL.into_iter().find(|dof| locked[*dof]),
        };
        let is_armed = self.connection.is_armed() && self.connection.status.armed.is_some();
        let not_armed = (!is_armed).then_some(StartRefusal::NotArmed);
        locked.map(StartRefusal::Locked).or(not_armed)
    }

    /// True while a series of trials or a check-up runs.
    pub const fn runs_series(&self) -> bool {
        self.running.runs_series()
    }

    /// Slot of the hand that leads this one.
    pub fn leader(&self) -> Option<SlotId> {
        let mirror = self.inputs.mirror.as_ref()?;
        let follows = self.running.follows(Owner::Mirror);
        follows.then_some(mirror.leader)
    }

    /// What a live hand holds of a joint, where that is not what was set.
    pub fn held_otherwise(&self, dof: Dof) -> HeldOtherwise {
        if !self.connection.is_live() {
            return HeldOtherwise::default();
        }
        let held = self.controls.held_otherwise(dof, &self.readings.sample);
        HeldOtherwise {
            // Where another than this window sends it is old by the time it is read back.
            target: held
                .target
                .filter(|_| self.connection.outside_owner().is_none()),
            ..held
        }
    }

    /// The pose that the hand has, if all six angles are known, live and fresh.
    pub fn pose_now(&self, now: Moment) -> Option<PerDof<Angle>> {
        self.readings.pose_now(self.connection.is_live(), now)
    }

    /// Takes its name and side from what is kept of it.
    pub(crate) fn apply_settings(&mut self, settings: &Settings) {
        let endpoint = self.connection.endpoint.as_ref();
        self.side = settings.side_of(endpoint);
        let name = endpoint.map(|endpoint| match settings.hand_name(endpoint) {
            Some(name) => name.to_owned(),
            None => place_name(endpoint),
        });
        let name = name.unwrap_or_default();
        if *self.label.name != *name {
            self.label.name = name.into();
        }
    }

    /// Leaves the hand. One that may be moving is told to hold first and gets time to.
    pub(crate) fn leave(&mut self, to: Option<Endpoint>, ctx: &mut Ctx<'_>) {
        if let Some(leaving) = &mut self.leaving {
            leaving.to = to;
        } else if self.connection.may_move() {
            self.stop(ctx);
            let told = ctx.now;
            self.leaving = Some(Leaving { to, told });
        } else {
            self.go(to, ctx);
        }
    }

    /// Goes on once a hand that was told to hold rests, or had its time.
    pub(crate) fn go_on_leaving(&mut self, ctx: &mut Ctx<'_>) {
        let is_due = |leaving: &mut Leaving| {
            let told = leaving.told;
            ctx.now.since(told) >= REST_TIMEOUT || self.connection.is_held(told)
        };
        if let Some(leaving) = self.leaving.take_if(is_due) {
            self.go(leaving.to, ctx);
        }
    }

    /// Opens another hand, or none, at once. Nothing of the old one is taken for the new one's; what is done under a card goes along.
    pub(crate) fn go(&mut self, to: Option<Endpoint>, ctx: &mut Ctx<'_>) {
        self.measured.leave(&self.connection.name(), ctx.now);
        // The old link goes first: a serial port has room for one.
        self.connection = Connection::none(ctx.now);
        // An id that was changed under a card makes no other hand.
        let is_moved = self.procedures.card.is_some();
        if to != self.connection.endpoint && !is_moved && !self.label.name.is_empty() {
            ctx.notices.name_former(&self.label);
        }
        if let Some(endpoint) = to {
            self.measured.begin(&endpoint, is_moved);
            self.connection = Connection::open(endpoint, ctx.env, ctx.now);
        }
        self.measured.history.gap(ctx.now);
        let before = std::mem::take(self);
        *self = Self {
            // Of the slot, whichever hand is in it.
            label: before.label,
            side: before.side,
            is_removed: before.is_removed,
            leaving: before.leaving,
            procedures: before.procedures,
            measured: before.measured,
            overshoot: before.overshoot,
            free_force: before.free_force,
            controls: if is_moved {
                before.controls.at_next_connection()
            } else {
                Controls::default()
            },
            params: before.params.at_next_connection(),
            // Of the connection.
            connection: before.connection,
            readings: Readings::default(),
            running: RunningMotion::default(),
            checkup: HandCheckup::default(),
            inputs: HandInputs::default(),
            recording: None,
            recorded: None,
        };
        let is_over = |what: &NoticeKind| {
            matches!(
                what,
                NoticeKind::LinkLost(_) | NoticeKind::NoLink(_) | NoticeKind::OpenElsewhere { .. }
            )
        };
        ctx.notices.withdraw(is_over);
        self.follow();
    }

    /// Takes in what happened on the link.
    pub(crate) fn take_news(&mut self, notices: &mut HandNotices<'_>, now: Moment) {
        if let Some((records, status)) = self.connection.heard() {
            for record in &records {
                self.take(record, notices, now);
            }
            self.take_status(status, notices, now);
        }
        self.follow();
    }

    /// Takes in one record. A reading is dated by itself, not by the frame that takes it in: a replay tells the same.
    pub(crate) fn take(&mut self, record: &Record, notices: &mut HandNotices<'_>, now: Moment) {
        match record {
            Record::Reading { sample, fresh } => {
                let at = sample.newest(*fresh).unwrap_or(now);
                let faults = self.readings.apply(sample, *fresh, at);
                self.measured.push(sample, *fresh, at, &faults);
                for entry in faults {
                    let (dof, what) = (entry.dof, entry.what);
                    notices.push(at, NoticeKind::Fault { dof, what });
                }
            }
            Record::State {
                at,
                state: LinkState::Holding,
            } => self.measured.history.mark(*at, MarkKind::Stop),
            Record::Sent { at, write, .. } => {
                self.connection.asked_at = *at;
                self.measured.history.sent(*at, write);
            }
            Record::State { .. } | Record::Answered { .. } => {}
            Record::ArmRefused { at, reason } => {
                self.running.forget_arming();
                notices.push(*at, NoticeKind::ArmRefused(*reason));
            }
        }
    }

    /// Takes in the status of the link.
    pub(crate) fn take_status(
        &mut self,
        status: LinkStatus,
        notices: &mut HandNotices<'_>,
        now: Moment,
    ) {
        let mut report = StatusReport {
            history: &mut self.measured.history,
            notices,
            now,
        };
        let news = report.status(&mut self.connection, status);
        if news.is_lost {
            self.params.link_lost(now);
        }
        if news.is_armed {
            self.connection.asked_at = now;
            self.controls.stand();
        }
    }

    /// Sliders that no user holds stand at the actual angle.
    pub(crate) fn follow(&mut self) {
        let angles = self.connection.angles(&self.readings.sample);
        self.controls.follow(angles, self.connection.is_armed());
        let status = &self.connection.status;
        let is_as_found = !self.connection.commanded && status.armed.is_none();
        if is_as_found && self.connection.is_live() {
            self.controls.adopt(&self.readings.sample);
        }
    }

    /// Why the hand cannot be armed now; `None` if it can or already is. The link asks the same again.
    pub fn arm_refusal(&self, now: Moment) -> Option<ArmRefusal> {
        let connection = &self.connection;
        let saves = connection.is_live() && self.params.is_saving();
        let busy = saves.then_some(ArmRefusal::HandBusy);
        let refusal = || arm_refusal(connection.status.state, &self.readings.sample, now);
        let is_let_go = !connection.is_armed() && self.controls.held.is_let_go(now);
        let let_go = is_let_go.then_some(ArmRefusal::LetGo);
        busy.or_else(refusal).or(let_go)
    }

    /// Asks the link to let setpoints pass, if the pose is known and nothing speaks against it.
    pub(crate) fn arm(&mut self, ctx: &mut Ctx<'_>) {
        if self.connection.is_armed() || !self.activity().lets_arm() {
            return;
        }
        match self.arm_refusal(ctx.now) {
            Some(reason) => ctx.notify(NoticeKind::ArmRefused(reason)),
            None => {
                let request = self.controls.arm_request(&self.readings.sample);
                self.connection.arm(request);
            }
        }
    }

    /// Arms the hand for a series, which begins once that holds. Whatever refuses, stops or disarms ends the wish.
    pub(crate) fn arm_for_series(&mut self, asked: AskedSeries, ctx: &mut Ctx<'_>) {
        let refusal = match &asked {
            AskedSeries::Trials(plan) => self.series_refusal(Some(&plan.trials())),
            AskedSeries::Checkup(_) => self.series_refusal(None),
        };
        if refusal.is_some_and(|why| why != StartRefusal::NotArmed) {
            return;
        }
        let may_arm = self.activity().lets_arm() && self.arm_refusal(ctx.now).is_none();
        self.arm(ctx);
        if may_arm {
            self.running.0 = Some(MotionRun::Arming(asked, ctx.now));
        }
    }

    /// Holds now. Works in every state; whatever was armed is not any more, at once. Without a live link it says that
    /// nothing could be sent.
    pub(crate) fn stop(&mut self, ctx: &mut Ctx<'_>) {
        if !self.connection.stop(ctx.now) {
            ctx.notify(NoticeKind::StopNotSent);
            self.measured.history.mark(ctx.now, MarkKind::StopNotSent);
        }
        self.running.end_series();
        self.controls.held.forget_press();
        self.follow();
    }

    /// Lets no setpoint pass any more. The hand keeps what it was told.
    pub(crate) fn disarm(&mut self, now: Moment) {
        self.connection.disarm(now);
        self.running.forget_arming();
        self.controls.held.forget_press();
        self.follow();
    }

    /// What is done with the key that lets the hand move. Who presses is armed as soon as a stop before is confirmed.
    pub(crate) fn hold_key(&mut self, key: HoldKey, ctx: &mut Ctx<'_>) {
        let wants_to_arm = self.controls.held.take(key, ctx.now);
        self.connection
            .hold_to_run(self.controls.held.hold_to_run());
        if !wants_to_arm || self.arm_refusal(ctx.now) == Some(ArmRefusal::Holding) {
            return;
        }
        self.controls.held.forget_press();
        // Who was let move the hand from outside arms by itself.
        if self.connection.outside_owner().is_none() {
            self.arm(ctx);
        }
    }

    /// Whether the key has to be held may have been changed, and time goes on.
    pub(crate) fn need_key(&mut self, is_needed: bool) {
        self.controls.held.need(is_needed);
        self.connection
            .hold_to_run(self.controls.held.hold_to_run());
    }

    /// The arming in which the user at this window may move the hand now.
    pub(crate) fn own_epoch(&self) -> Option<ArmEpoch> {
        let may_move = self.connection.is_armed() && self.activity().lets_person_move();
        self.connection.status.armed.filter(|_| may_move)
    }

    /// Changes what the user set for a joint. Speed and force are kept where they cannot be sent.
    pub(crate) fn change_joint(&mut self, dof: Dof, change: JointChange) {
        let wanted = self.controls.take(dof, change, self.own_epoch());
        if let JointChange::Lock(_) = change {
            self.follow();
            if let Some(run) = self.running.sequence() {
                run.command(PlayCommand::Lock(self.controls.locked()));
            }
        }
        if let Some(mut setpoints) = wanted {
            if let JointChange::Target(_) = change {
                self.take_over();
                let moved = setpoints.angle;
                self.controls
                    .restore_limits(&mut setpoints, |dof| moved[dof].is_some());
            }
            self.connection.send(&setpoints);
        }
    }

    /// What was played is over: the user's own speed and force are in force again for these joints.
    pub(crate) fn restore_limits(&mut self, of: impl Fn(Dof) -> bool) {
        let Some(epoch) = self.own_epoch() else {
            return;
        };
        let mut own = Setpoints::none(epoch);
        self.controls.restore_limits(&mut own, of);
        if !own.is_empty() {
            self.connection.send(&own);
        }
    }

    /// Sends the joints that are free and have a target; true if there are such. What moved the hand before does not any more.
    pub(crate) fn go_to(&mut self, fill: impl FnOnce(&mut Setpoints)) -> bool {
        let wanted = self.own_epoch().and_then(|epoch| {
            let mut wanted = Setpoints::none(epoch);
            fill(&mut wanted);
            self.controls.free(&wanted)
        });
        let Some(mut setpoints) = wanted else {
            return false;
        };
        self.take_over();
        self.controls.show(&setpoints);
        let (moved, speed) = (setpoints.angle, setpoints.speed);
        let has_own = |dof: Dof| moved[dof].is_some() && speed[dof].is_none();
        self.controls.restore_limits(&mut setpoints, has_own);
        self.connection.send(&setpoints);
        true
    }

    /// The user moves the hand: what moved it before does not any more.
    pub(crate) fn take_over(&mut self) {
        if let Some(run) = self.running.sequence_mut() {
            run.leave();
        }
        self.connection.take_over();
    }

    /// Starts what the user wants played; without arming, nothing. True if it was started.
    pub(crate) fn play(&mut self, plan: PlayPlan, pace: PlayMode, env: &Env, now: Moment) -> bool {
        let Some(epoch) = self.own_epoch() else {
            return false;
        };
        let entry = plan.entry;
        self.take_over();
        for cue in plan.cues() {
            self.controls.override_limits(&cue.targets);
        }
        let Some(open) = &mut self.connection.open else {
            return false;
        };
        let thresholds = plan.cues.iter().map(|cue| cue.thresholds).collect();
        let start = PlayStart {
            plan,
            pace,
            locked: self.controls.locked(),
            grip: self.readings.grip.clone(),
        };
        let armed = Armed {
            epoch,
            lease: open.lend_lease(),
            seen: self.readings.sample,
            clock: env.clock,
        };
        let (commands, wanted) = mpsc::channel(COMMANDS_MAX);
        let link = open.link.clone();
        let task = Running::start(env, |steps| async move {
            play::play(&link, armed, start, wanted, |step| steps.send(step)).await
        });
        self.running.0 = Some(MotionRun::Sequence(SequenceRun {
            entry,
            view: PlayView::first(now),
            commands: Some(commands),
            task: Some(task),
            thresholds,
        }));
        true
    }

    /// Something of this window's was sent by a task.
    pub(crate) fn sent(&mut self, setpoints: &Setpoints) {
        self.connection.commanded = true;
        if self.own_epoch().is_some() {
            self.controls.show(setpoints);
        }
    }

    /// Starts a gesture of the hand's own. It moves every joint, so none may be locked.
    pub(crate) fn gesture(&mut self, gesture: Gesture, route: GestureRoute, ctx: &mut Ctx<'_>) {
        let what = RequestKind::Gesture(gesture);
        if self.own_epoch().is_none() {
            let owner = self.connection.outside_owner();
            let taken = owner.map(|owner| LeaseRefusal::Taken(owner).into());
            self.failed(what, taken.unwrap_or(RequestError::NotArmed), ctx);
        } else if route == GestureRoute::Off {
            ctx.notify(NoticeKind::GesturesOff);
        } else if let Some((dof, _)) = self.controls.joints.iter().find(|(_, own)| own.locked) {
            ctx.notify(NoticeKind::GestureWouldMoveLocked { dof });
        } else {
            self.take_over();
            self.restore_limits(|_| true);
            self.controls.gesture = Some(gesture);
            if self.ask(what, HandCommand::Gesture(gesture, route), ctx) {
                let number = MarkKind::Gesture(gesture.get());
                self.measured.history.mark(ctx.now, number);
                self.connection.commanded = true;
                self.controls.let_go();
            }
        }
    }

    /// Writes a command; false, and told, if no hand is there to take it. The link holds the pose before errors are cleared.
    pub(crate) fn ask(
        &mut self,
        what: RequestKind,
        command: HandCommand,
        ctx: &mut Ctx<'_>,
    ) -> bool {
        let asked = self.connection.ask(what, command, ctx.env);
        asked.map_err(|error| self.failed(what, error, ctx)).is_ok()
    }

    /// Says how requests ended.
    pub(crate) fn tick_requests(&mut self, ctx: &mut Ctx<'_>) {
        for (what, end) in self.connection.ended_requests() {
            match end {
                Ok(()) => ctx.notify(NoticeKind::Acknowledged { what }),
                Err(error) => self.failed(what, error, ctx),
            }
        }
    }

    fn failed(&mut self, what: RequestKind, error: RequestError, ctx: &mut Ctx<'_>) {
        if matches!(what, RequestKind::Gesture(_)) {
            self.controls.gesture = None;
        }
        ctx.notify(NoticeKind::RequestFailed { what, error });
    }
}
