//! The parameter table: a row for each parameter, and columns of its values with their source and age. Every change is an
//! action that stages; nothing here writes.

use crate::app::action::Action;
use crate::app::readings::Freshness;
use crate::hand::SerialSpeed;
use crate::params::changes::RowVerdict;
use crate::params::rows::{ParamId, Value};
use crate::ui::kit::{self, Button, Label, NumberField, Pane, TextField, format};
use crate::ui::text::{Text, device, panels, poses};
use crate::ui::theme;
use egui::{Align, Layout, RichText, Ui, UiBuilder, vec2};
use egui_extras::{Column, TableBody, TableRow};

/// Maximum characters of an address.
const ADDRESS_MAX: usize = 15;
/// Height of a row.
const ROW: f32 = 28.0;
/// Widths of name, live, staged and saved; narrower if not all fit. The range column gets the rest.
const COLUMNS: [f32; 4] = [240.0, 152.0, 176.0, 128.0];
/// Width that all columns need.
const WIDTH: f32 = 800.0;
/// Rows of a group, its title, and its description.
type ParamGroup = (fn(ParamId) -> bool, Text, Text);
/// The groups in display order.
const GROUPS: [ParamGroup; 3] = [
    (
        |id| matches!(id, ParamId::DefaultSpeed(_)),
        device::GROUP_SPEED,
        device::ABOUT_SPEED,
    ),
    (
        |id| matches!(id, ParamId::DefaultForce(_)),
        device::GROUP_FORCE,
        device::ABOUT_FORCE,
    ),
    (ParamId::is_place, device::GROUP_PLACE, device::ABOUT_PLACE),
];

#[derive(Debug, Default)]
pub(crate) struct ShownRows {
    /// Only rows in which values differ.
    pub(crate) only: bool,
    /// Only rows that contain these words.
    pub(crate) words: String,
}

impl ShownRows {
    fn passes(&self, pane: &Pane<'_>, id: ParamId) -> bool {
        if self.only && !pane.hand().params.differs(id) {
            return false;
        }
        let name = device::whole_name(pane.look, id).to_lowercase();
        let register = id.register().name.to_lowercase();
        let all = format!("{name} {} {register}", id.name());
        let mut words = self.words.split_whitespace();
        words.all(|word| all.contains(&word.to_lowercase()))
    }
}

/// Minimum height: in a low window the table scrolls instead of covering the content below it.
const SCROLLED_LEAST: f32 = 64.0;

pub(crate) fn table_ui(ui: &mut Ui, pane: &mut Pane<'_>, shown: &ShownRows) {
    let look = pane.look;
    let rows = ParamId::all().into_iter();
    let rows: Vec<ParamId> = rows.filter(|id| shown.passes(pane, *id)).collect();
    if rows.is_empty() {
        let text = if shown.words.trim().is_empty() {
            device::NO_DIFFERENCE
        } else {
            device::FIND_NONE
        };
        Label::muted(look, text).ui(ui);
        return;
    }
    ui.visuals_mut().selection.bg_fill = look.palette.wash(look.palette.accent);
    let width = ui.available_width();
    let mut table = kit::table(ui, "parameters")
        .auto_shrink(false)
        .min_scrolled_height(SCROLLED_LEAST);
    for column in COLUMNS {
        table = table.column(Column::exact(column * (width / WIDTH).min(1.0)));
    }
    let table = table.column(Column::remainder());
    let (live, staged, saved) = (device::LIVE, device::STAGED, device::SAVED);
    let table = table.header(theme::LIST_LINE, |mut head| {
        for text in [poses::NAME, live, staged, saved, device::RANGE] {
            Label::note(look, text).column_ui(&mut head);
        }
    });
    table.body(|mut body| {
        for (has, title, about) in GROUPS {
            let own: Vec<ParamId> = rows.iter().copied().filter(|id| has(*id)).collect();
            if own.is_empty() {
                continue;
            }
            line_ui(&mut body, theme::CONTROL_LARGE, |ui| {
                let title = Label::text(look, title).ui(ui);
                title.on_hover_text(look.tr(about));
            });
            for id in own {
                let height = if id.is_place() { 62.0 } else { ROW };
                body.row(height, |row| row_ui(row, pane, id));
                if has_trouble(pane, id) {
                    line_ui(&mut body, theme::LIST_LINE, |ui| verdict_ui(ui, pane, id));
                }
            }
        }
    });
}

/// A line across all columns.
fn line_ui(body: &mut TableBody<'_>, height: f32, line: impl FnOnce(&mut Ui)) {
    let right = body.max_rect().right();
    body.row(height, |mut row| {
        row.col(|ui| {
            let place = ui.max_rect().with_max_x(right);
            let layout = Layout::left_to_right(Align::Center);
            let builder = UiBuilder::new().max_rect(place).layout(layout);
            // Not allocated: the column's width is unchanged.
            let mut whole = ui.new_child(builder);
            whole.set_clip_rect(ui.clip_rect().with_max_x(right));
            line(&mut whole);
        });
    });
}

/// True if the last write of a row did not succeed.
fn has_trouble(pane: &Pane<'_>, id: ParamId) -> bool {
    let end = pane.hand().params.outcome(id);
    end.is_some_and(|end| end.verdict != RowVerdict::Applied)
}

fn row_ui(mut row: TableRow<'_, '_>, pane: &mut Pane<'_>, id: ParamId) {
    let (book, muted) = (&pane.hand().params, pane.look.palette.muted);
    row.set_selected(book.staged(id).is_some());
    row.col(|ui| name_ui(ui, pane, id));
    row.col(|ui| live_ui(ui, pane, id));
    row.col(|ui| {
        ui.vertical(|ui| {
            let field = if id.is_place() {
                0.0
            } else {
                (ROW - theme::CONTROL) / 2.0
            };
            ui.add_space(field);
            ui.horizontal(|ui| staged_ui(ui, pane, id));
            if id.is_place() {
                change_ui(ui, pane, id);
            }
        });
    });
    row.col(|ui| {
        let saved = book.saved(id);
        let live = book.live(id).map(|(value, _)| value);
        let color = if saved == live || saved.is_none() || live.is_none() {
            muted
        } else {
            pane.look.palette.warn
        };
        let file = book.known.saved.as_ref().filter(|_| saved.is_some());
        let day = file.and_then(|file| file.at.get(..10)).unwrap_or_default();
        let name = cell_name(pane, id, device::SAVED);
        let value = value_text(id, saved);
        cell_ui(ui, Label::new(&value, color).named(&name), day);
    });
    row.col(|ui| range_ui(ui, pane, id));
}

/// Draws the writable range, and the factory value if the manual states it.
fn range_ui(ui: &mut Ui, pane: &Pane<'_>, id: ParamId) {
    let (look, muted) = (pane.look, pane.look.palette.muted);
    let range = match (id, id.range()) {
        (ParamId::ReduRatio, _) => look.tr(device::FOUR_SPEEDS).to_owned(),
        (_, Some((min, max))) => format!("{min}..{max} {}", id.unit()).trim_end().to_owned(),
        (_, None) => look.tr(device::ADDRESS_HINT).to_owned(),
    };
    let name = cell_name(pane, id, device::RANGE);
    let cell = |ui: &mut Ui| {
        cell_ui(ui, Label::new(&range, muted).named(&name), "");
        if id.factory().is_some() {
            let name = cell_name(pane, id, device::FACTORY);
            let factory = value_text(id, id.factory());
            Label::new(look.tr(device::FACTORY), muted).small().ui(ui);
            Label::new(&factory, muted).small().named(&name).ui(ui);
        }
    };
    let shown = match id.factory() {
        Some(_) => ui.vertical(cell),
        None => ui.scope(cell),
    };
    let section = id.register().section;
    let section = look.tr_with(device::MANUAL, section);
    shown.response.on_hover_text(section);
}

/// Accessible name of a value: `Index speed live`.
pub(crate) fn cell_name(pane: &Pane<'_>, id: ParamId, column: Text) -> String {
    let name = device::whole_name(pane.look, id);
    format!("{name} {}", pane.look.tr(column).to_lowercase())
}

/// Text of a value: the serial speed in baud, not as its code.
pub(crate) fn value_text(id: ParamId, value: Option<Value>) -> String {
    let speed = match (id, value) {
        (ParamId::ReduRatio, Some(Value::Number(code))) => SerialSpeed::of_code(code.into()),
        _ => None,
    };
    match (speed, value) {
        (Some(speed), _) => speed.baud().to_string(),
        (None, Some(value)) => value.to_string(),
        (None, None) => format::UNKNOWN.into(),
    }
}

/// Draws a value, with a note beside or below it.
pub(crate) fn cell_ui(ui: &mut Ui, value: Label<'_>, below: &str) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(theme::GAP, 0.0);
        value.number().ui(ui);
        if !below.is_empty() {
            let below = RichText::new(below).small().weak();
            ui.add(egui::Label::new(below).extend());
        }
    });
}

fn name_ui(ui: &mut Ui, pane: &Pane<'_>, id: ParamId) {
    let (look, palette) = (pane.look, pane.look.palette);
    let color = match id {
        ParamId::DefaultSpeed(dof) | ParamId::DefaultForce(dof) => palette.dof[dof],
        _ => palette.text,
    };
    let is_applied = pane.hand().params.outcome(id).is_some() && !has_trouble(pane, id);
    let name = Label::new(look.tr(device::name(id)), color);
    if !is_applied && !id.is_place() {
        name.ui(ui);
        return;
    }
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        name.ui(ui);
        if is_applied {
            let verdict = cell_name(pane, id, device::VERDICT);
            let label = Label::new(look.tr(device::APPLIED), palette.ok).small();
            label.named(&verdict).ui(ui);
        }
        if id.is_place() {
            Label::note(look, device::about(id)).wrap().ui(ui);
        }
    });
}

/// Draws the error of a row, with the hand's reply.
fn verdict_ui(ui: &mut Ui, pane: &Pane<'_>, id: ParamId) {
    let Some(end) = pane.hand().params.outcome(id) else {
        return;
    };
    let palette = pane.look.palette;
    let color = match &end.verdict {
        RowVerdict::Unverified(_) | RowVerdict::NotSent(_) => palette.warn,
        _ => palette.bad,
    };
    let words = device::row_end(pane.look, end);
    let name = cell_name(pane, id, device::VERDICT);
    Label::new(&words, color).small().named(&name).ui(ui);
}

fn live_ui(ui: &mut Ui, pane: &Pane<'_>, id: ParamId) {
    let hand = pane.hand();
    let live = hand.params.live(id);
    let is_live = hand.connection.is_live();
    let fresh = hand.params.freshness(id, is_live, pane.state.now);
    let color = pane.look.value(fresh, pane.look.palette.text);
    let age = live.map(|(_, at)| format::age(pane.state.now.since(at)));
    let below = match (age, fresh) {
        // How long ago all were read is above the table.
        (None, _) | (Some(_), Freshness::Live) => String::new(),
        (Some(age), _) => format!("{age} {}", pane.look.tr(device::AGO)),
    };
    let value = value_text(id, live.map(|(value, _)| value));
    let name = cell_name(pane, id, device::LIVE);
    cell_ui(ui, Label::new(&value, color).named(&name), &below);
}

/// Draws the field of the staged value, and the button that drops it.
fn staged_ui(ui: &mut Ui, pane: &mut Pane<'_>, id: ParamId) {
    let look = pane.look;
    let book = &pane.hand().params;
    let staged = book.staged(id);
    let live = book.live(id).map(|(value, _)| value);
    let shown = staged.or(live);
    let whole_name = device::whole_name(look, id);
    let name = cell_name(pane, id, device::STAGED);
    ui.scope(|ui| {
        let width = ui.available_width() - theme::CONTROL - theme::GAP;
        ui.set_max_width(width);
        let new = match id {
            ParamId::IpAddress => address_ui(ui, pane, &name, shown),
            ParamId::ReduRatio => speed_ui(ui, &name, shown),
            _ => number_ui(ui, pane, id, shown),
        };
        if let Some(new) = new {
            // A value equal to the live one is not staged.
            let new = Some(new).filter(|new| Some(*new) != live);
            pane.actions.push(Action::Stage(id, new));
        }
    });
    if staged.is_some() {
        let label = look.tr_with(device::UNSTAGE, whole_name);
        let drop = Button::new(&label, look.tip(device::UNSTAGE)).icon(theme::CLOSE);
        drop.on_click(ui, pane, Action::Stage(id, None));
    }
}

fn number_ui(ui: &mut Ui, pane: &mut Pane<'_>, id: ParamId, value: Option<Value>) -> Option<Value> {
    let (min, max) = id.range()?;
    let value = match value {
        Some(Value::Number(number)) => Some(number),
        _ => None,
    };
    let name = cell_name(pane, id, device::STAGED);
    let tip = pane.look.tip(device::STAGED);
    let field = NumberField::new(&name, tip, min.into()..=max.into());
    let typed = field.whole_ui(ui, pane, value)?;
    Some(Value::Number(i32::try_from(typed).ok()?))
}

fn speed_ui(ui: &mut Ui, name: &str, value: Option<Value>) -> Option<Value> {
    let all = SerialSpeed::ALL.map(|speed| Value::Number(i32::from(speed.code())));
    let all = all.map(|value| (Some(value), value_text(ParamId::ReduRatio, Some(value))));
    let mut chosen = value;
    ui.spacing_mut().combo_width = 0.0;
    kit::choose_ui(ui, name, &mut chosen, &all).then_some(chosen)?
}

/// Draws an address field. Invalid text stays, with the reason beside it.
fn address_ui(ui: &mut Ui, pane: &mut Pane<'_>, name: &str, value: Option<Value>) -> Option<Value> {
    let text = value.map_or_else(String::new, |value| value.to_string());
    let words = pane.look.tr(panels::ADDRESS_WRONG);
    let field = TextField::new(name, ADDRESS_MAX).hint(format::UNKNOWN);
    field.read_ui(ui, pane, &text, |text| {
        let address = text.parse().ok().map(Value::Address);
        address.ok_or_else(|| words.to_owned())
    })
}

/// Draws the button for a row that sets the hand's address: it is changed with a card, which can revert it.
fn change_ui(ui: &mut Ui, pane: &mut Pane<'_>, id: ParamId) {
    let look = pane.look;
    let hand = pane.hand();
    let name = device::whole_name(look, id);
    let label = look.tr_with(device::CHANGE, name);
    let live = hand.params.live(id).map(|(value, _)| value);
    let wanted = hand.params.staged(id);
    let wanted = wanted.filter(|wanted| Some(*wanted) != live);
    let reason = match wanted {
        None => Some(device::CHANGE_NONE),
        Some(_) if hand.connection.is_simulated() => Some(device::CHANGE_SIM),
        Some(_) => hand
            .params
            .write_refusal(&hand.connection.status)
            .map(device::refusal),
    };
    let button = Button::text(look, device::CHANGE)
        .named(&label)
        .disabled(reason.map(|reason| look.tr(reason)));
    let pressed = button.ui(ui, look);
    if let Some(wanted) = wanted.filter(|_| pressed.clicked()) {
        pane.actions.push(Action::ChangePlace(id, wanted));
    }
}
