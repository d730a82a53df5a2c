//! Controls above the plots: time window, pause, cursors, menu, and joints. Draws no curve.

use crate::app::action::Action;
use crate::app::files::export::Export;
use crate::app::settings::PlotWindow;
use crate::hand::Dof;
use crate::ui::kit::{self, Button, Look, Pane, ViewRequest, Weight};
use crate::ui::plots::PlotView;
use crate::ui::plots::notes::notes_ui;
use crate::ui::plots::panels::PANELS;
use crate::ui::plots::times::length;
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::text::{LayoutJob, TextFormat};
use egui::{Color32, Popup, Role, Ui, WidgetInfo};

/// Width of the menu.
const MENU: f32 = 264.0;

/// Draws title and buttons.
pub(crate) fn head_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let is_narrow = ui.available_width() < 440.0;
    kit::head_ui(ui, look, look.tr(panels::HISTORY), |ui| {
        ui.spacing_mut().item_spacing.x = theme::STEP;
        menu_ui(ui, pane, view);
        let cursors = Button::text(look, panels::CURSORS)
            .named(look.tr(panels::CURSORS_NAME))
            .switch(view.cursors.0.is_some());
        if cursors.ui(ui, look).clicked() {
            view.cursors.toggle(view.view.time.span());
        }
        if !is_narrow {
            let note = Button::text(look, panels::NOTE);
            let note = note.named(look.tr(panels::NOTE_NAME));
            note.navigate(ui, pane, ViewRequest::Note);
        }
        pause_ui(ui, pane, view, is_narrow);
        window_ui(ui, pane, view);
    });
}

/// Draws the menu of less frequent options.
fn menu_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let button = Button::text(look, panels::MORE);
    let button = button
        .named(look.tr(panels::MORE_NAME))
        .icon(theme::MORE)
        .ui(ui, look);
    kit::lasting_popup(&button).show(|ui| {
        ui.set_max_width(MENU);
        ui.label(look.tr(panels::SHOWN));
        shown_ui(ui, pane);
        ui.separator();
        ui.label(look.tr(panels::CURVES));
        legend_ui(ui, look, view);
        ui.separator();
        ui.checkbox(&mut view.large, look.tr(panels::ENLARGE));
        if kit::entry_ui(ui, look, panels::NOTE_NAME) {
            pane.open(ViewRequest::Note);
            Popup::close_all(ui.ctx());
        }
        ui.separator();
        if let Some(at_s) = notes_ui(ui, pane) {
            view.view.time.center(at_s);
            Popup::close_all(ui.ctx());
        }
        keep_ui(ui, pane, view);
        ui.separator();
        let hint = egui::RichText::new(look.tr(panels::AREA_TIP));
        ui.label(hint.small().color(look.palette.muted));
    });
}

/// Draws a check box for each plot. The last visible one cannot be turned off.
fn shown_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let shown = pane.state.settings.plots.clone();
    for panel in &PANELS {
        let mut on = shown.shows(panel.kind);
        let enabled = !on || shown.count() > 1;
        let switch = egui::Checkbox::new(&mut on, pane.look.tr(panel.title));
        if ui.add_enabled(enabled, switch).changed() {
            pane.actions.push(Action::ShowPlot(panel.kind, on));
        }
    }
}

/// Draws the entries that save the visible data as text or as a picture.
fn keep_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let (from_s, to_s) = view.view.time.span();
    let words = look.fill(panels::SAVE_CSV, &[&length(to_s - from_s)]);
    let save = ui.button(words).on_hover_text(look.tip(panels::SAVE_CSV));
    let save = save.clicked().then(|| {
        let history = &pane.hand().measured.history;
        let series = view.shown_series(pane);
        Action::Save(Export::Plots(history.table(&series, from_s, to_s)))
    });
    let picture = kit::entry_ui(ui, look, panels::SAVE_PNG);
    let picture = picture.then(|| Action::SavePicture(view.pixels()));
    if let Some(action) = save.or(picture) {
        pane.actions.push(action);
        Popup::close_all(ui.ctx());
    }
}

fn pause_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &mut PlotView, is_narrow: bool) {
    let look = pane.look;
    let is_paused = view.view.time.is_held();
    let (text, icon, weight) = if is_paused {
        (panels::PAUSED, theme::PLAY, Weight::Armed)
    } else {
        (panels::PAUSE, theme::PAUSE, Weight::Normal)
    };
    let button = Button::text(look, text)
        .named(look.tr(panels::PAUSE_NAME))
        .selected(is_paused)
        .weight(weight);
    let button = if is_narrow { button.icon(icon) } else { button };
    if button.ui(ui, look).clicked() {
        view.view.time.toggle();
    }
}

fn window_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &mut PlotView) {
    let mut chosen = pane.state.settings.plot_window;
    let all = PlotWindow::ALL.map(|window| (window, span_text(window)));
    ui.spacing_mut().combo_width = 68.0;
    // All entries, without scrolling.
    ui.spacing_mut().combo_height = f32::INFINITY;
    let name = pane.look.tr(panels::WINDOW_NAME);
    if kit::choose_ui(ui, name, &mut chosen, &all) {
        view.view.time.resize(chosen.seconds());
        pane.actions.push(Action::PlotWindow(chosen));
    }
}

/// Label of a time window.
pub(crate) const fn span_text(window: PlotWindow) -> &'static str {
    match window {
        PlotWindow::S5 => "5 s",
        PlotWindow::S10 => "10 s",
        PlotWindow::S30 => "30 s",
        PlotWindow::M1 => "1 min",
        PlotWindow::M5 => "5 min",
        PlotWindow::M10 => "10 min",
        PlotWindow::M30 => "30 min",
        PlotWindow::H1 => "1 h",
    }
}

/// Draws a switch for each joint's curves and for the thresholds, on as many rows as needed.
fn legend_ui(ui: &mut Ui, look: Look, view: &mut PlotView) {
    let palette = look.palette;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(theme::STEP, 0.0);
        ui.spacing_mut().button_padding = egui::vec2(theme::STEP, 2.0);
        ui.spacing_mut().interact_size.y = 20.0;
        for dof in Dof::ALL {
            let words = look.tr(words::dof(dof));
            let switch = CurveSwitch {
                sign: "■ ",
                color: palette.dof[dof],
                words,
                name: &look.pair(look.tr(panels::HISTORY), words),
                is_on: !view.hidden[dof],
            };
            view.hidden[dof] ^= switch.ui(ui, look, look.tr(panels::SHOW_CURVE));
        }
        let words = look.tr(panels::THRESHOLDS);
        let switch = CurveSwitch {
            sign: "- - ",
            color: palette.text,
            words,
            name: words,
            is_on: view.thresholds,
        };
        view.thresholds ^= switch.ui(ui, look, look.tip(panels::THRESHOLDS));
    });
}

/// A switch for curves: a symbol and a text, pale while off.
struct CurveSwitch<'a> {
    sign: &'a str,
    color: Color32,
    words: &'a str,
    /// Accessible name.
    name: &'a str,
    is_on: bool,
}

impl CurveSwitch<'_> {
    /// Draws it; true if it was pressed.
    fn ui(&self, ui: &mut Ui, look: Look, tip: &str) -> bool {
        let (line, text) = if self.is_on {
            (self.color, look.palette.text)
        } else {
            (look.palette.edge, look.palette.faint)
        };
        let mut job = LayoutJob::default();
        job.append(self.sign, 0.0, TextFormat::simple(theme::small(), line));
        job.append(self.words, 0.0, TextFormat::simple(theme::small(), text));
        let response = ui.add(egui::Button::new(job).frame_when_inactive(false));
        let info = || WidgetInfo::selected(Role::Button, true, self.is_on, self.name);
        response.widget_info(info);
        response.on_hover_text(tip).clicked()
    }
}
