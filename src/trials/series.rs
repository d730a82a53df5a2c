//! A series of trials: the next trial, the rest between two, and the end of the series. Sends nothing and reads no clock.

use crate::hand::{Angle, ArmEpoch, Groups, HandSample, Moment, PerDof, Setpoints, Speed};
use crate::record::Abort;
use crate::trials::limits::{TaskStall, warmest};
use crate::trials::measure::metrics::measure;
use crate::trials::plan::{Approach, PlanError, TrialPlan, TrialSetting};
use crate::trials::runner::{Runner, Stage};
use crate::trials::search::{SettingsSearch, Tried};
use crate::trials::summary::{EarlyEnd, Trial, TrialKind, TrialSummary};
use std::collections::VecDeque;
use std::time::Duration;

/// Longest wait for a hand that is too warm to start.
pub const COOLING_MAX: Duration = Duration::from_secs(900);
/// Speed of the probe that measures the contact.
const PROBE_SPEED: Speed = Speed::SLOWEST_MEASURED;
/// Maximum repeats of a trial whose readings stopped at its peak.
const REPEATS_MAX: usize = 3;

#[derive(Debug, Clone, Copy)]
struct GridTrial {
    /// Number among the trials of its setting, from 1; `None` for the probe that measures the contact.
    repeat: Option<usize>,
    setting: TrialSetting,
}

/// A trial with its plan.
#[derive(Debug, Clone)]
struct PlannedTrial {
    /// As of a [`GridTrial`].
    repeat: Option<usize>,
    setting: TrialSetting,
    plan: TrialPlan,
}

/// The arming, and the time of the start.
struct SeriesBegin {
    epoch: ArmEpoch,
    now: Moment,
}

/// Source of the trials.
#[derive(Debug, Clone)]
enum TrialSource {
    /// Speeds and thresholds of the plan, in order.
    Grid(VecDeque<GridTrial>),
    /// Each trial depends on the measurements of the previous ones.
    Search(Box<SettingsSearch>),
}

#[derive(Debug, Clone)]
enum SeriesPhase {
    Waiting { until: Moment },
    Running(Box<Runner>, Box<PlannedTrial>),
    Over,
}

/// Progress of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeriesView {
    /// Trials that have begun.
    pub number: usize,
    /// Total number of trials.
    pub total: usize,
    /// Current setting; `None` between two trials.
    pub setting: Option<TrialSetting>,
    /// True while the contact is being measured.
    pub is_probing: bool,
    /// Stage of the hand.
    pub stage: Stage,
}

/// A running series.
#[derive(Debug, Clone)]
pub struct TrialSeries {
    plan: TrialPlan,
    epoch: ArmEpoch,
    source: TrialSource,
    total: usize,
    phase: SeriesPhase,
    contact: PerDof<Option<Angle>>,
    number: usize,
    /// Longest interval in the running trial in which this program did not run.
    stall: Option<Duration>,
    /// Repeats of the last trial.
    repeats: usize,
    done: VecDeque<Trial>,
    aborted: Option<Abort>,
}

impl TrialSeries {
    /// Starts a series under an arming by the user. Nothing is sent before the first [`Self::tick`].
    ///
    /// # Errors
    /// [`PlanError`]: the plan is invalid, and nothing starts.
    pub fn start(plan: TrialPlan, epoch: ArmEpoch, now: Moment) -> Result<Self, PlanError> {
        plan.check()?;
        let queue = cells(&plan);
        Ok(Self {
            total: queue.len(),
            ..Self::from(TrialSource::Grid(queue), plan, SeriesBegin { epoch, now })
        })
    }

    /// Starts a search under an arming by the user. Its goal was checked when the search was created.
    pub fn search(search: SettingsSearch, epoch: ArmEpoch, now: Moment) -> Self {
        let plan = search.plan();
        let total = search.progress().closes_left;
        let source = TrialSource::Search(Box::new(search));
        Self {
            total,
            ..Self::from(source, plan, SeriesBegin { epoch, now })
        }
    }

    fn from(source: TrialSource, plan: TrialPlan, begin: SeriesBegin) -> Self {
        Self {
            source,
            total: 0,
            phase: SeriesPhase::Waiting { until: begin.now },
            plan,
            epoch: begin.epoch,
            contact: PerDof::splat(None),
            number: 0,
            stall: None,
            repeats: 0,
            done: VecDeque::new(),
            aborted: None,
        }
    }

    /// Current progress.
    pub fn view(&self) -> SeriesView {
        let (setting, is_probing, stage) = match &self.phase {
            SeriesPhase::Waiting { .. } => (None, false, Stage::Resting),
            SeriesPhase::Running(runner, own) => {
                (Some(own.setting), own.repeat.is_none(), runner.stage())
            }
            SeriesPhase::Over => (None, false, Stage::Over),
        };
        SeriesView {
            number: self.number,
            total: self.total,
            setting,
            is_probing,
            stage,
        }
    }

    /// The next finished trial. Each is returned once.
    pub fn finished(&mut self) -> Option<Trial> {
        self.done.pop_front()
    }

    fn wait(
        &mut self,
        sample: &HandSample,
        stall: Option<TaskStall>,
        until: Moment,
        now: Moment,
    ) -> Option<Setpoints> {
        if now < until {
            return None;
        }
        let limit = self.plan.limits.start_c;
        // Waits until temperatures are known; a trial does not begin without them.
        let (dof, celsius) = warmest(sample)?;
        if celsius >= limit {
            if now.since(until) >= COOLING_MAX {
                self.fail(Abort::TooWarm {
                    dof,
                    celsius,
                    limit,
                });
            }
            return None;
        }
        let Some(cell) = self.pop() else {
            self.phase = SeriesPhase::Over;
            return None;
        };
        self.number += 1;
        self.stall = None;
        let runner = Runner::new(&cell.plan, cell.setting, &self.contact, self.epoch);
        self.phase = SeriesPhase::Running(Box::new(runner), Box::new(cell));
        self.tick(sample, stall, now)
    }

    /// Returns the next trial, with the contact that its approach needs.
    fn pop(&mut self) -> Option<PlannedTrial> {
        let search = match &mut self.source {
            TrialSource::Grid(queue) => {
                let GridTrial { repeat, setting } = queue.pop_front()?;
                let mut plan = self.plan.clone();
                if repeat.is_none() {
                    plan.approach = Approach::OneStage;
                }
                return Some(PlannedTrial {
                    repeat,
                    setting,
                    plan,
                });
            }
            TrialSource::Search(search) => search,
        };
        let next = search.next()?;
        let of_setting = |own: &&Tried| own.setting == next.setting;
        let tried = search.tried().iter().filter(of_setting).count();
        self.total = self.number + search.progress().closes_left;
        self.contact = next.contact;
        Some(PlannedTrial {
            repeat: (!next.is_probe).then_some(tried + 1),
            setting: next.setting,
            plan: next.plan,
        })
    }

    /// The search, if this series is one.
    pub fn settings_search(&self) -> Option<&SettingsSearch> {
        match &self.source {
            TrialSource::Grid(_) => None,
            TrialSource::Search(search) => Some(search),
        }
    }

    /// Handles the normal end of a trial.
    fn next(&mut self, now: Moment) {
        let Some(mut trial) = self.close_trial() else {
            return;
        };
        let again = self.again(&trial.summary);
        trial.summary.repeated = again;
        let missing = match &mut self.source {
            TrialSource::Grid(_) if again => None,
            TrialSource::Grid(_) => self.learn_contact(&trial.summary),
            TrialSource::Search(search) => {
                search.learn(&trial);
                None
            }
        };
        self.done.push_back(trial);
        if let Some(why) = missing {
            self.fail(why);
            return;
        }
        let is_over = match &self.source {
            TrialSource::Grid(queue) => queue.is_empty(),
            TrialSource::Search(search) => search.next().is_none(),
        };
        self.phase = if is_over {
            SeriesPhase::Over
        } else {
            let until = now.plus(self.plan.grid.rest);
            SeriesPhase::Waiting { until }
        };
    }

    /// True if a trial is no evidence because its readings stopped at its peak. A grid repeats such a trial; a search does so by
    /// itself.
    fn again(&mut self, trial: &TrialSummary) -> bool {
        let has_gap = trial.has_gap();
        let TrialSource::Grid(queue) = &mut self.source else {
            return has_gap;
        };
        if !has_gap || self.repeats >= REPEATS_MAX {
            self.repeats = 0;
            return false;
        }
        self.repeats += 1;
        self.total += 1;
        queue.push_front(GridTrial {
            repeat: trial.repeat,
            setting: trial.setting,
        });
        true
    }

    /// Stores the contact angles of a probe; returns the reason to end if one is missing.
    fn learn_contact(&mut self, trial: &TrialSummary) -> Option<Abort> {
        if !trial.is_probe() {
            return None;
        }
        for joint in &trial.joints {
            let Some(angle) = joint.contact_angle else {
                continue;
            };
            // Between 0 and 1000, as all angles are.
            #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
            let angle = angle.round() as i64;
            self.contact[joint.dof] = Some(Angle::nearest(angle));
        }
        let missing = self.plan.joints().find(|dof| self.contact[*dof].is_none());
        missing.map(|dof| Abort::NoContact { dof })
    }

    fn close_trial(&mut self) -> Option<Trial> {
        let SeriesPhase::Running(runner, cell) =
            std::mem::replace(&mut self.phase, SeriesPhase::Over)
        else {
            return None;
        };
        let aborted = runner.ending().and_then(Result::err);
        let recording = runner.into_recording();
        let summary = TrialSummary {
            number: self.number,
            kind: match cell.repeat {
                None => TrialKind::Probe,
                Some(_) => TrialKind::Trial,
            },
            repeat: cell.repeat,
            setting: cell.setting,
            aborted: aborted.map(EarlyEnd::Here),
            samples: None,
            rows: recording.rows().len(),
            rows_lost: recording.lost(),
            repeated: false,
            stall_s: self.stall.map(|lasted| lasted.as_secs_f64()),
            joints: measure(&recording, &cell.plan, cell.setting),
            others: self.approach_of(&cell.plan),
        };
        Some(Trial { summary, recording })
    }

    /// Approach of a trial in a search: it differs per trial, so the plan of the series cannot record it.
    fn approach_of(&self, plan: &TrialPlan) -> toml::Table {
        let is_search = matches!(self.source, TrialSource::Search(_));
        let keys = toml::Table::try_from(plan.approach).ok();
        keys.filter(|_| is_search).unwrap_or_default()
    }

    fn fail(&mut self, why: Abort) {
        let trial = self.close_trial();
        self.done.extend(trial);
        self.aborted.get_or_insert(why);
        if let TrialSource::Grid(queue) = &mut self.source {
            queue.clear();
        }
        self.phase = SeriesPhase::Over;
    }

    /// True once nothing further is sent.
    pub const fn is_over(&self) -> bool {
        matches!(self.phase, SeriesPhase::Over)
    }

    /// Reason for an early end; `None` if there is none. The hand must then be stopped.
    pub const fn aborted(&self) -> Option<Abort> {
        self.aborted
    }

    /// Ends the series early, unless it is over.
    pub fn abort(&mut self, why: Abort, now: Moment) {
        if self.is_over() {
            return;
        }
        if let SeriesPhase::Running(runner, _) = &mut self.phase {
            runner.abort(why, now);
        }
        self.fail(why);
    }

    /// Records an interval in which the program did not run.
    pub fn stalled(&mut self, stall: TaskStall) {
        self.stall = self.stall.max(Some(stall.lasted));
    }

    /// Receives readings.
    pub fn read(&mut self, sample: &HandSample, fresh: Groups) {
        if let SeriesPhase::Running(runner, _) = &mut self.phase {
            runner.apply(sample, fresh);
        }
    }

    /// Advances the time. Returns the setpoints to send now, if any. `stall` is the most recent interval in which this program did not
    /// run.
    pub fn tick(
        &mut self,
        sample: &HandSample,
        stall: Option<TaskStall>,
        now: Moment,
    ) -> Option<Setpoints> {
        match &mut self.phase {
            SeriesPhase::Waiting { until } => {
                let until = *until;
                self.wait(sample, stall, until, now)
            }
            SeriesPhase::Running(runner, _) => {
                let setpoints = runner.tick(sample, stall, now);
                match runner.ending() {
                    None => return setpoints,
                    Some(Err(why)) => self.fail(why),
                    Some(Ok(())) => self.next(now),
                }
                None
            }
            SeriesPhase::Over => None,
        }
    }
}

/// Trials in order. If the contact has to be measured, a slow trial at the smallest threshold comes first.
fn cells(plan: &TrialPlan) -> VecDeque<GridTrial> {
    let least = plan.grid.forces.iter().min();
    let probe = least.filter(|_| plan.measures_contact());
    let probe = probe.map(|force| GridTrial {
        repeat: None,
        setting: TrialSetting {
            speed: PROBE_SPEED,
            force: *force,
        },
    });
    let settings = plan.grid.settings().into_iter().enumerate();
    let trials = settings.map(|(at, setting)| GridTrial {
        repeat: Some(at % plan.grid.repeats.max(1) + 1),
        setting,
    });
    probe.into_iter().chain(trials).collect()
}
