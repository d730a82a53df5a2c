//! Files that other programs have rewritten: other numbers, another order, chunks or none, other compressions, an index or none, or one
//! that does not fit; and files of which a bit is flipped.

#![expect(
    clippy::cast_possible_truncation,
    reason = "files of tests are small, and clippy.toml cannot excuse them"
)]

use super::{Atom, atoms, bytes_of, entries, opening, read};
use crate::record::Entry;
use crate::record::file::channels::SkipReason;
use crate::record::file::damage::{Damage, Remark};
use crate::record::file::format::opening::METADATA;
use crate::record::file::reader::{OpenError, RecordingFile, TimeRange};
use crate::record::file::walk::{self, ChunkKind, survey, whole};
use crate::record::file::writer::RecordingWriter;
use crate::soak;
use mcap::records::{MessageHeader, Metadata, op};
use mcap::{Compression, Message, MessageStream, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::ops::ControlFlow;
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What another program makes of a recording.
#[derive(Clone)]
struct Rewrite {
    /// What our numbers of channels become.
    number: fn(u16) -> u16,
    /// The order of the messages.
    order: fn(&mut Vec<One>),
    options: WriteOptions,
    /// Whether the end tells where what stands.
    index: bool,
    /// What the file says of itself.
    metadata: Vec<BTreeMap<String, String>>,
    /// The encoding of the messages of one topic, and the name of its schema.
    other: Option<(&'static str, &'static str, &'static str)>,
}

impl Rewrite {
    fn new() -> Self {
        Self {
            number: |number| 90 - 3 * number,
            order: |_| (),
            options: WriteOptions::new().profile("ros2").library("another"),
            index: true,
            metadata: vec![opening().metadata()],
            other: None,
        }
    }

    fn with(mut self, options: impl FnOnce(WriteOptions) -> WriteOptions) -> Self {
        self.options = options(self.options);
        self
    }

    fn writer(&self) -> Writer<Cursor<Vec<u8>>> {
        let options = if self.index {
            self.options.clone()
        } else {
            self.options
                .clone()
                .emit_summary_records(false)
                .emit_summary_offsets(false)
                .emit_message_indexes(false)
        };
        let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
        for metadata in &self.metadata {
            let (name, metadata) = (METADATA.into(), metadata.clone());
            writer.write_metadata(&Metadata { name, metadata }).unwrap();
        }
        writer
    }

    fn write(&self, messages: &[One], writer: &mut Writer<Cursor<Vec<u8>>>) {
        for message in messages {
            let number = (self.number)(message.header.channel_id);
            let (mut name, mut encoding) = (message.name.as_str(), "cdr");
            if let Some((topic, other, form)) = self.other
                && topic == message.topic
            {
                (name, encoding) = (other, form);
            }
            let id = (self.number)(message.schema) + u16::from(name != message.name);
            writer
                .add_schema_with_id(id, name, "ros2msg", &message.text)
                .unwrap();
            let none = BTreeMap::new();
            writer
                .add_channel_with_id(number, id, &message.topic, encoding, &none)
                .unwrap();
            let header = MessageHeader {
                channel_id: number,
                ..message.header
            };
            writer
                .write_to_known_channel(&header, &message.data)
                .unwrap();
        }
    }

    fn of(&self, bytes: &[u8]) -> Vec<u8> {
        let mut messages = messages(bytes);
        (self.order)(&mut messages);
        let mut writer = self.writer();
        self.write(&messages, &mut writer);
        writer.finish().unwrap();
        writer.into_inner().into_inner()
    }
}

/// A message, and what its channel is.
#[derive(Clone)]
struct One {
    header: MessageHeader,
    schema: u16,
    topic: String,
    name: String,
    text: Vec<u8>,
    data: Vec<u8>,
}

fn messages(bytes: &[u8]) -> Vec<One> {
    let stream = MessageStream::new(bytes).unwrap();
    let one = |message: Message<'_>| {
        let schema = message.channel.schema.as_ref().unwrap();
        One {
            header: MessageHeader {
                channel_id: message.channel.id,
                sequence: message.sequence,
                log_time: message.log_time,
                publish_time: message.publish_time,
            },
            schema: schema.id,
            topic: message.channel.topic.clone(),
            name: schema.name.clone(),
            text: schema.data.to_vec(),
            data: message.data.to_vec(),
        }
    };
    stream.map(|message| one(message.unwrap())).collect()
}

/// A recording, and a place for what is made of it.
struct Recording {
    bytes: Vec<u8>,
    wanted: Vec<Atom>,
    folder: TempDir,
}

impl Recording {
    fn new(count: u64) -> Self {
        let entries = entries(11, count);
        Self {
            bytes: bytes_of(&entries),
            wanted: entries.iter().flat_map(atoms).collect(),
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("a.mcap")
    }

    fn read(&self, bytes: &[u8]) -> (Vec<Atom>, RecordingFile, Damage) {
        std::fs::write(self.path(), bytes).unwrap();
        read(&self.path()).unwrap()
    }
}

#[test]
fn a_recording_that_another_program_rewrote_gives_the_same_entries() {
    let recording = Recording::new(3000);
    let (all, own, damage) = recording.read(&recording.bytes);
    assert_eq!((all, damage), (recording.wanted.clone(), Damage::default()));
    assert_eq!(own.remarks(), []);
    let backwards: fn(&mut Vec<One>) = |all| all.reverse();
    let by_topic: fn(&mut Vec<One>) = |all| all.sort_by_key(|one| one.header.channel_id);
    let shuffled: fn(&mut Vec<One>) = |all| fastrand::Rng::with_seed(3).shuffle(all.as_mut_slice());
    let plain = Rewrite::new();
    let small = |options: WriteOptions| options.chunk_size(Some(10_000));
    let mut same = plain.clone().with(small);
    same.number = |number| number;
    let mut unindexed = plain.clone().with(small);
    unindexed.index = false;
    let ordered = |order| {
        let mut rewrite = plain.clone().with(small);
        rewrite.order = order;
        rewrite
    };
    let loose = |order| {
        let mut rewrite = plain.clone().with(|options| options.use_chunks(false));
        rewrite.order = order;
        rewrite
    };
    let compressed = |by| plain.clone().with(|options| options.compression(by));
    for (what, rewrite) in [
        ("other numbers", plain.clone()),
        ("our numbers", same.clone()),
        (
            "our name",
            same.with(|options| options.library("handscope 0.1.0")),
        ),
        ("not compressed", compressed(None)),
        ("lz4", compressed(Some(Compression::Lz4))),
        ("zstd", compressed(Some(Compression::Zstd))),
        ("backwards", ordered(backwards)),
        ("topic after topic", ordered(by_topic)),
        ("in any order", ordered(shuffled)),
        ("no chunks", loose(|_| ())),
        ("no chunks, in any order", loose(shuffled)),
        ("no index", unindexed),
    ] {
        let (all, file, damage) = recording.read(&rewrite.of(&recording.bytes));
        assert!(all == recording.wanted, "{what}: {} entries", all.len());
        assert_eq!(damage, Damage::default(), "{what}");
        assert_eq!(file.remarks(), [Remark::Rewritten], "{what}");
        assert_eq!(file.opening(), own.opening(), "{what}");
        let (one, two) = (own.overview(), file.overview());
        assert_eq!((one.counts, &one.marks), (two.counts, &two.marks), "{what}");
    }
}

#[test]
fn more_messages_than_are_held_at_once_are_put_in_order_all_the_same() {
    let recording = Recording::new(20_000);
    let mut rewrite = Rewrite::new();
    rewrite.order = |all| all.reverse();
    let (all, ..) = recording.read(&rewrite.of(&recording.bytes));
    assert_eq!(all.len(), recording.wanted.len());
    assert!(all == recording.wanted);
}

#[test]
fn what_is_not_ours_is_named_and_what_is_ours_in_another_form_too() {
    let recording = Recording::new(200);
    let mut rewrite = Rewrite::new();
    rewrite.other = Some(("/handscope/touch/ring", "handscope_msgs/msg/Tip", "cdr"));
    let skipped = |rewrite: &Rewrite| {
        let (_, file, _) = recording.read(&rewrite.of(&recording.bytes));
        let remarks = file.remarks().to_vec();
        let skipped = remarks.into_iter().filter_map(|remark| match remark {
            Remark::Skipped(skipped) => Some(skipped),
            _ => None,
        });
        skipped.collect::<Vec<_>>()
    };
    let skipped_topics = skipped(&rewrite);
    assert_eq!(skipped_topics.len(), 1);
    assert_eq!(
        (skipped_topics[0].topic.as_str(), skipped_topics[0].why),
        ("/handscope/touch/ring", SkipReason::OtherSchema)
    );
    assert!(
        skipped_topics[0].is_ours() && skipped_topics[0].messages > 10,
        "{skipped_topics:?}"
    );
    rewrite.other = Some(("/handscope/state", "handscope_msgs/msg/State", "json"));
    let skipped_topics = skipped(&rewrite);
    assert_eq!(
        (skipped_topics[0].encoding.as_str(), skipped_topics[0].why),
        ("json", SkipReason::OtherSchema)
    );
    // A stranger beside ours.
    rewrite.other = None;
    let mut writer = rewrite.writer();
    rewrite.write(&messages(&recording.bytes), &mut writer);
    let schema = writer
        .add_schema("tf2_msgs/msg/TFMessage", "ros2msg", b"int32 a")
        .unwrap();
    let channel = writer
        .add_channel(schema, "/tf", "cdr", &BTreeMap::new())
        .unwrap();
    let header = MessageHeader {
        channel_id: channel,
        sequence: 1,
        log_time: super::BASE + 2_100_000_000,
        publish_time: 0,
    };
    writer
        .write_to_known_channel(&header, &[0, 1, 0, 0, 9, 0, 0, 0])
        .unwrap();
    writer.finish().unwrap();
    let (all, file, _) = recording.read(&writer.into_inner().into_inner());
    assert!(all == recording.wanted);
    let words: Vec<String> = file.remarks().iter().map(ToString::to_string).collect();
    let tf = "skipped: topic /tf with schema 'tf2_msgs/msg/TFMessage' in 'cdr', 1 messages: not Handscope's";
    assert_eq!(words[1], tf);
}

#[test]
fn recordings_of_several_hands_in_one_file_are_not_mixed() {
    let recording = Recording::new(50);
    let mut rewrite = Rewrite::new();
    let mut other = opening();
    other.hand = "tcp:127.0.0.1:6000".into();
    rewrite.metadata.push(other.metadata());
    std::fs::write(recording.path(), rewrite.of(&recording.bytes)).unwrap();
    let refused = RecordingFile::open(&recording.path()).unwrap_err();
    let hands = "sim:?seed=3, tcp:127.0.0.1:6000".to_owned();
    assert_eq!(refused, OpenError::SeveralHands { hands });
}

#[test]
fn a_recording_without_what_it_said_of_itself_is_not_said_to_be_of_a_real_hand() {
    let recording = Recording::new(50);
    let mut rewrite = Rewrite::new();
    rewrite.metadata.clear();
    let (all, file, _) = recording.read(&rewrite.of(&recording.bytes));
    assert_eq!(all.len(), recording.wanted.len());
    assert_eq!(file.opening().is_simulated(), None);
    assert!(file.remarks().contains(&Remark::OpeningLost));
}

/// Where records begin, and their codes.
fn records(bytes: &[u8]) -> Vec<(usize, u8)> {
    let (mut at, mut all) = (8, Vec::new());
    while at + 9 <= bytes.len() - 8 {
        all.push((at, bytes[at]));
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    all
}

/// The data of one file, and the index of another. No sum is over the index.
fn spliced(data: &[u8], index: &[u8]) -> Vec<u8> {
    let behind = |bytes: &[u8]| {
        records(bytes)
            .iter()
            .find(|(_, code)| *code == op::DATA_END)
            .unwrap()
            .0
            + 13
    };
    let mut all = data[..behind(data)].to_vec();
    let start = all.len() as u64;
    all.extend(&index[behind(index)..]);
    let footer = all.len() - 8 - 20;
    all[footer..footer + 8].copy_from_slice(&start.to_le_bytes());
    all[footer + 16..footer + 20].fill(0);
    all
}

#[test]
fn a_stale_index_is_told_and_gone_around() {
    let recording = Recording::new(1500);
    let rewrite = Rewrite::new().with(|options| options.chunk_size(Some(10_000)));
    let whole = rewrite.of(&recording.bytes);
    let mut half = rewrite.clone();
    half.order = |all| all.truncate(all.len() / 2);
    let half = half.of(&recording.bytes);
    let mut longer = rewrite.clone();
    longer.metadata.push(opening().metadata());
    let longer = longer.of(&recording.bytes);
    // Of our own file, too: its index with a sum that is right for a shorter one.
    let ours = {
        let all = entries(11, 1500);
        let part = bytes_of(&all[..all.len() / 2]);
        let mut stale = spliced(&recording.bytes, &part);
        let start = stale.len() - 8 - 20;
        let summary = u64::from_le_bytes(stale[start..start + 8].try_into().unwrap()) as usize;
        let sum = crc32fast::hash(&stale[summary..start + 16]);
        stale[start + 16..start + 20].copy_from_slice(&sum.to_le_bytes());
        stale
    };
    for (what, bytes) in [
        ("it misses messages", spliced(&whole, &half)),
        (
            "its places are those of another file",
            spliced(&whole, &longer),
        ),
        ("ours, and it misses messages", ours),
    ] {
        let (all, file, damage) = recording.read(&bytes);
        assert!(all == recording.wanted, "{what}: {}", all.len());
        assert!(file.remarks().contains(&Remark::StaleIndex), "{what}");
        assert_eq!(damage.chunks, 0, "{what}");
    }
}

#[test]
fn a_flipped_bit_outside_of_chunks_is_told_where_the_file_has_a_sum() {
    let recording = Recording::new(100);
    let rewrite = Rewrite::new().with(|options| options.use_chunks(false));
    let mut bytes = rewrite.of(&recording.bytes);
    let messages = records(&bytes);
    let (message, _) = messages
        .iter()
        .filter(|(_, code)| *code == op::MESSAGE)
        .nth(50)
        .unwrap();
    bytes[message + 60] ^= 4;
    let (_, file, _) = recording.read(&bytes);
    assert!(file.remarks().contains(&Remark::SumDiffers));
}

/// A short recording, closed or not.
fn short(closed: bool) -> (Vec<u8>, Vec<Atom>) {
    let entries: Vec<Entry> = entries(4, 40);
    let mut writer = RecordingWriter::new(&opening()).unwrap();
    for (number, entry) in entries.iter().enumerate() {
        writer.push(entry).unwrap();
        if number % 15 == 14 {
            writer.flush().unwrap();
        }
    }
    writer.flush().unwrap();
    if closed {
        writer.finish().unwrap();
    }
    (
        writer.take_bytes(),
        entries.iter().flat_map(atoms).collect(),
    )
}

/// Bits that are flipped: all of each record's head, of what the file says of itself and of what ends it, and a share of the others.
fn bits(bytes: &[u8]) -> Vec<usize> {
    let mut random = fastrand::Rng::with_seed(8);
    let records = if bytes.ends_with(b"\x89MCAP0\r\n") {
        records(bytes)
    } else {
        let mut longer = bytes.to_vec();
        longer.extend([0; 8]);
        records(&longer)
    };
    let is_structure = |byte: usize| {
        let (at, code) = *records.iter().rev().find(|(at, _)| *at <= byte).unwrap();
        byte - at < 57 && (code == op::CHUNK || code == op::DATA_END)
            || byte - at < 9 && code != op::MESSAGE_INDEX
            || code == op::METADATA
            || code == op::FOOTER
    };
    let all = 64..bytes.len() * 8;
    all.filter(|bit| is_structure(bit / 8) || random.u32(0..200) == 0)
        .collect()
}

#[test]
fn no_flipped_bit_of_a_recording_makes_it_wrong_or_shorter_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    for closed in [true, false] {
        let (bytes, written) = short(closed);
        let path = folder.path().join("a.mcap");
        std::fs::write(&path, &bytes).unwrap();
        let (all, file, damage) = read(&path).unwrap();
        assert_eq!((all.len(), damage), (written.len(), Damage::default()));
        assert_eq!((file.is_closed(), file.remarks()), (closed, [].as_slice()));
        let bits = bits(&bytes);
        assert!(bits.len() > 3000, "{}", bits.len());
        let disk = std::fs::File::options().write(true).open(&path).unwrap();
        let each = if soak::is_full() { 1 } else { 13 };
        for bit in bits.into_iter().step_by(each) {
            let (place, flipped) = (bit / 8, bytes[bit / 8] ^ 1 << (bit % 8));
            disk.write_all_at(&[flipped], place as u64).unwrap();
            check_flipped(
                &path,
                &written,
                &format!("bit {} of byte {place}, {closed}", bit % 8),
            );
            disk.write_all_at(&bytes[place..=place], place as u64)
                .unwrap();
        }
    }
}

fn check_flipped(path: &Path, written: &[Atom], say: &str) {
    let (all, file, damage) = read(path).unwrap_or_else(|| panic!("{say}: it does not open"));
    let is_lost = file.remarks().contains(&Remark::OpeningLost);
    if is_lost {
        // Its moments count from another time then, and the values are the same.
        assert_eq!(file.opening().is_simulated(), None, "{say}");
        let values = |atoms: &[Atom]| {
            let groups = atoms.iter().filter_map(|atom| match atom {
                Atom::Group(group, _, _, bytes) => Some((*group, bytes.clone())),
                Atom::Other(_) => None,
            });
            groups.collect::<Vec<_>>()
        };
        let wanted = values(written);
        let mut rest = wanted.iter();
        assert!(
            values(&all)
                .iter()
                .all(|value| rest.any(|one| one == value)),
            "{say}"
        );
    } else {
        assert_eq!(file.opening(), &opening(), "{say}");
        let mut rest = written.iter();
        assert!(all.iter().all(|atom| rest.any(|one| one == atom)), "{say}");
    }
    if all.len() < written.len() {
        let text = format!("{say}: {} of {}, {damage:?}", all.len(), written.len());
        assert_ne!(damage, Damage::default(), "{text}");
    }
}

#[test]
fn what_is_missing_is_found_by_the_numbers_of_the_messages_and_as_long_as_it_was() {
    let recording = Recording::new(600);
    let places = records(&recording.bytes);
    let chunks: Vec<usize> = places
        .iter()
        .filter(|(_, code)| *code == op::CHUNK)
        .map(|(at, _)| *at)
        .collect();
    // Two chunks amid are not there at all, nor is the end of the file.
    let end = places
        .iter()
        .find(|(_, code)| *code == op::DATA_END)
        .unwrap()
        .0;
    let (from, to) = (chunks[5], chunks[7]);
    let bytes = [&recording.bytes[..from], &recording.bytes[to..end]].concat();
    let (all, _, damage) = recording.read(&bytes);
    assert_eq!((damage.chunks, damage.bytes), (0, 0), "{damage:?}");
    assert_eq!(damage.gaps.len(), 1);
    let lost = recording.wanted.len() - all.len();
    assert!(damage.messages > 50 && lost > 50, "{damage:?}, {lost}");
    let time = |at: usize| u64::from_le_bytes(recording.bytes[at + 9..at + 17].try_into().unwrap());
    let length = damage.length().as_nanos() as u64;
    assert!(
        length.abs_diff(time(to) - time(from)) < 5_000_000,
        "{damage:?}"
    );
}

/// Seconds of all entries from the recording's start.
fn seconds(file: &RecordingFile) -> Vec<u64> {
    let mut all = Vec::new();
    let each = |entry: Entry| {
        let from_start = entry.at().since(file.first());
        all.push(u64::try_from(from_start.as_micros()).unwrap());
        ControlFlow::Continue(())
    };
    file.entries(TimeRange::WHOLE, each).unwrap();
    all
}

#[test]
fn the_log_of_a_file_is_believed_and_how_it_differs_from_the_messages_is_told() {
    const HOUR: u64 = 3_600_000_000_000;
    let recording = Recording::new(3000);
    let (_, own, _) = recording.read(&recording.bytes);
    let wanted = seconds(&own);
    let earlier: fn(&mut Vec<One>) = |all| {
        all.iter_mut().for_each(|one| one.header.log_time -= HOUR);
    };
    let later: fn(&mut Vec<One>) = |all| {
        all.iter_mut()
            .for_each(|one| one.header.log_time += 10_000_000_000);
    };
    let from_zero: fn(&mut Vec<One>) = |all| {
        let first = all[0].header.log_time;
        all.iter_mut().for_each(|one| one.header.log_time -= first);
    };
    let unlogged: fn(&mut Vec<One>) = |all| {
        all.iter_mut()
            .take(40)
            .for_each(|one| one.header.log_time = 0);
    };
    for (what, order, moved_s, is_unlogged) in [
        ("an hour", earlier, Some(-3600), false),
        ("ten seconds", later, Some(10), false),
        ("from 0", from_zero, None, true),
        ("40 without", unlogged, Some(0), true),
    ] {
        for has_metadata in [true, false] {
            let mut rewrite = Rewrite::new().with(|options| options.chunk_size(Some(10_000)));
            rewrite.order = order;
            if !has_metadata {
                rewrite.metadata.clear();
            }
            let (_, file, damage) = recording.read(&rewrite.of(&recording.bytes));
            let what = format!("{what}, metadata {has_metadata}");
            let found = seconds(&file);
            assert_eq!(found.len(), wanted.len(), "{what}");
            // Without what the file says of itself it begins with its first message.
            let begins = if has_metadata { 0 } else { wanted[0] };
            let differ = |(a, b): (&u64, &u64)| a.abs_diff(b.saturating_sub(begins)) > 2000;
            let differing = found
                .iter()
                .zip(&wanted)
                .filter(|pair| differ(*pair))
                .count();
            assert_eq!(differing, 0, "{what}: {found:?}");
            assert_eq!(damage, Damage::default(), "{what}");
            let mut remarks = file.remarks().iter();
            let shift_s = remarks.clone().find_map(|remark| match remark {
                Remark::LogMoved { nanos } => Some((nanos + 500_000_000).div_euclid(1_000_000_000)),
                _ => None,
            });
            if let Some(moved_s) = moved_s {
                assert_eq!(shift_s.unwrap_or_default(), moved_s, "{what}");
            } else {
                assert!(shift_s.unwrap() < -1_000_000_000, "{what}");
            }
            let has_unlogged = remarks.any(|remark| matches!(remark, Remark::Unlogged(_)));
            assert_eq!(has_unlogged, is_unlogged, "{what}");
        }
    }
}

#[test]
fn topics_in_a_namespace_are_those_of_one_hand() {
    let recording = Recording::new(500);
    let mut rewrite = Rewrite::new();
    rewrite.order = |all| {
        all.iter_mut()
            .for_each(|one| one.topic.insert_str(0, "/right"))
    };
    let (all, ..) = recording.read(&rewrite.of(&recording.bytes));
    assert!(all == recording.wanted, "{} entries", all.len());
    // Of two hands, values would be mixed.
    rewrite.number = |number| number;
    rewrite.order = |all| {
        let mut other = all.clone();
        all.iter_mut()
            .for_each(|one| one.topic.insert_str(0, "/right"));
        for one in &mut other {
            one.topic.insert_str(0, "/lab/left");
            one.header.channel_id += 100;
        }
        all.append(&mut other);
    };
    std::fs::write(recording.path(), rewrite.of(&recording.bytes)).unwrap();
    let refused = RecordingFile::open(&recording.path()).unwrap_err();
    let hands = "/lab/left, /right".to_owned();
    assert_eq!(refused, OpenError::SeveralHands { hands });
}

/// A recording with so many pictures of so many bytes between its messages.
fn with_pictures(
    recording: &Recording,
    rewrite: &Rewrite,
    count: usize,
    picture: &[u8],
) -> Vec<u8> {
    let mut writer = rewrite.writer();
    let messages = messages(&recording.bytes);
    let part = messages.len() / (count + 1);
    let mut parts = messages.chunks(part.max(1));
    let schema = writer
        .add_schema("sensor_msgs/msg/Image", "ros2msg", b"uint8[] data")
        .unwrap();
    for nth in 0..count {
        rewrite.write(parts.next().unwrap_or_default(), &mut writer);
        let channel = writer
            .add_channel(schema, "/camera", "cdr", &BTreeMap::new())
            .unwrap();
        let header = MessageHeader {
            channel_id: channel,
            sequence: u32::try_from(nth).unwrap(),
            log_time: super::BASE + 2_100_000_000,
            publish_time: 0,
        };
        writer.write_to_known_channel(&header, picture).unwrap();
    }
    parts.for_each(|part| rewrite.write(part, &mut writer));
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

#[test]
fn pictures_beside_ours_and_all_in_one_chunk_are_no_hindrance() {
    let recording = Recording::new(300);
    let mut random = fastrand::Rng::with_seed(1);
    let picture: Vec<u8> = (0..9_000_000).map(|_| random.u8(..)).collect();
    let none = Rewrite::new().with(|options| options.compression(None));
    let one_chunk = none
        .clone()
        .with(|options| options.chunk_size(Some(1 << 40)));
    for (what, rewrite) in [
        ("pictures", &none),
        (
            "compressed",
            &Rewrite::new().with(|options| options.compression(Some(Compression::Lz4))),
        ),
        ("one chunk", &one_chunk),
    ] {
        let bytes = with_pictures(&recording, rewrite, 2, &picture);
        let (all, file, damage) = recording.read(&bytes);
        assert!(all == recording.wanted, "{what}: {} entries", all.len());
        assert_eq!(damage, Damage::default(), "{what}");
        assert!(!file.remarks().contains(&Remark::StaleIndex), "{what}");
    }
    // A long chunk that is damaged gives nothing, and is counted.
    let mut bytes = with_pictures(&recording, &one_chunk, 1, &picture);
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(recording.path(), &bytes).unwrap();
    let refused = RecordingFile::open(&recording.path()).unwrap_err();
    assert_eq!(refused, OpenError::Empty);
}

#[test]
fn chunks_that_unpack_to_far_more_than_the_file_are_left_out_and_told() {
    let recording = Recording::new(50);
    let rewrite = Rewrite::new().with(|options| {
        options
            .compression(Some(Compression::Zstd))
            .chunk_size(Some(10_000))
    });
    let bytes = with_pictures(&recording, &rewrite, 20, &vec![0; 7 * 1024 * 1024]);
    assert!(bytes.len() < 200_000, "{} bytes", bytes.len());
    let (_, file, damage) = recording.read(&bytes);
    let left_out = file.remarks().iter().find_map(|remark| match remark {
        Remark::TooMuch { megabytes } => Some(*megabytes),
        _ => None,
    });
    // 140 MB in all, of which 64 and a hundred times the file's length are unpacked.
    assert!((60..=82).contains(&left_out.unwrap()), "{left_out:?}");
    assert!(damage.chunks >= 7, "{damage:?}");
}

#[test]
fn a_chunk_of_ours_does_not_unpack_to_hundreds_of_times_its_length() {
    let recording = Recording::new(50);
    let rewrite = Rewrite::new().with(|options| options.compression(Some(Compression::Zstd)));
    for (len, is_ours) in [(1000, true), (7 * 1024 * 1024, false)] {
        let bytes = with_pictures(&recording, &rewrite, 1, &vec![0; len]);
        let found = survey(&mut Cursor::new(&bytes)).unwrap().found;
        let mut is_whole = true;
        for chunk in found.chunks {
            let mut bytes = whole(&mut Cursor::new(&bytes), chunk.place).unwrap();
            is_whole &= walk::messages(&mut bytes, ChunkKind::Chunk, |_| ());
        }
        assert_eq!(is_whole, is_ours, "{len}");
    }
}
