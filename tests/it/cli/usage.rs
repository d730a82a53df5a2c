//! What can be asked without a hand, and how what cannot be done is told.

use crate::setup::process::{handscope, listen, run, start, take_pipe};
use serde_json::Value;
use std::net::TcpListener;
use std::time::Duration;

/// A wrong hand, place or port is told of this soon, on a machine with other work too.
const SOON: Duration = Duration::from_secs(5);

#[test]
fn the_register_map_is_printed_for_people_and_scripts() {
    let text = run(&["registers"]).ok().out;
    let json = run(&["registers", "--json"]).ok().out;
    assert_eq!(json.lines().count(), 1, "as every command: a line");
    let rows: Vec<Value> = serde_json::from_str(&json).unwrap();
    assert_eq!(rows.len(), 32);
    for row in &rows {
        let name = row["name"].as_str().unwrap();
        assert!(text.contains(name), "{name}");
    }
    let angle = rows.iter().find(|row| row["name"] == "ANGLE_SET").unwrap();
    assert_eq!(angle["address"], 1486);
    assert_eq!(angle["access"], "rw");
    assert_eq!(angle["range"], serde_json::json!([0, 1000]));
    assert_eq!(angle["also"], -1);
}

#[test]
fn wrong_usage_ends_with_two_and_says_what_is_right() {
    for (args, words) in [
        (&["fly"][..], "fly"),
        (&["watch"], "--hand"),
        (
            &["watch", "--hand", "usb:x"],
            "does not name a kind of link",
        ),
        (
            &["watch", "--hand", "sim:", "--for", "soon"],
            "number of seconds",
        ),
        (&["read", "--hand", "sim:"], "NAME"),
        (&["read", "ANGLE_ATC", "--hand", "sim:"], "ANGLE_ACT"),
        (&["sim"], "--tcp"),
        (&["sim", "--tcp", "6000"], "127.0.0.1:6000"),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--scenario", "party"],
            "idle, free, rigid, fragile, grasp, touched, faults, extremes or frozen",
        ),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--body", "/nowhere/b.toml"],
            "the body /nowhere/b.toml cannot be used: there is no such file",
        ),
        (
            &["watch", "--hand", "sim:?body=/nowhere/b.toml", "--for", "1"],
            "the body /nowhere/b.toml cannot be used: there is no such file",
        ),
        (&["watch", "--hand", "sim:?body="], "--print-body"),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--object", "rock"],
            "the object rock cannot be used: there is no such file",
        ),
        (
            &["sim", "--print-object", "rock"],
            "cup, egg, sponge, block, tube, can",
        ),
        (
            &[
                "watch",
                "--hand",
                "sim:?object=/nowhere/o.toml",
                "--for",
                "1",
            ],
            "the object /nowhere/o.toml cannot be used: there is no such file",
        ),
        (
            &["watch", "--hand", "sim:?object=cup&scenario=faults"],
            "idle, free, rigid, fragile or grasp where an object is given",
        ),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--print-body"],
            "--print-body",
        ),
        (&["sim", "--tcp", "127.0.0.1:0", "--id", "255"], "254"),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--id", "1,2,2"],
            "id 2 is named twice",
        ),
        (&["sim", "--tcp", "127.0.0.1:0", "--id", "1;2"], "1,2,3"),
        (
            &["sim", "--tcp", "127.0.0.1:0", "--id", "1-40"],
            "at most 32",
        ),
        (
            &["watch", "--hand", "sim:?scenario=nope"],
            "idle, free, rigid, fragile, grasp, touched, faults, extremes or frozen",
        ),
        (
            &["read", "TEMP", "--hand", "tcp:127.0.0.1?unit=1&unit=2"],
            "duplicate key 'unit'",
        ),
        (&["snapshot"], "--out"),
        (
            &["snapshot", "--out", "x", "--view", "nowhere"],
            "live, touch, tune, compare, faults, poses, device, checkup, connection, inputs, traffic, sessions, window or all",
        ),
        (&["snapshot", "--out", "x", "--size", "big"], "WIDTHxHEIGHT"),
        (&["snapshot", "--out", "x", "--scenario", "party"], "grasp"),
    ] {
        let ended = run(args);
        assert_eq!(ended.code, Some(2), "{args:?}: {}", ended.err);
        assert!(ended.err.contains(words), "{args:?}: {}", ended.err);
        assert_eq!(ended.out, "", "{args:?}");
    }
}

#[test]
fn help_names_every_command_and_endpoint() {
    let help = run(&["--help"]).ok().out;
    for word in [
        "snapshot",
        "watch",
        "read",
        "sim",
        "registers",
        "rs485:",
        "tcp:",
        "Exit status",
    ] {
        assert!(help.contains(word), "{word}");
    }
    for command in ["snapshot", "watch", "read", "scan", "sim"] {
        let help = run(&[command, "--help"]).ok().out;
        assert!(help.contains("Examples"), "{command}");
    }
}

#[test]
fn without_a_display_one_sentence_names_what_works() {
    let home = tempfile::tempdir().unwrap();
    let mut command = handscope();
    command
        .env("HOME", home.path())
        .env("XDG_CONFIG_HOME", home.path());
    let ended = listen(command).end();
    assert_eq!(ended.code, Some(1));
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    assert!(ended.err.starts_with("handscope: "), "{}", ended.err);
    assert!(ended.err.contains("snapshot"), "{}", ended.err);
}

#[test]
fn every_way_to_miss_a_hand_has_its_own_words() {
    let folder = tempfile::tempdir().unwrap();
    let nobody = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let mute = TcpListener::bind("127.0.0.1:0").unwrap();
    let mut all = std::collections::BTreeSet::new();
    for (hand, words) in [
        (
            format!("rs485:{}/none", folder.path().display()),
            "is not there",
        ),
        (
            format!("rs485:{}", folder.path().display()),
            "is not a serial port",
        ),
        (format!("tcp:{nobody}"), "refused the connection"),
        (
            format!("tcp:{}", mute.local_addr().unwrap()),
            "nothing there answers as unit 255",
        ),
        (
            "can:nocan9".to_owned(),
            if cfg!(target_os = "linux") {
                "there is no CAN interface nocan9"
            } else {
                "need Linux"
            },
        ),
        (
            format!("slcan:{}/gone", folder.path().display()),
            "gone is not there",
        ),
    ] {
        for command in [
            &["watch", "--hand", &hand][..],
            &["read", "HAND_ID", "--hand", &hand],
        ] {
            let ended = run(command);
            assert_eq!(ended.code, Some(1), "{command:?}");
            assert!(ended.took < SOON, "{command:?} took {:?}", ended.took);
            assert!(ended.err.contains(words), "{command:?}: {}", ended.err);
            assert_eq!(ended.err.lines().count(), 1, "{command:?}: {}", ended.err);
            assert!(
                ended.err.contains(&hand) || hand.starts_with("sim"),
                "{command:?}: {}",
                ended.err
            );
        }
        all.insert(words);
    }
    assert_eq!(all.len(), 6);
}

#[test]
fn watching_for_a_time_goes_on_trying_and_then_fails_with_statistics() {
    let mut watch = start(&[
        "watch",
        "--hand",
        "rs485:/nowhere/hand",
        "--for",
        "1.2",
        "--json",
    ]);
    assert!(watch.complaint().contains("/nowhere/hand is not there"));
    let ended = watch.end();
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.took >= Duration::from_millis(1200),
        "{:?}",
        ended.took
    );
    let lines = ended.lines();
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0]["stats"]["state_reads"], 0);
    assert!(ended.err.contains("never answered"), "{}", ended.err);
}

#[test]
fn a_reader_that_went_away_ends_it_quietly() {
    let (mut child, pipe) = take_pipe(&["watch", "--hand", "sim:", "--for", "30", "--json"]);
    drop(pipe);
    let mut complaint = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().unwrap(), &mut complaint).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(complaint, "");
}

#[test]
fn a_slow_reader_slows_no_reads_and_lost_lines_are_counted() {
    let args = [
        "watch",
        "--hand",
        "sim:",
        "--for",
        "1",
        "--json",
        "--full-rate",
    ];
    let (mut child, mut pipe) = take_pipe(&args);
    std::thread::sleep(Duration::from_millis(700));
    let mut out = String::new();
    std::io::Read::read_to_string(&mut pipe, &mut out).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let lines: Vec<Value> = out
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let stats = &lines[lines.len() - 1]["stats"];
    assert_eq!(stats["dropped_samples"], 0, "{stats}");
    let lost = lines.iter().filter_map(|line| line["lost"].as_u64());
    let (gaps, lost) = lost.fold((0, 0), |(gaps, all), lost| (gaps + 1, all + lost));
    let shown = lines.len() as u64 - 1 - gaps;
    assert_eq!(stats["state_reads"], shown + lost, "{stats}");
    assert!(lines.len() > 50, "{stats}");
}

#[test]
fn a_place_that_cannot_be_served_is_told() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let ended = run(&["sim", "--tcp", &address]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.err.contains("Address already in use"),
        "{}",
        ended.err
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "mine").unwrap();
    let ended = run(&["sim", "--rs485", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.err.contains("a file that is not a link"),
        "{}",
        ended.err
    );
    assert_eq!(std::fs::read(&file).unwrap(), b"mine");
    let deep = folder.path().join("none/hand");
    let ended = run(&["sim", "--rs485", deep.to_str().unwrap()]);
    assert!(ended.err.contains("folder does not exist"), "{}", ended.err);
}

#[cfg(unix)]
#[test]
fn where_too_few_files_may_be_open_one_sentence_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("pictures");
    let pictures = ["snapshot", "--out", set.to_str().unwrap(), "--view", "live"];
    let mut told = 0;
    for limit in 3..=20 {
        for args in [
            &["read", "TEMP", "--hand", "sim:"][..],
            &["watch", "--hand", "tcp:127.0.0.1:1", "--for", "0.1"],
            &["sim", "--tcp", "127.0.0.1:99"],
            &["--hand", "sim:"],
            &pictures,
        ] {
            // The gallery takes its time where it can be drawn.
            if limit > 12 && (args[0] == "snapshot" || args[0] == "sim") {
                continue;
            }
            let mut command = std::process::Command::new("sh");
            command
                .args(["-c", "ulimit -n \"$0\"; exec \"$@\""])
                .arg(limit.to_string())
                .arg(env!("CARGO_BIN_EXE_handscope"))
                .args(args)
                .env_remove("DISPLAY")
                .env_remove("WAYLAND_DISPLAY");
            let ended = listen(command).end();
            // The system's loader itself needs some.
            if ended.code == Some(127) {
                continue;
            }
            assert!(
                matches!(ended.code, Some(0 | 1)) && !ended.err.contains("panicked"),
                "{limit} {args:?}: {:?} {}",
                ended.code,
                ended.err
            );
            if ended.err.contains("limit on open files") {
                assert_eq!((ended.code, ended.err.lines().count()), (Some(1), 1));
                told += 1;
            }
        }
    }
    assert!(told > 20, "only {told}");
}

#[test]
fn the_default_body_is_printed_and_is_a_body() {
    let text = run(&["sim", "--print-body"]).ok().out;
    assert!(text.contains("latency_ms = 64.0 # ms"), "{text}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("body.toml");
    std::fs::write(&path, &text).unwrap();
    let hand = format!("sim:?seed=3&body={}", path.display());
    run(&["watch", "--hand", &hand, "--for", "0.3"]).ok();
}

#[test]
fn every_named_object_is_printed_and_can_be_held() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["cup", "egg", "sponge", "block", "tube", "can"] {
        let text = run(&["sim", "--print-object", name]).ok().out;
        assert!(text.contains("mass_g = "), "{text}");
        let path = folder.path().join(name);
        std::fs::write(&path, &text).unwrap();
        let hand = format!("sim:?seed=3&object={}", path.display());
        run(&["watch", "--hand", &hand, "--for", "0.3"]).ok();
    }
}
