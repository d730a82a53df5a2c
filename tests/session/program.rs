//! The programs of a session: a simulated hand in a process of its own, and the window in another. Claims nothing.

use handscope::hand::Dof;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const WITHIN: Duration = Duration::from_secs(20);
const SOON: Duration = Duration::from_secs(3);
const AGAIN: Duration = Duration::from_millis(50);
/// Feedback lies this much beside the setpoint of a joint that rests.
pub(crate) const REST: u16 = 20;

fn handscope() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_handscope"));
    command.stdin(Stdio::null());
    command
}

/// A simulated hand on a loopback socket. Dropping it ends it.
pub(crate) struct Hand {
    process: Child,
    pub(crate) endpoint: String,
}

impl Hand {
    pub(crate) fn start() -> Self {
        let mut process = handscope()
            .args(["sim", "--tcp", "127.0.0.1:0", "--scenario", "idle"])
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut ready = String::new();
        let out = process.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut ready).unwrap();
        let address = ready.trim().strip_prefix("ready tcp ").unwrap();
        let endpoint = format!("tcp:{address}");
        Self { process, endpoint }
    }

    /// Six values of a register, read by a program of its own.
    pub(crate) fn read(&self, name: &str) -> Vec<i16> {
        let done = handscope()
            .args(["read", name, "--json", "--hand", &self.endpoint])
            .output()
            .unwrap();
        let read: Value = serde_json::from_slice(&done.stdout).unwrap();
        let values = read[name].as_array().unwrap().iter();
        values
            .map(|value| i16::try_from(value.as_i64().unwrap()).unwrap())
            .collect()
    }

    fn read_until(&self, name: &str, wanted: impl Fn(&[i16]) -> bool) -> Vec<i16> {
        self.read_within(WITHIN, name, wanted)
            .unwrap_or_else(|values| panic!("{name}: {values:?}"))
    }

    /// The values as soon as they are as wanted; as they are when the time is over, as an error.
    fn read_within(
        &self,
        time: Duration,
        name: &str,
        wanted: impl Fn(&[i16]) -> bool,
    ) -> Result<Vec<i16>, Vec<i16>> {
        let begun = Instant::now();
        loop {
            let values = self.read(name);
            if wanted(&values) {
                return Ok(values);
            }
            if begun.elapsed() > time {
                return Err(values);
            }
            sleep(AGAIN);
        }
    }

    /// The setpoints, if this joint's comes down to `most` soon.
    pub(crate) fn is_soon_set_to(&self, dof: Dof, most: i16) -> Option<Vec<i16>> {
        let down = |values: &[i16]| (0..=most).contains(&values[dof.index()]);
        self.read_within(SOON, "ANGLE_SET", down).ok()
    }

    /// Waits until this joint's value has come down to `most`.
    pub(crate) fn reads_at_most(&self, name: &str, dof: Dof, most: i16) -> Vec<i16> {
        self.read_until(name, |values| values[dof.index()] <= most)
    }

    /// Waits until all setpoints are where the joints are; the setpoints.
    pub(crate) fn rests_where_it_stands(&self) -> Vec<i16> {
        self.read_until("ANGLE_SET", |set| {
            let actual = self.read("ANGLE_ACT");
            let mut pairs = set.iter().zip(&actual);
            pairs.all(|(set, actual)| set.abs_diff(*actual) <= REST)
        })
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        let _gone = self.process.kill();
        let _ended = self.process.wait();
    }
}

/// The real window, with settings of its own. Dropping it ends it.
pub(crate) struct Window {
    process: Child,
    _home: TempDir,
}

impl Window {
    pub(crate) fn start(display: &str, hand: &Hand, more: &[&str]) -> Self {
        Self::start_in(&[], display, hand, more)
    }

    /// On a system whose drivers for OpenGL are out of reach.
    pub(crate) fn start_without_drivers(display: &str, hand: &Hand) -> Self {
        let hidden = [
            ("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null"),
            ("LIBGL_DRIVERS_PATH", "/nowhere"),
        ];
        Self::start_in(&hidden, display, hand, &[])
    }

    fn start_in(around: &[(&str, &str)], display: &str, hand: &Hand, more: &[&str]) -> Self {
        let home = tempfile::tempdir().unwrap();
        let process = handscope()
            .args(["--hand", &hand.endpoint])
            .args(more)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("DISPLAY", display)
            .envs(around.iter().copied())
            .env("HOME", home.path())
            .env("XDG_CONFIG_HOME", home.path())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Self {
            process,
            _home: home,
        }
    }

    /// What it was started with, also if it started itself anew.
    pub(crate) fn arguments(&self) -> String {
        let file = format!("/proc/{}/cmdline", self.process.id());
        std::fs::read_to_string(file).unwrap().replace('\0', " ")
    }

    /// Waits for its end, which must be without complaint.
    pub(crate) fn ends_well(&mut self) {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = self.process.try_wait().unwrap() {
                break status;
            }
            assert!(begun.elapsed() < WITHIN, "the window does not close");
            sleep(AGAIN);
        };
        let mut said = String::new();
        let mut err = self.process.stderr.take().unwrap();
        err.read_to_string(&mut said).unwrap();
        assert!(status.success(), "{status}: {said}");
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        let _gone = self.process.kill();
        let _ended = self.process.wait();
    }
}
