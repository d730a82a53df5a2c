//! A strip for each hand below the header, with its state and a STOP of its own. Shown only with several hands.

use crate::app::action::Action;
use crate::app::hand::Hand;
use crate::app::hand::list::HandsAction;
use crate::app::hand::mover::Mover;
use crate::app::slot::SlotId;
use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::record::Hold;
use crate::ui::connection::link_words::link_words_of;
use crate::ui::kit::{self, Button, Label, Look, Pane, Weight};
use crate::ui::text::{Text, main, panels, window};
use crate::ui::theme;
use egui::{Color32, Rect, Ui, pos2, vec2};

/// Height of a strip.
const STRIP: f32 = 44.0;
/// Maximum and minimum width of a strip; if a row of minimum width does not fit, there are two rows.
const WIDTH_MAX: f32 = 252.0;
const WIDTH_LEAST: f32 = 140.0;
/// Width of a strip's STOP.
const STOP: f32 = 60.0;
/// Width of a hand's number.
const NUMBER: f32 = 18.0;
/// Width of the switch at the right end.
const SWITCH: f32 = 108.0;

/// Layout of the strips: number in a row, and width of each.
struct StripRows {
    in_row: usize,
    width: f32,
}

impl StripRows {
    fn of(room: f32, count: usize) -> Self {
        let room = room - SWITCH;
        let width = |in_row: usize| {
            let in_row = f32::from(u8::try_from(in_row).unwrap_or(u8::MAX)).max(1.0);
            (room / in_row - theme::GAP).floor()
        };
        let in_row = if width(count) < WIDTH_LEAST {
            count.div_ceil(2)
        } else {
            count
        };
        let width = width(in_row).min(WIDTH_MAX);
        Self { in_row, width }
    }
}

/// Width of the strips of `count` hands beside other content.
pub(crate) fn width(count: usize) -> f32 {
    let count = f32::from(u8::try_from(count).unwrap_or(u8::MAX));
    count * (WIDTH_MAX + theme::GAP) + SWITCH
}

/// Height of the strips of `count` hands, with the space around them.
pub(crate) fn height(room: f32, count: usize) -> f32 {
    if StripRows::of(room, count).in_row < count {
        2.0 * STRIP + 2.0 * theme::GAP
    } else {
        STRIP + theme::GAP
    }
}

/// Texts for the strip and the column of a hand.
pub(crate) struct HandWords {
    /// Number in the window, which is also the key that shows it.
    pub(crate) number: usize,
    pub(crate) name: String,
    /// State of its link and whether it is being moved, or the alarm that it does not stop.
    pub(crate) state: String,
    pub(crate) color: Color32,
    /// Left or right, as a letter and as a word.
    pub(crate) side: [Text; 2],
}

impl HandWords {
    /// Texts of the hand with this index.
    pub(crate) fn of(look: Look, at: usize, hand: &Hand, now: Moment) -> Self {
        let (state, color) = match hand.connection.status.hold {
            Hold::Alarm { .. } => (main::ALARM_TITLE, look.palette.bad),
            _ => link_words_of(look, hand),
        };
        let is_moved = !matches!(Mover::of(hand, now), None | Some(Mover::Stop));
        let state = if is_moved {
            format!("{} · {}", look.tr(state), look.tr(window::MOVES))
        } else {
            look.tr(state).to_owned()
        };
        let name = match &hand.connection.endpoint {
            Some(_) => hand.label.name.to_string(),
            None => look.tr(main::NO_HAND).to_owned(),
        };
        Self {
            number: at + 1,
            name,
            state,
            color,
            side: match hand.side {
                Side::Right => [window::SIDE_RIGHT, panels::RIGHT_HAND],
                Side::Left => [window::SIDE_LEFT, panels::LEFT_HAND],
            },
        }
    }
}

/// Draws the strips. A STOP is enabled whatever card is open, the rest only if `is_free`. `shows_all` is the state of the switch
/// that shows all hands side by side. True if that switch was clicked.
pub(crate) fn strips_ui(ui: &mut Ui, pane: &mut Pane<'_>, is_free: bool, shows_all: bool) -> bool {
    let look = pane.look;
    let place = ui.available_rect_before_wrap();
    let hands = &pane.state.hands;
    let rows = StripRows::of(place.width(), hands.count());
    let size = vec2(rows.width, STRIP);
    let mut corner = place.left_top();
    for (at, hand) in hands.iter().enumerate() {
        if at == rows.in_row {
            corner = place.left_top() + vec2(0.0, STRIP + theme::GAP);
        }
        let rect = Rect::from_min_size(corner, size);
        corner.x += rows.width + theme::GAP;
        let strip = HandStrip {
            slot: hand.label.slot,
            words: HandWords::of(look, at, hand, pane.state.now),
            rect,
            is_free,
        };
        ui.push_id(strip.slot, |ui| strip.ui(ui, pane));
    }
    if !is_free {
        ui.disable();
    }
    let middle = place.top() + STRIP / 2.0;
    let right = pos2(place.right(), middle + theme::CONTROL_LARGE / 2.0);
    let switch = vec2(SWITCH - theme::GAP, theme::CONTROL_LARGE);
    let rect = Rect::from_min_max(right - switch, right);
    let button = Button::text(look, window::ALL_HANDS).switch(shows_all);
    let id = ui.scope_id().with("all hands");
    button.put(ui, look, rect, id).clicked()
}

/// The strip of one hand.
struct HandStrip {
    slot: SlotId,
    words: HandWords,
    rect: Rect,
    /// Controls other than STOP are enabled.
    is_free: bool,
}

impl HandStrip {
    fn ui(&self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let (look, palette) = (pane.look, pane.look.palette);
        let Self {
            slot, words, rect, ..
        } = self;
        let (strip, stop) = rect.split_left_right_at_x(rect.right() - STOP);
        let strip = strip.with_max_x(strip.right() - theme::STEP);
        self.stop_ui(ui, pane, stop);
        if !self.is_free {
            ui.disable();
        }
        let is_shown = pane.hand().label.slot == *slot;
        let name = look.fill(window::HAND_OF, &[&words.number, &words.name]);
        let [letter, side] = words.side.map(|text| look.tr(text));
        let state = &words.state;
        let tip = format!("{name}\n{side}, {state}\n{}", look.tip(window::HAND_OF));
        let button = Button::new(&words.name, &tip).named(&name).switch(is_shown);
        let response = button.ground(ui, look, strip, ui.scope_id().with("show"));
        let inner = strip.shrink2(vec2(theme::GAP, theme::STEP));
        let (number, inner) = inner.split_left_right_at_x(inner.left() + NUMBER);
        let (upper, lower) = inner.split_top_bottom_at_fraction(0.5);
        let digit = words.number.to_string();
        let label = Label::new(&digit, palette.muted);
        label.paint(ui, number);
        let width = kit::text_width(ui, letter, theme::small()) + theme::STEP;
        let is_wide = width < upper.width() * 0.5;
        let (title, corner) = if is_wide {
            upper.split_left_right_at_x(upper.right() - width)
        } else {
            (upper, upper)
        };
        Label::new(&words.name, palette.text).paint(ui, title);
        if is_wide {
            let letter = Label::new(letter, palette.muted).small().right();
            letter.paint(ui, corner);
        }
        let lamp = pos2(lower.left() + theme::LAMP, lower.center().y);
        kit::lamp(ui, lamp, words.color);
        let text_rect = lower.with_min_x(lower.left() + theme::PAD);
        Label::new(state, palette.text).small().paint(ui, text_rect);
        if response.clicked() && !is_shown {
            pane.actions.push(Action::Hands(HandsAction::Show(*slot)));
        }
    }

    fn stop_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, rect: Rect) {
        let look = pane.look;
        let name = look.fill(window::STOP_ONE, &[&self.words.number]);
        let button = Button::new(look.tr(main::STOP), look.tip(window::STOP_ONE));
        let button = button.named(&name).weight(Weight::Danger);
        let response = button.ground(ui, look, rect, ui.scope_id().with("stop"));
        let word = Label::new(look.tr(main::STOP), look.palette.bad);
        word.center().paint(ui, rect);
        if kit::pressed(ui, &response) {
            let stop = HandsAction::StopOne(self.slot);
            pane.actions.push(Action::Hands(stop));
        }
    }
}
