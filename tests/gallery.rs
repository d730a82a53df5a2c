//! dev only
mod common;
use handscope::app::settings::{Language, Theme};
use handscope::headless::canvas::Canvas;
use handscope::headless::png;
use handscope::ui::{View, Window, install};

fn shot(name: &str, state: &handscope::app::state::State, view: View, size: (u32, u32)) {
    let mut canvas = Canvas::new(size, 1.0);
    install(
        canvas.context(),
        state.settings.theme,
        state.settings.language,
    );
    canvas.hold_still();
    let mut window = Window::new();
    window.set_view(view);
    // a first reading at rest
    let mut rest = state.clone();
    for (_, block) in rest.sample.tactile.iter_mut() {
        if let Some(block) = block {
            block.value = common::tactile(0);
        }
    }
    canvas.frame(0.0, |ui| {
        window.ui(ui, &rest);
    });
    let picture = canvas.picture(1.0, |ui| {
        window.ui(ui, state);
    });
    png::save(
        std::path::Path::new(&format!("/tmp/ui/{name}.png")),
        &picture.rgba,
        picture.size,
    )
    .unwrap();
}

#[test]
fn gallery() {
    std::fs::create_dir_all("/tmp/ui").unwrap();
    let big = (1440, 900);
    let small = (1024, 640);
    let look = |mut s: handscope::app::state::State, t, l| {
        s.settings.theme = t;
        s.settings.language = l;
        s
    };
    let (d, l, en, zh) = (Theme::Dark, Theme::Light, Language::En, Language::Zh);
    let only = std::env::var("ONLY").unwrap_or_default();
    let run = |n: &str, s: &handscope::app::state::State, v, z| {
        if n.contains(&only) {
            shot(n, s, v, z)
        }
    };
    run("live_dark", &look(common::armed(), d, en), View::Live, big);
    run("live_light", &look(common::live(), l, en), View::Live, big);
    run(
        "live_small",
        &look(common::armed(), d, en),
        View::Live,
        small,
    );
    run("live_zh", &look(common::armed(), d, zh), View::Live, big);
    run(
        "live_zh_small",
        &look(common::faulted(), l, zh),
        View::Live,
        small,
    );
    run("lost", &look(common::lost(), d, en), View::Live, big);
    run("fault", &look(common::faulted(), d, en), View::Live, big);
    run("empty", &look(common::empty(), d, en), View::Live, big);
    run("v_touch", &look(common::armed(), d, en), View::Touch, big);
    run(
        "v_faults",
        &look(common::faulted(), d, en),
        View::Faults,
        big,
    );
    run(
        "v_gestures",
        &look(common::armed(), d, en),
        View::Gestures,
        big,
    );
    run(
        "v_connection",
        &look(common::lost(), d, en),
        View::Connection,
        big,
    );
}
