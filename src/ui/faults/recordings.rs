//! Recordings around faults: their list, and an opened one with its plots and events. Plays nothing back.

use crate::app::action::Action;
use crate::app::files::export::Export;
use crate::app::readings::fault_recorder::{FaultRecording, FaultRecordingId};
use crate::app::settings::{Language, ShownPlots, Theme};
use crate::hand::{Dof, PerDof};
use crate::ui::faults::entry::{self as fault_entry, scroll_ui};
use crate::ui::faults::recording_events;
use crate::ui::faults::recording_events::EventLine;
use crate::ui::kit::{self, Button, Label, Look, Pane, Pick, Weight, format};
use crate::ui::plots;
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView, Points, height_over_axis};
use crate::ui::plots::panels::{self, PANELS, PanelLine};
use crate::ui::plots::times::Times;
use crate::ui::recordings::stretch::ReplayedStretch;
use crate::ui::text::{device, notices};
use crate::ui::theme;
use egui::{Panel, ScrollArea, Stroke, Ui};
use std::sync::Arc;

/// Seconds shown on both sides of the fault when zoomed to it.
const NEAR_S: f64 = 5.0;

/// View state of the recordings.
#[derive(Debug, Default)]
pub(crate) struct FaultRecordingsView {
    open: Option<FaultRecordingId>,
    shown: ShownPlots,
    near: bool,
    chart: ChartView,
    /// Events of the open recording, cached for a language and theme.
    lines: Option<((FaultRecordingId, Language, Theme), Vec<EventLine>)>,
}

/// One plot of a recording: joints with the fault are bold and drawn last, over the others.
fn chart<'a>(
    look: Look,
    recording: &'a FaultRecording,
    panel: &panels::Panel,
    height: f32,
) -> Chart<'a> {
    let is_of_fault = |dof: Dof| recording.faults.iter().any(|fault| fault.dof == dof);
    let mut lines = panel.lines(&PerDof::splat(false));
    lines.sort_by_key(|line| is_of_fault(line.dof));
    let curve = |line: PanelLine| {
        let is_of_fault = is_of_fault(line.dof);
        let (width, share) = match (is_of_fault, line.wished) {
            (true, false) => (theme::STRONG, 1.0),
            (true, true) => (1.0, 0.6),
            (false, false) => (1.0, 0.35),
            (false, true) => (1.0, 0.15),
        };
        let color = look.palette.dof[line.dof].gamma_multiply(share);
        let points = Points::Measured(&recording.history, line.series);
        ChartCurve {
            steps: line.wished,
            decimals: (is_of_fault && !line.wished).then_some(panel.row.decimals),
            ..ChartCurve::new(points, Stroke::new(width, color))
        }
    };
    let fault = recording.fault().map_or(recording.to, |fault| fault.at);
    let moments = recording.faults.iter();
    let moments = moments.map(|fault| (fault.at.secs(), look.palette.bad));
    Chart {
        curves: lines.into_iter().map(curve).collect(),
        moments: moments.collect(),
        least: panel.row.least_scale,
        times: Times::From(fault.secs(), look.tr(notices::RECORDING_FAULT)),
        ..Chart::new(look, panel.title, height)
    }
}

/// Its first fault, and the number of further ones.
fn title(pane: &Pane<'_>, recording: &FaultRecording) -> String {
    let Some(first) = recording.fault() else {
        return format::UNKNOWN.into();
    };
    let title = fault_entry::title(pane, first.dof, first.what);
    let more = recording.faults.len() - 1;
    if more == 0 {
        return title;
    }
    let other = pane.look.tr(notices::RECORDING_MORE);
    format!("{title} + {more} {other}")
}

impl FaultRecordingsView {
    pub(crate) fn open(&mut self, id: FaultRecordingId) {
        self.open = Some(id);
        self.near = false;
        self.chart = ChartView::default();
    }

    /// Closes the open recording.
    pub(crate) const fn close(&mut self) {
        self.open = None;
    }

    /// The open recording; `None` if there is none or it was dropped.
    pub(crate) fn opened(&self, pane: &Pane<'_>) -> Option<Arc<FaultRecording>> {
        let recorder = &pane.hand().measured.recorder;
        recorder.get(self.open?).map(Arc::clone)
    }

    /// Draws the list.
    pub(crate) fn list_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let recorder = &pane.hand().measured.recorder;
        let mut pressed = None;
        scroll_ui(ui, |ui| {
            if let Some(until) = recorder.runs_until() {
                let left = format::age(until.since(pane.state.now));
                let text = look.tr_with(notices::RECORDING_RUNS, left);
                ui.horizontal(|ui| {
                    kit::lamp_ui(ui, Some(look.palette.bad));
                    kit::small_text_ui(ui, &text, look.palette.text);
                });
            }
            for recording in recorder.iter() {
                if row_ui(ui, pane, recording) {
                    pressed = Some(recording.id);
                }
            }
            let kept = match recorder.iter().next() {
                None => notices::RECORDINGS_NONE,
                Some(_) => notices::RECORDINGS_KEPT,
            };
            kit::small_text_ui(ui, look.tr(kept), look.palette.muted);
            if recorder.lost() > 0 {
                let text = look.tr_with(notices::RECORDINGS_LOST, recorder.lost());
                kit::small_text_ui(ui, &text, look.palette.warn);
            }
        });
        if let Some(id) = pressed {
            self.open(id);
        }
    }

    /// Draws the open recording over all the available space.
    pub(crate) fn recording_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        recording: &FaultRecording,
    ) {
        self.head_ui(ui, pane, recording);
        self.tools_ui(ui, pane.look);
        let fault = recording.fault();
        let fault_s = fault.map_or(recording.to, |fault| fault.at).secs();
        let width = (ui.available_width() * 0.3).clamp(168.0, 300.0);
        let events = kit::bare(Panel::right("events"), width, theme::GAP_LEFT);
        events.show(ui, |ui| self.events_ui(ui, pane, recording, fault_s));
        // The history may begin later than the recording.
        let from = recording.from.secs();
        let from = recording.history.first_secs().unwrap_or(from).max(from);
        let (from, to) = if self.near {
            (fault_s - NEAR_S, fault_s + NEAR_S)
        } else {
            (from, recording.to.secs())
        };
        self.chart.time.advance((from, to), to - from);
        self.plots_ui(ui, pane.look, recording);
    }

    /// Draws the selected plots, as many as fit.
    fn plots_ui(&mut self, ui: &mut Ui, look: Look, recording: &FaultRecording) {
        let shown = PANELS.iter().filter(|panel| self.shown.shows(panel.kind));
        let mut shown: Vec<_> = shown.collect();
        while shown.len() > 1 && plots::room(ui, shown.len()) < 46.0 {
            shown.pop();
        }
        let height = plots::room(ui, shown.len());
        ui.spacing_mut().item_spacing.y = 0.0;
        for (n, panel) in shown.iter().enumerate() {
            let is_lowest = n + 1 == shown.len();
            let height = height_over_axis(height, is_lowest);
            let plot = Chart {
                is_lowest,
                ..chart(look, recording, panel, height)
            };
            plot.ui(ui, &mut self.chart);
        }
    }

    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, recording: &FaultRecording) {
        let look = pane.look;
        ui.horizontal(|ui| {
            let back = Button::text(look, notices::RECORDING_BACK);
            if back.ui(ui, look).clicked() {
                self.close();
            }
            kit::right_ui(ui, |ui| {
                let save = Button::text(look, notices::RECORDING_SAVE).weight(Weight::Strong);
                if save.ui(ui, look).clicked() {
                    let content = Export::Recording(recording.table());
                    pane.actions.push(Action::Save(content));
                }
                let title = title(pane, recording);
                let title = format!("{}: {title}", look.tr(notices::RECORDING));
                kit::left_ui(ui, |ui| {
                    let title = Label::new(&title, look.palette.text);
                    title.ui(ui).on_hover_text(about(pane, recording));
                });
            });
        });
        kit::small_text_ui(ui, &about(pane, recording), look.palette.muted);
    }

    /// Draws the choice of plots and of the time range.
    fn tools_ui(&mut self, ui: &mut Ui, look: Look) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            for panel in &PANELS {
                let title = look.tr(panel.title);
                // Without its unit, which the plot shows.
                let text = title.split([',', ' ']).next().unwrap_or(title);
                let on = self.shown.shows(panel.kind);
                let name = format!("{}: {title}", look.tr(notices::RECORDING));
                let button = Button::new(text, look.tr(notices::RECORDING_PANEL_TIP));
                if button.named(&name).choice(on).ui(ui, look).clicked() {
                    self.shown.set(panel.kind, !on);
                }
            }
            ui.separator();
            let near = [
                (true, notices::RECORDING_NEAR),
                (false, notices::RECORDING_WHOLE),
            ];
            let pick = Pick::new(look, notices::RECORDING_NEAR.tip());
            if pick.ui(ui, &mut self.near, near) {
                self.chart = ChartView::default();
            }
        });
    }

    fn events_ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        recording: &FaultRecording,
        fault_s: f64,
    ) {
        let look = pane.look;
        let key = (recording.id, look.language, pane.state.settings.theme);
        if self.lines.as_ref().is_none_or(|(known, _)| *known != key) {
            self.lines = Some((key, recording_events::lines(look, recording)));
        }
        let Some((_, lines)) = &self.lines else {
            return;
        };
        kit::small_text_ui(ui, look.tr(notices::RECORDING_EVENTS), look.palette.muted);
        if recording.events_lost > 0 {
            let lost = recording.events_lost;
            let text = look.tr_with(notices::RECORDING_EVENTS_LOST, lost);
            kit::small_text_ui(ui, &text, look.palette.warn);
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        let scroll = ScrollArea::vertical().auto_shrink(false);
        scroll.show_rows(ui, theme::LIST_LINE, lines.len(), |ui, rows| {
            for line in lines.get(rows).unwrap_or_default() {
                event_ui(ui, look, line, fault_s);
            }
        });
    }
}

/// Hand of a recording, and its age.
fn about(pane: &Pane<'_>, recording: &FaultRecording) -> String {
    let age = recording
        .fault()
        .map(|fault| pane.state.now.since(fault.at));
    let age = format::age(age.unwrap_or_default());
    format!("{} · {age} {}", recording.hand, pane.look.tr(device::AGO))
}

fn event_ui(ui: &mut Ui, look: Look, line: &EventLine, fault_s: f64) {
    ui.horizontal(|ui| {
        ui.set_min_height(theme::LIST_LINE);
        let time = format!("{:+7.1} s", line.at_s - fault_s);
        let time = Label::new(&time, look.palette.muted).number();
        time.ui(ui);
        let at = kit::lamp_ui(ui, None);
        ui.painter().circle_filled(at, theme::HALO, line.color);
        Label::new(&line.text, look.palette.text).small().ui(ui);
    });
}

/// Draws one recording of the list. True if the user opens it.
fn row_ui(ui: &mut Ui, pane: &mut Pane<'_>, recording: &FaultRecording) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let row = ui.horizontal(|ui| {
        let title = title(pane, recording);
        let text = look.tr(notices::RECORDING_OPEN);
        let name = format!("{text}: {title}");
        let open = Button::new(text, look.tip(notices::RECORDING_OPEN)).named(&name);
        let pressed = open.ui(ui, look).clicked();
        let from = recording.fault().map(|fault| fault.at);
        let stretch = ReplayedStretch {
            title: &title,
            hand: &recording.hand,
            stretch: from.map(|from| (from, recording.to)),
        };
        let replay = stretch.ui(ui, pane).map(Action::Recording);
        pane.actions.extend(replay);
        let at = kit::lamp_ui(ui, None);
        fault_entry::mark(ui, at, palette.warn);
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            Label::new(&title, palette.text).wrap().ui(ui);
            kit::small_text_ui(ui, &about(pane, recording), palette.muted);
        });
        pressed
    });
    row.inner
}
