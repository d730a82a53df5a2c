//! Joints that move away from an action that stands still: something moves them that the recording does not show.

use crate::hand::PerDof;
use crate::record::export::frames::DatasetFrame;

/// Time in seconds after which a joint no longer follows the previous action by its own inertia and delay.
const STILL_S: f32 = 1.0;
/// Distance that a joint at rest does not move by itself, as a share of its range.
const MOVED: f32 = 0.1;

/// One joint in an episode.
#[derive(Debug, Clone, Copy, Default)]
struct Joint {
    action: f32,
    /// Time of the first frame with this action, in seconds.
    since_s: f32,
    /// Smallest distance from the action, since it stands still.
    nearest: Option<f32>,
}

/// Follows the frames of a data set.
#[derive(Debug, Clone)]
pub(crate) struct UnfollowedMotion {
    six: PerDof<Joint>,
    /// True for each joint that moved so in any frame.
    pub(crate) joints: PerDof<bool>,
}

impl UnfollowedMotion {
    pub(crate) fn new() -> Self {
        Self {
            six: PerDof::splat(Joint::default()),
            joints: PerDof::splat(false),
        }
    }

    /// Applies the next frame. Returns true if a joint in it has moved away from its action.
    pub(crate) fn apply(&mut self, frame: &DatasetFrame) -> bool {
        let values = frame.state.iter().zip(&frame.action);
        let joints = self.six.iter_mut().zip(self.joints.iter_mut());
        let mut has_moved = false;
        for (((_, joint), (_, moved)), (state, action)) in joints.zip(values) {
            #[expect(clippy::float_cmp, reason = "a target that was not changed is equal")]
            if frame.number == 0 || joint.action != *action {
                *joint = Joint {
                    action: *action,
                    since_s: frame.time_s,
                    nearest: None,
                };
            }
            if frame.time_s - joint.since_s <= STILL_S {
                continue;
            }
            let distance = (state - action).abs();
            let nearest = joint.nearest.map_or(distance, |least| least.min(distance));
            joint.nearest = Some(nearest);
            if distance - nearest > MOVED {
                (*moved, has_moved) = (true, true);
            }
        }
        has_moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Dof;
    use std::iter::{once, repeat_n};

    /// Number of frames with such motion of the index finger: its angle and action in each tenth of a second.
    fn moved(frames: impl IntoIterator<Item = (f32, f32)>) -> usize {
        let mut motion = UnfollowedMotion::new();
        let mut count = 0;
        for (number, (state, action)) in (0_u16..).zip(frames) {
            let mut frame = DatasetFrame {
                number: number.into(),
                time_s: f32::from(number) / 10.0,
                ..DatasetFrame::default()
            };
            let index = Dof::Index.index();
            (frame.state[index], frame.action[index]) = (state, action);
            count += usize::from(motion.apply(&frame));
        }
        let index = motion.joints.iter().filter(|(_, moved)| **moved);
        assert!(index.eq(once((Dof::Index, &true)).filter(|_| count > 0)));
        count
    }

    /// From one value to another in twenty steps.
    fn ramp(from: f32, to: f32) -> impl Iterator<Item = f32> + Clone {
        (0..20_u8).map(move |step| from + (to - from) * f32::from(step) / 20.0)
    }

    #[test]
    fn a_joint_that_leaves_an_action_that_stands_still_is_counted() {
        let still = || repeat_n((1.0, 1.0), 20);
        assert_eq!(moved(still()), 0);
        let closed = still().chain(ramp(1.0, 0.1).map(|state| (state, 1.0)));
        assert_eq!(moved(closed.clone()), 17);
        // It goes back, as a hand that grasps by itself does.
        let back = ramp(0.1, 1.0).map(|state| (state, 1.0));
        assert_eq!(moved(closed.chain(back)), 35);
    }

    #[test]
    fn a_joint_that_follows_is_not_counted() {
        let still = || repeat_n((1.0, 1.0), 20);
        // To a target sent at once, slowly.
        assert_eq!(
            moved(still().chain(ramp(1.0, 0.0).map(|state| (state, 0.0)))),
            0
        );
        // To one that moves ahead of it.
        let led = ramp(1.0, 0.0).map(|state| (state, state - 0.2));
        assert_eq!(moved(still().chain(led)), 0);
        // On its way to the previous target, by inertia.
        let turned = still().chain(repeat_n((0.5, 0.0), 5));
        let turned = turned.chain(ramp(0.5, 0.2).take(5).map(|state| (state, 1.0)));
        assert_eq!(
            moved(turned.chain(ramp(0.4, 1.0).map(|state| (state, 1.0)))),
            0
        );
        // Stopped by an object before its target.
        assert_eq!(moved(still().chain(repeat_n((0.6, 0.0), 40))), 0);
    }
}
