//! Texts and buttons readable from two metres: as large as the screen allows.

use crate::app::exhibit::ExhibitState;
use crate::ui::exhibit::places::PagePlaces;
use crate::ui::kit::{self, Label, Look, Weight};
use crate::ui::theme::{self, Icon};
use egui::{
    Align2, Color32, FontId, Id, Rect, Role, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, vec2,
};

/// Minimum font size in points.
const FONT_LEAST: f32 = 14.0;
/// A text that does not fit shrinks to no less than this share of its size; beyond that it is truncated.
const SHRINK_TO: f32 = 0.6;

/// Size of the note below a button's text, in units.
const NOTE: f32 = 28.0;
/// Line height as a multiple of the font size.
const LINE: f32 = 1.22;

/// One frame of the exhibition page: appearance, layout, and the state to show.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Page<'a> {
    /// Colours and language.
    pub(crate) look: Look,
    pub(crate) places: PagePlaces,
    pub(crate) exhibit: &'a ExhibitState,
}

/// A coloured text, with its size in units of the page.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LargeText<'a> {
    words: &'a str,
    size: f32,
    color: Color32,
}

impl<'a> LargeText<'a> {
    pub(crate) const fn new(words: &'a str, size: f32, color: Color32) -> Self {
        Self { words, size, color }
    }
}

impl Page<'_> {
    /// Font of this size in units.
    pub(crate) fn font(self, size: f32) -> FontId {
        FontId::proportional((size * self.places.unit).max(FONT_LEAST))
    }

    /// Largest font up to this size in which a text fits.
    fn fit(self, ui: &Ui, text: &str, size: f32, width: f32) -> FontId {
        let font = self.font(size);
        let wide = kit::text_width(ui, text, font.clone());
        // Slightly smaller, because widths are rounded.
        let part = ((width - 1.0) / wide.max(1.0)).clamp(SHRINK_TO, 1.0);
        FontId::proportional((font.size * part).max(FONT_LEAST))
    }

    /// Paints a text on one line.
    pub(crate) fn paint(self, ui: &Ui, rect: Rect, text: LargeText<'_>) {
        let font = self.fit(ui, text.words, text.size, rect.width());
        let label = Label::new(text.words, text.color).font(font);
        label.center().paint(ui, rect);
    }

    /// Draws a left-aligned text on one line.
    pub(crate) fn line(self, ui: &mut Ui, rect: Rect, text: LargeText<'_>) {
        let font = self.fit(ui, text.words, text.size, rect.width());
        Label::new(text.words, text.color).font(font).put(ui, rect);
    }

    /// Draws a text from the top, on as many lines as it needs.
    pub(crate) fn lines(self, ui: &mut Ui, rect: Rect, text: LargeText<'_>) {
        let builder = UiBuilder::new().max_rect(rect);
        ui.scope_builder(builder, |ui| {
            let label = Label::new(text.words, text.color).font(self.font(text.size));
            label.wrap().ui(ui);
        });
    }

    /// Paints the background of a part of the page.
    pub(crate) fn card(self, ui: &Ui, rect: Rect) {
        let palette = self.look.palette;
        let edge = Stroke::new(1.0, palette.edge);
        let round = 16.0 * self.places.unit;
        ui.painter()
            .rect(rect, round, palette.card, edge, StrokeKind::Inside);
    }
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct LargeButton<'a> {
    /// Text.
    pub(crate) words: &'a str,
    /// Note below it in smaller letters.
    pub(crate) note: &'a str,
    /// An icon in place of the text, which stays the accessible name.
    pub(crate) icon: Option<Icon>,
    /// Font size of the text in units.
    pub(crate) size: f32,
    pub(crate) weight: Weight,
    /// Reason why it is disabled now.
    pub(crate) disabled: Option<&'a str>,
}

impl<'a> LargeButton<'a> {
    /// An ordinary button.
    pub(crate) const fn new(words: &'a str) -> Self {
        Self {
            words,
            note: "",
            icon: None,
            size: 32.0,
            weight: Weight::Normal,
            disabled: None,
        }
    }

    /// Draws it; true in the frame in which it is pressed.
    pub(crate) fn ui(self, ui: &Ui, page: Page<'_>, rect: Rect) -> bool {
        let enabled = self.disabled.is_none() && ui.is_enabled();
        let id = Id::unique(("large", self.words));
        let response = ui.interact(rect, id, kit::click_if(enabled));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, self.words));
        if let Some(reason) = self.disabled {
            ui.ctx()
                .accesskit_node_builder(response.id, |node| node.set_description(reason));
        }
        let (fill, edge, color) = self.colors(page.look, response.is_pointer_button_down_on());
        let round = 12.0 * page.places.unit;
        let edge = Stroke::new((2.0 * page.places.unit).max(1.0), edge);
        ui.painter()
            .rect(rect, round, fill, edge, StrokeKind::Inside);
        let inner = rect.shrink(8.0 * page.places.unit);
        match (self.icon, self.note) {
            (Some(icon), _) => {
                let font = theme::icon_high(self.size * page.places.unit);
                let center = Align2::CENTER_CENTER;
                ui.painter().text(rect.center(), center, icon, font, color);
            }
            (None, "") => page.paint(ui, inner, LargeText::new(self.words, self.size, color)),
            (None, note) => {
                // Text and note together, centred.
                let [upper, lower] = [self.size, NOTE].map(|size| page.font(size).size * LINE);
                let size = vec2(inner.width(), (upper + lower).min(inner.height()));
                let both = Rect::from_center_size(inner.center(), size);
                let (upper, lower) = both.split_top_bottom_at_fraction(upper / (upper + lower));
                page.paint(ui, upper, LargeText::new(self.words, self.size, color));
                page.paint(ui, lower, LargeText::new(note, NOTE, color));
            }
        }
        self.disabled.is_none() && kit::pressed(ui, &response)
    }

    /// Colours of background, edge and text.
    fn colors(self, look: Look, is_down: bool) -> (Color32, Color32, Color32) {
        let palette = look.palette;
        let ground = if is_down {
            palette.control_hover
        } else {
            palette.control
        };
        if self.disabled.is_some() {
            return (palette.card, palette.edge, palette.faint);
        }
        match self.weight {
            Weight::Stop if is_down => (palette.stop_hover, palette.stop_edge, palette.on_strong),
            Weight::Stop => (palette.stop, palette.stop_edge, palette.on_strong),
            Weight::Strong => (palette.accent, palette.accent, palette.on_accent),
            Weight::Armed => (palette.armed, palette.armed, palette.on_armed),
            Weight::Quiet => (Color32::TRANSPARENT, Color32::TRANSPARENT, palette.muted),
            Weight::Danger => (ground, palette.bad, palette.bad),
            Weight::Normal | Weight::Chosen => (ground, palette.edge, palette.text),
        }
    }
}
