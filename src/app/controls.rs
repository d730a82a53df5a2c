//! The user's settings of the joints, changes in and setpoints out, and the hold-to-run key: while it is required, motion passes only as
//! long as the user holds it; it counts as released when the window loses focus or hangs. Knows no link and no clock.

use crate::hand::hold_forces::HoldForces;
use crate::hand::newtons::ForceUnit;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Force, Gesture, Group, HandSample, Moment, PerDof,
    Setpoints, Speed, Target,
};
use crate::link::{ArmRequest, HoldToRun};
use crate::record::Record;
use std::time::Duration;

/// Forces of a hold before the user sets others, g.
const HOLD_AT_LEAST: i16 = 150;
const HOLD_AT_MOST: i16 = 400;

/// The user's settings of one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct JointControl {
    /// Position of the slider: the actual angle while disarmed, the user's target while armed. `None` if it is not known.
    pub target: Option<Angle>,
    /// Force threshold: the value found in the hand, gentle at most, until the user sets another; sent at arming and when changed
    /// while armed. `None` if it is not known.
    pub force: Option<Force>,
    /// Speed, likewise.
    pub speed: Option<Speed>,
    /// The joint is locked: it receives no setpoints.
    pub locked: bool,
}

/// A change that the user makes to one joint.
#[derive(Debug, Clone, Copy)]
pub(crate) enum JointChange {
    /// Target. Ignored while the user may not move the hand.
    Target(Angle),
    /// Force threshold; stored, and sent while the user may move the hand.
    Force(Force),
    /// Speed; stored, and sent while the user may move the hand.
    Speed(Speed),
    /// Locks or unlocks the joint.
    Lock(bool),
}

/// Actual settings of one joint; each `None` if it equals the user's setting, or is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HeldOtherwise {
    /// Its speed.
    pub speed: Option<Speed>,
    /// Its force threshold.
    pub force: Option<Force>,
    /// Its target, if the joint was sent elsewhere under this arming.
    pub target: Option<Angle>,
}

/// The user's settings of the six joints.
#[derive(Debug, Default)]
pub struct Controls {
    pub joints: PerDof<JointControl>,
    /// The stored gesture that was started last, unless it failed.
    pub gesture: Option<Gesture>,
    /// Forces of a hold, if the user set any: in g of this hand, and in g of a scale for those in newtons. Neither follows from the other.
    hold_forces: Option<HoldForces>,
    hold_scale_forces: Option<HoldForces>,
    /// Unit in which the user sets them.
    hold_unit: ForceUnit,
    /// Hold-to-run key.
    pub(crate) held: HeldKey,
    /// Sliders that show the commanded target; the others show the actual angle.
    steered: PerDof<bool>,
    /// Target of each joint under this arming; `None` if none was sent, or the joint was locked since.
    sent: PerDof<Option<Angle>>,
    /// Joints that have the speed and force of a played entry.
    overridden: PerDof<bool>,
}

impl Controls {
    /// Forces of the next hold, g of this hand.
    pub fn hold_forces(&self) -> HoldForces {
        self.hold_forces_in(ForceUnit::Grams)
    }

    /// Forces of the next hold if they are set in this unit.
    pub fn hold_forces_in(&self, unit: ForceUnit) -> HoldForces {
        let [least, most] = [HOLD_AT_LEAST, HOLD_AT_MOST].map(Force::nearest);
        let own = match unit {
            ForceUnit::Grams => self.hold_forces,
            ForceUnit::Newtons => self.hold_scale_forces,
        };
        own.unwrap_or(HoldForces::nearest(least, most))
    }

    /// Sets the forces of the next hold in a unit.
    pub(crate) const fn set_hold_forces(&mut self, unit: ForceUnit, forces: HoldForces) {
        match unit {
            ForceUnit::Grams => self.hold_forces = Some(forces),
            ForceUnit::Newtons => self.hold_scale_forces = Some(forces),
        }
    }

    /// Unit in which the user sets them; grams if the newtons of a finger are missing.
    pub fn hold_unit(&self, newtons: &PerDof<Option<f64>>) -> ForceUnit {
        let is_possible = |unit: &ForceUnit| unit.reading_per_g(newtons).is_some();
        Some(self.hold_unit).filter(is_possible).unwrap_or_default()
    }

    /// Chooses the unit.
    pub(crate) const fn set_hold_unit(&mut self, unit: ForceUnit) {
        self.hold_unit = unit;
    }

    /// Settings for the next connection with this hand: no key is held, and no slider was moved.
    pub(crate) fn at_next_connection(self) -> Self {
        Self {
            joints: self.joints,
            hold_forces: self.hold_forces,
            hold_scale_forces: self.hold_scale_forces,
            hold_unit: self.hold_unit,
            ..Self::default()
        }
    }

    /// Adopts the values found in the hand where the user has set none, limited to gentle: a hand is delivered with its maximum
    /// values.
    pub(crate) fn adopt(&mut self, found: &HandSample) {
        for (dof, joint) in self.joints.iter_mut() {
            let speed = found.speed_set.and_then(|all| all.value[dof]);
            let force = found.force_set.and_then(|all| all.value[dof]);
            joint.speed = joint.speed.or(speed.map(|speed| speed.min(Speed::GENTLE)));
            joint.force = joint.force.or(force.map(|force| force.min(Force::GENTLE)));
        }
    }

    /// Locked joints.
    pub fn locked(&self) -> PerDof<bool> {
        self.joints.map(|joint| joint.locked)
    }

    /// True if every slider follows its joint.
    pub(crate) fn all_follow(&self) -> bool {
        self.steered.iter().all(|(_, steered)| !steered)
    }

    /// Applies a record of a replay, which has no user settings: speeds and forces are those of the hand, and a target applies from
    /// the time it was sent.
    pub(crate) fn apply_recorded(&mut self, record: &Record) {
        match record {
            Record::Reading { sample, fresh } => {
                for (dof, joint) in self.joints.iter_mut() {
                    joint.speed = sample.speed_set.and_then(|all| all.value[dof]);
                    joint.force = sample.force_set.and_then(|all| all.value[dof]);
                    let set = sample.angle_set.filter(|_| fresh.contains(Group::AngleSet));
                    if let Some(set) = set {
                        joint.target = match set.value[dof] {
                            Some(Target::Go(held)) => Some(held),
                            _ => None,
                        };
                    }
                }
            }
            Record::Sent { write, .. } => {
                for (dof, to) in write.angle_targets().iter() {
                    self.joints[dof].target = to.or(self.joints[dof].target);
                }
            }
            _ => {}
        }
    }

    /// The user's limits, gentle where there are none.
    pub(crate) fn limits(&self) -> ArmRequest {
        ArmRequest {
            speed: self
                .joints
                .map(|joint| joint.speed.unwrap_or(Speed::GENTLE)),
            force: self
                .joints
                .map(|joint| joint.force.unwrap_or(Force::GENTLE)),
        }
    }

    /// Limits that arming sets; they become the user's settings. A locked joint keeps its actual values.
    pub(crate) fn arm_request(&mut self, holds: &HandSample) -> ArmRequest {
        let mut request = self.limits();
        for (dof, joint) in self.joints.iter_mut() {
            joint.speed = Some(request.speed[dof]);
            joint.force = Some(request.force[dof]);
            if joint.locked {
                let speed = holds.speed_set.and_then(|all| all.value[dof]);
                let force = holds.force_set.and_then(|all| all.value[dof]);
                request.speed[dof] = speed.unwrap_or(request.speed[dof]);
                request.force[dof] = force.unwrap_or(request.force[dof]);
            }
        }
        self.overridden = PerDof::default();
        request
    }

    /// Marks joints that a played entry sends with its own speed and force.
    pub(crate) fn override_limits(&mut self, targets: &PerDof<Option<Angle>>) {
        for (dof, to) in targets.iter() {
            self.overridden[dof] |= to.is_some();
        }
    }

    /// Adds the user's speed and force for those of these joints that are unlocked and have the values of a played entry.
    pub(crate) fn restore_limits(&mut self, sent: &mut Setpoints, of: impl Fn(Dof) -> bool) {
        for (dof, joint) in self.joints.iter().filter(|(_, joint)| !joint.locked) {
            if of(dof) && std::mem::take(&mut self.overridden[dof]) {
                (sent.speed[dof], sent.force[dof]) = (joint.speed, joint.force);
            }
        }
    }

    /// Actual settings of a joint that differ from the user's.
    pub(crate) fn held_otherwise(&self, dof: Dof, held: &HandSample) -> HeldOtherwise {
        let joint = self.joints[dof];
        let speed = held.speed_set.and_then(|all| all.value[dof]);
        let force = held.force_set.and_then(|all| all.value[dof]);
        let target = held.angle_set.and_then(|all| all.value[dof]?.angle());
        HeldOtherwise {
            speed: speed.filter(|speed| joint.speed != Some(*speed)),
            force: force.filter(|force| joint.force != Some(*force)),
            target: target.filter(|held| self.sent[dof].is_some_and(|sent| sent != *held)),
        }
    }

    /// Force threshold that stops a joint: the actual one, else the user's.
    pub fn stops_at(&self, dof: Dof, held: HeldOtherwise) -> Option<Force> {
        held.force.or(self.joints[dof].force)
    }

    /// Applies a change. `epoch` is the arming under which the user may move the hand; returns the setpoints to send under it.
    pub(crate) fn apply(
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
                (self.steered[dof], self.sent[dof]) = (true, Some(angle));
            }
            JointChange::Force(force) => joint.force = Some(force),
            JointChange::Speed(speed) => joint.speed = Some(speed),
            JointChange::Lock(locked) => {
                joint.locked = locked;
                (self.steered[dof], self.sent[dof]) = (false, None);
            }
        }
        let joint = self.joints[dof];
        let mut setpoints = Setpoints::none(epoch.filter(|_| !joint.locked)?);
        match change {
            JointChange::Target(angle) => setpoints.angle[dof] = Some(Target::Go(angle)),
            JointChange::Force(force) => setpoints.force[dof] = Some(force),
            JointChange::Speed(speed) => setpoints.speed[dof] = Some(speed),
            // Changes made while it was locked are sent when it is unlocked.
            JointChange::Lock(_) if was_locked => {
                (setpoints.force[dof], setpoints.speed[dof]) = (joint.force, joint.speed);
            }
            JointChange::Lock(_) => return None,
        }
        Some(setpoints)
    }

    /// Setpoints of the joints that have a target and are not locked; `None` if there are none.
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

    /// Moves the sliders of unlocked joints to these targets.
    pub(crate) fn show(&mut self, sent: &Setpoints) {
        for (dof, joint) in self.joints.iter_mut() {
            if let Some(Target::Go(to)) = sent.angle[dof].filter(|_| !joint.locked) {
                joint.target = Some(to);
                (self.steered[dof], self.sent[dof]) = (true, Some(to));
            }
        }
    }

    /// Moves the sliders to targets that a party outside this window sent.
    pub(crate) fn show_angles(&mut self, sent: PerDof<Option<Angle>>) {
        for (dof, to) in sent.iter() {
            if to.is_some() {
                self.joints[dof].target = *to;
                (self.steered[dof], self.sent[dof]) = (true, *to);
            }
        }
    }

    /// Notes that the hand was armed: sliders keep their positions until they are moved.
    pub(crate) fn freeze(&mut self) {
        let stands = |joint: JointControl| !joint.locked && joint.target.is_some();
        self.steered = self.joints.map(stands);
    }

    /// Makes all sliders follow their joints, discarding targets.
    pub(crate) fn release(&mut self) {
        (self.steered, self.sent) = (PerDof::default(), PerDof::default());
    }

    /// Moves sliders that the user has not moved to the actual angle, so that arming and taking over never jump.
    pub(crate) fn follow(&mut self, actual: Option<&PerDof<AngleReading>>, is_armed: bool) {
        if !is_armed {
            self.release();
        }
        for (dof, joint) in self.joints.iter_mut() {
            if !self.steered[dof] {
                joint.target = actual.and_then(|angles| angles[dof].hold());
            }
        }
    }
}

/// A held key stays valid for this long: a window that draws slowly does not stop the hand, a window that hangs does.
const HOLD_DURATION: Duration = Duration::from_millis(250);

/// State of the key, as the window reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HoldKey {
    /// It was just pressed: the user requests arming.
    Pressed,
    /// It is still held.
    Held,
    /// It is not held.
    LetGo,
}

/// State of the hold-to-run key.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HeldKey {
    is_needed: bool,
    until: Moment,
    /// The key was pressed, and this press has not armed yet.
    is_pressed: bool,
}

impl HeldKey {
    /// True if the key is required and not held.
    pub(crate) fn is_let_go(&self, now: Moment) -> bool {
        self.is_needed && self.until <= now
    }

    /// True while the key counts as held.
    pub(crate) fn is_held(&self, now: Moment) -> bool {
        self.until > now
    }

    /// Sets whether the key is required.
    pub(crate) const fn need(&mut self, is_needed: bool) {
        self.is_needed = is_needed;
    }

    /// Applies the state of the key; true while a press waits for arming.
    pub(crate) fn apply(&mut self, key: HoldKey, now: Moment) -> bool {
        let until = now.plus(HOLD_DURATION);
        (self.until, self.is_pressed) = match key {
            HoldKey::Pressed => (until, true),
            HoldKey::Held => (until, self.is_pressed),
            HoldKey::LetGo => (Moment::ZERO, false),
        };
        self.is_needed && self.is_pressed
    }

    /// State of the key for the link.
    pub(crate) const fn hold_to_run(&self) -> HoldToRun {
        match (self.is_needed, self.until) {
            (false, _) => HoldToRun::Off,
            (true, Moment::ZERO) => HoldToRun::Released,
            (true, until) => HoldToRun::Held(until),
        }
    }

    /// Discards the press: only a new press arms.
    pub(crate) const fn forget_press(&mut self) {
        self.is_pressed = false;
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
                controls.apply(Dof::Index, change, None).is_none(),
                "{change:?}"
            );
            assert_eq!(
                controls.joints[Dof::Index].target,
                None,
                "no wish to move is kept"
            );
            controls.apply(Dof::Index, JointChange::Lock(true), Some(EPOCH));
            let sent = controls.apply(Dof::Index, change, Some(EPOCH));
            let frees = matches!(change, JointChange::Lock(false));
            assert_eq!(sent.is_some(), frees, "{change:?} of a locked joint");
        }
    }

    #[test]
    fn speed_and_force_that_were_changed_while_locked_go_out_when_it_is_free() {
        let mut controls = Controls::default();
        controls.apply(Dof::Ring, JointChange::Lock(true), Some(EPOCH));
        controls.apply(Dof::Ring, JointChange::Force(Force::MAX), Some(EPOCH));
        let sent = controls.apply(Dof::Ring, JointChange::Lock(false), Some(EPOCH));
        let sent = sent.unwrap();
        assert_eq!(sent.force[Dof::Ring], Some(Force::MAX));
        assert_eq!(sent.speed[Dof::Ring], None, "nothing is known of it");
        assert!(sent.angle.iter().all(|(_, target)| target.is_none()));
    }

    #[test]
    fn own_speed_and_force_are_restored_once_and_for_the_joints_that_were_played() {
        let mut controls = Controls::default();
        controls.apply(Dof::Ring, JointChange::Speed(Speed::MIN), None);
        controls.apply(Dof::Index, JointChange::Speed(Speed::MIN), None);
        let mut targets = PerDof::splat(None);
        targets[Dof::Ring] = Some(Angle::MIN);
        controls.override_limits(&targets);
        let mut sent = Setpoints::none(EPOCH);
        sent.angle[Dof::Ring] = Some(Target::Go(Angle::MIN));
        sent.speed[Dof::Ring] = Some(Speed::MAX);
        controls.show(&sent);
        assert_eq!(controls.joints[Dof::Ring].speed, Some(Speed::MIN));
        let mut own = Setpoints::none(EPOCH);
        controls.restore_limits(&mut own, |_| true);
        assert_eq!(own.speed[Dof::Ring], Some(Speed::MIN));
        assert_eq!(own.speed[Dof::Index], None, "nothing played moved it");
        let mut again = Setpoints::none(EPOCH);
        controls.restore_limits(&mut again, |_| true);
        assert!(again.is_empty(), "once");
    }

    #[test]
    fn wishes_are_what_the_hand_was_found_with_until_a_person_sets_others() {
        let mut controls = Controls::default();
        controls.apply(Dof::Ring, JointChange::Force(Force::MIN), None);
        let timed = |value| {
            Some(crate::hand::Timed {
                value: PerDof::splat(Some(value)),
                asked: crate::hand::Moment::ZERO,
                received: crate::hand::Moment::ZERO,
            })
        };
        let mut found = HandSample {
            force_set: timed(Force::nearest(100)),
            ..HandSample::default()
        };
        controls.adopt(&found);
        found.force_set = timed(Force::MAX);
        controls.adopt(&found);
        let force = controls.joints.map(|joint| joint.force);
        assert_eq!(force[Dof::Ring], Some(Force::MIN));
        let first = Some(Force::nearest(100));
        assert_eq!(force[Dof::Index], first, "as it was found first");
        assert_eq!(controls.joints[Dof::Index].speed, None, "not read yet");
        let mut fresh = Controls::default();
        fresh.adopt(&found);
        assert_eq!(fresh.joints[Dof::Index].force, Some(Force::GENTLE));
    }

    #[test]
    fn of_a_pose_the_locked_joints_are_left_out() {
        let mut controls = Controls::default();
        controls.apply(Dof::Little, JointChange::Lock(true), None);
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
