//! The program and its window as one thing: drain, draw, act. The real window, the headless one and the tests
//! drive the same. Opens no window itself.

use crate::app::{App, State};
use crate::hand::Moment;
use crate::ui::{View, Window};

/// The program behind its window.
pub struct Cockpit {
    app: App,
    window: Window,
}

impl Cockpit {
    /// Puts a window in front of a program.
    #[must_use]
    pub fn new(app: App) -> Self {
        Self {
            app,
            window: Window::new(),
        }
    }

    /// Takes in what happened since the last call. Runs also while the window is hidden.
    pub fn logic(&mut self, now: Moment) {
        self.app.logic(now);
    }

    /// Draws one frame and carries out what the person asked for in it.
    pub fn ui(&mut self, ui: &mut egui::Ui, now: Moment) {
        if self.window.view() == View::Traffic {
            self.app.read_traffic(now);
        }
        for action in self.window.ui(ui, self.app.state()) {
            self.app.act(action, now);
        }
    }

    /// Shows another view.
    pub fn show(&mut self, view: View) {
        self.window.set_view(view);
    }

    /// Everything the window shows.
    #[must_use]
    pub fn state(&self) -> &State {
        self.app.state()
    }

    /// The program, to open hands and to carry out actions that come from elsewhere.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }
}
