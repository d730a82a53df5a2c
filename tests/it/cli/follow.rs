//! `follow`: a hand that follows datagrams of another process, and what is told when it cannot.

use crate::setup::process::{Running, listen, run, sim_on_tcp, start};
use crate::setup::skipped::skipped;
use nix::sys::signal::Signal;
use serde_json::Value;
use std::cell::RefCell;
use std::io::{Read as _, Write as _};
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

/// Closes the index slowly, a hundred lines a second, until it is told to end.
fn sender(place: String, ended: Arc<AtomicBool>) -> JoinHandle<()> {
    std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut seq = 0;
        while !ended.load(Ordering::Relaxed) {
            let index = 1.0 - f64::from(seq % 400) / 1000.0;
            let line = format!(r#"{{"seq":{seq},"right":[null,null,null,{index},null,null]}}"#);
            let _sent = socket.send_to(line.as_bytes(), &place);
            seq += 1;
            std::thread::sleep(Duration::from_millis(10));
        }
    })
}

fn phase(line: &str) -> Value {
    serde_json::from_str::<Value>(line).unwrap()["phase"].take()
}

fn angle(hand: &str) -> i64 {
    let read = run(&["read", "ANGLE_ACT", "--hand", hand, "--json"]).ok();
    let values = &read.lines()[0]["ANGLE_ACT"];
    values[3].as_i64().unwrap_or_else(|| panic!("{}", read.out))
}

#[test]
fn a_hand_follows_another_program_and_is_stopped_when_that_is_killed() {
    let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
    let before = angle(&hand);
    let (mut running, place) = following(&hand, &["--arm"]);
    let ended = Arc::new(AtomicBool::new(false));
    let sends = sender(place, Arc::clone(&ended));
    running.until(|line| phase(line) == "following");
    let told = running.until(|line| {
        let told: Value = serde_json::from_str(line).unwrap();
        told["phase"] == "following" && told["taken"].as_u64() > Some(150)
    });
    let told: Value = serde_json::from_str(&told).unwrap();
    assert!(told["delay_p99_ms"].as_f64().is_some(), "{told}");
    ended.store(true, Ordering::Relaxed);
    sends.join().unwrap();
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
}

#[test]
fn nothing_moves_without_a_person_who_lets_it() {
    let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
    let before = angle(&hand);
    let (mut running, place) = following(&hand, &[]);
    let ended = Arc::new(AtomicBool::new(false));
    let sends = sender(place, Arc::clone(&ended));
    let told = running.until(|line| {
        let told: Value = serde_json::from_str(line).unwrap();
        told["not_granted"].as_u64() > Some(50)
    });
    assert_eq!(phase(&told), "waiting");
    ended.store(true, Ordering::Relaxed);
    sends.join().unwrap();
    running.signal(Signal::SIGINT);
    running.end().ok();
    assert_eq!(angle(&hand), before);
}

#[test]
fn ctrl_c_stops_the_hand_and_ends_well() {
    let (mut running, place) = following("sim:?scenario=free", &["--arm"]);
    let ended = Arc::new(AtomicBool::new(false));
    let sends = sender(place, Arc::clone(&ended));
    running.until(|line| phase(line) == "following");
    running.signal(Signal::SIGINT);
    running.end().ok();
    ended.store(true, Ordering::Relaxed);
    sends.join().unwrap();
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
}

#[test]
fn the_sender_of_the_manual_moves_a_hand() {
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
}

#[test]
fn recorded_hand_tracking_is_retargeted_to_a_hand_that_holds_while_nobody_sees_it() {
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
}

#[test]
fn wrong_use_is_told_in_one_sentence() {
    for (args, code, words) in [
        (&["--hand", "sim:"][..], 2, "--udp"),
        (&["--hand", "sim:", "--udp", "here"], 2, "127.0.0.1:6000"),
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
}
