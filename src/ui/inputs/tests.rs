//! The drawn gamepad and its list, by label and by picture. With `HANDSCOPE_PICTURES=folder` it is drawn into files, to be
//! looked at.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]

use crate::app::settings::{Language, Theme};
use crate::hand::Dof;
use crate::hand::kinematics::Side;
use crate::inputs::pad::control::kernel_code;
use crate::inputs::pad::input::FingerChoice;
use crate::inputs::pad::{
    AxisRange, FaceOrder, KernelEvent, PadAction, PadControl, PadFacts, PadMap, PadState,
};
use crate::shell::headless::canvas::Canvas;
use crate::shell::headless::png;
use crate::ui::inputs::pad_picture::{PadShown, PoseName, pad_picture_ui};
use crate::ui::inputs::pad_table::pad_table_ui;
use crate::ui::kit::{Look, card_ui};
use crate::ui::theme::Palette;
use crate::ui::window;
use egui::{Ui, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use std::path::Path;

const STICK: AxisRange = AxisRange {
    min: -1000,
    max: 1000,
    flat: 0,
};
const TRIGGER: AxisRange = AxisRange {
    min: 0,
    max: 100,
    flat: 0,
};

/// An Xbox pad on which this happened.
fn state(events: &[(&str, i32)]) -> PadState {
    let axes = [
        ("ABS_X", STICK),
        ("ABS_Y", STICK),
        ("ABS_RX", STICK),
        ("ABS_RY", STICK),
        ("ABS_Z", TRIGGER),
        ("ABS_RZ", TRIGGER),
        ("ABS_HAT0X", STICK),
    ];
    let axes = axes.map(|(name, range)| (kernel_code(name).unwrap(), range));
    let mut state = PadState::of(&PadFacts {
        name: "Test pad".into(),
        path: "/dev/input/event7".into(),
        vendor: 0x45e,
        product: 0x28e,
        axes: axes.into(),
        face: FaceOrder::ByPlace,
    });
    for (name, value) in events {
        state.apply(KernelEvent::named(name, *value).unwrap());
    }
    state
}

fn busy() -> PadState {
    state(&[
        ("BTN_TL", 1),
        ("BTN_SOUTH", 1),
        ("ABS_RZ", 62),
        ("ABS_Z", 30),
        ("ABS_X", -900),
        ("ABS_Y", 100),
        ("ABS_RX", 700),
        ("ABS_RY", -300),
        ("ABS_HAT0X", 1000),
        ("BTN_START", 1),
    ])
}

fn poses() -> Vec<PoseName> {
    let name = |name: &str, shown: &str| PoseName {
        name: name.into(),
        shown: shown.into(),
    };
    vec![
        name("Pinch", "两指捏"),
        name("Open", "张开"),
        name("Point", "指向"),
    ]
}

fn in_english(name: &str) -> PoseName {
    PoseName {
        name: name.into(),
        shown: name.into(),
    }
}

fn look(theme: Theme, language: Language) -> Look {
    Look {
        palette: Palette::of(theme),
        language,
        side: Side::Right,
    }
}

struct PadDisplay {
    state: Option<PadState>,
    map: PadMap,
    chosen: Option<PadControl>,
    fingers: FingerChoice,
    poses: Vec<PoseName>,
}

impl PadDisplay {
    fn with(state: Option<PadState>) -> Self {
        Self {
            state,
            map: PadMap::usual(),
            chosen: None,
            fingers: FingerChoice::One(Dof::Index),
            poses: ["Pinch", "Open", "Point"].map(in_english).into(),
        }
    }

    fn pad(&self) -> PadShown<'_> {
        PadShown {
            state: self.state.as_ref(),
            map: &self.map,
            chosen: self.chosen,
            fingers: self.fingers,
            poses: &self.poses,
        }
    }
}

fn both_ui(ui: &mut Ui, look: Look, shown: &mut PadDisplay) {
    let (mut chosen, mut changed) = (None, None);
    card_ui(ui, look, |ui| {
        chosen = pad_picture_ui(ui, look, &shown.pad())
    });
    card_ui(ui, look, |ui| {
        changed = pad_table_ui(ui, look, &shown.pad())
    });
    shown.chosen = chosen.or(shown.chosen);
    if let Some(map) = changed {
        shown.map = map;
    }
}

fn harness(shown: PadDisplay) -> Harness<'static, PadDisplay> {
    let look = look(Theme::Dark, Language::En);
    let mut installed = false;
    let frame = move |ui: &mut Ui, shown: &mut PadDisplay| {
        if !std::mem::replace(&mut installed, true) {
            // Fonts hold from the second frame on.
            return window::install(ui.ctx(), Theme::Dark, Language::En);
        }
        both_ui(ui, look, shown);
    };
    let mut harness = Harness::builder()
        .with_size(vec2(1000.0, 1100.0))
        .build_ui_state(frame, shown);
    harness.run_steps(3);
    harness
}

#[test]
fn a_control_is_chosen_by_its_picture_and_by_its_row() {
    let mut harness = harness(PadDisplay::with(Some(state(&[]))));
    for (name, control) in [
        ("Right trigger: Close fingers", PadControl::RightTrigger),
        ("Left stick: Choose fingers", PadControl::LeftStick),
        ("B (right): STOP", PadControl::East),
        ("Left bumper: Hold to run", PadControl::LeftBumper),
        ("A (bottom): Pose Pinch", PadControl::South),
    ] {
        for which in 0..2 {
            harness.state_mut().chosen = None;
            let nodes: Vec<_> = harness.get_all_by_label(name).collect();
            assert_eq!(nodes.len(), 2, "{name}: in the picture and beside it");
            nodes[which].click();
            harness.run_steps(2);
            assert_eq!(harness.state().chosen, Some(control), "{name}");
        }
    }
    // What does nothing is in the picture only.
    harness.get_by_label("Home: Nothing").click();
    harness.run_steps(2);
    assert_eq!(harness.state().chosen, Some(PadControl::Home));
}

#[test]
fn a_pose_that_is_not_in_the_library_is_told_and_stays_the_choice() {
    let mut shown = PadDisplay::with(None);
    shown.poses.retain(|pose| pose.name != "Pinch");
    let harness = harness(shown);
    let gone = "A (bottom): Pose Pinch (not in the library)";
    assert_eq!(harness.get_all_by_label(gone).count(), 2);
    assert_eq!(harness.get_all_by_label("X (left): Pose Point").count(), 2);
    let map = &harness.state().map;
    let pinch = PadAction::Pose("Pinch".into());
    assert_eq!(*map.action(PadControl::South), pinch);
}

#[test]
fn everything_in_the_picture_can_be_hit_and_nothing_lies_on_another() {
    let harness = harness(PadDisplay::with(Some(busy())));
    let all = PadControl::ALL.map(|control| {
        let shown = harness.state().pad();
        let does = shown.does(look(Theme::Dark, Language::En), shown.map.action(control));
        let name = crate::ui::text::inputs::control(control).en;
        let name = format!("{name}: {does}");
        let nodes = harness.get_all_by_label(&name);
        let rects: Vec<_> = nodes.map(|node| node.rect()).collect();
        (name, rects)
    });
    let all: Vec<_> = all
        .iter()
        .flat_map(|(name, rects)| rects.iter().map(move |rect| (name, rect)))
        .collect();
    for (at, (name, rect)) in all.iter().enumerate() {
        assert!(rect.width() > 12.0 && rect.height() > 12.0, "{name} {rect}");
        for (other, place) in &all[..at] {
            assert!(!rect.shrink(0.5).intersects(**place), "{name} on {other}");
        }
    }
}

#[test]
fn an_action_is_changed_in_the_list_and_stop_only_changes_its_place() {
    let mut harness = harness(PadDisplay::with(Some(state(&[]))));
    let press = |harness: &mut Harness<'static, PadDisplay>, name: &str, choice: &str| {
        harness
            .get_by_role_and_label(egui::accesskit::Role::ComboBox, name)
            .click();
        harness.run_steps(3);
        let found: Vec<_> = harness.get_all_by_label(choice).collect();
        found.last().unwrap().click();
        harness.run_steps(3);
    };
    press(&mut harness, "Start", "STOP");
    let map = &harness.state().map;
    assert_eq!(*map.action(PadControl::Start), PadAction::Stop);
    assert_eq!(*map.action(PadControl::East), PadAction::Nothing);
    let stop = harness.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Start");
    assert!(
        stop.accesskit_node().is_disabled(),
        "it can only be given away"
    );
    press(&mut harness, "Right trigger", "Bend thumb");
    let map = &harness.state().map;
    assert_eq!(*map.action(PadControl::RightTrigger), PadAction::BendThumb);
}

#[test]
fn the_picture_is_drawn_where_somebody_wants_to_see_it() {
    let Some(folder) = std::env::var_os("HANDSCOPE_PICTURES") else {
        return;
    };
    for (what, state) in [
        ("busy", Some(busy())),
        ("rest", Some(state(&[]))),
        ("none", None),
    ] {
        for (language, theme) in [(Language::En, Theme::Dark), (Language::Zh, Theme::Light)] {
            let mut shown = PadDisplay::with(state.clone());
            if language == Language::Zh {
                shown.poses = poses();
                shown.chosen = Some(PadControl::RightStick);
                shown.fingers = FingerChoice::All;
            }
            let look = look(theme, language);
            let mut canvas = Canvas::new((1000, 1100), 1.0);
            let mut draw = |ui: &mut Ui| {
                window::install(ui.ctx(), theme, language);
                both_ui(ui, look, &mut shown);
            };
            canvas.frame(0.0, &mut draw);
            canvas.hold_still();
            let picture = canvas.picture(0.0, &mut draw);
            let path = Path::new(&folder).join(format!("pad-{what}-{language:?}.png"));
            png::save(&path, &picture.rgb, picture.size).unwrap();
        }
    }
}
