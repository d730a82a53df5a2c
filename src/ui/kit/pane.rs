//! What every part of the window is given: the state, how it looks, and where to put actions.

use crate::app::action::Action;
use crate::app::effect::Effect;
use crate::app::hands::Hand;
use crate::app::layout::{Breakpoint, Layout, RoomLayouts};
use crate::app::readings::Freshness;
use crate::app::state::State;
use crate::hand::{Dof, Finger, Moment, PerDof, Timed};
use crate::record::ArmRefusal;
use crate::ui::style::Look;
use crate::ui::text::{inputs, main};
use crate::ui::view::{Place, View};
use egui::{Id, Key, Ui};

/// One pass over one part of the window.
pub(crate) struct Pane<'a> {
    /// What is shown.
    pub(crate) state: &'a State,
    pub(crate) look: Look,
    /// What the user asked for.
    pub(crate) actions: &'a mut Vec<Action>,
    /// The field being typed into.
    pub(crate) typing: &'a mut Typing,
    /// What is to be opened after this frame.
    pub(crate) opens: &'a mut Option<ViewRequest>,
}

/// What the user opens from another part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ViewRequest {
    View(View),
    /// A place, with the view that was open there last.
    Place(Place),
    /// Faults and messages, or what was open before them.
    Faults,
    /// What a drive says, with its faults.
    Drive(Dof),
    /// A note of this moment.
    Note,
    /// The list of keys, or away with it.
    Keys,
    /// The command palette, or away with it.
    Palette,
}

impl<'a> Pane<'a> {
    /// The hand that is shown.
    pub(crate) fn hand(&self) -> &'a Hand {
        self.state.hand()
    }

    /// Opens this after the frame.
    pub(crate) const fn open(&mut self, opens: ViewRequest) {
        *self.opens = Some(opens);
    }

    /// How a window as large as this one is divided.
    pub(crate) fn layouts(&self, ui: &Ui) -> RoomLayouts {
        self.state.settings.layout.at(breakpoint(ui))
    }

    /// Divides windows as large as this one so.
    pub(crate) fn lay_out(&mut self, ui: &Ui, layouts: RoomLayouts) {
        self.actions.push(Action::Layout(self.layout(ui, layouts)));
    }

    /// The whole layout with windows as large as this one divided so.
    pub(crate) fn layout(&self, ui: &Ui, layouts: RoomLayouts) -> Layout {
        self.state.settings.layout.with(breakpoint(ui), layouts)
    }

    /// Why nothing that moves the hand can be asked for now.
    pub(crate) fn unready(&self) -> Option<&'static str> {
        if let Some(recorded) = self.recorded() {
            return Some(recorded);
        }
        let hand = self.hand();
        if hand.runs_series() {
            return Some(self.look.say(main::SERIES_RUNS));
        }
        if hand.connection.outside_owner().is_some() {
            return Some(self.look.say(inputs::TAKEN));
        }
        let advice = match hand.arm_refusal(self.state.now) {
            Some(ArmRefusal::LetGo) => main::REFUSED_LET_GO,
            _ => main::NOT_ARMED,
        };
        (!hand.connection.is_armed()).then(|| self.look.say(advice))
    }

    /// Why nothing at all can be asked of a hand now: a recording is shown.
    pub(crate) fn recorded(&self) -> Option<&'static str> {
        let is_recorded = self.state.timeline.is_some();
        is_recorded.then(|| self.look.say(main::RECORDED))
    }

    /// How fresh something asked for at `asked` is.
    pub(crate) fn freshness(&self, asked: Option<Moment>) -> Freshness {
        let hand = self.hand();
        hand.readings
            .freshness(asked, hand.connection.is_live(), self.state.now)
    }

    /// The same for the reading of a fingertip.
    pub(crate) fn tip_freshness(&self, finger: Finger) -> Freshness {
        let hand = self.hand();
        hand.readings
            .tip_freshness(finger, hand.connection.is_live(), self.state.now)
    }

    /// The newest value of one joint, and how fresh it is.
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

/// The one field that is being typed into, or whose text was refused.
#[derive(Debug, Default)]
pub(crate) struct Typing {
    /// Which, and what was typed so far.
    pub(crate) field: Option<(Id, String)>,
    /// Why that was refused.
    pub(crate) refused: Option<String>,
}

impl Typing {
    /// True if a text that was refused before goes now.
    pub(crate) fn is_given_up(&self, ui: &Ui) -> bool {
        let keys = [Key::Enter, Key::Escape];
        self.refused.is_some() && ui.input(|input| keys.iter().any(|key| input.key_pressed(*key)))
    }

    /// Something else was asked of a hand, or another view is open: a text that was refused would hide what is in force.
    pub(crate) fn after(&mut self, actions: &[Action]) {
        let covers = |action: &Action| {
            matches!(
                action.effect(),
                Effect::StopsAll
                    | Effect::Stops
                    | Effect::Moves
                    | Effect::Adjusts
                    | Effect::Connects
            )
        };
        if self.refused.is_some() && actions.iter().any(covers) {
            *self = Self::default();
        }
    }
}
