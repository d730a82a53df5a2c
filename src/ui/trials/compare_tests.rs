//! The list of sessions, drawn by itself.

use crate::app::settings::{Language, Theme};
use crate::app::trials::{SessionId, SessionOrigin, TrialsState};
use crate::trials::session::SessionHead;
use crate::ui::kit::Look;
use crate::ui::theme::Palette;
use crate::ui::trials::compare_choice::ShownSessions;
use crate::ui::trials::compare_list;
use crate::ui::trials::compare_list::Sheet;
use crate::ui::window;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

/// A trials of so many sessions that lie in no file.
fn trials(count: usize) -> TrialsState {
    let mut trials = TrialsState::default();
    for _ in 0..count {
        trials.add(SessionHead::default(), SessionOrigin::Unsaved, Vec::new());
    }
    trials
}

/// The list over this trials, with these sessions shown.
fn list(trials: TrialsState, shown: &[u64]) -> Harness<'static, ShownSessions> {
    let mut installed = false;
    let draw = move |ui: &mut egui::Ui, chosen: &mut ShownSessions| {
        if !std::mem::replace(&mut installed, true) {
            window::install(ui.ctx(), Theme::Dark, Language::En);
            return;
        }
        let sheet = Sheet {
            look: Look {
                palette: Palette::of(Theme::Dark),
                language: Language::En,
                side: crate::hand::kinematics::Side::Right,
            },
            trials: &trials,
        };
        compare_list::list_ui(ui, sheet, chosen);
    };
    let mut chosen = ShownSessions::default();
    for id in shown {
        chosen.toggle(SessionId(*id));
    }
    let size = egui::Vec2::splat(600.0);
    Harness::builder()
        .with_size(size)
        .build_ui_state(draw, chosen)
}

#[test]
fn a_session_that_lost_samples_says_what_to_do() {
    let warning = "Memory is full";
    let mut harness = list(trials(1), &[1]);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains(warning).is_none());
    harness.get_by_label_contains("not saved");
    let mut lost = trials(1);
    lost.session_mut(SessionId(1)).unwrap().lost = 7;
    let mut harness = list(lost, &[1]);
    harness.run_steps(3);
    harness.get_by_label_contains(warning);
    harness.get_by_label_contains("7 without samples");
}

#[test]
fn four_are_shown_at_once_and_one_always_stays() {
    let mut harness = list(trials(3), &[3, 2]);
    harness.run_steps(3);
    for name in ["Show Session 3", "Show Session 2"] {
        harness.get_by_label(name).click();
        harness.run_steps(3);
    }
    assert_eq!(harness.state().shown, [SessionId(2)], "the last one stays");
    let mut full = ShownSessions::default();
    for id in 1..=4 {
        full.toggle(SessionId(id));
    }
    let mut harness = list(trials(5), &[1, 2, 3, 4]);
    harness.run_steps(3);
    harness.get_by_label("Show Session 5").click();
    harness.run_steps(3);
    assert_eq!(harness.state().shown, full.shown);
}
