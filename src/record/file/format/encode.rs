//! Converts entries to messages.

use crate::hand::grip::{Grip, GripEstimate, GripState};
use crate::hand::kinematics::{Side, joint_names, joint_radians};
use crate::hand::model::urdf::urdf;
use crate::hand::{Finger, Group, Groups, HandSample, Moment, Quantity, register};
use crate::record::file::format::cdr;
use crate::record::file::format::message::{
    CommandFate, CommandMessage, EventMessage, GripMessage, Header, JointState, LinkMessage,
    StateMessage, Time, TouchMessage, WireMessage,
};
use crate::record::file::format::opening::{Opening, nanos_of};
use crate::record::file::format::robot::{FrameFollower, FramePace};
use crate::record::file::format::topic::Topic;
use crate::record::grip::{GripFollower, states};
use crate::record::{Direction, Entry, LinkState, Piece, PieceKind, Record, WriteFate};
use std::time::Duration;

/// Interval at which an unchanged grip is repeated.
const GRIP_INTERVAL: Duration = Duration::from_secs(1);

/// Event kind of a refusal to arm; its text is the reason in JSON.
pub(crate) const ARM_REFUSED: &str = "arm_refused";

/// One message, ready to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodedMessage {
    pub topic: Topic,
    /// Time of receipt, nanoseconds since 1970.
    pub log_nanos: u64,
    /// Time of the request, nanoseconds since 1970; that of receipt for data that was not requested.
    pub publish_nanos: u64,
    pub bytes: Vec<u8>,
}

#[derive(Debug)]
pub(crate) struct EntryEncoder {
    base_nanos: u64,
    side: Side,
    joint_names: Vec<String>,
    frames: FrameFollower,
    grip: GripFollower,
    /// Time and states of the last grip message.
    last_grip: Option<(Moment, [GripState; 6])>,
}

impl EntryEncoder {
    /// For a file.
    pub(crate) fn new(opening: &Opening) -> Self {
        Self::with_pace(opening, FramePace::File)
    }

    /// For readers that see the hand move.
    pub(crate) fn live(opening: &Opening) -> Self {
        Self::with_pace(opening, FramePace::Live)
    }

    fn with_pace(opening: &Opening, pace: FramePace) -> Self {
        Self {
            base_nanos: opening.base_nanos,
            side: opening.side,
            joint_names: joint_names(opening.side),
            frames: FrameFollower::new(opening.side, pace),
            grip: GripFollower::default(),
            last_grip: None,
        }
    }

    /// For the recording's next file, with the current state of the grip.
    pub(crate) fn next(&self, opening: &Opening) -> Self {
        Self::following(opening, self.grip.clone())
    }

    /// For a file with this state of the grip before its first entry.
    pub(crate) fn following(opening: &Opening, grip: GripFollower) -> Self {
        Self {
            grip,
            ..Self::new(opening)
        }
    }

    /// Messages that readers need before all others, and that do not change: the model, and its fixed frames.
    pub(crate) fn lasting(&self, at: Moment) -> [EncodedMessage; 2] {
        let fixed = self.frames.fixed(self.time(at));
        [
            self.message(Topic::Description, at, &urdf(self.side)),
            self.message(Topic::FixedFrames, at, &fixed),
        ]
    }

    /// Applies an entry without output, because later messages depend on it.
    pub(crate) fn pass(&mut self, entry: &Entry) {
        self.grip.apply(entry);
    }

    fn nanos(&self, at: Moment) -> u64 {
        nanos_of(self.base_nanos, at)
    }

    fn time(&self, at: Moment) -> Time {
        Time::of_nanos(self.nanos(at))
    }

    fn message<T: serde::Serialize>(
        &self,
        topic: Topic,
        at: Moment,
        message: &T,
    ) -> EncodedMessage {
        let nanos = self.nanos(at);
        EncodedMessage {
            topic,
            log_nanos: nanos,
            publish_nanos: nanos,
            bytes: cdr::encode(message),
        }
    }

    pub(crate) fn encode(&mut self, entry: &Entry) -> Vec<EncodedMessage> {
        let mut messages = self.own(entry);
        let at = entry.at();
        // At the start of a file or a cut, and when readings stop, the grip is known at most a second later.
        let grip = self
            .grip
            .apply(entry)
            .unwrap_or_else(|| self.grip.known(at));
        messages.extend(self.grip_message(&grip, at));
        messages
    }

    /// A message with the grip, if it changed or was not written for a while.
    fn grip_message(&mut self, grip: &Grip, at: Moment) -> Option<EncodedMessage> {
        let is_unchanged = |(written, before): (Moment, [GripState; 6])| {
            before == states(grip) && at.since(written) < GRIP_INTERVAL
        };
        if self.last_grip.is_some_and(is_unchanged) {
            return None;
        }
        self.last_grip = Some((at, states(grip)));
        let asked = |own: &GripEstimate| own.asked.map(|at| self.time(at)).unwrap_or_default();
        let fingers = grip.fingers.as_array();
        let message = GripMessage {
            at: self.time(at),
            state: grip.grasp.state.name().into(),
            since: self.time(grip.grasp.since),
            asked: asked(&grip.grasp),
            finger_states: fingers.iter().map(|own| own.state.name().into()).collect(),
            finger_since: fingers.iter().map(|own| self.time(own.since)).collect(),
            finger_asked: fingers.iter().map(asked).collect(),
        };
        Some(self.message(Topic::Grip, at, &message))
    }

    fn own(&mut self, entry: &Entry) -> Vec<EncodedMessage> {
        match entry {
            Entry::Heard(Record::Reading { sample, fresh }) => self.reading(sample, *fresh),
            Entry::Heard(record) => self.record(record).into_iter().collect(),
            Entry::Wire(piece) => vec![self.wire(piece)],
            Entry::Link(report) => {
                let link = LinkMessage {
                    at: self.time(report.at),
                    state: link_state_key(report.state).into(),
                    entered: false,
                    trouble: report.trouble.clone(),
                    status: report.status.clone(),
                    figures: report.figures.clone(),
                };
                vec![self.message(Topic::Link, report.at, &link)]
            }
            Entry::Event(event) => vec![self.event(event.at, event.kind.key(), &event.words)],
        }
    }

    pub(crate) fn event(&self, at: Moment, kind: &str, words: &str) -> EncodedMessage {
        let event = EventMessage {
            at: self.time(at),
            kind: kind.into(),
            words: words.into(),
        };
        self.message(Topic::Event, at, &event)
    }

    fn record(&self, record: &Record) -> Option<EncodedMessage> {
        Some(match record {
            Record::Reading { .. } => return None,
            Record::State { at, state } => {
                let link = LinkMessage {
                    at: self.time(*at),
                    state: link_state_key(*state).into(),
                    entered: true,
                    ..LinkMessage::default()
                };
                self.message(Topic::Link, *at, &link)
            }
            Record::Sent {
                at,
                number,
                cause,
                write,
            } => {
                let command = CommandMessage {
                    sent: self.time(*at),
                    number: *number,
                    cause: cause.key().into(),
                    register: register::by_address(write.address)
                        .map_or("", |row| row.name)
                        .into(),
                    address: write.address,
                    bytes: write.bytes.to_vec(),
                };
                self.message(Topic::Command, *at, &command)
            }
            Record::Answered { at, number, fate } => {
                let (word, reason) = match fate {
                    WriteFate::Acknowledged => ("acknowledged", ""),
                    WriteFate::Refused { reason } => ("refused", reason.as_str()),
                    WriteFate::Unanswered => ("unanswered", ""),
                };
                let fate = CommandFate {
                    at: self.time(*at),
                    number: *number,
                    fate: word.into(),
                    reason: reason.into(),
                };
                self.message(Topic::CommandFate, *at, &fate)
            }
            Record::ArmRefused { at, reason } => {
                let words = serde_json::to_string(reason).unwrap_or_default();
                self.event(*at, ARM_REFUSED, &words)
            }
        })
    }

    fn wire(&self, piece: &Piece) -> EncodedMessage {
        let wire = WireMessage {
            at: self.time(piece.at),
            kind: match piece.kind {
                PieceKind::Opened => 0,
                PieceKind::Bytes(Direction::ToHand) => 1,
                PieceKind::Bytes(Direction::FromHand) => 2,
                PieceKind::Broken => 3,
                PieceKind::Closed => 4,
            },
            bytes: piece.bytes.clone(),
        };
        self.message(Topic::Wire, piece.at, &wire)
    }

    /// Messages of one reply: one for the joints' groups, one for each fingertip.
    fn reading(&mut self, sample: &HandSample, fresh: Groups) -> Vec<EncodedMessage> {
        let mut messages = Vec::new();
        let of_joints = Group::ALL
            .into_iter()
            .find(|group| !matches!(group, Group::Tactile(_)) && fresh.contains(*group));
        if let Some((asked, received)) = of_joints.and_then(|group| sample.times(group)) {
            let state = self.state(sample, fresh, (asked, received));
            let mut message = self.message(Topic::State, received, &state);
            message.publish_nanos = self.nanos(asked);
            messages.push(message);
        }
        if fresh.contains(Group::Angle)
            && let Some(angle) = Quantity::Angle.documented(sample)
        {
            let stamp = self.time(angle.received);
            let joints = JointState {
                header: Header {
                    stamp,
                    frame_id: String::new(),
                },
                name: self.joint_names.clone(),
                position: joint_radians(&angle.value),
                ..JointState::default()
            };
            let mut message = self.message(Topic::Joints, angle.received, &joints);
            message.publish_nanos = self.nanos(angle.asked);
            messages.push(message);
            if let Some(frames) = self.frames.apply(angle.received, angle.value, stamp) {
                let mut message = self.message(Topic::Frames, angle.received, &frames);
                message.publish_nanos = self.nanos(angle.asked);
                messages.push(message);
            }
        }
        for finger in Finger::ALL {
            let block = sample.tactile[finger].filter(|_| fresh.contains(Group::Tactile(finger)));
            if let Some(block) = block {
                let touch = TouchMessage {
                    asked: self.time(block.asked),
                    received: self.time(block.received),
                    normal_n: block.value.normal_n,
                    tangential_n: block.value.tangential_n,
                    direction_deg: block.value.direction_raw,
                    proximity: block.value.proximity,
                    check_ok: block.value.check_ok(),
                    channels: block.value.raw.to_vec(),
                    raw: block.value.as_sent().to_vec(),
                };
                let mut message = self.message(Topic::Touch(finger), block.received, &touch);
                message.publish_nanos = self.nanos(block.asked);
                messages.push(message);
            }
        }
        messages
    }

    fn state(&self, sample: &HandSample, fresh: Groups, times: (Moment, Moment)) -> StateMessage {
        let shorts = |group: Group| -> Vec<i16> {
            let memory = sample.memory(group).filter(|_| fresh.contains(group));
            let pairs = memory.unwrap_or_default();
            let (pairs, _) = pairs.as_chunks::<2>();
            pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect()
        };
        let bytes = |group: Group| -> Vec<u8> {
            let memory = sample.memory(group).filter(|_| fresh.contains(group));
            memory.unwrap_or_default()
        };
        let undocumented = sample.undocumented(fresh).map(|value| value.name());
        StateMessage {
            asked: self.time(times.0),
            received: self.time(times.1),
            angle_set: shorts(Group::AngleSet),
            force_set: shorts(Group::ForceSet),
            speed_set: shorts(Group::SpeedSet),
            position: shorts(Group::Position),
            angle: shorts(Group::Angle),
            force: shorts(Group::Force),
            current: shorts(Group::Current),
            faults: bytes(Group::Faults),
            status: bytes(Group::Status),
            temperature: bytes(Group::Temperature),
            undocumented: undocumented.collect(),
        }
    }
}

/// Stable name of a state.
pub(crate) const fn link_state_key(state: LinkState) -> &'static str {
    match state {
        LinkState::Offline => "offline",
        LinkState::Identifying => "identifying",
        LinkState::Monitoring => "monitoring",
        LinkState::Armed => "armed",
        LinkState::Holding => "holding",
        LinkState::Fault => "fault",
    }
}
