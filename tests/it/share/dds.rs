//! A hand on DDS: told and followed by Unitree's own stack, and by nobody unless a person wants it.

use crate::setup::hand;
use crate::setup::link::{config, to_hand};
use crate::setup::process::{Running, handscope, listen, start};
use crate::setup::skipped::skipped;
use handscope::hand::kinematics::Side;
use handscope::link::{self, LinkHandle};
use handscope::record::file::format::cdr;
use handscope::record::file::format::message::GripMessage;
use handscope::share::dds::DdsPublisher;
use handscope::transport::dds::{DdsError, DdsMessage, DdsNode, DdsPlace, DdsTopic};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::fs;
use std::io::{PipeWriter, Write as _};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::sync::mpsc;
use tokio::time::{sleep, timeout};

/// Far more than anything takes here.
const PATIENCE: Duration = Duration::from_secs(20);
/// Commands of a round, and how many of them, and of the states meanwhile, must arrive.
const COMMANDS: u64 = 500;
const ARRIVE: f64 = 0.99;

/// At the loopback, in a domain that no other test uses.
fn place(domain: u16) -> DdsPlace {
    DdsPlace {
        interface: "127.0.0.1".into(),
        domain,
    }
}

fn states(node: &DdsNode) -> mpsc::Receiver<DdsMessage> {
    let topic = DdsTopic {
        name: "rt/inspire_hand/state/l".into(),
        type_name: "inspire::inspire_hand_state".into(),
    };
    node.reader(&topic, 64).unwrap()
}

type Lists = (
    Vec<i16>,
    Vec<i16>,
    Vec<i16>,
    Vec<i16>,
    Vec<u8>,
    Vec<u8>,
    Vec<u8>,
);

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn states_are_told_while_the_hand_answers_and_not_a_moment_longer() {
    let (tells, listens) = (DdsNode::open(&place(41)), DdsNode::open(&place(41)));
    let mut heard = states(&listens.unwrap());
    let hand = hand::plain();
    let (link, _records): (LinkHandle, _) = link::open(
        config("tcp:127.0.0.1:1", to_hand(hand.clone())),
        &Handle::current(),
    );
    let publisher = DdsPublisher::open(&tells.unwrap(), &link, Side::Left).unwrap();
    let message = timeout(PATIENCE, heard.recv()).await.unwrap().unwrap();
    let (_, angle, _, _, err, _, temperature): Lists = cdr::decode(&message.bytes).unwrap();
    assert_eq!((angle, err), (vec![1000; 6], vec![0; 6]));
    assert!(
        temperature.iter().all(|degrees| *degrees > 10),
        "{temperature:?}"
    );
    for _ in 0..50 {
        timeout(PATIENCE, heard.recv()).await.unwrap().unwrap();
    }
    // It may only say what it has read, and the link is what reads.
    let told = publisher.told();
    assert!(told.states >= 50 && told.lost == 0, "{told:?}");
    drop(link);
    sleep(Duration::from_millis(500)).await;
    while heard.try_recv().is_ok() {}
    let more = timeout(Duration::from_millis(700), heard.recv()).await;
    assert!(more.is_err(), "{more:?}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn the_grip_is_told_as_a_recording_has_it() {
    let (tells, listens) = (DdsNode::open(&place(57)), DdsNode::open(&place(57)));
    let topic = DdsTopic {
        name: "rt/handscope/grip".into(),
        type_name: "handscope_msgs::msg::dds_::Grip_".into(),
    };
    let mut heard = listens.unwrap().reader(&topic, 64).unwrap();
    let (link, _records): (LinkHandle, _) = link::open(
        config("tcp:127.0.0.1:1", to_hand(hand::plain())),
        &Handle::current(),
    );
    let publisher = DdsPublisher::open(&tells.unwrap(), &link, Side::Left).unwrap();
    let first = timeout(PATIENCE, async {
        loop {
            let message = heard.recv().await.unwrap();
            let grip: GripMessage = cdr::decode(&message.bytes).unwrap();
            if grip.state != "unknown" {
                return grip;
            }
        }
    });
    let grip = first.await.unwrap();
    assert_eq!(grip.finger_states.len(), 5);
    assert!(
        grip.at.nanos() >= grip.since.nanos() && grip.asked.nanos() > 0,
        "{grip:?}"
    );
    assert_eq!(publisher.told().lost, 0);
}

#[test]
fn an_interface_that_is_not_there_is_named() {
    for interface in ["nowhere0", "203.0.113.7", "::1"] {
        let place = DdsPlace {
            interface: interface.into(),
            domain: 42,
        };
        let error = DdsNode::open(&place).unwrap_err();
        assert!(matches!(error, DdsError::NoInterface { .. }), "{error}");
        assert!(error.to_string().contains(interface), "{error}");
    }
    let mut named = place(42);
    named.interface = "lo".into();
    assert!(DdsNode::open(&named).unwrap().address().is_loopback());
}

/// Ports of DDS in a domain (RTPS 9.6.2.3) that somebody listens at.
fn listened(domain: u16) -> usize {
    let first = 7400 + 250 * domain;
    let ports = (first..first + 30).filter(|port| UdpSocket::bind(("0.0.0.0", *port)).is_err());
    ports.count()
}

#[test]
fn nobody_listens_before_it_is_opened_or_after_it_is_closed() {
    assert_eq!(listened(43), 0);
    let node = DdsNode::open(&place(43)).unwrap();
    assert!(listened(43) > 0);
    drop(node);
    let patience = Instant::now() + PATIENCE;
    while listened(43) > 0 {
        assert!(Instant::now() < patience, "somebody listens");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// UDP sockets of a process.
fn udp_sockets(id: u32) -> usize {
    let table = fs::read_to_string(format!("/proc/{id}/net/udp")).unwrap();
    let fields = |line: &str| line.split_whitespace().nth(9).map(str::to_owned);
    let all: Vec<String> = table.lines().skip(1).filter_map(fields).collect();
    let open = fs::read_dir(format!("/proc/{id}/fd")).unwrap();
    let open = open.filter_map(|entry| fs::read_link(entry.ok()?.path()).ok());
    let names = open.filter_map(|link| Some(link.to_str()?.to_owned()));
    names
        .filter(|name| all.iter().any(|inode| *name == format!("socket:[{inode}]")))
        .count()
}

#[test]
fn it_is_off_unless_a_person_wants_it() {
    if !Path::new("/proc/self/net/udp").exists() {
        return skipped("sockets of a process", "this system does not list them");
    }
    let dds: &[&str] = &["--dds", "--domain", "44"];
    for (words, ready) in [
        (&["share", "--tcp", "127.0.0.1:0"][..], "ready tcp "),
        (&["follow", "--tcp", "127.0.0.1:0"], "ready tcp "),
    ] {
        let mut running = start(&[words, &["--hand", "sim:"]].concat());
        assert!(running.line().starts_with(ready));
        assert_eq!(udp_sockets(running.id()), 0, "{words:?}");
    }
    for words in [
        &["share"][..],
        &["share", "--tcp", "127.0.0.1:0"],
        &["follow"],
    ] {
        let mut running = start(&[words, &["--hand", "sim:"], dds].concat());
        running.until(|line| line == "ready dds 127.0.0.1");
        assert!(udp_sockets(running.id()) > 0, "{words:?}");
        running.signal(Signal::SIGINT);
        running.end().ok();
    }
}

/// Where Unitree's stack and our program meet: a network of their own if there can be one.
struct Meeting {
    _holder: Option<(Running, PipeWriter)>,
    enter: Vec<String>,
    python: String,
}

/// Brings the loopback up, and stays.
const HOLD: &str = "
import fcntl, socket, struct, sys
fcntl.ioctl(socket.socket(), 0x8914, struct.pack('16sh14x', b'lo', 0x49))
print('ready', flush=True)
sys.stdin.read()
";

impl Meeting {
    /// `None` if this machine has no CycloneDDS 0.10.2 for Python.
    fn new() -> Option<Self> {
        let own = std::env::var("HANDSCOPE_DDS_PYTHON").ok();
        let mut pythons = own
            .into_iter()
            .chain(["python3.10", "python3"].map(String::from));
        let python = pythons.find(|python| {
            let asked = Command::new(python)
                .args(["-c", "import cyclonedds.domain"])
                .stderr(Stdio::null())
                .status();
            asked.is_ok_and(|status| status.success())
        })?;
        let (kept, open) = std::io::pipe().unwrap();
        let mut command = Command::new("unshare");
        command.args(["-rn", &python, "-c", HOLD]).stdin(kept);
        let asked = Command::new("unshare").args(["-rn", "true"]).status();
        if !asked.is_ok_and(|status| status.success()) {
            return Some(Self {
                _holder: None,
                enter: Vec::new(),
                python,
            });
        }
        let mut holder = listen(command);
        assert_eq!(holder.line(), "ready");
        let target = format!("--target={}", holder.id());
        let enter = ["nsenter", &target, "-U", "-n", "--preserve-credentials"];
        Some(Self {
            enter: enter.map(String::from).to_vec(),
            _holder: Some((holder, open)),
            python,
        })
    }

    fn command(&self, words: &[&str]) -> Command {
        let own = self.enter.iter().map(String::as_str);
        let mut all = own.chain(words.iter().copied());
        let mut command = Command::new(all.next().unwrap());
        command.args(all).stdin(Stdio::null());
        command
    }

    /// Unitree's end, for so many commands a round and so many rounds.
    fn unitree(&self, commands: u64, rounds: u64) -> Running {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/interop/unitree_dds.py");
        let (commands, rounds) = (commands.to_string(), rounds.to_string());
        let words = ["127.0.0.1", "45", "r", &commands, &rounds];
        listen(self.command(&[&[self.python.as_str(), script], &words[..]].concat()))
    }

    /// Our end, and where a person presses Enter.
    fn follow(&self) -> (Running, PipeWriter) {
        let program = handscope().get_program().to_str().unwrap().to_owned();
        let words = ["follow", "--hand", "sim:?scenario=free", "--arm", "--json"];
        let dds = ["--dds", "--domain", "45", "--consent", "stdin"];
        let mut command = self.command(&[&[program.as_str()], &words[..], &dds].concat());
        let (input, person) = std::io::pipe().unwrap();
        command.stdin(input);
        let mut running = listen(command);
        assert_eq!(running.line(), "ready dds 127.0.0.1");
        (running, person)
    }
}

fn object(line: &str) -> Value {
    serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}"))
}

/// A round of commands and states, as both ends tell it: until the hand was stopped because theirs fell silent. Gives the commands
/// that were followed since ours began.
fn round(ours: &mut Running, theirs: &mut Running) -> f64 {
    let first = object(&theirs.line());
    let sent = object(&theirs.line());
    ours.until(|line| object(line)["phase"] == "following");
    let ended = object(&ours.until(|line| object(line)["phase"] == "waiting"));
    println!("{first} {sent} {ended}");
    assert_eq!(sent["sent"], COMMANDS);
    let (heard, told) = (&sent["states"], &sent["told"]);
    assert!(
        heard.as_f64().unwrap() >= ARRIVE * told.as_f64().unwrap(),
        "{sent}"
    );
    assert_eq!(ended["lost"], 0, "{ended}");
    assert_eq!(ended["refused"], serde_json::json!({}), "{ended}");
    // The last one asks for 502, and the hand was on its way.
    let index = sent["angle_act"][3].as_i64().unwrap();
    assert!((490..700).contains(&index), "{sent}");
    followed(&ended)
}

fn followed(told: &Value) -> f64 {
    told["taken"].as_f64().unwrap() - told["not_granted"].as_f64().unwrap()
}

#[test]
fn unitrees_own_stack_reads_and_moves_the_hand_also_after_either_side_was_killed() {
    let Some(meeting) = Meeting::new() else {
        return skipped("cyclonedds", "no Python here has CycloneDDS 0.10.2");
    };
    let (mut ours, mut person) = meeting.follow();
    let mut theirs = meeting.unitree(COMMANDS, 1);
    let once = round(&mut ours, &mut theirs);
    theirs.end().ok();
    let all = COMMANDS as f64;
    assert!(once >= ARRIVE * all, "{once}");
    let stopped = "fell silent: the hand was stopped";
    assert!(ours.complaint().contains(stopped));
    // Theirs is killed in the middle, and the hand is stopped until a person lets it go on.
    person.write_all(b"\n").unwrap();
    let mut theirs = meeting.unitree(100_000, 1);
    theirs.line();
    ours.until(|line| object(line)["phase"] == "following");
    theirs.kill();
    let before = followed(&object(
        &ours.until(|line| object(line)["phase"] == "waiting"),
    ));
    assert!(ours.complaint().contains(stopped));
    person.write_all(b"\n").unwrap();
    let mut theirs = meeting.unitree(COMMANDS, 2);
    let again = round(&mut ours, &mut theirs) - before;
    assert!(again >= ARRIVE * all, "{again}");
    // Ours is killed; theirs goes on and meets the next.
    ours.kill();
    // Long enough for theirs to see that nobody tells states.
    std::thread::sleep(Duration::from_secs(1));
    let (mut ours, _person) = meeting.follow();
    let last = round(&mut ours, &mut theirs);
    theirs.end().ok();
    assert!(last >= ARRIVE * all, "{last}");
    println!("followed {once}, {again}, {last} of {all}");
}
