//! The window in front of a hand on every wire there is: real ports and sockets, real time, no display. It shows what the
//! hand says and writes nothing. CAN is tried where this machine has `vcan0`.

use crate::setup::busy::unless_busy;
use crate::setup::hand::free;
use crate::setup::program::{Program, env};
#[cfg(target_os = "linux")]
use crate::setup::skipped::can_interface;
use crate::setup::time::Time;
use handscope::app::settings::Settings;
use handscope::hand::Moment;
use handscope::record::LinkState;
use handscope::shell::headless::canvas::Canvas;
use handscope::sim::serve::{modbus_tcp, pty};
use handscope::sim::{SharedHand, SimConfig};
use serde_json::Value;
use std::path::Path;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::time::Instant;

/// Frames until the window must be live: many times what it takes, on a machine with other work.
const FRAMES_MAX: usize = 1500;
const FRAME: Duration = Duration::from_millis(20);
/// The pose of the hand, which no default gives.
const ANGLE: i16 = 640;
/// The one write is that which brought it there.
const WRITES: usize = 1;

/// A hand that came to its pose before anyone looked.
fn hand() -> SharedHand {
    let mut hand = free(SimConfig::default());
    hand.write(1486, &ANGLE.to_le_bytes().repeat(6), Moment::ZERO)
        .unwrap();
    let begun = Instant::now().checked_sub(Duration::from_secs(5));
    SharedHand::new(hand, begun.unwrap())
}

/// The endpoints at which it is served.
fn serve(hand: &SharedHand, folder: &Path) -> Vec<String> {
    let place = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [rs485, rtu, slcan] = ["rs485", "rtu", "slcan"].map(place);
    tokio::spawn(pty::serve_rs485(hand.clone(), Path::new(&rs485), None).unwrap());
    tokio::spawn(pty::serve_rtu(hand.clone(), Path::new(&rtu), None).unwrap());
    tokio::spawn(pty::serve_slcan(hand.clone(), Path::new(&slcan)).unwrap());
    let socket = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    socket.set_nonblocking(true).unwrap();
    let tcp = socket.local_addr().unwrap();
    let listener = TcpListener::from_std(socket).unwrap();
    tokio::spawn(modbus_tcp::serve(hand.clone(), listener));
    let mut all = vec![
        format!("rs485:{rs485}"),
        format!("rtu:{rtu}"),
        format!("tcp:{tcp}"),
        format!("slcan:{slcan}"),
    ];
    all.extend(can(hand));
    all
}

#[cfg(target_os = "linux")]
fn can(hand: &SharedHand) -> Option<String> {
    let interface = can_interface()?;
    let wire = handscope::transport::can::open(interface, None).unwrap();
    tokio::spawn(handscope::sim::serve::can::serve(hand.clone(), wire));
    Some(format!("can:{interface}"))
}

#[cfg(not(target_os = "linux"))]
fn can(_: &SharedHand) -> Option<String> {
    None
}

/// The program and its window on one endpoint.
struct Desk {
    program: Program,
    canvas: Canvas,
}

impl Desk {
    fn open(endpoint: &str) -> Self {
        let set_up = || (env(), Settings::default());
        Self {
            program: Program::start(Time::Real, Some(endpoint), set_up),
            canvas: Canvas::new((1440, 900), 1.0),
        }
    }

    fn labels(&mut self) -> Vec<Value> {
        let now = self.program.now();
        let program = &mut self.program;
        let picture = self.canvas.picture(now.secs(), |ui| program.ui(ui));
        picture.labels.as_array().unwrap().clone()
    }

    /// Waits until the link is live and all five fingertips were read.
    fn until_live(&mut self, endpoint: &str) {
        for _ in 0..FRAMES_MAX {
            self.program.tick(FRAME);
            let state = self.program.state();
            if state.hand().connection.status.state == LinkState::Monitoring
                && state.hand().connection.stats.tactile_reads > 2
            {
                return;
            }
        }
        panic!(
            "{endpoint}: {:?}",
            self.program.state().hand().connection.status
        );
    }
}

fn shown<'a>(labels: &'a [Value], name: &str) -> Option<&'a str> {
    let entry = labels.iter().find(|entry| entry["name"] == name)?;
    entry["value"].as_str().map(str::trim)
}

#[test]
fn the_window_shows_the_hand_on_every_wire_and_writes_nothing() {
    unless_busy(|| {
        let servers = Time::Real.runtime();
        let folder = tempfile::tempdir().unwrap();
        let inside = servers.enter();
        let hand = hand();
        let endpoints = serve(&hand, folder.path());
        drop(inside);
        for endpoint in &endpoints {
            let mut desk = Desk::open(endpoint);
            desk.until_live(endpoint);
            let labels = desk.labels();
            for joint in [
                "Little",
                "Ring",
                "Middle",
                "Index",
                "Thumb bend",
                "Thumb rotate",
            ] {
                let angle = shown(&labels, &format!("{joint} actual angle"));
                assert_eq!(angle, Some("640"), "{endpoint}: {joint}");
            }
            let named = |name: &str| labels.iter().any(|entry| entry["name"] == name);
            assert!(named("Link state: Monitoring"), "{endpoint}");
            assert!(!named("SIMULATED"), "{endpoint}: it is no built-in hand");
            assert!(!named("Disarm the hand"), "{endpoint}");
            let stats = &desk.program.state().hand().connection.stats;
            assert_eq!((stats.writes, stats.reconnects), (0, 0), "{endpoint}");
            let written = hand.with(|hand, _| hand.journal().len());
            assert_eq!(written, WRITES, "{endpoint}");
        }
    });
}
