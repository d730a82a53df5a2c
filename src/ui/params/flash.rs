//! What is known of the hand's flash: SAVE and what came of it, what was saved last, backups, files. Every change is an action.

use crate::app::action::Action;
use crate::app::params::action::ParamAction;
use crate::app::params::refusal::Refusal;
use crate::app::params::state::Doing;
use crate::params::backups::Backup;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_top};
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::params::place_buttons as guarded_entries;
use crate::ui::text::{device, errors, verdicts};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Ui};

/// Draws the card: beside the table its parts under each other, below it side by side.
pub(crate) fn flash_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let body = controls::card(ui, pane.look, rect);
    if rect.height() > rect.width() {
        let body = entries_ui(ui, body, pane);
        let (upper, lower) = body.split_top_bottom_at_y(body.top() + theme::DEVICE_SAVE);
        save_ui(ui, upper.with_max_y(upper.bottom() - theme::GAP), pane);
        files_ui(ui, lower, pane);
    } else {
        let (left, right) = body.split_left_right_at_x(body.center().x);
        let left = entries_ui(ui, left.with_max_x(left.right() - theme::PAD), pane);
        save_ui(ui, left, pane);
        files_ui(ui, right, pane);
    }
}

/// What is done to the hand only under a card stands at the bottom; the room that is left.
fn entries_ui(ui: &mut Ui, body: Rect, pane: &mut Pane<'_>) -> Rect {
    let (rest, mut row) = body.split_top_bottom_at_y(body.bottom() - theme::CONTROL);
    guarded_entries::left_ui(ui, &mut row, pane);
    rest.with_max_y(rest.bottom() - theme::GAP)
}

fn save_ui(ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let mut head = take_top(&mut body, theme::CONTROL_LARGE);
    let title = look.say(device::FLASH);
    let width = controls::text_width(ui, title, theme::title()) + 1.0;
    Label::new(title, look.palette.text)
        .font(theme::title())
        .put(ui, take_left(&mut head, width));
    let refusal = pane.state.hand().save_refusal();
    let reason = refusal.map(|why| look.say(verdicts::refusal(why)));
    let button = Button::new(look.say(device::SAVE), look.say(device::SAVE_TIP))
        .weight(Weight::Strong)
        .disabled(reason);
    let width = controls::text_width(ui, button.text, theme::body()) + 2.0 * theme::PAD;
    let place = head.with_min_x((head.right() - width).max(head.left()));
    if button
        .put(ui, look, place, Id::unique("save to flash"))
        .clicked()
    {
        pane.actions.push(Action::Param(ParamAction::Save));
    }
    let lines = lines(pane, reason);
    list::scroll_ui(ui, body, "flash", |ui, width| {
        for (words, color) in lines {
            list::wrapped_ui(ui, width, 0.0, &words, color);
        }
    });
}

/// What is known, the newest first.
fn lines(pane: &Pane<'_>, reason: Option<&str>) -> Vec<(String, Color32)> {
    let (look, book) = (pane.look, &pane.state.hand().params);
    let palette = look.palette;
    let mut lines = Vec::new();
    if let Some(doing) = verdicts::doing(book.doing).filter(|_| book.doing != Doing::Reading) {
        lines.push((look.say(doing).to_owned(), palette.accent));
    }
    if let Some((end, _)) = &book.save {
        let color = match verdicts::is_saved(end) {
            true => palette.ok,
            false => palette.bad,
        };
        lines.push((verdicts::save_end(look, end), color));
    }
    if let Some(reason) = reason.filter(|_| !book.is_busy()) {
        lines.push((reason.to_owned(), palette.muted));
    }
    if let Some(file) = &book.known.doubtful {
        let words = format!("{} {}", look.say(device::DOUBTFUL), moment(&file.at));
        lines.push((words, palette.warn));
    }
    lines.push(match &book.known.saved {
        None => (look.say(device::NEVER_SAVED).into(), palette.muted),
        Some(file) => {
            let how = match file.verdict.as_str() {
                "confirmed" => look.say(device::BY_FRAME),
                _ => look.say(device::BY_READING),
            };
            let words = format!(
                "{} {} ({how})",
                look.say(device::SAVED_ON),
                moment(&file.at)
            );
            (words, palette.text)
        }
    });
    if let Some(error) = &book.unreadable {
        let error = errors::params(look, error);
        let words = format!("{} {error}", look.say(device::UNREADABLE));
        lines.push((words, palette.warn));
    }
    lines.push((look.say(device::FLASH_BODY).into(), palette.muted));
    lines
}

/// `2026-11-21 12:30:00 UTC`, from a stamp.
pub(crate) fn moment(stamp: &str) -> String {
    stamp.replace('T', " ").replace('Z', " UTC")
}

fn files_ui(ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let mut row = take_top(&mut body, theme::CONTROL);
    let nothing = pane.state.hand().params.live_params().is_empty();
    let nothing = nothing.then(|| look.say(verdicts::refusal(Refusal::NothingRead)));
    let dump = Button::new(look.say(device::DUMP), look.say(device::DUMP_TIP)).disabled(nothing);
    let open = Button::new(look.say(device::OPEN), look.say(device::OPEN_TIP));
    for (button, wish) in [(dump, ParamAction::Dump), (open, ParamAction::Open)] {
        let width = controls::text_width(ui, button.text, theme::body()) + 2.0 * theme::PAD;
        let place = take_left(&mut row, width);
        let id = Id::unique(("file", button.text));
        if button.put(ui, look, place, id).clicked() {
            pane.actions.push(Action::Param(wish));
        }
    }
    let title = take_top(&mut body, theme::TITLE_LINE);
    body.min.y -= theme::STEP;
    Label::new(look.say(device::BACKUPS), look.palette.text)
        .font(theme::title())
        .put(ui, title);
    let backups = &pane.state.hand().params.backups;
    let mut wanted = None;
    list::scroll_ui(ui, body, "backups", |ui, width| {
        if backups.is_empty() {
            let words = look.say(device::BACKUPS_NONE);
            list::wrapped_ui(ui, width, 0.0, words, look.palette.muted);
        }
        for backup in backups.iter().rev() {
            let place = list::piece(ui, width, theme::CONTROL + theme::STEP);
            if backup_ui(ui, controls::middle(place, theme::CONTROL), pane, backup) {
                wanted = Some(backup.path.clone());
            }
        }
    });
    if let Some(path) = wanted {
        pane.actions
            .push(Action::Param(ParamAction::OpenBackup(path)));
    }
}

/// One backup as a button; true if it was pressed.
fn backup_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, backup: &Backup) -> bool {
    let look = pane.look;
    let (words, unreadable) = match &backup.about {
        Ok((at, why)) => (format!("{} {}", moment(at), verdicts::why(look, why)), None),
        Err(error) => {
            let name = backup.path.file_name().unwrap_or_default();
            (
                name.to_string_lossy().into_owned(),
                Some(errors::params(look, error)),
            )
        }
    };
    let button = Button::new(&words, look.say(device::BACKUP_TIP)).disabled(unreadable.as_deref());
    button
        .put(ui, look, rect, Id::unique(("backup", &backup.path)))
        .clicked()
}
