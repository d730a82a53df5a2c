//! Claims about several hands in one window: each has its own arming, its own history and its own STOP, and one STOP stops all.

use crate::setup::program::{env, start};
use crate::setup::window::{ANGLE_SET, Bench, Role, SPEED_SET};
use crate::window::tune::{on_block, short};
use egui::{Key, Modifiers};
use handscope::app::action::Action;
use handscope::app::exhibit::ExhibitAction;
use handscope::app::hand::Hand;
use handscope::app::hand::list::HandsAction;
use handscope::app::notices::NoticeKind;
use handscope::app::settings::Settings;
use handscope::app::slot::SlotId;
use handscope::app::trials::{SeriesKind, TrialAction};
use handscope::hand::kinematics::Side;
use handscope::hand::quantity::Quantity;
use handscope::hand::{Angle, Dof};
use handscope::poses::library::{EntryId, PoseId};
use handscope::poses::starter::starter;
use handscope::record::LinkState;
use handscope::sim::SimConfig;
use handscope::transport::Endpoint;
use handscope::ui::View;
use std::time::Duration;

const SECOND: &str = "tcp:10.0.0.2:6000";
const THIRD: &str = "tcp:10.0.0.3:6000";

/// The built-in hand in the first slot and another in the second, which is shown.
fn two() -> Bench {
    let mut bench = Bench::live();
    bench.open_another(SECOND);
    bench
}

/// Both armed, the second shown.
fn two_armed() -> Bench {
    let mut bench = two();
    arm(&mut bench);
    show(&mut bench, 0);
    arm(&mut bench);
    show(&mut bench, 1);
    assert!(hands(&bench).iter().all(|hand| hand.connection.is_armed()));
    bench
}

fn arm(bench: &mut Bench) {
    bench.click("Arm the hand");
    bench.run(200);
    assert!(bench.state().hand().connection.is_armed());
}

fn hands(bench: &Bench) -> Vec<&Hand> {
    bench.state().hands.iter().collect()
}

fn slot(bench: &Bench, at: usize) -> SlotId {
    hands(bench)[at].label.slot
}

fn show(bench: &mut Bench, at: usize) {
    let slot = slot(bench, at);
    bench.act(Action::Hands(HandsAction::Show(slot)));
    bench.run(40);
}

fn shown(bench: &Bench) -> usize {
    let slot = bench.state().hand().label.slot;
    let all = hands(bench);
    all.iter().position(|hand| hand.label.slot == slot).unwrap()
}

/// A shipped pose that is reached in one part.
fn pose() -> PoseId {
    starter().poses.first().unwrap().id
}

#[test]
fn with_one_hand_there_is_no_strip_and_no_switch() {
    let mut bench = Bench::live();
    assert_eq!(bench.buttons_with("STOP"), ["STOP"]);
    assert!(!bench.shows("All hands") && !bench.shows("To all armed hands"));
    bench.show(View::Connection);
    assert!(bench.shows("Add a hand") && !bench.shows("Remove this hand"));
}

#[test]
fn another_hand_leaves_the_first_connected_unwritten_and_with_its_history() {
    let mut bench = two();
    let first = hands(&bench)[0];
    assert_eq!(first.connection.status.state, LinkState::Monitoring);
    let since = first.measured.history.first_secs();
    let reads = first.connection.stats.state_reads;
    bench.run(1000);
    let first = hands(&bench)[0];
    assert!(
        first.connection.stats.state_reads > reads + 10,
        "its link goes on"
    );
    assert_eq!(first.measured.history.first_secs(), since);
    assert!(hands(&bench)[1].measured.history.first_secs() > since);
    assert_eq!(
        (bench.writes().len(), bench.addresses_at(SECOND).len()),
        (0, 0)
    );
    assert_eq!(
        bench.buttons_with("Hand "),
        ["Hand 1: sim:?seed=1", "Hand 2: 10.0.0.2:6000"]
    );
}

#[test]
fn what_is_done_to_one_hand_reaches_no_other() {
    let mut bench = two();
    arm(&mut bench);
    bench.drag("Index angle target", 1.0, 0.4);
    bench.run(300);
    let index = ANGLE_SET + 2 * Dof::Index as u16;
    assert!(bench.addresses_at(SECOND).contains(&index));
    assert_eq!(bench.writes().len(), 0);
    let [first, second] = hands(&bench)[..] else {
        panic!("two")
    };
    assert!(!first.connection.is_armed() && second.connection.is_armed());
    assert_ne!(
        first.controls.joints[Dof::Index].target,
        second.controls.joints[Dof::Index].target
    );
    show(&mut bench, 0);
    assert!(bench.is_disabled(Role::Slider, "Index angle target"));
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(200);
    assert_eq!(bench.writes().len(), 0, "the first was never armed");
}

#[test]
fn stop_holds_every_hand_and_that_of_a_strip_only_its_own() {
    for key in [None, Some(Key::Space), Some(Key::Escape)] {
        let mut bench = two_armed();
        let before = [bench.addresses().len(), bench.addresses_at(SECOND).len()];
        match key {
            None => bench.click("STOP"),
            Some(key) => bench.key(key),
        }
        bench.run(400);
        assert!(
            hands(&bench).iter().all(|hand| !hand.connection.is_armed()),
            "{key:?}"
        );
        let written = [bench.addresses(), bench.addresses_at(SECOND)];
        for (written, before) in written.iter().zip(before) {
            assert!(
                written[before..].contains(&ANGLE_SET),
                "{key:?} {written:?}"
            );
        }
    }
    let mut bench = two_armed();
    let before = bench.addresses_at(SECOND).len();
    bench.click_button("STOP hand 1");
    bench.run(400);
    let armed: Vec<bool> = hands(&bench)
        .iter()
        .map(|hand| hand.connection.is_armed())
        .collect();
    assert_eq!(armed, [false, true]);
    assert_eq!(
        bench.addresses_at(SECOND).len(),
        before,
        "the other is let alone"
    );
    assert!(bench.addresses().contains(&ANGLE_SET));
}

#[test]
fn hold_to_run_arms_the_shown_hand_alone_and_letting_go_stops_every_hand() {
    let mut bench = two();
    bench.act(Action::HoldToRun(true));
    bench.run(100);
    let armed = |bench: &Bench| -> Vec<bool> {
        let hands = hands(bench);
        hands
            .iter()
            .map(|hand| hand.connection.is_armed())
            .collect()
    };
    bench.key_down(Key::H);
    bench.run(400);
    assert_eq!(armed(&bench), [false, true], "the shown one");
    // While it is held, the other one is armed by its button, and both may move.
    show(&mut bench, 0);
    arm(&mut bench);
    bench.run(1000);
    assert_eq!(armed(&bench), [true, true]);
    let before = [bench.addresses().len(), bench.addresses_at(SECOND).len()];
    bench.key_up(Key::H);
    bench.run(200);
    assert_eq!(armed(&bench), [false, false]);
    let written = [bench.addresses(), bench.addresses_at(SECOND)];
    for (written, before) in written.iter().zip(before) {
        assert!(written[before..].contains(&ANGLE_SET), "{written:?}");
    }
    bench.run(1000);
    bench.key_down(Key::H);
    bench.run(400);
    assert_eq!(armed(&bench), [true, false], "the one that is shown now");
}

#[test]
fn an_empty_slot_has_nothing_to_stop() {
    let mut bench = Bench::armed();
    bench.act(Action::Hands(HandsAction::Add));
    bench.run(100);
    bench.key(Key::Space);
    bench.run(400);
    assert!(!hands(&bench)[0].connection.is_armed());
    assert!(!bench.shows("STOP COULD NOT BE SENT"));
}

#[test]
fn keys_and_strips_show_a_hand_and_carry_nothing_over() {
    let mut bench = two();
    arm(&mut bench);
    bench.key_with(Modifiers::ALT, Key::Num1);
    assert_eq!(shown(&bench), 0);
    bench.key_with(Modifiers::ALT, Key::Num8);
    assert_eq!(shown(&bench), 0, "there is no eighth");
    bench.click_button("Hand 2: 10.0.0.2:6000");
    assert_eq!(shown(&bench), 1);
    // The keyboard at a joint of one hand is not at that of the next.
    bench.key(Key::Num4);
    assert!(
        bench.is_focused("Index angle target"),
        "{:?}",
        bench.focused()
    );
    bench.key_with(Modifiers::ALT, Key::Num1);
    assert_ne!(bench.focused().as_deref(), Some("Index angle target"));
    // While something is dragged, the keys show no other hand.
    bench.key_with(Modifiers::ALT, Key::Num2);
    let track = bench.rect(Role::Slider, "Index angle target");
    bench.press_at(track.center());
    bench.key_with(Modifiers::ALT, Key::Num1);
    assert_eq!(shown(&bench), 1);
    bench.release_at(track.center());
    bench.run(100);
    assert_eq!(bench.writes().len(), 0);
}

#[test]
fn a_note_and_joints_that_are_linked_stay_with_their_hand() {
    let mut bench = two();
    bench.key_with(Modifiers::ALT, Key::L);
    bench.key(Key::N);
    let is_note = |(name, _): &(String, _)| name == "Words of the note";
    assert!(bench.all(Role::TextInput).iter().any(is_note));
    show(&mut bench, 0);
    let fields = bench.all(Role::TextInput);
    assert!(!fields.iter().any(is_note), "{fields:?}");
    let note = Action::Note(bench.now(), "only here".into());
    bench.act(note);
    let marks =
        |bench: &Bench, at: usize| hands(bench)[at].measured.history.marks(0.0, 1e9).count();
    assert!(marks(&bench, 0) > marks(&bench, 1));
}

#[test]
fn a_lost_link_disarms_its_own_hand_alone_and_says_which() {
    let mut bench = two_armed();
    show(&mut bench, 0);
    bench.unplug_at(SECOND);
    bench.until(500, |bench| bench.shows("LINK LOST"));
    let armed: Vec<bool> = hands(&bench)
        .iter()
        .map(|hand| hand.connection.is_armed())
        .collect();
    assert_eq!(armed, [true, false]);
    assert!(
        !bench.texts_with("10.0.0.2:6000: ").is_empty(),
        "{:?}",
        bench.texts()
    );
    let told: Vec<_> = bench.state().notices.iter().collect();
    let lost = |kind: &NoticeKind| matches!(kind, NoticeKind::LinkLost(_));
    let lost = told.iter().find(|one| lost(&one.what)).unwrap();
    assert_eq!(
        lost.hand.as_ref().map(|hand| hand.slot),
        Some(slot(&bench, 1))
    );
}

#[test]
fn what_is_open_in_one_slot_is_refused_in_another() {
    let mut bench = two();
    let dials = bench.dials();
    bench.act(Action::Hands(HandsAction::Add));
    for taken in ["sim:", SECOND, "tcp:10.0.0.2?packing=high"] {
        bench.act(Action::Connect(taken.parse().unwrap()));
        bench.run(200);
        assert_eq!(bench.state().hand().connection.endpoint, None, "{taken}");
        let told = bench.state().notices.iter().next().unwrap();
        let spelled = taken.parse::<Endpoint>().unwrap().to_string();
        let is_said = |what: &NoticeKind| matches!(what, NoticeKind::OpenElsewhere { endpoint, .. } if *endpoint == spelled);
        assert!(is_said(&told.what), "{taken} {told:?}");
        assert!(!bench.texts_with("is open already, as ").is_empty());
    }
    assert_eq!(bench.dials(), dials);
    show(&mut bench, 0);
    bench.act(Action::Connect(SECOND.parse().unwrap()));
    bench.run(100);
    assert!(
        bench.state().hand().connection.is_simulated(),
        "the first goes on"
    );
}

#[test]
fn several_hands_are_open_at_one_can_interface_and_each_id_once() {
    let mut bench = two();
    let connect = |bench: &mut Bench, url: &str| {
        bench.act(Action::Connect(url.parse().unwrap()));
        bench.run(100);
        let open = &bench.state().hand().connection.endpoint;
        open.as_ref() == Some(&url.parse::<Endpoint>().unwrap())
    };
    for url in ["can:can7?id=1", "can:can7?id=2"] {
        bench.act(Action::Hands(HandsAction::Add));
        assert!(connect(&mut bench, url), "{url}");
    }
    bench.act(Action::Hands(HandsAction::Add));
    for url in ["can:can7?id=1", "can:can7?id=2"] {
        assert!(!connect(&mut bench, url), "{url}");
    }
    assert!(connect(&mut bench, "can:can7?id=3"));
}

#[test]
fn a_hand_that_is_taken_away_is_held_first_and_the_last_one_stays() {
    let mut bench = two_armed();
    let before = bench.addresses_at(SECOND).len();
    bench.show(View::Connection);
    bench.click("Remove this hand");
    bench.wait(1500);
    assert_eq!(bench.state().hands.count(), 1);
    assert!(
        bench.addresses_at(SECOND)[before..].contains(&ANGLE_SET),
        "it is held"
    );
    assert!(
        bench.state().hand().connection.is_armed(),
        "the other is let alone"
    );
    let last = slot(&bench, 0);
    bench.act(Action::Hands(HandsAction::Remove(last)));
    bench.run(1000);
    assert!(bench.state().hand().connection.is_armed());
}

#[test]
fn at_most_eight_hands() {
    let mut bench = Bench::live();
    for _ in 0..20 {
        bench.act(Action::Hands(HandsAction::Add));
    }
    assert_eq!(bench.state().hands.count(), 8);
    bench.show(View::Connection);
    assert!(bench.is_disabled(Role::Button, "Add a hand"));
    bench.key_with(Modifiers::ALT, Key::Num8);
    assert_eq!(shown(&bench), 7);
}

#[test]
fn a_pose_or_demo_goes_to_all_armed_hands_only_where_that_is_wanted() {
    let mut bench = two_armed();
    bench.open_another(THIRD);
    show(&mut bench, 1);
    let speeds = |bench: &Bench| {
        let all = [
            bench.addresses(),
            bench.addresses_at(SECOND),
            bench.addresses_at(THIRD),
        ];
        all.map(|written| {
            written
                .iter()
                .filter(|address| **address == SPEED_SET)
                .count()
        })
    };
    let before = speeds(&bench);
    bench.act(Action::Recall(pose()));
    bench.run(600);
    let alone = speeds(&bench);
    assert!(
        alone[0] == before[0] && alone[1] > before[1],
        "{before:?} {alone:?}"
    );
    bench.click_first_button("To all armed hands");
    bench.act(Action::Recall(pose()));
    bench.run(600);
    let both = speeds(&bench);
    assert!(
        both[0] > alone[0] && both[1] > alone[1],
        "{alone:?} {both:?}"
    );
    assert_eq!(both[2], 0, "the third is not armed");
    let demo = starter().sequences.first().unwrap().id;
    bench.act(Action::Play(handscope::poses::Play::Start(
        EntryId::Sequence(demo),
    )));
    bench.run(400);
    let runs = |bench: &Bench| -> Vec<bool> {
        let runs = |hand: &&Hand| hand.running.sequence().is_some_and(|run| run.is_running());
        hands(bench).iter().map(runs).collect()
    };
    assert_eq!(runs(&bench), [true, true, false]);
    bench.click_button("STOP hand 1");
    bench.run(300);
    assert_eq!(
        runs(&bench),
        [false, true, false],
        "each has a player of its own"
    );
    bench.click("STOP");
    bench.run(300);
    assert_eq!(runs(&bench), [false; 3]);
}

#[test]
fn name_and_side_are_kept_of_each_hand() {
    let mut bench = two();
    bench.show(View::Connection);
    bench.type_into("Name of this hand", "left bench");
    bench.key(Key::Enter);
    bench.run(60);
    bench.act(Action::Side(Side::Left));
    bench.run(60);
    assert!(bench.shows("Hand 2: left bench"));
    let sides: Vec<Side> = hands(&bench).iter().map(|hand| hand.side).collect();
    assert_eq!(sides, [Side::Right, Side::Left]);
    bench.act(Action::Disconnect);
    bench.run(60);
    bench.act(Action::Connect(SECOND.parse().unwrap()));
    bench.run(400);
    assert!(bench.shows("Hand 2: left bench"));
    assert_eq!(bench.state().hand().side, Side::Left);
    let text = handscope::app::files::settings_file::text(&bench.state().settings).unwrap();
    assert!(text.contains("left bench"), "{text}");
}

#[test]
fn two_hands_are_recorded_each_into_its_own_file() {
    let mut bench = Bench::keeping(SimConfig::default());
    bench.act(Action::Recording(
        handscope::app::recordings::RecordingAction::RecordSimulated(true),
    ));
    bench.open_another("sim:?seed=2");
    let path = |hand: &&Hand| hand.recording.as_ref()?.status.path.clone();
    // Files are made by a thread of their own.
    let mut paths = Vec::new();
    for _ in 0..500 {
        bench.run(20);
        std::thread::sleep(Duration::from_millis(10));
        paths = hands(&bench).iter().filter_map(path).collect();
        if paths.len() == 2 {
            break;
        }
    }
    assert_eq!(paths.len(), 2, "{paths:?}");
    assert_ne!(paths[0], paths[1]);
    assert!(paths.iter().all(|path| path.exists()), "{paths:?}");
}

#[test]
fn an_exhibition_is_for_one_hand() {
    let mut bench = two();
    bench.act(Action::Exhibit(ExhibitAction::Enter));
    bench.run(100);
    assert!(bench.state().exhibit.is_none());
    assert!(!bench.texts_with("An exhibition is for one hand").is_empty());
    bench.act(Action::Disconnect);
    bench.run(100);
    show(&mut bench, 0);
    bench.act(Action::Exhibit(ExhibitAction::Enter));
    bench.run(100);
    assert!(bench.state().exhibit.is_some());
}

#[test]
fn side_by_side_each_hand_has_a_column_and_the_plots_come_back() {
    let mut bench = two();
    bench.click_button("All hands");
    bench.run(100);
    assert!(bench.is_on("All hands"));
    let pictures = bench.all(Role::Image);
    assert_eq!(
        pictures
            .iter()
            .filter(|(name, _)| name == "Picture of the hand")
            .count(),
        2,
        "{pictures:?}"
    );
    let names = ["Highest temperature", "Highest current", "Highest force"];
    let quantities = [Quantity::Temperature, Quantity::Current, Quantity::Force];
    for (name, quantity) in names.into_iter().zip(quantities) {
        let name = format!("{name} of the six drives");
        let labels = bench.labels_below(0.0).into_iter();
        let shown: Vec<String> = labels
            .filter(|(own, _)| *own == name)
            .map(|(_, text)| text)
            .collect();
        let highest = |hand: &&Hand| {
            let known = quantity.documented(&hand.readings.sample).unwrap();
            let most = known.value.iter().filter_map(|(_, value)| *value).max();
            format!(
                "{} {}",
                most.unwrap(),
                quantity.row().unit.replace("C", "°C")
            )
        };
        let wanted: Vec<String> = hands(&bench).iter().map(highest).collect();
        assert_eq!(shown, wanted, "{name}");
    }
    bench.click_button("All hands");
    bench.run(100);
    assert!(!bench.is_on("All hands"));
}

#[tokio::test(start_paused = true)]
async fn hands_of_the_command_line_have_a_slot_each_and_none_twice() {
    let env = env();
    let clock = env.clock;
    let mut app = start(env, Settings::default(), Some("sim:"));
    let more = ["sim:?seed=2", "sim:", "sim:?seed=3"];
    let more = more.map(|hand| hand.parse().unwrap());
    app.open_beside(more.to_vec(), clock.now());
    tokio::time::sleep(std::time::Duration::from_secs(1)).await;
    app.logic(clock.now());
    let state = app.state();
    let names: Vec<&str> = state.hands.iter().map(|hand| &*hand.label.name).collect();
    assert_eq!(names, ["sim:?seed=1", "sim:?seed=2", "sim:?seed=3"]);
    assert_eq!(&*state.hand().label.name, "sim:?seed=1");
    let is_live = |hand: &Hand| hand.connection.status.state == LinkState::Monitoring;
    assert!(state.hands.iter().all(is_live));
    assert!(state.settings.recent.is_empty(), "nothing is remembered");
}

#[test]
fn a_series_at_one_hand_goes_on_beside_another_and_any_key_ends_it() {
    let mut bench = on_block();
    short(&mut bench);
    bench.open_another(SECOND);
    show(&mut bench, 0);
    arm(&mut bench);
    bench.click("Start trials");
    bench.run(200);
    show(&mut bench, 1);
    bench.run(600);
    assert!(
        hands(&bench)[0].running.series().is_some(),
        "another hand ends it not"
    );
    assert!(bench.state().trials.running.is_some());
    arm(&mut bench);
    bench.act(Action::Trial(TrialAction::Start(SeriesKind::Grid)));
    bench.run(100);
    assert!(
        bench.state().hand().running.series().is_none(),
        "one series at a time"
    );
    bench.key(Key::F7);
    bench.run(600);
    let busy = |hand: &&Hand| hand.running.series().is_some() || hand.connection.is_armed();
    assert_eq!(hands(&bench).iter().filter(|hand| busy(hand)).count(), 0);
}

#[test]
fn after_a_stop_of_all_hands_the_line_tells_of_the_shown_one() {
    for at in 0..2 {
        let mut bench = two();
        show(&mut bench, at);
        bench.click_button("STOP");
        bench.run(1500);
        let told = bench.texts_with("Feedback shows rest");
        let name = bench.state().hand().label.name.to_string();
        assert!(
            told.len() == 1 && told[0].starts_with(&name),
            "{name}: {told:?}"
        );
    }
}
