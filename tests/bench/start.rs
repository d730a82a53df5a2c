//! From the start of the program to the first frame that shows live values, in real time.

use crate::clock::{Sorted, millis};
use crate::report::{Aim, Failure, Report};
use crate::scene::{Scene, Time};
use handscope::hand::Finger;
use std::time::{Duration, Instant};

/// Starts of one figure.
const STARTS: usize = 7;
/// Between two frames, as a display of 60 Hz gives them.
const FRAME_EACH: Duration = Duration::from_millis(16);
/// A hand that is not live by then will not be.
const LIVE_WITHIN: Duration = Duration::from_secs(10);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let mut first = Vec::with_capacity(STARTS);
    let mut live = Vec::with_capacity(STARTS);
    for _ in 0..STARTS {
        let (a, b) = once()?;
        first.push(millis(a));
        live.push(millis(b));
    }
    report.row(
        "start to first frame, without the window system, median",
        Sorted::new(first).median(),
        "ms",
        Aim::AtMost(400.0),
    )?;
    report.row(
        "  to the first frame with live values, median",
        Sorted::new(live).median(),
        "ms",
        Aim::AtMost(1000.0),
    )
}

/// Time to the first frame at all, and to the first with a live pose and touch.
fn once() -> Result<(Duration, Duration), Failure> {
    let begun = Instant::now();
    let mut scene = Scene::start(Time::Real)?;
    std::hint::black_box(scene.frame());
    let first = begun.elapsed();
    while begun.elapsed() < LIVE_WITHIN {
        // The frame that is drawn now shows what its own logic took in.
        std::hint::black_box(scene.frame());
        let state = scene.state();
        let touched = Finger::ALL
            .iter()
            .all(|finger| state.hand().readings.sample.tactile[*finger].is_some());
        if state.hand().connection.status.state.is_live()
            && state.hand().readings.sample.angle.is_some()
            && touched
        {
            return Ok((first, begun.elapsed()));
        }
        scene.pass(FRAME_EACH);
    }
    Err("the built-in hand does not become live".into())
}
