//! Grasps saved on one random hand and used on others, in virtual time, judged by the simulated object's own truth. Each hand reads its
//! forces in units of its own. Used by the bench and, in a small form, by the tests.

use super::hold_table::Plan;
use handscope::hand::gap::SizeBlocks;
use handscope::hand::grip::GripEstimator;
use handscope::hand::newtons::N_PER_G;
use handscope::hand::overshoot::OvershootMap;
use handscope::hand::register::{FORCE_ACT, FORCE_SET};
use handscope::hand::{
    Angle, ArmEpoch, Dof, Finger, Group, HandCommand, HandSample, Moment, PerDof, Reply,
};
use handscope::link::LinkStatus;
use handscope::motion::grasp::doubt::GraspDoubt;
use handscope::motion::grasp::run::{
    ConfirmStep, Confirming, GraspInput, GraspRun, GraspStart, Unconfirmed,
};
use handscope::motion::grasp::saved::Grasp;
use handscope::motion::grasp::seen::GraspLabel;
use handscope::motion::hold::{HoldClose, HoldEnd, HoldStart};
use handscope::motion::program::{Ended, Order, Program, Seen};
use handscope::record::LinkState;
use handscope::sim::body_params::random::random;
use handscope::sim::object::{HandTurn, Loads, PullLoad, listed};
use handscope::sim::{Object, ObjectLoss, Scenario, SimConfig, SimHand};
use std::collections::BTreeMap;
use std::time::Duration;

const EPOCH: ArmEpoch = ArmEpoch(1);
/// Interval of the loop, as in the table of holds.
const STEP: Duration = Duration::from_millis(5);
/// Time for which an object is held.
const HOLD_DURATION: Duration = Duration::from_secs(16);
/// A confirmation that takes longer has failed.
const LONGEST: Duration = Duration::from_secs(900);
/// Other hands for each grasp: the same object on the first ones, another one on the rest.
pub(crate) const OTHERS: u64 = 20;
const SAME_OBJECT: u64 = 14;
/// Load below which an object stands on its table, g.
const PUT_DOWN_G: f64 = 5.0;
/// How far a drive at the speed of the close may run past its threshold, g.
const OVERSHOOT_G: f64 = 64.0;

/// A hand with readings of its own.
#[derive(Debug, Clone, Copy)]
struct OwnHand {
    seed: u64,
    /// True grams of one gram of its readings.
    factor: PerDof<f64>,
    /// Newtons of one gram of its readings, as a scale showed them.
    newtons: PerDof<f64>,
}

impl OwnHand {
    fn draw(seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed ^ 0x6A45);
        let mut between = |low: f64, high: f64| low + (high - low) * chance.f64();
        let factor = PerDof::from_fn(|_| between(0.66, 1.32));
        Self {
            seed,
            factor,
            newtons: factor.map(|factor| factor * N_PER_G * between(0.96, 1.04)),
        }
    }

    fn newtons(&self) -> PerDof<Option<f64>> {
        self.newtons.map(Some)
    }
}

/// A program on a hand.
struct Bench {
    own: OwnHand,
    hand: SimHand,
    program: GraspRun,
    sample: HandSample,
    now: Moment,
    steps: u64,
}

/// What happened while a program ran.
struct Ran {
    program: GraspRun,
    now: Moment,
    end: Ended<Result<HoldEnd, GraspDoubt>>,
    /// It was dropped while the hand carried it.
    is_dropped: bool,
    is_broken: bool,
    /// Largest force of a finger above *at most*, g.
    over_g: f64,
}

impl Ran {
    fn worked(&self) -> bool {
        let is_held = self.end == Ok(Ok(HoldEnd::Held));
        is_held && !self.is_dropped && !self.is_broken && self.over_g <= OVERSHOOT_G
    }
}

impl Bench {
    fn of(own: OwnHand, object: Object, start: GraspStart) -> Self {
        let now = Moment::ZERO.plus(Duration::from_millis(10));
        Self {
            own,
            hand: SimHand::new(SimConfig {
                seed: own.seed,
                scenario: Scenario::Free,
                body: random(own.seed),
                object: Some(object),
                ..SimConfig::default()
            }),
            program: GraspRun::new(EPOCH, start, now),
            sample: HandSample::default(),
            now,
            steps: 0,
        }
    }

    fn read(&mut self) {
        self.steps += 1;
        let mut groups = Vec::new();
        if self.steps.is_multiple_of(2) {
            groups.extend([Group::Angle, Group::Force, Group::Current, Group::Status]);
        }
        if self.steps % 6 == 1 {
            groups.extend(Finger::ALL.map(Group::Tactile));
        }
        if self.steps % 40 == 1 {
            groups.extend([Group::Temperature, Group::Faults]);
        }
        for group in groups {
            let span = group.span();
            let mut bytes = self.hand.read(span, self.now).unwrap();
            if span.address == FORCE_ACT.address {
                scale(&mut bytes, FORCE_ACT.address, span.address, |dof| {
                    1.0 / self.own.factor[dof]
                });
            }
            let fresh = self.sample.apply(&Reply {
                span,
                bytes: &bytes,
                asked: self.now,
                received: self.now,
            });
            self.program.read(&self.sample, fresh, self.now);
        }
        self.hand.advance_to(self.now);
    }

    /// Runs the program. `most_g` is the true force that no finger should exceed.
    fn run(mut self, most_g: &PerDof<f64>) -> Ran {
        let status = LinkStatus {
            state: LinkState::Armed,
            armed: Some(EPOCH),
            ..LinkStatus::default()
        };
        let (mut is_dropped, mut over_g, mut load_g) = (false, f64::NEG_INFINITY, 0.0);
        loop {
            self.now = self.now.plus(STEP);
            self.read();
            let truth = self.hand.held();
            for (finger, pressing) in truth.fingers.iter() {
                over_g = over_g.max(pressing.normal_g - most_g[finger.bend()]);
            }
            // A hand that opens after the object was put down lets go on purpose.
            is_dropped |= truth.lost == Some(ObjectLoss::Dropped) && load_g > PUT_DOWN_G;
            load_g = match truth.lost {
                None => truth.external_g.length(),
                Some(_) => 0.0,
            };
            let seen = Seen {
                status: &status,
                sample: &self.sample,
                stall: None,
                now: self.now,
            };
            let asks =
                |own: Option<Confirming>| own.is_some_and(|own| own.step == ConfirmStep::Release);
            // The user sees whether the object stands.
            let says = asks(self.program.view(self.now).confirming) && load_g <= PUT_DOWN_G;
            let order = match says {
                true => self.program.input(GraspInput::PutDown, &seen),
                false => self.program.tick(&seen),
            };
            if let Some(Order::Set(setpoints)) = order {
                for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
                    let address = write.span().address;
                    let mut bytes = write.bytes().to_vec();
                    if (FORCE_SET.address..FORCE_SET.address + 12).contains(&address) {
                        let factor = |dof: Dof| self.own.factor[dof];
                        scale(&mut bytes, FORCE_SET.address, address, factor);
                    }
                    self.hand.write(address, &bytes, self.now).unwrap();
                }
            }
            let end = self.program.ended();
            let is_late = self.now.since(Moment::ZERO) > LONGEST;
            if let Some(end) = end.or(is_late.then_some(Ok(Ok(HoldEnd::Late)))) {
                return Ran {
                    program: self.program,
                    now: self.now,
                    end,
                    is_dropped,
                    is_broken: truth.broken,
                    over_g,
                };
            }
        }
    }
}

/// Multiplies the values of joints in these bytes.
fn scale(bytes: &mut [u8], first: u16, address: u16, factor: impl Fn(Dof) -> f64) {
    let skipped = usize::from((address - first) / 2);
    let joints = Dof::ALL.into_iter().skip(skipped);
    for (dof, pair) in joints.zip(bytes.chunks_exact_mut(2)) {
        let value = f64::from(i16::from_le_bytes([pair[0], pair[1]]));
        let scaled = (value * factor(dof)).round() as i16;
        pair.copy_from_slice(&scaled.to_le_bytes());
    }
}

fn hold_start(close: HoldClose, plan: &Plan, reading_per_g: PerDof<f64>) -> HoldStart {
    HoldStart {
        close,
        forces: plan.forces,
        duration: Some(HOLD_DURATION),
        reading_per_g,
        locked: PerDof::splat(false),
        overshoot: OvershootMap::default(),
        blocks: SizeBlocks::default(),
        grip: GripEstimator::default(),
    }
}

/// True forces that the fingers should not exceed, g.
fn most_g(plan: &Plan, own: &OwnHand, reading_per_g: &PerDof<f64>) -> PerDof<f64> {
    let at_most_g = f64::from(plan.forces.at_most().get());
    PerDof::from_fn(|dof| at_most_g * reading_per_g[dof] * own.factor[dof])
}

/// Holds the object of a plan on a hand; the grasp, if that worked.
fn made(plan: &Plan, own: OwnHand) -> Option<Grasp> {
    let bends = PerDof::new([Some(100), Some(100), Some(100), Some(100), Some(100), None]);
    let close = HoldClose::To(bends.map(|angle: Option<i16>| angle.map(Angle::nearest)));
    let ones = PerDof::splat(1.0);
    let start = GraspStart {
        hold: hold_start(close, plan, ones),
        unconfirmed: None,
    };
    let ran = Bench::of(own, plan.object, start).run(&most_g(plan, &own, &ones));
    let about = GraspLabel {
        name: "grasp".into(),
        note: String::new(),
        day: "2026-11-30".into(),
        hand: format!("tcp:10.0.0.1:{}", 1000 + own.seed % 60_000)
            .parse()
            .unwrap(),
        pose: None,
        newtons: own.newtons(),
        claim: None,
    };
    ran.worked()
        .then(|| ran.program.grasp(about, ran.now).ok())?
}

/// The object as a user lifts, loads and puts it down in a confirmation: with a share of the largest load of the plan.
fn handled(object: Object, plan: &Plan, share: f64) -> Object {
    let pull = PullLoad {
        at_s: 1.5,
        force_g: (share * plan.load_g - object.mass_g).max(0.0),
        direction_deg: 270.0,
        rise_ms: 400.0,
        lasts_ms: 1500.0,
    };
    let turn = |at_s, share| HandTurn {
        at_s,
        direction_deg: 270.0,
        share,
    };
    Object {
        loads: Loads {
            lift_after_s: Some(1.5),
            turns: listed(&[turn(4.5, 1.0), turn(5.5, 0.0)]),
            pulls: listed(&[pull]),
            ..Loads::NONE
        },
        ..object
    }
}

/// The object of a plan, or one that a user takes for it.
fn object_of(plan: &Plan, nth: u64) -> Object {
    let mut object = plan.object;
    if nth >= SAME_OBJECT {
        match nth % 3 {
            0 => object.friction.sticking *= 0.5,
            1 => object.mass_g *= 2.0,
            _ => {
                for (_, contact) in object.contacts.iter_mut() {
                    if let Some(contact) = contact {
                        contact.stiffness *= 6.0;
                    }
                }
            }
        }
    }
    object
}

/// A grasp on another hand.
#[derive(Debug, Clone)]
pub(crate) struct Used {
    pub(crate) is_same_object: bool,
    /// `None`: it is trusted.
    pub(crate) doubt: Option<GraspDoubt>,
    /// The hold afterwards worked, or would have without the doubt.
    pub(crate) works: bool,
    /// The confirmation broke it, dropped it, or pressed too hard.
    pub(crate) is_harmed: bool,
    pub(crate) told: String,
}

impl Used {
    /// It is trusted, and does not work.
    pub(crate) const fn is_false_claim(&self) -> bool {
        self.doubt.is_none() && !self.works
    }
}

/// The outcomes of many grasps on many hands.
#[derive(Debug, Default)]
pub(crate) struct GraspTable {
    /// Number of grasps.
    pub(crate) grasps: usize,
    pub(crate) used: Vec<Used>,
}

impl GraspTable {
    pub(crate) fn count(&self, is_counted: impl Fn(&Used) -> bool) -> usize {
        self.used.iter().filter(|own| is_counted(own)).count()
    }

    pub(crate) fn trusted(&self) -> usize {
        self.count(|own| own.doubt.is_none())
    }

    /// Trusted grasps that then did not work.
    pub(crate) fn false_claims(&self) -> usize {
        self.count(Used::is_false_claim)
    }

    /// One line with all of it.
    pub(crate) fn line(&self) -> String {
        let mut doubts = BTreeMap::new();
        for own in &self.used {
            let name = format!("{:?}", own.doubt);
            let name = name.trim_start_matches("Some(");
            let name: String = name.chars().take_while(|c| c.is_alphanumeric()).collect();
            let name = if own.is_same_object {
                name
            } else {
                format!("{name}, other object")
            };
            *doubts.entry(name).or_insert(0) += 1;
        }
        format!(
            "{} grasps on {} others: {} trusted, {} of them false; {} doubted that would have worked; {} harmed; {doubts:?}",
            self.grasps,
            self.used.len(),
            self.trusted(),
            self.false_claims(),
            self.count(|own| own.doubt.is_some() && own.works),
            self.count(|own| own.is_harmed),
        )
    }
}

/// Makes this many grasps, and uses each on 20 other hands.
pub(crate) fn grasps(count: usize, others: u64) -> GraspTable {
    let mut table = GraspTable::default();
    let mut seed = 0;
    while table.grasps < count {
        seed += 1;
        let plan = Plan::draw(seed);
        let Some(grasp) = made(&plan, OwnHand::draw(1000 * seed)) else {
            continue;
        };
        table.grasps += 1;
        let step = (OTHERS / others).max(1) as usize;
        for nth in (0..OTHERS).step_by(step) {
            let own = OwnHand::draw(1000 * seed + 1 + nth);
            table.used.push(used(&plan, &grasp, own, nth));
        }
    }
    table
}

fn used(plan: &Plan, grasp: &Grasp, own: OwnHand, nth: u64) -> Used {
    let object = object_of(plan, nth);
    let is_same_object = nth < SAME_OBJECT;
    let reading_per_g = match grasp.reading_per_g_on(&own.newtons()) {
        Ok(reading_per_g) => reading_per_g,
        Err(doubt) => {
            return Used {
                is_same_object,
                doubt: Some(doubt),
                works: false,
                is_harmed: false,
                told: String::new(),
            };
        }
    };
    let most_g = most_g(plan, &own, &reading_per_g);
    let hold = hold_start(grasp.close.way, plan, reading_per_g);
    let start = GraspStart {
        hold: HoldStart {
            duration: Some(Duration::from_secs(1)),
            ..hold.clone()
        },
        unconfirmed: Some(Unconfirmed {
            grasp: grasp.clone(),
            newtons: own.newtons(),
        }),
    };
    let share = 0.7 + 0.4 * fastrand::Rng::with_seed(own.seed).f64();
    let confirmed = Bench::of(own, handled(object, plan, share), start).run(&most_g);
    let doubt = match confirmed.end {
        Ok(Err(doubt)) => Some(doubt),
        Ok(Ok(HoldEnd::Held)) => None,
        _ => Some(GraspDoubt::NoLoad { close: 99 }),
    };
    let is_harmed = confirmed.is_broken || confirmed.is_dropped || confirmed.over_g > OVERSHOOT_G;
    let mut object = object;
    object.loads = plan.object.loads;
    let start = GraspStart {
        hold,
        unconfirmed: None,
    };
    let other = OwnHand {
        seed: own.seed + 500,
        ..own
    };
    // The same body, whose noise is drawn anew.
    let mut bench = Bench::of(other, object, start);
    bench.hand = SimHand::new(SimConfig {
        seed: other.seed,
        scenario: Scenario::Free,
        body: random(own.seed),
        object: Some(object),
        ..SimConfig::default()
    });
    let ran = bench.run(&most_g);
    Used {
        is_same_object,
        doubt,
        works: ran.worked(),
        is_harmed,
        told: format!(
            "{:?} {:?} dropped {} broken {} over {:.0} g; {:?}",
            confirmed.end,
            ran.end,
            ran.is_dropped,
            ran.is_broken,
            ran.over_g,
            confirmed.program.agreement()
        ),
    }
}
