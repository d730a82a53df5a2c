//! A hold as a part of another program, which keeps control of the hand: its end neither stops nor disarms the hand.

use crate::hand::grip::Tightened;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Groups, HandSample, Moment, PerDof, Setpoints, Target,
};
use crate::link::ArmRequest;
use crate::motion::hold::{HoldEnd, HoldPhase, HoldRun, HoldStart, HoldView};
use crate::motion::program::{Order, Program as _, Seen};

/// A hold that another program hosts.
#[derive(Debug)]
pub(crate) struct HostedHold {
    run: HoldRun,
    epoch: ArmEpoch,
    /// Highest speeds and force thresholds that the host passes on.
    limits: ArmRequest,
}

impl HostedHold {
    /// A hold under this arming of its host, within these limits.
    pub(crate) fn new(epoch: ArmEpoch, start: HoldStart, limits: ArmRequest, now: Moment) -> Self {
        Self {
            run: HoldRun::new(epoch, start, now),
            epoch,
            limits,
        }
    }

    /// Arming under which it moves the hand.
    pub(crate) const fn epoch(&self) -> ArmEpoch {
        self.epoch
    }

    /// Receives a reading.
    pub(crate) fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        self.run.read(sample, fresh, now);
    }

    /// Advances the time; returns what to send, nothing of it to locked joints. Where a hold of its own would stop the hand, the
    /// measured angles become the targets.
    pub(crate) fn tick(&mut self, seen: &Seen<'_>, locked: &PerDof<bool>) -> Option<Setpoints> {
        let mut setpoints = match self.run.tick(seen)? {
            Order::Set(setpoints) => setpoints,
            Order::Stop => stay(self.epoch, seen)?,
            _ => return None,
        };
        for (dof, is_locked) in locked.iter() {
            setpoints.angle[dof] = setpoints.angle[dof].filter(|_| !is_locked);
            let speed = setpoints.speed[dof].filter(|_| !is_locked);
            setpoints.speed[dof] = speed.map(|speed| speed.min(self.limits.speed[dof]));
            let force = setpoints.force[dof].filter(|_| !is_locked);
            setpoints.force[dof] = force.map(|force| force.min(self.limits.force[dof]));
        }
        (!setpoints.is_empty()).then_some(setpoints)
    }

    /// State for display.
    pub(crate) fn view(&self, now: Moment) -> HoldView {
        self.run.view(now)
    }

    /// The next finger that pressed harder and was not reported yet.
    pub(crate) fn event(&mut self) -> Option<Tightened> {
        self.run.event()
    }

    /// How it ended; `None` while it runs.
    pub(crate) fn end(&self) -> Option<HoldEnd> {
        self.run.ended()?.ok()
    }

    /// True once it keeps what is held: without further setpoints, position and thresholds stay.
    pub(crate) fn is_holding(&self, now: Moment) -> bool {
        let phase = self.view(now).phase;
        matches!(phase, HoldPhase::Holding | HoldPhase::CannotHold)
    }
}

/// The measured angles as targets; `None` unless all are known and fresh.
pub(crate) fn stay(epoch: ArmEpoch, seen: &Seen<'_>) -> Option<Setpoints> {
    let pose: PerDof<Angle> = seen.angles()?.value.map(AngleReading::hold).all()?;
    let mut setpoints = Setpoints::none(epoch);
    setpoints.angle = pose.map(|at| Some(Target::Go(at)));
    Some(setpoints)
}
