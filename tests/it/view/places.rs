//! Every view in every size, language, theme and state: nothing that can be pressed is cut off or lies on another thing, and
//! no text is shortened or cut. No hand. With `HANDSCOPE_PICTURES=folder` the states are drawn into files, to be looked at.

use crate::setup::soak;
use crate::setup::states;
use crate::setup::view::{self, LARGE, Shown};
use egui::accesskit::Role;
use egui::{Pos2, Rect, Shape, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use handscope::app::settings::{Language, Theme};
use handscope::app::state::State;
use handscope::link::Dialling;
use handscope::shell::headless::canvas::Canvas;
use handscope::shell::headless::png;
use handscope::ui::{View, Window};
use std::path::Path;

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
    let mut state = states::empty();
    state.hand_mut().connection.endpoint =
        Some("tcp:192.168.11.210:6000?unit=255".parse().unwrap());
    state.hand_mut().connection.status.dialling = Dialling::Trying { attempt: 2 };
    state
}

/// Names and places, as far as they are not scrolled away.
fn pressed(harness: &Harness<'static, Shown>) -> Vec<(String, Rect)> {
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

fn check(harness: &Harness<'static, Shown>, size: Vec2, when: &str) {
    let screen = Rect::from_min_size(Pos2::ZERO, size);
    let mut all = pressed(harness);
    assert!(all.len() > 14, "{when}: {}", all.len());
    while let Some((name, rect)) = all.pop() {
        assert!(!name.is_empty(), "{when}: something at {rect} has no name");
        assert!(screen.contains_rect(rect), "{when}: {name} at {rect}");
        for (other, place) in &all {
            let apart = !rect.shrink(0.5).intersects(*place);
            assert!(apart, "{when}: {name} {rect} on {other} {place}");
        }
    }
}

/// Texts that are written and cannot be read whole: shortened, or beyond the edge of what is shown of them.
fn unreadable(harness: &Harness<'static, Shown>) -> Vec<String> {
    let mut found = Vec::new();
    for clipped in &harness.output().shapes {
        collect(&clipped.shape, clipped.clip_rect, &mut found);
    }
    found
}

fn collect(shape: &Shape, clip: Rect, found: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => {
            for shape in shapes {
                collect(shape, clip, found);
            }
        }
        Shape::Text(text) => {
            let place = shape.visual_bounding_rect();
            let words = text.galley.text();
            // What is scrolled away is no more cut than a page that was turned.
            let seen = place.intersects(clip) && !words.trim().is_empty();
            let room = clip.expand(1.0).x_range();
            let whole = room.contains(place.left()) && room.contains(place.right());
            if seen && (text.galley.elided || !whole) {
                found.push(format!("{words:?} at {place} in {clip}"));
            }
        }
        _ => {}
    }
}

fn open_at(state: State, scale: f32, size: Vec2) -> Harness<'static, Shown> {
    let display = view::display(size).with_pixels_per_point(scale);
    view::open(state, View::Live, display)
}

fn walk_at(harness: &mut Harness<'static, Shown>, size: Vec2, what: &str) {
    let mut all_cut = Vec::new();
    for language in [Language::En, Language::Zh] {
        harness.state_mut().state.settings.language = language;
        for theme in [Theme::Dark, Theme::Light] {
            // Each language in one theme, or in both.
            let is_usual = (language == Language::Zh) == (theme == Theme::Light);
            if !is_usual && !soak::is_full() {
                continue;
            }
            harness.state_mut().state.settings.theme = theme;
            for view in View::ALL {
                harness.state_mut().window.set_view(view);
                harness.run_steps(3);
                let when = format!("{what} {size} {language:?} {theme:?} {view:?}");
                check(harness, size, &when);
                let cut = unreadable(harness);
                all_cut.extend(cut.iter().map(|cut| format!("{when}: {cut}")));
            }
        }
    }
    assert!(all_cut.is_empty(), "{}", all_cut.join("\n"));
}

/// The state as it looks, where somebody wants to see it.
fn draw(make: fn() -> State, what: &str) {
    let Some(folder) = std::env::var_os("HANDSCOPE_PICTURES") else {
        return;
    };
    for size in [(1024, 640), (1440, 900)] {
        for (language, theme) in [(Language::En, Theme::Dark), (Language::Zh, Theme::Light)] {
            for view in View::ALL {
                let mut state = make();
                (state.settings.language, state.settings.theme) = (language, theme);
                let mut window = Window::new();
                window.set_view(view);
                let mut canvas = Canvas::new(size, 1.0);
                canvas.frame(0.0, |ui| drop(window.ui(ui, &state)));
                canvas.hold_still();
                let picture = canvas.picture(0.0, |ui| drop(window.ui(ui, &state)));
                let name = format!("{what}-{}-{}-{language:?}.png", view.name(), size.0);
                let path = Path::new(&folder).join(name.replace(' ', "-"));
                png::save(&path, &picture.rgb, picture.size).unwrap();
            }
        }
    }
}

fn walk(make: fn() -> State, what: &str) {
    draw(make, what);
    let mut harness = open_at(make(), 1.0, SIZES[0]);
    for size in SIZES {
        harness.set_size(size);
        walk_at(&mut harness, size, what);
    }
}

/// Pixels that a finger needs, on a display that is drawn one and a half times as large.
const FINGER_PX: f32 = 39.0;

/// True for what a list that scrolls shows in part.
fn is_scrolled(harness: &Harness<'static, Shown>, seen: Rect) -> bool {
    harness.ctx.viewport(|viewport| {
        let mut layers = viewport.prev_pass.widgets.layers();
        layers.any(|(_, widgets)| {
            let mut widgets = widgets.iter();
            widgets.any(|widget| widget.interact_rect == seen && widget.rect != seen)
        })
    })
}

/// The place from which a press hits this target: a press beside it hits it where no other is nearer.
fn reached(rect: Rect, all: &[(String, Rect)], reach: f32) -> Vec2 {
    let side = |gap: &dyn Fn(&Rect) -> f32, across: &dyn Fn(&Rect) -> bool| {
        let near = all.iter().map(|(_, other)| other);
        let near = near.filter(|other| **other != rect && across(other));
        near.map(gap)
            .filter(|gap| *gap > -0.5)
            .fold(reach, |least, gap| least.min(gap / 2.0))
    };
    // Those that only touch are neither beside nor above.
    let inner = rect.shrink(0.5);
    let beside = |other: &Rect| other.y_range().intersects(inner.y_range());
    let over = |other: &Rect| other.x_range().intersects(inner.x_range());
    rect.size()
        + vec2(
            side(&|other| other.left() - rect.right(), &beside)
                + side(&|other| rect.left() - other.right(), &beside),
            side(&|other| other.top() - rect.bottom(), &over)
                + side(&|other| rect.top() - other.bottom(), &over),
        )
}

#[test]
fn every_target_is_as_large_as_a_finger_on_a_touch_display() {
    let scale = 1.5;
    // All joints are to be seen, and with no room to spare.
    for (state, height) in [
        (states::armed(), 852.0),
        (states::faulted(), 904.0),
        (states::several(), 904.0),
    ] {
        let mut harness = open_at(state, scale, vec2(1280.0, height));
        for view in View::ALL {
            harness.state_mut().window.set_view(view);
            harness.run_steps(3);
            let reach = harness.ctx.global_style().interaction.interact_radius;
            let all = pressed(&harness);
            let whole = |rect: &&(String, Rect)| !is_scrolled(&harness, rect.1);
            for (name, rect) in all.iter().filter(whole) {
                let px = reached(*rect, &all, reach).min_elem() * scale;
                assert!(px >= FINGER_PX, "{view:?} {name}: {rect} {px} px");
            }
        }
    }
}

#[test]
fn nothing_is_cut_or_covered_without_a_hand() {
    walk(states::empty, "no hand");
}

#[test]
fn nothing_is_cut_or_covered_while_connecting() {
    walk(connecting, "connecting");
}

#[test]
fn nothing_is_cut_or_covered_while_watching() {
    walk(states::live, "live");
}

#[test]
fn nothing_is_cut_or_covered_after_a_lost_link() {
    walk(states::lost, "lost");
}

#[test]
fn nothing_is_cut_or_covered_with_a_fault() {
    walk(states::faulted, "faulted");
}

#[test]
fn nothing_is_cut_or_covered_while_armed() {
    walk(states::armed, "armed");
}

/// Grips by size in both languages: the button of their drawer, and the control for the gap in it.
const GRIP_SIZE: [(Language, &str, &str); 2] = [
    (Language::En, "Grip by size", "Gap, mm"),
    (Language::Zh, "按尺寸抓握", "间距 mm"),
];

#[test]
fn nothing_is_cut_in_the_drawer_of_grips_by_size() {
    for make in [states::live, states::armed] {
        for (size, (language, button, gap)) in SIZES
            .into_iter()
            .flat_map(|size| GRIP_SIZE.map(|words| (size, words)))
        {
            let mut harness = open_at(make(), 1.0, size);
            harness.state_mut().state.settings.language = language;
            harness.run_steps(3);
            harness.get_by_role_and_label(Role::Button, button).click();
            harness.run_steps(6);
            let sliders = harness.query_all_by_role(Role::Slider);
            let mut named =
                sliders.filter(|node| node.accesskit_node().label().as_deref() == Some(gap));
            let place = named
                .next()
                .unwrap_or_else(|| panic!("{size} {language:?}"));
            let screen = Rect::from_min_size(Pos2::ZERO, size);
            assert!(screen.contains_rect(place.rect()), "{size} {language:?}");
            drop(named);
            let cut = unreadable(&harness);
            assert!(cut.is_empty(), "{size} {language:?}: {cut:?}");
        }
    }
}

#[test]
fn nothing_is_cut_or_covered_with_several_hands() {
    walk(states::several, "several hands");
}

#[test]
fn nothing_is_cut_or_covered_with_all_hands_side_by_side() {
    let mut harness = open_at(states::several(), 1.0, SIZES[0]);
    let switch = harness.get_by_role_and_label(Role::Button, "All hands");
    switch.click();
    for size in SIZES {
        harness.set_size(size);
        for language in [Language::En, Language::Zh] {
            harness.state_mut().state.settings.language = language;
            harness.run_steps(3);
            let when = format!("side by side {size} {language:?}");
            check(&harness, size, &when);
            // At the edge of what is scrolled a text may be cut.
            let cut = unreadable(&harness);
            let cut: Vec<_> = cut.iter().filter(|cut| !cut.contains("210")).collect();
            assert!(cut.is_empty() || size.x < 1900.0, "{when}: {cut:?}");
        }
    }
}

/// Draws all hands side by side where somebody wants to see it.
#[test]
fn all_hands_side_by_side_are_drawn_for_who_wants_to_see_them() {
    let Some(folder) = std::env::var_os("HANDSCOPE_PICTURES") else {
        return;
    };
    let (mut window, state) = (Window::new(), states::several());
    let mut canvas = Canvas::new((1440, 900), 1.0);
    window.show_all_hands();
    canvas.frame(0.0, |ui| drop(window.ui(ui, &state)));
    canvas.hold_still();
    let picture = canvas.picture(0.0, |ui| drop(window.ui(ui, &state)));
    let path = Path::new(&folder).join("side-by-side.png");
    png::save(&path, &picture.rgb, picture.size).unwrap();
}

#[test]
fn nothing_is_cut_or_covered_on_a_fine_display() {
    for scale in [1.25, 1.5, 2.0, 3.0] {
        for state in [states::armed(), states::faulted()] {
            let mut harness = open_at(state, scale, SIZES[0]);
            walk_at(&mut harness, SIZES[0], &format!("scale {scale}"));
        }
    }
}

/// How much of what is below is hidden by the cards of the open place: 1 is all.
fn cover(harness: &Harness<'static, Shown>) -> f32 {
    let shapes = harness.output().shapes.iter();
    let cards = shapes.filter_map(|clipped| match &clipped.shape {
        Shape::Rect(card) if card.rect.left() > 200.0 && card.rect.top() > 110.0 => {
            Some(card.fill.a())
        }
        _ => None,
    });
    f32::from(cards.max().expect("a card")) / 255.0
}

#[test]
fn a_place_fades_in_and_is_there_at_once_where_nothing_is_to_move_by_itself() {
    let display = view::display(LARGE).with_step_dt(0.02);
    let mut harness = view::open(states::empty(), View::Live, display);
    harness
        .ctx
        .all_styles_mut(|style| style.animation_time = 0.12);
    harness.state_mut().window.set_view(View::Connection);
    harness.run_steps(3);
    let begun = cover(&harness);
    assert!((0.1..0.9).contains(&begun), "{begun}");
    harness.run_steps(5);
    assert!((cover(&harness) - 1.0).abs() < 1e-6);

    harness
        .ctx
        .all_styles_mut(|style| style.animation_time = 0.0);
    for view in [View::Live, View::Connection] {
        harness.state_mut().window.set_view(view);
        harness.step();
    }
    assert!((cover(&harness) - 1.0).abs() < 1e-6);
}
