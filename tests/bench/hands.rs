//! Eight hands in one window, each over TCP, in real time: what all threads of the program take of a core, and one frame. The hands
//! are served by this process; the program is measured in one of its own.

use crate::clock::{Sorted, wall_and_cpu_ms};
use crate::cycles::{Server, count};
use crate::report::{Aim, Failure, Report, line};
use crate::scene::{Scene, Time};
use handscope::transport::Endpoint;
use std::process::Command;
use std::time::{Duration, Instant};

/// The word that makes this program the measured one; the endpoints come after it.
pub(crate) const CHILD: &str = "--eight-hands";
/// Hands in the window.
const HANDS: usize = 8;
/// How long is counted.
const LENGTH: Duration = Duration::from_secs(10);
/// Until all links are steady.
const WARM: Duration = Duration::from_secs(5);
/// Frames that are drawn one right after another, as those of the part `ui` are.
const WARM_FRAMES: usize = 1000;
/// As the window: a frame comes this often in any case.
const AT_LEAST: Duration = Duration::from_millis(250);
/// What the threads may take together, and a frame: 99 of 100.
const AIM_CPU: f64 = 60.0;
const AIM_FRAME_MS: f64 = 4.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let servers: Vec<Server> = (0..HANDS)
        .map(|_| Server::tcp())
        .collect::<Result<_, _>>()?;
    let endpoints = servers.iter().map(|server| server.endpoint.to_string());
    let mut child = Command::new(std::env::current_exe()?);
    let output = child.arg(CHILD).args(endpoints).output()?;
    let text = String::from_utf8(output.stdout)?;
    let figures: Vec<f64> = text
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let [one, all] = figures.as_chunks::<9>().0 else {
        return Err("the measured process said nothing".into());
    };
    for (what, [rate, cpu, median, slow, warm, slow_warm, parts @ ..]) in [
        (
            "eight hands over tcp, one shown: states a second of each",
            one,
        ),
        ("the same, all side by side", all),
    ] {
        // Counted to the reading before the last frame, of 100 asked for.
        report.row(what, *rate, "1/s", Aim::AtLeast(98.0))?;
        report.row("  CPU of all threads", *cpu, "% core", Aim::AtMost(AIM_CPU))?;
        report.row("  window frame, median", *median, "ms cpu", Aim::None)?;
        let aim = Aim::AtMost(AIM_FRAME_MS);
        report.row("  99 of 100, after pauses", *slow, "ms cpu", aim)?;
        let what = "  frames one right after another, median";
        report.row(what, *warm, "ms cpu", Aim::None)?;
        let aim = Aim::AtMost(AIM_FRAME_MS);
        report.row("  99 of 100", *slow_warm, "ms cpu", aim)?;
        for (part, median) in ["  logic", "  layout", "  triangles"].iter().zip(parts) {
            report.row(part, *median, "ms cpu", Aim::None)?;
        }
    }
    Ok(())
}

/// Shows the hands, and says for one shown and for all side by side: states a second of the slowest, percent of a core, and
/// milliseconds of a frame: the middle one, 99 of 100, both also without pauses, and the middle ones of its parts.
pub(crate) fn child(endpoints: &[String]) -> Result<(), Failure> {
    let mut endpoints = endpoints.iter().map(|text| text.parse::<Endpoint>());
    let first = endpoints.next().ok_or("no hand")??;
    let mut scene = Scene::open(Time::Real, first)?;
    scene.open_beside(endpoints.collect::<Result<_, _>>()?);
    let mut words = Vec::new();
    for shows_all in [false, true] {
        if shows_all {
            scene.show_all_hands();
        }
        draw(&mut scene, WARM);
        let before = reads(&scene);
        let ([wall, cpu], frames) = wall_and_cpu_ms(|| draw(&mut scene, LENGTH));
        let after = reads(&scene);
        let rates = before
            .iter()
            .zip(&after)
            .map(|(before, after)| after - before);
        let rate = rates.fold(f64::INFINITY, f64::min) / wall * 1000.0;
        let parts: [fn(&[f64; 3]) -> f64; 4] = [
            |frame| frame.iter().sum(),
            |[logic, _, _]| *logic,
            |[_, layout, _]| *layout,
            |[_, _, triangles]| *triangles,
        ];
        let parts = parts.map(|part| Sorted::new(frames.iter().map(part).collect()));
        let slow = parts[0].percentile(99);
        let [median, logic, layout, triangles] = parts.map(|part| part.median());
        let cpu = cpu / wall * 100.0;
        let warm = (0..WARM_FRAMES).map(|_| scene.frame().iter().sum());
        let warm = Sorted::new(warm.collect());
        let (warm, slow_warm) = (warm.median(), warm.percentile(99));
        words.push(format!(
            "{rate} {cpu} {median} {slow} {warm} {slow_warm} {logic} {layout} {triangles}"
        ));
    }
    line(&words.join(" "))
}

fn reads(scene: &Scene) -> Vec<f64> {
    let hands = scene.state().hands.iter();
    hands
        .map(|hand| count(hand.connection.stats.state_reads))
        .collect()
}

/// Draws as the window does; processor milliseconds of each frame's parts.
fn draw(scene: &mut Scene, length: Duration) -> Vec<[f64; 3]> {
    let begun = Instant::now();
    let mut frames = Vec::new();
    while begun.elapsed() < length {
        scene.wait(AT_LEAST);
        scene.pass(scene.frame_within());
        frames.push(scene.frame());
    }
    frames
}
