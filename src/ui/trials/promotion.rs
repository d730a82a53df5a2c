//! Saves tried settings as the values after power-up: the button, the reason for a refusal, and the outcome. Writes nothing: a
//! card asks first.

use crate::app::action::Action;
use crate::app::params::{ParamAction, ParamRefusal};
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::trials::TrialSetting;
use crate::ui::kit::{self, Button, Pane};
use crate::ui::params::flash;
use crate::ui::text::{Text, device};
use egui::Ui;

/// Settings of joints that can be made the default.
pub(crate) struct Promotion<'a> {
    values: Params,
    /// Reason why they cannot be saved now.
    refusal: Option<&'a str>,
    /// The refusal is temporary: shown in the tooltip only.
    passes: bool,
}

impl<'a> Promotion<'a> {
    /// Promotes these settings; `none` is the reason why there are none.
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
        // A hand just used for a trial is soon known to be at rest.
        let passes = refusal == Some(ParamRefusal::Moving);
        let refusal = refusal.map(|why| pane.look.tr(device::refusal(why)));
        Self {
            values,
            refusal: pane.recorded().or(none).or(refusal),
            passes,
        }
    }

    /// Draws the button, which asks for confirmation with the card of a save.
    pub(crate) fn button_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, text: Text) {
        let button = Button::text(pane.look, text);
        if button.disabled(self.refusal).ui(ui, pane.look).clicked() {
            let save = ParamAction::SaveWith(self.values.clone());
            pane.actions.push(Action::Param(save));
        }
    }

    /// Draws whether the settings are saved, or the reason why they cannot be.
    pub(crate) fn end_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let palette = pane.look.palette;
        let book = &pane.hand().params;
        let is_held =
            !self.values.is_empty() && book.live_params().with(&self.values) == book.live_params();
        if let Some(writing) = flash::writing(pane) {
            kit::small_text_ui(ui, writing, palette.accent);
        } else if let Some((words, color)) = flash::save_end(pane).filter(|_| is_held) {
            kit::small_text_ui(ui, &words, color);
        } else if let Some(refusal) = self
            .refusal
            .filter(|_| !self.passes && !self.values.is_empty())
        {
            kit::small_text_ui(ui, refusal, palette.muted);
        }
    }
}

/// Values after power-up that correspond to this setting.
fn defaults(dof: Dof, setting: TrialSetting) -> [(ParamId, Value); 2] {
    let speed = Value::Number(setting.speed.get().into());
    let force = Value::Number(setting.force.get().into());
    [
        (ParamId::DefaultSpeed(dof), speed),
        (ParamId::DefaultForce(dof), force),
    ]
}
