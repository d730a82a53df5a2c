//! Objects between the fingers: where they are touched, how they give, their friction and their loads. Moves nothing.

use crate::hand::gap::Gap;
use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::hand::{Dof, PerDof};
use crate::sim::number;
use crate::sim::scenario::Scenario;

/// Object in the way of one joint as it bends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// Angle at which the fingertip touches, 0..=1000.
    pub angle: f64,
    /// Stiffness of the object, g for each position count. A hand's body multiplies it.
    pub stiffness: f64,
    /// Stiffness of a deeper compression; `None` = the same.
    pub harder: Option<Harder>,
    /// Force above which its surface retreats and stays dented, g; `None` = elastic.
    pub yields_at_g: Option<f64>,
    /// Force that breaks the object, g; it is replaced by a new one when the joint is open again. `None` = unbreakable.
    pub breaks_at_g: Option<f64>,
}

/// Second stage of a compression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harder {
    /// Compression at which it begins, position counts.
    pub from_counts: f64,
    /// Stiffness from there, g for each position count.
    pub stiffness: f64,
}

impl Obstacle {
    /// An elastic and unbreakable obstacle at this angle, of this stiffness in g for each position count.
    pub const fn at(angle: f64, stiffness: f64) -> Self {
        Self {
            angle,
            stiffness,
            harder: None,
            yields_at_g: None,
            breaks_at_g: None,
        }
    }

    /// Force of a compression in position counts, g.
    pub fn load_g(&self, counts: f64) -> f64 {
        let counts = counts.max(0.0);
        match self.harder {
            Some(harder) if counts > harder.from_counts => {
                self.stiffness * harder.from_counts
                    + harder.stiffness * (counts - harder.from_counts)
            }
            _ => self.stiffness * counts,
        }
    }

    /// Compression at a force in g, position counts.
    pub fn compression(&self, load_g: f64) -> f64 {
        let load_g = load_g.max(0.0);
        let soft = self.stiffness.max(SOFTEST_G_PER_COUNT);
        match self.harder {
            Some(harder) if load_g > soft * harder.from_counts => {
                let more = load_g - soft * harder.from_counts;
                harder.from_counts + more / harder.stiffness.max(SOFTEST_G_PER_COUNT)
            }
            _ => load_g / soft,
        }
    }

    /// Stiffness at a force in g, g for each position count.
    pub fn stiffness_at(&self, load_g: f64) -> f64 {
        let hard = self
            .harder
            .filter(|harder| load_g > self.stiffness * harder.from_counts);
        hard.map_or(self.stiffness, |harder| harder.stiffness)
    }

    /// The same obstacle, whose surface is this many position counts deeper and whose stiffness is multiplied.
    pub fn shifted(self, counts: f64, stiffness_factor: f64) -> Self {
        Self {
            angle: self.angle - counts / COUNTS_PER_ANGLE,
            stiffness: self.stiffness * stiffness_factor,
            harder: self.harder.map(|harder| Harder {
                stiffness: harder.stiffness * stiffness_factor,
                ..harder
            }),
            ..self
        }
    }
}

/// Friction between the object and the fingertips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient of static friction.
    pub sticking: f64,
    /// Sliding friction as a share of static friction.
    pub sliding_ratio: f64,
    /// Share by which sliding friction grows for each mm/s, as that of rubber does.
    pub drag_per_mm_s: f64,
    /// Standard deviation of a fingertip's coefficient, as a share of it; drawn for each grip.
    pub scatter: f64,
}

/// Weight direction at a time; it turns evenly from one to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandTurn {
    /// Time after the lift, s.
    pub at_s: f64,
    /// Direction of the weight in the plane of the pads, degrees.
    pub direction_deg: f64,
    /// Share of the weight that acts along the pads, 0 to 1.
    pub share: f64,
}

/// External pull on a lifted object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PullLoad {
    /// Start after the lift, s.
    pub at_s: f64,
    pub force_g: f64,
    /// Direction in the plane of the pads, degrees.
    pub direction_deg: f64,
    /// Time in which it grows, ms.
    pub rise_ms: f64,
    /// Time at full force, ms.
    pub lasts_ms: f64,
}

/// Pulls of random force, direction and rise, one in each interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomPulls {
    pub every_s: f64,
    /// Lowest and highest force, g.
    pub force_g: [f64; 2],
    /// Shortest and longest rise, ms.
    pub rise_ms: [f64; 2],
}

/// Largest number of turns, and of scheduled pulls: a test of minutes needs fewer, and an object stays a plain value.
pub const LOADS_MAX: usize = 16;

/// External events of an object. Times are seconds after its lift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loads {
    /// Time from a grip by two fingers to the lift, s; `None` = it stays on its table, which carries every load.
    pub lift_after_s: Option<f64>,
    /// Turns of the hand, in order.
    pub turns: [Option<HandTurn>; LOADS_MAX],
    pub pulls: [Option<PullLoad>; LOADS_MAX],
    pub random_pulls: Option<RandomPulls>,
    /// Time at which it is taken out of the hand, s.
    pub taken_away_at_s: Option<f64>,
    /// Time at which a lost object stands in its place again, s.
    pub put_back_at_s: Option<f64>,
}

impl Loads {
    /// On its table for good.
    pub const NONE: Self = Self {
        lift_after_s: None,
        turns: [None; LOADS_MAX],
        pulls: [None; LOADS_MAX],
        random_pulls: None,
        taken_away_at_s: None,
        put_back_at_s: None,
    };
}

/// Copies the first [`LOADS_MAX`] loads.
pub fn listed<T: Copy>(loads: &[T]) -> [Option<T>; LOADS_MAX] {
    let mut list = [None; LOADS_MAX];
    for (place, load) in list.iter_mut().zip(loads) {
        *place = Some(*load);
    }
    list
}

/// An object between the fingers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// Contact of each joint; `None` = the joint misses the object.
    pub contacts: PerDof<Option<Obstacle>>,
    pub mass_g: f64,
    pub friction: Friction,
    /// Share of the normal force lost for each mm that the object slides, because it tapers.
    pub taper_per_mm: f64,
    pub loads: Loads,
}

/// Position counts of one unit of ANGLE_ACT.
const COUNTS_PER_ANGLE: f64 = 2.0;
/// Lowest stiffness that compressions are computed with, g for each position count.
const SOFTEST_G_PER_COUNT: f64 = 0.01;
/// Angle at which the block and the cup are touched, units of ANGLE_ACT.
const STANDS_AT: f64 = 500.0;
/// Stiffness of the cup: half of the block's.
const CUP_G_PER_COUNT: f64 = RIGID_G_PER_COUNT / 2.0;
/// Force of each finger above which the cup breaks, g.
pub const CUP_BREAKS_AT_G: f64 = 700.0;
/// Force of each finger above which the egg breaks, g.
pub const EGG_BREAKS_AT_G: f64 = 450.0;
/// Time from a grip to the lift, s.
pub const LIFT_AFTER_S: f64 = 1.5;
/// Friction of rubber on a common surface.
const USUAL_FRICTION: Friction = Friction {
    sticking: 0.6,
    sliding_ratio: 0.8,
    drag_per_mm_s: 0.0,
    scatter: 0.05,
};

impl Object {
    /// Object between the fingers at power-up.
    pub fn of(scenario: Scenario) -> Self {
        match scenario {
            Scenario::Free | Scenario::Touched | Scenario::Frozen => Self::none(),
            Scenario::Rigid => Self::rigid(STANDS_AT),
            Scenario::Fragile => Self::cup(STANDS_AT),
            Scenario::Grasp => Self::pulled_ball(),
            Scenario::Idle | Scenario::Faults | Scenario::Extremes => Self::soft_ball(),
        }
    }

    /// Nothing between the fingers.
    pub const fn none() -> Self {
        Self::touched_at(PerDof::splat(None))
    }

    /// An object with these contacts that stays on its table.
    pub const fn touched_at(contacts: PerDof<Option<Obstacle>>) -> Self {
        Self {
            contacts,
            mass_g: 100.0,
            friction: USUAL_FRICTION,
            taper_per_mm: 0.0,
            loads: Loads::NONE,
        }
    }

    /// A soft ball, which each finger touches at a different angle; the thumb's rotation misses it.
    pub fn soft_ball() -> Self {
        let angles = PerDof::new([
            Some(355.0),
            Some(390.0),
            Some(430.0),
            Some(410.0),
            Some(450.0),
            None,
        ]);
        Self::touched_at(angles.map(|angle| angle.map(|angle| Obstacle::at(angle, 4.0))))
    }

    /// A block as hard as the one used for the overshoot table, at one angle for all joints.
    pub const fn rigid(angle: f64) -> Self {
        Self::touched_at(PerDof::splat(Some(Obstacle::at(angle, RIGID_G_PER_COUNT))))
    }

    /// A thin cup at one angle for all joints; each joint breaks its own side of it beyond [`CUP_BREAKS_AT_G`].
    pub const fn cup(angle: f64) -> Self {
        Self::touched_at(PerDof::splat(Some(Obstacle {
            breaks_at_g: Some(CUP_BREAKS_AT_G),
            ..Obstacle::at(angle, CUP_G_PER_COUNT)
        })))
    }

    /// The ball of the scenario `grasp`: a jerk makes it slide a little in each grasp, and the hand turns with it.
    fn pulled_ball() -> Self {
        let turn = |at_s, direction_deg| HandTurn {
            at_s,
            direction_deg,
            share: 1.0,
        };
        Self {
            mass_g: 400.0,
            friction: Friction {
                sliding_ratio: 0.9,
                drag_per_mm_s: 0.015,
                ..USUAL_FRICTION
            },
            taper_per_mm: 0.04,
            loads: Loads {
                lift_after_s: Some(0.1),
                turns: listed(&[turn(0.0, 270.0), turn(0.9, 270.0), turn(1.2, 355.0)]),
                pulls: listed(&[PullLoad {
                    at_s: 0.9,
                    force_g: 1300.0,
                    direction_deg: 310.0,
                    rise_ms: 150.0,
                    lasts_ms: 100.0,
                }]),
                ..Loads::NONE
            },
            ..Self::soft_ball()
        }
    }

    /// Contacts of an object of this width between thumb and index; the other fingers touch it as the index does.
    pub fn contacts_of_size(size_mm: f64, obstacle: Obstacle) -> PerDof<Option<Obstacle>> {
        let path = Gap::nearest(number::single(size_mm)).angles();
        PerDof::from_fn(|dof| {
            let angle = match dof {
                Dof::ThumbRotate => return None,
                Dof::ThumbBend => path[Dof::ThumbBend],
                Dof::Little | Dof::Ring | Dof::Middle | Dof::Index => path[Dof::Index],
            };
            Some(Obstacle {
                angle: f64::from(angle.get()),
                ..obstacle
            })
        })
    }
}

/// Objects that can be chosen by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedObject {
    /// A thin cup that breaks.
    Cup,
    /// A smooth and stiff egg that breaks early.
    Egg,
    /// Soft, and hard once it is compressed.
    Sponge,
    /// Rigid and heavy.
    Block,
    /// Firm and slippery.
    Tube,
    /// Firm, and dented by too much force.
    Can,
}

impl NamedObject {
    /// All of them, in the order of their list.
    pub const ALL: [Self; 6] = [
        Self::Cup,
        Self::Egg,
        Self::Sponge,
        Self::Block,
        Self::Tube,
        Self::Can,
    ];

    /// Stable lower-case name, as in endpoints.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cup => "cup",
            Self::Egg => "egg",
            Self::Sponge => "sponge",
            Self::Block => "block",
            Self::Tube => "tube",
            Self::Can => "can",
        }
    }

    /// Object of this name; `None` if there is none.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|object| object.name() == name)
    }

    /// Width between the fingers, mm.
    pub const fn size_mm(self) -> f64 {
        match self {
            Self::Cup => 45.0,
            Self::Egg | Self::Block => 40.0,
            Self::Sponge | Self::Can => 50.0,
            Self::Tube => 30.0,
        }
    }

    /// The object itself: it is lifted once two fingers press it.
    pub fn object(self) -> Object {
        let (mass_g, sticking) = match self {
            Self::Cup => (150.0, 0.6),
            Self::Egg => (60.0, 0.45),
            Self::Sponge => (20.0, 0.9),
            Self::Block => (300.0, 0.6),
            Self::Tube => (120.0, 0.3),
            Self::Can => (350.0, 0.5),
        };
        let obstacle = match self {
            Self::Cup => Obstacle {
                breaks_at_g: Some(CUP_BREAKS_AT_G),
                ..Obstacle::at(0.0, CUP_G_PER_COUNT)
            },
            Self::Egg => Obstacle {
                breaks_at_g: Some(EGG_BREAKS_AT_G),
                ..Obstacle::at(0.0, 30.0)
            },
            Self::Sponge => Obstacle {
                harder: Some(Harder {
                    from_counts: 120.0,
                    stiffness: 6.0,
                }),
                ..Obstacle::at(0.0, 1.0)
            },
            Self::Block => Obstacle::at(0.0, RIGID_G_PER_COUNT),
            Self::Tube => Obstacle::at(0.0, 15.0),
            Self::Can => Obstacle {
                yields_at_g: Some(800.0),
                ..Obstacle::at(0.0, 20.0)
            },
        };
        Object {
            mass_g,
            friction: Friction {
                sticking,
                ..USUAL_FRICTION
            },
            loads: Loads {
                lift_after_s: Some(LIFT_AFTER_S),
                ..Loads::NONE
            },
            ..Object::touched_at(Object::contacts_of_size(self.size_mm(), obstacle))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::{ANGLE_SET, FORCE_SET, SPEED_SET};
    use crate::hand::{Finger, Moment};
    use crate::sim::held::TRAVEL_MM;
    use crate::sim::{HeldState, ObjectLoss, SimConfig, SimHand};

    fn at(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    fn around(object: Object) -> SimHand {
        SimHand::new(SimConfig {
            scenario: Scenario::Free,
            object: Some(object),
            ..SimConfig::default()
        })
    }

    fn set(hand: &mut SimHand, address: u16, values: [i16; 6], ms: u64) {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        hand.write(address, &bytes, at(ms)).unwrap();
    }

    /// Closes all fingers slowly at this force threshold.
    fn close(hand: &mut SimHand, force_g: i16, ms: u64) {
        set(hand, SPEED_SET.address, [100; 6], ms);
        set(hand, FORCE_SET.address, [force_g; 6], ms);
        set(hand, ANGLE_SET.address, [0, 0, 0, 0, 0, 1000], ms);
    }

    fn open(hand: &mut SimHand, ms: u64) {
        set(hand, SPEED_SET.address, [1000; 6], ms);
        set(hand, ANGLE_SET.address, [1000; 6], ms);
    }

    /// State of a grip 10 s after it began.
    fn gripped(object: Object, force_g: i16) -> HeldState {
        let mut hand = around(object);
        close(&mut hand, force_g, 0);
        hand.advance_to(at(10_000));
        hand.held()
    }

    #[test]
    fn each_named_object_is_held_at_some_force_and_drops_at_a_smaller_one() {
        for (named, holds_g, drops_g) in [
            (NamedObject::Cup, 150, 30),
            (NamedObject::Egg, 80, 15),
            (NamedObject::Sponge, 60, 2),
            (NamedObject::Block, 250, 60),
            (NamedObject::Tube, 200, 40),
            (NamedObject::Can, 350, 70),
        ] {
            let held = gripped(named.object(), holds_g);
            assert!(held.held && !held.broken, "{named:?} {held:?}");
            let dropped = gripped(named.object(), drops_g);
            assert_eq!(
                dropped.lost,
                Some(ObjectLoss::Dropped),
                "{named:?} {dropped:?}"
            );
        }
    }

    #[test]
    fn a_lost_object_is_gone_from_all_fingers_until_the_hand_is_open() {
        let mut hand = around(NamedObject::Block.object());
        close(&mut hand, 60, 0);
        hand.advance_to(at(10_000));
        assert!(hand.true_loads().as_array().iter().all(|load| *load == 0.0));
        open(&mut hand, 10_000);
        hand.advance_to(at(12_000));
        assert_eq!(hand.held().lost, None);
        close(&mut hand, 400, 12_000);
        hand.advance_to(at(22_000));
        assert!(hand.held().held, "{:?}", hand.held());
    }

    #[test]
    fn an_object_put_back_between_closed_fingers_touches_without_force() {
        let mut object = NamedObject::Block.object();
        object.loads.taken_away_at_s = Some(1.0);
        object.loads.put_back_at_s = Some(3.0);
        let mut hand = around(object);
        close(&mut hand, 400, 0);
        hand.advance_to(at(20_000));
        assert!(
            hand.true_loads()
                .as_array()
                .iter()
                .all(|load| *load < 400.0)
        );
        assert_ne!(hand.held().lost, Some(ObjectLoss::TakenAway));
    }

    #[test]
    fn an_egg_breaks_and_a_can_is_dented_under_too_much_force() {
        assert!(gripped(NamedObject::Egg.object(), 600).broken);
        let mut hand = around(NamedObject::Can.object());
        close(&mut hand, 1500, 0);
        hand.advance_to(at(10_000));
        let loads = hand.true_loads();
        assert!(loads[Finger::Index] <= 800.1 && loads[Finger::Index] > 500.0);
        let dented = hand.true_angles()[Dof::Index];
        open(&mut hand, 10_000);
        hand.advance_to(at(12_000));
        close(&mut hand, 300, 12_000);
        hand.advance_to(at(22_000));
        let new = hand.true_angles()[Dof::Index];
        assert!(dented < new - 50.0, "a new can is whole: {dented} {new}");
    }

    #[test]
    fn the_same_seed_gives_the_same_object_however_often_it_is_read() {
        let state = |each_ms: u64| {
            let mut hand = around(NamedObject::Tube.object());
            close(&mut hand, 200, 0);
            for ms in (0..=6000).step_by(usize::try_from(each_ms).unwrap()) {
                hand.advance_to(at(ms));
            }
            hand.held()
        };
        assert_eq!(state(1), state(1000));
    }

    #[test]
    fn the_ball_of_the_grasp_slides_a_little_and_is_never_lost() {
        for seed in 1..12 {
            let mut hand = SimHand::new(SimConfig {
                seed,
                scenario: Scenario::Grasp,
                ..SimConfig::default()
            });
            for begins in [0, 8000, 16_000] {
                hand.advance_to(at(begins + 2400));
                let before = hand.held();
                assert!(before.held && !before.slides, "{seed} {before:?}");
                let mut slid = false;
                for ms in begins + 2400..begins + 4900 {
                    hand.advance_to(at(ms));
                    slid |= hand.object_slides();
                    assert_eq!(hand.held().lost, None, "{seed} {ms}");
                }
                let after = hand.held();
                assert!(slid && after.held && !after.slides, "{seed} {after:?}");
                assert!(
                    (1.0..TRAVEL_MM).contains(&after.slid_mm),
                    "{seed} {after:?}"
                );
            }
        }
    }

    #[test]
    fn a_two_stage_compression_and_its_force_belong_together() {
        let sponge = Obstacle {
            harder: Some(Harder {
                from_counts: 100.0,
                stiffness: 10.0,
            }),
            ..Obstacle::at(500.0, 2.0)
        };
        for (counts, load_g, slope) in [
            (-5.0, 0.0, 2.0),
            (50.0, 100.0, 2.0),
            (100.0, 200.0, 2.0),
            (130.0, 500.0, 10.0),
        ] {
            assert_eq!(sponge.load_g(counts), load_g);
            assert_eq!(sponge.compression(load_g), counts.max(0.0));
            assert_eq!(sponge.stiffness_at(load_g), slope);
        }
        let dented = sponge.shifted(20.0, 2.0);
        assert_eq!((dented.angle, dented.load_g(130.0)), (490.0, 1000.0));
    }

    #[test]
    fn every_named_object_is_within_reach_of_thumb_and_fingers() {
        for named in NamedObject::ALL {
            assert_eq!(NamedObject::by_name(named.name()), Some(named));
            let contacts = named.object().contacts;
            assert_eq!(contacts[Dof::ThumbRotate], None);
            for dof in Dof::ALL.into_iter().filter(|dof| *dof != Dof::ThumbRotate) {
                let angle = contacts[dof].unwrap().angle;
                assert!((400.0..950.0).contains(&angle), "{named:?} {dof:?} {angle}");
            }
        }
        assert_eq!(NamedObject::by_name("Egg"), None);
    }
}
