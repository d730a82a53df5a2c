//! The window against hand-made states: what is there, what may be pressed, what it asks for. No hand, no renderer.

use crate::setup::states;
use crate::setup::view::{self, LARGE, SMALL, Shown};
use egui::accesskit::{Role, Toggled};
use egui::{Key, Modifiers, Rect, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use handscope::app::action::Action;
use handscope::app::scan::{IdRange, ScanTarget};
use handscope::app::settings::{KnownHand, Language, Theme};
use handscope::app::state::State;
use handscope::hand::kinematics::Side;
use handscope::hand::{Angle, Dof, Force, Gesture, Speed};
use handscope::inputs::pad::source::PadView;
use handscope::record::{Hold, LinkState};
use handscope::shell::headless::labels::displayed;
use handscope::ui::View;

fn open_at(state: State, view: View, size: Vec2) -> Harness<'static, Shown> {
    view::open(state, view, view::display(size))
}

fn open(state: State) -> Harness<'static, Shown> {
    open_at(state, View::Live, LARGE)
}

fn actions(harness: &mut Harness<'static, Shown>) -> Vec<Action> {
    harness.run_steps(2);
    std::mem::take(&mut harness.state_mut().actions)
}

fn in_chinese(mut state: State) -> State {
    state.settings.language = Language::Zh;
    state
}

#[test]
fn stop_is_there_whole_and_enabled_in_every_view_language_size_and_state() {
    let states: [fn() -> State; 5] = [
        states::empty,
        states::live,
        states::armed,
        states::faulted,
        states::lost,
    ];
    let small = states.into_iter().map(|make| (make, SMALL));
    for (make, size) in small.chain([(states[1], LARGE)]) {
        for view in View::ALL {
            for (state, name) in [(make(), "STOP"), (in_chinese(make()), "停止")] {
                let mut harness = open_at(state, view, size);
                let stop = harness.get_by_role_and_label(Role::Button, name);
                assert!(!stop.accesskit_node().is_disabled());
                let screen = Rect::from_min_size(egui::Pos2::ZERO, size);
                assert!(screen.contains_rect(stop.rect()), "{:?}", stop.rect());
                assert!(stop.rect().width() >= 120.0 && stop.rect().height() >= 36.0);
                stop.click();
                assert_eq!(actions(&mut harness), [Action::Stop]);
            }
        }
    }
}

#[test]
fn space_and_escape_stop_from_anywhere() {
    for key in [Key::Space, Key::Escape] {
        for view in View::ALL {
            let mut harness = open_at(states::armed(), view, LARGE);
            harness.key_press(key);
            assert_eq!(actions(&mut harness), [Action::Stop], "{key:?} {view:?}");
        }
    }
}

#[test]
fn space_on_a_button_that_has_the_keyboard_stops_and_does_not_press_it() {
    let mut harness = open(states::live());
    harness.get_by_label("Arm the hand").focus();
    harness.run_steps(2);
    harness.key_press(Key::Space);
    assert_eq!(actions(&mut harness), [Action::Stop]);
}

#[test]
fn escape_stops_while_typing_and_space_types() {
    let mut harness = open_at(states::armed(), View::Connection, LARGE);
    harness
        .get_by_role_and_label(Role::TextInput, ADDRESS)
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::Space);
    assert_eq!(actions(&mut harness), []);
    harness
        .get_by_role_and_label(Role::TextInput, ADDRESS)
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    assert_eq!(actions(&mut harness), [Action::Stop]);
}

/// Opens the drawer of named gestures on Live.
fn open_gestures(harness: &mut Harness<'_, Shown>) {
    harness.get_by_label("Gestures").click();
    harness.run_steps(4);
}

#[test]
fn every_control_has_its_name() {
    let mut harness = open(states::armed());
    open_gestures(&mut harness);
    for joint in [
        "Little",
        "Ring",
        "Middle",
        "Index",
        "Thumb bend",
        "Thumb rotate",
    ] {
        for (role, what) in [
            (Role::Slider, "angle target"),
            (Role::Slider, "force threshold"),
            (Role::Slider, "speed"),
            (Role::TextInput, "angle number"),
            (Role::TextInput, "force number"),
            (Role::TextInput, "speed number"),
            (Role::Button, "lock"),
        ] {
            harness.get_by_role_and_label(role, &format!("{joint} {what}"));
        }
    }
    for name in [
        "Disarm the hand",
        "Open all",
        "Faults",
        "Pause the plots",
        "Plot window",
        "Gesture 1 open",
        "Gesture 14 cup",
        "Save pose",
        "Window menu",
        "Link state: Armed",
    ] {
        harness.get_by_label(name);
    }
    harness.get_by_label("More for the plots").click();
    harness.run_steps(3);
    harness.get_by_label("Thresholds");
}

#[test]
fn angles_can_be_moved_only_while_armed_and_not_locked() {
    for state in [
        states::empty(),
        states::live(),
        states::faulted(),
        states::lost(),
    ] {
        let mut harness = open_at(state, View::Poses, LARGE);
        harness.get_by_label("In the hand").click();
        harness.run_steps(4);
        for name in [
            "Index angle target",
            "Index angle number",
            "Open all",
            "Gesture 1",
        ] {
            let node = harness.query_all_by_label_contains(name).next().unwrap();
            assert!(node.accesskit_node().is_disabled(), "{name}");
        }
        let force = harness.get_by_label("Index force threshold");
        assert!(!force.accesskit_node().is_disabled());
    }
    let harness = open(states::armed());
    let index = harness.get_by_label("Index angle target");
    assert!(!index.accesskit_node().is_disabled());
    let locked = harness.get_by_label("Thumb rotate angle target");
    assert!(locked.accesskit_node().is_disabled());
    let lock = harness.get_by_label("Thumb rotate lock");
    assert_eq!(lock.accesskit_node().toggled(), Some(Toggled::True));
}

#[test]
fn dragging_a_track_asks_for_targets() {
    let mut harness = open(states::armed());
    let rect = harness.get_by_label("Index angle target").rect();
    harness.drag_at(rect.center());
    harness.run_steps(1);
    harness.hover_at(rect.right_center());
    harness.run_steps(1);
    harness.drop_at(rect.right_center());
    let asked = actions(&mut harness);
    assert!(!asked.is_empty());
    for action in &asked {
        assert!(
            matches!(action, Action::Target(Dof::Index, _)),
            "{action:?}"
        );
    }
    assert_eq!(asked.last(), Some(&Action::Target(Dof::Index, Angle::MAX)));
}

#[test]
fn a_locked_or_disarmed_track_asks_for_nothing_when_dragged() {
    for (state, name) in [
        (states::live(), "Index angle target"),
        (states::armed(), "Thumb rotate angle target"),
    ] {
        let mut harness = open(state);
        let rect = harness.get_by_label(name).rect();
        harness.drag_at(rect.center());
        harness.run_steps(1);
        harness.hover_at(rect.left_center());
        harness.run_steps(1);
        harness.drop_at(rect.left_center());
        assert_eq!(actions(&mut harness), []);
    }
}

#[test]
fn arrows_step_by_ten_and_with_shift_by_a_hundred() {
    let mut harness = open(states::armed());
    for (key, modifiers, want) in [
        (Key::ArrowRight, Modifiers::NONE, 310),
        (Key::ArrowLeft, Modifiers::NONE, 290),
        (Key::ArrowRight, Modifiers::SHIFT, 400),
        (Key::ArrowLeft, Modifiers::SHIFT, 200),
    ] {
        harness.get_by_label("Index angle target").focus();
        harness.run_steps(2);
        harness.key_press_modifiers(modifiers, key);
        let want = Action::Target(Dof::Index, Angle::nearest(want));
        assert_eq!(actions(&mut harness), [want]);
    }
}

#[test]
fn a_typed_number_counts_only_with_enter() {
    let mut harness = open(states::armed());
    let field = |harness: &Harness<'static, Shown>| {
        harness
            .get_by_role_and_label(Role::TextInput, "Ring force number")
            .focus();
    };
    let retype = |harness: &mut Harness<'static, Shown>, text: &str| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.run_steps(1);
        harness
            .get_by_role_and_label(Role::TextInput, "Ring force number")
            .type_text(text);
        harness.run_steps(2);
    };
    field(&harness);
    harness.run_steps(2);
    retype(&mut harness, "750");
    assert_eq!(actions(&mut harness), [], "nothing before Enter");
    harness.key_press(Key::Enter);
    let want = Action::Force(Some(Dof::Ring), Force::nearest(750));
    assert_eq!(actions(&mut harness), [want]);
    for wrong in ["9000", "1,5", "-1", ""] {
        field(&harness);
        harness.run_steps(2);
        retype(&mut harness, wrong);
        harness.key_press(Key::Enter);
        assert_eq!(actions(&mut harness), [], "{wrong}");
    }
    field(&harness);
    harness.run_steps(2);
    retype(&mut harness, "900");
    harness.key_press(Key::Tab);
    assert_eq!(actions(&mut harness), [], "leaving the field is no Enter");
}

#[test]
fn force_and_speed_are_staged_while_not_armed() {
    let mut harness = open(states::live());
    harness.get_by_label("Little speed").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowRight);
    let want = Action::Speed(Some(Dof::Little), Speed::nearest(210));
    assert_eq!(actions(&mut harness), [want]);
}

#[test]
fn what_is_not_known_is_a_dash() {
    let harness = open(states::empty());
    for (name, value) in [
        ("Index actual angle", "-"),
        ("Index live force", "- g"),
        ("Index current and temperature", "- mA   - °C"),
        ("Index status", "-"),
        ("Index normal force", "-"),
        ("Thumb force at the drawn finger", "- g"),
    ] {
        let node = harness
            .query_all_by_role(Role::Label)
            .find(|node| node.accesskit_node().label().as_deref() == Some(name))
            .unwrap_or_else(|| panic!("{name}"));
        let spoken = node.value().unwrap();
        assert_eq!(displayed(name, &spoken).trim(), value, "{name}");
        // Screen readers read the value of a label, and nothing else.
        assert!(spoken.starts_with(name), "{spoken}");
    }
    let target = harness.get_by_label("Index angle target");
    assert_eq!(target.accesskit_node().numeric_value(), None);
    harness.get_by_label("Not read yet");
    harness.get_by_label("NO HAND");
}

#[test]
fn old_values_show_their_age_and_a_lost_link_is_said_in_words() {
    let mut harness = open(states::lost());
    harness.get_by_label("Age 2.4 s");
    harness.get_by_label("LINK LOST");
    harness.get_by_label("Next try in 0.6 s");
    let body = harness.get_by_label_contains("may still be moving or gripping");
    assert!(body.value().unwrap().contains("5 requests"));
    assert!(
        harness
            .get_by_label("Arm the hand")
            .accesskit_node()
            .is_disabled()
    );
    harness.get_by_label("Faults").click();
    harness.run_steps(3);
    assert!(
        harness
            .get_by_label("Clear errors")
            .accesskit_node()
            .is_disabled()
    );
    assert!(harness.query_by_label("No faults").is_none());
    harness.get_by_label("No faults when last read");
}

#[test]
fn an_unconfirmed_stop_is_an_alarm() {
    let alarm = || {
        let mut state = states::live();
        let at = state.now;
        state.hand_mut().connection.status.state = LinkState::Holding;
        state.hand_mut().connection.status.hold = Hold::Alarm { at };
        state
    };
    open(alarm()).get_by_label("STOP NOT CONFIRMED");
    open(in_chinese(alarm())).get_by_label("停止未确认");
}

#[test]
fn faults_are_listed_with_advice_and_over_temperature_is_said_to_stay() {
    let harness = open_at(states::faulted(), View::Faults, LARGE);
    harness.get_by_label("Index: Stall");
    harness.get_by_label("What to do: Free the finger or open it, then clear errors.");
    harness
        .get_by_label("What to do: Let it cool: this fault cannot be cleared and ends by itself.");
    let mut harness = open(states::faulted());
    // What says that it shows them never shuts them.
    for _ in 0..2 {
        harness.get_by_label("Show faults").click();
        harness.run_steps(3);
        assert_eq!(harness.state().window.view(), View::Faults);
    }
    harness.get_by_label("Clear errors").click();
    assert_eq!(actions(&mut harness), [Action::ClearErrors]);
    harness.get_by_label("Close faults").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Clear errors").is_none());
    assert_eq!(harness.state().window.view(), View::Live);
}

#[test]
fn simulated_is_badged_and_a_real_hand_is_not() {
    for view in View::ALL {
        open_at(states::live(), view, LARGE).get_by_label("SIMULATED");
        let real = open_at(states::lost(), view, LARGE);
        assert!(real.query_by_label("SIMULATED").is_none());
    }
}

#[test]
fn arming_and_disarming_is_one_press() {
    let mut harness = open(states::live());
    harness.get_by_label("Arm the hand").click();
    assert_eq!(actions(&mut harness), [Action::Arm]);
    let mut harness = open(states::armed());
    harness.get_by_label("Disarm the hand").click();
    assert_eq!(actions(&mut harness), [Action::Disarm]);
}

#[test]
fn gestures_start_by_number_and_take_names() {
    let mut harness = open(states::armed());
    open_gestures(&mut harness);
    harness.get_by_label("Gesture 3 fist").click();
    harness.run_steps(2);
    assert_eq!(actions(&mut harness), [], "it is shown before it runs");
    harness.get_by_label_contains("Fixed by the maker");
    harness.get_by_label("Start gesture 3").click();
    let three = Gesture::nearest(3);
    assert_eq!(actions(&mut harness), [Action::Gesture(three)]);
    let seven = Gesture::nearest(7);
    let mut harness = open_at(states::armed(), View::Poses, LARGE);
    harness.get_by_label("In the hand").click();
    harness.run_steps(2);
    harness.get_by_label("Gesture 40");
    assert!(harness.query_by_label("Gesture route").is_none());
    harness.get_by_label("Name gestures").click();
    harness.run_steps(2);
    harness.get_by_label("Name of gesture 7").focus();
    harness.run_steps(2);
    harness.get_by_label("Name of gesture 7").type_text("point");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    assert_eq!(
        actions(&mut harness),
        [Action::NameGesture(seven, "point".into())]
    );
}

const ADDRESS: &str = "Address, port or name";

fn at_connection(state: State) -> Harness<'static, Shown> {
    open_at(state, View::Connection, LARGE)
}

/// Types this in place of what stands in the field of the address.
fn type_address(harness: &mut Harness<'static, Shown>, name: &str, text: &str) {
    let field = (Role::TextInput, name);
    harness.get_by_role_and_label(field.0, field.1).focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(1);
    let edit = harness.get_by_role_and_label(field.0, field.1);
    edit.type_text(text);
    harness.run_steps(2);
}

#[test]
fn serial_ports_are_looked_for_once_when_the_connection_is_shown() {
    let mut state = states::empty();
    state.ports.clear();
    let mut harness = open_at(state, View::Live, LARGE);
    harness.state_mut().window.set_view(View::Connection);
    assert_eq!(actions(&mut harness), [Action::FindPorts]);
    harness.run_steps(5);
    assert_eq!(actions(&mut harness), []);
}

#[test]
fn a_click_on_a_way_to_connect_begins_an_address_of_it() {
    let mut harness = at_connection(states::empty());
    harness.get_by_label("Kind of link: Modbus TCP").click();
    harness.run_steps(3);
    harness.get_by_label("Connect").click();
    let endpoint = "tcp:192.168.11.210:6000?unit=255".parse().unwrap();
    assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
    harness.get_by_label("Kind of link: RS485").click();
    harness.run_steps(3);
    let missing = "The port or address is missing";
    assert!(harness.query_by_label_contains(missing).is_none());
    harness.get_by_label("Connect").click();
    harness.run_steps(2);
    assert_eq!(actions(&mut harness), [], "no port yet");
    assert!(harness.query_all_by_label_contains(missing).count() > 0);
    harness.get_by_label("Refresh").click();
    assert_eq!(actions(&mut harness), [Action::FindPorts]);
}

#[test]
fn an_address_is_recognised_while_it_is_typed_and_enter_connects() {
    for (typed, words, endpoint) in [
        (
            "127.0.0.1:7650",
            "Modbus TCP, port 7650, unit 255",
            "tcp:127.0.0.1:7650?unit=255",
        ),
        (
            "10.0.0.7",
            "Modbus TCP, port 6000, unit 255",
            "tcp:10.0.0.7:6000?unit=255",
        ),
        (
            "[::1]:7650",
            "Modbus TCP, port 7650, unit 255",
            "tcp:[::1]:7650?unit=255",
        ),
        (
            "/dev/ttyUSB0",
            "RS485, 115200 baud, id 1",
            "rs485:/dev/ttyUSB0?baud=115200&id=1",
        ),
        (
            "COM3",
            "RS485, 115200 baud, id 1",
            "rs485:COM3?baud=115200&id=1",
        ),
        ("can0", "CAN, id 1", "can:can0?id=1"),
        (
            "usbcan:COM4?id=7",
            "Maker's CAN, 115200 baud, id 7",
            "usbcan:COM4?baud=115200&id=7",
        ),
        (
            "slcan:COM4",
            "CAN adapter, 1000000 bit/s, id 1",
            "slcan:COM4?bitrate=1000000&id=1",
        ),
        ("sim:", "Simulated, Soft ball", "sim:?seed=1&scenario=idle"),
    ] {
        let mut harness = at_connection(states::empty());
        type_address(&mut harness, ADDRESS, typed);
        harness.get_by_label(words);
        assert_eq!(actions(&mut harness), [], "nothing while it is typed");
        harness.key_press(Key::Enter);
        harness.run_steps(2);
        let endpoint = endpoint.parse().unwrap();
        assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
    }
}

#[test]
fn the_other_protocol_of_a_port_is_one_click_away() {
    let mut harness = at_connection(states::empty());
    type_address(&mut harness, ADDRESS, "/dev/ttyUSB0?id=4");
    harness.get_by_label("RS485, 115200 baud, id 4");
    harness.get_by_label("Modbus RTU instead").click();
    harness.run_steps(3);
    harness.get_by_label("Modbus RTU, 115200 baud, id 4");
    harness.get_by_label("RS485 instead");
    harness.get_by_label("Connect").click();
    let endpoint = "rtu:/dev/ttyUSB0?baud=115200&id=4".parse().unwrap();
    assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
}

#[test]
fn a_setting_that_is_changed_stands_in_the_address() {
    let mut harness = at_connection(states::empty());
    type_address(&mut harness, ADDRESS, "192.168.11.7");
    assert!(harness.query_by_label("Unit id").is_none(), "folded");
    harness.get_by_label("Change").click();
    harness.run_steps(2);
    type_address(&mut harness, "Unit id", "3");
    harness.get_by_label("Modbus TCP, port 6000, unit 3");
    // A wrong one is told, and stays to be mended.
    type_address(&mut harness, "Unit id", "300");
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(actions(&mut harness), []);
    assert!(harness.query_all_by_label_contains("0 to 255").count() > 0);
    type_address(&mut harness, "Unit id", "4");
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    let endpoint = "tcp:192.168.11.7:6000?unit=4".parse().unwrap();
    assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
}

#[test]
fn a_wrong_address_is_told_once_it_is_not_typed_any_more_and_a_name_is_none() {
    for (typed, is_wrong) in [
        ("192.168.11", true),
        ("192.168.11.999:6000", true),
        ("192.168.11.7", false),
        ("hand.local:6000", false),
        ("::1", false),
    ] {
        let mut harness = at_connection(states::empty());
        type_address(&mut harness, ADDRESS, typed);
        let told = |harness: &Harness<'static, Shown>| {
            let all =
                harness.query_all_by_label_contains("is not an IP address: write four numbers");
            all.count() > 0
        };
        assert!(!told(&harness), "not while it is typed");
        harness.key_press(Key::Enter);
        harness.run_steps(3);
        assert_eq!(told(&harness), is_wrong, "{typed}");
        let asked = actions(&mut harness);
        assert_eq!(asked.is_empty(), is_wrong, "{typed}: {asked:?}");
    }
}

#[test]
fn what_is_wrong_is_told_in_the_windows_language() {
    for (language, name, words) in [
        (Language::En, ADDRESS, "is not an address: type for example"),
        (Language::Zh, "地址、端口或名称", "不是地址"),
    ] {
        let mut state = states::empty();
        state.settings.language = language;
        let mut harness = at_connection(state);
        type_address(&mut harness, name, "usb:/dev/x");
        assert!(harness.query_by_label_contains(words).is_none());
        harness.key_press(Key::Enter);
        harness.run_steps(3);
        assert!(harness.query_all_by_label_contains(words).count() > 0);
    }
}

#[test]
fn connected_to_just_this_address_only_disconnect_is_offered() {
    let mut harness = at_connection(states::live());
    assert!(harness.query_by_label("Connect").is_none());
    harness.get_by_label("Disconnect");
    let field = harness.get_by_role_and_label(Role::TextInput, ADDRESS);
    field.focus();
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert_eq!(actions(&mut harness), [], "it is connected already");
    type_address(&mut harness, ADDRESS, "10.0.0.7");
    harness.get_by_label("Connect");
    harness.get_by_label("Disconnect").click();
    assert_eq!(actions(&mut harness), [Action::Disconnect]);
}

#[test]
fn speeds_and_scenarios_are_chosen_from_lists() {
    let mut harness = at_connection(states::empty());
    harness.get_by_label("Kind of link: Simulated").click();
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::ComboBox, "Scenario")
        .click();
    harness.run_steps(2);
    harness.get_by_label("Grasps by itself").click();
    harness.run_steps(2);
    harness.get_by_label("Connect").click();
    let endpoint = "sim:?seed=1&scenario=grasp".parse().unwrap();
    assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
    assert!(harness.query_by_label("Seed").is_none(), "in the drawer");
    harness.get_by_label("Kind of link: RS485").click();
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::ComboBox, "Baud")
        .click();
    harness.run_steps(2);
    for speed in ["115200", "57600", "19200", "921600"] {
        assert!(
            harness.query_all_by_label(speed).next().is_some(),
            "{speed}"
        );
    }
}

#[test]
fn hands_of_before_are_one_click_away_with_what_is_known_of_them() {
    let mut state = states::live();
    let spelled = [
        "rs485:/dev/ttyUSB0?baud=115200&id=1",
        "tcp:127.0.0.1:7650?unit=255",
        "sim:?seed=1&scenario=idle",
    ];
    state.settings.recent = spelled.map(str::to_owned).into();
    state.ports = vec![states::usb_port("/dev/ttyUSB0")];
    let known = KnownHand {
        name: "bench".into(),
        side: Some(Side::Left),
        last_day: "2026-11-23".into(),
        ..KnownHand::default()
    };
    state.settings.hands = [(spelled[1].to_owned(), known)].into();
    let mut harness = at_connection(state);
    harness.get_by_label(&format!("Connected: {}", spelled[2]));
    harness.get_by_label("Right hand · now plugged in");
    harness.get_by_label("bench");
    harness.get_by_label("Left hand · last used 2026-11-23");
    harness
        .get_by_label(&format!("Connect: {}", spelled[1]))
        .click();
    let endpoint = spelled[1].parse().unwrap();
    assert_eq!(actions(&mut harness), [Action::Connect(endpoint)]);
}

#[test]
fn the_place_just_typed_can_be_scanned() {
    let hosts = |text: &str| ScanTarget::Hosts(text.parse().unwrap());
    for (typed, wish) in [
        (
            "/dev/ttyUSB9",
            ScanTarget::Port("/dev/ttyUSB9".into(), IdRange::Few),
        ),
        ("can0", ScanTarget::Interface("can0".into(), IdRange::Few)),
        ("192.168.11.210", hosts("192.168.11.210:6000")),
        ("192.168.11.0/24", hosts("192.168.11.0/24")),
    ] {
        let mut harness = at_connection(states::empty());
        type_address(&mut harness, ADDRESS, typed);
        harness.get_by_label("Scan").click();
        assert_eq!(actions(&mut harness), [Action::Scan(wish)]);
    }
}

#[test]
fn the_address_is_that_of_the_connected_hand_as_short_as_it_means_the_same() {
    for (url, typed) in [
        (
            "rtu:/dev/ttyUSB3?baud=57600&id=4",
            "rtu:/dev/ttyUSB3?baud=57600&id=4",
        ),
        ("tcp:10.0.0.7:6000?unit=255", "10.0.0.7:6000"),
        (
            "slcan:/dev/ttyACM0?bitrate=500000&id=7",
            "slcan:/dev/ttyACM0?bitrate=500000&id=7",
        ),
        ("can:can0?id=1", "can0"),
    ] {
        let mut state = states::empty();
        let endpoint: handscope::transport::Endpoint = url.parse().unwrap();
        state.hand_mut().connection.endpoint = Some(endpoint);
        let harness = at_connection(state);
        let field = harness.get_by_role_and_label(Role::TextInput, ADDRESS);
        assert_eq!(field.accesskit_node().value().as_deref(), Some(typed));
        assert!(harness.query_by_label("Connect").is_none());
    }
}

/// A state with a gamepad that is read.
fn with_gamepad() -> State {
    let mut state = states::live();
    state.hand_mut().inputs.pad_view = Some(PadView {
        name: Some("Test pad".into()),
        ..PadView::default()
    });
    state
}

#[test]
fn once_there_is_a_gamepad_its_picture_and_its_list_are_shown() {
    let mut harness = open_at(with_gamepad(), View::Inputs, vec2(1440.0, 2000.0));
    harness.run_steps(3);
    harness.get_by_label("Share: Gamepad").click();
    harness.run_steps(3);
    assert!(harness.query_all_by_label("Test pad").count() > 0);
    // In the picture and beside it.
    let pinch = "A (bottom): Pose Pinch";
    assert_eq!(harness.query_all_by_label(pinch).count(), 2);
    let pose = harness.get_by_role_and_label(Role::ComboBox, "A (bottom)");
    pose.scroll_to_me();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::ComboBox, "A (bottom)")
        .click();
    harness.run_steps(3);
    assert!(harness.query_all_by_label("Pose Open").count() > 0);
    harness.state_mut().state.settings.hidden_poses = ["Pinch".to_owned()].into();
    harness.run_steps(3);
    let gone = "A (bottom): Pose Pinch (not in the library)";
    assert_eq!(harness.query_all_by_label(gone).count(), 2);
}

#[test]
fn the_link_lamp_opens_the_connection_and_tabs_open_their_views() {
    let mut harness = open(states::live());
    harness.get_by_label("Link state: Monitoring").click();
    harness.run_steps(2);
    assert_eq!(harness.state().window.view(), View::Connection);
    for (place, view) in [
        ("Tune", View::Tune),
        ("Recordings", View::Recordings),
        ("Share", View::Inputs),
        ("Hand", View::Connection),
        ("Live", View::Live),
    ] {
        let place = harness.get_by_role_and_label(Role::Button, place);
        place.click();
        harness.run_steps(2);
        assert_eq!(harness.state().window.view(), view);
    }
}

#[test]
fn the_place_of_the_device_opens_with_the_view_that_was_open_there_last() {
    let mut harness = open(states::live());
    for (button, view) in [
        ("Hand", View::Connection),
        ("Device", View::Device),
        ("Live", View::Live),
        ("Hand", View::Device),
    ] {
        let button = harness.get_by_role_and_label(Role::Button, button);
        button.click();
        harness.run_steps(2);
        assert_eq!(harness.state().window.view(), view);
    }
}

#[test]
fn theme_language_window_and_pause_are_asked_for() {
    let mut harness = open(states::live());
    for (entry, action) in [
        ("Dark or light", Action::Theme(Theme::Light)),
        ("中文", Action::Language(Language::Zh)),
    ] {
        harness.get_by_label("Window menu").click();
        harness.run_steps(3);
        harness.get_by_label(entry).click();
        assert_eq!(actions(&mut harness), [action]);
    }
    harness.get_by_label("Pause the plots").click();
    assert_eq!(actions(&mut harness), []);
    let node = harness.get_by_label("Pause the plots");
    assert_eq!(node.accesskit_node().toggled(), Some(Toggled::True));
}

#[test]
fn joints_do_not_overlap_and_stay_on_the_screen() {
    for size in [SMALL, LARGE, vec2(3840.0, 2160.0)] {
        for state in [states::armed(), in_chinese(states::armed())] {
            let harness = open_at(state, View::Live, size);
            let mut rects: Vec<Rect> = harness
                .query_all_by_role(Role::Slider)
                .chain(harness.query_all_by_role(Role::TextInput))
                .map(|node| node.rect())
                .collect();
            // In a small window force and speed of each joint are folded away; those of all joints stay.
            assert_eq!(rects.len(), if size == SMALL { 16 } else { 40 });
            let screen = Rect::from_min_size(egui::Pos2::ZERO, size);
            while let Some(rect) = rects.pop() {
                assert!(screen.contains_rect(rect), "{size} {rect}");
                assert!(rect.width() >= 40.0, "{size} {rect}");
                for other in &rects {
                    assert!(
                        !rect.shrink(0.5).intersects(*other),
                        "{size} {rect} {other}"
                    );
                }
            }
        }
    }
}

#[test]
fn an_armed_hand_that_is_asked_nothing_for_minutes_says_so() {
    let mut state = states::armed();
    state.now = handscope::hand::Moment::from_micros(400_000_000);
    let angle = state.hand_mut().readings.sample.angle.as_mut().unwrap();
    angle.asked = handscope::hand::Moment::from_micros(399_990_000);
    let harness = open(state);
    let said = harness.query_all_by_label_contains("No command for");
    assert!(said.count() > 0);
}
