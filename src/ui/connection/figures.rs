//! How the link goes: state, rates, round trips, counts. Asks for nothing.

use crate::ui::connection::budget;
use crate::ui::connection::link_words::link_words;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, notices, panels};
use crate::ui::theme;
use egui::text::LayoutJob;
use egui::{Color32, FontId, Rect, Ui, pos2, vec2};

/// From this height on there is room for the line's budget below the figures.
const WITH_BUDGET: f32 = theme::BUDGET_FROM;

/// True if the card has room for the line's budget below it.
pub(crate) fn has_budget(rect: Rect) -> bool {
    rect.height() >= WITH_BUDGET
}

/// Draws the card.
pub(crate) fn link_ui(ui: &mut Ui, mut rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    if has_budget(rect) {
        let (above, below) = rect.split_top_bottom_at_y(rect.bottom() - budget::HEIGHT);
        budget::budget_ui(ui, below, pane);
        rect = above.with_max_y(above.bottom() - theme::GAP);
    }
    let (_, mut body) = controls::titled_card(ui, look, rect, look.say(panels::LINK_NOW));
    let (word, color) = link_words(pane);
    let mut row = take_top(&mut body, theme::TITLE_LINE);
    controls::lamp(ui, pos2(row.left() + theme::LAMP_AT, row.center().y), color);
    row.min.x += theme::INDENT;
    let since = format::age(pane.state.now.since(pane.state.hand().link.since));
    let text = format!("{}, {} {since}", look.say(word), look.say(panels::SINCE));
    Label::new(&text, look.palette.text).put(ui, row);
    if let Some(endpoint) = &pane.state.hand().endpoint {
        endpoint_ui(ui, &mut body, pane, &endpoint.to_string());
    }
    if let Some(port) = &pane.state.hand().link.moved_to {
        let text = format!("{} {port}", look.say(panels::MOVED_TO));
        Label::new(&text, look.palette.warn).put(ui, take_top(&mut body, theme::TEXT_LINE));
    }
    if pane.state.hand().link.echoes {
        paragraph_ui(ui, &mut body, look.say(panels::ECHOES), look.palette.muted);
    }
    if let Some(trouble) = &pane.state.hand().link.trouble {
        let text = notices::trouble(look, trouble);
        paragraph_ui(ui, &mut body, &text, look.palette.bad);
    }
    take_top(&mut body, 0.0);
    for group in figures(pane) {
        for (caption, value, color) in group {
            if body.height() < theme::FIGURE_ROW {
                return;
            }
            let mut row = take_top(&mut body, theme::FIGURE_ROW);
            body.min.y -= theme::GAP - 2.0;
            let caption = look.say(caption);
            let right = take_right(&mut row, theme::COUNT_COLUMN);
            Label::new(caption, look.palette.muted).put(ui, row);
            Label::new(&value, color)
                .number()
                .right()
                .named(caption)
                .put(ui, right);
        }
        body.min.y += theme::STEP;
        let stroke = egui::Stroke::new(1.0, look.palette.grid);
        ui.painter().hline(body.x_range(), body.top(), stroke);
        body.min.y += theme::STEP + 2.0;
    }
}

/// Where the hand is, over as many lines as it needs.
fn endpoint_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>, text: &str) {
    let color = pane.look.palette.muted;
    let mut job = LayoutJob::simple(text.to_owned(), theme::number(), color, body.width());
    job.wrap.break_anywhere = true;
    job_ui(ui, body, job);
}

type Figures = Vec<(Text, String, Color32)>;

fn figures(pane: &Pane<'_>) -> [Figures; 3] {
    let palette = pane.look.palette;
    let stats = &pane.state.hand().stats;
    let live = pane.state.hand().link.state.is_live();
    let plain = if live { palette.text } else { palette.faint };
    let rate = |hz: f64| format::hertz(if live { hz } else { 0.0 });
    let trip = |value: Option<_>| format!("{} ms", format::millis(value.filter(|_| live)));
    let count = |text, value: u64| (text, value.to_string(), palette.text);
    let bad = |text, value: u64| {
        (
            text,
            value.to_string(),
            if value > 0 {
                palette.warn
            } else {
                palette.text
            },
        )
    };
    let rates = vec![
        (panels::STATE_RATE, rate(stats.state_hz), plain),
        (panels::TACTILE_RATE, rate(stats.tactile_hz), plain),
        (panels::RTT_P50, trip(stats.rtt_p50), plain),
        (panels::RTT_P99, trip(stats.rtt_p99), plain),
        (
            panels::LINE_USED,
            if live {
                budget::percent(stats.line.utilisation)
            } else {
                format::UNKNOWN.into()
            },
            plain,
        ),
    ];
    [
        rates,
        vec![
            count(panels::READS, stats.state_reads + stats.tactile_reads),
            count(panels::WRITES, stats.writes),
            count(panels::RECONNECTS, stats.reconnects),
        ],
        vec![
            bad(panels::TIMEOUTS, stats.timeouts),
            bad(panels::CHECKSUMS, stats.checksum_errors),
            bad(panels::RESYNCS, stats.resyncs),
            bad(panels::FOREIGN, stats.foreign_replies),
            bad(panels::RIVAL_REQUESTS, stats.foreign_requests),
            bad(panels::REFUSALS, stats.refusals),
            bad(panels::DROPPED, stats.dropped_events),
        ],
    ]
}

/// A caption, and beside it a value of words over as many lines as it needs.
pub(crate) fn fact_ui(
    ui: &mut Ui,
    body: &mut Rect,
    (caption, width): (&str, f32),
    muted: Color32,
    (value, font, color): (&str, FontId, Color32),
) {
    let room = (body.width() - width - theme::GAP).max(1.0);
    let mut job = LayoutJob::simple(value.to_owned(), font, color, room);
    // An address has no spaces.
    job.wrap.break_anywhere = true;
    let galley = ui.painter().layout_job(job);
    let height = galley.size().y.max(theme::FIGURE_ROW);
    let mut row = take_top(body, height);
    let left = take_left(&mut row, width).with_max_y(row.top() + theme::FIGURE_ROW);
    Label::new(caption, muted).put(ui, left);
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(row, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, value));
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(caption));
    let lone = galley.size().y < theme::FIGURE_ROW;
    let down = if lone {
        (theme::FIGURE_ROW - galley.size().y) / 2.0
    } else {
        0.0
    };
    ui.painter()
        .galley(row.min + vec2(0.0, down), galley, color);
}

/// A text over as many lines as it needs, cut from the top of what is left.
pub(crate) fn paragraph_ui(ui: &mut Ui, body: &mut Rect, text: &str, color: Color32) {
    let job = LayoutJob::simple(text.to_owned(), theme::body(), color, body.width());
    job_ui(ui, body, job);
}

fn job_ui(ui: &mut Ui, body: &mut Rect, job: LayoutJob) {
    let text = job.text.clone();
    let galley = ui.painter().layout_job(job);
    let place = take_top(body, galley.size().y);
    let response = ui.allocate_rect(place, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    ui.painter().galley(place.min, galley, Color32::PLACEHOLDER);
}
