//! Physics of the object between the fingertips: friction, loads, slides and falls, in steps of one millisecond. Knows no drives.
//!
//! The object moves in the plane of the pads. Each pressing pad carries it by an elastic bristle that sticks up to the static friction
//! and slides at the sliding friction, so the loads of the pads add up to the external load at rest.

use crate::hand::{Finger, PerFinger};
use crate::sim::number;
use crate::sim::object::{Object, PullLoad, Turn};
use glam::DVec2;

/// Length of a step, s.
const STEP_S: f64 = 0.001;
/// Acceleration of a mass of 1 g by 1 g of force, mm/s².
const GRAVITY: f64 = 9_810.0;
/// Stiffness of a pad along its surface, g/mm.
const PAD_G_PER_MM: f64 = 100.0;
/// Highest frequency of the object on five pads, 1/s; softer pads keep the step stable for lighter objects.
const FASTEST_PER_S: f64 = 500.0;
/// Damping ratio of the pads.
const DAMPING: f64 = 0.7;
/// Normal force below which a pad does not touch, g.
const TOUCHES_G: f64 = 0.5;
/// Normal force from which a finger grips for the lift, and number of fingers that it takes.
const GRIPS_G: f64 = 5.0;
const GRIPPING_FINGERS: usize = 2;
/// Time in which the weight is transferred from the table to the hand, s.
const LIFT_S: f64 = 0.3;
/// Slide after which the object is out of the hand, mm: real pads are some 15 mm wide.
pub const TRAVEL_MM: f64 = 12.0;
/// Speed below which a pad sticks again, mm/s, and the shortest slide, ms: it begins slowly, too.
const STICKS_MM_PER_S: f64 = 0.5;
const SLIDES_LEAST_MS: u32 = 5;
/// Time in which a pull ends, and how long a random pull lasts, ms.
const PULL_ENDS_MS: f64 = 50.0;
const RANDOM_LASTS_MS: f64 = 200.0;
/// Share of the normal force that the most tapered object keeps.
const TAPERED_LEAST: f64 = 0.3;
/// Weight before the first turn.
const UPRIGHT: Turn = Turn {
    at_s: 0.0,
    direction_deg: 270.0,
    share: 1.0,
};

/// Reason for which an object is out of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectLoss {
    /// It slid or fell out.
    Dropped,
    /// It was taken away.
    TakenAway,
}

/// Contact of one fingertip with the object.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeldFinger {
    /// Force on the fingertip, g.
    pub normal_g: f64,
    /// Load along its surface, g.
    pub tangential_g: DVec2,
    /// Distance by which the contact slid on it, mm.
    pub slid_mm: DVec2,
    /// True while this fingertip slides; the object may rest on the others.
    pub slides: bool,
}

/// True state of the object, independent of the feedback.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldState {
    pub fingers: PerFinger<HeldFinger>,
    /// True while the hand alone carries it.
    pub held: bool,
    /// True from the lift until it is lost.
    pub lifted: bool,
    /// True while it slides on every fingertip that touches it.
    pub slides: bool,
    /// Distance of all slides of this grip, mm.
    pub slid_mm: f64,
    /// Reason for which it is gone; `None` while it is there.
    pub lost: Option<ObjectLoss>,
    /// True if a joint broke its side.
    pub broken: bool,
    /// Tangential load from outside, g.
    pub external_g: DVec2,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    Stands { pressed_ms: u64 },
    Lifted { for_ms: u64 },
    Gone { loss: ObjectLoss, for_ms: u64 },
}

#[derive(Debug, Clone, Copy, Default)]
struct Pad {
    contact: HeldFinger,
    friction: f64,
    /// Deflection of the bristle, mm.
    bent_mm: DVec2,
    slides_ms: u32,
}

/// Stiffness and damping of a bristle, and sliding friction as a share of static friction.
#[derive(Debug, Clone, Copy)]
struct Bristle {
    g_per_mm: f64,
    g_s_per_mm: f64,
    sliding_ratio: f64,
}

impl Pad {
    /// Moves with the object for one step and returns the load on this pad.
    fn carry(&mut self, normal_g: f64, velocity: DVec2, bristle: Bristle) -> DVec2 {
        self.contact.normal_g = normal_g;
        if normal_g < TOUCHES_G {
            self.bent_mm = DVec2::ZERO;
            self.slides_ms = 0;
            self.contact.slides = false;
            self.contact.tangential_g = DVec2::ZERO;
            return DVec2::ZERO;
        }
        let bent_mm = self.bent_mm + velocity * STEP_S;
        let load = bent_mm * bristle.g_per_mm + velocity * bristle.g_s_per_mm;
        let sticking_g = self.friction * normal_g;
        let sliding_g = sticking_g * bristle.sliding_ratio;
        let along = velocity.dot(load.normalize_or_zero());
        let slows = along < STICKS_MM_PER_S && self.slides_ms >= SLIDES_LEAST_MS;
        let most_g = if self.contact.slides && !slows {
            sliding_g
        } else {
            sticking_g
        };
        self.contact.slides = load.length() > most_g;
        if self.contact.slides {
            self.slides_ms = self.slides_ms.saturating_add(1);
            self.contact.tangential_g = load.normalize_or_zero() * sliding_g;
            self.bent_mm = self.contact.tangential_g / bristle.g_per_mm;
            self.contact.slid_mm += bent_mm - self.bent_mm;
        } else {
            self.slides_ms = 0;
            self.contact.tangential_g = load;
            self.bent_mm = bent_mm;
        }
        self.contact.tangential_g
    }
}

/// The object, and what the fingertips feel of it.
#[derive(Debug, Clone)]
pub struct Held {
    object: Object,
    phase: Phase,
    pads: PerFinger<Pad>,
    velocity: DVec2,
    slid_mm: f64,
    slides: bool,
    external_g: DVec2,
    random_pull: Option<PullLoad>,
    rng: fastrand::Rng,
}

impl Held {
    /// Creates an object that stands in its place; `seed` determines friction and random pulls.
    pub fn new(object: &Object, seed: u64) -> Self {
        Self {
            object: *object,
            phase: Phase::Stands { pressed_ms: 0 },
            pads: PerFinger::splat(Pad::default()),
            velocity: DVec2::ZERO,
            slid_mm: 0.0,
            slides: false,
            external_g: DVec2::ZERO,
            random_pull: None,
            rng: fastrand::Rng::with_seed(seed),
        }
    }

    /// Puts another object in its place.
    pub fn set_object(&mut self, object: &Object) {
        self.object = *object;
        self.stand();
    }

    /// False while the object is out of the hand.
    pub const fn is_present(&self) -> bool {
        !matches!(self.phase, Phase::Gone { .. })
    }

    /// Share of the normal force that its shape leaves after it slid.
    pub fn grip(&self) -> f64 {
        (1.0 - self.object.taper_per_mm * self.slid_mm).max(TAPERED_LEAST)
    }

    /// Contact of one fingertip.
    pub fn finger(&self, finger: Finger) -> HeldFinger {
        self.pads[finger].contact
    }

    /// True if it slides on every fingertip that touches it.
    pub const fn slides(&self) -> bool {
        self.slides
    }

    /// True state; `broken` comes from the joints.
    pub fn state(&self, broken: bool) -> HeldState {
        let lifted = matches!(self.phase, Phase::Lifted { .. });
        HeldState {
            fingers: self.pads.map(|pad| pad.contact),
            held: lifted && self.lift_share() >= 1.0,
            lifted,
            slides: self.slides,
            slid_mm: self.slid_mm,
            lost: match self.phase {
                Phase::Gone { loss, .. } => Some(loss),
                Phase::Stands { .. } | Phase::Lifted { .. } => None,
            },
            broken,
            external_g: self.external_g,
        }
    }

    /// Advances by one millisecond with these normal forces; `is_open` is true if no joint is near the object's place.
    pub fn step(&mut self, normal_g: &PerFinger<f64>, is_open: bool) {
        let loads = self.object.loads;
        match self.phase {
            Phase::Stands { pressed_ms } => {
                for (finger, pad) in self.pads.iter_mut() {
                    pad.contact.normal_g = normal_g[finger];
                }
                let grips = normal_g.iter().filter(|(_, force)| **force >= GRIPS_G);
                let pressed_ms = if grips.count() >= GRIPPING_FINGERS {
                    pressed_ms + 1
                } else {
                    0
                };
                self.phase = Phase::Stands { pressed_ms };
                let is_due = |after: f64| pressed_ms > 0 && number::seconds(pressed_ms) >= after;
                if loads.lift_after_s.is_some_and(is_due) {
                    self.lift();
                }
            }
            Phase::Lifted { for_ms } => {
                let for_ms = for_ms + 1;
                self.phase = Phase::Lifted { for_ms };
                let now_s = number::seconds(for_ms);
                if loads.taken_away_at_s.is_some_and(|at_s| now_s >= at_s) {
                    return self.lose(ObjectLoss::TakenAway, for_ms);
                }
                self.draw_pull(for_ms);
                self.external_g = self.load_at(now_s);
                self.slide(normal_g);
                let is_touched = normal_g.iter().any(|(_, force)| *force >= TOUCHES_G);
                if !is_touched || self.slid_mm > TRAVEL_MM {
                    self.lose(ObjectLoss::Dropped, for_ms);
                }
            }
            Phase::Gone { loss, for_ms } => {
                let for_ms = for_ms + 1;
                self.phase = Phase::Gone { loss, for_ms };
                let is_due = |at_s: f64| {
                    number::seconds(for_ms - 1) < at_s && number::seconds(for_ms) >= at_s
                };
                if is_open || loads.put_back_at_s.is_some_and(is_due) {
                    self.stand();
                }
            }
        }
    }

    fn stand(&mut self) {
        self.phase = Phase::Stands { pressed_ms: 0 };
        self.clear();
    }

    fn lose(&mut self, loss: ObjectLoss, for_ms: u64) {
        self.phase = Phase::Gone { loss, for_ms };
        self.clear();
    }

    fn clear(&mut self) {
        self.pads = PerFinger::splat(Pad::default());
        self.velocity = DVec2::ZERO;
        self.slid_mm = 0.0;
        self.slides = false;
        self.external_g = DVec2::ZERO;
        self.random_pull = None;
    }

    fn lift(&mut self) {
        self.phase = Phase::Lifted { for_ms: 0 };
        let friction = self.object.friction;
        for (_, pad) in self.pads.iter_mut() {
            let scatter = friction.scatter * number::normal(&mut self.rng);
            pad.friction = friction.sticking * (1.0 + scatter).max(0.0);
        }
    }

    fn lift_share(&self) -> f64 {
        match self.phase {
            Phase::Lifted { for_ms } => (number::seconds(for_ms) / LIFT_S).min(1.0),
            Phase::Stands { .. } | Phase::Gone { .. } => 0.0,
        }
    }

    fn draw_pull(&mut self, for_ms: u64) {
        let Some(random) = self.object.loads.random_pulls else {
            return;
        };
        let every_ms = number::whole_ms(random.every_s * 1000.0).max(1);
        if !for_ms.is_multiple_of(every_ms) {
            return;
        }
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * self.rng.f64();
        self.random_pull = Some(PullLoad {
            at_s: number::seconds(for_ms),
            force_g: between(random.force_g),
            direction_deg: between([0.0, 360.0]),
            rise_ms: between(random.rise_ms),
            lasts_ms: RANDOM_LASTS_MS,
        });
    }

    /// Tangential load from outside, g.
    fn load_at(&self, now_s: f64) -> DVec2 {
        let loads = &self.object.loads;
        let weight = weight_at(loads.turns.iter().flatten(), now_s);
        let weight = vector(self.object.mass_g * weight.share, weight.direction_deg);
        let pulls = loads.pulls.iter().flatten().chain(&self.random_pull);
        weight * self.lift_share() + pulls.map(|pull| pull_at(pull, now_s)).sum::<DVec2>()
    }

    /// Moves the object under its loads.
    fn slide(&mut self, normal_g: &PerFinger<f64>) {
        let mass_g = self.object.mass_g;
        let touching = normal_g.iter().filter(|(_, force)| **force >= TOUCHES_G);
        let pads: f64 = touching.map(|_| 1.0).sum();
        let softer = mass_g * FASTEST_PER_S * FASTEST_PER_S / GRAVITY / 5.0;
        let g_per_mm = PAD_G_PER_MM.min(softer);
        let bristle = Bristle {
            g_per_mm,
            // The damping of one mass on all touching pads, shared by them.
            g_s_per_mm: 2.0 * DAMPING * (g_per_mm * mass_g / GRAVITY / f64::max(pads, 1.0)).sqrt(),
            sliding_ratio: self.object.friction.sliding_ratio,
        };
        let mut carried_g = DVec2::ZERO;
        for (finger, pad) in self.pads.iter_mut() {
            carried_g += pad.carry(normal_g[finger], self.velocity, bristle);
        }
        let touch = |pad: &&Pad| pad.contact.normal_g >= TOUCHES_G;
        let mut touching = self.pads.as_array().iter().filter(touch);
        self.slides = pads > 0.0 && touching.all(|pad| pad.contact.slides);
        if self.slides {
            self.slid_mm += self.velocity.length() * STEP_S;
        }
        self.velocity += (self.external_g - carried_g) * (GRAVITY / mass_g * STEP_S);
    }
}

/// Weight at this time, between the turn before and the next.
fn weight_at<'a>(turns: impl Iterator<Item = &'a Turn>, now_s: f64) -> Turn {
    let mut before = UPRIGHT;
    for next in turns {
        if next.at_s > now_s {
            let way = (now_s - before.at_s) / (next.at_s - before.at_s).max(STEP_S);
            let between = |from: f64, to: f64| from + (to - from) * way;
            return Turn {
                at_s: now_s,
                direction_deg: between(before.direction_deg, next.direction_deg),
                share: between(before.share, next.share),
            };
        }
        before = *next;
    }
    before
}

fn pull_at(pull: &PullLoad, now_s: f64) -> DVec2 {
    let since_ms = (now_s - pull.at_s) * 1000.0;
    let rises = (since_ms / pull.rise_ms.max(1.0)).clamp(0.0, 1.0);
    let ended_ms = since_ms - pull.rise_ms - pull.lasts_ms;
    let ends = (1.0 - ended_ms / PULL_ENDS_MS).clamp(0.0, 1.0);
    vector(pull.force_g * rises.min(ends), pull.direction_deg)
}

fn vector(length: f64, direction_deg: f64) -> DVec2 {
    DVec2::from_angle(direction_deg.to_radians()) * length
}
