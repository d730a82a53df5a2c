//! The interface of a motion over time: a pure state machine with readings, time and user input in, orders out. `drive` runs it and
//! owns the safety rules.

use crate::hand::{AngleReading, ArmEpoch, Groups, HandSample, Moment, PerDof, Setpoints, Timed};
use crate::link::{ArmRequest, LinkStatus, Owner, PollRates};
use crate::record::{Abort, ArmRefusal, Disarmed};
use crate::trials::limits::TaskStall;
use std::time::Duration;

/// Result of a program: its own outcome, or the reason for an early end.
pub type Ended<O> = Result<O, Abort>;

/// Progress of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Progress<V, E> {
    /// Its state changed, as a window shows it.
    View(V),
    /// These setpoints were sent; joints with `None` are unchanged.
    Sent(Setpoints),
    /// Something that its results contain.
    Event(E),
}

/// Time that a leg of a motion may take beyond the time its speed implies.
pub const LEG_SPARE: Duration = Duration::from_secs(4);

/// Action that a program requests from the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Send these targets and limits.
    Set(Setpoints),
    /// Stop the hand before anything else; this disarms it.
    Stop,
    /// Pass no further setpoints. The program may continue with a hand that must not move.
    Disarm,
    /// Grant control to this owner, at the user's request.
    Grant(Owner),
    /// Arm the hand within these limits. For programs that were granted control and arm by themselves.
    Arm(ArmRequest),
    /// Disarm a hand that has nothing to do. Control remains granted, and the program may arm again.
    Rest,
    /// Clear the faults of the drives. Feedback shows whether that succeeded.
    Clear,
    /// Stop and disarm. Control remains granted, and the program may arm again.
    Halt,
    /// Halt automatically at this moment, unless a later order extends the deadline.
    RunUntil(Moment),
    /// Stop, disarm and return control, with this reason.
    GiveBack(Disarmed),
}

/// Reaction of the loop to an early end (`handscope help safety` has the table). By then the session has disarmed the hand, and held
/// it where the common rules require that. An owner that was granted control meanwhile is not affected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterAbort {
    /// Stop the hand, also after a reconnect or while another controller moves it, and wait for rest: the hand may be unattended.
    Stop,
    /// Stop a hand whose link was lost, once it is back. The loop does not wait for that.
    StopAfterLinkLoss,
    /// Nothing: the user at the window decides.
    Nothing,
}

/// State of the hand in one step.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Status of the link.
    pub status: &'a LinkStatus,
    /// Newest value of every reading.
    pub sample: &'a HandSample,
    /// Most recent interval in which the loop did not run.
    pub stall: Option<TaskStall>,
    /// Time of this step.
    pub now: Moment,
}

impl Seen<'_> {
    /// Measured angles, if they are fresh enough to steer by.
    pub fn angles(&self) -> Option<Timed<PerDof<AngleReading>>> {
        let fresh_for = self.status.fresh_for();
        let angle = self.sample.angle;
        angle.filter(|angle| angle.age(self.now) <= fresh_for)
    }
}

/// A motion over time, under an arming or control that the user granted.
pub trait Program {
    /// User input while the program runs. For a program that can only be ended this is [`Abort`], which ends it.
    type Input;
    /// Outcome of a program that was not ended early.
    type Outcome: Copy;
    /// Its state for display.
    type View: Clone + PartialEq;
    /// Something that its results contain, such as a finished trial.
    type Event;
    /// Poll rates requested throughout; `None` leaves them unchanged.
    const RATES: Option<PollRates> = None;
    /// Reaction of the loop to an early end.
    const AFTER_ABORT: AfterAbort = AfterAbort::Stop;

    /// Poll rates requested now; `None` leaves them unchanged.
    fn rates(&self) -> Option<PollRates> {
        Self::RATES
    }
    /// Receives user input.
    fn input(&mut self, input: Self::Input, seen: &Seen<'_>) -> Option<Order>;
    /// Receives a reading.
    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment);
    /// Receives the answer to [`Order::Arm`].
    fn armed(&mut self, _answer: Result<ArmEpoch, ArmRefusal>) -> Option<Order> {
        None
    }
    /// Receives the end of the input stream. By default this means that the caller moves the hand in another way.
    fn input_ended(&mut self, seen: &Seen<'_>) -> Option<Order> {
        self.abort(Abort::TakenOver, seen.now);
        None
    }
    /// Receives the time at which a setpoint was sent on the wire.
    fn sent(&mut self, _at: Moment) {}
    /// Receives an interval in which the loop did not run.
    fn stalled(&mut self, _stall: TaskStall) {}
    /// Advances the time.
    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order>;
    /// Ends the program early, or ends its control of the hand if it continues: then it moves nothing before [`Order::Grant`].
    fn abort(&mut self, why: Abort, now: Moment);
    /// State for display.
    fn view(&self, now: Moment) -> Self::View;
    /// The next event that was not reported yet.
    fn event(&mut self) -> Option<Self::Event> {
        None
    }
    /// Result of the program; `None` while it runs. After `Err` the loop stops the hand.
    fn ended(&self) -> Option<Ended<Self::Outcome>>;
}
