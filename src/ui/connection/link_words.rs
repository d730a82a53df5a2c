//! State of the link as a word and a colour.

use crate::app::hand::Hand;
use crate::link::Dialling;
use crate::record::LinkState;
use crate::ui::kit::{Look, Pane};
use crate::ui::text::{Text, main};
use egui::Color32;

/// Every word for a state of the link.
pub(crate) fn all() -> [Text; 8] {
    let state = main::link_state;
    [
        main::STATE_LOST,
        main::STATE_CONNECTING,
        state(LinkState::Offline),
        state(LinkState::Identifying),
        state(LinkState::Monitoring),
        state(LinkState::Armed),
        state(LinkState::Holding),
        state(LinkState::Fault),
    ]
}

/// Word and colour of the shown hand's link state.
pub(crate) fn link_words(pane: &Pane<'_>) -> (Text, Color32) {
    link_words_of(pane.look, pane.hand())
}

/// Same as [`link_words`], for any hand.
pub(crate) fn link_words_of(look: Look, hand: &Hand) -> (Text, Color32) {
    let (palette, link) = (look.palette, &hand.connection.status);
    match link.state {
        // A hand that never answered counts as not yet reached; only one that answered can be lost.
        LinkState::Offline if link.trouble.is_some() && hand.readings.sample.angle.is_some() => {
            (main::STATE_LOST, palette.bad)
        }
        LinkState::Offline if link.dialling != Dialling::Idle => {
            (main::STATE_CONNECTING, palette.warn)
        }
        state => (main::link_state(state), state_color(look, state)),
    }
}

/// Colour of a link state.
pub(crate) const fn state_color(look: Look, state: LinkState) -> Color32 {
    let palette = look.palette;
    match state {
        LinkState::Offline => palette.faint,
        LinkState::Identifying | LinkState::Holding => palette.warn,
        LinkState::Monitoring => palette.ok,
        LinkState::Armed => palette.armed,
        LinkState::Fault => palette.bad,
    }
}
