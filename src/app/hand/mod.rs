//! One hand as a composition: the parts own their state and are independent of each other; operations on several parts are here. The
//! other files hold the list of hands, the program that moves one, and what moves it as the user sees it.

mod free_force;
pub mod grasps;
pub mod grip;
pub mod hold;
pub mod list;
pub mod mover;
#[cfg(test)]
mod news_tests;
pub mod newtons;
pub mod running;
pub mod scale;

use crate::app::activity::{Activity, RecordedMover, RecordedPlay};
use crate::app::checkup::HandCheckup;
use crate::app::connection::Connection;
use crate::app::connection::Leaving;
use crate::app::connection::StatusReport;
use crate::app::controls::{Controls, HoldKey};
use crate::app::controls::{HeldOtherwise, JointChange};
use crate::app::env::Ctx;
use crate::app::env::Env;
use crate::app::env::motion_task::MotionTask;
use crate::app::hand::free_force::HandFreeForce;
use crate::app::hand::grasps::HandGrasps;
use crate::app::hand::newtons::HandNewtons;
use crate::app::hand::running::SequenceRun;
use crate::app::hand::running::{AskedSeries, MotionRun, RunningMotion};
use crate::app::inputs::HandInputs;
use crate::app::notices::{HandNotices, NoticeKind, RequestKind};
use crate::app::params::{ParamsState, rest_refusal};
use crate::app::procedures::Procedures;
use crate::app::readings::{Measurements, Readings};
use crate::app::recordings::recording::HandRecording;
use crate::app::settings::Settings;
use crate::app::slot::{HandLabel, SlotId, place_name};
use crate::app::trials::{HandOvershoot, StartRefusal};
use crate::hand::gap::SizeBlocks;
use crate::hand::kinematics::Side;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{
    Angle, ArmEpoch, Dof, Force, Gesture, GestureRoute, HandCommand, Moment, PerDof, Setpoints,
};
use crate::history::MarkKind;
use crate::link::session::motion::arm_refusal;
use crate::link::{Clock, LeaseRefusal, LinkHandle, LinkStatus, Owner, RequestError};
use crate::motion::drive::Armed;
use crate::motion::play::{self, PlayCommand, PlayStart};
use crate::poses::player::{PlayMode, PlayPlan, PlayView};
use crate::record::{ArmRefusal, LinkState, Record};
use crate::tasks::Question;
use crate::transport::Endpoint;
use crate::trials::TrialPlan;
use std::time::Duration;

/// Maximum wait for a stopped hand to show rest before its link is closed regardless: the time after which the link itself raises the
/// alarm, plus a margin.
pub(crate) const REST_TIMEOUT: Duration = Duration::from_millis(600);

/// Everything about one hand.
#[derive(Debug, Default)]
pub struct Hand {
    /// Slot and name.
    pub label: HandLabel,
    /// Left or right, as the user set it: no register contains it.
    pub side: Side,
    pub connection: Connection,
    pub readings: Readings,
    pub measured: Measurements,
    pub controls: Controls,
    /// The program that moves the hand.
    pub running: RunningMotion,
    /// Overshoot of the hand, as measured by trials.
    pub overshoot: HandOvershoot,
    /// Forces that its joints read while they touch nothing.
    pub(crate) free_force: HandFreeForce,
    /// Newtons of its joints, where they were measured.
    pub newtons: HandNewtons,
    /// Grasps of the pose library, and those that the hand confirmed.
    pub grasps: HandGrasps,
    /// Last check-up.
    pub checkup: HandCheckup,
    /// Open procedure: change of address, reset or calibration.
    pub procedures: Procedures,
    /// Inputs from outside the window that may move the hand, and their clients.
    pub inputs: HandInputs,
    /// Persistent parameters, with staged changes.
    pub params: ParamsState,
    /// The recording being made of it.
    pub recording: Option<HandRecording>,
    /// Party that moves the hand, in a replay.
    pub(crate) recorded: Option<RecordedMover>,
    /// Set while the hand was stopped and is being disconnected.
    pub(crate) leaving: Option<Leaving>,
    /// Its slot is removed as soon as the hand is disconnected.
    pub(crate) is_removed: bool,
}

impl Hand {
    /// Current activity, which decides who may move the hand.
    pub fn activity(&self) -> Activity {
        if self.leaving.is_some() {
            Activity::Leaving
        } else if self.procedures.card.is_some() {
            Activity::Procedure
        } else if self.runs_series() {
            Activity::Series
        } else if let Some(owner) = self.connection.outside_owner() {
            Activity::Following(owner)
        } else if self.running.plays() {
            Activity::Playing
        } else {
            Activity::Idle
        }
    }

    /// Reason why a valid plan of trials cannot start now; without a plan, a check-up, which moves every joint.
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

    /// Actual settings of a joint of a live hand that differ from the user's.
    pub fn held_otherwise(&self, dof: Dof) -> HeldOtherwise {
        if !self.connection.is_live() {
            return HeldOtherwise::default();
        }
        let held = self.controls.held_otherwise(dof, &self.readings.sample);
        HeldOtherwise {
            // A target from outside this window is outdated by the time it is read back.
            target: held
                .target
                .filter(|_| self.connection.outside_owner().is_none()),
            ..held
        }
    }

    /// Current pose, if all six angles are known, live and fresh.
    pub fn pose_now(&self, now: Moment) -> Option<PerDof<Angle>> {
        self.readings.pose_now(self.connection.is_live(), now)
    }

    /// Applies name and side from the settings.
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

    /// Disconnects the hand. A hand that may be moving is stopped first and gets time to come to rest.
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

    /// Continues a disconnect once the stopped hand rests, or its time has expired.
    pub(crate) fn continue_leaving(&mut self, ctx: &mut Ctx<'_>) {
        let is_due = |leaving: &mut Leaving| {
            let told = leaving.told;
            ctx.now.since(told) >= REST_TIMEOUT || self.connection.is_held(told)
        };
        if let Some(leaving) = self.leaving.take_if(is_due) {
            self.go(leaving.to, ctx);
        }
    }

    /// Opens another hand, or none, at once. No state of the old hand is attributed to the new one; an open procedure continues.
    pub(crate) fn go(&mut self, to: Option<Endpoint>, ctx: &mut Ctx<'_>) {
        self.measured.leave(&self.connection.name(), ctx.now);
        // The old link closes first: a serial port has room for one.
        self.connection = Connection::none(ctx.now);
        // A change of id during a procedure does not make another hand.
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
            newtons: before.newtons,
            grasps: before.grasps,
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

    /// Applies news of the link.
    pub(crate) fn apply_news(&mut self, notices: &mut HandNotices<'_>, now: Moment) {
        if let Some((records, status)) = self.connection.received() {
            for record in &records {
                self.apply(record, notices, now);
            }
            self.apply_status(status, notices, now);
        }
        self.follow();
    }

    /// Applies a record. A reading has its own time, independent of the frame, so that a replay gives the same result.
    pub(crate) fn apply(&mut self, record: &Record, notices: &mut HandNotices<'_>, now: Moment) {
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

    /// Applies a status of the link.
    pub(crate) fn apply_status(
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
            self.controls.freeze();
        }
    }

    /// Moves sliders that the user has not moved to the actual angle.
    pub(crate) fn follow(&mut self) {
        let angles = self.connection.angles(&self.readings.sample);
        self.controls.follow(angles, self.connection.is_armed());
        let status = &self.connection.status;
        let is_as_found = !self.connection.commanded && status.armed.is_none();
        if is_as_found && self.connection.is_live() {
            self.controls.adopt(&self.readings.sample);
        }
    }

    /// Reason why the hand cannot be armed now; `None` if it can or already is. The link checks again.
    pub fn arm_refusal(&self, now: Moment) -> Option<ArmRefusal> {
        let connection = &self.connection;
        let saves = connection.is_live() && self.params.is_saving();
        let busy = saves.then_some(ArmRefusal::HandBusy);
        let refusal = || arm_refusal(connection.status.state, &self.readings.sample, now);
        let is_let_go = !connection.is_armed() && self.controls.held.is_let_go(now);
        let let_go = is_let_go.then_some(ArmRefusal::LetGo);
        busy.or_else(refusal).or(let_go)
    }

    /// Asks the link to arm, if the pose is known and no other reason prevents it.
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

    /// Arms the hand for a series, which starts once the arming holds. A refusal, stop or disarming cancels the request.
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

    /// Stops (holds) the hand, in every state; any arming ends at once. Without a live link the user is notified that the stop could
    /// not be sent.
    pub(crate) fn stop(&mut self, ctx: &mut Ctx<'_>) {
        if !self.connection.stop(ctx.now) {
            ctx.notify(NoticeKind::StopNotSent);
            self.measured.history.mark(ctx.now, MarkKind::StopNotSent);
        }
        self.running.end_series();
        self.controls.held.forget_press();
        self.follow();
    }

    /// Passes no further setpoints. The hand keeps its targets.
    pub(crate) fn disarm(&mut self, now: Moment) {
        self.connection.disarm(now);
        self.running.forget_arming();
        self.controls.held.forget_press();
        self.follow();
    }

    /// Applies the state of the hold-to-run key. A press arms the hand as soon as an earlier stop is confirmed.
    pub(crate) fn hold_key(&mut self, key: HoldKey, ctx: &mut Ctx<'_>) {
        let wants_to_arm = self.controls.held.apply(key, ctx.now);
        self.connection
            .hold_to_run(self.controls.held.hold_to_run());
        if !wants_to_arm || self.arm_refusal(ctx.now) == Some(ArmRefusal::Holding) {
            return;
        }
        self.controls.held.forget_press();
        // A party outside this window that was granted control arms by itself.
        if self.connection.outside_owner().is_none() {
            self.arm(ctx);
        }
    }

    /// Updates whether the key is required, and its state over time.
    pub(crate) fn need_key(&mut self, is_needed: bool) {
        self.controls.held.need(is_needed);
        self.connection
            .hold_to_run(self.controls.held.hold_to_run());
    }

    /// Arming under which the user at this window may move the hand now.
    pub(crate) fn own_epoch(&self) -> Option<ArmEpoch> {
        let may_move = self.connection.is_armed() && self.activity().lets_person_move();
        self.connection.status.armed.filter(|_| may_move)
    }

    /// Changes the user's setting of a joint. Speed and force are stored if they cannot be sent.
    pub(crate) fn change_joint(&mut self, dof: Dof, change: JointChange) {
        let wanted = self.controls.apply(dof, change, self.own_epoch());
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

    /// Restores the user's speed and force for these joints after an entry was played.
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

    /// Sends targets of unlocked joints; true if there are any. Whatever moved the hand before loses control.
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

    /// Gives control to the user; whatever moved the hand before loses it.
    pub(crate) fn take_over(&mut self) {
        self.running.leave();
        self.connection.take_over();
    }

    /// Adds what begins to play to the recording of the hand, if there is one.
    pub(crate) fn record_play(&mut self, play: &RecordedPlay, at: Moment) {
        if let Some(recording) = &mut self.recording {
            recording.begin_play(at, play.words());
        }
    }

    /// What plays in a replay, if the recording names it.
    pub(crate) fn recorded_play(&self) -> Option<&RecordedPlay> {
        self.recorded.as_ref().and_then(RecordedMover::playing)
    }

    /// Lends an armed hand to a program of this window; whatever moved it before loses it. `None` if it is not armed.
    pub(crate) fn lend_armed(&mut self, clock: Clock) -> Option<(LinkHandle, Armed)> {
        let epoch = self.own_epoch()?;
        self.take_over();
        let open = self.connection.open.as_mut()?;
        let armed = Armed {
            epoch,
            lease: open.lend_lease(),
            seen: self.readings.sample,
            clock,
        };
        Some((open.link.clone(), armed))
    }

    /// Starts an entry of the library, if the hand is armed. True if it was started.
    pub(crate) fn play(
        &mut self,
        plan: PlayPlan,
        pace: PlayMode,
        blocks: SizeBlocks,
        (env, now): (&Env, Moment),
    ) -> bool {
        let Some((link, armed)) = self.lend_armed(env.clock) else {
            return false;
        };
        let entry = plan.entry;
        for cue in plan.cues() {
            // A hold sets speeds and thresholds of whatever joints hold the object.
            let any = cue.hold.map(|_| PerDof::splat(Some(Angle::MAX)));
            self.controls.override_limits(&any.unwrap_or(cue.targets));
        }
        let thresholds = plan.cues.iter().map(|cue| cue.thresholds).collect();
        let start = PlayStart {
            plan,
            pace,
            locked: self.controls.locked(),
            grip: self.readings.grip.clone(),
            overshoot: OvershootMap::clone(&self.overshoot.map),
            blocks,
            force_limit: Force::MAX,
        };
        let task = MotionTask::start(env, |steps, commands| async move {
            play::play(&link, armed, start, commands, |step| steps.send(step)).await
        });
        self.running.0 = Some(MotionRun::Sequence(SequenceRun {
            entry,
            view: PlayView::first(now),
            hold: None,
            task,
            thresholds,
        }));
        true
    }

    /// Notes that a task of this window sent setpoints.
    pub(crate) fn sent(&mut self, setpoints: &Setpoints) {
        self.connection.commanded = true;
        if self.own_epoch().is_some() {
            self.controls.show(setpoints);
        }
    }

    /// Starts a gesture stored in the hand. It moves every joint, so none may be locked.
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
            if self.request(what, HandCommand::Gesture(gesture, route), ctx) {
                let number = MarkKind::Gesture(gesture.get());
                self.measured.history.mark(ctx.now, number);
                self.connection.commanded = true;
                self.controls.release();
            }
        }
    }

    /// Writes a command; false, with a notice, if no hand is connected. The link holds the pose before it clears errors.
    pub(crate) fn request(
        &mut self,
        what: RequestKind,
        command: HandCommand,
        ctx: &mut Ctx<'_>,
    ) -> bool {
        let asked = self.connection.request(what, command, ctx.env);
        asked.map_err(|error| self.failed(what, error, ctx)).is_ok()
    }

    /// Passes the user's answer to the task that asked. To write, the hand must be disarmed and at rest, as before the question.
    pub(crate) fn answer(&mut self, question: &Question, yes: bool) {
        let is_write = matches!(question, Question::Apply(_) | Question::Save(_));
        if !(yes && is_write && rest_refusal(&self.connection.status).is_some()) {
            let _is_open =
                self.params.answer(question, yes) || self.procedures.answer(question, yes);
        }
    }

    /// Notifies the user of the results of requests.
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
