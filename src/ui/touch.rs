//! The five fingertips: pictures over a table of numbers, small in the overview and large in their own view.

use crate::app::action::Action;
use crate::hand::{Finger, PerFinger, TactileBlock};
use crate::ui::controls::{self, Button, Label};
use crate::ui::fingertip::{self, Tip};
use crate::ui::hand_picture::HandView;
use crate::ui::look::{Look, Pane};
use crate::ui::text::{Text, panels, words};
use crate::ui::tip_detail::TipDetail;
use crate::ui::touch_heat::HeatScale;
use crate::ui::{format, theme};
use egui::{Id, Rect, Ui, pos2, vec2};

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

/// Heights of the drawn hand in the overview: less shows nothing, more would take the room of the faults.
const HAND_LEAST: f32 = 130.0;
const HAND_MOST: f32 = 340.0;
/// Height that the faults below keep.
const FAULTS_LEAST: f32 = 150.0;

/// Height of the overview's card in a column of this size: the drawn hand gets what tips and faults leave.
pub(crate) fn overview_height(column: Rect) -> f32 {
    let tips = small_height(column.width());
    let free = column.height() - tips - FAULTS_LEAST - 2.0 * theme::GAP;
    let hand = if free >= HAND_LEAST {
        free.min(HAND_MOST) + theme::GAP
    } else {
        0.0
    };
    let most = (column.height() * 0.68).max(200.0);
    if hand > 0.0 {
        (tips + hand).round()
    } else {
        tips.min(most).round()
    }
}

/// Height of the card at this width without the drawn hand: as much as the pictures can fill.
fn small_height(width: f32) -> f32 {
    let picture = (width - 2.0 * theme::PAD - 44.0) / 5.0 * fingertip::HEIGHT_TO_WIDTH;
    2.0 * theme::PAD + theme::CONTROL + theme::GAP + 20.0 + picture + theme::STEP + 5.0 * 17.0
}

/// What the person chose for the fingertips.
#[derive(Debug, Clone, Default)]
pub(crate) struct TouchView {
    hand: HandView,
    scale: HeatScale,
    detail: TipDetail,
}

impl TouchView {
    /// The card of the overview.
    pub(crate) fn small_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let (head, mut body) = controls::titled_card(ui, look, rect, look.say(panels::TOUCH));
        self.scale.ui(ui, head, pane);
        let tips = self.scale.tips(pane);
        let room = rect.height() - small_height(rect.width()) - theme::GAP;
        if room >= HAND_LEAST - 1.0 {
            let picture = controls::take_top(&mut body, room);
            let clicked = self.hand.ui(
                ui,
                picture,
                pane,
                &tips,
                (Id::unique("hand, small"), self.detail.finger),
            );
            self.detail.finger = clicked.unwrap_or(self.detail.finger);
        }
        let captions = LINES.each_ref().map(|line| line.caption);
        let sheet = Sheet::new(ui, look, &captions, 17.0, false);
        let (pictures, table) = body.split_top_bottom_at_y(body.bottom() - 5.0 * sheet.row);
        let pictures = pictures.with_max_y(pictures.bottom() - theme::STEP);
        self.pictures_ui(ui, pictures, pane, sheet, &tips);
        table_ui(ui, table, pane, sheet);
    }

    /// The view of its own: the hand, one fingertip in detail, and every channel of all five as a number.
    pub(crate) fn large_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let tips = self.scale.tips(pane);
        let (left, right) = rect.split_left_right_at_x(rect.left() + (rect.width() * 0.42).round());
        let left = left.with_max_x(left.right() - theme::GAP);
        let (hand, detail) =
            left.split_top_bottom_at_y(left.top() + (left.height() * 0.52).round());
        let hand = hand.with_max_y(hand.bottom() - theme::GAP);
        let (_, picture) = controls::titled_card(ui, look, hand, look.say(panels::HAND));
        let clicked = self.hand.ui(
            ui,
            picture,
            pane,
            &tips,
            (Id::unique("hand, large"), self.detail.finger),
        );
        self.detail.finger = clicked.unwrap_or(self.detail.finger);
        self.detail.ui(ui, detail, pane);
        let (head, mut body) = controls::titled_card(ui, look, right, look.say(panels::TOUCH));
        self.scale.ui(ui, head, pane);
        let buttons = controls::take_top(&mut body, theme::CONTROL);
        self.tare_ui(ui, buttons, pane);
        self.sheet_ui(ui, body, pane, &tips);
    }

    fn sheet_ui(
        &mut self,
        ui: &mut Ui,
        body: Rect,
        pane: &Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
    ) {
        let captions = [panels::TOUCH_DELTA_N, panels::TOUCH_DELTA_T];
        let wide = body.width() > 760.0;
        let row = if body.height() > 560.0 { 20.0 } else { 16.0 };
        let sheet = Sheet::new(ui, pane.look, &captions, row, wide);
        let height = 15.0 * sheet.row + 2.0 * theme::GAP;
        let (pictures, mut table) = body.split_top_bottom_at_y(body.bottom() - height);
        let pictures = pictures.with_max_y(pictures.bottom() - theme::GAP);
        self.pictures_ui(ui, pictures, pane, sheet, tips);
        let forces = controls::take_top(&mut table, 5.0 * sheet.row);
        table_ui(ui, forces, pane, sheet);
        let deltas = controls::take_top(&mut table, 2.0 * sheet.row);
        deltas_ui(ui, deltas, pane, sheet);
        channels_ui(ui, table, pane, sheet);
    }

    /// Taring, and the lock of the colours.
    fn tare_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let live = pane.state.link.state.is_live();
        let offline = (!live).then(|| look.say(panels::TARE_OFFLINE));
        let finger = self.detail.finger;
        let one = format!(
            "{} {}",
            look.say(panels::TARE_ONE),
            look.say(words::finger(finger))
        );
        let nothing = (!pane.state.tare.can_undo()).then(|| look.say(panels::TARE_NOTHING));
        let all = look.say(panels::TARE_ALL);
        let buttons = [
            (all, panels::TARE_ALL_TIP, offline, Action::Tare(None)),
            (
                &one,
                panels::TARE_ONE_TIP,
                offline,
                Action::Tare(Some(finger)),
            ),
            (
                look.say(panels::TARE_UNDO),
                panels::TARE_UNDO_TIP,
                nothing,
                Action::UndoTare,
            ),
        ];
        for (at, (text, tip, disabled, action)) in buttons.into_iter().enumerate() {
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let place = controls::take_left(&mut row, width);
            let id = Id::unique(("tare", at));
            let button = Button::new(text, look.say(tip)).disabled(disabled);
            if button.put(ui, look, place, id).clicked() {
                pane.actions.push(action);
            }
        }
        let text = look.say(panels::HEAT_LOCK);
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let place = controls::take_right(&mut row, width);
        let lock =
            Button::new(text, look.say(panels::HEAT_LOCK_TIP)).choice(self.scale.locked.is_some());
        if lock.put(ui, look, place, Id::unique("heat lock")).clicked() {
            self.scale.locked = match self.scale.locked {
                Some(_) => None,
                None => Some(self.scale.full(pane)),
            };
        }
    }

    fn pictures_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        sheet: Sheet,
        tips: &PerFinger<Option<Tip>>,
    ) {
        let look = pane.look;
        for (finger, mut column) in sheet.columns(rect) {
            let name = look.say(words::finger(finger));
            let title = controls::take_top(&mut column, 16.0);
            let color = look.palette.dof[finger.bend()];
            Label::new(name, color).small().center().put(ui, title);
            let place = column.with_min_y(column.top() - theme::STEP);
            fingertip::paint(ui.painter(), look, place, &tips[finger].unwrap_or_default());
            let response = ui.allocate_rect(place, egui::Sense::click());
            if response
                .on_hover_text(look.say(panels::TOUCH_TIP))
                .clicked()
            {
                self.detail.finger = finger;
            }
            if tips[finger].is_none() {
                Label::new(format::UNKNOWN, look.palette.faint)
                    .center()
                    .put(ui, place);
            }
        }
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
                let rest = pane.state.tare.rest(finger);
                let rest = rest.and_then(|rest| rest.raw.get(channel).copied());
                let change = raw.zip(rest).map(|(raw, rest)| raw - i64::from(rest));
                if narrow {
                    Signed(change).to_string()
                } else {
                    format!("{:>6} {:>7}", format::counts(raw), Signed(change))
                }
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
