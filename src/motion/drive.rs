//! The loop that moves an armed hand by a program, with the rules that apply to all programs: control, link loss, faults, arming,
//! another controller, stalls, and the stop that follows an early end.

use crate::hand::{ArmEpoch, HandCommand, HandSample, Moment, Setpoints};
use crate::link::{Clock, Lease, LeaseRefusal, LinkHandle, LinkStatus, PollRates, Records, Stop};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::record::{Abort, ArmRefusal, Disarmed, LinkState, Record, SetpointConflict, WriteCause};
use crate::trials::limits::{TaskStall, fault, heat_reason};
use futures::future::BoxFuture;
use futures::{FutureExt as _, Stream, StreamExt as _};
use std::pin::pin;
use std::time::Duration;
use tokio::time::timeout;

/// Maximum wait for a reading while the hand is armed, …
const TICK: Duration = Duration::from_millis(5);
/// … and while it must not move.
const IDLE_TICK: Duration = Duration::from_millis(50);
/// A turn of the loop that exceeds its tick by this much is a stall.
const STALL_MARGIN: Duration = Duration::from_millis(45);
/// After a stall of this length the computer may have slept: the session decides that first, within the grace. A program would take
/// its own time limits for exceeded.
const SLEEP_LEAST: Duration = Duration::from_secs(1);
const SLEEP_GRACE: Duration = Duration::from_millis(100);

/// An arming by the user, and the newest readings.
#[derive(Debug, Clone, Copy)]
pub struct Armed {
    /// The arming.
    pub epoch: ArmEpoch,
    /// The right to move the hand.
    pub lease: Lease,
    /// Newest readings.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// State in which a program starts.
#[derive(Debug, Clone, Copy)]
pub struct DriveStart {
    /// Party that arms the hand.
    pub armed_by: ArmedBy,
    /// The right to move the hand; `None` for a program that waits until the user grants it.
    pub lease: Option<Lease>,
    /// Newest readings.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// Party that arms the hand for a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArmedBy {
    /// The user armed. The program ends with this arming.
    User(ArmEpoch),
    /// The program arms, as often as it needs. It ends with its lease.
    Program,
    /// No party: the program disarmed the hand, which must not move.
    Nobody,
}

impl From<Armed> for DriveStart {
    fn from(armed: Armed) -> Self {
        Self {
            armed_by: ArmedBy::User(armed.epoch),
            lease: Some(armed.lease),
            seen: armed.seen,
            clock: armed.clock,
        }
    }
}

/// A program that has ended.
#[derive(Debug)]
pub struct Driven<P: Program> {
    /// The program, with its results.
    pub program: P,
    /// Its outcome, or the reason for an early end.
    pub end: Ended<P::Outcome>,
    /// Result of the stop that followed, as feedback shows it; `None` if the hand was not stopped.
    pub stop: Option<Stop>,
}

impl<P: Program> Driven<P> {
    /// Returns the reason for an early end, and the result of the stop.
    pub fn report(&self) -> EndReport {
        EndReport {
            aborted: self.end.err(),
            stop: self.stop,
        }
    }
}

/// End of a program, for reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndReport {
    /// Reason for an early end; `None` if the program ended by itself.
    pub aborted: Option<Abort>,
    /// Result of the stop that followed, as feedback shows it; `None` if the hand was not stopped.
    pub stop: Option<Stop>,
}

/// Runs a program to its end. `report` receives its progress after each step, and returns false if it could not store or show it; the
/// program is then aborted. The end of `inputs` means that the caller moves the hand in another way.
pub async fn drive<P: Program>(
    hand: &LinkHandle,
    start: impl Into<DriveStart>,
    mut program: P,
    inputs: impl Stream<Item = P::Input>,
    report: impl FnMut(Progress<P::View, P::Event>) -> bool,
) -> Driven<P> {
    let start = start.into();
    let clock = start.clock;
    let mut at = Driving {
        hand,
        records: hand.records(),
        sample: start.seen,
        armed_by: start.armed_by,
        lease: start.lease,
        foreign: None,
        arming: None,
        turns: Turns::from(clock.now()),
    };
    let mut inputs = pin!(inputs);
    let mut reporter = Reporter {
        report,
        shown: None,
        clock,
    };
    let (mut stop, mut rates) = (None, None);
    while program.ended().is_none() {
        let requested = program.rates();
        if std::mem::replace(&mut rates, requested) != requested {
            hand.read_at(requested.unwrap_or_default());
        }
        let is_armed = hand.status().armed.is_some();
        let tick = if is_armed { TICK } else { IDLE_TICK };
        let (mut input, record) = tokio::select! {
            biased;
            // A source that sends without a pause delays no reading.
            input = inputs.next() => (Some(input), at.records.try_next()),
            record = timeout(tick, at.records.next()) => (None, record.ok().flatten()),
        };
        if let Some(stall) = at.turns.turn(clock.now(), tick) {
            program.stalled(stall);
        }
        at.read(&mut program, record, clock.now());
        // Before the status, which then shows the arming.
        let answer = at.answered();
        let status = hand.status();
        let is_broken = at.broken(&status);
        if is_broken {
            // The user may have ended it in the same moment, and the newest readings may show the cause.
            input = input.or_else(|| inputs.next().now_or_never());
            while let Some(record) = at.records.try_next() {
                at.read(&mut program, Some(record), clock.now());
            }
        }
        let sample = at.sample;
        let seen = Seen {
            status: &status,
            sample: &sample,
            stall: at.turns.stall,
            now: clock.now(),
        };
        let follow_up = answer.and_then(|answer| program.armed(answer));
        follow_up.and_then(|order| at.execute(order, &status));
        let mut order = match input {
            Some(Some(input)) => program.input(input, &seen),
            Some(None) => program.input_ended(&seen),
            None => None,
        };
        let mut sent = order.and_then(|order| at.execute(order, &status));
        if program.ended().is_none() && is_broken {
            program.abort(at.cause(&status, clock.now()), clock.now());
            // A program that continues has no control until control is granted again.
            at.lease = None;
        } else if program.ended().is_none() && sent.is_none() && !at.turns.may_have_slept(seen.now)
        {
            order = program.tick(&seen);
            sent = order.and_then(|order| at.execute(order, &status));
        }
        if !reporter.report(&mut program, sent) {
            program.abort(Abort::NotKept, clock.now());
        }
        match (program.ended(), P::AFTER_ABORT) {
            (Some(Err(Abort::TakenOver)), _) => {}
            (Some(Err(Abort::NotKept)), _) | (Some(Err(_)), AfterAbort::Stop) => {
                stop = Some(hand.stop().await);
            }
            (Some(Err(Abort::LinkLost)), AfterAbort::StopAfterLinkLoss) => drop(hand.stop()),
            (Some(_), _) if order == Some(Order::Stop) => stop = Some(hand.stop().await),
            (None, _) if order == Some(Order::Stop) => drop(hand.stop()),
            _ => {}
        }
    }
    reporter.report(&mut program, None);
    if rates.is_some() {
        hand.read_at(PollRates::default());
    }
    let end = program.ended().unwrap_or(Err(Abort::TakenOver));
    Driven { program, end, stop }
}

/// Reports the progress of a program to its caller.
struct Reporter<P: Program, F> {
    report: F,
    /// The state that was reported last.
    shown: Option<P::View>,
    clock: Clock,
}

impl<P: Program, F: FnMut(Progress<P::View, P::Event>) -> bool> Reporter<P, F> {
    /// Reports what is new, with the setpoints sent in this step; false if it could not be stored or shown.
    fn report(&mut self, program: &mut P, sent: Option<Setpoints>) -> bool {
        let mut is_kept = sent.is_none_or(|sent| (self.report)(Progress::Sent(sent)));
        while let Some(event) = program.event() {
            is_kept &= (self.report)(Progress::Event(event));
        }
        let view = program.view(self.clock.now());
        if self.shown.as_ref() != Some(&view) {
            self.shown = Some(view.clone());
            is_kept &= (self.report)(Progress::View(view));
        }
        is_kept
    }
}

struct Driving<'a> {
    hand: &'a LinkHandle,
    records: Records,
    sample: HandSample,
    armed_by: ArmedBy,
    lease: Option<Lease>,
    /// Foreign setpoint that was already known when the program disarmed the hand.
    foreign: Option<SetpointConflict>,
    /// The arming that the program requested.
    arming: Option<BoxFuture<'static, Result<ArmEpoch, ArmRefusal>>>,
    turns: Turns,
}

impl Driving<'_> {
    /// The answer to the last arming request, once there is one.
    fn answered(&mut self) -> Option<Result<ArmEpoch, ArmRefusal>> {
        let answer = self.arming.as_mut()?.now_or_never()?;
        self.arming = None;
        Some(answer)
    }

    fn read<P: Program>(&mut self, program: &mut P, record: Option<Record>, now: Moment) {
        match record {
            Some(Record::Reading { sample, fresh }) => {
                self.sample = *sample;
                program.read(&self.sample, fresh, now);
            }
            Some(Record::Sent {
                at,
                cause: WriteCause::Setpoint,
                ..
            }) => program.sent(at),
            _ => {}
        }
    }

    /// Executes an order; returns the setpoints that were sent, if any.
    fn execute(&mut self, order: Order, status: &LinkStatus) -> Option<Setpoints> {
        let (hand, lease) = (self.hand, self.lease);
        // Under an ended lease no order is executed, and the next step ends the program.
        let under = |act: &dyn Fn(Lease) -> Result<(), LeaseRefusal>| {
            lease.is_some_and(|lease| act(lease).is_ok())
        };
        let _is_done = match order {
            Order::Set(setpoints) => {
                let is_sent = !setpoints.is_empty() && under(&|lease| hand.set(lease, &setpoints));
                return is_sent.then_some(setpoints);
            }
            Order::Arm(request) => {
                let asked = lease.and_then(|lease| hand.arm(lease, request).ok());
                self.arming = asked.map(IntoFuture::into_future);
                self.arming.is_some()
            }
            Order::Rest => under(&|lease| hand.rest(lease)),
            Order::Halt => under(&|lease| hand.halt(lease)),
            Order::RunUntil(until) => under(&|lease| hand.run_until(lease, until)),
            Order::GiveBack(why) => under(&|lease| hand.give_back(lease, why)),
            Order::Grant(owner) => self.lease.replace(hand.grant(owner)).is_none(),
            Order::Disarm => {
                hand.disarm();
                (self.armed_by, self.foreign) = (ArmedBy::Nobody, status.foreign_setpoint);
                true
            }
            Order::Clear => {
                let hand = hand.clone();
                tokio::spawn(async move { hand.write(HandCommand::ClearErrors).await });
                true
            }
            // The loop stops the hand after the report.
            Order::Stop => true,
        };
        None
    }

    /// Reason for which control has ended; `None` while it lasts.
    fn refusal(&self) -> Option<LeaseRefusal> {
        self.lease.and_then(|lease| self.hand.check(lease).err())
    }

    /// True if the conditions under which the program may run no longer hold.
    fn broken(&self, status: &LinkStatus) -> bool {
        let is_refused = || self.refusal().is_some();
        match self.armed_by {
            ArmedBy::User(epoch) => {
                let is_armed = status.armed == Some(epoch) && status.state != LinkState::Fault;
                !status.state.is_live() || !is_armed || is_refused()
            }
            ArmedBy::Program => is_refused(),
            ArmedBy::Nobody => {
                let is_moved = status.armed.is_some() || status.foreign_setpoint != self.foreign;
                !status.state.is_live() || is_moved
            }
        }
    }

    /// Reason for which the program must end.
    fn cause(&self, status: &LinkStatus, now: Moment) -> Abort {
        let wrote = status.foreign_setpoint;
        if !status.state.is_live() {
            return Abort::LinkLost;
        }
        if self.armed_by == ArmedBy::Nobody {
            return match status.armed {
                Some(_) => Abort::ArmedAnew,
                None => Abort::OtherController { wrote },
            };
        }
        let refused = self.refusal();
        if let Some(LeaseRefusal::Taken(_)) = refused {
            return Abort::TakenOver;
        }
        let ended = match refused {
            Some(LeaseRefusal::Ended(why)) => Some(why),
            _ => status.disarmed,
        };
        if ended == Some(Disarmed::LinkLost) {
            return Abort::LinkLost;
        }
        // While the hand is stopped for a fault, its state reports only the stop.
        let by_fault = status.state == LinkState::Fault || ended == Some(Disarmed::Fault);
        if let Some(why) = fault(&self.sample).or(by_fault.then_some(Abort::Fault { joint: None }))
        {
            return why;
        }
        let is_anew = |epoch| ArmedBy::User(epoch) != self.armed_by;
        if refused.is_none() && status.armed.is_some_and(is_anew) {
            return Abort::ArmedAnew;
        }
        let by_heat = match ended {
            Some(Disarmed::OtherController) => return Abort::OtherController { wrote },
            Some(Disarmed::Hot | Disarmed::HeatUnknown) => {
                heat_reason(&self.sample, self.turns.stall, now)
            }
            _ => None,
        };
        by_heat.unwrap_or(Abort::Disarmed { why: ended })
    }
}

/// The turns of the loop, and the newest stall between two of them.
struct Turns {
    last: Moment,
    stall: Option<TaskStall>,
}

impl Turns {
    const fn from(now: Moment) -> Self {
        Self {
            last: now,
            stall: None,
        }
    }

    fn may_have_slept(&self, now: Moment) -> bool {
        let long = self.stall.filter(|stall| stall.lasted >= SLEEP_LEAST);
        long.is_some_and(|stall| now.since(stall.ended) < SLEEP_GRACE)
    }

    /// Counts a turn that was due after `tick`; returns the stall before it, if there was one.
    fn turn(&mut self, now: Moment, tick: Duration) -> Option<TaskStall> {
        let lasted = now.since(self.last);
        self.last = now;
        let stall = (lasted > tick + STALL_MARGIN).then_some(TaskStall { lasted, ended: now });
        self.stall = stall.or(self.stall);
        stall
    }
}

/// Text on the result of a stop that followed an early end, to be appended to the reason.
pub fn stop_words(stop: Option<Stop>) -> String {
    match stop {
        None => String::new(),
        Some(Stop::Confirmed { after }) => {
            let after_s = after.as_secs_f64();
            format!("; stopped: feedback shows rest after {after_s:.2} s")
        }
        Some(Stop::NotConfirmed) => "; the stop is not confirmed by feedback".into(),
        Some(Stop::LinkLost) => format!("; {STOP_LOST}"),
    }
}

/// Shown if a stop cannot be confirmed because there is no feedback.
pub const STOP_LOST: &str =
    "the link is lost, so a stop cannot be confirmed: switch off the 24 V supply if the hand moves";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_comes_late_is_a_stall_of_this_program() {
        let at = |ms: u64| Moment::from_micros(1000 * ms);
        let mut turns = Turns::from(at(1000));
        for ms in (1005..1100).step_by(5) {
            assert_eq!(turns.turn(at(ms), TICK), None);
        }
        let stall = TaskStall {
            lasted: Duration::from_millis(405),
            ended: at(1500),
        };
        assert_eq!(turns.turn(at(1500), TICK), Some(stall));
        assert_eq!(turns.turn(at(1505), TICK), None);
        assert_eq!(turns.stall, Some(stall), "it is known until the next");
    }
}
