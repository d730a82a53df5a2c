//! The button that starts a series: a click while armed; while disarmed, hold it for a second, which arms the hand as well.
//! A stop, or anything that forbids the start, cancels the hold.

use crate::app::action::Action;
use crate::app::trials::StartRefusal;
use crate::hand::Moment;
use crate::ui::kit::controls::{Button, Weight, small_text_ui, wide_ui};
use crate::ui::kit::pane::Pane;
use crate::ui::text::{Text, main, tune, words};
use crate::ui::theme;
use egui::{CornerRadius, Event, Key, Response, Ui};
use std::time::Duration;

/// Required hold time: longer than any click.
const HOLD_DURATION: Duration = Duration::from_secs(1);

/// State of the hold between frames.
#[derive(Debug, Default)]
pub(crate) struct StartButton {
    since: Option<Moment>,
    /// Released too early.
    is_short: bool,
}

/// Labels and actions of the start button.
#[derive(Debug, Clone)]
pub(crate) struct StartWish {
    /// Reason why the series cannot start.
    pub(crate) refused: Option<String>,
    /// Start within the arming in force.
    pub(crate) start: (Text, Action),
    /// Start with an arming of its own.
    pub(crate) arm_and_start: (Text, Action),
}

impl StartButton {
    /// Draws the button and a line of text below it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, wish: StartWish) {
        let (look, palette) = (pane.look, pane.look.palette);
        let is_armed = pane.hand().connection.is_armed();
        let reason = wish.refused;
        let (text, action) = if is_armed {
            wish.start
        } else {
            wish.arm_and_start
        };
        let button = Button::text(look, text).large().weight(Weight::Strong);
        // Its tooltip would cover what the plan says above it, which has to be seen while the button is held.
        let tip = if self.since.is_some() {
            ""
        } else {
            look.tip(text)
        };
        let button = button.tip(tip).disabled(reason.as_deref());
        let response = wide_ui(ui, |ui| {
            ui.set_max_height(theme::CONTROL_LARGE);
            button.ui(ui, look)
        });
        if is_armed {
            *self = Self::default();
            if response.clicked() {
                pane.actions.push(action);
            }
        } else if self.is_held(ui, pane, &response) {
            pane.actions.push(action);
        }
        let (words, color) = match (&reason, is_armed) {
            (Some(reason), _) => (reason.as_str(), palette.warn),
            (None, false) if self.is_short => (look.tr(tune::HOLD_LONGER), palette.warn),
            (None, false) => (look.tr(tune::HOLD_TO_START), palette.muted),
            (None, true) => (look.tr(tune::ANY_KEY), palette.muted),
        };
        small_text_ui(ui, words, color);
    }

    /// True once held for [`HOLD_DURATION`], with the pointer or with Enter.
    fn is_held(&mut self, ui: &Ui, pane: &Pane<'_>, response: &Response) -> bool {
        let has_pointer = response.contains_pointer();
        let has_keyboard = response.has_focus();
        // `response.is_pointer_button_down_on()` ends once a press is too long for a click.
        let (begins, is_down) = ui.input(|input| {
            let pointer = &input.pointer;
            // Auto-repeat of a held key does not begin a new hold.
            let is_enter = |event: &Event| {
                matches!(
                    event,
                    Event::Key {
                        key: Key::Enter,
                        pressed: true,
                        repeat: false,
                        ..
                    }
                )
            };
            let begins = has_pointer && pointer.primary_pressed()
                || has_keyboard && input.events.iter().any(is_enter);
            let by_key = has_keyboard && input.key_down(Key::Enter);
            (begins, has_pointer && pointer.primary_down() || by_key)
        });
        let now = pane.state.now;
        let connection = &pane.hand().connection;
        let is_stopped = self
            .since
            .is_some_and(|at| connection.is_disarmed_since(at));
        if is_stopped || !response.sense.senses_click() {
            *self = Self::default();
        } else if is_down && begins {
            (self.since, self.is_short) = (Some(now), false);
        } else if !is_down {
            self.is_short |= self.since.take().is_some() || response.clicked();
        }
        let Some(since) = self.since else {
            return false;
        };
        let held = now.since(since);
        bar(ui, pane, response, held);
        ui.ctx().request_repaint();
        let is_long = held >= HOLD_DURATION;
        if is_long {
            *self = Self::default();
        }
        is_long
    }
}

/// Progress of the hold, along the lower edge.
fn bar(ui: &Ui, pane: &Pane<'_>, response: &Response, held: Duration) {
    let share = held.as_secs_f32() / HOLD_DURATION.as_secs_f32();
    let place = response.rect.shrink(2.0);
    let place = place.with_min_y(place.bottom() - theme::STEP);
    let place = place.with_max_x(egui::lerp(place.x_range(), share.min(1.0)));
    let (round, ink) = (theme::ROUND_TINY, pane.look.palette.on_accent);
    ui.painter()
        .rect_filled(place, CornerRadius::same(round), ink);
}

/// Reason why a series cannot start. `unsound` is the error in the plan, `refusal` the reason why the hand cannot start it.
pub(crate) fn start_refused(
    pane: &Pane<'_>,
    unsound: Option<Text>,
    refusal: Option<StartRefusal>,
) -> Option<String> {
    let (look, state) = (pane.look, pane.state);
    let hand = state.hand();
    if let Some(recorded) = pane.recorded() {
        return Some(recorded.into());
    }
    if !hand.connection.status.state.is_live() {
        return Some(look.tr(main::REFUSED_OFFLINE).into());
    }
    if hand.running.awaits_arming() {
        return Some(look.tr(tune::ARMING).into());
    }
    if state.trials.running.is_some() {
        return Some(look.tr(main::SERIES_RUNS).into());
    }
    if let Some(unsound) = unsound {
        return Some(look.tr(unsound).into());
    }
    match refusal {
        Some(StartRefusal::Runs) => Some(look.tr(main::SERIES_RUNS).into()),
        Some(StartRefusal::Locked(dof)) => {
            Some(look.fill(tune::NEED_FREE, &[&look.tr(words::dof(dof))]))
        }
        Some(StartRefusal::NotArmed) => {
            let refusal = hand.arm_refusal(state.now);
            refusal.map(|reason| words::refusal(look, reason))
        }
        None => None,
    }
}
