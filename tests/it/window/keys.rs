//! Claims about the keyboard: what each key does, in which order Tab walks, and that everything has a name.

use crate::setup::window::{Bench, LARGE, Role};
use egui::{Key, Modifiers};
use handscope::app::action::Action;
use handscope::app::settings::{AngleUnit, Language, PlotWindow, Settings, Theme};
use handscope::hand::Dof;
use handscope::hand::kinematics::Side;
use handscope::sim::SimConfig;
use handscope::ui::View;

/// Nodes that a person can act on.
const INTERACTIVE: [Role; 7] = [
    Role::Button,
    Role::CheckBox,
    Role::ComboBox,
    Role::Link,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
];

#[test]
fn arming_by_key_needs_what_arming_by_click_needs() {
    let mut bench = Bench::live();
    bench.key(Key::A);
    bench.wait(300);
    assert!(
        !bench.state().hand().connection.is_armed(),
        "one key alone arms nothing"
    );
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    assert!(bench.state().hand().connection.is_armed());
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    assert!(!bench.state().hand().connection.is_armed());
}

#[test]
fn presets_by_key_move_only_an_armed_hand() {
    let mut bench = Bench::live();
    for key in [Key::O, Key::H, Key::C] {
        bench.key_with(Modifiers::SHIFT, key);
        bench.wait(200);
    }
    assert_eq!(bench.writes().len(), 0, "not armed");
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    bench.key_with(Modifiers::SHIFT, Key::H);
    bench.wait(6000);
    assert!(
        (bench.angle(Dof::Index) - 500).abs() < 30,
        "{}",
        bench.angle(Dof::Index)
    );
}

#[test]
fn a_number_gives_the_keyboard_to_a_joint_and_arrows_then_move_it() {
    let mut bench = Bench::live();
    bench.key(Key::Num4);
    assert!(
        bench.is_focused("Index force threshold"),
        "not armed: the threshold"
    );
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    for (key, name) in [
        (Key::Num1, "Little"),
        (Key::Num2, "Ring"),
        (Key::Num3, "Middle"),
        (Key::Num5, "Thumb bend"),
        (Key::Num6, "Thumb rotate"),
        (Key::Num4, "Index"),
    ] {
        bench.key(key);
        bench.step();
        assert!(bench.is_focused(&format!("{name} angle target")), "{name}");
    }
    bench.key_with(Modifiers::SHIFT, Key::ArrowLeft);
    bench.wait(100);
    let target = bench.state().hand().controls.joints[Dof::Index]
        .target
        .unwrap()
        .get();
    assert_eq!(target, 900, "ten steps of ten");
}

#[test]
fn switches_of_the_window_have_keys() {
    let mut bench = Bench::live();
    bench.key_with(Modifiers::COMMAND, Key::L);
    assert_eq!(bench.state().settings.language, Language::Zh);
    bench.key_with(Modifiers::COMMAND, Key::L);
    bench.key_with(Modifiers::COMMAND, Key::D);
    assert_eq!(bench.state().settings.theme, Theme::Light);
    bench.key(Key::U);
    assert_eq!(bench.state().settings.angle_unit, AngleUnit::Degrees);
    bench.key(Key::T);
    bench.wait(100);
    assert!(
        !bench.state().hand().readings.tare.can_undo(),
        "a plain letter"
    );
    bench.key_with(Modifiers::SHIFT, Key::T);
    bench.wait(100);
    assert!(bench.state().hand().readings.tare.can_undo());
    bench.key_with(Modifiers::COMMAND, Key::T);
    bench.wait(100);
    assert!(!bench.state().hand().readings.tare.can_undo());
    bench.key(Key::P);
    bench.step();
    assert!(bench.is_on("Pause the plots"), "the plots hold still");
    for (key, name) in [
        (Key::Num2, "tune"),
        (Key::Num3, "sessions"),
        (Key::Num4, "connection"),
        (Key::Num5, "inputs"),
        (Key::Num6, "faults"),
        (Key::Num6, "inputs"),
        (Key::Num1, "live"),
    ] {
        bench.key_with(Modifiers::COMMAND, key);
        assert_eq!(bench.view(), View::by_name(name).unwrap());
    }
    assert_eq!(bench.writes().len(), 0, "none of them writes");
}

#[test]
fn keys_are_letters_while_somebody_types() {
    let mut bench = Bench::live();
    bench.key(Key::N);
    bench.step();
    for key in [Key::U, Key::P, Key::T, Key::Num4] {
        bench.key(key);
    }
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    assert!(!bench.state().hand().connection.is_armed());
    assert_eq!(bench.state().settings.angle_unit, AngleUnit::Raw);
    assert!(!bench.state().hand().readings.tare.can_undo());
}

#[test]
fn a_capital_letter_that_missed_its_field_moves_and_arms_nothing() {
    let mut bench = Bench::armed();
    let writes = bench.writes().len();
    bench.type_into("Index force number", "700");
    bench.key(Key::Enter);
    bench.run(100);
    let limits = bench.writes().len();
    assert!(limits > writes, "the number counts");
    bench.key_with(Modifiers::SHIFT, Key::F);
    bench.key_with(Modifiers::SHIFT, Key::C);
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.run(300);
    assert_eq!(
        bench.writes().len(),
        limits,
        "the field had the keyboard just now"
    );
    assert!(bench.state().hand().connection.is_armed());
    bench.run(1000);
    bench.key_with(Modifiers::SHIFT, Key::F);
    bench.run(300);
    assert!(bench.writes().len() > limits);
}

#[test]
fn the_list_of_keys_opens_and_closes_and_stop_works_over_it() {
    let mut bench = Bench::armed();
    for open in [Key::F1, Key::Questionmark] {
        bench.key(open);
        bench.step();
        assert!(bench.shows("Shift+A") && bench.shows("Arm or disarm"));
        for told in ["arrows 10, with Shift 100", "a click selects all"] {
            assert_eq!(bench.texts_with(told).len(), 1, "{told}");
        }
        for zoom in ["Ctrl++", "Ctrl+-", "Ctrl+0"] {
            assert!(bench.shows(zoom), "{zoom}");
        }
        bench.key(open);
        bench.step();
        assert!(!bench.shows("Shift+A"));
    }
    bench.click("Window menu");
    bench.run(60);
    bench.click("Keys");
    bench.run(60);
    assert!(bench.shows("Shift+A"));
    bench.click_button("Close the list of keys");
    bench.step();
    assert!(!bench.shows("Shift+A"));
    bench.key(Key::F1);
    bench.step();
    bench.click_button("STOP");
    bench.wait(200);
    assert!(
        !bench.state().hand().connection.is_armed(),
        "the list does not cover STOP"
    );
    assert!(!bench.shows("Shift+A"), "a press beside it closes it");
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.wait(300);
    bench.key(Key::F1);
    bench.key(Key::Space);
    bench.wait(200);
    assert!(
        !bench.state().hand().connection.is_armed(),
        "and Space stops over it"
    );
}

/// Opens something, and tells whether it is open.
type Opened = (fn(&mut Bench), fn(&Bench) -> bool);

/// What Esc closes: the list of keys, a note, a number that is being typed, a menu.
const OPENED: [Opened; 5] = [
    (|bench| bench.key(Key::F1), |bench| bench.shows("Shift+A")),
    (
        |bench| bench.key(Key::N),
        |bench| bench.shows("Words of the note"),
    ),
    (
        |bench| bench.type_into("Index force number", "9"),
        |bench| bench.typed("Index force number") != "500",
    ),
    (
        |bench| bench.click_button("Window menu"),
        |bench| bench.shows("Reset layout"),
    ),
    (
        |bench| bench.key_with(Modifiers::COMMAND, Key::K),
        |bench| bench.shows("Commands"),
    ),
];

#[test]
fn escape_first_closes_what_is_open_while_the_hand_rests_and_stops_when_pressed_again() {
    for (index, (open, is_open)) in OPENED.into_iter().enumerate() {
        let mut bench = Bench::live();
        bench.wait(1500);
        open(&mut bench);
        bench.run(200);
        assert!(is_open(&bench), "{index}: {:?}", bench.texts());
        bench.key(Key::Escape);
        bench.run(300);
        assert!(!is_open(&bench), "{index}");
        assert_eq!(bench.writes(), [], "{index}: no stop");
        bench.key(Key::Escape);
        bench.run(100);
        assert!(!bench.writes().is_empty(), "{index}: a stop");
    }
}

#[test]
fn escape_stops_an_armed_hand_whatever_is_open() {
    for (index, (open, is_open)) in OPENED.into_iter().enumerate() {
        let mut bench = Bench::armed();
        open(&mut bench);
        bench.run(200);
        assert!(is_open(&bench), "{index}");
        bench.key(Key::Escape);
        bench.run(100);
        assert!(!bench.state().hand().connection.is_armed(), "{index}");
        // What covers the window goes with the stop; what was being written does not.
        let covers = matches!(index, 0 | 4);
        assert!(!covers || !is_open(&bench), "{index}");
    }
}

#[test]
fn the_zoom_is_kept_and_comes_back() {
    let mut bench = Bench::live();
    let wide = bench.rect(Role::Button, "STOP").width();
    bench.key_with(Modifiers::COMMAND, Key::Plus);
    bench.run(100);
    let zoom = bench.state().settings.zoom;
    assert!(f32::from(zoom) > 1.05, "{zoom:?}");
    let kept = Settings {
        zoom,
        ..Settings::default()
    };
    let mut again = Bench::with(kept);
    again.wait(1000);
    assert_eq!(again.state().settings.zoom, zoom);
    assert!((again.zoom() - f32::from(zoom)).abs() < 0.01);
    assert!(again.rect(Role::Button, "STOP").width() > 1.0 && wide > 1.0);
    again.key_with(Modifiers::COMMAND, Key::Num0);
    again.run(100);
    assert_eq!(f32::from(again.state().settings.zoom), 1.0);
}

#[test]
fn everything_that_can_be_used_has_a_name_in_every_view_and_language() {
    let mut bench = Bench::armed();
    for language in [Language::En, Language::Zh] {
        for view in View::ALL {
            bench.show(view);
            bench.step();
            for role in INTERACTIVE {
                for (name, rect) in bench.all(role) {
                    assert!(
                        !name.trim().is_empty(),
                        "{role:?} at {rect} in {view:?}, {language:?}"
                    );
                }
            }
        }
        bench.key_with(Modifiers::COMMAND, Key::L);
    }
}

#[test]
fn tab_walks_from_the_top_bar_over_the_joints_to_the_view() {
    let mut bench = Bench::armed();
    let mut walked = Vec::new();
    for _ in 0..200 {
        bench.key(Key::Tab);
        bench.step();
        let Some(name) = bench.focused() else {
            continue;
        };
        if walked.first() == Some(&name) {
            break;
        }
        walked.push(name);
    }
    let at = |name: &str| {
        let found = walked.iter().position(|one| one == name);
        found.unwrap_or_else(|| panic!("Tab never comes to {name}: {walked:?}"))
    };
    let order = [
        "STOP",
        "Disarm the hand",
        "Live",
        "Little angle target",
        "Little force threshold",
        "Little speed",
        "Ring angle target",
        "Thumb rotate speed",
        "Open all",
        "Pause the plots",
    ];
    for pair in order.windows(2) {
        assert!(at(pair[0]) < at(pair[1]), "{pair:?} in {walked:?}");
    }
}

#[test]
fn the_palette_finds_a_view_an_act_and_a_pose_in_either_language() {
    let mut bench = Bench::live();
    for (typed, view) in [("traf", View::Traffic), ("连接", View::Connection)] {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", typed);
        bench.key(Key::Enter);
        bench.run(100);
        assert_eq!(bench.view(), view, "{typed}");
        assert!(!bench.shows("Commands"), "it is closed");
    }
    bench.key_with(Modifiers::COMMAND, Key::K);
    bench.run(100);
    bench.type_into("Commands", "dark light");
    bench.key(Key::Enter);
    bench.run(100);
    assert_eq!(bench.state().settings.theme, Theme::default().other());
    // What has no key of its own is found as well: a setting, with its value.
    for typed in ["hold to run", "window 5 min"] {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", typed);
        bench.key(Key::Enter);
        bench.run(100);
    }
    assert!(bench.state().settings.hold_to_run);
    assert_eq!(bench.state().settings.plot_window, PlotWindow::M5);
}

#[test]
fn the_palette_saves_a_pose_and_finds_a_hand_used_before() {
    let mut bench = Bench::kept(SimConfig::default(), "tcp:127.0.0.1:6000", LARGE);
    bench.wait(1000);
    let choose = |bench: &mut Bench, typed: &str| {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", typed);
        bench.key(Key::Enter);
        bench.run(200);
    };
    bench.act(Action::Connect("tcp:127.0.0.1:6001".parse().unwrap()));
    bench.wait(1000);
    let poses = bench.state().poses.library.poses.len();
    choose(&mut bench, "save pose");
    assert_eq!(bench.state().poses.library.poses.len(), poses + 1);
    choose(&mut bench, "left hand");
    assert_eq!(bench.state().hand().side, Side::Left);
    choose(&mut bench, "disconnect");
    bench.wait(1000);
    assert_eq!(bench.state().hand().connection.endpoint, None);
    choose(&mut bench, "connect 6001");
    let endpoint = bench.state().hand().connection.endpoint.clone();
    assert_eq!(endpoint, Some("tcp:127.0.0.1:6001".parse().unwrap()));
    assert!(bench.writes().is_empty(), "none of them moves a hand");
}

#[test]
fn the_palette_finds_what_a_view_holds_and_what_a_setting_is_called() {
    let mut bench = Bench::live();
    for (typed, view) in [
        ("flash", View::Device),
        ("闪存", View::Device),
        ("export", View::Recordings),
        ("gateway", View::Inputs),
        ("trial", View::Tune),
    ] {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", typed);
        bench.key(Key::Enter);
        bench.run(100);
        assert_eq!(bench.view().tab(), view.tab(), "{typed}");
    }
    for typed in ["language", "语言", "theme", "add a hand", "index", "速度"] {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", typed);
        bench.run(100);
        assert!(!bench.shows("No match."), "{typed}");
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
    }
}

#[test]
fn the_places_stay_where_they_are_whatever_the_hand_says() {
    let mut bench = Bench::live();
    let places = ["Live", "Tune", "Recordings", "Hand", "Share"];
    let at = |bench: &Bench| places.map(|name| bench.rect(Role::Button, name).min.x);
    let before = at(&bench);
    bench.click("Arm the hand");
    bench.run(300);
    assert_eq!(at(&bench), before, "armed");
    bench.act(Action::Disconnect);
    bench.run(300);
    assert_eq!(at(&bench), before, "without a hand");
}

#[test]
fn the_palette_moves_only_an_armed_hand_and_esc_closes_it() {
    let mut bench = Bench::live();
    let take_point = |bench: &mut Bench| {
        bench.key_with(Modifiers::COMMAND, Key::K);
        bench.run(100);
        bench.type_into("Commands", "point");
        bench.key(Key::Enter);
        bench.run(1500);
    };
    take_point(&mut bench);
    assert_eq!(bench.writes().len(), 0, "not armed");
    assert!(bench.shows("Commands"), "nothing was chosen");
    assert!(
        bench.shows("Not armed: press Arm first."),
        "and it says why"
    );
    bench.key(Key::Escape);
    bench.run(300);
    assert!(!bench.shows("Commands"));
    assert_eq!(bench.writes(), [], "no stop");
    // A key so soon after a field had the keyboard may be meant for it.
    bench.run(1200);
    bench.key_with(Modifiers::SHIFT, Key::A);
    bench.run(300);
    take_point(&mut bench);
    bench.wait(4000);
    assert!(bench.angle(Dof::Ring) < 900, "it bends");
    assert!(bench.angle(Dof::Index) > 900, "it points");
}
