//! `follow`: a hand that follows datagrams of another process, and what is told when it cannot.

use crate::cli::hold::ball;
use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, listen, run, sim_on_tcp, start, take_pipe};
use crate::setup::skipped::skipped;
use handscope::record::file::RecordingFile;
use nix::sys::signal::Signal;
use serde_json::Value;
use std::cell::RefCell;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{TcpStream, UdpSocket};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Follows on a free port; where that is.
fn following(hand: &str, more: &[&str]) -> (Running, String) {
    let args = ["follow", "--hand", hand, "--udp", "127.0.0.1:0", "--json"];
    let mut running = start(&[&args, more].concat());
    let ready = running.line();
    let place = ready.strip_prefix("ready udp ").expect(&ready).to_owned();
    (running, place)
}

/// Closes the index slowly, a hundred lines a second, until it is dropped.
pub(super) struct Sender {
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Sender {
    pub(super) fn start(place: &str) -> Self {
        Self::each(place, |seq| 1.0 - f64::from(seq % 400) / 1000.0)
    }

    /// Sends the index where this says.
    fn each(place: &str, index: fn(u32) -> f64) -> Self {
        Self::lines(place, move |seq| {
            let index = index(seq);
            format!(r#""right":[null,null,null,{index},null,null]"#)
        })
    }

    /// Sends these fields.
    fn lines(place: &str, fields: impl Fn(u32) -> String + Send + 'static) -> Self {
        let (place, ended) = (place.to_owned(), Arc::new(AtomicBool::new(false)));
        let until = Arc::clone(&ended);
        let send = move || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            for seq in 0.. {
                if until.load(Ordering::Relaxed) {
                    return;
                }
                let line = format!(r#"{{"seq":{seq},{}}}"#, fields(seq));
                let _sent = socket.send_to(line.as_bytes(), &place);
                std::thread::sleep(Duration::from_millis(10));
            }
        };
        Self {
            ended,
            thread: Some(std::thread::spawn(send)),
        }
    }
}

impl Drop for Sender {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap();
    }
}

pub(super) fn phase(line: &str) -> Value {
    serde_json::from_str::<Value>(line).unwrap()["phase"].take()
}

fn index(register: &str, hand: &str) -> i64 {
    let read = run(&["read", register, "--hand", hand, "--json"]).ok();
    let values = &read.lines()[0][register];
    values[3].as_i64().unwrap_or_else(|| panic!("{}", read.out))
}

fn angle(hand: &str) -> i64 {
    index("ANGLE_ACT", hand)
}

/// Where the index was told to go.
pub(super) fn setpoint(hand: &str) -> i64 {
    index("ANGLE_SET", hand)
}

#[test]
fn a_hand_follows_another_program_and_is_stopped_when_that_is_killed() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let before = angle(&hand);
        let (mut running, place) = following(&hand, &["--arm"]);
        let sends = Sender::start(&place);
        running.until(|line| phase(line) == "following");
        let told = running.until(|line| {
            let told: Value = serde_json::from_str(line).unwrap();
            told["phase"] == "following" && told["taken"].as_u64() > Some(150)
        });
        let told: Value = serde_json::from_str(&told).unwrap();
        assert!(told["delay_p99_ms"].as_f64().is_some(), "{told}");
        drop(sends);
        running.until(|line| phase(line) == "silent");
        // Nobody can press Enter in a test.
        let said = running.end();
        assert_eq!(said.code, Some(1), "{}", said.err);
        assert!(
            said.err.contains("fell silent: the hand was stopped"),
            "{}",
            said.err
        );
        let after = angle(&hand);
        assert!((before - after).abs() > 50, "{before} {after}");
    });
}

#[test]
fn an_object_is_held_while_lines_ask_for_it_and_their_end_stops_the_hand() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (mut running, place) = following(&ball(folder.path()), &["--arm"]);
        let sends = Sender::lines(&place, |_| {
            let forces = r#"{"at_least_g":150,"at_most_g":400}"#;
            format!(r#""right":[0.3,0.3,0.3,0.3,0.5,null],"hold":{forces}"#)
        });
        let held = running.until(|line| {
            let told: Value = serde_json::from_str(line).unwrap();
            told["hold"]["phase"] == "holding"
        });
        let told: Value = serde_json::from_str(&held).unwrap();
        assert_eq!(told["phase"], "holding", "{told}");
        assert_eq!(told["hold"]["end"], Value::Null, "{told}");
        assert_eq!(told["hold"]["forces"]["at_most_g"], 400, "{told}");
        drop(sends);
        running.until(|line| phase(line) == "silent");
        let said = running.end();
        assert!(
            said.err.contains("fell silent: the hand was stopped"),
            "{}",
            said.err
        );
    });
}

#[test]
fn nobody_says_that_a_hand_was_stopped_where_nothing_reached_it() {
    unless_busy(|| {
        let (sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let (mut running, place) = following(&hand, &["--arm"]);
        let _sends = Sender::start(&place);
        running.until(|line| phase(line) == "following");
        sim.kill();
        let said = running.end();
        assert_eq!(said.code, Some(1), "{}", said.err);
        assert!(
            said.err.contains("which may still finish its move"),
            "{}",
            said.err
        );
        assert!(!said.err.contains("was stopped"), "{}", said.err);
    });
}

#[test]
fn a_hand_is_held_when_the_output_is_closed() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let args = ["follow", "--hand", &hand, "--udp", "127.0.0.1:0", "--arm"];
        // A slow hand with its target far ahead: unless it is held, it goes on for long.
        let slow = ["--speed", "50", "--lead", "500", "--rate", "1700"];
        let (mut child, out) = take_pipe(&[&args[..], &slow].concat());
        let mut lines = BufReader::new(out).lines().map(Result::unwrap);
        let ready = lines.next().unwrap();
        let _sends = Sender::each(ready.strip_prefix("ready udp ").unwrap(), |seq| {
            f64::from(seq % 2) / 100.0
        });
        lines.find(|line| line.starts_with("following")).unwrap();
        // Until it moves: a drive needs its dead time.
        while angle(&hand) > 960 {}
        drop(lines);
        assert_eq!(child.wait().unwrap().code(), Some(1));
        let mut said = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut said)
            .unwrap();
        assert!(
            said.contains("the output is no longer read: the hand was stopped"),
            "{said}"
        );
        let (told, at) = (setpoint(&hand), angle(&hand));
        assert!(told > 100 && told.abs_diff(at) < 40, "told {told}, at {at}");
    });
}

#[test]
fn what_was_sent_stands_in_the_recording_and_a_disk_that_fails_holds_nothing_up() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        std::fs::write(path("file"), "").unwrap();
        for (name, is_kept) in [("moves.mcap", true), ("file/moves.mcap", false)] {
            let record = path(name);
            let (mut running, place) =
                following("sim:?scenario=free", &["--arm", "--record", &record]);
            let _sends = Sender::start(&place);
            let told = running.until(|line| {
                let told: Value = serde_json::from_str(line).unwrap();
                told["phase"] == "following" && told["taken"].as_u64() > Some(100)
            });
            running.signal(Signal::SIGINT);
            let ended = running.end();
            // The hand was followed all the same, and the recording that was asked for is not there.
            assert_eq!(ended.code, Some(i32::from(!is_kept)), "{}", ended.err);
            let is_told = ended.err.contains("the recording cannot be written");
            assert_eq!(is_told, !is_kept, "{told} {}", ended.err);
            if is_kept {
                let file = RecordingFile::open(record.as_ref()).unwrap();
                let writes = file.overview().counts.writes;
                assert!(writes > 10, "{writes}: {}", ended.err);
            }
        }
        let there = path("moves.mcap");
        let args = ["--udp", "127.0.0.1:0", "--record", &there];
        let ended = run(&[&["follow", "--hand", "sim:"], &args[..]].concat());
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("already exists"), "{}", ended.err);
    });
}

#[test]
fn a_recording_that_is_renamed_beside_a_command_is_told_at_once() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (file, other) = (folder.path().join("a.mcap"), folder.path().join("b.mcap"));
        let args = ["--record", file.to_str().unwrap()];
        let (mut running, _place) = following("sim:?scenario=free", &args);
        while !file.exists() {
            std::thread::sleep(Duration::from_millis(10));
        }
        std::fs::rename(&file, &other).unwrap();
        loop {
            let told = running.complaint();
            if told.contains("a.mcap was renamed during recording") {
                break;
            }
        }
    });
}

#[test]
fn a_second_hand_that_would_obey_the_same_sender_is_refused() {
    unless_busy(|| {
        let dds = |more: &[&str]| {
            let args = ["follow", "--hand", "sim:", "--dds", "--domain", "47"];
            start(&[&args[..], more].concat())
        };
        let mut first = dds(&["--arm", "--name", "egg"]);
        assert_eq!(first.line(), "ready dds 127.0.0.1");
        // Who only looks on, or is the other hand of a pair, is in nobody's way.
        for others in [&[][..], &["--arm", "--side", "left"]] {
            assert_eq!(dds(others).line(), "ready dds 127.0.0.1");
        }
        let ended = dds(&["--arm"]).end();
        assert_eq!(
            (ended.code, ended.out.as_str()),
            (Some(1), ""),
            "{}",
            ended.err
        );
        assert!(
            ended.err.contains("the right hand egg of "),
            "{}",
            ended.err
        );
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
        first.signal(Signal::SIGINT);
        first.end().ok();
        assert_eq!(dds(&["--arm"]).line(), "ready dds 127.0.0.1");
    });
}

#[test]
fn nothing_moves_without_a_person_who_lets_it() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let before = angle(&hand);
        let (mut running, place) = following(&hand, &[]);
        let sends = Sender::start(&place);
        let told = running.until(|line| {
            let told: Value = serde_json::from_str(line).unwrap();
            told["not_granted"].as_u64() > Some(50)
        });
        assert_eq!(phase(&told), "waiting");
        drop(sends);
        running.signal(Signal::SIGINT);
        running.end().ok();
        assert_eq!(angle(&hand), before);
    });
}

#[test]
fn ctrl_c_stops_the_hand_and_ends_well() {
    unless_busy(|| {
        let (mut running, place) = following("sim:?scenario=free", &["--arm"]);
        let sends = Sender::start(&place);
        running.until(|line| phase(line) == "following");
        running.signal(Signal::SIGINT);
        running.end().ok();
        drop(sends);
    });
}

/// Follows another hand; told as JSON.
fn mirroring(hand: &str, other: &str, more: &[&str]) -> Running {
    let args = ["follow", "--hand", hand, "--mirror", other, "--json"];
    let mut running = start(&[&args, more].concat());
    let ready = running.line();
    assert!(
        ready.starts_with(&format!("ready mirror {other}")),
        "{ready}"
    );
    running
}

#[test]
fn a_hand_follows_another_and_is_stopped_when_that_is_switched_off() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let (leads, other) = sim_on_tcp(&["--scenario", "free"]);
        let mut running = mirroring(&hand, &other, &["--scale", "0.5", "--arm"]);
        running.until(|line| phase(line) == "following");
        let moved = move_index(&other, 200);
        assert!(moved < 230, "{moved}");
        let told = running.until(|line| phase(line) == "following");
        let told: Value = serde_json::from_str(&told).unwrap();
        assert!(
            told["mirror"].as_str().unwrap().starts_with(&other),
            "{told}"
        );
        assert!(told["rate_hz"].as_f64() > Some(20.0), "{told}");
        let patience = std::time::Instant::now() + Duration::from_secs(20);
        while angle(&hand).abs_diff(600) > 30 {
            assert!(std::time::Instant::now() < patience, "{}", angle(&hand));
        }
        leads.kill();
        running.until(|line| phase(line) == "silent");
        // Nobody can press Enter in a test.
        let said = running.end();
        assert_eq!(said.code, Some(1), "{}", said.err);
        assert!(said.err.contains(&other), "{}", said.err);
        let words = "fell silent: the hand was stopped";
        assert!(said.err.contains(words), "{}", said.err);
    });
}

/// Sends the index of a hand here, as another program would, and waits for it; where it is then.
fn move_index(hand: &str, to: u16) -> i64 {
    let place = hand.strip_prefix("tcp:").unwrap();
    let mut other = TcpStream::connect(place).unwrap();
    let [high, low] = to.to_be_bytes();
    // Function 06 at the index's place in ANGLE_SET, 1492.
    let asked = [0, 1, 0, 0, 0, 6, 1, 6, 5, 0xD4, high, low];
    other.write_all(&asked).unwrap();
    let mut echo = [0; 12];
    other.read_exact(&mut echo).unwrap();
    assert_eq!(echo, asked);
    drop(other);
    let patience = std::time::Instant::now() + Duration::from_secs(20);
    loop {
        let at = angle(hand);
        if at.abs_diff(i64::from(to)) <= 25 || std::time::Instant::now() > patience {
            return at;
        }
    }
}

#[test]
fn another_hand_moves_nothing_without_a_person_who_lets_it() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let (_other, other) = sim_on_tcp(&["--scenario", "free"]);
        let before = angle(&hand);
        let mut running = mirroring(&hand, &other, &[]);
        move_index(&other, 300);
        let told = running.until(|line| line.contains("rate_hz"));
        assert_eq!(phase(&told), "waiting");
        running.signal(Signal::SIGINT);
        running.end().ok();
        assert_eq!(angle(&hand), before);
    });
}

#[test]
fn the_sender_of_the_manual_moves_a_hand() {
    unless_busy(|| {
        let page = handscope::manual::topic("stream").unwrap().text;
        let python = page.split("```python\n").nth(1).unwrap();
        let python = python.split("```").next().unwrap();
        if !Command::new("python3")
            .arg("--version")
            .output()
            .is_ok_and(|output| output.status.success())
        {
            skipped("a sender in Python", "this machine has no python3");
            return;
        }
        let (mut running, place) = following("sim:?scenario=free", &["--arm"]);
        let port = place.rsplit(':').next().unwrap();
        let python = python.replace("6010", port).replace("< 10", "< 3");
        let mut command = Command::new("python3");
        command.args(["-c", &python]).stdin(Stdio::null());
        let sends = listen(command);
        running.until(|line| phase(line) == "following");
        sends.end().ok();
        let told = running.until(|line| phase(line) == "silent");
        let told: Value = serde_json::from_str(&told).unwrap();
        assert!(told["taken"].as_u64() > Some(100), "{told}");
        assert_eq!(told["refused"], serde_json::json!({}), "{told}");
    });
}

#[test]
fn recorded_hand_tracking_is_retargeted_to_a_hand_that_holds_while_nobody_sees_it() {
    unless_busy(|| {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/");
        let mut command = Command::new("python3");
        command.arg(format!("{root}assets/retarget.py"));
        command.arg(format!("{root}tests/interop/hand_tracking.csv"));
        let probe = Command::new("python3").arg("--version").output();
        if !probe.is_ok_and(|output| output.status.success()) {
            skipped("a sender in Python", "this machine has no python3");
            return;
        }
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let (mut running, place) = following(&hand, &["--arm", "--rate", "1700", "--lead", "500"]);
        command.arg(&place).env("PYTHONDONTWRITEBYTECODE", "1");
        let sends = listen(command);
        running.until(|line| phase(line) == "following");
        // As a fist, then open again; with thumb and index towards one another when the tracker loses sight of it, and at last open.
        let seen = RefCell::new(vec![angle(&hand)]);
        running.until(|line| {
            seen.borrow_mut().push(angle(&hand));
            phase(line) == "silent"
        });
        let seen = seen.into_inner();
        assert!(*seen.iter().min().unwrap() < 300, "{seen:?}");
        running.until(|line| phase(line) == "following");
        sends.end().ok();
        let told = running.until(|line| phase(line) == "silent");
        let told: Value = serde_json::from_str(&told).unwrap();
        assert_eq!(told["taken"], 165, "{told}");
        assert_eq!(told["refused"], serde_json::json!({}), "{told}");
        assert!(angle(&hand) > 900, "{}", angle(&hand));
    });
}

#[test]
fn a_landmark_that_is_not_known_leaves_its_joint_alone() {
    unless_busy(|| {
        let mut command = Command::new("python3");
        let python = "import sys; sys.path.insert(0, 'assets'); import retarget; \
        points = [[float(at), float(at * at % 7), 1.0] for at in range(21)]; \
        points[8] = [float('nan')] * 3; print(retarget.bends(points)[2:4])";
        command
            .args(["-c", python])
            .current_dir(env!("CARGO_MANIFEST_DIR"));
        command.env("PYTHONDONTWRITEBYTECODE", "1");
        let Ok(output) = command.output() else {
            return skipped("a sender in Python", "this machine has no python3");
        };
        let said = String::from_utf8(output.stdout).unwrap();
        // The index is not known, and the middle finger is.
        assert!(
            said.starts_with('[') && said.ends_with(", None]\n"),
            "{said}"
        );
        assert!(!said.starts_with("[None"), "{said}");
    });
}

#[test]
fn who_can_move_a_hand_from_beyond_this_computer_is_said_at_the_start() {
    unless_busy(|| {
        let any = "0.0.0.0:0";
        for (args, can) in [
            (&["follow", "--udp", any, "--arm"][..], "move this hand"),
            (&["follow", "--tcp", any, "--arm"], "move this hand"),
            (&["follow", "--udp", any], "send to this hand"),
            (&["share", "--tcp", any, "--writers"], "move this hand"),
            (&["share", "--tcp", any], "read this hand"),
        ] {
            let mut running = start(&[args, &["--hand", "sim:"]].concat());
            let told = running.complaint();
            let words = "warning: anyone in the network can reach 0.0.0.0:";
            assert!(
                told.contains(words) && told.contains(&format!("and {can};")),
                "{told}"
            );
        }
    });
}

#[test]
fn wrong_use_is_told_in_one_sentence() {
    unless_busy(|| {
        for (args, code, words) in [
            (&["--hand", "sim:"][..], 2, "--udp"),
            (&["--hand", "sim:", "--udp", "here"], 2, "127.0.0.1:6000"),
            (&["--hand", "sim:", "--speed", "0"], 2, "nothing moves"),
            (&["--hand", "sim:", "--force", "2001"], 2, "2000 g"),
            (
                &["--hand", "sim:", "--udp", "127.0.0.1:0", "--lead", "5"],
                2,
                "20",
            ),
            (
                &["--hand", "sim:", "--udp", "127.0.0.1:0", "--side", "both"],
                2,
                "right or left",
            ),
            (
                &[
                    "--hand",
                    "sim:",
                    "--udp",
                    "127.0.0.1:0",
                    "--map",
                    "pad.toml",
                ],
                2,
                "--map",
            ),
            (&["--hand", "sim:", "--dds", "--domain", "233"], 2, "232"),
            (&["--hand", "sim:", "--dds", "--gamepad"], 2, "--dds"),
            (&["--hand", "sim:", "--dds=nowhere0"], 1, "nowhere0"),
            (
                &["--hand", "sim:", "--mirror", "sim:", "--scale", "0.1"],
                2,
                "0.2 to 1.0",
            ),
            (
                &["--hand", "sim:", "--gamepad", "--scale", "0.5"],
                2,
                "--scale",
            ),
            (
                &["--hand", "tcp:127.0.0.1:1", "--mirror", "tcp:127.0.0.1:1"],
                2,
                "cannot follow itself",
            ),
            (
                &["--hand", "sim:", "--mirror", "tcp:127.0.0.1:1"],
                1,
                "127.0.0.1:1",
            ),
            (
                &["--hand", "sim:", "--gamepad", "--map", "/none.toml"],
                1,
                "/none.toml",
            ),
            (
                &["--hand", "sim:", "--gamepad", "--devices", "/nonexistent"],
                1,
                "no folder /nonexistent",
            ),
            (
                &[
                    "--hand",
                    "sim:",
                    "--udp",
                    "127.0.0.1:0",
                    "--consent",
                    "stdin",
                ],
                2,
                "--arm",
            ),
        ] {
            let ended = run(&[&["follow"], args].concat());
            assert_eq!(ended.code, Some(code), "{args:?}: {}", ended.err);
            assert!(ended.err.contains(words), "{args:?}: {}", ended.err);
        }
        let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
        let place = taken.local_addr().unwrap().to_string();
        let ended = run(&["follow", "--hand", "sim:", "--udp", &place]);
        assert_eq!(ended.code, Some(1));
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
        assert!(ended.err.contains(&place), "{}", ended.err);
    });
}
