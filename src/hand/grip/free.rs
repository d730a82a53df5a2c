//! Force that a joint's sensor reads while the joint bends and touches nothing: friction of its own mechanics, by angle.

use crate::hand::dof::{Dof, PerDof};
use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Distance between the stored angles, in counts.
const KNOT: i16 = 50;
const KNOTS: usize = 21;
/// Largest distance between an angle and a measured knot for which a value is known.
const KNOWN_TOLERANCE: i16 = 125;
/// Upper limit of the friction, g; a larger force means that something was in the way.
const FREE_MAX_G: f32 = 200.0;
/// Weight of a newer measurement that is lower or higher. An obstacle during a close adds force and never reduces it.
const LESS_SHARE: f32 = 0.5;
const MORE_SHARE: f32 = 0.1;

/// Force of free motion over each joint's own zero, g, every 50 counts from 0 to 1000.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "StoredFreeForce", into = "StoredFreeForce")]
pub struct FreeForce(PerDof<Knots>);

/// Form in files: a list of forces for each joint with any known value.
type StoredFreeForce = BTreeMap<Dof, Vec<Option<f32>>>;

type Knots = [Option<f32>; KNOTS];

/// Error for values in a file that cannot be forces of free motion.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {KNOTS} forces of at most {FREE_MAX_G} g are needed", dof.name())]
pub struct NoFreeForce {
    dof: Dof,
}

impl From<FreeForce> for StoredFreeForce {
    fn from(free: FreeForce) -> Self {
        let tenths = |g: f32| (g * 10.0).round() / 10.0;
        let rounded = |dof| free.0[dof].iter().map(|g| g.map(tenths)).collect();
        free.known().map(|dof| (dof, rounded(dof))).collect()
    }
}

impl TryFrom<StoredFreeForce> for FreeForce {
    type Error = NoFreeForce;

    fn try_from(kept: StoredFreeForce) -> Result<Self, NoFreeForce> {
        let is_possible = |g: &Option<f32>| g.is_none_or(|g| g.abs() <= FREE_MAX_G);
        let mut free = Self::default();
        for (dof, all) in kept {
            let knots = Knots::try_from(all).ok();
            let knots = knots.filter(|knots| knots.iter().all(is_possible));
            free.0[dof] = knots.ok_or(NoFreeForce { dof })?;
        }
        Ok(free)
    }
}

impl FreeForce {
    /// Force over its zero that a joint reads at this angle when it touches nothing, g; `None` where it was never measured.
    pub fn at(&self, dof: Dof, angle: i16) -> Option<f32> {
        let mut known = known(&self.0[dof]);
        let below = known.clone().rfind(|(at, _)| *at <= angle);
        let above = known.find(|(at, _)| *at >= angle);
        let near = |knot: &(i16, f32)| (knot.0 - angle).abs() <= KNOWN_TOLERANCE;
        match (below.filter(near), above.filter(near)) {
            (Some((low, low_g)), Some((high, high_g))) if low < high => {
                let part = f32::from(angle - low) / f32::from(high - low);
                Some(low_g + (high_g - low_g) * part)
            }
            (Some((_, g)), _) | (None, Some((_, g))) => Some(g),
            (None, None) => None,
        }
    }

    /// Joints with at least one known value.
    pub fn known(&self) -> impl Iterator<Item = Dof> {
        let joints = self.0.iter();
        joints.filter_map(|(dof, knots)| known(knots).next().map(|_| dof))
    }

    /// Merges the measurement of a close that touched nothing. Returns true if a value changed by at least 1 g.
    pub(super) fn learn(&mut self, dof: Dof, close: &FreeClose) -> bool {
        let mut is_news = false;
        for (own, felt) in self.0[dof].iter_mut().zip(close.means()) {
            let Some(felt) = felt else {
                continue;
            };
            let before = *own;
            let known = own.get_or_insert(felt);
            let share = if felt < *known {
                LESS_SHARE
            } else {
                MORE_SHARE
            };
            *known += (felt - *known) * share;
            is_news |= before.is_none_or(|before| (before - *known).abs() >= 1.0);
        }
        is_news
    }

    /// Replaces the values of each joint that `newer` knows.
    pub fn merge(&mut self, newer: &Self) {
        for dof in newer.known() {
            self.0[dof] = newer.0[dof];
        }
    }

    /// Overwrites with the measurement of a hand known to be empty, which is more reliable than an ordinary close.
    pub fn put(&mut self, dof: Dof, close: &FreeClose) {
        for (own, felt) in self.0[dof].iter_mut().zip(close.means()) {
            *own = felt.or(*own);
        }
    }
}

/// Iterates over the angles with a known value.
fn known(knots: &Knots) -> impl DoubleEndedIterator<Item = (i16, f32)> + Clone {
    let angles = (0..).step_by(KNOT.unsigned_abs().into());
    let known = angles.zip(knots).filter_map(|(at, g)| Some((at, (*g)?)));
    known.collect::<ArrayVec<_, KNOTS>>().into_iter()
}

/// Force of one joint over its zero during one close, by angle.
#[derive(Debug, Clone, Copy, Default)]
pub struct FreeClose([(f32, f32); KNOTS]);

impl FreeClose {
    /// Adds one reading, in g over the zero of the joint.
    pub fn push(&mut self, angle: i16, force_g: f32) {
        let knot = usize::try_from(angle.saturating_add(KNOT / 2) / KNOT).unwrap_or_default();
        if let Some((sum, count)) = self.0.get_mut(knot) {
            *sum += force_g;
            *count += 1.0;
        }
    }

    fn means(&self) -> impl Iterator<Item = Option<f32>> + '_ {
        let mean = |(sum, count): &(f32, f32)| (*count > 0.0).then(|| sum / count);
        let means = self.0.iter().map(mean);
        means.map(|g| g.filter(|g| g.abs() <= FREE_MAX_G))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(g: impl Fn(i16) -> f32) -> FreeClose {
        let mut close = FreeClose::default();
        for angle in (240..=1000).step_by(7) {
            close.push(angle, g(angle));
        }
        close
    }

    /// A published log: 87 g on a little finger that is bent to 240 and touches nothing.
    fn friction(angle: i16) -> f32 {
        f32::from(1000 - angle) * 87.0 / 760.0
    }

    #[test]
    fn it_is_known_where_it_was_measured_and_nowhere_else() {
        let mut free = FreeForce::default();
        assert_eq!(free.at(Dof::Little, 240), None);
        assert!(free.learn(Dof::Little, &close(friction)));
        assert_eq!(free.known().collect::<Vec<_>>(), [Dof::Little]);
        for angle in [240, 333, 500, 777, 1000] {
            let known = free.at(Dof::Little, angle).unwrap();
            assert!((known - friction(angle)).abs() < 3.0, "{angle}: {known}");
        }
        assert_eq!(free.at(Dof::Little, 50), None, "it never went there");
        assert_eq!(free.at(Dof::Ring, 500), None);
        assert!(!free.learn(Dof::Little, &close(friction)), "nothing new");
    }

    #[test]
    fn what_was_in_the_way_once_is_forgotten_with_the_closes_that_follow() {
        let mut free = FreeForce::default();
        free.learn(Dof::Little, &close(|_| 120.0));
        for _ in 0..5 {
            free.learn(Dof::Little, &close(friction));
        }
        let known = free.at(Dof::Little, 600).unwrap();
        assert!((known - friction(600)).abs() < 5.0, "{known}");
        free.learn(Dof::Little, &close(|_| 2000.0));
        assert_eq!(
            free.at(Dof::Little, 600),
            Some(known),
            "no friction is that strong"
        );
    }

    #[test]
    fn what_is_kept_comes_back_and_what_cannot_be_is_refused() {
        let mut free = FreeForce::default();
        free.put(Dof::Little, &close(friction));
        let text = serde_json::to_string(&free).unwrap();
        let back: FreeForce = serde_json::from_str(&text).unwrap();
        for angle in (200..=1000).step_by(25) {
            let [one, two] = [free, back].map(|own| own.at(Dof::Little, angle).unwrap());
            assert!((one - two).abs() < 0.1, "{angle}: {one} {two}");
        }
        let many = |g: &str| format!(r#"{{"little":[{}{g}]}}"#, "null,".repeat(20));
        assert!(serde_json::from_str::<FreeForce>(&many("87.5")).is_ok());
        for wrong in [
            &many("870.5"),
            r#"{"little":[1.0]}"#,
            r#"{"palm":[]}"#,
            "[]",
        ] {
            assert!(serde_json::from_str::<FreeForce>(wrong).is_err(), "{wrong}");
        }
    }
}
