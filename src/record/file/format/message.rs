//! Messages of a recording file, in ROS 2's types. Their definitions are stored in each file, too.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces/msg/Time`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Time {
    /// Whole seconds since 1970.
    pub sec: i32,
    /// Remaining nanoseconds.
    pub nanosec: u32,
}

impl Time {
    /// Converts nanoseconds since 1970.
    pub fn of_nanos(nanos: u64) -> Self {
        const SECOND: u64 = 1_000_000_000;
        Self {
            sec: i32::try_from(nanos / SECOND).unwrap_or(i32::MAX),
            nanosec: u32::try_from(nanos % SECOND).unwrap_or_default(),
        }
    }

    /// True of all times after January 2038, whose seconds saturate.
    pub(crate) const fn has_ended(self) -> bool {
        self.sec == i32::MAX
    }

    /// Nanoseconds since 1970; 0 before that.
    pub fn nanos(self) -> u64 {
        let seconds = u64::try_from(self.sec).unwrap_or_default();
        seconds * 1_000_000_000 + u64::from(self.nanosec)
    }
}

/// `std_msgs/msg/Header`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Header {
    /// Time of the measurement.
    pub stamp: Time,
    /// Coordinate frame.
    pub frame_id: String,
}

/// `sensor_msgs/msg/JointState`: the twelve joints of the model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct JointState {
    /// Time of receipt.
    pub header: Header,
    /// Names of the model's joints.
    pub name: Vec<String>,
    /// In rad; NaN if the angle is unknown.
    pub position: Vec<f64>,
    /// Always empty.
    pub velocity: Vec<f64>,
    /// Always empty: the hand reports forces of six drives, not of twelve joints.
    pub effort: Vec<f64>,
}

/// `tf2_msgs/msg/TFMessage`: links of the model in their parents' frames.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TfMessage {
    pub transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TransformStamped {
    /// Time of receipt of the angles, and the parent's frame.
    pub header: Header,
    /// Frame of the link.
    pub child_frame_id: String,
    pub transform: Transform,
}

/// `geometry_msgs/msg/Transform`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Transform {
    /// In m.
    pub translation: [f64; 3],
    /// Quaternion: x, y, z, w.
    pub rotation: [f64; 4],
}

/// One reply about the joints. Each list has six values in the order of the registers (little, ring, middle, index, thumb bend,
/// thumb rotation), or is empty if the reply did not include the group.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StateMessage {
    /// Time at which the request was sent.
    pub asked: Time,
    /// Time at which the reply was complete.
    pub received: Time,
    /// ANGLE_SET; -1 means no new target.
    pub angle_set: Vec<i16>,
    /// FORCE_SET, g.
    pub force_set: Vec<i16>,
    pub speed_set: Vec<i16>,
    /// POS_ACT.
    pub position: Vec<i16>,
    /// ANGLE_ACT.
    pub angle: Vec<i16>,
    /// FORCE_ACT, g.
    pub force: Vec<i16>,
    /// CURRENT, mA.
    pub current: Vec<i16>,
    /// ERROR, bits.
    pub faults: Vec<u8>,
    /// STATUS, codes.
    pub status: Vec<u8>,
    /// TEMP, °C.
    pub temperature: Vec<u8>,
    /// Values outside the manual's ranges, as `angle[4]`.
    pub undocumented: Vec<String>,
}

/// The block of one fingertip.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TouchMessage {
    /// Time at which the request was sent.
    pub asked: Time,
    /// Time at which the reply was complete.
    pub received: Time,
    /// Normal force, N.
    pub normal_n: f32,
    /// Tangential force, N.
    pub tangential_n: f32,
    /// Direction of the tangential force in degrees; 65535 without contact.
    pub direction_deg: u16,
    /// Proximity, counts.
    pub proximity: i32,
    /// True if the check word is correct.
    pub check_ok: bool,
    /// Counts of the eight channels.
    pub channels: Vec<u32>,
    /// The 58 bytes as received.
    pub raw: Vec<u8>,
}

/// State of the grip: unknown, open, moving, empty, holding, slipping, lost, too_hard or touching.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GripMessage {
    /// Time of this message.
    pub at: Time,
    /// State of the whole grasp.
    pub state: String,
    /// Start of that state.
    pub since: Time,
    /// Request time of the oldest reading that it is based on; 0 if there is none.
    pub asked: Time,
    /// States of little, ring, middle, index, thumb.
    pub finger_states: Vec<String>,
    pub finger_since: Vec<Time>,
    pub finger_asked: Vec<Time>,
}

/// A write that left for the hand.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CommandMessage {
    pub sent: Time,
    /// Number of the write on this connection.
    pub number: u64,
    /// Cause: hold, arming, setpoint, request or setting.
    pub cause: String,
    /// Name of the register; empty if it has none.
    pub register: String,
    /// Address of the first byte.
    pub address: u16,
    /// Bytes in memory order.
    pub bytes: Vec<u8>,
}

/// The outcome of a write.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CommandFate {
    /// Time at which it was known.
    pub at: Time,
    /// Number of the write.
    pub number: u64,
    /// acknowledged, refused or unanswered.
    pub fate: String,
    /// The protocol's reason for a refusal.
    pub reason: String,
}

/// State of the link.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LinkMessage {
    pub at: Time,
    /// offline, identifying, monitoring, armed, holding or fault.
    pub state: String,
    /// True if the state began here; false if it is a repetition.
    pub entered: bool,
    /// Reason why there was no live hand.
    pub trouble: String,
    /// The whole status, in JSON; empty if unchanged.
    pub status: String,
    /// Statistics of the link, in JSON; empty if not included.
    pub figures: String,
}

/// Any other event.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct EventMessage {
    pub at: Time,
    /// Kind of the event, in one word.
    pub kind: String,
    pub words: String,
}

/// Bytes on the wire.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct WireMessage {
    pub at: Time,
    /// 0 the wire was opened, 1 bytes to the hand, 2 bytes from the hand, 3 the wire broke, 4 it was closed.
    pub kind: u8,
    pub bytes: Vec<u8>,
}
