//! What holds say about random objects in random bodies, in virtual time, judged by the simulated objects. Each hand is measured with two
//! blocks first, as its user does. Used by the bench and, in a small form, by the tests.

use super::hold_table::{BODIES, Bench};
use handscope::hand::gap::{Block, Gap, SizeBlocks};
use handscope::hand::grip::GripEstimator;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::overshoot::{OvershootMap, Stiffness};
use handscope::hand::{Dof, Finger, Force, PerDof};
use handscope::motion::held_object::HeldObject;
use handscope::motion::hold::{HoldClose, HoldStart};
use handscope::sim::body_params::BodyParams;
use handscope::sim::body_params::random::random;
use handscope::sim::object::{Friction, Loads};
use handscope::sim::{Object, Obstacle};
use std::collections::BTreeMap;
use std::time::Duration;

/// Time for which an object is held; what is in the hand is asked after the first.
const HOLD_DURATION: Duration = Duration::from_secs(8);
const ASKED_AFTER: Duration = Duration::from_secs(6);
/// Position counts of a unit of angle.
const COUNTS_PER_ANGLE: f64 = 2.0;
/// Errors up to which size and weight are right.
const SIZE_MM: f64 = 2.0;
const WEIGHT_SHARE: f64 = 0.2;

/// A random object.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thing {
    seed: u64,
    body: u64,
    size_mm: f64,
    g_per_count: f64,
    mass_g: f64,
    friction: f64,
    yields_at_g: Option<f64>,
    at_least_g: f64,
    /// All fingers hold it, or thumb and index only.
    by_all: bool,
}

impl Thing {
    /// The object of this seed.
    fn draw(seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed ^ 0x0B1E);
        let mut between = |low: f64, high: f64| low + (high - low) * chance.f64();
        let at_least_g = between(80.0, 250.0).round();
        Self {
            seed,
            body: seed % BODIES,
            size_mm: between(10.0, 90.0),
            g_per_count: 40f64.powf(between(0.0, 1.0)),
            mass_g: 20.0 * 25f64.powf(between(0.0, 1.0)),
            friction: between(0.4, 1.0),
            yields_at_g: Some(between(1.1, 1.8) * at_least_g).filter(|_| between(0.0, 4.0) < 1.0),
            at_least_g,
            by_all: between(0.0, 2.0) < 1.0,
        }
    }

    /// A block with which a hand is measured.
    const fn block(body: u64, size_mm: f64) -> Self {
        Self {
            seed: 7000 + body,
            body,
            size_mm,
            g_per_count: 12.5,
            mass_g: 100.0,
            friction: 0.8,
            yields_at_g: None,
            at_least_g: 150.0,
            by_all: false,
        }
    }

    fn object(&self) -> Object {
        let obstacle = Obstacle {
            yields_at_g: self.yields_at_g,
            ..Obstacle::at(0.0, self.g_per_count)
        };
        let mut contacts = Object::contacts_of_size(self.size_mm, obstacle);
        for dof in [Dof::Little, Dof::Ring, Dof::Middle] {
            contacts[dof] = contacts[dof].filter(|_| self.by_all);
        }
        Object {
            mass_g: self.mass_g,
            friction: Friction {
                sticking: self.friction,
                sliding_ratio: 0.8,
                drag_per_mm_s: 0.0,
                scatter: 0.05,
            },
            loads: Loads {
                lift_after_s: Some(1.5),
                ..Loads::NONE
            },
            ..Object::touched_at(contacts)
        }
    }

    fn close(&self) -> HoldClose {
        if !self.by_all {
            return HoldClose::Pinch(Gap::MIN);
        }
        let mut targets = Gap::MIN.angles().map(Some);
        for dof in [Dof::Little, Dof::Ring, Dof::Middle] {
            targets[dof] = targets[Dof::Index];
        }
        HoldClose::To(targets)
    }

    /// Stiffness of the object with the fingers that hold it, the median of them, g per unit of angle.
    fn g_per_angle(&self, body: &BodyParams) -> f64 {
        let holding = Finger::ALL
            .into_iter()
            .filter(|finger| self.by_all || matches!(finger, Finger::Index | Finger::Thumb));
        let mut factors: Vec<f64> = holding
            .map(|finger| body.joints[finger.bend()].stiffness_factor)
            .collect();
        factors.sort_by(f64::total_cmp);
        let (low, high) = ((factors.len() - 1) / 2, factors.len() / 2);
        COUNTS_PER_ANGLE * self.g_per_count * f64::midpoint(factors[low], factors[high])
    }

    /// What a hold says about it, and the largest force of a finger; `None` if it was not held for long enough.
    fn held(&self, blocks: &SizeBlocks) -> Option<(HeldObject, f64)> {
        let grams = |force_g: f64| Force::nearest(force_g as i64);
        let start = HoldStart {
            close: self.close(),
            forces: HoldForces::new(grams(self.at_least_g), grams(self.at_least_g + 400.0)).ok()?,
            duration: Some(HOLD_DURATION),
            reading_per_g: PerDof::splat(1.0),
            locked: PerDof::splat(false),
            overshoot: OvershootMap::default(),
            blocks: blocks.clone(),
            grip: GripEstimator::default(),
        };
        let mut bench = Bench::new(self.seed, random(self.body), self.object(), start);
        let mut peak_g = 0f64;
        loop {
            bench.step();
            let fingers = bench.hand.held().fingers;
            let forces = fingers.as_array().iter().map(|finger| finger.normal_g);
            peak_g = forces.fold(peak_g, f64::max);
            if bench.held_for().is_some_and(|held| held >= ASKED_AFTER) {
                return Some((bench.view().object?, peak_g));
            }
            if bench.has_ended() {
                return None;
            }
        }
    }
}

/// What holds said about random objects.
#[derive(Debug, Default)]
pub(crate) struct ObjectTable {
    pub(crate) held: usize,
    /// Errors of the sizes that were told, mm; those outside their bound.
    pub(crate) size_mm: Vec<f64>,
    pub(crate) size_outside: usize,
    pub(crate) class_right: usize,
    pub(crate) class_wrong: usize,
    /// Relative errors of the weights that were told; those outside their bound.
    pub(crate) weight: Vec<f64>,
    pub(crate) weight_outside: usize,
    pub(crate) yield_right: usize,
    pub(crate) yield_wrong: usize,
}

impl ObjectTable {
    /// Share of the sizes that were told and are right.
    pub(crate) fn size_right(&self) -> f64 {
        share(&self.size_mm, |error| error.abs() <= SIZE_MM)
    }

    /// Share of the weights that were told and are right.
    pub(crate) fn weight_right(&self) -> f64 {
        share(&self.weight, |error| error.abs() <= WEIGHT_SHARE)
    }

    /// Share of the stiffness classes that were told and are right.
    pub(crate) fn class_share(&self) -> f64 {
        self.class_right as f64 / (self.class_right + self.class_wrong).max(1) as f64
    }

    /// One line with all of it.
    pub(crate) fn line(&self) -> String {
        format!(
            "{} objects held: size told of {}, within {SIZE_MM} mm {:.0} %, {} outside their bound; class told of {}, right {:.0} %; weight told of {}, within 20 % {:.0} %, {} outside their bound; yielding told of {}, {} wrong",
            self.held,
            self.size_mm.len(),
            100.0 * self.size_right(),
            self.size_outside,
            self.class_right + self.class_wrong,
            100.0 * self.class_share(),
            self.weight.len(),
            100.0 * self.weight_right(),
            self.weight_outside,
            self.yield_right + self.yield_wrong,
            self.yield_wrong,
        )
    }

    fn judge(&mut self, thing: &Thing, said: &HeldObject, peak_g: f64) {
        self.held += 1;
        if let Some(size) = said.size_mm {
            let error = size.value - thing.size_mm;
            self.size_mm.push(error);
            self.size_outside += usize::from(error.abs() > size.bound);
        }
        let class = Stiffness::of(Some(thing.g_per_angle(&random(thing.body))));
        match said.stiffness {
            Stiffness::Unknown => {}
            told if told == class => self.class_right += 1,
            _ => self.class_wrong += 1,
        }
        if let Some(weight) = said.weight_g {
            let error = weight.value - thing.mass_g;
            self.weight.push(error / thing.mass_g);
            self.weight_outside += usize::from(error.abs() > weight.bound);
        }
        let yielded = thing.yields_at_g.is_some_and(|at_g| peak_g >= at_g - 1.0);
        match said.yields {
            None => {}
            Some(told) if told == yielded => self.yield_right += 1,
            Some(_) => self.yield_wrong += 1,
        }
    }
}

fn share(values: &[f64], is_right: impl Fn(f64) -> bool) -> f64 {
    let right = values.iter().filter(|value| is_right(**value)).count();
    right as f64 / values.len().max(1) as f64
}

/// What holds say about the objects of these seeds.
pub(crate) fn objects(seeds: std::ops::Range<u64>) -> ObjectTable {
    let mut table = ObjectTable::default();
    let mut measured: BTreeMap<u64, SizeBlocks> = BTreeMap::new();
    for thing in seeds.map(Thing::draw) {
        let blocks = measured
            .entry(thing.body)
            .or_insert_with(|| blocks_of(thing.body));
        if let Some((said, peak_g)) = thing.held(blocks) {
            table.judge(&thing, &said, peak_g);
        }
    }
    table
}

/// Measures a hand with blocks of 20 and 70 mm.
fn blocks_of(body: u64) -> SizeBlocks {
    let mut blocks = SizeBlocks::default();
    for size_mm in [20.0, 70.0] {
        let held = Thing::block(body, size_mm).held(&SizeBlocks::default());
        if let Some(gap) = held.and_then(|(said, _)| said.size_mm) {
            let (size_mm, gap_mm) = (size_mm as f32, gap.value as f32);
            blocks.measure(Block { size_mm, gap_mm }).unwrap();
        }
    }
    blocks
}
