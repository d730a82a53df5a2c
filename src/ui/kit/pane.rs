//! Context of every part of the window: the state, the appearance, and the list of actions.

use crate::app::action::Action;
use crate::app::effect::ActionEffect;
use crate::app::hand::Hand;
use crate::app::layout::{Breakpoint, Layout, RoomLayouts};
use crate::app::readings::Freshness;
use crate::app::state::State;
use crate::hand::{Dof, Finger, Moment, PerDof, Timed};
use crate::record::ArmRefusal;
use crate::ui::style::Look;
use crate::ui::text::{inputs, main};
use crate::ui::view::{Tab, View};
use egui::{Id, Key, Ui};

/// Context for one pass over one part of the window.
pub(crate) struct Pane<'a> {
    /// State to show.
    pub(crate) state: &'a State,
    pub(crate) look: Look,
    /// Actions requested by the user, in order.
    pub(crate) actions: &'a mut Vec<Action>,
    /// Field with the keyboard, or with refused text.
    pub(crate) typing: &'a mut Typing,
    /// View to open after this frame.
    pub(crate) opens: &'a mut Option<ViewRequest>,
}

/// A view or overlay that the user opens from another part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ViewRequest {
    View(View),
    /// A tab, at the view that was open there last.
    Tab(Tab),
    /// Toggles between faults and messages and the view open before them.
    Faults,
    /// State and faults of one drive.
    Drive(Dof),
    /// A note at the current moment.
    Note,
    /// Toggles the list of keys.
    Keys,
    /// Toggles the command palette.
    Palette,
}

impl<'a> Pane<'a> {
    /// Hand that is shown.
    pub(crate) fn hand(&self) -> &'a Hand {
        self.state.hand()
    }

    /// Opens a view after the frame.
    pub(crate) const fn open(&mut self, opens: ViewRequest) {
        *self.opens = Some(opens);
    }

    /// Panel layouts for the current window size.
    pub(crate) fn layouts(&self, ui: &Ui) -> RoomLayouts {
        self.state.settings.layout.at(breakpoint(ui))
    }

    /// Requests these panel layouts for windows of the current size.
    pub(crate) fn lay_out(&mut self, ui: &Ui, layouts: RoomLayouts) {
        self.actions.push(Action::Layout(self.layout(ui, layouts)));
    }

    /// Returns the whole layout with these panel layouts for the current window size.
    pub(crate) fn layout(&self, ui: &Ui, layouts: RoomLayouts) -> Layout {
        self.state.settings.layout.with(breakpoint(ui), layouts)
    }

    /// Reason why no motion can be requested now; `None` if motion is possible.
    pub(crate) fn unready(&self) -> Option<&'static str> {
        if let Some(recorded) = self.recorded() {
            return Some(recorded);
        }
        let hand = self.hand();
        if hand.runs_series() {
            return Some(self.look.tr(main::SERIES_RUNS));
        }
        if hand.connection.outside_owner().is_some() {
            return Some(self.look.tr(inputs::TAKEN));
        }
        let advice = match hand.arm_refusal(self.state.now) {
            Some(ArmRefusal::LetGo) => main::REFUSED_LET_GO,
            _ => main::NOT_ARMED,
        };
        (!hand.connection.is_armed()).then(|| self.look.tr(advice))
    }

    /// Reason why nothing can be requested of a hand: a recording is shown. `None` otherwise.
    pub(crate) fn recorded(&self) -> Option<&'static str> {
        let is_recorded = self.state.timeline.is_some();
        is_recorded.then(|| self.look.tr(main::RECORDED))
    }

    /// Freshness of a reading requested at `asked`.
    pub(crate) fn freshness(&self, asked: Option<Moment>) -> Freshness {
        let hand = self.hand();
        hand.readings
            .freshness(asked, hand.connection.is_live(), self.state.now)
    }

    /// Freshness of a fingertip's reading.
    pub(crate) fn tip_freshness(&self, finger: Finger) -> Freshness {
        let hand = self.hand();
        hand.readings
            .tip_freshness(finger, hand.connection.is_live(), self.state.now)
    }

    /// Newest value of one joint, with its freshness.
    pub(crate) fn newest<T: Copy>(
        &self,
        dof: Dof,
        group: Option<Timed<PerDof<T>>>,
    ) -> (Option<T>, Freshness) {
        let freshness = self.freshness(group.map(|group| group.asked));
        (group.map(|group| group.value[dof]), freshness)
    }
}

fn breakpoint(ui: &Ui) -> Breakpoint {
    Breakpoint::of(ui.ctx().content_rect().width())
}

/// The field being edited, or whose text was refused.
#[derive(Debug, Default)]
pub(crate) struct Typing {
    /// Id of the field, and the text typed so far.
    pub(crate) field: Option<(Id, String)>,
    /// Reason why the text was refused.
    pub(crate) refused: Option<String>,
}

impl Typing {
    /// True if Enter or Esc discards a refused text in this frame.
    pub(crate) fn is_discarded(&self, ui: &Ui) -> bool {
        let keys = [Key::Enter, Key::Escape];
        self.refused.is_some() && ui.input(|input| keys.iter().any(|key| input.key_pressed(*key)))
    }

    /// Discards refused text that would hide the value in force, once an action stops, moves, adjusts or connects a hand.
    pub(crate) fn after(&mut self, actions: &[Action]) {
        let covers = |action: &Action| {
            matches!(
                action.effect(),
                ActionEffect::StopAll
                    | ActionEffect::Stop
                    | ActionEffect::Motion
                    | ActionEffect::Adjustment
                    | ActionEffect::Connection
            )
        };
        if self.refused.is_some() && actions.iter().any(covers) {
            *self = Self::default();
        }
    }
}
