//! The fingertips and the drawn hand: choosing one, taring, the scale of the heat.

use crate::setup::window::{Bench, LARGE, Role};
use handscope::app::action::Action;
use handscope::app::readings::tare::TareSource;
use handscope::hand::Finger;
use handscope::poses::Preset;
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;

fn gripping() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Grasp,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(3000);
    bench.show(View::Touch);
    bench.run(60);
    bench
}

/// A hand that touches nothing.
fn free() -> Bench {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(1000);
    bench.show(View::Touch);
    bench.run(60);
    bench
}

fn rest(bench: &Bench, finger: Finger) -> [u32; 8] {
    bench
        .state()
        .hand()
        .readings
        .tare
        .zero(finger)
        .expect("it was read")
        .raw
}

#[test]
fn the_hand_is_drawn_and_named_with_the_plots_and_with_the_fingertips() {
    let mut bench = gripping();
    let beside = bench.rect(Role::Image, "Picture of the hand");
    bench.show(View::Live);
    bench.run(60);
    let small = bench.rect(Role::Image, "Picture of the hand");
    let heights = [beside, small].map(|place| place.height());
    assert!(heights.iter().all(|height| *height > 272.0), "{heights:?}");
}

#[test]
fn a_fingertip_is_chosen_by_its_button_and_tared_alone() {
    let mut bench = free();
    let (before, thumb) = (rest(&bench, Finger::Middle), rest(&bench, Finger::Thumb));
    bench.click("Fingertip: Middle");
    bench.run(60);
    bench.click("Tare Middle");
    bench.run(60);
    assert_ne!(rest(&bench, Finger::Middle), before);
    assert_eq!(rest(&bench, Finger::Thumb), thumb);
    bench.click("Undo");
    bench.run(60);
    assert_eq!(rest(&bench, Finger::Middle), before);
    assert!(bench.is_disabled(Role::Button, "Undo"));
}

#[test]
fn taring_counts_all_tips_from_now_and_writes_nothing() {
    let mut bench = free();
    bench.click("Tare all");
    bench.run(60);
    let is_kept = |finger| {
        let rest = bench.state().hand().readings.tare.zero(finger);
        rest.is_some_and(|rest| rest.source == TareSource::User)
    };
    assert!(Finger::ALL.into_iter().all(is_kept));
    for finger in Finger::ALL {
        let now = bench.state().hand().readings.sample.tactile[finger].expect("it was read");
        let apart = rest(&bench, finger)[0].abs_diff(now.value.raw[0]);
        assert!(apart < 20_000, "{finger:?}: {apart}");
    }
    assert_eq!(bench.writes().len(), 0);
}

#[test]
fn nothing_is_tared_under_load_and_it_is_said_why() {
    let mut bench = gripping();
    let before = rest(&bench, Finger::Index);
    bench.click("Tare all");
    bench.run(60);
    assert_eq!(rest(&bench, Finger::Index), before);
    assert!(!bench.state().hand().readings.tare.can_undo());
    assert_eq!(bench.texts_with("Not tared: ").len(), 1);
}

#[test]
fn a_hand_that_grips_when_it_is_connected_has_no_zero_until_it_lets_go() {
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(500);
    bench.click("Arm the hand");
    bench.run(100);
    bench.click("Close");
    bench.wait(6000);
    bench.unplug();
    bench.wait(1000);
    let endpoint = bench
        .state()
        .hand()
        .connection
        .endpoint
        .clone()
        .expect("it is wanted");
    bench.act(Action::Disconnect);
    bench.run(100);
    bench.plug();
    bench.act(Action::Connect(endpoint));
    bench.wait(2000);
    let pressed = |bench: &Bench| {
        let block = bench.state().hand().readings.sample.tactile[Finger::Index];
        block.expect("it was read").value.normal_n
    };
    assert!(pressed(&bench) > 0.3, "{}", pressed(&bench));
    assert_eq!(bench.state().hand().readings.tare.zero(Finger::Index), None);
    assert_eq!(bench.texts_with("No zero").len(), 1);
    bench.click("Arm the hand");
    bench.run(100);
    bench.click("Open all");
    bench.wait(8000);
    assert!(
        bench
            .state()
            .hand()
            .readings
            .tare
            .zero(Finger::Index)
            .is_some()
    );
    assert!(bench.texts_with("No zero yet").is_empty());
}

#[test]
fn a_taring_is_kept_for_its_hand_and_offered_but_never_taken_under_load() {
    let config = || SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let endpoint = "tcp:192.168.11.210";
    let mut bench = Bench::kept(config(), endpoint, LARGE);
    bench.wait(2000);
    bench.show(View::Touch);
    bench.run(60);
    assert!(!bench.shows("Take the kept taring"));
    bench.click("Tare all");
    bench.run(60);
    let tared = rest(&bench, Finger::Index);
    assert_eq!(bench.state().settings.tares.len(), 1);
    let mut other = "tcp:192.168.11.211".parse().unwrap();
    bench.act(Action::Connect(other));
    bench.wait(1000);
    assert!(!bench.shows("Take the kept taring"), "another hand");
    other = endpoint.parse().unwrap();
    bench.act(Action::Connect(other));
    bench.wait(1000);
    assert_ne!(rest(&bench, Finger::Index), tared, "it is only offered");
    bench.click("Take the kept taring");
    bench.run(60);
    assert_eq!(rest(&bench, Finger::Index), tared);
    let zero = bench.reading("Taring of the chosen fingertip");
    assert!(
        zero.starts_with("Tared ") && zero.ends_with("kept"),
        "{zero}"
    );
    bench.click("Undo");
    bench.click("Arm the hand");
    bench.run(100);
    bench.act(Action::Preset(Preset::Close));
    bench.wait(6000);
    let before = rest(&bench, Finger::Index);
    bench.click("Take the kept taring");
    bench.run(60);
    assert_eq!(rest(&bench, Finger::Index), before, "it is pressed");
    assert_eq!(bench.texts_with("Not tared: ").len(), 1);
}

#[test]
fn the_heat_scale_stays_whatever_is_gripped() {
    let end = |bench: &Bench| bench.reading("end of the heat scale");
    let (free, mut gripping) = (free(), gripping());
    assert_eq!(end(&free), end(&gripping));
    gripping.wait(2000);
    assert_eq!(end(&free), end(&gripping));
}

#[test]
fn a_fingertip_of_the_overview_is_chosen_for_the_detail() {
    let mut bench = gripping();
    for finger in ["Little", "Ring", "Middle", "Index", "Thumb"] {
        bench.show(View::Live);
        bench.run(60);
        let force = bench.reading(&format!("{finger} normal force"));
        assert!(!force.contains('-'), "in a grip all are known: {force}");
        bench.click(&format!("Fingertip: {finger}"));
        bench.run(60);
        assert_eq!(bench.view(), View::Touch);
        assert!(bench.shows(&format!("Tare {finger}")));
    }
}

#[test]
fn all_numbers_stand_there_on_demand() {
    let mut bench = gripping();
    assert!(!bench.shows("Channel 8"));
    bench.click("All numbers");
    bench.run(60);
    for finger in ["Little", "Thumb"] {
        assert_ne!(bench.reading(&format!("{finger} Channel 8")), "-");
    }
    bench.click("Detail");
    bench.run(60);
    assert!(bench.texts_with("Channel 8").is_empty());
}

#[test]
fn a_channel_tells_its_change_and_a_taring_its_age() {
    let mut bench = gripping();
    bench.click("All numbers");
    bench.run(60);
    let channel = bench.reading("Index Channel 4");
    assert!(channel.contains(" +"), "{channel}");
    let mut bench = free();
    let tared = |bench: &Bench| bench.reading("Taring of the chosen fingertip");
    assert_eq!(tared(&bench), "Zero: first reading");
    bench.click("Tare Index");
    bench.wait(1500);
    assert!(tared(&bench).starts_with("Tared 1."), "{}", tared(&bench));
    bench.click("Fingertip: Ring");
    bench.run(60);
    assert_eq!(tared(&bench), "Zero: first reading");
}

#[test]
fn too_little_friction_raises_the_alarm_on_each_fingertip() {
    let mut bench = gripping();
    assert!(bench.shows("Holds") || !bench.texts_with("Holds").is_empty());
    assert!(bench.texts_with("Slip").iter().all(|text| text != "Slip"));
    bench.drag("Friction, percent", 0.33, 0.01);
    bench.run(60);
    assert_eq!(bench.texts_with("Slips at this friction").len(), 1);
    let slipping = bench.texts().into_iter().filter(|text| text == "Slip");
    assert!(slipping.count() >= 4, "all fingertips in contact slip");
}
