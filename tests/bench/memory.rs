//! Memory of the whole program after an hour, in a process of its own. A graphics driver's share is not in it.

use crate::report::{Aim, Failure, Report, line};
use crate::scene::{Scene, Time};
use handscope::app::settings::PlotWindow;
use std::process::Command;
use std::time::Duration;

/// The word that makes this program the measured one.
pub(crate) const CHILD: &str = "--one-hour";
/// Simulated minutes.
const MINUTES: u32 = 60;
/// Frames drawn a simulated minute, so that all that a window keeps is there.
const FRAMES: u32 = 60;
/// 300 MB.
const AIM_MIB: f64 = 286.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let what = "memory in use after an hour of simulated time";
    if !cfg!(target_os = "linux") {
        return report.absent(what, "read from /proc, Linux only");
    }
    let output = Command::new(std::env::current_exe()?).arg(CHILD).output()?;
    let text = String::from_utf8(output.stdout)?;
    let mut words = text.split_whitespace().map(str::parse::<f64>);
    let mut next = || words.next().ok_or("the measured process said nothing");
    let (now, most) = (next()??, next()??);
    report.row(what, now, "MiB", Aim::AtMost(AIM_MIB))?;
    report.row("  at most on the way", most, "MiB", Aim::AtMost(AIM_MIB))
}

/// Lives an hour, then says how much memory that took: now and at most, in MiB.
pub(crate) fn child() -> Result<(), Failure> {
    let mut scene = Scene::start(Time::Virtual)?;
    scene.plot(PlotWindow::H1);
    for _ in 0..MINUTES * FRAMES {
        scene.run(Duration::from_secs(60) / FRAMES);
        std::hint::black_box(scene.frame());
    }
    line(&format!("{} {}", mib("VmRSS:")?, mib("VmHWM:")?))
}

/// One line of this process's status, in MiB.
pub(crate) fn mib(key: &str) -> Result<f64, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let value = status
        .lines()
        .find_map(|line| line.strip_prefix(key))
        .and_then(|rest| rest.split_whitespace().next())
        .ok_or("no such line in /proc/self/status")?;
    Ok(value.parse::<f64>()? / 1024.0)
}
