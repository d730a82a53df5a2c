//! What the line's time goes to: each group of reads, what it gets and what the wire could give. Asks for nothing.

use crate::link::{GroupUse, PollGroup};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Color32, Rect, Ui};

/// Height of the card: title, head, five groups, writes, and the whole line.
pub(crate) const HEIGHT: f32 = theme::FIGURES_CARD;
/// Widths of the columns, from the right: what the wire could give, share, rate now.
const COLUMNS: [f32; 3] = [72.0, 60.0, 64.0];
const ROW: f32 = theme::FIGURE_ROW;

/// Draws the card.
pub(crate) fn budget_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let (_, mut body) = controls::titled_card(ui, look, rect, look.say(panels::BUDGET));
    let live = pane.state.hand().link.state.is_live();
    let plain = if live {
        look.palette.text
    } else {
        look.palette.faint
    };
    let heads = [
        panels::BUDGET_COULD,
        panels::BUDGET_SHARE,
        panels::BUDGET_NOW,
    ];
    let heads = heads.map(|head| look.say(head).to_owned());
    row_ui(ui, &mut body, "", &heads, look.palette.muted, pane);
    let line = &pane.state.hand().stats.line;
    for (group, used) in PollGroup::ALL.into_iter().zip(&line.groups) {
        let cells = [used.could_hz, used.share, used.hz];
        let cells = if live {
            group_cells(used)
        } else {
            cells.map(|_| format::UNKNOWN.into())
        };
        row_ui(ui, &mut body, look.say(name(group)), &cells, plain, pane);
    }
    let share = |share: f64| {
        if live {
            percent(share)
        } else {
            format::UNKNOWN.into()
        }
    };
    let writes = [String::new(), share(line.writes), String::new()];
    row_ui(
        ui,
        &mut body,
        look.say(panels::BUDGET_WRITES),
        &writes,
        plain,
        pane,
    );
    let stroke = egui::Stroke::new(1.0, look.palette.grid);
    ui.painter().hline(body.x_range(), body.top() - 1.0, stroke);
    body.min.y += theme::STEP;
    let whole = [String::new(), share(line.utilisation), String::new()];
    row_ui(
        ui,
        &mut body,
        look.say(panels::LINE_USED),
        &whole,
        plain,
        pane,
    );
}

fn group_cells(used: &GroupUse) -> [String; 3] {
    [rate(used.could_hz), percent(used.share), rate(used.hz)]
}

/// One row: a caption, and numbers from the right.
fn row_ui(
    ui: &mut Ui,
    body: &mut Rect,
    caption: &str,
    cells: &[String; 3],
    color: Color32,
    pane: &Pane<'_>,
) {
    let mut row = take_top(body, ROW);
    body.min.y -= theme::GAP - 2.0;
    let heads = [
        panels::BUDGET_COULD,
        panels::BUDGET_SHARE,
        panels::BUDGET_NOW,
    ];
    for ((cell, width), head) in cells.iter().zip(COLUMNS).zip(heads) {
        let place = take_right(&mut row, width);
        if cell.is_empty() {
            continue;
        }
        let name = format!("{caption}: {}", pane.look.say(head));
        let mut label = Label::new(cell, color).right();
        if caption.is_empty() {
            label = label.small();
        } else {
            label = label.number().named(&name);
        }
        label.put(ui, place);
    }
    Label::new(caption, pane.look.palette.muted).put(ui, row);
}

/// A rate, with a digit more where it is slow.
fn rate(hz: f64) -> String {
    if hz > 0.0 && hz < 9.95 {
        return format!("{hz:.1} Hz");
    }
    format::hertz(hz)
}

/// A share in percent.
pub(crate) fn percent(share: f64) -> String {
    let percent = share * 100.0;
    if percent > 0.0 && percent < 9.95 {
        return format!("{percent:.1} %");
    }
    format!("{percent:.0} %")
}

const fn name(group: PollGroup) -> Text {
    match group {
        PollGroup::Motion => panels::GROUP_MOTION,
        PollGroup::Drives => panels::GROUP_DRIVES,
        PollGroup::Temperature => panels::GROUP_TEMPERATURE,
        PollGroup::Tactile => panels::TACTILE_RATE,
        PollGroup::Settings => panels::GROUP_SETTINGS,
    }
}
