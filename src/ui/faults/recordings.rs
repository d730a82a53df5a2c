//! The recordings around faults: their list, and one of them opened with its plots and events. Plays nothing back.

use crate::app::action::Action;
use crate::app::files::export::Content;
use crate::app::readings::fault_recorder::{Listed, Recording, RecordingId};
use crate::app::settings::{Language, ShownPlots, Theme};
use crate::ui::faults::entry as fault_entry;
use crate::ui::faults::recording_events;
use crate::ui::faults::recording_events::EventLine;
use crate::ui::faults::recording_plot::{RecordingCharts, RecordingPlot, panel_height};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::list::{INDENT, LAMP_AT, LINE, line_ui, piece, scroll_ui, wrapped_ui};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::panels::{PANELS, Panel};
use crate::ui::text::faults;
use crate::ui::theme;
use egui::{Id, Rect, Ui, pos2};
use std::sync::Arc;

/// Seconds shown on both sides of the fault when only its surroundings are.
const NEAR_S: f64 = 5.0;

/// What the recordings need between frames.
#[derive(Debug, Default)]
pub(crate) struct RecordingsView {
    open: Option<RecordingId>,
    shown: ShownPlots,
    near: bool,
    charts: RecordingCharts,
    /// The events of the open one, in the language they were worded in.
    lines: Option<((RecordingId, Language, Theme), Vec<EventLine>)>,
}

/// Its first fault, and how many more.
fn title(pane: &Pane<'_>, recording: &Recording) -> String {
    let Some(first) = recording.fault() else {
        return format::UNKNOWN.into();
    };
    let title = fault_entry::title(pane, first.dof, first.what);
    let more = recording.faults.len() - 1;
    if more == 0 {
        return title;
    }
    format!("{title} + {more} {}", pane.look.say(faults::RECORDING_MORE))
}

impl RecordingsView {
    /// Opens one.
    pub(crate) fn open(&mut self, id: RecordingId, pane: &mut Pane<'_>) {
        self.open = Some(id);
        self.near = false;
        pane.actions.push(Action::OpenedRecording(id));
    }

    /// Closes the open one.
    pub(crate) const fn close(&mut self) {
        self.open = None;
    }

    /// The open one, if it is still kept.
    pub(crate) fn opened(&self, pane: &Pane<'_>) -> Option<Arc<Recording>> {
        pane.state.hand().recorder.get(self.open?).map(Arc::clone)
    }

    /// Draws the list.
    pub(crate) fn list_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let recorder = &pane.state.hand().recorder;
        let mut pressed = None;
        scroll_ui(ui, rect, "recordings", |ui, width| {
            if let Some(until) = recorder.runs_until() {
                let left = format::age(until.since(pane.state.now));
                let place = piece(ui, width, LINE + theme::STEP);
                controls::lamp(
                    ui,
                    pos2(place.left() + LAMP_AT, place.center().y),
                    look.palette.bad,
                );
                let text = format!("{} {left}", look.say(faults::RECORDING_RUNS));
                Label::new(&text, look.palette.text)
                    .small()
                    .put(ui, place.with_min_x(place.left() + INDENT));
            }
            for listed in recorder.iter() {
                if row_ui(ui, width, pane, listed) {
                    pressed = Some(listed.recording.id);
                }
            }
            if recorder.iter().next().is_none() {
                let text = look.say(faults::RECORDINGS_NONE);
                wrapped_ui(ui, width, 0.0, text, look.palette.muted);
            } else {
                let text = look.say(faults::RECORDINGS_KEPT);
                wrapped_ui(ui, width, 0.0, text, look.palette.faint);
            }
            if recorder.lost_unopened() > 0 {
                let lost = recorder.lost_unopened();
                let text = format!("{} {lost}", look.say(faults::RECORDINGS_LOST));
                line_ui(ui, width, &text, look.palette.warn);
            }
        });
        if let Some(id) = pressed {
            self.open(id, pane);
        }
    }

    /// Draws the open one over the whole place.
    pub(crate) fn recording_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &mut Pane<'_>,
        recording: &Recording,
    ) {
        let mut body = controls::card(ui, pane.look, rect);
        self.head_ui(ui, take_top(&mut body, theme::CONTROL), pane, recording);
        self.tools_ui(ui, take_top(&mut body, theme::CONTROL), pane.look);
        let width = (body.width() * 0.3).clamp(theme::RECORDINGS_LIST.0, theme::RECORDINGS_LIST.1);
        let events = take_right(&mut body, width);
        let fault_s = recording
            .fault()
            .map_or(recording.to, |fault| fault.at)
            .secs();
        // The history may have begun within the time before.
        let from_s = recording
            .history
            .first_secs()
            .unwrap_or(recording.from.secs());
        let whole = (recording.from.secs().max(from_s), recording.to.secs());
        let span = if self.near {
            (fault_s - NEAR_S, fault_s + NEAR_S)
        } else {
            whole
        };
        let mut shown: Vec<&Panel> = PANELS
            .iter()
            .filter(|panel| self.shown.shows(panel.kind))
            .collect();
        while shown.len() > 1 && panel_height(body, shown.len()) < theme::RECORDING_LEAST {
            shown.pop();
        }
        let plot = RecordingPlot {
            look: pane.look,
            recording,
            span,
            fault_s,
        };
        plot.ui(ui, body, &shown, &mut self.charts);
        self.events_ui(ui, events, pane, recording, fault_s);
    }

    fn head_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, recording: &Recording) {
        let look = pane.look;
        let wide =
            |ui: &Ui, text: &str| controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let text = look.say(faults::RECORDING_BACK);
        let place = take_left(&mut row, wide(ui, text));
        let back = Button::new(text, look.say(faults::RECORDING_BACK_TIP));
        if back
            .put(ui, look, place, Id::unique("recording back"))
            .clicked()
        {
            self.close();
        }
        let text = look.say(faults::RECORDING_SAVE);
        let place = take_right(&mut row, wide(ui, text));
        let save = Button::new(text, look.say(faults::RECORDING_SAVE_TIP)).weight(Weight::Strong);
        if save
            .put(ui, look, place, Id::unique("recording save"))
            .clicked()
        {
            let content = Content::Recording(recording.table());
            pane.actions.push(Action::Save(content));
        }
        let age = recording
            .fault()
            .map(|fault| pane.state.now.since(fault.at));
        let age = format::age(age.unwrap_or_default());
        let about = format!("{} · {age} {}", recording.hand, look.say(faults::AGO));
        let width = controls::text_width(ui, &about, theme::small()) + 1.0;
        let room = row.width() * 0.45;
        Label::new(&about, look.palette.muted)
            .small()
            .right()
            .put(ui, take_right(&mut row, width.min(room)));
        let text = format!(
            "{}: {}",
            look.say(faults::RECORDING),
            title(pane, recording)
        );
        Label::new(&text, look.palette.text)
            .font(theme::title())
            .put(ui, row);
    }

    /// Which plots, and how much of the time.
    fn tools_ui(&mut self, ui: &mut Ui, mut row: Rect, look: Look) {
        for (text, tip, near) in [
            (faults::RECORDING_NEAR, faults::RECORDING_NEAR_TIP, true),
            (faults::RECORDING_WHOLE, faults::RECORDING_WHOLE_TIP, false),
        ] {
            let text = look.say(text);
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
            let place = take_right(&mut row, width);
            row.max.x += theme::STEP;
            let button = Button::new(text, look.say(tip)).choice(self.near == near);
            if button
                .put(ui, look, place, Id::unique(("recording near", near)))
                .clicked()
            {
                self.near = near;
            }
        }
        let panels = f32::from(u8::try_from(PANELS.len()).unwrap_or(1));
        let most = (row.width() - theme::GAP) / panels - theme::STEP;
        for panel in &PANELS {
            let title = look.say(panel.title);
            // Without its unit: that stands at the plot.
            let text = title.split([',', ' ']).next().unwrap_or(title);
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
            let place = take_left(&mut row, width.min(most));
            row.min.x -= theme::STEP;
            let on = self.shown.shows(panel.kind);
            let name = format!("{}: {title}", look.say(faults::RECORDING));
            let tip = look.say(faults::RECORDING_PANEL_TIP);
            let button = Button::new(text, tip).named(&name).choice(on);
            let id = Id::unique(("recording panel", title));
            if button.put(ui, look, place, id).clicked() {
                self.shown.set(panel.kind, !on);
            }
        }
    }

    fn events_ui(
        &mut self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &Pane<'_>,
        recording: &Recording,
        fault_s: f64,
    ) {
        let look = pane.look;
        let key = (recording.id, look.language, pane.state.settings.theme);
        if self.lines.as_ref().is_none_or(|(known, _)| *known != key) {
            self.lines = Some((key, recording_events::lines(look, recording)));
        }
        let text = look.say(faults::RECORDING_EVENTS);
        Label::new(text, look.palette.muted)
            .small()
            .put(ui, take_top(&mut rect, LINE));
        let Some((_, lines)) = &self.lines else {
            return;
        };
        scroll_ui(ui, rect, "recording events", |ui, width| {
            let count = f32::from(u16::try_from(lines.len()).unwrap_or(u16::MAX));
            let place = piece(ui, width, count * LINE);
            let seen = ui.clip_rect();
            let mut top = place.top();
            for line in lines {
                let row =
                    Rect::from_min_max(pos2(place.left(), top), pos2(place.right(), top + LINE));
                top += LINE;
                if row.intersects(seen) {
                    event_ui(ui, row, look, line, fault_s);
                }
            }
            if recording.events_lost > 0 {
                let lost = recording.events_lost;
                let text = format!("{} {lost}", look.say(faults::RECORDING_EVENTS_LOST));
                line_ui(ui, width, &text, look.palette.warn);
            }
        });
    }
}

fn event_ui(ui: &mut Ui, mut row: Rect, look: Look, line: &EventLine, fault_s: f64) {
    let time = format!("{:+.1} s", line.at_s - fault_s);
    Label::new(&time, look.palette.faint)
        .font(theme::number_small())
        .right()
        .put(ui, take_left(&mut row, theme::RECORDINGS_TIME));
    let at = pos2(row.left() + 2.0, row.center().y);
    ui.painter().circle_filled(at, theme::HALO, line.color);
    row.min.x += theme::GAP + 2.0;
    Label::new(&line.text, look.palette.text)
        .small()
        .put(ui, row);
}

/// One recording of the list. True if it is to be opened.
fn row_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, listed: &Listed) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let recording = &listed.recording;
    let mut row = piece(ui, width, theme::CONTROL + theme::STEP);
    let text = look.say(faults::RECORDING_OPEN);
    let wide = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
    let place = controls::middle(take_right(&mut row, wide), theme::CONTROL - 2.0);
    let title = title(pane, recording);
    let name = format!("{text}: {title}");
    let open = Button::new(text, look.say(faults::RECORDING_OPEN_TIP)).named(&name);
    let id = Id::unique(("open recording", recording.id));
    let pressed = open.put(ui, look, place, id).clicked();
    let at = pos2(row.left() + LAMP_AT, row.center().y);
    if listed.opened {
        fault_entry::mark(ui, at, palette.faint);
    } else {
        fault_entry::mark(ui, at, palette.warn);
    }
    row.min.x += INDENT;
    let age = recording
        .fault()
        .map(|fault| pane.state.now.since(fault.at));
    let age = format::age(age.unwrap_or_default());
    let wide = controls::text_width(ui, &age, theme::small()) + 1.0;
    Label::new(&age, palette.faint)
        .small()
        .right()
        .put(ui, take_right(&mut row, wide));
    let ink = if listed.opened {
        palette.muted
    } else {
        palette.text
    };
    let response = Label::new(&title, ink).put(ui, row);
    let mut about = recording.hand.clone();
    if !listed.opened {
        about = format!("{about}\n{}", look.say(faults::RECORDING_NEW));
    }
    response.on_hover_text(about);
    pressed
}
