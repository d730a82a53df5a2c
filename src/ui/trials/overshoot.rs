//! Overshoot measured on this hand: how far each close exceeded its threshold over its speed, the values, and the actions on them.
//! Measures nothing.

use crate::app::action::Action;
use crate::app::trials::TrialAction;
use crate::hand::Dof;
use crate::hand::impact::overshoot_g;
use crate::hand::overshoot::{MeasuredCloses, Stages, Stiffness};
use crate::ui::hand::panel::StillHand;
use crate::ui::kit::{self, Button, Label, Look, Pane, Pick, Weight};
use crate::ui::plots::scales;
use crate::ui::text::{Text, tune, words};
use crate::ui::theme;
use crate::ui::touch::heat;
use egui::{Color32, Role, Ui, WidgetInfo};
use egui_extras::{Column, TableRow};
use egui_plot::{AxisHints, Line, LineStyle, MarkerShape, Plot, PlotBounds, PlotPoints, Points};

const ROW: f32 = 20.0;
/// Maximum share of the height for the table.
const TABLE_SHARE: f32 = 0.45;
/// Minimum range of the axes: units of SPEED_SET, and grams.
const LEAST: [f64; 2] = [50.0, 50.0];
/// Number of points on the other hand's curve.
const STEPS: u32 = 60;
const COLUMNS: [(Text, f32); 7] = [
    (tune::MAP_SPEED, 72.0),
    (tune::MAP_THRESHOLD, 88.0),
    (tune::MAP_OBJECT, 88.0),
    (tune::MAP_CLOSES, 64.0),
    (tune::MAP_MOST, 80.0),
    (tune::MAP_MEAN, 80.0),
    (tune::MAP_LAST, 96.0),
];

/// View state.
#[derive(Debug, Default)]
pub(crate) struct OvershootView {
    /// Joint shown alone; `None` shows all.
    dof: Option<Dof>,
    /// True while a confirmation to delete all measurements is shown.
    asks: bool,
    hand: StillHand,
}

impl OvershootView {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let map = &pane.hand().overshoot.map;
        if map.is_empty() {
            self.asks = false;
            no_trials_ui(ui, pane.look, tune::MAP_EMPTY, tune::MAP_EMPTY_BODY);
            return self.hand.rest_ui(ui, pane, &heat::tips(pane), None);
        }
        let has = |dof: Dof| map.kinds().iter().any(|own| own.kind.dof == dof);
        self.dof = self.dof.filter(|dof| has(*dof));
        self.head_ui(ui, pane, has);
        let dof = self.dof;
        let mut kinds: Vec<&MeasuredCloses> = map.kinds().iter().collect();
        kinds.retain(|own| dof.is_none_or(|dof| own.kind.dof == dof));
        kinds.sort_by_key(|own| {
            let kind = own.kind;
            let what = (kind.dof, kind.stages);
            (what, kind.threshold, kind.speed, kind.stiffness)
        });
        let rows = f32::from(u16::try_from(kinds.len() + 1).unwrap_or(u16::MAX));
        let height = (rows * ROW + theme::GAP).min(ui.available_height() * TABLE_SHARE);
        let table = kit::bare(egui::Panel::bottom("kinds"), height, theme::GAP_TOP);
        table.show(ui, |ui| table_ui(ui, pane, &kinds));
        plot_ui(ui, pane, &kinds);
    }

    /// Draws the choice of joints, and the actions on all measurements.
    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, has: impl Fn(Dof) -> bool) {
        let look = pane.look;
        let all = Dof::ALL.into_iter().filter(|dof| has(*dof));
        let all = all.map(|dof| (Some(dof), words::dof(dof)));
        let all: Vec<_> = std::iter::once((None, tune::MAP_ALL)).chain(all).collect();
        ui.horizontal(|ui| {
            Pick::new(look, tune::MAP_PICK).ui(ui, &mut self.dof, all);
            kit::right_ui(ui, |ui| self.use_ui(ui, pane));
        });
    }

    /// Draws the actions on all measurements, from right to left.
    fn use_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let quiet = |text| Button::text(look, text).weight(Weight::Quiet);
        if self.asks {
            let sure = Button::text(look, tune::MAP_FORGET_SURE).weight(Weight::Danger);
            sure.on_click(ui, pane, Action::Trial(TrialAction::ForgetOvershoot));
            if quiet(tune::MAP_FORGET_NOT).ui(ui, look).clicked() {
                self.asks = false;
            }
        } else {
            self.asks = quiet(tune::MAP_FORGET).ui(ui, look).clicked();
        }
        quiet(tune::MAP_EXPORT).on_click(ui, pane, Action::Trial(TrialAction::ExportOvershoot));
    }
}

/// Draws the title and the next step of an empty view.
pub(crate) fn no_trials_ui(ui: &mut Ui, look: Look, title: Text, body: Text) {
    Label::text(look, title).large().wrap().ui(ui);
    kit::small_text_ui(ui, look.tr(body), look.palette.muted);
}

/// Plots overshoot over speed, with a point per kind of close and a curve for the other hand.
fn plot_ui(ui: &mut Ui, pane: &Pane<'_>, kinds: &[&MeasuredCloses]) {
    let (look, palette) = (pane.look, pane.look.palette);
    let most = |of: fn(&MeasuredCloses) -> f64, least| {
        kinds.iter().map(|own| of(own)).fold(least, f64::max) * 1.15
    };
    let width = most(|own| f64::from(own.kind.speed.get()), LEAST[0]);
    let height = most(|own| own.most_over_g, LEAST[1]);
    let mut thresholds: Vec<i16> = kinds.iter().map(|own| own.kind.threshold.get()).collect();
    thresholds.sort_unstable();
    let threshold = thresholds.get(thresholds.len() / 2).copied().unwrap_or(500);
    let caption = look.fill(tune::MAP_OTHER, &[&threshold]);
    let other = (0..=STEPS).map(|step| {
        let speed = width * f64::from(step) / f64::from(STEPS);
        [speed, overshoot_g(speed, threshold.into())]
    });
    let other = other.take_while(|at| at[1] <= height * 1.2);
    let hints = |hints: AxisHints<'static>| {
        let hints = hints.tick_label_font(theme::number());
        hints.tick_label_color(palette.muted)
    };
    ui.horizontal_wrapped(|ui| {
        for stiffness in Stiffness::ALL {
            if kinds.iter().any(|own| own.kind.stiffness == stiffness) {
                let name = look.tr(tune::stiffness(stiffness));
                let text = format!("{} {name}", sign(stiffness));
                Label::new(&text, palette.text).small().ui(ui);
            }
        }
        let caption = format!("- - {caption}");
        Label::new(&caption, palette.muted).small().ui(ui);
        Label::note(look, tune::MAP_AXES).ui(ui);
    });
    let mut pointed = None;
    let plot = Plot::new("overshoot of this hand")
        .height(ui.available_height())
        .custom_x_axes(vec![hints(AxisHints::new_x())])
        .custom_y_axes(vec![
            hints(AxisHints::new_y())
                .formatter(|mark, _| scales::number(mark.value, mark.step_size)),
        ])
        .grid_color(palette.grid)
        .grid_fade(0.0)
        .cursor_color(Color32::TRANSPARENT)
        .show_x(false)
        .show_y(false)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false);
    let lowest = kinds.iter().map(|own| own.most_over_g).fold(0.0, f64::min);
    let bounds = PlotBounds::from_min_max([0.0, lowest], [width, height]);
    let shown = plot.show(ui, |plot| {
        plot.set_plot_bounds(bounds);
        let line = Line::new("", PlotPoints::from_iter(other)).color(palette.muted);
        plot.line(line.style(LineStyle::dashed_dense()).allow_hover(false));
        let pointer = plot.pointer_coordinate();
        for own in kinds {
            let at = [f64::from(own.kind.speed.get()), own.most_over_g];
            let points = Points::new("", vec![at]).radius(5.0).allow_hover(false);
            let points = points.shape(shape(own.kind.stiffness));
            plot.points(points.color(palette.dof[own.kind.dof]));
            let near = pointer.is_some_and(|to| {
                (to.x - at[0]).abs() < width * 0.015 && (to.y - at[1]).abs() < height * 0.03
            });
            if near {
                pointed = Some(*own);
            }
        }
    });
    let response = shown.response;
    let name = look.tr(tune::MAP_NAME);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
    if let Some(own) = pointed {
        response.on_hover_text_at_pointer(words_of(pane, own));
    }
}

/// All closes of one kind, summarised as text.
fn words_of(pane: &Pane<'_>, own: &MeasuredCloses) -> String {
    let (look, kind) = (pane.look, own.kind);
    let [most, mean] = [own.most_over_g, own.mean_over_g].map(|over| format!("{over:+.0}"));
    let what = format!(
        "{}, {}, {}",
        look.tr(words::dof(kind.dof)),
        look.fill(tune::SETTING, &[&kind.speed.get(), &kind.threshold.get()]),
        look.tr(tune::stiffness(kind.stiffness)),
    );
    let figures = look.fill(tune::MAP_POINT, &[&own.closes, &most, &mean, &own.last]);
    format!("{what}\n{figures}")
}

const fn shape(stiffness: Stiffness) -> MarkerShape {
    match stiffness {
        Stiffness::Soft => MarkerShape::Circle,
        Stiffness::Firm => MarkerShape::Diamond,
        Stiffness::Rigid => MarkerShape::Square,
        Stiffness::Unknown => MarkerShape::Cross,
    }
}

const fn sign(stiffness: Stiffness) -> &'static str {
    match stiffness {
        Stiffness::Soft => "●",
        Stiffness::Firm => "◆",
        Stiffness::Rigid => "■",
        Stiffness::Unknown => "×",
    }
}

/// Draws the values as a table.
fn table_ui(ui: &mut Ui, pane: &Pane<'_>, kinds: &[&MeasuredCloses]) {
    let look = pane.look;
    ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
    let mut table = kit::table(ui, "kinds of closes")
        .min_scrolled_height(0.0)
        .auto_shrink(false)
        .column(Column::remainder().at_least(96.0).clip(true));
    for (_, width) in COLUMNS {
        table = table.column(Column::exact(width).clip(true));
    }
    let table = table.header(ROW, |mut row| {
        let heads = [tune::MAP_JOINT].into_iter();
        for text in heads.chain(COLUMNS.map(|(text, _)| text)) {
            row.col(|ui| {
                let label = Label::note(look, text);
                label.ui(ui).on_hover_text(look.tip(text));
            });
        }
    });
    table.body(|body| {
        body.rows(ROW, kinds.len(), |mut row| {
            if let Some(own) = kinds.get(row.index()) {
                row_ui(&mut row, pane, own);
            }
        });
    });
}

fn row_ui(row: &mut TableRow<'_, '_>, pane: &Pane<'_>, own: &MeasuredCloses) {
    let (look, palette, kind) = (pane.look, pane.look.palette, own.kind);
    let name = look.tr(words::dof(kind.dof));
    let name = match kind.stages {
        Stages::One => name.to_owned(),
        Stages::Two => format!("{name}, {}", look.tr(tune::MAP_TWO)),
    };
    Label::new(&name, palette.dof[kind.dof]).column_ui(row);
    let figures = [
        kind.speed.get().to_string(),
        format!("{} g", kind.threshold.get()),
        look.tr(tune::stiffness(kind.stiffness)).to_owned(),
        own.closes.to_string(),
        format!("{:+.0} g", own.most_over_g),
        format!("{:+.0} g", own.mean_over_g),
        own.last.clone(),
    ];
    for figure in figures {
        Label::new(&figure, palette.text).number().column_ui(row);
    }
}
