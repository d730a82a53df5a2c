//! One card over the body of the window: what is asked or under way, and what can be done about it. Nothing below it can be
//! reached, by pointer or keyboard; STOP stays. Knows no card's meaning and carries nothing out.

use crate::app::action::Action;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight};
use crate::ui::kit::look::Look;
use crate::ui::text::{Text, cards};
use crate::ui::theme;
use egui::{
    Align, Area, Frame, Id, Key, Layout, Order, ProgressBar, Rect, Role, ScrollArea, Sense, Stroke,
    Ui, UiBuilder, WidgetInfo, vec2,
};

/// What pressing a button of a card means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Manner {
    /// Nothing is changed by it. It has the keyboard first, and Esc does the same after it stopped the hand.
    Safe,
    /// One of several things to do.
    Plain,
    /// The thing to do.
    Main,
    /// It cannot simply be taken back: only a pointer or a screen reader presses it, never Enter.
    Danger,
}

/// One button of a card. Pressing it closes nothing by itself: the card is there for as long as what it is about.
#[derive(Debug, Clone)]
pub(crate) struct Choice {
    text: Text,
    manner: Manner,
    disabled: Option<String>,
    does: Vec<Action>,
}

impl Choice {
    /// A button that asks for nothing yet.
    pub(crate) const fn new(text: Text, manner: Manner) -> Self {
        Self {
            text,
            manner,
            disabled: None,
            does: Vec::new(),
        }
    }

    /// The usual way out.
    pub(crate) const fn cancel() -> Self {
        Self::new(cards::CANCEL, Manner::Safe)
    }

    /// Asks for this too.
    pub(crate) fn does(mut self, action: Action) -> Self {
        self.does.push(action);
        self
    }

    /// Cannot be pressed, for this reason.
    pub(crate) fn disabled(mut self, reason: Option<String>) -> Self {
        self.disabled = reason;
        self
    }
}

/// One line of a card.
#[derive(Debug, Clone)]
pub(crate) enum Line {
    /// A sentence.
    Words(String),
    /// A sentence that matters less.
    Note(String),
    /// A sentence that matters more.
    Warning(String),
    /// Something that must be so, and whether it is; `None` = not known.
    Check(Option<bool>, String),
    /// What the columns of a table hold.
    Head(Vec<String>),
    /// Cells of a table, the first one wide.
    Cells(Vec<String>),
}

/// How far something is.
#[derive(Debug, Clone)]
pub(crate) struct Progress {
    /// From 0 to 1.
    pub(crate) part: f32,
    /// What is going on, or what is left.
    pub(crate) words: String,
}

/// What a card says and offers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Card {
    /// What it is about.
    pub(crate) title: String,
    /// What should be known.
    pub(crate) lines: Vec<Line>,
    /// How far it is.
    pub(crate) progress: Option<Progress>,
    /// A word that has to be typed before anything dangerous can be pressed.
    pub(crate) word: Option<&'static str>,
    /// The buttons, the safe one first.
    pub(crate) choices: Vec<Choice>,
}

/// What the window remembers of its card.
#[derive(Debug, Default)]
pub(crate) struct CardView {
    typed: String,
    /// The title and the buttons of the card that is shown: another one begins anew.
    shown: Option<(String, usize)>,
    /// Height of the card as it was drawn last, and of all of it but its lines.
    height: f32,
    chrome: f32,
}

impl CardView {
    /// Draws the card, if there is one, over `shade`; what the person asked for in it.
    pub(crate) fn ui(
        &mut self,
        ui: &Ui,
        shade: Rect,
        look: Look,
        card: Option<Card>,
    ) -> Vec<Action> {
        let Some(card) = card else {
            self.shown = None;
            return Vec::new();
        };
        let key = (card.title.clone(), card.choices.len());
        let is_new = self.shown.as_ref() != Some(&key);
        if is_new {
            self.shown = Some(key);
            self.typed.clear();
            egui::Popup::close_all(ui.ctx());
        }
        let area = Area::new(Id::unique("card"))
            .order(Order::Foreground)
            .fixed_pos(shade.min)
            .constrain(false);
        let shown = area.show(ui.ctx(), |ui| {
            // Takes every press beside the card, too.
            ui.allocate_rect(shade, Sense::click_and_drag());
            let veil = look.palette.window.gamma_multiply(0.75);
            ui.painter().rect_filled(shade, 0.0, veil);
            self.placed_ui(ui, shade.shrink(theme::PAD), look, (&card, is_new))
        });
        if is_new {
            ui.ctx().move_to_top(shown.response.layer_id);
        }
        let pressed = shown.inner.and_then(|index| card.choices.get(index));
        pressed.map_or_else(Vec::new, |choice| choice.does.clone())
    }

    /// The card in the middle of a place, as high as it was last; the button that was pressed.
    fn placed_ui(
        &mut self,
        ui: &mut Ui,
        place: Rect,
        look: Look,
        card: (&Card, bool),
    ) -> Option<usize> {
        let width = 560.0_f32.min(place.width());
        let high = vec2(width, self.height.min(place.height()));
        let corner = Rect::from_center_size(place.center(), high).min;
        let room = Rect::from_min_size(corner, vec2(width, place.height()));
        let palette = look.palette;
        let frame = Frame::new()
            .fill(palette.card)
            .stroke(Stroke::new(theme::LINE, palette.accent))
            .corner_radius(theme::ROUND)
            .inner_margin(20.0);
        let builder = UiBuilder::new().max_rect(room);
        let shown = ui.scope_builder(builder, |ui| {
            frame.show(ui, |ui| {
                ui.set_width(ui.available_width());
                ui.spacing_mut().item_spacing.y = theme::GAP;
                self.card_ui(ui, place.height() - self.chrome, look, card)
            })
        });
        let (pressed, lines) = shown.inner.inner;
        let response = shown.response;
        response.widget_info(|| WidgetInfo::labeled(Role::AlertDialog, true, &card.0.title));
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_modal());
        let height = response.rect.height();
        if (self.height, self.chrome) != (height, height - lines) {
            (self.height, self.chrome) = (height, height - lines);
            ui.ctx()
                .request_discard("the card is as high as what it says");
        }
        pressed
    }

    /// What is in a card; the button that was pressed, and the height that its lines have.
    fn card_ui(
        &mut self,
        ui: &mut Ui,
        most: f32,
        look: Look,
        (card, is_new): (&Card, bool),
    ) -> (Option<usize>, f32) {
        let palette = look.palette;
        let title = Label::new(&card.title, palette.text).font(theme::large());
        title.wrap().ui(ui);
        let lines = ScrollArea::vertical().max_height(most).show(ui, |ui| {
            for line in &card.lines {
                line_ui(ui, look, line);
            }
        });
        if let Some(progress) = &card.progress {
            Label::new(&progress.words, palette.muted).ui(ui);
            let bar = ProgressBar::new(progress.part).fill(palette.accent);
            ui.add(bar.desired_height(6.0));
        }
        if let Some(word) = card.word {
            let ask = format!("{} {word}", look.say(cards::TYPE));
            ui.horizontal(|ui| {
                Label::new(&ask, palette.text).ui(ui);
                let field = controls::edit_ui(ui, &ask, "", &mut self.typed);
                if is_new {
                    field.request_focus();
                }
            });
        }
        let row = ui.horizontal(|ui| {
            let right = Layout::right_to_left(Align::Center);
            ui.with_layout(right, |ui| self.choices_ui(ui, look, card, is_new))
        });
        (row.inner.inner, lines.inner_rect.height())
    }

    /// The buttons. The keyboard goes to the field, else to what is safe, so that Enter does no harm.
    fn choices_ui(&self, ui: &mut Ui, look: Look, card: &Card, is_new: bool) -> Option<usize> {
        let (escaped, entered) = ui.input(|input| {
            (
                input.key_pressed(Key::Escape),
                input.key_pressed(Key::Enter),
            )
        });
        let mut pressed = None;
        let untyped = card.word.filter(|word| self.typed.trim() != *word);
        let untyped = untyped.map(|word| format!("{} {word}", look.say(cards::TYPE)));
        for (index, choice) in card.choices.iter().enumerate().rev() {
            let is_danger = choice.manner == Manner::Danger;
            let reason = choice.disabled.clone();
            let reason = reason.or_else(|| untyped.clone().filter(|_| is_danger));
            let button = Button::said(look, choice.text)
                .weight(weight(choice.manner))
                .disabled(reason.as_deref())
                .large()
                .ui(ui, look);
            if button.clicked() && !(is_danger && entered) {
                pressed = Some(index);
            }
            let is_safe = choice.manner == Manner::Safe;
            if is_new && is_safe && card.word.is_none() {
                button.request_focus();
            }
            if is_safe && escaped {
                pressed = pressed.or(Some(index));
            }
        }
        pressed
    }
}

const fn weight(manner: Manner) -> Weight {
    match manner {
        Manner::Safe | Manner::Plain => Weight::Normal,
        Manner::Main => Weight::Strong,
        Manner::Danger => Weight::Danger,
    }
}

fn line_ui(ui: &mut Ui, look: Look, line: &Line) {
    let palette = look.palette;
    let words = |ui: &mut Ui, text: &str, color| {
        Label::new(text, color).wrap().ui(ui);
    };
    match line {
        Line::Words(text) => words(ui, text, palette.text),
        Line::Note(text) => words(ui, text, palette.muted),
        Line::Warning(text) => signed_ui(ui, |ui, sign| {
            controls::warning_sign(ui, sign, palette.warn);
            words(ui, text, palette.warn);
        }),
        Line::Check(known, text) => signed_ui(ui, |ui, sign| {
            let (lamp, color) = match known {
                Some(true) => (palette.ok, palette.muted),
                Some(false) => (palette.bad, palette.text),
                None => (palette.faint, palette.text),
            };
            controls::lamp(ui, sign.center(), lamp);
            words(ui, text, color);
        }),
        Line::Head(cells) => cells_ui(ui, cells, |text, _| Label::new(text, palette.muted).small()),
        Line::Cells(cells) => cells_ui(ui, cells, |text, first| match first {
            Some(first) => Label::new(text, palette.text).number().named(first),
            None => Label::new(text, palette.muted),
        }),
    }
}

/// A line with a sign before it.
fn signed_ui(ui: &mut Ui, line: impl FnOnce(&mut Ui, Rect)) {
    ui.horizontal_top(|ui| {
        let (_, sign) = ui.allocate_space(vec2(theme::SIGN, theme::SIGN));
        line(ui, sign);
    });
}

/// Cells in columns of one width, the numbers against the right edge; `label` gets a cell and, but for the first, the
/// first one.
fn cells_ui<'a>(
    ui: &mut Ui,
    cells: &'a [String],
    label: impl Fn(&'a str, Option<&'a str>) -> Label<'a>,
) {
    ui.columns(cells.len(), |columns| {
        let first = cells.first().map(String::as_str);
        for (index, (ui, text)) in columns.iter_mut().zip(cells).enumerate() {
            let (align, name) = match index {
                0 => (Align::Min, None),
                _ => (Align::Max, first),
            };
            ui.with_layout(Layout::top_down(align), |ui| label(text, name).ui(ui));
        }
    });
}
