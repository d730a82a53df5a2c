//! The button that replays what is listed elsewhere: a fault, a recording around one, a trial.

use crate::app::sessions::{SessionAction, replay_of};
use crate::hand::Moment;
use crate::ui::kit::{Button, Pane, Weight};
use crate::ui::text::sessions;
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
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &Pane<'_>) -> Option<SessionAction> {
        let look = pane.look;
        let replay = self.stretch.and_then(|stretch| {
            let (sessions, line) = (&pane.state.sessions, pane.state.timeline.as_ref());
            replay_of(sessions, line, self.hand, stretch)
        });
        let name = look.pair(look.say(sessions::REPLAY_STRETCH), self.title);
        let button = Button::said(look, sessions::REPLAY_STRETCH).named(&name);
        let button = button.icon(theme::PLAY).weight(Weight::Quiet);
        let button = button.disabled_if(replay.is_none(), look.say(sessions::REPLAY_NONE));
        let is_pressed = button.ui(ui, look).clicked();
        replay.filter(|_| is_pressed)
    }
}
