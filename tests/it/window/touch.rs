//! The fingertips and the drawn hand: choosing one, taring, keeping the colours.

use crate::setup::window::{Bench, LARGE, Role};
use handscope::hand::Finger;
use handscope::sim::{Scenario, SimConfig};

fn gripping() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Grasp,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(3000);
    bench.click_first_button("Touch");
    bench.run(60);
    bench
}

fn rest(bench: &Bench, finger: Finger) -> [u32; 8] {
    bench
        .state()
        .hand()
        .tare
        .rest(finger)
        .expect("it was read")
        .raw
}

#[test]
fn the_hand_is_drawn_and_named_in_both_views() {
    let mut bench = gripping();
    let large = bench.rect(Role::Image, "Picture of the hand");
    bench.click_first_button("Live");
    bench.run(60);
    let small = bench.rect(Role::Image, "Picture of the hand");
    assert!(large.area() > small.area() && small.height() > 100.0);
}

#[test]
fn a_fingertip_is_chosen_by_its_button_and_tared_alone() {
    let mut bench = gripping();
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
    let mut bench = gripping();
    bench.click("Tare all");
    bench.run(60);
    assert!(bench.state().hand().tare.chosen_at().is_some());
    for finger in Finger::ALL {
        let now = bench.state().hand().sample.tactile[finger].expect("it was read");
        let apart = rest(&bench, finger)[0].abs_diff(now.value.raw[0]);
        assert!(apart < 20_000, "{finger:?}: {apart}");
    }
    assert_eq!(bench.writes().len(), 0);
}

#[test]
fn kept_colours_stay_when_the_grip_lets_go() {
    let mut bench = gripping();
    let end = |bench: &Bench| bench.reading("end of the heat scale");
    let tight = end(&bench);
    bench.click("Tare all");
    bench.run(60);
    assert_ne!(end(&bench), tight, "after taring nothing is hot");
    bench.click("Undo");
    bench.run(60);
    bench.click("Keep colours");
    bench.run(60);
    let kept = end(&bench);
    bench.click("Tare all");
    bench.run(60);
    assert_eq!(end(&bench), kept);
}

#[test]
fn a_drawn_finger_says_its_name_and_force_and_is_chosen_by_it() {
    let mut bench = gripping();
    for finger in ["Little", "Ring", "Middle", "Index", "Thumb"] {
        let head = format!("Drawn finger: {finger}: Normal ");
        let mut names = bench.all(Role::Button).into_iter().map(|(name, _)| name);
        let name = names.find(|name| name.starts_with(&head)).expect(finger);
        assert!(
            !name.contains('-'),
            "in a grip all forces are known: {name}"
        );
        bench.click(&name);
        bench.run(60);
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
fn a_channel_tells_its_change_and_noise_and_a_taring_its_age() {
    let mut bench = gripping();
    let tared = |bench: &Bench| bench.reading("Taring of the chosen fingertip");
    assert_eq!(tared(&bench), "Not tared");
    assert!(
        bench
            .reading("Change and noise of channel 4")
            .starts_with('+')
    );
    bench.click("Tare Index");
    bench.wait(1500);
    assert!(
        tared(&bench).starts_with("Tared, ago 1."),
        "{}",
        tared(&bench)
    );
    bench.click("Fingertip: Ring");
    bench.run(60);
    assert_eq!(tared(&bench), "Not tared");
    bench.click("Raw");
    bench.click("10 min");
    bench.run(60);
    assert_ne!(bench.reading("Change and noise of channel 4"), "-");
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
