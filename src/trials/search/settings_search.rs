//! The search for the fastest close under a limit: chooses the next close from the results so far. Two slow closes first, then
//! faster ones, at most twice as fast each time, up to the fastest whose upper bound stays under the limit; then repeats until they
//! support a claim. Pure: moves nothing and reads no clock.

use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::measure::unseen::GAP_S;
use crate::trials::plan::{Approach, TrialPlan, TrialSetting, Until};
use crate::trials::recording::seconds;
use crate::trials::search::close::CloseFacts;
use crate::trials::search::confirm::{Confirmation, bound_g, has_tail, largest_g};
use crate::trials::search::finding::{
    Claim, ComparedThreshold, Finding, FoundApproach, NoClaim, OpenQuestion, SearchProgress,
    SearchStage, Tried,
};
use crate::trials::search::goal::{GoalError, LIMIT_MIN_G, SearchGoal, whole};
use crate::trials::search::joint::JointModel;
use crate::trials::search::offset::ThresholdReference;
use crate::trials::search::peak::ContactSetting;
use crate::trials::search::tolerance::{Assurance, FREE_95, tolerance_factor};
use crate::trials::summary::Trial;
use std::time::Duration;

/// The slowest close tried, units of SPEED_SET.
const SLOWEST: i16 = 3;
/// Approach speed of the second probe, and its margin before the contact found by the first.
const SECOND_FAST: i16 = 200;
const SECOND_MARGIN: i16 = 60;
/// Speed reduction of the second probe if the threshold reference of the drive is unknown: the remaining part of its peak then
/// shows it.
const SECOND_SLOWER: f64 = 3.0;
/// Each close is at most this many times as fast as the fastest before it.
const RISE_MOST: f64 = 2.0;
/// Speeds that differ by less than this share count as equal.
const SPEED_STEP: f64 = 0.01;
/// Ratio between the stopping forces of successive candidate thresholds.
const THRESHOLD_STEP: f64 = 1.08;
/// A threshold is informative if it stops the drive at this many times the earlier forces.
const HARDER: f64 = 1.1;
/// The highest force that may stop the drive, as a share of the limit.
const STOPS_MOST: f64 = 0.95;
/// Successive closes that may be uncertain or end in free air.
const REPEATS_MAX: usize = 3;
/// Approach speed of a close in two stages.
const FAST: i16 = Speed::MAX.get();
/// Saving that is worth another close, and ten more, as a share of the closing time.
const WORTH_ONE: f64 = 0.02;
const WORTH_TEN: f64 = 0.05;
/// Maximum number of speed increases, and of settings to confirm.
const RISES_MAX: usize = 10;
const CONFIRMATIONS_MAX: usize = 20;
/// After this many closes a claim is accepted, even if a faster setting may exist.
const RISING_UNTIL: usize = 40;
/// Closes of the setting itself that every claim needs.
const HERE_LEAST: usize = 10;
/// Until enough closes are done, a stop may overrun by this many times the usual: most closes then run slower than the last ones,
/// so that a late stop first shows up where it does little harm.
const LATE: f64 = 3.0;
/// With some late stops, the next may be later than all: the largest overshoot is scaled by this.
const LATER: f64 = 1.3;
/// Expected distance of the largest of many closes from the mean, in standard deviations.
const LARGEST_SIGMAS: f64 = 2.7;
/// Share of the room under the limit to aim at, since bounds from few closes scatter.
const AIM: f64 = 0.97;
/// Maximum number of closes in a search.
pub const TRIALS_MAX: usize = 250;
/// From the order to continue slowly to the motion, s: dead time and one reading.
const PAUSE_S: f64 = 0.1;
/// Smallest limit, as a multiple of the noise.
const LIMIT_SIGMAS: f64 = 15.0;
/// A close over the limit excludes speeds from this share of its own on.
const BARRED_FROM: f64 = 0.97;
/// Assumed delay of a stop before any was measured, s, and the lowest speed of a first close chosen for it.
const STOPS_LATE_S: f64 = 0.08;
const GENTLE_LEAST: i16 = 5;
/// A threshold closer than this many noise deviations above the reading at rest is reached by noise alone.
const STOPS_SIGMAS: f64 = 6.0;
/// Estimated duration of a close before any was measured.
const CLOSE_TAKES: Duration = Duration::from_secs(7);

/// The next close to run.
#[derive(Debug, Clone, PartialEq)]
pub struct NextClose {
    pub plan: TrialPlan,
    pub setting: TrialSetting,
    /// Mean contact angle of each joint; `None` before it is known.
    pub contact: PerDof<Option<Angle>>,
    /// True if it searches for the contact.
    pub is_probe: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum SearchPhase {
    First,
    Second,
    Rising { rises: usize },
    Confirming(Confirmation),
}

/// The setting and approach being tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    setting: TrialSetting,
    approach: FoundApproach,
}

/// A running search.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingsSearch {
    goal: SearchGoal,
    joints: Vec<JointModel>,
    phase: SearchPhase,
    choice: Candidate,
    threshold_g: f64,
    /// Closes over the limit, or with a slip: nothing as fast at such a threshold is tried again.
    barred: Vec<ContactSetting>,
    /// Bound of the peaks, in standard deviations above their mean.
    factor: f64,
    /// Modelled hold that is required, g, after closes held less than their model.
    hold_more_g: f64,
    /// Successive closes that were uncertain or ended in free air.
    repeats: usize,
    confirmations: usize,
    /// A peak was far above the others: the distribution is not normal.
    has_tail: bool,
    tried: Vec<Tried>,
    open_questions: Vec<OpenQuestion>,
    result: Option<Result<Claim, NoClaim>>,
    /// Duration of the last close, including travel.
    last_duration: Option<Duration>,
}

impl SettingsSearch {
    ///
    /// # Errors
    /// [`GoalError`] if the goal is invalid.
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
            choice: Candidate {
                setting,
                approach: FoundApproach::OneStage,
            },
            threshold_g: f64::from(first.force.get()),
            barred: Vec::new(),
            factor: tolerance_factor(goal.closes, goal.assurance()).unwrap_or(3.0),
            hold_more_g: 0.0,
            repeats: 0,
            confirmations: 0,
            has_tail: false,
            tried: Vec::new(),
            open_questions: Vec::new(),
            result: None,
            last_duration: None,
            goal,
        })
    }

    /// The plan of its trials: joints, ways and limits, with speed and threshold of the current choice.
    pub fn plan(&self) -> TrialPlan {
        self.goal.plan(self.choice.setting)
    }

    /// The result; `None` while the search runs.
    pub fn finding(&self) -> Option<Finding> {
        let result = self.result.clone()?;
        let compared: Vec<ComparedThreshold> =
            self.joints.iter().map(JointModel::compared).collect();
        let open = compared.iter().filter(|own| {
            let is_known = own
                .compared
                .is_some_and(|own| own != ThresholdReference::Unknown);
            !is_known && own.is_notable()
        });
        let open = open.map(|own| OpenQuestion::Offset {
            dof: own.dof,
            offset_g: own.offset_g,
        });
        Some(Finding {
            result,
            tried: self.tried.clone(),
            open_questions: self.open_questions.iter().copied().chain(open).collect(),
            compared,
        })
    }

    pub fn tried(&self) -> &[Tried] {
        &self.tried
    }

    pub fn progress(&self) -> SearchProgress {
        let of = self.needed();
        let (stage, closes_left) = match &self.phase {
            _ if self.result.is_some() => (SearchStage::Over, 0),
            SearchPhase::First => (SearchStage::Probing, of + 8),
            SearchPhase::Second => (SearchStage::Probing, of + 7),
            SearchPhase::Rising { rises } => (
                SearchStage::Rising,
                of + 6_usize.saturating_sub(*rises).max(1),
            ),
            SearchPhase::Confirming(confirmation) => {
                let here = confirmation.closes();
                let done = if self.is_free() {
                    self.relevant_closes(self.at(self.speed()))
                } else {
                    here
                };
                // The last of them must be of the setting itself.
                let left = of
                    .saturating_sub(done)
                    .max(self.here_least() - here.min(self.here_least()));
                let done = done.min(of.saturating_sub(left));
                (SearchStage::Confirming { done, of }, left)
            }
        };
        let each = self.last_duration.unwrap_or(CLOSE_TAKES);
        let left = u32::try_from(closes_left).map_or(Duration::MAX, |n| each.saturating_mul(n));
        SearchProgress {
            stage,
            tried: self.tried.clone(),
            closes_left,
            left,
        }
    }

    /// The next close; `None` once the search is over.
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

    /// Learns from a completed close, and chooses the next.
    pub fn learn(&mut self, trial: &Trial) {
        self.last_duration = duration_of(trial).or(self.last_duration);
        self.learn_facts(trial.summary.number, &CloseFacts::of(trial));
    }

    /// Learns from the facts of a completed close, and chooses the next.
    pub(crate) fn learn_facts(&mut self, number: usize, facts: &[CloseFacts]) {
        self.note(number, facts);
        if let Err(none) = self.apply(facts) {
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

    fn apply(&mut self, facts: &[CloseFacts]) -> Result<(), NoClaim> {
        // Checked first, since no contact is detectable in noise.
        self.check_noise(facts)?;
        if let Some(stopped) = self.stopped_in_air(facts) {
            return self.stop_later(stopped);
        }
        let slips = self.inspect(facts)?;
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
            let threshold_g = if slips { 0.0 } else { at.threshold_g };
            self.bar(ContactSetting { threshold_g, ..at });
            return self.narrow(facts, slips);
        }
        if let Some(unseen) = facts.iter().find(|joint| joint.is_uncertain) {
            return self.again(NoClaim::NotMeasured { dof: unseen.dof });
        }
        self.repeats = 0;
        match &mut self.phase {
            SearchPhase::First => self.probe_again(),
            SearchPhase::Second => self.rise(0),
            SearchPhase::Rising { rises } => {
                let rises = *rises + 1;
                self.rise(rises)
            }
            SearchPhase::Confirming(confirmation) => {
                confirmation.add(facts);
                self.confirmed()
            }
        }
    }

    /// Repeats the same close; fails with `why` after too many repeats.
    const fn again(&mut self, why: NoClaim) -> Result<(), NoClaim> {
        self.repeats += 1;
        if self.repeats > REPEATS_MAX {
            return Err(why);
        }
        Ok(())
    }

    /// The joint whose drive stopped before it met anything, because of its reading at rest.
    fn stopped_in_air(&self, facts: &[CloseFacts]) -> Option<CloseFacts> {
        let limit = self.limit();
        let mut joints = self.joints.iter().zip(facts);
        let stopped = joints.find(|(joint, facts)| {
            let above = self.threshold_g - facts.offset_g;
            let noise = STOPS_SIGMAS * joint.noise_g().max(facts.noise_g);
            let is_light = facts.contact.is_none() || facts.peak_g.is_none();
            is_light && facts.stopped_by_force && above < noise.min(limit)
        });
        stopped.map(|(_, facts)| *facts)
    }

    /// Chooses a threshold above the reading at rest.
    fn stop_later(&mut self, stopped: CloseFacts) -> Result<(), NoClaim> {
        let (dof, offset_g) = (stopped.dof, stopped.offset_g);
        let limit = self.limit();
        let noise_g = stopped.noise_g;
        for joint in self.joints.iter_mut().filter(|joint| joint.dof == dof) {
            joint.growth.stopped_in_air(offset_g);
            let least = joint.stops_least(limit).max(STOPS_SIGMAS * noise_g);
            self.threshold_g = self.threshold_g.max((offset_g + least).ceil());
        }
        if self.threshold_g > f64::from(Force::MAX.get()) {
            return Err(NoClaim::Offset { dof, offset_g });
        }
        self.choose(self.speed(), self.choice.approach);
        self.again(NoClaim::Offset { dof, offset_g })
    }

    fn bar(&mut self, at: ContactSetting) {
        self.barred.push(at);
    }

    fn is_barred(&self, at: ContactSetting) -> bool {
        self.barred.iter().any(|own| {
            at.speed >= BARRED_FROM * own.speed && at.threshold_g >= own.threshold_g - 1.0
        })
    }

    /// Checks the facts: `Err` ends the search; otherwise true if the object slipped.
    fn inspect(&mut self, facts: &[CloseFacts]) -> Result<bool, NoClaim> {
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
            if joint.peak_g.is_none() {
                return Err(NoClaim::NotMeasured { dof });
            }
            if joint.close_s.is_none() || joint.steady_g.is_none() {
                return Err(NoClaim::NoStop { dof });
            }
            slips |= joint.slips.is_some_and(|count| count > 0);
            self.note_open_questions(joint);
        }
        if facts.len() < self.joints.len() {
            let dof = self.joints.first().map_or(Dof::Index, |own| own.dof);
            return Err(NoClaim::NotMeasured { dof });
        }
        Ok(slips)
    }

    fn note_open_questions(&mut self, joint: &CloseFacts) {
        let dof = joint.dof;
        let gap = joint.longest_gap_s.filter(|gap| *gap > GAP_S);
        let is_known =
            |one: &OpenQuestion| self.open_questions.iter().any(|own| own.is_of_same(one));
        let slips = joint.slips.is_none().then_some(OpenQuestion::Slips { dof });
        let gaps = gap.map(|gap_s| OpenQuestion::Gaps { dof, gap_s });
        let new: Vec<OpenQuestion> = slips
            .into_iter()
            .chain(gaps)
            .filter(|one| !is_known(one))
            .collect();
        self.open_questions.extend(new);
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

    fn at(&self, speed: f64) -> ContactSetting {
        ContactSetting {
            speed,
            threshold_g: self.threshold_g,
        }
    }

    fn probe_again(&mut self) -> Result<(), NoClaim> {
        self.phase = SearchPhase::Second;
        let is_open = |joint: &JointModel| {
            let own = joint.compared();
            own.compared.is_none() && own.is_notable()
        };
        let speed = if self.joints.iter().any(is_open) {
            (self.speed() / SECOND_SLOWER).max(SLOWEST.into())
        } else {
            self.speed()
        };
        let under = self
            .thresholds()
            .into_iter()
            .map(|threshold_g| ContactSetting { speed, threshold_g });
        let under = under.take_while(|at| self.is_under(*at, &Self::safe));
        let under: Vec<ContactSetting> = under.collect();
        let holds = under.iter().find(|at| self.holds_enough(**at));
        let found = holds.or(under.last()).map(|at| at.threshold_g);
        self.threshold_g = found.unwrap_or(self.threshold_g);
        let approach = FoundApproach::TwoStage {
            fast_speed: SECOND_FAST,
            margin: SECOND_MARGIN,
        };
        self.choose(speed, approach);
        Ok(())
    }

    fn choose_at(&mut self, at: ContactSetting) {
        self.threshold_g = at.threshold_g;
        self.choose(at.speed, self.approach(at));
    }

    fn choose(&mut self, speed: f64, approach: FoundApproach) {
        self.choice = Candidate {
            setting: TrialSetting {
                speed: Speed::nearest(whole(speed)),
                force: Force::nearest(whole(self.threshold_g)),
            },
            approach,
        };
    }

    /// The quicker approach at this speed; one stage if there is no room for two.
    fn approach(&self, at: ContactSetting) -> FoundApproach {
        let margins = self.joints.iter().map(JointModel::margin);
        let margin = margins.fold(0.0, f64::max).ceil();
        let two = FoundApproach::TwoStage {
            fast_speed: FAST,
            margin: whole(margin).clamp(1, 500),
        };
        let one = FoundApproach::OneStage;
        if self.room() <= margin + 1.0
            || self.estimated_close_s(one, at) <= self.estimated_close_s(two, at)
        {
            one
        } else {
            two
        }
    }

    /// The shortest way to the contact among the joints, units of ANGLE_ACT.
    fn room(&self) -> f64 {
        let room = self.joints.iter().map(|joint| {
            let (start, _) = self.goal.way(joint.dof);
            start - joint.contact().unwrap_or(start)
        });
        room.fold(f64::INFINITY, f64::min)
    }

    /// Estimated time of a close after the dead time, s.
    fn estimated_close_s(&self, approach: FoundApproach, at: ContactSetting) -> f64 {
        let rate = self.joints.first().map_or(1.5, JointModel::rate).max(0.01);
        let pressed = self.joints.iter().filter_map(|joint| {
            let stops_at = joint.growth.stops_at(at.threshold_g);
            Some(stops_at / joint.stiffness()?.max(0.1))
        });
        let pressed = pressed.fold(0.0, f64::max);
        let (fast_s, slow_way) = match approach {
            FoundApproach::OneStage => (0.0, self.room()),
            FoundApproach::TwoStage { fast_speed, margin } => {
                let fast_way = (self.room() - f64::from(margin)).max(0.0);
                let fast_s = fast_way / (rate * f64::from(fast_speed.max(1)));
                (fast_s + PAUSE_S, f64::from(margin))
            }
        };
        fast_s + (slow_way + pressed) / (rate * at.speed.max(1.0))
    }

    /// The highest mean peak that is still possible, plus the scatter of single closes.
    fn safe(&self, joint: &JointModel, at: ContactSetting) -> Option<f64> {
        Some(joint.growth.upper(at)? + 2.0 * joint.growth.scatter(at))
    }

    /// The bound that will probably be confirmed.
    fn expected(&self, joint: &JointModel, at: ContactSetting) -> Option<f64> {
        let bound = self.expected_at_last(joint, at)?;
        if !self.is_early(joint, at) {
            return Some(bound);
        }
        let stops_at = joint.growth.stops_at(at.threshold_g);
        Some(bound.max(stops_at + LATE * (joint.growth.likely(at)? - stops_at)))
    }

    /// The same once enough closes show how late stops are.
    fn expected_at_last(&self, joint: &JointModel, at: ContactSetting) -> Option<f64> {
        let factor = if self.is_free() {
            LARGEST_SIGMAS
        } else {
            self.factor
        };
        let usual = joint.growth.likely(at)? + factor * joint.growth.scatter(at);
        // A close over the limit counts for all later settings.
        let stops_at = joint.growth.stops_at(at.threshold_g);
        let reserve = if self.has_tail { LATER } else { 1.0 };
        Some(usual.max(stops_at + reserve * (largest_g(joint, at) - stops_at)))
    }

    /// True if the bound is the largest of all closes: on request, with enough closes, or if their peaks are not normal.
    const fn is_free(&self) -> bool {
        self.goal.distribution_free || self.goal.closes >= FREE_95 || self.has_tail
    }

    /// Closes that a claim needs.
    const fn needed(&self) -> usize {
        if self.has_tail && !self.goal.distribution_free && self.goal.closes < FREE_95 {
            return FREE_95;
        }
        self.goal.closes
    }

    /// True while too few closes show how late stops are.
    fn is_early(&self, joint: &JointModel, at: ContactSetting) -> bool {
        self.is_free() && joint.growth.carried(at).certain + HERE_LEAST < self.needed()
    }

    /// Number of closes relevant to this setting.
    fn relevant_closes(&self, at: ContactSetting) -> usize {
        let counts = self.joints.iter().map(|own| own.growth.carried(at).certain);
        counts.min().unwrap_or_default()
    }

    fn is_under(
        &self,
        at: ContactSetting,
        bound: &impl Fn(&Self, &JointModel, ContactSetting) -> Option<f64>,
    ) -> bool {
        let under =
            |joint: &JointModel| bound(self, joint, at).is_some_and(|peak| peak <= self.limit());
        !self.is_barred(at) && self.joints.iter().all(under)
    }

    fn holds_enough(&self, at: ContactSetting) -> bool {
        let hold = f64::from(self.goal.hold_g).max(self.hold_more_g);
        let holds = |joint: &JointModel| joint.holds(at).is_some_and(|own| own >= hold);
        self.joints.iter().all(holds)
    }

    /// Candidate thresholds, ascending.
    fn thresholds(&self) -> Vec<f64> {
        let limit = self.limit();
        let least = self.joints.iter().map(|joint| joint.threshold_least(limit));
        let least = least.fold(1.0, f64::max);
        let most = self
            .joints
            .iter()
            .map(|joint| joint.threshold_for(STOPS_MOST * limit));
        let most = most
            .fold(f64::INFINITY, f64::min)
            .min(f64::from(Force::MAX.get()));
        let stops_least = self.joints.iter().map(|joint| joint.stops_least(limit));
        let mut stops_at = stops_least.fold(1.0, f64::max);
        let first = stops_at;
        let mut thresholds = Vec::new();
        loop {
            let threshold = (least + stops_at - first).ceil();
            if threshold > most.max(least) {
                return thresholds;
            }
            thresholds.push(threshold);
            stops_at *= THRESHOLD_STEP;
        }
    }

    /// The speed of the fastest close so far.
    fn fastest(&self) -> f64 {
        let fastest = self
            .joints
            .iter()
            .filter_map(|joint| joint.growth.fastest());
        fastest.reduce(f64::min).unwrap_or(self.speed())
    }

    /// The highest speed allowed for the next close.
    fn fastest_step(&self) -> f64 {
        (RISE_MOST * self.fastest()).min(Speed::MAX.get().into())
    }

    /// The quickest close up to speed `most` that holds, with its bound under the limit.
    fn quickest(
        &self,
        most: f64,
        bound: impl Fn(&Self, &JointModel, ContactSetting) -> Option<f64>,
    ) -> Option<ContactSetting> {
        let mut best: Option<(f64, ContactSetting)> = None;
        for threshold_g in self.thresholds() {
            let at = |speed| ContactSetting { speed, threshold_g };
            let (mut low, mut high) = (f64::from(SLOWEST), most.floor() + 1.0);
            if low >= high || !self.is_under(at(low), &bound) {
                continue;
            }
            // The bounds increase with the speed, except for small dips in the published shapes.
            while high - low > 1.0_f64.max(SPEED_STEP * low) {
                let middle = f64::midpoint(low, high).floor();
                if self.is_under(at(middle), &bound) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let at = at(low);
            if !self.holds_enough(at) {
                continue;
            }
            let takes = self.estimated_close_s(self.approach(at), at);
            if best.is_none_or(|(least, _)| takes < least) {
                best = Some((takes, at));
            }
        }
        best.map(|(_, at)| at)
    }

    /// The quickest close that no result so far rules out.
    fn quickest_safe(&self) -> Option<ContactSetting> {
        let both = |own: &Self, joint: &JointModel, at: ContactSetting| {
            Some(own.safe(joint, at)?.max(own.expected(joint, at)?))
        };
        self.quickest(self.fastest_step(), both)
    }

    /// The quickest close that will probably be confirmed, no faster than any close so far.
    fn quickest_likely(&self) -> Option<ContactSetting> {
        self.quickest(self.fastest(), Self::expected)
    }

    /// Increases the speed, or starts to confirm.
    fn rise(&mut self, rises: usize) -> Result<(), NoClaim> {
        let Some(next) = self.quickest_safe() else {
            return match self.harder() {
                Some(at) if rises < RISES_MAX => {
                    self.phase = SearchPhase::Rising { rises };
                    self.choose_at(at);
                    Ok(())
                }
                _ => self.slower(),
            };
        };
        let is_worth = self.gain(next) > WORTH_ONE || !self.holds_enough(self.at(self.speed()));
        if rises < RISES_MAX && is_worth && next != self.at(self.speed()) {
            self.phase = SearchPhase::Rising { rises };
            self.choose_at(next);
            return Ok(());
        }
        self.confirm(next)
    }

    /// The highest threshold that stays under the limit, if it is more informative than those before. For when no setting is certain
    /// both to hold and to stay under the limit.
    fn harder(&self) -> Option<ContactSetting> {
        let thresholds = self.thresholds().into_iter().rev();
        let mut speeds = thresholds.filter_map(|threshold_g| {
            let slower = |n: f64| ContactSetting {
                speed: (self.fastest() / n).max(SLOWEST.into()).floor(),
                threshold_g,
            };
            let speeds = [1.0, 2.0, 4.0, 8.0, 16.0].map(slower).into_iter();
            let mut safe = speeds.filter(|at| self.is_under(*at, &Self::safe));
            safe.next()
        });
        let stops_at = |at: ContactSetting| {
            let joints = self.joints.iter();
            let stops = joints.map(|joint| joint.growth.stops_at(at.threshold_g));
            stops.fold(f64::INFINITY, f64::min)
        };
        let before = self.joints.iter().map(|joint| joint.growth.stopped_most());
        let before = before.fold(0.0, f64::max);
        speeds.next().filter(|at| stops_at(*at) > HARDER * before)
    }

    /// Saving by this setting with its best approach, as a share of the last close.
    fn gain(&self, at: ContactSetting) -> f64 {
        let Some(close) = self.tried.last().and_then(|own| own.close_s) else {
            return 1.0;
        };
        let now = self.estimated_close_s(self.choice.approach, self.at(self.speed()));
        (now - self.estimated_close_s(self.approach(at), at)) / close.max(0.05)
    }

    fn confirm(&mut self, at: ContactSetting) -> Result<(), NoClaim> {
        self.confirmations += 1;
        if self.confirmations > CONFIRMATIONS_MAX {
            let trials = self.tried.len();
            return Err(NoClaim::NotConfirmed { trials });
        }
        self.choose_at(at);
        let dofs = self.joints.iter().map(|joint| joint.dof);
        self.phase = SearchPhase::Confirming(Confirmation::new(dofs));
        Ok(())
    }

    /// Chooses something slower, after a close over the limit or a slip.
    fn narrow(&mut self, facts: &[CloseFacts], slips: bool) -> Result<(), NoClaim> {
        let is_slowest = self.speed() <= f64::from(SLOWEST);
        if slips && (is_slowest || self.phase == SearchPhase::First) {
            let dof = facts.first().map_or(Dof::Index, |own| own.dof);
            return Err(NoClaim::Slips { dof });
        }
        match self.phase {
            SearchPhase::First => {
                self.phase = SearchPhase::Second;
                let Some(at) = self.quickest_safe() else {
                    return Err(self.too_strong());
                };
                self.choose_at(at);
                let approach = FoundApproach::TwoStage {
                    fast_speed: SECOND_FAST,
                    margin: SECOND_MARGIN,
                };
                self.choose(at.speed, approach);
                Ok(())
            }
            SearchPhase::Second | SearchPhase::Rising { .. } => self.rise(RISES_MAX),
            SearchPhase::Confirming(_) => self.slower(),
        }
    }

    /// Confirms the quickest setting that is likely to pass and not excluded.
    fn slower(&mut self) -> Result<(), NoClaim> {
        match self.quickest_likely() {
            Some(at) => self.confirm(at),
            None => Err(self.too_strong()),
        }
    }

    /// The reason why nothing fits, from the joint furthest over the limit at the lowest threshold that holds.
    fn too_strong(&self) -> NoClaim {
        let slowest = |threshold_g| ContactSetting {
            speed: SLOWEST.into(),
            threshold_g,
        };
        let mut thresholds = self.thresholds().into_iter().map(slowest);
        let holding = thresholds.clone().find(|at| self.holds_enough(*at));
        let at = holding
            .or(thresholds.next_back())
            .unwrap_or(self.at(SLOWEST.into()));
        let bounds = self.joints.iter().filter_map(|joint| {
            let peak_g = self.expected(joint, at)?.max(self.safe(joint, at)?);
            Some((joint.dof, peak_g))
        });
        let worst = bounds.max_by(|(_, a), (_, b)| a.total_cmp(b));
        let (dof, peak_g) = worst.unwrap_or((Dof::Index, 0.0));
        if peak_g > self.limit() && holding.is_some() {
            return NoClaim::TooStrong {
                dof,
                speed: SLOWEST,
                peak_g,
            };
        }
        let holds = self.joints.iter().filter_map(|joint| joint.holds(at));
        NoClaim::HoldsTooLittle {
            dof,
            holds_g: holds.fold(f64::INFINITY, f64::min).clamp(0.0, self.limit()),
            wanted_g: self.goal.hold_g,
        }
    }

    /// Closes of a setting before its first judgement.
    const fn here_least(&self) -> usize {
        if self.is_free() {
            HERE_LEAST
        } else {
            self.goal.closes
        }
    }

    /// Judges a setting after each of its closes: claims it, or chooses something slower, something faster, or another close.
    fn confirmed(&mut self) -> Result<(), NoClaim> {
        let SearchPhase::Confirming(confirmation) = &self.phase else {
            return Ok(());
        };
        let (here, least_hold) = (confirmation.closes(), confirmation.least_hold());
        let now = self.at(self.speed());
        self.has_tail |= self.joints.iter().any(|own| has_tail(own, now));
        let bound = self.bound(now);
        let is_over = bound > self.limit();
        if here < self.here_least() && !(is_over && self.is_free()) {
            return Ok(());
        }
        if let Some(creeps) = self.joints.iter().find_map(JointModel::creeps) {
            return Err(creeps);
        }
        if least_hold.1 < f64::from(self.goal.hold_g) {
            return self.hold_more(least_hold);
        }
        if is_over {
            self.bar(now);
            return match self.better(now, bound) {
                Some(at) => self.confirm(at),
                None => self.slower(),
            };
        }
        // The contact is known better by now, so even the same speed may be quicker with a smaller margin.
        let better = self.better(now, bound);
        match better.filter(|at| self.gain(*at) > WORTH_TEN) {
            Some(at) => self.confirm(at),
            None if self.relevant_closes(now) >= self.needed() || !self.is_free() => {
                self.claim();
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Bound of future peaks, g: the highest of all joints.
    fn bound(&self, now: ContactSetting) -> f64 {
        let bounds = self
            .joints
            .iter()
            .map(|own| bound_g(own, now, self.is_free()));
        bounds.fold(0.0, f64::max)
    }

    /// Chooses a setting with a stronger hold.
    fn hold_more(&mut self, (dof, holds_g): (Dof, f64)) -> Result<(), NoClaim> {
        let wanted = f64::from(self.goal.hold_g);
        self.hold_more_g = self.hold_more_g.max(wanted) + (wanted - holds_g) + 2.0;
        match self.quickest_likely() {
            Some(at) => self.confirm(at),
            None => Err(NoClaim::HoldsTooLittle {
                dof,
                holds_g,
                wanted_g: self.goal.hold_g,
            }),
        }
    }

    /// Another setting worth confirming, given the bound of the current one.
    fn better(&self, now: ContactSetting, bound: f64) -> Option<ContactSetting> {
        let safe = |own: &Self, joint: &JointModel, at: ContactSetting| {
            let is_known = at.speed <= now.speed && at.threshold_g <= now.threshold_g;
            let safe = own.safe(joint, at).filter(|_| !is_known);
            safe.unwrap_or_default()
        };
        let SearchPhase::Confirming(confirmation) = &self.phase else {
            return None;
        };
        if !self.is_free() {
            // The ratio of bound to expectation here may apply elsewhere too.
            let joints = self.joints.iter();
            let expected = joints.filter_map(|joint| self.expected(joint, now));
            let times = bound / expected.fold(1.0, f64::max) / AIM;
            let may = bound > self.limit() || self.tried.len() < RISING_UNTIL;
            return may.then_some(()).and_then(|()| {
                self.quickest(self.fastest_step(), |own, joint, at| {
                    Some((times * own.expected(joint, at)?).max(safe(own, joint, at)))
                })
            });
        }
        let closes = self.joints.iter().map(|own| own.growth.closes()).min()?;
        if closes + HERE_LEAST >= self.needed() {
            let last = self.quickest(self.fastest_step(), |own, joint, at| {
                Some((own.expected_at_last(joint, at)? / AIM).max(safe(own, joint, at)))
            });
            let is_early =
                |at: &ContactSetting| self.joints.iter().any(|own| self.is_early(own, *at));
            if let Some(at) = last.filter(|at| !is_early(at)) {
                return Some(at);
            }
        }
        let is_first_look = confirmation.closes() == HERE_LEAST || bound > self.limit();
        is_first_look.then_some(()).and_then(|()| {
            self.quickest(self.fastest_step(), |own, joint, at| {
                Some((own.expected(joint, at)? / AIM).max(safe(own, joint, at)))
            })
        })
    }

    fn claim(&mut self) {
        let SearchPhase::Confirming(confirmation) = &self.phase else {
            return;
        };
        let now = self.at(self.speed());
        let is_free = self.is_free();
        let here = confirmation.closes();
        let first = self.tried.len().saturating_sub(here);
        let joints = confirmation.claims(&self.joints, now, is_free);
        let close_s = confirmation.close_s();
        for own in self.tried.iter_mut().skip(first) {
            own.confirms = true;
        }
        for joint in joints.iter().filter(|joint| joint.stiffness_g.is_none()) {
            self.open_questions
                .push(OpenQuestion::Stiffness { dof: joint.dof });
        }
        let closes = if is_free {
            self.relevant_closes(now)
        } else {
            here
        };
        self.open_questions.extend(match closes - here.min(closes) {
            _ if !is_free => Some(OpenQuestion::Distribution),
            0 => None,
            slower => Some(OpenQuestion::OtherSpeeds { closes: slower }),
        });
        let assurance = if self.goal.distribution_free {
            self.goal.assurance()
        } else {
            Assurance::USUAL
        };
        self.result = Some(Ok(Claim {
            setting: self.choice.setting,
            approach: self.choice.approach,
            joints,
            close_s,
            closes,
            here,
            assurance,
            distribution_free: is_free,
        }));
    }
}

/// The speed of the first close: slow, and slower still if that may exceed the limit on a rigid block.
fn gentle(goal: &SearchGoal, setting: TrialSetting) -> Speed {
    let threshold = f64::from(setting.force.get());
    let worst = |speed: Speed| speed.angle_per_s() * STOPS_LATE_S * RIGID_G_PER_COUNT * 2.0;
    let mut slow = setting.speed.get();
    while slow > GENTLE_LEAST && threshold + worst(Speed::nearest(slow)) > f64::from(goal.limit_g) {
        slow -= 1;
    }
    Speed::nearest(slow)
}

/// Duration of a trial.
fn duration_of(trial: &Trial) -> Option<Duration> {
    let rows = trial.recording.rows();
    let (first, last) = (rows.first()?, rows.last()?);
    Duration::try_from_secs_f64(seconds(first.at, last.at)).ok()
}
