//! The five fingertips: pictures over a table of numbers, small in the overview and large in their own view.

use crate::app::state::Freshness;
use crate::hand::{Finger, TactileBlock};
use crate::ui::controls::{self, Label};
use crate::ui::fingertip::{self, Tip};
use crate::ui::look::{Look, Pane};
use crate::ui::text::{Text, panels, words};
use crate::ui::{format, theme};
use egui::{CornerRadius, Rect, Ui, pos2, vec2};

/// Counts above rest at which a pad is hottest, at least: below this, noise would look like touch.
const HEAT_FLOOR: f32 = 20_000.0;
/// How the numbers under the pictures are set.
#[derive(Debug, Clone, Copy)]
struct Sheet {
    /// Width of the captions.
    caption: f32,
    /// Height of a row.
    row: f32,
    /// Large digits.
    large: bool,
}

impl Sheet {
    fn new(ui: &Ui, look: Look, captions: &[Text], row: f32, large: bool) -> Self {
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
    fn columns(self, rect: Rect) -> impl Iterator<Item = (Finger, Rect)> {
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
struct Line {
    caption: Text,
    name: Text,
    value: fn(&TactileBlock, Look) -> String,
}

const LINES: [Line; 5] = [
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

fn direction(block: &TactileBlock, look: Look) -> String {
    match (block.direction_deg(), block.direction_raw) {
        (Some(degrees), _) => format!("{degrees}°"),
        (None, u16::MAX) => look.say(panels::TOUCH_NO_CONTACT).into(),
        (None, raw) => format!("?{raw}"),
    }
}

/// Height of the overview's card at this width: as much as the pictures can fill.
pub(crate) fn small_height(width: f32) -> f32 {
    let picture = (width - 2.0 * theme::PAD - 44.0) / 5.0 * fingertip::HEIGHT_TO_WIDTH;
    2.0 * theme::PAD + theme::CONTROL + theme::GAP + 20.0 + picture + theme::STEP + 5.0 * 17.0
}

/// The card of the overview.
pub(crate) fn small_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let (head, body) = controls::titled_card(ui, look, rect, look.say(panels::TOUCH));
    scale_ui(ui, head, look);
    let captions = LINES.each_ref().map(|line| line.caption);
    let sheet = Sheet::new(ui, look, &captions, 17.0, false);
    let (pictures, table) = body.split_top_bottom_at_y(body.bottom() - 5.0 * sheet.row);
    let pictures = pictures.with_max_y(pictures.bottom() - theme::STEP);
    pictures_ui(ui, pictures, pane, sheet);
    table_ui(ui, table, pane, sheet);
}

/// The view of its own: larger pictures, and every channel as a number.
pub(crate) fn large_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let (head, body) = controls::titled_card(ui, look, rect, look.say(panels::TOUCH));
    scale_ui(ui, head, look);
    let captions = [panels::TOUCH_DELTA_N, panels::TOUCH_DELTA_T];
    let wide = body.width() > 760.0;
    let row = if body.height() > 600.0 { 20.0 } else { 16.0 };
    let sheet = Sheet::new(ui, look, &captions, row, wide);
    let height = 15.0 * sheet.row + 2.0 * theme::GAP;
    let (pictures, mut table) = body.split_top_bottom_at_y(body.bottom() - height);
    let pictures = pictures.with_max_y(pictures.bottom() - theme::GAP);
    pictures_ui(ui, pictures, pane, sheet);
    let forces = controls::take_top(&mut table, 5.0 * sheet.row);
    table_ui(ui, forces, pane, sheet);
    let deltas = controls::take_top(&mut table, 2.0 * sheet.row);
    deltas_ui(ui, deltas, pane, sheet);
    channels_ui(ui, table, pane, sheet);
}

fn pictures_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
    let look = pane.look;
    let full = hottest(pane);
    for (finger, mut column) in sheet.columns(rect) {
        let name = look.say(words::finger(finger));
        let title = controls::take_top(&mut column, 16.0);
        let color = look.palette.dof[finger.bend()];
        Label::new(name, color).small().center().put(ui, title);
        let block = pane.state.sample.tactile[finger];
        let freshness = pane.freshness(block.map(|block| block.asked));
        let tip = block.map_or_else(Tip::default, |block| {
            tip(pane.state.touch_rest[finger], &block.value, full)
        });
        let tip = Tip {
            stale: freshness != Freshness::Live,
            ..tip
        };
        let place = column.with_min_y(column.top() - theme::STEP);
        fingertip::paint(ui.painter(), look, place, &tip);
        let response = ui.allocate_rect(place, egui::Sense::hover());
        response.on_hover_text(look.say(panels::TOUCH_TIP));
        if block.is_none() {
            Label::new(format::UNKNOWN, look.palette.faint)
                .center()
                .put(ui, place);
        }
    }
}

fn tip(rest: Option<[u32; 8]>, block: &TactileBlock, full: f32) -> Tip {
    let rest = rest.unwrap_or(block.raw);
    let mut heat = [None; 8];
    for ((heat, raw), rest) in heat.iter_mut().zip(block.raw).zip(rest) {
        *heat = Some(above(raw, rest) / full);
    }
    Tip {
        heat,
        normal_n: block.normal(),
        shear: block.tangential().zip(block.direction_deg().map(f32::from)),
        proximity: Some(small_float(i64::from(block.proximity))),
        stale: false,
    }
}

/// The one end of the scale for all fingers.
fn hottest(pane: &Pane<'_>) -> f32 {
    let mut full = HEAT_FLOOR;
    for (finger, block) in pane.state.sample.tactile.iter() {
        let (Some(block), Some(rest)) = (block, pane.state.touch_rest[finger]) else {
            continue;
        };
        for (raw, rest) in block.value.raw.into_iter().zip(rest) {
            full = full.max(above(raw, rest));
        }
    }
    // Steps of a fifth, so that the colours do not breathe with every reading.
    let step = 10.0_f32.powf((full.log10() * 5.0).ceil() / 5.0);
    step.max(HEAT_FLOOR)
}

fn channels_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
    let look = pane.look;
    let mut top = rect.top();
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
                let rest =
                    pane.state.touch_rest[finger].and_then(|rest| rest.get(channel).copied());
                let change = raw.zip(rest).map(|(raw, rest)| raw - i64::from(rest));
                format!("{:>6} {:>7}", format::counts(raw), Signed(change))
            },
        );
        top += sheet.row;
    }
}
/// A change with its sign, shortened like counts.
struct Signed(Option<i64>);

impl std::fmt::Display for Signed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let text = match self.0 {
            Some(value) if value > 0 => format!("+{}", format::counts(Some(value))),
            other => format::counts(other),
        };
        f.pad(&text)
    }
}

fn above(raw: u32, rest: u32) -> f32 {
    small_float(i64::from(raw) - i64::from(rest)).max(0.0)
}

fn small_float(value: i64) -> f32 {
    #[expect(
        clippy::cast_precision_loss,
        reason = "only its place on a colour scale matters"
    )]
    let float = value as f32;
    float
}

fn table_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sheet: Sheet) {
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
        let block = pane.state.sample.tactile[finger];
        let freshness = pane.freshness(block.map(|block| block.asked));
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

/// The heat scale, at the right of the title.
fn scale_ui(ui: &mut Ui, head: Rect, look: Look) {
    let mut rest = head;
    let bar = controls::middle(controls::take_right(&mut rest, 64.0), 8.0);
    let steps = 16u8;
    let width = bar.width() / f32::from(steps);
    for step in 0..steps {
        let left = bar.left() + width * f32::from(step);
        let piece = Rect::from_min_size(pos2(left, bar.top()), vec2(width + 0.5, bar.height()));
        let color = look.palette.heat(f32::from(step) / f32::from(steps - 1));
        ui.painter().rect_filled(piece, CornerRadius::ZERO, color);
    }
    Label::new(look.say(panels::TOUCH_SCALE), look.palette.faint)
        .small()
        .right()
        .put(ui, rest);
}
