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
}

/// A definition that several topics may share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schema {
    /// Number in a file.
    pub id: u16,
    pub name: &'static str,
    pub text: &'static str,
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
"# What is gripped: unknown, open, moving, empty, holding, slipping, lost or too_hard. Told when a state changes, and once a
# second. Each state has the time of its begin, and when the oldest reading that it rests on was asked for: 0 if there is none.
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
/// Channel number of the grip, after the last fingertip's.
const GRIP_CHANNEL: u16 = 13;

impl Topic {
    /// All topics, in the order of their channel numbers.
    pub fn all() -> impl Iterator<Item = Self> {
        let tips = Finger::ALL.map(Self::Touch);
        PLAIN.into_iter().chain(tips).chain([Self::Grip])
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
            Self::Grip => GRIP_CHANNEL,
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
        }
    }
}
