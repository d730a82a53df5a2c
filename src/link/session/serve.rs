//! One step of a live session: picks what is sent next, and applies its result. Never two requests at once; control
//! requests are checked before each.

use crate::hand::{
    ArmEpoch, Dof, Groups, HandCommand, ModbusException, Moment, PerDof, Refusal, RegisterWrite,
    Target, Timed,
};
use crate::link::bus::client::Urgent;
use crate::link::bus::{Bus, BusError};
use crate::link::guard::holder::HolderState;
use crate::link::lease::Lease;
use crate::link::request::RequestError;
use crate::link::series::DeviceSeries;
use crate::link::session::conversation::{Session, WireEnd, unless_lost};
use crate::link::session::hold::HoldWatch;
use crate::link::session::motion::{
    ANGLE_LOST, ARM_READS_TIMEOUT, PendingArm, arm_refusal, hold_targets,
};
use crate::link::session::stall::watched;
use crate::link::status::{ANGLE_FRESH, LinkTrouble};
use crate::link::wanted::{ArmCommand, PendingControl};
use crate::record::{ArmRefusal, Disarmed, Hold, LinkState, Record, Rest, WriteCause, WriteFate};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::oneshot;
use tokio::time::{sleep_until, timeout};

/// Longest time that arming waits for the holder process, which holds the hand if this program dies; it starts within
/// milliseconds.
const HOLDER_TIMEOUT: Duration = Duration::from_millis(250);
/// Stall time of this program that is added to the maximum age of an armed hand's angles: the hand follows its last
/// setpoints, and is read next.
const STALL_FORGIVEN: Duration = Duration::from_secs(1);
/// Data bytes of an acknowledgement.
const ACK_LEN: u16 = 1;

impl Session {
    /// Serves the wire until it is lost or the handle is dropped.
    pub(crate) async fn serve(&mut self, bus: &mut dyn Bus) -> WireEnd {
        loop {
            match self.round(bus).await {
                Ok(true) => self.after_step(bus),
                Ok(false) => {
                    self.publish_rest();
                    self.idle().await;
                }
                Err(end) => return end,
            }
        }
    }

    async fn round(&mut self, bus: &mut dyn Bus) -> Result<bool, WireEnd> {
        self.wake_up()?;
        self.turn(bus).await?;
        self.step(bus).await
    }

    /// Ends the session if this computer slept, because the link state is then unknown.
    pub(crate) fn wake_up(&mut self) -> Result<(), WireEnd> {
        let Some(slept) = self.sleep.slept() else {
            return Ok(());
        };
        if self.status.armed.is_some() {
            // The end of its motion was not observed.
            self.keep_stop(self.now());
        }
        self.disarm(Disarmed::Resume);
        let slept_s = slept.as_secs();
        Err(WireEnd::Lost(LinkTrouble::Suspended { slept_s }))
    }

    /// Publishes state and statistics after a step.
    pub(crate) fn after_step(&mut self, bus: &mut dyn Bus) {
        self.learn_late(bus);
        self.publish_rest();
        self.count(bus);
        self.watch_others(bus);
    }

    /// Does the most urgent thing; false if nothing is due.
    async fn step(&mut self, bus: &mut dyn Bus) -> Result<bool, WireEnd> {
        if self.urgent_step(bus).await? {
            return Ok(true);
        }
        if self.motion.hold.is_none() && self.identify_further(bus).await? {
            return Ok(true);
        }
        if self.motion.lets_jobs(self.now()) && self.next_job() {
            self.work(bus).await?;
        } else if let Some(question) = self.next_poll() {
            self.poll(bus, &question).await?;
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// Handles what precedes all requests: control requests, a stop, setpoints. Returns true if it sent something.
    pub(crate) async fn urgent_step(&mut self, bus: &mut dyn Bus) -> Result<bool, WireEnd> {
        if let Some(asked) = self.apply_control_requests()? {
            let until = self.now().plus(ARM_READS_TIMEOUT);
            self.motion.arming = Some(PendingArm { asked, until });
        }
        if let Some(arming) = self.due_arming() {
            self.arm(bus, arming.asked).await?;
            return Ok(true);
        }
        self.watch_age();
        self.watch_heat();
        let now = self.now();
        let begins_round = self.motion.begins_round(now);
        let hold = self.motion.hold;
        let is_due = |hold: HoldWatch| hold.next_frame(now).is_some_and(|at| at <= now);
        if hold.is_some_and(is_due) {
            // If an acknowledgement takes longer than the interval between hold frames, the pose is read between two
            // frames: frames alone would never show the hand at rest. Nothing is read while the hand saves or
            // calibrates. Over CAN a pose takes several requests, longer than the verdict on rest may take, so only
            // frames are sent.
            let looks = !self.leaves_line && !self.dialled.is_can();
            // A frame without a target holds nothing, and the effect of -1 on a moving joint is unknown (manual 2.6.12).
            let newest = self.hold_targets(now);
            let is_blind = |hold: &mut HoldWatch| hold.needs_pose(&newest);
            if looks && self.motion.waits_for_read
                || self.motion.hold.as_mut().is_some_and(is_blind)
            {
                return self.read_pose(bus).await.map(|()| true);
            }
            let is_acknowledged = self.send_hold(bus).await?;
            // An unacknowledged frame is repeated at once, unless its acknowledgement is only late.
            self.motion.waits_for_read = is_acknowledged || self.slowness.slowest().is_some();
        } else if self.pose_is_due(now) {
            self.poll_motion(bus).await?;
        } else if begins_round && let Some(question) = self.plan.before_write(now) {
            self.poll(bus, &question).await?;
        } else if let Some(write) = self.motion.next_write(now) {
            if begins_round {
                self.plan.begin_round(now);
            }
            self.send_setpoint(bus, write).await?;
            self.motion.add_write_time(self.now().since(now));
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// Publishes whether the hand rests, and whether the line is left to it.
    pub(crate) fn publish_rest(&mut self) {
        self.watch_holder();
        let rest = if self.feedback.is_doubted() || self.feedback.is_frozen() {
            Rest::Unknown
        } else {
            self.rest_now(self.now())
        };
        if (self.status.line_left, self.status.rest) != (self.leaves_line, rest) {
            self.status.line_left = self.leaves_line;
            self.status.rest = rest;
            self.publish();
        }
        let is_left_alone = self.status.armed.is_none() && self.motion.hold.is_none();
        if is_left_alone && rest == Rest::Resting {
            self.end_late_alarm();
            if self.rests() {
                self.publish();
            }
        }
    }

    /// Returns whether the hand rests according to its feedback.
    pub(crate) fn rest_now(&self, now: Moment) -> Rest {
        self.moving
            .rest(&self.sample, now, self.status.slow_allowance())
    }

    /// Records that feedback shows the hand at rest; true if that is new.
    fn rests(&mut self) -> bool {
        self.guard.rests();
        std::mem::take(&mut self.status.may_move)
    }

    /// Waits until something is due, or a control request or other request arrives.
    pub(crate) async fn idle(&mut self) {
        let now = self.now();
        let read = self.next_read();
        let due = self
            .motion
            .next_send(now)
            .map_or(read, |send| send.min(read));
        let is_armed = self.status.armed.is_some();
        let ends = self.ends.wanted.borrow().ends().filter(|_| is_armed);
        let due = ends.map_or(due, |end| end.min(due));
        let due_at = due;
        let due = self.config.clock.instant(due);
        let mut wanted = self.ends.wanted.subscribe();
        let is_news =
            |wanted: &PendingControl| wanted.is_any() || is_armed && wanted.is_let_go(now);
        tokio::select! {
            biased;
            _ = wanted.wait_for(is_news) => {}
            Some(request) = self.ends.requests.recv(), if self.job.is_none() => self.accept_job(request),
            () = sleep_until(due) => {}
        }
        self.stalled(self.now().since(due_at));
    }

    /// Applies the pending control requests; returns a request to arm, which takes exchanges of its own.
    fn apply_control_requests(&mut self) -> Result<Option<ArmCommand>, WireEnd> {
        let mut wishes = PendingControl::default();
        self.ends.wanted.send_if_modified(|wanted| {
            wishes = wanted.take();
            false
        });
        self.status.holder = wishes.book.holder();
        if wishes.stop {
            self.begin_hold(wishes.why.unwrap_or(Disarmed::Stop));
        }
        self.publish();
        if wishes.closed {
            return Err(WireEnd::Closed);
        }
        if wishes.disarm {
            self.disarm(wishes.why.unwrap_or(Disarmed::Person));
        }
        if wishes.handed_over {
            self.motion.forget_setpoints();
            if let Some(job) = self.job.take_if(|job| job.is_motion()) {
                job.fail(RequestError::NotArmed);
            }
        }
        if let Some(rates) = wishes.rates {
            self.config.rates = rates;
            self.plan.change_rates(rates, self.now());
            let periods = self.plan.periods();
            self.ends
                .image
                .send_modify(|image| image.change_periods(periods));
        }
        if let Some(setpoints) = wishes.setpoints {
            self.motion.merge_setpoints(&setpoints, self.status.armed);
        }
        Ok(wishes.arm)
    }

    /// Reason why the hand cannot be armed now, if any.
    fn arm_refusal(&self) -> Option<ArmRefusal> {
        let busy = self.leaves_line.then_some(ArmRefusal::HandBusy);
        let is_let_go = self.ends.wanted.borrow().is_let_go(self.now());
        let let_go = is_let_go.then_some(ArmRefusal::LetGo);
        let refusal = || arm_refusal(self.status.state, &self.sample, self.now());
        let unknown = (self.status.series != DeviceSeries::Ours).then_some(ArmRefusal::NotRead);
        busy.or(let_go).or_else(refusal).or(unknown)
    }

    /// Returns the requested arming once everything that it needs is known, or its wait is over.
    fn due_arming(&mut self) -> Option<PendingArm> {
        let waits = self.arm_refusal() == Some(ArmRefusal::NotRead);
        let now = self.now();
        self.motion
            .arming
            .take_if(|arming| !waits || now >= arming.until)
    }

    /// True if the arming in progress was superseded: its lease ended, or a stop, disarm or close was requested.
    fn arming_is_over(&self, lease: Lease) -> bool {
        let wanted = self.ends.wanted.borrow();
        let is_ended = wanted.book.check(lease).is_err() || wanted.is_let_go(self.now());
        wanted.stop || wanted.disarm || wanted.closed || is_ended
    }

    /// Sends the limits, and enables setpoints once the hand acknowledged them. No angle is written. An armed hand
    /// stays armed as it is.
    async fn arm(&mut self, bus: &mut dyn Bus, asked: ArmCommand) -> Result<(), WireEnd> {
        let ArmCommand {
            lease,
            request,
            answer,
        } = asked;
        if let Some(epoch) = self.status.armed {
            let _gone = answer.send(Ok(epoch));
            return Ok(());
        }
        if let Some(reason) = self.arm_refusal() {
            self.refuse_arm(answer, reason);
            return Ok(());
        }
        self.guard.moves(&self.dialled);
        let limits = [
            HandCommand::Speeds(request.speed.map(Some)),
            HandCommand::Forces(request.force.map(Some)),
        ];
        for write in limits.iter().flat_map(HandCommand::writes) {
            self.turn(bus).await?;
            if self.arming_is_over(lease) {
                return Ok(());
            }
            if let Err(error) = self.write(bus, &write, WriteCause::Arming).await {
                self.failed(bus, &error).await?;
                let reason = match error {
                    BusError::Refused {
                        reason: Refusal::Exception(ModbusException::Busy),
                    } => ArmRefusal::Taken,
                    BusError::Refused { .. } => ArmRefusal::Refused,
                    _ => ArmRefusal::NoAnswer,
                };
                self.refuse_arm(answer, reason);
                return Ok(());
            }
        }
        self.holder_started().await;
        // On a slow link the writes of the limits take longer than a pose stays fresh.
        if self.slowness.slowest().is_some() {
            self.turn(bus).await?;
            // A stop requested meanwhile goes first.
            if self.arming_is_over(lease) {
                return Ok(());
            }
            self.poll_motion(bus).await?;
        }
        self.status.unguarded = self.guard.unguarded();
        // A stop requested meanwhile takes precedence: it is handled in the next step, and arming must be requested anew.
        if self.arming_is_over(lease) {
            return Ok(());
        }
        let epoch = ArmEpoch(self.motion.last_epoch.0 + 1);
        self.motion.last_epoch = epoch;
        self.status.armed = Some(epoch);
        self.status.may_move = true;
        self.status.disarmed = None;
        self.others.foreign = None;
        self.others.not_taken = None;
        self.status.hold = Hold::None;
        let now = self.now();
        self.plan.schedule_settings_read(now);
        let owner = self.status.holder.map(|holder| holder.owner);
        self.heat.arm(&self.sample, owner, now);
        self.go(LinkState::Armed);
        let _gone = answer.send(Ok(epoch));
        Ok(())
    }

    /// Waits briefly for the holder process that holds the hand if this program dies: nothing moves before it started.
    /// If the wait times out, the process is still starting.
    async fn holder_started(&self) {
        if let Some(mut holder) = self.guard.holder() {
            let started = holder.wait_for(|state| *state != HolderState::Starting);
            let _late = timeout(HOLDER_TIMEOUT, started).await;
        }
    }

    /// Publishes the end of the holder process, which may happen long after arming.
    fn watch_holder(&mut self) {
        let unguarded = self.status.armed.and_then(|_| self.guard.unguarded());
        if unguarded.is_some() && self.status.unguarded != unguarded {
            self.status.unguarded = unguarded;
            self.publish();
        }
    }

    fn refuse_arm(
        &mut self,
        answer: oneshot::Sender<Result<ArmEpoch, ArmRefusal>>,
        reason: ArmRefusal,
    ) {
        let at = self.now();
        self.broadcast(Record::ArmRefused { at, reason });
        let _gone = answer.send(Err(reason));
    }

    /// Disarms, and drops pending setpoints. A disarm that was not requested also ends the lease.
    pub(crate) fn disarm(&mut self, why: Disarmed) {
        let holder = &mut self.status.holder;
        self.ends.wanted.send_if_modified(|wanted| {
            if !why.is_asked_for() {
                wanted.book.end(why);
            }
            *holder = wanted.book.holder();
            false
        });
        // After the lease: the requester of a dropped arming finds the reason there.
        self.motion.forget_setpoints();
        if self.status.armed.take().is_none() {
            return;
        }
        self.status.disarmed = Some(why);
        if self.status.state == LinkState::Armed {
            self.go(LinkState::Monitoring);
        }
        self.publish();
    }

    /// Maximum age of an armed hand's angles: extended by stalls of this program since, up to a limit.
    fn angle_lost(&self) -> Duration {
        let asked = self.sample.angle.map_or(Moment::ZERO, |angle| angle.asked);
        ANGLE_LOST + self.stalls.since(asked).min(STALL_FORGIVEN)
    }

    /// On a slow link every other exchange of an armed hand reads its pose: after a round of writes it would be too old.
    fn pose_is_due(&self, now: Moment) -> bool {
        let slow = self.slowness.slowest();
        let slow = slow.filter(|_| self.status.armed.is_some() && !self.leaves_line);
        let is_due = |angle: Timed<_>, slow: Duration| now.since(angle.received) >= slow / 2;
        slow.is_some_and(|slow| self.sample.angle.is_none_or(|angle| is_due(angle, slow)))
    }

    /// Stops an armed hand whose pose is no longer known or whose hold-to-run key was released, and raises the alarm of
    /// a stop that is overdue.
    fn watch_age(&mut self) {
        let now = self.now();
        if self.status.armed.is_some() && !self.sample.angles_fresh(now, self.angle_lost()) {
            self.begin_hold(Disarmed::Stale);
        }
        if self.status.armed.is_some() && self.ends.wanted.borrow().is_let_go(now) {
            self.begin_hold(Disarmed::Released);
        }
        if let Some(hold) = &mut self.motion.hold
            && hold.alarm_due(now)
        {
            hold.alarmed = true;
            self.status.hold = Hold::Alarm { at: hold.at };
            self.publish();
        }
    }

    /// Stops an armed hand with a drive that is hot or may be.
    fn watch_heat(&mut self) {
        let reason = self.heat.reason(&self.sample, self.now());
        if let Some(why) = reason.filter(|_| self.status.armed.is_some()) {
            self.begin_hold(why);
        }
    }

    /// Disarms once when another controller appears: a user who arms while it is active has been warned.
    fn watch_others(&mut self, bus: &dyn Bus) {
        let is_there = self.others.is_active(self.now());
        let is_news = is_there && !self.status.other_controller;
        let seen = (self.others.foreign, self.others.not_taken);
        let status = &mut self.status;
        let published = (status.foreign_setpoint, status.setpoint_not_taken);
        if (status.other_controller, status.echoes, published) != (is_there, bus.echoes(), seen) {
            status.other_controller = is_there;
            status.echoes = bus.echoes();
            (status.foreign_setpoint, status.setpoint_not_taken) = seen;
            self.publish();
        }
        if is_news {
            self.disarm(Disarmed::OtherController);
        }
    }

    /// Records a round trip. If the system does not report an adapter's latency timer, its ticks reveal it.
    pub(crate) fn watch_ticks(&mut self, bytes: u16, took: Duration) {
        self.ticks.record(bytes, took);
        let is_unknown = self.status.latency_timer_ms.is_none() && self.dialled.port().is_some();
        let seen = is_unknown && self.ticks.are_seen();
        if self.status.latency_ticks != seen {
            self.status.latency_ticks = seen;
            self.publish();
        }
    }

    /// Disarms and stops the hand. Every arming over a live link ends this way, except one that another controller or
    /// the user ends without a stop.
    pub(crate) fn begin_hold(&mut self, why: Disarmed) {
        let now = self.now();
        self.disarm(why);
        if let Some(job) = self.job.take_if(|job| job.is_motion()) {
            job.fail(RequestError::NotArmed);
        }
        // Doubted joints that were sent their hold targets are not commanded again: an unresponsive joint that
        // recovered would move.
        if (self.motion.hold).is_none_or(|hold| hold.alarmed && !hold.has_ceased()) {
            self.motion.hold = Some(HoldWatch::new(
                now,
                self.moving.moves(now),
                self.feedback.way_back(now),
            ));
            self.motion.waits_for_read = false;
            self.status.hold = Hold::Asked { at: now, sent: 0 };
        }
        if self.feedback.is_suspect() {
            self.doubt_feedback();
        }
        self.go(LinkState::Holding);
    }

    /// Ignores readings of suspect joints until they change: they cannot confirm the requested hold.
    pub(crate) fn doubt_feedback(&mut self) {
        self.feedback.doubt();
        self.status.feedback_in_doubt = true;
        if let Some(hold) = &self.motion.hold {
            self.status.hold = Hold::Alarm { at: hold.at };
        }
        self.publish();
    }

    /// Ends arming on an angle that is unchanged while motion was commanded; such an angle confirms no stop.
    pub(crate) fn watch_feedback(&mut self, doubted_before: &PerDof<bool>) {
        let doubted = self.feedback.doubted();
        let is_trusted_again = |dof: &Dof| doubted_before[*dof] && !doubted[*dof];
        if Dof::ALL.iter().any(is_trusted_again)
            && let Some(hold) = &mut self.motion.hold
        {
            // Its hold position is known now.
            *hold = hold.again(self.config.clock.now());
        }
        if self.status.feedback_in_doubt && !self.feedback.is_doubted() {
            self.status.feedback_in_doubt = false;
            self.publish();
        }
        if self.status.armed.is_some() && self.feedback.is_frozen() {
            self.begin_hold(Disarmed::FrozenFeedback);
        } else if self.motion.hold.is_some() && self.feedback.is_suspect_in_stop() {
            self.doubt_feedback();
        }
    }

    /// The targets that hold the hand in place, as far as its pose is known.
    pub(crate) fn hold_targets(&self, now: Moment) -> PerDof<Target> {
        let seen = hold_targets(&self.sample, now);
        // On a slow link the newest pose is old: the present pose is extrapolated from the joints' motion, or from
        // their commands.
        let is_slow = self.slowness.slowest().is_some();
        let is_old = !self.sample.angles_fresh(now, ANGLE_FRESH);
        PerDof::from_fn(|dof| {
            let doubted = self.feedback.hold_target(dof, now);
            let by_now = || match (is_slow, is_old) {
                (false, _) => None,
                (true, false) => self.feedback.gone_on(dof, now),
                (true, true) => self.feedback.expected(dof, now),
            };
            doubted.or_else(by_now).unwrap_or(seen[dof])
        })
    }

    /// Confirms the hold once the trusted joints, and so the hand, rest.
    pub(crate) fn watch_hold(&mut self, fresh: Groups) {
        let doubted = self.feedback.doubted();
        let Some(hold) = &mut self.motion.hold else {
            return;
        };
        if !hold.rests(&self.sample, fresh, &doubted) {
            return;
        }
        hold.trusted_rest();
        if hold.has_ceased() {
            // The holder process would drive the joints back to where their feedback froze.
            self.guard.rests();
        }
        if !self.feedback.is_doubted() {
            self.hold_confirmed();
        }
    }

    /// Sends one hold frame; true if the hand acknowledged it.
    async fn send_hold(&mut self, bus: &mut dyn Bus) -> Result<bool, WireEnd> {
        let now = self.now();
        let newest = self.hold_targets(now);
        let angle = self.sample.angle;
        let read = angle.filter(|_| self.sample.angles_fresh(now, ANGLE_FRESH));
        let way_back = self.feedback.way_back(now);
        let Some(hold) = &mut self.motion.hold else {
            return Ok(false);
        };
        let asked = read.map(|angle| angle.asked);
        let command = HandCommand::Angles(hold.frame(&newest, asked, way_back, now).map(Some));
        if !hold.alarmed && !self.feedback.is_doubted() {
            self.status.hold = Hold::Asked {
                at: hold.at,
                sent: hold.sent,
            };
        }
        let mut is_acknowledged = true;
        for write in command.writes() {
            if let Err(error) = self.write(bus, &write, WriteCause::Hold).await {
                is_acknowledged = false;
                self.failed(bus, &error).await?;
            }
        }
        if let Some(hold) = &mut self.motion.hold
            && is_acknowledged
            && self.feedback.is_doubted()
        {
            hold.doubted_acknowledged(now);
        }
        self.publish();
        Ok(is_acknowledged)
    }

    pub(crate) fn hold_confirmed(&mut self) {
        let Some(hold) = self.motion.hold.take() else {
            return;
        };
        self.status.hold = Hold::Confirmed {
            at: hold.at,
            rest: self.now(),
        };
        self.rests();
        self.go(if self.sample.has_fault() {
            LinkState::Fault
        } else {
            LinkState::Monitoring
        });
    }

    /// Sends one write and waits for its acknowledgement; timed and counted.
    pub(crate) async fn write(
        &mut self,
        bus: &mut dyn Bus,
        write: &RegisterWrite,
        cause: WriteCause,
    ) -> Result<(), BusError> {
        self.write_unless(bus, write, cause, &|| false).await
    }

    async fn write_unless(
        &mut self,
        bus: &mut dyn Bus,
        write: &RegisterWrite,
        cause: WriteCause,
        urgent: Urgent<'_>,
    ) -> Result<(), BusError> {
        let reason = Refusal::NotIdentified;
        let Some(permitted) = self.status.series.permit(write, cause) else {
            return Err(BusError::Refused { reason });
        };
        bus.allows(write)?;
        let limit = self.reply_limit(bus, ACK_LEN);
        let asked = self.now();
        self.counters.stats.writes += 1;
        let number = self.counters.stats.writes;
        self.others.wrote(write, asked);
        self.feedback.wrote(write, asked);
        self.plan.wrote_setpoint(asked);
        self.broadcast(Record::Sent {
            at: asked,
            number,
            cause,
            write: write.into(),
        });
        let (written, late) = watched(bus.write_unless(permitted, limit, urgent)).await;
        self.stalled(late);
        let answered = self.now();
        let took = answered.since(asked);
        self.broadcast(Record::Answered {
            at: answered,
            number,
            fate: fate(&written),
        });
        self.counters
            .line
            .wrote(self.plan.cost(), write.span(), took);
        let span = write.span();
        self.ends.image.send_modify(|image| image.forget(span));
        written?;
        self.feedback.acknowledged(write);
        self.answered(took.saturating_sub(late));
        Ok(())
    }

    async fn send_setpoint(
        &mut self,
        bus: &mut dyn Bus,
        write: RegisterWrite,
    ) -> Result<(), WireEnd> {
        self.moving.commanded(self.now());
        let wanted = Arc::clone(&self.ends.wanted);
        let stop = || wanted.borrow().stop;
        if let Err(error) = self
            .write_unless(bus, &write, WriteCause::Setpoint, &stop)
            .await
        {
            if matches!(error, BusError::Timeout { .. }) {
                self.motion.again(write);
            }
            self.failed(bus, &error).await?;
        }
        Ok(())
    }

    /// Waits for the line to be free; fails only if the wire is lost.
    pub(crate) async fn turn(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let (turned, late) = watched(bus.turn()).await;
        self.stalled(late);
        unless_lost(turned)
    }
}

fn fate(written: &Result<(), BusError>) -> WriteFate {
    match written {
        Ok(()) => WriteFate::Acknowledged,
        Err(BusError::Refused { reason }) => WriteFate::Refused {
            reason: reason.to_string(),
        },
        Err(_) => WriteFate::Unanswered,
    }
}
