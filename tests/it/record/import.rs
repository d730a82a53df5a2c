//! Comma-separated values that were exported, made into a recording again: every value comes back, what no column says stays unknown,
//! and a file that is wrong is refused with the line.

use handscope::hand::command::HandCommand;
use handscope::hand::feedback::tactile::TactileBlock;
use handscope::hand::kinematics::Side;
use handscope::hand::{
    Dof, Finger, Group, Groups, HandSample, Moment, PerDof, Reply, Span, Target, register,
};
use handscope::record::export::cut;
use handscope::record::export::{Destination, ExportFormat, ExportOptions, ExportSource};
use handscope::record::file::reader::{RecordingFile, TimeRange};
use handscope::record::file::writer::RecordingWriter;
use handscope::record::file::{Counts, Opening};
use handscope::record::import::csv::{self as values, ImportError, Imported};
use handscope::record::{Entry, Event, EventKind, LinkState, Record, WriteCause};
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

fn at(millis: u64) -> Moment {
    Moment::from_micros(2_000_000 + 1000 * millis)
}

/// A hand that reads as a busy one does: values in and out of their ranges, faults, a gap, a lost link, notes of all kinds.
fn entries() -> Vec<Entry> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut sample = HandSample::default();
    let state = |at, state| Entry::Heard(Record::State { at, state });
    let event = |at, kind, words: &str| {
        Entry::Event(Event {
            at,
            kind,
            words: words.into(),
        })
    };
    let mut all = vec![state(at(0), LinkState::Monitoring)];
    for number in 0..4000_u64 {
        let millis = 10 * number + if number > 2000 { 70_000 } else { 0 };
        let (asked, received) = (at(millis), at(millis + 3));
        let mut reply = |span: Span, bytes: &[u8]| {
            let fresh = sample.apply(&Reply {
                span,
                bytes,
                asked,
                received,
            });
            Entry::Heard(Record::Reading {
                sample: Arc::new(sample),
                fresh,
            })
        };
        let short = |random: &mut fastrand::Rng| random.i16(-50..1100).to_le_bytes();
        let shorts: Vec<u8> = (0..6).flat_map(|_| short(&mut random)).collect();
        all.push(match number % 5 {
            0 => reply(register::ANGLE_ACT.span(), &shorts),
            1 => reply(register::ANGLE_SET.span(), &shorts),
            2 => reply(register::TEMP.span(), &shorts[..6]),
            3 => {
                let faults = [0, 0, 0, random.u8(0..4), 0, 0];
                reply(register::ERROR.span(), &faults)
            }
            _ => {
                let tip = Finger::ALL[random.usize(0..5)];
                let block = TactileBlock::decode(&[0; 58]).unwrap();
                let block = TactileBlock {
                    raw: std::array::from_fn(|_| random.u32(..)),
                    normal_n: random.f32() * 20.0,
                    tangential_n: if number % 3 == 0 { f32::NAN } else { 0.1 },
                    ..block
                };
                reply(Group::Tactile(tip).span(), &block.encode())
            }
        });
        match number {
            300 => all.push(event(received, EventKind::Note, "a \"quoted\", note")),
            301 => all.push(event(received, EventKind::Note, "=two\nlines: äöü 捏")),
            302 => all.push(event(asked, EventKind::Trial, "egg: 300 g")),
            400 => all.push(state(received, LinkState::Armed)),
            500 => all.push(state(received, LinkState::Holding)),
            2000 => all.push(state(received, LinkState::Offline)),
            2001 => all.push(state(received, LinkState::Monitoring)),
            2002 => {
                let words = "12 entries are missing before this";
                all.push(event(received, EventKind::Recording, words));
            }
            2003 => all.push(Entry::Heard(Record::Sent {
                at: received,
                number,
                cause: WriteCause::Request,
                write: HandCommand::ClearErrors.writes().first().unwrap().into(),
            })),
            _ => {}
        }
    }
    all
}

fn write(path: &Path, entries: &[Entry]) {
    let opening = Opening {
        base_nanos: 1_795_219_200_000_000_123,
        began: at(0),
        hand: "tcp:10.0.0.9".into(),
        simulated: false,
        side: Side::Left,
        newtons_per_g: PerDof::splat(None),
        version: "0.1.0".into(),
        part: None,
    };
    let mut writer = RecordingWriter::new(&opening).unwrap();
    entries.iter().for_each(|entry| writer.push(entry).unwrap());
    writer.finish().unwrap();
    std::fs::write(path, writer.take_bytes()).unwrap();
}

fn import(csv: &Path, recording: &Path) -> Result<Imported, ImportError> {
    let from = BufReader::new(File::open(csv).unwrap());
    let go_on = || ControlFlow::Continue(());
    values::import(from, &Destination::from(recording), &go_on)
}

struct Trial(TempDir);

impl Trial {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The values of a recording as text.
    fn values(&self, recording: &str, csv: &str) -> String {
        let file = RecordingFile::open(&self.path(recording)).unwrap();
        let source = ExportSource::new(&file, TimeRange::WHOLE);
        let to = Destination::Path(self.path(csv));
        let options = ExportOptions::default();
        ExportFormat::Csv.write(&[source], &to, &options).unwrap();
        std::fs::read_to_string(self.path(csv)).unwrap()
    }

    fn import(&self, text: &str) -> Result<Imported, String> {
        let (csv, recording) = (self.path("in.csv"), self.path("out.mcap"));
        std::fs::write(&csv, text).unwrap();
        let _old = std::fs::remove_file(&recording);
        import(&csv, &recording).map_err(|error| {
            assert!(!recording.exists());
            error.to_string()
        })
    }

    /// Readings of what was imported.
    fn read(&self) -> Vec<(HandSample, Groups)> {
        let file = RecordingFile::open(&self.path("out.mcap")).unwrap();
        let mut all = Vec::new();
        let damage = file.entries(TimeRange::WHOLE, |entry| {
            if let Entry::Heard(Record::Reading { sample, fresh }) = entry {
                all.push((*sample, fresh));
            }
            ControlFlow::Continue(())
        });
        assert_eq!(
            damage.unwrap(),
            handscope::record::file::reader::Damage::default()
        );
        all
    }
}

#[test]
fn every_value_and_every_event_comes_back_from_a_session_with_faults_and_gaps() {
    let trial = Trial::new();
    write(&trial.path("a.mcap"), &entries());
    let first = trial.values("a.mcap", "a.csv");
    let done = import(&trial.path("a.csv"), &trial.path("b.mcap")).unwrap();
    let lines = first.lines().count() as u64;
    assert_eq!(
        done.rows + 2,
        lines,
        "one note has two lines, and the first line names the columns"
    );
    assert_eq!((done.unknown.len(), done.incomplete_tips), (0, 0));
    let again = trial.values("b.mcap", "b.csv");
    // Where a reply was about nothing that has a column, the first has a line without a value.
    let first: String = first
        .split_inclusive('\n')
        .filter(|line| says(line))
        .collect();
    for (one, two) in first.lines().zip(again.lines()) {
        assert_eq!(one, two);
    }
    assert!(first == again);
    for words in [
        "fault: index",
        "link lost",
        "reconnected",
        "armed",
        "stop",
        "egg",
    ] {
        assert!(first.contains(words), "{words}");
    }
    let file = RecordingFile::open(&trial.path("b.mcap")).unwrap();
    let opening = file.opening();
    assert!(opening.is_imported() && !opening.simulated);
    assert_eq!(
        (opening.hand.as_str(), opening.base_nanos),
        ("", Opening::NO_DATE)
    );
    let whole = RecordingFile::open(&trial.path("a.mcap")).unwrap();
    assert!(whole.overview().counts.faults > 10);
    let counts = Counts {
        // Commands are no columns, and of several faults in one reply the marks tell as one.
        writes: 0,
        faults: file.overview().counts.faults,
        ..whole.overview().counts
    };
    assert_eq!(file.overview().counts, counts);
    // The same from a copy, and where no overview tells it.
    let source = ExportSource::new(&file, TimeRange::WHOLE);
    cut::recover(source, &Destination::Path(trial.path("c.mcap"))).unwrap();
    assert!(trial.values("c.mcap", "c.csv") == first);
    let mut bytes = std::fs::read(trial.path("b.mcap")).unwrap();
    let name = b"handscope-overview";
    for place in 0..bytes.len() - name.len() {
        if bytes[place..].starts_with(name) {
            bytes[place] = b'H';
        }
    }
    std::fs::write(trial.path("d.mcap"), bytes).unwrap();
    assert!(trial.values("d.mcap", "d.csv") == first);
}

#[test]
fn what_no_column_says_stays_unknown() {
    let trial = Trial::new();
    let done = trial.import(
        "\u{feff}mood,time_s,angle_index,force_index_g\r\ncalm,0,500,\r\n,0.25,,-7\r\n\r\n,1,,\r\n",
    );
    let done = done.unwrap();
    assert_eq!((done.rows, done.unknown), (3, vec!["mood".to_owned()]));
    let read = trial.read();
    assert_eq!(read.len(), 2);
    let (sample, fresh) = &read[0];
    assert!(fresh.contains(Group::Angle) && !fresh.contains(Group::Force));
    assert_eq!(
        Group::ALL
            .into_iter()
            .filter(|group| fresh.contains(*group))
            .count(),
        1
    );
    let angles = handscope::hand::Quantity::Angle.documented(sample).unwrap();
    let angles: Vec<Option<i16>> = angles.value.iter().map(|(_, angle)| *angle).collect();
    assert_eq!(angles, [None, None, None, Some(500), None, None]);
    assert_eq!(angles_at(sample), Duration::ZERO);
    let forces = handscope::hand::Quantity::Force
        .documented(&read[1].0)
        .unwrap();
    assert_eq!(
        forces.received.since(Moment::ZERO),
        Duration::from_millis(250)
    );
    assert_eq!(forces.value[Dof::Index], Some(-7));
    // A fingertip's counts have no number that means unknown.
    let done = trial
        .import("time_s,normal_thumb_N,angle_ring\n1,0.5,3\n2,0.5,\n")
        .unwrap();
    assert_eq!((done.rows, done.incomplete_tips), (2, 2));
    assert_eq!(trial.read().len(), 1);
    let names: Vec<String> = (1..=8).map(|n| format!("channel_{n}_thumb")).collect();
    let text = format!("time_s,{}\n1,1,2,3,4,5,6,7,8\n", names.join(","));
    assert_eq!(trial.import(&text).unwrap().incomplete_tips, 0);
    let block = trial.read()[0].0.tactile[Finger::Thumb].unwrap().value;
    assert_eq!(block.raw, [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!((block.normal(), block.tangential()), (None, None));
    assert!(block.direction_deg().is_none() && !block.check_ok());
}

#[test]
fn values_that_went_through_pandas_are_the_same_values() {
    let trial = Trial::new();
    write(&trial.path("a.mcap"), &entries());
    let first = trial.values("a.mcap", "a.csv");
    // pandas reads a column with holes as numbers with a point, and writes its index without a name. Notes have line breaks.
    let (mut lines, mut is_quoted) = (Vec::new(), false);
    for (number, line) in first.lines().enumerate() {
        let is_rest = is_quoted;
        is_quoted ^= line.matches('"').count() % 2 == 1;
        let cell = |cell: &str| match cell.parse::<i64>() {
            Ok(whole) => format!("{whole}.0"),
            Err(_) if number > 3000 && cell.is_empty() => "NaN".to_owned(),
            Err(_) => cell.to_owned(),
        };
        lines.push(match (number, line.rsplit_once(',')) {
            _ if is_rest => format!("{line}\n"),
            (0, _) => format!(",{line}\n"),
            (_, Some((values, event))) if !line.contains('"') => {
                let cells: Vec<String> = values.split(',').map(cell).collect();
                format!("{number},{},{event}\n", cells.join(","))
            }
            _ => format!("{number},{line}\n"),
        });
    }
    let text = lines.concat().replace("time_s", "\"time_s\"");
    let plain: Vec<&str> = first.lines().collect();
    assert!(text.contains(".0,") && text.contains(",NaN,") && plain.len() == lines.len());
    let done = trial.import(&text).unwrap();
    assert_eq!(done.unknown, ["(no name)"]);
    let again = trial.values("out.mcap", "again.csv");
    let first: String = first
        .split_inclusive('\n')
        .filter(|line| says(line))
        .collect();
    assert!(first == again);
}

#[test]
fn what_is_outside_the_ranges_is_an_empty_cell_and_named_and_comes_back() {
    let trial = Trial::new();
    let text =
        "time_s,angle_little,angle_ring,target_angle_little,temperature_index_C,undocumented,event
1.000000,,40,,,angle[0]=1203 temperature[3]=255,
2.000000,7,,500,30,angle[1]=-4 angle_set[2],
";
    assert_eq!(trial.import(text).unwrap().rows, 2);
    let read = trial.read();
    let raw = |place: usize, dof| read[place].0.angle.unwrap().value[dof].raw();
    assert_eq!((raw(0, Dof::Little), raw(0, Dof::Ring)), (1203, 40));
    assert_eq!((raw(1, Dof::Little), raw(1, Dof::Ring)), (7, -4));
    // A target that is neither there nor named is left alone.
    let targets = read[1].0.angle_set.unwrap().value;
    assert_eq!(targets[Dof::Ring], Some(Target::Leave));
    assert_eq!(targets[Dof::Middle], None);
    let again = trial.values("out.mcap", "again.csv");
    let named: Vec<&str> = again
        .lines()
        .map(|line| line.rsplit(',').nth(1).unwrap())
        .collect();
    let unknown = |names: &str| {
        (2..6).fold(names.to_owned(), |all, n| {
            format!("{all} angle[{n}]=-32768")
        })
    };
    assert_eq!(named[0], "undocumented");
    assert!(
        named[1].starts_with(&unknown("angle[0]=1203")),
        "{}",
        named[1]
    );
    assert!(named[1].ends_with("temperature[5]=255"), "{}", named[1]);
    assert!(
        named[2].starts_with("angle_set[2] angle[1]=-4 "),
        "{}",
        named[2]
    );
}

/// True for a line that holds more than a time.
fn says(line: &str) -> bool {
    let values = line.split_once(',').map_or(line, |(_, values)| values);
    values.trim_end().contains(|letter| letter != ',')
}

fn angles_at(sample: &HandSample) -> Duration {
    sample.angle.unwrap().received.since(Moment::ZERO)
}

#[test]
fn a_file_that_is_wrong_is_refused_in_one_sentence_with_its_line() {
    let trial = Trial::new();
    let long = format!("time_s,event\n1,{}\n", "x".repeat(2 << 20));
    let wide = format!("time_s,event{}\n", ",a".repeat(5000));
    let quotes = format!("time_s,event\n1,\"{}\n", "\"\"\n".repeat(300_000));
    for (text, line, words) in [
        ("", 1, "no column time_s"),
        ("1,2,3\n4,5,6\n", 1, "no column time_s"),
        ("time_s\n1\n", 1, "it has no known column except time_s"),
        (
            "time_s,mood\n1,2\n",
            1,
            "it has no known column except time_s",
        ),
        ("time_s,event,time_s\n", 1, "duplicate column time_s"),
        (
            "time_s,event\n1,a\n2\n",
            3,
            "1 cells, and the first line has 2",
        ),
        ("time_s,event\n1,\"a\nb\"\n2,3,4\n", 4, "3 cells"),
        (
            "time_s,event\nsoon,\n",
            2,
            "invalid value 'soon' in column time_s",
        ),
        ("time_s,event\n,\n", 2, "invalid value ''"),
        ("time_s,event\n-1,\n", 2, "invalid value '-1'"),
        ("time_s,event\n1e300,\n", 2, "'1e300'"),
        ("time_s,angle_index\nNaN,1\n", 2, "'NaN'"),
        (
            "time_s,angle_index\n1,1001\n",
            2,
            "invalid value '1001' in column angle_index",
        ),
        ("time_s,angle_index\n1,5.5\n", 2, "'5.5'"),
        ("time_s,angle_index\n1,1001.0\n", 2, "'1001.0'"),
        ("time_s,angle_index\n1,-0.5\n", 2, "'-0.5'"),
        (
            "time_s,channel_1_index\n1,4294967296.0\n",
            2,
            "'4294967296.0'",
        ),
        ("time_s,channel_1_index\n1,1e300\n", 2, "'1e300'"),
        (
            "time_s,undocumented,angle_index\n1,mood[2]=7,\n",
            2,
            "'mood[2]=7'",
        ),
        (
            "time_s,undocumented,angle_index\n1,angle[6]=7,\n",
            2,
            "'angle[6]=7'",
        ),
        ("time_s,temperature_index_C\n1,101\n", 2, "'101'"),
        ("time_s,temperature_index_C\n1,-3\n", 2, "'-3'"),
        ("time_s,normal_index_N\n1,inf\n", 2, "'inf'"),
        ("time_s,channel_1_index\n1,-1\n", 2, "'-1'"),
        ("time_s,event\n1,\"a\n", 2, "unmatched quote"),
        ("time_s,event\n1,a\"b\n", 2, "unmatched quote"),
        ("time_s,event\n1,\"a\"b\n", 2, "unmatched quote"),
        (&long, 2, "longer than 1024 KiB"),
        (&wide, 1, "more than 4096 cells"),
        (&quotes, 2, "unmatched quote"),
    ] {
        let error = trial.import(text).unwrap_err();
        let begin = &text[..text.len().min(60)];
        assert!(
            error.starts_with(&format!("line {line}: ")),
            "{begin:?}: {error}"
        );
        assert!(
            error.contains(words) && !error.contains('\n'),
            "{begin:?}: {error}"
        );
        assert!(error.len() < 200, "{error}");
    }
    std::fs::write(trial.path("in.csv"), b"time_s,event\n1,\xFF\n").unwrap();
    let latin = import(&trial.path("in.csv"), &trial.path("x.mcap"));
    assert_eq!(
        latin.unwrap_err().to_string(),
        "line 2: it is not UTF-8 text"
    );
    let folder = import(trial.0.path(), &trial.path("x.mcap"));
    assert!(
        folder
            .unwrap_err()
            .to_string()
            .starts_with("Is a directory")
    );
    trial.import("time_s,event\n1,a\n").unwrap();
    let taken = import(&trial.path("in.csv"), &trial.path("out.mcap"));
    let words = taken.unwrap_err().to_string();
    assert!(
        words.ends_with("already exists and is not overwritten"),
        "{words}"
    );
}
