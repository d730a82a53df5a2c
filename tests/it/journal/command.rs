//! The command line in front of a line: the real program as a process, over pseudo-terminals and loopback, in real time.

use crate::journal::line::{Line, named};
use crate::journal::page::{Case, Outcome, masked, write_file};
use handscope::transport::{Endpoint, PtyLink};
use nix::fcntl::OFlag;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs::OpenOptions;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use std::thread;
use std::time::Duration;
use tempfile::TempDir;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

/// The program with a hand at the other end of one wire.
struct Bench<'a> {
    case: &'a Case,
    wire: &'a str,
    line: Arc<Line>,
    /// Where it is: the hand without an id, and its port or address alone.
    hand: String,
    place: String,
    folder: TempDir,
    _runtime: Runtime,
}

/// Runs a case on one wire.
pub(crate) fn run(case: &Case, wire: &str) -> Vec<Outcome> {
    let bench = Bench::new(case, wire);
    let mut when = Vec::new();
    let steps = case.steps().map(|step| {
        let words: Vec<&str> = step.split(' ').collect();
        let mut outcome = Outcome::default();
        match words[0] {
            "file" => write_file(bench.folder.path(), &words[1..]),
            "hand" => bench.line.event(&words[1..]),
            "wait" => thread::sleep(Duration::from_millis(words[1].parse().unwrap())),
            "when" => when = words[1..].to_vec(),
            "$" => outcome.said = bench.command(&words[1..], &std::mem::take(&mut when)),
            other => panic!("no step: {other}"),
        }
        outcome.passed = case.lines(&bench.line.take());
        outcome
    });
    steps.collect()
}

impl<'a> Bench<'a> {
    fn new(case: &'a Case, wire: &'a str) -> Self {
        let mut runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = runtime.worker_threads(1).enable_all().build().unwrap();
        let inside = runtime.enter();
        let line = Line::new(&case.ids, case.config, &case.upsets);
        let folder = TempDir::new().unwrap();
        let place = match wire {
            "tcp" => serve_tcp(&runtime, &line),
            _ => serve_port(&line, wire, &folder.path().join("hand")),
        };
        drop(inside);
        let hand = format!("{wire}:{place}");
        Self {
            case,
            wire,
            line,
            hand,
            place,
            folder,
            _runtime: runtime,
        }
    }

    /// Runs one command to its end; what it says.
    fn command(&self, words: &[&str], when: &[&str]) -> Vec<String> {
        let mut args: Vec<String> = words.iter().map(|word| self.word(word)).collect();
        if !args.iter().any(|arg| arg.contains(&self.place)) {
            args.extend(["--hand".into(), self.hand.clone()]);
        }
        if words[0] == "params" {
            args.extend(["--folder".into(), self.word("records/")]);
        }
        let mut command = Command::new(env!("CARGO_BIN_EXE_handscope"));
        for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(display);
        }
        command
            .args(&args)
            .env("HOME", self.folder.path())
            .stdin(Stdio::null());
        let child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let ended = self.end(child, when);
        // What was on its way when the program hung up.
        thread::sleep(Duration::from_millis(20));
        let mut said = vec![format!("exit {}", ended.status.code().unwrap())];
        for (name, bytes) in [("out", ended.stdout), ("err", ended.stderr)] {
            let text = self.masked(&String::from_utf8(bytes).unwrap());
            said.extend(text.lines().map(|line| format!("{name} {line}")));
        }
        let out = args.iter().position(|arg| arg == "--out");
        let written = out.map(|at| self.masked(&written(Path::new(&args[at + 1]))));
        said.extend(
            written
                .unwrap_or_default()
                .lines()
                .map(|line| format!("file {line}")),
        );
        said
    }

    /// Waits for the end; before it, does to the hand or the program what is to be done once a joint is bent so far.
    fn end(&self, child: Child, when: &[&str]) -> Output {
        let id = Pid::from_raw(child.id().try_into().unwrap());
        let ended = thread::spawn(|| child.wait_with_output().unwrap());
        if let [dof, angle, event @ ..] = when {
            let (dof, angle) = (named(dof), angle.parse().unwrap());
            while self.line.angle(dof) > angle && !ended.is_finished() {
                thread::sleep(Duration::from_millis(2));
            }
            match event {
                // One that ended by itself is told by what it says.
                ["INT"] if ended.is_finished() => {}
                ["INT"] => drop(kill(id, Signal::SIGINT)),
                _ => self.line.event(event),
            }
        }
        ended.join().unwrap()
    }

    /// `@?id=9` is the hand with that, `@` its port or address alone; files and folders are those of the test.
    fn word(&self, word: &str) -> String {
        let path = self.folder.path().join(word);
        match word.strip_prefix('@') {
            Some("") => self.place.clone(),
            Some(more) => format!("{}{more}", self.hand),
            None if word.ends_with(".toml") || word.ends_with('/') => path.to_str().unwrap().into(),
            None => word.to_owned(),
        }
    }

    fn masked(&self, text: &str) -> String {
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '.';
        let plain = self.place.replace(|letter| !is_plain(letter), "_");
        let names = [
            (&*self.hand.parse::<Endpoint>().unwrap().to_string(), "HAND"),
            (&self.hand, "HAND"),
            (&self.place, "PLACE"),
            (&format!("{}_{plain}", self.wire), "RECORD"),
            (self.folder.path().to_str().unwrap(), "DIR"),
            // What a hand is called by on each wire.
            ("?baud=115200&id=", "?id="),
            ("?bitrate=1000000&id=", "?id="),
            ("_baud_115200-id", "-id"),
            ("_bitrate_1000000-id", "-id"),
        ];
        masked(text, &names, &self.case.hides)
    }
}

/// A file, or the names in a folder.
fn written(path: &Path) -> String {
    let Ok(entries) = std::fs::read_dir(path) else {
        return std::fs::read_to_string(path).unwrap_or_default();
    };
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names.join("\n")
}

/// Answers on a port of its own; the address.
fn serve_tcp(runtime: &Runtime, line: &Arc<Line>) -> String {
    let listener = runtime.block_on(TcpListener::bind("127.0.0.1:0")).unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let (line, place) = (
        Arc::clone(line),
        format!("tcp:{address}").parse::<Endpoint>(),
    );
    tokio::spawn(async move {
        while let Ok((stream, _)) = listener.accept().await {
            stream.set_nodelay(true).unwrap();
            tokio::spawn(Arc::clone(&line).carry(place.clone().unwrap(), stream, || true));
        }
    });
    address
}

/// Answers on a pseudo-terminal behind this link, to who has set the speed that the hand has; the link.
fn serve_port(line: &Arc<Line>, wire: &str, link: &Path) -> String {
    let (near, place) = (
        PtyLink::create(link).unwrap(),
        link.to_str().unwrap().to_owned(),
    );
    let mut options = OpenOptions::new();
    let options = options
        .read(true)
        .custom_flags((OFlag::O_NOCTTY | OFlag::O_NONBLOCK).bits());
    let settings = options.open(near.slave_path()).unwrap();
    let (is_can, heard_by) = (wire == "slcan", Arc::clone(line));
    let is_heard = move || {
        let set = rustix::termios::tcgetattr(&settings).unwrap();
        is_can || heard_by.is_heard_at(set.output_speed())
    };
    let endpoint = format!("{wire}:{place}").parse().unwrap();
    tokio::spawn(Arc::clone(line).carry(endpoint, near, is_heard));
    place
}
