//! One modal card over the body of the window: a question or a running job, with its actions. It blocks everything below it
//! for pointer and keyboard; STOP stays usable. Independent of the cards' meaning; executes nothing.

use crate::app::action::Action;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight};
use crate::ui::style::Look;
use crate::ui::text::{Text, cards};
use crate::ui::theme;
use egui::{
    Align, Area, Frame, Id, Key, Layout, Order, ProgressBar, Rect, Role, ScrollArea, Sense, Stroke,
    Ui, UiBuilder, WidgetInfo, vec2,
};
use std::fmt::Display;

/// Effect of a card's button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ButtonRole {
    /// Changes nothing. It has the initial focus, and Esc activates it after stopping the hand; where it is the only button of
    /// the card and the hand is at rest, without a stop.
    Safe,
    /// One of several options.
    Plain,
    /// The main action.
    Main,
    /// Cannot simply be undone: only a pointer or a screen reader presses it, never Enter.
    Danger,
}

/// One button of a card. Pressing it does not close the card, which is shown for as long as its cause lasts.
#[derive(Debug, Clone)]
pub(crate) struct CardButton {
    text: Text,
    role: ButtonRole,
    disabled: Option<Text>,
    does: Action,
}

impl CardButton {
    /// A button that requests an action.
    pub(crate) const fn new(text: Text, role: ButtonRole, does: Action) -> Self {
        Self {
            text,
            role,
            disabled: None,
            does,
        }
    }

    /// Disabled for this reason, which overrides an earlier one.
    pub(crate) fn disabled(mut self, reason: Option<Text>) -> Self {
        self.disabled = reason.or(self.disabled);
        self
    }
}

/// One line of a card.
#[derive(Debug, Clone)]
enum CardLine {
    /// A sentence.
    Words(String),
    /// A less important sentence.
    Note(String),
    /// A warning.
    Warning(String),
    /// A precondition, and whether it is met; `None` = not known.
    Check(Option<bool>, String),
    /// Column headings of a table.
    Head(Vec<String>),
    /// Cells of a table, the first one wide.
    Cells(Vec<String>),
}

/// Text of a card: a translated sentence, or a composed string.
pub(crate) trait IntoText {
    /// Text in the window's language.
    fn into_text(self, look: Look) -> String;
}

impl IntoText for Text {
    fn into_text(self, look: Look) -> String {
        look.tr(self).to_owned()
    }
}

impl IntoText for String {
    fn into_text(self, _look: Look) -> String {
        self
    }
}

impl<D: Display> IntoText for (Text, D) {
    fn into_text(self, look: Look) -> String {
        format!("{} {}", look.tr(self.0), self.1)
    }
}

/// Content and buttons of a card.
#[derive(Debug, Clone)]
pub(crate) struct Card {
    look: Look,
    title: String,
    lines: Vec<CardLine>,
    /// Progress from 0 to 1, with the current step or the time left.
    progress: Option<(f32, String)>,
    /// A word that must be typed before any dangerous button is enabled.
    word: Option<&'static str>,
    /// The buttons, the safe one first.
    choices: Vec<CardButton>,
}

impl Card {
    /// An empty card.
    pub(crate) fn new(look: Look, title: impl IntoText) -> Self {
        Self {
            look,
            title: title.into_text(look),
            lines: Vec::new(),
            progress: None,
            word: None,
            choices: Vec::new(),
        }
    }

    /// Adds a sentence.
    pub(crate) fn words(self, text: impl IntoText) -> Self {
        let line = CardLine::Words(text.into_text(self.look));
        self.line(line)
    }

    /// Adds a less important sentence.
    pub(crate) fn note(self, text: impl IntoText) -> Self {
        let line = CardLine::Note(text.into_text(self.look));
        self.line(line)
    }

    /// Adds a warning.
    pub(crate) fn warning(self, text: impl IntoText) -> Self {
        let line = CardLine::Warning(text.into_text(self.look));
        self.line(line)
    }

    /// Adds a precondition; `None` = not known.
    pub(crate) fn check(self, is_so: Option<bool>, text: Text) -> Self {
        let line = CardLine::Check(is_so, text.into_text(self.look));
        self.line(line)
    }

    /// Adds the column headings of a table.
    pub(crate) fn head(self, columns: impl IntoIterator<Item = Text>) -> Self {
        let columns = columns.into_iter().map(|text| text.into_text(self.look));
        let head = CardLine::Head(columns.collect());
        self.line(head)
    }

    /// Adds a table row: its label, then its cells.
    pub(crate) fn row(self, of: impl IntoText, cells: impl IntoIterator<Item = String>) -> Self {
        let of = [of.into_text(self.look)].into_iter();
        self.line(CardLine::Cells(of.chain(cells).collect()))
    }

    fn line(mut self, line: CardLine) -> Self {
        self.lines.push(line);
        self
    }

    /// Sets the progress from 0 to 1, with the current step or the time left.
    pub(crate) fn progress(mut self, part: f32, text: impl IntoText) -> Self {
        self.progress = Some((part, text.into_text(self.look)));
        self
    }

    /// Requires a word to be typed before any dangerous button is enabled.
    pub(crate) fn typed(mut self, word: &'static str) -> Self {
        self.word = Some(word);
        self
    }

    /// Adds a button, the safe one first.
    pub(crate) fn choice(mut self, choice: CardButton) -> Self {
        self.choices.push(choice);
        self
    }
}

/// View state of the card.
#[derive(Debug, Default)]
pub(crate) struct CardView {
    typed: String,
    /// The card only informs: all its buttons are safe.
    informs: bool,
    /// Title and number of buttons of the card shown; a different card resets the view state.
    shown: Option<(String, usize)>,
    /// Heights of the last drawn card: the whole, and all except its lines.
    height: f32,
    chrome: f32,
}

impl CardView {
    /// True while the card shown only informs.
    pub(crate) const fn informs(&self) -> bool {
        self.informs
    }

    /// Draws the card, if any, over `shade`. Returns the action of the button pressed.
    pub(crate) fn ui(&mut self, ui: &Ui, shade: Rect, card: Option<Card>) -> Option<Action> {
        let Some(card) = card else {
            self.shown = None;
            self.informs = false;
            return None;
        };
        let key = (card.title.clone(), card.choices.len());
        let mut choices = card.choices.iter();
        self.informs =
            !card.choices.is_empty() && choices.all(|choice| choice.role == ButtonRole::Safe);
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
            // Consumes presses beside the card, too.
            ui.allocate_rect(shade, Sense::click_and_drag());
            let veil = card.look.palette.window.gamma_multiply(0.75);
            ui.painter().rect_filled(shade, 0.0, veil);
            self.placed_ui(ui, shade.shrink(theme::PAD), &card, is_new)
        });
        if is_new {
            ui.ctx().move_to_top(shown.response.layer_id);
        }
        let pressed = card.choices.get(shown.inner?);
        pressed.map(|choice| choice.does.clone())
    }

    /// Draws the card in the middle of `place`, with its last height. Returns the index of the button pressed.
    fn placed_ui(&mut self, ui: &mut Ui, place: Rect, card: &Card, is_new: bool) -> Option<usize> {
        let width = 560.0_f32.min(place.width());
        let high = vec2(width, self.height.min(place.height()));
        let corner = Rect::from_center_size(place.center(), high).min;
        let room = Rect::from_min_size(corner, vec2(width, place.height()));
        let palette = card.look.palette;
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
                self.card_ui(ui, place.height() - self.chrome, card, is_new)
            })
        });
        let (pressed, lines) = shown.inner.inner;
        let response = shown.response;
        response.widget_info(|| WidgetInfo::labeled(Role::AlertDialog, true, &card.title));
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

    /// Draws the content of a card. Returns the index of the button pressed, and the height of its lines.
    fn card_ui(
        &mut self,
        ui: &mut Ui,
        most: f32,
        card: &Card,
        is_new: bool,
    ) -> (Option<usize>, f32) {
        let (look, palette) = (card.look, card.look.palette);
        let title = Label::new(&card.title, palette.text);
        title.large().wrap().ui(ui);
        let lines = ScrollArea::vertical().max_height(most).show(ui, |ui| {
            for line in &card.lines {
                line_ui(ui, look, line);
            }
        });
        if let Some((part, words)) = &card.progress {
            Label::new(words, palette.muted).ui(ui);
            let bar = ProgressBar::new(*part).fill(palette.accent);
            ui.add(bar.desired_height(6.0));
        }
        if let Some(word) = card.word {
            let ask = look.tr_with(cards::TYPE, word);
            ui.horizontal(|ui| {
                Label::new(&ask, palette.text).ui(ui);
                let field = controls::edit_ui(ui, &ask, "", &mut self.typed);
                if is_new {
                    field.request_focus();
                }
            });
        }
        let row =
            ui.horizontal(|ui| controls::right_ui(ui, |ui| self.choices_ui(ui, card, is_new)));
        (row.inner, lines.inner_rect.height())
    }

    /// Draws the buttons. The focus goes to the word field, else to the safe button, so that Enter does no harm.
    fn choices_ui(&self, ui: &mut Ui, card: &Card, is_new: bool) -> Option<usize> {
        let look = card.look;
        let is_pressed = |key| ui.input(|input| input.key_pressed(key));
        let (escaped, entered) = (is_pressed(Key::Escape), is_pressed(Key::Enter));
        let mut pressed = None;
        let untyped = card.word.filter(|word| self.typed.trim() != *word);
        let untyped = untyped.map(|word| look.tr_with(cards::TYPE, word));
        for (index, choice) in card.choices.iter().enumerate().rev() {
            let is_danger = choice.role == ButtonRole::Danger;
            let reason = choice.disabled.map(|reason| look.tr(reason).to_owned());
            let reason = reason.or_else(|| untyped.clone().filter(|_| is_danger));
            let button = Button::text(look, choice.text)
                .weight(weight(choice.role))
                .disabled(reason.as_deref())
                .large()
                .ui(ui, look);
            if button.clicked() && !(is_danger && entered) {
                pressed = Some(index);
            }
            let is_safe = choice.role == ButtonRole::Safe;
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

const fn weight(role: ButtonRole) -> Weight {
    match role {
        ButtonRole::Safe | ButtonRole::Plain => Weight::Normal,
        ButtonRole::Main => Weight::Strong,
        ButtonRole::Danger => Weight::Danger,
    }
}

fn line_ui(ui: &mut Ui, look: Look, line: &CardLine) {
    let palette = look.palette;
    let words = |ui: &mut Ui, text: &str, color| {
        Label::new(text, color).wrap().ui(ui);
    };
    match line {
        CardLine::Words(text) => words(ui, text, palette.text),
        CardLine::Note(text) => words(ui, text, palette.muted),
        CardLine::Warning(text) => drop(ui.horizontal_top(|ui| {
            controls::warning_ui(ui, palette.warn);
            words(ui, text, palette.warn);
        })),
        CardLine::Check(known, text) => drop(ui.horizontal_top(|ui| {
            let (lamp, color) = match known {
                Some(true) => (palette.ok, palette.muted),
                Some(false) => (palette.bad, palette.text),
                None => (palette.faint, palette.text),
            };
            controls::lamp_ui(ui, Some(lamp));
            words(ui, text, color);
        })),
        CardLine::Head(cells) => {
            cells_ui(ui, cells, |text, _| Label::new(text, palette.muted).small())
        }
        CardLine::Cells(cells) => cells_ui(ui, cells, |text, first| match first {
            Some(first) => Label::new(text, palette.text).number().named(first),
            None => Label::new(text, palette.muted),
        }),
    }
}

/// Draws cells in columns of equal width, the numbers right-aligned. `label` receives a cell and, except for the first, the
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
