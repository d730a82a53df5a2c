//! The numbers of the five fingertips in rows: forces, deltas, channels. Draws no picture.

use crate::hand::{Finger, TactileBlock};
use crate::ui::kit::controls;
use crate::ui::kit::controls::Label;
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, panels, words};
use crate::ui::theme;
use crate::ui::touch::tip_channels::signed;
use egui::{Rect, Ui, pos2, vec2};

/// How the numbers under the pictures are set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheet {
    /// Width of the captions.
    pub(crate) caption: f32,
    /// Height of a row.
    pub(crate) row: f32,
    /// Large digits.
    large: bool,
}

impl Sheet {
    /// Captions as wide as the widest of these.
    pub(crate) fn new(ui: &Ui, look: Look, captions: &[Text], row: f32, large: bool) -> Self {
        let width = |text: &Text| controls::text_width(ui, look.say(*text), theme::small());
        let widest = captions.iter().map(width).fold(0.0, f32::max);
        Self {
            caption: widest + theme::STEP,
            row,
            large,
        }
    }

    fn font(self) -> egui::FontId {
        if self.large {
            theme::number()
        } else {
            theme::number_small()
        }
    }

    /// The five columns right of the captions.
    pub(crate) fn columns(self, rect: Rect) -> impl Iterator<Item = (Finger, Rect)> {
        let left = rect.left() + self.caption;
        let width = (rect.right() - left) / 5.0;
        Finger::ALL.into_iter().scan(left, move |x, finger| {
            let column = Rect::from_min_max(pos2(*x, rect.top()), pos2(*x + width, rect.bottom()));
            *x += width;
            Some((finger, column))
        })
    }
}

/// One row of numbers under the pictures.
pub(crate) struct Line {
    pub(crate) caption: Text,
    name: Text,
    value: fn(&TactileBlock, Look) -> String,
}

pub(crate) const LINES: [Line; 5] = [
    Line {
        caption: panels::TOUCH_NORMAL,
        name: panels::TOUCH_NORMAL_NAME,
        value: |block, _| format::newtons(Some(block.normal_n)),
    },
    Line {
        caption: panels::TOUCH_SHEAR,
        name: panels::TOUCH_SHEAR_NAME,
        value: |block, _| format::newtons(Some(block.tangential_n)),
    },
    Line {
        caption: panels::TOUCH_DIRECTION,
        name: panels::TOUCH_DIRECTION_NAME,
        value: direction,
    },
    Line {
        caption: panels::TOUCH_PROXIMITY,
        name: panels::TOUCH_PROXIMITY_NAME,
        value: |block, _| format::counts(Some(block.proximity.into())),
    },
    Line {
        caption: panels::TOUCH_CHECK,
        name: panels::TOUCH_CHECK_NAME,
        value: |block, look| {
            let word = if block.check_ok() {
                panels::TOUCH_OK
            } else {
                panels::TOUCH_DIFFERS
            };
            look.say(word).into()
        },
    },
];

/// The direction in degrees, or why there is none.
pub(crate) fn direction(block: &TactileBlock, look: Look) -> String {
    match (block.direction_deg(), block.direction_raw) {
        (Some(degrees), _) => format!("{degrees}°"),
        (None, u16::MAX) => look.say(panels::TOUCH_NO_CONTACT).into(),
        (None, raw) => format!("?{raw}"),
    }
}

fn channels_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
    let look = pane.look;
    let mut top = rect.top();
    // Where both numbers find no room, the change says more than the count.
    let both = controls::text_width(ui, "0.00M +000.0k", sheet.font()) + theme::STEP;
    let narrow = (rect.width() - sheet.caption) / 5.0 < both;
    for channel in 0..8usize {
        let row = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), sheet.row));
        let caption = format!("{} {}", look.say(panels::TOUCH_CHANNEL), channel + 1);
        row_ui(
            ui,
            row,
            pane,
            sheet,
            [&caption, &caption],
            &|finger, block, _| {
                let raw = block.raw.get(channel).copied().map(i64::from);
                let rest = pane.state.hand().tare.rest(finger);
                let rest = rest.and_then(|rest| rest.raw.get(channel).copied());
                let change = raw.zip(rest).map(|(raw, rest)| raw - i64::from(rest));
                if narrow {
                    signed(change)
                } else {
                    format!("{:>6} {:>7}", format::counts(raw), signed(change))
                }
            },
        );
        top += sheet.row;
    }
}
/// Every value of all fingertips, under their names.
pub(crate) fn all_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let captions = [panels::TOUCH_DELTA_N, panels::TOUCH_DELTA_T];
    let row = (rect.height() / 16.5).clamp(theme::TABLE_ROW_LEAST, theme::CONTROL);
    let sheet = Sheet::new(ui, look, &captions, row, row > 15.0);
    let mut body = rect;
    let mut take = |rows: f32| {
        let (piece, rest) = body.split_top_bottom_at_y(body.top() + rows * row);
        body = rest;
        piece
    };
    for (finger, place) in sheet.columns(take(1.2)) {
        let color = look.palette.dof[finger.bend()];
        Label::new(look.say(words::finger(finger)), color)
            .small()
            .center()
            .put(ui, place);
    }
    table_ui(ui, take(5.0), pane, sheet);
    deltas_ui(ui, take(2.0), pane, sheet);
    channels_ui(ui, take(8.0), pane, sheet);
}

/// The forces.
pub(crate) fn table_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
    let look = pane.look;
    let mut top = rect.top();
    for line in &LINES {
        let row = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), sheet.row));
        let texts = [look.say(line.caption), look.say(line.name)];
        row_ui(ui, row, pane, sheet, texts, &|_, block, look| {
            (line.value)(block, look)
        });
        top += sheet.row;
    }
}

fn deltas_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
    let look = pane.look;
    let (first, second) = rect.split_top_bottom_at_fraction(0.5);
    let text = look.say(panels::TOUCH_DELTA_N);
    row_ui(ui, first, pane, sheet, [text, text], &|_, block, _| {
        format::counts(Some(block.normal_delta.into()))
    });
    let text = look.say(panels::TOUCH_DELTA_T);
    row_ui(ui, second, pane, sheet, [text, text], &|_, block, _| {
        format::counts(Some(block.tangential_delta.into()))
    });
}

type Reading<'a> = &'a dyn Fn(Finger, &TactileBlock, Look) -> String;

/// One row: a caption, its longer name for accessibility, and a number for each finger.
fn row_ui(
    ui: &mut Ui,
    row: Rect,
    pane: &Pane<'_>,
    sheet: Sheet,
    [caption, name]: [&str; 2],
    reading: Reading<'_>,
) {
    let look = pane.look;
    let left = row.with_max_x(row.left() + sheet.caption);
    Label::new(caption, look.palette.muted)
        .small()
        .put(ui, left);
    for (finger, column) in sheet.columns(row) {
        let block = pane.state.hand().sample.tactile[finger];
        let freshness = pane.state.hand().tip_freshness(finger);
        let text = block.map_or_else(
            || format::UNKNOWN.to_owned(),
            |block| reading(finger, &block.value, look),
        );
        let name = format!("{} {name}", look.say(words::finger(finger)));
        Label::new(&text, look.value(freshness, look.palette.text))
            .font(sheet.font())
            .center()
            .named(&name)
            .put(ui, column);
    }
}
