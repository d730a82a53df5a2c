//! The window against a hand-made state, without a program behind it.

use egui::{Vec2, vec2};
use egui_kittest::{Harness, HarnessBuilder};
use handscope::app::action::Action;
use handscope::app::settings::Language;
use handscope::app::state::State;
use handscope::history::MarkKind;
use handscope::ui::{View, Window};

pub(crate) const LARGE: Vec2 = vec2(1440.0, 900.0);
pub(crate) const SMALL: Vec2 = vec2(1024.0, 640.0);

/// The window, what it shows and what it asked for.
pub(crate) struct Shown {
    pub(crate) window: Window,
    pub(crate) state: State,
    pub(crate) actions: Vec<Action>,
}

impl Shown {
    fn frame(&mut self, ui: &mut egui::Ui) {
        let asked = self.window.ui(ui, &self.state);
        for action in &asked {
            carry_out(&mut self.state, action);
        }
        self.actions.extend(asked);
    }
}

/// Does what the program does with what concerns the plots.
fn carry_out(state: &mut State, action: &Action) {
    match action {
        Action::Note(at, words) => state
            .hand_mut()
            .measured
            .history
            .mark(*at, MarkKind::note(words).unwrap()),
        Action::PlotWindow(window) => state.settings.plot_window = *window,
        Action::GrowPlot(kind) => state.settings.tall_plots.grow(*kind),
        Action::ShowPlot(kind, on) => state.settings.plots.set(*kind, *on),
        _ => {}
    }
}

/// The window with this view open, drawn until it holds still.
pub(crate) fn open(
    state: State,
    view: View,
    display: HarnessBuilder<Shown>,
) -> Harness<'static, Shown> {
    let mut window = Window::new();
    window.set_view(view);
    let language = state.settings.language;
    let mut shown = Shown {
        window,
        state,
        actions: Vec::new(),
    };
    // Fonts hold from the second frame on.
    shown.state.settings.language = Language::En;
    let mut harness = display.build_ui_state(|ui, shown: &mut Shown| shown.frame(ui), shown);
    harness.state_mut().state.settings.language = language;
    harness.run_steps(3);
    harness.state_mut().actions.clear();
    harness
}

/// A display of this size, in points.
pub(crate) fn display(size: Vec2) -> HarnessBuilder<Shown> {
    Harness::builder().with_size(size)
}
