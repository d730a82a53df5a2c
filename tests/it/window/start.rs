//! Claims about watching: what the first start shows, and that nothing but arming leads to a write.

use crate::setup::program::{Program, env};
use crate::setup::time::Time;
use crate::setup::window::{Bench, LARGE, Role};
use egui::{Key, Modifiers};
use handscope::app::settings::Settings;
use handscope::hand::Dof;
use handscope::link::PollPriority;
use handscope::record::LinkState;
use handscope::shell::headless::canvas::Canvas;
use handscope::sim::SimConfig;
use handscope::ui::View;
use std::time::Duration;

const JOINTS: [&str; 6] = [
    "Little",
    "Ring",
    "Middle",
    "Index",
    "Thumb bend",
    "Thumb rotate",
];

#[test]
fn the_first_start_is_live_within_a_second_badged_disarmed_and_writes_nothing() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.until(1000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
            && bench.reading("Thumb normal force") != "-"
    });
    bench.wait(1000);
    assert!(bench.shows("SIMULATED"));
    assert!(bench.shows("Link state: Monitoring"));
    assert!(!bench.is_disabled(Role::Button, "Arm the hand"));
    assert!(!bench.shows("Disarm the hand"));
    for (dof, joint) in Dof::ALL.into_iter().zip(JOINTS) {
        let shown: i16 = bench
            .reading(&format!("{joint} actual angle"))
            .parse()
            .unwrap();
        assert!((shown - bench.angle(dof)).abs() <= 3, "{joint} {shown}");
        let handle = bench.handle(&format!("{joint} angle target")).unwrap();
        assert!((handle - f64::from(shown)).abs() <= 3.0, "{joint} {handle}");
        assert!(bench.is_disabled(Role::Slider, &format!("{joint} angle target")));
    }
    assert!(bench.state().hand().connection.stats.state_hz > 50.0);
    assert_eq!(bench.writes(), []);
}

#[test]
fn looking_around_writes_nothing() {
    let mut bench = Bench::live();
    for view in View::ALL {
        bench.show(view);
        bench.run(100);
    }
    bench.show(View::Live);
    for key in [Key::D, Key::D] {
        bench.key_with(Modifiers::COMMAND, key);
    }
    for name in ["Pause the plots", "Cursors"] {
        bench.click(name);
        bench.run(100);
    }
    for _language in 0..2 {
        bench.key_with(Modifiers::COMMAND, Key::L);
        bench.run(100);
    }
    assert!(bench.shows("Link state: Monitoring"));
    assert_eq!(bench.writes(), []);
}

#[test]
fn connecting_and_disconnecting_write_nothing() {
    let mut bench = Bench::live();
    bench.show(View::Connection);
    bench.run(100);
    bench.click_button("Disconnect");
    bench.wait(200);
    assert!(bench.shows("NOT CONNECTED") && !bench.shows("SIMULATED"));
    assert_eq!(bench.reading("Index actual angle"), "-");
    bench.click_button("Connect");
    bench.wait(1000);
    assert!(bench.shows("SIMULATED") && bench.shows("Link state: Monitoring"));
    assert_eq!(bench.reading("Index actual angle"), "1000");
    assert_eq!(bench.writes(), []);
}

#[test]
fn how_bytes_stand_in_words_can_be_said_for_modbus_and_is_part_of_the_address() {
    let mut bench = Bench::live();
    bench.show(View::Connection);
    bench.run(60);
    bench.click_button("Change");
    for (kind, has_words) in [("RS485", false), ("Modbus RTU", true), ("Modbus TCP", true)] {
        let address = match kind {
            "RS485" => "COM3",
            "Modbus RTU" => "rtu:COM3",
            _ => "192.168.11.210",
        };
        bench.type_into("Address, port or name", address);
        bench.run(60);
        if has_words && !bench.shows("Modbus bytes") {
            bench.open_drawer("For experts");
        }
        let offers = bench.all(Role::ComboBox);
        let offers = offers.iter().any(|(name, _)| name == "Modbus bytes");
        assert_eq!(offers, has_words, "{kind}");
    }
    bench.choose("Modbus bytes", "low first");
    assert_eq!(
        bench
            .texts_with("tcp:192.168.11.210:6000?unit=255&packing=low")
            .len(),
        1
    );
    bench.choose("Modbus bytes", "as the hand shows");
    assert!(bench.texts_with("packing=").is_empty());
    assert_eq!(bench.writes(), [], "nothing is connected by choosing");
}

#[test]
fn without_arming_no_control_of_the_joints_writes() {
    let mut bench = Bench::live();
    for joint in JOINTS {
        bench.drag(&format!("{joint} angle target"), 0.9, 0.1);
        bench.drag(&format!("{joint} force threshold"), 0.2, 0.6);
        bench.drag(&format!("{joint} speed"), 0.2, 0.6);
    }
    for name in ["Open all", "Index lock"] {
        bench.click(name);
        bench.run(60);
    }
    bench.show(View::Poses);
    for name in ["In the hand", "Gesture 1"] {
        bench.click(name);
        bench.run(60);
    }
    bench.wait(500);
    assert_eq!(bench.writes(), []);
    assert_eq!(bench.angle(Dof::Index), 1000);
    let staged = bench.handle("Index speed").unwrap();
    assert!(staged > 500.0, "kept for arming: {staged}");
}

#[test]
fn stop_without_arming_holds_the_pose_it_sees() {
    let mut bench = Bench::live();
    bench.click_button("STOP");
    bench.wait(1000);
    let writes = bench.writes();
    assert!(!writes.is_empty());
    for write in &writes {
        assert_eq!((write.address, write.shorts()), (1486, vec![1000; 6]));
    }
    assert!(bench.shows("Link state: Monitoring"));
}

/// The list beside each headless picture.
#[test]
fn the_list_of_labels_has_stop_the_badge_and_every_joint_with_its_value() {
    let set_up = || (env(), Settings::default());
    let mut program = Program::start(Time::Virtual, None, set_up);
    for _ in 0..50 {
        program.tick(Duration::from_millis(20));
    }
    let mut canvas = Canvas::new((1440, 900), 1.0);
    let now = program.now();
    let picture = canvas.picture(now.secs(), |ui| program.ui(ui));
    let list = picture.labels.as_array().unwrap();
    let find = |role: &str, name: &str| {
        list.iter()
            .find(|entry| entry["role"] == role && entry["name"] == name)
            .unwrap_or_else(|| panic!("no {role} {name}"))
    };
    assert_eq!(find("button", "STOP")["disabled"], false);
    find("label", "SIMULATED");
    for joint in JOINTS {
        let target = &find("slider", &format!("{joint} angle target"))["value"];
        assert_eq!(target, &serde_json::json!(1000.0), "{joint}");
        let actual = &find("label", &format!("{joint} actual angle"))["value"];
        assert_eq!(actual.as_str().map(str::trim), Some("1000"), "{joint}");
        find("label", &format!("{joint} live force"));
    }
}

#[test]
fn what_is_read_first_while_the_hand_moves_is_chosen_beside_the_use_of_the_line_and_kept() {
    let mut bench = Bench::live();
    bench.show(View::Connection);
    bench.open_drawer("Details");
    assert_eq!(bench.state().settings.read_first, PollPriority::Force);
    bench.choose("While it moves, first", "Fingertips");
    assert_eq!(bench.state().settings.read_first, PollPriority::Touch);
    let kept = toml::to_string(&bench.state().settings).unwrap();
    assert!(kept.contains("first = \"touch\""), "{kept}");
    assert_eq!(bench.writes(), []);
}
