//! The model and its frames in a recording, as viewers need them.

use super::{BASE, opening};
use crate::hand::{Group, HandSample, Moment, Reply};
use crate::record::file::format::cdr;
use crate::record::file::format::message::{JointState, TfMessage};
use crate::record::file::format::topic::Topic;
use crate::record::file::reader::{OpenError, RecordingFile};
use crate::record::file::writer::RecordingWriter;
use crate::record::{Entry, Record};
use std::path::Path;
use std::sync::Arc;

/// A reading of six angles.
fn reading(ms: u64, angles: [i16; 6]) -> Entry {
    let at = Moment::from_micros(2_000_000 + ms * 1000);
    let mut sample = HandSample::default();
    let fresh = sample.apply(&Reply {
        span: Group::Angle.span(),
        bytes: &angles.map(i16::to_le_bytes).concat(),
        asked: at,
        received: at,
    });
    Entry::Heard(Record::Reading {
        sample: Arc::new(sample),
        fresh,
    })
}

/// Messages in the order of the file, with their log times.
fn messages(path: &Path) -> Vec<(Topic, u64, Vec<u8>)> {
    let file = RecordingFile::open(path).unwrap();
    let mut all = Vec::new();
    let whole = (Moment::ZERO, Moment::from_micros(u64::MAX / 2000));
    let damage = file.messages(whole.0, whole.1, |topic, (log, _), bytes| {
        all.push((topic, log, bytes.to_vec()));
    });
    assert_eq!(
        damage.unwrap(),
        crate::record::file::reader::Damage::default()
    );
    assert_eq!(file.remarks(), []);
    all
}

fn write(
    folder: &Path,
    writer: &mut RecordingWriter,
    entries: impl Iterator<Item = Entry>,
) -> Vec<(Topic, u64, Vec<u8>)> {
    entries.for_each(|entry| writer.push(&entry).unwrap());
    writer.finish().unwrap();
    let path = folder.join("a.mcap");
    std::fs::write(&path, writer.take_bytes()).unwrap();
    messages(&path)
}

#[test]
fn each_file_of_a_recording_begins_with_the_model_and_its_fixed_frames() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = RecordingWriter::new(&opening()).unwrap();
    let mut next = first.next(&opening()).unwrap();
    for writer in [&mut first, &mut next] {
        let entries = (0..3).map(|nth| reading(nth * 10, [400; 6]));
        let all = write(folder.path(), writer, entries);
        let topics: Vec<Topic> = all.iter().map(|(topic, ..)| *topic).collect();
        assert_eq!(topics[..2], [Topic::Description, Topic::FixedFrames]);
        for lasting in [Topic::Description, Topic::FixedFrames] {
            assert_eq!(topics.iter().filter(|topic| **topic == lasting).count(), 1);
        }
        let model: String = cdr::decode(&all[0].2).unwrap();
        let frames: TfMessage = cdr::decode(&all[1].2).unwrap();
        assert_eq!(frames.transforms.len(), 5);
        for frame in frames.transforms {
            for name in [frame.header.frame_id, frame.child_frame_id] {
                assert!(model.contains(&format!("<link name=\"{name}\"")), "{name}");
            }
        }
        // Nothing is older than what was recorded first.
        let times: Vec<u64> = all.iter().map(|(_, log, _)| *log).collect();
        assert!(times.is_sorted(), "{times:?}");
    }
}

#[test]
fn frames_have_the_time_of_the_joints_and_only_known_angles() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = RecordingWriter::new(&opening()).unwrap();
    // Two seconds of movement; then the index finger sends what the manual does not know, and later all do.
    let moving = (0..200).map(|nth| reading(nth * 10, [i16::try_from(nth).unwrap(); 6]));
    let index = (200..300).map(|nth| reading(nth * 10, [500, 500, 500, 2000, 500, 500]));
    let none = (300..400).map(|nth| reading(nth * 10, [-9; 6]));
    let all = write(folder.path(), &mut writer, moving.chain(index).chain(none));
    let of = |wanted| all.iter().filter(move |(topic, ..)| *topic == wanted);
    let joints: Vec<(u64, JointState)> = of(Topic::Joints)
        .map(|(_, log, bytes)| (*log, cdr::decode(bytes).unwrap()))
        .collect();
    let frames: Vec<(u64, TfMessage)> = of(Topic::Frames)
        .map(|(_, log, bytes)| (*log, cdr::decode(bytes).unwrap()))
        .collect();
    assert_eq!((joints.len(), frames.len()), (400, 21));
    for (log, message) in &frames {
        let (_, joints) = joints.iter().find(|(own, _)| own == log).unwrap();
        let known = joints.position.iter().filter(|radians| !radians.is_nan());
        assert_eq!(known.count(), message.transforms.len());
        assert!(
            message
                .transforms
                .iter()
                .all(|frame| frame.header.stamp == joints.header.stamp)
        );
    }
    assert_eq!(frames[0].1.transforms.len(), 12);
    let last = &frames[20].1.transforms;
    let names: Vec<&str> = last
        .iter()
        .map(|frame| frame.child_frame_id.as_str())
        .collect();
    assert_eq!(names.len(), 10);
    assert!(!names.contains(&"left_index_1") && !names.contains(&"left_index_2"));
}

#[test]
fn a_file_with_the_frames_of_another_robot_is_no_recording() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.mcap");
    let mut writer = mcap::Writer::new(std::fs::File::create(&path).unwrap()).unwrap();
    for topic in Topic::all().filter(|topic| topic.is_common()) {
        let schema = topic.schema();
        let text = schema.text.as_bytes();
        let schema = writer.add_schema(schema.name, "ros2msg", text).unwrap();
        let none = std::collections::BTreeMap::new();
        let channel = writer
            .add_channel(schema, topic.name(), "cdr", &none)
            .unwrap();
        let header = mcap::records::MessageHeader {
            channel_id: channel,
            sequence: 1,
            log_time: BASE,
            publish_time: BASE,
        };
        writer
            .write_to_known_channel(&header, &cdr::encode(&TfMessage::default()))
            .unwrap();
    }
    writer.finish().unwrap();
    let refused = RecordingFile::open(&path);
    assert!(matches!(refused, Err(OpenError::Foreign)), "{refused:?}");
}
