//! The table of sessions: a row each, with what is done with it at its end.

use crate::app::action::Action;
use crate::app::sessions::{SessionAction, SessionForm, SessionItem};
use crate::record::EventKind;
use crate::ui::kit::{Button, Label, Pane, TextField, Weight, format};
use crate::ui::sessions::strip;
use crate::ui::text::{Text, sessions};
use crate::ui::theme;
use egui::{Align, Color32, Layout, Popup, Sense, Ui, vec2};
use egui_extras::{Column, TableBuilder};

const ROW: f32 = 32.0;
/// Characters of a name.
const NAME_MAX: usize = 80;

/// The least width of a name.
const NAME: f32 = 140.0;
/// The strip of force where there is much room, and where there is little.
const STRIP: (f32, f32) = (48.0, 112.0);

/// The columns: title and width; the strip of force takes what it can have beside a name, the name what is left then.
const COLUMNS: [(Text, f32); 10] = [
    (sessions::STAR, 36.0),
    (sessions::NAME, 0.0),
    (sessions::BEGAN, 132.0),
    (sessions::LENGTH, 84.0),
    (sessions::FORCE, STRIP.0),
    (sessions::FAULTS, 52.0),
    (sessions::TRIALS, 52.0),
    (sessions::NOTES, 52.0),
    (sessions::SIZE, 72.0),
    (sessions::REPLAY, 100.0),
];

/// Draws the table.
pub(crate) fn table_ui(ui: &mut Ui, pane: &mut Pane<'_>, items: &[&SessionItem]) {
    let look = pane.look;
    ui.spacing_mut().item_spacing.x = theme::STEP;
    let strip = strip_width(ui.available_width());
    let mut table = TableBuilder::new(ui)
        .id_salt("recorded")
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .auto_shrink([false, false]);
    for (title, width) in COLUMNS {
        table = table.column(match width {
            0.0 => Column::remainder().at_least(NAME).clip(true),
            _ if title == sessions::FORCE => Column::exact(strip),
            width => Column::exact(width),
        });
    }
    let table = table.header(theme::CONTROL, |mut row| {
        for (title, _) in COLUMNS {
            row.col(|ui| {
                let text = if title == sessions::REPLAY {
                    ""
                } else {
                    look.say(title)
                };
                Label::new(text, look.palette.muted).small().ui(ui);
            });
        }
    });
    table.body(|body| {
        body.rows(ROW, items.len(), |mut row| {
            let Some(item) = items.get(row.index()) else {
                return;
            };
            for column in 0..COLUMNS.len() {
                row.col(|ui| cell_ui(ui, pane, item, column));
            }
        });
    });
}

/// How wide the strip of force is, so that all columns fit in the smallest window.
fn strip_width(room: f32) -> f32 {
    let others = COLUMNS.iter().map(|(_, width)| width + theme::STEP);
    let taken = others.sum::<f32>() - STRIP.0 + NAME;
    (room - taken - theme::GAP).clamp(STRIP.0, STRIP.1)
}

fn cell_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &SessionItem, column: usize) {
    let palette = pane.look.palette;
    let number = |ui: &mut Ui, text: &str, color: Color32| {
        Label::new(text, color).number().ui(ui);
    };
    let count = |ui: &mut Ui, count: u64, color: Color32| {
        let color = if count == 0 { palette.faint } else { color };
        number(ui, &count.to_string(), color);
    };
    match column {
        0 => star_ui(ui, pane, item),
        1 => name_ui(ui, pane, item),
        2 => {
            let began: String = item.began().replace('T', " ").chars().take(16).collect();
            number(ui, &began, palette.muted);
        }
        3 => {
            let length = pane.state.sessions.length(item);
            number(ui, &format::duration(length), palette.text);
        }
        4 => {
            let size = vec2(ui.available_width() - theme::GAP, ROW - theme::GAP);
            let (place, response) = ui.allocate_exact_size(size, Sense::hover());
            strip::strip(ui.painter(), pane.look, place, &item.strip);
            response.on_hover_text(pane.look.tip(sessions::FORCE));
        }
        5 => count(ui, item.counts.faults, palette.bad),
        6 => {
            let trials = item.count(EventKind::Trial);
            count(ui, u64::try_from(trials).unwrap_or_default(), palette.text);
        }
        7 => {
            let notes = item.notes().len();
            count(ui, u64::try_from(notes).unwrap_or_default(), palette.text);
        }
        8 => size_ui(ui, pane, item),
        _ => ends_ui(ui, pane, item),
    }
}

/// The size; told apart where it goes to make room.
fn size_ui(ui: &mut Ui, pane: &Pane<'_>, item: &SessionItem) {
    let look = pane.look;
    let mut planned = pane.state.sessions.planned.iter();
    let planned = planned.find(|planned| planned.path == item.path);
    let color = match planned {
        Some(_) => look.palette.warn,
        None => look.palette.muted,
    };
    let size = format::megabytes(item.bytes);
    let label = Label::new(&size, color).number().ui(ui);
    if let Some(planned) = planned {
        label.on_hover_text(look.fill(sessions::GOES, &[&planned.due()]));
    }
}

fn star_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &SessionItem) {
    let look = pane.look;
    let star = item.about.star;
    let (icon, tip) = if star {
        (theme::STAR, look.say(sessions::UNSTAR))
    } else {
        (theme::NO_STAR, look.tip(sessions::STAR))
    };
    let name = look.pair(look.say(sessions::STAR), &item.title());
    let button = Button::new(look.say(sessions::STAR), tip).named(&name);
    let button = button.icon(icon).weight(Weight::Quiet).selected(star);
    let action = SessionAction::Star(item.path.clone(), !star);
    button.on_click(ui, pane, Action::Session(action));
}

/// The name, and below it the hand.
fn name_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &SessionItem) {
    let look = pane.look;
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let title = item.title();
        let label = Label::new(&title, look.palette.text).ui(ui);
        label.on_hover_text(item.path.display().to_string());
        let mut about = item.opening.hand.clone();
        if item.opening.simulated {
            about = format!("{}  {about}", look.say(sessions::SIMULATED));
        }
        let mut color = look.palette.muted;
        let is_recorded = item.is_in(&pane.state.sessions.recorded);
        let state = match item.closed {
            _ if is_recorded => Some((sessions::RECORDS_NOW, look.palette.ok)),
            true => None,
            false => Some((sessions::UNCLOSED, look.palette.warn)),
        };
        if let Some((text, own)) = state {
            about = format!("{}  {about}", look.say(text));
            color = own;
        }
        let label = Label::new(&about, color).small().ui(ui);
        if !item.closed {
            label.on_hover_text(look.tip(sessions::UNCLOSED));
        }
    });
}

fn ends_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &SessionItem) {
    let look = pane.look;
    let title = item.title();
    let named = look.pair(look.say(sessions::REPLAY), &title);
    let replay = Button::said(look, sessions::REPLAY).named(&named);
    let open = SessionAction::Open(item.path.clone());
    replay.on_click(ui, pane, Action::Session(open));
    let named = look.pair(look.say(sessions::MORE), &title);
    let more = Button::said(look, sessions::MORE).named(&named);
    let more = more.icon(theme::MORE).weight(Weight::Quiet).ui(ui, look);
    let close = egui::PopupCloseBehavior::CloseOnClickOutside;
    Popup::menu(&more).close_behavior(close).show(|ui| {
        ui.set_min_width(220.0);
        let field = TextField::new(look.say(sessions::RENAME), NAME_MAX);
        let field = field.hint(look.tip(sessions::RENAME));
        if let Some(name) = field.ui(ui, pane, &item.about.name) {
            let action = SessionAction::Name(item.path.clone(), name.trim().to_owned());
            pane.actions.push(Action::Session(action));
        }
        let reveal = ui.button(look.say(sessions::REVEAL));
        if reveal.on_hover_text(look.tip(sessions::REVEAL)).clicked() {
            let reveal = SessionAction::Reveal(item.path.clone());
            pane.actions.push(Action::Session(reveal));
            ui.close();
        }
        let exports = ui.menu_button(look.say(sessions::EXPORT), |ui| {
            SessionForm::ALL.into_iter().find(|form| {
                let name = look.say(sessions::form(*form));
                ui.button(name).clicked()
            })
        });
        if let Some(form) = exports.inner.flatten() {
            let export = SessionAction::Export(item.path.clone(), form);
            pane.actions.push(Action::Session(export));
            ui.close();
        }
        let copy = ui.button(look.say(sessions::COPY_PATH));
        if copy.on_hover_text(look.tip(sessions::COPY_PATH)).clicked() {
            ui.copy_text(item.path.display().to_string());
            ui.close();
        }
        let delete = ui.button(look.say(sessions::DELETE));
        if delete.on_hover_text(look.tip(sessions::DELETE)).clicked() {
            let ask = SessionAction::AskDelete(item.path.clone());
            pane.actions.push(Action::Session(ask));
            ui.close();
        }
    });
}
