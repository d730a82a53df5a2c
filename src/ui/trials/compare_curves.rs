//! Overlaid curves of the shown sessions: colours for settings or joints, line styles for sessions, and the hovered trial.
//! Measures nothing.

use crate::app::trials::{
    ComparedLine, ComparedLines, ComparedRow, Comparison, LineGroup, RowKey, TrialQuantity,
};
use crate::ui::kit::{Button, Label, Pane, Pick, dash};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartResponse, ChartView, Points};
use crate::ui::plots::legend::{LegendKey, legend_ui};
use crate::ui::plots::scales;
use crate::ui::plots::times::Times;
use crate::ui::text::{tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use egui::{Color32, Stroke, Ui};
use egui_plot::LineStyle;

/// Minimum visible time, in seconds.
pub(crate) const LEAST_S: f64 = 0.1;

/// Time before the common moment that is visible at first, in seconds.
const LEAD_S: f64 = 0.5;

/// Zero of the curves' time axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Align {
    Command,
    #[default]
    Contact,
}

/// Key of the drawn curves: another choice is decimated anew.
type Drawn = (TrialQuantity, Option<TrialKey>);

/// View state of the curves.
#[derive(Debug, Default)]
pub(crate) struct CurvesView {
    shown: TrialQuantity,
    align: Align,
    /// Decimated once, not in each frame.
    picture: Option<(Drawn, ComparedLines)>,
    /// Curve under the pointer.
    pointed: Option<RowKey>,
    pub(crate) chart: ChartView,
}

/// Curves of trials, with their sources.
#[derive(Clone, Copy)]
struct DrawnTrials<'a> {
    pane: &'a Pane<'a>,
    comparison: &'a Comparison,
    picture: &'a ComparedLines,
    /// The highlighted trial.
    strong: Option<TrialKey>,
}

impl CurvesView {
    /// Resets the view for another comparison.
    pub(crate) fn forget(&mut self) {
        (self.picture, self.pointed) = (None, None);
        self.chart = ChartView::default();
    }

    /// Draws the curves and their choices. A click on a curve highlights its trial.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        self.choices_ui(ui, pane);
        self.chart_ui(ui, pane, comparison, strong);
    }

    /// Draws the selected curves. A click on a curve highlights its trial.
    fn chart_ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        let look = pane.look;
        let trials = &pane.state.trials;
        let drawn = (self.shown, *strong);
        let picture = self.picture.take().filter(|(own, _)| *own == drawn);
        let lines = || comparison.lines(trials, self.shown, *strong);
        let picture = picture.map_or_else(lines, |(_, own)| own);
        let trial = DrawnTrials {
            pane,
            comparison,
            picture: &picture,
            strong: *strong,
        };
        legend_ui(ui, look, &trial.legend(self.pointed));
        let (keys, curves): (Vec<_>, Vec<_>) = self.curves(trial).into_iter().unzip();
        let chart = Chart {
            curves,
            levels: match self.shown {
                TrialQuantity::Force => trial.levels(),
                _ => Vec::new(),
            },
            empty: tune::CURVES_EMPTY,
            ..Chart::new(look, tune::quantity(self.shown), ui.available_height())
        };
        let (response, near) = trial_chart_ui(ui, chart, &mut self.chart);
        self.pointed = near.and_then(|at| keys.get(at)).copied();
        if response.response.clicked() {
            let chosen = self.pointed.and_then(|key| trial.trial(key));
            *strong = chosen.filter(|_| chosen != *strong);
        }
        self.picture = Some((drawn, picture));
    }

    fn curves<'a>(&self, all: DrawnTrials<'a>) -> Vec<(RowKey, ChartCurve<'a>)> {
        let lines = &all.picture.lines;
        let any = lines.iter().any(|own| all.is_strong(own.key));
        // Without contacts there is nothing to align.
        let has_contact = lines.iter().any(|own| own.contact_s.is_some());
        let styled = lines.iter().filter_map(|own| {
            let mut curve = all.curve(own)?;
            let is_strong = all.is_strong(own.key);
            if is_strong || !any && all.is_best(own.key) || self.pointed == Some(own.key) {
                curve.stroke.width = theme::STRONG;
            }
            if any && !is_strong {
                curve.stroke.color = dash::behind(curve.stroke.color);
            }
            curve.zero[0] = match self.align {
                Align::Contact if has_contact => own.contact_s?,
                Align::Command | Align::Contact => 0.0,
            };
            Some((own.key, curve))
        });
        styled.collect()
    }

    fn choices_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            let all = TrialQuantity::ALL.map(|shown| (shown, tune::quantity(shown)));
            Pick::new(look, tune::SHOWN_TIP).ui(ui, &mut self.shown, all);
            ui.add_space(theme::PAD);
            for (align, text) in [
                (Align::Command, tune::ON_COMMAND),
                (Align::Contact, tune::ON_CONTACT),
            ] {
                let button = Button::new(look.tr(text), look.tr(tune::ALIGN_TIP));
                if button.choice(self.align == align).ui(ui, look).clicked() {
                    self.align = align;
                    self.chart.time.follow();
                }
            }
            let picture = self.picture.as_ref().map(|(_, picture)| picture);
            let warn = |ui: &mut Ui, text: &str| {
                Label::new(text, look.palette.warn).small().ui(ui);
            };
            if let Some(few) = picture.filter(|picture| picture.lines.len() < picture.all) {
                let of = look.tr(tune::OF_ALL);
                warn(ui, &format!("{} {of} {}", few.lines.len(), few.all));
            }
            let missed = picture.map_or(0, |picture| {
                let lines = picture.lines.iter();
                lines.filter(|own| own.contact_s.is_none()).count()
            });
            let has_contact = picture.is_some_and(|picture| missed < picture.lines.len());
            if self.align == Align::Contact && missed > 0 && has_contact {
                warn(ui, &look.fill(tune::NO_CONTACT_DRAWN, &[&missed]));
            }
        });
    }
}

impl<'a> DrawnTrials<'a> {
    fn row(&self, key: RowKey) -> Option<ComparedRow<'a>> {
        self.comparison.row(&self.pane.state.trials, key)
    }

    fn trial(&self, key: RowKey) -> Option<TrialKey> {
        let seen = self.row(key)?;
        Some((seen.session.id, seen.trial.number))
    }

    fn is_strong(&self, key: RowKey) -> bool {
        self.strong.is_some() && self.trial(key) == self.strong
    }

    fn is_best(&self, key: RowKey) -> bool {
        let seen = self.row(key);
        seen.is_some_and(|seen| self.comparison.is_best(seen.trial.setting))
    }

    fn style(&self, seen: ComparedRow<'_>) -> LineStyle {
        compare_list::style(self.comparison.sessions(), seen.session.id)
    }

    /// Curve in the colour of its setting, joint or session.
    fn curve(&self, own: &'a ComparedLine) -> Option<ChartCurve<'a>> {
        let seen = self.row(own.key)?;
        let color = color(self.pane, self.comparison, own.key, seen);
        Some(ChartCurve {
            style: self.style(seen),
            ..ChartCurve::new(Points::Own(&own.points), Stroke::new(theme::LINE, color))
        })
    }

    /// Levels of the tried thresholds.
    fn levels(&self) -> Vec<(f64, Color32)> {
        let forces = self.comparison.settings.iter();
        let mut levels: Vec<f64> = forces.map(|own| f64::from(own.force.get())).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let color = self.pane.look.palette.muted;
        levels.into_iter().map(|level| (level, color)).collect()
    }

    /// Legend entry of the hovered or highlighted trial, else the meaning of colours and line styles.
    fn legend(&self, pointed: Option<RowKey>) -> Vec<LegendKey> {
        let mut drawn = self.picture.lines.iter().map(|line| line.key);
        let meant = pointed.or_else(|| drawn.find(|key| self.is_strong(*key)));
        let Some((meant, seen)) = meant.and_then(|key| Some((key, self.row(key)?))) else {
            return self.keys();
        };
        let look = self.pane.look;
        let name = compare_list::name(look, seen.session.id);
        let (trial, number) = (look.tr(tune::COLUMN_TRIAL), seen.trial.number);
        let setting = setting_words(seen.trial.setting);
        let joint = look.tr(words::dof(seen.joint.dof));
        vec![LegendKey {
            words: format!("{name}  {trial} {number}  {setting}  {joint}"),
            color: color(self.pane, self.comparison, meant, seen),
            style: self.style(seen),
        }]
    }

    /// One entry per line style, then one per colour.
    fn keys(&self) -> Vec<LegendKey> {
        let look = self.pane.look;
        let mut keys = Vec::new();
        if self.comparison.sessions().len() > 1 {
            keys.extend(self.comparison.sessions().rev().map(|id| LegendKey {
                words: compare_list::name(look, id),
                color: look.palette.text,
                style: compare_list::style(self.comparison.sessions(), id),
            }));
        }
        let mut groups: Vec<LineGroup> = Vec::new();
        for line in &self.picture.lines {
            let seen = self.row(line.key);
            let group = seen.map(|seen| self.comparison.group(line.key, seen));
            groups.extend(group.filter(|group| !groups.contains(group)));
        }
        for group in groups {
            let words = match group {
                LineGroup::Joint(dof) => look.tr(words::dof(dof)).to_owned(),
                LineGroup::Setting(at) => {
                    let setting = self.comparison.settings.get(at);
                    setting.map_or_else(String::new, |own| setting_words(*own))
                }
                LineGroup::Session(_) => continue,
            };
            keys.push(LegendKey {
                words,
                color: group_color(self.pane, self.comparison, group),
                style: LineStyle::Solid,
            });
        }
        keys
    }
}

fn group_color(pane: &Pane<'_>, comparison: &Comparison, group: LineGroup) -> Color32 {
    let palette = pane.look.palette;
    let settings = &comparison.settings;
    let is_best = |at: usize| settings.get(at).is_some_and(|own| comparison.is_best(*own));
    let (at, count) = match group {
        LineGroup::Joint(dof) => return palette.dof[dof],
        LineGroup::Setting(at) if is_best(at) => return palette.ok,
        LineGroup::Setting(at) => (at, settings.len()),
        LineGroup::Session(at) => (at, comparison.sessions().len()),
    };
    let number = |count: usize| f64::from(u8::try_from(count).unwrap_or(u8::MAX));
    palette.scale(number(at) / number(count.saturating_sub(1).max(1)))
}

/// Colour of a curve, by its setting, joint or session.
pub(crate) fn color(
    pane: &Pane<'_>,
    comparison: &Comparison,
    place: RowKey,
    seen: ComparedRow<'_>,
) -> Color32 {
    group_color(pane, comparison, comparison.group(place, seen))
}

/// Draws a chart over the whole time of its curves. Returns the chart, and the index of the curve under the pointer.
pub(crate) fn trial_chart_ui(
    ui: &mut Ui,
    chart: Chart<'_>,
    view: &mut ChartView,
) -> (ChartResponse, Option<usize>) {
    let spans = chart.curves.iter().filter_map(|curve| {
        let Points::Own([first, .., last]) = curve.points else {
            return None;
        };
        Some((first[0] - curve.zero[0], last[0] - curve.zero[0]))
    });
    let (from_s, to_s) = spans.fold(None, scales::joined).unwrap_or_default();
    let to_s = to_s.max(from_s + LEAST_S);
    // The time long before a common contact is a flat line.
    let width = (to_s - from_s).min(to_s + LEAD_S);
    view.time.advance((from_s, to_s), width);
    let chart = Chart {
        times: Times::From(0.0, "0 s"),
        ..chart
    };
    let shown = chart.ui(ui, view);
    let near = chart.nearest(&shown);
    (shown, near)
}
