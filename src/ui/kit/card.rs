//! One card over the body of the window: what is asked or under way, and what can be done about it. Nothing below it can be
//! reached, by pointer or keyboard; STOP stays. Knows no card's meaning and carries nothing out.

use crate::app::action::Action;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::list;
use crate::ui::kit::look::Look;
use crate::ui::text::{Text, cards};
use crate::ui::theme;
use egui::{
    Area, Color32, Context, CornerRadius, Event, Frame, Id, Key, Order, Rect, Role, Sense, Stroke,
    StrokeKind, TextEdit, Ui, UiBuilder, WidgetInfo, vec2,
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
    tip: Text,
    manner: Manner,
    disabled: Option<String>,
    does: Vec<Action>,
}

impl Choice {
    /// A button that asks for nothing yet.
    pub(crate) const fn new(text: Text, tip: Text, manner: Manner) -> Self {
        Self {
            text,
            tip,
            manner,
            disabled: None,
            does: Vec::new(),
        }
    }

    /// The usual way out.
    pub(crate) const fn cancel() -> Self {
        Self::new(cards::CANCEL, cards::CANCEL_TIP, Manner::Safe)
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
}

impl CardView {
    /// Draws the card, if there is one; what the person asked for in it.
    pub(crate) fn ui(
        &mut self,
        ui: &Ui,
        place: Rect,
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
        let id = Id::unique("card");
        let area = Area::new(id)
            .order(Order::Foreground)
            .fixed_pos(place.min)
            .constrain(false);
        let shown = area.show(ui.ctx(), |ui| self.card_ui(ui, place, look, &card));
        if is_new {
            ui.ctx().move_to_top(shown.response.layer_id);
            first_focus(ui.ctx(), &card);
        }
        let pressed = shown.inner.and_then(|index| card.choices.get(index));
        pressed.map_or_else(Vec::new, |choice| choice.does.clone())
    }

    /// The button that was pressed.
    fn card_ui(&mut self, ui: &mut Ui, place: Rect, look: Look, card: &Card) -> Option<usize> {
        // Takes every press beside the card, too.
        let shade = ui.allocate_rect(place, Sense::click_and_drag());
        ui.painter().rect_filled(
            place,
            CornerRadius::ZERO,
            look.palette.window.gamma_multiply(0.55),
        );
        let title = card.title.clone();
        ui.ctx().accesskit_node_builder(shade.id, |node| {
            node.set_role(Role::AlertDialog);
            node.set_label(title);
            node.set_modal();
        });
        let (rect, lines) = rects(ui, place, look, card);
        let round = CornerRadius::same(theme::ROUND);
        ui.painter().rect_filled(rect, round, look.palette.card);
        let edge = Stroke::new(theme::LINE, look.palette.accent);
        ui.painter()
            .rect_stroke(rect, round, edge, StrokeKind::Outside);
        let mut rest = rect.shrink(theme::CARD_PAD);
        Label::new(&card.title, look.palette.text)
            .font(theme::large())
            .put(ui, take_top(&mut rest, theme::CONTROL_LARGE));
        let lines = take_top(&mut rest, lines);
        list::scroll_ui(ui, lines, "card lines", |ui, _| {
            for line in &card.lines {
                line_ui(ui, lines.width(), look, line);
            }
        });
        if let Some(progress) = &card.progress {
            progress_ui(ui, take_top(&mut rest, theme::FIGURE), look, progress);
        }
        if let Some(word) = card.word {
            self.word_ui(ui, take_top(&mut rest, theme::CONTROL_LARGE), look, word);
        }
        let buttons = rest.with_min_y(rest.bottom() - theme::CONTROL_LARGE);
        self.choices_ui(ui, buttons, look, card)
    }

    fn word_ui(&mut self, ui: &mut Ui, mut rect: Rect, look: Look, word: &str) {
        let palette = look.palette;
        let ask = format!("{} {word}", look.say(cards::TYPE));
        let width = controls::text_width(ui, &ask, theme::body()) + 1.0;
        Label::new(&ask, palette.text).put(ui, take_left(&mut rect, width));
        let is_typed = self.typed.trim() == word;
        let edge = if is_typed { palette.bad } else { palette.edge };
        let frame = Frame::new()
            .fill(palette.sunken)
            .stroke(Stroke::new(theme::LINE_THIN, edge))
            .corner_radius(theme::ROUND_SMALL)
            .inner_margin(theme::NUMBER_INSET);
        let place = controls::middle(rect, theme::CONTROL);
        let edit = TextEdit::singleline(&mut self.typed)
            .id(Id::unique("card word"))
            .char_limit(2 * word.len())
            .frame(frame)
            .min_size(place.size())
            .align(egui::Align2::LEFT_CENTER)
            .desired_width(place.width() - theme::FIELD_MARGIN_SMALL);
        let builder = UiBuilder::new().max_rect(place);
        let response = ui.scope_builder(builder, |ui| ui.add(edit)).inner;
        let text = self.typed.clone();
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::TextInput, true, &ask);
            info.current_text_value = Some(text.clone());
            info
        });
    }

    fn choices_ui(&self, ui: &mut Ui, mut row: Rect, look: Look, card: &Card) -> Option<usize> {
        let escaped = ui.input(|input| input.key_pressed(Key::Escape));
        let mut pressed = None;
        let untyped = card.word.filter(|word| self.typed.trim() != *word);
        let untyped = untyped.map(|word| format!("{} {word}", look.say(cards::TYPE)));
        for (index, choice) in card.choices.iter().enumerate().rev() {
            let is_danger = choice.manner == Manner::Danger;
            let has_keyboard = ui.memory(|memory| memory.has_focus(choice_id(index)));
            if is_danger && has_keyboard {
                ui.input_mut(|input| input.events.retain(|event| !is_enter(event)));
            }
            let reason = choice.disabled.clone();
            let reason = reason.or_else(|| untyped.clone().filter(|_| is_danger));
            let words = look.say(choice.text);
            let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::CARD_PAD;
            let place = take_right(&mut row, width.max(theme::CARD_BUTTON));
            let button = Button::new(words, look.say(choice.tip))
                .weight(weight(choice.manner))
                .disabled(reason.as_deref());
            if button.put(ui, look, place, choice_id(index)).clicked() {
                pressed = Some(index);
            }
        }
        let safe = card
            .choices
            .iter()
            .position(|choice| choice.manner == Manner::Safe);
        pressed.or_else(|| safe.filter(|_| escaped))
    }
}

fn choice_id(index: usize) -> Id {
    Id::unique(("card choice", index))
}

/// The keyboard goes to the field, else to what is safe, so that Enter does no harm.
fn first_focus(ctx: &Context, card: &Card) {
    let safe = card
        .choices
        .iter()
        .position(|choice| choice.manner == Manner::Safe);
    let id = match (card.word, safe) {
        (Some(_), _) => Some(Id::unique("card word")),
        (None, Some(index)) => Some(choice_id(index)),
        (None, None) => None,
    };
    ctx.memory_mut(|memory| match (id, memory.focused()) {
        (Some(id), _) => memory.request_focus(id),
        (None, Some(former)) => memory.surrender_focus(former),
        (None, None) => {}
    });
}

const fn is_enter(event: &Event) -> bool {
    matches!(
        event,
        Event::Key {
            key: Key::Enter,
            ..
        }
    )
}

const fn weight(manner: Manner) -> Weight {
    match manner {
        Manner::Safe | Manner::Plain => Weight::Normal,
        Manner::Main => Weight::Strong,
        Manner::Danger => Weight::Danger,
    }
}

/// Where the card stands, and the height of its lines: they scroll where the window is too low for them.
fn rects(ui: &Ui, place: Rect, look: Look, card: &Card) -> (Rect, f32) {
    let width = theme::CARD_WIDTH.min(place.width() - 2.0 * theme::PAD);
    let inner = width - 2.0 * theme::CARD_PAD;
    let lines: f32 = card
        .lines
        .iter()
        .map(|line| line_height(ui, inner, look, line))
        .sum();
    let mut other = 2.0 * theme::CARD_PAD + 2.0 * (theme::CONTROL_LARGE + theme::GAP) + theme::GAP;
    if card.progress.is_some() {
        other += theme::FIGURE + theme::GAP;
    }
    if card.word.is_some() {
        other += theme::CONTROL_LARGE + theme::GAP;
    }
    let most = place.height() - 2.0 * theme::PAD;
    let lines = lines.min(most - other).max(0.0);
    let rect = Rect::from_center_size(place.center(), vec2(width, lines + other));
    (rect, lines)
}

fn words(line: &Line, look: Look) -> (&str, Color32, f32) {
    let palette = look.palette;
    match line {
        Line::Words(text) => (text, palette.text, 0.0),
        Line::Note(text) => (text, palette.muted, 0.0),
        Line::Warning(text) => (text, palette.warn, theme::SIGN_ROOM),
        Line::Check(Some(true), text) => (text, palette.muted, theme::SIGN_ROOM),
        Line::Check(_, text) => (text, palette.text, theme::SIGN_ROOM),
        Line::Head(_) | Line::Cells(_) => ("", palette.text, 0.0),
    }
}

fn galley(ui: &Ui, width: f32, look: Look, line: &Line) -> std::sync::Arc<egui::Galley> {
    let (text, color, indent) = words(line, look);
    ui.painter()
        .layout(text.to_owned(), theme::body(), color, width - indent)
}

fn line_height(ui: &Ui, width: f32, look: Look, line: &Line) -> f32 {
    match line {
        Line::Head(_) | Line::Cells(_) | Line::Check(..) => theme::CONTROL,
        line => galley(ui, width, look, line).size().y + theme::GAP,
    }
}

fn line_ui(ui: &mut Ui, width: f32, look: Look, line: &Line) {
    let place = list::piece(ui, width, line_height(ui, width, look, line));
    let palette = look.palette;
    let sign = place.with_max_x(place.left() + theme::SIGN);
    match line {
        Line::Head(cells) => return head_ui(ui, place, look, cells),
        Line::Cells(cells) => return cells_ui(ui, place, look, cells),
        Line::Check(known, text) => {
            let color = match known {
                Some(true) => palette.ok,
                Some(false) => palette.bad,
                None => palette.faint,
            };
            controls::lamp(ui, sign.center(), color);
            let color = if *known == Some(true) {
                palette.muted
            } else {
                palette.text
            };
            let rest = place.with_min_x(place.left() + theme::SIGN_ROOM);
            Label::new(text, color).put(ui, rest);
            return;
        }
        Line::Warning(_) => {
            let above = sign.top() + theme::GAP / 2.0;
            let top = sign.with_min_y(above).with_max_y(above + theme::SIGN);
            controls::warning_sign(ui, controls::middle(top, theme::SIGN_HEIGHT), palette.warn);
        }
        Line::Words(_) | Line::Note(_) => {}
    }
    let (text, color, indent) = words(line, look);
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(place, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    let galley = galley(ui, width, look, line);
    let text = controls::middle(place, galley.size().y);
    let at = text.min + vec2(indent, 0.0);
    ui.painter().galley(at, galley, color);
}

fn head_ui(ui: &mut Ui, mut place: Rect, look: Look, cells: &[String]) {
    let Some((first, others)) = cells.split_first() else {
        return;
    };
    let muted = look.palette.muted;
    for text in others.iter().rev() {
        let cell = take_right(&mut place, theme::CARD_CELL);
        Label::new(text, muted).small().right().put(ui, cell);
    }
    Label::new(first, muted).small().put(ui, place);
}

fn cells_ui(ui: &mut Ui, mut place: Rect, look: Look, cells: &[String]) {
    let Some((first, others)) = cells.split_first() else {
        return;
    };
    for text in others.iter().rev() {
        let cell = take_right(&mut place, theme::CARD_CELL);
        Label::new(text, look.palette.text)
            .number()
            .right()
            .named(first)
            .put(ui, cell);
    }
    Label::new(first, look.palette.muted).put(ui, place);
}

fn progress_ui(ui: &mut Ui, rect: Rect, look: Look, progress: &Progress) {
    let (words, bar) = rect.split_top_bottom_at_y(rect.bottom() - theme::TRACK_RAIL);
    Label::new(&progress.words, look.palette.muted).put(ui, words);
    let round = CornerRadius::same(theme::ROUND_TRACK);
    ui.painter().rect_filled(bar, round, look.palette.sunken);
    let part = progress.part.clamp(0.0, 1.0);
    let done = bar.with_max_x(egui::lerp(bar.x_range(), part));
    ui.painter().rect_filled(done, round, look.palette.accent);
}
