//! The programs of a session: a simulated hand in a process of its own, and the window in another. Claims nothing.

use crate::setup::process::{Running, handscope, listen, run, sim_on_tcp};
use handscope::hand::Dof;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const WITHIN: Duration = Duration::from_secs(20);
const SOON: Duration = Duration::from_secs(3);
const AGAIN: Duration = Duration::from_millis(50);
/// Feedback lies this much beside the setpoint of a joint that rests.
pub(crate) const REST: u16 = 20;

/// A simulated hand on a loopback socket. Dropping it ends it.
pub(crate) struct Hand {
    _process: Running,
    pub(crate) endpoint: String,
}

impl Hand {
    pub(crate) fn start() -> Self {
        let (process, endpoint) = sim_on_tcp(&["--scenario", "idle"]);
        Self {
            _process: process,
            endpoint,
        }
    }

    /// Six values of a register, read by a program of its own.
    pub(crate) fn read(&self, name: &str) -> Vec<i16> {
        let read = run(&["read", name, "--json", "--hand", &self.endpoint]).ok();
        let read = read.lines().remove(0);
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

    /// The setpoints, if this joint's comes to lie in this range soon.
    pub(crate) fn is_soon_set_to(&self, dof: Dof, range: &RangeInclusive<i16>) -> Option<Vec<i16>> {
        let there = |values: &[i16]| range.contains(&values[dof.index()]);
        self.read_within(SOON, "ANGLE_SET", there).ok()
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

/// The real window, with settings of its own. Dropping it ends it.
pub(crate) struct Window {
    process: Running,
    home: TempDir,
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
        Self::start_in(&hidden, display, hand, &["--opengl"])
    }

    /// An exhibition of this file.
    pub(crate) fn exhibit(display: &str, hand: &Hand, file: &Path) -> Self {
        let mut command = handscope();
        command.arg("exhibit").arg(file);
        command.args(["--hand", &hand.endpoint]);
        Self::start_command(command, &[], display)
    }

    fn start_in(around: &[(&str, &str)], display: &str, hand: &Hand, more: &[&str]) -> Self {
        let mut command = handscope();
        // The twin records nothing either.
        command.args(["--hand", &hand.endpoint, "--no-record"]);
        command.args(more);
        Self::start_command(command, around, display)
    }

    fn start_command(mut command: Command, around: &[(&str, &str)], display: &str) -> Self {
        let home = tempfile::tempdir().unwrap();
        command
            .env("DISPLAY", display)
            .envs(around.iter().copied())
            .env("HOME", home.path())
            .env("XDG_CONFIG_HOME", home.path())
            .env("HANDSCOPE_DOCUMENTS", home.path());
        let process = listen(command);
        Self { process, home }
    }

    /// The first file that it saves in the folder of the day, with what is in it.
    pub(crate) fn saves(&self) -> (PathBuf, String) {
        let begun = Instant::now();
        loop {
            let days = std::fs::read_dir(self.home.path().join("Handscope"));
            let days = days.into_iter().flatten().flatten();
            let files = days.flat_map(|day| std::fs::read_dir(day.path()).into_iter().flatten());
            if let Some(file) = files.flatten().next() {
                let text = std::fs::read_to_string(file.path()).unwrap();
                return (file.path(), text);
            }
            assert!(begun.elapsed() < WITHIN, "nothing was saved");
            sleep(AGAIN);
        }
    }

    /// What it was started with, also if it started itself anew.
    pub(crate) fn arguments(&self) -> String {
        let file = format!("/proc/{}/cmdline", self.process.id());
        std::fs::read_to_string(file).unwrap().replace('\0', " ")
    }

    /// Waits for its end, which must be without complaint.
    pub(crate) fn ends_well(self) {
        self.process.end().ok();
    }
}
