//! Recordings written and read back: whole, cut at any byte, with flipped bits, on disks that fail.

mod failing;
mod model;
mod parts;
mod rewritten;
mod unended;

use crate::hand::command::HandCommand;
use crate::hand::kinematics::Side;
use crate::hand::{
    Angle, Dof, Group, Groups, HandSample, Moment, PerDof, Reply, Span, Target, register,
};
use crate::record::file::Contents;
use crate::record::file::format::opening::Opening;
use crate::record::file::reader::{Damage, RecordingFile, TimeRange};
use crate::record::file::writer::RecordingWriter;
use crate::record::{
    ArmRefusal, Direction, Entry, Event, EventKind, LinkReport, LinkState, Piece, PieceKind,
    Record, WriteCause, WriteFate,
};
use crate::soak;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

pub(crate) const BASE: u64 = 1_795_219_200_000_000_123;

pub(crate) fn opening() -> Opening {
    Opening {
        base_nanos: BASE,
        began: Moment::from_micros(2_000_000),
        hand: "sim:?seed=3".into(),
        simulated: true,
        side: Side::Left,
        newtons_per_g: PerDof::splat(None),
        version: "0.1.0".into(),
        part: None,
    }
}

/// Entries as a busy link tells them, `count` readings 2 ms apart.
pub(crate) fn entries(seed: u64, count: u64) -> Vec<Entry> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut sample = HandSample::default();
    let mut all = Vec::new();
    let at = Moment::from_micros(2_000_000);
    all.push(Entry::Heard(Record::State {
        at,
        state: LinkState::Monitoring,
    }));
    for number in 0..count {
        let received = Moment::from_micros(2_000_000 + number * 2000 + 700);
        let asked = Moment::from_micros(2_000_000 + number * 2000);
        let span = match random.u8(0..4) {
            0 => register::STATE,
            1 => Span::new(3000, 174),
            2 => Span::new(1486, 48),
            _ => Span::new(1534, 36),
        };
        let bytes: Vec<u8> = (0..span.len).map(|_| random.u8(..)).collect();
        let fresh = sample.apply(&Reply {
            span,
            bytes: &bytes,
            asked,
            received,
        });
        all.push(Entry::Heard(Record::Reading {
            sample: Arc::new(sample),
            fresh,
        }));
        all.push(Entry::Wire(Piece {
            at: received,
            kind: PieceKind::Bytes(Direction::FromHand),
            bytes,
        }));
        if number % 50 == 7 {
            others(number, received, &mut all);
        }
    }
    all
}

fn others(number: u64, at: Moment, all: &mut Vec<Entry>) {
    let angle = Angle::new(500).unwrap();
    let command = HandCommand::Angles(PerDof::splat(Some(Target::Go(angle))));
    let write = command.writes().first().unwrap().into();
    let cause = WriteCause::Setpoint;
    all.extend([
        Entry::Heard(Record::Sent {
            at,
            number,
            cause,
            write,
        }),
        Entry::Heard(Record::Answered {
            at,
            number,
            fate: WriteFate::Refused {
                reason: "exception 3".into(),
            },
        }),
        Entry::Heard(Record::ArmRefused {
            at,
            reason: ArmRefusal::UnknownPose { dof: Dof::Index },
        }),
        Entry::Link(LinkReport {
            at,
            state: LinkState::Monitoring,
            trouble: String::new(),
            status: "{}".into(),
            figures: String::new(),
        }),
        Entry::Event(Event {
            at,
            kind: EventKind::Note,
            words: format!("Griff {number} 捏"),
        }),
    ]);
}

/// One thing that a file must not change: a group of a reading, or another entry.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Atom {
    Group(Group, Moment, Moment, Vec<u8>),
    Other(Box<Entry>),
}

pub(crate) fn atoms(entry: &Entry) -> Vec<Atom> {
    let Entry::Heard(Record::Reading { sample, fresh }) = entry else {
        return vec![Atom::Other(Box::new(entry.clone()))];
    };
    let own = Group::ALL
        .into_iter()
        .filter(|group| fresh.contains(*group));
    own.filter_map(|group| {
        let (asked, received) = sample.times(group)?;
        Some(Atom::Group(group, asked, received, sample.memory(group)?))
    })
    .collect()
}

pub(crate) fn bytes_of(entries: &[Entry]) -> Vec<u8> {
    let mut writer = RecordingWriter::new(&opening()).unwrap();
    for (number, entry) in entries.iter().enumerate() {
        writer.push(entry).unwrap();
        if number % 60 == 59 {
            writer.flush().unwrap();
        }
    }
    writer.finish().unwrap();
    writer.take_bytes()
}

pub(crate) fn read(path: &Path) -> Option<(Vec<Atom>, RecordingFile, Damage)> {
    let file = RecordingFile::open(path).ok()?;
    let mut all = Vec::new();
    let damage = file
        .entries(TimeRange::WHOLE, |entry| {
            all.extend(atoms(&entry));
            ControlFlow::Continue(())
        })
        .unwrap();
    Some((all, file, damage))
}

#[test]
fn what_is_written_is_read_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let entries = entries(1, 40_000);
    std::fs::write(&path, bytes_of(&entries)).unwrap();
    let (all, file, damage) = read(&path).unwrap();
    let wanted: Vec<Atom> = entries.iter().flat_map(atoms).collect();
    assert_eq!(all.len(), wanted.len());
    for (got, wanted) in all.iter().zip(&wanted) {
        assert_eq!(got, wanted);
    }
    assert_eq!(damage, Damage::default());
    assert_eq!(file.opening(), &opening());
    assert!(file.is_closed());
    let counts = file.overview().counts;
    let is_state = |entry: &&Entry| matches!(entry, Entry::Heard(Record::Reading { fresh, .. }) if fresh.contains(Group::Angle));
    assert_eq!(
        counts.states,
        entries.iter().filter(is_state).count() as u64
    );
    assert_eq!((counts.writes, counts.notes), (800, 800));
    let seconds = file.overview().seconds().unwrap();
    assert_eq!(seconds, (2, 81), "eighty seconds, over a border of blocks");
}

#[test]
fn the_overview_is_the_same_from_the_index_and_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let bytes = bytes_of(&entries(2, 35_000));
    std::fs::write(&path, &bytes).unwrap();
    let whole = RecordingFile::open(&path).unwrap();
    // Without blocks: their name is spoilt, and with it the sums over them.
    let mut spoilt = bytes.clone();
    let name = b"handscope-overview";
    for place in 0..spoilt.len() - name.len() {
        if spoilt[place..].starts_with(name) {
            spoilt[place] = b'H';
        }
    }
    std::fs::write(&path, &spoilt).unwrap();
    let anew = RecordingFile::open(&path).unwrap();
    let (one, two) = (whole.overview(), anew.overview());
    assert_eq!((one.counts, &one.marks), (two.counts, &two.marks));
    assert_eq!(format!("{:?}", one.rows), format!("{:?}", two.rows));
    assert!(one.rows.len() > 60);
}

/// What was read must be a part of what was written, in its order.
fn is_part(read: &[Atom], written: &[Atom]) -> bool {
    let mut rest = written.iter();
    read.iter().all(|atom| rest.any(|wanted| wanted == atom))
}

#[test]
fn a_file_cut_anywhere_gives_all_whole_chunks_and_no_wrong_value() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let entries = entries(3, 400);
    let written: Vec<Atom> = entries.iter().flat_map(atoms).collect();
    let bytes = bytes_of(&entries);
    let cuts = if soak::is_full() { 101 } else { 1009 };
    let mut most = 0;
    for end in (0..bytes.len()).step_by(cuts) {
        std::fs::write(&path, &bytes[..end]).unwrap();
        let Some((all, file, _)) = read(&path) else {
            assert_eq!(most, 0, "cut at {end}: nothing is read any more");
            continue;
        };
        assert!(!file.is_closed());
        assert!(written.starts_with(&all), "cut at {end}");
        assert!(all.len() >= most, "cut at {end}");
        most = all.len();
    }
    assert!(most > written.len() / 2);
}

#[test]
fn no_flipped_bit_gives_a_wrong_value_and_each_costs_one_chunk_at_most() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let entries = entries(4, 100);
    let written: Vec<Atom> = entries.iter().flat_map(atoms).collect();
    let bytes = bytes_of(&entries);
    let mut random = fastrand::Rng::with_seed(5);
    let mut unopened = 0;
    for _ in 0..soak::times_at_least(500, 10_000) {
        let mut flipped = bytes.clone();
        let place = random.usize(0..bytes.len());
        flipped[place] ^= 1 << random.u8(0..8);
        std::fs::write(&path, &flipped).unwrap();
        let Some((all, file, _)) = read(&path) else {
            assert!(place < 8, "a bit of byte {place} and nothing opens");
            unopened += 1;
            continue;
        };
        // Moments are counted from what the file says of itself; where that is lost, from its first message.
        match file.opening().base_nanos {
            BASE => assert!(is_part(&all, &written), "a bit of byte {place}"),
            _ => assert_eq!(file.opening().hand, "", "a bit of byte {place}"),
        }
        let lost = written.len() - all.len().min(written.len());
        assert!(lost < 400, "a bit of byte {place} costs {lost}");
    }
    assert!(unopened < 50);
}

#[test]
fn what_is_no_session_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let words = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        RecordingFile::open(&path).unwrap_err().to_string()
    };
    assert!(words(b"").contains("not an MCAP file"));
    assert!(words(b"time_s,angle\n1,2\n").contains("not an MCAP file"));
    assert!(words(&bytes_of(&[])[..8]).contains("no complete part"));
    let gone = RecordingFile::open(&folder.path().join("b.mcap")).unwrap_err();
    assert!(gone.to_string().starts_with("No such file"), "{gone}");
    let folder = RecordingFile::open(folder.path()).unwrap_err();
    assert_eq!(folder.to_string(), "it is not a regular file");
    let mut writer = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    let none = std::collections::BTreeMap::new();
    let channel = writer.add_channel(0, "/tf", "json", &none).unwrap();
    let header = mcap::records::MessageHeader {
        channel_id: channel,
        sequence: 1,
        log_time: 5,
        publish_time: 5,
    };
    writer.write_to_known_channel(&header, b"{}").unwrap();
    writer.finish().unwrap();
    let bytes = writer.into_inner().into_inner();
    assert!(words(&bytes).contains("another program"));
}

#[test]
fn times_in_which_the_hand_was_not_read_are_told_and_nothing_is_missing_there() {
    let second = |s| Moment::from_micros(2_000_000 + s * 1_000_000);
    let all = entries(17, 5000);
    let is_reading = |entry: &Entry| matches!(entry, Entry::Heard(Record::Reading { .. }));
    let without = |from: u64, to: u64| -> Vec<Entry> {
        let is_in = |entry: &Entry| (second(from)..second(to)).contains(&entry.at());
        let kept = all
            .iter()
            .filter(|entry| !(is_reading(entry) && is_in(entry)));
        kept.cloned().collect()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lost.mcap");
    for (from, to) in [(0, 4), (3, 7), (6, 20), (0, 20)] {
        std::fs::write(&path, bytes_of(&without(from, to))).unwrap();
        let contents = Contents::of(&RecordingFile::open(&path).unwrap()).unwrap();
        assert_eq!(contents.damage, Damage::default());
        let [gap] = contents.unread.as_slice() else {
            panic!("{from} to {to}: {:?}", contents.unread);
        };
        let apart = |a: Moment, b: Moment| a.since(b).max(b.since(a)).as_millis();
        assert!(apart(gap.from, second(from)) < 50, "{gap:?}");
        assert!(apart(gap.to, second(to.min(10))) < 50, "{gap:?}");
    }
    std::fs::write(&path, bytes_of(&without(3, 5))).unwrap();
    let contents = Contents::of(&RecordingFile::open(&path).unwrap()).unwrap();
    assert_eq!(contents.unread, []);
}

#[test]
fn a_stretch_begins_with_what_was_known_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    std::fs::write(&path, bytes_of(&entries(6, 10_000))).unwrap();
    let file = RecordingFile::open(&path).unwrap();
    let from = Moment::from_micros(12_000_000);
    let to = Moment::from_micros(12_100_000);
    let mut first = None;
    let mut times = Vec::new();
    let stretch = TimeRange {
        from,
        to,
        wire: false,
    };
    file.entries(stretch, |entry| {
        times.push(entry.at());
        if let Entry::Heard(Record::Reading { sample, .. }) = entry {
            first.get_or_insert(sample);
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(times.iter().all(|at| (from..=to).contains(at)));
    let first = first.unwrap();
    let mut missing = Groups::NONE;
    for group in Group::ALL.into_iter().take(10) {
        if first.times(group).is_none() {
            missing.insert(group);
        }
    }
    assert!(missing.is_empty());
}

/// Files of the versions until 0.1.0 of 24 November 2026, with an own list of chunks each minute: one that was ended, and one of a
/// program that was killed while it wrote.
#[test]
fn files_with_lists_of_chunks_still_open() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let check = |bytes: &[u8], wanted: (usize, u64), bytes_lost: u64| {
        std::fs::write(&path, bytes).unwrap();
        let (all, file, damage) = read(&path).unwrap();
        let counts = file.overview().counts;
        assert_eq!((all.len(), counts.faults), wanted);
        assert_eq!((counts.states, counts.touch_blocks), (14, 39));
        assert_eq!((counts.notes, counts.missing), (175, 0));
        assert_eq!(file.overview().seconds(), Some((2, 70)));
        assert_eq!(file.last(), Moment::from_micros(71_614_700));
        assert_eq!(
            (file.opening(), file.remarks()),
            (&opening(), [].as_slice())
        );
        let lost = Damage {
            bytes: bytes_lost,
            ..Damage::default()
        };
        assert_eq!((damage, file.is_closed()), (lost, bytes_lost == 0));
    };
    check(include_bytes!("listed-ended.mcap"), (302, 121), 0);
    check(include_bytes!("listed-killed.mcap"), (302, 134), 7);
}
