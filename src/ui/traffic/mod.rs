//! The traffic view: what goes over the wire, with filter, pause, copy and export. Asks for files; reads no wire.
pub(crate) mod detail;
pub(crate) mod filter;
pub(crate) mod list;

use crate::app::action::Action;
use crate::app::files::export::{Content, TrafficForm};
use crate::link::tap::Direction;
use crate::link::traffic::frame::Frame;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, traffic};
use crate::ui::theme;
use crate::ui::traffic::detail as traffic_detail;
use crate::ui::traffic::filter::{Filter, Passed};
use crate::ui::traffic::list as traffic_list;
use crate::ui::traffic::list::{Choice, Sight};
use egui::{Event, Id, Rect, TextEdit, Ui};
use std::collections::VecDeque;
use std::sync::Arc;

/// The list's part of the height; the rest is the chosen frame's.
const LIST_PART: f32 = 0.64;
/// Most signs of a filter.
const FILTER_MAX: usize = 64;

/// The frames as they were when the list was paused.
#[derive(Debug)]
struct Paused {
    frames: VecDeque<Arc<Frame>>,
    changes: u64,
    newest: u64,
}

/// What the view remembers.
#[derive(Debug, Default)]
pub(crate) struct TrafficView {
    filter: Filter,
    passed: Passed,
    choice: Choice,
    paused: Option<Paused>,
    scrolls: bool,
}

impl TrafficView {
    /// Draws the list above and the chosen frame below.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let detail = (rect.height() * (1.0 - LIST_PART))
            .max(theme::FRAME_DETAIL_LEAST)
            .round();
        let (list, detail) = rect.split_top_bottom_at_y(rect.bottom() - detail);
        let list = list.with_max_y(list.bottom() - theme::GAP);
        self.update(pane);
        self.list_ui(ui, list, pane);
        self.copy_by_key(ui);
        let chosen: Vec<&Frame> = self.chosen().collect();
        traffic_detail::detail_ui(ui, detail, pane, &chosen);
    }

    fn update(&mut self, pane: &Pane<'_>) {
        let live = &pane.state.hand().traffic;
        // Another link counts its frames from the beginning.
        if live.newest() < self.filter.cleared {
            self.filter.cleared = 0;
        }
        match &self.paused {
            Some(paused) => self
                .passed
                .update(&paused.frames, paused.changes, &self.filter),
            None => self
                .passed
                .update(live.frames(), live.changes(), &self.filter),
        }
    }

    fn chosen(&self) -> impl Iterator<Item = &Frame> {
        let frames = self.passed.frames().iter();
        let chosen = frames.filter(|frame| self.choice.numbers.contains(&frame.number));
        chosen.map(AsRef::as_ref)
    }

    fn list_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let title = look.say(traffic::TITLE);
        let (mut head, mut body) = controls::titled_card(ui, look, rect, title);
        self.buttons_ui(ui, &mut head, pane);
        self.count_ui(ui, head, pane);
        let row = take_top(&mut body, theme::CONTROL);
        self.filter_ui(ui, row, look);
        if self.passed.frames().is_empty() {
            let text = look.say(self.why_empty(pane));
            Label::new(text, look.palette.faint)
                .center()
                .put(ui, controls::middle(body, theme::CONTROL));
            return;
        }
        let frames = self.passed.frames();
        let sight = if self.scrolls || self.paused.is_some() {
            Sight::Scrolled
        } else {
            Sight::Newest
        };
        let after = traffic_list::list_ui(ui, body, pane, frames, &mut self.choice, sight);
        self.scrolls |= after != sight;
    }

    fn why_empty(&self, pane: &Pane<'_>) -> Text {
        if pane.state.hand().endpoint.is_none() {
            traffic::EMPTY_LINK
        } else if pane.state.hand().traffic.frames().is_empty() {
            traffic::EMPTY
        } else {
            traffic::EMPTY_FILTER
        }
    }

    fn count_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let live = &pane.state.hand().traffic;
        let (shown, all) = (self.passed.frames().len(), live.frames().len());
        let mut text = format!(
            "{shown} {} {all} {}",
            look.say(traffic::SHOWN_OF),
            look.say(traffic::FRAMES)
        );
        if let Some(paused) = &self.paused {
            let since = live.newest().saturating_sub(paused.newest);
            text = format!("{text}, {since} {}", look.say(traffic::CAME_SINCE));
        }
        Label::new(&text, look.palette.muted).put(ui, rect);
    }

    fn buttons_ui(&mut self, ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let nothing = self.passed.frames().is_empty();
        let no_frames = nothing.then(|| look.say(traffic::EXPORT_NONE));
        for (text, form) in [
            (traffic::EXPORT_JSON, TrafficForm::JsonLines),
            (traffic::EXPORT_CSV, TrafficForm::Csv),
        ] {
            let button =
                Button::new(look.say(text), look.say(traffic::EXPORT_TIP)).disabled(no_frames);
            if put_right(ui, head, look, button, text) {
                let frames = self.passed.frames().iter().cloned().collect();
                pane.actions
                    .push(Action::Save(Content::Traffic(form, frames)));
            }
        }
        let none = self.choice.numbers.is_empty();
        let copy = Button::new(look.say(traffic::COPY), look.say(traffic::COPY_TIP))
            .disabled(none.then(|| look.say(traffic::COPY_NONE)));
        if put_right(ui, head, look, copy, traffic::COPY) {
            self.copy(ui);
        }
        let clear = Button::new(look.say(traffic::CLEAR), look.say(traffic::CLEAR_TIP))
            .named(look.say(traffic::CLEAR_NAME))
            .disabled(no_frames);
        if put_right(ui, head, look, clear, traffic::CLEAR) {
            let newest = pane.state.hand().traffic.newest();
            self.filter.cleared = self.paused.as_ref().map_or(newest, |paused| paused.newest);
            self.choice = Choice::default();
        }
        let mut follow = Button::new(look.say(traffic::FOLLOW), look.say(traffic::FOLLOW_TIP))
            .named(look.say(traffic::FOLLOW_NAME));
        follow = switch(follow, !self.scrolls);
        if put_right(ui, head, look, follow, traffic::FOLLOW) {
            self.scrolls = !self.scrolls;
        }
        self.pause_ui(ui, head, pane);
    }

    fn pause_ui(&mut self, ui: &mut Ui, head: &mut Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let is_paused = self.paused.is_some();
        let text = if is_paused {
            traffic::PAUSED
        } else {
            traffic::PAUSE
        };
        let pause = Button::new(look.say(text), look.say(traffic::PAUSE_TIP))
            .named(look.say(traffic::PAUSE_NAME));
        if put_right(ui, head, look, switch(pause, is_paused), traffic::PAUSE) {
            let live = &pane.state.hand().traffic;
            self.paused = (!is_paused).then(|| Paused {
                frames: live.frames().clone(),
                changes: live.changes(),
                newest: live.newest(),
            });
            // What is shown from now on has a history of its own.
            self.passed = Passed::default();
            self.update(pane);
        }
    }

    fn filter_ui(&mut self, ui: &mut Ui, mut row: Rect, look: Look) {
        let texts = [
            traffic::WAY_ALL,
            traffic::WAY_OUT,
            traffic::WAY_IN,
            traffic::WRONG_ONLY,
            traffic::HIDE_POLLING,
        ];
        let switches: f32 = texts
            .map(|text| width_of(ui, look.say(text)) + theme::STEP)
            .iter()
            .sum();
        let width = theme::TRAFFIC_FILTER.min(row.width() - theme::GAP - switches);
        let field = take_left(&mut row, width);
        filter_field_ui(ui, field, look, &mut self.filter.text);
        for (text, way) in [
            (traffic::WAY_ALL, None),
            (traffic::WAY_OUT, Some(Direction::ToHand)),
            (traffic::WAY_IN, Some(Direction::FromHand)),
        ] {
            let button = Button::new(look.say(text), look.say(traffic::WAY_TIP))
                .choice(self.filter.direction == way);
            if put_left(ui, &mut row, look, button, text) {
                self.filter.direction = way;
            }
        }
        for (text, tip, on) in [
            (
                traffic::WRONG_ONLY,
                traffic::WRONG_ONLY_TIP,
                &mut self.filter.wrong_only,
            ),
            (
                traffic::HIDE_POLLING,
                traffic::HIDE_POLLING_TIP,
                &mut self.filter.hide_polling,
            ),
        ] {
            let button = switch(Button::new(look.say(text), look.say(tip)), *on);
            if put_left(ui, &mut row, look, button, text) {
                *on = !*on;
            }
        }
    }

    /// Ctrl+C, unless a text field has the keyboard.
    fn copy_by_key(&self, ui: &Ui) {
        let wished = ui.input(|input| input.events.contains(&Event::Copy));
        if wished && !self.choice.numbers.is_empty() && !ui.ctx().text_edit_focused() {
            self.copy(ui);
        }
    }

    fn copy(&self, ui: &Ui) {
        let lines: Vec<String> = self.chosen().map(Frame::hex).collect();
        ui.ctx().copy_text(lines.join("\n"));
    }
}

fn filter_field_ui(ui: &mut Ui, rect: Rect, look: Look, text: &mut String) {
    let edit = TextEdit::singleline(text)
        .id(Id::unique("traffic filter"))
        .hint_text(look.say(traffic::FILTER_HINT))
        .char_limit(FILTER_MAX)
        .align(egui::Align2::LEFT_CENTER)
        .margin(theme::FIELD_INSET)
        .min_size(rect.size())
        .desired_width(rect.width() - theme::FIELD_MARGIN);
    let response = ui.put(rect, edit);
    let value = text.clone();
    response.widget_info(|| {
        let name = look.say(traffic::FILTER);
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
        info.current_text_value = Some(value.clone());
        info
    });
}

const fn switch(mut button: Button<'_>, on: bool) -> Button<'_> {
    button.selected = Some(on);
    button.weight(if on { Weight::Chosen } else { Weight::Normal })
}

fn width_of(ui: &Ui, text: &str) -> f32 {
    controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP
}

fn put_right(ui: &mut Ui, rest: &mut Rect, look: Look, button: Button<'_>, id: Text) -> bool {
    let place = take_right(rest, width_of(ui, button.text));
    rest.max.x += theme::STEP;
    let id = Id::unique(("traffic", id.en));
    button.put(ui, look, place, id).clicked()
}

fn put_left(ui: &mut Ui, rest: &mut Rect, look: Look, button: Button<'_>, id: Text) -> bool {
    let place = take_left(rest, width_of(ui, button.text));
    rest.min.x -= theme::STEP;
    let id = Id::unique(("traffic", id.en));
    button.put(ui, look, place, id).clicked()
}
