//! A parameter file compared with the hand, row by row with check boxes. Checked rows are staged by an action; nothing is written.

use crate::app::action::Action;
use crate::app::params::state::FileComparison;
use crate::app::params::state::ParamAction;
use crate::params::rows::ParamId;
use crate::ui::kit::{self, Button, Label, Pane, Weight};
use crate::ui::params::flash::moment;
use crate::ui::params::table::{cell_name, cell_ui, value_text};
use crate::ui::text::device;
use crate::ui::theme;
use egui::{Grid, Role, ScrollArea, Ui, WidgetInfo};

/// Draws the comparison.
pub(crate) fn file_ui(ui: &mut Ui, pane: &mut Pane<'_>, compared: &FileComparison) {
    let look = pane.look;
    let palette = look.palette;
    let file = &compared.file;
    let title = format!("{}: {}", look.tr(device::COMPARED), compared.name);
    Label::new(&title, palette.text).ui(ui);
    let parts = [
        file.hand.clone(),
        moment(&file.at),
        device::why(look, &file.why),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    Label::new(&parts.join(", "), palette.muted).small().ui(ui);
    ui.horizontal(|ui| buttons_ui(ui, pane, compared));
    let unknown = file.unknown_keys();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let width = ui.available_width() / 3.0 - theme::GAP;
        let grid = Grid::new("compared").num_columns(3).min_col_width(width);
        grid.show(ui, |ui| {
            for text in [device::TAKE, device::LIVE, device::IN_FILE] {
                Label::note(look, text).ui(ui);
            }
            ui.end_row();
            for (id, _) in file.params.iter() {
                row_ui(ui, pane, compared, id);
                ui.end_row();
            }
        });
        if !unknown.is_empty() {
            let words = look.tr_with(device::UNKNOWN_KEYS, unknown.join(", "));
            kit::small_text_ui(ui, &words, palette.warn);
        }
    });
}

fn buttons_ui(ui: &mut Ui, pane: &mut Pane<'_>, compared: &FileComparison) {
    let look = pane.look;
    let count = compared.chosen().iter().count();
    let text = format!("{} ({count})", look.tr(device::STAGE_TICKED));
    let stage = Button::new(&text, look.tip(device::STAGE_TICKED))
        .named(look.tr(device::STAGE_TICKED))
        .weight(Weight::Strong)
        .disabled_if(count == 0, look.tr(device::STAGE_NONE));
    stage.on_click(ui, pane, Action::Param(ParamAction::StageTicked));
    let close = Button::text(look, device::CLOSE_FILE);
    close.on_click(ui, pane, Action::Param(ParamAction::CloseFile));
}

fn row_ui(ui: &mut Ui, pane: &mut Pane<'_>, compared: &FileComparison, id: ParamId) {
    let look = pane.look;
    let palette = look.palette;
    let words = device::whole_name(look, id);
    let mut ticked = compared.is_ticked(id);
    let tip = if id.is_place() {
        device::TICK_PLACE_TIP
    } else {
        device::TICK_TIP
    };
    let tick = ui.checkbox(&mut ticked, &words);
    let label = look.tr_with(device::TAKE, words);
    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, ticked, &label));
    if tick.on_hover_text(look.tr(tip)).changed() {
        pane.actions.push(Action::Param(ParamAction::Tick(id)));
    }
    let hand = pane.hand();
    let held = hand.params.live(id).map(|(value, _)| value);
    let is_live = hand.connection.is_live();
    let fresh = hand.params.freshness(id, is_live, pane.state.now);
    let color = look.value(fresh, palette.text);
    let label = cell_name(pane, id, device::LIVE);
    let text = value_text(id, held);
    cell_ui(ui, Label::new(&text, color).named(&label), "");
    let value = compared.file.params.get(id);
    let text = value_text(id, value);
    let (words, color) = if held == value {
        (format!("{text}  {}", look.tr(device::SAME)), palette.muted)
    } else {
        (text, palette.warn)
    };
    let label = cell_name(pane, id, device::IN_FILE);
    cell_ui(ui, Label::new(&words, color).named(&label), "");
}
