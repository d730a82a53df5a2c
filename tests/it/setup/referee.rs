//! A simulated hand by another author (`tests/referee/hand.c`): its own physics in its own process, on loopback TCP. It tells
//! apart what is true of hands from what is true of our simulator. Claims nothing.

use crate::setup::skipped::skipped;
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;
use std::time::Duration;

const READY_TIMEOUT: Duration = Duration::from_secs(30);

/// Compiles the hand once per test run. `None`, and a line that says so, without a C compiler.
fn program() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    let built = PROGRAM.get_or_init(|| {
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/referee/hand.c");
        let name = format!("referee-hand-{}", std::process::id());
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let mut cc = Command::new("cc");
        cc.args(["-O2", "-w", "-o"]).arg(&program);
        match cc.args([source, "-lm"]).status() {
            Ok(status) => {
                assert!(status.success(), "{source} does not compile");
                Some(program)
            }
            Err(error) => {
                skipped("the referee hand", &format!("no C compiler: {error}"));
                None
            }
        }
    });
    built.as_deref()
}

/// The referee hand, running. Dropping it ends it.
pub(crate) struct RefereeHand {
    child: Child,
    input: ChildStdin,
    port: u16,
    closes: Arc<Mutex<Vec<Value>>>,
}

impl RefereeHand {
    /// Starts the hand with keys of its README (`&["k=25", "index.contact=480", "only=index"]`).
    pub(crate) fn start(seed: u32, keys: &[&str]) -> Option<Self> {
        let program = program()?;
        // A free port can be taken by another before the hand binds it.
        (0..5).find_map(|_| Self::start_on(program, free_port(), seed, keys))
    }

    fn start_on(program: &Path, port: u16, seed: u32, keys: &[&str]) -> Option<Self> {
        let mut command = Command::new(program);
        command
            .args([port.to_string(), seed.to_string()])
            .args(keys);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let input = child.stdin.take().unwrap();
        let output = BufReader::new(child.stdout.take().unwrap());
        let closes = Arc::new(Mutex::new(Vec::new()));
        let (ready, is_ready) = channel();
        let log = Arc::clone(&closes);
        thread::spawn(move || {
            for line in output.lines().map_while(Result::ok) {
                if line == "READY" {
                    let _gone = ready.send(());
                } else if let Ok(close) = serde_json::from_str(&line) {
                    log.lock().unwrap().push(close);
                }
            }
        });
        let hand = Self {
            child,
            input,
            port,
            closes,
        };
        wait_for(&is_ready).then_some(hand)
    }

    /// The endpoint as the program's `--hand` takes it.
    pub(crate) fn endpoint(&self) -> String {
        format!("tcp:127.0.0.1:{}", self.port)
    }

    /// Sends a line of its README, such as `set index zero 60`.
    pub(crate) fn send(&mut self, line: &str) {
        writeln!(self.input, "{line}").unwrap();
    }

    /// True values of each close that has opened again: `peak` (g), `broken`, `angle_contact` and others.
    pub(crate) fn closes(&self) -> Vec<Value> {
        self.closes.lock().unwrap().clone()
    }
}

impl Drop for RefereeHand {
    fn drop(&mut self) {
        let _gone = self.child.kill();
        let _ended = self.child.wait();
    }
}

fn free_port() -> u16 {
    let socket = TcpListener::bind("127.0.0.1:0").unwrap();
    socket.local_addr().unwrap().port()
}

fn wait_for(is_ready: &Receiver<()>) -> bool {
    is_ready.recv_timeout(READY_TIMEOUT).is_ok()
}

/// One close without any wire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FastClose {
    /// The largest true force, g.
    pub(crate) peak_g: f64,
    /// From the command to the stop, s.
    pub(crate) close_s: f64,
    /// The true force held in the end, g.
    pub(crate) hold_g: f64,
    /// The object broke.
    pub(crate) is_broken: bool,
}

/// Closes `joint` `count` times, about 3000 a second.
pub(crate) fn fast_closes(
    seed: u32,
    joint: &str,
    count: u32,
    keys: &[&str],
) -> Option<Vec<FastClose>> {
    let mut command = Command::new(program()?);
    command.args(["0", &seed.to_string()]).args(keys);
    command.args([format!("fast={joint}"), format!("fn={count}")]);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let closes = text.lines().map(|line| {
        let row: Vec<f64> = line
            .split(' ')
            .map(|value| value.parse().unwrap())
            .collect();
        FastClose {
            peak_g: row[0],
            close_s: row[1],
            hold_g: row[2],
            is_broken: row[3] > 0.0,
        }
    });
    Some(closes.collect())
}
