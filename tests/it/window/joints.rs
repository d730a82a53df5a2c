//! What a person does with the joints beside dragging one: presets, links, all at once, units, the frame behind a control.

use crate::setup::window::{ANGLE_SET, Bench, FORCE_SET, LARGE, Role, SPEED_SET};
use handscope::app::action::Action;
use handscope::checkup::newtons_file;
use handscope::hand::newtons::{JointPoints, ScalePoint};
use handscope::hand::{Dof, Force, Speed};
use handscope::sim::SimConfig;
use handscope::transport::Endpoint;
use std::time::Duration;

#[test]
fn a_preset_goes_at_the_speeds_that_are_set_and_leaves_locked_joints() {
    let mut bench = Bench::armed();
    bench.drag("Index speed", 0.2, 0.9);
    bench.run(200);
    let speed = bench.state().hand().controls.joints[Dof::Index].speed;
    assert!(speed > Some(Speed::GENTLE));
    bench.click("Ring lock");
    bench.run(60);
    let before = bench.writes().len();
    let ring = bench.angle(Dof::Ring);
    bench.click("Half");
    bench.run(3000);
    let writes = bench.writes();
    let sent: Vec<u16> = writes[before..].iter().map(|write| write.address).collect();
    let is_angle = |address: &u16| (ANGLE_SET..ANGLE_SET + 12).contains(address);
    assert!(!sent.is_empty() && sent.iter().all(is_angle), "{sent:?}");
    assert_eq!(
        bench.state().hand().controls.joints[Dof::Index].speed,
        speed
    );
    assert!(
        (bench.angle(Dof::Index) - 500).abs() < 30,
        "{}",
        bench.angle(Dof::Index)
    );
    assert!((bench.angle(Dof::Ring) - ring).abs() < 10);
}

#[test]
fn without_arming_no_preset_can_be_pressed() {
    let bench = Bench::live();
    for name in ["Open all", "Half", "Close"] {
        assert!(bench.is_disabled(Role::Button, name), "{name}");
    }
}

#[test]
fn linked_fingers_go_as_far_as_the_one_that_is_moved() {
    let mut bench = Bench::armed();
    bench.click("Link");
    bench.run(60);
    bench.drag("Index angle target", 1.0, 0.7);
    bench.run(60);
    let joints = bench.state().hand().controls.joints;
    let target = |dof: Dof| joints[dof].target.unwrap().get();
    for dof in [Dof::Little, Dof::Ring, Dof::Middle] {
        assert!((target(dof) - target(Dof::Index)).abs() <= 12, "{dof:?}");
    }
    assert!(target(Dof::Index) < 800);
    assert!(target(Dof::ThumbBend) > 950, "the thumb is apart");
}

#[test]
fn all_joints_take_one_threshold_and_one_speed() {
    let mut bench = Bench::armed();
    let before = bench.writes().len();
    bench.drag("All force threshold", 0.2, 0.5);
    bench.drag("All speed", 0.2, 0.4);
    bench.run(500);
    let joints = bench.state().hand().controls.joints;
    let of = |dof: Dof| {
        (
            joints[dof].force.unwrap().get(),
            joints[dof].speed.unwrap().get(),
        )
    };
    let (force, speed) = of(Dof::Little);
    assert!(force > 1200 && speed > 300);
    for dof in Dof::ALL {
        assert_eq!(of(dof), (force, speed));
    }
    let writes = bench.writes();
    let last = |address: u16| {
        writes[before..]
            .iter()
            .rev()
            .find(|write| write.address == address)
    };
    assert_eq!(last(FORCE_SET).unwrap().shorts(), [force; 6]);
    assert_eq!(last(SPEED_SET).unwrap().shorts(), [speed; 6]);
}

#[test]
fn angles_are_typed_in_the_unit_that_is_shown_with_a_decimal_comma() {
    let mut bench = Bench::armed();
    bench.click("Angle unit");
    bench.run(60);
    assert_eq!(bench.typed("Index angle number"), "176.0");
    bench.type_into("Index angle number", "98,0");
    bench.key(egui::Key::Enter);
    bench.run(60);
    assert_eq!(
        bench.state().hand().controls.joints[Dof::Index]
            .target
            .unwrap()
            .get(),
        500
    );
    bench.click("Angle unit");
    bench.run(60);
    assert_eq!(bench.typed("Index angle number"), "50.0");
}

#[test]
fn the_wheel_moves_only_the_track_that_has_the_keyboard() {
    let mut bench = Bench::armed();
    let target = |bench: &Bench| {
        bench.state().hand().controls.joints[Dof::Index]
            .target
            .unwrap()
            .get()
    };
    let before = target(&bench);
    bench.wheel("Index angle target", -1.0);
    assert_eq!(target(&bench), before, "not focused");
    bench.drag("Index angle target", 1.0, 0.8);
    let dragged = target(&bench);
    bench.wheel("Index angle target", -1.0);
    assert_eq!(target(&bench), dragged - 10);
    bench.wheel("Index angle target", 1.0);
    assert_eq!(target(&bench), dragged);
}

#[test]
fn a_rough_pair_of_speed_and_threshold_is_said_with_its_figure() {
    let mut bench = Bench::live();
    assert!(!bench.shows("Index impact warning"));
    bench.drag("Index speed", 0.2, 0.95);
    bench.run(60);
    assert!(bench.shows("Index impact warning"));
}

#[test]
fn one_click_on_a_number_selects_all_of_it() {
    let mut bench = Bench::armed();
    bench.type_into("Index angle number", "212");
    bench.key(egui::Key::Enter);
    bench.run(60);
    bench.click("Index angle number");
    bench.run(60);
    bench.write("700");
    assert_eq!(bench.typed("Index angle number"), "700");
    bench.key(egui::Key::Enter);
    bench.run(60);
    let target = bench.state().hand().controls.joints[Dof::Index]
        .target
        .unwrap();
    assert_eq!(target.get(), 700);
}

#[test]
fn escape_gives_the_old_number_back() {
    let mut bench = Bench::armed();
    bench.type_into("Index force number", "900");
    bench.key(egui::Key::Escape);
    bench.run(200);
    assert_eq!(bench.typed("Index force number"), "500");
}

#[test]
fn a_refused_number_is_told_in_words_and_is_gone_after_a_stop() {
    let mut bench = Bench::armed();
    bench.type_into("Index angle number", "abc");
    bench.key(egui::Key::Enter);
    bench.run(60);
    let told = "Only numbers from 0..1000";
    let before = bench.texts_with("0..1000");
    assert!(!before.is_empty(), "{told}: {:?}", bench.texts());
    assert_eq!(bench.typed("Index angle number"), "abc");
    bench.click_button("STOP");
    bench.run(200);
    assert!(bench.texts_with("0..1000").is_empty());
    assert_ne!(bench.typed("Index angle number"), "abc");
}

#[test]
fn no_tooltip_covers_a_joint_until_the_pointer_has_left_its_track() {
    let mut bench = Bench::armed();
    let track = bench.rect(Role::Slider, "Index angle target");
    let tip = |bench: &Bench| !bench.texts_with("0 = bent").is_empty();
    let rest = |bench: &mut Bench, at: egui::Pos2| {
        bench.point(at);
        bench.run(1500);
    };
    rest(&mut bench, track.lerp_inside(egui::vec2(0.9, 0.5)));
    assert!(tip(&bench), "it tells what it is: {:?}", bench.texts());
    let (from, to) = (
        track.right_center(),
        track.lerp_inside(egui::vec2(0.7, 0.5)),
    );
    bench.press_at(from);
    rest(&mut bench, to);
    assert!(!tip(&bench), "not in a drag");
    bench.release_at(to);
    bench.run(1500);
    assert!(!tip(&bench), "not after a drag");
    rest(&mut bench, track.lerp_inside(egui::vec2(0.4, 0.5)));
    assert!(!tip(&bench), "not while the pointer stays");
    rest(&mut bench, egui::pos2(2.0, 2.0));
    rest(&mut bench, track.lerp_inside(egui::vec2(0.4, 0.5)));
    assert!(tip(&bench), "again once it came back");
}

#[test]
fn a_refused_text_goes_with_the_next_key_stop_or_motion() {
    type Way = fn(&mut Bench);
    let ways: [(&str, Way); 6] = [
        ("another tab", |bench| {
            bench.click("Tune");
            bench.run(60);
            assert!(!bench.shows("Correct the plan first."));
            bench.click("Live");
        }),
        ("Space", |bench| bench.key(egui::Key::Space)),
        ("Enter", |bench| bench.key(egui::Key::Enter)),
        ("Esc", |bench| bench.key(egui::Key::Escape)),
        ("STOP", |bench| bench.click_button("STOP")),
        ("a preset", |bench| bench.click("Half")),
    ];
    for (what, way) in ways {
        let mut bench = Bench::armed();
        bench.type_into("Index force number", "abc");
        bench.key(egui::Key::Enter);
        bench.run(100);
        assert_eq!(bench.typed("Index force number"), "abc", "told why");
        way(&mut bench);
        bench.run(100);
        assert_eq!(bench.typed("Index force number"), "500", "{what}");
    }
}

#[test]
fn what_the_hand_holds_otherwise_stands_beside_what_is_set() {
    let mut bench = Bench::live();
    let name = "Index speed number 200 · hand 1000";
    assert!(!bench.shows(name));
    bench.gentle();
    bench.run(60);
    assert_eq!(bench.reading(name), "hand 1000");
    assert_eq!(
        bench.reading("Index force number 500 · hand 1000"),
        "hand 1000"
    );
    bench.click("Arm the hand");
    bench.run(1500);
    assert!(!bench.shows(name), "{:?}", bench.texts_with("hand"));
}

#[test]
fn one_line_says_what_the_hand_holds_and_a_click_keeps_that() {
    let mut bench = Bench::live();
    bench.gentle();
    bench.run(60);
    let told = bench.texts_with("Hand: speed 1000, force 1000");
    assert_eq!(told.len(), 1, "{told:?}");
    bench.click_button("Use the hand's values");
    bench.run(60);
    for setting in ["Index force number", "Little speed number"] {
        assert_eq!(bench.typed(setting), "1000");
    }
    assert!(bench.texts_with("Hand: speed").is_empty());
    bench.run(500);
    assert!(bench.writes().is_empty());
}

#[test]
fn newtons_stand_beside_the_grams_of_a_joint_that_was_measured() {
    let measured: Endpoint = "tcp:127.0.0.1:6000?unit=1".parse().unwrap();
    let mut bench = Bench::kept(SimConfig::default(), "tcp:127.0.0.1:6000?unit=2", LARGE);
    bench.wait(1000);
    let file = newtons_file::file_of(&bench.folder().join("kept/settings.toml"), &measured);
    let point = |load: u16| {
        let hand_g = f64::from(150 + 60 * load);
        ScalePoint {
            load: load.into(),
            hand_g,
            scale_g: 0.7 * hand_g,
            tip_n: None,
        }
    };
    let index = JointPoints {
        limit: Force::GENTLE,
        day: "2026-11-30".into(),
        points: (0..5).map(point).collect(),
    };
    newtons_file::put(&file.unwrap(), Dof::Index, index).unwrap();
    let index = |bench: &Bench| bench.reading("Index live force");
    assert!(index(&bench).ends_with(" g"), "{}", index(&bench));
    bench.act(Action::Connect(measured));
    for _ in 0..20 {
        std::thread::sleep(Duration::from_millis(20));
        bench.run(100);
    }
    let text = index(&bench);
    assert!(text.contains(" g ") && text.ends_with(" N"), "{text}");
    let ring = bench.reading("Ring live force");
    assert!(ring.ends_with(" g"), "{ring}");
    bench.act(Action::Force(Some(Dof::Index), Force::nearest(500)));
    bench.run(60);
    let slider = bench.rect(Role::Slider, "Index force threshold");
    bench.point(slider.center());
    bench.run(1500);
    let told = bench.texts_with("500 g are 3.4 N at this joint.");
    assert_eq!(told.len(), 1, "{:?}", bench.texts_with("at this joint"));
}
