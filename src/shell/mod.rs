//! The program and its window as a unit: drain, draw, act. The real window, the headless one and the tests all use it. Opens no
//! window itself.
#[cfg(feature = "desktop")]
pub mod desktop;
pub mod headless;
pub(crate) mod interrupt;

use crate::app::action::Action;
use crate::app::files::export::Export;
use crate::app::hand::Hand;
use crate::app::hand::mover::Mover;
use crate::app::program::App;
use crate::app::state::State;
use crate::hand::Moment;
use crate::record::Rest;
use crate::ui::{View, Window};
use std::time::Duration;

/// Minimum time between frames: updates arrive faster than a display shows them, so one frame serves several.
const FRAME_INTERVAL: Duration = Duration::from_millis(16);
/// Frame interval while no hand moves: only the curves advance, by a pixel or two.
pub const REST_FRAME_INTERVAL: Duration = Duration::from_millis(100);
/// Frame interval at rest with software rendering.
pub const SOFTWARE_REST_FRAME_INTERVAL: Duration = Duration::from_millis(180);

/// Renders `ui` at a time in seconds and a size in points to a PNG file's bytes; `None` if that fails.
pub type Snap =
    fn(size: (u32, u32), at_s: f64, ui: &mut dyn FnMut(&mut egui::Ui)) -> Option<Vec<u8>>;

/// The program behind its window.
pub struct DesktopApp {
    app: App,
    window: Window,
    snap: Option<Snap>,
}

impl DesktopApp {
    /// Puts a window in front of a program.
    pub fn new(app: App) -> Self {
        Self {
            app,
            window: Window::new(),
            snap: None,
        }
    }

    /// Adds a renderer for pictures of parts of the window.
    #[must_use]
    pub fn with_snap(self, snap: Snap) -> Self {
        Self {
            snap: Some(snap),
            ..self
        }
    }

    /// Applies all updates since the last call. Runs also while the window is hidden.
    pub fn logic(&mut self, now: Moment) {
        self.app.logic(now);
    }

    /// Draws one frame and carries out the user's actions.
    pub fn ui(&mut self, ui: &mut egui::Ui, now: Moment) {
        if self.window.view() == View::Traffic {
            self.app.read_traffic(now);
        }
        match self.window.view() {
            View::Device => self.app.read_params_if_due(now),
            View::Checkup => self.app.read_checkups(),
            // Tried settings may become the defaults, which are compared with the hand's stored ones.
            View::Tune | View::Compare if self.app.may_keep_tried() => {
                self.app.read_params_if_due(now);
            }
            _ => {}
        }
        for action in self.window.ui(ui, self.app.state()) {
            match action {
                Action::SavePicture(size) => self.save_picture(size, now),
                action => self.app.act(action, now),
            }
        }
        self.app.drawn(now);
    }

    /// Renders the plots alone, and opens the dialog for the picture's path.
    fn save_picture(&mut self, size: (u32, u32), now: Moment) {
        let (window, state) = (&mut self.window, self.app.state());
        let mut draw = |ui: &mut egui::Ui| window.plots_alone_ui(ui, state);
        let drawn = self.snap.and_then(|snap| snap(size, now.secs(), &mut draw));
        if let Some(bytes) = drawn {
            self.app.act(Action::Save(Export::Picture(bytes)), now);
        }
    }

    /// Maximum delay of a frame after an update; `at_rest` applies while no hand moves.
    pub fn frame_within(&self, at_rest: Duration) -> Duration {
        let state = self.app.state();
        let moves = |hand: &Hand| {
            hand.connection.status.rest == Rest::Moving || Mover::of(hand, state.now).is_some()
        };
        if state.hands.iter().any(moves) {
            FRAME_INTERVAL
        } else {
            at_rest
        }
    }

    pub fn show(&mut self, view: View) {
        self.window.set_view(view);
    }

    /// Shows all hands side by side.
    pub fn show_all_hands(&mut self) {
        self.window.show_all_hands();
    }

    /// Shows exactly this time range in the plots.
    pub fn show_stretch(&mut self, (from, to): (Moment, Moment)) {
        self.window.show_stretch((from.secs(), to.secs()));
    }

    pub const fn view(&self) -> View {
        self.window.view()
    }

    /// Everything the window shows.
    pub fn state(&self) -> &State {
        self.app.state()
    }

    /// The program, to open hands and to carry out external actions.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }
}
