//! The list of sessions: which are shown, with which stroke, what each is of, and whether it lies in files. Keeps nothing.

use crate::app::trials::comparison::SHOWN_MAX;
use crate::app::trials::{SessionId, SessionOrigin, TrialSession, TrialsState};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_left, take_right, take_top};
use crate::ui::kit::dash;
use crate::ui::kit::list;
use crate::ui::kit::look::Look;
use crate::ui::text::{compare, tune};
use crate::ui::theme;
use crate::ui::trials::compare_choice::ShownSessions;
use egui::{Color32, CornerRadius, Id, Rect, Role, Sense, Stroke, Ui, WidgetInfo};
use egui_plot::LineStyle;

/// What the list is drawn from.
#[derive(Clone, Copy)]
pub(crate) struct Sheet<'a> {
    /// Colours and language.
    pub(crate) look: Look,
    /// The sessions.
    pub(crate) trials: &'a TrialsState,
}

/// A session's name.
pub(crate) fn name(look: Look, id: SessionId) -> String {
    format!("{} {}", look.say(tune::SESSION), id.0)
}

/// The stroke of a session that is shown: the newest has the plain one.
pub(crate) fn style(shown: impl ExactSizeIterator<Item = SessionId>, id: SessionId) -> LineStyle {
    let count = shown.len();
    let at = shown.into_iter().position(|own| own == id);
    at.map_or(LineStyle::Solid, |at| {
        dash::nth(count.saturating_sub(at + 1))
    })
}

/// Draws the list at the top of `body`, the newest first.
pub(crate) fn list_ui(ui: &mut Ui, body: &mut Rect, sheet: Sheet<'_>, chosen: &mut ShownSessions) {
    let sessions = &sheet.trials.sessions;
    let count = f32::from(u8::try_from(sessions.len()).unwrap_or(u8::MAX));
    let (whole, some) = theme::SESSIONS_SEEN;
    let rows = if count > whole { some } else { count };
    let place = take_top(body, rows * theme::TRIAL_ROW);
    list::scroll_ui(ui, place, "sessions", |ui, width| {
        for session in sessions.iter().rev() {
            let row = list::piece(ui, width, theme::TRIAL_ROW);
            row_ui(ui, row, sheet, session, chosen);
        }
    });
    if sessions.iter().any(|session| session.lost > 0) {
        let look = sheet.look;
        let place = take_top(body, theme::LIST_LINE);
        Label::new(look.say(compare::LOST_WHY), look.palette.warn)
            .small()
            .put(ui, place);
    }
}

fn row_ui(
    ui: &mut Ui,
    rect: Rect,
    sheet: Sheet<'_>,
    session: &TrialSession,
    chosen: &mut ShownSessions,
) {
    let look = sheet.look;
    let name = name(look, session.id);
    let mut row = rect;
    let tick = take_left(&mut row, theme::SESSION_TICK);
    let is_focus = chosen.focus == Some(session.id);
    let response = ui.interact(row, Id::unique(("session", session.id)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_focus, &name));
    let ground = match (is_focus, response.hovered()) {
        (true, _) => look.palette.wash(look.palette.accent),
        (false, true) => look.palette.control,
        (false, false) => Color32::TRANSPARENT,
    };
    let round = CornerRadius::same(theme::ROUND_TINY);
    ui.painter().rect_filled(row, round, ground);
    controls::focus_ring(ui, look, &response, row);
    let clicked = response.clicked();
    response.on_hover_text(look.say(tune::SESSION_TIP));
    tick_ui(ui, tick, sheet, session.id, chosen);
    if clicked {
        chosen.choose(session.id);
    }
    parts_ui(
        ui,
        row.shrink2(egui::vec2(theme::STEP, 0.0)),
        sheet,
        session,
        chosen,
    );
}

fn tick_ui(ui: &mut Ui, place: Rect, sheet: Sheet<'_>, id: SessionId, chosen: &mut ShownSessions) {
    let look = sheet.look;
    let mut on = chosen.shown.contains(&id);
    let count = chosen.shown.len();
    let reason = match on {
        true => (count == 1).then_some(compare::SHOWN_LAST),
        false => (count >= SHOWN_MAX).then_some(compare::SHOWN_ALL),
    };
    let label = format!("{} {}", look.say(compare::SHOW), name(look, id));
    let inside = egui::UiBuilder::new().max_rect(place);
    let tick = ui.scope_builder(inside, |ui| {
        ui.spacing_mut().interact_size = place.size();
        let tick = egui::Checkbox::without_text(&mut on);
        ui.add_enabled(reason.is_none(), tick)
    });
    let tick = tick.inner;
    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, reason.is_none(), on, &label));
    let changed = tick.changed();
    match reason {
        None => tick.on_hover_text(look.say(compare::SHOW_TIP)),
        Some(reason) => tick.on_disabled_hover_text(look.say(reason)),
    };
    if changed {
        chosen.toggle(id);
    }
}

fn parts_ui(
    ui: &mut Ui,
    mut row: Rect,
    sheet: Sheet<'_>,
    session: &TrialSession,
    chosen: &ShownSessions,
) {
    let look = sheet.look;
    let palette = look.palette;
    let sign = take_left(&mut row, theme::SESSION_DASH);
    if chosen.shown.len() > 1 && chosen.shown.contains(&session.id) {
        let style = style(chosen.shown.iter().copied(), session.id);
        let stroke = Stroke::new(theme::STRONG, palette.text);
        dash::sample(ui.painter(), sign, style, stroke);
    }
    let title = name(look, session.id);
    let place = take_left(&mut row, theme::SESSION_NAME);
    Label::new(&title, palette.text).small().put(ui, place);
    let (state, color) = state(sheet, session);
    let place = take_right(&mut row, theme::SESSION_STATE);
    let label = format!("{title}: {}", look.say(tune::SAVE));
    Label::new(&state, color)
        .small()
        .right()
        .named(&label)
        .put(ui, place);
    let trials = format!("{} {}", session.trials.len(), look.say(compare::TRIALS));
    let place = take_right(&mut row, theme::SESSION_TRIALS);
    Label::new(&trials, palette.muted)
        .small()
        .right()
        .put(ui, place);
    Label::new(&about(session), palette.muted)
        .small()
        .put(ui, row);
}

/// The day, the hand, the words. What was tried on the built-in hand belongs to no day.
fn about(session: &TrialSession) -> String {
    let head = &session.head;
    let day = (!head.simulated).then(|| head.day.clone());
    let parts = day
        .into_iter()
        .chain([head.hand.clone(), head.note.clone()]);
    let parts = parts.chain([head.tags.join(", ")]);
    let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
    parts.join("  ")
}

fn state(sheet: Sheet<'_>, session: &TrialSession) -> (String, Color32) {
    let look = sheet.look;
    let palette = look.palette;
    let runs = sheet.trials.running;
    if session.lost > 0 {
        let lost = format!("{} {}", session.lost, look.say(compare::LOST));
        return (lost, palette.warn);
    }
    let (text, color) = match &session.origin {
        _ if runs == Some(session.id) => (compare::RUNS, palette.accent),
        SessionOrigin::Unsaved => (compare::NOT_SAVED, palette.muted),
        SessionOrigin::Saved(_) => (compare::SAVED, palette.ok),
        SessionOrigin::Folder(_) => (compare::READ, palette.muted),
    };
    (look.say(text).into(), color)
}
