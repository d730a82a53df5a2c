//! A file of parameters beside the hand, row by row with ticks. What is ticked is staged by an action; nothing is written.

use crate::app::action::Action;
use crate::app::params::action::ParamAction;
use crate::app::params::compared::Compared;
use crate::params::rows::{ParamId, Value};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_top};
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::params::flash::moment;
use crate::ui::params::table::{cell_name, cell_ui, value_text};
use crate::ui::text::{device, verdicts};
use crate::ui::theme;
use egui::{Rect, Role, Ui, UiBuilder, WidgetInfo};

/// Columns of a row: tick with name, the hand, the file.
fn columns(row: Rect) -> [Rect; 3] {
    let third = row.width() / 3.0;
    let (name, rest) = row.split_left_right_at_x(row.left() + third);
    let (live, file) = rest.split_left_right_at_x(rest.left() + third);
    [name, live, file]
}

/// Draws the comparison.
pub(crate) fn file_ui(ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>, compared: &Compared) {
    let look = pane.look;
    let palette = look.palette;
    let title = format!("{}: {}", look.say(device::COMPARED), compared.name);
    Label::new(&title, palette.text)
        .font(theme::title())
        .put(ui, take_top(&mut body, theme::CONTROL));
    about_ui(ui, take_top(&mut body, theme::TEXT_LINE), pane, compared);
    buttons_ui(ui, take_top(&mut body, theme::CONTROL), pane, compared);
    let head = take_top(&mut body, theme::LIST_LINE);
    let [name, live, file] = columns(head.with_max_x(head.right() - theme::GAP));
    for (place, text) in [
        (name, device::TAKE),
        (live, device::LIVE),
        (file, device::IN_FILE),
    ] {
        Label::new(look.say(text), palette.muted)
            .small()
            .put(ui, place);
    }
    list::scroll_ui(ui, body, "compared", |ui, width| {
        let rows: Vec<_> = compared.file.params.iter().collect();
        let high = theme::CONTROL + theme::STEP;
        let places: Vec<Rect> = rows.iter().map(|_| list::piece(ui, width, high)).collect();
        let unknown = compared.file.unknown_keys();
        if !unknown.is_empty() {
            let words = format!("{} {}", look.say(device::UNKNOWN_KEYS), unknown.join(", "));
            list::wrapped_ui(ui, width, 0.0, &words, palette.warn);
        }
        for (row, place) in rows.into_iter().zip(places) {
            row_ui(ui, place, pane, compared, row);
        }
    });
}

/// Whose values these are, of when, and why they were kept.
fn about_ui(ui: &mut Ui, row: Rect, pane: &Pane<'_>, compared: &Compared) {
    let file = &compared.file;
    let why = verdicts::why(pane.look, &file.why);
    let parts = [file.hand.clone(), moment(&file.at), why];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    Label::new(&parts.join(", "), pane.look.palette.muted)
        .small()
        .put(ui, row);
}

fn buttons_ui(ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, compared: &Compared) {
    let look = pane.look;
    let count = compared.chosen().iter().count();
    let text = format!("{} ({count})", look.say(device::STAGE_TICKED));
    let none = (count == 0).then(|| look.say(device::STAGE_NONE));
    let stage = Button::new(&text, look.say(device::STAGE_TICKED_TIP))
        .named(look.say(device::STAGE_TICKED))
        .weight(Weight::Strong)
        .disabled(none);
    let close = Button::new(
        look.say(device::CLOSE_FILE),
        look.say(device::CLOSE_FILE_TIP),
    );
    for (button, wish) in [
        (stage, ParamAction::StageTicked),
        (close, ParamAction::CloseFile),
    ] {
        let width = controls::text_width(ui, button.text, theme::body()) + 2.0 * theme::PAD;
        let place = take_left(&mut row, width);
        let id = egui::Id::unique(("compared", format!("{wish:?}")));
        if button.put(ui, look, place, id).clicked() {
            pane.actions.push(Action::Param(wish));
        }
    }
}

fn row_ui(
    ui: &mut Ui,
    row: Rect,
    pane: &mut Pane<'_>,
    compared: &Compared,
    (id, value): (ParamId, Value),
) {
    let look = pane.look;
    let palette = look.palette;
    let [name, live, file] = columns(row);
    let words = verdicts::whole_name(look, id);
    let mut ticked = compared.is_ticked(id);
    let tip = match id.is_place() {
        true => device::TICK_PLACE_TIP,
        false => device::TICK_TIP,
    };
    let tick = ui
        .scope_builder(UiBuilder::new().max_rect(name), |ui| {
            ui.checkbox(&mut ticked, &words)
        })
        .inner;
    let label = format!("{} {words}", look.say(device::TAKE));
    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, ticked, &label));
    if tick.on_hover_text(look.say(tip)).changed() {
        pane.actions.push(Action::Param(ParamAction::Tick(id)));
    }
    let held = pane.state.hand().params.live(id).map(|(value, _)| value);
    let fresh = pane.state.hand().param_freshness(id);
    let color = look.value(fresh, palette.text);
    let label = cell_name(pane, id, device::LIVE);
    cell_ui(ui, live, (&label, &value_text(held), color), "");
    let (words, color) = match held == Some(value) {
        true => (
            format!("{value}  {}", look.say(device::SAME)),
            palette.faint,
        ),
        false => (value.to_string(), palette.warn),
    };
    let label = cell_name(pane, id, device::IN_FILE);
    cell_ui(ui, file, (&label, &words, color), "");
}
