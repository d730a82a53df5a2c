//! Claims about places: STOP is always whole and free, and nothing that can be pressed lies on another thing.

use crate::setup::window::{Bench, LARGE, Role};
use egui::{Key, Modifiers, Pos2, Rect, Vec2, vec2};
use handscope::app::action::Action;
use handscope::app::inputs::InputAction;
use handscope::hand::{Dof, Fault};
use handscope::sim::SimConfig;
use handscope::ui::View;

const SIZES: [Vec2; 3] = [vec2(1024.0, 640.0), LARGE, vec2(2560.0, 1440.0)];
/// Places and STOP, as each language calls them.
const ENGLISH: Names = Names {
    tabs: ["Live", "Tune", "Recordings", "Share", "Hand"],
    stop: "STOP",
};
const CHINESE: Names = Names {
    tabs: ["实时", "调参", "录制", "共享", "灵巧手"],
    stop: "停止",
};

struct Names {
    tabs: [&'static str; 5],
    stop: &'static str,
}

pub(crate) fn check(bench: &Bench, size: Vec2, stop: &str, when: &str) {
    let screen = Rect::from_min_size(Pos2::ZERO, size);
    assert!(!bench.is_disabled(Role::Button, stop), "{when}");
    let place = bench.rect(Role::Button, stop);
    assert!(screen.contains_rect(place), "{when}: STOP at {place}");
    let mut all: Vec<(String, Rect)> = [
        Role::Button,
        Role::Slider,
        Role::TextInput,
        Role::CheckBox,
        Role::ComboBox,
    ]
    .into_iter()
    .flat_map(|role| bench.all(role))
    .collect();
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

/// The state in which most can be pressed, with names being typed and each form of the connection.
#[test]
fn no_two_controls_overlap_while_armed_naming_or_choosing_a_link() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.wait(400);
        bench.click("Arm the hand");
        bench.wait(200);
        assert!(bench.state().hand().connection.is_armed());
        bench.drag("Index angle target", 1.0, 0.6);
        check(&bench, size, "STOP", &format!("{size} armed"));
        bench.show(View::Poses);
        bench.run(60);
        bench.click("In the hand");
        bench.run(60);
        bench.click("Name gestures");
        bench.run(60);
        assert!(bench.all(Role::TextInput).len() > 40);
        check(&bench, size, "STOP", &format!("{size} naming"));
        bench.show(View::Live);
        bench.run(60);
        check(&bench, size, "STOP", &format!("{size} naming in the strip"));
        bench.show(View::Connection);
        bench.run(60);
        bench.click_button("Change");
        for address in ["/dev/ttyUSB0", "192.168.11.7", "can0", "sim:", "no such"] {
            bench.type_into("Address, port or name", address);
            bench.run(60);
            check(&bench, size, "STOP", &format!("{size} {address}"));
        }
        assert!(
            bench.state().hand().connection.is_armed(),
            "looking around disarms nothing"
        );
    }
}

/// Poses with one chosen, and a sequence with steps: where most fields of these views are.
#[test]
fn no_two_controls_overlap_among_poses_and_steps() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.wait(400);
        bench.show(View::Poses);
        bench.run(60);
        bench.click("Save the pose the hand has now");
        bench.run(60);
        for _ in 0..8 {
            bench.click("Save pose");
            bench.run(60);
        }
        check(&bench, size, "STOP", &format!("{size} poses"));
        bench.click("Sequences");
        bench.run(60);
        bench.click("New sequence");
        bench.run(60);
        for _ in 0..7 {
            bench.click("Add");
            bench.run(60);
        }
        check(&bench, size, "STOP", &format!("{size} steps"));
    }
}

fn check_all_views(mut bench: Bench, size: Vec2) {
    for names in [&ENGLISH, &CHINESE] {
        for theme in ["first", "second"] {
            for tab in names.tabs {
                // In Chinese a tab and a button of its view are called the same: the tab comes first.
                bench.click_first_button(tab);
                bench.run(60);
                check(&bench, size, names.stop, &format!("{size} {tab} {theme}"));
            }
            for view in [View::Touch, View::Poses, View::Faults] {
                bench.show(view);
                bench.run(60);
                check(
                    &bench,
                    size,
                    names.stop,
                    &format!("{size} {view:?} {theme}"),
                );
            }
            bench.key_with(Modifiers::COMMAND, Key::D);
            bench.run(40);
        }
        bench.key_with(Modifiers::COMMAND, Key::L);
        bench.run(60);
    }
}

#[test]
fn stop_is_free_and_no_two_controls_overlap_while_watching() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.run(400);
        check_all_views(bench, size);
    }
}

#[test]
fn stop_is_free_and_no_two_controls_overlap_with_a_fault_and_a_lost_link() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.run(400);
        bench.hand(|hand, _| {
            hand.inject_fault(handscope::hand::Dof::Index, handscope::hand::Fault::Stall);
        });
        bench.run(200);
        bench.unplug();
        bench.run(400);
        assert!(bench.shows("LINK LOST") && bench.shows("FAULT"));
        check_all_views(bench, size);
    }
}

/// The borders between rooms that stand beside each other, from the left.
fn borders(bench: &Bench) -> Vec<Rect> {
    let all = bench.all(Role::Splitter).into_iter().map(|(_, rect)| rect);
    let mut upright: Vec<Rect> = all.filter(|rect| rect.height() > rect.width()).collect();
    upright.sort_by(|one, other| one.center().x.total_cmp(&other.center().x));
    upright
}

fn drag_border(bench: &mut Bench, at: usize, by: f32) {
    let from = borders(bench)[at].center();
    bench.drag_from_to(from, from + vec2(by, 0.0));
    bench.run(60);
}

fn menu(bench: &mut Bench, entry: &str) {
    bench.click("Window menu");
    bench.run(60);
    bench.click(entry);
    bench.run(60);
    bench.click("Window menu");
    bench.run(300);
}

#[test]
fn a_border_is_dragged_is_kept_and_comes_back() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.run(200);
    let at = |bench: &Bench, which: usize| borders(bench)[which].center().x;
    let designed = borders(&bench);
    let joints = at(&bench, 0);
    drag_border(&mut bench, 0, 60.0);
    assert!((at(&bench, 0) - joints - 60.0).abs() <= 2.0, "{joints}");
    let side = at(&bench, 1);
    drag_border(&mut bench, 1, 50.0);
    assert!((at(&bench, 1) - side - 50.0).abs() <= 2.0, "{side}");
    let kept = bench.state().settings.layout;
    assert!(kept.medium.joints.share.is_some() && kept.medium.stage.share.is_some());
    drag_border(&mut bench, 0, 900.0);
    check(&bench, LARGE, "STOP", "wide joints");
    // Beyond what the joints need they are a rail.
    drag_border(&mut bench, 0, -900.0);
    bench.run(400);
    assert!(bench.state().settings.layout.medium.joints.shut);
    check(&bench, LARGE, "STOP", "narrow joints");
    menu(&mut bench, "Reset layout");
    assert_eq!(borders(&bench), designed);
    assert!(
        bench.writes().is_empty(),
        "nothing of this reaches the hand"
    );
}

#[test]
fn every_room_but_the_plots_can_be_shut_and_opened_again() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.run(400);
    for room in ["Joints", "Poses", "Hand"] {
        bench.click("Window menu");
        bench.run(60);
        bench.click_box(room);
        bench.run(300);
        check(&bench, LARGE, "STOP", &format!("{room} shut"));
        bench.click("Window menu");
        bench.run(60);
        bench.click_box(room);
        bench.run(300);
        assert_eq!(
            bench.state().settings.layout,
            handscope::app::layout::Layout::default()
        );
    }
}

#[test]
fn shut_joints_still_show_angle_force_and_lamp() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.run(400);
    bench.click("Window menu");
    bench.run(60);
    bench.click_box("Joints");
    bench.run(300);
    assert!(bench.all(Role::Slider).is_empty());
    for joint in [
        "Little",
        "Ring",
        "Middle",
        "Index",
        "Thumb bend",
        "Thumb rotate",
    ] {
        assert!(bench.shows(joint), "{joint}");
        assert!(
            bench
                .reading(&format!("{joint} actual angle"))
                .trim()
                .parse::<i16>()
                .is_ok()
        );
        assert!(bench.reading(&format!("{joint} live force")).ends_with('g'));
    }
}

#[test]
fn looking_at_another_view_leaves_no_trace_in_the_layout() {
    for size in [vec2(1366.0, 768.0), LARGE, vec2(1920.0, 1080.0)] {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.run(400);
        let before = borders(&bench);
        for view in [View::Touch, View::Poses, View::Faults, View::Tune] {
            bench.show(view);
            bench.run(100);
            bench.show(View::Live);
            bench.run(100);
            assert_eq!(borders(&bench), before, "{size} {view:?}");
        }
        assert_eq!(
            bench.state().settings.layout,
            handscope::app::layout::Layout::default(),
            "{size}"
        );
    }
}

/// What stands in the header, with its place.
fn header(bench: &Bench, names: &[&str]) -> Vec<Rect> {
    let buttons = bench.all(Role::Button);
    let place = |name: &&str| {
        let found = buttons.iter().find(|(button, _)| button.starts_with(name));
        found.unwrap_or_else(|| panic!("{name}: {buttons:?}")).1
    };
    names.iter().map(place).collect()
}

#[test]
fn nothing_in_the_header_moves_or_is_covered_when_a_fault_comes_or_the_link_goes() {
    for size in [
        vec2(1024.0, 640.0),
        vec2(1366.0, 768.0),
        vec2(1920.0, 1080.0),
    ] {
        let mut bench = Bench::kept(SimConfig::default(), "tcp:127.0.0.1:6000?unit=255", size);
        bench.wait(1000);
        bench.act(Action::Input(InputAction::ReadPad(true)));
        bench.run(200);
        let names = [
            "Live",
            "Share",
            "Link state",
            "Faults",
            "Window menu",
            "Arm",
        ];
        let before = header(&bench, &names);
        for finger in [Dof::Index, Dof::Ring, Dof::Little] {
            bench.hand(|hand, _| hand.inject_fault(finger, Fault::Stall));
        }
        bench.run(400);
        assert!(bench.shows("Faults: 3 unseen"), "{size}");
        assert_eq!(header(&bench, &names), before, "{size} with faults");
        bench.show(View::Faults);
        bench.run(100);
        check(&bench, size, "STOP", &format!("{size} faults"));
        assert_eq!(header(&bench, &names), before, "{size} among the faults");
        bench.unplug();
        bench.run(1000);
        assert!(bench.shows("LINK LOST"), "{size}");
        assert_eq!(header(&bench, &names), before, "{size} link lost");
        let cut = bench.cut().into_iter();
        let cut: Vec<_> = cut.filter(|(_, place)| place.bottom() < 48.0).collect();
        assert_eq!(cut, [], "{size}");
    }
}

#[test]
fn no_state_of_a_drive_is_cut() {
    for size in [
        vec2(1024.0, 640.0),
        vec2(1366.0, 768.0),
        vec2(1920.0, 1080.0),
    ] {
        for fault in (0..5).map(Fault::from_bit) {
            let mut bench = Bench::open(SimConfig::default(), size);
            bench.wait(1000);
            bench.hand(|hand, _| Dof::ALL.map(|dof| hand.inject_fault(dof, fault)));
            bench.run(400);
            assert!(bench.shows("FAULT"), "{size} {fault:?}");
            let cut = bench.cut().into_iter();
            // The strip of messages may be longer than the window.
            let cut: Vec<_> = cut.filter(|(_, place)| place.top() > 80.0).collect();
            assert_eq!(cut, [], "{size} {fault:?}");
        }
    }
}

#[test]
fn no_slider_is_too_short_to_be_moved() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.run(400);
        let sliders = bench.all(Role::Slider);
        assert!(sliders.len() >= 6, "{size}");
        for (name, place) in sliders {
            assert!(place.width() >= 48.0, "{size} {name}: {place}");
        }
        assert!(!bench.typed("All speed number").is_empty(), "{size}");
    }
}
