//! Claims about the page of an exhibition: only staff let the hand move, visitors play within the limits, and nothing leads
//! anywhere else.

use crate::setup::window::{ANGLE_SET, Bench, FORCE_SET, Role, SPEED_SET, Write};
use egui::{Key, Modifiers, Pos2, Vec2, vec2};
use handscope::app::action::Action;
use handscope::app::exhibit::{ExhibitAction, StaffPanel};
use handscope::app::params::ParamAction;
use handscope::app::settings::{Language, Settings, Zoom};
use handscope::exhibit::file;
use handscope::exhibit::pin::Pin;
use handscope::exhibit::plan::ExhibitPlan;
use handscope::exhibit::stage::{ExhibitStage, ExhibitWish, HaltReason};
use handscope::hand::{Dof, Gesture, PerDof};
use handscope::sim::object::{Loads, PullLoad, listed};
use handscope::sim::{Object, Obstacle, Scenario, SimConfig};
use handscope::transport::Endpoint;
use handscope::ui::View;

fn plan() -> ExhibitPlan {
    ExhibitPlan {
        pin: Some(Pin::try_from("4711".to_owned()).unwrap()),
        ..file::built_in().unwrap()
    }
}

fn free() -> SimConfig {
    SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    }
}

/// A page with nobody at it, not armed.
fn shown_with(plan: ExhibitPlan) -> Bench {
    let mut bench = Bench::open(free(), vec2(1440.0, 900.0));
    bench.wait(1000);
    bench.exhibit(plan);
    bench
}

fn type_pin(bench: &mut Bench, pin: &str) {
    for digit in pin.chars() {
        bench.click_button(&digit.to_string());
    }
    bench.click_button("Enter");
    bench.run(60);
}

fn unlock(bench: &mut Bench) {
    bench.click_button("Staff: unlock");
    bench.run(60);
    type_pin(bench, "4711");
    // What the PIN opens takes no press at first.
    bench.run(600);
}

/// Armed by staff, and open; nobody plays yet.
fn armed_with(plan: ExhibitPlan) -> Bench {
    let mut bench = shown_with(plan);
    unlock(&mut bench);
    bench.click_button("Arm");
    bench.wait(6000);
    assert_eq!(stage(&bench), ExhibitStage::Idle);
    bench
}

fn stage(bench: &Bench) -> ExhibitStage {
    bench.state().exhibit.as_ref().unwrap().view.stage
}

fn staff(bench: &Bench) -> &StaffPanel {
    &bench.state().exhibit.as_ref().unwrap().staff
}

fn wish(bench: &mut Bench, wish: ExhibitWish) {
    bench.act(Action::Exhibit(ExhibitAction::Wish(wish)));
}

/// The middle of the drawn hand: no tile, no button.
fn beside(bench: &Bench) -> Pos2 {
    bench.rect(Role::Image, "Picture of the hand").center()
}

fn press(bench: &mut Bench, tile: &str) {
    bench.press(tile);
    let at = bench.rect(Role::Button, tile).center();
    bench.release_at(at);
    bench.point_away();
}

/// Everything that was written to this register and its neighbours of the other joints.
fn told(writes: &[Write], first: u16) -> Vec<i16> {
    let own = writes
        .iter()
        .filter(|write| (first..first + 12).contains(&write.address));
    own.flat_map(Write::shorts)
        .filter(|value| *value >= 0)
        .collect()
}

#[test]
fn without_a_pin_staff_choose_one_by_typing_it_twice() {
    let mut bench = Bench::live();
    bench.click_button("Window menu");
    bench.run(100);
    bench.click_button("Exhibition");
    bench.run(400);
    assert!(
        bench.shows("Choose a PIN: 4 to 8 digits"),
        "{:?}",
        bench.texts()
    );
    assert!(bench.is_disabled(Role::Button, "Enter"), "no digits yet");
    type_pin(&mut bench, "4711");
    assert!(bench.shows("Type the PIN once more"));
    type_pin(&mut bench, "4712");
    assert_eq!(bench.texts_with("Begin again").len(), 1);
    type_pin(&mut bench, "4711");
    // A real keyboard does as well; the wrong digit is taken back.
    for key in [
        Key::Num4,
        Key::Num7,
        Key::Num9,
        Key::Backspace,
        Key::Num1,
        Key::Num1,
        Key::Enter,
    ] {
        bench.key(key);
    }
    bench.run(600);
    assert!(
        matches!(staff(&bench), StaffPanel::Open { .. }),
        "{:?}",
        bench.texts()
    );
    bench.click_button("Close");
    bench.run(60);
    assert_eq!(*staff(&bench), StaffPanel::Closed);
    assert_eq!(bench.writes(), [], "none of it moves the hand");
}

#[test]
fn five_wrong_pins_lock_for_a_minute_even_the_right_one() {
    let mut bench = shown_with(plan());
    bench.click_button("Staff: unlock");
    bench.run(60);
    for left in [4, 3, 2, 1] {
        type_pin(&mut bench, "0000");
        assert!(bench.shows(&format!("Wrong PIN. Tries left: {left}")));
    }
    type_pin(&mut bench, "0000");
    assert_eq!(bench.texts_with("Too many wrong PINs. Wait 60 s.").len(), 1);
    for key in [Key::Num4, Key::Num7, Key::Num1, Key::Num1] {
        bench.key(key);
    }
    assert!(bench.is_disabled(Role::Button, "Enter"));
    bench.key(Key::Enter);
    bench.run(1000);
    assert_eq!(bench.texts_with("Wait 59 s.").len(), 1);
    bench.wait(58_500);
    assert_eq!(
        *staff(&bench),
        StaffPanel::Closed,
        "nobody typed for half a minute"
    );
    bench.wait(1000);
    unlock(&mut bench);
    assert!(matches!(staff(&bench), StaffPanel::Open { .. }));
}

#[test]
fn nothing_moves_before_staff_arm_and_then_within_the_limits() {
    let mut bench = shown_with(plan());
    assert!(bench.shows("One moment, please"));
    assert_eq!(
        bench.texts_with("Staff: check that nobody is near").len(),
        1
    );
    assert!(bench.is_disabled(Role::Button, "Fist"));
    press(&mut bench, "Fist");
    wish(&mut bench, ExhibitWish::Press(1));
    wish(&mut bench, ExhibitWish::Arm);
    bench.wait(5000);
    assert_eq!(bench.writes(), []);
    unlock(&mut bench);
    assert!(bench.shows("Visitors") && bench.shows("STOP pressed"));
    assert_eq!(bench.writes(), []);
    bench.click_button("Arm");
    bench.wait(6000);
    assert!(bench.shows("Touch a tile"), "{:?}", bench.texts());
    assert!(!bench.state().hand().connection.is_armed(), "it rests open");
    press(&mut bench, "Fist");
    bench.run(200);
    assert!(bench.is_on("Fist") && !bench.is_on("Open"));
    assert!(bench.shows("Your turn"));
    bench.wait(5000);
    assert!(bench.angle(Dof::Index) < 100, "{}", bench.angle(Dof::Index));
    let writes = bench.writes();
    let (speeds, forces) = (told(&writes, SPEED_SET), told(&writes, FORCE_SET));
    assert!(
        !speeds.is_empty() && speeds.iter().all(|speed| *speed <= 300),
        "{speeds:?}"
    );
    assert!(
        !forces.is_empty() && forces.iter().all(|force| *force <= 800),
        "{forces:?}"
    );
}

#[test]
fn stop_ends_everything_until_staff_arm_again_even_under_what_staff_see() {
    type Stop = fn(&mut Bench);
    let stops: [Stop; 4] = [
        |bench| bench.press("STOP"),
        |bench| bench.touch_at(bench.rect(Role::Button, "STOP").center()),
        |bench| bench.key(Key::Space),
        |bench| {
            bench.click_button("Staff: unlock");
            bench.press("STOP");
        },
    ];
    for (index, stop) in stops.into_iter().enumerate() {
        let mut bench = armed_with(plan());
        press(&mut bench, "Fist");
        bench.run(500);
        assert!(bench.state().hand().connection.is_armed(), "{index}");
        stop(&mut bench);
        bench.run(1500);
        assert_eq!(
            stage(&bench),
            ExhibitStage::Halted(HaltReason::Stopped),
            "{index}"
        );
        assert!(!bench.state().hand().connection.is_armed(), "{index}");
        let at = bench.angle(Dof::Index);
        assert!((50..990).contains(&at), "{index}: on its way: {at}");
        let count = bench.writes().len();
        wish(&mut bench, ExhibitWish::Press(1));
        bench.wait(5000);
        assert!((bench.angle(Dof::Index) - at).abs() <= 5, "{index}");
        assert_eq!(bench.writes().len(), count, "{index}");
    }
}

#[test]
fn nothing_leads_from_the_page_to_anything_else() {
    let mut bench = shown_with(plan());
    let texts = bench.texts();
    let (endpoint, theme) = (
        bench.state().hand().connection.endpoint.clone(),
        bench.state().settings.theme,
    );
    let poses = bench.state().poses.library.clone();
    for action in [
        Action::Arm,
        Action::Disconnect,
        Action::Connect("tcp:127.0.0.1:6000".parse::<Endpoint>().unwrap()),
        Action::Gesture(Gesture::MIN),
        Action::Param(ParamAction::Read),
        Action::Param(ParamAction::Save),
        Action::Capture("mine".into()),
        Action::ClearErrors,
        Action::FactoryReset,
        Action::CalibrateForce,
        Action::Leave,
        Action::Exhibit(ExhibitAction::Leave),
        Action::Exhibit(ExhibitAction::Enter),
    ] {
        bench.act(action);
        bench.run(40);
    }
    for key in [
        Key::F1,
        Key::F11,
        Key::N,
        Key::T,
        Key::Tab,
        Key::Enter,
        Key::Num1,
        Key::Q,
    ] {
        for modifiers in [
            Modifiers::NONE,
            Modifiers::SHIFT,
            Modifiers::COMMAND,
            Modifiers::ALT,
        ] {
            bench.key_with(modifiers, key);
        }
    }
    bench.write("text");
    bench.press_secondary_at(beside(&bench));
    bench.show(View::Connection);
    bench.run(400);
    assert_eq!(bench.texts(), texts);
    assert_eq!(bench.focused(), None);
    assert_eq!(bench.cursor(), egui::CursorIcon::None);
    assert!(bench.all(Role::TextInput).is_empty() && bench.all(Role::ComboBox).is_empty());
    assert!(bench.wants_to_close(), "the cross asks for the PIN");
    assert!(matches!(staff(&bench), StaffPanel::Ask { .. }));
    let state = bench.state();
    assert_eq!(
        (&state.hand().connection.endpoint, state.settings.theme),
        (&endpoint, theme)
    );
    assert_eq!(state.poses.library, poses);
    assert!(state.hand().procedures.card.is_none() && state.leave.is_none());
    assert_eq!(bench.writes(), []);
}

#[test]
fn a_file_that_is_still_asked_for_does_not_replace_an_exhibition() {
    let mut bench = Bench::live();
    let text = include_str!("../../../assets/exhibit.toml");
    let text = text.replace("Touch a tile: the hand does it", "Another");
    std::fs::write(bench.folder().join("handscope-exhibit.toml"), text).unwrap();
    bench.act(Action::Exhibit(ExhibitAction::EnterFile));
    bench.act(Action::Exhibit(ExhibitAction::Enter));
    for _ in 0..20 {
        std::thread::sleep(std::time::Duration::from_millis(5));
        bench.run(20);
    }
    let title = &bench.state().exhibit.as_ref().unwrap().plan.title.en;
    assert_eq!(title, "Touch a tile: the hand does it");
}

#[test]
fn arming_that_was_asked_for_before_does_not_arm_the_exhibition() {
    let mut bench = Bench::open(free(), vec2(1440.0, 900.0));
    bench.wait(1000);
    bench.act(Action::Arm);
    bench.exhibit(plan());
    assert!(!bench.state().hand().connection.is_armed());
    unlock(&mut bench);
    bench.click_button("Arm");
    bench.wait(6000);
    assert_eq!(stage(&bench), ExhibitStage::Idle);
    press(&mut bench, "Fist");
    bench.wait(5000);
    assert!(bench.angle(Dof::Index) < 100);
}

#[test]
fn the_page_has_its_own_zoom_and_the_window_gets_its_own_back() {
    let zoom = Zoom::from(1.2);
    let mut bench = Bench::with(Settings {
        zoom,
        ..Settings::default()
    });
    bench.wait(1000);
    bench.exhibit(plan());
    assert!((bench.zoom() - 1.0).abs() < 1e-3);
    bench.key_with(Modifiers::COMMAND, Key::Plus);
    bench.run(100);
    assert!((bench.zoom() - 1.0).abs() < 1e-3);
    unlock(&mut bench);
    bench.click_button("Leave the exhibition");
    bench.run(100);
    assert!(bench.state().exhibit.is_none());
    assert!(bench.shows("Arm the hand"), "the window is back");
    assert!((bench.zoom() - 1.2).abs() < 1e-3);
    assert_eq!(bench.state().settings.zoom, zoom);
    bench.key_with(Modifiers::COMMAND, Key::Plus);
    bench.run(100);
    assert!(bench.zoom() > 1.25);
    assert_eq!(bench.writes(), [], "leaving a hand at rest sends nothing");
}

#[test]
fn one_touch_changes_the_language_also_before_the_pin() {
    let mut bench = shown_with(plan());
    bench.press("中文");
    bench.run(60);
    assert_eq!(bench.state().settings.language, Language::Zh);
    assert!(bench.shows("请稍候") && bench.shows("点一下，灵巧手就动") && bench.shows("握拳"));
    bench.click_button("工作人员：解锁");
    bench.run(60);
    bench.press("English");
    bench.run(60);
    assert!(bench.shows("Staff PIN"));
}

#[test]
fn after_a_quiet_minute_the_hand_shows_what_it_can_do_and_a_touch_holds_it() {
    let mut bench = armed_with(plan());
    bench.wait(50_000);
    assert_eq!(stage(&bench), ExhibitStage::Idle);
    bench.until(15_000, |bench| stage(bench) == ExhibitStage::Attract);
    assert!(bench.shows("Touch anywhere to play"));
    let open = bench.angle(Dof::Index);
    bench.until(8_000, |bench| (bench.angle(Dof::Index) - open).abs() > 150);
    let before = bench.writes().len();
    let at = beside(&bench);
    bench.press_at(at);
    bench.run(100);
    let writes = bench.writes().split_off(before);
    assert!(!told(&writes, ANGLE_SET).is_empty(), "a hold: {writes:?}");
    assert!(matches!(stage(&bench), ExhibitStage::Visit { .. }));
    bench.run(600);
    let held = bench.angle(Dof::Index);
    bench.run(1500);
    assert!((bench.angle(Dof::Index) - held).abs() <= 5);
}

#[test]
fn somebody_who_only_changed_the_language_leaves_the_page_as_it_was() {
    let mut bench = armed_with(plan());
    bench.press("中文");
    bench.run(60);
    assert_eq!(bench.state().settings.language, Language::Zh);
    bench.until(70_000, |bench| stage(bench) == ExhibitStage::Attract);
    bench.run(60);
    assert_eq!(bench.state().settings.language, Language::En);
}

#[test]
fn a_warm_hand_goes_slowly_a_hot_one_rests_open_and_comes_back() {
    let mut bench = armed_with(plan());
    press(&mut bench, "Fist");
    bench.run(1000);
    for dof in Dof::ALL {
        bench.hand(|hand, _| hand.warm(dof, 58.0));
    }
    bench.until(10_000, |bench| {
        matches!(stage(bench), ExhibitStage::Cooling { .. })
    });
    bench.run(60);
    assert!(
        bench.shows("The hand is cooling: about 2 min"),
        "{:?}",
        bench.texts()
    );
    assert!(bench.is_disabled(Role::Button, "Fist"));
    bench.wait(6000);
    assert!(bench.angle(Dof::Index) > 950 && !bench.state().hand().connection.is_armed());
    let rests = bench.writes().len();
    press(&mut bench, "Fist");
    bench.wait(20_000);
    assert_eq!(bench.writes().len(), rests);
    for dof in Dof::ALL {
        bench.hand(|hand, _| hand.warm(dof, 40.0));
    }
    bench.wait(120_000);
    assert!(
        matches!(stage(&bench), ExhibitStage::Idle | ExhibitStage::Attract),
        "{:?}",
        stage(&bench)
    );
    assert!(!bench.is_disabled(Role::Button, "Fist"));
    // Slowly: what warms fast is expected to become hot.
    for step in 0..70_u8 {
        for dof in Dof::ALL {
            bench.hand(|hand, _| hand.warm(dof, 45.0 + f64::from(step) / 10.0));
        }
        bench.wait(1000);
    }
    assert!(bench.shows("Warm: moving slowly"), "{:?}", bench.texts());
}

#[test]
fn a_tile_that_is_held_for_two_seconds_arms_again_where_visitors_may() {
    let mut bench = shown_with(ExhibitPlan {
        visitor_restart: true,
        ..plan()
    });
    assert!(bench.shows("Hold a tile for 2 seconds to start again"));
    let at = bench.rect(Role::Button, "Fist").center();
    bench.press_at(at);
    bench.run(1500);
    bench.release_at(at);
    bench.run(3000);
    assert_eq!(bench.writes(), [], "let go too soon");
    bench.press_at(at);
    bench.run(1500);
    bench.point_away();
    bench.run(3000);
    assert_eq!(bench.writes(), [], "the finger went away");
    bench.press_at(at);
    bench.run(2500);
    assert!(matches!(stage(&bench), ExhibitStage::Visit { .. }));
    bench.release_at(at);
    bench.wait(6000);
    assert!(bench.angle(Dof::Index) < 100);
}

#[test]
fn every_tile_and_stop_are_large_and_named_at_every_size() {
    let sizes: [Vec2; 4] = [
        vec2(1024.0, 640.0),
        vec2(1920.0, 1080.0),
        vec2(3840.0, 2160.0),
        vec2(1080.0, 1920.0),
    ];
    for size in sizes {
        let mut bench = Bench::open(free(), size);
        bench.wait(1000);
        bench.exhibit(plan());
        for piece in &plan().tiles {
            let rect = bench.rect(Role::Button, &piece.name.en);
            assert!(
                rect.size().min_elem() >= 72.0,
                "{} at {size}: {rect}",
                piece.name.en
            );
        }
        let stop = bench.rect(Role::Button, "STOP");
        assert!(
            stop.width() >= size.x * 0.5 && stop.height() >= 64.0,
            "{stop}"
        );
        let lock = bench.rect(Role::Button, "Staff: unlock");
        assert!(lock.size().min_elem() >= 48.0);
        assert!(bench.shows("SIMULATED"));
        for (name, _) in bench.all(Role::Button) {
            assert!(!name.trim().is_empty());
        }
    }
}

#[test]
fn a_lost_hand_is_told_and_needs_staff_when_it_is_back() {
    let mut bench = armed_with(plan());
    press(&mut bench, "Fist");
    bench.run(500);
    bench.unplug();
    bench.run(1500);
    assert_eq!(stage(&bench), ExhibitStage::Halted(HaltReason::NoHand));
    assert_eq!(bench.texts_with("the hand does not answer").len(), 1);
    bench.plug();
    bench.until(20_000, |bench| {
        stage(bench) == ExhibitStage::Halted(HaltReason::LinkLost)
    });
    bench.run(60);
    let count = bench.writes().len();
    press(&mut bench, "Open");
    bench.wait(5000);
    assert_eq!(bench.writes().len(), count);
}

#[test]
fn who_types_a_digit_too_many_does_not_leave_the_exhibition() {
    let mut bench = shown_with(plan());
    bench.click_button("Staff: unlock");
    bench.run(60);
    let seven = bench.rect(Role::Button, "7").center();
    type_pin(&mut bench, "4711");
    let leave = "Leave the exhibition";
    assert!(bench.shows(leave));
    let under = bench.rect(Role::Button, leave);
    for at in [seven, under.center(), seven, under.center()] {
        bench.press_at(at);
        bench.release_at(at);
        bench.run(200);
        assert!(bench.state().exhibit.is_some() && bench.shows(leave));
    }
    // A finger that stays is not away.
    bench.press_at(under.center());
    bench.run(1500);
    bench.release_at(under.center());
    assert!(bench.state().exhibit.is_some());
    bench.run(600);
    bench.press_at(under.center());
    bench.run(60);
    assert!(bench.state().exhibit.is_none());
}

#[test]
fn the_page_says_how_it_holds_what_a_visitor_gives_and_which_finger_pressed_harder() {
    let mut bench = armed_with(plan());
    let contacts =
        PerDof::from_fn(|dof| (dof != Dof::ThumbRotate).then_some(Obstacle::at(900.0, 10.0)));
    let object = Object {
        mass_g: 200.0,
        loads: Loads {
            lift_after_s: Some(1.0),
            pulls: listed(&[PullLoad {
                at_s: 1.0,
                force_g: 400.0,
                direction_deg: 270.0,
                rise_ms: 300.0,
                lasts_ms: 1000.0,
            }]),
            ..Loads::NONE
        },
        ..Object::touched_at(contacts)
    };
    bench.hand(|hand, _| hand.set_object(&object));
    let tiles = plan().tiles;
    let tile = tiles.iter().position(|tile| tile.name.en == "Pull it out");
    wish(&mut bench, ExhibitWish::Press(tile.unwrap()));
    bench.run(500);
    assert!(
        bench.shows("Put something into the hand"),
        "{:?}",
        bench.texts()
    );
    let says = |bench: &Bench, words: &str| !bench.texts_with(words).is_empty();
    bench.until(30_000, |bench| says(bench, "g: pull!"));
    bench.until(15_000, |bench| says(bench, "Pressed harder"));
    bench.until(40_000, |bench| bench.shows("Your turn"));
    bench.until(10_000, |bench| bench.angle(Dof::Index) > 980);
}
