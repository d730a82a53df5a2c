//! Publishes a hand over DDS: to Unitree's programs in the format of their driver, and to ROS 2. Values that were not read are not
//! published, and nothing is published twice.

use crate::hand::kinematics::Side;
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment};
use crate::link::{Clock, LinkEntries, LinkHandle};
use crate::record::file::Opening;
use crate::record::file::format::cdr;
use crate::record::file::format::encode::{EncodedMessage, EntryEncoder};
use crate::record::file::format::topic::Topic;
use crate::record::{Entry, Record};
use crate::share::fleet::{FleetAnnouncer, FleetCard};
use crate::share::motors::{self, MotorPair};
use crate::transport::dds::{DdsMessage, DdsNode, DdsTopic, DdsWriter};
use serde::Serialize;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::sync::{mpsc, watch};
use tokio_util::task::AbortOnDropHandle;

/// Largest age of any part of a state: the slowest part is read twice a second.
pub const OLDEST: Duration = Duration::from_secs(1);
/// Queue of received states of both hands: only the newest counts.
const MOTORS_KEPT: u16 = 8;

/// Unitree's state of a hand, `inspire::inspire_hand_state`: raw numbers of the hand, in register order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InspireState {
    shorts: [[i16; Dof::ALL.len()]; 4],
    bytes: [[u8; Dof::ALL.len()]; 3],
}

impl InspireState {
    /// Lists of the type, in order.
    const SHORTS: [Group; 4] = [Group::Position, Group::Angle, Group::Force, Group::Current];
    const BYTES: [Group; 3] = [Group::Faults, Group::Status, Group::Temperature];

    /// State at this moment; `None` unless all parts were read recently.
    pub fn of(sample: &HandSample, now: Moment) -> Option<Self> {
        let memory = |group: Group| {
            let (asked, _) = sample.times(group)?;
            sample.memory(group).filter(|_| now.since(asked) <= OLDEST)
        };
        let mut state = Self {
            shorts: [[0; Dof::ALL.len()]; 4],
            bytes: [[0; Dof::ALL.len()]; 3],
        };
        for (list, group) in state.shorts.iter_mut().zip(Self::SHORTS) {
            let bytes = memory(group)?;
            let (pairs, []) = bytes.as_chunks::<2>() else {
                return None;
            };
            let values: Vec<i16> = pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect();
            *list = values.try_into().ok()?;
        }
        for (list, group) in state.bytes.iter_mut().zip(Self::BYTES) {
            *list = memory(group)?.try_into().ok()?;
        }
        Some(state)
    }

    const fn angles(&self) -> &[i16; Dof::ALL.len()] {
        let [_, angles, _, _] = &self.shorts;
        angles
    }

    const fn celsius(&self) -> &[u8; Dof::ALL.len()] {
        let [_, _, celsius] = &self.bytes;
        celsius
    }

    /// Encodes the message in CDR with its header.
    pub fn message(&self) -> Vec<u8> {
        /// Slices, as the type has sequences and no arrays.
        #[derive(Serialize)]
        struct Lists<'a> {
            pos_act: &'a [i16],
            angle_act: &'a [i16],
            force_act: &'a [i16],
            current: &'a [i16],
            err: &'a [u8],
            status: &'a [u8],
            temperature: &'a [u8],
        }
        let [pos_act, angle_act, force_act, current] = &self.shorts;
        let [err, status, temperature] = &self.bytes;
        cdr::encode(&Lists {
            pos_act,
            angle_act,
            force_act,
            current,
            err,
            status,
            temperature,
        })
    }
}

/// Counts of published messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DdsCounts {
    pub states: u64,
    /// States that were not published because a part was never read or is too old.
    pub incomplete: u64,
    /// Messages that could not be sent in time because a reader does not accept them.
    pub lost: u64,
}

/// Publishes everything about one hand until dropped.
#[derive(Debug)]
pub struct DdsPublisher {
    counts: watch::Receiver<DdsCounts>,
    _task: AbortOnDropHandle<()>,
}

impl DdsPublisher {
    /// Publishes while the link is open; does not keep it open. Must be called within a tokio runtime.
    pub fn open(node: &DdsNode, link: &LinkHandle, side: Side) -> Self {
        let others = OtherHands {
            messages: node.reader(&motors::topic(), MOTORS_KEPT),
            node: node.clone(),
        };
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
        let now = (link.clock().now(), since_1970.unwrap_or_default());
        let (counts, view) = watch::channel(DdsCounts::default());
        let encoder = EntryEncoder::live(&Opening::begin(String::new(), now, side));
        let publisher = HandPublisher {
            writers: HandWriters::open(node, side, encoder.lasting(now.0)),
            motors: MotorPair::new(side),
            encoder,
            clock: link.clock(),
            counts,
        };
        let entries = LinkEntries::new(link.observe(), link.clock());
        Self {
            counts: view,
            _task: AbortOnDropHandle::new(tokio::spawn(publisher.run(entries, others))),
        }
    }

    /// Counts so far.
    pub fn counts(&self) -> DdsCounts {
        *self.counts.borrow()
    }
}

/// A hand that is shared on DDS: published there, and announced to the lists of other Handscopes, until dropped.
#[derive(Debug)]
pub struct SharedOnDds {
    /// DDS participant, for other readers and writers.
    pub node: DdsNode,
    publisher: DdsPublisher,
    announcer: FleetAnnouncer,
}

impl SharedOnDds {
    /// Publishes this hand from now on. Must be called within a tokio runtime.
    pub fn open(node: DdsNode, link: &LinkHandle, card: FleetCard) -> Self {
        Self {
            publisher: DdsPublisher::open(&node, link, card.side),
            announcer: FleetAnnouncer::open(&node, link, card),
            node,
        }
    }

    /// Counts so far.
    pub fn counts(&self) -> DdsCounts {
        self.publisher.counts()
    }

    /// Announces the hand with this card from now on.
    pub fn announce(&self, card: FleetCard) {
        self.announcer.announce(card);
    }
}

/// States of both hands of a robot from other participants.
struct OtherHands {
    messages: mpsc::Receiver<DdsMessage>,
    node: DdsNode,
}

struct HandWriters {
    state: DdsWriter,
    motors: DdsWriter,
    joints: DdsWriter,
    touch: [DdsWriter; Finger::ALL.len()],
    grip: DdsWriter,
    frames: DdsWriter,
    /// Keep the model and its fixed frames available for late joiners.
    _lasting: Vec<DdsWriter>,
}

impl HandWriters {
    fn open(node: &DdsNode, side: Side, lasting: [EncodedMessage; 2]) -> Self {
        let letter = match side {
            Side::Left => 'l',
            Side::Right => 'r',
        };
        let [little, ring, middle, index, thumb] =
            Finger::ALL.map(|finger| node.writer(&ros_topic(Topic::Touch(finger))));
        let lasting = lasting.into_iter().map(|message| {
            let writer = node.lasting_writer(&ros_topic(message.topic));
            // Stored for late joiners; no reader exists yet that could be too slow.
            let _kept = writer.send(message.bytes);
            writer
        });
        Self {
            _lasting: lasting.collect(),
            state: node.writer(&DdsTopic {
                name: format!("rt/inspire_hand/state/{letter}"),
                type_name: "inspire::inspire_hand_state".into(),
            }),
            motors: node.writer(&motors::topic()),
            joints: node.writer(&ros_topic(Topic::Joints)),
            touch: [little, ring, middle, index, thumb],
            grip: node.writer(&ros_topic(Topic::Grip)),
            frames: node.writer(&ros_topic(Topic::Frames)),
        }
    }
}

/// Topic and type of ROS 2, with their DDS names.
fn ros_topic(topic: Topic) -> DdsTopic {
    let (package, name) = topic.schema().name.split_once("/msg/").unwrap_or_default();
    DdsTopic {
        name: format!("rt{}", topic.name()),
        type_name: format!("{package}::msg::dds_::{name}_"),
    }
}

struct HandPublisher {
    writers: HandWriters,
    motors: MotorPair,
    encoder: EntryEncoder,
    clock: Clock,
    counts: watch::Sender<DdsCounts>,
}

impl HandPublisher {
    async fn run(mut self, mut entries: LinkEntries, mut others: OtherHands) {
        loop {
            let entry = tokio::select! {
                entry = entries.next() => match entry {
                    Some(entry) => entry,
                    None => return,
                },
                Some(message) = others.messages.recv() => {
                    if !others.node.wrote(&message) {
                        self.motors.receive(&message.bytes, self.clock.now());
                    }
                    continue;
                }
            };
            if let Entry::Heard(Record::Reading { sample, fresh }) = &entry {
                self.state(sample, *fresh);
            }
            if !matches!(entry, Entry::Wire(_)) {
                self.ros(&entry);
            }
        }
    }

    fn state(&self, sample: &HandSample, fresh: Groups) {
        // Each reading of the angles makes one state; groups read with it are part of it.
        if !fresh.contains(Group::Angle) {
            return;
        }
        let now = self.clock.now();
        let Some(state) = InspireState::of(sample, now) else {
            self.counts.send_modify(|counts| counts.incomplete += 1);
            return;
        };
        let is_sent = self.writers.state.send(state.message());
        let motors = self.motors.message(state.angles(), state.celsius(), now);
        let are_sent = motors.is_none_or(|motors| self.writers.motors.send(motors));
        self.counts.send_modify(|counts| {
            counts.states += u64::from(is_sent);
            counts.lost += u64::from(!is_sent) + u64::from(!are_sent);
        });
    }

    fn ros(&mut self, entry: &Entry) {
        for message in self.encoder.encode(entry) {
            let writer = match message.topic {
                Topic::Joints => &self.writers.joints,
                Topic::Grip => &self.writers.grip,
                Topic::Frames => &self.writers.frames,
                Topic::Touch(finger) => {
                    let [little, ring, middle, index, thumb] = &self.writers.touch;
                    match finger {
                        Finger::Little => little,
                        Finger::Ring => ring,
                        Finger::Middle => middle,
                        Finger::Index => index,
                        Finger::Thumb => thumb,
                    }
                }
                _ => continue,
            };
            if !writer.send(message.bytes) {
                self.counts.send_modify(|counts| counts.lost += 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Reply;

    /// CycloneDDS 0.10.2 wrote this of the lists below.
    const CYCLONE: &str = "000100000600000001000200030004000500faff06000000e803e703e603e503e403e30306000000dfff0100020003000400b80b0600000000000100020003000400d007060000000004000000010000060000000202050203020000060000001f2021222324";
    const SHORTS: [[i16; 6]; 4] = [
        [1, 2, 3, 4, 5, -6],
        [1000, 999, 998, 997, 996, 995],
        [-33, 1, 2, 3, 4, 3000],
        [0, 1, 2, 3, 4, 2000],
    ];
    const BYTES: [[u8; 6]; 3] = [
        [0, 4, 0, 0, 0, 1],
        [2, 2, 5, 2, 3, 2],
        [31, 32, 33, 34, 35, 36],
    ];

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    /// All lists in the type's order, with their groups, as memory.
    fn lists() -> Vec<(Group, Vec<u8>)> {
        let shorts = InspireState::SHORTS.into_iter().zip(SHORTS);
        let shorts = shorts.map(|(group, list)| (group, list.map(i16::to_le_bytes).concat()));
        let bytes = InspireState::BYTES.into_iter().zip(BYTES);
        let bytes = bytes.map(|(group, list)| (group, list.to_vec()));
        shorts.chain(bytes).collect()
    }

    fn apply(sample: &mut HandSample, (group, bytes): &(Group, Vec<u8>), asked: Moment) {
        sample.apply(&Reply {
            span: group.span(),
            bytes,
            asked,
            received: asked.plus(Duration::from_millis(2)),
        });
    }

    #[test]
    fn a_state_is_what_cyclonedds_writes() {
        let mut sample = HandSample::default();
        lists()
            .iter()
            .for_each(|list| apply(&mut sample, list, ms(0)));
        let state = InspireState::of(&sample, ms(5)).unwrap();
        let message = state.message();
        let hex = message.iter().map(|byte| format!("{byte:02x}"));
        assert_eq!(hex.collect::<String>(), CYCLONE);
    }

    #[test]
    fn what_was_never_read_or_long_ago_makes_no_state() {
        for left_out in 0..lists().len() {
            let mut sample = HandSample::default();
            for (nth, list) in lists().iter().enumerate() {
                if nth != left_out {
                    apply(&mut sample, list, ms(1000));
                }
            }
            assert_eq!(InspireState::of(&sample, ms(1001)), None, "{left_out}");
            apply(&mut sample, &lists()[left_out], ms(500));
            assert!(InspireState::of(&sample, ms(1500)).is_some());
            assert_eq!(InspireState::of(&sample, ms(1501)), None, "{left_out}");
        }
    }

    #[test]
    fn topics_of_ros_are_named_as_ros_names_them() {
        let joints = ros_topic(Topic::Joints);
        assert_eq!(joints.name, "rt/joint_states");
        assert_eq!(joints.type_name, "sensor_msgs::msg::dds_::JointState_");
        let frames = ros_topic(Topic::FixedFrames);
        assert_eq!(frames.name, "rt/tf_static");
        assert_eq!(frames.type_name, "tf2_msgs::msg::dds_::TFMessage_");
        let touch = ros_topic(Topic::Touch(Finger::Thumb));
        assert_eq!(touch.name, "rt/handscope/touch/thumb");
        assert_eq!(touch.type_name, "handscope_msgs::msg::dds_::Touch_");
    }
}
