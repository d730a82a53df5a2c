//! Processor time of one frame of the whole window: logic, layout and triangles, with a minute and an hour of history, beside
//! a plain drawing of the same lines.

use crate::clock::Sorted;
use crate::cycles::{Server, count};
use crate::plain;
use crate::report::{Aim, Failure, Report};
use crate::scene::{Scene, Time};
use handscope::app::settings::PlotWindow;
use handscope::app::state::State;
use handscope::ui::View;
use std::time::{Duration, Instant};

/// Frames of one figure: eight seconds, one whole grasp of the built-in hand, so that each figure has the same in it.
const FRAMES: usize = 500;
/// Frames before, until layout and caches are settled.
const WARM: usize = 20;
/// A display of 60 Hz.
const FRAME_EACH: Duration = Duration::from_millis(16);
/// What a frame may take: the middle one, and 99 of 100.
const AIM_MS: f64 = 2.5;
const AIM_SLOW_MS: f64 = 4.0;
/// A dead link may cost no more than this, as a part of what a live one costs.
const AIM_DEAD: f64 = 1.1;
/// The same while the hand is recorded.
const AIM_RECORDED: f64 = 1.05;
/// Until a link that is gone is known to be gone.
const DEAD_AFTER: Duration = Duration::from_secs(3);
/// Growth that is still none: what one figure differs from the next anyway.
const SAME: f64 = 1.1;

const WINDOWS: [(PlotWindow, &str); 3] = [
    (PlotWindow::S10, "10 s"),
    (PlotWindow::M1, "1 min"),
    (PlotWindow::H1, "1 h"),
];

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let mut scene = Scene::start(Time::Virtual)?;
    scene.run(Duration::from_secs(60));
    let young = all(report, &mut scene, "1 min")?;
    scene.run(Duration::from_secs(3545));
    let held = scene.state().now.secs()
        - scene
            .state()
            .hand()
            .measured
            .history
            .first_secs()
            .unwrap_or_default();
    report.row("history held by now", held, "s", Aim::AtLeast(3600.0))?;
    let old = all(report, &mut scene, "1 h")?;
    views(report, &mut scene)?;
    growth(report, young, old)?;
    beside(report, scene.state(), old)?;
    recorded(report)?;
    dead(report)
}

/// What frames cost and how fast the link is while the hand is recorded, to the same without; in real time, frame beside frame, as
/// a machine has its moods.
fn recorded(report: &mut Report) -> Result<(), Failure> {
    let servers = [Server::tcp()?, Server::tcp()?];
    let folder = tempfile::tempdir()?;
    let [plain, kept] = &servers;
    let mut scenes = [
        Scene::open(Time::Real, plain.endpoint.clone())?,
        Scene::recorded(kept.endpoint.clone(), folder.path())?,
    ];
    for scene in &mut scenes {
        scene.run(Duration::from_secs(10));
    }
    // What the first did meanwhile is no news any more then.
    for scene in &mut scenes {
        scene.run(FRAME_EACH);
    }
    let reads = |scene: &Scene| {
        let stats = &scene.state().hand().connection.stats;
        count(stats.state_reads + stats.tactile_reads)
    };
    let (before, begun) = (scenes.each_ref().map(reads), Instant::now());
    let mut frames = [const { Vec::new() }; 2];
    for _ in 0..2 * FRAMES {
        for (scene, frames) in scenes.iter_mut().zip(&mut frames) {
            scene.pass(FRAME_EACH);
            frames.push(scene.frame().iter().sum());
        }
    }
    let took = begun.elapsed().as_secs_f64();
    let [_, with] = &scenes;
    if with.state().hand().recording.is_none() {
        return Err("the hand is not recorded".into());
    }
    let [without, with] = frames.map(|frames| Sorted::new(frames).percentile(99));
    let what = "while recording to not: window frame, 99 of 100";
    report.row(what, with / without, "times", Aim::AtMost(AIM_RECORDED))?;
    let [first, second] = scenes.each_ref().map(reads);
    let [first_before, second_before] = before;
    let without = (first - first_before) / took;
    let with = (second - second_before) / took;
    let what = "  readings a second";
    let least = Aim::AtLeast(2.0 - AIM_RECORDED);
    report.row(what, with / without, "times", least)
}

/// The same lines in egui_plot, and the whole window as a part of that.
fn beside(
    report: &mut Report,
    state: &State,
    [ours_10_s, _, ours_1_h]: [f64; 3],
) -> Result<(), Failure> {
    for (seconds, shown, ours) in [(10.0, "10 s", ours_10_s), (3600.0, "1 h", ours_1_h)] {
        let theirs = plain::median_ms(&state.hand().measured.history, seconds, state.now.secs());
        let what = format!("egui_plot alone, the same lines of {shown}: median");
        report.row(&what, theirs, "ms cpu", Aim::None)?;
        let what = format!("  the whole window with plots of {shown} to that");
        report.row(&what, ours / theirs, "times", Aim::None)?;
    }
    Ok(())
}

/// What a frame costs after the hand fell silent, to what it cost before; in real time.
fn dead(report: &mut Report) -> Result<(), Failure> {
    let server = Server::tcp()?;
    let mut scene = Scene::open(Time::Real, server.endpoint.clone())?;
    // Until the plots are full.
    scene.run(Duration::from_secs(10));
    if !scene.state().hand().connection.status.state.is_live() {
        return Err("the served hand does not become live".into());
    }
    let [live, ..] = measure(&mut scene);
    drop(server);
    scene.run(DEAD_AFTER);
    if scene.state().hand().connection.status.state.is_live() {
        return Err("the link lives on without its hand".into());
    }
    let [dead, ..] = measure(&mut scene);
    let times = dead.median() / live.median();
    let what = "window frame, dead link to live link";
    report.row(what, times, "times", Aim::AtMost(AIM_DEAD))
}

/// How the frame grows with the history. Where a minute fills a part of the plots and an hour fills them, the
/// frame must grow; it may not where both fill them.
fn growth(
    report: &mut Report,
    [young_10_s, young_1_min, _]: [f64; 3],
    [old_10_s, old_1_min, old_1_h]: [f64; 3],
) -> Result<(), Failure> {
    for (what, times) in [
        (
            "1 h of history to 1 min, plots of 10 s",
            old_10_s / young_10_s,
        ),
        (
            "1 h of history to 1 min, plots of 1 min",
            old_1_min / young_1_min,
        ),
        ("1 h held and shown to 10 s shown", old_1_h / old_10_s),
    ] {
        report.row(what, times, "times", Aim::AtMost(SAME))?;
    }
    Ok(())
}

/// The other views, with all plots of the first as they were left.
fn views(report: &mut Report, scene: &mut Scene) -> Result<(), Failure> {
    for view in View::ALL {
        if view != View::Live {
            scene.show(view);
            let what = format!("view {}: median", view.name());
            let [whole, ..] = measure(scene);
            let median = whole.median();
            report.row(&what, median, "ms cpu", Aim::AtMost(AIM_MS))?;
        }
    }
    scene.show(View::Live);
    Ok(())
}

/// The medians with each time window of the plots.
fn all(report: &mut Report, scene: &mut Scene, held: &str) -> Result<[f64; 3], Failure> {
    let mut medians = [f64::NAN; 3];
    for (median, (window, shown)) in medians.iter_mut().zip(WINDOWS) {
        scene.plot(window);
        let [whole, logic, layout, triangles] = measure(scene);
        *median = whole.median();
        let what = format!("window frame, {held} of history, plots of {shown}: median");
        report.row(&what, *median, "ms cpu", Aim::AtMost(AIM_MS))?;
        report.row(
            "  99 of 100",
            whole.percentile(99),
            "ms cpu",
            Aim::AtMost(AIM_SLOW_MS),
        )?;
        for (part, figures) in [
            ("  logic", logic),
            ("  layout", layout),
            ("  triangles", triangles),
        ] {
            report.row(part, figures.median(), "ms cpu", Aim::None)?;
        }
    }
    Ok(medians)
}

/// Whole frames, then logic, layout and triangles of them.
fn measure(scene: &mut Scene) -> [Sorted; 4] {
    let mut figures = [const { Vec::new() }; 4];
    for frame in 0..WARM + FRAMES {
        scene.pass(FRAME_EACH);
        let [logic, layout, triangles] = scene.frame();
        if frame >= WARM {
            let taken = [logic + layout + triangles, logic, layout, triangles];
            for (figures, ms) in figures.iter_mut().zip(taken) {
                figures.push(ms);
            }
        }
    }
    figures.map(Sorted::new)
}
