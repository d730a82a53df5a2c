//! Dangers of power-up defaults: fast and strong joints, judged by the measured overshoot. Forbids nothing.

use crate::hand::impact::{HIGHEST_G, NOTABLE_G};
use crate::hand::overshoot::{Expected, MeasuredOn, OvershootMap, Stages};
use crate::hand::{Dof, Force};
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;

/// A joint whose defaults need a warning before they are written or saved.
#[derive(Debug, Clone, PartialEq)]
pub struct Danger {
    pub dof: Dof,
    /// Its speed after power-up.
    pub speed: i32,
    /// Its force threshold after power-up, grams.
    pub force_g: i32,
    /// Expected peak above the threshold on a rigid object, and the hand on which it was measured.
    pub expected: Expected,
}

impl Danger {
    /// Expected peak force of the finger, grams.
    pub fn peak_g(&self) -> f64 {
        f64::from(self.force_g) + self.expected.over_g
    }

    /// True if the threshold is above the highest measured one, whose overshoot is used then.
    pub fn is_beyond_measured(&self) -> bool {
        f64::from(self.force_g) > HIGHEST_G && self.expected.on == MeasuredOn::AnotherHand
    }

    /// True if the threshold alone exceeds the rated grip.
    pub fn is_above_rated(&self) -> bool {
        self.force_g > i32::from(Force::RATED.get())
    }
}

/// The dangerous joints that would hit or press harder with `after` than with `before`, by the overshoot measured on this hand: these
/// need a confirmation. A joint is never worse with a lower or equal speed and a lower or equal threshold, whatever was measured.
pub fn worse(before: &Params, after: &Params, map: &OvershootMap) -> Vec<Danger> {
    let rises = |danger: &Danger| {
        let Some(before) = joint(before, danger.dof, map) else {
            return true;
        };
        let is_milder = danger.speed <= before.speed && danger.force_g <= before.force_g;
        let presses_harder = danger.is_above_rated() && danger.force_g > before.force_g;
        !is_milder && (danger.peak_g() > before.peak_g() || presses_harder)
    };
    dangers(after, map).into_iter().filter(rises).collect()
}

/// The dangerous joints in a set of parameters. Joints without a known speed or threshold are skipped.
pub fn dangers(params: &Params, map: &OvershootMap) -> Vec<Danger> {
    let joints = Dof::ALL.into_iter();
    joints
        .filter_map(|dof| joint(params, dof, map))
        .filter(|joint| joint.expected.over_g >= NOTABLE_G || joint.is_above_rated())
        .collect()
}

fn joint(params: &Params, dof: Dof, map: &OvershootMap) -> Option<Danger> {
    let number = |id| match params.get(id) {
        Some(Value::Number(number)) => Some(number),
        _ => None,
    };
    let speed = number(ParamId::DefaultSpeed(dof))?;
    let force_g = number(ParamId::DefaultForce(dof))?;
    Some(Danger {
        dof,
        speed,
        force_g,
        expected: map.expected(dof, Stages::One, speed.into(), force_g.into()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Speed;
    use crate::hand::overshoot::{CLOSES_LEAST, CloseKind, Stiffness};

    #[test]
    fn fast_and_strong_defaults_are_told_and_gentle_ones_are_not() {
        for (speed, force, told) in [
            (25, 500, false),
            (200, 500, false),
            (250, 500, true),
            (1000, 1000, true),
            (1000, 50, false),
            (10, 2001, true),
            (10, 2000, false),
        ] {
            let mut params = Params::default();
            params.put(ParamId::DefaultSpeed(Dof::Index), Value::Number(speed));
            assert!(
                dangers(&params, &OvershootMap::default()).is_empty(),
                "one value alone is not judged"
            );
            params.put(ParamId::DefaultForce(Dof::Index), Value::Number(force));
            let dangers = dangers(&params, &OvershootMap::default());
            assert_eq!(dangers.len(), usize::from(told), "{speed} {force}");
            assert!(dangers.iter().all(|danger| danger.dof == Dof::Index));
        }
    }

    #[test]
    fn a_joint_is_worse_if_it_hits_or_presses_harder_and_never_if_both_values_fall() {
        let params = |(speed, force): (i32, i32)| {
            let mut params = Params::default();
            params.put(ParamId::DefaultSpeed(Dof::Ring), Value::Number(speed));
            params.put(ParamId::DefaultForce(Dof::Ring), Value::Number(force));
            params
        };
        for (before, after, is_worse) in [
            ((1000, 1000), (1000, 900), false),
            ((1000, 1000), (900, 1000), false),
            ((1000, 1000), (1000, 1100), true),
            // Slower, but the threshold alone is above the rated grip.
            ((1000, 1000), (25, 3000), true),
            ((1000, 3000), (25, 2500), false),
            ((25, 500), (1000, 500), true),
        ] {
            let worse = worse(&params(before), &params(after), &OvershootMap::default());
            assert_eq!(worse.len(), usize::from(is_worse), "{before:?} {after:?}");
        }
    }

    #[test]
    fn what_this_hand_measured_replaces_the_other_hand() {
        let mut params = Params::default();
        params.put(ParamId::DefaultSpeed(Dof::Index), Value::Number(500));
        params.put(ParamId::DefaultForce(Dof::Index), Value::Number(500));
        let of_another = dangers(&params, &OvershootMap::default());
        assert_eq!(of_another[0].expected.on, MeasuredOn::AnotherHand);
        let mut map = OvershootMap::default();
        let kind = CloseKind {
            dof: Dof::Index,
            stages: Stages::One,
            speed: Speed::nearest(500),
            threshold: Force::GENTLE,
            stiffness: Stiffness::Rigid,
        };
        for _ in 0..CLOSES_LEAST {
            map.add(kind, 90.0, "2026-11-26");
        }
        assert_eq!(dangers(&params, &map), []);
        map.add(kind, 700.0, "2026-11-26");
        let told = dangers(&params, &map);
        assert_eq!((told[0].expected.over_g, told[0].peak_g()), (700.0, 1200.0));
        assert!(matches!(
            told[0].expected.on,
            MeasuredOn::ThisHand { closes: 4, .. }
        ));
    }

    #[test]
    fn only_what_hits_harder_than_before_has_to_be_meant() {
        let joint = |speed, force| {
            let mut params = Params::default();
            params.put(ParamId::DefaultSpeed(Dof::Index), Value::Number(speed));
            params.put(ParamId::DefaultForce(Dof::Index), Value::Number(force));
            params
        };
        for (before, after, told) in [
            (joint(1000, 1000), joint(200, 1000), false),
            (joint(1000, 1000), joint(1000, 1000), false),
            (joint(200, 500), joint(1000, 1000), true),
            (joint(200, 1000), joint(250, 1000), true),
            (Params::default(), joint(1000, 1000), true),
            (joint(25, 500), joint(200, 500), false),
        ] {
            assert_eq!(
                !worse(&before, &after, &OvershootMap::default()).is_empty(),
                told,
                "{before:?} {after:?}"
            );
        }
    }
}
