//! Motion state of a session: arming, pending setpoints and the stop. Sends nothing itself.

use crate::hand::ArmEpoch;
use crate::hand::Setpoints;
use crate::hand::{Dof, HandCommand, HandSample, Moment, PerDof, RegisterWrite, Target, Timed};
use crate::link::session::hold::HoldWatch;
use crate::link::status::ANGLE_FRESH;
use crate::link::wanted::ArmCommand;
use crate::record::{ArmRefusal, LinkState};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Maximum setpoint rounds per second: as soon as hand tracking has a new target. The pose is read before each.
pub const SETPOINT_HZ_MAX: u32 = 200;
/// On a slow line rounds leave three quarters of the time to reads, as long as that allows this many per second.
const SETPOINT_HZ_SLOW: u32 = 50;
const ROUND_SHARE: u32 = 4;
/// An armed hand whose angles become this old is disarmed.
pub(crate) const ANGLE_LOST: Duration = Duration::from_millis(500);
/// Longest time that an arming waits for missing readings: on a new link, or after a stall of this computer.
pub(crate) const ARM_READS_TIMEOUT: Duration = Duration::from_secs(1);
/// Maximum writes per round: speeds and forces in at most three runs each, and the angles.
const ROUND_MAX: usize = 7;

/// Consecutive rounds between which only the motion state is read, on a line that they fill.
const ROUNDS_MAX: u8 = 2;

/// An arming that the session has accepted.
#[derive(Debug)]
pub(crate) struct PendingArm {
    pub(crate) asked: ArmCommand,
    /// The arming is refused if required readings are still missing at this time.
    pub(crate) until: Moment,
}

/// Arming, setpoints and stop of one session.
#[derive(Debug, Default)]
pub(crate) struct Motion {
    pub(crate) last_epoch: ArmEpoch,
    /// Pending until the pose, the faults and the series are known.
    pub(crate) arming: Option<PendingArm>,
    pub(crate) hold: Option<HoldWatch>,
    /// A hold frame was sent, and the pose was not requested since.
    pub(crate) waits_for_read: bool,
    /// The newest setpoints that are in no round yet.
    setpoints: Option<Setpoints>,
    /// The remaining writes of the current round, in order.
    round: ArrayVec<RegisterWrite, ROUND_MAX>,
    round_began: Option<Moment>,
    /// Time that its writes have taken on the wire so far.
    round_took: Duration,
    /// The pose was not requested since the round began: on a slow line writes alone must not fill it.
    pose_due: bool,
    /// Rounds since anything but the motion state was requested.
    rounds: u8,
}

impl Motion {
    /// A fresh state that continues to count armings from `last_epoch`.
    pub(crate) fn after(last_epoch: ArmEpoch) -> Self {
        Self {
            last_epoch,
            ..Self::default()
        }
    }

    /// Drops the stop, the arming and all setpoints.
    pub(crate) fn forget(&mut self) {
        self.hold = None;
        self.forget_setpoints();
    }

    /// Drops the pending arming and all setpoints.
    pub(crate) fn forget_setpoints(&mut self) {
        self.arming = None;
        self.setpoints = None;
        self.round.clear();
    }

    /// Merges newer setpoints if they belong to the current arming.
    pub(crate) fn merge_setpoints(&mut self, newer: &Setpoints, armed: Option<ArmEpoch>) {
        if armed != Some(newer.epoch) {
            return;
        }
        match &mut self.setpoints {
            Some(older) => older.merge(newer),
            none => *none = Some(*newer),
        }
    }

    /// Time at which the next frame can be sent; `None` if nothing is pending.
    pub(crate) fn next_send(&self, now: Moment) -> Option<Moment> {
        if let Some(hold) = &self.hold {
            return hold.next_frame(now);
        }
        if !self.round.is_empty() {
            return Some(now);
        }
        self.setpoints.as_ref()?;
        Some(self.round_began.map_or(now, |began| {
            let second = Duration::from_secs(1);
            let gap = self.round_took.saturating_mul(ROUND_SHARE);
            began.plus(gap.clamp(second / SETPOINT_HZ_MAX, second / SETPOINT_HZ_SLOW))
        }))
    }

    /// True if the next write is due and begins a round of setpoints.
    pub(crate) fn begins_round(&self, now: Moment) -> bool {
        let is_due = self.next_send(now).is_some_and(|at| at <= now);
        let may_begin = self.round.is_empty() && !self.pose_due && self.rounds < ROUNDS_MAX;
        is_due && may_begin && self.hold.is_none() && self.setpoints.is_some()
    }

    /// The next setpoint write, if one is due: speed before force before angle, so that no motion
    /// starts with older limits.
    pub(crate) fn next_write(&mut self, now: Moment) -> Option<RegisterWrite> {
        if self.next_send(now)? > now {
            return None;
        }
        if self.round.is_empty() {
            if self.pose_due || self.rounds >= ROUNDS_MAX {
                return None;
            }
            let setpoints = self.setpoints.take()?;
            self.round_began = Some(now);
            self.round_took = Duration::ZERO;
            self.pose_due = true;
            self.rounds = self.rounds.saturating_add(1);
            self.round = round(&setpoints);
        }
        self.round.pop_at(0)
    }

    /// Adds the time that a write of the round took.
    pub(crate) const fn add_write_time(&mut self, took: Duration) {
        self.round_took = self.round_took.saturating_add(took);
    }

    /// True if the next round waits only for the pose to be read.
    pub(crate) fn waits_for_pose(&self, now: Moment) -> bool {
        self.pose_due && self.waits(now)
    }

    /// True if the next round waits only for another read.
    pub(crate) fn waits_for_others(&self, now: Moment) -> bool {
        !self.pose_due && self.rounds >= ROUNDS_MAX && self.waits(now)
    }

    /// True if requests may be served: not while a stop is being confirmed, but while its alarm lasts, and not before
    /// the read that the next round waits for.
    pub(crate) fn lets_jobs(&self, now: Moment) -> bool {
        match &self.hold {
            Some(hold) => hold.alarmed,
            None => !self.waits_for_pose(now) && !self.waits_for_others(now),
        }
    }

    fn waits(&self, now: Moment) -> bool {
        self.round.is_empty() && self.next_send(now).is_some_and(|send| send <= now)
    }

    /// Records that something was requested, answered or not.
    pub(crate) const fn note_request(&mut self, is_pose: bool) {
        if is_pose {
            self.pose_due = false;
            self.waits_for_read = false;
        } else {
            self.rounds = 0;
        }
    }

    /// Records that only the pose is polled: rounds need not wait.
    pub(crate) const fn nothing_else(&mut self) {
        self.rounds = 0;
    }

    /// Queues an unacknowledged write again, unless a newer one replaced it.
    pub(crate) fn again(&mut self, write: RegisterWrite) {
        if !self.round.is_full() {
            self.round.insert(0, write);
        }
    }
}

fn round(setpoints: &Setpoints) -> ArrayVec<RegisterWrite, ROUND_MAX> {
    let mut round = ArrayVec::new();
    for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
        let _full = round.try_push(write);
    }
    round
}

/// The targets that hold the present pose: the actual angles if they are fresh, otherwise "no action" for all joints,
/// because an old pose would be a move.
pub(crate) fn hold_targets(sample: &HandSample, now: Moment) -> PerDof<Target> {
    if sample.angles_fresh(now, ANGLE_FRESH) {
        sample.hold_targets()
    } else {
        PerDof::splat(Target::Leave)
    }
}

/// Reason why a hand in this state and with these readings must not be armed; `None` if it may be armed, or is.
pub fn arm_refusal(state: LinkState, sample: &HandSample, now: Moment) -> Option<ArmRefusal> {
    match state {
        LinkState::Offline | LinkState::Identifying => return Some(ArmRefusal::Offline),
        LinkState::Holding => return Some(ArmRefusal::Holding),
        LinkState::Fault => return Some(ArmRefusal::Fault),
        LinkState::Armed => return None,
        LinkState::Monitoring => {}
    }
    if sample.faults.is_none() {
        return Some(ArmRefusal::NotRead);
    }
    let angle = sample
        .angle
        .filter(|angle: &Timed<_>| angle.age(now) <= ANGLE_FRESH);
    let Some(angle) = angle else {
        return Some(ArmRefusal::NotRead);
    };
    Dof::ALL
        .into_iter()
        .find(|dof| angle.value[*dof].hold().is_none())
        .map(|dof| ArmRefusal::UnknownPose { dof })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, AngleReading, Faults, Force, Speed};

    fn sample(angle: i16, at: Moment) -> HandSample {
        HandSample {
            angle: Some(Timed {
                value: PerDof::splat(AngleReading::new(angle)),
                asked: at,
                received: at,
            }),
            faults: Some(Timed {
                value: PerDof::splat(Faults::default()),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        }
    }

    #[test]
    fn only_a_fresh_and_sensible_pose_can_be_armed() {
        let at = Moment::from_micros(1_000_000);
        let late = at.plus(ANGLE_FRESH + Duration::from_millis(1));
        let check = |state, sample: HandSample, now| arm_refusal(state, &sample, now);
        assert_eq!(check(LinkState::Monitoring, sample(500, at), at), None);
        let unread = Some(ArmRefusal::NotRead);
        assert_eq!(check(LinkState::Monitoring, sample(500, at), late), unread);
        let mut senseless = sample(500, at);
        let readings = &mut senseless.angle.as_mut().unwrap().value;
        readings[Dof::Middle] = AngleReading::new(-200);
        let unknown = Some(ArmRefusal::UnknownPose { dof: Dof::Middle });
        assert_eq!(check(LinkState::Monitoring, senseless, at), unknown);
        assert_eq!(
            check(LinkState::Monitoring, HandSample::default(), at),
            unread
        );
        assert_eq!(
            check(LinkState::Fault, sample(500, at), at),
            Some(ArmRefusal::Fault)
        );
        assert_eq!(
            check(LinkState::Holding, sample(500, at), at),
            Some(ArmRefusal::Holding)
        );
        assert_eq!(
            check(LinkState::Offline, sample(500, at), at),
            Some(ArmRefusal::Offline)
        );
    }

    #[test]
    fn an_old_pose_is_never_held_to() {
        let at = Moment::from_micros(1_000_000);
        let go = PerDof::splat(Target::Go(Angle::nearest(420)));
        assert_eq!(hold_targets(&sample(420, at), at), go);
        let old = hold_targets(&sample(420, at), at.plus(Duration::from_secs(1)));
        assert_eq!(old, PerDof::splat(Target::Leave));
    }

    #[test]
    fn limits_go_before_angles_and_rounds_keep_their_distance() {
        let epoch = ArmEpoch(3);
        let mut motion = Motion::default();
        let mut wish = Setpoints::none(epoch);
        wish.angle[Dof::Index] = Some(Target::Go(Angle::MIN));
        wish.force[Dof::Index] = Some(Force::GENTLE);
        wish.speed[Dof::Index] = Some(Speed::GENTLE);
        motion.merge_setpoints(&wish, Some(epoch));
        let now = Moment::from_micros(10);
        let sent: Vec<_> = std::iter::from_fn(|| motion.next_write(now))
            .map(|write| write.address())
            .collect();
        assert_eq!(sent, [1528, 1504, 1492]);
        motion.note_request(true);
        motion.merge_setpoints(&wish, Some(epoch));
        assert_eq!(motion.next_write(now.plus(Duration::from_millis(4))), None);
        assert!(
            motion
                .next_write(now.plus(Duration::from_millis(5)))
                .is_some()
        );
    }

    #[test]
    fn rounds_leave_a_slow_line_to_what_is_read() {
        let epoch = ArmEpoch(1);
        for (took, next) in [(0, 5), (1, 5), (3, 12), (40, 20)] {
            let mut motion = Motion::default();
            let mut wish = Setpoints::none(epoch);
            wish.angle[Dof::Index] = Some(Target::Go(Angle::MIN));
            motion.merge_setpoints(&wish, Some(epoch));
            assert!(motion.next_write(Moment::ZERO).is_some());
            motion.add_write_time(Duration::from_millis(took));
            motion.merge_setpoints(&wish, Some(epoch));
            let due = motion.next_send(Moment::ZERO);
            assert_eq!(due, Some(Moment::from_micros(next * 1000)), "{took}");
        }
    }

    #[test]
    fn a_round_waits_for_a_look_at_the_pose_after_the_one_before() {
        let epoch = ArmEpoch(1);
        let mut motion = Motion::default();
        let mut wish = Setpoints::none(epoch);
        wish.angle[Dof::Index] = Some(Target::Go(Angle::MIN));
        motion.merge_setpoints(&wish, Some(epoch));
        assert!(motion.next_write(Moment::ZERO).is_some());
        motion.merge_setpoints(&wish, Some(epoch));
        let later = Moment::from_micros(100_000);
        assert!(motion.waits_for_pose(later) && motion.next_write(later).is_none());
        motion.note_request(true);
        assert!(!motion.waits_for_pose(later) && motion.next_write(later).is_some());
    }

    #[test]
    fn setpoints_of_another_arming_are_dropped() {
        let mut motion = Motion::default();
        let mut wish = Setpoints::none(ArmEpoch(1));
        wish.angle[Dof::Index] = Some(Target::Go(Angle::MIN));
        motion.merge_setpoints(&wish, Some(ArmEpoch(2)));
        motion.merge_setpoints(&wish, None);
        assert_eq!(motion.next_send(Moment::ZERO), None);
    }
}
