//! Recordings on the command line: recorded, looked into, exported, recovered, and every file that is none.

use crate::setup::process::{Ended, Running, run, start};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A recording of the simulated hand in a folder of its own.
struct Recorded {
    folder: TempDir,
    stats: Value,
}

fn record(seconds: &str) -> Recorded {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("session.mcap");
    let hand = "sim:?scenario=grasp";
    let ended = run(&[
        "record",
        "--hand",
        hand,
        "--for",
        seconds,
        "--out",
        text(&file),
    ])
    .ok();
    assert_eq!(ended.out.lines().count(), 1, "{}", ended.out);
    let stats = ended.lines().remove(0);
    Recorded { folder, stats }
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

impl Recorded {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn info(&self, name: &str) -> Value {
        let ended = run(&["info", text(&self.path(name)), "--json"]).ok();
        ended.lines().remove(0)
    }

    fn export(&self, more: &[&str], to: &str) -> Ended {
        let (file, to) = (self.path("session.mcap"), self.path(to));
        run(&[&["export", text(&file)], more, &["--out", text(&to)]].concat())
    }

    /// Names in the folder, hidden ones too.
    fn names(&self) -> Vec<String> {
        let all = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = all
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

fn rows(csv: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let cells = |line: &str| line.split(',').map(str::to_owned).collect();
    let mut lines = csv.lines();
    (cells(lines.next().unwrap()), lines.map(cells).collect())
}

/// A sentence on standard error, and nothing else.
fn refused(ended: &Ended, code: i32, words: &[&str]) {
    assert_eq!(ended.code, Some(code), "{}", ended.err);
    assert_eq!(ended.out, "");
    for word in words {
        assert!(ended.err.contains(word), "{word}: {}", ended.err);
    }
    if code == 1 {
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    }
}

#[test]
fn a_recording_tells_what_it_holds_and_nothing_is_missing_in_it() {
    let recorded = record("1.2");
    let stats = &recorded.stats;
    assert!(stats["states"].as_u64().unwrap() > 50, "{stats}");
    assert!(stats["touch_sweeps"].as_u64().unwrap() > 10, "{stats}");
    assert_eq!(
        (&stats["writes"], &stats["missing"]),
        (&0.into(), &0.into())
    );
    let info = recorded.info("session.mcap");
    for key in [
        "states",
        "touch_sweeps",
        "writes",
        "faults",
        "bytes",
        "length_s",
    ] {
        assert_eq!(info[key], stats[key], "{key}: {info}");
    }
    assert_eq!(info["hand"], "sim:?seed=1&scenario=grasp");
    assert_eq!(info["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        (&info["simulated"], &info["closed"]),
        (&true.into(), &true.into())
    );
    assert_eq!((&info["gaps"], &info["notes"]), (&0.into(), &0.into()));
    let length = info["length_s"].as_f64().unwrap();
    assert!((1.1..5.0).contains(&length), "{info}");
    let start = info["start"].as_str().unwrap();
    assert!(start.len() == 20 && start.ends_with('Z'), "{start}");
    let words = run(&["info", text(&recorded.path("session.mcap"))])
        .ok()
        .out;
    assert!(words.contains("nothing is missing"), "{words}");
    assert_eq!(recorded.names(), ["session.mcap"]);
}

#[test]
fn a_signal_closes_the_file_in_the_folder_of_the_day() {
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let documents = tempfile::tempdir().unwrap();
        let mut command = crate::setup::process::handscope();
        command.env("HANDSCOPE_DOCUMENTS", documents.path());
        command.args(["record", "--hand", "sim:"]);
        let mut running = crate::setup::process::listen(command);
        let began = running.complaint();
        assert!(began.contains("recording sim:"), "{began}");
        std::thread::sleep(std::time::Duration::from_millis(400));
        running.signal(signal);
        let ended = running.end().ok();
        let stats = ended.lines().remove(0);
        let file = PathBuf::from(stats["file"].as_str().unwrap());
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(name.ends_with("-sim.mcap") && name.len() == 15, "{name}");
        let day = file.parent().unwrap();
        assert_eq!(day.parent().unwrap(), documents.path().join("Handscope"));
        let info = run(&["info", text(&file), "--json"]).ok().lines().remove(0);
        assert_eq!(info["closed"], true, "{info}");
        assert!(info["states"].as_u64().unwrap() > 10, "{info}");
    }
}

#[test]
fn a_renamed_file_is_told_and_written_on_and_one_that_cannot_be_written_still_has_its_statistics() {
    let folder = tempfile::tempdir().unwrap();
    let day = folder.path().join("day");
    let (file, other) = (day.join("a.mcap"), folder.path().join("b.mcap"));
    let mut running = start(&["record", "--hand", "sim:", "--out", text(&file)]);
    running.complaint();
    std::fs::rename(&file, &other).unwrap();
    let told = running.complaint();
    let words = format!(
        "{} was renamed during recording; it continues as {}, and nothing is lost",
        file.display(),
        other.display()
    );
    assert!(told.contains(&words), "{told}");
    running.signal(Signal::SIGINT);
    let stats = running.end().ok().lines().remove(0);
    assert_eq!(stats["file"], text(&other));
    assert_eq!(
        (&stats["missing"], &stats["closed"]),
        (&0.into(), &true.into())
    );
    // Its folder is removed, and a file takes the folder's place: nothing can be written any more.
    let mut running = start(&["record", "--hand", "sim:", "--out", text(&file)]);
    running.complaint();
    std::fs::remove_dir_all(&day).unwrap();
    std::fs::write(&day, "").unwrap();
    let told = running.complaint();
    assert!(told.contains("was removed during recording"), "{told}");
    let told = running.complaint();
    assert!(told.contains("cannot be written"), "{told}");
    running.signal(Signal::SIGINT);
    let ended = running.end();
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    let stats = ended.lines().remove(0);
    assert_eq!(
        (&stats["states"], &stats["closed"]),
        (&Value::Null, &false.into())
    );
    assert!(stats["missing"].as_u64().unwrap() > 0, "{stats}");
}

#[test]
fn a_killed_recording_opens_says_that_it_was_not_closed_and_is_recovered() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("killed.mcap");
    let mut running = start(&["record", "--hand", "sim:", "--out", text(&file)]);
    running.complaint();
    std::thread::sleep(std::time::Duration::from_millis(900));
    running.kill();
    let info = |path: &Path| run(&["info", text(path), "--json"]).ok().lines().remove(0);
    let killed = info(&file);
    assert_eq!(killed["closed"], false);
    assert!(killed["length_s"].as_f64().unwrap() > 0.3, "{killed}");
    let words = run(&["info", text(&file)]).ok().out;
    assert!(words.contains("not closed"), "{words}");
    let before = std::fs::read(&file).unwrap();
    let told = run(&["recover", text(&file)]).ok().out;
    assert!(told.contains("killed-recovered.mcap"), "{told}");
    let whole = info(&folder.path().join("killed-recovered.mcap"));
    assert_eq!(whole["closed"], true);
    for key in ["states", "touch_sweeps", "hand", "start"] {
        assert_eq!(whole[key], killed[key], "{key}");
    }
    assert_eq!(std::fs::read(&file).unwrap(), before);
    refused(
        &run(&["recover", text(&file)]),
        1,
        &["already exists", "--out"],
    );
}

#[test]
fn a_recording_is_for_its_person_alone_whichever_command_makes_it() {
    let recorded = record("0.6");
    let (file, csv) = (recorded.path("session.mcap"), recorded.path("a.csv"));
    recorded.export(&["--csv"], "a.csv").ok();
    recorded.export(&["--mcap"], "cut.mcap").ok();
    run(&["recover", text(&file)]).ok();
    run(&["import", text(&csv)]).ok();
    for name in [
        "session.mcap",
        "cut.mcap",
        "session-recovered.mcap",
        "a.mcap",
    ] {
        let about = std::fs::metadata(recorded.path(name)).unwrap();
        assert_eq!(about.permissions().mode() & 0o777, 0o600, "{name}");
    }
}

#[test]
fn damage_costs_a_piece_and_is_told() {
    let recorded = record("1.5");
    let mut bytes = std::fs::read(recorded.path("session.mcap")).unwrap();
    let mut file = std::fs::File::open(recorded.path("session.mcap")).unwrap();
    let found = handscope::record::file::walk::walk(&mut file).unwrap();
    // In what a chunk holds: a bit of an index costs nothing.
    let chunk = found.chunks[found.chunks.len() / 2].place;
    let middle = usize::try_from(chunk.offset + chunk.len / 2).unwrap();
    bytes[middle] ^= 0x10;
    std::fs::write(recorded.path("session.mcap"), &bytes).unwrap();
    let info = recorded.info("session.mcap");
    assert!(info["gaps"].as_u64().unwrap() >= 1, "{info}");
    let ended = recorded.export(&["--csv"], "a.csv").ok();
    assert!(ended.err.contains("damaged"), "{}", ended.err);
    let file = recorded.path("session.mcap");
    let told = run(&["recover", text(&file), "--json"])
        .ok()
        .lines()
        .remove(0);
    assert_eq!(told["damaged_chunks"], info["damaged_chunks"], "{told}");
    let whole = recorded.info("session-recovered.mcap");
    assert_eq!(
        (&whole["damaged_chunks"], &whole["gaps"]),
        (&0.into(), &1.into())
    );
}

#[test]
fn a_damaged_piece_is_called_left_out_only_if_messages_are_missing() {
    let recorded = record("1.5");
    let file = recorded.path("session.mcap");
    let bytes = std::fs::read(&file).unwrap();
    let mut opened = std::fs::File::open(&file).unwrap();
    let found = handscope::record::file::walk::walk(&mut opened).unwrap();
    let mut words = Vec::new();
    for chunk in &found.chunks {
        // In its length: the next one is looked for, and its messages may be found all the same.
        let place = usize::try_from(chunk.place.offset).unwrap() + 1;
        let mut bytes = bytes.clone();
        bytes[place] ^= 0x10;
        std::fs::write(&file, &bytes).unwrap();
        let info = recorded.info("session.mcap");
        let told = run(&["info", text(&file)]).ok().out;
        let misses = info["missing_messages"].as_u64().unwrap() > 0;
        assert_eq!(told.contains("left out"), misses, "{info} {told}");
        words.push(misses);
    }
    assert!(words.contains(&false), "none was found whole");
}

#[test]
fn a_csv_has_the_columns_of_the_plots_and_a_line_for_each_moment() {
    let recorded = record("1.2");
    recorded.export(&["--csv"], "all.csv").ok();
    let csv = std::fs::read_to_string(recorded.path("all.csv")).unwrap();
    let (head, lines) = rows(&csv);
    assert_eq!(
        (head[0].as_str(), head.last().unwrap().as_str()),
        ("time_s", "event")
    );
    for name in [
        "angle_index",
        "force_thumb_bend_g",
        "current_little_mA",
        "temperature_ring_C",
        "target_angle_middle",
        "normal_thumb_N",
        "channel_8_little",
    ] {
        let place = head.iter().position(|head| head == name).expect(name);
        assert!(lines.iter().any(|line| !line[place].is_empty()), "{name}");
    }
    let place = head.iter().position(|head| head == "angle_index").unwrap();
    let read = lines.iter().filter(|line| !line[place].is_empty()).count();
    assert_eq!(recorded.stats["states"], read);
    let times: Vec<f64> = lines.iter().map(|line| line[0].parse().unwrap()).collect();
    assert!(times.is_sorted() && times[0] >= 0.0 && *times.last().unwrap() < 5.0);
    let told = recorded.export(
        &["--csv", "--from", "0.5", "--to", "0.8", "--json"],
        "part.csv",
    );
    let part = std::fs::read_to_string(recorded.path("part.csv")).unwrap();
    let inside = |line: &&str| {
        let time: f64 = line.split(',').next().unwrap().parse().unwrap_or(-1.0);
        (0.5..=0.8).contains(&time)
    };
    let wanted: Vec<&str> = csv.lines().filter(inside).collect();
    assert_eq!(part.lines().skip(1).collect::<Vec<_>>(), wanted);
    assert_eq!(told.ok().lines()[0]["rows"], wanted.len());
}

#[test]
fn a_cut_opens_again_with_what_the_session_said_of_itself() {
    let recorded = record("1.5");
    recorded
        .export(&["--mcap", "--from", "0.4", "--to", "1"], "cut.mcap")
        .ok();
    let (whole, cut) = (recorded.info("session.mcap"), recorded.info("cut.mcap"));
    for key in ["hand", "simulated", "version", "closed", "gaps"] {
        assert_eq!(whole[key], cut[key], "{key}");
    }
    assert!(
        (0.5..=0.6).contains(&cut["length_s"].as_f64().unwrap()),
        "{cut}"
    );
    let file = recorded.path("cut.mcap");
    let csv = recorded.path("cut.csv");
    run(&["export", text(&file), "--csv", "--out", text(&csv)]).ok();
    recorded
        .export(&["--csv", "--from", "0.4", "--to", "1"], "part.csv")
        .ok();
    let values = |name: &str| {
        let text = std::fs::read_to_string(recorded.path(name)).unwrap();
        let lines = rows(&text).1.into_iter();
        // What was before a cut is not known in it, and the grip rests on that.
        let but_grip =
            |line: Vec<String>| [&line[1..line.len() - 8], &line[line.len() - 2..]].concat();
        lines.map(but_grip).collect::<Vec<_>>()
    };
    assert_eq!(values("cut.csv"), values("part.csv"));
    let (names, lines) = rows(&std::fs::read_to_string(recorded.path("part.csv")).unwrap());
    let grip = names.iter().position(|name| name == "grip").unwrap();
    assert_eq!(names[grip + 5], "grip_thumb");
    assert!(lines.iter().any(|line| !line[grip].is_empty()), "{lines:?}");
}

#[test]
fn tables_and_bags_take_their_place_whole_or_not_at_all() {
    let recorded = record("1");
    recorded.export(&["--parquet"], "a.parquet").ok();
    let bytes = std::fs::read(recorded.path("a.parquet")).unwrap();
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    recorded.export(&["--rosbag"], "bag").ok();
    let bag = recorded.path("bag");
    let yaml = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    assert!(yaml.contains("storage_identifier: mcap") && yaml.contains("'bag_0.mcap'"));
    let inside = run(&["info", text(&bag.join("bag_0.mcap")), "--json"]).ok();
    assert_eq!(inside.lines()[0]["states"], recorded.stats["states"]);
    let names = recorded.names();
    for form in ["--csv", "--parquet", "--rosbag", "--mcap"] {
        for there in ["session.mcap", "a.parquet", "bag"] {
            refused(
                &recorded.export(&[form], there),
                1,
                &["already exists", "--out"],
            );
        }
        refused(
            &recorded.export(&[form], "none/here"),
            1,
            &["cannot write", "none/here"],
        );
    }
    assert_eq!(recorded.names(), names, "nothing is left over");
    assert_eq!(std::fs::read(recorded.path("a.parquet")).unwrap(), bytes);
}

#[test]
fn a_bag_is_played_with_the_model_for_whoever_comes_late() {
    let recorded = record("1");
    recorded.export(&["--rosbag"], "bag").ok();
    let bag = recorded.path("bag");
    let yaml = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    let bytes = std::fs::read(bag.join("bag_0.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    for channel in summary.channels.values() {
        let topic = format!("name: {}\n", channel.topic);
        let Some((_, listed)) = yaml.split_once(&topic) else {
            continue;
        };
        // Readers compare what the folder and the file say of a topic.
        let quality = listed.split("offered_qos_profiles: ").nth(1).unwrap();
        let quality = quality.lines().next().unwrap().trim_matches('"');
        let own = channel.metadata.get("offered_qos_profiles");
        let own = own.map(String::as_str).unwrap_or_default();
        assert_eq!(quality.replace("\\n", "\n"), own, "{topic}");
        let is_kept = own.contains("durability: 1") && own.contains("reliability: 1");
        let is_lasting = ["/tf_static", "/robot_description"].contains(&channel.topic.as_str());
        assert_eq!(is_kept, is_lasting, "{topic}");
        if is_lasting {
            let count = listed.split("message_count: ").nth(1).unwrap();
            assert_eq!(count.lines().next(), Some("1"), "{topic}");
        }
    }
}

#[test]
fn a_data_set_for_learners_says_how_it_was_made() {
    let recorded = record("2.5");
    // The joints move, and nobody told them to.
    refused(
        &recorded.export(&["--lerobot", "--fps", "20"], "none"),
        1,
        &["no joint was commanded", "--uncommanded"],
    );
    let args = ["--lerobot", "--fps", "20", "--uncommanded", "--json"];
    let told = recorded.export(&args, "set").ok();
    assert!(
        told.err
            .contains("in 1 of 1 episodes no joint was commanded"),
        "{}",
        told.err
    );
    let frames = told.lines()[0]["rows"].as_u64().unwrap();
    assert!((20..=90).contains(&frames), "{frames}");
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(recorded.path("set/meta").join(name)).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let info = read("info.json");
    assert_eq!(
        (&info["codebase_version"], &info["fps"]),
        (&"v3.0".into(), &20.into())
    );
    assert_eq!(info["total_frames"], frames);
    let warning = info["handscope"]["action_warning"].as_str().unwrap();
    assert!(warning.contains("no joint was commanded"), "{warning}");
    assert_eq!(info["handscope"]["action_uncommanded_episodes"], 1);
    let names = &info["features"]["action"]["names"];
    assert_eq!(names[0], "kRightHandPinky");
    assert_eq!(names[5], "kRightHandThumbRotation");
    assert!(
        info["handscope"]["gaps"]
            .as_str()
            .unwrap()
            .contains("0.5 s")
    );
    let state = &read("stats.json")["observation.state"];
    assert_eq!(state["count"][0], frames);
    assert!(state["q99"][3].as_f64().unwrap() <= 1.0, "{state}");
    let short = recorded.export(&["--lerobot", "--from", "0", "--to", "0"], "none");
    refused(
        &short,
        1,
        &["there is nothing to export in this time range", "--from"],
    );
    refused(
        &recorded.export(&["--lerobot", "--fps", "0"], "none"),
        2,
        &["--fps"],
    );
    refused(
        &recorded.export(&["--csv", "--fps", "5"], "none"),
        2,
        &["--lerobot"],
    );
    assert_eq!(recorded.names(), ["session.mcap", "set"]);
}

/// A recorded hand on TCP, with its endpoint.
fn replayed(file: &Path, more: &[&str]) -> (Running, String) {
    let args = ["replay", text(file), "--tcp", "127.0.0.1:0"];
    let mut replay = start(&[&args, more].concat());
    let ready = replay.line();
    let address = ready.strip_prefix("ready tcp ").expect(&ready);
    (replay, format!("tcp:{address}"))
}

/// The angles of a recording, without those that repeat.
fn angles(recorded: &Recorded, file: &str) -> Vec<String> {
    let (file, csv) = (recorded.path(file), recorded.path("angles.csv"));
    run(&["export", text(&file), "--csv", "--out", text(&csv)]).ok();
    let lines = rows(&std::fs::read_to_string(&csv).unwrap()).1;
    std::fs::remove_file(&csv).unwrap();
    let six = lines.iter().map(|line| line[1..7].join(","));
    let mut six: Vec<String> = six.filter(|six| six != ",,,,,").collect();
    six.dedup();
    six
}

#[test]
fn a_replayed_hand_says_what_was_recorded_and_nothing_else() {
    let recorded = record("3");
    let (replay, hand) = replayed(&recorded.path("session.mcap"), &["--loop"]);
    let again = recorded.path("again.mcap");
    run(&[
        "record",
        "--hand",
        &hand,
        "--for",
        "2",
        "--out",
        text(&again),
    ])
    .ok();
    drop(replay);
    let (before, after) = (
        angles(&recorded, "session.mcap"),
        angles(&recorded, "again.mcap"),
    );
    assert!(after.len() > 10, "{after:?}");
    for six in &after {
        assert!(before.contains(six), "{six} was never recorded");
    }
}

#[test]
fn a_replayed_hand_acknowledges_writes_and_keeps_to_the_recording() {
    let recorded = record("1");
    let file = recorded.path("session.mcap");
    let (replay, hand) = replayed(&file, &["--loop", "--id", "9", "--speed", "0.5"]);
    let read = |name: &str| {
        run(&["read", name, "--hand", &hand, "--json"])
            .ok()
            .lines()
            .remove(0)
    };
    let before = read("DEFAULT_SPEED_SET");
    assert_eq!(
        before["DEFAULT_SPEED_SET"],
        serde_json::json!([1000, 1000, 1000, 1000, 1000, 1000])
    );
    let params = recorded.path("params.toml");
    std::fs::write(
        &params,
        "format = \"handscope-params\"\nversion = 1\n[default_speed]\nindex = 77\n",
    )
    .unwrap();
    let folder = recorded.path("kept");
    let apply = [
        "params",
        "apply",
        text(&params),
        "--hand",
        &hand,
        "--folder",
        text(&folder),
    ];
    let applied = run(&apply);
    assert_eq!(applied.code, Some(1), "{}{}", applied.out, applied.err);
    assert_eq!(read("DEFAULT_SPEED_SET"), before);
    drop(replay);
}

#[test]
fn a_replay_ends_with_the_recording_at_the_speed_that_was_asked_for() {
    let recorded = record("2");
    for (speed, seconds) in [("4", 0.3..1.8), ("1", 1.7..6.0)] {
        let (replay, _) = replayed(&recorded.path("session.mcap"), &["--speed", speed]);
        let ended = replay.end().ok();
        let took = ended.took.as_secs_f64();
        assert!(seconds.contains(&took), "{speed} times: {took}");
    }
    let file = recorded.path("session.mcap");
    refused(&run(&["replay", text(&file)]), 2, &["--tcp"]);
    let wild = [
        "replay",
        text(&file),
        "--tcp",
        "127.0.0.1:0",
        "--speed",
        "0",
    ];
    refused(&run(&wild), 2, &["between 0.1 and 100"]);
    let gone = recorded.path("gone.mcap");
    refused(
        &run(&["replay", text(&gone), "--tcp", "127.0.0.1:0"]),
        1,
        &["No such file"],
    );
}

#[test]
fn what_is_no_session_is_refused_in_one_sentence_by_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("empty"), b"").unwrap();
    std::fs::write(path("text.mcap"), "time_s,angle\n1,2\n".repeat(1000)).unwrap();
    std::fs::write(path("head.mcap"), b"\x89MCAP0\r\n").unwrap();
    std::fs::write(
        path("huge.mcap"),
        [b"\x89MCAP0\r\n".as_slice(), &[0xFF; 4000]].concat(),
    )
    .unwrap();
    let sparse = std::fs::OpenOptions::new()
        .write(true)
        .open(path("huge.mcap"))
        .unwrap();
    sparse.set_len(200_000_000).unwrap();
    for (name, words) in [
        ("gone.mcap", "No such file"),
        ("", "is not a regular file"),
        ("empty", "is not an MCAP file"),
        ("text.mcap", "is not an MCAP file"),
        ("head.mcap", "no complete part"),
        ("huge.mcap", "no complete part"),
    ] {
        let file = path(name);
        let out = path("out");
        for args in [
            &["info", text(&file)][..],
            &["info", text(&file), "--json"],
            &["export", text(&file), "--csv", "--out", text(&out)],
            &["recover", text(&file), "--out", text(&out)],
        ] {
            refused(&run(args), 1, &[words, "cannot open", "; "]);
        }
        assert!(!out.exists(), "{name}");
    }
}

#[test]
fn exported_values_are_made_a_session_again_that_says_what_it_does_not_know() {
    let recorded = record("1");
    recorded.export(&["--csv"], "values.csv").ok();
    let csv = recorded.path("values.csv");
    for args in [
        &["info", text(&csv)][..],
        &["recover", text(&csv)],
        &["replay", text(&csv), "--tcp", "127.0.0.1:0"],
    ] {
        refused(&run(args), 1, &["not an MCAP file", "handscope import"]);
    }
    refused(&run(&[text(&csv)]), 2, &["handscope import"]);
    let told = run(&["import", text(&csv), "--json"])
        .ok()
        .lines()
        .remove(0);
    assert_eq!(told["skipped_columns"], serde_json::json!([]));
    let rows = std::fs::read_to_string(&csv).unwrap().lines().count() - 1;
    assert_eq!(told["rows"], rows);
    let info = recorded.info("values.mcap");
    assert_eq!(
        (info["start"].clone(), info["hand"].clone()),
        (Value::Null, "".into())
    );
    assert_eq!(
        (info["gaps"].clone(), info["closed"].clone()),
        (0.into(), true.into())
    );
    assert_eq!(info["states"], recorded.info("session.mcap")["states"]);
    let words = run(&["info", text(&recorded.path("values.mcap"))]).ok().out;
    assert!(words.contains("start         not known"), "{words}");
    let again = run(&["import", text(&csv)]);
    refused(&again, 1, &["is not overwritten", "--out"]);
    std::fs::write(&csv, "time_s,mood\n").unwrap();
    let out = recorded.path("x.mcap");
    let wrong = run(&["import", text(&csv), "--out", text(&out)]);
    refused(
        &wrong,
        1,
        &[
            "cannot import",
            "line 1: it has no known column except time_s",
        ],
    );
    assert!(!out.exists());
}

#[test]
fn wrong_flags_are_told_before_anything_is_done() {
    let recorded = record("0.5");
    let file = recorded.path("session.mcap");
    let (file, out) = (text(&file), recorded.path("x"));
    let out = text(&out);
    for (args, words) in [
        (&["record"][..], "--hand"),
        (
            &["record", "--hand", "nonsense"],
            "does not name a kind of link",
        ),
        (
            &["record", "--hand", "sim:", "--for", "soon"],
            "number of seconds",
        ),
        (&["info"], "FILE.mcap"),
        (&["export", file, "--out", out], "--csv"),
        (&["export", file, "--csv"], "--out"),
        (
            &["export", file, "--csv", "--parquet", "--out", out],
            "cannot be used with",
        ),
        (
            &["export", file, "--csv", "--from", "soon", "--out", out],
            "number of seconds",
        ),
        (&["recover"], "FILE.mcap"),
        (&["import"], "FILE.csv"),
    ] {
        refused(&run(args), 2, &[words]);
    }
    let backwards = recorded.export(&["--csv", "--from", "2", "--to", "1"], "x");
    refused(
        &backwards,
        1,
        &["nothing between --from and --to", "s long"],
    );
    let taken = run(&["record", "--hand", "sim:", "--out", file]);
    refused(&taken, 1, &["is not overwritten", "--out"]);
    let nowhere = run(&["record", "--hand", "tcp:127.0.0.1:1", "--out", out]);
    refused(&nowhere, 1, &["no hand at"]);
    assert_eq!(recorded.names(), ["session.mcap"]);
}

/// Width, height and pixels of a picture, RGB row by row.
fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgb).unwrap();
    (info.width, info.height, rgb)
}

#[test]
fn a_picture_shows_just_the_stretch_and_a_wrong_one_makes_no_file() {
    let recorded = record("4");
    let draw = |from: &str, to: &str, name: &str| {
        recorded.export(&["--png", "--from", from, "--to", to], name)
    };
    for (from, to, name) in [
        ("0.5", "1.5", "a.png"),
        ("0.5", "1.5", "b.png"),
        ("1", "3.5", "c.png"),
    ] {
        let ended = draw(from, to, name).ok();
        assert!(ended.out.contains("1 picture in"), "{}", ended.out);
    }
    let [a, b, c] = ["a.png", "b.png", "c.png"].map(|name| pixels(&recorded.path(name)));
    assert_eq!((a.0, a.1), (1440, 900));
    assert!(a == b, "the same stretch gives the same picture");
    // The plots fill the lower middle of the window.
    let row = 1440 * 3;
    let plots = |picture: &(u32, u32, Vec<u8>)| {
        let rows = picture.2.chunks_exact(row).skip(450).take(350);
        rows.flat_map(|row| row[600 * 3..900 * 3].to_vec())
            .collect::<Vec<u8>>()
    };
    let (one, other) = (plots(&a), plots(&c));
    let differ = one.chunks_exact(3).zip(other.chunks_exact(3));
    let differ = differ.filter(|(one, other)| one != other).count();
    assert!(differ > 300, "{differ} pixels of the plots differ");
    let names = recorded.names();
    refused(&draw("3", "1", "d.png"), 1, &["--from must be before --to"]);
    refused(
        &draw("100", "200", "d.png"),
        1,
        &["nothing", "--from and --to"],
    );
    refused(&draw("0", "1", "a.png"), 1, &["already exists", "--out"]);
    refused(
        &draw("0", "1", "none/a.png"),
        1,
        &["cannot write", "none/a.png"],
    );
    assert_eq!(recorded.names(), names);
}
