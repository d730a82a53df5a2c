//! The traffic view: frames on the wire, with filter, pause, copy and export. Requests files; reads no wire.
pub(crate) mod detail;
pub(crate) mod filter;
pub(crate) mod list;

use crate::app::action::Action;
use crate::app::files::export::{Export, TrafficForm};
use crate::link::traffic::frame::Frame;
use crate::record::Direction;
use crate::ui::kit::{self, Button, Label, Pane, Pick};
use crate::ui::text::{Text, main, traffic};
use crate::ui::theme;
use crate::ui::traffic::filter::Filter;
use crate::ui::traffic::list::{ChosenFrames, FrameList};
use egui::{Event, Ui, vec2};
use std::collections::VecDeque;
use std::sync::Arc;

/// Frames at the time when the list was paused.
#[derive(Debug)]
struct Paused {
    frames: VecDeque<Arc<Frame>>,
    changes: u64,
    newest: u64,
}

/// View state.
#[derive(Debug, Default)]
pub(crate) struct TrafficView {
    filter: Filter,
    passed: VecDeque<Arc<Frame>>,
    /// Filter and frames that `passed` was computed from; it is recomputed when they change.
    of: Option<(Filter, u64, u64)>,
    choice: ChosenFrames,
    paused: Option<Paused>,
    scrolls: bool,
}

impl TrafficView {
    /// Draws the list above and the selected frame below.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.update(pane);
        let whole = ui.available_size();
        let detail = (whole.y * 0.36).max(150.0);
        ui.spacing_mut().item_spacing.y = theme::GAP;
        let size = vec2(whole.x, whole.y - detail.round() - theme::GAP);
        ui.allocate_ui(size, |ui| {
            kit::full_card_ui(ui, pane.look, |ui| self.list_ui(ui, pane));
        });
        self.copy_by_key(ui);
        let chosen: Vec<&Frame> = self.chosen().collect();
        kit::full_card_ui(ui, pane.look, |ui| {
            detail::detail_ui(ui, pane.look, &chosen)
        });
    }

    fn update(&mut self, pane: &Pane<'_>) {
        let live = &pane.hand().connection.traffic;
        // A new link numbers its frames from the beginning.
        if live.newest() < self.filter.cleared {
            self.filter.cleared = 0;
        }
        let (frames, changes, newest) = match &self.paused {
            Some(paused) => (&paused.frames, paused.changes, paused.newest),
            None => (live.frames(), live.changes(), live.newest()),
        };
        let of = Some((self.filter.clone(), changes, newest));
        if self.of != of {
            self.passed = self.filter.passing(frames);
            self.of = of;
        }
    }

    fn chosen(&self) -> impl Iterator<Item = &Frame> {
        let frames = self.passed.iter();
        let chosen = frames.filter(|frame| self.choice.numbers.contains(&frame.number));
        chosen.map(AsRef::as_ref)
    }

    fn list_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.spacing_mut().item_spacing.y = theme::STEP;
        kit::head_ui(ui, look, look.tr(main::TAB_TRAFFIC), |ui| {
            Label::new(&self.count(pane), look.palette.muted).ui(ui);
        });
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            self.filter_ui(ui, pane);
            ui.separator();
            self.buttons_ui(ui, pane);
        });
        if self.passed.is_empty() {
            let text = Label::muted(look, self.why_empty(pane));
            ui.vertical_centered(|ui| text.wrap().ui(ui));
            return;
        }
        let list = FrameList {
            frames: &self.passed,
            choice: &mut self.choice,
            follows: !self.scrolls && self.paused.is_none(),
        };
        self.scrolls |= list.ui(ui, pane);
    }

    fn why_empty(&self, pane: &Pane<'_>) -> Text {
        if pane.hand().connection.endpoint.is_none() {
            traffic::EMPTY_LINK
        } else if pane.hand().connection.traffic.frames().is_empty() {
            traffic::EMPTY
        } else {
            traffic::EMPTY_FILTER
        }
    }

    fn count(&self, pane: &Pane<'_>) -> String {
        let look = pane.look;
        let live = &pane.hand().connection.traffic;
        let (shown, all) = (self.passed.len(), live.frames().len());
        let of = look.tr(traffic::SHOWN_OF);
        let text = format!("{shown} {of} {all} {}", look.tr(traffic::FRAMES));
        let Some(paused) = &self.paused else {
            return text;
        };
        let since = live.newest().saturating_sub(paused.newest);
        format!("{text}, {since} {}", look.tr(traffic::CAME_SINCE))
    }

    fn buttons_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let is_paused = self.paused.is_some();
        let text = if is_paused {
            traffic::PAUSED
        } else {
            traffic::PAUSE
        };
        let pause = Button::text(look, text);
        let pause = pause.named(look.tr(traffic::PAUSE_NAME)).switch(is_paused);
        if pause.ui(ui, look).clicked() {
            let live = &pane.hand().connection.traffic;
            self.paused = (!is_paused).then(|| Paused {
                frames: live.frames().clone(),
                changes: live.changes(),
                newest: live.newest(),
            });
            // The list shown from now on has other frames.
            self.update(pane);
        }
        let follow = Button::text(look, traffic::FOLLOW).switch(!self.scrolls);
        let follow = follow.named(look.tr(traffic::FOLLOW_NAME));
        follow.toggle(ui, look, &mut self.scrolls);
        let nothing = self.passed.is_empty();
        let nothing = nothing.then(|| look.tr(traffic::EXPORT_NONE));
        let clear = Button::text(look, traffic::CLEAR);
        let clear = clear.named(look.tr(traffic::CLEAR_NAME)).disabled(nothing);
        if clear.ui(ui, look).clicked() {
            let newest = pane.hand().connection.traffic.newest();
            self.filter.cleared = self.paused.as_ref().map_or(newest, |paused| paused.newest);
            self.choice = ChosenFrames::default();
        }
        let none = self.choice.numbers.is_empty();
        let copy = Button::text(look, traffic::COPY);
        let copy = copy.disabled(none.then(|| look.tr(traffic::COPY_NONE)));
        if copy.ui(ui, look).clicked() {
            self.copy(ui);
        }
        for (text, form) in [
            (traffic::EXPORT_CSV, TrafficForm::Csv),
            (traffic::EXPORT_JSON, TrafficForm::JsonLines),
        ] {
            let button = Button::text(look, text);
            if button.disabled(nothing).ui(ui, look).clicked() {
                let frames = self.passed.iter().cloned().collect();
                let content = Export::Traffic(form, frames);
                pane.actions.push(Action::Save(content));
            }
        }
    }

    fn filter_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let filter = &mut self.filter;
        ui.allocate_ui(vec2(220.0, theme::CONTROL), |ui| {
            kit::translated_edit_ui(ui, look, traffic::FILTER, &mut filter.text);
        });
        let ways = [
            (None, traffic::WAY_ALL),
            (Some(Direction::ToHand), traffic::WAY_OUT),
            (Some(Direction::FromHand), traffic::WAY_IN),
        ];
        Pick::new(look, traffic::WAY_TIP).ui(ui, &mut filter.direction, ways);
        for (text, on) in [
            (traffic::WRONG_ONLY, &mut filter.wrong_only),
            (traffic::HIDE_POLLING, &mut filter.hide_polling),
        ] {
            Button::text(look, text).switch(*on).toggle(ui, look, on);
        }
    }

    /// Copies on Ctrl+C, unless a text field has the focus.
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
