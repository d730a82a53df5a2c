//! The task that owns one wire: dials, identifies, serves, and reconnects after a loss. It decides what is sent next:
//! stop, then hold, setpoints, requests, reads. No request survives a lost link.

use crate::hand::{HandSample, ModbusException, Moment, Refusal};
use crate::link::bus::late_replies::{LateReplies, REPLY_LIMIT_MIN};
use crate::link::bus::latency::Ticks;
use crate::link::bus::slowness::Slowness;
use crate::link::bus::{self, Bus, BusCounts, BusError};
use crate::link::clock::SleepWatch;
use crate::link::config::LinkConfig;
use crate::link::guard::MotionGuard;
use crate::link::image::RegisterImage;
use crate::link::poll::cost::WireCost;
use crate::link::poll::plan::PollPlan;
use crate::link::request::RequestError;
use crate::link::series::SeriesEvidence;
use crate::link::session::absence::{Absence, REFUSED_PAUSE, Refused};
use crate::link::session::adapter::KnownAdapter;
use crate::link::session::counters::Counters;
use crate::link::session::hold::PendingStop;
use crate::link::session::job::SessionJob;
use crate::link::session::motion::Motion;
use crate::link::session::rest::RestWatch;
use crate::link::session::stall::{STALL_MIN, StallMeter, watched};
use crate::link::session::watch::feedback::FeedbackWatch;
use crate::link::session::watch::heat::HeatWatch;
use crate::link::session::watch::other_controller::OtherController;
use crate::link::session::watch::save::SaveWatch;
use crate::link::status::{Dialling, LinkStatus, LinkTrouble};
use crate::link::tap::TappedWire;
use crate::link::wanted::{PendingControl, SessionChannels};
use crate::record::{Disarmed, Hold, LinkState, Record, Rest};
use crate::transport::{BoxedWire, Endpoint, TransportError};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::watch;
use tokio::time::{sleep_until, timeout};

/// Delay before the first retry; some hands need 300 ms between close and connect.
const RETRY_FIRST: Duration = Duration::from_millis(300);
/// Longest retry delay: a hand that is back is detected within two seconds.
const RETRY_LONGEST: Duration = Duration::from_secs(1);
/// Consecutive requests without a reply after which the link counts as lost …
pub(crate) const SILENT_MAX: u32 = 4;
/// … or fewer, but never one alone, if not even the minimum wait for one more would fit into this: with the time before
/// the first of them, silence shows within 300 ms. A wire so slow that two requests take longer is allowed those two.
const SILENCE_MAX: Duration = Duration::from_millis(288);
const SILENT_LEAST: u32 = 2;
/// Longest wait for a reply: part of the time in which a stop gets through, and half of the time in which silence
/// shows. Longer only where replies are known to be late, and a stop does not wait for them.
const REPLY_LIMIT_MAX: Duration = Duration::from_millis(120);
/// Reason why serving a wire ended.
pub(crate) enum WireEnd {
    /// The last handle was dropped.
    Closed,
    /// The link was lost.
    Lost(LinkTrouble),
}

/// The session with one hand.
pub(crate) struct Session {
    pub(crate) config: LinkConfig,
    pub(crate) ends: SessionChannels,
    pub(crate) status: LinkStatus,
    pub(crate) counters: Counters,
    pub(crate) sample: HandSample,
    pub(crate) plan: PollPlan,
    pub(crate) motion: Motion,
    /// The only state that survives a lost link.
    pub(crate) pending_stop: Option<PendingStop>,
    pub(crate) moving: RestWatch,
    pub(crate) feedback: FeedbackWatch,
    pub(crate) heat: HeatWatch,
    pub(crate) job: Option<SessionJob>,
    /// The line is reserved for a hand that saves or calibrates.
    pub(crate) leaves_line: bool,
    /// Answers the request that a lost link interrupted.
    pub(crate) broken_off: Option<Box<dyn FnOnce() + Send + Sync>>,
    pub(crate) saving: SaveWatch,
    pub(crate) sleep: SleepWatch,
    pub(crate) stalls: StallMeter,
    silent: u32,
    /// Time of the first of the consecutive unanswered requests.
    silent_since: Option<Moment>,
    /// Exceptions of a gateway instead of the hand's replies.
    pub(crate) absence: Absence,
    /// Replies on this wire carry the number of their request.
    has_numbers: bool,
    /// Reply delays, over all wires to this hand.
    pub(crate) slowness: Slowness,
    adapter: KnownAdapter,
    pub(crate) ticks: Ticks,
    /// The endpoint that was dialled last: through the port where the adapter was found.
    pub(crate) dialled: Endpoint,
    late: LateReplies,
    pub(crate) others: OtherController,
    /// Evidence read to decide whether this is a hand of the series.
    pub(crate) evidence: SeriesEvidence,
    /// Time of the next read for more evidence.
    pub(crate) evidence_due: Moment,
    /// The last step read evidence, so the next one does not.
    pub(crate) asked_evidence: bool,
    closed_wires: BusCounts,
    /// Holds the hand if this program ends.
    pub(crate) guard: Arc<MotionGuard>,
}

impl Session {
    pub(crate) fn new(config: LinkConfig, ends: SessionChannels) -> Self {
        let now = config.clock.now();
        Self {
            guard: MotionGuard::enter(Arc::clone(&ends.wanted)),
            plan: PollPlan::new(config.rates, WireCost::default(), now),
            sleep: SleepWatch::start(config.clock),
            dialled: config.endpoint.clone(),
            config,
            ends,
            status: LinkStatus {
                since: now,
                ..LinkStatus::default()
            },
            counters: Counters::default(),
            sample: HandSample::default(),
            motion: Motion::default(),
            pending_stop: None,
            moving: RestWatch::default(),
            feedback: FeedbackWatch::default(),
            heat: HeatWatch::default(),
            job: None,
            leaves_line: false,
            broken_off: None,
            saving: SaveWatch::default(),
            stalls: StallMeter::default(),
            silent: 0,
            silent_since: None,
            absence: Absence::default(),
            has_numbers: false,
            slowness: Slowness::default(),
            adapter: KnownAdapter::default(),
            ticks: Ticks::default(),
            late: LateReplies::default(),
            others: OtherController::default(),
            evidence: SeriesEvidence::default(),
            evidence_due: now,
            asked_evidence: false,
            closed_wires: BusCounts::default(),
        }
    }

    /// Runs until the handle is dropped.
    pub(crate) async fn run(mut self) {
        let mut attempt = 0;
        loop {
            attempt += 1;
            let (end, answered) = self.conversation(attempt).await;
            match end {
                WireEnd::Closed => return,
                WireEnd::Lost(trouble) => self.lost(trouble),
            }
            if answered {
                attempt = 0;
            }
            if self.wait_for_retry(attempt).await {
                return;
            }
        }
    }

    pub(crate) fn now(&self) -> Moment {
        self.config.clock.now()
    }

    /// Serves one wire, from dialling to its end; also returns whether the hand answered on it.
    async fn conversation(&mut self, attempt: u32) -> (WireEnd, bool) {
        self.status.dialling = Dialling::Trying { attempt };
        self.publish();
        let closed = closed(Arc::clone(&self.ends.wanted));
        let dialled = tokio::select! {
            biased;
            () = closed => return (WireEnd::Closed, false),
            dialled = self.dial() => dialled,
        };
        self.keep_pressed_stop();
        let late = std::mem::take(&mut self.late);
        let (endpoint, wire) = match dialled {
            Ok(dialled) => dialled,
            Err(error) => return (WireEnd::Lost(error.into()), false),
        };
        self.dialled = endpoint;
        let (tap, clock) = (self.ends.tap.clone(), self.config.clock);
        let wire = Box::new(TappedWire::new(wire, tap, clock));
        let mut bus = bus::on_wire(&self.dialled, wire, late, clock);
        self.has_numbers = bus.has_numbers();
        self.note_answer();
        self.sleep = SleepWatch::start(self.config.clock);
        self.go(LinkState::Identifying);
        let (end, answered) = match self.identify(bus.as_mut()).await {
            Err(end) => (self.explained(end, bus.as_ref()), false),
            Ok(()) => {
                self.note_port().await;
                self.begin(bus.as_ref());
                (self.serve(bus.as_mut()).await, true)
            }
        };
        self.count(bus.as_ref());
        self.closed_wires = self.closed_wires.plus(bus.counts());
        self.late = bus.close();
        (end, answered)
    }

    /// Opens the wire at the port where the adapter is now, and returns the endpoint used.
    async fn dial(&self) -> Result<(Endpoint, BoxedWire), TransportError> {
        let dial = self.config.dial.as_ref();
        let endpoint = self.adapter.endpoint(dial, &self.config.endpoint).await?;
        let wire = dial.dial(&endpoint).await?;
        Ok((endpoint, wire))
    }

    /// Refines the trouble of a hand that never answered by what was received instead.
    fn explained(&self, end: WireEnd, bus: &dyn Bus) -> WireEnd {
        let WireEnd::Lost(LinkTrouble::NoAnswer { id }) = end else {
            return end;
        };
        let place = self.dialled.place();
        let counts = bus.counts();
        let is_noisy = counts.checksum_errors + counts.resyncs + counts.foreign_replies > 0;
        WireEnd::Lost(match self.dialled {
            Endpoint::Tcp { .. } => LinkTrouble::Mute { place, unit: id },
            // The simulated hand has no port or speed that could be wrong.
            Endpoint::Sim { .. } => LinkTrouble::NoAnswer { id },
            _ if bus.own_frames() > 0 => LinkTrouble::OnlyEcho { place },
            _ if is_noisy => LinkTrouble::Garbled { place, id },
            _ => LinkTrouble::NoAnswer { id },
        })
    }

    /// Records the adapter through which the hand answered.
    async fn note_port(&mut self) {
        let (asked, at) = (&self.config.endpoint, &self.dialled);
        let found = self.adapter.remember(self.config.dial.as_ref(), at).await;
        self.status.latency_timer_ms = found.and_then(|port| port.usb?.latency_timer_ms);
        self.status.moved_to = at.port().filter(|_| at != asked).map(str::to_owned);
    }

    /// Starts a fresh session: earlier requests are dropped. Only a stop that was requested while there was no live
    /// link is kept, with what is known for it of joints whose feedback froze.
    fn begin(&mut self, bus: &dyn Bus) {
        self.keep_pressed_stop();
        self.forget_wishes();
        if self.sample != HandSample::default() {
            self.counters.stats.reconnects += 1;
        }
        self.sample = HandSample::default();
        self.others.begin();
        self.plan = PollPlan::new(self.config.rates, bus.cost(), self.now());
        if let Some(gap) = self.status.quirks.gap {
            self.plan.set_gap_read(gap);
        }
        self.moving = RestWatch::default();
        let before = std::mem::take(&mut self.feedback);
        if self.has_pending_stop() {
            self.feedback = before.after_loss();
        }
        self.heat = HeatWatch::default();
        self.status.feedback_in_doubt = false;
        self.ticks = Ticks::default();
        self.motion = Motion::after(self.motion.last_epoch);
        self.status.dialling = Dialling::Idle;
        self.status.trouble = None;
        self.status.hold = Hold::None;
        let image = RegisterImage::live(self.plan.periods());
        self.ends.image.send_replace(image);
        self.guard.reaches(true);
        self.go(LinkState::Monitoring);
        self.resume_stop();
        if self.feedback.is_doubted() {
            self.doubt_feedback();
        }
    }

    /// Handles a lost link: disarms, and drops everything queued but a stop that feedback did not confirm.
    fn lost(&mut self, trouble: LinkTrouble) {
        self.disarm(Disarmed::LinkLost);
        self.keep_pressed_stop();
        if let Some(hold) = self.motion.hold {
            self.keep_stop(hold.at);
        }
        self.motion.forget();
        self.guard.reaches(false);
        self.status.trouble = Some(trouble);
        self.counters.lost();
        self.forget_wishes();
        if let Some(job) = self.job.take() {
            job.fail(RequestError::LinkLost);
        }
        self.status.line_left = false;
        self.status.rest = Rest::Unknown;
        self.status.heat = None;
        self.go(LinkState::Offline);
        self.ends.image.send_modify(RegisterImage::lose);
        if let Some(answer) = self.broken_off.take() {
            answer();
        }
        while let Ok(request) = self.ends.requests.try_recv() {
            request.fail(RequestError::NotConnected);
        }
        self.ends.stats.send_replace(self.counters.stats);
    }

    /// Clears the pending control requests, except for closing and the poll rates.
    pub(crate) fn forget_wishes(&self) {
        self.ends.wanted.send_if_modified(|wanted| {
            *wanted = wanted.lasting();
            false
        });
    }

    /// Waits before the next attempt; true if the handle was dropped meanwhile.
    async fn wait_for_retry(&mut self, attempt: u32) -> bool {
        let begun = self.now();
        let doublings = attempt.saturating_sub(1).min(8);
        let usual = (RETRY_FIRST * 2u32.pow(doublings)).min(RETRY_LONGEST);
        loop {
            // A stop waits only for the pause that the hand needs.
            let asked = self.config.dial.retry_delay(attempt);
            let wait = match self.has_pending_stop() {
                true => asked.unwrap_or(RETRY_FIRST),
                false => asked.unwrap_or(usual),
            };
            let until = begun.plus(wait);
            self.status.dialling = Dialling::Waiting { attempt, until };
            self.publish();
            let pressed = stopped(Arc::clone(&self.ends.wanted));
            tokio::select! {
                biased;
                () = pressed => {
                    if self.ends.wanted.borrow().closed {
                        return true;
                    }
                    self.keep_pressed_stop();
                }
                () = sleep_until(self.config.clock.instant(until)) => return false,
            }
        }
    }

    /// Longest wait for a reply of this many bytes on this link.
    pub(crate) fn reply_limit(&self, bus: &dyn Bus, bytes: u16) -> Duration {
        let usual = self.counters.stats.rtt_p99.unwrap_or_default() * 2;
        let on_wire = bus.wire_time(bytes);
        let least = self.slowness.least_wait();
        let limit = on_wire + usual.clamp(REPLY_LIMIT_MIN, REPLY_LIMIT_MAX).max(least);
        // During a silence the requests share the time that is left.
        let Some(since) = self.silent_since else {
            return limit;
        };
        let left = SILENCE_MAX.saturating_sub(self.silent_for(since));
        limit.min(left.max(on_wire + least))
    }

    /// Records that a request was answered after `took`.
    pub(crate) fn answered(&mut self, took: Duration) {
        self.note_answer();
        self.counters.round_trip(took);
        if self.has_numbers {
            self.slowness.record(took);
            self.show_slowness();
        }
    }

    /// Learns from replies that came after their requests timed out.
    pub(crate) fn learn_late(&mut self, bus: &mut dyn Bus) {
        let Some(late) = bus.take_late() else {
            return;
        };
        if let Some(exception) = late.exception {
            // It explains why nothing comes; the missing reply is counted already.
            let _counted = self.absence.refused(exception.into(), self.now());
            return;
        }
        self.counters.round_trip(late.took);
        self.slowness.late(late);
        self.show_slowness();
    }

    fn show_slowness(&mut self) {
        let slowest = self.slowness.slowest();
        let slow_ms = slowest.and_then(|took| u16::try_from(took.as_millis()).ok());
        // A change of a millisecond is not worth publishing.
        let is_news = match (self.status.slow_ms, slow_ms) {
            (Some(shown), Some(now)) => shown.abs_diff(now) > shown / 8,
            (shown, now) => shown != now,
        };
        if is_news {
            self.status.slow_ms = slow_ms;
            self.publish();
        }
    }

    /// Handles a failed request. Only a lost wire or too many consecutive failures end the session.
    pub(crate) async fn failed(
        &mut self,
        bus: &mut dyn Bus,
        error: &BusError,
    ) -> Result<(), WireEnd> {
        self.learn_late(bus);
        match error {
            BusError::Lost(error) => return Err(WireEnd::Lost(error.clone().into())),
            BusError::Refused { reason } => return self.refused(*reason).await,
            BusError::WrongLength { .. } | BusError::TooLong => self.counters.stats.refusals += 1,
            BusError::Timeout { .. } => self.counters.stats.timeouts += 1,
            // Nothing was sent.
            BusError::Ambiguous => return Ok(()),
        }
        if self.note_silence(error) {
            let last = self.absence.last();
            return Err(WireEnd::Lost(last.map_or_else(
                || self.silence(),
                |exception| self.gateway_alone(exception),
            )));
        }
        if self.motion.hold.is_some() {
            return Ok(());
        }
        // A stop does not wait for the line to settle.
        let stop = stopped(Arc::clone(&self.ends.wanted));
        let settle = async {
            tokio::select! {
                biased;
                () = stop => Ok(()),
                settled = bus.quiet() => unless_lost(settled),
            }
        };
        let (settled, late) = watched(settle).await;
        self.stalled(late);
        settled
    }

    /// Handles a refused request. Only the hand's own refusals count as answers of the hand.
    async fn refused(&mut self, reason: Refusal) -> Result<(), WireEnd> {
        self.counters.stats.refusals += 1;
        match self.absence.refused(reason, self.now()) {
            Refused::ByHand => self.note_answer(),
            Refused::Unsent => {}
            Refused::Unsure if self.motion.hold.is_some() => {}
            Refused::Unsure => self.pause_unless_stopped(REFUSED_PAUSE).await,
            Refused::Gone(exception) => {
                return Err(WireEnd::Lost(self.gateway_alone(exception)));
            }
        }
        Ok(())
    }

    /// The trouble to report if a gateway answers for a hand that does not.
    pub(crate) fn gateway_alone(&self, exception: ModbusException) -> LinkTrouble {
        let place = self.dialled.place();
        LinkTrouble::Gateway { place, exception }
    }

    /// Waits, unless a stop is requested.
    pub(crate) async fn pause_unless_stopped(&self, length: Duration) {
        let stop = stopped(Arc::clone(&self.ends.wanted));
        let _either = timeout(length, stop).await;
    }

    /// Resets the silence: the hand answered.
    pub(crate) fn note_answer(&mut self) {
        self.silent = 0;
        self.silent_since = None;
        self.absence.answered();
    }

    /// Counts a request without a usable reply; true if the hand now counts as lost.
    fn note_silence(&mut self, error: &BusError) -> bool {
        let now = self.now();
        let waited = match error {
            BusError::Timeout { after } => *after,
            _ => Duration::ZERO,
        };
        let asked = Moment::from_duration(now.since(Moment::ZERO).saturating_sub(waited));
        // A reply that arrived while this program stalled was not missing.
        let stalled = self.stalls.since(asked);
        if stalled.is_zero() || stalled * 2 < waited {
            self.silent += 1;
        }
        let since = *self.silent_since.get_or_insert(asked);
        let one_more = self.silent_for(since) + self.slowness.least_wait();
        // A TCP connection loses nothing: a reply is late there, and shows how late.
        let are_many = self.silent >= SILENT_MAX && !self.has_numbers;
        are_many || self.silent >= SILENT_LEAST && one_more > SILENCE_MAX
    }

    /// Time for which the hand has been silent since `since`, without this program's own stalls.
    fn silent_for(&self, since: Moment) -> Duration {
        let passed = self.now().since(since);
        passed.saturating_sub(self.stalls.since(since))
    }

    /// Records that this program serviced the wire this much too late.
    pub(crate) fn stalled(&mut self, late: Duration) {
        let now = self.now();
        let Some(stall) = self.stalls.late(late, now) else {
            return;
        };
        let stats = &mut self.counters.stats;
        stats.stalls += 1;
        stats.stalled += stall.lasted;
        stats.longest_stall = stats.longest_stall.max(stall.lasted);
        self.status.stall = Some(stall);
        self.publish();
    }

    /// The trouble to report for a silence: not the hand's alone if this program stalled during it.
    fn silence(&self) -> LinkTrouble {
        let silent = self.silent;
        let stalled = self
            .silent_since
            .map_or(Duration::ZERO, |since| self.stalls.since(since));
        if stalled < STALL_MIN {
            return LinkTrouble::Silent { silent };
        }
        LinkTrouble::Stalled {
            silent,
            stalled_ms: u32::try_from(stalled.as_millis()).unwrap_or(u32::MAX),
        }
    }

    /// Changes the state and publishes it.
    pub(crate) fn go(&mut self, state: LinkState) {
        let now = self.now();
        if self.status.state != state {
            self.status.state = state;
            self.status.since = now;
            self.publish();
            self.broadcast(Record::State { at: now, state });
        }
        self.publish();
    }

    pub(crate) fn publish(&self) {
        let changed = self.ends.status.send_if_modified(|shown| {
            let changed = *shown != self.status;
            if changed {
                shown.clone_from(&self.status);
            }
            changed
        });
        if changed {
            (self.config.wake)();
        }
    }

    /// Broadcasts a record.
    pub(crate) fn broadcast(&self, record: Record) {
        // An error means that there are no readers.
        let _readers = self.ends.records.send(record);
        (self.config.wake)();
    }

    /// Updates and publishes the statistics.
    pub(crate) fn count(&mut self, bus: &dyn Bus) {
        let all = self.closed_wires.plus(bus.counts());
        self.counters.stats.checksum_errors = all.checksum_errors;
        self.counters.stats.resyncs = all.resyncs;
        self.counters.stats.foreign_replies = all.foreign_replies;
        self.counters.stats.late_replies = all.late_replies;
        self.others.overheard(all.foreign_requests, self.now());
        self.counters.stats.foreign_requests = all.foreign_requests + self.others.changes;
        let now = self.now();
        self.counters.digest(now);
        if let Some(line) = self.counters.line.figures(&self.plan, now) {
            self.counters.stats.line = line;
        }
        self.ends.stats.send_replace(self.counters.stats);
    }
}

impl Drop for Session {
    /// Reports the hand at rest if it is disarmed and its last stop, if any, was confirmed or alarmed: the user knows
    /// its state.
    fn drop(&mut self) {
        let is_held = self.motion.hold.is_none_or(|hold| hold.alarmed);
        if self.status.armed.is_none() && is_held {
            self.guard.rests();
        }
    }
}

/// Ignores every failure but a lost wire, which ends the session.
pub(crate) fn unless_lost(done: Result<(), BusError>) -> Result<(), WireEnd> {
    match done {
        Err(BusError::Lost(error)) => Err(WireEnd::Lost(error.into())),
        _ => Ok(()),
    }
}

/// Resolves when the handle is dropped.
pub(crate) async fn closed(wanted: Arc<watch::Sender<PendingControl>>) {
    let mut wanted = wanted.subscribe();
    let _gone = wanted.wait_for(|wanted| wanted.closed).await;
}

/// Resolves when a stop is requested or the handle is dropped.
pub(crate) async fn stopped(wanted: Arc<watch::Sender<PendingControl>>) {
    let mut wanted = wanted.subscribe();
    let _asked = wanted.wait_for(|wanted| wanted.stop || wanted.closed).await;
}
