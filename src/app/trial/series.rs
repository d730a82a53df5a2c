//! A series of trials: which is next, the rest between, and what ends all. Sends nothing and reads no clock.

use crate::app::trial::metrics::{TrialMetrics, measure};
use crate::app::trial::plan::{Approach, PlanError, Setting, TrialPlan, Until};
use crate::app::trial::recording::Recording;
use crate::app::trial::runner::{Runner, Stage};
use crate::app::trial::watch::{Abort, LinkView, warmest};
use crate::hand::{Angle, Groups, HandSample, Moment, PerDof, Speed};
use crate::link::{ArmEpoch, Setpoints};
use std::collections::VecDeque;
use std::time::Duration;

/// Longest wait for a hand that is too warm to begin.
pub const COOLING_MAX: Duration = Duration::from_secs(900);
/// Speed at which the contact is looked for.
const PROBE_SPEED: Speed = Speed::SLOWEST_MEASURED;

/// What a trial is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Finds the contact, slowly.
    Probe,
    /// A cell of the grid.
    Trial {
        /// How often this setting was tried, this one included.
        repeat: usize,
    },
}

/// What to tell the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// New targets and limits.
    Set(Setpoints),
    /// Hold now, before anything else.
    Stop,
}

/// One trial that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// 1 the first.
    pub number: usize,
    /// What it was for.
    pub kind: Kind,
    /// Speed and threshold.
    pub setting: Setting,
    /// What was read.
    pub recording: Recording,
    /// What was measured.
    pub metrics: TrialMetrics,
    /// Why it ended early, if it did.
    pub aborted: Option<Abort>,
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    kind: Kind,
    setting: Setting,
}

#[derive(Debug, Clone)]
enum Phase {
    Waiting { since: Moment, rest: Duration },
    Running(Box<Runner>, Cell),
    Over,
}

/// A series on its way.
#[derive(Debug, Clone)]
pub struct Series {
    plan: TrialPlan,
    epoch: ArmEpoch,
    queue: VecDeque<Cell>,
    total: usize,
    phase: Phase,
    contact: PerDof<Option<Angle>>,
    number: usize,
    done: VecDeque<Trial>,
    aborted: Option<Abort>,
}

impl Series {
    /// Begins a series in an arming that a person gave. Nothing is sent before the first [`Self::tick`].
    ///
    /// # Errors
    /// [`PlanError`]: the plan makes no sense, and nothing begins.
    pub fn start(plan: TrialPlan, epoch: ArmEpoch, now: Moment) -> Result<Self, PlanError> {
        plan.check()?;
        let queue = cells(&plan);
        Ok(Self {
            total: queue.len(),
            queue,
            phase: Phase::Waiting {
                since: now,
                rest: Duration::ZERO,
            },
            plan,
            epoch,
            contact: PerDof::splat(None),
            number: 0,
            done: VecDeque::new(),
            aborted: None,
        })
    }

    /// True once nothing is sent any more.
    #[must_use]
    pub const fn is_over(&self) -> bool {
        matches!(self.phase, Phase::Over)
    }

    /// Why it ended early, if it did.
    #[must_use]
    pub const fn aborted(&self) -> Option<Abort> {
        self.aborted
    }

    /// Trials that began, and trials in all.
    #[must_use]
    pub const fn progress(&self) -> (usize, usize) {
        (self.number, self.total)
    }

    /// What the hand does now.
    #[must_use]
    pub fn stage(&self) -> Stage {
        match &self.phase {
            Phase::Waiting { .. } => Stage::Resting,
            Phase::Running(runner, _) => runner.stage(),
            Phase::Over => Stage::Over,
        }
    }

    /// The setting of the trial of now; `None` between two.
    #[must_use]
    pub const fn setting(&self) -> Option<Setting> {
        match &self.phase {
            Phase::Running(_, cell) => Some(cell.setting),
            Phase::Waiting { .. } | Phase::Over => None,
        }
    }

    /// Whether the trial of now looks for the contact.
    #[must_use]
    pub fn is_probing(&self) -> bool {
        matches!(&self.phase, Phase::Running(_, cell) if cell.kind == Kind::Probe)
    }

    /// What was read in the trial of now; `None` between two.
    #[must_use]
    pub fn recording(&self) -> Option<&Recording> {
        match &self.phase {
            Phase::Running(runner, _) => Some(runner.recording()),
            Phase::Waiting { .. } | Phase::Over => None,
        }
    }

    /// The settings of the trials that did not begin yet.
    pub fn ahead(&self) -> impl Iterator<Item = Setting> {
        self.queue.iter().map(|cell| cell.setting)
    }

    /// The next trial that is over. Each is given once.
    pub fn finished(&mut self) -> Option<Trial> {
        self.done.pop_front()
    }

    /// Ends it. Gives the stop that has to follow, if it ran.
    pub fn end(&mut self, why: Abort, now: Moment) -> Option<Order> {
        if self.is_over() {
            return None;
        }
        if let Phase::Running(runner, _) = &mut self.phase {
            runner.abort(why, now);
        }
        Some(self.fail(why))
    }

    /// Keeps what was read.
    pub fn take(&mut self, sample: &HandSample, fresh: Groups) {
        if let Phase::Running(runner, _) = &mut self.phase {
            runner.take(sample, fresh);
        }
    }

    /// Lets time pass. What to tell the link now, if anything.
    pub fn tick(&mut self, sample: &HandSample, link: LinkView, now: Moment) -> Option<Order> {
        match &mut self.phase {
            Phase::Waiting { since, rest } => {
                let (since, rest) = (*since, *rest);
                self.wait(sample, link, Wait { since, rest, now })
            }
            Phase::Running(runner, _) => {
                let setpoints = runner.tick(sample, link, now);
                match runner.ending() {
                    None => setpoints.map(Order::Set),
                    Some(Err(why)) => Some(self.fail(why)),
                    Some(Ok(())) => self.next(now),
                }
            }
            Phase::Over => None,
        }
    }

    fn wait(&mut self, sample: &HandSample, link: LinkView, wait: Wait) -> Option<Order> {
        let Wait { since, rest, now } = wait;
        if !link.state.is_live() {
            return Some(self.fail(Abort::LinkLost));
        }
        if link.armed != Some(self.epoch) {
            return Some(self.fail(Abort::Disarmed));
        }
        if now.since(since) < rest {
            return None;
        }
        let limit = self.plan.limits.start_c;
        // Temperatures that are not known yet are waited for; the trial itself does not begin without them.
        let (dof, celsius) = warmest(sample)?;
        if celsius >= limit {
            let waited = now.since(since) >= rest + COOLING_MAX;
            return waited.then(|| {
                self.fail(Abort::TooWarm {
                    dof,
                    celsius,
                    limit,
                })
            });
        }
        let Some(cell) = self.queue.pop_front() else {
            self.phase = Phase::Over;
            return None;
        };
        self.number += 1;
        let plan = match cell.kind {
            Kind::Probe => TrialPlan {
                approach: Approach::OneStage,
                ..self.plan.clone()
            },
            Kind::Trial { .. } => self.plan.clone(),
        };
        let runner = Runner::new(&plan, cell.setting, &self.contact, self.epoch);
        self.phase = Phase::Running(Box::new(runner), cell);
        self.tick(sample, link, now)
    }

    /// A trial is over as it should be.
    fn next(&mut self, now: Moment) -> Option<Order> {
        let trial = self.close_trial()?;
        let missing = self.learn(&trial);
        self.done.push_back(trial);
        if let Some(why) = missing {
            return Some(self.fail(why));
        }
        self.phase = if self.queue.is_empty() {
            Phase::Over
        } else {
            Phase::Waiting {
                since: now,
                rest: self.plan.grid.rest,
            }
        };
        None
    }

    /// Takes the contact angles of a probe; the reason to end if one is missing.
    fn learn(&mut self, trial: &Trial) -> Option<Abort> {
        if trial.kind != Kind::Probe {
            return None;
        }
        for joint in &trial.metrics.joints {
            let Some(angle) = joint.contact_angle else {
                continue;
            };
            // Between 0 and 1000 as all angles are.
            #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
            let angle = angle.round() as i64;
            self.contact[joint.dof] = Some(Angle::nearest(angle));
        }
        let missing = self.plan.joints().find(|dof| self.contact[*dof].is_none());
        missing.map(|dof| Abort::NoContact { dof })
    }

    fn close_trial(&mut self) -> Option<Trial> {
        let Phase::Running(runner, cell) = std::mem::replace(&mut self.phase, Phase::Over) else {
            return None;
        };
        let aborted = runner.ending().and_then(Result::err);
        let recording = runner.into_recording();
        let metrics = measure(&recording, &self.plan, cell.setting);
        Some(Trial {
            number: self.number,
            kind: cell.kind,
            setting: cell.setting,
            metrics,
            recording,
            aborted,
        })
    }

    fn fail(&mut self, why: Abort) -> Order {
        let trial = self.close_trial();
        self.done.extend(trial);
        self.aborted.get_or_insert(why);
        self.queue.clear();
        self.phase = Phase::Over;
        Order::Stop
    }
}

struct Wait {
    since: Moment,
    rest: Duration,
    now: Moment,
}

/// The trials in order; where the contact has to be measured, a slow one at the smallest threshold goes first.
fn cells(plan: &TrialPlan) -> VecDeque<Cell> {
    let settings = plan.grid.settings();
    let measured = matches!(
        plan.approach,
        Approach::TwoStage {
            until: Until::Measured { .. },
            ..
        }
    );
    let probe = plan.grid.forces.iter().min().filter(|_| measured);
    let probe = probe.map(|force| Cell {
        kind: Kind::Probe,
        setting: Setting {
            speed: PROBE_SPEED,
            force: *force,
        },
    });
    let repeat = |at: usize| at % plan.grid.repeats.max(1) + 1;
    let trials = settings.into_iter().enumerate().map(|(at, setting)| Cell {
        kind: Kind::Trial { repeat: repeat(at) },
        setting,
    });
    probe.into_iter().chain(trials).collect()
}
