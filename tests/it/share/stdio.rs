//! `handscope share --stdio` as the program meets it that starts it: lines of JSON, and a hand that stops when they end.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, handscope, run, sim_on_tcp};
use handscope::record::file::reader::RecordingFile;
use nix::sys::signal::Signal;
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

/// Longer than anything here takes on a machine that does other work as well.
const PATIENCE: Duration = Duration::from_secs(60);
/// A hand that is let go is told to stop within this.
const STOPS_WITHIN: Duration = Duration::from_millis(300);
/// The index finger's places in ANGLE_SET and ANGLE_ACT.
const INDEX: [u16; 2] = [1492, 1552];

/// A program that moves a hand by lines.
struct Script {
    child: Child,
    asks: Option<ChildStdin>,
    told: Receiver<Value>,
    gateway: String,
}

impl Script {
    fn start(hand: &str) -> Self {
        let mut command = handscope();
        command.args(["share", "--stdio", "--hand", hand]);
        Self::of(command.args(["--tcp", "127.0.0.1:0", "--writers"]))
    }

    fn of(command: &mut Command) -> Self {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        let (tell, told) = channel();
        let out = child.stdout.take().unwrap();
        spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                let _gone = tell.send(serde_json::from_str(&line).unwrap());
            }
        });
        let asks = child.stdin.take();
        let mut script = Self {
            child,
            asks,
            told,
            gateway: String::new(),
        };
        let ready = script.until("ready");
        assert_eq!(ready["v"], 1);
        script.gateway = ready["tcp"].as_str().unwrap().to_owned();
        script
    }

    /// Goes on until something of this name is told.
    fn until(&self, name: &str) -> Value {
        loop {
            let told = self.told.recv_timeout(PATIENCE).expect(name);
            if let Some(told) = told.get(name) {
                return told.clone();
            }
        }
    }

    fn tell(&mut self, line: &Value) {
        writeln!(self.asks.as_ref().unwrap(), "{line}").unwrap();
    }

    /// Asks, and waits for the answer.
    fn ask(&mut self, mut line: Value) -> Value {
        line["id"] = json!("own");
        self.tell(&line);
        self.until("reply")
    }

    /// Asks for what is done.
    fn done(&mut self, line: Value) -> Value {
        let reply = self.ask(line);
        assert!(reply["error"].is_null(), "{reply}");
        reply["ok"].clone()
    }

    /// Armed, with the index finger on its slow way, and not near its end.
    fn moving(hand: &str) -> Self {
        let mut script = Self::start(hand);
        script.done(json!({"do": "arm"}));
        script.tell(&to_index(0, 100));
        while script.until("state")["angle"][3].as_i64().unwrap() > 950 {}
        script
    }

    fn end(mut self) -> Option<i32> {
        self.asks = None;
        self.child.wait().unwrap().code()
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        let _gone = self.child.kill();
        let _ended = self.child.wait();
    }
}

fn to_index(angle: i16, speed: i16) -> Value {
    json!({"id": 1, "do": "move", "angle": [null, null, null, angle, null, null], "speed": speed})
}

/// A Modbus client.
struct Client(TcpStream);

impl Client {
    fn of(address: &str) -> Self {
        Self(TcpStream::connect(address.trim_start_matches("tcp:")).unwrap())
    }

    fn ask(&mut self, pdu: &[u8]) -> Vec<u8> {
        let len = u8::try_from(pdu.len() + 1).unwrap();
        self.0
            .write_all(&[&[0, 9, 0, 0, 0, len, 1], pdu].concat())
            .unwrap();
        let mut head = [0; 7];
        self.0.read_exact(&mut head).unwrap();
        let mut said = vec![0; usize::from(head[5]) - 1];
        self.0.read_exact(&mut said).unwrap();
        said
    }

    fn read(&mut self, address: u16, count: u8) -> Vec<u16> {
        let [high, low] = address.to_be_bytes();
        let said = self.ask(&[3, high, low, 0, count]);
        let words = said[2..].chunks(2);
        words
            .map(|word| u16::from_be_bytes([word[0], word[1]]))
            .collect()
    }

    /// Six targets; the exception, if there is one.
    fn put(&mut self, targets: &[u16]) -> Option<u8> {
        let [high, low] = 1486u16.to_be_bytes();
        let words: Vec<u8> = targets.iter().flat_map(|word| word.to_be_bytes()).collect();
        let said = self.ask(&[&[16, high, low, 0, 6, 12], words.as_slice()].concat());
        (said[0] == 0x90).then(|| said[1])
    }

    /// How long it takes until the index finger is told to stay where it is.
    fn until_held(&mut self, from: Instant) -> Duration {
        while self.read(INDEX[0], 1) == [0] {
            assert!(from.elapsed() < PATIENCE, "it goes on");
        }
        let took = from.elapsed();
        let (set, at) = (self.read(INDEX[0], 1)[0], self.read(INDEX[1], 1)[0]);
        assert!(set.abs_diff(at) < 150 && at > 100, "{set} {at}");
        took
    }
}

#[test]
fn a_pose_is_told_as_the_angles_of_a_move_and_moves_nothing() {
    let mut script = Script::start("sim:");
    let told = script.done(json!({"do": "pose", "name": "pinch"}));
    assert_eq!(told["angle"], json!([300, 300, 300, 500, 60, 150]));
    let refused = script.ask(json!({"do": "pose", "name": "Cube"}));
    assert_eq!(refused["kind"], "wrong");
    let why = refused["error"].as_str().unwrap();
    assert!(
        why.contains("no pose 'Cube'") && why.contains("Pinch"),
        "{why}"
    );
    // It is not armed for that.
    let state = script.until("state");
    assert_eq!(state["angle"], json!(vec![1000; 6]), "{state}");
    let moved = script.ask(json!({"do": "move", "angle": told["angle"]}));
    assert_eq!(moved["kind"], "not_armed");
}

#[test]
fn a_gesture_of_the_hand_moves_it_while_armed_and_its_end_is_awaited() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        let gesture = json!({"do": "gesture", "number": 3, "speed": 900});
        assert_eq!(script.ask(gesture.clone())["kind"], "not_armed");
        assert_eq!(script.until("state")["angle"], json!(vec![1000; 6]));
        script.done(json!({"do": "arm"}));
        let ended = script.done(gesture);
        assert_eq!(ended["end"], "reached");
        let state = script.until("state");
        for (joint, to) in [1000, 1000, 1000, 420, 420, 200].into_iter().enumerate() {
            let at = state["angle"][joint].as_i64().unwrap();
            assert!((at - to).abs() < 20, "{joint}: {state}");
        }
        while script.until("state")["target_speed"] != json!(vec![900; 6]) {}
        // A gesture that nobody taught moves nothing.
        assert_eq!(
            script.done(json!({"do": "gesture", "number": 14}))["end"],
            "reached"
        );
        let no = script.ask(json!({"do": "gesture", "number": 0}));
        assert_eq!(no["kind"], "wrong");
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_gesture_is_stopped_as_any_motion_and_not_started_where_the_user_switched_gestures_off() {
    unless_busy(|| {
        let home = tempfile::tempdir().unwrap();
        let settings = home.path().join(".config/handscope");
        std::fs::create_dir_all(&settings).unwrap();
        std::fs::write(settings.join("settings.toml"), "gesture_route = \"off\"\n").unwrap();
        let mut command = handscope();
        command.env("HOME", home.path());
        command.args(["share", "--stdio", "--hand", "sim:"]);
        let mut script = Script::of(command.args(["--tcp", "127.0.0.1:0", "--writers"]));
        script.done(json!({"do": "arm"}));
        let no = script.ask(json!({"do": "gesture", "number": 3}));
        assert_eq!(no["kind"], "refused");
        assert!(
            no["error"].as_str().unwrap().contains("gestures are off"),
            "{no}"
        );
        assert_eq!(script.until("state")["angle"], json!(vec![1000; 6]));
        assert_eq!(script.end(), Some(0));
        let mut script = Script::start("sim:");
        script.done(json!({"do": "arm"}));
        script.tell(&json!({"id": 1, "do": "gesture", "number": 2, "speed": 100}));
        while script.until("state")["angle"][3].as_i64().unwrap() > 950 {}
        script.tell(&json!({"do": "stop"}));
        let told = script.until("reply");
        assert_eq!((&told["id"], &told["kind"]), (&json!(1), &json!("stop")));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn nothing_moves_before_it_is_armed_and_what_is_wrong_is_told() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        let no = script.ask(to_index(0, 100));
        assert_eq!(
            (&no["kind"], &no["id"]),
            (&json!("not_armed"), &json!("own"))
        );
        assert_eq!(script.ask(json!({"do": "fly"}))["kind"], "wrong");
        script.tell(&json!({"right": [0, 0, 0, 0, 0, 0]}));
        assert_eq!(script.until("refused")["kind"], "not_armed");
        for _ in 0..20 {
            assert_eq!(
                script.until("state")["angle"],
                json!([1000, 1000, 1000, 1000, 1000, 1000])
            );
        }
        script.done(json!({"do": "arm"}));
        script.done(json!({"do": "release"}));
        assert_eq!(
            script.ask(to_index(0, 100))["kind"],
            "not_armed",
            "not any more"
        );
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_motion_says_where_it_ended_and_what_is_held() {
    unless_busy(|| {
        let mut script = Script::start("sim:?scenario=rigid");
        script.done(json!({"do": "arm"}));
        let done = script.done(to_index(900, 500));
        assert_eq!(done["end"], "reached");
        let all =
            json!({"do": "move", "angle": [0, 0, 0, 0, 0, null], "force_g": 300, "settle": true});
        let done = script.done(all);
        assert_eq!(
            (&done["end"], &done["grip"]["state"]),
            (&json!("stopped"), &json!("holding"))
        );
        script.done(json!({"do": "stop"}));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn speed_and_threshold_are_those_of_the_arming_until_others_are_named() {
    unless_busy(|| {
        // SPEED_SET and FORCE_SET of the index finger.
        let (speed_set, force_set) = (1528, 1504);
        let (_sim, hand) = sim_on_tcp(&[]);
        let mut client = Client::of(&hand);
        let mut limits = || [client.read(speed_set, 1)[0], client.read(force_set, 1)[0]];
        let mut script = Script::start(&hand);
        let bend = json!({"do": "move", "angle": [null, null, null, 900, null, null]});
        script.done(json!({"do": "arm", "speed": 400, "force_g": 333}));
        assert_eq!(limits(), [400, 333]);
        script.done(bend.clone());
        assert_eq!(limits(), [400, 333], "a motion that names none");
        script.done(to_index(950, 300));
        assert_eq!(limits(), [300, 333], "a motion that names a speed");
        script.done(bend);
        assert_eq!(limits(), [400, 333], "and the next");
        let mut slowly = to_index(0, 100);
        slowly["id"] = Value::Null;
        script.tell(&slowly);
        while script.until("state")["angle"][3].as_i64().unwrap() > 800 {}
        script.done(json!({"do": "arm", "speed": 50}));
        let began = Instant::now();
        while limits() != [50, 333] {
            assert!(began.elapsed() < PATIENCE, "{:?}", limits());
        }
        script.done(json!({"do": "stop"}));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_motion_goes_on_while_its_limits_change() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        script.done(json!({"do": "arm"}));
        script.tell(&to_index(750, 100));
        for speed in [200, 900] {
            let reply = script.ask(json!({"do": "arm", "speed": speed}));
            assert_eq!((&reply["id"], &reply["ok"]), (&json!("own"), &json!({})));
        }
        let moved = script.until("reply");
        assert_eq!(
            (&moved["id"], &moved["ok"]["end"]),
            (&json!(1), &json!("reached")),
            "{moved}"
        );
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn the_end_of_the_script_stops_the_hand_at_once() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let mut client = Client::of(&hand);
        let mut script = Script::moving(&hand);
        assert_eq!(client.read(INDEX[0], 1), [0]);
        let killed = Instant::now();
        script.asks = None;
        let took = client.until_held(killed);
        assert!(took < STOPS_WITHIN, "{took:?}");
        assert_eq!(script.end(), Some(0), "at rest");
    });
}

#[test]
fn a_killed_script_leaves_joints_whose_feedback_froze_where_they_were_held() {
    unless_busy(|| {
        let (sim, hand) = sim_on_tcp(&[]);
        let mut client = Client::of(&hand);
        let mut script = Script::moving(&hand);
        sim.signal(Signal::SIGUSR2);
        assert_eq!(script.until("disarmed")["kind"], "frozen_feedback");
        let frozen_at = client.read(INDEX[1], 1)[0];
        // All that can be done is done by then.
        sleep(Duration::from_secs(1));
        script.child.kill().unwrap();
        sleep(Duration::from_secs(2));
        sim.signal(Signal::SIGUSR2);
        let begun = Instant::now();
        let mut angle = client.read(INDEX[1], 1)[0];
        while angle == frozen_at && begun.elapsed() < Duration::from_secs(1) {
            angle = client.read(INDEX[1], 1)[0];
        }
        assert!(angle + 40 < frozen_at, "{angle}, frozen at {frozen_at}");
    });
}

#[test]
fn a_stop_needs_no_line_feed_and_a_line_that_is_too_long_ends_nothing() {
    unless_busy(|| {
        let long = "y".repeat(200_000);
        for text in [
            "{\"do\":\"stop\"".to_owned(),
            "{\"do\":\"stop\"}".to_owned(),
            "{\n  \"do\": \"stop\"\n".to_owned(),
            format!("{{\"x\":\"{long}\",\"do\":\"stop\"}}"),
        ] {
            let (_sim, hand) = sim_on_tcp(&[]);
            let mut script = Script::moving(&hand);
            let asks = script.asks.as_mut().unwrap();
            asks.write_all(text.as_bytes()).unwrap();
            let told = script.until("disarmed");
            assert_eq!(told["kind"], "stop", "{}", &text[..10]);
            // It is served on.
            let asks = script.asks.as_mut().unwrap();
            asks.write_all(b"\n").unwrap();
            let told = script.ask(json!({"do": "arm"}));
            assert!(told.get("ok").is_some(), "{told}");
            assert_eq!(script.end(), Some(0));
        }
        let (_sim, hand) = sim_on_tcp(&[]);
        let mut script = Script::start(&hand);
        let told = script.ask(json!({"do": "arm", "why": long}));
        let why = told["error"].as_str().unwrap();
        assert!(why.contains("65536"), "{why}");
        script.done(json!({"do": "arm"}));
        // At the end of the input, too, and with a status of success.
        let mut asks = script.asks.take().unwrap();
        asks.write_all(b"{\"do\":\"stop\"").unwrap();
        drop(asks);
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_stop_is_answered_by_feedback_whatever_is_asked_next() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let mut script = Script::moving(&hand);
        // In one write: the second request is there before the stop is confirmed.
        let asks = script.asks.as_mut().unwrap();
        asks.write_all(b"{\"id\":70,\"do\":\"stop\"}\n{\"id\":71,\"do\":\"arm\"}\n")
            .unwrap();
        let mut stopped = Value::Null;
        while stopped["id"] != 70 {
            stopped = script.until("reply");
        }
        assert_eq!(stopped["ok"], json!({}), "{stopped}");
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_script_that_does_not_read_may_not_move_the_hand() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let mut client = Client::of(&hand);
        let mut command = handscope();
        command.args(["share", "--stdio", "--hand", &hand]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut asks = child.stdin.take().unwrap();
        writeln!(asks, "{}", json!({"do": "rate", "state_hz": 500})).unwrap();
        writeln!(asks, "{}", json!({"do": "arm"})).unwrap();
        sleep(Duration::from_millis(200));
        writeln!(asks, "{}", to_index(0, 5)).unwrap();
        while client.read(INDEX[0], 1) != [0] {}
        let begun = Instant::now();
        client.until_held(begun);
        let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
        assert!(said.any(|line| line.unwrap().contains("the output was not read")));
        // Once it reads again, it is told so.
        let told = BufReader::new(child.stdout.take().unwrap()).lines();
        let told = told.map(|line| serde_json::from_str(&line.unwrap()).unwrap());
        let mut told = told.take(5_000);
        let ended: Value = told.find(|told: &Value| told["reply"]["id"] == 1).unwrap();
        let ended = &ended["reply"];
        assert_eq!(ended["kind"], "silent", "{ended}");
        let why = ended["error"].as_str().unwrap();
        assert!(
            why.contains("did not read its states for a second"),
            "{why}"
        );
        drop(asks);
        child.wait().unwrap();
    });
}

#[test]
fn a_client_stops_what_a_script_moves_which_is_told_and_may_ask_again() {
    unless_busy(|| {
        let mut script = Script::moving("sim:");
        let mut window = Client::of(&script.gateway);
        let here = window.read(1546, 6);
        assert_eq!(window.put(&[300; 6]), Some(6), "it may not move it");
        assert_eq!(window.put(&here), None, "it may stop it");
        assert_eq!(script.until("reply")["kind"], "stop");
        let why = script.until("disarmed");
        assert!(
            why["why"]
                .as_str()
                .unwrap()
                .contains("a stop was requested"),
            "{why}"
        );
        assert_eq!(script.ask(to_index(0, 100))["kind"], "not_armed");
        script.done(json!({"do": "arm"}));
        script.done(json!({"do": "release"}));
        // Now it is free for others, and not for the script.
        assert_eq!(window.put(&[500; 6]), None);
        let no = script.ask(json!({"do": "arm"}));
        assert_eq!(no["kind"], "taken");
        assert!(
            no["error"]
                .as_str()
                .unwrap()
                .contains("until it disconnects"),
            "{no}"
        );
        drop(window);
        while script.ask(json!({"do": "arm"}))["kind"] == "taken" {}
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn what_was_moved_before_a_link_was_lost_is_stopped_once_it_is_back_and_let_go() {
    unless_busy(|| {
        // It lets go once the link is back, or ends then, or ends before.
        for (ends, before) in [(false, false), (true, false), (true, true)] {
            let (sim, hand) = sim_on_tcp(&[]);
            let mut script = Script::start(&hand);
            script.done(json!({"do": "arm"}));
            script.tell(&to_index(0, 30));
            while script.until("state")["angle"][3].as_i64().unwrap() > 980 {}
            sim.signal(Signal::SIGSTOP);
            assert_eq!(script.until("link")["state"], "lost");
            if ends {
                assert_eq!(script.ask(json!({"do": "arm"}))["ok"], Value::Null);
            }
            if !ends {
                // Nothing was stopped yet, which is said.
                assert_eq!(script.ask(json!({"do": "release"}))["kind"], "link_lost");
            }
            let back = || sim.signal(Signal::SIGCONT);
            if !before {
                back();
                assert_eq!(script.until("link")["state"], "live");
            }
            let at = || {
                let read = run(&["read", "ANGLE_ACT", "--json", "--hand", &hand]).ok();
                read.lines()[0]["ANGLE_ACT"][3].as_i64().unwrap()
            };
            if before {
                std::thread::scope(|threads| {
                    let ended = threads.spawn(|| script.end());
                    sleep(Duration::from_millis(700));
                    back();
                    assert_eq!(ended.join().unwrap(), Some(0));
                });
            } else if ends {
                assert_eq!(script.end(), Some(0));
            } else {
                script.done(json!({"do": "release"}));
            }
            let first = at();
            sleep(Duration::from_millis(500));
            assert!(
                (first - at()).abs() <= 2 && first > 300,
                "{ends} {before} {first}"
            );
        }
    });
}

/// A way to a hand on which its angles can be kept from being read: the way, and whether they are.
fn way_without_angles(hand: &str) -> (String, Arc<AtomicBool>) {
    let far = hand.strip_prefix("tcp:").unwrap();
    let far = far.split('?').next().unwrap().to_owned();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let way = format!("tcp:{}", listener.local_addr().unwrap());
    let is_blind = Arc::new(AtomicBool::new(false));
    let blind = Arc::clone(&is_blind);
    spawn(move || {
        for near in listener.incoming() {
            let (mut near, mut hand) = (near.unwrap(), TcpStream::connect(&far).unwrap());
            let (mut back, mut answers) = (near.try_clone().unwrap(), hand.try_clone().unwrap());
            spawn(move || std::io::copy(&mut answers, &mut back));
            let blind = Arc::clone(&blind);
            spawn(move || {
                let mut head = [0; 6];
                while near.read_exact(&mut head).is_ok() {
                    let mut rest = vec![0; usize::from(head[5])];
                    near.read_exact(&mut rest).unwrap();
                    let word = |at: usize| u16::from_be_bytes([rest[at], rest[at + 1]]);
                    let reads = rest[1] == 3 && (word(2)..word(2) + 2 * word(4)).contains(&1546);
                    if !(reads && blind.load(Ordering::Relaxed)) {
                        hand.write_all(&[&head[..], &rest].concat()).unwrap();
                    }
                }
            });
        }
    });
    (way, is_blind)
}

#[test]
fn what_was_moved_before_feedback_grew_old_is_stopped_as_soon_as_it_is_read_again() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let (way, is_blind) = way_without_angles(&hand);
        let mut script = Script::moving(&way);
        is_blind.store(true, Ordering::Relaxed);
        assert_eq!(script.until("disarmed")["kind"], "stale");
        is_blind.store(false, Ordering::Relaxed);
        let begun = Instant::now();
        let mut angle = 0;
        while begun.elapsed() < Duration::from_secs(3) {
            angle = script.until("state")["angle"][3].as_i64().unwrap();
        }
        assert!(angle > 500, "it went on to {angle}");
        script.done(json!({"do": "arm"}));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn an_arming_that_something_else_is_asked_for_meanwhile_gives_the_hand_back() {
    unless_busy(|| {
        for instead in ["release", "disarm", "arm"] {
            let mut script = Script::start("sim:");
            script.tell(&json!({"id": 1, "do": "arm"}));
            script.tell(&json!({"id": 2, "do": instead}));
            let told = [script.until("reply"), script.until("reply")];
            let replaced = told.iter().any(|reply| reply["kind"] == "replaced");
            let done = told.iter().filter(|reply| !reply["ok"].is_null()).count();
            assert!(replaced || done == 2, "{instead}: {told:?}");
            script.done(json!({"do": "release"}));
            script.done(json!({"do": "arm"}));
            script.done(to_index(900, 500));
            assert_eq!(script.end(), Some(0));
        }
    });
}

#[test]
fn two_scripts_share_a_hand_and_one_moves_it() {
    unless_busy(|| {
        let (_sim, at) = sim_on_tcp(&[]);
        let mut first = Script::start(&at);
        let mut second = Script::start(&format!("tcp:{}", first.gateway));
        first.done(json!({"do": "arm"}));
        let no = second.ask(json!({"do": "arm"}));
        assert_eq!(no["kind"], "taken", "{no}");
        assert!(no["error"].as_str().unwrap().contains("ask there"), "{no}");
        first.done(to_index(600, 500));
        while second.until("state")["angle"][3].as_i64().unwrap() > 620 {}
        first.done(json!({"do": "release"}));
        second.done(json!({"do": "arm"}));
        second.done(to_index(900, 500));
        while first.until("state")["angle"][3].as_i64().unwrap() < 880 {}
        assert_eq!(second.end(), Some(0));
        assert_eq!(first.end(), Some(0));
    });
}

#[test]
fn a_command_moves_the_hand_in_the_place_of_a_script() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        script.done(json!({"do": "arm"}));
        script.done(json!({"do": "disarm"}));
        let hand = format!("tcp:{}", script.gateway);
        let grip = [
            "grip", "--hand", &hand, "--gap", "100", "--speed", "500", "--arm", "--json",
        ];
        // Two programs and a hand in one of them: a machine that does other work may lose the link between them.
        let ended = |end: Ended| {
            let told = end.lines();
            told.first()?["grip"]["end"].as_str().map(str::to_owned)
        };
        let mut tries = (0..5).filter_map(|_| ended(run(&grip)));
        assert!(tries.any(|end| end == "reached"));
        while script.ask(json!({"do": "arm"}))["kind"] == "taken" {}
        script.done(to_index(900, 500));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn targets_are_followed_held_in_a_silence_and_followed_again() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        script.done(json!({"do": "arm"}));
        let follow = |script: &mut Script, share: f64| {
            script.tell(&json!({"right": [null, null, null, share, null, null]}));
            sleep(Duration::from_millis(20));
        };
        let at = |script: &Script| script.until("state")["angle"][3].as_i64().unwrap();
        let begun = Instant::now();
        while at(&script) > 800 {
            follow(&mut script, 0.2);
            assert!(begun.elapsed() < PATIENCE);
            while script.told.try_recv().is_ok() {}
        }
        sleep(Duration::from_millis(1500));
        while script.told.try_recv().is_ok() {}
        let held = at(&script);
        assert!(held > 300, "it was held: {held}");
        while at(&script) < 950 {
            follow(&mut script, 1.0);
            while script.told.try_recv().is_ok() {}
        }
        // A hold presses no harder than the limits of `arm`.
        let hold = |most: i16| json!({"hold": {"at_least_g": 150, "at_most_g": most}});
        assert_eq!(script.ask(hold(900))["kind"], "wrong");
        script.done(hold(400));
        script.done(to_index(700, 500));
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn a_recording_begins_and_ends_when_it_is_asked_for() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("script.mcap");
        let mut script = Script::start("sim:");
        assert_eq!(
            script.ask(json!({"do": "record", "path": null}))["kind"],
            "refused"
        );
        script.done(json!({"do": "record", "path": path}));
        script.done(json!({"do": "arm"}));
        script.done(to_index(800, 500));
        script.done(json!({"do": "record", "path": null}));
        let file = RecordingFile::open(&path).unwrap();
        assert!(file.is_closed(), "whole, though the script goes on");
        let again = script.ask(json!({"do": "record", "path": path}));
        assert!(
            again["error"].as_str().unwrap().contains("not overwritten"),
            "{again}"
        );
        assert_eq!(script.end(), Some(0));
    });
}

#[test]
fn states_come_at_500_a_second_and_none_is_lost() {
    unless_busy(|| {
        let mut script = Script::start("sim:");
        script.done(json!({"do": "rate", "state_hz": 500}));
        sleep(Duration::from_millis(200));
        while script.told.try_recv().is_ok() {}
        let (mut states, mut first, mut last) = (0.0, None, 0.0);
        while states < 1500.0 {
            let told = script.told.recv_timeout(PATIENCE).unwrap();
            assert!(told.get("lost").is_none(), "{told}");
            last = told["state"]["t_s"].as_f64().unwrap();
            first.get_or_insert(last);
            states += 1.0;
        }
        let hz = states / (last - first.unwrap());
        assert!(hz > 250.0, "{hz} on a machine that does other work as well");
        assert_eq!(script.end(), Some(0));
    });
}
