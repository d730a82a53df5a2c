//! Physics of the object between the fingertips: friction, loads, slides and falls, in steps of one millisecond. Knows no drives.
//!
//! The object moves in the plane of the pads. Each pressing pad carries it by an elastic bristle that sticks up to the static friction
//! and slides at the sliding friction, so the loads of the pads add up to the external load at rest.

use crate::hand::{Finger, PerFinger};
use crate::sim::number;
use crate::sim::object::{HandTurn, Object, PullLoad};
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
const GRIPS_G: f64 = 2.0;
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
const UPRIGHT: HandTurn = HandTurn {
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
enum ObjectPhase {
    Stands { pressed_ms: u64 },
    Lifted { for_ms: u64 },
    Gone { loss: ObjectLoss, for_ms: u64 },
}

#[derive(Debug, Clone, Copy, Default)]
struct PadContact {
    contact: HeldFinger,
    friction: f64,
    /// Deflection of the bristle, mm.
    bent_mm: DVec2,
    slides_ms: u32,
}

/// Stiffness and damping of a bristle, sliding friction as a share of static friction, and its growth with speed.
#[derive(Debug, Clone, Copy)]
struct Bristle {
    g_per_mm: f64,
    g_s_per_mm: f64,
    sliding_ratio: f64,
    drag_s_per_mm: f64,
}

impl PadContact {
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
            let drag = 1.0 + bristle.drag_s_per_mm * along.max(0.0);
            let along_load = load.normalize_or_zero() * sliding_g;
            self.contact.tangential_g = along_load * drag;
            self.bent_mm = along_load / bristle.g_per_mm;
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
pub struct HeldObject {
    object: Object,
    phase: ObjectPhase,
    pads: PerFinger<PadContact>,
    velocity: DVec2,
    slid_mm: f64,
    slides: bool,
    external_g: DVec2,
    random_pull: Option<PullLoad>,
    rng: fastrand::Rng,
}

impl HeldObject {
    /// Creates an object that stands in its place; `seed` determines friction and random pulls.
    pub fn new(object: &Object, seed: u64) -> Self {
        Self {
            object: *object,
            phase: ObjectPhase::Stands { pressed_ms: 0 },
            pads: PerFinger::splat(PadContact::default()),
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
        !matches!(self.phase, ObjectPhase::Gone { .. })
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
        let lifted = matches!(self.phase, ObjectPhase::Lifted { .. });
        HeldState {
            fingers: self.pads.map(|pad| pad.contact),
            held: lifted && self.lift_share() >= 1.0,
            lifted,
            slides: self.slides,
            slid_mm: self.slid_mm,
            lost: match self.phase {
                ObjectPhase::Gone { loss, .. } => Some(loss),
                ObjectPhase::Stands { .. } | ObjectPhase::Lifted { .. } => None,
            },
            broken,
            external_g: self.external_g,
        }
    }

    /// Advances by one millisecond with these normal forces. `is_open` is true if no joint is near the object's place, `is_closing` while
    /// a joint moves: nobody lifts an object before the grip is complete.
    pub fn step(&mut self, normal_g: &PerFinger<f64>, is_open: bool, is_closing: bool) {
        let loads = self.object.loads;
        match self.phase {
            ObjectPhase::Stands { pressed_ms } => {
                for (finger, pad) in self.pads.iter_mut() {
                    pad.contact.normal_g = normal_g[finger];
                }
                let grips = normal_g.iter().filter(|(_, force)| **force >= GRIPS_G);
                let pressed_ms = if grips.count() >= GRIPPING_FINGERS && !is_closing {
                    pressed_ms + 1
                } else {
                    0
                };
                self.phase = ObjectPhase::Stands { pressed_ms };
                let is_due = |after: f64| pressed_ms > 0 && number::seconds(pressed_ms) >= after;
                if loads.lift_after_s.is_some_and(is_due) {
                    self.lift();
                }
            }
            ObjectPhase::Lifted { for_ms } => {
                let for_ms = for_ms + 1;
                self.phase = ObjectPhase::Lifted { for_ms };
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
            ObjectPhase::Gone { loss, for_ms } => {
                let for_ms = for_ms + 1;
                self.phase = ObjectPhase::Gone { loss, for_ms };
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
        self.phase = ObjectPhase::Stands { pressed_ms: 0 };
        self.clear();
    }

    fn lose(&mut self, loss: ObjectLoss, for_ms: u64) {
        self.phase = ObjectPhase::Gone { loss, for_ms };
        self.clear();
    }

    fn clear(&mut self) {
        self.pads = PerFinger::splat(PadContact::default());
        self.velocity = DVec2::ZERO;
        self.slid_mm = 0.0;
        self.slides = false;
        self.external_g = DVec2::ZERO;
        self.random_pull = None;
    }

    fn lift(&mut self) {
        self.phase = ObjectPhase::Lifted { for_ms: 0 };
        let friction = self.object.friction;
        for (_, pad) in self.pads.iter_mut() {
            let scatter = friction.scatter * number::normal(&mut self.rng);
            pad.friction = friction.sticking * (1.0 + scatter).max(0.0);
        }
    }

    fn lift_share(&self) -> f64 {
        match self.phase {
            ObjectPhase::Lifted { for_ms } => (number::seconds(for_ms) / LIFT_S).min(1.0),
            ObjectPhase::Stands { .. } | ObjectPhase::Gone { .. } => 0.0,
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
        let friction = self.object.friction;
        let normal_sum_g: f64 = normal_g.as_array().iter().sum();
        let sliding_g = friction.sticking * friction.sliding_ratio * normal_sum_g;
        // More would turn the motion round within a step.
        let most_drag = 0.3 * mass_g / (GRAVITY * STEP_S * sliding_g.max(TOUCHES_G));
        let bristle = Bristle {
            g_per_mm,
            // The damping of one mass on all touching pads, shared by them.
            g_s_per_mm: 2.0 * DAMPING * (g_per_mm * mass_g / GRAVITY / f64::max(pads, 1.0)).sqrt(),
            sliding_ratio: friction.sliding_ratio,
            drag_s_per_mm: friction.drag_per_mm_s.min(most_drag),
        };
        let mut carried_g = DVec2::ZERO;
        for (finger, pad) in self.pads.iter_mut() {
            carried_g += pad.carry(normal_g[finger], self.velocity, bristle);
        }
        let touch = |pad: &&PadContact| pad.contact.normal_g >= TOUCHES_G;
        let mut touching = self.pads.as_array().iter().filter(touch);
        self.slides = pads > 0.0 && touching.all(|pad| pad.contact.slides);
        if self.slides {
            self.slid_mm += self.velocity.length() * STEP_S;
        }
        self.velocity += (self.external_g - carried_g) * (GRAVITY / mass_g * STEP_S);
    }
}

/// Weight at this time, between the turn before and the next.
fn weight_at<'a>(turns: impl Iterator<Item = &'a HandTurn>, now_s: f64) -> HandTurn {
    let mut before = UPRIGHT;
    for next in turns {
        if next.at_s > now_s {
            let way = (now_s - before.at_s) / (next.at_s - before.at_s).max(STEP_S);
            let between = |from: f64, to: f64| from + (to - from) * way;
            return HandTurn {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::object::{Friction, Loads, NamedObject, RandomPulls, listed};

    const AFTER_LIFT_MS: u64 = 2000;

    /// A block of 200 g with a friction of exactly 0.5, lifted at once.
    fn block() -> Object {
        Object {
            mass_g: 200.0,
            friction: Friction {
                sticking: 0.5,
                sliding_ratio: 0.8,
                drag_per_mm_s: 0.0,
                scatter: 0.0,
            },
            loads: Loads {
                lift_after_s: Some(0.0),
                ..Loads::NONE
            },
            ..Object::none()
        }
    }

    fn pull(force_g: f64, rise_ms: f64) -> PullLoad {
        PullLoad {
            at_s: 1.0,
            force_g,
            direction_deg: 270.0,
            rise_ms,
            lasts_ms: 600_000.0,
        }
    }

    fn pulled(force_g: f64, rise_ms: f64) -> Object {
        let mut object = block();
        object.loads.pulls = listed(&[pull(force_g, rise_ms)]);
        object
    }

    fn run(held: &mut HeldObject, normal_g: [f64; 5], ms: u64) -> HeldState {
        for _ in 0..ms {
            held.step(&PerFinger::new(normal_g), false, false);
        }
        held.state(false)
    }

    fn after(object: &Object, normal_g: [f64; 5], ms: u64) -> HeldState {
        run(&mut HeldObject::new(object, 1), normal_g, ms)
    }

    fn carried(state: &HeldState) -> DVec2 {
        let fingers = state.fingers.as_array().iter();
        fingers.map(|finger| finger.tangential_g).sum()
    }

    #[test]
    fn the_loads_of_the_fingers_add_up_to_the_external_load_at_rest() {
        for normal_g in [
            [0.0, 0.0, 0.0, 900.0, 900.0],
            [300.0, 400.0, 500.0, 600.0, 900.0],
            [20.0, 0.0, 40.0, 2000.0, 1000.0],
        ] {
            for direction_deg in [0.0, 77.0, 270.0, 400.0] {
                for mass_g in [1.0, 20.0, 300.0] {
                    let mut object = pulled(120.0, 50.0);
                    object.mass_g = mass_g;
                    let turn = HandTurn {
                        at_s: 0.5,
                        direction_deg,
                        share: 0.7,
                    };
                    object.loads.turns = listed(&[turn]);
                    let state = after(&object, normal_g, 4000);
                    let rest = carried(&state) - state.external_g;
                    assert!(state.held && rest.length() < 0.5, "{state:?}");
                    let load = vector(0.7 * mass_g, direction_deg) + vector(120.0, 270.0);
                    assert!((state.external_g - load).length() < 0.01, "{state:?}");
                    for (_, finger) in state.fingers.iter() {
                        let ratio = finger.tangential_g.length() / finger.normal_g.max(1.0);
                        assert!(ratio <= 0.5 + 1e-9, "{finger:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_turned_hand_turns_the_load() {
        let mut object = block();
        let turn = |at_s, direction_deg| HandTurn {
            at_s,
            direction_deg,
            share: 1.0,
        };
        object.loads.turns = listed(&[turn(1.0, 270.0), turn(2.0, 360.0)]);
        let mut held = HeldObject::new(&object, 1);
        let normal_g = [0.0, 0.0, 0.0, 600.0, 600.0];
        for (ms, degrees) in [(1000, 270.0), (500, 315.0), (700, 360.0)] {
            let state = run(&mut held, normal_g, ms);
            let off = (carried(&state) - vector(200.0, degrees)).length();
            assert!(state.held && off < 25.0, "{degrees} {state:?}");
        }
    }

    #[test]
    fn nothing_holds_without_normal_force_and_the_table_carries_until_the_lift() {
        let mut object = block();
        object.loads.lift_after_s = Some(1.5);
        let mut held = HeldObject::new(&object, 1);
        let state = run(&mut held, [0.0, 0.0, 0.0, 800.0, 0.0], 5000);
        assert!(
            !state.lifted && state.lost.is_none(),
            "one finger lifts nothing"
        );
        let state = run(&mut held, [0.0, 0.0, 0.0, 800.0, 800.0], 1400);
        assert!(!state.lifted && carried(&state) == DVec2::ZERO);
        let state = run(&mut held, [0.0, 0.0, 0.0, 800.0, 800.0], 2000);
        assert!(state.held && !state.slides);
        let state = run(&mut held, [0.0; 5], 2);
        assert_eq!(state.lost, Some(ObjectLoss::Dropped));
        assert!(!held.is_present() && carried(&state) == DVec2::ZERO);
        let state = run(&mut held, [0.0; 5], 2000);
        assert_eq!(state.lost, Some(ObjectLoss::Dropped));
        held.step(&PerFinger::splat(0.0), true, false);
        assert!(held.is_present());
    }

    #[test]
    fn too_little_normal_force_lets_it_slide_out() {
        let weak = after(&block(), [0.0, 0.0, 0.0, 190.0, 190.0], AFTER_LIFT_MS);
        assert_eq!(weak.lost, Some(ObjectLoss::Dropped));
        let firm = after(&block(), [0.0, 0.0, 0.0, 215.0, 215.0], AFTER_LIFT_MS);
        assert!(firm.held && firm.slid_mm == 0.0, "{firm:?}");
    }

    #[test]
    fn the_finger_with_less_friction_slips_first_and_the_others_take_over() {
        let mut held = HeldObject::new(&block(), 1);
        let normal_g = [0.0, 0.0, 100.0, 500.0, 500.0];
        let mut slipped = false;
        for _ in 0..AFTER_LIFT_MS {
            held.step(&PerFinger::new(normal_g), false, false);
            let state = held.state(false);
            slipped |= state.fingers[Finger::Middle].slides;
            assert!(!state.fingers[Finger::Index].slides && !state.slides);
        }
        let state = held.state(false);
        assert!(slipped && state.held && state.lost.is_none());
        let load = |finger: Finger| state.fingers[finger].tangential_g.length();
        assert!(load(Finger::Middle) <= 50.0 && load(Finger::Index) > 70.0);
        assert!((load(Finger::Index) - load(Finger::Thumb)).abs() < 1.0);
        assert!((carried(&state) - state.external_g).length() < 0.5);
    }

    #[test]
    fn a_pull_drops_it_above_the_friction_limit_and_more_force_prevents_that() {
        let pinch = |normal_g: f64| [0.0, 0.0, 0.0, normal_g, normal_g];
        // 500 g of normal force on two pads hold 500 g.
        let under = after(&pulled(280.0, 100.0), pinch(500.0), 3000);
        assert!(under.held && under.slid_mm == 0.0, "{under:?}");
        let over = after(&pulled(320.0, 100.0), pinch(500.0), 3000);
        assert_eq!(over.lost, Some(ObjectLoss::Dropped));
        let firm = after(&pulled(320.0, 100.0), pinch(600.0), 3000);
        assert!(firm.held && firm.slid_mm == 0.0, "{firm:?}");
    }

    #[test]
    fn a_slide_ends_with_more_normal_force_and_not_by_itself() {
        let start = |normal_g: [f64; 5]| {
            let mut held = HeldObject::new(&pulled(305.0, 1000.0), 1);
            let mut state = held.state(false);
            while !(state.slides && state.slid_mm > 1.0) {
                state = run(&mut held, [0.0, 0.0, 0.0, 500.0, 500.0], 1);
                assert!(state.lost.is_none(), "it slides before it is lost");
            }
            run(&mut held, normal_g, 1000)
        };
        let same = start([0.0, 0.0, 0.0, 500.0, 500.0]);
        assert_eq!(same.lost, Some(ObjectLoss::Dropped));
        let more = start([0.0, 0.0, 0.0, 1000.0, 1000.0]);
        assert!(
            more.held && !more.slides && more.slid_mm < TRAVEL_MM,
            "{more:?}"
        );
        assert!(more.fingers[Finger::Index].slid_mm.y < -1.0, "{more:?}");
    }

    #[test]
    fn an_object_is_taken_away_and_put_back() {
        let mut object = block();
        object.loads.taken_away_at_s = Some(1.0);
        object.loads.put_back_at_s = Some(2.0);
        let mut held = HeldObject::new(&object, 1);
        let pinch = [0.0, 0.0, 0.0, 600.0, 600.0];
        assert!(run(&mut held, pinch, 900).held);
        assert_eq!(run(&mut held, pinch, 200).lost, Some(ObjectLoss::TakenAway));
        assert!(!run(&mut held, [0.0; 5], 800).lifted && !held.is_present());
        assert_eq!(run(&mut held, [0.0; 5], 200).lost, None);
        assert!(held.is_present());
        assert!(run(&mut held, pinch, 500).held, "it can be lifted again");
    }

    #[test]
    fn random_pulls_depend_on_the_seed_alone_and_stay_in_their_range() {
        let mut object = block();
        object.loads.random_pulls = Some(RandomPulls {
            every_s: 1.0,
            force_g: [50.0, 100.0],
            rise_ms: [10.0, 200.0],
        });
        let loads = |seed: u64| -> Vec<DVec2> {
            let mut held = HeldObject::new(&object, seed);
            let normal_g = [0.0, 0.0, 0.0, 2000.0, 2000.0];
            let weight = vector(200.0, 270.0);
            (0..9000)
                .map(|_| run(&mut held, normal_g, 1).external_g - weight)
                .skip(900)
                .collect()
        };
        let first = loads(3);
        assert_eq!(first, loads(3));
        assert_ne!(first, loads(4));
        let most = first.iter().map(|load| load.length()).fold(0.0, f64::max);
        assert!((50.0..=100.1).contains(&most), "{most}");
    }

    #[test]
    fn friction_scatters_from_pad_to_pad_and_from_grip_to_grip() {
        let mut held = HeldObject::new(&NamedObject::Egg.object(), 1);
        held.lift();
        let first = held.pads.map(|pad| pad.friction);
        held.lift();
        let second = held.pads.map(|pad| pad.friction);
        assert_ne!(first, second);
        assert_ne!(first[Finger::Index], first[Finger::Thumb]);
        for (_, friction) in first.iter().chain(second.iter()) {
            assert!((0.3..0.6).contains(friction), "{friction}");
        }
    }
}
