//! The lines of the plots as egui_plot draws them by itself: from the same columns as the window's, borrowed, in bands.

use crate::clock::{Sorted, cpu_ms};
use egui::{Context, RawInput, Rect, pos2, vec2};
use egui_plot::{Line, Plot, PlotPoint, PlotPoints};
use handscope::hand::Dof;
use handscope::hand::Quantity;
use handscope::history::{History, Series, Trace};

/// Frames of one figure; with an hour of history each takes long.
const FRAMES: usize = 15;
/// Frames before.
const WARM: usize = 3;
/// The plots as the window has them.
const WIDTH: f32 = 510.0;
const HEIGHT: f32 = 110.0;
/// Columns of pixels of one of them.
const COLUMNS: usize = 464;
const SHOWN: [&[Quantity]; 4] = [
    &[Quantity::Force],
    &[Quantity::Current],
    &[Quantity::Temperature],
    &[Quantity::TargetAngle, Quantity::Angle],
];

/// Processor milliseconds of one frame with the newest so many seconds of 30 lines.
pub(crate) fn median_ms(history: &History, seconds: f64, to: f64) -> f64 {
    let plots = SHOWN.map(|quantities| lines(history, quantities, (to - seconds, to)));
    let context = Context::default();
    let figures = (0..WARM + FRAMES).map(|_| {
        let (ms, ()) = cpu_ms(|| {
            let mut output = context.run_ui(screen(), |ui| {
                for (n, lines) in plots.iter().enumerate() {
                    Plot::new(n).height(HEIGHT).show(ui, |plot| {
                        for points in lines {
                            plot.line(Line::new("", PlotPoints::Borrowed(points)));
                        }
                    });
                }
            });
            output.textures_delta.clear();
            let meshes = context.tessellate(output.shapes, output.pixels_per_point);
            std::hint::black_box(meshes);
        });
        ms
    });
    Sorted::new(figures.skip(WARM).collect()).median()
}

fn lines(
    history: &History,
    quantities: &[Quantity],
    (from, to): (f64, f64),
) -> Vec<Vec<PlotPoint>> {
    let mut trace = Trace::default();
    let mut all = Vec::new();
    for quantity in quantities {
        for dof in Dof::ALL {
            history.trace(Series::Joint(*quantity, dof), from, to, COLUMNS, &mut trace);
            all.push(trace.points().map(|[x, y]| PlotPoint::new(x, y)).collect());
        }
    }
    all
}

fn screen() -> RawInput {
    let size = vec2(WIDTH, 900.0);
    RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
        ..RawInput::default()
    }
}
