//! Staff panel over the page: the PIN, then arming, disarming, leaving, and the day's figures.

use crate::app::action::Action;
use crate::app::exhibit::{ExhibitAction, ExhibitState, StaffPanel};
use crate::exhibit::pin::PinAnswer;
use crate::exhibit::stage::{ExhibitStage, ExhibitWish};
use crate::ui::exhibit::keypad::Keypad;
use crate::ui::exhibit::large::{LargeButton, LargeText, Page};
use crate::ui::exhibit::places::above;
use crate::ui::kit::{Label, Pane, Weight};
use crate::ui::text::{Text, exhibit, notices};
use egui::{Key, Rect, Role, Sense, Ui, Vec2, WidgetInfo, vec2};
use std::mem::Discriminant;

/// Opacity of the veil over the page.
const VEIL: f32 = 0.86;

/// Seconds without a touch before a new panel accepts presses, so that a typing finger presses nothing in it.
const AWAY_S: f64 = 0.5;

/// View state of the staff panel.
#[derive(Debug, Default)]
pub(crate) struct StaffView {
    keypad: Keypad,
    shown: Option<Discriminant<StaffPanel>>,
    /// Time from which the panel opened by the PIN accepts presses.
    accepts_from: f64,
}

/// Text above the keypad.
struct PadWords {
    title: Text,
    note: String,
    is_bad: bool,
    locked: bool,
}

impl StaffView {
    /// Draws the open panel; `keys` are those of a real keyboard.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, page: Page<'_>, keys: &[Key]) {
        let (exhibit, places) = (page.exhibit, page.places);
        let kind = std::mem::discriminant(&exhibit.staff);
        let is_new = self.shown.replace(kind) != Some(kind);
        if is_new {
            self.keypad.clear();
        }
        let accepts = self.accepts_presses(ui, is_new);
        if exhibit.staff == StaffPanel::Closed {
            return;
        }
        let veil = pane.look.palette.window.gamma_multiply(VEIL);
        ui.painter().rect_filled(places.whole, 0.0, veil);
        match pad_words(pane, exhibit) {
            Some(words) => {
                let typed = self.pad_ui(ui, pane, page, &words);
                let by_key = keys.iter().filter_map(|key| self.keypad.key(*key)).last();
                let typed = typed.or(by_key);
                let enter = |typed| Action::Exhibit(ExhibitAction::Pin(typed));
                pane.actions.extend(typed.map(enter));
            }
            None => drop(ui.scope(|ui| {
                if !accepts {
                    ui.visuals_mut().disabled_alpha = 1.0;
                    ui.disable();
                }
                open_ui(ui, pane, page);
            })),
        }
    }

    /// False until nothing has been pressed for [`AWAY_S`] since a new panel is shown: a surplus digit then presses nothing.
    fn accepts_presses(&mut self, ui: &Ui, is_new: bool) -> bool {
        let (now, is_down) = ui.input(|input| {
            let pointer = &input.pointer;
            let is_down = pointer.any_down() || pointer.any_pressed() || input.any_touches();
            (input.time, is_down)
        });
        if is_new || is_down && now < self.accepts_from {
            self.accepts_from = now + AWAY_S;
        }
        now >= self.accepts_from
    }

    fn pad_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        page: Page<'_>,
        words: &PadWords,
    ) -> Option<String> {
        let (look, unit) = (page.look, page.places.unit);
        let inner = card_ui(ui, page, vec2(620.0, 860.0), words.title);
        let (title, rest) = above(inner, 56.0 * unit, 4.0 * unit);
        title_ui(ui, page, title, words.title);
        let (note, rest) = above(rest, 44.0 * unit, 0.0);
        let color = if words.is_bad {
            look.palette.bad
        } else {
            look.palette.muted
        };
        page.line(ui, note, LargeText::new(&words.note, 28.0, color));
        let last = 84.0 * unit;
        let keys = rest.with_max_y(rest.bottom() - last - 16.0 * unit);
        let locked = words.locked.then_some(words.note.as_str());
        let typed = self.keypad.ui(ui, page, keys, locked);
        let cancel = LargeButton::new(look.tr(exhibit::CANCEL));
        if cancel.ui(ui, page, rest.with_min_y(rest.bottom() - last)) {
            let close = Action::Exhibit(ExhibitAction::CloseStaff);
            pane.actions.push(close);
        }
        typed
    }
}

/// Draws a centred card of this size in units, limited to the available space. Returns the area inside.
fn card_ui(ui: &mut Ui, page: Page<'_>, size: Vec2, title: Text) -> Rect {
    let room = page.places.staff();
    let rect = Rect::from_center_size(room.center(), (size * page.places.unit).min(room.size()));
    let response = ui.allocate_rect(rect, Sense::hover());
    let name = page.look.tr(title);
    response.widget_info(|| WidgetInfo::labeled(Role::Dialog, true, name));
    page.card(ui, rect);
    rect.shrink(28.0 * page.places.unit)
}

fn title_ui(ui: &mut Ui, page: Page<'_>, place: Rect, title: Text) {
    let look = page.look;
    let title = LargeText::new(look.tr(title), 38.0, look.palette.text);
    page.line(ui, place, title);
}

/// Text above the keypad; `None` once the PIN was right.
fn pad_words(pane: &Pane<'_>, exhibit: &ExhibitState) -> Option<PadWords> {
    let look = pane.look;
    let plain = |title, note: Text| PadWords {
        title,
        note: look.tr(note).to_owned(),
        is_bad: false,
        locked: false,
    };
    let bad = |title, note| PadWords {
        note,
        is_bad: true,
        ..plain(title, title)
    };
    Some(match &exhibit.staff {
        StaffPanel::Closed | StaffPanel::Open { .. } => return None,
        StaffPanel::Choose { first: Some(_), .. } => {
            plain(exhibit::PIN_AGAIN, exhibit::PIN_CHOOSE_NOTE)
        }
        StaffPanel::Choose { refused: true, .. } => bad(
            exhibit::PIN_CHOOSE,
            look.tr(exhibit::PIN_REFUSED).to_owned(),
        ),
        StaffPanel::Choose { .. } => plain(exhibit::PIN_CHOOSE, exhibit::PIN_CHOOSE_NOTE),
        StaffPanel::Ask { answer, .. } => match answer {
            Some(PinAnswer::Wrong { left }) => {
                bad(exhibit::PIN_ASK, look.fill(exhibit::PIN_WRONG, &[left]))
            }
            Some(PinAnswer::Locked { until }) if *until > pane.state.now => {
                let left = until.since(pane.state.now).as_millis().div_ceil(1000);
                PadWords {
                    locked: true,
                    ..bad(exhibit::PIN_ASK, look.fill(exhibit::PIN_LOCKED, &[&left]))
                }
            }
            _ => plain(exhibit::PIN_ASK, exhibit::PIN_CHOOSE_NOTE),
        },
    })
}

/// Draws the staff controls, available once the PIN was right.
fn open_ui(ui: &mut Ui, pane: &mut Pane<'_>, page: Page<'_>) {
    let (look, unit) = (page.look, page.places.unit);
    let gap = 18.0 * unit;
    let inner = card_ui(ui, page, vec2(1100.0, 760.0), exhibit::STAFF);
    let (title, rest) = above(inner, 56.0 * unit, gap);
    title_ui(ui, page, title, exhibit::STAFF);
    let (left, right) = rest.split_left_right_at_fraction(0.54);
    figures_ui(ui, page, right.with_min_x(right.left() + 2.0 * gap));
    let is_halted = matches!(page.exhibit.view.stage, ExhibitStage::Halted(_));
    let no_hand = !pane.hand().connection.status.state.is_live();
    let arm = LargeButton {
        note: look.tr(exhibit::ARM_NOTE),
        size: 48.0,
        weight: Weight::Armed,
        disabled: no_hand.then(|| look.tr(exhibit::ARM_NO_HAND)),
        ..LargeButton::new(look.tr(exhibit::ARM))
    };
    let disarm = LargeButton {
        disabled: is_halted.then(|| look.tr(exhibit::DISARM_NOTHING)),
        ..LargeButton::new(look.tr(exhibit::DISARM))
    };
    let leave = LargeButton {
        weight: Weight::Danger,
        ..LargeButton::new(look.tr(exhibit::LEAVE))
    };
    let close = LargeButton::new(look.tr(exhibit::CLOSE));
    let (large, small) = split(left, gap);
    let all = [
        (arm, large, ExhibitAction::Wish(ExhibitWish::Arm)),
        (disarm, small[0], ExhibitAction::Wish(ExhibitWish::Disarm)),
        (leave, small[1], ExhibitAction::Leave),
        (close, small[2], ExhibitAction::CloseStaff),
    ];
    for (button, place, action) in all {
        if button.ui(ui, page, place) {
            pane.actions.push(Action::Exhibit(action));
        }
    }
}

/// Splits into a large rectangle above three smaller ones.
fn split(rect: Rect, gap: f32) -> (Rect, [Rect; 3]) {
    let (large, rest) = above(rect, rect.height() * 0.34, gap);
    let high = (rest.height() - 2.0 * gap) / 3.0;
    let (first, rest) = above(rest, high, gap);
    let (second, third) = above(rest, high, gap);
    (large, [first, second, third])
}

/// Draws today's counts.
fn figures_ui(ui: &mut Ui, page: Page<'_>, rect: Rect) {
    let (look, report) = (page.look, page.exhibit.report.today());
    let rows: [(Text, u32); 5] = [
        (exhibit::VISITS, report.visits),
        (exhibit::PIECES, report.pieces.values().sum()),
        (exhibit::RESTS, report.rests),
        (exhibit::FAULTS, report.faults.values().sum()),
        (exhibit::STOPS, report.stops),
    ];
    let high = rect.height() / 7.0;
    let (head, mut rest) = above(rect, high, 0.0);
    let today = LargeText::new(look.tr(exhibit::TODAY), 30.0, look.palette.muted);
    page.line(ui, head, today);
    for (text, count) in rows {
        let (row, below) = above(rest, high, 0.0);
        rest = below;
        let line = egui::Stroke::new(1.0, look.palette.edge);
        ui.painter().hline(row.x_range(), row.top(), line);
        let (name, figure) = row.split_left_right_at_fraction(0.72);
        let label = LargeText::new(look.tr(text), 30.0, look.palette.text);
        page.line(ui, name, label);
        let count = count.to_string();
        let label = Label::new(&count, look.palette.text).font(page.font(34.0));
        label.right().named(look.tr(text)).put(ui, figure);
    }
    if let Some(trouble) = page.exhibit.report.troubles().last() {
        let words = notices::notice(look, trouble);
        page.lines(ui, rest, LargeText::new(&words, 20.0, look.palette.bad));
    }
}
