//! From the plan of trials to a hand that wakes up tuned, by a person with a mouse: on a cup that breaks, over each wire,
//! the hand in another process, in real time. What the window then says, other programs read from the hand.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, Wires, run, sim_on_all};
use crate::setup::program::{InFolder, Program, env};
use crate::setup::time::Time;
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use handscope::app::env::Env;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::hand::Dof;
use handscope::params::rows::{ParamId, Value};
use handscope::record::LinkState;
use handscope::shell::headless::labels::displayed;
use handscope::ui::View;
use nix::sys::signal::Signal;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

const FRAME: Duration = Duration::from_millis(20);
/// Many times what anything here takes on an idle machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// A series that other work on this machine held up may be run again.
const RUNS: usize = 3;
/// What the cup is held with at least, g, and may be pressed with beyond the threshold.
const HOLD_G: f64 = 100.0;
const OVERSHOOT_G: f64 = 100.0;
const SPEED: ParamId = ParamId::DefaultSpeed(Dof::Index);

/// A program that keeps everything in this folder.
fn program(endpoint: &str, folder: &Path) -> Program {
    Program::start(Time::Real, Some(endpoint), || {
        let env = Env {
            files: Arc::new(InFolder(folder.into())),
            settings_path: Some(folder.join("settings.toml")),
            ..env()
        };
        (env, Settings::default())
    })
}

/// A person at the window. Everything is found by its name and pressed with the pointer.
struct Person {
    harness: Harness<'static, Program>,
}

impl Person {
    fn at(endpoint: &str, folder: &Path) -> Self {
        let harness = Harness::builder()
            .with_size(vec2(1440.0, 900.0))
            .with_step_dt(FRAME.as_secs_f32())
            .build_ui_state(
                |ui, program: &mut Program| {
                    program.logic();
                    program.ui(ui);
                },
                program(endpoint, folder),
            );
        let mut person = Self { harness };
        person.until("a live hand", |state| {
            state.hand().connection.status.state == LinkState::Monitoring
                && state.hand().connection.stats.tactile_reads > 2
        });
        person
    }

    fn state(&self) -> &State {
        self.harness.state().state()
    }

    fn look(&mut self) {
        std::thread::sleep(FRAME);
        self.harness.step();
    }

    fn until(&mut self, what: &str, so: impl Fn(&State) -> bool) {
        let begun = Instant::now();
        while !so(self.state()) {
            assert!(
                begun.elapsed() < PATIENCE,
                "{what} does not come: {:?}",
                self.state().hand().params
            );
            self.look();
        }
        self.look();
    }

    /// Presses a button as soon as it can be pressed.
    fn press(&mut self, name: &str) {
        let begun = Instant::now();
        let button = |harness: &Harness<'static, Program>| {
            let node = harness.get_by_role_and_label(Role::Button, name);
            !node.accesskit_node().is_disabled()
        };
        while !button(&self.harness) {
            assert!(begun.elapsed() < PATIENCE, "{name} stays disabled");
            self.look();
        }
        self.harness
            .get_by_role_and_label(Role::Button, name)
            .click();
        self.harness.step();
        self.harness.remove_cursor();
        self.look();
    }

    fn open(&mut self, tab: &str, view: View) {
        self.press(tab);
        assert_eq!(self.harness.state().desktop_app.view(), view);
    }

    fn enter(&mut self, field: &str, text: &str) {
        let input = |harness: &Harness<'static, Program>| {
            harness
                .get_by_role_and_label(Role::TextInput, field)
                .focus();
        };
        input(&self.harness);
        self.look();
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.look();
        self.harness
            .get_by_role_and_label(Role::TextInput, field)
            .type_text(text);
        self.look();
        self.harness.key_press(Key::Enter);
        self.look();
    }

    /// What stands under a name.
    fn reading(&self, name: &str) -> String {
        let labels = self.harness.query_all_by_role(Role::Label);
        let mut named =
            labels.filter(|node| node.accesskit_node().label().as_deref() == Some(name));
        let found = named.next().and_then(|node| node.value());
        let found = found.unwrap_or_else(|| panic!("no reading '{name}'"));
        displayed(name, &found).to_owned()
    }
}

/// Writes the plan: the index closes onto the cup at two speeds.
fn plan(person: &mut Person) {
    person.open("Tune", View::Tune);
    person.press("Try a grid");
    for (field, text) in [
        ("Index from", "600"),
        ("Index to", "300"),
        ("Speeds to try", "25, 250"),
        ("Force thresholds to try", "200"),
        ("Hold, s", "0.5"),
        ("Rest, s", "0"),
        ("Force limit, g", "1500"),
    ] {
        person.enter(field, text);
    }
}

/// Runs the series in an arming of its own; whether it was left alone until its end.
fn tried(person: &mut Person) -> bool {
    person.press("Arm the hand");
    person.until("the arming", |state| state.hand().connection.is_armed());
    person.press("Start trials");
    assert!(person.state().hand().running.series().is_some());
    person.until("the end of the series", |state| {
        state.hand().running.series().is_none()
    });
    person.until("disarming", |state| !state.hand().connection.is_armed());
    let last = person.state().trials.sessions.last().unwrap();
    last.head.aborted.is_none()
}

/// The quickest setting that spares the cup, as the window names it, and its overshoot.
fn chosen(person: &mut Person) -> (i32, i32) {
    person.open("Hide the plan", View::Compare);
    person.press("Fastest within 100 g");
    person.enter("Holds at least, g", &format!("{HOLD_G}"));
    let best = person.reading("Best");
    let (speed, force) = best.trim().split_once(" / ").expect(&best);
    let force = force.trim_end_matches(" g").parse().unwrap();
    (speed.parse().unwrap(), force)
}

fn check_gentle(state: &State, speed: i32) {
    let session = state.trials.sessions.last().unwrap();
    let tried = session.trials.iter();
    let tried: Vec<_> = tried
        .filter(|tried| i32::from(tried.summary.setting.speed.get()) == speed)
        .collect();
    assert!(!tried.is_empty());
    for joint in tried.iter().flat_map(|tried| &tried.summary.joints) {
        let over = joint.overshoot_g.expect("it was measured");
        let steady = joint.steady_force_g.expect("it was measured");
        assert!(over < OVERSHOOT_G, "{over}");
        assert!(steady >= HOLD_G, "{steady}");
    }
}

/// Makes the best the default: two presses.
fn keep(person: &mut Person) {
    person.press("Make it the default");
    person.until("the question", |state| {
        state.hand().params.question().is_some()
    });
    person.press("Apply and save");
    person.until("the end of SAVE", |state| {
        let params = &state.hand().params;
        !params.is_busy() && params.save.is_some() && params.staged(SPEED).is_none()
    });
}

fn power_cycle(sim: &mut Running, person: &mut Person) {
    sim.signal(Signal::SIGUSR1);
    sim.until(|line| line == "power cycled");
    person.until("the hand again", |state| {
        state.hand().connection.status.state == LinkState::Monitoring
            && state.hand().readings.sample.speed_set.is_some()
    });
}

/// The whole way on one wire of a hand that serves all of them.
fn walk(choose: fn(&Wires) -> &str) {
    let folder = tempfile::tempdir().unwrap();
    let (mut sim, wires) = sim_on_all(folder.path(), &["--scenario", "fragile"]);
    let hand = choose(&wires);
    let mut person = Person::at(hand, folder.path());
    plan(&mut person);
    assert!((0..RUNS).any(|_| tried(&mut person)), "disturbed");
    let (speed, force) = chosen(&mut person);
    check_gentle(person.state(), speed);
    keep(&mut person);
    power_cycle(&mut sim, &mut person);
    let live = person.state().hand().params.live(SPEED).unwrap();
    assert_eq!(live.0, Value::Number(speed));
    drop(person);
    check_by_script(hand, folder.path(), speed, force);
}

#[test]
fn a_person_finds_what_spares_a_cup_and_the_hand_wakes_up_so_over_tcp() {
    unless_busy(|| {
        walk(|wires| &wires.tcp);
    });
}

#[test]
fn a_person_finds_what_spares_a_cup_and_the_hand_wakes_up_so_over_rs485() {
    unless_busy(|| {
        walk(|wires| &wires.rs485);
    });
}

#[test]
fn a_person_finds_what_spares_a_cup_and_the_hand_wakes_up_so_over_modbus_rtu() {
    unless_busy(|| {
        walk(|wires| &wires.rtu);
    });
}

#[test]
fn a_person_finds_what_spares_a_cup_and_the_hand_wakes_up_so_over_a_can_adapter() {
    unless_busy(|| {
        walk(|wires| &wires.slcan);
    });
}

/// Other programs find what the person chose.
fn check_by_script(hand: &str, place: &Path, speed: i32, force: i32) {
    let wanted = place.join("wanted.toml");
    let rows = format!("[default_speed]\nindex = {speed}\n[default_force]\nindex = {force}");
    let text = format!("format = \"handscope-params\"\nversion = 1\n{rows}\n");
    std::fs::write(&wanted, text).unwrap();
    let found = run(&[
        "params",
        "diff",
        wanted.to_str().unwrap(),
        "--json",
        "--hand",
        hand,
    ]);
    let found = found.ok().lines().pop().unwrap();
    assert_eq!(found["differences"], 0, "{hand}");
    for (register, value) in [("SPEED_SET", speed), ("FORCE_SET", force)] {
        let read = run(&["read", register, "--json", "--hand", hand]).ok();
        let read = read.lines().pop().unwrap();
        assert_eq!(
            read[register][Dof::Index.index()],
            value,
            "{hand} {register}"
        );
    }
}
