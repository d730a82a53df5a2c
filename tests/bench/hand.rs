//! Processor time of the drawn hand alone while it grasps: its mesh, its triangles, and its pixels without a GPU.

use crate::clock::{Sorted, cpu_ms, wall_and_cpu_ms};
use crate::report::{Aim, Failure, Report};
use crate::scene::{Scene, Time};
use egui::{Context, RawInput, Rect, pos2, vec2};
use handscope::draw::raster::Raster;
use handscope::ui::Window;
use std::time::Duration;

/// Frames of one figure: a whole grasp, in which everything moves.
const FRAMES: usize = 500;
/// Frames before, until shapes are made and caches settled.
const WARM: usize = 20;
const FRAME_EACH: Duration = Duration::from_millis(16);
/// Size of the picture, in points and pixels.
const SIZE: (u16, u16) = (420, 460);
/// What the mesh may take with its triangles, and what its pixels may take more.
const AIM_MESH_MS: f64 = 0.6;
const AIM_PIXELS_MS: f64 = 2.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let mut scene = Scene::start(Time::Virtual)?;
    scene.run(Duration::from_secs(1));
    let (mut window, context) = (Window::new(), Context::default());
    let mut raster = Raster::new(SIZE.0.into(), SIZE.1.into());
    let [mut mesh, mut triangles, mut pixels] = [const { Vec::new() }; 3];
    for frame in 0..WARM + FRAMES {
        scene.run(FRAME_EACH);
        let state = scene.state();
        let (drawn_ms, mut output) =
            cpu_ms(|| context.run_ui(screen(), |ui| window.hand_alone_ui(ui, state)));
        raster.apply_textures(&mut output.textures_delta);
        let (cut_ms, primitives) =
            cpu_ms(|| context.tessellate(output.shapes, output.pixels_per_point));
        let ([_, painted_ms], ()) = wall_and_cpu_ms(|| raster.draw(&primitives, 1.0, [0; 4]));
        if frame >= WARM {
            mesh.push(drawn_ms);
            triangles.push(cut_ms);
            pixels.push(painted_ms);
        }
    }
    let (mesh, triangles) = (Sorted::new(mesh).median(), Sorted::new(triangles).median());
    let aim = Aim::AtMost(AIM_MESH_MS);
    report.row(
        "the drawn hand in motion: mesh and triangles, median",
        mesh + triangles,
        "ms cpu",
        aim,
    )?;
    report.row("  mesh, with its frame of egui", mesh, "ms cpu", Aim::None)?;
    report.row("  triangles", triangles, "ms cpu", Aim::None)?;
    let aim = Aim::AtMost(AIM_PIXELS_MS);
    let what = "  its pixels without a GPU, 420x460";
    report.row(what, Sorted::new(pixels).median(), "ms cpu", aim)
}

fn screen() -> RawInput {
    let size = vec2(SIZE.0.into(), SIZE.1.into());
    RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
        ..RawInput::default()
    }
}
