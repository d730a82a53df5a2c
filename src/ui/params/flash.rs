//! State of the hand's flash: SAVE and its outcome, last saved values, backups, files. Every change is an action.

use crate::app::action::Action;
use crate::app::params::state::Doing;
use crate::app::params::state::ParamAction;
use crate::app::params::state::ParamRefusal;
use crate::params::backups::Backup;
use crate::params::file::SaveVerdict;
use crate::ui::kit::path_field::path_ui;
use crate::ui::kit::{self, Button, Label, Pane};
use crate::ui::text::{cards, device, errors, main, notices};
use crate::ui::theme;
use egui::{Color32, ScrollArea, Ui, vec2};

/// Draws the card: its parts stacked beside the table, or side by side below it.
pub(crate) fn flash_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    kit::card_ui(ui, pane.look, |ui| {
        let height = ui.available_height();
        ui.set_min_height(height);
        if height > ui.available_width() {
            save_ui(ui, pane, height / 2.0);
            ui.add_space(theme::GAP);
            files_ui(ui, pane);
            return;
        }
        ui.columns(2, |columns| {
            if let [left, right] = columns {
                left.vertical(|ui| save_ui(ui, pane, height - theme::CONTROL_LARGE));
                right.vertical(|ui| files_ui(ui, pane));
            }
        });
    });
}

fn save_ui(ui: &mut Ui, pane: &mut Pane<'_>, most: f32) {
    let look = pane.look;
    let hand = pane.hand();
    let reason = hand.params.save_refusal(&hand.connection.status);
    let reason = reason.map(|why| look.tr(device::refusal(why)));
    // Strong only if it is the next step.
    let unsaved = hand.params.unsaved();
    let is_next = hand.params.to_apply().is_empty() && !unsaved.is_empty();
    let save = Button::text(look, device::SAVE).strong_if(is_next);
    let save = save.disabled(reason);
    kit::head_ui(ui, look, look.tr(device::FLASH), |ui| {
        save.on_click(ui, pane, Action::Param(ParamAction::Save));
    });
    let lines = lines(pane, reason);
    let area = ScrollArea::vertical().id_salt("flash").max_height(most);
    area.show(ui, |ui| {
        for (words, color) in lines {
            kit::small_text_ui(ui, &words, color);
        }
    });
}

/// State of the flash, newest first.
fn lines(pane: &Pane<'_>, reason: Option<&str>) -> Vec<(String, Color32)> {
    let (look, book) = (pane.look, &pane.hand().params);
    let palette = look.palette;
    let mut lines = Vec::new();
    lines.extend(writing(pane).map(|writing| (writing.to_owned(), palette.accent)));
    lines.extend(save_end(pane));
    if let Some(reason) = reason.filter(|_| !book.is_busy()) {
        lines.push((reason.to_owned(), palette.muted));
    }
    if !book.to_apply().is_empty() {
        lines.push((look.tr(device::SAVE_STAGED).into(), palette.warn));
    }
    let unsaved = book.unsaved().into_iter();
    let unsaved: Vec<String> = unsaved
        .map(|row| device::whole_name(look, row.id))
        .collect();
    if !unsaved.is_empty() {
        let words = look.tr_with(device::UNSAVED, unsaved.join(", "));
        lines.push((words, palette.text));
    }
    if let Some(file) = &book.known.doubtful {
        let words = look.tr_with(device::DOUBTFUL, moment(&file.at));
        lines.push((words, palette.warn));
    }
    lines.push(match &book.known.saved {
        None => (look.tr(device::NEVER_SAVED).into(), palette.muted),
        Some(file) => {
            let how = match &file.verdict {
                Some(SaveVerdict::Confirmed) => look.tr(device::BY_FRAME),
                _ => look.tr(device::BY_READING),
            };
            let (saved, at) = (look.tr(device::SAVED), moment(&file.at));
            (format!("{saved} {at} ({how})"), palette.text)
        }
    });
    if let Some(error) = &book.unreadable {
        let error = errors::file(look, error);
        let words = look.tr_with(device::UNREADABLE, error);
        lines.push((words, palette.warn));
    }
    lines.push((look.tr(device::FLASH_BODY).into(), palette.muted));
    lines
}

/// Write or save in progress, as text; `None` also while parameters are only read.
pub(crate) fn writing(pane: &Pane<'_>) -> Option<&'static str> {
    let doing = pane.hand().params.doing;
    let words = device::doing(doing).filter(|_| doing != Doing::Reading);
    words.map(|words| pane.look.tr(words))
}

/// Outcome of the last save, with its colour; `None` if nothing was saved yet.
pub(crate) fn save_end(pane: &Pane<'_>) -> Option<(String, Color32)> {
    let (look, palette) = (pane.look, pane.look.palette);
    let (end, _) = pane.hand().params.save.as_ref()?;
    let is_saved = device::is_saved(end);
    let color = if is_saved { palette.ok } else { palette.bad };
    Some((device::save_end(look, end), color))
}

/// Formats a timestamp as `2026-11-21 12:30:00 UTC`.
pub(crate) fn moment(stamp: &str) -> String {
    stamp.replace('T', " ").replace('Z', " UTC")
}

fn files_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let nothing = pane.hand().params.live_params().is_empty();
    let nothing = nothing.then(|| look.tr(device::refusal(ParamRefusal::NothingRead)));
    ui.horizontal(|ui| {
        let dump = Button::text(look, device::DUMP);
        let open = Button::text(look, device::OPEN);
        dump.disabled(nothing)
            .on_click(ui, pane, Action::Param(ParamAction::Dump));
        open.on_click(ui, pane, Action::Param(ParamAction::Open(None)));
    });
    if let Some(refused) = &pane.hand().params.file_refused {
        let words = notices::notice(look, refused);
        kit::small_text_ui(ui, &words, look.palette.warn);
        if let Some(path) = path_ui(ui, look, "parameters") {
            pane.actions
                .push(Action::Param(ParamAction::Open(Some(path))));
        }
    }
    Label::text(look, device::BACKUPS).ui(ui);
    let backups = &pane.hand().params.backups;
    let most = ui.available_height() - theme::CONTROL - theme::GAP;
    let area = ScrollArea::vertical().auto_shrink(false).max_height(most);
    let area = area.id_salt("backups").min_scrolled_height(0.0);
    area.show(ui, |ui| {
        if backups.is_empty() {
            Label::note(look, device::BACKUPS_NONE).wrap().ui(ui);
        }
        for backup in backups.iter().rev() {
            backup_ui(ui, pane, backup);
        }
    });
    ui.horizontal(|ui| guarded_ui(ui, pane));
}

/// Draws one backup as a button, with its hand below.
fn backup_ui(ui: &mut Ui, pane: &mut Pane<'_>, backup: &Backup) {
    let look = pane.look;
    let (words, unreadable) = match &backup.file {
        Ok(file) => {
            let why = device::why(look, &file.why);
            (format!("{} {why}", moment(&file.at)), None)
        }
        Err(error) => {
            let name = backup.path.file_name().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            (name, Some(errors::file(look, error)))
        }
    };
    let tip = format!("{words}\n{}", look.tr(device::BACKUP_TIP));
    let button = Button::new(&words, &tip).disabled(unreadable.as_deref());
    // As wide as the list: a longer name is truncated.
    let (id, place) = ui.allocate_space(vec2(ui.available_width(), theme::CONTROL));
    if button.put(ui, look, place, id).clicked() {
        let wish = ParamAction::Open(Some(backup.path.clone()));
        pane.actions.push(Action::Param(wish));
    }
    if let Ok(file) = &backup.file {
        let label = format!("{}: {words}", look.tr(device::BACKUP_OF));
        let hand = Label::new(&file.hand, look.palette.muted).small();
        hand.named(&label).wrap().ui(ui);
    }
}

/// Draws the buttons of procedures that need confirmation. Each only opens its card.
pub(crate) fn guarded_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let live = pane.hand().connection.status.state.is_live();
    for (text, action) in [
        (cards::RESET_ENTRY, Action::FactoryReset),
        (cards::CALIBRATE_ENTRY, Action::CalibrateForce),
    ] {
        let button = Button::text(look, text).disabled_if(!live, look.tr(main::REFUSED_OFFLINE));
        button.on_click(ui, pane, action);
    }
}
