//! What stands over the plots: legend, window, pause, cursors and the menu. Draws no curve.

use crate::app::action::Action;
use crate::app::files::export::Content;
use crate::app::settings::PlotWindow;
use crate::hand::Dof;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Weight, take_left, take_right, take_top};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::plot_rows::PANELS;
use crate::ui::plots::state::PlotView;
use crate::ui::text::{Text, panels, plots, words};
use crate::ui::theme;
use egui::{
    Align2, Color32, CornerRadius, Id, Popup, PopupCloseBehavior, Rect, Stroke, Ui, UiBuilder, pos2,
};

/// Rows that go to the clipboard at once: they are made into text within one frame.
const COPY_ROWS_MAX: usize = 20_000;

/// The switches beside the title.
pub(crate) fn head_ui(ui: &mut Ui, mut head: Rect, pane: &mut Pane<'_>, view: &mut PlotView) {
    let narrow = head.width() < theme::PLOT_HEAD_NARROW;
    menu_ui(
        ui,
        take_right(&mut head, theme::PLOT_MENU_BUTTON),
        pane,
        view,
    );
    let look = pane.look;
    let span = view.sight.span();
    if switch_ui(
        ui,
        take_right(&mut head, theme::PLOT_CURSOR_BUTTON),
        look,
        view.cursors.at.is_some(),
    ) {
        view.cursors.toggle(span);
    }
    if !narrow {
        let text = look.say(plots::NOTE);
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
        let place = take_right(&mut head, width);
        let button = Button::new(text, look.say(plots::NOTE_TIP)).named(look.say(plots::NOTE_NAME));
        let pressed = button.put(ui, look, place, Id::unique("note")).clicked();
        view.note_asked |= pressed;
    }
    pause_ui(
        ui,
        &mut head,
        pane,
        view,
        narrow.then_some(theme::PLOT_ICON_BUTTON),
    );
    if head.width() < theme::PLOT_WINDOWS {
        window_list_ui(ui, head, pane, view);
    } else {
        window_ui(ui, head, pane, view);
    }
}

/// The switch of the cursors; true if it was pressed.
fn switch_ui(ui: &mut Ui, place: Rect, look: Look, on: bool) -> bool {
    let button = Button::new(look.say(plots::CURSORS), look.say(plots::CURSORS_TIP))
        .named(look.say(plots::CURSORS_NAME));
    let button = Button {
        selected: Some(on),
        weight: if on { Weight::Chosen } else { Weight::Normal },
        ..button
    };
    button.put(ui, look, place, Id::unique("cursors")).clicked()
}

/// Everything that is not needed all the time.
fn menu_ui(ui: &mut Ui, place: Rect, pane: &mut Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let button = Button::new(look.say(plots::MORE), look.say(plots::MORE_TIP))
        .named(look.say(plots::MORE_NAME))
        .icon(theme::MORE);
    let response = button.put(ui, look, place, Id::unique("more for plots"));
    let shown = Popup::menu(&response)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.label(look.say(plots::SHOWN));
            shown_ui(ui, pane);
            ui.separator();
            ui.checkbox(&mut view.large, look.say(plots::ENLARGE));
            view.note_asked |= menu_button(ui, look, plots::NOTE_NAME, plots::NOTE_TIP);
            ui.separator();
            copy_ui(ui, pane, view);
            save_ui(ui, pane, view);
            ui.separator();
            ui.set_max_width(theme::PLOT_MENU);
            let hint = egui::RichText::new(look.say(plots::AREA_TIP));
            ui.label(hint.small().color(look.palette.muted));
        });
    if shown.is_none() {
        view.copied = None;
    }
    if view.note_asked {
        Popup::close_all(ui.ctx());
    }
}

fn menu_button(ui: &mut Ui, look: Look, text: Text, tip: Text) -> bool {
    let response = ui.button(look.say(text));
    response.on_hover_text(look.say(tip)).clicked()
}

/// A switch for each plot. The last one that is shown stays.
fn shown_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let shown = pane.state.settings.plots;
    for panel in &PANELS {
        let mut on = shown.shows(panel.kind);
        let enabled = !on || shown.count() > 1;
        let switch = egui::Checkbox::new(&mut on, pane.look.say(panel.title));
        if ui.add_enabled(enabled, switch).changed() {
            pane.actions.push(Action::ShowPlot(panel.kind, on));
        }
    }
}

fn copy_ui(ui: &mut Ui, pane: &Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let (from_s, to_s) = view.sight.span();
    let series = view.shown_series(pane);
    let rows = pane.state.hand().history.rows(&series, from_s, to_s);
    let fits = rows <= COPY_ROWS_MAX;
    let button = egui::Button::new(look.say(plots::COPY));
    let response = ui
        .add_enabled(fits, button)
        .on_hover_text(look.say(plots::COPY_TIP))
        .on_disabled_hover_text(look.say(plots::COPY_LONG));
    if response.clicked() {
        let table = pane.state.hand().history.table(&series, from_s, to_s);
        ui.copy_text(table.csv());
        view.copied = Some(table.len());
    }
    if let Some(rows) = view.copied {
        ui.label(format!("{} {rows}", look.say(plots::COPIED)));
    }
}

fn save_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: &PlotView) {
    let look = pane.look;
    if menu_button(ui, look, plots::SAVE_CSV, plots::SAVE_CSV_TIP) {
        let (from_s, to_s) = view.sight.span();
        let series = view.shown_series(pane);
        let table = pane.state.hand().history.table(&series, from_s, to_s);
        pane.actions.push(Action::Save(Content::Plots(table)));
        Popup::close_all(ui.ctx());
    }
    if menu_button(ui, look, plots::SAVE_PNG, plots::SAVE_PNG_TIP) {
        pane.actions.push(Action::SavePicture(view.size));
        Popup::close_all(ui.ctx());
    }
}

fn pause_ui(
    ui: &mut Ui,
    head: &mut Rect,
    pane: &mut Pane<'_>,
    view: &mut PlotView,
    icon_width: Option<f32>,
) {
    let look = pane.look;
    let paused = view.sight.is_held();
    let text = look.say(if paused {
        panels::PAUSED
    } else {
        panels::PAUSE
    });
    let place = take_right(head, icon_width.unwrap_or(theme::PLOT_BUTTON));
    let mut button = Button::new(text, look.say(panels::PAUSE_TIP))
        .named(look.say(panels::PAUSE_NAME))
        .weight(if paused {
            Weight::Armed
        } else {
            Weight::Normal
        });
    button.selected = Some(paused);
    let id = Id::unique("pause plots");
    let response = if icon_width.is_some() {
        let icon = if paused { theme::PLAY } else { theme::PAUSE };
        button.icon(icon).put(ui, look, place, id)
    } else {
        button.put(ui, look, place, id)
    };
    if response.clicked() {
        pane.actions.push(Action::PausePlots(view.sight.toggle()));
    }
}

/// The windows as a list, where a row has no room.
fn window_list_ui(ui: &mut Ui, head: Rect, pane: &mut Pane<'_>, view: &mut PlotView) {
    let now = pane.state.settings.plot_window;
    let mut chosen = now;
    let width = head.width().min(theme::PLOT_WINDOW_CHOICE);
    let place = controls::middle(head.with_min_x(head.right() - width), theme::CONTROL);
    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        let shown = egui::ComboBox::from_id_salt("plot window")
            .width(width)
            .selected_text(window_text(now).0)
            .truncate()
            .show_ui(ui, |ui| {
                for window in PlotWindow::ALL {
                    ui.selectable_value(&mut chosen, window, window_text(window).0);
                }
            });
        shown
            .response
            .on_hover_text(pane.look.say(panels::WINDOW_TIP))
            .accessible_name(pane.look.say(panels::WINDOW_NAME));
    });
    if chosen != now {
        choose_window(pane, view, chosen);
    }
}

fn choose_window(pane: &mut Pane<'_>, view: &mut PlotView, window: PlotWindow) {
    view.sight.resize(window.seconds());
    pane.actions.push(Action::PlotWindow(window));
}

fn window_ui(ui: &mut Ui, mut head: Rect, pane: &mut Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let now = pane.state.settings.plot_window;
    let each = (head.width() / 8.0).min(theme::PLOT_WINDOW_BUTTON);
    let mut row = take_right(&mut head, each * 8.0);
    let round = CornerRadius::same(theme::ROUND_SMALL);
    ui.painter().rect_filled(row, round, look.palette.sunken);
    for window in PlotWindow::ALL {
        let (place, rest) = row.split_left_right_at_x(row.left() + each);
        row = rest;
        let (text, short) = window_text(window);
        let name = format!("{}: {text}", look.say(panels::WINDOW_NAME));
        let shown = if each < theme::PLOT_WINDOW_SHORT {
            short
        } else {
            text
        };
        let as_wide = (view.sight.width_s() - window.seconds()).abs() < 1e-3;
        let button = Button::new(shown, look.say(panels::WINDOW_TIP))
            .choice(window == now && as_wide)
            .named(&name);
        let response = button.ground(ui, look, place, Id::unique(("plot window", text)));
        let color = button.text_color(look);
        controls::paint_text(
            ui,
            place,
            Align2::CENTER_CENTER,
            shown,
            theme::small(),
            color,
        );
        if response.clicked() {
            choose_window(pane, view, window);
        }
    }
}

const fn window_text(window: PlotWindow) -> (&'static str, &'static str) {
    match window {
        PlotWindow::S5 => ("5 s", "5s"),
        PlotWindow::S10 => ("10 s", "10s"),
        PlotWindow::S30 => ("30 s", "30s"),
        PlotWindow::M1 => ("1 min", "1m"),
        PlotWindow::M5 => ("5 min", "5m"),
        PlotWindow::M10 => ("10 min", "10m"),
        PlotWindow::M30 => ("30 min", "30m"),
        PlotWindow::H1 => ("1 h", "1h"),
    }
}

/// The six joints, each a switch for its curves, and the switch for thresholds; in as many rows as they need.
pub(crate) fn legend_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>, view: &mut PlotView) {
    let look = pane.look;
    let widths = Dof::ALL.map(|dof| item_width(ui, look, dof));
    let thresholds = look.say(panels::THRESHOLDS);
    let threshold_width =
        controls::text_width(ui, thresholds, theme::small()) + theme::LEGEND_DASHES;
    let needed: f32 = widths.iter().map(|width| width + theme::STEP).sum();
    let one_row = needed + threshold_width <= body.width();
    let mut row = take_top(body, theme::PLOT_NAMES_ROW);
    if !one_row {
        body.min.y -= theme::STEP;
    }
    let columns = [0, 1, 2].map(|n| {
        let width = |n: usize| widths.get(n).copied().unwrap_or_default();
        width(n).max(width(n + 3))
    });
    let threshold = take_right(
        &mut row,
        if one_row {
            threshold_width
        } else {
            theme::LEGEND_MARK
        },
    );
    threshold_ui(ui, threshold, look, view);
    for (n, (dof, width)) in Dof::ALL.into_iter().zip(widths).enumerate() {
        if n == 3 && !one_row {
            row = take_top(body, theme::PLOT_NAMES_ROW);
        }
        let column = columns.get(n % 3).copied().unwrap_or(width);
        let width = if one_row { width } else { column };
        let place = take_left(&mut row, width);
        row.min.x -= theme::STEP;
        item_ui(ui, place, look, dof, view);
    }
}

fn item_width(ui: &Ui, look: Look, dof: Dof) -> f32 {
    controls::text_width(ui, look.say(words::dof(dof)), theme::small()) + theme::LEGEND_NAME
}

fn item_ui(ui: &mut Ui, place: Rect, look: Look, dof: Dof, view: &mut PlotView) {
    let name = look.say(words::dof(dof));
    let shown = !view.hidden[dof];
    let named = format!("{}: {name}", look.say(panels::HISTORY));
    let mut button = Button::new(name, look.say(panels::SHOW_CURVE))
        .weight(Weight::Quiet)
        .named(&named);
    button.selected = Some(shown);
    let response = button.ground(ui, look, place, Id::unique(("legend", dof)));
    let swatch = Rect::from_center_size(
        pos2(place.left() + theme::LEGEND_MARK_AT, place.center().y),
        theme::LEGEND_LINE,
    );
    let palette = look.palette;
    let (line, text) = if shown {
        (palette.dof[dof], palette.text)
    } else {
        (palette.edge, palette.faint)
    };
    ui.painter()
        .rect_filled(swatch, CornerRadius::same(1), line);
    legend_text(ui, place, theme::LEGEND_WORDS, name, text);
    if response.clicked() {
        view.hidden[dof] = shown;
    }
}

fn threshold_ui(ui: &mut Ui, place: Rect, look: Look, view: &mut PlotView) {
    let text = look.say(panels::THRESHOLDS);
    let mut button = Button::new(text, look.say(panels::THRESHOLDS_TIP)).weight(Weight::Quiet);
    button.selected = Some(view.thresholds);
    let response = button.ground(ui, look, place, Id::unique("thresholds"));
    let palette = look.palette;
    let color = if view.thresholds {
        palette.text
    } else {
        palette.faint
    };
    let y = place.center().y;
    for (from, to) in theme::LEGEND_DASH {
        let line = [pos2(place.left() + from, y), pos2(place.left() + to, y)];
        ui.painter()
            .line_segment(line, Stroke::new(theme::FOCUS_LINE, color));
    }
    if place.width() > theme::LEGEND_LEAST {
        legend_text(ui, place, theme::LEGEND_MARK, text, color);
    }
    if response.clicked() {
        view.thresholds = !view.thresholds;
    }
}

fn legend_text(ui: &Ui, place: Rect, indent: f32, text: &str, color: Color32) {
    let place = place.with_min_x(place.left() + indent);
    controls::paint_text(ui, place, Align2::LEFT_CENTER, text, theme::small(), color);
}
