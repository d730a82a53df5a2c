//! What a hold holds: its size, its stiffness, whether it yields, and its weight; each with the bound of its error, or unknown. Pure.

use crate::hand::gap::{SizeBlocks, gap_on_path};
use crate::hand::overshoot::Stiffness;
use crate::hand::statistics::{count, mean, median, spread};
use crate::hand::{Dof, Finger, PerDof, PerFinger};
use serde::Serialize;

/// Forces at rest that are kept for each finger.
const POINTS_MAX: usize = 32;
/// Least way between them that shows a stiffness, units of angle.
const WAY_LEAST: f64 = 2.0;
/// Bound of an angle, units: readings are whole.
const ANGLE_BOUND: f64 = 0.5;
/// Bound of a stiffness besides that of its angles, as a share of it: the fingers give, too, and not all alike.
const STIFFNESS_BOUND: f64 = 0.15;
/// Bound of the angle at which a contact begins, units: it begins a little earlier or later at each close.
const CONTACT_BOUND: f64 = 6.0;
/// The same for a moving finger, whose force and angle are not read at the same moment.
const MOVING_BOUND: f64 = 1.5;
/// Bound of a size besides that of the contacts, mm: by the model of the hand, and once two blocks were measured with it.
const MODEL_BOUND_MM: f64 = 3.0;
const BLOCKS_BOUND_MM: f64 = 1.3;
/// A finger that rests deeper by this, with no more force, has dented what it holds, units of angle.
const DENT: f64 = 4.0;
/// Noise of a force at rest, g.
const REST_NOISE_G: f64 = 8.0;
/// Share of the stiffness of the close below which it gave way.
const SOFTENS: f64 = 0.5;
/// Tangential force that a fingertip shows without a load, as a share of its normal force.
const CROSSTALK: f64 = 0.015;
/// Bound of a load besides that, as a share of it.
const LOAD_BOUND: f64 = 0.05;
/// A load with a larger bound, as a share of it, is unknown.
const LOAD_BOUND_MAX: f64 = 0.2;

/// A value and the bound of its error, which is larger in at most one of 20 cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// Bound of its error, in its unit.
    pub bound: f64,
}

/// What is held. What the fingers cannot tell is `None`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HeldObject {
    /// Distance between the pads of thumb and index where they met it, mm: by the model, or by the two blocks measured with this hand.
    /// `None` unless both hold it, facing each other.
    pub size_mm: Option<Bounded>,
    /// Class of its stiffness; `Unknown` also if the bound reaches into another class.
    pub stiffness: Stiffness,
    /// Its stiffness, g per unit of ANGLE_ACT, together with that of the fingers.
    pub g_per_angle: Option<Bounded>,
    /// Whether a finger dented it.
    pub yields: Option<bool>,
    /// Sum of the tangential forces, g: its weight, if the hand is upright and nothing else pulls. `None` while the load changes, if
    /// a fingertip of a finger that holds is not read, and for a load that is small against the force.
    pub weight_g: Option<Bounded>,
}

/// Load along one fingertip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TipLoad {
    pub(crate) normal_g: f64,
    pub(crate) tangential_g: f64,
}

/// A point of a contact: the angle of the joint and its force above the zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ContactPoint {
    angle: f64,
    force_g: f64,
}

/// What one finger showed.
#[derive(Debug, Clone, Default)]
struct FingerShown {
    /// Where the close met the object.
    met: Option<ContactPoint>,
    /// Points at rest, in order.
    rests: Vec<ContactPoint>,
}

/// Collects what a hold shows about its object.
#[derive(Debug, Clone)]
pub(crate) struct ObjectWatch {
    blocks: SizeBlocks,
    fingers: PerFinger<FingerShown>,
}

impl ObjectWatch {
    /// Sizes follow from the blocks measured with this hand.
    pub(crate) fn new(blocks: SizeBlocks) -> Self {
        Self {
            blocks,
            fingers: PerFinger::from_fn(|_| FingerShown::default()),
        }
    }

    /// Notes where the close met the object.
    pub(crate) fn met(&mut self, finger: Finger, angle: i16, force_g: f64) {
        self.fingers[finger].met = Some(ContactPoint::new(angle, force_g));
    }

    /// Applies a force at rest of a finger that holds.
    pub(crate) fn rests(&mut self, finger: Finger, angle: i16, force_g: f64) {
        let rests = &mut self.fingers[finger].rests;
        let point = ContactPoint::new(angle, force_g);
        if rests.len() < POINTS_MAX && rests.last() != Some(&point) {
            rests.push(point);
        }
    }

    /// What these fingers hold, with the thumb rotated to this angle. `tip_loads` is `None` while a load changes, or if a fingertip is
    /// not read.
    pub(crate) fn object(
        &self,
        holds: PerFinger<bool>,
        rotation: Option<i16>,
        tip_loads: Option<&[TipLoad]>,
    ) -> HeldObject {
        let yields = self.yields(&holds);
        let of_fingers = |slope: fn(&FingerShown) -> Option<Bounded>| {
            let holding = Finger::ALL.into_iter().filter(|finger| holds[*finger]);
            let all: Vec<Bounded> = holding
                .filter_map(|finger| slope(&self.fingers[finger]))
                .collect();
            combined(&all)
        };
        // What is dented rests deeper with no more force, which is no stiffness.
        let by_rests = of_fingers(FingerShown::slope).filter(|_| yields != Some(true));
        let g_per_angle = by_rests.or_else(|| of_fingers(FingerShown::slope_of_close));
        let begins = |finger: Finger| self.fingers[finger].begins(g_per_angle);
        HeldObject {
            size_mm: begins(Finger::Index)
                .zip(begins(Finger::Thumb))
                .zip(rotation)
                .filter(|_| holds[Finger::Thumb] && holds[Finger::Index])
                .and_then(|((index, thumb), rotation)| size(index, thumb, rotation, &self.blocks)),
            stiffness: g_per_angle.map_or(Stiffness::Unknown, class),
            g_per_angle,
            yields,
            weight_g: tip_loads.and_then(weight),
        }
    }

    /// Whether a finger dented the object; `None` before any finger rested twice.
    fn yields(&self, holds: &PerFinger<bool>) -> Option<bool> {
        let held = Finger::ALL.into_iter().filter(|finger| holds[*finger]);
        let shown = held.filter_map(|finger| {
            let own = &self.fingers[finger];
            (own.rests.len() >= 2).then(|| own.is_dented())
        });
        shown.reduce(|one, other| one || other)
    }
}

impl ContactPoint {
    fn new(angle: i16, force_g: f64) -> Self {
        Self {
            angle: angle.into(),
            force_g,
        }
    }
}

impl FingerShown {
    /// Angle at which the contact begins, at this stiffness: by the points at rest or by where the close met the object, whichever is
    /// surer; by the latter if they contradict each other, as what is soft first and hard later does.
    fn begins(&self, g_per_angle: Option<Bounded>) -> Option<Bounded> {
        let slope = g_per_angle?;
        let bound =
            |force_g: f64| CONTACT_BOUND.hypot(force_g / slope.value * (slope.bound / slope.value));
        let begins = |point: &ContactPoint| point.angle + point.force_g / slope.value;
        let rests: Vec<f64> = self.rests.iter().map(begins).collect();
        let by_rests = mean(&rests)
            .zip(self.rests.last())
            .map(|(value, last)| Bounded {
                value,
                bound: bound(last.force_g),
            });
        let by_close = self.met.map(|met| Bounded {
            value: begins(&met),
            bound: bound(met.force_g) + MOVING_BOUND,
        });
        match (by_rests, by_close) {
            (Some(rests), Some(close)) => {
                let agree = (rests.value - close.value).abs() <= rests.bound + MOVING_BOUND;
                Some(if agree && rests.bound <= close.bound {
                    rests
                } else {
                    close
                })
            }
            (rests, close) => rests.or(close),
        }
    }

    /// True if it later rested deeper with no more force, or much deeper than the stiffness of the close says: nothing elastic softens.
    fn is_dented(&self) -> bool {
        let softens = self.slope().zip(self.slope_of_close());
        let softens = softens.is_some_and(|(slope, close)| slope.value < SOFTENS * close.value);
        let deeper = |one: &ContactPoint, other: &ContactPoint| {
            one.angle - other.angle >= DENT && other.force_g <= one.force_g + REST_NOISE_G
        };
        let points = self.rests.iter().enumerate();
        let later = |at: usize| self.rests.iter().skip(at + 1);
        let mut pairs = points.flat_map(|(at, one)| later(at).map(move |other| (one, other)));
        softens || pairs.any(|(one, other)| deeper(one, other))
    }

    /// Stiffness by where the close met the object, and the first rest.
    fn slope_of_close(&self) -> Option<Bounded> {
        let (met, rest) = (self.met?, self.rests.first()?);
        let way = met.angle - rest.angle;
        let value = (rest.force_g - met.force_g) / way;
        let share = STIFFNESS_BOUND + 4.0 * ANGLE_BOUND / way;
        (way >= WAY_LEAST && value > 0.0).then_some(Bounded {
            value,
            bound: share * value,
        })
    }

    /// Stiffness by the points at rest: their regression.
    fn slope(&self) -> Option<Bounded> {
        let angles: Vec<f64> = self.rests.iter().map(|point| point.angle).collect();
        let forces: Vec<f64> = self.rests.iter().map(|point| point.force_g).collect();
        let (angle, force) = (mean(&angles)?, mean(&forces)?);
        let way = angles.iter().copied().fold(f64::MIN, f64::max)
            - angles.iter().copied().fold(f64::MAX, f64::min);
        let together: f64 = self
            .rests
            .iter()
            .map(|point| (point.angle - angle) * (force - point.force_g))
            .sum();
        let value = together / spread(&angles);
        let share = STIFFNESS_BOUND + 2.0 * ANGLE_BOUND / way;
        (way >= WAY_LEAST && value > 0.0).then_some(Bounded {
            value,
            bound: share * value,
        })
    }
}

/// The median of several values; its bound is that of one finger, less the more fingers agree.
fn combined(values: &[Bounded]) -> Option<Bounded> {
    let bounds: Vec<f64> = values.iter().map(|own| own.bound).collect();
    let values: Vec<f64> = values.iter().map(|own| own.value).collect();
    Some(Bounded {
        value: median(&values)?,
        bound: median(&bounds)? / count(&bounds).sqrt(),
    })
}

/// The class of a stiffness; unknown if its bounds are in different classes.
fn class(g_per_angle: Bounded) -> Stiffness {
    let Bounded { value, bound } = g_per_angle;
    let least = Stiffness::of(Some(value - bound));
    if least == Stiffness::of(Some(value + bound)) {
        least
    } else {
        Stiffness::Unknown
    }
}

/// Size between the pads of index and thumb, whose contacts begin at these angles.
fn size(index: Bounded, thumb: Bounded, rotation: i16, blocks: &SizeBlocks) -> Option<Bounded> {
    let gap = |index: f64, thumb: f64| {
        let mut counts = PerDof::splat(1000.0);
        counts[Dof::Index] = number(index);
        counts[Dof::ThumbBend] = number(thumb);
        counts[Dof::ThumbRotate] = f32::from(rotation);
        gap_on_path(&counts).map(f64::from)
    };
    let value = gap(index.value, thumb.value)?;
    let shift = |index, thumb| gap(index, thumb).map_or(0.0, |other| other - value);
    let by_index = shift(index.value + index.bound, thumb.value);
    let by_thumb = shift(index.value, thumb.value + thumb.bound);
    let corrected = blocks.corrected(number(value));
    let of_hand = match corrected {
        Some(_) => BLOCKS_BOUND_MM,
        None => MODEL_BOUND_MM,
    };
    Some(Bounded {
        value: corrected.map_or(value, f64::from),
        bound: of_hand.hypot(by_index.hypot(by_thumb)),
    })
}

/// The load of fingers that all rest.
fn weight(loads: &[TipLoad]) -> Option<Bounded> {
    let load: f64 = loads.iter().map(|tip| tip.tangential_g).sum();
    let normal: f64 = loads.iter().map(|tip| tip.normal_g).sum();
    let bound = CROSSTALK * normal + LOAD_BOUND * load;
    (bound <= LOAD_BOUND_MAX * load).then_some(Bounded { value: load, bound })
}

#[expect(clippy::cast_possible_truncation, reason = "an angle or a size in mm")]
const fn number(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOLDS: PerFinger<bool> = PerFinger::splat(true);
    /// Angles at which a block of 50 mm is met.
    const INDEX_AT: f64 = 556.0;
    const THUMB_AT: f64 = 794.0;

    /// A watch of index and thumb that met something at those angles, and rested with these forces in order. `depth` is how far a force
    /// presses it in.
    fn watch(forces_g: &[f64], depth: impl Fn(f64) -> f64) -> ObjectWatch {
        #[expect(clippy::cast_possible_truncation, reason = "an angle")]
        let at = |begins: f64, force_g: f64| (begins - depth(force_g)).round() as i16;
        let mut watch = ObjectWatch::new(SizeBlocks::default());
        for (finger, begins) in [(Finger::Index, INDEX_AT), (Finger::Thumb, THUMB_AT)] {
            watch.met(finger, at(begins, 20.0), 20.0);
            for force_g in forces_g {
                watch.rests(finger, at(begins, *force_g), *force_g);
            }
        }
        watch
    }

    fn object(watch: &ObjectWatch) -> HeldObject {
        watch.object(HOLDS, Some(0), None)
    }

    fn is_within(own: Option<Bounded>, truth: f64) -> bool {
        own.is_some_and(|own| (own.value - truth).abs() <= own.bound)
    }

    #[test]
    fn an_elastic_object_shows_its_size_and_stiffness() {
        for g_per_angle in [2.0, 8.0, 30.0] {
            let said = object(&watch(&[150.0, 320.0, 230.0, 170.0], |g| g / g_per_angle));
            let size = said.size_mm.unwrap();
            assert!((size.value - 50.0).abs() < 1.0, "{g_per_angle} {said:?}");
            assert!(is_within(said.g_per_angle, g_per_angle), "{said:?}");
            assert_eq!(said.stiffness, Stiffness::of(Some(g_per_angle)));
            assert_eq!(said.yields, Some(false), "{g_per_angle}");
        }
    }

    #[test]
    fn a_class_is_told_only_where_its_bounds_agree() {
        for (value, bound, told) in [
            (19.9, 12.9, Stiffness::Unknown),
            (12.0, 6.0, Stiffness::Firm),
            (30.0, 9.0, Stiffness::Rigid),
            (4.0, 1.5, Stiffness::Unknown),
        ] {
            assert_eq!(class(Bounded { value, bound }), told, "{value} {bound}");
        }
    }

    #[test]
    fn what_is_soft_first_and_hard_later_has_the_size_at_which_it_was_met() {
        let sponge = |g: f64| {
            let soft = (g / 2.0).min(60.0);
            soft + (g - 120.0).max(0.0) / 12.0
        };
        let said = object(&watch(&[200.0, 320.0, 230.0], sponge));
        assert!(is_within(said.size_mm, 50.0), "{said:?}");
        assert_eq!(said.yields, Some(false));
    }

    #[test]
    fn what_is_dented_yields_and_keeps_the_stiffness_of_the_close() {
        // It gives way at 200 g: the fingers go on with no more force.
        let mut clay = watch(&[150.0], |g| g / 10.0);
        for depth in [30, 60] {
            clay.rests(Finger::Index, 556 - depth, 200.0);
        }
        let said = object(&clay);
        assert_eq!(said.yields, Some(true));
        assert!(is_within(said.g_per_angle, 10.0), "{said:?}");
        assert!(is_within(said.size_mm, 50.0), "{said:?}");
    }

    #[test]
    fn what_was_not_shown_is_not_told() {
        let nothing = object(&ObjectWatch::new(SizeBlocks::default()));
        assert_eq!((nothing.size_mm, nothing.yields), (None, None));
        assert_eq!(nothing.stiffness, Stiffness::Unknown);
        let once = watch(&[150.0], |g| g / 8.0);
        assert_eq!(object(&once).yields, None, "it rested once");
        let ring_alone = PerFinger::from_fn(|finger| finger == Finger::Ring);
        let held = watch(&[150.0, 320.0], |g| g / 8.0);
        assert_eq!(held.object(ring_alone, Some(0), None).size_mm, None);
        let turned_away = held.object(HOLDS, Some(1000), None);
        assert_eq!(turned_away.size_mm, None, "the pads do not face each other");
    }

    #[test]
    fn a_weight_is_told_only_if_it_is_large_against_the_force() {
        let tips = |tangential_g| {
            [TipLoad {
                normal_g: 200.0,
                tangential_g,
            }; 2]
        };
        let weight = |tangential_g| {
            let watch = ObjectWatch::new(SizeBlocks::default());
            watch
                .object(HOLDS, None, Some(&tips(tangential_g)))
                .weight_g
        };
        assert!(is_within(weight(50.0), 100.0));
        assert_eq!(weight(5.0), None);
    }

    #[test]
    fn two_blocks_of_the_hand_correct_the_size() {
        let mut blocks = SizeBlocks::default();
        for (size_mm, gap_mm) in [(22.0, 20.0), (72.0, 70.0)] {
            let block = crate::hand::gap::Block { size_mm, gap_mm };
            blocks.measure(block).unwrap();
        }
        let mut held = watch(&[150.0, 320.0], |g| g / 30.0);
        let by_model = object(&held).size_mm.unwrap();
        held.blocks = blocks;
        let by_blocks = object(&held).size_mm.unwrap();
        assert!((by_blocks.value - by_model.value - 2.0).abs() < 0.01);
        assert!(by_blocks.bound < by_model.bound);
    }
}
