//! Every view in every size, language and state: nothing that can be pressed is cut off or lies on another thing. No hand.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::expect_used,
    reason = "a test may"
)]

mod common;

use egui::accesskit::Role;
use egui::{Pos2, Rect, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use handscope::app::settings::{Language, Theme};
use handscope::app::state::State;
use handscope::link::Dialling;
use handscope::ui::{View, Window};

struct Bench {
    window: Window,
    state: State,
}

/// Sizes in points. A scale makes points larger and moves none of them.
const SIZES: [Vec2; 6] = [
    vec2(1024.0, 640.0),
    vec2(1280.0, 720.0),
    vec2(1440.0, 900.0),
    vec2(1920.0, 1080.0),
    vec2(2560.0, 1440.0),
    vec2(3840.0, 2160.0),
];
/// What can be pressed, moved or typed into.
const PRESSED: [Role; 5] = [
    Role::Button,
    Role::Slider,
    Role::TextInput,
    Role::CheckBox,
    Role::ComboBox,
];

fn connecting() -> State {
    let mut state = common::empty();
    state.endpoint = Some("tcp:192.168.11.210:6000?unit=255".parse().unwrap());
    state.link.dialling = Dialling::Trying { attempt: 2 };
    state
}

/// Names and places, as far as they are not scrolled away.
fn pressed(harness: &Harness<'static, Bench>) -> Vec<(String, Rect)> {
    let nodes = PRESSED
        .into_iter()
        .flat_map(|role| harness.query_all_by_role(role));
    let named = nodes.map(|node| {
        let name = node.accesskit_node().label().unwrap_or_default();
        let (id, _) = node.accesskit_node().locate();
        let seen = harness.ctx.viewport(|viewport| {
            let mut layers = viewport.prev_pass.widgets.layers();
            layers.find_map(|(_, widgets)| {
                let mut widgets = widgets.iter();
                widgets
                    .find(|widget| widget.id.accesskit_id() == id)
                    .map(|widget| widget.interact_rect)
            })
        });
        (name, seen.unwrap_or(node.rect()))
    });
    named.filter(|(_, rect)| rect.is_positive()).collect()
}

fn check(harness: &Harness<'static, Bench>, size: Vec2, when: &str) {
    let screen = Rect::from_min_size(Pos2::ZERO, size);
    let mut all = pressed(harness);
    assert!(all.len() > 20, "{when}: {}", all.len());
    while let Some((name, rect)) = all.pop() {
        assert!(!name.is_empty(), "{when}: something at {rect} has no name");
        assert!(screen.contains_rect(rect), "{when}: {name} at {rect}");
        for (other, place) in &all {
            let apart = !rect.shrink(0.5).intersects(*place);
            assert!(apart, "{when}: {name} {rect} on {other} {place}");
        }
    }
}

fn walk(state: State, what: &str) {
    let bench = Bench {
        window: Window::new(),
        state,
    };
    let mut harness = Harness::builder().build_ui_state(
        |ui, bench: &mut Bench| drop(bench.window.ui(ui, &bench.state)),
        bench,
    );
    for (at, size) in SIZES.into_iter().enumerate() {
        harness.set_size(size);
        for language in [Language::En, Language::Zh] {
            harness.state_mut().state.settings.language = language;
            for (n, view) in View::ALL.into_iter().enumerate() {
                // Colours move nothing: each size and each view has both themes once.
                let themes = [Theme::Dark, Theme::Light];
                harness.state_mut().state.settings.theme = themes[(at + n) % 2];
                harness.state_mut().window.set_view(view);
                harness.run_steps(3);
                check(
                    &harness,
                    size,
                    &format!("{what} {size} {language:?} {view:?}"),
                );
            }
        }
    }
}

#[test]
fn nothing_is_cut_or_covered_without_a_hand() {
    walk(common::empty(), "no hand");
}

#[test]
fn nothing_is_cut_or_covered_while_connecting() {
    walk(connecting(), "connecting");
}

#[test]
fn nothing_is_cut_or_covered_while_watching() {
    walk(common::live(), "live");
}

#[test]
fn nothing_is_cut_or_covered_after_a_lost_link() {
    walk(common::lost(), "lost");
}

#[test]
fn nothing_is_cut_or_covered_with_a_fault() {
    walk(common::faulted(), "faulted");
}

#[test]
fn nothing_is_cut_or_covered_while_armed() {
    walk(common::armed(), "armed");
}
