//! Claims about what goes wrong: a pulled cable, drives with faults, values that no hand should send.

use crate::setup::window::{ANGLE_SET, Bench, CLEAR_ERROR, LARGE, Role, SPEED_SET};
use egui::{Key, Modifiers};
use handscope::app::action::Action;
use handscope::app::hand::list::HandsAction;
use handscope::app::notices::NoticeKind;
use handscope::hand::{Dof, Fault};
use handscope::record::LinkState;
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;
use std::time::Duration;

#[test]
fn an_unplugged_hand_is_said_in_words_and_cannot_be_driven() {
    let mut bench = Bench::armed();
    bench.unplug();
    bench.until(300, |bench| bench.shows("LINK LOST"));
    let words = bench.texts_with("may still be moving or gripping");
    assert_eq!(words.len(), 1, "{words:?}");
    assert!(words[0].contains("hung up"), "{words:?}");
    assert!(bench.shows("Link state: Link lost"));
    bench.wait(700);
    assert!(!bench.texts_with("is not there").is_empty());
    assert_eq!(bench.texts_with("Age ").len(), 1);
    for (role, name) in [
        (Role::Button, "Arm the hand"),
        (Role::Button, "Open all"),
        (Role::Button, "Go to Fist"),
        (Role::Slider, "Index angle target"),
        (Role::TextInput, "Index angle number"),
    ] {
        assert!(bench.is_disabled(role, name), "{name}");
    }
    assert!(!bench.is_disabled(Role::Button, "STOP"));
    assert_eq!(bench.handle("Index angle target"), None);
}

#[test]
fn what_is_no_longer_so_is_no_news() {
    let mut bench = Bench::live();
    bench.act(Action::Disconnect);
    bench.wait(1000);
    bench.unplug();
    bench.act(Action::Connect("tcp:192.168.11.210".parse().unwrap()));
    bench.wait(1000);
    assert_eq!(bench.texts_with("NO CONNECTION").len(), 1);
    let newest = bench.state().notices.log().next().map(|one| &one.what);
    assert!(matches!(newest, Some(NoticeKind::NoLink(_))), "{newest:?}");
    bench.plug();
    bench.until(3000, |bench| bench.shows("Link state: Monitoring"));
    bench.run(60);
    assert_eq!(bench.texts_with("No hand reached"), [""; 0]);
    assert!(bench.shows("Nothing moves the hand."));
}

#[test]
fn a_new_slot_is_offline_since_it_is_there_and_not_since_the_start() {
    let mut bench = Bench::live();
    bench.wait(30_000);
    bench.unplug();
    bench.act(Action::Hands(HandsAction::Add));
    bench.act(Action::Connect("tcp:192.168.11.210".parse().unwrap()));
    bench.wait(1000);
    let status = &bench.state().hand().connection.status;
    assert_eq!(status.state, LinkState::Offline);
    let since = bench.now().since(status.since);
    assert!(since < Duration::from_secs(2), "{since:?}");
}

#[test]
fn messages_of_several_lines_stand_below_each_other() {
    let mut bench = Bench::armed();
    bench.unplug();
    bench.until(300, |bench| bench.shows("LINK LOST"));
    bench.wait(1500);
    bench.show(View::Faults);
    bench.run(60);
    let labels = bench.all(Role::Label);
    let is_lost = |(text, _): &&(String, _)| text.starts_with("Link lost. ");
    let column = labels.iter().find(is_lost).unwrap().1.left();
    let listed = labels.iter().map(|(_, place)| place);
    let mut messages: Vec<_> = listed.filter(|place| place.left() == column).collect();
    assert!(messages.len() >= 2, "{messages:?}");
    messages.sort_by(|a, b| a.top().total_cmp(&b.top()));
    for pair in messages.windows(2) {
        assert!(pair[0].bottom() <= pair[1].top(), "{messages:?}");
    }
}

#[test]
fn a_hand_that_is_plugged_back_is_live_within_two_seconds_disarmed_and_unwritten() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.unplug();
    bench.until(300, |bench| bench.shows("LINK LOST"));
    bench.wait(3000);
    bench.plug();
    bench.until(2000, |bench| {
        bench.shows("Link state: Monitoring") && bench.handle("Index angle target").is_some()
    });
    bench.wait(1000);
    assert!(!bench.shows("LINK LOST"));
    assert!(bench.texts_with("Age ").is_empty());
    assert!(!bench.is_disabled(Role::Button, "Arm the hand"));
    assert!(bench.is_disabled(Role::Slider, "Index angle target"));
    assert!(!bench.texts_with("It is not armed.").is_empty());
    assert_eq!(bench.writes().len(), armed);
}

#[test]
fn what_was_dragged_while_the_link_was_gone_never_reaches_the_hand() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.unplug();
    bench.drag("Index angle target", 1.0, 0.0);
    bench.wait(500);
    bench.plug();
    bench.wait(3000);
    assert!(bench.shows("Link state: Monitoring"));
    assert_eq!(bench.writes().len(), armed);
    assert_eq!(bench.angle(Dof::Index), 1000);
}

#[test]
fn a_hand_that_moved_on_while_the_link_was_gone_can_be_held_when_it_is_back() {
    let mut bench = Bench::armed();
    bench.drag("Index angle target", 1.0, 0.0);
    bench.wait(200);
    let before = bench.writes().len();
    bench.unplug();
    bench.until(300, |bench| bench.shows("LINK LOST"));
    bench.plug();
    bench.until(2000, |bench| bench.shows("Link state: Monitoring"));
    let seen = bench.angle(Dof::Index);
    assert!(seen > 100, "still under way: {seen}");
    assert_eq!(bench.writes().len(), before);
    bench.click_button("STOP");
    bench.wait(1000);
    let rest = bench.angle(Dof::Index);
    assert!(seen - rest < 120, "{seen} {rest}");
    bench.wait(1000);
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3);
    let held = bench.writes().split_off(before);
    assert!(!held.is_empty() && held.iter().all(|write| write.address == ANGLE_SET));
    assert!(!bench.is_disabled(Role::Button, "Arm the hand"));
}

#[test]
fn a_stop_pressed_while_the_link_is_gone_holds_the_hand_when_it_is_back() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.unplug();
    bench.until(300, |bench| bench.shows("LINK LOST"));
    bench.click_button("STOP");
    bench.wait(1500);
    assert!(bench.shows("LINK LOST"));
    let before = Dof::ALL.map(|dof| bench.angle(dof));
    bench.plug();
    bench.wait(2500);
    assert!(bench.shows("Link state: Monitoring"));
    let held = bench.writes().split_off(armed);
    assert!(!held.is_empty() && held.iter().all(|write| write.address == ANGLE_SET));
    assert_eq!(Dof::ALL.map(|dof| bench.angle(dof)), before);
}

#[test]
fn a_fault_is_said_with_advice_and_disarms() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.until(300, |bench| bench.shows("FAULT"));
    // It is stopped first.
    bench.until(1500, |bench| bench.shows("Link state: Fault"));
    assert!(bench.is_disabled(Role::Button, "Arm the hand"));
    assert!(bench.is_disabled(Role::Slider, "Index angle target"));
    assert_eq!(bench.reading("Index status"), "Stall");
    bench.click("Show faults");
    bench.run(100);
    assert!(bench.shows("Index: Stall"));
    assert!(
        !bench
            .texts_with("What to do: Free the finger or open it")
            .is_empty()
    );
    let held = bench.writes().split_off(armed);
    let is_hold = held.iter().all(|write| write.address == ANGLE_SET);
    assert!(!held.is_empty() && is_hold, "nothing is cleared by itself");
}

#[test]
fn clearing_holds_the_pose_first() {
    let mut bench = Bench::live();
    bench.hand(|hand, _| {
        hand.inject_fault(Dof::Index, Fault::Stall);
    });
    bench.wait(200);
    bench.click("Show faults");
    bench.run(60);
    bench.click("Clear errors");
    bench.wait(500);
    assert_eq!(bench.addresses(), [ANGLE_SET, CLEAR_ERROR]);
    let writes = bench.writes();
    assert_eq!(writes[0].shorts(), [1000; 6]);
    assert_eq!(writes[1].bytes, [1]);
    assert!(bench.shows("Link state: Monitoring"));
    assert!(!bench.shows("FAULT"));
    assert!(!bench.is_disabled(Role::Button, "Arm the hand"));
}

#[test]
fn over_temperature_is_said_to_stay_and_stays() {
    let mut bench = Bench::live();
    bench.hand(|hand, _| {
        hand.inject_fault(Dof::Middle, Fault::OverTemperature);
        hand.warm(Dof::Middle, 92.0);
    });
    bench.wait(200);
    bench.show(View::Faults);
    bench.run(100);
    let cannot = "What to do: Let it cool: this fault cannot be cleared and ends by itself.";
    assert!(bench.shows("Middle: Over-temperature") && bench.shows(cannot));
    let warmth = bench.reading("Middle current and temperature");
    assert!(warmth.contains(" 9"), "{warmth}");
    assert!(
        bench.is_disabled(Role::Button, "Clear errors"),
        "it cannot help"
    );
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.wait(200);
    bench.click("Clear errors");
    bench.wait(500);
    assert_eq!(bench.addresses(), [ANGLE_SET, CLEAR_ERROR]);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Fault
    );
    assert!(bench.shows(cannot), "the stall is gone, the heat is not");
    assert!(bench.is_disabled(Role::Button, "Clear errors"));
}

#[test]
fn impossible_values_break_no_view_and_are_shown_as_they_are() {
    let config = SimConfig {
        scenario: Scenario::Extremes,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(1000);
    for _theme in 0..2 {
        for view in View::ALL {
            bench.show(view);
            // The values go once around the six joints.
            for _ in 0..6 {
                bench.wait(1000);
                assert!(bench.is_disabled(Role::Button, "Arm the hand"), "{view:?}");
            }
        }
        bench.key_with(Modifiers::COMMAND, Key::D);
    }
    bench.show(View::Touch);
    bench.run(100);
    assert_eq!(bench.reading("Little normal force"), "NaN N");
    bench.click_button("All numbers");
    bench.run(100);
    assert_eq!(bench.reading("Little direction"), "?360");
    assert_eq!(bench.reading("Ring normal force"), "+inf N");
    assert_eq!(bench.reading("Ring tangential force"), "not a number");
    assert!(bench.has_reading("Ring tangential force", "-inf N"));
    assert_eq!(bench.reading("Ring check"), "diff");
    bench.show(View::Connection);
    bench.run(100);
    // Those that have a word stand as that, below a fault.
    for code in ["255", "8", "254"] {
        let in_words = format!("({code})");
        let told = !bench.texts_with(&in_words).is_empty();
        assert!(told, "status {code}: {:?}", bench.texts());
    }
    bench.show(View::Faults);
    bench.run(100);
    for bit in 5..8 {
        let words = format!("Unknown fault, bit {bit}");
        assert!(!bench.texts_with(&words).is_empty(), "{words}");
    }
    bench.key_with(Modifiers::COMMAND, Key::L);
    for view in View::ALL {
        bench.show(view);
        bench.wait(200);
    }
    assert_eq!(bench.writes(), []);
}

#[test]
fn impossible_angles_are_shown_raw_and_no_handle_stands_there() {
    let config = SimConfig {
        scenario: Scenario::Extremes,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(500);
    let shown: Vec<String> = ["Little", "Ring", "Middle", "Index", "Thumb bend"]
        .iter()
        .map(|joint| bench.reading(&format!("{joint} actual angle")))
        .collect();
    assert_eq!(shown, ["1013", "-7", "1000", "0", "32767"]);
    assert_eq!(bench.handle("Thumb bend angle target"), None);
    assert_eq!(bench.writes(), []);
}

#[test]
fn another_controller_is_a_banner_disarms_and_goes_away_again() {
    let mut bench = Bench::armed();
    // Setpoints are compared once nothing of ours can act any more.
    bench.wait(4000);
    let slow = [7, 0].repeat(6);
    bench.hand(|hand, now| hand.write(SPEED_SET, &slow, now).map(drop).unwrap());
    bench.until(2000, |bench| bench.shows("ANOTHER CONTROLLER"));
    assert_eq!(bench.state().hand().connection.status.armed, None);
    let told = bench.texts_with("It wrote SPEED_SET Little: 7");
    assert_eq!(told.len(), 1, "{told:?}");
    bench.until(7000, |bench| !bench.shows("ANOTHER CONTROLLER"));
}

/// A hand that saves and never says how that went.
fn saving() -> Bench {
    let mut config = SimConfig::default();
    config.personality.set("save-result", "never").unwrap();
    let mut bench = Bench::keeping(config);
    let gentle = 100_i16.to_le_bytes().repeat(6);
    for address in [1032, 1044] {
        bench.hand(|hand, now| hand.write(address, &gentle, now).unwrap());
    }
    bench.show(View::Device);
    bench.until(2000, |bench| bench.state().hand().params.read_at.is_some());
    bench.run(200);
    bench.click("Save to flash");
    bench.run(60);
    bench.click("Save anyway");
    bench.until(2000, |bench| {
        bench.state().hand().connection.status.line_left
    });
    bench
}

#[test]
fn values_that_grow_old_because_the_hand_saves_are_greyed_and_no_warning() {
    let mut bench = saving();
    bench.wait(1500);
    assert!(bench.shows("The hand writes its flash. Leave it switched on."));
    assert_eq!(bench.texts_with("Age ").len(), 1);
    assert!(!bench.shows("OLD VALUES"));
    bench.until(6000, |bench| {
        !bench.state().hand().connection.status.line_left
    });
    bench.run(200);
    assert!(bench.texts_with("Age ").is_empty(), "it is read again");
}

#[test]
fn a_link_that_is_lost_while_the_hand_saves_is_not_left_to_it_any_more() {
    let mut bench = saving();
    bench.unplug();
    bench.until(5000, |bench| bench.shows("LINK LOST"));
    assert!(!bench.state().hand().connection.status.line_left);
}
