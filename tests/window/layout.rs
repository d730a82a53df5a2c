//! Claims about places: STOP is always whole and free, and nothing that can be pressed lies on another thing.

use crate::bench::{Bench, LARGE, Role};
use egui::{Pos2, Rect, Vec2, vec2};
use handscope::sim::SimConfig;

const SIZES: [Vec2; 3] = [vec2(1024.0, 640.0), LARGE, vec2(2560.0, 1440.0)];
/// Tabs, STOP, theme and language, as each language calls them.
const ENGLISH: Names = Names {
    tabs: ["Live", "Touch", "Faults", "Poses", "Connection"],
    stop: "STOP",
    theme: "Theme",
    language: "Language",
};
const CHINESE: Names = Names {
    tabs: ["总览", "触觉", "故障", "姿态", "连接"],
    stop: "停止",
    theme: "主题",
    language: "语言",
};

struct Names {
    tabs: [&'static str; 5],
    stop: &'static str,
    theme: &'static str,
    language: &'static str,
}

pub fn check(bench: &Bench, size: Vec2, stop: &str, when: &str) {
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
    assert!(all.len() > 40, "{when}: {}", all.len());
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
        assert!(bench.state().is_armed());
        bench.drag("Index angle target", 1.0, 0.6);
        check(&bench, size, "STOP", &format!("{size} armed"));
        bench.click_first_button("Poses");
        bench.run(60);
        bench.click("Stored in the hand");
        bench.run(60);
        bench.click("Name gestures");
        bench.run(60);
        assert!(bench.all(Role::TextInput).len() > 40);
        check(&bench, size, "STOP", &format!("{size} naming"));
        bench.click_first_button("Live");
        bench.run(60);
        check(&bench, size, "STOP", &format!("{size} naming in the strip"));
        bench.click_first_button("Connection");
        bench.run(60);
        for kind in ["RS485", "Modbus TCP", "Simulated"] {
            bench.click(&format!("Kind of link: {kind}"));
            bench.run(60);
            check(&bench, size, "STOP", &format!("{size} {kind}"));
        }
        assert!(bench.state().is_armed(), "looking around disarms nothing");
    }
}

/// Poses with one chosen, and a sequence with steps: where most fields of these views are.
#[test]
fn no_two_controls_overlap_among_poses_and_steps() {
    for size in SIZES {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.wait(400);
        bench.click_first_button("Poses");
        bench.run(60);
        bench.click("Capture the pose the hand has now");
        bench.run(60);
        for _ in 0..8 {
            bench.click("Capture");
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
            bench.click_first_button(names.theme);
            bench.run(40);
        }
        bench.click_first_button(names.language);
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
