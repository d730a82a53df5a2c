//! Current stage as text, large for visitors and small for staff; and the reasons why tiles are disabled.

use crate::app::exhibit::ExhibitState;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::exhibit::stage::{ExhibitHold, ExhibitStage, HaltReason};
use crate::record::{Hold, LinkState};
use crate::ui::exhibit::large::{LargeText, Page};
use crate::ui::kit::{Look, Pane};
use crate::ui::text::{Text, exhibit, hold, main, window};
use egui::{Color32, CornerRadius, ProgressBar, Rect, Ui, UiBuilder, WidgetInfo};
use std::time::Duration;

/// Unit of durations shown in minutes.
const MINUTE: Duration = Duration::from_secs(60);

/// Text of a stage.
struct StageWords {
    title: String,
    note: String,
    color: Color32,
    /// Remaining share of the time to play.
    left: Option<f32>,
}

/// True if holding a tile arms the hand again now.
pub(crate) fn restarts(state: &State, exhibit: &ExhibitState) -> bool {
    matches!(exhibit.view.stage, ExhibitStage::Halted(_))
        && exhibit.plan.visitor_restart
        && state.hand().connection.status.state == LinkState::Monitoring
}

/// Reason why pressing a tile has no effect now; `None` if it has.
pub(crate) fn tile_refusal(look: Look, state: &State, exhibit: &ExhibitState) -> Option<String> {
    let tr = |text| Some(look.tr(text).to_owned());
    match exhibit.view.stage {
        ExhibitStage::Halted(_) if restarts(state, exhibit) => None,
        ExhibitStage::Halted(why) => tr(exhibit::halted(why)),
        ExhibitStage::Idle | ExhibitStage::Attract | ExhibitStage::Visit { .. } => None,
        ExhibitStage::NextVisitor { .. } => tr(exhibit::NEXT_NOTE),
        ExhibitStage::Cooling { .. } => tr(exhibit::COOLING_NOTE),
        ExhibitStage::HeatUnknown => tr(exhibit::HEAT_UNKNOWN),
        ExhibitStage::Clearing => tr(exhibit::CLEARING),
    }
}

/// Draws the stage's text on its card.
pub(crate) fn words_ui(ui: &mut Ui, pane: &Pane<'_>, page: Page<'_>) {
    let (look, unit, rect) = (page.look, page.places.unit, page.places.words);
    let words = trouble(look, pane.state);
    let words = words.unwrap_or_else(|| stage_words(look, pane.state, page.exhibit));
    page.card(ui, rect);
    let bar = rect.with_max_x(rect.left() + 12.0 * unit).shrink(1.0);
    let round = CornerRadius {
        nw: CornerRadius::from(16.0 * unit).nw,
        sw: CornerRadius::from(16.0 * unit).sw,
        ..CornerRadius::ZERO
    };
    ui.painter().rect_filled(bar, round, words.color);
    let inner = rect.with_min_x(bar.right()).shrink(18.0 * unit);
    let (title, note) = inner.split_top_bottom_at_y(inner.top() + 66.0 * unit);
    let color = look.palette.text;
    page.line(ui, title, LargeText::new(&words.title, 54.0, color));
    let note = note.with_min_y(note.top() + 6.0 * unit);
    let label = LargeText::new(&words.note, 31.0, look.palette.muted);
    page.lines(ui, note, label);
    if let Some(left) = words.left {
        let bar = note.with_min_y(note.bottom() - 12.0 * unit);
        left_ui(ui, page, bar, left);
    }
}

/// Draws the remaining time to play.
fn left_ui(ui: &mut Ui, page: Page<'_>, rect: Rect, left: f32) {
    let builder = UiBuilder::new().max_rect(rect);
    ui.scope_builder(builder, |ui| {
        let bar = ProgressBar::new(left).fill(page.look.palette.accent);
        let response = ui.add(bar.desired_height(rect.height()));
        response.widget_info(|| {
            let name = page.look.tr(exhibit::PLAY_TIME);
            WidgetInfo::labeled(egui::Role::ProgressIndicator, true, name)
        });
    });
}

/// Text of a stop that was not sent or did not stop the hand, which takes precedence; `None` otherwise.
fn trouble(look: Look, state: &State) -> Option<StageWords> {
    let trouble = |text: Text| StageWords {
        title: look.tr(text).to_owned(),
        note: look.tip(text).to_owned(),
        color: look.palette.bad,
        left: None,
    };
    let mut notices = state.notices.iter();
    if notices.any(|notice| notice.what == NoticeKind::StopNotSent) {
        return Some(trouble(window::STOP_NOT_SENT));
    }
    matches!(state.hand().connection.status.hold, Hold::Alarm { .. })
        .then(|| trouble(main::ALARM_TITLE))
}

/// Text of a piece that holds what the visitor gives it.
fn hold_words(look: Look, own: ExhibitHold) -> StageWords {
    let force = own.force_g.map_or("-".into(), |g| g.to_string());
    let title = match (own.is_held, own.is_short) {
        (false, _) => look.tr(exhibit::GIVE).to_owned(),
        (true, false) => look.fill(exhibit::HELD, &[&force]),
        (true, true) => look.tr(exhibit::HELD_SHORT).to_owned(),
    };
    let note = match (own.is_held, own.last) {
        (false, _) => look.tr(exhibit::GIVE_NOTE).to_owned(),
        (true, None) => look.tr(exhibit::HELD_NOTE).to_owned(),
        (true, Some(last)) => {
            let last = hold::tightened(look, last);
            look.fill(exhibit::HELD_TIGHTENED, &[&own.tightened, &last])
        }
    };
    let color = if own.is_short {
        look.palette.warn
    } else {
        look.palette.ok
    };
    StageWords {
        title,
        note,
        color,
        left: None,
    }
}

fn stage_words(look: Look, state: &State, exhibit: &ExhibitState) -> StageWords {
    let palette = look.palette;
    let (accent, warn) = (palette.accent, palette.warn);
    let words = |(title, note): (Text, Text), color| StageWords {
        title: look.tr(title).to_owned(),
        note: look.tr(note).to_owned(),
        color,
        left: None,
    };
    match exhibit.view.stage {
        ExhibitStage::Halted(why) => {
            let title = if restarts(state, exhibit) {
                exhibit::HOLD
            } else {
                exhibit::MOMENT
            };
            let color = match why {
                HaltReason::NotArmed => accent,
                _ => warn,
            };
            words((title, exhibit::halted(why)), color)
        }
        ExhibitStage::Idle => words((exhibit::IDLE, exhibit::IDLE_NOTE), accent),
        ExhibitStage::Attract => words((exhibit::ATTRACT, exhibit::ATTRACT_NOTE), accent),
        ExhibitStage::Visit { until } => {
            let (left, all) = (until.since(state.now), exhibit.plan.visit);
            StageWords {
                left: Some(left.as_secs_f32() / all.as_secs_f32().max(1.0)),
                ..exhibit.view.hold.map_or_else(
                    || words((exhibit::VISIT, exhibit::VISIT_NOTE), palette.ok),
                    |own| hold_words(look, own),
                )
            }
        }
        ExhibitStage::NextVisitor { .. } => words((exhibit::NEXT, exhibit::NEXT_NOTE), accent),
        ExhibitStage::Cooling { until } => {
            let left = until.since(state.now).as_millis();
            let minutes = left.div_ceil(MINUTE.as_millis()).max(1);
            StageWords {
                title: look.fill(exhibit::COOLING, &[&minutes]),
                ..words((exhibit::COOLING, exhibit::COOLING_NOTE), warn)
            }
        }
        ExhibitStage::HeatUnknown => {
            words((exhibit::HEAT_UNKNOWN, exhibit::HEAT_UNKNOWN_NOTE), warn)
        }
        ExhibitStage::Clearing => words((exhibit::CLEARING, exhibit::CLEARING_NOTE), warn),
    }
}
