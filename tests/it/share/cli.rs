//! `handscope share` as a process of its own, at hands behind other wires, with clients that speak bytes.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, listen, run, sim_on_link, sim_on_tcp, start};
use crate::setup::skipped::skipped;
use handscope::hand::{Angle, Dof};
use handscope::record::file::reader::{RecordingFile, TimeRange};
use handscope::record::{Entry, Record};
use nix::sys::signal::Signal;
use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::ops::ControlFlow;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use tokio_tungstenite::tungstenite;
use tokio_tungstenite::tungstenite::client::IntoClientRequest as _;
use tokio_tungstenite::tungstenite::http::HeaderValue;

/// The index finger's place in ANGLE_SET.
const INDEX: u16 = 1492;
const BUSY: u8 = 6;

/// A shared hand, and where.
fn share(args: &[&str]) -> (Running, String) {
    let mut share = start(&[&["share", "--tcp", "127.0.0.1:0"], args].concat());
    let ready = share.line();
    let address = ready.strip_prefix("ready tcp ").expect(&ready).to_owned();
    (share, address)
}

/// What is said to a request, without its envelope.
fn ask(client: &mut TcpStream, pdu: &[u8]) -> Vec<u8> {
    let len = u8::try_from(pdu.len() + 1).unwrap();
    let head = [0, 9, 0, 0, 0, len, 1];
    client.write_all(&[&head, pdu].concat()).unwrap();
    let mut head = [0; 7];
    client.read_exact(&mut head).unwrap();
    assert_eq!((&head[..4], head[6]), (&[0, 9, 0, 0][..], 1));
    let mut said = vec![0; usize::from(head[5]) - 1];
    client.read_exact(&mut said).unwrap();
    said
}

fn read(client: &mut TcpStream, address: u16) -> u16 {
    let [high, low] = address.to_be_bytes();
    match ask(client, &[3, high, low, 0, 1])[..] {
        [3, 2, high, low] => u16::from_be_bytes([high, low]),
        ref other => panic!("{other:?}"),
    }
}

/// Function 06: the exception, if there is one.
fn write(client: &mut TcpStream, address: u16, value: u16) -> Option<u8> {
    let [[a, b], [c, d]] = [address, value].map(u16::to_be_bytes);
    let asked = [6, a, b, c, d];
    match ask(client, &asked)[..] {
        [0x86, exception] => Some(exception),
        ref echo => {
            assert_eq!(echo, asked);
            None
        }
    }
}

#[test]
fn without_writers_several_clients_read_and_nobody_writes() {
    unless_busy(|| {
        let (share, address) = share(&["--hand", "sim:"]);
        let mut clients: Vec<TcpStream> = (0..3)
            .map(|_| TcpStream::connect(&address).unwrap())
            .collect();
        for client in &mut clients {
            assert_eq!(read(client, 1000), 1);
            assert_eq!(read(client, 1546), 1000);
            assert_eq!(write(client, INDEX, 0), Some(BUSY));
            assert_eq!(write(client, 1005, 1), Some(2));
            assert_eq!(read(client, INDEX), 1000);
        }
        share.signal(Signal::SIGINT);
        let ended = share.end().ok();
        assert_eq!(ended.err, "", "nothing moved");
    });
}

#[test]
fn the_first_writer_moves_the_hand_and_ctrl_c_stops_it() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (sim, hand) = sim_on_link(&link, &[]);
        let (mut share, address) = share(&["--hand", &hand, "--writers"]);
        let mut client = TcpStream::connect(&address).unwrap();
        let mut other = TcpStream::connect(&address).unwrap();
        assert_eq!(write(&mut client, INDEX, 0), None);
        assert_eq!(write(&mut other, INDEX, 900), Some(BUSY));
        assert_eq!(read(&mut other, INDEX), 0);
        let told = share.complaint();
        let mover = client.local_addr().unwrap();
        assert!(
            told.contains(&format!("{mover} may move the hand")),
            "{told}"
        );
        // A drive needs its dead time before it moves.
        while read(&mut other, 1552) > 950 {}
        share.signal(Signal::SIGINT);
        share.end().ok();
        let ours = run(&["read", "ANGLE_SET", "ANGLE_ACT", "--json", "--hand", &hand]);
        let ours = ours.ok().lines().remove(0);
        let held = ours["ANGLE_SET"][3].as_i64().unwrap();
        assert!((1..990).contains(&held), "{ours}");
        drop(sim);
    });
}

#[test]
fn the_end_of_a_client_is_told_and_the_next_may() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let (mut share, address) = share(&["--hand", &hand, "--writers", "--silence", "1"]);
        let mut client = TcpStream::connect(&address).unwrap();
        assert_eq!(write(&mut client, INDEX, 500), None);
        assert!(share.complaint().contains("may move the hand"));
        let told = share.complaint();
        assert!(
            told.contains("it received no command for too long"),
            "{told}"
        );
        assert_eq!(write(&mut client, INDEX, 500), Some(BUSY));
        let mut next = TcpStream::connect(&address).unwrap();
        while write(&mut next, INDEX, 500) == Some(BUSY) {
            sleep(Duration::from_millis(20));
        }
        assert!(share.complaint().contains("may move the hand"));
        drop(next);
        assert!(
            share
                .complaint()
                .contains("has disconnected: the hand is being stopped")
        );
    });
}

#[test]
fn clients_that_come_write_and_leave_between_two_looks_are_told_too() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("moves.mcap");
        let (_sim, hand) = sim_on_tcp(&[]);
        let record_to = record.to_str().unwrap();
        let (mut share, address) = share(&["--hand", &hand, "--writers", "--record", record_to]);
        assert!(share.complaint().contains("recording "));
        for nth in 0..3 {
            let client = loop {
                let mut client = TcpStream::connect(&address).unwrap();
                if write(&mut client, INDEX, 900 - nth) != Some(BUSY) {
                    break client.local_addr().unwrap();
                }
            };
            let began = share.complaint();
            assert!(
                began.contains(&format!("{client} may move the hand")),
                "{began}"
            );
            let left = share.complaint();
            let gone =
                format!("{client}, which had control, has disconnected: the hand is being stopped");
            assert!(left.contains(&gone), "{left}");
        }
        share.signal(Signal::SIGINT);
        share.end().ok();
        // What clients wrote was recorded as it passed.
        let file = RecordingFile::open(&record).unwrap();
        let mut told = Vec::new();
        let all = TimeRange {
            from: file.first(),
            to: file.last(),
            wire: false,
        };
        let read = file.entries(all, |entry| {
            if let Entry::Heard(Record::Sent { write, .. }) = &entry {
                told.extend(write.angle_targets()[Dof::Index].map(Angle::get));
            }
            ControlFlow::Continue(())
        });
        read.unwrap();
        for to in [900, 899, 898] {
            assert!(told.contains(&to), "{told:?}");
        }
    });
}

#[test]
fn a_hand_that_goes_away_is_told_once_and_is_answered_for_as_gone() {
    unless_busy(|| {
        let (sim, hand) = sim_on_tcp(&[]);
        let (mut share, address) = share(&["--hand", &hand]);
        let mut client = TcpStream::connect(&address).unwrap();
        assert_eq!(read(&mut client, 1546), 1000);
        sim.kill();
        assert!(share.complaint().contains("lost"));
        assert_eq!(ask(&mut client, &[3, 6, 10, 0, 1]), [0x83, 0x0A]);
        let mut sim = start(&["sim", "--tcp", hand.strip_prefix("tcp:").unwrap()]);
        sim.line();
        while !share.complaint().contains("answers again") {}
        assert_eq!(read(&mut client, 1546), 1000);
    });
}

#[test]
fn what_cannot_be_shared_is_told_in_one_sentence() {
    unless_busy(|| {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let taken = listener.local_addr().unwrap().to_string();
        for (args, code, words) in [
            (&["--hand", "sim:"][..], 2, "--tcp"),
            (&["--hand", "sim:"], 2, "--foxglove"),
            (&["--hand", "sim:", "--dds", "--writers"], 2, "--tcp"),
            (&["--hand", "sim:", "--dds=nowhere0"], 1, "nowhere0"),
            (&["--tcp", "127.0.0.1:0"], 2, "--hand"),
            (
                &["--hand", "sim:", "--foxglove", "127.0.0.1:0", "--writers"],
                2,
                "--tcp",
            ),
            (
                &["--hand", "sim:", "--tcp", "localhost:6001"],
                2,
                "127.0.0.1:6000",
            ),
            (
                &["--hand", "sim:", "--tcp", "127.0.0.1:0", "--silence", "5"],
                2,
                "--writers",
            ),
            (
                &["--hand", "rs485:/nowhere/hand", "--tcp", "127.0.0.1:0"],
                1,
                "is not there",
            ),
        ] {
            let ended = run(&[&["share"], args].concat());
            assert_eq!(ended.code, Some(code), "{args:?}: {}", ended.err);
            assert!(ended.err.contains(words), "{args:?}: {}", ended.err);
            assert_eq!(ended.out, "", "{args:?}");
        }
        let ended = run(&["share", "--hand", "sim:", "--tcp", &taken]);
        assert_eq!(ended.code, Some(1));
        assert!(
            ended.err.contains("Address already in use"),
            "{}",
            ended.err
        );
        assert_eq!(ended.err.lines().count(), 1);
    });
}

/// Reads, is refused what is not for clients, moves the index finger, and reads back what it was told.
const CLIENT: &str = r#"
import sys
from pymodbus.client import ModbusTcpClient
host, port = sys.argv[1].rsplit(":", 1)
client = ModbusTcpClient(host, port=int(port), timeout=5)
assert client.connect()
def whole(reply):
    assert not reply.isError(), reply
    return reply
print(whole(client.read_holding_registers(1546, count=6, device_id=255)).registers)
print(len(whole(client.read_holding_registers(1534, count=45, device_id=1)).registers))
print(client.write_register(1005, 1, device_id=255).exception_code)
print(client.write_register(1486, 1001, device_id=255).exception_code)
whole(client.write_registers(1486, [0xFFFF, 0xFFFF, 0xFFFF, 500, 0xFFFF, 0xFFFF], device_id=255))
print(whole(client.read_holding_registers(1492, count=1, device_id=255)).registers)
print(client.read_holding_registers(9000, count=2, device_id=255).exception_code)
client.close()
"#;

#[test]
fn pymodbus_reads_and_moves_a_shared_hand() {
    unless_busy(|| {
        let asked = Command::new("python3")
            .args(["-c", "from pymodbus.client import ModbusTcpClient"])
            .stderr(Stdio::null())
            .status();
        if !asked.is_ok_and(|status| status.success()) {
            return skipped("pymodbus", "python3 has no pymodbus");
        }
        let (_sim, hand) = sim_on_tcp(&[]);
        let (_share, address) = share(&["--hand", &hand, "--writers"]);
        let mut command = Command::new("python3");
        command.args(["-c", CLIENT, &address]).stdin(Stdio::null());
        let out = listen(command).end().ok().out;
        let lines: Vec<&str> = out.lines().collect();
        let angles = "[1000, 1000, 1000, 1000, 1000, 1000]";
        assert_eq!(lines, [angles, "45", "2", "3", "[500]", "2"]);
    });
}

/// A hand that is shown, and where.
fn show(args: &[&str]) -> (Running, String) {
    let mut share = start(&[&["share", "--foxglove", "127.0.0.1:0"], args].concat());
    let ready = share.line();
    let address = ready.strip_prefix("ready foxglove ").expect(&ready);
    let address = address.to_owned();
    (share, address)
}

#[test]
fn a_hand_is_shown_and_shared_at_once() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let both = ["--hand", &hand, "--foxglove", "127.0.0.1:0"];
        let (mut share, tcp) = share(&both);
        let ready = share.line();
        let shown = ready.strip_prefix("ready foxglove ").expect(&ready);
        let mut client = TcpStream::connect(tcp).unwrap();
        assert_eq!(read(&mut client, 1546), 1000);
        let viewer = TcpStream::connect(shown).unwrap();
        let request = "ws://hand".into_client_request().map(|mut request| {
            let name = HeaderValue::from_static("foxglove.sdk.v1");
            request.headers_mut().insert("sec-websocket-protocol", name);
            request
        });
        let (mut viewer, _) = tungstenite::client(request.unwrap(), viewer).unwrap();
        let told = viewer.read().unwrap().into_text().unwrap();
        assert!(told.contains(&format!("Handscope {hand}")), "{told}");
        assert!(!told.contains("SIMULATED"), "it is behind a wire: {told}");
        share.signal(Signal::SIGINT);
        assert_eq!(share.end().ok().err, "");
    });
}

#[test]
fn a_viewer_in_the_network_is_warned_of() {
    unless_busy(|| {
        let mut share = start(&["share", "--hand", "sim:", "--foxglove", "0.0.0.0:0"]);
        assert!(share.line().starts_with("ready foxglove 0.0.0.0:"));
        let told = share.complaint();
        assert!(told.contains("watch this hand"), "{told}");
    });
}

/// Ports at which a process listens or takes datagrams.
#[cfg(target_os = "linux")]
fn listens(id: u32) -> usize {
    let folder = std::fs::read_dir(format!("/proc/{id}/fd")).unwrap();
    let links = folder.filter_map(|entry| std::fs::read_link(entry.unwrap().path()).ok());
    let sockets: Vec<String> = links
        .filter_map(|link| Some(link.to_str()?.strip_prefix("socket:[")?.replace(']', "")))
        .collect();
    let tables = ["tcp", "tcp6", "udp", "udp6"].map(|table| {
        std::fs::read_to_string(format!("/proc/{id}/net/{table}")).unwrap_or_default()
    });
    let rows = tables.iter().flat_map(|table| table.lines().skip(1));
    let waiting = rows.filter(|row| {
        let fields: Vec<&str> = row.split_whitespace().collect();
        // 0A is a listener, 07 an open socket for datagrams (man proc_pid_net).
        matches!(fields[3], "0A" | "07") && sockets.iter().any(|own| own == fields[9])
    });
    waiting.count()
}

#[cfg(target_os = "linux")]
#[test]
fn there_is_a_listener_for_each_way_that_was_asked_for_and_no_other() {
    unless_busy(|| {
        let (share, _) = share(&["--hand", "sim:"]);
        assert_eq!(listens(share.id()), 1);
        let (share, _) = show(&["--hand", "sim:"]);
        assert_eq!(listens(share.id()), 1);
        let mut watch = start(&["watch", "--hand", "sim:", "--json"]);
        watch.line();
        assert_eq!(listens(watch.id()), 0);
    });
}

#[test]
fn websockets_mcap_and_rosbags_of_others_read_a_shown_hand() {
    unless_busy(|| {
        let asked = Command::new("python3")
            .args([
                "-c",
                "import websockets, mcap_ros2.decoder, rosbags.typesys",
            ])
            .stderr(Stdio::null())
            .status();
        if !asked.is_ok_and(|status| status.success()) {
            return skipped(
                "foxglove",
                "python3 has no websockets, mcap-ros2-support or rosbags",
            );
        }
        let (_share, address) = show(&["--hand", "sim:"]);
        let mut command = Command::new("python3");
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/interop/foxglove.py");
        command.args([script, &address]).stdin(Stdio::null());
        let out = listen(command).end().ok().out;
        let lines: Vec<&str> = out.lines().collect();
        assert_eq!(lines.len(), 2, "{out}");
        for (line, name) in lines.iter().zip(["sdk", "websocket"]) {
            let begin = format!("foxglove.{name}.v1 Handscope sim:");
            assert!(line.starts_with(&begin), "{out}");
            assert!(line.contains("(SIMULATED)"), "{out}");
        }
    });
}
