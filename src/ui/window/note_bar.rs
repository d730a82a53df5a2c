//! The line in which a person notes what happens: opened by one key, kept at the moment of that key. Stops nothing.

use crate::app::action::Action;
use crate::hand::Moment;
use crate::history::NOTE_MAX;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right};
use crate::ui::kit::look::Pane;
use crate::ui::plots::times::clock;
use crate::ui::text::plots;
use crate::ui::theme;
use egui::{
    CornerRadius, Frame, Id, Key, Rect, Role, Stroke, StrokeKind, TextEdit, Ui, UiBuilder,
    WidgetInfo, vec2,
};

/// A note that is being written.
#[derive(Debug, Default)]
pub(crate) struct NoteBar {
    /// When its key was pressed; `None` while there is none.
    at: Option<Moment>,
    text: String,
    fresh: bool,
}

impl NoteBar {
    /// Opens it for a note of this moment; one that is being written stays.
    pub(crate) fn open(&mut self, at: Moment) {
        if self.at.is_none() {
            *self = Self {
                at: Some(at),
                text: String::new(),
                fresh: true,
            };
        }
    }

    /// True while a note is being written.
    pub(crate) const fn is_open(&self) -> bool {
        self.at.is_some()
    }

    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let Some(at) = self.at else { return };
        let look = pane.look;
        let palette = look.palette;
        let ground = rect
            .shrink2(vec2(theme::GAP, 0.0))
            .with_min_y(rect.top() + theme::GAP);
        ui.painter().rect(
            ground,
            CornerRadius::same(theme::ROUND),
            palette.card,
            Stroke::new(1.0, palette.accent),
            StrokeKind::Inside,
        );
        let mut rest = controls::middle(ground, theme::CONTROL).shrink2(vec2(theme::PAD, 0.0));
        let title = format!("{} {}", look.say(plots::NOTE_AT), clock(at.secs(), 0.01));
        let width = controls::text_width(ui, &title, theme::title()) + 1.0;
        Label::new(&title, palette.text)
            .font(theme::title())
            .put(ui, take_left(&mut rest, width));
        let mut button = |text, tip, id: &str, weight| {
            let text = look.say(text);
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let button = Button::new(text, look.say(tip)).weight(weight);
            let place = take_right(&mut rest, width);
            button.put(ui, look, place, Id::unique(id)).clicked()
        };
        let cancelled = button(
            plots::NOTE_CANCEL,
            plots::NOTE_CANCEL_TIP,
            "note cancel",
            Weight::Normal,
        );
        let kept = button(
            plots::NOTE_KEEP,
            plots::NOTE_KEEP_TIP,
            "note keep",
            Weight::Strong,
        );
        let hint = look.say(plots::NOTE_HINT);
        let width = controls::text_width(ui, hint, theme::small()) + 1.0;
        if rest.width() - width > 200.0 {
            Label::new(hint, palette.muted)
                .small()
                .put(ui, take_right(&mut rest, width));
        }
        let entered = self.field_ui(ui, rest, pane);
        if kept || entered {
            let words = std::mem::take(&mut self.text);
            pane.actions.push(Action::Note(at, words));
        }
        if kept || entered || cancelled {
            *self = Self::default();
        }
    }

    /// The field; true if Enter was pressed in it.
    fn field_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) -> bool {
        let palette = pane.look.palette;
        let frame = Frame::new()
            .fill(palette.sunken)
            .stroke(Stroke::new(1.0, palette.edge))
            .corner_radius(theme::ROUND_SMALL)
            .inner_margin(theme::NUMBER_INSET);
        let edit = TextEdit::singleline(&mut self.text)
            .id(Id::unique("note field"))
            .char_limit(NOTE_MAX)
            .frame(frame)
            .min_size(rect.size())
            .align(egui::Align2::LEFT_CENTER)
            .desired_width(rect.width() - theme::FIELD_MARGIN_SMALL);
        let place = UiBuilder::new().max_rect(rect);
        let response = ui.scope_builder(place, |ui| ui.add(edit)).inner;
        let text = self.text.clone();
        response.widget_info(|| {
            let name = pane.look.say(plots::NOTE_FIELD);
            let mut info = WidgetInfo::labeled(Role::TextInput, true, name);
            info.current_text_value = Some(text.clone());
            info
        });
        if std::mem::take(&mut self.fresh) {
            response.request_focus();
        }
        response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
    }
}
