//! The program and its window as one thing: drain, draw, act. The real window, the headless one and the tests
//! drive the same. Opens no window itself.
#[cfg(feature = "desktop")]
pub mod desktop;
pub mod headless;
pub(crate) mod interrupt;

use crate::app::action::Action;
use crate::app::files::export::Export;
use crate::app::hands::{Hand, Mover};
use crate::app::program::App;
use crate::app::state::State;
use crate::hand::Moment;
use crate::record::Rest;
use crate::ui::{View, Window};
use std::time::Duration;

/// News come faster than a display shows them: one frame serves all that come within this time.
const FRAME_INTERVAL: Duration = Duration::from_millis(16);
/// The same while no hand moves: only curves go on then, a pixel or two.
pub const REST_FRAME_INTERVAL: Duration = Duration::from_millis(100);
/// The same where the processor draws each pixel.
pub const SOFTWARE_REST_FRAME_INTERVAL: Duration = Duration::from_millis(180);

/// Draws what `ui` draws at a time in seconds, in a size in points, into the bytes of a PNG file; `None` if it cannot.
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

    /// With something that makes pictures of parts of the window.
    #[must_use]
    pub fn with_snap(self, snap: Snap) -> Self {
        Self {
            snap: Some(snap),
            ..self
        }
    }

    /// Takes in what happened since the last call. Runs also while the window is hidden.
    pub fn logic(&mut self, now: Moment) {
        self.app.logic(now);
    }

    /// Draws one frame and carries out what the user asked for in it.
    pub fn ui(&mut self, ui: &mut egui::Ui, now: Moment) {
        if self.window.view() == View::Traffic {
            self.app.read_traffic(now);
        }
        match self.window.view() {
            View::Device => self.app.look_at_params(now),
            View::Checkup => self.app.look_at_checkups(),
            // What was tried may be made the default, which is compared with what the hand keeps.
            View::Tune | View::Compare if self.app.may_keep_tried() => {
                self.app.look_at_params(now);
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

    /// Draws the plots once more, by themselves, and asks where the picture should go.
    fn save_picture(&mut self, size: (u32, u32), now: Moment) {
        let (window, state) = (&mut self.window, self.app.state());
        let mut draw = |ui: &mut egui::Ui| window.plots_alone_ui(ui, state);
        let drawn = self.snap.and_then(|snap| snap(size, now.secs(), &mut draw));
        if let Some(bytes) = drawn {
            self.app.act(Action::Save(Export::Picture(bytes)), now);
        }
    }

    /// How soon news of the hands are to be drawn; `at_rest` is for hands of which none moves.
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

    /// Shows another view.
    pub fn show(&mut self, view: View) {
        self.window.set_view(view);
    }

    /// Shows all hands side by side.
    pub fn show_all_hands(&mut self) {
        self.window.show_all_hands();
    }

    /// Lets the plots show just the time from one moment to another.
    pub fn show_stretch(&mut self, (from, to): (Moment, Moment)) {
        self.window.show_stretch((from.secs(), to.secs()));
    }

    /// The view that is shown.
    pub const fn view(&self) -> View {
        self.window.view()
    }

    /// Everything the window shows.
    pub fn state(&self) -> &State {
        self.app.state()
    }

    /// The program, to open hands and to carry out actions that come from elsewhere.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }
}
