//! The targets of the joints over time: as sent, when sent. Only a target that the recording did not send is taken from the
//! hand's read-back.

use crate::hand::{Dof, Moment, PerDof, Target, Timed};
use crate::record::WrittenMemory;
use std::time::Duration;

/// Maximum time until a write takes effect: values read before then may be older than the write.
const ACT_DELAY: Duration = Duration::from_secs(2);
/// Registers that start a gesture: the hand then sets its own targets.
const GESTURES: [u16; 3] = [1008, 2320, 2322];

/// Origin of a joint's target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TargetOrigin {
    /// The hand's target at the first read, unchanged since.
    Held,
    /// A write in the recording.
    Sent,
    /// Set during the recording by another controller, or by the hand itself for a gesture.
    ReadBack,
}

/// The target of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct JointTarget {
    angle: i16,
    origin: TargetOrigin,
    /// True after one deviating read-back: one reading may be wrong, two are not.
    doubted: bool,
}

/// Targets of six joints; `None` for a joint that has had no target so far.
type Six = PerDof<Option<JointTarget>>;

/// Last targets of the joints.
#[derive(Debug, Clone)]
pub(crate) struct CommandedTargets {
    six: Six,
    sent: Option<Moment>,
    /// Number of the last write, and the targets before it.
    before: Option<(u64, Six)>,
}

impl CommandedTargets {
    pub(crate) const UNKNOWN: Self = Self {
        six: PerDof::splat(None),
        sent: None,
        before: None,
    };

    /// Target of a joint; `None` if it has had none so far.
    pub(crate) fn angle(&self, dof: Dof) -> Option<i16> {
        self.six[dof].map(|target| target.angle)
    }

    /// True if each joint has a target that was sent; then no read-back is needed.
    pub(crate) fn are_sent(&self) -> bool {
        let is_sent = |target: &JointTarget| target.origin == TargetOrigin::Sent;
        self.six
            .iter()
            .all(|(_, target)| target.as_ref().is_some_and(is_sent))
    }

    /// True if a target was set by anything other than the recorded writes.
    pub(crate) fn are_read_back(&self) -> bool {
        let is_read = |target: &JointTarget| target.origin == TargetOrigin::ReadBack;
        self.six
            .iter()
            .any(|(_, target)| target.as_ref().is_some_and(is_read))
    }

    /// True if a target of a joint was sent, or set during the recording by anything else. What the hand held at the first read is no
    /// command.
    pub(crate) fn are_commanded(&self) -> bool {
        let is_held = |target: &JointTarget| target.origin == TargetOrigin::Held;
        self.six
            .iter()
            .any(|(_, target)| target.as_ref().is_some_and(|target| !is_held(target)))
    }

    /// Applies a write that left for the hand. A joint without a value in it retains its target.
    pub(crate) fn sent(&mut self, at: Moment, number: u64, write: &WrittenMemory) {
        let before = self.six;
        for (dof, angle) in write.angle_targets().iter() {
            if let Some(angle) = angle {
                self.six[dof] = Some(JointTarget {
                    angle: angle.get(),
                    origin: TargetOrigin::Sent,
                    doubted: false,
                });
            }
        }
        if GESTURES.contains(&write.address) {
            for target in self
                .six
                .iter_mut()
                .filter_map(|(_, target)| target.as_mut())
            {
                target.origin = TargetOrigin::ReadBack;
            }
        } else if before == self.six {
            return;
        }
        self.sent = Some(at);
        self.before = Some((number, before));
    }

    /// Reverts a write that the hand refused.
    pub(crate) fn refused(&mut self, number: u64) {
        if let Some((_, before)) = self.before.take_if(|(last, _)| *last == number) {
            self.six = before;
        }
    }

    /// Applies targets read from the hand.
    pub(crate) fn read(&mut self, held: Timed<PerDof<Option<Target>>>) {
        let may_be_old = self.sent.is_some_and(|at| held.asked.since(at) < ACT_DELAY);
        for (dof, target) in held.value.iter() {
            // -1 means no new target for a joint: its last one stays in effect.
            let Some(angle) = target.and_then(Target::angle).map(|angle| angle.get()) else {
                continue;
            };
            let set = |origin| {
                Some(JointTarget {
                    angle,
                    origin,
                    doubted: false,
                })
            };
            self.six[dof] = match self.six[dof] {
                None => set(TargetOrigin::Held),
                Some(known) if known.angle == angle => set(known.origin),
                Some(known) if known.origin == TargetOrigin::Sent => match may_be_old {
                    false if known.doubted => set(TargetOrigin::ReadBack),
                    is_old => Some(JointTarget {
                        doubted: !is_old,
                        ..known
                    }),
                },
                Some(_) => set(TargetOrigin::ReadBack),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::command::HandCommand;
    use crate::hand::{Angle, Gesture, GestureRoute};

    fn millis(millis: u64) -> Moment {
        Moment::from_micros(1000 * millis)
    }

    /// An event for the index finger.
    enum Step {
        /// Time of sending in ms, write number, angle; -1 means no new target.
        Sent(u64, u64, i16),
        Gesture(u64),
        Refused(u64),
        /// Time of reading in ms, angle.
        Read(u64, i16),
    }

    fn target(raw: i16) -> Target {
        Angle::new(raw).map_or(Target::Leave, Target::Go)
    }

    /// The targets after these steps.
    fn targets(steps: &[Step]) -> CommandedTargets {
        let mut targets = CommandedTargets::UNKNOWN;
        let first = |command: HandCommand| WrittenMemory::from(command.writes().first().unwrap());
        for step in steps {
            match step {
                Step::Sent(at, number, raw) => {
                    let mut six = PerDof::splat(None);
                    six[Dof::Index] = Some(target(*raw));
                    targets.sent(millis(*at), *number, &first(HandCommand::Angles(six)));
                }
                Step::Gesture(at) => {
                    let gesture = Gesture::new(3).unwrap();
                    let command = HandCommand::Gesture(gesture, GestureRoute::default());
                    targets.sent(millis(*at), 99, &first(command));
                }
                Step::Refused(number) => targets.refused(*number),
                Step::Read(at, raw) => {
                    let mut value = PerDof::splat(Some(Target::Leave));
                    value[Dof::Index] = Some(target(*raw));
                    targets.read(Timed {
                        value,
                        asked: millis(*at),
                        received: millis(at + 5),
                    });
                }
            }
        }
        targets
    }

    /// The index finger's target, and whether it is from elsewhere.
    fn after(steps: &[Step]) -> (Option<i16>, bool) {
        let targets = targets(steps);
        (targets.angle(Dof::Index), targets.are_read_back())
    }

    #[test]
    fn what_a_hand_held_at_the_first_read_is_no_command() {
        use Step::{Gesture, Read, Refused, Sent};
        for (steps, wanted) in [
            (&[][..], false),
            (&[Read(0, 700), Read(500, 700)], false),
            (&[Read(0, 700), Sent(10, 1, 300), Refused(1)], false),
            (&[Read(0, 700), Sent(10, 1, -1)], false),
            (&[Sent(0, 1, 700)], true),
            (&[Read(0, 700), Read(500, 650)], true),
            (&[Read(0, 700), Gesture(100)], true),
        ] {
            assert_eq!(targets(steps).are_commanded(), wanted);
        }
    }

    #[test]
    fn a_target_is_what_was_sent_and_read_back_only_where_nobody_sent_it() {
        use Step::{Gesture, Read, Refused, Sent};
        for (what, steps, wanted) in [
            ("nothing", &[][..], (None, false)),
            (
                "held since before",
                &[Read(0, 700), Read(500, 700)],
                (Some(700), false),
            ),
            ("held by -1", &[Read(0, -1)], (None, false)),
            (
                "sent",
                &[Read(0, 700), Sent(10, 1, 300)],
                (Some(300), false),
            ),
            (
                "left alone",
                &[Sent(0, 1, 300), Sent(10, 2, -1)],
                (Some(300), false),
            ),
            (
                "left alone, read as -1",
                &[Sent(0, 1, 300), Read(9000, -1)],
                (Some(300), false),
            ),
            (
                "an old reading",
                &[Sent(0, 1, 300), Read(400, 700), Read(900, 700)],
                (Some(300), false),
            ),
            (
                "one wrong reading",
                &[Sent(0, 1, 300), Read(5000, 9), Read(5500, 300)],
                (Some(300), false),
            ),
            (
                "another's, read twice",
                &[Sent(0, 1, 300), Read(5000, 9), Read(5500, 9)],
                (Some(9), true),
            ),
            (
                "another's from the start",
                &[Read(0, 700), Read(500, 650)],
                (Some(650), true),
            ),
            (
                "another's, then ours",
                &[
                    Read(0, 700),
                    Read(500, 650),
                    Read(600, 650),
                    Sent(700, 1, 20),
                ],
                (Some(20), false),
            ),
            (
                "refused",
                &[Read(0, 700), Sent(10, 1, 300), Refused(1)],
                (Some(700), false),
            ),
            (
                "another refused",
                &[Sent(0, 1, 300), Sent(10, 2, 200), Refused(1)],
                (Some(200), false),
            ),
            (
                "a gesture",
                &[Sent(0, 1, 300), Gesture(100), Read(600, 880)],
                (Some(880), true),
            ),
            ("zero", &[Sent(0, 1, 0)], (Some(0), false)),
        ] {
            assert_eq!(after(steps), wanted, "{what}");
        }
    }
}
