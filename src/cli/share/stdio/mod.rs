//! `share --stdio`: the parent program moves and watches the hand by lines of JSON on standard input and output. The hand is
//! stopped when standard input ends, for whatever reason that program ends.

mod pipe;
mod refused;
mod request;

use crate::app::files::settings_file;
use crate::cli::hold;
use crate::cli::out::{Out, notify};
use crate::cli::recordings::beside::SideRecording;
use crate::cli::session;
use crate::cli::share::stdio::pipe::{NobodyReads, ReplyWriter};
use crate::cli::share::stdio::refused::{RefusalKind, StdioRefusal};
use crate::cli::share::stdio::request::{LimitsRequest, MoveRequest, StdioLine, StdioRequest};
use crate::cli::watch::telemetry::{grip_json, watch_json};
use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::kinematics::Side;
use crate::hand::{
    Angle, ArmEpoch, Gesture, GestureRoute, Group, HandCommand, HandSample, Moment, PerDof,
    Setpoints,
};
use crate::inputs::line::StreamLine;
use crate::inputs::{Offer, OfferLimits};
use crate::link::{ArmRequest, Lease, LeaseRefusal, LinkHandle, LinkStatus, Owner, Records};
use crate::motion::drive::{Armed, STOP_LOST};
use crate::motion::follow::{FollowStart, FollowTerms, follow};
use crate::motion::move_to::{MoveEnd, MoveReport, MoveStart, move_to};
use crate::motion::program::Ended;
use crate::record::{ArmRefusal, Disarmed, LinkState, Record, Rest};
use crate::store::calendar;
use crate::transport::Endpoint;
use futures::future::{BoxFuture, FutureExt as _, OptionFuture};
use futures::stream::{FuturesUnordered, StreamExt as _};
use serde_json::{Value, json};
use std::net::SocketAddr;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, interval, sleep, timeout};

/// Version of the protocol.
const VERSION: u64 = 1;
/// Polling interval of the hand's state.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// Maximum time for arming, including a stop before it.
const ARM_TIMEOUT: Duration = Duration::from_secs(5);
/// Maximum wait for a lost link at the end, because the hand may still be moving to its last target: covers one failed dial and
/// one successful one.
const RECONNECT_TIMEOUT: Duration = Duration::from_secs(6);
const LINK_LOST: RefusalKind = RefusalKind::Ended(Disarmed::LinkLost);
/// Capacity of the queue of targets to follow.
const OFFERS_MAX: usize = 64;

/// The shared hand and its properties.
pub(crate) struct StdioHand<'a> {
    pub(crate) link: &'a LinkHandle,
    pub(crate) endpoint: &'a Endpoint,
    pub(crate) side: Side,
    /// Listening address of the gateway, if there is one.
    pub(crate) gateway: Option<SocketAddr>,
}

/// Result of a task.
enum TaskResult {
    Armed(Result<Right, StdioRefusal>),
    Moved(Result<Box<MoveReport>, StdioRefusal>),
    Followed(Result<Ended<()>, StdioRefusal>),
    Cleared(Result<(), StdioRefusal>),
}

/// A task on the hand. There is one at a time.
struct Task {
    /// ID for the reply; `null` for no reply.
    id: Value,
    done: BoxFuture<'static, TaskResult>,
    kind: TaskKind,
}

impl Task {
    fn of(id: Value, done: impl Future<Output = TaskResult> + Send + 'static) -> Self {
        Self {
            id,
            done: done.boxed(),
            kind: TaskKind::Other,
        }
    }
}

/// Kind of a task, which determines the effect of dropping it.
enum TaskKind {
    /// Acquires control of the hand; no controller has it yet if the task is dropped.
    Arms,
    /// Follows targets sent here until dropped, which ends nothing else.
    Follows(mpsc::Sender<Offer>),
    /// Moves the hand, which continues to its targets if the task is dropped.
    Moves,
    Other,
}

/// Control of the hand, from `arm` to its end.
#[derive(Clone, Copy)]
struct Right {
    lease: Lease,
    limits: ArmRequest,
}

struct StdioSession<'a> {
    hand: StdioHand<'a>,
    replies: ReplyWriter<'a>,
    seen: HandSample,
    grip: GripEstimator,
    /// Newtons of a gram of each joint, where they are known.
    newtons_per_g: PerDof<Option<f64>>,
    /// Number of missed records reported so far.
    missed: u64,
    right: Option<Right>,
    task: Option<Task>,
    /// Stops that wait for their confirmation, each with the ID for its reply. No later request takes that away.
    stops: FuturesUnordered<BoxFuture<'static, (Value, anyhow::Result<()>)>>,
    recording: Option<SideRecording>,
    /// The recording being closed, and the ID for its reply.
    ending: Option<(Value, BoxFuture<'static, anyhow::Result<()>>)>,
    is_live: bool,
    /// True once control was taken from a program that did not read the output.
    unread: bool,
}

/// Serves until standard input ends, standard output is closed, or the user ends it. A hand that may move is stopped.
pub(crate) async fn serve<'a>(
    out: &'a mut Out,
    hand: StdioHand<'a>,
    interrupted: impl Future<Output = ()>,
) -> anyhow::Result<()> {
    let stopper = hand.link.stopper();
    let mut lines = pipe::lines(move || {
        stopper.stop_if_moved();
    });
    let mut records = hand.link.records();
    let mut session = StdioSession {
        replies: ReplyWriter::to(out),
        seen: HandSample::default(),
        grip: session::grip_estimator(hand.endpoint),
        newtons_per_g: session::newtons_per_g(hand.endpoint),
        missed: 0,
        right: None,
        task: None,
        stops: FuturesUnordered::new(),
        recording: None,
        ending: None,
        is_live: true,
        unread: false,
        hand,
    };
    tokio::select! {
        biased;
        () = interrupted => {}
        _nobody_reads = session.run(&mut lines, &mut records) => {}
    }
    session.leave().await
}

impl StdioSession<'_> {
    async fn run(
        &mut self,
        lines: &mut mpsc::Receiver<Vec<u8>>,
        records: &mut Records,
    ) -> Result<(), NobodyReads> {
        let began =
            calendar::since_1970().saturating_sub(self.hand.link.clock().now().since(Moment::ZERO));
        self.replies.send(&json!({"ready": {
            "v": VERSION,
            "since_1970_s": began.as_secs_f64(),
            "program": env!("CARGO_PKG_VERSION"),
            "hand": self.hand.endpoint.to_string(),
            "simulated": self.hand.endpoint.is_sim(),
            "tcp": self.hand.gateway.map(|at| at.to_string()),
        }}))?;
        let mut tick = interval(POLL_INTERVAL);
        loop {
            let task = OptionFuture::from(self.task.as_mut().map(|task| &mut task.done));
            let ending = OptionFuture::from(self.ending.as_mut().map(|ending| &mut ending.1));
            tokio::select! {
                // Polled in turn: a continuous stream of lines must not block the other sources.
                line = lines.recv() => match line {
                    Some(line) => self.handle_request(StdioLine::parse(&line, self.hand.side))?,
                    None => return Ok(()),
                },
                Some(done) = task => self.finish(done)?,
                Some((id, stopped)) = self.stops.next() => self.stopped(&id, stopped)?,
                Some(whole) = ending => self.ended(whole)?,
                record = records.next() => match record {
                    Some(record) => self.apply(record, records)?,
                    None => return Ok(()),
                },
                _ = tick.tick() => self.poll()?,
            }
        }
    }

    /// Stops a hand that may move, and closes the recording.
    async fn leave(mut self) -> anyhow::Result<()> {
        let link = self.hand.link;
        // The reader of the output may be gone.
        let _sent = self.end_task(LeaseRefusal::Ended(Disarmed::Stop).into());
        let _sent = self.poll();
        if link.status().owes_stop() {
            let back = async {
                while !link.status().state.is_live() {
                    sleep(POLL_INTERVAL).await;
                }
            };
            let _back = timeout(RECONNECT_TIMEOUT, back).await;
        }
        let status = link.status();
        let is_lost = status.owes_stop() && !status.state.is_live();
        let may_move = is_lost || self.is_to_stop() || status.state == LinkState::Holding;
        let done = if may_move {
            session::stopped(link).await
        } else {
            Ok(())
        };
        let mut recorded = Ok(());
        if let Some(recording) = self.recording.take() {
            recorded = recording.end_here().await;
        }
        if let Some((_id, ending)) = self.ending.take() {
            recorded = recorded.and(ending.await);
        }
        SideRecording::and(done, recorded)
    }

    /// True if the hand may continue to its last target, also after a link that was lost and restored, unless another controller
    /// moves it.
    fn is_to_stop(&self) -> bool {
        let status = self.hand.link.status();
        status.owes_stop() && status.state.is_live() || self.holds().is_some()
    }

    /// True if the hand is known to have completed all motion for the program.
    fn is_at_rest(&self) -> bool {
        let is_motion = |task: &Task| matches!(task.kind, TaskKind::Follows(_) | TaskKind::Moves);
        let status = self.hand.link.status();
        let goes_on = status.owes_stop() || self.task.as_ref().is_some_and(is_motion);
        !goes_on && status.rest == Rest::Resting
    }

    /// The control of the hand, if still valid.
    fn holds(&self) -> Option<Right> {
        self.right
            .filter(|right| self.hand.link.check(right.lease).is_ok())
    }

    /// Applies a record; a state is published in the format of `watch`.
    fn apply(&mut self, record: Record, records: &Records) -> Result<(), NobodyReads> {
        let Record::Reading { sample, fresh } = record else {
            return Ok(());
        };
        self.seen = *sample;
        let read = sample.newest(fresh).unwrap_or_default();
        let mut grip = self.grip.apply(&sample, fresh, read);
        if self.hand.link.status().feedback_in_doubt {
            grip = Grip::default();
        }
        let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) else {
            return Ok(());
        };
        let missed = records.lost() - self.missed;
        self.missed = records.lost();
        let newtons = self.newtons_per_g;
        let state = || json!({"state": watch_json(&sample, &grip, &newtons, angle.received)});
        self.replies.state(state, missed)
    }

    /// Publishes changes of the link and of the control of the hand; stops the hand if the output is stuck.
    fn poll(&mut self) -> Result<(), NobodyReads> {
        let status = self.hand.link.status();
        if status.state.is_live() != self.is_live {
            self.is_live = status.state.is_live();
            let why = session::trouble(&status).map(ToString::to_string);
            let state = if self.is_live { "live" } else { "lost" };
            self.replies
                .send(&json!({"link": {"state": state, "why": why}}))?;
        }
        if self.replies.is_stuck()
            && let Some(right) = self.holds()
        {
            notify("the output was not read for a second: the hand is stopped");
            self.unread = true;
            let _done = self.hand.link.give_back(right.lease, Disarmed::Silent);
        }
        if self.task.is_none()
            && let Some(Err(why)) = self.right.map(|right| self.check(right))
        {
            self.lose(&why)?;
        }
        Ok(())
    }

    /// Handles the unrequested loss of control of the hand.
    fn lose(&mut self, why: &StdioRefusal) -> Result<(), NobodyReads> {
        self.right = None;
        if why.kind == LINK_LOST {
            // The hand continues to its last target: a stop is queued until the link is back.
            drop(self.hand.link.stop());
        }
        self.replies
            .send(&json!({"disarmed": {"kind": why.kind, "why": why.why}}))
    }

    fn reply(&mut self, id: &Value, done: Result<Value, StdioRefusal>) -> Result<(), NobodyReads> {
        if id.is_null() {
            // Success without an ID is not reported; an error is reported in any case.
            return match done {
                Ok(_) => Ok(()),
                Err(no) => self
                    .replies
                    .send(&json!({"refused": {"kind": no.kind, "why": no.why}})),
            };
        }
        self.replies.send(&match done {
            Ok(done) => json!({"reply": {"id": id, "ok": done}}),
            Err(no) => json!({"reply": {"id": id, "kind": no.kind, "error": no.why}}),
        })
    }

    /// Handles a request. An error in a line that ends a motion is reported once the end is under way.
    fn handle_request(&mut self, line: StdioLine) -> Result<(), NobodyReads> {
        let odd = line
            .odd
            .map(|why| json!({"odd": {"id": &line.id, "why": why}}));
        self.begin_request(line.id, line.what)?;
        odd.map_or(Ok(()), |odd| self.replies.send(&odd))
    }

    fn begin_request(
        &mut self,
        id: Value,
        what: Result<StdioRequest, String>,
    ) -> Result<(), NobodyReads> {
        let done = match what {
            Err(why) => Err(StdioRefusal::new(RefusalKind::Wrong, why)),
            Ok(StdioRequest::Rate(rates)) => {
                self.hand.link.read_at(rates);
                Ok(())
            }
            Ok(StdioRequest::Pose(name)) => return self.pose(&id, &name),
            Ok(StdioRequest::Record(path)) => return self.record(id, path.as_deref()),
            Ok(StdioRequest::Stop) => return self.stop(id),
            Ok(StdioRequest::Release) if self.is_to_stop() => return self.stop(id),
            Ok(StdioRequest::Disarm) if self.is_to_stop() && !self.is_at_rest() => {
                return self.stop(id);
            }
            Ok(StdioRequest::Release | StdioRequest::Disarm)
                if self.hand.link.status().owes_stop() && !self.is_live =>
            {
                Err(StdioRefusal::new(LINK_LOST, STOP_LOST))
            }
            Ok(StdioRequest::Release | StdioRequest::Disarm) => {
                self.end_task(StdioRefusal::replaced())?;
                if self.holds().is_some() {
                    self.hand.link.disarm();
                }
                self.right = None;
                Ok(())
            }
            Ok(StdioRequest::Arm(limits)) => return self.arm(id, limits),
            Ok(StdioRequest::Move(request)) => match self.right() {
                Ok(right) => return self.move_hand(id, right, request),
                Err(no) => Err(no),
            },
            Ok(StdioRequest::Follow(line)) => match self.right() {
                Ok(right) => match line.within(&right.limits) {
                    Ok(line) => return self.follow(id, right, line),
                    Err(why) => Err(StdioRefusal::new(RefusalKind::Wrong, why.to_string())),
                },
                Err(no) => Err(no),
            },
            Ok(StdioRequest::Clear) => {
                let link = self.hand.link.clone();
                let clearing = async move {
                    let done = link.write(HandCommand::ClearErrors).await;
                    TaskResult::Cleared(done.map_err(|error| {
                        StdioRefusal::new(RefusalKind::Refused, error.to_string())
                    }))
                };
                return self.begin(Task::of(id, clearing));
            }
        };
        self.reply(&id, done.map(|()| json!({})))
    }

    /// Reports the angles of a pose, as `move` accepts them.
    fn pose(&mut self, id: &Value, name: &str) -> Result<(), NobodyReads> {
        let wrong = |why: String| StdioRefusal::new(RefusalKind::Wrong, why);
        let found = match hold::pose(name) {
            Err(error) => Err(wrong(error.to_string())),
            Ok(pose) if pose.gap.is_some() => Err(wrong(format!(
                "the pose '{}' is a grip by size: 'handscope grip' closes to a gap",
                pose.name
            ))),
            Ok(pose) => {
                let angles = pose.targets().map(|to| to.map(Angle::get));
                Ok(json!({ "angle": angles.as_array() }))
            }
        };
        self.reply(id, found)
    }

    /// The control of the hand, or the reason why it is missing.
    fn right(&mut self) -> Result<Right, StdioRefusal> {
        let right = self.right.ok_or_else(|| {
            StdioRefusal::new(
                RefusalKind::NotArmed,
                "nothing was moved: arm the hand first",
            )
        })?;
        self.check(right)?;
        Ok(right)
    }

    /// Reports the end of a control.
    fn check(&self, right: Right) -> Result<(), StdioRefusal> {
        let checked = self.hand.link.check(right.lease);
        checked.map_err(|end| match end {
            LeaseRefusal::Ended(Disarmed::Silent) if self.unread => StdioRefusal::unread(),
            end => end.into(),
        })
    }

    /// Ends the current task, without sending anything to the hand.
    fn end_task(&mut self, why: StdioRefusal) -> Result<(), NobodyReads> {
        let Some(task) = self.task.take() else {
            return Ok(());
        };
        if matches!(task.kind, TaskKind::Follows(_)) {
            return Ok(());
        }
        let holder = self.hand.link.status().holder;
        let is_own = holder.is_some_and(|holder| holder.owner == Owner::Task);
        if matches!(task.kind, TaskKind::Arms) && is_own && self.holds().is_none() {
            self.hand.link.disarm();
        }
        self.reply(&task.id, Err(why))
    }

    /// Starts a task in place of the current one.
    fn begin(&mut self, task: Task) -> Result<(), NobodyReads> {
        self.end_task(StdioRefusal::replaced())?;
        self.task = Some(task);
        Ok(())
    }

    /// Stops the hand, whichever controller moves it, and waits for confirmation by feedback.
    fn stop(&mut self, id: Value) -> Result<(), NobodyReads> {
        let stopped = session::stopped(self.hand.link);
        self.right = None;
        self.stops.push(async move { (id, stopped.await) }.boxed());
        self.end_task(LeaseRefusal::Ended(Disarmed::Stop).into())
    }

    /// Answers a stop: an error unless feedback shows that the hand rests.
    fn stopped(&mut self, id: &Value, stopped: anyhow::Result<()>) -> Result<(), NobodyReads> {
        let done =
            stopped.map_err(|not| StdioRefusal::new(RefusalKind::NotConfirmed, not.to_string()));
        self.reply(id, done.map(|()| json!({})))
    }

    /// Acquires control of the hand, unless another controller has it. If the hand is armed already, only its limits change,
    /// immediately, and its motion continues.
    fn arm(&mut self, id: Value, limits: LimitsRequest) -> Result<(), NobodyReads> {
        let held = self.holds();
        let limits = limits.over(held.map_or(ArmRequest::GENTLE, |right| right.limits));
        if let (Some(right), Some(epoch)) = (held, self.hand.link.status().armed) {
            let set = self.hand.link.set(right.lease, &limits.setpoints(epoch));
            self.right = Some(Right { limits, ..right });
            return self.reply(&id, set.map(|()| json!({})).map_err(StdioRefusal::from));
        }
        let link = self.hand.link.clone();
        let arming = async move { TaskResult::Armed(granted(&link, held, limits).await) };
        self.begin(Task {
            id,
            done: arming.boxed(),
            kind: TaskKind::Arms,
        })
    }

    fn move_hand(
        &mut self,
        id: Value,
        right: Right,
        request: MoveRequest,
    ) -> Result<(), NobodyReads> {
        let link = self.hand.link.clone();
        let (seen, grip) = (self.seen, self.grip.clone());
        let limits = request.limits.over(right.limits);
        let moving = async move {
            let epoch = match armed(&link, right).await {
                Ok(epoch) => epoch,
                Err(no) => return TaskResult::Moved(Err(no)),
            };
            if let Some(gesture) = request.gesture {
                let limits = limits.setpoints(epoch);
                if let Err(no) = begin_gesture(&link, right.lease, &limits, gesture).await {
                    return TaskResult::Moved(Err(no));
                }
            }
            let start = MoveStart {
                targets: request.targets,
                limits,
                settles: request.settles,
                grip,
            };
            let armed = Armed {
                epoch,
                lease: right.lease,
                seen,
                clock: link.clock(),
            };
            TaskResult::Moved(Ok(Box::new(move_to(&link, armed, start).await)))
        };
        self.begin(Task {
            id,
            done: moving.boxed(),
            kind: TaskKind::Moves,
        })
    }

    /// Makes the hand follow a target, as one of a stream.
    fn follow(&mut self, id: Value, right: Right, line: StreamLine) -> Result<(), NobodyReads> {
        if line.held == Some(false) && self.followed_by().is_none() {
            // Nothing is followed; any other motion of the hand is ended nevertheless.
            self.end_task(LeaseRefusal::Ended(Disarmed::Released).into())?;
            let done = self.hand.link.halt(right.lease);
            return self.reply(&id, done.map(|()| json!({})).map_err(StdioRefusal::from));
        }
        let offer = Offer {
            at: self.hand.link.clock().now(),
            aims: line.aims,
            gap: line.gap,
            hold: line.hold,
            // An earlier motion may have changed the limits.
            limits: OfferLimits {
                force: right.limits.force.map(Some),
                speed: right.limits.speed.map(Some),
            },
            held: line.held,
            // A script may send the same target repeatedly; only silence counts as a loss.
            mark: None,
        };
        if self.followed_by().is_none() {
            let (offers, followed) = mpsc::channel(OFFERS_MAX);
            let link = self.hand.link.clone();
            let start = FollowStart {
                lease: right.lease,
                terms: watch::Sender::new(FollowTerms::default()).subscribe(),
                arm: right.limits,
                grip: self.grip.clone(),
                overshoot: hold::overshoot(self.hand.endpoint),
                blocks: session::size_blocks(self.hand.endpoint),
                seen: self.seen,
                clock: link.clock(),
            };
            let following = async move {
                match armed(&link, right).await {
                    Ok(_epoch) => {
                        TaskResult::Followed(Ok(follow(&link, start, followed, |_| ()).await))
                    }
                    Err(no) => TaskResult::Followed(Err(no)),
                }
            };
            self.begin(Task {
                id: Value::Null,
                done: following.boxed(),
                kind: TaskKind::Follows(offers),
            })?;
        }
        if let Some(offers) = self.followed_by() {
            // A target that does not fit is dropped: the next one is newer.
            let _full = offers.try_send(offer);
        }
        self.reply(&id, Ok(json!({})))
    }

    /// Sender of targets while they are followed.
    fn followed_by(&self) -> Option<&mpsc::Sender<Offer>> {
        match &self.task.as_ref()?.kind {
            TaskKind::Follows(offers) => Some(offers),
            TaskKind::Arms | TaskKind::Moves | TaskKind::Other => None,
        }
    }

    /// Starts or ends a recording. The end is reported once the file is complete.
    fn record(&mut self, id: Value, path: Option<&std::path::Path>) -> Result<(), NobodyReads> {
        let StdioHand {
            link,
            endpoint,
            side,
            ..
        } = self.hand;
        let done = match (path, self.recording.take()) {
            (Some(path), None) => match SideRecording::begin(Some(path), link, endpoint, side) {
                Ok(begun) => {
                    self.recording = Some(begun);
                    Ok(json!({}))
                }
                Err(error) => Err(format!("{error:#}")),
            },
            (Some(_), goes_on) => {
                self.recording = goes_on;
                Err("a recording is in progress: end it first".into())
            }
            (None, Some(recording)) if self.ending.is_none() => {
                self.ending = Some((id, recording.end_here().boxed()));
                return Ok(());
            }
            (None, Some(goes_on)) => {
                self.recording = Some(goes_on);
                Err(
                    "the previous recording is not complete yet: end this one a little later"
                        .into(),
                )
            }
            (None, None) => Err("nothing is recorded".into()),
        };
        self.reply(
            &id,
            done.map_err(|why| StdioRefusal::new(RefusalKind::Refused, why)),
        )
    }

    /// Reports the end of a recording; an error if the file is incomplete.
    fn ended(&mut self, whole: anyhow::Result<()>) -> Result<(), NobodyReads> {
        let whole =
            whole.map_err(|why| StdioRefusal::new(RefusalKind::Refused, format!("{why:#}")));
        match self.ending.take() {
            Some((id, _)) => self.reply(&id, whole.map(|()| json!({}))),
            None => Ok(()),
        }
    }

    /// Handles the result of a task.
    fn finish(&mut self, done: TaskResult) -> Result<(), NobodyReads> {
        let Some(Task { id, .. }) = self.task.take() else {
            return Ok(());
        };
        match done {
            TaskResult::Armed(Ok(right)) => {
                self.right = Some(right);
                self.unread = false;
                self.reply(&id, Ok(json!({})))
            }
            // The previous control may still be valid, or have ended meanwhile.
            TaskResult::Armed(Err(no)) => {
                let lost = self.right.is_some() && self.holds().is_none();
                self.reply(&id, Err(no.clone()))?;
                if lost { self.lose(&no) } else { Ok(()) }
            }
            TaskResult::Moved(moved) => {
                let done = moved.and_then(|report| self.moved(&report));
                let lost = done.clone().err().filter(|_| self.holds().is_none());
                self.reply(&id, done)?;
                lost.map_or(Ok(()), |why| self.lose(&why))
            }
            TaskResult::Followed(followed) => self.followed(followed),
            TaskResult::Cleared(cleared) => self.reply(&id, cleared.map(|()| json!({}))),
        }
    }

    /// Result of a motion. A hand that took too long is stopped.
    fn moved(&mut self, report: &MoveReport) -> Result<Value, StdioRefusal> {
        let link = self.hand.link;
        let end = match report.end {
            Ok(MoveEnd::Reached) => "reached",
            Ok(MoveEnd::Stopped) => "stopped",
            Ok(MoveEnd::Late) => {
                if let Some(right) = self.right {
                    link.halt(right.lease)?;
                }
                "late"
            }
            Err(_) => {
                self.right()?;
                // The control is still valid, but the arming has ended.
                let why = link.status().disarmed.map(|why| why.to_string());
                return Err(StdioRefusal::new(
                    RefusalKind::Disarmed,
                    why.unwrap_or_else(|| "the hand was disarmed".into()),
                ));
            }
        };
        Ok(json!({"end": end, "grip": grip_json(&report.grip, link.clock().now())}))
    }

    /// Handles the end of following. A script that fell silent may continue; the hand was stopped.
    fn followed(&mut self, followed: Result<Ended<()>, StdioRefusal>) -> Result<(), NobodyReads> {
        let lost = match followed {
            Err(no) => no,
            Ok(Ok(())) => {
                let granted = self.hand.link.grant(Owner::Task);
                if let Some(right) = &mut self.right {
                    right.lease = granted;
                }
                return Ok(());
            }
            Ok(Err(why)) => match self.right() {
                Err(no) => no,
                Ok(_right) => StdioRefusal::new(RefusalKind::Disarmed, why.to_string()),
            },
        };
        self.lose(&lost)
    }
}

/// Acquires control of the hand and arms it, once its link and an earlier stop permit it. Existing control is kept.
async fn granted(
    link: &LinkHandle,
    held: Option<Right>,
    limits: ArmRequest,
) -> Result<Right, StdioRefusal> {
    let until = Instant::now() + ARM_TIMEOUT;
    loop {
        let LinkStatus { state, holder, .. } = link.status();
        let right = match (held, holder) {
            (Some(right), _) => Right { limits, ..right },
            (None, Some(other)) => {
                let who = match other.owner {
                    Owner::Gateway(at) => format!("{at} may move the hand, until it disconnects"),
                    _ => "another controller has control".into(),
                };
                return Err(StdioRefusal::new(RefusalKind::Taken, who));
            }
            (None, None) if !state.is_live() && Instant::now() < until => {
                sleep(POLL_INTERVAL).await;
                continue;
            }
            (None, None) => Right {
                lease: link.grant(Owner::Task),
                limits,
            },
        };
        match armed(link, right).await {
            Ok(_epoch) => return Ok(right),
            // Nothing has moved yet: retry when the link is back.
            Err(no) if no.kind == LINK_LOST && held.is_none() && Instant::now() < until => {}
            Err(no) => return Err(no),
        }
    }
}

/// Starts a gesture that the hand stores, with these limits, by the register that the user chose in the window.
async fn begin_gesture(
    link: &LinkHandle,
    lease: Lease,
    limits: &Setpoints,
    gesture: Gesture,
) -> Result<(), StdioRefusal> {
    let settings = settings_file::default_path().and_then(|path| settings_file::peek(&path));
    let route = settings.unwrap_or_default().gesture_route;
    if route == GestureRoute::Off {
        return Err(StdioRefusal::new(
            RefusalKind::Refused,
            "nothing was moved: gestures are off in the settings of the window",
        ));
    }
    link.set(lease, limits)?;
    let written = link.write_as(lease, HandCommand::Gesture(gesture, route));
    let Err(error) = written.await else {
        return Ok(());
    };
    // A lost control is more informative than the write that it prevented.
    link.check(lease)?;
    Err(StdioRefusal::new(RefusalKind::Refused, error.to_string()))
}

/// Arms the hand under an existing lease, once an earlier stop has completed.
async fn armed(link: &LinkHandle, right: Right) -> Result<ArmEpoch, StdioRefusal> {
    let until = Instant::now() + ARM_TIMEOUT;
    while link.status().state == LinkState::Holding && Instant::now() < until {
        sleep(POLL_INTERVAL).await;
    }
    let why = match link.arm(right.lease, right.limits)?.await {
        Ok(epoch) => return Ok(epoch),
        Err(why) => why,
    };
    link.check(right.lease)?;
    link.disarm();
    let kind = match why {
        ArmRefusal::Taken => RefusalKind::Taken,
        _ => RefusalKind::Refused,
    };
    Err(StdioRefusal::new(
        kind,
        format!("the hand cannot be armed: {why}"),
    ))
}
