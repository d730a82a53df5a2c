//! Frames of the hand's links as messages of ROS 2's tf.

use crate::hand::kinematics::Side;
use crate::hand::model::frames::{FrameTree, LinkFrame};
use crate::hand::{Moment, PerDof};
use crate::record::file::format::message::{Header, TfMessage, Time, Transform, TransformStamped};
use std::time::Duration;

/// Interval of frames in a file while joints move: at each reading they would be as large as everything else.
const FILE_INTERVAL: Duration = Duration::from_millis(100);
/// Interval of frames in a file while no angle changes.
const REST_INTERVAL: Duration = Duration::from_secs(1);

/// How often frames are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FramePace {
    /// Ten times a second where an angle changes, else once a second.
    File,
    /// With each reading of the angles.
    Live,
}

/// Frames of a hand over time.
#[derive(Debug)]
pub(crate) struct FrameFollower {
    tree: FrameTree,
    pace: FramePace,
    /// Time and angles of the last message.
    last: Option<(Moment, PerDof<Option<i16>>)>,
}

impl FrameFollower {
    pub(crate) fn new(side: Side, pace: FramePace) -> Self {
        Self {
            tree: FrameTree::new(side),
            pace,
            last: None,
        }
    }

    /// Frames at newly read angles, with this stamp; `None` if no message is due or no angle is known.
    pub(crate) fn apply(
        &mut self,
        at: Moment,
        angles: PerDof<Option<i16>>,
        stamp: Time,
    ) -> Option<TfMessage> {
        if self.pace == FramePace::File
            && let Some((before, known)) = self.last
        {
            let interval = if known == angles {
                REST_INTERVAL
            } else {
                FILE_INTERVAL
            };
            if at.since(before) < interval {
                return None;
            }
        }
        let frames = self.tree.at(&angles);
        if frames.is_empty() {
            return None;
        }
        self.last = Some((at, angles));
        Some(message(&frames, stamp))
    }

    /// Frames that never move.
    pub(crate) fn fixed(&self, stamp: Time) -> TfMessage {
        message(self.tree.fixed(), stamp)
    }
}

fn message(frames: &[LinkFrame], stamp: Time) -> TfMessage {
    let frame = |frame: &LinkFrame| TransformStamped {
        header: Header {
            stamp,
            frame_id: frame.parent.clone(),
        },
        child_frame_id: frame.child.clone(),
        transform: Transform {
            translation: frame.at_m,
            rotation: frame.turn,
        },
    };
    TfMessage {
        transforms: frames.iter().map(frame).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    #[test]
    fn a_file_has_ten_a_second_of_a_moving_hand_and_one_of_a_resting_one() {
        let count = |pace, angle: fn(u64) -> i16| {
            let mut follower = FrameFollower::new(Side::Right, pace);
            let angles = |nth: u64| PerDof::splat(Some(angle(nth)));
            let messages = (0..1000)
                .filter_map(|nth| follower.apply(ms(nth * 10), angles(nth), Time::default()));
            messages.count()
        };
        let moving = |nth| i16::try_from(nth).unwrap_or_default();
        assert_eq!(count(FramePace::File, moving), 100);
        assert_eq!(count(FramePace::File, |_| 400), 10);
        assert_eq!(count(FramePace::Live, |_| 400), 1000);
    }

    #[test]
    fn a_hand_without_a_known_angle_has_no_frames() {
        let mut follower = FrameFollower::new(Side::Right, FramePace::File);
        let none = PerDof::splat(None);
        assert_eq!(follower.apply(ms(0), none, Time::default()), None);
        let mut one = none;
        one[crate::hand::Dof::ThumbRotate] = Some(1000);
        let stamp = Time::of_nanos(5);
        let message = follower.apply(ms(1), one, stamp).unwrap();
        let [frame] = &message.transforms[..] else {
            panic!("{message:?}")
        };
        assert_eq!(frame.header.frame_id, "right_palm");
        assert_eq!(frame.child_frame_id, "right_thumb_1");
        assert_eq!(frame.header.stamp, stamp);
        let wanted = [-0.0269, 0.02101, 0.0689];
        for (metres, wanted) in frame.transform.translation.into_iter().zip(wanted) {
            assert!((metres - wanted).abs() < 1e-6, "{frame:?}");
        }
    }
}
