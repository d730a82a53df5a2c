//! The topics of a recording file and the definitions of their messages. Channel numbers are fixed, so that a file with damaged
//! channel records can still be read.

use crate::hand::Finger;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Topic {
    /// The twelve joints of the model.
    Joints,
    /// Replies about the joints.
    State,
    /// Writes.
    Command,
    /// Outcomes of writes.
    CommandFate,
    /// State of the link.
    Link,
    /// Other events.
    Event,
    /// Bytes on the wire.
    Wire,
    /// Blocks of one fingertip.
    Touch(Finger),
    /// State of the grip.
    Grip,
    /// Frames of the links, from the angles.
    Frames,
    /// Frames that never move.
    FixedFrames,
    /// The model as URDF.
    Description,
}

/// A definition that several topics may share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schema {
    /// Number in a file.
    pub id: u16,
    pub name: &'static str,
    pub text: &'static str,
}

impl Schema {
    /// Definition without those of the types that it uses: the content of its `.msg` file.
    pub fn fields(self) -> &'static str {
        let nested = self.text.find("====");
        nested
            .and_then(|at| self.text.get(..at))
            .unwrap_or(self.text)
    }
}

/// Appends the definition of `Time` to a definition.
macro_rules! with_time {
    ($text:literal) => {
        concat!(
            $text,
            "================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"
        )
    };
}

const JOINT_STATE: Schema = Schema {
    id: 1,
    name: "sensor_msgs/msg/JointState",
    text: with_time!(
        "std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"
    ),
};
const STATE: Schema = Schema {
    id: 2,
    name: "handscope_msgs/msg/State",
    text: with_time!(
"# One reply about the joints. A list has six values (little, ring, middle, index, thumb bend, thumb rotation), or
# none if the reply was not about it. Numbers are as the hand sent them; -32768 in a set point is one out of its range.
builtin_interfaces/Time asked
builtin_interfaces/Time received
int16[] angle_set
int16[] force_set
int16[] speed_set
int16[] position
int16[] angle
int16[] force
int16[] current
uint8[] faults
uint8[] status
uint8[] temperature
# Values outside the ranges of the manual, as angle[4].
string[] undocumented
"
    ),
};
const COMMAND: Schema = Schema {
    id: 3,
    name: "handscope_msgs/msg/Command",
    text: with_time!(
        "# A write that left for the hand.
builtin_interfaces/Time sent
uint64 number
# hold, arming, setpoint, request or setting
string cause
string register
uint16 address
uint8[] bytes
"
    ),
};
const COMMAND_FATE: Schema = Schema {
    id: 4,
    name: "handscope_msgs/msg/CommandFate",
    text: with_time!(
        "# The end of a write: acknowledged, refused or unanswered.
builtin_interfaces/Time at
uint64 number
string fate
string reason
"
    ),
};
const LINK: Schema = Schema {
    id: 5,
    name: "handscope_msgs/msg/Link",
    text: with_time!(
        "# Where the link stood: offline, identifying, monitoring, armed, holding or fault.
builtin_interfaces/Time at
string state
# True if the state began here.
bool entered
string trouble
# In JSON; empty if unchanged.
string status
# In JSON; empty if not told here.
string figures
"
    ),
};
const EVENT: Schema = Schema {
    id: 6,
    name: "handscope_msgs/msg/Event",
    text: with_time!(
        "# What happened beside: fault, stop, armed, note, trial, ...
builtin_interfaces/Time at
string kind
string words
"
    ),
};
const WIRE: Schema = Schema {
    id: 7,
    name: "handscope_msgs/msg/Wire",
    text: with_time!(
"# 0 the wire was opened, 1 bytes to the hand, 2 bytes from the hand, 3 it broke, 4 it was closed.
builtin_interfaces/Time at
uint8 kind
uint8[] bytes
"
    ),
};
const TOUCH: Schema = Schema {
    id: 8,
    name: "handscope_msgs/msg/Touch",
    text: with_time!(
        "# The block of one fingertip.
builtin_interfaces/Time asked
builtin_interfaces/Time received
float32 normal_n
float32 tangential_n
# 65535 without contact
uint16 direction_deg
int32 proximity
bool check_ok
uint32[] channels
# The 58 bytes as they were sent.
uint8[] raw
"
    ),
};

const GRIP: Schema = Schema {
    id: 9,
    name: "handscope_msgs/msg/Grip",
    text: with_time!(
"# What is gripped: unknown, open, moving, empty, holding, slipping, lost, too_hard or touching. Told when a state changes, and once
# a second. Each state has the time of its begin, and when the oldest reading that it rests on was asked for: 0 if there is none.
builtin_interfaces/Time at
# Of the whole grasp.
string state
builtin_interfaces/Time since
builtin_interfaces/Time asked
# Of little, ring, middle, index, thumb.
string[] finger_states
builtin_interfaces/Time[] finger_since
builtin_interfaces/Time[] finger_asked
"
    ),
};

const STRING: Schema = Schema {
    id: 10,
    name: "std_msgs/msg/String",
    text: "string data\n",
};
const TF_MESSAGE: Schema = Schema {
    id: 11,
    name: "tf2_msgs/msg/TFMessage",
    text: with_time!(
        "geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"
    ),
};

/// Quality of service of messages that are written once and kept for late readers, without which RViz does not accept them: reliable,
/// transient local, the last message. The numbers are those of rosbag2 before its version 9, which later ones read.
const LASTING: &str = "- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline:
    sec: 9223372036
    nsec: 854775807
  lifespan:
    sec: 9223372036
    nsec: 854775807
  liveliness: 1
  liveliness_lease_duration:
    sec: 9223372036
    nsec: 854775807
  avoid_ros_namespace_conventions: false";
/// Key of the quality of service in a channel's metadata.
pub(crate) const QUALITY: &str = "offered_qos_profiles";

/// Topics before those of the fingertips, in the order of their channel numbers.
const PLAIN: [Topic; 7] = [
    Topic::Joints,
    Topic::State,
    Topic::Command,
    Topic::CommandFate,
    Topic::Link,
    Topic::Event,
    Topic::Wire,
];
/// Channel number of the first fingertip.
const FIRST_TIP: u16 = 8;
/// Topics after those of the fingertips, in the order of their channel numbers.
const LATER: [Topic; 4] = [
    Topic::Grip,
    Topic::Frames,
    Topic::FixedFrames,
    Topic::Description,
];

impl Topic {
    /// All topics, in the order of their channel numbers.
    pub fn all() -> impl Iterator<Item = Self> {
        let tips = Finger::ALL.map(Self::Touch);
        PLAIN.into_iter().chain(tips).chain(LATER)
    }

    /// Channel number.
    pub const fn channel(self) -> u16 {
        match self {
            Self::Joints => 1,
            Self::State => 2,
            Self::Command => 3,
            Self::CommandFate => 4,
            Self::Link => 5,
            Self::Event => 6,
            Self::Wire => 7,
            #[expect(clippy::cast_possible_truncation, reason = "there are five fingers")]
            Self::Touch(finger) => FIRST_TIP + finger.index() as u16,
            Self::Grip => 13,
            Self::Frames => 14,
            Self::FixedFrames => 15,
            Self::Description => 16,
        }
    }

    /// The topic of a channel.
    pub fn by_channel(channel: u16) -> Option<Self> {
        Self::all().find(|topic| topic.channel() == channel)
    }

    pub const fn name(self) -> &'static str {
        match self {
            Self::Joints => "/joint_states",
            Self::State => "/handscope/state",
            Self::Command => "/handscope/command",
            Self::CommandFate => "/handscope/command_fate",
            Self::Link => "/handscope/link",
            Self::Event => "/handscope/event",
            Self::Wire => "/handscope/wire",
            Self::Touch(Finger::Little) => "/handscope/touch/little",
            Self::Touch(Finger::Ring) => "/handscope/touch/ring",
            Self::Touch(Finger::Middle) => "/handscope/touch/middle",
            Self::Touch(Finger::Index) => "/handscope/touch/index",
            Self::Touch(Finger::Thumb) => "/handscope/touch/thumb",
            Self::Grip => "/handscope/grip",
            Self::Frames => "/tf",
            Self::FixedFrames => "/tf_static",
            Self::Description => "/robot_description",
        }
    }

    /// Definition of its messages.
    pub const fn schema(self) -> Schema {
        match self {
            Self::Joints => JOINT_STATE,
            Self::State => STATE,
            Self::Command => COMMAND,
            Self::CommandFate => COMMAND_FATE,
            Self::Link => LINK,
            Self::Event => EVENT,
            Self::Wire => WIRE,
            Self::Touch(_) => TOUCH,
            Self::Grip => GRIP,
            Self::Frames | Self::FixedFrames => TF_MESSAGE,
            Self::Description => STRING,
        }
    }

    /// True if the topic was added after the first version of the format, so that older files lack it.
    pub(crate) fn is_later(self) -> bool {
        LATER.contains(&self)
    }

    /// True for topics that every robot has. Here they are computed from the others, so that readers need none of them.
    pub(crate) const fn is_common(self) -> bool {
        matches!(
            self,
            Self::Joints | Self::Frames | Self::FixedFrames | Self::Description
        )
    }

    /// True if each message begins with its time.
    pub(crate) const fn is_stamped(self) -> bool {
        !matches!(self, Self::Frames | Self::FixedFrames | Self::Description)
    }

    /// Quality of service for programs that play a file, as ROS 2 spells it; `None` for the usual one.
    pub(crate) const fn quality(self) -> Option<&'static str> {
        match self {
            Self::FixedFrames | Self::Description => Some(LASTING),
            _ => None,
        }
    }
}
