//! The six drives as a row of tiles: lamp, what each says, heat and current. A tile is chosen to hear more of it.

use crate::app::hand::Freshness;
use crate::hand::Dof;
use crate::ui::faults::entry as fault_entry;
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::kit::{self, Button, Label, Pane, format};
use crate::ui::text::{faults, words};
use crate::ui::theme;
use egui::text::LayoutJob;
use egui::{Align, Color32, Layout, Role, Sense, Ui, UiBuilder, WidgetInfo, vec2};

/// Most lines of a cause.
const CAUSE_LINES: usize = 4;

/// Draws them; the joint whose tile was pressed.
pub(crate) fn tiles_ui(ui: &mut Ui, pane: &Pane<'_>, chosen: Option<Dof>) -> Option<Dof> {
    let mut pressed = None;
    ui.columns(Dof::ALL.len(), |columns| {
        for (ui, dof) in columns.iter_mut().zip(Dof::ALL) {
            if tile_ui(ui, pane, dof, chosen == Some(dof)) {
                pressed = Some(dof);
            }
        }
    });
    ui.add_space(theme::STEP);
    pressed
}

/// A tile; in a high view it says the cause, too.
fn tile_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof, chosen: bool) -> bool {
    let (look, palette) = (pane.look, pane.look.palette);
    let joint = look.say(words::dof(dof));
    let said = DriveWords::of(pane, dof);
    let name = look.told(faults::DRIVE, joint);
    let button = Button::new(joint, look.tip(faults::DRIVE)).named(&name);
    let button = button.switch(chosen);
    let is_high = ui.available_height() >= 560.0;
    let height = if is_high { 112.0 } else { 52.0 };
    let (id, rect) = ui.allocate_space(vec2(ui.available_width(), height));
    let response = button.ground(ui, look, rect, id);
    let bar = rect.shrink2(vec2(0.0, theme::STEP));
    let bar = bar.with_max_x(rect.left() + theme::BAR);
    ui.painter().rect_filled(bar, 2.0, palette.dof[dof]);
    let inner = rect.shrink2(vec2(theme::GAP, theme::STEP));
    let down = Layout::top_down(Align::Min);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(inner).layout(down));
    ui.spacing_mut().item_spacing = vec2(theme::STEP, 0.0);
    ui.spacing_mut().interact_size.y = theme::TITLE_LINE;
    ui.horizontal(|ui| {
        Label::new(joint, palette.dof[dof]).ui(ui);
        kit::right_ui(ui, |ui| {
            unseen_mark_ui(ui, pane, dof);
            figures_ui(ui, pane, dof);
        });
    });
    ui.horizontal(|ui| {
        kit::lamp_ui(ui, Some(said.lamp));
        kit::right_ui(ui, |ui| {
            let (status, _) = pane.newest(dof, pane.state.hand().sample.status);
            if let Some(status) = status {
                figure_ui(ui, &status.raw().to_string(), palette.muted);
            }
            let ink = match said.freshness == Freshness::Live && said.text == palette.muted {
                true => palette.text,
                false => said.text,
            };
            let title = Label::new(&said.title, ink);
            kit::left_ui(ui, |ui| title.ui(ui));
        });
    });
    if let Some(words) = said.words.filter(|_| is_high) {
        let ink = look.value(said.freshness, palette.muted);
        let cause = words.cause.to_owned();
        let mut job = LayoutJob::simple(cause, theme::small(), ink, inner.width());
        job.wrap.max_rows = CAUSE_LINES;
        ui.label(job);
    }
    response.clicked()
}

/// Heat and current, as far as there is room.
fn figures_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof) {
    let sample = &pane.state.hand().sample;
    let (heat, heat_age) = pane.newest(dof, sample.temperature);
    let (current, current_age) = pane.newest(dof, sample.current);
    let heat = format::whole(heat.map(|heat| heat.raw().into()), 0);
    let current = format::whole(current.map(|current| current.raw().into()), 0);
    for (text, age) in [
        (format!("{heat} °C"), heat_age),
        (format!("{current} mA"), current_age),
    ] {
        if kit::text_width(ui, &text, theme::number()) > ui.available_width() {
            return;
        }
        figure_ui(ui, &text, pane.look.value(age, pane.look.palette.muted));
    }
}

fn figure_ui(ui: &mut Ui, text: &str, color: Color32) {
    Label::new(text, color).number().ui(ui);
}

/// A ring for faults of this joint that nobody has seen yet.
pub(crate) fn unseen_mark_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof) {
    let mut unseen = pane.state.hand().faults.unseen();
    let Some(first) = unseen.find(|entry| entry.dof == dof) else {
        return;
    };
    let palette = pane.look.palette;
    let is_active = first.is_active();
    let (place, response) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
    let color = if is_active { palette.bad } else { palette.warn };
    fault_entry::mark(ui, place.center(), color);
    let joint = pane.look.say(words::dof(dof));
    let name = format!("{joint} {}", pane.look.say(faults::UNSEEN_MARK));
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    let tip = fault_entry::title(pane, dof, first.what);
    response.on_hover_text(format!("{tip}\n{}", pane.look.say(faults::OVER_UNSEEN)));
}
