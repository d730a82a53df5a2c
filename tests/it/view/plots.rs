//! The plots against a history that is known: time, zoom, cursors, notes, what is shown and what is saved. No hand.

use crate::setup::states;
use crate::setup::view::{self, LARGE, SMALL, Shown};
use egui::accesskit::{Role, Toggled};
use egui::{Event, Key, Modifiers, Pos2, Rect, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use handscope::app::action::Action;
use handscope::app::files::export::Export;
use handscope::app::settings::{Language, PlotKind, PlotWindow};
use handscope::app::state::State;
use handscope::hand::{
    Dof, ForceReading, Group, Groups, HandSample, Moment, PerDof, Status, Timed,
};
use handscope::history::{History, MarkKind};
use handscope::record::LinkState;
use handscope::shell::headless::labels::displayed;
use handscope::ui::View;
use std::time::Duration;

fn open_at(state: State, size: Vec2) -> Harness<'static, Shown> {
    view::open(state, View::Live, view::display(size).with_step_dt(0.02))
}

/// A hundred seconds of force, at 100 Hz: each joint rises by 10 g a second, from 100 g times its number; between 60
/// and 62 s nothing was measured, and at 95.5 s the index finger was hit once.
fn known() -> State {
    let mut state = states::empty();
    state.now = Moment::from_micros(100_000_000);
    let mut history = History::new();
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Force);
    for tick in 0..=10_000_u64 {
        if (6001..6200).contains(&tick) {
            continue;
        }
        let at = Moment::from_micros(tick * 10_000);
        let grams = |dof: Dof| {
            let hit = dof == Dof::Index && tick == 9550;
            let base = 100 * i16::try_from(dof.index()).unwrap();
            if hit {
                2500
            } else {
                base + i16::try_from(tick / 10).unwrap()
            }
        };
        let sample = HandSample {
            force: Some(Timed {
                value: PerDof::from_fn(|dof| ForceReading::new(grams(dof))),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        };
        history.push(&sample, fresh);
    }
    state.hand_mut().measured.history = history;
    state
}

/// A window that is too low for four tall plots.
const LOW: Vec2 = vec2(1440.0, 880.0);

fn open() -> Harness<'static, Shown> {
    open_at(known(), LARGE)
}

fn rect(harness: &Harness<'static, Shown>, role: Role, name: &str) -> Rect {
    harness.get_by_role_and_label(role, name).rect()
}

fn ground(harness: &Harness<'static, Shown>) -> Rect {
    rect(harness, Role::Image, "Force, g")
}

/// A place in the topmost plot, at a part of its width.
fn at(harness: &Harness<'static, Shown>, part: f32) -> Pos2 {
    let ground = ground(harness);
    pos2(ground.left() + ground.width() * part, ground.top() + 30.0)
}

fn hover(harness: &mut Harness<'static, Shown>, part: f32) {
    let place = at(harness, part);
    harness.hover_at(place);
    harness.run_steps(3);
}

fn drag(harness: &mut Harness<'static, Shown>, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for step in 1_u8..=10 {
        harness.hover_at(from.lerp(to, f32::from(step) / 10.0));
        harness.step();
    }
    harness.drop_at(to);
    harness.run_steps(3);
}

fn press(harness: &mut Harness<'static, Shown>, name: &str) {
    harness.get_by_label(name).click();
    harness.remove_cursor();
    harness.run_steps(3);
}

fn choose_window(harness: &mut Harness<'static, Shown>, window: &str) {
    press(harness, "Plot window");
    harness.get_by_role_and_label(Role::Button, window).click();
    harness.run_steps(30);
}

/// The words of a named reading.
fn reading(harness: &Harness<'static, Shown>, name: &str) -> Option<String> {
    let mut all = harness.query_all_by_role(Role::Label);
    let found = all.find(|node| node.accesskit_node().label().as_deref() == Some(name))?;
    found
        .value()
        .map(|value| displayed(name, &value).to_owned())
}

/// A row of the cursors' table.
fn row(harness: &Harness<'static, Shown>, line: &str) -> Vec<String> {
    let columns = ["A", "B", "B - A", "per s", "min", "max", "mean"];
    let cells = columns.map(|column| reading(harness, &format!("{line}: {column}")));
    cells.into_iter().flatten().collect()
}

fn force_at_pointer(harness: &Harness<'static, Shown>) -> Vec<f64> {
    let text = reading(harness, "Force, g under the pointer").expect("a reading");
    text.split(' ')
        .map(|word| word.parse().unwrap_or(f64::NAN))
        .collect()
}

/// The time under a part of the plots, read from the little finger's ramp.
fn time_at(harness: &mut Harness<'static, Shown>, part: f32) -> f64 {
    hover(harness, part);
    force_at_pointer(harness)[0] / 10.0
}

fn near(one: f64, two: f64, by: f64) {
    assert!((one - two).abs() <= by, "{one} is not {two}");
}

fn is_held(harness: &Harness<'static, Shown>) -> bool {
    let node = harness.get_by_label("Pause the plots");
    node.accesskit_node().toggled() == Some(Toggled::True)
}

fn pass(harness: &mut Harness<'static, Shown>, time: Duration) {
    let now = harness.state().state.now.plus(time);
    harness.state_mut().state.now = now;
    harness.run_steps(2);
}

#[test]
fn the_values_under_the_pointer_are_read_out_while_live() {
    let mut harness = open();
    hover(&mut harness, 0.5);
    assert!(!is_held(&harness));
    let values = force_at_pointer(&harness);
    for (n, value) in values.iter().enumerate() {
        near(
            *value,
            950.0 + 100.0 * f64::from(u8::try_from(n).unwrap()),
            2.0,
        );
    }
    harness.remove_cursor();
    harness.run_steps(2);
    assert_eq!(reading(&harness, "Force, g under the pointer"), None);
}

#[test]
fn a_long_title_leaves_room_for_all_values_under_the_pointer() {
    let mut harness = open_at(known(), LOW);
    hover(&mut harness, 0.5);
    let values = harness.query_all_by_role(Role::Label);
    let values = values.filter_map(|node| {
        let name = node.accesskit_node().label()?;
        let title = name.strip_suffix(" under the pointer")?;
        Some((title.to_owned(), node.rect().width()))
    });
    let values: Vec<(String, f32)> = values.collect();
    let [(short, narrow), (long, wide)] = values.as_slice() else {
        panic!("{values:?}")
    };
    assert!(short.len() < 10 && long.len() > 20, "{short} {long}");
    near(f64::from(*wide), f64::from(*narrow), 0.1);
}

#[test]
fn the_wheel_zooms_around_the_pointer_and_a_double_click_follows_again() {
    let mut harness = open();
    let before = time_at(&mut harness, 0.25);
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 180.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    assert!(is_held(&harness));
    near(time_at(&mut harness, 0.25), before, 0.15);
    let width = (time_at(&mut harness, 0.95) - time_at(&mut harness, 0.05)) / 0.9;
    near(width, 5.0, 0.3);
    let place = at(&harness, 0.5);
    for _ in 0..2 {
        harness.drag_at(place);
        harness.step();
        harness.drop_at(place);
        harness.step();
    }
    harness.run_steps(3);
    assert!(!is_held(&harness));
    near(time_at(&mut harness, 0.5), 95.0, 0.15);
}

#[test]
fn a_drag_moves_in_time_and_shift_marks_what_to_zoom_into() {
    let mut harness = open();
    let (from, to) = (at(&harness, 0.2), at(&harness, 0.7));
    drag(&mut harness, from, to);
    assert!(is_held(&harness));
    near(time_at(&mut harness, 0.5), 90.0, 0.2);
    let (from, to) = (at(&harness, 0.4), at(&harness, 0.6) + vec2(0.0, 3.0));
    box_with_shift(&mut harness, from, to);
    let width = (time_at(&mut harness, 0.9) - time_at(&mut harness, 0.1)) / 0.8;
    near(width, 2.0, 0.3);
    assert!(
        harness.query_by_label("fixed scale").is_none(),
        "a low box marks time alone"
    );
    // A high one marks values too, until a double click takes both back.
    let (from, to) = (at(&harness, 0.2), at(&harness, 0.8) + vec2(0.0, 40.0));
    box_with_shift(&mut harness, from, to);
    harness.get_by_label("fixed scale");
    let place = at(&harness, 0.5);
    for _ in 0..2 {
        harness.drag_at(place);
        harness.step();
        harness.drop_at(place);
        harness.step();
    }
    harness.run_steps(3);
    assert!(!is_held(&harness) && harness.query_by_label("fixed scale").is_none());
}

/// Draws a box with the primary button and shift.
fn box_with_shift(harness: &mut Harness<'static, Shown>, from: Pos2, to: Pos2) {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::SHIFT,
    };
    harness.event_modifiers(Event::PointerMoved(from), Modifiers::SHIFT);
    harness.step();
    harness.event_modifiers(button(from, true), Modifiers::SHIFT);
    harness.step();
    for step in 1_u8..=30 {
        let at = from.lerp(to, f32::from(step) / 30.0);
        harness.event_modifiers(Event::PointerMoved(at), Modifiers::SHIFT);
        harness.step();
    }
    harness.event_modifiers(button(to, false), Modifiers::SHIFT);
    harness.run_steps(3);
}

#[test]
fn a_pause_stands_still_and_loses_nothing() {
    let mut harness = open();
    press(&mut harness, "Pause the plots");
    pass(&mut harness, Duration::from_secs(3));
    near(time_at(&mut harness, 0.5), 95.0, 0.15);
    press(&mut harness, "Pause the plots");
    near(time_at(&mut harness, 0.5), 98.0, 0.15);
}

#[test]
fn what_was_chosen_for_one_hand_is_not_kept_for_another() {
    let mut state = known();
    state.hand_mut().connection.endpoint = Some("rs485:x".parse().unwrap());
    let mut harness = open_at(state, LARGE);
    press(&mut harness, "Pause the plots");
    press(&mut harness, "Cursors");
    assert!(is_held(&harness) && harness.query_by_label("Cursor A").is_some());
    harness.state_mut().state.hand_mut().connection.endpoint = None;
    harness.run_steps(3);
    assert!(is_held(&harness), "what was seen last can be looked at");
    harness.state_mut().state.hand_mut().connection.endpoint = Some("rs485:y".parse().unwrap());
    harness.run_steps(3);
    assert!(!is_held(&harness) && harness.query_by_label("Cursor A").is_none());
}

#[test]
fn nothing_points_at_values_that_are_old() {
    let mut harness = open();
    harness
        .state_mut()
        .state
        .hand_mut()
        .measured
        .history
        .gap(Moment::from_micros(100_000_000));
    pass(&mut harness, Duration::from_secs(5));
    hover(&mut harness, 0.9);
    let told = reading(&harness, "Force, g under the pointer").expect("a reading");
    assert_eq!(told, "- - - - - -", "at the right end there is no value");
    hover(&mut harness, 0.3);
    assert!(force_at_pointer(&harness)[0] > 900.0);
}

#[test]
fn an_hour_can_be_chosen_and_a_hit_of_one_measurement_is_told_in_it() {
    let mut harness = open();
    choose_window(&mut harness, "1 h");
    assert_eq!(harness.state().state.settings.plot_window, PlotWindow::H1);
    assert!(force_ends(&harness)[0] >= 2500.0, "no extreme is lost");
}

#[test]
fn cursors_tell_the_figures_of_all_measurements() {
    let mut harness = open();
    press(&mut harness, "Cursors");
    let handle = |harness: &Harness<'static, Shown>, name: &str| {
        let node = harness.get_by_role_and_label(Role::Slider, name);
        (
            node.rect().center(),
            node.accesskit_node().numeric_value().unwrap(),
        )
    };
    near(handle(&harness, "Cursor A").1, 100.0 - 20.0 / 3.0, 1e-6);
    let ground = ground(&harness);
    for (name, part) in [("Cursor A", 0.4), ("Cursor B", 0.6)] {
        let (from, _) = handle(&harness, name);
        let to = pos2(ground.left() + ground.width() * part, from.y);
        drag(&mut harness, from, to);
    }
    let (_, a) = handle(&harness, "Cursor A");
    let (_, b) = handle(&harness, "Cursor B");
    near(a, 94.0, 0.05);
    near(b, 96.0, 0.05);
    assert!(!is_held(&harness), "moving a cursor moves no plot");
    let figures = |name: &str| -> Vec<f64> {
        let texts = row(&harness, name).into_iter();
        texts.map(|text| text.parse().unwrap()).collect()
    };
    let little = figures("Little Force, g");
    let want = [
        10.0 * a,
        10.0 * b,
        10.0 * (b - a),
        10.0,
        10.0 * a,
        10.0 * b,
        5.0 * (a + b),
    ];
    for (got, want) in little.iter().zip(want) {
        near(*got, want, 1.5);
    }
    // The hit lies between: largest shows it, and the mean counts it once.
    let index = figures("Index Force, g");
    near(index[5], 2500.0, 0.01);
    near(
        index[6],
        300.0 + 5.0 * (a + b) + (2500.0 - 1255.0) / 200.0,
        1.5,
    );
}

#[test]
fn a_cursor_in_a_gap_has_no_value_and_figures_can_be_of_each_plot() {
    let mut state = known();
    state.now = Moment::from_micros(64_000_000);
    let mut harness = open_at(state, LARGE);
    choose_window(&mut harness, "5 s");
    press(&mut harness, "Cursors");
    // A at 60.67 s, B at 62.33 s.
    let words = row(&harness, "Little Force, g");
    assert_eq!(words[0], "-", "{words:?}");
    assert_eq!(words[2], "-", "{words:?}");
    near(words[4].parse().unwrap(), 620.0, 1.0);
    press(&mut harness, "Figures of the next plot");
    assert_eq!(row(&harness, "Little Current, mA").len(), 7);
}

#[test]
fn a_note_stands_at_the_moment_of_its_key() {
    for size in [SMALL, LARGE] {
        let mut harness = open_at(known(), size);
        // A keyboard brings both at once.
        let key = Event::Key {
            key: Key::N,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        harness
            .input_mut()
            .events
            .extend([key, Event::Text("n".into())]);
        harness.run_steps(3);
        let field = harness.get_by_role_and_label(Role::TextInput, "Words of the note");
        assert!(field.is_focused());
        assert_eq!(field.value().unwrap_or_default(), "");
        field.type_text("slips here");
        harness.state_mut().actions.clear();
        pass(&mut harness, Duration::from_secs(4));
        // A space between words is a space, and no stop.
        harness.key_press(Key::Space);
        harness.run_steps(2);
        assert_eq!(harness.state().actions, []);
        harness.key_press(Key::Enter);
        harness.run_steps(3);
        let at = Moment::from_micros(100_000_000);
        assert_eq!(
            harness.state().actions,
            [Action::Note(at, "slips here".into())]
        );
        assert!(harness.query_by_label("Words of the note").is_none());
        // It is told where its line is.
        hover(&mut harness, 0.6);
        harness.run_steps(60);
        assert!(harness.query_by_label_contains("slips here").is_some());
    }
}

#[test]
fn escape_stops_an_armed_hand_while_a_note_is_written_and_a_letter_in_another_field_opens_none() {
    let mut state = known();
    state.hand_mut().connection.status.state = LinkState::Armed;
    let mut harness = view::open(state, View::Live, view::display(LARGE));
    harness.key_press(Key::N);
    harness.run_steps(3);
    harness.state_mut().actions.clear();
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(harness.state().actions, [Action::Stop]);
    press(&mut harness, "Cancel");
    assert!(harness.query_by_label("Words of the note").is_none());
    harness.get_by_label("Index force number").focus();
    harness.run_steps(2);
    harness.key_press(Key::N);
    harness.run_steps(2);
    assert!(harness.query_by_label("Words of the note").is_none());
}

/// The numbers beside the plot of force; what a wheel or a drag does to them.
fn force_scale(harness: &Harness<'static, Shown>) -> Rect {
    rect(harness, Role::Image, "Value scale: Force, g")
}

/// The upper and the lower end of the scale of force, as it tells.
fn force_ends(harness: &Harness<'static, Shown>) -> [f64; 2] {
    let axis = harness.get_by_role_and_label(Role::Image, "Value scale: Force, g");
    let ends = axis.value().unwrap();
    let (low, high) = ends.split_once(" to ").unwrap();
    [high, low].map(|end| end.parse().unwrap())
}

#[test]
fn a_value_scale_is_dragged_zoomed_and_automatic_again() {
    let mut harness = open();
    assert!(harness.query_by_label("fixed scale").is_none());
    let [high, low] = force_ends(&harness);
    assert!(high >= 1500.0 && low <= 0.0, "{low} to {high}");
    let axis = force_scale(&harness);
    // Half of its height down: the scale moves up by half of what it spans.
    drag(
        &mut harness,
        axis.center_top() + vec2(0.0, axis.height() * 0.3),
        axis.center_top() + vec2(0.0, axis.height() * 0.8),
    );
    harness.get_by_label("fixed scale");
    assert!(!is_held(&harness), "time goes on");
    let [moved_high, moved_low] = force_ends(&harness);
    near(moved_high - moved_low, high - low, 1.0);
    near(moved_high - high, (high - low) * 0.5, (high - low) * 0.1);
    // New values do not move it.
    pass(&mut harness, Duration::from_secs(9));
    near(force_ends(&harness)[0], moved_high, 0.1);
    harness.hover_at(axis.center());
    harness.step();
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 180.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    harness.remove_cursor();
    let [zoomed_high, zoomed_low] = force_ends(&harness);
    near(
        zoomed_high - zoomed_low,
        (high - low) / 2.0,
        (high - low) * 0.05,
    );
    for _ in 0..2 {
        harness.drag_at(axis.center());
        harness.step();
        harness.drop_at(axis.center());
        harness.step();
    }
    harness.run_steps(30);
    harness.remove_cursor();
    harness.run_steps(3);
    assert!(harness.query_by_label("fixed scale").is_none());
}

fn saved(harness: &mut Harness<'static, Shown>) -> String {
    harness.get_by_label("Save these 5 s as CSV").click();
    harness.run_steps(2);
    let mut actions = harness.state().actions.iter();
    let table = actions.find_map(|action| match action {
        Action::Save(Export::Plots(table)) => Some(table.csv()),
        _ => None,
    });
    table.expect("something was saved")
}

#[test]
fn what_is_shown_is_saved_with_heads_and_units_and_gaps_are_empty() {
    let mut state = known();
    state.now = Moment::from_micros(64_000_000);
    state
        .hand_mut()
        .measured
        .history
        .mark(Moment::from_micros(61_000_000), MarkKind::Stop);
    let mut harness = open_at(state, LARGE);
    choose_window(&mut harness, "5 s");
    press(&mut harness, "More for the plots");
    for joint in ["Little", "Ring", "Middle", "Thumb bend", "Thumb rotate"] {
        press(&mut harness, &format!("History: {joint}"));
    }
    for plot in ["Current, mA", "Temperature, °C"] {
        harness.get_by_role_and_label(Role::CheckBox, plot).click();
        harness.run_steps(3);
    }
    let csv = saved(&mut harness);
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(
        lines[0],
        "time_s,target_angle_index,angle_index,force_index_g,event".replace(
            "target_angle_index,angle_index,force_index_g",
            heads(lines[0])
        )
    );
    let force = lines[0]
        .split(',')
        .position(|head| head == "force_index_g")
        .unwrap();
    let cell = |line: &str, n: usize| line.split(',').nth(n).unwrap().to_owned();
    assert_eq!(cell(lines[1], 0), "59.000000");
    assert_eq!(cell(lines[1], force), "890");
    // 59 to 60 s, a break, the stop, 62 to 64 s.
    assert_eq!(lines.len(), 1 + 101 + 1 + 1 + 201);
    assert_eq!(cell(lines[102], force), "");
    assert_eq!(lines[103], "61.000000,,,,stop");
    assert_eq!(cell(lines[104], force), "920");
}

/// The order of the plots is not what is tested.
fn heads(line: &str) -> &str {
    let line = line.strip_prefix("time_s,").unwrap();
    line.strip_suffix(",event").unwrap()
}

#[test]
fn plots_are_shown_and_hidden_and_the_last_one_stays() {
    let mut harness = open();
    let mut state = known();
    state.settings.language = Language::Zh;
    drop(open_at(state, LARGE));
    press(&mut harness, "More for the plots");
    let force = harness.get_by_role_and_label(Role::CheckBox, "Force, g");
    force.click();
    harness.run_steps(3);
    assert!(!harness.state().state.settings.plots.shows(PlotKind::Force));
    for name in ["Current, mA", "Temperature, °C"] {
        harness.get_by_role_and_label(Role::CheckBox, name).click();
        harness.run_steps(3);
    }
    let last = harness.get_by_role_and_label(Role::CheckBox, "Angle, 0 bent to 1000 open");
    assert!(last.accesskit_node().is_disabled());
    let tips = harness.get_by_role_and_label(Role::CheckBox, "Normal force at the tips, N");
    tips.click();
    harness.run_steps(3);
    assert!(harness.state().state.settings.plots.shows(PlotKind::Normal));
}

#[test]
fn a_hidden_joint_is_neither_read_out_nor_in_the_table() {
    let mut harness = open();
    // At the end of its curve.
    press(&mut harness, "Force, g: Little");
    hover(&mut harness, 0.5);
    assert_eq!(force_at_pointer(&harness).len(), 5);
    press(&mut harness, "Cursors");
    assert_eq!(row(&harness, "Little Force, g").len(), 0);
    assert_eq!(row(&harness, "Ring Force, g").len(), 7);
    press(&mut harness, "More for the plots");
    press(&mut harness, "History: Little");
    press(&mut harness, "More for the plots");
    assert_eq!(
        row(&harness, "Little Force, g").len(),
        7,
        "it is shown again"
    );
}

#[test]
fn a_sparkline_grows_at_a_click_and_another_plot_shrinks() {
    let mut harness = open_at(known(), LOW);
    let grown = |harness: &Harness<'static, Shown>| -> Vec<PlotKind> {
        let settings = &harness.state().state.settings;
        settings.tall_plots.of(&settings.plots, 2)
    };
    assert_eq!(grown(&harness), [PlotKind::Force, PlotKind::Angle]);
    harness.get_by_label("Value scale: Force, g");
    assert!(harness.query_by_label("Value scale: Current, mA").is_none());
    press(&mut harness, "Grow: Current, mA");
    assert_eq!(grown(&harness), [PlotKind::Current, PlotKind::Force]);
    harness.get_by_label("Value scale: Current, mA");
    harness.get_by_label("Grow: Angle, 0 bent to 1000 open");
    // The line itself does it, too.
    let line = rect(&harness, Role::Image, "Temperature, °C");
    assert!(line.height() <= 32.0, "{line}");
    harness.hover_at(line.center());
    harness.step();
    harness.drag_at(line.center());
    harness.step();
    harness.drop_at(line.center());
    harness.run_steps(3);
    assert_eq!(grown(&harness), [PlotKind::Temperature, PlotKind::Current]);
}

#[test]
fn in_a_high_window_all_four_plots_have_their_axes() {
    let titles = [
        "Force, g",
        "Current, mA",
        "Temperature, °C",
        "Angle, 0 bent to 1000 open",
    ];
    let scales = |harness: &Harness<'static, Shown>| -> Vec<bool> {
        let has = |title: &str| {
            let scale = format!("Value scale: {title}");
            harness.query_by_label(&scale).is_some()
        };
        titles.iter().map(|title| has(title)).collect()
    };
    let mut harness = open();
    assert_eq!(scales(&harness), [true; 4]);
    for pair in titles.windows(2) {
        let [above, below] = [pair[0], pair[1]].map(|title| rect(&harness, Role::Image, title));
        assert!(
            above.bottom() <= below.top() && above.height() >= 80.0,
            "{above}"
        );
    }
    // Below 900 points two are tall, and a click grows another.
    harness = open_at(known(), LOW);
    assert_eq!(scales(&harness), [true, false, false, true]);
    press(&mut harness, "Grow: Current, mA");
    assert_eq!(scales(&harness), [true, true, false, false]);
}

#[test]
fn the_time_under_a_resting_pointer_is_exact_in_each_plot_while_time_goes_on() {
    let mut state = known();
    state.now = Moment::from_micros(90_000_000);
    let mut harness = open_at(state, LARGE);
    let lowest = rect(&harness, Role::Image, "Angle, 0 bent to 1000 open");
    harness.hover_at(lowest.center());
    harness.run_steps(3);
    for second in 91..94 {
        harness.state_mut().state.now = Moment::from_micros(second * 1_000_000);
        harness.step();
        let little = force_at_pointer(&harness)[0];
        near(little / 10.0, second as f64 - 5.0, 0.05);
    }
}

#[test]
fn nothing_is_told_where_the_pointer_is_over_a_gap() {
    let mut state = known();
    state.now = Moment::from_micros(64_000_000);
    let mut harness = open_at(state, LARGE);
    // 60.3 s: the last reading is 0.3 s before.
    hover(&mut harness, 0.63);
    let told = reading(&harness, "Force, g under the pointer").expect("a reading");
    assert_eq!(told, "- - - - - -");
}

#[test]
fn the_rows_under_the_plots_tell_what_each_drive_said_and_since_when() {
    let mut state = known();
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Status);
    for tick in 900..1000_u64 {
        let at = Moment::from_micros(tick * 100_000);
        let status = |dof: Dof| match dof {
            Dof::Index if tick >= 950 => Status::ForceReached,
            _ => Status::Grasping,
        };
        let sample = HandSample {
            status: Some(Timed {
                value: PerDof::from_fn(status),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        };
        state.hand_mut().measured.history.push(&sample, fresh);
    }
    let mut harness = open_at(state, LOW);
    let rows = rect(&harness, Role::Image, "Status");
    let plot = ground(&harness);
    let mut told = |part: f32, row: u8| {
        let x = plot.left() + plot.width() * part;
        harness.hover_at(pos2(x, rows.top() + 6.0 + 5.0 * f32::from(row)));
        harness.run_steps(60);
        let tip = harness.query_by_label_contains("since 1:");
        tip.and_then(|node| node.value())
    };
    let index = u8::try_from(Dof::Index.index()).unwrap();
    assert_eq!(
        told(0.8, index).as_deref(),
        Some("Index: At force\nsince 1:35.0, for 4.9 s")
    );
    let before = told(0.2, index).unwrap();
    assert!(
        before.starts_with("Index: Closing\nsince 1:30.0"),
        "{before}"
    );
    let little = told(0.8, 0).unwrap();
    assert!(little.starts_with("Little: Closing"), "{little}");
}

#[test]
fn switches_table_and_plots_stay_apart_at_every_size_and_in_both_languages() {
    for size in [SMALL, LARGE, vec2(2560.0, 1440.0)] {
        for (language, cursors) in [(Language::En, "Cursors"), (Language::Zh, "游标")] {
            let mut state = known();
            state.settings.language = language;
            PlotKind::ALL
                .into_iter()
                .for_each(|kind| state.settings.plots.set(kind, true));
            let mut harness = open_at(state, size);
            press(&mut harness, cursors);
            let area = match language {
                Language::En => ["Force, g", "Angle, 0 bent to 1000 open"],
                Language::Zh => ["受力 g", "角度 0 弯曲 1000 张开"],
            };
            let lowest = harness.query_by_role_and_label(Role::Image, area[1]);
            // While figures are read, only the plot they are of is shown in little room.
            let ground = rect(&harness, Role::Image, area[0]);
            // The flags of the cursors stand below the tall ones, over the sparklines.
            let lowest = lowest.map(|lowest| lowest.rect());
            let lowest = lowest.filter(|lowest| lowest.height() > 40.0);
            let ground = lowest.map_or(ground, |lowest| ground.union(lowest));
            let card = (ground.left() - 60.0)..=(ground.right() + 20.0);
            let screen = Rect::from_min_size(Pos2::ZERO, size);
            let roles = [
                Role::Button,
                Role::Slider,
                Role::TextInput,
                Role::CheckBox,
                Role::ComboBox,
            ];
            let mut all: Vec<Rect> = roles
                .into_iter()
                .flat_map(|role| harness.query_all_by_role(role))
                .map(|node| node.rect())
                .filter(|place| {
                    card.contains(&place.left()) && place.top() < ground.bottom() + 200.0
                })
                .collect();
            all.push(ground);
            assert!(all.len() > 8 && ground.height() > 36.0, "{size} {ground}");
            while let Some(one) = all.pop() {
                assert!(screen.contains_rect(one), "{size} {one}");
                for other in &all {
                    assert!(!one.shrink(0.5).intersects(*other), "{size} {one} {other}");
                }
            }
        }
    }
}

#[test]
fn time_and_value_at_the_pointer_lie_over_the_curves() {
    let mut harness = open_at(known(), LARGE);
    // With so many readings in a column, the curves are one mesh.
    choose_window(&mut harness, "1 min");
    let place = at(&harness, 0.5);
    harness.hover_at(place);
    harness.run_steps(4);
    let shapes = &harness.output().shapes;
    let is_text = |shape: &egui::Shape| match shape {
        egui::Shape::Text(text) => text.galley.text().contains(" s  "),
        _ => false,
    };
    let text = shapes.iter().rposition(|clipped| is_text(&clipped.shape));
    let text = text.expect("time and value are shown");
    let plot = ground(&harness);
    let covers = |shape: &egui::Shape| {
        matches!(shape, egui::Shape::Mesh(_)) && shape.visual_bounding_rect().intersects(plot)
    };
    let mut after = shapes.iter().skip(text);
    assert!(!after.any(|clipped| covers(&clipped.shape)));
    let mut before = shapes.iter().take(text);
    assert!(before.any(|clipped| covers(&clipped.shape)));
}
