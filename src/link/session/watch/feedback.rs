//! Whether feedback lives, and where the joints must be if it does not. Pure; what follows from it is the session's.
//!
//! A hand that moves changes something in angle, force, current or touch at each look. Where the joints must have moved visibly
//! by what they were told, and nothing at all changes, frames may be valid and their values old all the same.

use crate::hand::{Angle, AngleReading, Dof, Finger, Group, Groups, HandSample, Moment, PerDof};
use crate::hand::{RegisterWrite, Speed, Status, Target, register};
use std::collections::VecDeque;
use std::time::Duration;

/// Feedback that stands still for so long, counted from where motion should have been seen, is in doubt: about half a second from
/// the last change or the command.
pub(crate) const FROZEN_AFTER: Duration = Duration::from_millis(450);
/// Looks at the angles in this time at least: a pause in reading says nothing.
const LOOKS_MIN: u32 = 5;
/// Looks after which a stop already counts on nothing that is read.
const LOOKS_SUSPECT: u32 = 2;
/// So many counts of ANGLE_ACT are a visible move: more than noise, and more than a joint may rest beside its target.
const VISIBLE: f64 = 25.0;
/// From a command to the motion (measured: 64 +- 8 ms).
const DEAD_TIME: Duration = Duration::from_millis(64);
/// Commands that are remembered: more than setpoint rounds fit into the time after which feedback is in doubt.
const COMMANDS_MAX: usize = 512;

/// What the joints were told, from one moment on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Command {
    at: Moment,
    targets: PerDof<Option<i16>>,
    speeds: PerDof<Option<i16>>,
}

/// Where the joints were when feedback was last seen to live.
#[derive(Debug, Clone, Copy)]
struct Base {
    at: Moment,
    angles: PerDof<i16>,
}

/// Watches feedback of one conversation.
#[derive(Debug, Default)]
pub(crate) struct FeedbackWatch {
    last: HandSample,
    base: Option<Base>,
    /// Oldest first; the first is in force at the base.
    commands: VecDeque<Command>,
    speeds_written: Option<Moment>,
    /// The first look that should have shown motion and did not, the newest one, and how many there were.
    still: Option<(Moment, Moment, u32)>,
    /// What is read counts for nothing until it changes.
    doubted: bool,
}

impl FeedbackWatch {
    /// We write this, or may have. A joint that is left alone goes where it was told before.
    pub(crate) fn wrote(&mut self, write: &RegisterWrite, now: Moment) {
        let within = |row: &register::Register| row.span().covers(write.span());
        if within(&register::ANGLE_SET) {
            let targets = write.shorts(&register::ANGLE_SET);
            let targets = targets.map(|target| target.filter(|target| *target >= 0));
            self.tell(now, |command| put(&mut command.targets, &targets));
        } else if within(&register::SPEED_SET) {
            self.speeds_written = Some(now);
            let speeds = write.shorts(&register::SPEED_SET);
            self.tell(now, |command| put(&mut command.speeds, &speeds));
        } else if write.is_motion() {
            // A gesture: the hand may go anywhere.
            self.tell(now, |command| command.targets = PerDof::splat(None));
        }
    }

    fn tell(&mut self, at: Moment, change: impl FnOnce(&mut Command)) {
        let before = self.commands.back().copied();
        let mut command = Command {
            at,
            targets: before.map_or(PerDof::splat(None), |command| command.targets),
            speeds: before.map_or(PerDof::splat(None), |command| command.speeds),
        };
        change(&mut command);
        let told = |command: Command| (command.targets, command.speeds);
        if before.map(told) == Some(told(command)) {
            return;
        }
        if self.commands.len() == COMMANDS_MAX {
            self.commands.pop_front();
        }
        self.commands.push_back(command);
    }

    /// Takes what was read.
    pub(crate) fn take(&mut self, sample: &HandSample, fresh: Groups) {
        self.take_speeds(sample, fresh);
        let before = std::mem::replace(&mut self.last, *sample);
        if has_changed(&before, sample, fresh) {
            self.still = None;
            self.doubted = false;
            self.base = base(sample);
            self.forget_old();
            return;
        }
        let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) else {
            return;
        };
        if self.base.is_none() {
            self.base = base(sample);
        }
        let should_move = |dof: &Dof| {
            let Some(reckoned) = self.reckoned(*dof, angle.asked) else {
                return false;
            };
            let way = reckoned - f64::from(angle.value[*dof].raw());
            way.abs() >= VISIBLE && !(way < 0.0 && is_blocked(sample, *dof))
        };
        if self.still.is_some() || Dof::ALL.iter().any(should_move) {
            let (since, _, looks) = self.still.unwrap_or((angle.asked, angle.asked, 0));
            self.still = Some((since, angle.asked, looks.saturating_add(1)));
        }
    }

    /// Speeds that somebody else set, or that were never written here.
    fn take_speeds(&mut self, sample: &HandSample, fresh: Groups) {
        let Some(speeds) = sample.speed_set.filter(|_| fresh.contains(Group::SpeedSet)) else {
            return;
        };
        let ours = self.speeds_written;
        if ours.is_none_or(|at| speeds.asked.since(at) >= Duration::from_secs(1)) {
            let read = speeds.value.map(|speed| speed.map(Speed::get));
            self.tell(speeds.asked, |command| put(&mut command.speeds, &read));
        }
    }

    fn forget_old(&mut self) {
        let Some(base) = self.base else { return };
        while let Some(second) = self.commands.get(1)
            && second.at.plus(DEAD_TIME) <= base.at
        {
            self.commands.pop_front();
        }
    }

    /// True if motion was asked for, and nothing changed for so long that feedback must be taken for frozen.
    pub(crate) fn is_frozen(&self) -> bool {
        self.still.is_some_and(|(since, last, looks)| {
            looks >= LOOKS_MIN && last.since(since) >= FROZEN_AFTER
        })
    }

    /// True if motion should have been seen and was not: no proof yet, but a stop must not count on what is read.
    pub(crate) fn is_suspect(&self) -> bool {
        self.still
            .is_some_and(|(_, _, looks)| looks >= LOOKS_SUSPECT)
    }

    /// From now on, until something changes, what is read counts for nothing.
    pub(crate) const fn doubt(&mut self) {
        self.doubted = true;
    }

    pub(crate) const fn is_doubted(&self) -> bool {
        self.doubted
    }

    /// The targets that hold the joints where they must be at this time; a joint of which that is not known is left alone.
    pub(crate) fn hold_targets(&self, now: Moment) -> PerDof<Target> {
        PerDof::from_fn(|dof| {
            self.reckoned(dof, now)
                .map_or(Target::Leave, |angle| Target::Go(nearest(angle)))
        })
    }

    /// Where a joint must be: from where it was last seen on to what it was told, as fast as it was told, and never beyond.
    fn reckoned(&self, dof: Dof, now: Moment) -> Option<f64> {
        let base = self.base?;
        let mut angle = f64::from(base.angles[dof]);
        let begins = self
            .commands
            .iter()
            .map(|command| command.at.plus(DEAD_TIME));
        let ends = begins.clone().skip(1).chain([now]);
        for ((command, begin), end) in self.commands.iter().zip(begins).zip(ends) {
            let (Some(target), Some(speed)) = (command.targets[dof], command.speeds[dof]) else {
                continue;
            };
            let lasts = end.min(now).since(begin.max(base.at)).as_secs_f64();
            let most = f64::from(speed) * Speed::ANGLE_PER_UNIT * lasts;
            angle += (f64::from(target) - angle).clamp(-most, most);
        }
        Some(angle)
    }
}

fn put(into: &mut PerDof<Option<i16>>, newer: &PerDof<Option<i16>>) {
    for (dof, value) in newer.iter() {
        if value.is_some() {
            into[dof] = *value;
        }
    }
}

/// The joints as they were read, if all of that makes sense.
fn base(sample: &HandSample) -> Option<Base> {
    let angle = sample.angle?;
    let is_sensible = Dof::ALL
        .iter()
        .all(|dof| angle.value[*dof].hold().is_some());
    is_sensible.then(|| Base {
        at: angle.asked,
        angles: angle.value.map(AngleReading::raw),
    })
}

/// True if any measured value differs from the one before, or is the first.
fn has_changed(before: &HandSample, now: &HandSample, fresh: Groups) -> bool {
    let differs = |group: Group| fresh.contains(group) && before.memory(group) != now.memory(group);
    let measured = [Group::Angle, Group::Force, Group::Current].into_iter();
    let touch = Finger::ALL.map(Group::Tactile);
    measured.chain(touch).any(differs)
}

/// True if the drive itself says why it does not close further.
fn is_blocked(sample: &HandSample, dof: Dof) -> bool {
    let stopped = |status: Status| {
        matches!(
            status,
            Status::ForceReached | Status::CurrentProtection | Status::Stalled | Status::DriveFault
        )
    };
    sample
        .status
        .is_some_and(|status| stopped(status.value[dof]))
}

fn nearest(angle: f64) -> Angle {
    #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
    let counts = angle.round() as i16;
    Angle::nearest(counts)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::{AngleReading, ForceReading, HandCommand, Timed};

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    /// A hand without any noise: what it tells at a time.
    #[derive(Clone, Copy)]
    struct Told {
        angle: i16,
        force: i16,
        status: u8,
    }

    /// What a hand is told, what it tells, and when that is in doubt, ms from the command.
    struct Case {
        name: &'static str,
        speed: i16,
        target: Target,
        tells: fn(u64) -> Told,
        frozen: Option<std::ops::Range<u64>>,
    }

    fn at(angle: i16, status: u8) -> Told {
        Told {
            angle,
            force: 0,
            status,
        }
    }

    fn sample(told: Told, now: Moment) -> (HandSample, Groups) {
        fn timed<T>(value: T, now: Moment) -> Option<Timed<PerDof<T>>>
        where
            T: Copy,
        {
            Some(Timed {
                value: PerDof::splat(value),
                asked: now,
                received: now,
            })
        }
        let sample = HandSample {
            angle: timed(AngleReading::new(told.angle), now),
            force: timed(ForceReading::new(told.force), now),
            status: timed(Status::from_raw(told.status), now),
            ..HandSample::default()
        };
        let groups = [Group::Angle, Group::Force, Group::Status];
        (sample, groups.into_iter().collect())
    }

    fn watch(speed: i16, target: Target) -> FeedbackWatch {
        let mut watch = FeedbackWatch::default();
        let (first, fresh) = sample(at(1000, 2), ms(0));
        watch.take(&first, fresh);
        let speeds = HandCommand::Speeds(PerDof::splat(Some(Speed::nearest(speed))));
        let angles = HandCommand::Angles(PerDof::splat(target));
        for command in [speeds, angles] {
            watch.wrote(&command.writes()[0], ms(0));
        }
        watch
    }

    fn go(angle: i16) -> Target {
        Target::Go(Angle::nearest(angle))
    }

    /// Where a joint is at speed 250, in thousandths of a second.
    fn moving(t: u64) -> i16 {
        let way = i16::try_from(t.saturating_sub(64) * 400 / 1000).unwrap();
        (1000 - way).max(0)
    }

    #[test]
    fn only_feedback_that_stands_still_where_motion_was_asked_for_is_in_doubt() {
        let cases = [
            Case {
                name: "moves",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t), 1),
                frozen: None,
            },
            Case {
                name: "freezes before it moves",
                speed: 250,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: Some(500..650),
            },
            Case {
                name: "freezes in motion",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t.min(300)), 1),
                frozen: Some(740..860),
            },
            Case {
                name: "rests: it is where it was told to be",
                speed: 1000,
                target: go(1000),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "a few counts beside its target",
                speed: 1000,
                target: go(980),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "left alone",
                speed: 1000,
                target: Target::Leave,
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "does not move at speed 0",
                speed: 0,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "creeps at speed 1, one count in 0.6 s",
                speed: 1,
                target: go(0),
                tells: |t| at(1000 - i16::try_from(t / 600).unwrap(), 1),
                frozen: None,
            },
            Case {
                name: "stands at speed 10: asked for longer than at full speed",
                speed: 10,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: Some(2000..2400),
            },
            Case {
                name: "stopped by its force threshold",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t.min(500)), if t < 500 { 1 } else { 3 }),
                frozen: None,
            },
            Case {
                name: "pushes: only its force changes",
                speed: 250,
                target: go(0),
                tells: |t| Told {
                    force: i16::try_from(t / 100 % 3).unwrap(),
                    ..at(1000, 1)
                },
                frozen: None,
            },
        ];
        for case in cases {
            let mut watch = watch(case.speed, case.target);
            let seen = (10..5000).step_by(10).find(|t| {
                let (sample, fresh) = sample((case.tells)(*t), ms(*t));
                watch.take(&sample, fresh);
                watch.is_frozen()
            });
            let is_right = match (&case.frozen, seen) {
                (Some(range), Some(at)) => range.contains(&at),
                (None, None) => true,
                _ => false,
            };
            assert!(is_right, "{}: {seen:?}", case.name);
        }
    }

    #[test]
    fn a_pause_in_reading_is_no_frozen_feedback() {
        let mut watch = watch(250, go(0));
        for t in [100, 900, 1700] {
            let (sample, fresh) = sample(at(1000, 2), ms(t));
            watch.take(&sample, fresh);
            assert!(!watch.is_frozen());
        }
    }

    #[test]
    fn the_joints_are_reckoned_from_where_they_were_seen_to_what_they_were_told_and_not_beyond() {
        let mut watch = watch(500, go(200));
        let held = |watch: &FeedbackWatch, t| watch.hold_targets(ms(t))[Dof::Index];
        assert_eq!(held(&watch, 64), go(1000));
        // 760 counts a second after the dead time.
        assert_eq!(held(&watch, 564), go(620));
        assert_eq!(held(&watch, 3000), go(200));
        let (seen, fresh) = sample(at(900, 1), ms(200));
        watch.take(&seen, fresh);
        assert_eq!(held(&watch, 300), go(824));
        // The hold acts late too.
        let hold = HandCommand::Angles(PerDof::splat(go(824)));
        watch.wrote(&hold.writes()[0], ms(300));
        assert_eq!(held(&watch, 364), go(775));
        assert_eq!(held(&watch, 1000), go(824));
        let nothing = FeedbackWatch::default();
        assert_eq!(nothing.hold_targets(ms(5))[Dof::Index], Target::Leave);
    }
}
