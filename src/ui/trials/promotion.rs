//! Settings that were tried, made the values after power-up: the button, what forbids it, and what became of it. Writes nothing: a
//! card asks first.

use crate::app::action::Action;
use crate::app::params::{ParamAction, ParamRefusal};
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::trials::TrialSetting;
use crate::ui::kit::{self, Button, Pane, Weight};
use crate::ui::params::flash;
use crate::ui::text::{Text, device};
use egui::Ui;

/// Settings of joints that can be made the default.
pub(crate) struct Promotion<'a> {
    values: Params,
    /// Why they cannot now.
    refusal: Option<&'a str>,
    /// It will pass by itself: only who asks is told.
    passes: bool,
}

impl<'a> Promotion<'a> {
    /// Of these settings; `none` is why there are none.
    pub(crate) fn of(
        pane: &Pane<'a>,
        settings: impl Iterator<Item = (Dof, TrialSetting)>,
        none: Option<&'a str>,
    ) -> Self {
        let mut values = Params::default();
        for (id, value) in settings.flat_map(|(dof, setting)| defaults(dof, setting)) {
            values.put(id, value);
        }
        let hand = pane.hand();
        let refusal = hand
            .params
            .save_refusal_with(&values, &hand.connection.status);
        // A hand that was just tried is soon seen to rest.
        let passes = refusal == Some(ParamRefusal::Moving);
        let refusal = refusal.map(|why| pane.look.say(device::refusal(why)));
        Self {
            values,
            refusal: pane.recorded().or(none).or(refusal),
            passes,
        }
    }

    /// The button: asks by the card of a save.
    pub(crate) fn button_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, text: Text) {
        let button = Button::said(pane.look, text).weight(Weight::Strong);
        if button.disabled(self.refusal).ui(ui, pane.look).clicked() {
            let save = ParamAction::SaveWith(self.values.clone());
            pane.actions.push(Action::Param(save));
        }
    }

    /// Whether they are kept, and why they cannot be.
    pub(crate) fn end_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let palette = pane.look.palette;
        let book = &pane.hand().params;
        let is_held =
            !self.values.is_empty() && book.live_params().with(&self.values) == book.live_params();
        if let Some(writing) = flash::writing(pane) {
            kit::say_ui(ui, writing, palette.accent);
        } else if let Some((words, color)) = flash::save_end(pane).filter(|_| is_held) {
            kit::say_ui(ui, &words, color);
        } else if let Some(refusal) = self
            .refusal
            .filter(|_| !self.passes && !self.values.is_empty())
        {
            kit::say_ui(ui, refusal, palette.muted);
        }
    }
}

/// The values after power-up that this setting stands for.
fn defaults(dof: Dof, setting: TrialSetting) -> [(ParamId, Value); 2] {
    let speed = Value::Number(setting.speed.get().into());
    let force = Value::Number(setting.force.get().into());
    [
        (ParamId::DefaultSpeed(dof), speed),
        (ParamId::DefaultForce(dof), force),
    ]
}
