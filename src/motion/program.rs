//! What moves an armed hand over time, as a pure state machine: readings, time and user input in, orders out. `drive` runs it and owns
//! the safety rules.

use crate::hand::{AngleReading, Groups, HandSample, Moment, PerDof, Setpoints, Timed};
use crate::link::{ArmRequest, LinkStatus, Owner, PollRates};
use crate::record::{Abort, Disarmed};
use crate::trials::limits::TaskStall;

/// How a program ended: with its own outcome, or early.
pub type Ended<O> = Result<O, Abort>;

/// What a program wants done at the hand now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Send these targets and limits.
    Set(Setpoints),
    /// Stop the hand before anything else, which disarms it.
    Stop,
    /// Let no setpoint pass any longer. The program may continue with a hand that must not move.
    Disarm,
    /// Grant control to this owner: the user asked for it.
    Grant(Owner),
    /// Arm the hand within these limits. For programs that were granted control and arm by themselves.
    Arm(ArmRequest),
    /// Disarm a hand that has nothing to do. Control remains granted, and the program may arm again.
    Rest,
    /// Clear the faults of the drives. Whether that succeeded shows in feedback.
    Clear,
    /// Stop and disarm. Control remains granted, and the program may arm again.
    Halt,
    /// Halt at this moment by itself, unless that is put off before.
    RunUntil(Moment),
    /// Stop, disarm and give back control for this reason.
    GiveBack(Disarmed),
}

/// What the loop does after an early end (`handscope help safety` has the table). The session has disarmed the hand then, and held it
/// where that is the rule for all. Whoever was granted control meanwhile is left alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterAbort {
    /// Stop the hand, also one that is back from a lost link or that another controller moves, and wait for rest: nobody may be near.
    Stop,
    /// Stop a hand whose link was lost, once it is back. Nothing is waited for.
    StopAfterLinkLoss,
    /// Nothing: the user at the window decides.
    Nothing,
}

/// What is known of the hand in one step.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Status of the link.
    pub status: &'a LinkStatus,
    /// The newest of everything that was read.
    pub sample: &'a HandSample,
    /// The last time in which the loop did not run.
    pub stall: Option<TaskStall>,
    /// The time of this step.
    pub now: Moment,
}

impl Seen<'_> {
    /// The angles, if they are fresh enough to steer by.
    pub fn angles(&self) -> Option<Timed<PerDof<AngleReading>>> {
        let fresh_for = self.status.fresh_for();
        let angle = self.sample.angle;
        angle.filter(|angle| angle.age(self.now) <= fresh_for)
    }
}

/// A motion over time in an arming, or with control, that the user gave.
pub trait Program {
    /// What the user may send while it runs. A program that can only be ended has [`Abort`] here, and ends with it.
    type Input;
    /// How it ends when nothing ends it early.
    type Outcome: Copy;
    /// How often it wants the hand to be read; `None` leaves that as it is.
    const RATES: Option<PollRates> = None;
    /// What the loop does after an early end.
    const AFTER_ABORT: AfterAbort = AfterAbort::Stop;

    /// Receives user input.
    fn input(&mut self, input: Self::Input, seen: &Seen<'_>) -> Option<Order>;
    /// Receives a reading.
    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment);
    /// Receives the end of its input. By itself that means that whoever ran the program moves the hand in another way.
    fn input_ended(&mut self, seen: &Seen<'_>) -> Option<Order> {
        self.abort(Abort::TakenOver, seen.now);
        None
    }
    /// Receives that a setpoint went out on the wire.
    fn sent(&mut self, _at: Moment) {}
    /// Receives how long the loop did not run.
    fn stalled(&mut self, _stall: TaskStall) {}
    /// Advances the time.
    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order>;
    /// Ends it early, or ends its control of the hand if it continues: then it moves nothing before [`Order::Grant`].
    fn abort(&mut self, why: Abort, now: Moment);
    /// How it ended, once it has. After `Err` the loop stops the hand.
    fn ended(&self) -> Option<Ended<Self::Outcome>>;
}
