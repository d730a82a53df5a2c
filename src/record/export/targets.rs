//! The targets of the joints over time: as they were sent, when they were sent. Only a target that nobody sent in the recording is
//! what the hand held when it was asked.

use crate::hand::{Dof, Moment, PerDof, Target, Timed};
use crate::record::WrittenMemory;
use std::time::Duration;

/// A write may act so late: what is read until then may be of before it.
const ACT_DELAY: Duration = Duration::from_secs(2);
/// Registers by which the hand is told a gesture: it then sets targets of its own.
const GESTURES: [u16; 3] = [1008, 2320, 2322];

/// Who set the target of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TargetOrigin {
    /// The hand held it when it was read first, and since.
    Held,
    /// A write in the recording.
    Sent,
    /// Something else, while it was recorded: another controller, or the hand itself for a gesture.
    ReadBack,
}

/// The target of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct JointTarget {
    angle: i16,
    origin: TargetOrigin,
    /// Read once as another: one reading may be wrong, two are not.
    doubted: bool,
}

/// The targets of six joints; `None` for a joint that was only ever left alone.
type Six = PerDof<Option<JointTarget>>;

/// What the joints were told last.
#[derive(Debug, Clone)]
pub(crate) struct CommandedTargets {
    six: Six,
    sent: Option<Moment>,
    /// The number of the last write, and what held before it.
    before: Option<(u64, Six)>,
}

impl CommandedTargets {
    /// Nothing is known.
    pub(crate) const UNKNOWN: Self = Self {
        six: PerDof::splat(None),
        sent: None,
        before: None,
    };

    /// The target of a joint; `None` if it was only ever left alone.
    pub(crate) fn angle(&self, dof: Dof) -> Option<i16> {
        self.six[dof].map(|target| target.angle)
    }

    /// True if each joint has the target that it was sent; then nothing needs to be read.
    pub(crate) fn are_sent(&self) -> bool {
        let is_sent = |target: &JointTarget| target.origin == TargetOrigin::Sent;
        self.six
            .iter()
            .all(|(_, target)| target.as_ref().is_some_and(is_sent))
    }

    /// True if a target was set by something else than the writes of the recording.
    pub(crate) fn are_read_back(&self) -> bool {
        let is_read = |target: &JointTarget| target.origin == TargetOrigin::ReadBack;
        self.six
            .iter()
            .any(|(_, target)| target.as_ref().is_some_and(is_read))
    }

    /// A write left for the hand. A joint that it leaves alone keeps its target.
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

    /// The hand refused a write: it told the joints nothing.
    pub(crate) fn refused(&mut self, number: u64) {
        if let Some((_, before)) = self.before.take_if(|(last, _)| *last == number) {
            self.six = before;
        }
    }

    /// What the hand holds was read.
    pub(crate) fn read(&mut self, held: Timed<PerDof<Option<Target>>>) {
        let may_be_old = self.sent.is_some_and(|at| held.asked.since(at) < ACT_DELAY);
        for (dof, target) in held.value.iter() {
            // -1 leaves a joint alone: what it was told before holds on.
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

    /// What happens to the index finger.
    enum Step {
        /// Sent at so many milliseconds, with a number; -1 leaves it alone.
        Sent(u64, u64, i16),
        Gesture(u64),
        Refused(u64),
        /// Read at so many milliseconds.
        Read(u64, i16),
    }

    fn target(raw: i16) -> Target {
        Angle::new(raw).map_or(Target::Leave, Target::Go)
    }

    /// The index finger's target, and whether it is from elsewhere.
    fn after(steps: &[Step]) -> (Option<i16>, bool) {
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
        (targets.angle(Dof::Index), targets.are_read_back())
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
