//! Files that were never ended: how they are found by their lists of chunks, and what a flipped bit in a list or in the head of a
//! chunk does.

#![expect(
    clippy::cast_possible_truncation,
    reason = "files of tests are small, and clippy.toml cannot excuse them"
)]

use super::{BASE, opening};
use crate::hand::Moment;
use crate::record::file::chunk_list::CHUNK_LIST;
use crate::record::file::reader::{Damage, SessionFile, Stretch};
use crate::record::file::walk::{Found, Place, walk};
use crate::record::file::writer::SessionWriter;
use crate::record::{Entry, Event, EventKind};
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::ops::ControlFlow;

/// A note each tenth of a second, four in a chunk, and no end.
fn unended(seconds: u64) -> Vec<u8> {
    let mut writer = SessionWriter::new(&opening()).unwrap();
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

/// Counts how often bytes are read.
struct Counting(Cursor<Vec<u8>>, usize);

impl Read for Counting {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.1 += 1;
        self.0.read(bytes)
    }
}

impl Seek for Counting {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

fn found(bytes: &[u8]) -> (Found, usize) {
    let mut file = Counting(Cursor::new(bytes.to_vec()), 0);
    (walk(&mut file).unwrap(), file.1)
}

/// Where the names of the lists stand.
fn names(bytes: &[u8]) -> Vec<usize> {
    let name = CHUNK_LIST.as_bytes();
    let all = bytes.windows(name.len()).enumerate();
    all.filter(|(_, bytes)| *bytes == name)
        .map(|(at, _)| at)
        .collect()
}

fn without(bytes: &[u8], lists: &[usize]) -> Vec<u8> {
    let mut spoilt = bytes.to_vec();
    lists.iter().for_each(|at| spoilt[*at] = b'H');
    spoilt
}

#[test]
fn lists_tell_the_same_as_going_from_record_to_record_with_few_reads() {
    let bytes = unended(250);
    let lists = names(&bytes);
    assert_eq!(lists.len(), 4, "one a minute");
    let (plain, many) = found(&without(&bytes, &lists));
    assert_eq!((plain.chunks.len(), plain.skipped), (626, 0));
    let (listed, few) = found(&bytes);
    assert_eq!(listed, plain);
    assert!(few * 3 < many, "{few} reads instead of {many}");
    // Each list alone may be lost, and the file cut anywhere.
    for (spoilt, _) in lists.iter().enumerate() {
        assert_eq!(found(&without(&bytes, &[lists[spoilt]])).0, plain);
    }
    for end in (9..bytes.len()).step_by(997) {
        let cut = &bytes[..end];
        assert_eq!(found(cut).0, found(&without(cut, &names(cut))).0);
    }
}

#[test]
fn no_flipped_bit_of_a_list_changes_what_is_found() {
    let bytes = unended(130);
    let (plain, _) = found(&bytes);
    let lists = names(&bytes);
    let list = |at: usize| {
        let is_it = |place: &&Place| (place.offset as usize) < at && at < end(place);
        *plain.attachments.iter().find(is_it).unwrap()
    };
    for place in lists.iter().map(|name| list(*name)) {
        // Behind the code and the length, a flipped bit of which costs the way from record to record a search.
        for byte in place.offset as usize + 9..end(&place) {
            let mut flipped = bytes.clone();
            flipped[byte] ^= 1 << (byte % 8);
            assert_eq!(found(&flipped).0, plain, "byte {byte}");
        }
    }
}

fn end(place: &Place) -> usize {
    (place.offset + 9 + place.len) as usize
}

#[test]
fn lists_made_to_harm_are_not_believed() {
    let bytes = unended(130);
    let (plain, _) = found(&bytes);
    let names = names(&bytes);
    for name in names {
        let begin = name - 4 - 16;
        let data = name + 16 + 4 + 24 + 8;
        let len = u64::from_le_bytes(bytes[data - 8..data].try_into().unwrap()) as usize;
        for field in 0..3 {
            for lie in [0, 1, 8, name as u64, bytes.len() as u64, 1 << 62, u64::MAX] {
                let mut lies = bytes.clone();
                lies[data + 8 * field..][..8].copy_from_slice(&lie.to_le_bytes());
                let crc = crc32fast::hash(&lies[begin..data + len]);
                lies[data + len..][..4].copy_from_slice(&crc.to_le_bytes());
                let (found, reads) = found(&lies);
                assert!(reads < 1000 && found.chunks.len() <= 2 * plain.chunks.len());
            }
        }
        let mut lies = bytes.clone();
        lies[data + 24..data + len].fill(0xFF);
        let crc = crc32fast::hash(&lies[begin..data + len]);
        lies[data + len..][..4].copy_from_slice(&crc.to_le_bytes());
        assert!(found(&lies).0.chunks == plain.chunks);
    }
}

/// The notes of a stretch, and what is missing.
fn notes(file: &SessionFile, from: Moment, to: Moment) -> (Vec<Moment>, Damage) {
    let mut all = Vec::new();
    let stretch = Stretch {
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
    let (plain, _) = found(&bytes);
    assert!(names(&bytes).is_empty());
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
            let file = SessionFile::open(&path).unwrap();
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
