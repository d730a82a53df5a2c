//! The real program as a process: runs it to its end, or keeps a simulated hand running beside a test. Claims nothing.

use crate::setup::shape::check_shape;
#[cfg(unix)]
use nix::sys::signal::{Signal, kill};
#[cfg(unix)]
use nix::unistd::Pid;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Longer than anything here takes on a slow machine that does other work as well: only a program that hangs takes longer.
const PATIENCE: Duration = Duration::from_secs(180);

/// How a run ended.
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
    pub(crate) took: Duration,
    /// Our command that it was, if it was one.
    json_of: Option<String>,
}

impl Ended {
    /// Every line of standard output as JSON, which has the shape that is documented.
    pub(crate) fn lines(&self) -> Vec<serde_json::Value> {
        let lines: Vec<_> = self
            .out
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        if let Some(command) = self
            .json_of
            .as_ref()
            .filter(|_| matches!(self.code, Some(0 | 1)))
        {
            check_shape(command, &lines);
        }
        lines
    }

    pub(crate) fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{}{}", self.out, self.err);
        self
    }
}

/// Commands that have commands of their own.
const GROUPS: [&str; 1] = ["params"];

/// The name of our command that a process runs.
fn json_of(command: &Command) -> Option<String> {
    let is_ours = command.get_program() == env!("CARGO_BIN_EXE_handscope");
    let args: Vec<&str> = command.get_args().filter_map(OsStr::to_str).collect();
    let (name, more) = args.split_first()?;
    if !is_ours || name.starts_with('-') {
        return None;
    }
    if !GROUPS.contains(name) {
        return Some((*name).to_owned());
    }
    let own = more.iter().find(|arg| !arg.starts_with('-'))?;
    Some(format!("{name}-{own}"))
}

/// The program as for a user of its own, of whom nothing is kept yet.
pub(crate) fn handscope() -> Command {
    static USERS: AtomicU32 = AtomicU32::new(0);
    let user = USERS.fetch_add(1, Ordering::Relaxed);
    let home = format!("home-{}-{user}", std::process::id());
    let mut command = Command::new(env!("CARGO_BIN_EXE_handscope"));
    command.env("HOME", Path::new(env!("CARGO_TARGET_TMPDIR")).join(home));
    command.env_remove("XDG_CONFIG_HOME");
    // Without a display, unless a test gives it one.
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(display);
    }
    command.stdin(Stdio::null());
    command
}

/// Runs the program to its end.
pub(crate) fn run(args: &[&str]) -> Ended {
    start(args).end()
}

/// Starts the program and listens to both its outputs.
pub(crate) fn start(args: &[&str]) -> Running {
    let mut command = handscope();
    command.args(args);
    listen(command)
}

/// Starts a command and listens to both its outputs.
pub(crate) fn listen(mut command: Command) -> Running {
    let begun = Instant::now();
    let json_of = json_of(&command);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let out = lines_of(child.stdout.take().unwrap());
    let err = lines_of(child.stderr.take().unwrap());
    Running {
        child,
        out,
        err,
        begun,
        heard: String::new(),
        json_of,
    }
}

fn lines_of(from: impl Read + Send + 'static) -> Receiver<String> {
    let (tell, hear) = channel();
    thread::spawn(move || {
        for line in BufReader::new(from).lines() {
            let Ok(line) = line else { break };
            if tell.send(line).is_err() {
                break;
            }
        }
    });
    hear
}

/// A program that runs. Dropping it kills it.
pub(crate) struct Running {
    child: Child,
    out: Receiver<String>,
    err: Receiver<String>,
    begun: Instant,
    heard: String,
    json_of: Option<String>,
}

impl Running {
    /// The next line of standard output.
    pub(crate) fn line(&mut self) -> String {
        let line = self.out.recv_timeout(PATIENCE).expect("a line comes");
        self.heard.push_str(&line);
        self.heard.push('\n');
        line
    }

    /// The next line of standard error.
    pub(crate) fn complaint(&mut self) -> String {
        self.err.recv_timeout(PATIENCE).expect("a complaint comes")
    }

    /// Reads standard output until a line is as wanted.
    pub(crate) fn until(&mut self, wanted: impl Fn(&str) -> bool) -> String {
        loop {
            let line = self.line();
            if wanted(&line) {
                return line;
            }
        }
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    #[cfg(unix)]
    pub(crate) fn signal(&self, signal: Signal) {
        let id = i32::try_from(self.child.id()).unwrap();
        kill(Pid::from_raw(id), signal).unwrap();
    }

    pub(crate) fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// Waits for the end and takes all that was said.
    pub(crate) fn end(self) -> Ended {
        self.end_within(PATIENCE)
    }

    /// The same for a program that computes for long.
    pub(crate) fn end_within(mut self, patience: Duration) -> Ended {
        let until = Instant::now() + patience;
        let status = loop {
            // The pipes are read by threads, so a program that says much can end.
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(Instant::now() < until, "the program does not end");
            thread::sleep(Duration::from_millis(5));
        };
        let took = self.begun.elapsed();
        let mut out = std::mem::take(&mut self.heard);
        for line in self.out.iter() {
            out.push_str(&line);
            out.push('\n');
        }
        let err: Vec<String> = self.err.iter().collect();
        Ended {
            code: status.code(),
            out,
            err: err.join("\n"),
            took,
            json_of: self.json_of.take(),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _gone = self.child.kill();
        let _ended = self.child.wait();
    }
}

/// A simulated hand on TCP, with its endpoint.
pub(crate) fn sim_on_tcp(more: &[&str]) -> (Running, String) {
    let mut sim = start(&[&["sim", "--tcp", "127.0.0.1:0"], more].concat());
    let ready = sim.line();
    let address = ready.strip_prefix("ready tcp ").expect(&ready);
    let endpoint = format!("tcp:{address}");
    (sim, endpoint)
}

/// A simulated hand on a pseudo-terminal linked at `link`, with its endpoint.
#[cfg(unix)]
pub(crate) fn sim_on_link(link: &Path, more: &[&str]) -> (Running, String) {
    sim_on("rs485", link, more)
}

/// The same in Modbus RTU.
#[cfg(unix)]
pub(crate) fn sim_on_rtu(link: &Path, more: &[&str]) -> (Running, String) {
    sim_on("rtu", link, more)
}

#[cfg(unix)]
fn sim_on(kind: &str, link: &Path, more: &[&str]) -> (Running, String) {
    let (link, option) = (link.to_str().unwrap(), format!("--{kind}"));
    let mut sim = start(&[&["sim", &option, link], more].concat());
    assert_eq!(sim.line(), format!("ready {kind} {link}"));
    (sim, format!("{kind}:{link}"))
}

/// Endpoints of what one process serves on every wire of a system that has no CAN.
#[cfg(unix)]
#[derive(Debug)]
pub(crate) struct Wires {
    pub(crate) tcp: String,
    pub(crate) rs485: String,
    pub(crate) rtu: String,
    pub(crate) slcan: String,
}

#[cfg(unix)]
impl Wires {
    pub(crate) fn all(&self) -> [&str; 4] {
        [&self.tcp, &self.rs485, &self.rtu, &self.slcan]
    }
}

/// Simulated hands on every wire of a system that has no CAN.
#[cfg(unix)]
pub(crate) fn sim_on_all(folder: &Path, more: &[&str]) -> (Running, Wires) {
    let link = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (rs485, rtu, slcan) = (link("rs485"), link("rtu"), link("slcan"));
    let links = ["--rs485", &rs485, "--rtu", &rtu, "--slcan", &slcan];
    let (mut sim, tcp) = sim_on_tcp(&[&links, more].concat());
    for _ in links.chunks(2) {
        assert!(sim.line().starts_with("ready "));
    }
    let wires = Wires {
        tcp,
        rs485: format!("rs485:{rs485}"),
        rtu: format!("rtu:{rtu}"),
        slcan: format!("slcan:{slcan}"),
    };
    (sim, wires)
}

/// The output pipe, for tests that close it.
pub(crate) fn take_pipe(args: &[&str]) -> (Child, ChildStdout) {
    let mut command = handscope();
    command
        .args(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let out = child.stdout.take().unwrap();
    (child, out)
}
