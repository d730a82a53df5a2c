//! What the program costs while nobody touches it, in real time: frames and processor, drawn as the window draws them.
//! The graphics driver's share is not in it.

use crate::clock::{page_faults, wall_and_cpu_ms};
use crate::cycles::count;
use crate::report::{Aim, Failure, Report};
use crate::scene::{Scene, Time};
use handscope::transport::Endpoint;
use std::time::{Duration, Instant};

/// How long is counted.
const LENGTH: Duration = Duration::from_secs(10);
/// Until the link is steady, or gone.
const WARM: Duration = Duration::from_secs(2);
/// As the window: a frame comes this often in any case.
const AT_LEAST: Duration = Duration::from_millis(250);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let hand = Endpoint::Sim {
        seed: 1,
        scenario: "idle".into(),
        body: None,
        object: None,
    };
    let mut scene = Scene::open(Time::Real, hand)?;
    rest(&mut scene, WARM);
    let before = scene.state().hand().connection.stats.state_reads;
    let [frames, cpu, faults] = measure(&mut scene);
    let data =
        count(scene.state().hand().connection.stats.state_reads - before) / LENGTH.as_secs_f64();
    report.row("states a second, live link at rest", data, "1/s", Aim::None)?;
    report.row("  frames a second", frames, "1/s", Aim::AtMost(data))?;
    report.row("  CPU of all threads", cpu, "% core", Aim::AtMost(4.0))?;
    report.row("  page faults a frame", faults, "", Aim::AtMost(10.0))?;
    scene.paint();
    let [frames, cpu, _] = measure(&mut scene);
    report.row(
        "the same with 1920x1080 pixels drawn by this program",
        frames,
        "1/s",
        Aim::None,
    )?;
    report.row("  CPU of all threads", cpu, "% core", Aim::AtMost(12.0))?;
    scene.paint_not();
    scene.disconnect();
    rest(&mut scene, WARM);
    let [frames, cpu, _] = measure(&mut scene);
    report.row("frames a second without a link", frames, "1/s", Aim::None)?;
    report.row("  CPU of all threads", cpu, "% core", Aim::AtMost(1.0))
}

/// Frames a second, percent of a core, and page faults a frame.
fn measure(scene: &mut Scene) -> [f64; 3] {
    let faults_before = page_faults();
    let ([wall, cpu], frames) = wall_and_cpu_ms(|| rest(scene, LENGTH));
    let faults = count(page_faults() - faults_before) / count(frames);
    [count(frames) / wall * 1000.0, cpu / wall * 100.0, faults]
}

/// Draws as the window does; how many frames.
fn rest(scene: &mut Scene, length: Duration) -> u64 {
    let begun = Instant::now();
    let mut frames = 0;
    while begun.elapsed() < length {
        scene.wait(AT_LEAST);
        scene.pass(scene.frame_within());
        std::hint::black_box(scene.frame());
        frames += 1;
    }
    frames
}
