//! What stands in the messages of a recording file, as ROS 2 defines them. The definitions stand in each file, too.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces/msg/Time`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Time {
    /// Seconds since 1970.
    pub sec: i32,
    /// And nanoseconds.
    pub nanosec: u32,
}

impl Time {
    /// From nanoseconds since 1970.
    pub fn of_nanos(nanos: u64) -> Self {
        const SECOND: u64 = 1_000_000_000;
        Self {
            sec: i32::try_from(nanos / SECOND).unwrap_or(i32::MAX),
            nanosec: u32::try_from(nanos % SECOND).unwrap_or_default(),
        }
    }

    /// True of all times after January 2038, which have no other number of seconds.
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
    /// When it was measured.
    pub stamp: Time,
    /// The frame of coordinates.
    pub frame_id: String,
}

/// `sensor_msgs/msg/JointState`: the twelve joints of the model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct JointState {
    /// When it was received.
    pub header: Header,
    /// As the model's joints are named.
    pub name: Vec<String>,
    /// In rad; NaN where the angle is not known.
    pub position: Vec<f64>,
    /// Empty.
    pub velocity: Vec<f64>,
    /// Empty: the hand tells forces of six drives, not of twelve joints.
    pub effort: Vec<f64>,
}

/// One reply about the joints. Each list has six values in the order of the registers (little, ring, middle, index, thumb bend,
/// thumb rotation), or is empty if the reply was not about it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StateMessage {
    /// When the request left.
    pub asked: Time,
    /// When the reply was there.
    pub received: Time,
    /// ANGLE_SET; -1 leaves the joint alone.
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
    /// When the request left.
    pub asked: Time,
    /// When the reply was there.
    pub received: Time,
    /// Normal force, N.
    pub normal_n: f32,
    /// Tangential force, N.
    pub tangential_n: f32,
    /// Direction of the tangential force in degrees; 65535 without contact.
    pub direction_deg: u16,
    /// Proximity, counts.
    pub proximity: i32,
    /// Whether the check word is right.
    pub check_ok: bool,
    /// Counts of the eight channels.
    pub channels: Vec<u32>,
    /// The 58 bytes as they were sent.
    pub raw: Vec<u8>,
}

/// What is gripped, in words: unknown, open, moving, empty, holding, slipping, lost or too_hard.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GripMessage {
    /// When that was told.
    pub at: Time,
    /// State of the whole grasp.
    pub state: String,
    /// When that state began.
    pub since: Time,
    /// When the oldest reading that it rests on was asked for; 0 if there is none.
    pub asked: Time,
    /// The same of little, ring, middle, index, thumb.
    pub finger_states: Vec<String>,
    pub finger_since: Vec<Time>,
    pub finger_asked: Vec<Time>,
}

/// A write that left for the hand.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CommandMessage {
    pub sent: Time,
    /// Its number on this connection.
    pub number: u64,
    /// Why it was written: hold, arming, setpoint, request or setting.
    pub cause: String,
    /// The register's name; empty if it has none.
    pub register: String,
    /// The first byte's address.
    pub address: u16,
    /// The bytes in memory order.
    pub bytes: Vec<u8>,
}

/// The end of a write.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CommandFate {
    /// When that was known.
    pub at: Time,
    /// The number of the write.
    pub number: u64,
    /// acknowledged, refused or unanswered.
    pub fate: String,
    /// The protocol's word for a refusal.
    pub reason: String,
}

/// Where the link stood.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LinkMessage {
    pub at: Time,
    /// offline, identifying, monitoring, armed, holding or fault.
    pub state: String,
    /// True if the state began here; else it was told again.
    pub entered: bool,
    /// Why there was no live hand.
    pub trouble: String,
    /// All of the status, in JSON; empty if it did not change.
    pub status: String,
    /// Figures of the link, in JSON; empty if not told here.
    pub figures: String,
}

/// What else happened.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct EventMessage {
    pub at: Time,
    /// What, in one word.
    pub kind: String,
    pub words: String,
}

/// Bytes that went over the wire.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct WireMessage {
    pub at: Time,
    /// 0 the wire was opened, 1 bytes to the hand, 2 bytes from the hand, 3 the wire broke, 4 it was closed.
    pub kind: u8,
    /// The bytes.
    pub bytes: Vec<u8>,
}
