//! Files that were made to harm: whatever they claim, reading them takes little memory, and ends with entries or with one sentence.

use crate::setup::process::listen;
use handscope::record::file::format::topic::Topic;
use handscope::record::file::reader::{RecordingFile, TimeRange};
use handscope::record::file::walk::CHUNKS_MAX;
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, WriteOptions, Writer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Makes this program the one that reads: the file.
const ORDER: &str = "HANDSCOPE_TEST_READS";
/// What a file may cost at most.
const MOST_KIB: u64 = 64 * 1024;
/// A million chunks take ten seconds, and minutes with other tests beside.
const PATIENCE: Duration = Duration::from_secs(900);
/// Close to the longest record that is read at all.
const LONG: usize = 7 * 1024 * 1024;

/// Not a claim: what the other tests start, so that its memory is its own.
#[test]
fn child_reads_a_file_and_says_what_it_took() {
    let Ok(path) = std::env::var(ORDER) else {
        return;
    };
    let before = peak_kib();
    let words = match RecordingFile::open(Path::new(&path)) {
        Ok(file) => {
            let mut entries = 0_u64;
            let all = TimeRange::WHOLE;
            let took = file.entries(all, |_| {
                entries += 1;
                ControlFlow::Continue(())
            });
            took.unwrap();
            file.messages(all.from, all.to, |_, _, _| ()).unwrap();
            format!("{entries} entries")
        }
        Err(error) => error.to_string(),
    };
    println!("peak grew by {} {words}", peak_kib() - before);
}

/// The most memory that this process ever had.
fn peak_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let number = line.unwrap().split_whitespace().next();
    number.unwrap().parse().unwrap()
}

/// Reads a file in a process of its own; what it said.
fn reads(what: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    std::fs::write(&path, bytes).unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    let child = "record::hostile::child_reads_a_file_and_says_what_it_took";
    command.args([child, "--exact", "--nocapture"]);
    command.env(ORDER, &path);
    let ended = listen(command).end_within(PATIENCE).ok();
    let took = ended
        .out
        .lines()
        .find_map(|line| line.split_once("peak grew by "));
    let (kib, words) = took.expect(&ended.out).1.split_once(' ').unwrap();
    println!("{what}: {kib} KiB, {words}");
    let kib: u64 = kib.parse().unwrap();
    assert!(kib <= MOST_KIB, "{what} takes {kib} KiB");
    assert!(!words.contains('\n') && words.len() < 200, "{words}");
    words.to_owned()
}

struct Made(Writer<Cursor<Vec<u8>>>);

impl Made {
    fn new() -> Self {
        let options = WriteOptions::new()
            .profile("ros2")
            .library("handscope")
            .compression(Some(Compression::Lz4))
            .chunk_size(Some(LONG as u64));
        let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
        let recording = [("base_nanos", "1000"), ("began_micros", "0")];
        let recording = recording.map(|(key, value)| (key.to_owned(), value.to_owned()));
        writer
            .write_metadata(&Metadata {
                name: "handscope".into(),
                metadata: recording.into_iter().collect(),
            })
            .unwrap();
        for topic in Topic::all() {
            let schema = topic.schema();
            let text = schema.text.as_bytes();
            let none = BTreeMap::new();
            writer
                .add_schema_with_id(schema.id, schema.name, "ros2msg", text)
                .unwrap();
            writer
                .add_channel_with_id(topic.channel(), schema.id, topic.name(), "cdr", &none)
                .unwrap();
        }
        Self(writer)
    }

    fn message(&mut self, topic: Topic, data: &[u8]) {
        let header = MessageHeader {
            channel_id: topic.channel(),
            sequence: 1,
            log_time: 2_000_000,
            publish_time: 2_000_000,
        };
        self.0.write_to_known_channel(&header, data).unwrap();
        self.0.flush().unwrap();
    }

    fn attachment(&mut self, data: Vec<u8>) {
        self.0
            .attach(&Attachment {
                log_time: 1,
                create_time: 1,
                name: "handscope-overview".into(),
                media_type: "application/octet-stream".into(),
                data: Cow::Owned(data),
            })
            .unwrap();
    }

    fn end(mut self) -> Vec<u8> {
        self.0.finish().unwrap();
        self.0.into_inner().into_inner()
    }

    /// Without its index.
    fn cut(mut self) -> Vec<u8> {
        self.0.flush().unwrap();
        self.0.into_inner().into_inner()
    }
}

/// Bytes of CDR: its head, a part, and zeros.
fn zeros_after(part: &[u8], len: usize) -> Vec<u8> {
    let mut bytes = vec![0, 1, 0, 0];
    bytes.extend(part);
    bytes.resize(len, 0);
    bytes
}

/// A message of the wire with so many bytes.
fn wire(len: usize) -> Vec<u8> {
    let mut part = vec![0; 12];
    part[8] = 2;
    part.extend(u32::try_from(len).unwrap().to_le_bytes());
    zeros_after(&part, 20 + len)
}

#[test]
fn chunks_that_unfold_a_hundredfold_take_no_more_than_one_of_them() {
    let mut made = Made::new();
    for _ in 0..100 {
        made.message(Topic::Wire, &wire(LONG - 100));
    }
    assert_eq!(reads("bombs", &made.end()), "0 entries");
    let mut made = Made::new();
    for _ in 0..100 {
        made.message(Topic::Wire, &wire(1000));
    }
    let whole = made.cut();
    assert_eq!(reads("none", &whole), "100 entries");
    // Operation code, length, two times, and then the length that it claims to unfold to.
    for claimed in [0, 1, 1 << 20, 1 << 33, 1 << 50, u64::MAX] {
        for field in [1, 25] {
            let mut lies = whole.clone();
            for place in chunks(&whole) {
                lies[place + field..place + field + 8].copy_from_slice(&claimed.to_le_bytes());
            }
            let _words = reads(&format!("field {field} of {claimed}"), &lies);
        }
    }
}

/// Where chunks begin.
fn chunks(bytes: &[u8]) -> Vec<usize> {
    let (mut at, mut all) = (8, Vec::new());
    while at + 9 < bytes.len() {
        if bytes[at] == 6 {
            all.push(at);
        }
        let len = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
        at += 9 + len as usize;
    }
    assert!(!all.is_empty());
    all
}

#[test]
fn lists_that_claim_any_length_take_no_room() {
    // Times, and then a list that claims to be as long as can be; or many lists or words of nothing.
    let endless = [[0; 16].as_slice(), &[0xFF; 4]].concat();
    let nothings = |lists: usize, len: usize| {
        let mut part = vec![0; 16 + 4 * lists];
        part.extend(
            u32::try_from((len - part.len() - 8) / 4)
                .unwrap()
                .to_le_bytes(),
        );
        zeros_after(&part, len)
    };
    let mut made = Made::new();
    for len in [100_000, 1_000_000, LONG] {
        for topic in Topic::all() {
            made.message(topic, &zeros_after(&endless, len));
        }
        // Ten lists stand before the one of words.
        made.message(Topic::State, &nothings(10, len));
    }
    // From, six counts, and lists.
    let block = |len: usize, before: usize| {
        let mut part = vec![0; 56 + 4 * before];
        part.extend(
            u32::try_from((len - part.len() - 8) / 4)
                .unwrap()
                .to_le_bytes(),
        );
        zeros_after(&part, len)
    };
    for len in [100_000, 1_000_000, LONG] {
        (0..7).for_each(|before| made.attachment(block(len, before)));
        let endless = [[0; 56].as_slice(), &[0xFF; 4]].concat();
        made.attachment(zeros_after(&endless, len));
    }
    let words = reads("lists", &made.end());
    assert!(words.ends_with(" entries"), "{words}");
}

#[test]
fn more_chunks_than_any_recording_has_are_left_out() {
    let mut bytes = Made::new().cut();
    let mut chunk = vec![6];
    chunk.extend(40_u64.to_le_bytes());
    chunk.extend([2_000_000_u64.to_le_bytes(); 2].concat());
    chunk.extend([0; 24]);
    bytes.extend(chunk.repeat(CHUNKS_MAX * 3 / 2));
    let words = reads("tiny chunks", &bytes);
    assert!(words.contains("no complete part"), "{words}");
}

#[test]
fn an_index_that_tells_of_one_chunk_again_and_again_is_not_believed() {
    let mut made = Made::new();
    made.message(Topic::Wire, &wire(100));
    let whole = made.end();
    let footer = whole.len() - 37;
    let start = u64::from_le_bytes(whole[footer + 9..footer + 17].try_into().unwrap()) as usize;
    let mut summary = Vec::new();
    let mut at = start;
    while at < footer {
        let len = u64::from_le_bytes(whole[at + 1..at + 9].try_into().unwrap());
        let record = &whole[at..at + 9 + len as usize];
        let times = if record[0] == 8 { 400_000 } else { 1 };
        summary.extend(record.repeat(times));
        at += record.len();
    }
    let mut again = whole[..start].to_vec();
    let mut tail = whole[footer..footer + 25].to_vec();
    let crc = crc32fast::hash(&[summary.as_slice(), &tail].concat());
    again.append(&mut summary);
    again.append(&mut tail);
    again.extend(crc.to_le_bytes());
    again.extend(&whole[whole.len() - 8..]);
    assert_eq!(reads("index", &again), "1 entries");
}
