//! From a press of the mouse to its pixels, where this program draws them: a press waits for the frame that is being drawn.

use crate::report::{Aim, Failure, Report};
use crate::scene::{Scene, Time};
use egui::pos2;
use std::time::{Duration, Instant};

/// Presses that are measured.
const PRESSES: usize = 200;
/// Frames come this often while a hand moves.
const FRAME_EACH: Duration = Duration::from_millis(16);
/// Until the link is steady.
const WARM: Duration = Duration::from_secs(2);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let mut scene = Scene::start(Time::Real)?;
    scene.run(WARM);
    scene.paint();
    for _ in 0..10 {
        scene.frame();
    }
    let mut random = fastrand::Rng::with_seed(1);
    let mut waited: Vec<f64> = (0..PRESSES)
        .map(|number| {
            let frame = Instant::now();
            scene.frame();
            let pressed = FRAME_EACH.mul_f64(random.f64());
            std::thread::sleep(pressed.saturating_sub(frame.elapsed()));
            // Along the tracks of the joints, where each press shows something.
            let y = 150.0 + 500.0 * random.f32();
            scene.press(pos2(random.f32() * 300.0, y), number % 2 == 0);
            scene.frame();
            (frame.elapsed() - pressed).as_secs_f64() * 1000.0
        })
        .collect();
    waited.sort_by(f64::total_cmp);
    let at = |share: usize| waited.get(PRESSES * share / 100).copied();
    let missing = || Failure::from("no press was measured");
    let median = at(50).ok_or_else(missing)?;
    let tail = at(95).ok_or_else(missing)?;
    let name = "press to pixels of 1920x1080, drawn by this program, median";
    report.row(name, median, "ms", Aim::None)?;
    report.row("  95 of 100", tail, "ms", Aim::AtMost(60.0))
}
