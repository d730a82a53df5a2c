//! List of sessions: which are shown, with which line style, their content, and their files. Stores nothing.

use crate::app::trials::comparison::SHOWN_MAX;
use crate::app::trials::{SessionId, SessionOrigin, TrialSession, TrialsState};
use crate::ui::kit::{self, Label, Look, dash};
use crate::ui::text::tune;
use crate::ui::theme;
use crate::ui::trials::compare_choice::ShownSessions;
use egui::{Color32, Role, Stroke, Ui, WidgetInfo};
use egui_extras::{Column, TableRow};
use egui_plot::LineStyle;

const ROW: f32 = 24.0;
/// Widths of check box, line style and name, and of trial count and file state.
const LEFT: [f32; 3] = [20.0, 26.0, 92.0];
const RIGHT: [f32; 2] = [72.0, 128.0];

/// Data of the list.
#[derive(Clone, Copy)]
pub(crate) struct SessionSheet<'a> {
    /// Colours and language.
    pub(crate) look: Look,
    /// The sessions.
    pub(crate) trials: &'a TrialsState,
}

pub(crate) fn name(look: Look, id: SessionId) -> String {
    look.fill(tune::SESSION, &[&id.0])
}

/// Line style of a shown session: the newest has the solid one.
pub(crate) fn style(shown: impl ExactSizeIterator<Item = SessionId>, id: SessionId) -> LineStyle {
    let count = shown.len();
    let at = shown.into_iter().position(|own| own == id);
    dash::nth(at.map_or(0, |at| count.saturating_sub(at + 1)))
}

/// Draws the list, newest first.
pub(crate) fn list_ui(ui: &mut Ui, sheet: SessionSheet<'_>, chosen: &mut ShownSessions) {
    let sessions = &sheet.trials.sessions;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut table = kit::table(ui, "sessions")
            .auto_shrink([false, true])
            .max_scroll_height(3.4 * ROW);
        for width in LEFT {
            table = table.column(Column::exact(width));
        }
        table = table.column(Column::remainder().clip(true));
        for width in RIGHT {
            table = table.column(Column::exact(width));
        }
        table.body(|body| {
            body.rows(ROW, sessions.len(), |mut row| {
                if let Some(session) = sessions.iter().rev().nth(row.index()) {
                    row_ui(&mut row, sheet, session, chosen);
                }
            });
        });
    });
    if sessions.iter().any(|session| session.lost > 0) {
        let look = sheet.look;
        kit::small_text_ui(ui, look.tr(tune::LOST_WHY), look.palette.warn);
    }
}

fn row_ui(
    row: &mut TableRow<'_, '_>,
    sheet: SessionSheet<'_>,
    session: &TrialSession,
    chosen: &mut ShownSessions,
) {
    let (look, palette) = (sheet.look, sheet.look.palette);
    let (id, name) = (session.id, name(sheet.look, session.id));
    row.col(|ui| tick_ui(ui, sheet, id, chosen));
    row.col(|ui| {
        if chosen.shown.len() > 1 && chosen.shown.contains(&id) {
            let style = style(chosen.shown.iter().copied(), id);
            let stroke = Stroke::new(theme::STRONG, palette.text);
            dash::sample(ui.painter(), ui.max_rect(), style, stroke);
        }
    });
    row.col(|ui| {
        let response = ui.selectable_label(chosen.focus == Some(id), &name);
        if response.on_hover_text(look.tip(tune::SESSION)).clicked() {
            chosen.choose(id);
        }
    });
    let trials = look.fill(tune::TRIALS, &[&session.trials.len()]);
    for words in [about(session), trials] {
        Label::new(&words, palette.muted).small().column_ui(row);
    }
    let (state, color) = state(sheet, session);
    let label = look.fill(tune::STATE, &[&name]);
    let state = Label::new(&state, color).small();
    state.named(&label).column_ui(row);
}

fn tick_ui(ui: &mut Ui, sheet: SessionSheet<'_>, id: SessionId, chosen: &mut ShownSessions) {
    let look = sheet.look;
    let mut on = chosen.shown.contains(&id);
    let count = chosen.shown.len();
    let reason = if on {
        (count == 1).then_some(tune::SHOWN_LAST)
    } else {
        (count >= SHOWN_MAX).then_some(tune::SHOWN_ALL)
    };
    let label = look.fill(tune::SHOW, &[&name(look, id)]);
    let tick = egui::Checkbox::without_text(&mut on);
    let tick = ui.add_enabled(reason.is_none(), tick);
    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, reason.is_none(), on, &label));
    if tick.changed() {
        chosen.toggle(id);
    }
    match reason {
        None => tick.on_hover_text(look.tip(tune::SHOW)),
        Some(reason) => tick.on_disabled_hover_text(look.tr(reason)),
    };
}

/// Day, hand, note and tags. Trials of the built-in hand have no day.
fn about(session: &TrialSession) -> String {
    let head = &session.head;
    let day = if head.simulated { "" } else { &head.day };
    let tags = head.tags.join(", ");
    let mut parts = vec![day, &head.hand, &head.note, &tags];
    parts.retain(|part| !part.is_empty());
    parts.join("  ")
}

fn state(sheet: SessionSheet<'_>, session: &TrialSession) -> (String, Color32) {
    let (look, palette) = (sheet.look, sheet.look.palette);
    if session.lost > 0 {
        return (look.fill(tune::LOST, &[&session.lost]), palette.warn);
    }
    let (text, color) = match &session.origin {
        _ if sheet.trials.running == Some(session.id) => (tune::SESSION_RUNS, palette.accent),
        SessionOrigin::Unsaved => (tune::SESSION_NOT_SAVED, palette.muted),
        SessionOrigin::Saved(_) => (tune::SAVED, palette.ok),
        SessionOrigin::Folder(_) => (tune::READ, palette.muted),
    };
    (look.tr(text).into(), color)
}
