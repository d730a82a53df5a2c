//! Holds of random objects by random bodies in virtual time, judged by the simulated object's own truth. Used by the bench and, in a
//! small form, by the tests.

use handscope::hand::gap::SizeBlocks;
use handscope::hand::grip::GripEstimator;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::overshoot::OvershootMap;
use handscope::hand::{
    Angle, ArmEpoch, Dof, Finger, Force, Group, HandCommand, HandSample, Moment, PerDof, PerFinger,
    Reply, Setpoints, Target,
};
use handscope::link::LinkStatus;
use handscope::motion::hold::{HoldClose, HoldEnd, HoldRun, HoldStart, HoldView};
use handscope::motion::program::{Order, Program, Seen};
use handscope::record::LinkState;
use handscope::sim::body_params::BodyParams;
use handscope::sim::body_params::random::random;
use handscope::sim::object::{Friction, Loads, PullLoad, listed};
use handscope::sim::{HeldState, Object, ObjectLoss, Obstacle, Scenario, SimConfig, SimHand};
use std::time::Duration;

/// Random bodies; each holds every 40th object.
pub(crate) const BODIES: u64 = 40;
const EPOCH: ArmEpoch = ArmEpoch(1);
/// Interval of the loop. The state is read in every second step, the fingertips in every sixth, the rest in every fortieth.
const STEP: Duration = Duration::from_millis(5);
/// Time for which an object is held: the lift, and three pulls with 4 s between them.
const HOLD_DURATION: Duration = Duration::from_secs(16);
/// Without a disturbance a hold has settled this long after the lift.
const SETTLE_DURATION: Duration = Duration::from_secs(3);
/// Share of its capacity up to which *at most* certainly holds an object: friction scatters from pad to pad.
const SURE_SHARE: f64 = 0.97;
/// A slide that a fingertip can show, mm.
const SHOWN_MM: f64 = 1.0;
/// A finger below this share of *at most* can press harder.
const ROOM_SHARE: f64 = 0.8;

/// An object, and the forces between which it is held.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    seed: u64,
    pub(crate) object: Object,
    pub(crate) forces: HoldForces,
    /// Number of fingers that touch it.
    fingers: f64,
    /// Largest load along the pads, g.
    pub(crate) load_g: f64,
    pub(crate) is_fragile: bool,
    /// Nothing pulls at it.
    pub(crate) is_quiet: bool,
}

impl Plan {
    /// The hold of this seed.
    pub(crate) fn draw(seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed ^ 0x401D);
        let mut between = |low: f64, high: f64| low + (high - low) * chance.f64();
        let stiffness = 40f64.powf(between(0.0, 1.0));
        let angle = between(350.0, 750.0);
        let at_least_g = between(80.0, 250.0).round();
        let at_most_g = (at_least_g + between(150.0, 600.0)).round();
        let is_fragile = between(0.0, 1.0) < 0.2;
        let is_pinch = between(0.0, 5.0) < 1.0;
        let sticking = between(0.3, 1.0);
        let mass_g = 20.0 * 25f64.powf(between(0.0, 1.0));
        let contacts = PerDof::from_fn(|dof| {
            let touches = match dof {
                Dof::ThumbRotate => false,
                Dof::Index | Dof::ThumbBend => true,
                Dof::Little | Dof::Ring | Dof::Middle => !is_pinch,
            };
            touches.then(|| Obstacle {
                breaks_at_g: is_fragile.then_some(at_most_g * 1.1 + 60.0),
                ..Obstacle::at(angle + between(-20.0, 20.0), stiffness)
            })
        });
        let fingers = if is_pinch { 2.0 } else { 5.0 };
        let capacity_g = fingers * sticking * at_most_g;
        let count = between(0.0, 4.0) as u32;
        let pulls: Vec<PullLoad> = (0..count)
            .map(|at| PullLoad {
                at_s: 2.0 + 4.0 * f64::from(at),
                force_g: (between(0.05, 0.6) * capacity_g - mass_g).max(0.0),
                direction_deg: between(0.0, 360.0),
                rise_ms: between(200.0, 1000.0),
                lasts_ms: between(100.0, 1500.0),
            })
            .collect();
        let loads = pulls.iter().map(|pull| load_g(mass_g, pull));
        Self {
            seed,
            load_g: loads.fold(mass_g, f64::max),
            object: Object {
                mass_g,
                friction: Friction {
                    sticking,
                    sliding_ratio: 0.8,
                    drag_per_mm_s: 0.0,
                    scatter: 0.05,
                },
                loads: Loads {
                    lift_after_s: Some(1.5),
                    pulls: listed(&pulls),
                    ..Loads::NONE
                },
                ..Object::touched_at(contacts)
            },
            forces: HoldForces::new(grams(at_least_g), grams(at_most_g)).unwrap(),
            fingers,
            is_fragile,
            is_quiet: pulls.is_empty(),
        }
    }

    fn at_most_g(&self) -> f64 {
        f64::from(self.forces.at_most().get())
    }

    /// Force of each finger without which its largest load would pull it out, g.
    fn needed_g(&self) -> f64 {
        self.load_g / (self.fingers * self.object.friction.sticking)
    }

    /// True if *at most* would hold it.
    pub(crate) fn is_possible(&self) -> bool {
        self.needed_g() <= SURE_SHARE * self.at_most_g()
    }

    /// Smallest force between the limits that holds it, g.
    fn least_g(&self) -> f64 {
        f64::from(self.forces.at_least().get()).max(self.needed_g())
    }
}

fn grams(force_g: f64) -> Force {
    Force::nearest(force_g as i64)
}

/// The weight and a pull, g.
fn load_g(mass_g: f64, pull: &PullLoad) -> f64 {
    let from_weight = (pull.direction_deg - 270.0).to_radians();
    let along = mass_g + pull.force_g * from_weight.cos();
    along.hypot(pull.force_g * from_weight.sin())
}

/// What happened in a hold.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    pub(crate) plan: Plan,
    pub(crate) end: HoldEnd,
    pub(crate) is_lifted: bool,
    pub(crate) is_dropped: bool,
    pub(crate) is_broken: bool,
    /// Largest force of a finger above *at most*, g.
    pub(crate) over_g: f64,
    /// Mean force of the pressing fingers while it was carried, relative to the least that would have held; `None` if it never was.
    pub(crate) ratio: Option<f64>,
    /// Changes of the direction of an angle target after it settled, and for how long, s.
    pub(crate) reversals: u32,
    pub(crate) settled_s: f64,
    /// Delay of the first frame that tightens after the reading that shows a slide, ms; `None` if there was none while it slid.
    pub(crate) delays_ms: Vec<Option<f64>>,
}

impl Outcome {
    /// It was not held although *at most* would have held it.
    pub(crate) fn is_missed(&self) -> bool {
        self.plan.is_possible() && (self.is_dropped || !self.is_lifted)
    }
}

/// The outcomes of many holds.
#[derive(Debug, Default)]
pub(crate) struct HoldTable {
    pub(crate) outcomes: Vec<Outcome>,
}

impl HoldTable {
    pub(crate) fn count(&self, is_counted: impl Fn(&Outcome) -> bool) -> usize {
        self.outcomes.iter().filter(|own| is_counted(own)).count()
    }

    /// Those that end held.
    pub(crate) fn ratios(&self) -> Vec<f64> {
        let held = self.outcomes.iter().filter(|own| own.end == HoldEnd::Held);
        sorted(held.filter_map(|own| own.ratio))
    }

    pub(crate) fn over_g(&self) -> Vec<f64> {
        sorted(self.outcomes.iter().map(|own| own.over_g))
    }

    /// Delays of the slides that were answered.
    pub(crate) fn delays_ms(&self) -> Vec<f64> {
        let delays = self.outcomes.iter().flat_map(|own| &own.delays_ms);
        sorted(delays.copied().flatten())
    }

    /// Slides that were not.
    pub(crate) fn unanswered(&self) -> usize {
        let delays = self.outcomes.iter().flat_map(|own| &own.delays_ms);
        delays.filter(|delay| delay.is_none()).count()
    }

    /// Reversals a minute of the settled holds without a disturbance.
    pub(crate) fn reversals_per_min(&self) -> f64 {
        let quiet = || self.outcomes.iter().filter(|own| own.plan.is_quiet);
        let reversals: u32 = quiet().map(|own| own.reversals).sum();
        let settled_s: f64 = quiet().map(|own| own.settled_s).sum();
        60.0 * f64::from(reversals) / settled_s.max(1.0)
    }

    /// One line with all of it.
    pub(crate) fn line(&self) -> String {
        let end = |end: HoldEnd| self.count(|own| own.end == end);
        let over_g = self.over_g();
        let ratios = self.ratios();
        let delays_ms = self.delays_ms();
        format!(
            "{} holds: {} held, {} nothing, {} lost, {} late; possible {}, missed {}; fragile {}, broken {}; over at most {:.0} g in the mean of 2, {:.0} g in 1 of 100, {:.0} g at most; force {:.2} of the least, {:.2} in 1 of 10; {:.2} reversals a minute; {} slides answered, {:.0} ms in the mean of 2, {:.0} ms in 1 of 10, {} not",
            self.outcomes.len(),
            end(HoldEnd::Held),
            end(HoldEnd::Nothing),
            end(HoldEnd::Lost),
            end(HoldEnd::Late),
            self.count(|own| own.plan.is_possible()),
            self.count(Outcome::is_missed),
            self.count(|own| own.plan.is_fragile),
            self.count(|own| own.is_broken),
            at_share(&over_g, 0.5),
            at_share(&over_g, 0.99),
            at_share(&over_g, 1.0),
            mean(&ratios),
            at_share(&ratios, 0.9),
            self.reversals_per_min(),
            delays_ms.len(),
            at_share(&delays_ms, 0.5),
            at_share(&delays_ms, 0.9),
            self.unanswered(),
        )
    }
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The value that this share of the sorted values does not exceed; 0 without values.
pub(crate) fn at_share(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    let at = (share * last as f64).round() as usize;
    sorted.get(at).copied().unwrap_or_default()
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Holds of these seeds.
pub(crate) fn holds(seeds: std::ops::Range<u64>) -> HoldTable {
    HoldTable {
        outcomes: seeds.map(|seed| hold(&Plan::draw(seed))).collect(),
    }
}

fn hold(plan: &Plan) -> Outcome {
    let mut bench = Bench::of(plan);
    let mut watch = Watch::default();
    loop {
        let Step { tips, truth, sent } = bench.step();
        watch.truth(plan, &truth, &tips, bench.now);
        if let Some(setpoints) = sent {
            watch.sent(&setpoints, bench.now);
        }
        if let Some(end) = bench.program.ended() {
            return watch.end(plan, end.unwrap(), truth.broken);
        }
    }
}

/// One step of a hold.
pub(crate) struct Step {
    /// Fingertips that were read.
    tips: PerFinger<bool>,
    truth: HeldState,
    sent: Option<Setpoints>,
}

/// A simulated hand and the program that holds.
pub(crate) struct Bench {
    pub(crate) hand: SimHand,
    program: HoldRun,
    sample: HandSample,
    status: LinkStatus,
    now: Moment,
    steps: u64,
}

impl Bench {
    fn of(plan: &Plan) -> Self {
        let bends = PerDof::new([Some(100), Some(100), Some(100), Some(100), Some(100), None]);
        let start = HoldStart {
            close: HoldClose::To(bends.map(|angle: Option<i16>| angle.map(Angle::nearest))),
            forces: plan.forces,
            duration: Some(HOLD_DURATION),
            reading_per_g: PerDof::splat(1.0),
            locked: PerDof::splat(false),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            grip: GripEstimator::default(),
        };
        Self::new(plan.seed, random(plan.seed % BODIES), plan.object, start)
    }

    /// A hold of this object on a hand with this body.
    pub(crate) fn new(seed: u64, body: BodyParams, object: Object, start: HoldStart) -> Self {
        let now = Moment::ZERO.plus(Duration::from_millis(10));
        Self {
            hand: SimHand::new(SimConfig {
                seed,
                scenario: Scenario::Free,
                body,
                object: Some(object),
                ..SimConfig::default()
            }),
            program: HoldRun::new(EPOCH, start, now),
            sample: HandSample::default(),
            status: LinkStatus {
                state: LinkState::Armed,
                armed: Some(EPOCH),
                ..LinkStatus::default()
            },
            now,
            steps: 0,
        }
    }

    /// Advances hand and hold by one step.
    pub(crate) fn step(&mut self) -> Step {
        self.now = self.now.plus(STEP);
        let tips = self.read();
        // The hand as it is before it receives what the hold sends.
        let truth = self.hand.held();
        let sent = self.tick();
        Step { tips, truth, sent }
    }

    pub(crate) fn held_for(&self) -> Option<Duration> {
        self.program.held_for(self.now)
    }

    pub(crate) fn view(&self) -> HoldView {
        self.program.view(self.now)
    }

    pub(crate) fn has_ended(&self) -> bool {
        self.program.ended().is_some()
    }

    /// Reads what is due; returns the fingertips that were read.
    fn read(&mut self) -> PerFinger<bool> {
        self.steps += 1;
        let mut groups = Vec::new();
        if self.steps.is_multiple_of(2) {
            groups.extend([Group::Angle, Group::Force, Group::Current, Group::Status]);
        }
        let reads_tips = self.steps % 6 == 1;
        if reads_tips {
            groups.extend(Finger::ALL.map(Group::Tactile));
        }
        if self.steps % 40 == 1 {
            groups.extend([Group::Temperature, Group::Faults]);
        }
        for group in groups {
            let span = group.span();
            let bytes = self.hand.read(span, self.now).unwrap();
            let fresh = self.sample.apply(&Reply {
                span,
                bytes: &bytes,
                asked: self.now,
                received: self.now,
            });
            self.program.read(&self.sample, fresh, self.now);
        }
        self.hand.advance_to(self.now);
        PerFinger::splat(reads_tips)
    }

    /// Runs a step of the program, and sends what it orders.
    fn tick(&mut self) -> Option<Setpoints> {
        let seen = Seen {
            status: &self.status,
            sample: &self.sample,
            stall: None,
            now: self.now,
        };
        let Some(Order::Set(setpoints)) = self.program.tick(&seen) else {
            return None;
        };
        for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
            let address = write.span().address;
            self.hand.write(address, write.bytes(), self.now).unwrap();
        }
        Some(setpoints)
    }
}

/// A slide on all fingertips.
#[derive(Debug, Clone, Copy)]
struct Slide {
    from_mm: f64,
    /// Time of the first reading that shows it.
    shown: Option<Moment>,
    tightened: Option<Moment>,
    /// Some finger can press harder.
    has_room: bool,
}

/// Counts what happens in a hold.
#[derive(Debug, Default)]
struct Watch {
    peak_g: f64,
    /// Sum of the mean forces, and their number.
    carried: (f64, f64),
    carried_since: Option<Moment>,
    settled_s: f64,
    is_settled: bool,
    is_dropped: bool,
    /// Last target of each joint, and the direction in which it last changed.
    targets: PerDof<Option<(i16, i16)>>,
    reversals: u32,
    slide: Option<Slide>,
    delays_ms: Vec<Option<f64>>,
}

impl Watch {
    fn truth(&mut self, plan: &Plan, truth: &HeldState, tips: &PerFinger<bool>, now: Moment) {
        let forces_g = truth.fingers.map(|finger| finger.normal_g);
        self.peak_g = forces_g
            .as_array()
            .iter()
            .copied()
            .fold(self.peak_g, f64::max);
        self.is_dropped |= truth.lost == Some(ObjectLoss::Dropped);
        let pressing: Vec<f64> = forces_g
            .as_array()
            .iter()
            .copied()
            .filter(|g| *g > 5.0)
            .collect();
        if truth.held {
            self.carried.0 += mean(&pressing);
            self.carried.1 += 1.0;
            let since = *self.carried_since.get_or_insert(now);
            self.is_settled = now.since(since) >= SETTLE_DURATION;
            self.settled_s += if self.is_settled {
                STEP.as_secs_f64()
            } else {
                0.0
            };
        } else {
            self.is_settled = false;
        }
        if !self.is_settled {
            // The close, and what the lift calls for, are no reversals.
            self.targets = self.targets.map(|last| last.map(|(angle, _)| (angle, 0)));
        }
        self.follow_slide(plan, truth, tips, now);
    }

    fn follow_slide(
        &mut self,
        plan: &Plan,
        truth: &HeldState,
        tips: &PerFinger<bool>,
        now: Moment,
    ) {
        if !truth.slides || truth.lost.is_some() {
            self.end_slide();
            return;
        }
        let room_g = ROOM_SHARE * plan.at_most_g();
        let slide = self.slide.get_or_insert(Slide {
            from_mm: truth.slid_mm,
            shown: None,
            tightened: None,
            has_room: truth
                .fingers
                .iter()
                .any(|(_, finger)| (5.0..room_g).contains(&finger.normal_g)),
        });
        let is_read = tips.iter().any(|(_, is_read)| *is_read);
        if is_read && truth.slid_mm - slide.from_mm >= SHOWN_MM {
            slide.shown.get_or_insert(now);
        }
    }

    fn end_slide(&mut self) {
        let Some(slide) = self.slide.take().filter(|slide| slide.has_room) else {
            return;
        };
        if let Some(shown) = slide.shown {
            let delay = slide
                .tightened
                .map(|at| 1000.0 * at.since(shown).as_secs_f64());
            self.delays_ms.push(delay);
        }
    }

    fn sent(&mut self, setpoints: &Setpoints, now: Moment) {
        for (dof, target) in setpoints.angle.iter() {
            let Some(angle) = target.map(Target::raw) else {
                continue;
            };
            let (before, direction) = self.targets[dof].unwrap_or((angle, 0));
            let change = (angle - before).signum();
            if change < 0
                && let Some(slide) = &mut self.slide
            {
                slide.tightened.get_or_insert(now);
            }
            let is_reversal = change != 0 && direction != 0 && change != direction;
            self.reversals += u32::from(is_reversal && self.is_settled);
            let direction = if change == 0 { direction } else { change };
            self.targets[dof] = Some((angle, direction));
        }
    }

    fn end(mut self, plan: &Plan, end: HoldEnd, is_broken: bool) -> Outcome {
        self.end_slide();
        let (sum_g, count) = self.carried;
        Outcome {
            plan: *plan,
            end,
            is_lifted: self.carried_since.is_some(),
            is_dropped: self.is_dropped,
            is_broken,
            over_g: self.peak_g - plan.at_most_g(),
            ratio: (count > 0.0).then(|| sum_g / count / plan.least_g()),
            reversals: self.reversals,
            settled_s: self.settled_s,
            delays_ms: self.delays_ms,
        }
    }
}
