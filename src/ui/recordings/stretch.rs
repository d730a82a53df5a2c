//! The button that replays an entry of another list: a fault, a recording around one, a trial.

use crate::app::recordings::{RecordingAction, replay_of};
use crate::hand::Moment;
use crate::ui::kit::{Button, Pane, Weight};
use crate::ui::text::recordings;
use crate::ui::theme;
use egui::Ui;

/// Time range to replay.
pub(crate) struct ReplayedStretch<'a> {
    /// Title, for the button's accessible name.
    pub(crate) title: &'a str,
    /// The hand, as an endpoint.
    pub(crate) hand: &'a str,
    pub(crate) stretch: Option<(Moment, Moment)>,
}

impl ReplayedStretch<'_> {
    /// Draws the button. Returns its action on a click.
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &Pane<'_>) -> Option<RecordingAction> {
        let look = pane.look;
        let replay = self.stretch.and_then(|stretch| {
            let (recordings, line) = (&pane.state.recordings, pane.state.timeline.as_ref());
            replay_of(recordings, line, self.hand, stretch)
        });
        let name = look.pair(look.tr(recordings::REPLAY_STRETCH), self.title);
        let button = Button::text(look, recordings::REPLAY_STRETCH).named(&name);
        let button = button.icon(theme::PLAY).weight(Weight::Quiet);
        let button = button.disabled_if(replay.is_none(), look.tr(recordings::REPLAY_NONE));
        let is_pressed = button.ui(ui, look).clicked();
        replay.filter(|_| is_pressed)
    }
}
