//! The calibration of the force sensors: what must be so before, and the offsets before and after. Pure; sends nothing.

use crate::hand::{Dof, Finger, ForceReading, HandSample, Moment, PerDof, Status};
use crate::link::{Calibrated, LinkState, LinkStatus};
use std::collections::VecDeque;
use std::time::Duration;

/// An angle from here on counts as open: what drivers of this family ask for before a calibration.
pub const OPEN_FROM: i16 = 950;
/// A force beyond this is more than any offset of a hand at rest, g.
pub const FREE_BELOW_G: u16 = 400;
/// A fingertip that feels more than this is touched, N.
pub const TOUCH_N: f32 = 0.3;
/// How long the force has to be steady.
const STEADY_FOR: Duration = Duration::from_secs(2);
/// By how much it may change in that time, g.
const STEADY_G: i16 = 20;
/// Samples that are looked at: two seconds of the fastest wire.
const SAMPLES_MAX: usize = 512;
/// Samples older than this say nothing of now.
const FRESH_FOR: Duration = Duration::from_millis(500);
/// After the end the new offset is measured for so long.
const MEASURE_FOR: Duration = Duration::from_millis(1500);

/// What it takes at most (manual 2.6.6: about six seconds).
const TAKES: Duration = Duration::from_secs(8);

/// What must be so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Check {
    /// Every joint is open.
    Open,
    /// No joint moves.
    Still,
    /// No force, and no fingertip feels anything.
    Untouched,
    /// The force does not change.
    Steady,
    /// No drive has a fault.
    NoFault,
    /// Nothing is armed, by this program; no stop is under way.
    Disarmed,
}

impl Check {
    /// All, in the order in which a person sees to them.
    pub const ALL: [Self; 6] = [
        Self::Disarmed,
        Self::NoFault,
        Self::Open,
        Self::Still,
        Self::Untouched,
        Self::Steady,
    ];
}

/// Forces by joint, g.
pub type Offsets = PerDof<i16>;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Stage {
    #[default]
    Asking,
    Sending {
        since: Moment,
    },
    Measuring {
        until: Moment,
    },
    Over,
}

/// One calibration.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Calibration {
    stage: Stage,
    forces: VecDeque<(Moment, Offsets)>,
    before: Option<Offsets>,
    after: Option<Offsets>,
    end: Option<Calibrated>,
}

impl Calibration {
    /// Takes in the newest force.
    pub fn watch(&mut self, sample: &HandSample) {
        let Some(force) = sample.force else { return };
        if self.forces.back().is_some_and(|last| last.0 >= force.asked) {
            return;
        }
        if self.forces.len() >= SAMPLES_MAX {
            self.forces.pop_front();
        }
        let grams = force.value.map(ForceReading::raw);
        self.forces.push_back((force.asked, grams));
        let from = force.asked;
        while let Some((at, _)) = self.forces.front()
            && from.since(*at) > STEADY_FOR + FRESH_FOR
        {
            self.forces.pop_front();
        }
    }

    /// Whether something is so; `None` = not known.
    #[must_use]
    pub fn check(
        &self,
        check: Check,
        sample: &HandSample,
        link: &LinkStatus,
        now: Moment,
    ) -> Option<bool> {
        let fresh = |asked: Moment| link.state.is_live() && now.since(asked) <= FRESH_FOR;
        match check {
            Check::Disarmed => match link.state {
                LinkState::Offline | LinkState::Identifying => None,
                state => Some(!matches!(state, LinkState::Armed | LinkState::Holding)),
            },
            Check::NoFault => {
                let all = sample.faults.filter(|all| fresh(all.asked))?;
                Some(all.value.iter().all(|(_, faults)| faults.is_empty()))
            }
            Check::Open => {
                let all = sample.angle.filter(|all| fresh(all.asked))?;
                let is_open =
                    |dof: Dof| dof == Dof::ThumbRotate || all.value[dof].raw() >= OPEN_FROM;
                Some(Dof::ALL.into_iter().all(is_open))
            }
            Check::Still => {
                let all = sample.status.filter(|all| fresh(all.asked))?;
                let moves =
                    |status: &Status| matches!(status, Status::Releasing | Status::Grasping);
                Some(!all.value.iter().any(|(_, status)| moves(status)))
            }
            Check::Untouched => {
                let all = sample.force.filter(|all| fresh(all.asked))?;
                let free = |force: &ForceReading| force.raw().unsigned_abs() <= FREE_BELOW_G;
                Some(all.value.iter().all(|(_, force)| free(force)) && is_untouched(sample)?)
            }
            Check::Steady => self.is_steady(now),
        }
    }

    fn is_steady(&self, now: Moment) -> Option<bool> {
        let (first, last) = (self.forces.front()?, self.forces.back()?);
        if now.since(last.0) > FRESH_FOR || last.0.since(first.0) < STEADY_FOR {
            return None;
        }
        Some(Dof::ALL.into_iter().all(|dof| {
            let all = self.forces.iter().map(|(_, forces)| forces[dof]);
            let (least, most) = (all.clone().min(), all.max());
            let spread = least
                .zip(most)
                .map(|(least, most)| most.saturating_sub(least));
            spread.is_some_and(|spread| spread <= STEADY_G)
        }))
    }

    /// True if all of it is so.
    #[must_use]
    pub fn is_ready(&self, sample: &HandSample, link: &LinkStatus, now: Moment) -> bool {
        let is_so = |check| self.check(check, sample, link, now) == Some(true);
        Check::ALL.into_iter().all(is_so)
    }

    /// A person said yes, and all is as it must be.
    pub fn begin(&mut self, now: Moment) {
        self.before = self.mean();
        self.stage = Stage::Sending { since: now };
    }

    /// What came of it; `None` = it was not sent.
    pub fn ended(&mut self, end: Option<Calibrated>, now: Moment) {
        let is_done = matches!(end, Some(Calibrated::Finished | Calibrated::Quiet));
        self.end = end;
        self.forces.clear();
        self.stage = if is_done {
            let until = now.plus(MEASURE_FOR);
            Stage::Measuring { until }
        } else {
            Stage::Over
        };
    }

    /// Time goes by: after the end the new offsets are measured.
    pub fn tick(&mut self, sample: &HandSample, now: Moment) {
        let Stage::Measuring { until } = self.stage else {
            return;
        };
        let since = Moment::from_duration(until.since(Moment::ZERO).saturating_sub(MEASURE_FOR));
        if sample.force.is_some_and(|force| force.asked >= since) {
            self.watch(sample);
        }
        if until <= now {
            self.after = self.mean();
            self.stage = Stage::Over;
        }
    }

    /// True while the request is to be asked, or is under way.
    #[must_use]
    pub const fn is_sending(&self) -> bool {
        matches!(self.stage, Stage::Sending { .. })
    }

    /// How far it is, from 0 to 1, by the time that it usually takes.
    #[must_use]
    pub fn part(&self, now: Moment) -> f32 {
        match self.stage {
            Stage::Asking => 0.0,
            Stage::Sending { since } => now.since(since).as_secs_f32() / TAKES.as_secs_f32(),
            Stage::Measuring { .. } | Stage::Over => 1.0,
        }
    }

    /// True while the new offsets are measured.
    #[must_use]
    pub const fn is_measuring(&self) -> bool {
        matches!(self.stage, Stage::Measuring { .. })
    }

    /// True once it is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.stage == Stage::Over
    }

    /// What came of it; `None` until then, and if it was not sent.
    #[must_use]
    pub const fn end(&self) -> Option<&Calibrated> {
        self.end.as_ref()
    }

    /// The offsets before and after, as far as they were measured.
    #[must_use]
    pub const fn offsets(&self) -> (Option<Offsets>, Option<Offsets>) {
        (self.before, self.after)
    }

    fn mean(&self) -> Option<Offsets> {
        let count = i64::try_from(self.forces.len())
            .ok()
            .filter(|count| *count > 0)?;
        Some(PerDof::from_fn(|dof| {
            let all = self.forces.iter().map(|(_, forces)| i64::from(forces[dof]));
            i16::try_from(all.sum::<i64>() / count).unwrap_or_default()
        }))
    }
}

/// Whether no fingertip feels anything; `None` where one was never read.
fn is_untouched(sample: &HandSample) -> Option<bool> {
    let mut is_free = true;
    for finger in Finger::ALL {
        let block = sample.tactile[finger]?.value;
        is_free &= block.normal().is_none_or(|newton| newton.abs() <= TOUCH_N);
    }
    Some(is_free)
}
