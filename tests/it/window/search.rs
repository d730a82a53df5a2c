//! Claims about the search for settings in the window: wished, armed by its own button, run on the simulated hand, used.

use crate::setup::window::{Bench, Role};
use crate::window::tune::{enter, finish};
use handscope::hand::Dof;
use handscope::poses::library::{LibraryPose, PoseLibrary};
use handscope::record::Abort;
use handscope::sim::{Scenario, SimConfig};
use handscope::trials::search::{Claim, FoundApproach, NoClaim};
use handscope::ui::View;

const LIMIT: &str = "peak at most, g";

fn with(scenario: Scenario) -> Bench {
    let config = SimConfig {
        scenario,
        ..SimConfig::default()
    };
    let mut bench = Bench::keeping(config);
    bench.wait(1000);
    bench.show(View::Tune);
    bench
}

fn said(bench: &Bench, part: &str) {
    assert!(
        !bench.texts_with(part).is_empty(),
        "{part}: {:?}",
        bench.texts()
    );
}

fn hold(bench: &mut Bench) {
    let at = bench.rect(Role::Button, "Arm and start").center();
    bench.press_at(at);
    bench.run(1500);
    bench.release_at(at);
    bench.run(60);
}

fn begin(bench: &mut Bench) {
    hold(bench);
    assert!(bench.state().hand().running.series().is_some(), "it runs");
}

fn library(bench: &Bench) -> &PoseLibrary {
    &bench.state().poses.library
}

fn claim(bench: &Bench) -> Claim {
    let search = bench.state().trials.search.clone().unwrap();
    search.finding.unwrap().result.unwrap()
}

#[test]
fn a_search_is_the_first_thing_and_what_it_finds_becomes_a_pose_and_the_default() {
    let mut bench = with(Scenario::Rigid);
    enter(&mut bench, LIMIT, "700");
    begin(&mut bench);
    bench.wait(8000);
    said(&bench, "closes so far");
    finish(&mut bench, 700_000);
    let claim = claim(&bench);
    assert!(claim.peak_bound_g() <= 700.0, "{claim}");
    said(&bench, "on this object");
    let trials = bench.state().trials.sessions.last().unwrap().trials.len();
    assert!(
        trials > claim.closes,
        "as a series it is in the list: {trials}"
    );
    assert!(!bench.state().hand().connection.is_armed());
    let before = library(&bench).poses.len();
    bench.click(match claim.approach {
        FoundApproach::OneStage => "Save as pose",
        FoundApproach::TwoStage { .. } => "Save as sequence",
    });
    bench.run(60);
    let after = library(&bench).poses[before..].to_vec();
    let last: &LibraryPose = after.last().unwrap();
    assert_eq!(last.speed, claim.setting.speed);
    assert_eq!(last.force, claim.setting.force);
    assert!(!last.leave[Dof::Index] && last.leave[Dof::Little]);
    if let FoundApproach::TwoStage { fast_speed, margin } = claim.approach {
        let [near, _] = after.as_slice() else {
            panic!("{after:?}");
        };
        assert_eq!(near.speed.get(), fast_speed);
        let contact = claim.joints[0].contact_angle;
        let at = f64::from(near.angles[Dof::Index].get());
        assert!(
            (at - contact - f64::from(margin)).abs() <= 1.0,
            "{at} {contact}"
        );
        let sequence = library(&bench).sequences.last().unwrap();
        assert_eq!(sequence.steps.len(), 2);
        assert_eq!(sequence.steps[1].speed, claim.setting.speed);
    }
    let reading = bench.reading("Best");
    let (speed, force) = (claim.setting.speed, claim.setting.force);
    assert_eq!(reading, format!("{} / {} g", speed.get(), force.get()));
    assert!(
        !bench.shows("Make it the default"),
        "one recommendation, one button for it"
    );
    let button = "Use as default";
    bench.until(5000, |bench| !bench.is_disabled(Role::Button, button));
    bench.click(button);
    bench.run(100);
    assert!(bench.shows("Save these changes to flash?"), "the card asks");
}

#[test]
fn a_key_ends_a_search_and_nothing_is_claimed() {
    let mut bench = with(Scenario::Rigid);
    begin(&mut bench);
    bench.wait(3000);
    bench.key(egui::Key::Escape);
    finish(&mut bench, 4000);
    let search = bench.state().trials.search.clone().unwrap();
    assert_eq!(search.finding, None);
    said(&bench, "The search was ended: there is no result.");
    let session = bench.state().trials.sessions.last().unwrap();
    assert_eq!(
        session.head.aborted,
        Some(handscope::trials::EarlyEnd::Here(Abort::Person))
    );
}

#[test]
fn without_an_object_it_says_so_and_the_hand_is_not_armed_any_more() {
    let mut bench = with(Scenario::Free);
    begin(&mut bench);
    finish(&mut bench, 200_000);
    let search = bench.state().trials.search.clone().unwrap();
    let result = search.finding.unwrap().result;
    assert_eq!(result, Err(NoClaim::NoContact { dof: Dof::Index }));
    said(&bench, "Index met nothing on its way");
    assert!(!bench.state().hand().connection.is_armed());
}

#[test]
fn a_wish_that_cannot_be_tried_is_said_and_not_begun() {
    let mut bench = with(Scenario::Rigid);
    enter(&mut bench, "hold at least, g", "450");
    said(&bench, "At most 400 g under this limit.");
    hold(&mut bench);
    assert!(bench.state().hand().running.series().is_none());
    assert!(!bench.state().hand().connection.is_armed());
    enter(&mut bench, "hold at least, g", "200");
    enter(&mut bench, LIMIT, "900");
    let goal = &bench.state().trials.goal;
    assert_eq!(
        (goal.limit_g, goal.hold_g),
        (900, 360),
        "the usual goes along"
    );
    bench.click("Index takes part");
    bench.run(60);
    said(&bench, "Choose at least one joint.");
}
