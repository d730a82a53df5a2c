//! The button that replays what is listed elsewhere: a fault, a recording around one, a trial.

use crate::app::recordings::{RecordingAction, replay_of};
use crate::hand::Moment;
use crate::ui::kit::{Button, Pane, Weight};
use crate::ui::text::recordings;
use crate::ui::theme;
use egui::Ui;

/// What is to be replayed.
pub(crate) struct ReplayedStretch<'a> {
    /// What it is, for the button's name.
    pub(crate) title: &'a str,
    /// The hand, in the spelling of endpoints.
    pub(crate) hand: &'a str,
    pub(crate) stretch: Option<(Moment, Moment)>,
}

impl ReplayedStretch<'_> {
    /// Draws the button; what it asks for, once it is pressed.
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &Pane<'_>) -> Option<RecordingAction> {
        let look = pane.look;
        let replay = self.stretch.and_then(|stretch| {
            let (recordings, line) = (&pane.state.recordings, pane.state.timeline.as_ref());
            replay_of(recordings, line, self.hand, stretch)
        });
        let name = look.pair(look.say(recordings::REPLAY_STRETCH), self.title);
        let button = Button::said(look, recordings::REPLAY_STRETCH).named(&name);
        let button = button.icon(theme::PLAY).weight(Weight::Quiet);
        let button = button.disabled_if(replay.is_none(), look.say(recordings::REPLAY_NONE));
        let is_pressed = button.ui(ui, look).clicked();
        replay.filter(|_| is_pressed)
    }
}
