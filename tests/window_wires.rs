//! The window in front of a hand on every wire there is: real ports and sockets, real time, no display. It shows what the
//! hand says and writes nothing. CAN is tried where this machine has `vcan0`.
#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may"
)]

use handscope::app::program::{App, Env};
use handscope::app::settings::Settings;
use handscope::app::{NoChoice, SimDial};
use handscope::hand::Moment;
use handscope::headless::canvas::Canvas;
use handscope::link::{Clock, LinkState};
use handscope::shell::Cockpit;
use handscope::sim::serve::{modbus_tcp, pty};
use handscope::sim::{Object, SharedHand, SimConfig, SimHand};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
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
    let mut hand = SimHand::new(SimConfig::default());
    hand.set_object(&Object::none());
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
    if !Path::new("/sys/class/net/vcan0").exists() {
        println!("no vcan0 here: the window was not tried on CAN");
        return None;
    }
    let wire = handscope::transport::can::open("vcan0", None).unwrap();
    tokio::spawn(handscope::sim::serve::can::serve(hand.clone(), wire));
    Some("can:vcan0".into())
}

#[cfg(not(target_os = "linux"))]
fn can(_: &SharedHand) -> Option<String> {
    None
}

/// The program and its window on one endpoint.
struct Desk {
    runtime: Runtime,
    clock: Clock,
    cockpit: Cockpit,
    canvas: Canvas,
}

impl Desk {
    fn open(endpoint: &str) -> Self {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .unwrap();
        let inside = runtime.enter();
        let clock = Clock::start();
        let env = Env {
            runtime: runtime.handle().clone(),
            clock,
            dial: Arc::new(SimDial::new(clock)),
            wake: Arc::new(|| {}),
            files: Arc::new(NoChoice),
            settings_path: None,
        };
        let mut app = App::new(env, Settings::default());
        app.open(Some(endpoint.parse().unwrap()), clock.now());
        let cockpit = Cockpit::new(app);
        drop(inside);
        Self {
            runtime,
            clock,
            cockpit,
            canvas: Canvas::new((1440, 900), 1.0),
        }
    }

    fn tick(&mut self) {
        self.runtime
            .block_on(async { tokio::time::sleep(FRAME).await });
        let _inside = self.runtime.enter();
        self.cockpit.logic(self.clock.now());
    }

    /// Everything in the window that has a name.
    fn labels(&mut self) -> Vec<Value> {
        let _inside = self.runtime.enter();
        let now = self.clock.now();
        let cockpit = &mut self.cockpit;
        let picture = self.canvas.picture(now.secs(), |ui| cockpit.ui(ui, now));
        picture.labels.as_array().unwrap().clone()
    }

    /// Waits until the link is live and all five fingertips were read.
    fn until_live(&mut self, endpoint: &str) {
        for _ in 0..FRAMES_MAX {
            self.tick();
            let state = self.cockpit.state();
            if state.link.state == LinkState::Monitoring && state.stats.tactile_reads > 2 {
                return;
            }
        }
        panic!("{endpoint}: {:?}", self.cockpit.state().link);
    }
}

fn shown<'a>(labels: &'a [Value], name: &str) -> Option<&'a str> {
    let entry = labels.iter().find(|entry| entry["name"] == name)?;
    entry["value"].as_str().map(str::trim)
}

#[test]
fn the_window_shows_the_hand_on_every_wire_and_writes_nothing() {
    let servers = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .unwrap();
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
        let stats = &desk.cockpit.state().stats;
        assert_eq!((stats.writes, stats.reconnects), (0, 0), "{endpoint}");
        let written = hand.with(|hand, _| hand.journal().len());
        assert_eq!(written, WRITES, "{endpoint}");
    }
}
