//! Claims about poses: kept, taken, played, read from files; and that none of it moves a hand unasked.

use crate::setup::window::{ANGLE_SET, Bench, FORCE_SET, LARGE, Role, SPEED_SET, Write};
use egui::{Key, Modifiers, vec2};
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::app::settings::Language;
use handscope::hand::{Dof, Speed};
use handscope::poses::library::StepGoal;
use handscope::poses::player::{PlayEnd, PlayPhase};
use handscope::record::Abort;
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;

fn pose(bench: &mut Bench, angle: i16) {
    let bytes: Vec<u8> = [angle; 6].into_iter().flat_map(i16::to_le_bytes).collect();
    bench.hand(|hand, now| hand.write(ANGLE_SET, &bytes, now).unwrap());
    bench.wait(2500);
}

fn open(bench: &mut Bench) {
    bench.show(View::Poses);
    bench.run(60);
}

fn enter(bench: &mut Bench, field: &str, text: &str) {
    bench.type_into(field, text);
    bench.key(Key::Enter);
    bench.run(60);
}

/// Two poses, 500 and 1000, in a sequence; the hand at 1000 and armed.
fn with_sequence() -> Bench {
    sequence_on(Bench::live())
}

fn sequence_on(mut bench: Bench) -> Bench {
    open(&mut bench);
    pose(&mut bench, 500);
    bench.click("Save the pose the hand has now");
    pose(&mut bench, 1000);
    bench.click("Save pose");
    bench.run(60);
    bench.click("Sequences");
    bench.run(60);
    bench.click("New sequence");
    bench.run(60);
    for _ in 0..2 {
        bench.click("Add");
        bench.run(60);
    }
    bench.click("Arm the hand");
    bench.run(300);
    assert!(bench.state().hand().connection.is_armed());
    bench
}

fn phase(bench: &Bench) -> PlayPhase {
    bench.state().hand().running.sequence().unwrap().view.phase
}

#[test]
fn a_captured_pose_is_renamed_and_taken_with_speed_and_force_first() {
    let mut bench = Bench::live();
    open(&mut bench);
    assert!(bench.shows("No poses of your own yet"));
    pose(&mut bench, 500);
    let before = bench.writes().len();
    bench.click("Save the pose the hand has now");
    bench.run(100);
    enter(&mut bench, "Name", "Cup");
    enter(&mut bench, "Pose Speed", "300");
    enter(&mut bench, "Pose Force, g", "700");
    bench.click("Little leave alone");
    bench.run(60);
    let all = bench.all_disabled("Go to Cup");
    assert_eq!(
        all,
        [true, true],
        "on the tile and in the editor: not armed"
    );
    pose(&mut bench, 1000);
    assert_eq!(bench.writes().len(), before + 1, "only what the test wrote");
    bench.click("Ring lock");
    bench.click("Arm the hand");
    bench.run(300);
    let armed = bench.writes().len();
    bench.click_first_button("Go to Cup");
    bench.wait(3000);
    let writes = bench.writes().split_off(armed);
    let order: Vec<u16> = writes.iter().map(|write| write.address / 12 * 12).collect();
    let is = |write: &Write, first: u16| (first..first + 12).contains(&write.address);
    let runs = |first: u16| writes.iter().filter(|write| is(write, first)).count();
    assert_eq!(
        (runs(SPEED_SET), runs(FORCE_SET), runs(ANGLE_SET)),
        (2, 2, 1),
        "{order:?}"
    );
    assert!(is(&writes[0], SPEED_SET) && is(&writes[1], FORCE_SET) && is(&writes[2], ANGLE_SET));
    assert_eq!(
        writes[0].shorts(),
        [300; 4],
        "neither the left nor the locked joint"
    );
    assert_eq!(writes[1].shorts(), [700; 4]);
    let own = [Speed::GENTLE.get(); 4];
    assert_eq!(writes[3].shorts(), own, "the own ones are back");
    let angles = writes[2].shorts();
    assert_eq!((writes[2].address, angles.len()), (ANGLE_SET + 4, 4));
    assert!(
        angles.iter().all(|angle| (angle - 500).abs() <= 5),
        "{angles:?}"
    );
    for dof in [Dof::Little, Dof::Ring] {
        assert!((bench.angle(dof) - 1000).abs() <= 5, "{dof:?}");
    }
}

#[test]
fn a_sequence_runs_pauses_resumes_and_finishes() {
    let mut bench = with_sequence();
    let armed = bench.writes().len();
    bench.click("Start");
    bench.run(600);
    bench.click("Pause");
    bench.run(100);
    assert_eq!(phase(&bench), PlayPhase::Paused);
    bench.wait(3000);
    let rest = bench.angle(Dof::Index);
    assert!((510..=990).contains(&rest), "held on its way: {rest}");
    let paused = bench.writes().len();
    bench.wait(5000);
    assert_eq!(bench.writes().len(), paused, "a pause sends nothing");
    bench.click("Resume");
    bench.wait(3000);
    assert!((bench.angle(Dof::Index) - 500).abs() <= 25);
    bench.wait(6000);
    assert_eq!(phase(&bench), PlayPhase::Ended(Ok(PlayEnd::Finished)));
    assert!(bench.writes().len() > armed);
}

#[test]
fn stop_fault_and_a_lost_link_end_a_sequence_and_nothing_is_sent_afterwards() {
    type Break = fn(&mut Bench);
    type Is = fn(Abort) -> bool;
    let breaks: [(Break, Is, &str); 3] = [
        (
            |bench| bench.key(Key::Space),
            |why| matches!(why, Abort::Disarmed { .. }),
            "a stop was requested",
        ),
        (
            |bench| {
                bench.hand(|hand, _| {
                    hand.inject_fault(Dof::Ring, handscope::hand::Fault::Motor);
                });
            },
            |why| {
                matches!(
                    why,
                    Abort::Fault {
                        joint: Some((Dof::Ring, _))
                    }
                )
            },
            "Ring",
        ),
        (Bench::unplug, |why| why == Abort::LinkLost, "link"),
    ];
    for (break_off, want, cause) in breaks {
        let mut bench = with_sequence();
        bench.click("Start");
        bench.run(600);
        break_off(&mut bench);
        bench.wait(3000);
        let PlayPhase::Ended(Err(why)) = phase(&bench) else {
            panic!("{:?}", phase(&bench));
        };
        assert!(want(why), "{why}");
        let texts = bench.texts().into_iter();
        let texts: Vec<String> = texts.filter(|text| text.contains(cause)).collect();
        assert!(!texts.is_empty(), "{why}: {:?}", bench.texts());
        bench.plug();
        let ended = bench.writes().len();
        bench.wait(8000);
        assert_eq!(bench.writes().len(), ended, "{why}");
        assert!(!bench.state().hand().connection.is_armed());
    }
}

#[test]
fn one_step_is_one_step() {
    let mut bench = with_sequence();
    bench.click("Step");
    bench.wait(6000);
    assert_eq!(phase(&bench), PlayPhase::Paused);
    assert!((bench.angle(Dof::Index) - 500).abs() <= 5);
    let after = bench.writes().len();
    bench.wait(3000);
    assert_eq!(bench.writes().len(), after);
}

#[test]
fn a_dry_run_shows_the_steps_and_writes_nothing() {
    let mut bench = with_sequence();
    let armed = bench.writes().len();
    bench.click("Dry run");
    bench.run(400);
    assert!(bench.shows("Dry run, step 1"));
    bench.wait(5000);
    assert!(bench.shows("Dry run, step 2"));
    bench.click("End dry run");
    bench.run(100);
    assert_eq!(bench.writes().len(), armed);
    assert!((bench.angle(Dof::Index) - 1000).abs() <= 5);
}

#[test]
fn an_exported_file_comes_back_and_a_bad_one_changes_nothing() {
    let mut bench = with_sequence();
    bench.click("Export");
    bench.run(400);
    let path = bench.folder().join("handscope-poses.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen("ring = ", "ring = 9", 1)).unwrap();
    let before = bench.state().poses.library.clone();
    let writes = bench.writes().len();
    bench.click("Import");
    bench.run(400);
    assert_eq!(bench.state().poses.library, before);
    let refused = bench
        .state()
        .notices
        .iter()
        .find_map(|notice| match &notice.what {
            NoticeKind::FileRefused { error, .. } => Some(error.clone()),
            _ => None,
        });
    assert_eq!(refused.unwrap().field.as_deref(), Some("ring"));
    std::fs::write(&path, text).unwrap();
    bench.click("Import");
    bench.run(400);
    let library = &bench.state().poses.library;
    assert_eq!((library.poses.len(), library.sequences.len()), (4, 2));
    bench.click("Undo");
    bench.run(100);
    assert_eq!(bench.state().poses.library, before);
    assert_eq!(bench.writes().len(), writes, "files move nothing");
}

#[test]
fn the_path_of_a_file_of_poses_can_be_typed() {
    let mut bench = with_sequence();
    bench.click("Import");
    bench.run(400);
    assert!(!bench.texts_with("handscope-poses.toml").is_empty());
    bench.click("Export");
    bench.run(400);
    let path = bench.folder().join("handscope-poses.toml");
    bench.type_into("Path of the file", &format!("\"{}\"", path.display()));
    bench.click("Open path");
    bench.run(400);
    assert_eq!(bench.state().poses.library.poses.len(), 4);
    assert!(!bench.shows("Path of the file"));
}

fn pose_names(bench: &Bench) -> Vec<&str> {
    let poses = bench.state().poses.library.poses.iter();
    poses.map(|pose| pose.name.as_str()).collect()
}

fn steps(bench: &Bench) -> Vec<&str> {
    let library = &bench.state().poses.library;
    let steps = library.sequences[0].steps.iter();
    let name = |goal| match goal {
        StepGoal::Pose(id) => library.pose(id).unwrap().name.as_str(),
        StepGoal::Gap { .. } => "grip by size",
        StepGoal::Hold(_) => "hold",
    };
    steps.map(|step| name(step.goal)).collect()
}

#[test]
fn poses_are_put_in_order_by_dragging_and_by_arrows_and_nothing_moves() {
    let mut bench = with_sequence();
    let before = bench.writes().len();
    bench.click("My poses");
    bench.run(60);
    bench.click("Save pose");
    bench.run(60);
    assert_eq!(pose_names(&bench), ["Pose", "Pose 2", "Pose 3"]);
    bench.drag_to("Pose Pose 3", "Pose Pose");
    assert_eq!(pose_names(&bench), ["Pose 3", "Pose", "Pose 2"]);
    bench.drag_to("Pose Pose 3", "Pose Pose 2");
    assert_eq!(pose_names(&bench), ["Pose", "Pose 2", "Pose 3"]);
    bench.click("Pose Pose 2");
    bench.run(60);
    bench.click("Move later");
    bench.run(60);
    assert_eq!(pose_names(&bench), ["Pose", "Pose 3", "Pose 2"]);
    for _ in 0..3 {
        bench.click("Move earlier");
        bench.run(60);
    }
    assert_eq!(
        pose_names(&bench),
        ["Pose 2", "Pose", "Pose 3"],
        "the first stays the first"
    );
    assert_eq!(bench.writes().len(), before);
}

#[test]
fn steps_are_put_in_order_by_dragging_and_by_arrows() {
    let mut bench = with_sequence();
    let before = bench.writes().len();
    bench.click("Add");
    bench.run(60);
    // All three are the first pose: let the last be the other one.
    let library = &bench.state().poses.library;
    assert_eq!(library.sequences[0].steps.len(), 3);
    enter(&mut bench, "Step 3 speed", "77");
    let speeds = |bench: &Bench| -> Vec<i16> {
        let steps = bench.state().poses.library.sequences[0].steps.iter();
        steps.map(|step| step.speed.get()).collect()
    };
    let other = speeds(&bench)[0];
    assert_eq!(steps(&bench).len(), 3);
    bench.drag_to("Step 3: Pose", "Step 1: Pose");
    assert_eq!(speeds(&bench), [77, other, other]);
    bench.click("Move later 1");
    bench.run(60);
    assert_eq!(speeds(&bench), [other, 77, other]);
    bench.click("Move later 2");
    bench.run(60);
    bench.click("Move later 3");
    bench.run(60);
    assert_eq!(
        speeds(&bench),
        [other, other, 77],
        "the last stays the last"
    );
    assert_eq!(bench.writes().len(), before);
}

#[test]
fn all_of_a_step_that_waits_has_room_in_the_smallest_window() {
    let mut bench = Bench::open(SimConfig::default(), vec2(1024.0, 640.0));
    bench.wait(1000);
    let mut bench = sequence_on(bench);
    bench.click("Step 1 Until holding");
    bench.run(60);
    let parts = [
        (Role::Button, "Step 1: Pose"),
        (Role::Button, "Step 1 Until holding"),
        (Role::Button, "Remove 1"),
        (Role::TextInput, "Step 1 speed"),
        (Role::TextInput, "Step 1 dwell, ms"),
        (Role::TextInput, "Step 1 limit, ms"),
        (Role::TextInput, "Step 1 within, ms"),
        (Role::TextInput, "Step 1 retries"),
    ];
    let places = parts.map(|(role, name)| (name, bench.rect(role, name)));
    for (at, (name, place)) in places.into_iter().enumerate() {
        assert!(place.width() > 20.0, "{name}: {place}");
        for (other, there) in places.into_iter().skip(at + 1) {
            assert!(
                !place.shrink(1.0).intersects(there.shrink(1.0)),
                "{name} and {other}"
            );
        }
    }
    let removes = bench.rect(Role::Button, "Remove 1");
    assert!(
        removes.right() < 1024.0 && places[0].1.left() > 560.0,
        "{places:?}"
    );
}

#[test]
fn a_step_is_told_to_wait_for_the_grip_and_says_what_it_waits_for() {
    let free = SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(free, LARGE);
    bench.wait(1000);
    let mut bench = sequence_on(bench);
    bench.click("Step 2 Until holding");
    bench.run(60);
    enter(&mut bench, "Step 2 within, ms", "1500");
    enter(&mut bench, "Step 2 retries", "1");
    let until = |bench: &Bench| {
        let steps = &bench.state().poses.library.sequences[0].steps;
        let until = steps[1].until;
        until.map(|until| (until.within.get(), until.retries.get()))
    };
    assert_eq!(until(&bench), Some((1500, 1)));
    enter(&mut bench, "Step 2 retries", "21");
    assert_eq!(until(&bench), Some((1500, 1)), "out of range");
    enter(&mut bench, "Step 2 retries", "1");
    bench.click("Start");
    for said in [
        "Closed on nothing, opens to try again: step 2",
        "Waits until holding at step 2",
        "Ended: the hand is not known to hold anything. Grip: Empty.",
    ] {
        bench.until(9000, |bench| !bench.texts_with(said).is_empty());
    }
    bench.click("Step 2 Until holding");
    bench.run(60);
    assert_eq!(until(&bench), None);
}

#[test]
fn a_drag_that_is_stopped_by_esc_leaves_the_order() {
    let mut bench = with_sequence();
    bench.click("My poses");
    bench.run(60);
    let (from, to) = (
        bench.rect(Role::Button, "Pose Pose"),
        bench.rect(Role::Button, "Pose Pose 2"),
    );
    bench.drag_and_press(from.center(), to.center(), Key::Escape);
    assert_eq!(pose_names(&bench), ["Pose", "Pose 2"]);
}

#[test]
fn poses_are_found_by_name_and_tag_and_put_in_order_among_those_that_are_found() {
    let mut bench = with_sequence();
    bench.click("My poses");
    bench.run(60);
    bench.click("Save pose");
    bench.run(60);
    bench.click("Pose Pose");
    bench.run(60);
    enter(&mut bench, "Tags", "Pinch, small");
    bench.click("Pose Pose 3");
    bench.run(60);
    enter(&mut bench, "Tags", "pinch");
    bench.type_into("Find poses", "PINCH");
    assert!(bench.shows("Pose Pose") && bench.shows("Pose Pose 3") && !bench.shows("Pose Pose 2"));
    bench.drag_to("Pose Pose 3", "Pose Pose");
    assert_eq!(pose_names(&bench), ["Pose 3", "Pose", "Pose 2"]);
    bench.type_into("Find poses", "nowhere");
    assert!(bench.shows("No pose has these words in its name or tags."));
    bench.type_into("Find poses", "e 2");
    assert!(bench.shows("Pose Pose 2") && !bench.shows("Pose Pose 3"));
}

#[test]
fn a_press_before_arming_says_at_the_tile_what_to_do() {
    let mut bench = Bench::live();
    open(&mut bench);
    bench.click("Save the pose the hand has now");
    bench.run(100);
    let words = "Not armed: press Arm first.";
    assert!(!bench.shows(words));
    let tile = bench.rects("Go to Pose").remove(0);
    bench.press_at(tile.center());
    bench.run(200);
    let told = bench.rect(Role::Label, words);
    assert!(told.distance_to_pos(tile.center()) < 60.0, "{told} {tile}");
    bench.run(3500);
    assert!(!bench.shows(words));
    assert_eq!(bench.writes(), []);
}

#[test]
fn names_that_nobody_typed_are_chinese_in_a_chinese_window() {
    let mut bench = Bench::live();
    bench.act(handscope::app::action::Action::Language(
        handscope::app::settings::Language::Zh,
    ));
    bench.show(handscope::ui::View::Poses);
    bench.click("记录灵巧手当前的姿态");
    bench.run(100);
    bench.click("动作序列");
    bench.run(100);
    bench.click("新建序列");
    bench.run(100);
    let library = &bench.state().poses.library;
    assert_eq!(library.poses[0].name, "姿态");
    assert_eq!(library.sequences[0].name, "序列");
}

#[test]
fn shipped_poses_are_on_live_with_a_key_each_and_a_press_without_arming_says_what_to_do() {
    let mut bench = Bench::live();
    let advice = "Not armed: press Arm first.";
    assert!(!bench.shows(advice));
    bench.click("Go to Thumbs up");
    bench.run(100);
    assert!(bench.shows(advice), "{:?}", bench.texts());
    let tile = bench.rect(Role::Button, "Go to Thumbs up");
    let told = bench.rect(Role::Label, advice);
    assert!(tile.expand(40.0).intersects(told), "{told} at {tile}");
    bench.key_with(Modifiers::SHIFT, Key::U);
    bench.run(300);
    assert!(bench.writes().is_empty(), "not armed");
    bench.click("Arm the hand");
    bench.run(300);
    let before = bench.writes().len();
    bench.click("Go to Thumbs up");
    bench.run(300);
    let told = |bench: &Bench| {
        let writes = bench.writes();
        let angles = writes.iter().filter(|write| write.address == ANGLE_SET);
        angles.map(Write::shorts).next_back()
    };
    assert!(bench.writes().len() > before);
    assert_eq!(told(&bench), Some(vec![0, 0, 0, 0, 1000, 1000]));
    bench.key_with(Modifiers::SHIFT, Key::R);
    bench.run(300);
    assert_eq!(told(&bench), Some(vec![1000, 0, 0, 1000, 350, 100]));
}

#[test]
fn a_demo_starts_from_live_and_is_ended_in_every_view() {
    let mut bench = Bench::armed();
    bench.scroll_shelf();
    bench.click("Start Wave");
    bench.run(500);
    for view in [View::Faults, View::Touch, View::Live] {
        bench.show(view);
        bench.run(60);
        assert!(!bench.texts_with("Sequence Wave").is_empty(), "{view:?}");
    }
    bench.show(View::Touch);
    bench.run(60);
    let end = bench.buttons_with("End: Sequence Wave");
    bench.click(&end[0]);
    bench.run(300);
    assert_eq!(phase(&bench), PlayPhase::Ended(Ok(PlayEnd::Person)));
    bench.show(View::Live);
    bench.run(60);
    bench.click("Start Wave");
    bench.run(500);
    bench.click("End Wave");
    bench.run(300);
    assert_eq!(phase(&bench), PlayPhase::Ended(Ok(PlayEnd::Person)));
}

#[test]
fn what_is_shipped_is_hidden_shown_and_copied_and_has_a_chinese_name() {
    let mut bench = Bench::live();
    assert!(!bench.buttons_with("Go to Fist").is_empty());
    open(&mut bench);
    bench.click("Built in");
    bench.run(60);
    bench.click("Hide Fist");
    bench.run(60);
    bench.click("Copy V");
    bench.run(60);
    bench.show(View::Live);
    bench.run(60);
    assert!(bench.buttons_with("Go to Fist").is_empty());
    assert_eq!(bench.buttons_with("Go to V").len(), 1);
    bench.act(Action::Language(Language::Zh));
    bench.run(60);
    assert_eq!(bench.buttons_with("点赞").len(), 1);
    bench.act(Action::HideShipped("Fist".into(), false));
    bench.run(60);
    assert_eq!(bench.buttons_with("握拳").len(), 1);
}
