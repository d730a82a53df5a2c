//! Targets and limits for an armed hand: the newest value of each joint wins, and none outlives its arming.

use crate::hand::command::HandCommand;
use crate::hand::dof::PerDof;
use crate::hand::units::{Force, Speed, Target};

/// Identifies one arming. Setpoints carry it, so that setpoints of an earlier arming have no effect.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Default,
    serde::Serialize,
    serde::Deserialize,
)]
pub struct ArmEpoch(pub u64);

/// New targets and limits for an armed hand. Joints that are `None` keep their previous values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setpoints {
    /// Arming to which they belong; in any other they are dropped.
    pub epoch: ArmEpoch,
    /// Target angles; `None` leaves ANGLE_SET of the joint as it is.
    pub angle: PerDof<Option<Target>>,
    /// Force thresholds; `None` leaves FORCE_SET of the joint as it is.
    pub force: PerDof<Option<Force>>,
    /// Speeds; `None` leaves SPEED_SET of the joint as it is.
    pub speed: PerDof<Option<Speed>>,
}

impl Setpoints {
    /// Empty setpoints for one arming.
    pub const fn none(epoch: ArmEpoch) -> Self {
        Self {
            epoch,
            angle: PerDof::splat(None),
            force: PerDof::splat(None),
            speed: PerDof::splat(None),
        }
    }

    /// True if there is nothing to send.
    pub fn is_empty(&self) -> bool {
        *self == Self::none(self.epoch)
    }

    /// Commands that send the setpoints: speeds before forces before angles, so that no motion starts with older limits.
    pub const fn commands(&self) -> [HandCommand; 3] {
        [
            HandCommand::Speeds(self.speed),
            HandCommand::Forces(self.force),
            HandCommand::Angles(self.angle),
        ]
    }

    /// Overwrites with newer values, joint by joint. Setpoints of another arming replace all.
    pub fn merge(&mut self, newer: &Self) {
        if self.epoch != newer.epoch {
            *self = *newer;
            return;
        }
        put(&mut self.angle, &newer.angle);
        put(&mut self.force, &newer.force);
        put(&mut self.speed, &newer.speed);
    }
}

fn put<T: Copy>(older: &mut PerDof<Option<T>>, newer: &PerDof<Option<T>>) {
    for (dof, value) in newer.iter() {
        if value.is_some() {
            older[dof] = *value;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::dof::Dof;
    use crate::hand::units::Angle;

    fn one(epoch: u64, dof: Dof, angle: i16) -> Setpoints {
        let mut setpoints = Setpoints::none(ArmEpoch(epoch));
        setpoints.angle[dof] = Some(Target::Go(Angle::nearest(angle)));
        setpoints
    }

    #[test]
    fn the_newest_value_of_each_joint_wins() {
        let mut all = one(1, Dof::Little, 100);
        all.merge(&one(1, Dof::Index, 300));
        all.merge(&one(1, Dof::Little, 200));
        assert_eq!(all.angle[Dof::Little].unwrap().raw(), 200);
        assert_eq!(all.angle[Dof::Index].unwrap().raw(), 300);
    }

    #[test]
    fn another_arming_forgets_older_setpoints() {
        let mut all = one(1, Dof::Little, 100);
        all.merge(&one(2, Dof::Index, 300));
        assert_eq!(all, one(2, Dof::Index, 300));
    }
}
