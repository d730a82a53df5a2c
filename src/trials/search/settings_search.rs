//! The search for the fastest close under a limit: which close is next, and what it said. Two slow ones first, then upwards only,
//! to the fastest whose upper bound stays under the limit; then the same again and again until it is a claim. Pure: it moves
//! nothing and reads no clock.

use crate::hand::impact::{overshoot_g, second_hand_overshoot_g};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::{Approach, TrialPlan, TrialSetting, Until};
use crate::trials::recording::seconds;
use crate::trials::search::close::CloseFacts;
use crate::trials::search::confirm::Confirmation;
use crate::trials::search::finding::{
    Claim, Finding, FoundApproach, NoClaim, SearchProgress, SearchStage, Tried, Untold,
};
use crate::trials::search::goal::{GoalError, LIMIT_MIN_G, SearchGoal, whole};
use crate::trials::search::growth::Contact;
use crate::trials::search::joint::JointModel;
use crate::trials::search::tolerance::tolerance_factor;
use crate::trials::summary::Trial;
use std::time::Duration;

/// The slowest close that is tried, units of SPEED_SET.
const SLOWEST: i16 = 3;
/// The second probe comes near with this speed, and slows down so far before the contact that the first met.
const SECOND_FAST: i16 = 200;
const SECOND_MARGIN: i16 = 60;
/// How a close in two stages comes near.
const FAST: i16 = Speed::MAX.get();
/// A setting that is this much faster, as a share of the close, is worth another close, and ten more.
const WORTH_ONE: f64 = 0.02;
const WORTH_TEN: f64 = 0.05;
/// Steps upwards, and settings that are tried for confirmation.
const RISES_MAX: usize = 10;
const CONFIRMATIONS_MAX: usize = 8;
/// After so many closes a claim is taken as it is, even if something quicker may be left.
const RISING_UNTIL: usize = 40;
/// What is aimed at of the room under the limit: bounds of few closes scatter themselves.
const AIM: f64 = 0.97;
/// All closes of a search.
pub const TRIALS_MAX: usize = 250;
/// From the order to go on slowly to the motion: the dead time and a reading, s.
const PAUSE_S: f64 = 0.1;
/// A threshold is at least this, and this many times the noise.
const THRESHOLD_MIN_G: f64 = 15.0;
const THRESHOLD_SIGMAS: f64 = 6.0;
/// What a limit has to be above the noise for.
const LIMIT_SIGMAS: f64 = 15.0;
/// A close that is over the limit takes the speeds from this share of its own on away.
const BARRED_FROM: f64 = 0.97;
/// Readings of the force further apart than this may miss a peak, s.
const GAP_S: f64 = 0.025;
/// About how long a close takes before any was measured.
const CLOSE_TAKES: Duration = Duration::from_secs(7);

/// A close that is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct NextClose {
    pub plan: TrialPlan,
    pub setting: TrialSetting,
    /// Where each joint met the object.
    pub contact: PerDof<Option<Angle>>,
    /// Whether it looks for the contact.
    pub is_probe: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum SearchPhase {
    First,
    Second,
    Rising { rises: usize },
    Confirming(Confirmation),
}

/// What is tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Choice {
    setting: TrialSetting,
    approach: FoundApproach,
}

/// A search under way.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingsSearch {
    goal: SearchGoal,
    joints: Vec<JointModel>,
    phase: SearchPhase,
    choice: Choice,
    threshold_g: f64,
    /// Speeds from here on are over the limit.
    barred: f64,
    confirmations: usize,
    tried: Vec<Tried>,
    untold: Vec<Untold>,
    result: Option<Result<Claim, NoClaim>>,
    /// How long the last close took, with its ways.
    took: Option<Duration>,
}

impl SettingsSearch {
    /// A search for this goal.
    ///
    /// # Errors
    /// [`GoalError`]: it cannot be tried.
    pub fn new(goal: SearchGoal) -> Result<Self, GoalError> {
        goal.check()?;
        let first = goal.first_setting();
        let joints = goal.joints().map(JointModel::new).collect();
        let setting = TrialSetting {
            speed: gentle(&goal, first),
            ..first
        };
        Ok(Self {
            joints,
            phase: SearchPhase::First,
            choice: Choice {
                setting,
                approach: FoundApproach::OneStage,
            },
            threshold_g: f64::from(first.force.get()),
            barred: f64::INFINITY,
            confirmations: 0,
            tried: Vec::new(),
            untold: Vec::new(),
            result: None,
            took: None,
            goal,
        })
    }

    /// The plan that its trials begin with: joints, ways, limits. Speed and threshold are the first's.
    pub fn plan(&self) -> TrialPlan {
        self.goal.plan(self.choice.setting)
    }

    /// What it came to, once it is over.
    pub fn finding(&self) -> Option<Finding> {
        let result = self.result.clone()?;
        Some(Finding {
            result,
            tried: self.tried.clone(),
            untold: self.untold.clone(),
        })
    }

    /// Every close so far.
    pub fn tried(&self) -> &[Tried] {
        &self.tried
    }

    /// Where it stands.
    pub fn progress(&self) -> SearchProgress {
        let of = self.goal.closes;
        let (stage, closes_left) = match &self.phase {
            _ if self.result.is_some() => (SearchStage::Over, 0),
            SearchPhase::First => (SearchStage::Probing, of + 8),
            SearchPhase::Second => (SearchStage::Probing, of + 7),
            SearchPhase::Rising { rises } => (
                SearchStage::Rising,
                of + 6_usize.saturating_sub(*rises).max(1),
            ),
            SearchPhase::Confirming(confirmation) => {
                let done = confirmation.closes();
                (SearchStage::Confirming { done, of }, of - done.min(of))
            }
        };
        let each = self.took.unwrap_or(CLOSE_TAKES);
        let left = u32::try_from(closes_left).map_or(Duration::MAX, |n| each.saturating_mul(n));
        SearchProgress {
            stage,
            tried: self.tried.clone(),
            closes_left,
            left,
        }
    }

    /// The next close; `None` once it is over.
    pub fn next(&self) -> Option<NextClose> {
        if self.result.is_some() {
            return None;
        }
        let mut plan = self.goal.plan(self.choice.setting);
        if let FoundApproach::TwoStage { fast_speed, margin } = self.choice.approach {
            plan.approach = Approach::TwoStage {
                fast: Speed::nearest(fast_speed),
                until: Until::Measured { margin },
            };
        }
        let mut contact = PerDof::splat(None);
        for joint in &self.joints {
            contact[joint.dof] = joint.contact().map(|at| Angle::nearest(whole(at)));
        }
        Some(NextClose {
            plan,
            setting: self.choice.setting,
            contact,
            is_probe: matches!(self.phase, SearchPhase::First | SearchPhase::Second),
        })
    }

    /// Takes a close that ended well, and chooses the next.
    pub fn learn(&mut self, trial: &Trial) {
        let facts = CloseFacts::of(trial);
        self.took = took(trial).or(self.took);
        self.note(trial.summary.number, &facts);
        if let Err(none) = self.take(&facts) {
            self.result.get_or_insert(Err(none));
        }
        if self.result.is_none() && self.tried.len() >= TRIALS_MAX {
            let trials = self.tried.len();
            self.result = Some(Err(NoClaim::NotConfirmed { trials }));
        }
    }

    fn note(&mut self, number: usize, facts: &[CloseFacts]) {
        let peak = facts.iter().filter_map(|joint| joint.peak_g);
        let peak_g = peak.reduce(f64::max);
        let all: Option<Vec<f64>> = facts.iter().map(|joint| joint.close_s).collect();
        let close_s = all.and_then(|all| all.into_iter().reduce(f64::max));
        self.tried.push(Tried {
            number,
            setting: self.choice.setting,
            approach: self.choice.approach,
            peak_g,
            close_s,
            over_limit: peak_g.is_some_and(|peak| peak > self.limit()),
            confirms: false,
        });
    }

    fn take(&mut self, facts: &[CloseFacts]) -> Result<(), NoClaim> {
        // In noise no contact can be told, so it goes first.
        self.check_noise(facts)?;
        let slips = self.look(facts)?;
        let at = self.at(self.speed());
        let goal = &self.goal;
        for (joint, facts) in self.joints.iter_mut().zip(facts) {
            if self.phase == SearchPhase::First {
                let (start, _) = goal.way(joint.dof);
                joint.learn_rate(facts, start, at.speed);
            }
            if let Some(gives) = joint.learn(facts, at) {
                return Err(gives);
            }
        }
        let over = self.tried.last().is_some_and(|own| own.over_limit);
        if over || slips {
            self.barred = self.barred.min(BARRED_FROM * self.speed());
            return self.narrow(facts, slips);
        }
        match &mut self.phase {
            SearchPhase::First => self.probe_again(),
            SearchPhase::Second => self.rise(0),
            SearchPhase::Rising { rises } => {
                let rises = *rises + 1;
                self.rise(rises)
            }
            SearchPhase::Confirming(confirmation) => {
                confirmation.add(facts, &self.joints, at);
                self.confirmed()
            }
        }
    }

    /// What ends it at once; whether the object slipped.
    fn look(&mut self, facts: &[CloseFacts]) -> Result<bool, NoClaim> {
        let mut slips = false;
        let is_first = self.phase == SearchPhase::First;
        for joint in facts {
            let dof = joint.dof;
            if joint.is_dead {
                return Err(NoClaim::Dead { dof });
            }
            if joint.touched_before {
                return Err(NoClaim::Touching { dof });
            }
            if joint.contact.is_none() && is_first {
                return Err(NoClaim::NoContact { dof });
            }
            if joint.contact.is_none() {
                return Err(NoClaim::Lost { dof });
            }
            if joint.peak_g.is_none() || joint.close_s.is_none() || joint.steady_g.is_none() {
                return Err(NoClaim::NotMeasured { dof });
            }
            slips |= joint.slips.is_some_and(|count| count > 0);
            self.note_untold(joint);
        }
        if facts.len() < self.joints.len() {
            let dof = self.joints.first().map_or(Dof::Index, |own| own.dof);
            return Err(NoClaim::NotMeasured { dof });
        }
        Ok(slips)
    }

    fn note_untold(&mut self, joint: &CloseFacts) {
        let dof = joint.dof;
        let gap = joint.longest_gap_s.filter(|gap| *gap > GAP_S);
        let is_known = |untold: &Untold| self.untold.iter().any(|own| own.is_of_same(untold));
        let slips = joint.slips.is_none().then_some(Untold::Slips { dof });
        let gaps = gap.map(|gap_s| Untold::Gaps { dof, gap_s });
        let new: Vec<Untold> = slips
            .into_iter()
            .chain(gaps)
            .filter(|untold| !is_known(untold))
            .collect();
        self.untold.extend(new);
    }

    fn check_noise(&self, facts: &[CloseFacts]) -> Result<(), NoClaim> {
        let limit = self.limit();
        for joint in facts.iter().filter(|joint| !joint.is_dead) {
            let noise_g = joint.noise_g;
            let least_g = (LIMIT_SIGMAS * noise_g).max(f64::from(LIMIT_MIN_G));
            if limit < least_g {
                return Err(NoClaim::Noise {
                    dof: joint.dof,
                    limit_g: self.goal.limit_g,
                    noise_g,
                    least_g,
                });
            }
        }
        Ok(())
    }

    fn limit(&self) -> f64 {
        f64::from(self.goal.limit_g)
    }

    fn speed(&self) -> f64 {
        f64::from(self.choice.setting.speed.get())
    }

    fn at(&self, speed: f64) -> Contact {
        Contact {
            speed,
            threshold_g: self.threshold_g,
        }
    }

    /// The threshold that leaves what is wished for.
    fn choose_threshold(&mut self) {
        let hold = f64::from(self.goal.hold_g);
        let joints = self.joints.iter();
        let needs = joints.map(|joint| {
            let least = THRESHOLD_MIN_G.max(THRESHOLD_SIGMAS * joint.noise_g());
            joint.threshold_for(hold).max(least)
        });
        let needed = needs.fold(0.0, f64::max).ceil();
        self.threshold_g = needed.min(f64::from(Force::MAX.get()));
    }

    fn probe_again(&mut self) -> Result<(), NoClaim> {
        self.phase = SearchPhase::Second;
        self.choose_threshold();
        let speed = self.speed();
        let approach = FoundApproach::TwoStage {
            fast_speed: SECOND_FAST,
            margin: SECOND_MARGIN,
        };
        self.choose(speed, approach);
        Ok(())
    }

    fn choose(&mut self, speed: f64, approach: FoundApproach) {
        self.choice = Choice {
            setting: TrialSetting {
                speed: Speed::nearest(whole(speed)),
                force: Force::nearest(whole(self.threshold_g)),
            },
            approach,
        };
    }

    /// The quicker of both approaches at this speed; in one stage where there is no room for two.
    fn approach(&self, speed: f64) -> FoundApproach {
        let margins = self.joints.iter().map(JointModel::margin);
        let margin = margins.fold(0.0, f64::max).ceil();
        let two = FoundApproach::TwoStage {
            fast_speed: FAST,
            margin: whole(margin).clamp(1, 500),
        };
        let one = FoundApproach::OneStage;
        if self.room() <= margin + 1.0 || self.takes(one, speed) <= self.takes(two, speed) {
            one
        } else {
            two
        }
    }

    /// The way to the contact of the joint that has the least, units of ANGLE_ACT.
    fn room(&self) -> f64 {
        let room = self.joints.iter().map(|joint| {
            let (start, _) = self.goal.way(joint.dof);
            start - joint.contact().unwrap_or(start)
        });
        room.fold(f64::INFINITY, f64::min)
    }

    /// About how long a close takes after the dead time, s.
    fn takes(&self, approach: FoundApproach, speed: f64) -> f64 {
        let rate = self.joints.first().map_or(1.5, JointModel::rate).max(0.01);
        let pressed = self
            .joints
            .iter()
            .filter_map(|joint| Some(self.threshold_g / joint.stiffness()?.max(0.1)));
        let pressed = pressed.fold(0.0, f64::max);
        let (fast_s, slow_way) = match approach {
            FoundApproach::OneStage => (0.0, self.room()),
            FoundApproach::TwoStage { fast_speed, margin } => {
                let fast_way = (self.room() - f64::from(margin)).max(0.0);
                let fast_s = fast_way / (rate * f64::from(fast_speed.max(1)));
                (fast_s + PAUSE_S, f64::from(margin))
            }
        };
        fast_s + (slow_way + pressed) / (rate * speed.max(1.0))
    }

    /// The fastest speed up to `most` at which each joint stays under the limit by this bound of the peak.
    fn fastest(&self, bound: impl Fn(&JointModel, Contact) -> Option<f64>) -> Option<f64> {
        let fits = |speed: i16| {
            let at = self.at(f64::from(speed));
            let under = |joint: &JointModel| {
                bound(joint, at).is_some_and(|over| at.threshold_g + over <= self.limit())
            };
            at.speed < self.barred && self.joints.iter().all(under)
        };
        // The bounds rise with the speed but for small dips of the published shapes: the first that does not fit ends it.
        let mut fastest = None;
        for speed in SLOWEST..=Speed::MAX.get() {
            if !fits(speed) {
                break;
            }
            fastest = Some(f64::from(speed));
        }
        fastest
    }

    /// The fastest that nothing known so far speaks against.
    fn fastest_safe(&self) -> Option<f64> {
        self.fastest(|joint, at| Some(joint.growth.upper(at)? + 2.0 * joint.growth.scatter(at)))
    }

    /// The fastest that is likely to be confirmed.
    fn fastest_likely(&self) -> Option<f64> {
        let k = tolerance_factor(self.goal.closes, self.goal.assurance()).unwrap_or(3.0);
        self.fastest(|joint, at| Some(joint.growth.likely(at)? + k * joint.growth.scatter(at)))
    }

    /// Goes on upwards, or confirms.
    fn rise(&mut self, rises: usize) -> Result<(), NoClaim> {
        self.choose_threshold();
        let likely = self.fastest_likely();
        let next = self.fastest_safe().zip(likely);
        let next = next.map(|(safe, likely)| safe.min(likely));
        let Some(next) = next else {
            return self.slower();
        };
        let is_worth = self.gain(next) > WORTH_ONE;
        if rises < RISES_MAX && is_worth && next > self.speed() {
            self.phase = SearchPhase::Rising { rises };
            self.choose(next, self.approach(next));
            return Ok(());
        }
        self.confirm(likely.unwrap_or(next).min(next.max(self.speed())))
    }

    /// How much of the last close this speed would save with the best approach to it, as a share.
    fn gain(&self, speed: f64) -> f64 {
        let Some(close) = self.tried.last().and_then(|own| own.close_s) else {
            return 1.0;
        };
        let now = self.takes(self.choice.approach, self.speed());
        (now - self.takes(self.approach(speed), speed)) / close.max(0.05)
    }

    fn confirm(&mut self, speed: f64) -> Result<(), NoClaim> {
        self.confirmations += 1;
        if self.confirmations > CONFIRMATIONS_MAX {
            let trials = self.tried.len();
            return Err(NoClaim::NotConfirmed { trials });
        }
        self.choose(speed, self.approach(speed));
        let dofs = self.joints.iter().map(|joint| joint.dof);
        self.phase = SearchPhase::Confirming(Confirmation::new(dofs));
        Ok(())
    }

    /// After a close over the limit, or a slip: something slower.
    fn narrow(&mut self, facts: &[CloseFacts], slips: bool) -> Result<(), NoClaim> {
        if self.barred <= f64::from(SLOWEST) || matches!(self.phase, SearchPhase::First) && slips {
            let worst = facts.iter().max_by(|a, b| {
                let (a, b) = (a.peak_g.unwrap_or(0.0), b.peak_g.unwrap_or(0.0));
                a.total_cmp(&b)
            });
            let dof = worst.map_or(Dof::Index, |own| own.dof);
            return Err(if slips {
                NoClaim::Slips { dof }
            } else {
                self.too_strong(dof)
            });
        }
        match self.phase {
            SearchPhase::First => self.probe_again().and_then(|()| self.slower()),
            SearchPhase::Second | SearchPhase::Rising { .. } => self.rise(RISES_MAX),
            SearchPhase::Confirming(_) => self.slower(),
        }
    }

    /// Confirms the fastest that is likely and not barred.
    fn slower(&mut self) -> Result<(), NoClaim> {
        self.choose_threshold();
        match self.fastest_likely() {
            Some(speed) if self.phase == SearchPhase::Second => {
                let approach = self.choice.approach;
                self.choose(speed, approach);
                Ok(())
            }
            Some(speed) => self.confirm(speed),
            None => {
                let dof = self.joints.first().map_or(Dof::Index, |own| own.dof);
                Err(self.too_strong(dof))
            }
        }
    }

    fn too_strong(&self, dof: Dof) -> NoClaim {
        let joint = self.joints.iter().find(|joint| joint.dof == dof);
        let at = self.at(f64::from(SLOWEST));
        let over = joint
            .and_then(|joint| joint.growth.likely(at))
            .unwrap_or_default();
        NoClaim::TooStrong {
            dof,
            speed: SLOWEST,
            peak_g: at.threshold_g + over,
        }
    }

    /// Looks at a setting that was confirmed as often as asked: a claim, something slower, or something faster.
    fn confirmed(&mut self) -> Result<(), NoClaim> {
        let SearchPhase::Confirming(confirmation) = &self.phase else {
            return Ok(());
        };
        if confirmation.closes() < self.goal.closes {
            return Ok(());
        }
        let confirmation = confirmation.clone();
        let bound = confirmation.bound(&self.goal);
        let (dof, holds_g) = confirmation.least_hold();
        let wanted = f64::from(self.goal.hold_g);
        if holds_g < wanted {
            let before = self.threshold_g;
            self.choose_threshold();
            self.threshold_g = self.threshold_g.max(before + (wanted - holds_g) + 2.0);
            if self.threshold_g > 0.95 * self.limit() {
                return Err(NoClaim::HoldsTooLittle {
                    dof,
                    holds_g,
                    wanted_g: self.goal.hold_g,
                });
            }
            let speed = self.fastest_likely().unwrap_or(f64::from(SLOWEST));
            return self.confirm(speed.min(self.speed()));
        }
        // What the bound is of the limit, over the threshold, is what the overshoot may be more or less.
        let room = (self.limit() - self.threshold_g) / (bound - self.threshold_g).max(1.0);
        let aim = self.speed_for(AIM * room);
        if bound > self.limit() {
            self.barred = self.barred.min(BARRED_FROM * self.speed());
            let Some(speed) = aim.filter(|speed| *speed < self.speed()) else {
                return self.slower();
            };
            return self.confirm(speed);
        }
        // By now the contact is known better too, so that even the same speed may be quicker with less before it.
        let now = self.speed();
        let better = aim.unwrap_or(now).min(self.barred - 1.0).max(now);
        if self.tried.len() < RISING_UNTIL && self.gain(better) > WORTH_TEN {
            return self.confirm(better);
        }
        self.claim(&confirmation);
        Ok(())
    }

    /// The speed at which the likely overshoot is so many times that of the present speed.
    fn speed_for(&self, times: f64) -> Option<f64> {
        let now = self.at(self.speed());
        let goal: Option<Vec<f64>> = self
            .joints
            .iter()
            .map(|own| own.growth.likely(now))
            .collect();
        let goal = goal?;
        let fits = |speed: i16| {
            let at = self.at(f64::from(speed));
            self.joints.iter().zip(&goal).all(|(joint, own)| {
                joint
                    .growth
                    .likely(at)
                    .is_some_and(|over| over <= times * own)
            })
        };
        let speeds = SLOWEST..=Speed::MAX.get();
        let fastest = speeds.take_while(|speed| fits(*speed)).last();
        let fastest = fastest.map(f64::from)?;
        Some(fastest.min(self.barred.floor().min(f64::from(Speed::MAX.get()))))
    }

    fn claim(&mut self, confirmation: &Confirmation) {
        let closes = confirmation.closes();
        let first = self.tried.len().saturating_sub(closes);
        for own in self.tried.iter_mut().skip(first) {
            own.confirms = true;
        }
        let joints = confirmation.claims(&self.joints, &self.goal);
        for joint in joints.iter().filter(|joint| joint.stiffness_g.is_none()) {
            self.untold.push(Untold::Stiffness { dof: joint.dof });
        }
        if !self.goal.distribution_free {
            self.untold.push(Untold::Distribution);
        }
        self.result = Some(Ok(Claim {
            setting: self.choice.setting,
            approach: self.choice.approach,
            joints,
            close_s: confirmation.close_s(),
            closes,
            assurance: self.goal.assurance(),
            distribution_free: self.goal.distribution_free,
        }));
    }
}

/// The speed of the first close: slow, and slower where even that may be over the limit on a stiff object.
fn gentle(goal: &SearchGoal, setting: TrialSetting) -> Speed {
    let threshold = f64::from(setting.force.get());
    let worst =
        |speed: f64| 1.5 * overshoot_g(speed, threshold).max(second_hand_overshoot_g(speed));
    let mut slow = setting.speed.get();
    while slow > 5 && threshold + worst(f64::from(slow)) > f64::from(goal.limit_g) {
        slow -= 1;
    }
    Speed::nearest(slow)
}

/// How long a trial took.
fn took(trial: &Trial) -> Option<Duration> {
    let rows = trial.recording.rows();
    let (first, last) = (rows.first()?, rows.last()?);
    Duration::try_from_secs_f64(seconds(first.at, last.at)).ok()
}
