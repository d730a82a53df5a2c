//! The view of the hand's parameters: tools, pending confirmation, and the layout of table, file and flash. Stores the filter
//! only; every change is an action.
pub(crate) mod calibration;
pub(crate) mod card;
pub(crate) mod choices;
pub(crate) mod file;
pub(crate) mod flash;
pub(crate) mod procedures;
pub(crate) mod table;

use crate::app::action::Action;
use crate::app::params::state::ParamAction;
use crate::app::params::state::ParamRefusal;
use crate::ui::kit::{self, Button, Label, Pane, format};
use crate::ui::params::table::ShownRows;
use crate::ui::text::{device, errors};
use crate::ui::theme;
use egui::{Color32, Panel, Ui};

/// View state.
#[derive(Debug, Default)]
pub(crate) struct DeviceView {
    shown: ShownRows,
}

impl DeviceView {
    /// Draws the view: flash beside the table, or below it in a narrow window.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let flash = if ui.available_width() >= 860.0 {
            kit::bare(Panel::right("flash"), 280.0, theme::GAP_LEFT)
        } else {
            kit::bare(Panel::bottom("flash"), 172.0, theme::GAP_TOP)
        };
        flash.show(ui, |ui| flash::flash_ui(ui, pane));
        kit::full_card_ui(ui, pane.look, |ui| {
            if let Some(compared) = &pane.hand().params.compared {
                return file::file_ui(ui, pane, compared);
            }
            ui.horizontal(|ui| self.find_ui(ui, pane));
            ui.horizontal(|ui| tools_ui(ui, pane));
            let (words, color) = status(pane);
            Label::new(&words, color).small().ui(ui);
            table::table_ui(ui, pane, &self.shown);
        });
    }

    /// Draws the filter of the table.
    fn find_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.scope(|ui| {
            ui.set_max_width(200.0);
            kit::translated_edit_ui(ui, look, device::FIND, &mut self.shown.words);
        });
        kit::right_ui(ui, |ui| {
            let hand = pane.hand();
            let refusal = hand.params.read_refusal(&hand.connection.status);
            let refusal = refusal.map(|why| look.tr(device::refusal(why)));
            let read = Button::text(look, device::READ);
            read.disabled(refusal)
                .on_click(ui, pane, Action::Param(ParamAction::Read));
            let only = Button::text(look, device::ONLY).choice(self.shown.only);
            only.toggle(ui, look, &mut self.shown.only);
        });
    }
}

/// Draws the actions on staged values.
fn tools_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, hand) = (pane.look, pane.hand());
    let why = |why: Option<_>| why.map(|why| look.tr(device::refusal(why)));
    let apply = match hand.params.to_apply().iter().count() {
        0 => look.tr(device::APPLY).to_owned(),
        count => format!("{} ({count})", look.tr(device::APPLY)),
    };
    let nothing = hand.params.all_staged().is_empty();
    let nothing = nothing.then(|| look.tr(device::refusal(ParamRefusal::NothingStaged)));
    let is_known =
        hand.readings.sample.speed_set.is_some() && hand.connection.status.state.is_live();
    let unknown = (!is_known).then(|| look.tr(device::COPY_UNKNOWN));
    let link = &hand.connection.status;
    let no_apply = why(hand.params.apply_refusal(link));
    let no_undo = why(hand.params.undo_refusal(link));
    let apply = Button::new(&apply, look.tip(device::APPLY))
        .named(look.tr(device::APPLY))
        .strong_if(no_apply.is_none());
    let undo = Button::text(look, device::UNDO);
    let drop = Button::text(look, device::UNSTAGE_ALL);
    let copy = Button::text(look, device::COPY);
    let tools = [
        (apply, no_apply, ParamAction::Apply),
        (undo, no_undo, ParamAction::Undo),
        (drop, nothing, ParamAction::UnstageAll),
        (copy, unknown, ParamAction::CopyLive),
    ];
    for (button, disabled, wish) in tools {
        let button = button.disabled(disabled);
        button.on_click(ui, pane, Action::Param(wish));
    }
}

/// Operation in progress, or age of the values.
fn status(pane: &Pane<'_>) -> (String, Color32) {
    let (look, hand) = (pane.look, pane.hand());
    let book = &hand.params;
    if let Some(doing) = device::doing(book.doing) {
        return (look.tr(doing).into(), look.palette.accent);
    }
    if !hand.connection.status.state.is_live() {
        return (look.tr(device::NO_HAND).into(), look.palette.warn);
    }
    if let Some(error) = &book.trouble {
        let error = errors::request(look, error);
        let words = look.tr_with(device::TROUBLE, error);
        return (words, look.palette.warn);
    }
    let words = match book.read_at {
        None => look.tr(device::NOT_READ).into(),
        Some(at) => {
            let age = format::age(pane.state.now.since(at));
            let [read, ago] = [device::READ_AT, device::AGO].map(|text| look.tr(text));
            format!("{read} {age} {ago}")
        }
    };
    (words, look.palette.muted)
}
