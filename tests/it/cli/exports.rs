//! What people do with recordings: data sets of what was commanded, several recordings at once, pipes, and a signal in the middle.

use crate::setup::process::{Ended, handscope, listen, run, start};
use handscope::hand::command::HandCommand;
use handscope::hand::kinematics::Side;
use handscope::hand::{Angle, Dof, HandSample, Moment, PerDof, Reply, Span, Target, register};
use handscope::record::export::{
    Destination, ExportFormat, ExportOptions, ExportSource, OutputKind,
};
use handscope::record::file::Opening;
use handscope::record::file::reader::{RecordingFile, TimeRange};
use handscope::record::file::writer::RecordingWriter;
use handscope::record::{
    Entry, Event, EventKind, LinkState, Record, WriteCause, WriteFate, WrittenMemory,
};
use nix::sys::signal::Signal;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::Field;
use serde_json::{Value, json};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A reading each so many milliseconds.
const TICK_MS: u64 = 20;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn at(millis: u64) -> Moment {
    Moment::from_micros(2_000_000 + 1000 * millis)
}

/// A recording in the making.
struct Script {
    entries: Vec<Entry>,
    sample: HandSample,
    number: u64,
}

impl Script {
    fn new() -> Self {
        Self {
            entries: vec![Entry::Heard(Record::State {
                at: at(0),
                state: LinkState::Monitoring,
            })],
            sample: HandSample::default(),
            number: 0,
        }
    }

    fn read(&mut self, millis: u64, span: Span, values: &[i16]) {
        let bytes: Vec<u8> = values.iter().flat_map(|raw| raw.to_le_bytes()).collect();
        let fresh = self.sample.apply(&Reply {
            span,
            bytes: &bytes,
            asked: at(millis),
            received: at(millis),
        });
        self.entries.push(Entry::Heard(Record::Reading {
            sample: Arc::new(self.sample),
            fresh,
        }));
    }

    /// Angle and force of the joints; the targets that the hand holds twice a second.
    fn tick(&mut self, millis: u64, angle: i16, held: i16) {
        self.read(
            millis,
            Span::new(register::ANGLE_ACT.address, 12),
            &[angle; 6],
        );
        self.read(
            millis,
            Span::new(register::FORCE_ACT.address, 12),
            &[100; 6],
        );
        if millis.is_multiple_of(500) {
            self.read(millis, register::ANGLE_SET.span(), &[held; 6]);
        }
    }

    /// Sends a target to the index finger and leaves the others alone.
    fn send(&mut self, millis: u64, cause: WriteCause, angle: i16, fate: WriteFate) {
        let mut six = PerDof::splat(None);
        six[Dof::Index] = Some(Target::Go(Angle::new(angle).unwrap()));
        let write = HandCommand::Angles(six).writes();
        self.number += 1;
        let (number, write) = (self.number, WrittenMemory::from(write.first().unwrap()));
        let at = at(millis);
        let sent = Record::Sent {
            at,
            number,
            cause,
            write,
        };
        self.entries.push(Entry::Heard(sent));
        let answered = Record::Answered { at, number, fate };
        self.entries.push(Entry::Heard(answered));
    }

    fn note(&mut self, millis: u64, words: &str) {
        self.entries.push(Entry::Event(Event {
            at: at(millis),
            kind: EventKind::Note,
            words: words.into(),
        }));
    }

    fn write(&self, path: &Path, side: Side) {
        self.write_of(path, side, PerDof::splat(None));
    }

    /// Writes the recording of a hand with these newtons.
    fn write_of(&self, path: &Path, side: Side, newtons_per_g: PerDof<Option<f64>>) {
        let opening = Opening {
            base_nanos: 1_795_219_200_000_000_000,
            began: at(0),
            hand: "tcp:127.0.0.1:6000".into(),
            simulated: false,
            side,
            newtons_per_g,
            version: "0.1.0".into(),
            part: None,
        };
        let mut writer = RecordingWriter::new(&opening).unwrap();
        for entry in &self.entries {
            writer.push(entry).unwrap();
        }
        writer.finish().unwrap();
        std::fs::write(path, writer.take_bytes()).unwrap();
    }
}

struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Exports files of this folder.
    fn export(&self, files: &[&str], more: &[&str], out: &str) -> Ended {
        let files: Vec<PathBuf> = files.iter().map(|name| self.path(name)).collect();
        let files: Vec<&str> = files.iter().map(|file| text(file)).collect();
        let out = self.path(out);
        run(&[&["export"], &files[..], more, &["--out", text(&out)]].concat())
    }

    fn names(&self) -> Vec<String> {
        let all = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = all
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn info(&self, set: &str) -> Value {
        let info = std::fs::read_to_string(self.path(set).join("meta/info.json")).unwrap();
        serde_json::from_str(&info).unwrap()
    }

    /// Of each frame: episode, time, and the index finger's action.
    fn frames(&self, set: &str) -> Vec<(i64, f32, f32)> {
        let data = self.path(set).join("data/chunk-000/file-000.parquet");
        let reader = SerializedFileReader::new(File::open(data).unwrap()).unwrap();
        let row = |row: parquet::record::Row| {
            let value = |name: &str| {
                let mut columns = row.get_column_iter();
                columns
                    .find(|(column, _)| *column == name)
                    .unwrap()
                    .1
                    .clone()
            };
            let list = |name: &str| match value(name) {
                Field::ListInternal(list) => list.elements().to_vec(),
                other => panic!("{other}"),
            };
            let action = &list("action")[Dof::Index.index()];
            let environment = list("observation.environment_state");
            assert_eq!(environment, list("observation.force"));
            match (value("episode_index"), value("timestamp"), action) {
                (Field::Long(episode), Field::Float(time), Field::Float(action)) => {
                    (episode, time, *action)
                }
                other => panic!("{other:?}"),
            }
        };
        let rows = reader.get_row_iter(None).unwrap();
        rows.map(|read| row(read.unwrap())).collect()
    }
}

/// A wrong command line or a refusal: one sentence, nothing on standard output.
fn refused(ended: &Ended, code: i32, words: &str) {
    assert_eq!(ended.code, Some(code), "{}{}", ended.out, ended.err);
    assert!(
        ended.out.is_empty() && ended.err.contains(words),
        "{words}: {}",
        ended.err
    );
}

/// What was sent at each time, in ms: the index finger closes by ramps, is stopped, and a refused write tells it nothing.
fn commanded() -> Script {
    let mut script = Script::new();
    for millis in (0..6000).step_by(TICK_MS as usize) {
        // The targets that it tells are of before.
        script.tick(millis, 700, 700);
        match millis {
            1000..3000 if millis.is_multiple_of(100) => {
                let angle = target_at(millis).try_into().unwrap();
                let acknowledged = WriteFate::Acknowledged;
                script.send(millis, WriteCause::Setpoint, angle, acknowledged);
            }
            3000 => script.send(3000, WriteCause::Hold, 444, WriteFate::Acknowledged),
            3200 => {
                let reason = "busy".into();
                script.send(3200, WriteCause::Request, 5, WriteFate::Refused { reason });
            }
            _ => {}
        }
        match millis {
            1500 => script.note(millis, "pick an egg"),
            3500 => script.note(millis, ""),
            _ => {}
        }
    }
    script
}

/// The index finger's target.
fn target_at(millis: u64) -> u64 {
    match millis {
        0..1000 => 700,
        1000..3000 => 700 - (millis - 1000) / 100 * 10,
        _ => 444,
    }
}

#[test]
fn a_hand_of_known_newtons_exports_them_beside_its_grams() {
    let place = Place::new();
    let mut newtons = PerDof::splat(None);
    (newtons[Dof::Index], newtons[Dof::ThumbBend]) = (Some(0.0071), Some(0.0129));
    let script = commanded();
    script.write_of(&place.path("known.mcap"), Side::Right, newtons);
    script.write(&place.path("plain.mcap"), Side::Right);

    place.export(&["known.mcap"], &["--csv"], "known.csv").ok();
    let csv = std::fs::read_to_string(place.path("known.csv")).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let column = |name: &str| head.iter().position(|own| *own == name);
    let (grams, in_newtons) = (column("force_index_g"), column("force_index_N"));
    assert!(column("force_thumb_bend_N").is_some() && column("force_ring_N").is_none());
    let mut read = 0;
    for line in lines {
        let (grams, in_newtons) = (line[grams.unwrap()], line[in_newtons.unwrap()]);
        assert_eq!(grams.is_empty(), in_newtons.is_empty());
        if let Ok(grams) = grams.parse::<f64>() {
            let force_n: f64 = in_newtons.parse().unwrap();
            assert!((force_n - 0.0071 * grams).abs() <= 0.0006, "{line:?}");
            read += 1;
        }
    }
    assert!(read > 100, "{read}");
    let known = place.path("known.csv");
    let imported = place.path("again.mcap");
    let told = run(&["import", text(&known), "--out", text(&imported)]).ok();
    assert!(!told.err.contains("force_index_N"), "{}", told.err);

    place
        .export(&["known.mcap"], &["--parquet"], "t.parquet")
        .ok();
    let table = File::open(place.path("t.parquet")).unwrap();
    let table = SerializedFileReader::new(table).unwrap();
    let schema = table.metadata().file_metadata().schema_descr();
    let names: Vec<&str> = schema
        .columns()
        .iter()
        .map(|column| column.name())
        .collect();
    assert!(names.contains(&"force_index_N") && !names.contains(&"force_ring_N"));

    let lerobot = ["--lerobot", "--task", "hold"];
    place.export(&["known.mcap"], &lerobot, "set").ok();
    let feature = &place.info("set")["features"]["observation.force_n"];
    let joints = ["kRightHandIndex", "kRightHandThumbBend"];
    assert_eq!(feature["names"], json!(joints), "{feature}");
    assert!(!place.frames("set").is_empty());
    place
        .export(&["known.mcap", "plain.mcap"], &lerobot, "both")
        .ok();
    let both = place.info("both");
    assert!(both["features"]["observation.force_n"].is_null(), "{both}");
}

#[test]
fn an_action_is_what_was_commanded_when_it_was_commanded() {
    let place = Place::new();
    let mut script = commanded();
    // Until late replies are through, what is read may be of before: the script ends there.
    script.entries.retain(|entry| entry.at() < at(4900));
    script.write(&place.path("a.mcap"), Side::Right);
    let told = place
        .export(&["a.mcap"], &["--lerobot", "--fps", "50", "--json"], "set")
        .ok();
    assert_eq!(told.err, "");
    assert_eq!(told.lines()[0]["action_read_back_frames"], 0);
    let frames = place.frames("set");
    assert!(frames.len() > 200, "{}", frames.len());
    for (_, time, action) in &frames {
        // A frame at the very moment of a command may be before it.
        let millis = (time * 1000.0).round() as u64;
        let wanted = [millis, millis.saturating_sub(1)].map(target_at);
        let action = (action * 1000.0).round() as u64;
        assert!(
            wanted.contains(&action),
            "at {millis} ms: {action}, not {wanted:?}"
        );
    }
    // What was commanded before a stretch holds on in it.
    let late = ["--lerobot", "--from", "3.3", "--to", "-0.5"];
    place.export(&["a.mcap"], &late, "late").ok();
    let late = place.frames("late");
    assert!(late.len() > 20 && late.iter().all(|frame| (frame.2 - 0.444).abs() < 1e-6));
}

#[test]
fn targets_of_another_controller_are_read_back_and_that_is_said() {
    let place = Place::new();
    let mut script = Script::new();
    for millis in (0..4000).step_by(TICK_MS as usize) {
        script.tick(millis, 700, if millis < 2000 { 700 } else { 300 });
    }
    script.write(&place.path("a.mcap"), Side::Right);
    let told = place
        .export(&["a.mcap"], &["--lerobot", "--json"], "set")
        .ok();
    let late = told.lines()[0]["action_read_back_frames"].as_u64().unwrap();
    let frames = place.frames("set");
    let changed = frames.iter().filter(|frame| frame.2 < 0.5).count();
    assert!(
        late as usize == changed && (55..=61).contains(&changed),
        "{late} {changed}"
    );
    assert!(
        told.err
            .contains(&format!("in {late} of {} frames", frames.len())),
        "{}",
        told.err
    );
    let info = &place.info("set")["handscope"];
    assert_eq!(info["action_read_back_frames"], late);
    assert!(
        info["action_warning"]
            .as_str()
            .unwrap()
            .contains("another controller")
    );
    assert_eq!(info["action_uncommanded_episodes"], 0);
    // What the hand held all along, and nobody changed, is no command.
    let still = ["--lerobot", "--to", "1.9"];
    let words = "no joint was commanded in this time range";
    refused(&place.export(&["a.mcap"], &still, "none"), 1, words);
    let wished = [&still[..], &["--uncommanded", "--json"]].concat();
    let told = place.export(&["a.mcap"], &wished, "still").ok();
    assert_eq!(told.lines()[0]["action_uncommanded_episodes"], 1);
    assert!(
        told.err
            .contains("in 1 of 1 episodes no joint was commanded"),
        "{}",
        told.err
    );
    let info = &place.info("still")["handscope"];
    let warning = info["action_warning"].as_str().unwrap();
    assert!(warning.contains("no joint was commanded"), "{warning}");
    assert_eq!(info["action_unfollowed_frames"], 0);
    refused(
        &place.export(&["a.mcap"], &["--csv", "--uncommanded"], "none"),
        2,
        "are for --lerobot",
    );
}

#[test]
fn a_joint_that_moves_while_its_action_stands_still_is_reported() {
    let place = Place::new();
    let mut script = Script::new();
    for millis in (0..6000).step_by(TICK_MS as usize) {
        // Two seconds after its command the hand is bent by something else, and stays so.
        let bent = i16::try_from(u64::saturating_sub(millis, 3000) / 4).unwrap();
        script.tick(millis, 700 - bent.min(400), 700);
        if millis == 1000 {
            script.send(1000, WriteCause::Setpoint, 700, WriteFate::Acknowledged);
        }
    }
    script.write(&place.path("a.mcap"), Side::Right);
    let told = place
        .export(&["a.mcap"], &["--lerobot", "--json"], "set")
        .ok();
    let frames = told.lines()[0]["action_unfollowed_frames"]
        .as_u64()
        .unwrap();
    // From the first that is 0.1 away, 400 ms after it began to move, to the end.
    assert!((74..=79).contains(&frames), "{frames}");
    let words = format!("in {frames} of ");
    assert!(
        told.err.contains(&words) && told.err.contains("index"),
        "{}",
        told.err
    );
    let info = &place.info("set")["handscope"];
    assert_eq!(info["action_unfollowed_frames"], frames);
    assert_eq!(info["action_unfollowed_joints"][3], "kRightHandIndex");
    let warning = info["action_warning"].as_str().unwrap();
    assert!(warning.contains("stands still"), "{warning}");
    assert_eq!(info["action_uncommanded_episodes"], 0);
}

#[test]
fn several_sessions_make_one_set_whose_episodes_begin_at_gaps_or_notes() {
    let place = Place::new();
    commanded().write(&place.path("a.mcap"), Side::Right);
    let mut gap = commanded();
    gap.entries
        .retain(|entry| !(at(4000)..at(5000)).contains(&entry.at()));
    gap.write(&place.path("b.mcap"), Side::Right);
    Script::new().write(&place.path("left.mcap"), Side::Left);
    let both = ["a.mcap", "b.mcap"];
    place.export(&both, &["--lerobot"], "gaps").ok();
    let info = place.info("gaps");
    assert_eq!(
        (&info["total_episodes"], &info["total_tasks"]),
        (&3.into(), &1.into())
    );
    let origin = &info["handscope"];
    assert_eq!(origin["recordings"][1]["file"], "b.mcap");
    let begins: Vec<(u64, f64)> = origin["episodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            (
                one["recording"].as_u64().unwrap(),
                one["from_s"].as_f64().unwrap(),
            )
        })
        .collect();
    assert_eq!(begins, [(0, 0.0), (1, 0.0), (1, 5.0)]);
    place
        .export(&both, &["--lerobot", "--episode", "notes"], "notes")
        .ok();
    let info = place.info("notes");
    // The note of 1.5 s, the one of 3.5 s, and in the second recording what is after the silence.
    assert_eq!(
        (&info["total_episodes"], &info["total_tasks"]),
        (&5.into(), &2.into())
    );
    assert_eq!(info["handscope"]["episodes"][0]["from_s"], 1.5);
    let frames = place.frames("notes");
    let first = frames.iter().filter(|frame| frame.0 == 0).count();
    assert!((58..=61).contains(&first), "{first}");
    assert_eq!(
        info["features"]["observation.environment_state"]["shape"],
        serde_json::json!([6])
    );
    assert_eq!(
        info["features"]["observation.environment_state"]["names"][3],
        "kRightHandIndexForce"
    );
    let grip = &info["features"]["observation.grip"];
    assert_eq!(grip["shape"], serde_json::json!([6]));
    assert_eq!(grip["names"][0], "kRightHandGrip");
    assert_eq!(grip["names"][5], "kRightHandThumbGrip");
    assert_eq!(info["handscope"]["grip_states"][4], "holding");
    let names = place.names();
    for (files, more, code, words) in [
        (
            &["a.mcap", "left.mcap"][..],
            &["--lerobot"][..],
            1,
            "a left and a right hand",
        ),
        (
            &["left.mcap"],
            &["--lerobot", "--episode", "notes"],
            1,
            "no user note",
        ),
        (
            &["left.mcap"],
            &["--lerobot"],
            1,
            "nothing to export in this time range",
        ),
        (
            &["a.mcap"],
            &["--csv", "--episode", "notes"],
            2,
            "--episode are for --lerobot",
        ),
        (
            &["a.mcap"],
            &["--lerobot", "--episode", "moods"],
            2,
            "notes",
        ),
        (&["a.mcap", "b.mcap"], &["--png"], 2, "one recording"),
    ] {
        refused(&place.export(files, more, "none"), code, words);
    }
    assert_eq!(place.names(), names);
}

#[test]
fn every_format_has_a_flag_and_writes_what_its_properties_name() {
    let place = Place::new();
    for name in ["a.mcap", "b.mcap"] {
        commanded().write(&place.path(name), Side::Right);
    }
    let help = run(&["export", "--help"]).ok().out;
    let help: Vec<&str> = help.split_whitespace().collect();
    let help = help.join(" ");
    let file = RecordingFile::open(&place.path("a.mcap")).unwrap();
    let source = ExportSource::new(&file, TimeRange::WHOLE);
    for &format in ExportFormat::ALL {
        let properties = format.properties();
        let (name, ending) = (properties.name, properties.ending);
        let flag = format!("--{name}");
        let is_folder = properties.kind == OutputKind::Folder;
        assert!(help.contains(&format!("{flag} {}", properties.description)));

        let direct = place.path(&format!("direct-{name}{ending}"));
        let write = |to: &Destination| format.write(&[source], to, &ExportOptions::default());
        let rows = write(&Destination::from(direct.as_path())).unwrap().rows();
        assert_eq!((direct.is_dir(), direct.is_file()), (is_folder, !is_folder));

        let one = place.export(&["a.mcap"], &[&flag], &format!("one-{name}{ending}"));
        let line = format!("{rows} {} in ", properties.unit);
        let out = one.ok().out;
        assert!(rows > 10 && out.starts_with(&line), "{line}: {out}");

        let both = format!("both-{name}");
        let told = place.export(&["a.mcap", "b.mcap"], &[&flag, "--json"], &both);
        assert_eq!(told.ok().lines()[0]["rows"], 2 * rows, "{name}");
        let parts = match (format, is_folder) {
            (ExportFormat::LeRobot, _) => ["data".to_owned(), "meta".to_owned()],
            (_, true) => ["a".to_owned(), "b".to_owned()],
            (_, false) => ["a", "b"].map(|stem| format!("{stem}{ending}")),
        };
        let found = std::fs::read_dir(place.path(&both)).unwrap();
        let mut found: Vec<_> = found.map(|part| part.unwrap().file_name()).collect();
        found.sort();
        assert_eq!(found, parts.map(std::ffi::OsString::from), "{name}");

        if is_folder {
            let refused = write(&Destination::Stdout).unwrap_err().to_string();
            assert!(refused.contains("standard output"), "{name}: {refused}");
        }
    }
}

#[test]
fn several_sessions_in_a_table_format_are_a_folder_of_tables() {
    let place = Place::new();
    std::fs::create_dir(place.path("other")).unwrap();
    commanded().write(&place.path("a.mcap"), Side::Right);
    commanded().write(&place.path("other/a.mcap"), Side::Right);
    place
        .export(&["a.mcap"], &["--csv", "--from", "-1.5"], "one.csv")
        .ok();
    let told = place.export(
        &["a.mcap", "other/a.mcap"],
        &["--csv", "--from", "-1.5", "--json"],
        "all",
    );
    let told = told.ok();
    let one = std::fs::read_to_string(place.path("one.csv")).unwrap();
    for name in ["all/a.csv", "all/a-2.csv"] {
        assert!(
            std::fs::read_to_string(place.path(name)).unwrap() == one,
            "{name}"
        );
    }
    let begin: f64 = one
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((begin - 4.48).abs() < 0.001, "{begin}");
    assert_eq!(told.lines()[0]["rows"], 2 * (one.lines().count() - 1));
    for (value, words) in [
        ("-soon", "number of seconds"),
        ("--1", "number"),
        ("-inf", "not between"),
    ] {
        let from = format!("--from={value}");
        refused(&place.export(&["a.mcap"], &["--csv", &from], "x"), 2, words);
    }
    let backwards = place.export(&["a.mcap"], &["--csv", "--from", "-1", "--to", "-2"], "x");
    refused(&backwards, 1, "nothing between --from and --to");
    // Longer ago than the recording is its start.
    place
        .export(&["a.mcap"], &["--csv", "--from", "-1000"], "whole.csv")
        .ok();
}

#[test]
fn sessions_and_tables_go_through_pipes_and_not_to_a_terminal() {
    let place = Place::new();
    commanded().write(&place.path("a.mcap"), Side::Right);
    let piped = |args: &[&str], from: &str, to: &str| {
        let mut command = handscope();
        command.args(args);
        command.stdin(File::open(place.path(from)).unwrap());
        command.stdout(File::create(place.path(to)).unwrap());
        let done = command.stderr(Stdio::piped()).output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(0), "{err}");
        err
    };
    for form in ["csv", "parquet", "mcap"] {
        let (flag, file) = (format!("--{form}"), format!("file.{form}"));
        place.export(&["a.mcap"], &[&flag], &file).ok();
        let err = piped(&["export", "-", &flag, "--out", "-"], "a.mcap", "piped");
        let (one, other) = (
            std::fs::read(place.path(&file)),
            std::fs::read(place.path("piped")),
        );
        assert!(one.unwrap() == other.unwrap(), "{form}");
        assert_eq!(err.lines().count(), 1, "{err}");
    }
    let (csv, imported) = (place.path("file.csv"), place.path("imported.mcap"));
    run(&["import", text(&csv), "--out", text(&imported)]).ok();
    piped(&["import", "-", "--out", "-"], "file.csv", "piped.mcap");
    let bytes = |name: &str| std::fs::read(place.path(name)).unwrap();
    assert!(bytes("imported.mcap") == bytes("piped.mcap"));
    place.export(&["piped.mcap"], &["--csv"], "again.csv").ok();
    assert!(bytes("again.csv") == bytes("file.csv"));
    // A reader that goes away ends it quietly.
    let file = place.path("a.mcap");
    let (mut child, out) =
        crate::setup::process::take_pipe(&["export", text(&file), "--csv", "--out", "-"]);
    drop(out);
    assert!(child.wait().unwrap().success());
    let names = place.names();
    for (args, words) in [
        (
            &["export", text(&file), "--rosbag", "--out", "-"][..],
            "is a folder",
        ),
        (
            &["export", text(&file), "--lerobot", "--out", "-"],
            "is a folder",
        ),
        (
            &["export", text(&file), "--png", "--out", "-"],
            "a picture is a file",
        ),
        (&["export", "-", "-", "--csv", "--out", "x"], "write - once"),
        (
            &["export", text(&file), "--csv", "--json", "--out", "-"],
            "leave out --json",
        ),
        (
            &["export", text(&file), text(&file), "--csv", "--out", "-"],
            "name it with --out",
        ),
        (&["import", "-"], "name the recording file with --out"),
    ] {
        refused(&run(args), 2, words);
    }
    let nothing = run(&["export", "-", "--csv", "--out", text(&place.path("x"))]);
    refused(
        &nothing,
        1,
        "cannot open standard input: it is not an MCAP file",
    );
    for form in ["--parquet", "--mcap"] {
        let terminal = nix::pty::openpty(None, None).unwrap();
        let mut command = handscope();
        command.args(["export", text(&file), form, "--out", "-"]);
        command
            .stdout(Stdio::from(terminal.slave))
            .stderr(Stdio::piped());
        let done = command.output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert!(
            done.status.code() == Some(2) && err.contains("for a terminal"),
            "{err}"
        );
    }
    assert_eq!(place.names(), names);
}

/// Long enough that a signal finds every export at work.
fn long(place: &Place) {
    let mut script = Script::new();
    for number in 0..20_000 {
        let angle = (number % 1000) as i16;
        script.tick(10 * number, angle, 700);
    }
    script.write(&place.path("long.mcap"), Side::Right);
}

#[test]
fn a_signal_in_the_middle_leaves_nothing_behind_whatever_is_made() {
    let place = Place::new();
    long(&place);
    let (file, out) = (place.path("long.mcap"), place.path("out"));
    let (file, out) = (text(&file), text(&out));
    let csv = place.path("long.csv");
    run(&["export", file, "--csv", "--out", text(&csv)]).ok();
    let names = place.names();
    let signals = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP]
        .into_iter()
        .cycle();
    for (args, signal) in [
        &["export", file, "--csv"][..],
        &["export", file, "--parquet"],
        &["export", file, "--mcap"],
        &["export", file, "--rosbag"],
        &["export", file, "--lerobot", "--fps", "200"],
        &["export", file, file, "--csv"],
        &["recover", file],
        &["import", text(&csv)],
    ]
    .into_iter()
    .zip(signals)
    {
        let running = start(&[args, &["--out", out]].concat());
        let until = Instant::now() + Duration::from_secs(30);
        while place.names().len() == names.len() {
            assert!(Instant::now() < until, "{args:?} begins");
            std::thread::sleep(Duration::from_millis(1));
        }
        running.signal(signal);
        let ended = running.end();
        refused(&ended, 1, "interrupted; nothing was written");
        assert_eq!(place.names(), names, "{args:?}");
    }
}

#[test]
fn nothing_is_told_of_progress_where_nobody_reads_it() {
    let place = Place::new();
    commanded().write(&place.path("a.mcap"), Side::Right);
    let mut command = handscope();
    let (file, out) = (place.path("a.mcap"), place.path("a.csv"));
    command.args(["export", text(&file), "--csv", "--out", text(&out)]);
    assert_eq!(listen(command).end().ok().err, "");
}
