//! Link statistics: state, rates, round trips, counts, and the use of the line's time.

use crate::app::action::Action;
use crate::hand::RateClass;
use crate::link::PollPriority;
use crate::record::quirk_sheet::Fact;
use crate::transport::Endpoint;
use crate::ui::connection::link_words::link_words;
use crate::ui::kit::{self, Label, Pane, format};
use crate::ui::text::{Text, errors, notices, panels, scan};
use crate::ui::theme;
use egui::{Align, CollapsingHeader, Color32, Layout, Ui, vec2};

/// Columns of the line's use from right to left, with their widths.
const BUDGET: [(Text, f32); 3] = [
    (panels::BUDGET_COULD, 80.0),
    (panels::BUDGET_SHARE, 80.0),
    (notices::NOW, 72.0),
];

/// Height of a window from which on the figures are open at first.
const OPEN_FROM: f32 = 960.0;

/// Draws state and rates of the link, and a collapsible section with all figures.
pub(crate) fn link_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    kit::head_ui(ui, look, look.tr(panels::LINK_NOW), |_| ());
    state_ui(ui, pane);
    let is_high = ui.ctx().content_rect().height() >= OPEN_FROM;
    let details = CollapsingHeader::new(look.tr(panels::DETAILS)).default_open(is_high);
    details.show_unindented(ui, |ui| {
        let [hand, rates, counts, troubles] = figures(pane);
        let groups = [vec![hand, rates, counts], vec![troubles]];
        ui.columns(2, |columns| {
            for (column, groups) in columns.iter_mut().zip(groups) {
                // The columns of egui are justified, which would spread the words of a text.
                column.vertical(|ui| {
                    for group in groups {
                        group_ui(ui, pane, group);
                    }
                });
            }
        });
        ui.add_space(theme::STEP);
        budget_ui(ui, pane);
    });
}

/// Draws the state of the link, its duration, and recent reads.
fn state_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let connection = &pane.hand().connection;
    let (link, stats) = (&connection.status, &connection.stats);
    let (word, color) = link_words(pane);
    let since = format::age(pane.state.now.since(link.since));
    let since = format!("{}{} {since}", look.tr(word), look.tr(panels::SINCE));
    ui.horizontal_wrapped(|ui| {
        kit::lamp_ui(ui, Some(color));
        Label::new(&since, look.palette.text).ui(ui);
        if link.state.is_live() {
            let rate = |text, hz| format!("{} {}", look.tr(text), format::hertz(hz));
            let trip = format::millis(stats.rtt_p50);
            let rates = [
                rate(panels::STATE_RATE, stats.state_hz),
                rate(panels::group(RateClass::Tactile), stats.tactile_hz),
                look.fill(panels::ROUND_TRIP, &[&trip]),
            ];
            Label::new(&rates.join("  ·  "), look.palette.muted).ui(ui);
        }
    });
    let text_ui = |ui: &mut Ui, text: &str, color| Label::new(text, color).wrap().ui(ui);
    if let Some(endpoint) = &connection.endpoint {
        let endpoint = endpoint.to_string();
        let label = Label::new(&endpoint, look.palette.muted).number();
        label.wrap().ui(ui);
    }
    if let Some(port) = &link.moved_to {
        let text = look.tr_with(panels::MOVED_TO, port);
        text_ui(ui, &text, look.palette.warn);
    }
    if link.echoes {
        text_ui(ui, look.tr(panels::ECHOES), look.palette.muted);
    }
    if let Some(ms) = link.slow_ms.filter(|_| link.state.is_live()) {
        let text = look.fill(panels::SLOW, &[&ms.to_string()]);
        text_ui(ui, &text, look.palette.warn);
    }
    if let Some(trouble) = &link.trouble {
        text_ui(ui, &errors::trouble(look, trouble), look.palette.bad);
    }
}

fn group_ui(ui: &mut Ui, pane: &Pane<'_>, group: FigureList) {
    ui.separator();
    for (caption, value, color) in group {
        let caption = pane.look.tr(caption);
        figure_ui(ui, pane, caption, |ui| {
            Label::new(&value, color).number().named(caption).ui(ui);
        });
    }
}

type FigureList = Vec<(Text, String, Color32)>;

fn figures(pane: &Pane<'_>) -> [FigureList; 4] {
    let palette = pane.look.palette;
    let stats = &pane.hand().connection.stats;
    let live = pane.hand().connection.status.state.is_live();
    let measured = |text, value: String| {
        if live {
            (text, value, palette.text)
        } else {
            (text, format::UNKNOWN.to_owned(), palette.faint)
        }
    };
    let trip = |value| format!("{} ms", format::millis(value));
    let count = |text, value: u64| (text, value.to_string(), palette.text);
    let bad = |text, value: u64| match value {
        0 => count(text, 0),
        value => (text, value.to_string(), palette.warn),
    };
    let (look, quirks) = (pane.look, &pane.hand().connection.status.quirks);
    let tr = |text: Option<Text>| {
        text.map_or(format::UNKNOWN, |text| look.tr(text))
            .to_owned()
    };
    let touch = format::hertz(stats.tactile_hz);
    let id = quirks.hand_id.map(i64::from);
    let mut hand = vec![
        measured(scan::fact(Fact::HandId), format::whole(id, 0)),
        measured(scan::fact(Fact::Touch), tr(quirks.touch.map(scan::touch))),
    ];
    let endpoint = pane.hand().connection.endpoint.as_ref();
    let has_words = matches!(
        endpoint,
        Some(Endpoint::Tcp { .. } | Endpoint::Rtu(_) | Endpoint::RtuTcp(_))
    );
    if has_words {
        let packing = quirks.packing.map_or(scan::PACKING_UNKNOWN, scan::packing);
        hand.push(measured(scan::fact(Fact::Packing), tr(Some(packing))));
    }
    [
        hand,
        vec![
            measured(panels::STATE_RATE, format::hertz(stats.state_hz)),
            measured(panels::group(RateClass::Tactile), touch),
            measured(panels::RTT_P50, trip(stats.rtt_p50)),
            measured(panels::RTT_P99, trip(stats.rtt_p99)),
        ],
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
            bad(panels::LATE, stats.late_replies),
            bad(panels::FOREIGN_REQUESTS, stats.foreign_requests),
            bad(panels::REFUSALS, stats.refusals),
            bad(panels::IMPLAUSIBLE, stats.implausible),
            bad(panels::DROPPED, stats.dropped_events),
        ],
    ]
}

/// Draws the use of the line: for each group of reads, its rate and the rate that the wire could provide.
fn budget_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let line = &pane.hand().connection.stats.line;
    let live = pane.hand().connection.status.state.is_live();
    let row = |ui: &mut Ui, caption: Text, values: [String; 3]| {
        let caption = look.tr(caption);
        figure_ui(ui, pane, caption, |ui| {
            for ((head, width), value) in BUDGET.into_iter().zip(values) {
                let name = format!("{caption}: {}", look.tr(head));
                let (text, color) = if live {
                    (value.as_str(), look.palette.text)
                } else {
                    (format::UNKNOWN, look.palette.faint)
                };
                cell_ui(ui, width, |ui| {
                    if !value.is_empty() {
                        Label::new(text, color).number().named(&name).ui(ui);
                    }
                });
            }
        });
    };
    kit::head_ui(ui, look, look.tr(panels::BUDGET), |_| ());
    figure_ui(ui, pane, "", |ui| {
        for (head, width) in BUDGET {
            let label = Label::note(look, head);
            let place = cell_ui(ui, width, |ui| label.ui(ui));
            if !look.tip(head).is_empty() {
                place.on_hover_text(look.tip(head));
            }
        }
    });
    for (group, used) in RateClass::ALL.into_iter().zip(&line.groups) {
        let values = [rate(used.could_hz), percent(used.share), rate(used.hz)];
        row(ui, panels::group(group), values);
    }
    let share = |share| [String::new(), percent(share), String::new()];
    row(ui, panels::BUDGET_WRITES, share(line.writes));
    ui.separator();
    row(ui, panels::LINE_USED, share(line.utilisation));
    let first = first_ui(ui, pane);
    pane.actions.extend(first.map(Action::ReadFirst));
}

/// Draws the choice of values read first during motion. Returns the new choice, if the user made one.
fn first_ui(ui: &mut Ui, pane: &Pane<'_>) -> Option<PollPriority> {
    let look = pane.look;
    let mut first = pane.state.settings.read_first;
    let all = [
        (PollPriority::Force, look.tr(panels::FIRST_FORCE)),
        (PollPriority::Touch, look.tr(panels::FIRST_TOUCH)),
    ];
    let caption = look.tr(panels::FIRST);
    let chosen = ui.horizontal(|ui| {
        let label = Label::new(caption, look.palette.muted).ui(ui);
        label.on_hover_text(look.tr(panels::FIRST_TIP));
        kit::right_ui(ui, |ui| {
            ui.spacing_mut().combo_width = 120.0;
            kit::choose_ui(ui, caption, &mut first, &all)
        })
    });
    chosen.inner.then_some(first)
}

/// Draws a caption, and values from the right end.
fn figure_ui(ui: &mut Ui, pane: &Pane<'_>, caption: &str, add: impl FnOnce(&mut Ui)) {
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = theme::FIGURE_ROW;
        ui.spacing_mut().item_spacing.x = theme::STEP;
        ui.horizontal(|ui| {
            Label::new(caption, pane.look.palette.muted).ui(ui);
            kit::right_ui(ui, add);
        });
    });
}

fn cell_ui<R>(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    let size = vec2(width, theme::FIGURE_ROW);
    let right = Layout::right_to_left(Align::Center);
    let cell = ui.allocate_ui_with_layout(size, right, |ui| {
        ui.set_min_width(width);
        add(ui)
    });
    cell.inner
}

/// Formats a rate: one more digit if it is slow, and within its column for a built-in hand that answers at once.
fn rate(hz: f64) -> String {
    if hz >= 9_999.5 {
        return format!("{:.0} kHz", hz / 1e3);
    }
    if hz > 0.0 && hz < 9.95 {
        return format!("{hz:.1} Hz");
    }
    format::hertz(hz)
}

/// Formats a share in percent.
fn percent(share: f64) -> String {
    let percent = share * 100.0;
    if percent > 0.0 && percent < 9.95 {
        return format!("{percent:.1} %");
    }
    format!("{percent:.0} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_of_any_size_fits_its_column() {
        let rates = [0.0, 1.64, 9.96, 9999.0, 9999.6, 22_183.0, 990_000.0];
        let words = rates.map(rate);
        assert_eq!(words[1], "1.6 Hz");
        assert_eq!(words[3..6], ["9999 Hz", "10 kHz", "22 kHz"]);
        assert!(words.iter().all(|rate| rate.len() <= 7), "{words:?}");
    }
}
