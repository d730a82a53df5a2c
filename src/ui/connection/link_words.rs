//! Where the link stands, in a word and a colour.

use crate::app::hands::Hand;
use crate::link::Dialling;
use crate::record::LinkState;
use crate::ui::kit::{Look, Pane};
use crate::ui::text::{Text, main};
use egui::Color32;

/// The word and the colour for where the link of the shown hand stands.
pub(crate) fn link_words(pane: &Pane<'_>) -> (Text, Color32) {
    link_words_of(pane.look, pane.hand())
}

/// The same of any hand.
pub(crate) fn link_words_of(look: Look, hand: &Hand) -> (Text, Color32) {
    let (palette, link) = (look.palette, &hand.connection.status);
    match link.state {
        // A hand that never answered is not reached yet; only one that did can be lost.
        LinkState::Offline if link.trouble.is_some() && hand.readings.sample.angle.is_some() => {
            (main::STATE_LOST, palette.bad)
        }
        LinkState::Offline if link.dialling != Dialling::Idle => {
            (main::STATE_CONNECTING, palette.warn)
        }
        state => (main::link_state(state), state_color(look, state)),
    }
}

/// The colour for where a link stands.
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
