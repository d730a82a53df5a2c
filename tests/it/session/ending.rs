//! Whatever ends a program that moves a hand: a hand in this process is the judge, over real sockets and pseudo-terminals. It must
//! be held at once, rest where it stands, and nothing of the program may stay.

use crate::setup::busy::unless_busy;
use crate::setup::hand::free;
use crate::setup::process::{Running, handscope, listen, start};
use crate::setup::time::Time;
use handscope::hand::Moment;
use handscope::hand::register::{ANGLE_ACT, ANGLE_SET};
use handscope::sim::serve::{modbus_tcp, pty};
use handscope::sim::{SharedHand, SimConfig};
use handscope::transport::Endpoint;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::net::UdpSocket;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

/// A hand must be held by then: three times what is promised, on a machine with other work.
const HELD_WITHIN: Duration = Duration::from_millis(1000);
const WITHIN: Duration = Duration::from_secs(30);
const LOOK_EACH: Duration = Duration::from_millis(5);
/// The index, in register order.
const INDEX: usize = 3;
/// Feedback lies this much beside the setpoint of a joint that rests.
const BESIDE: u16 = 20;

/// A hand that tells what was done to it, and its endpoints.
struct Witness {
    hand: SharedHand,
    servers: Option<Runtime>,
    folder: TempDir,
    tcp: String,
}

impl Witness {
    fn start() -> Self {
        let servers = Time::Real.runtime();
        let inside = servers.enter();
        let hand = SharedHand::new(free(SimConfig::default()), tokio::time::Instant::now());
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let (rs485, rtu, slcan) = (place("rs485"), place("rtu"), place("slcan"));
        tokio::spawn(pty::serve_rs485(hand.clone(), &rs485, None).unwrap());
        tokio::spawn(pty::serve_rtu(hand.clone(), &rtu, None).unwrap());
        tokio::spawn(pty::serve_slcan(hand.clone(), &slcan).unwrap());
        let socket = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        socket.set_nonblocking(true).unwrap();
        let tcp = format!("tcp:{}", socket.local_addr().unwrap());
        tokio::spawn(modbus_tcp::serve(
            hand.clone(),
            TcpListener::from_std(socket).unwrap(),
        ));
        drop(inside);
        Self {
            hand,
            servers: Some(servers),
            folder,
            tcp,
        }
    }

    fn endpoint(&self, kind: &str) -> String {
        match kind {
            "tcp" => self.tcp.clone(),
            kind => format!("{kind}:{}", self.folder.path().join(kind).display()),
        }
    }

    fn angles(&self) -> Vec<i16> {
        let bytes = self
            .hand
            .with(|hand, now| hand.read(ANGLE_ACT.span(), now).unwrap());
        let pairs = bytes.chunks_exact(2);
        pairs
            .map(|pair| i16::from_le_bytes([pair[0], pair[1]]))
            .collect()
    }

    /// Waits until the index came down to this.
    fn moves_below(&self, angle: i16) {
        let begun = Instant::now();
        while self.angles()[INDEX] > angle {
            assert!(begun.elapsed() < WITHIN, "{:?}", self.angles());
            sleep(LOOK_EACH);
        }
    }

    /// Writes of angles that came later than this, which move or hold the index.
    fn set_after(&self, moment: Moment) -> Vec<(Moment, i16)> {
        let span = ANGLE_SET.span();
        self.hand.with(|hand, _| {
            let later = hand.journal().iter().filter(|entry| entry.at > moment);
            let index = |address: u16, bytes: &[u8]| {
                let wanted = usize::from(span.address) + 2 * INDEX;
                let at = wanted.checked_sub(usize::from(address))?;
                let pair = bytes.get(at..at + 2)?;
                Some(i16::from_le_bytes([pair[0], pair[1]]))
            };
            later
                .filter(|entry| (span.address..span.address + span.len).contains(&entry.address))
                .filter_map(|entry| Some((entry.at, index(entry.address, &entry.bytes)?)))
                .filter(|(_, angle)| *angle >= 0)
                .collect()
        })
    }

    /// Judges what happened to a hand in motion since then: how soon it was held. It rests where it was held.
    fn was_held(&self, since: Moment, what: &str) -> Duration {
        let begun = Instant::now();
        let first = loop {
            if let Some((at, _)) = self.set_after(since).first() {
                break at.since(since);
            }
            assert!(begun.elapsed() < 5 * HELD_WITHIN, "{what}: never held");
            sleep(LOOK_EACH);
        };
        println!("{what}: held {first:?} after");
        assert!(first < HELD_WITHIN, "{what}: held only after {first:?}");
        let mut last = self.angles();
        loop {
            sleep(Duration::from_millis(150));
            let now = self.angles();
            if now == last {
                break;
            }
            last = now;
            assert!(begun.elapsed() < WITHIN, "{what}: it moves on");
        }
        let (_, set) = *self.set_after(since).last().unwrap();
        assert!(
            set.abs_diff(last[INDEX]) <= BESIDE,
            "{what}: {set} {last:?}"
        );
        assert!(last[INDEX] > 100, "{what}: ran on to the fist: {last:?}");
        first
    }
}

impl Drop for Witness {
    fn drop(&mut self) {
        if let Some(servers) = self.servers.take() {
            servers.shutdown_background();
        }
    }
}

/// Processes that would hold the hand at this endpoint, by their command.
fn holders(endpoint: &str) -> Vec<Pid> {
    let endpoint: Endpoint = endpoint.parse().unwrap();
    let all = std::fs::read_dir("/proc").unwrap().flatten();
    let id = |path: &Path| path.file_name()?.to_str()?.parse::<i32>().ok();
    all.filter_map(|entry| {
        let words = std::fs::read(entry.path().join("cmdline")).ok()?;
        let words = String::from_utf8_lossy(&words).replace('\0', " ");
        let is_one = words
            .trim_end()
            .ends_with(&format!(" guard --hand {endpoint}"));
        is_one.then(|| id(&entry.path()).map(Pid::from_raw))?
    })
    .collect()
}

fn no_holder_stays(endpoint: &str, what: &str) {
    let begun = Instant::now();
    while !holders(endpoint).is_empty() {
        assert!(begun.elapsed() < WITHIN, "{what}: a holder stays");
        sleep(LOOK_EACH);
    }
}

fn trial(endpoint: &str) -> Running {
    start(&[
        "trial", "--hand", endpoint, "--joint", "index", "--speed", "150", "--force", "500",
        "--dwell", "0.3", "--arm",
    ])
}

#[test]
fn a_hand_is_held_when_the_program_that_moves_it_is_killed_on_every_wire() {
    unless_busy(|| {
        std::thread::scope(|all| {
            for kind in ["tcp", "rs485", "rtu", "slcan"] {
                all.spawn(move || {
                    let witness = Witness::start();
                    let endpoint = witness.endpoint(kind);
                    let trial = trial(&endpoint);
                    witness.moves_below(900);
                    let [holder] = holders(&endpoint)[..] else {
                        panic!("{kind}: {:?}", holders(&endpoint));
                    };
                    // What a terminal or the system says to all is not for it.
                    for signal in [Signal::SIGINT, Signal::SIGHUP, Signal::SIGTERM] {
                        kill(holder, signal).unwrap();
                    }
                    // A program that stands still is not dead.
                    trial.signal(Signal::SIGSTOP);
                    let stands = witness.hand.now();
                    sleep(Duration::from_millis(400));
                    assert_eq!(
                        witness.set_after(stands),
                        [],
                        "{kind}: it only stands still"
                    );
                    let died = witness.hand.now();
                    trial.signal(Signal::SIGKILL);
                    witness.was_held(died, &format!("killed on {kind}"));
                    let ended = trial.end();
                    assert!(ended.err.contains("the hand was stopped"), "{}", ended.err);
                    no_holder_stays(&endpoint, kind);
                });
            }
        });
    });
}

#[test]
fn a_hand_is_held_when_follow_is_killed() {
    unless_busy(|| {
        let witness = Witness::start();
        let endpoint = witness.endpoint("tcp");
        let mut follow = start(&[
            "follow",
            "--hand",
            &endpoint,
            "--udp",
            "127.0.0.1:0",
            "--arm",
            "--lead",
            "500",
            "--rate",
            "300",
        ]);
        let ready = follow.line();
        let place = ready.strip_prefix("ready udp ").expect(&ready).to_owned();
        let ends = AtomicBool::new(false);
        std::thread::scope(|all| {
            all.spawn(|| {
                let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
                for seq in 0.. {
                    if ends.load(Ordering::Relaxed) {
                        return;
                    }
                    let line = format!("{{\"seq\":{seq},\"right\":[0,0,0,0,0,0]}}");
                    let _sent = socket.send_to(line.as_bytes(), &place);
                    sleep(Duration::from_millis(20));
                }
            });
            witness.moves_below(850);
            let died = witness.hand.now();
            follow.kill();
            ends.store(true, Ordering::Relaxed);
            witness.was_held(died, "follow killed");
        });
        no_holder_stays(&endpoint, "follow");
    });
}

#[test]
fn a_program_that_ends_by_itself_leaves_nothing_and_writes_nothing_more() {
    unless_busy(|| {
        let witness = Witness::start();
        let endpoint = witness.endpoint("rs485");
        let trial = start(&[
            "trial", "--hand", &endpoint, "--joint", "index", "--close", "700", "--speed", "500",
            "--force", "500", "--dwell", "0.3", "--arm",
        ]);
        trial.end().ok();
        let ended = witness.hand.now();
        no_holder_stays(&endpoint, "trial");
        sleep(Duration::from_millis(300));
        assert_eq!(witness.set_after(ended), [], "nothing is written after it");
        // The port is free.
        start(&["read", "ANGLE_ACT", "--hand", &endpoint])
            .end()
            .ok();
    });
}

/// What ends a window.
#[cfg(feature = "desktop")]
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Signal(Signal),
    DisplayGone,
    /// The display answers no more, and then a signal comes.
    Frozen(Signal),
}

#[cfg(feature = "desktop")]
#[test]
fn a_hand_is_held_whatever_ends_the_window() {
    unless_busy(|| {
        use crate::session::display::Display;
        let home = tempfile::tempdir().unwrap();
        for (drawn, end, status) in [
            ("--software", End::Signal(Signal::SIGINT), Some(0)),
            ("--opengl", End::Signal(Signal::SIGTERM), Some(0)),
            ("--software", End::Signal(Signal::SIGHUP), Some(0)),
            ("--software", End::Signal(Signal::SIGKILL), None),
            ("--software", End::Frozen(Signal::SIGTERM), Some(143)),
            ("--software", End::DisplayGone, Some(1)),
            ("--opengl", End::DisplayGone, Some(1)),
        ] {
            let Some(display) = Display::start() else {
                return;
            };
            let witness = Witness::start();
            let endpoint = witness.endpoint("tcp");
            let mut command = handscope();
            command.args(["--hand", &endpoint, "--no-record", drawn]);
            command
                .env("DISPLAY", display.name())
                .env("HOME", home.path())
                .env("XDG_CONFIG_HOME", home.path())
                .env("HANDSCOPE_DOCUMENTS", home.path());
            let window = listen(command);
            let what = format!("{end:?} {drawn}");
            display.waits_for("Handscope");
            // On a machine with other work the feedback may have grown old and the hand be disarmed, as it should.
            let begun = Instant::now();
            while witness.angles()[INDEX] > 950 {
                assert!(begun.elapsed() < 3 * WITHIN, "{what}: it does not move");
                display.focus("Handscope");
                display.shifted("a");
                sleep(Duration::from_millis(300));
                display.shifted("c");
                sleep(Duration::from_millis(300));
            }
            assert_eq!(holders(&endpoint).len(), 1, "{what}");
            if let End::Frozen(_) = end {
                display.signal(Signal::SIGSTOP);
                sleep(Duration::from_millis(100));
            }
            let since = witness.hand.now();
            match end {
                End::Signal(signal) | End::Frozen(signal) => window.signal(signal),
                End::DisplayGone => display.signal(Signal::SIGKILL),
            }
            witness.was_held(since, &what);
            let ended = window.end();
            // A frame may take seconds where others want the processors, too: that is a window that hangs.
            let hung = match end {
                End::Signal(signal) if signal != Signal::SIGKILL => Some(128 + signal as i32),
                _ => status,
            };
            assert!(
                [status, hung].contains(&ended.code),
                "{what}: {:?} {}",
                ended.code,
                ended.err
            );
            no_holder_stays(&endpoint, &what);
            display.signal(Signal::SIGCONT);
        }
    });
}
