//! Files that were never ended: what a flipped bit in the head of a chunk does.

#![expect(
    clippy::cast_possible_truncation,
    reason = "files of tests are small, and clippy.toml cannot excuse them"
)]

use super::{BASE, opening};
use crate::hand::Moment;
use crate::record::file::reader::{Damage, RecordingFile, TimeRange};
use crate::record::file::walk::walk;
use crate::record::file::writer::RecordingWriter;
use crate::record::{Entry, Event, EventKind};
use std::io::Cursor;
use std::ops::ControlFlow;

/// A note each tenth of a second, four in a chunk, and no end.
fn unended(seconds: u64) -> Vec<u8> {
    let mut writer = RecordingWriter::new(&opening()).unwrap();
    for number in 0..seconds * 10 {
        let note = Event {
            at: at(number),
            kind: EventKind::Note,
            words: format!("{number}"),
        };
        writer.push(&Entry::Event(note)).unwrap();
        if number % 4 == 3 {
            writer.flush().unwrap();
        }
    }
    writer.flush().unwrap();
    writer.take_bytes()
}

fn at(number: u64) -> Moment {
    Moment::from_micros(2_000_000 + number * 100_000)
}

/// The notes of a stretch, and what is missing.
fn notes(file: &RecordingFile, from: Moment, to: Moment) -> (Vec<Moment>, Damage) {
    let mut all = Vec::new();
    let stretch = TimeRange {
        from,
        to,
        wire: true,
    };
    let damage = file.entries(stretch, |entry| {
        all.push(entry.at());
        ControlFlow::Continue(())
    });
    (all, damage.unwrap())
}

#[test]
fn a_flipped_bit_in_the_head_of_a_chunk_hides_nothing_without_being_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let bytes = unended(20);
    let plain = walk(&mut Cursor::new(&bytes)).unwrap();
    // The first with notes, one amid, and the last; code, length, two times, size, sum, name, size.
    let last = plain.chunks.len() - 1;
    for place in [1, 25, last] {
        let chunk = plain.chunks[place];
        let first = Moment::from_micros((chunk.first_nanos - BASE) / 1000);
        let after = Moment::from_micros((chunk.last_nanos - BASE) / 1000);
        for bit in 0..52 * 8 {
            let mut flipped = bytes.clone();
            flipped[chunk.place.offset as usize + bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, &flipped).unwrap();
            let file = RecordingFile::open(&path).unwrap();
            let (some, damage) = notes(&file, first, after);
            let whole = some.len() == 4 && some[0] == first && some[3] == after;
            let is_time = (9..25).contains(&(bit / 8));
            assert!(
                whole || damage != Damage::default() && !is_time,
                "bit {bit} of {place}"
            );
            let (all, damage) = notes(&file, Moment::ZERO, at(200));
            assert!(all.is_sorted());
            let lost = 200 - all.len();
            assert!(
                lost == 0 || lost <= 4 && damage != Damage::default(),
                "bit {bit}"
            );
            assert!(lost == 0 || !is_time, "bit {bit} of {place}");
            let (end, wanted) = (file.last(), at(199));
            assert!(
                end == wanted || place == last && !is_time,
                "bit {bit}: {end:?}"
            );
        }
    }
}
