//! What a person sets for the joints: changes in, setpoints out. Knows no link and no clock.

use crate::app::hand::held_key::HeldKey;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Force, Gesture, PerDof, Setpoints, Speed, Target,
};
use crate::link::ArmRequest;

/// One joint as a person sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointControl {
    /// Where the slider stands: the actual angle while not armed, the person's target while armed. `None` = not known.
    pub target: Option<Angle>,
    /// Force threshold; sent at arming and when changed while armed.
    pub force: Force,
    /// Speed; sent at arming and when changed while armed.
    pub speed: Speed,
    /// Leave this joint alone.
    pub locked: bool,
}

impl Default for JointControl {
    fn default() -> Self {
        Self {
            target: None,
            force: Force::GENTLE,
            speed: Speed::GENTLE,
            locked: false,
        }
    }
}

/// A change that a person makes to one joint.
#[derive(Debug, Clone, Copy)]
pub(crate) enum JointChange {
    /// Where it should go. Nothing while the person may not move it.
    Target(Angle),
    /// Force threshold; kept, and sent while the person may move it.
    Force(Force),
    /// Speed; kept, and sent while the person may move it.
    Speed(Speed),
    /// Leave it alone, or not any more.
    Lock(bool),
}

/// The six joints as a person sets them.
#[derive(Debug, Default)]
pub struct Controls {
    pub joints: PerDof<JointControl>,
    /// The stored gesture that was started last, unless it failed.
    pub gesture: Option<Gesture>,
    /// What a person holds to let the hand move.
    pub(crate) held: HeldKey,
    /// Sliders that show where the joint was sent; the others show the actual angle.
    steered: PerDof<bool>,
}

impl Controls {
    /// The same for the next connection: nobody holds a key, and no slider was moved.
    pub(crate) fn at_next_connection(self) -> Self {
        Self {
            joints: self.joints,
            gesture: None,
            held: HeldKey::default(),
            steered: PerDof::default(),
        }
    }

    /// Joints that are left alone.
    pub fn locked(&self) -> PerDof<bool> {
        self.joints.map(|joint| joint.locked)
    }

    /// Whether each slider follows its joint.
    pub(crate) fn all_follow(&self) -> bool {
        self.steered.iter().all(|(_, steered)| !steered)
    }

    /// The limits that arming sets.
    pub(crate) fn arm_request(&self) -> ArmRequest {
        ArmRequest {
            speed: self.joints.map(|joint| joint.speed),
            force: self.joints.map(|joint| joint.force),
        }
    }

    /// Takes a change. `epoch` is the arming in which the person may move the hand; gives what is to be sent in it.
    pub(crate) fn take(
        &mut self,
        dof: Dof,
        change: JointChange,
        epoch: Option<ArmEpoch>,
    ) -> Option<Setpoints> {
        let joint = &mut self.joints[dof];
        let was_locked = joint.locked;
        match change {
            JointChange::Target(angle) => {
                if epoch.is_none() || was_locked {
                    return None;
                }
                joint.target = Some(angle);
                self.steered[dof] = true;
            }
            JointChange::Force(force) => joint.force = force,
            JointChange::Speed(speed) => joint.speed = speed,
            JointChange::Lock(locked) => {
                joint.locked = locked;
                self.steered[dof] = false;
            }
        }
        let joint = self.joints[dof];
        let mut setpoints = Setpoints::none(epoch.filter(|_| !joint.locked)?);
        match change {
            JointChange::Target(angle) => setpoints.angle[dof] = Some(Target::Go(angle)),
            JointChange::Force(force) => setpoints.force[dof] = Some(force),
            JointChange::Speed(speed) => setpoints.speed[dof] = Some(speed),
            // What was changed meanwhile goes out when it is free again.
            JointChange::Lock(_) if was_locked => {
                setpoints.force[dof] = Some(joint.force);
                setpoints.speed[dof] = Some(joint.speed);
            }
            JointChange::Lock(_) => return None,
        }
        Some(setpoints)
    }

    /// Of these setpoints those of joints that have a target and are not locked; `None` if there are none.
    pub(crate) fn free(&self, wanted: &Setpoints) -> Option<Setpoints> {
        let mut free = Setpoints::none(wanted.epoch);
        for (dof, joint) in self.joints.iter() {
            if wanted.angle[dof].is_some() && !joint.locked {
                free.angle[dof] = wanted.angle[dof];
                free.speed[dof] = wanted.speed[dof];
                free.force[dof] = wanted.force[dof];
            }
        }
        (!free.is_empty()).then_some(free)
    }

    /// The sliders of joints that are not locked stand where these were sent.
    pub(crate) fn show(&mut self, sent: &Setpoints) {
        for (dof, joint) in self.joints.iter_mut() {
            if let Some(Target::Go(to)) = sent.angle[dof].filter(|_| !joint.locked) {
                joint.target = Some(to);
                joint.speed = sent.speed[dof].unwrap_or(joint.speed);
                joint.force = sent.force[dof].unwrap_or(joint.force);
                self.steered[dof] = true;
            }
        }
    }

    /// The sliders stand where another than this window sent the joints.
    pub(crate) fn show_angles(&mut self, sent: PerDof<Option<Angle>>) {
        for (dof, to) in sent.iter() {
            if to.is_some() {
                self.joints[dof].target = *to;
                self.steered[dof] = true;
            }
        }
    }

    /// The hand is armed: sliders stay where they stand until they are moved.
    pub(crate) fn stand(&mut self) {
        let stands = |joint: JointControl| !joint.locked && joint.target.is_some();
        self.steered = self.joints.map(stands);
    }

    /// All sliders follow their joints, whatever was sent.
    pub(crate) fn let_go(&mut self) {
        self.steered = PerDof::default();
    }

    /// Sliders that no person holds stand at the actual angle, so that arming and taking over never jump.
    pub(crate) fn follow(&mut self, actual: Option<&PerDof<AngleReading>>, is_armed: bool) {
        if !is_armed {
            self.let_go();
        }
        for (dof, joint) in self.joints.iter_mut() {
            if !self.steered[dof] {
                joint.target = actual.and_then(|angles| angles[dof].hold());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPOCH: ArmEpoch = ArmEpoch(1);

    #[test]
    fn a_change_goes_out_only_in_an_arming_and_only_for_a_joint_that_is_not_locked() {
        let changes = [
            JointChange::Target(Angle::MIN),
            JointChange::Force(Force::MAX),
            JointChange::Speed(Speed::MAX),
            JointChange::Lock(false),
        ];
        for change in changes {
            let mut controls = Controls::default();
            assert!(
                controls.take(Dof::Index, change, None).is_none(),
                "{change:?}"
            );
            assert_eq!(
                controls.joints[Dof::Index].target,
                None,
                "no wish to move is kept"
            );
            controls.take(Dof::Index, JointChange::Lock(true), Some(EPOCH));
            let sent = controls.take(Dof::Index, change, Some(EPOCH));
            let frees = matches!(change, JointChange::Lock(false));
            assert_eq!(sent.is_some(), frees, "{change:?} of a locked joint");
        }
    }

    #[test]
    fn speed_and_force_that_were_changed_while_locked_go_out_when_it_is_free() {
        let mut controls = Controls::default();
        controls.take(Dof::Ring, JointChange::Lock(true), Some(EPOCH));
        controls.take(Dof::Ring, JointChange::Force(Force::MAX), Some(EPOCH));
        let sent = controls.take(Dof::Ring, JointChange::Lock(false), Some(EPOCH));
        let sent = sent.unwrap();
        assert_eq!(sent.force[Dof::Ring], Some(Force::MAX));
        assert_eq!(sent.speed[Dof::Ring], Some(Speed::GENTLE));
        assert!(sent.angle.iter().all(|(_, target)| target.is_none()));
    }

    #[test]
    fn of_a_pose_the_locked_joints_are_left_out() {
        let mut controls = Controls::default();
        controls.take(Dof::Little, JointChange::Lock(true), None);
        let mut pose = Setpoints::none(EPOCH);
        pose.angle = PerDof::splat(Some(Target::Go(Angle::MAX)));
        let sent = controls.free(&pose).unwrap();
        let going = sent.angle.iter().filter(|(_, target)| target.is_some());
        assert_eq!(going.count(), 5);
        controls.joints = controls.joints.map(|joint| JointControl {
            locked: true,
            ..joint
        });
        assert_eq!(controls.free(&pose), None);
    }
}
