//! Keypad for entering a PIN. It never shows the digits.

use crate::exhibit::pin::DIGITS;
use crate::ui::exhibit::large::{LargeButton, Page};
use crate::ui::kit::Weight;
use crate::ui::text::exhibit;
use crate::ui::theme;
use egui::{Key, Rect, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

/// Digits as on a telephone; the last row has the other keys beside its own.
const ROWS: [[char; 3]; 3] = [['1', '2', '3'], ['4', '5', '6'], ['7', '8', '9']];

/// Digits typed so far.
#[derive(Debug, Default)]
pub(crate) struct Keypad {
    typed: String,
}

impl Keypad {
    /// Clears the digits.
    pub(crate) fn clear(&mut self) {
        self.typed.clear();
    }

    /// Handles a key of a real keyboard. Returns the PIN on Enter.
    pub(crate) fn key(&mut self, key: Key) -> Option<String> {
        match key {
            Key::Backspace => self.typed.truncate(self.typed.len().saturating_sub(1)),
            Key::Enter => return self.enter(),
            key => {
                let mut name = key.name().chars();
                if let (Some(digit @ '0'..='9'), None) = (name.next(), name.next()) {
                    self.digit(digit);
                }
            }
        }
        None
    }

    fn digit(&mut self, digit: char) {
        if self.typed.len() < *DIGITS.end() {
            self.typed.push(digit);
        }
    }

    fn enter(&mut self) -> Option<String> {
        (self.typed.len() >= *DIGITS.start()).then(|| std::mem::take(&mut self.typed))
    }

    /// Draws dots for the digits typed, and the keys. Returns the PIN once it is entered.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        page: Page<'_>,
        rect: Rect,
        locked: Option<&str>,
    ) -> Option<String> {
        let (dots, keys) = rect.split_top_bottom_at_y(rect.top() + rect.height() / 5.0);
        self.dots_ui(ui, page, dots);
        let gap = 14.0 * page.places.unit;
        let size = (keys.size() + Vec2::splat(gap)) / vec2(3.0, 4.0) - Vec2::splat(gap);
        let place = |column: u8, row: u8| {
            let step = vec2(column.into(), row.into()) * (size + Vec2::splat(gap));
            Rect::from_min_size(keys.min + step, size)
        };
        for (row, digits) in (0_u8..).zip(ROWS) {
            for (column, digit) in (0_u8..).zip(digits) {
                self.digit_ui(ui, page, place(column, row), digit);
            }
        }
        let delete = LargeButton {
            icon: Some(theme::BACKSPACE),
            size: 40.0,
            ..LargeButton::new(page.look.tr(exhibit::PIN_DELETE))
        };
        if delete.ui(ui, page, place(0, 3)) {
            self.key(Key::Backspace);
        }
        self.digit_ui(ui, page, place(1, 3), '0');
        let short = self.typed.len() < *DIGITS.start();
        let short = short.then(|| page.look.tr(exhibit::PIN_CHOOSE));
        let enter = LargeButton {
            weight: Weight::Strong,
            disabled: locked.or(short),
            ..LargeButton::new(page.look.tr(exhibit::PIN_ENTER))
        };
        enter.ui(ui, page, place(2, 3)).then(|| self.enter())?
    }

    fn digit_ui(&mut self, ui: &Ui, page: Page<'_>, place: Rect, digit: char) {
        let mut bytes = [0; 4];
        let words: &str = digit.encode_utf8(&mut bytes);
        let button = LargeButton {
            size: 44.0,
            ..LargeButton::new(words)
        };
        if button.ui(ui, page, place) {
            self.digit(digit);
        }
    }

    /// Draws a dot for each digit, and placeholders up to the minimum length of a PIN.
    fn dots_ui(&self, ui: &mut Ui, page: Page<'_>, rect: Rect) {
        let (palette, unit) = (page.look.palette, page.places.unit);
        let response = ui.allocate_rect(rect, Sense::hover());
        let count = u8::try_from(self.typed.len()).unwrap_or(u8::MAX);
        response.widget_info(|| {
            let text = page.look.tr_with(exhibit::PIN_TYPED, count);
            WidgetInfo::labeled(Role::Label, true, text)
        });
        let places = count.max(4);
        let step = 48.0 * unit;
        let left = rect.center().x - step * (f32::from(places) - 1.0) / 2.0;
        for index in 0..places {
            let center = pos2(left + step * f32::from(index), rect.center().y);
            let painter = ui.painter();
            if index < count {
                painter.circle_filled(center, 13.0 * unit, palette.text)
            } else {
                let ring = egui::Stroke::new((3.0 * unit).max(1.5), palette.faint);
                painter.circle_stroke(center, 12.0 * unit, ring)
            };
        }
    }
}
