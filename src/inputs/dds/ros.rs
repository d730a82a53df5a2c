//! Commands in ROS 2's standard types (`handscope help dds`): the next targets as one point of a `trajectory_msgs/JointTrajectory`,
//! or as a `sensor_msgs/JointState`, in radians, of joints by their names in the URDF. An error refuses the message as a whole.

use crate::hand::kinematics::{RANGE, Side};
use crate::hand::model::{links, side_name};
use crate::hand::{Angle, Dof, PerDof};
use crate::inputs::dds::ctrl::{CtrlFault, CtrlMessage};
use crate::inputs::line::angle_of;
use crate::inputs::offer::{HOLD_TIMEOUT, OfferLimits};
use crate::record::file::format::cdr;
use crate::record::file::format::message::{Header, JointState};
use crate::transport::dds::DdsTopic;
use serde::Deserialize;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::time::Duration;

/// Limit of a message's length: twelve joints with names, positions, velocities, accelerations and efforts take a third of it.
const BYTES_MAX: usize = 2048;

/// Topic of trajectories for the hand of this side.
pub fn trajectory_topic(side: Side) -> DdsTopic {
    DdsTopic {
        name: format!("rt/handscope/{}/joint_trajectory", side_name(side)),
        type_name: "trajectory_msgs::msg::dds_::JointTrajectory_".into(),
    }
}

/// Topic of positions for the hand of this side.
pub fn position_topic(side: Side) -> DdsTopic {
    DdsTopic {
        name: format!("rt/handscope/{}/joint_command", side_name(side)),
        type_name: "sensor_msgs::msg::dds_::JointState_".into(),
    }
}

/// The type, field by field.
#[derive(Deserialize)]
struct JointTrajectory {
    _header: Header,
    joint_names: Vec<String>,
    points: Vec<TrajectoryPoint>,
}

#[derive(Deserialize)]
struct TrajectoryPoint {
    positions: Vec<f64>,
    /// Velocities, accelerations and efforts, which this hand does not follow.
    _others: [Vec<f64>; 3],
    time_from_start: RosDuration,
}

#[derive(Deserialize)]
struct RosDuration {
    sec: i32,
    nanosec: u32,
}

impl RosDuration {
    /// True if a stream's next message is due only after this.
    fn is_soon(&self) -> bool {
        let seconds = u64::try_from(self.sec).ok();
        seconds.is_some_and(|seconds| Duration::new(seconds, self.nanosec) <= HOLD_TIMEOUT)
    }
}

/// True if a message requests a stop: a trajectory without points, as ROS 2's own controllers understand it.
pub fn is_stop(bytes: &[u8]) -> bool {
    let trajectory: Option<JointTrajectory> = cdr::decode(bytes);
    trajectory.is_some_and(|trajectory| trajectory.points.is_empty())
}

/// Names of a hand's joints.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JointNames(Vec<(String, Option<Dof>)>);

impl JointNames {
    /// Names of the hand of this side.
    pub fn of(side: Side) -> Self {
        let joints = links(side).into_iter().filter_map(|link| link.joint);
        let named = joints.map(|joint| {
            let dof = joint.follows.is_none().then_some(joint.dof);
            (joint.name, dof)
        });
        Self(named.collect())
    }

    /// Parses a trajectory in CDR with its header. It has one point, which is followed at once; time_from_start may be up to the
    /// silence after which a hand is held. A stop is not an error.
    ///
    /// # Errors
    /// [`CtrlFault`]; the message is refused as a whole.
    pub fn trajectory(&self, bytes: &[u8]) -> Result<CtrlMessage, CtrlFault> {
        if bytes.len() > BYTES_MAX {
            return Err(CtrlFault::Malformed);
        }
        let raw: JointTrajectory = cdr::decode(bytes).ok_or(CtrlFault::Malformed)?;
        let [point] = &raw.points[..] else {
            return Err(CtrlFault::Points);
        };
        if !point.time_from_start.is_soon() {
            return Err(CtrlFault::Timing);
        }
        self.targets(&raw.joint_names, &point.positions)
    }

    /// Parses positions in CDR with their header.
    ///
    /// # Errors
    /// [`CtrlFault`]; the message is refused as a whole.
    pub fn positions(&self, bytes: &[u8]) -> Result<CtrlMessage, CtrlFault> {
        if bytes.len() > BYTES_MAX {
            return Err(CtrlFault::Malformed);
        }
        let raw: JointState = cdr::decode(bytes).ok_or(CtrlFault::Malformed)?;
        self.targets(&raw.name, &raw.position)
    }

    /// Targets of the driven joints that are named. The others may be named, too: they follow by themselves.
    fn targets(&self, names: &[String], radians: &[f64]) -> Result<CtrlMessage, CtrlFault> {
        if names.len() != radians.len() {
            return Err(CtrlFault::Unpaired);
        }
        let mut aims: PerDof<Option<Angle>> = PerDof::splat(None);
        for (name, radians) in names.iter().zip(radians) {
            let mut known = self.0.iter();
            let known = known.find(|(own, _)| own == name);
            let (_, dof) = known.ok_or(CtrlFault::UnknownJoint)?;
            let Some(dof) = *dof else { continue };
            let share = 1.0 - radians / f64::from(RANGE[dof]);
            let aim = angle_of(share).ok_or(CtrlFault::Range)?;
            if aims[dof].replace(aim).is_some() {
                return Err(CtrlFault::UnknownJoint);
            }
        }
        if aims.iter().all(|(_, aim)| aim.is_none()) {
            return Err(CtrlFault::UnknownJoint);
        }
        let mut hasher = DefaultHasher::new();
        for radians in radians {
            radians.to_bits().hash(&mut hasher);
        }
        Ok(CtrlMessage {
            aims,
            limits: OfferLimits::NONE,
            mark: hasher.finish(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::kinematics::joint_names;
    use proptest::prelude::*;

    /// CycloneDDS 11.0.1 wrote these: index at 0.71905 and thumb_2 at 0 rad, due in 34 ms; no points; index_1 at 1.4381 and index_2.
    const TRAJECTORY: &str = "0001000000000000000000000100000000000000020000001400000072696768745f696e6465785f315f6a6f696e74001400000072696768745f7468756d625f325f6a6f696e7400010000000200000000000000a60a46257502e73f00000000000000000000000000000000000000000000000080cc0602";
    const NO_POINTS: &str = "00010000050000000600000002000000780000000000000000000000";
    const POSITIONS: &str = "0001000000000000000000000100000000000000020000001400000072696768745f696e6465785f315f6a6f696e74001400000072696768745f696e6465785f325f6a6f696e740002000000a60a46257502f73f00000000000000000000000000000000";

    fn bytes(hex: &str) -> Vec<u8> {
        let digits = hex.as_bytes().chunks(2);
        digits
            .map(|two| u8::from_str_radix(str::from_utf8(two).unwrap(), 16).unwrap())
            .collect()
    }

    type Point = (Vec<f64>, [Vec<f64>; 3], (i32, u32));

    fn point(positions: &[f64], time: (i32, u32)) -> Point {
        (positions.to_vec(), [vec![9.0], vec![], vec![7.0]], time)
    }

    fn message(names: &[&str], points: &[Point]) -> Vec<u8> {
        cdr::encode(&(Header::default(), names, points))
    }

    fn read(names: &[&str], points: &[Point]) -> Result<CtrlMessage, CtrlFault> {
        JointNames::of(Side::Right).trajectory(&message(names, points))
    }

    fn counts(read: &CtrlMessage) -> [Option<i16>; 6] {
        *read.aims.map(|aim| aim.map(Angle::get)).as_array()
    }

    #[test]
    fn what_cyclonedds_writes_is_read() {
        let names = JointNames::of(Side::Right);
        let trajectory = names.trajectory(&bytes(TRAJECTORY)).unwrap();
        let wanted = [None, None, None, Some(500), Some(1000), None];
        assert_eq!(counts(&trajectory), wanted);
        assert_eq!(trajectory.limits, OfferLimits::NONE);
        let positions = names.positions(&bytes(POSITIONS)).unwrap();
        assert_eq!(counts(&positions), [None, None, None, Some(0), None, None]);
        assert!(is_stop(&bytes(NO_POINTS)) && !is_stop(&bytes(TRAJECTORY)));
        let left = JointNames::of(Side::Left);
        let refused = left.positions(&bytes(POSITIONS));
        assert_eq!(refused, Err(CtrlFault::UnknownJoint));
    }

    #[test]
    fn positions_of_all_twelve_joints_are_those_that_the_hand_publishes() {
        let angles = PerDof::new([0, 1000, 250, 999, 1, 640]);
        let state = JointState {
            name: joint_names(Side::Left),
            position: crate::hand::kinematics::joint_radians(&angles.map(Some)),
            ..JointState::default()
        };
        let names = JointNames::of(Side::Left);
        let read = names.positions(&cdr::encode(&state)).unwrap();
        assert_eq!(counts(&read), *angles.map(Some).as_array());
    }

    #[test]
    fn what_is_wrong_is_refused_whole() {
        let [index, thumb] = ["right_index_1_joint", "right_thumb_1_joint"];
        let now = (0, 0);
        for (names, points, fault) in [
            (vec![index], vec![], CtrlFault::Points),
            (vec![index], vec![point(&[0.1], now); 2], CtrlFault::Points),
            (
                vec![index],
                vec![point(&[0.1], (0, 200_000_001))],
                CtrlFault::Timing,
            ),
            (vec![index], vec![point(&[0.1], (1, 0))], CtrlFault::Timing),
            (vec![index], vec![point(&[0.1], (-1, 0))], CtrlFault::Timing),
            (
                vec![index],
                vec![point(&[0.1, 0.2], now)],
                CtrlFault::Unpaired,
            ),
            (
                vec![index, thumb],
                vec![point(&[0.1], now)],
                CtrlFault::Unpaired,
            ),
            (vec![], vec![point(&[], now)], CtrlFault::UnknownJoint),
            (
                vec!["index"],
                vec![point(&[0.1], now)],
                CtrlFault::UnknownJoint,
            ),
            (
                vec!["left_index_1_joint"],
                vec![point(&[0.1], now)],
                CtrlFault::UnknownJoint,
            ),
            (
                vec!["right_index_2_joint"],
                vec![point(&[0.1], now)],
                CtrlFault::UnknownJoint,
            ),
            (
                vec![index, index],
                vec![point(&[0.1, 0.1], now)],
                CtrlFault::UnknownJoint,
            ),
            (vec![index], vec![point(&[1.44], now)], CtrlFault::Range),
            (vec![index], vec![point(&[-0.01], now)], CtrlFault::Range),
            (vec![index], vec![point(&[f64::NAN], now)], CtrlFault::Range),
            (
                vec![index],
                vec![point(&[f64::INFINITY], now)],
                CtrlFault::Range,
            ),
            // One wrong joint refuses the other, too.
            (
                vec![index, thumb],
                vec![point(&[0.1, 1.2], now)],
                CtrlFault::Range,
            ),
        ] {
            assert_eq!(read(&names, &points), Err(fault), "{names:?} {points:?}");
        }
        let whole = message(&[index], &[point(&[0.1], now)]);
        assert!(read(&[index], &[point(&[0.1], (0, 200_000_000))]).is_ok());
        let names = JointNames::of(Side::Right);
        for cut in [0, 3, 16, 40, whole.len() - 1] {
            assert_eq!(
                names.trajectory(&whole[..cut]),
                Err(CtrlFault::Malformed),
                "{cut}"
            );
            assert_eq!(
                names.positions(&whole[..cut.min(30)]),
                Err(CtrlFault::Malformed)
            );
            assert!(!is_stop(&whole[..cut]), "{cut}");
        }
        let long = [whole, vec![0; BYTES_MAX]].concat();
        assert_eq!(names.trajectory(&long), Err(CtrlFault::Malformed));
        assert_eq!(names.positions(&long), Err(CtrlFault::Malformed));
    }

    #[test]
    fn topics_of_each_side_have_the_names_and_types_of_ros() {
        let trajectory = trajectory_topic(Side::Right);
        assert_eq!(trajectory.name, "rt/handscope/right/joint_trajectory");
        assert_eq!(
            trajectory.type_name,
            "trajectory_msgs::msg::dds_::JointTrajectory_"
        );
        let positions = position_topic(Side::Left);
        assert_eq!(positions.name, "rt/handscope/left/joint_command");
        assert_eq!(positions.type_name, "sensor_msgs::msg::dds_::JointState_");
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            let names = JointNames::of(Side::Left);
            let _either = (names.trajectory(&bytes), names.positions(&bytes), is_stop(&bytes));
        }
    }
}
