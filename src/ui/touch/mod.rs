//! The five fingertips: small over their numbers in the overview, large in their own view with one of them in detail.
pub(crate) mod fingertip;
pub(crate) mod heat;
pub(crate) mod table;
pub(crate) mod tip_channels;
pub(crate) mod tip_detail;
pub(crate) mod tip_space;

use crate::app::action::Action;
use crate::app::readings::friction::Hold;
use crate::hand::{Finger, PerFinger};
use crate::ui::hand::panel::HandPanel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::{panels, touch as text, words};
use crate::ui::theme;
use crate::ui::touch::fingertip::{Sense, Tip};
use crate::ui::touch::heat::HeatScale;
use crate::ui::touch::table as touch_table;
use crate::ui::touch::table::{LINES, Sheet, table_ui};
use crate::ui::touch::tip_detail::TipDetail;
use egui::{Align2, Id, Rect, Ui, pos2, vec2};

/// Height of the overview's card in a column of this size: what the faults leave, as far as hand and fingertips fill it.
pub(crate) fn overview_height(column: Rect) -> f32 {
    let tips = FRAME + pictures_height(column.width()) + NUMBERS;
    let roomy = column.height() >= tips + theme::HAND_LEAST + theme::TOUCH_FAULTS_LEAST;
    let faults = if roomy {
        theme::TOUCH_FAULTS_LEAST
    } else {
        theme::FAULTS_LEAST
    };
    let free = column.height() - faults - 2.0 * theme::GAP;
    let filled = tips + theme::HAND_MOST + theme::GAP;
    free.min(filled).max(theme::TIPS_LEAST).round()
}

/// What the card's edge and title take.
const FRAME: f32 = 2.0 * theme::PAD + theme::CONTROL + theme::GAP;
/// The numbers of the fingertips.
const NUMBERS: f32 = 5.0 * theme::LIST_LINE;

/// Height of the fingertips as pictures, with their names.
fn pictures_height(width: f32) -> f32 {
    let picture =
        (width - 2.0 * theme::PAD - theme::TIP_NUMBERS_CAPTION) / 5.0 * fingertip::HEIGHT_TO_WIDTH;
    theme::TITLE_LINE + picture + theme::STEP
}

/// Part of the view's height that the hand and the fingertips take, by what stands below.
const UPPER_PART: f32 = 0.48;
const UPPER_BY_NUMBERS_PART: f32 = 0.46;

/// What the person chose for the fingertips.
#[derive(Debug, Default)]
pub(crate) struct TouchView {
    hand: HandPanel,
    scale: HeatScale,
    detail: TipDetail,
    /// All numbers instead of one fingertip.
    numbers: bool,
}

impl TouchView {
    /// The card of the overview.
    pub(crate) fn small_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (head, mut body) = controls::titled_card(ui, look, rect, look.say(panels::TOUCH));
        self.scale.ui(ui, head, pane);
        let tips = self.scale.tips(pane);
        let (pictures, least) = (
            pictures_height(rect.width()),
            theme::HAND_LEAST + theme::GAP,
        );
        // Where room is short, the fingertips go before the hand does: it shows their heat and forces too.
        let below = [pictures + NUMBERS, NUMBERS, 0.0]
            .into_iter()
            .find(|below| body.height() - below >= least)
            .unwrap_or_default();
        let height = body.height() - below - if below > 0.0 { theme::GAP } else { 0.0 };
        let picture = controls::take_top(&mut body, height);
        let place = (Id::unique("hand, small"), self.detail.finger);
        let clicked = self.hand.ui(ui, picture, pane, &tips, place);
        self.detail.finger = clicked.unwrap_or(self.detail.finger);
        if below <= 0.0 {
            return;
        }
        let captions = LINES.each_ref().map(|line| line.caption);
        let sheet = Sheet::new(ui, look, &captions, 17.0, false);
        let (pictures, table) = body.split_top_bottom_at_y(body.bottom() - 5.0 * sheet.row);
        if below > NUMBERS {
            let pictures = pictures.with_max_y(pictures.bottom() - theme::STEP);
            self.pictures_ui(ui, pictures, pane, sheet, &tips);
        }
        table_ui(ui, table, pane, sheet);
    }

    /// The drawn hand alone.
    pub(crate) fn hand_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let tips = self.scale.tips(pane);
        let place = (Id::unique("hand, alone"), self.detail.finger);
        let clicked = self.hand.ui(ui, rect, pane, &tips, place);
        self.detail.finger = clicked.unwrap_or(self.detail.finger);
    }

    /// The view of its own: the hand and five large fingertips over the chosen one in detail, or all numbers.
    pub(crate) fn large_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let tips = self.scale.tips(pane);
        self.detail.follow(pane);
        let share = if self.numbers {
            UPPER_BY_NUMBERS_PART
        } else {
            UPPER_PART
        };
        let (upper, lower) =
            rect.split_top_bottom_at_y(rect.top() + (rect.height() * share).round());
        let upper = upper.with_max_y(upper.bottom() - theme::GAP);
        let width = (upper.height() * 0.96).min(upper.width() * 0.36).round();
        let (hand, right) = upper.split_left_right_at_x(upper.left() + width);
        let hand = hand.with_max_x(hand.right() - theme::GAP);
        let (_, picture) = controls::titled_card(ui, look, hand, look.say(panels::HAND));
        let place = (Id::unique("hand, large"), self.detail.finger);
        let clicked = self.hand.ui(ui, picture, pane, &tips, place);
        self.detail.finger = clicked.unwrap_or(self.detail.finger);
        let (head, mut body) = controls::titled_card(ui, look, right, look.say(panels::TOUCH));
        self.scale.ui(ui, head, pane);
        let buttons = controls::take_top(&mut body, theme::CONTROL);
        self.tare_ui(ui, buttons, pane);
        self.tips_ui(ui, body, pane, &tips);
        self.lower_ui(ui, lower, pane, &tips);
    }

    fn lower_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
    ) {
        let look = pane.look;
        let finger = self.detail.finger;
        let title = format!(
            "{}: {}",
            look.say(panels::TIP),
            look.say(words::finger(finger))
        );
        let (mut head, body) = controls::titled_card(ui, look, rect, &title);
        for (name, tip, numbers) in [
            (text::NUMBERS, text::NUMBERS_TIP, true),
            (text::DETAIL, text::DETAIL_TIP, false),
        ] {
            let words = look.say(name);
            let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
            let place = controls::take_right(&mut head, width);
            let button = Button::new(words, look.say(tip)).choice(self.numbers == numbers);
            if button
                .put(ui, look, place, Id::unique(("lower", numbers)))
                .clicked()
            {
                self.numbers = numbers;
            }
        }
        let rest = pane
            .state
            .hand()
            .tare
            .rest(finger)
            .filter(|rest| rest.chosen);
        let tared = rest.map_or_else(
            || look.say(text::NOT_TARED).to_owned(),
            |rest| {
                let age = format::age(pane.state.now.since(rest.at));
                format!("{} {age}", look.say(text::TARED_AGO))
            },
        );
        let (left, right) = head.split_left_right_at_fraction(0.5);
        Label::new(&tared, look.palette.muted)
            .small()
            .named(look.say(text::TARED_NAME))
            .put(ui, left);
        Label::new(look.say(text::ASSUMED), look.palette.faint)
            .small()
            .right()
            .put(ui, right)
            .on_hover_text(look.say(text::ASSUMED_TIP));
        if self.numbers {
            touch_table::all_ui(ui, body, pane);
        } else {
            self.detail.ui(ui, body, pane, tips[finger].as_ref());
        }
    }

    /// Five large fingertips, each a button that chooses it, with its forces.
    fn tips_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>, tips: &PerFinger<Option<Tip>>) {
        let look = pane.look;
        let width = rect.width() / 5.0;
        for (finger, at) in Finger::ALL.into_iter().zip(0u8..) {
            let left = rect.left() + width * f32::from(at);
            let place = Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()));
            let place = place.shrink2(vec2(1.0, 0.0));
            let name = look.say(words::finger(finger));
            let label = format!("{}: {name}", look.say(panels::TIP));
            let button = Button::new(name, look.say(panels::TOUCH_TIP))
                .named(&label)
                .choice(self.detail.finger == finger);
            let id = Id::unique(("tip", finger));
            if button.ground(ui, look, place, id).clicked() {
                self.detail.finger = finger;
            }
            self.tip_ui(
                ui,
                place.shrink(theme::STEP),
                pane,
                finger,
                tips[finger].as_ref(),
            );
        }
    }

    fn tip_ui(&self, ui: &mut Ui, place: Rect, pane: &Pane<'_>, finger: Finger, tip: Option<&Tip>) {
        let look = pane.look;
        let color = look.palette.dof[finger.bend()];
        let mut column = place;
        let title = controls::take_top(&mut column, theme::TIP_TITLE);
        let name = look.say(words::finger(finger));
        controls::paint_text(ui, title, Align2::CENTER_CENTER, name, theme::body(), color);
        let (picture, values) = column.split_top_bottom_at_y(column.bottom() - theme::TIP_VALUES);
        fingertip::paint(
            ui.painter(),
            look,
            picture,
            &tip.copied().unwrap_or_default(),
        );
        let block = pane.state.hand().sample.tactile[finger];
        let freshness = pane.state.hand().tip_freshness(finger);
        let block = block.map(|block| block.value);
        let (first, second) = values.split_top_bottom_at_fraction(0.5);
        let normal = format!("{} N", format::newtons(block.map(|block| block.normal_n)));
        let sense = tip.map_or(Sense::Fine, |tip| tip.sense);
        let hold = self.detail.hold(finger);
        let (below, below_color) = match (sense, hold) {
            (Sense::NoNumber, _) => (look.say(text::NO_NUMBER).to_owned(), look.palette.warn),
            (Sense::Beyond, _) => (look.say(text::BEYOND).to_owned(), look.palette.warn),
            (Sense::Fine, Hold::Slips) => (look.say(text::SLIP).to_owned(), look.palette.bad),
            (Sense::Fine, _) => {
                let shear = format::newtons(block.map(|block| block.tangential_n));
                let way = block.map_or(String::new(), |block| touch_table::direction(&block, look));
                (format!("{shear} N {way}"), look.palette.muted)
            }
        };
        let strong = if sense == Sense::Fine {
            look.palette.text
        } else {
            look.palette.warn
        };
        let tip = match sense {
            Sense::Beyond => text::BEYOND_TIP,
            _ => panels::TOUCH_TIP,
        };
        let tip = look.say(tip);
        for (place, words, font, color) in [
            (first, normal, theme::title(), strong),
            (second, below, theme::small(), below_color),
        ] {
            let name = format!(
                "{name} {}",
                look.say(if place == first {
                    panels::TOUCH_NORMAL_NAME
                } else {
                    panels::TOUCH_SHEAR_NAME
                })
            );
            Label::new(&words, look.value(freshness, color))
                .font(font)
                .center()
                .named(&name)
                .put(ui, place)
                .on_hover_text(tip);
        }
    }

    /// Taring, and the lock of the colours.
    fn tare_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let live = pane.state.hand().link.state.is_live();
        let offline = (!live).then(|| look.say(panels::TARE_OFFLINE));
        let finger = self.detail.finger;
        let one = format!(
            "{} {}",
            look.say(panels::TARE_ONE),
            look.say(words::finger(finger))
        );
        let nothing = (!pane.state.hand().tare.can_undo()).then(|| look.say(panels::TARE_NOTHING));
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
            let title = controls::take_top(&mut column, theme::TEXT_LINE);
            let color = look.palette.dof[finger.bend()];
            Label::new(name, color).small().center().put(ui, title);
            let place = column.with_min_y(column.top() - theme::STEP);
            let tip = tips[finger].unwrap_or_default();
            fingertip::paint(ui.painter(), look, place, &tip);
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
