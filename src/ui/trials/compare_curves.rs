//! The curves of the sessions that are shown, over each other: colours for settings or joints, strokes for sessions, and
//! which trial the pointer is at. Measures nothing.

use crate::app::trials::{
    ComparedLine, ComparedLines, ComparedRow, Comparison, LineGroup, RowKey, TrialQuantity,
};
use crate::ui::kit::{Button, Label, Pane, dash};
use crate::ui::plots::chart::{Chart, ChartView, Curve, Points};
use crate::ui::plots::legend::{Key, fits, legend_ui};
use crate::ui::text::{Text, compare, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use crate::ui::trials::plot::trial_chart_ui;
use egui::{Color32, Stroke, Ui};
use egui_plot::LineStyle;

/// More lines are never named one by one.
const LINES_NAMED: usize = 12;

/// Where the time of the curves begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Align {
    #[default]
    Command,
    Contact,
}

/// What the curves need between frames.
#[derive(Debug, Default)]
pub(crate) struct CurvesView {
    shown: TrialQuantity,
    align: Align,
    /// Thinned once, not each frame.
    picture: Option<(TrialQuantity, ComparedLines)>,
    /// The line at the pointer.
    pointed: Option<RowKey>,
    chart: ChartView,
}

/// Lines of trials, and what they are of.
#[derive(Clone, Copy)]
pub(crate) struct DrawnTrials<'a> {
    /// How they look.
    pub(crate) pane: &'a Pane<'a>,
    /// Of these sessions.
    pub(crate) comparison: &'a Comparison,
    /// What is drawn.
    pub(crate) picture: &'a ComparedLines,
}

impl CurvesView {
    /// The comparison is another one.
    pub(crate) fn forget(&mut self) {
        (self.picture, self.pointed) = (None, None);
        self.chart = ChartView::default();
    }

    /// Draws what is chosen. A pressed line stands out.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        let look = pane.look;
        self.choices_ui(ui, pane);
        let trials = &pane.state.trials;
        let shown = self.shown;
        let picture = self.picture.take().filter(|(own, _)| *own == shown);
        let picture = picture.map_or_else(|| comparison.lines(trials, shown), |(_, own)| own);
        let drawn = DrawnTrials {
            pane,
            comparison,
            picture: &picture,
        };
        legend_ui(ui, look, &drawn.legend(ui, self.pointed, *strong));
        let whole = drawn.whole(shown, *strong);
        let whole = ComparedLines {
            all: whole.len(),
            lines: whole,
        };
        let strongs = DrawnTrials {
            picture: &whole,
            ..drawn
        };
        let (keys, curves): (Vec<_>, Vec<_>) = self.curves(drawn, strongs).into_iter().unzip();
        let chart = Chart {
            curves,
            levels: match shown {
                TrialQuantity::Force => drawn.levels(),
                _ => Vec::new(),
            },
            empty: tune::CURVES_EMPTY,
            ..Chart::new(look, tune::quantity(shown), ui.available_height())
        };
        let (response, near) = trial_chart_ui(ui, chart, &mut self.chart);
        self.pointed = near.and_then(|at| keys.get(at)).copied();
        if response.response.clicked() {
            let seen = self.pointed.and_then(|place| comparison.row(trials, place));
            let chosen = seen.map(|seen| (seen.session.id, seen.trial.number));
            *strong = chosen.filter(|_| chosen != *strong);
        }
        self.picture = Some((shown, picture));
    }

    /// The lines of all, with those of the trial that stands out over them.
    fn curves<'a>(
        &self,
        all: DrawnTrials<'a>,
        strong: DrawnTrials<'a>,
    ) -> Vec<(RowKey, Curve<'a>)> {
        let is_strong = |key: RowKey| strong.picture.lines.iter().any(|own| own.key == key);
        let back = all.curves().filter(|(own, _)| !is_strong(own.key));
        let styled = back.chain(strong.curves()).filter_map(|(own, mut curve)| {
            let is_strong = is_strong(own.key);
            if is_strong || self.pointed == Some(own.key) {
                curve.stroke.width = theme::STRONG;
            }
            if strong.picture.all > 0 && !is_strong {
                curve.stroke.color = dash::behind(curve.stroke.color);
            }
            curve.zero[0] = match self.align {
                Align::Command => 0.0,
                Align::Contact => own.contact_s?,
            };
            Some((own.key, curve))
        });
        styled.collect()
    }

    fn choices_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let choice = |ui: &mut Ui, (text, tip): (Text, Text), is_chosen: bool| {
            let button = Button::new(look.say(text), look.say(tip)).choice(is_chosen);
            button.ui(ui, look).clicked()
        };
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            for shown in TrialQuantity::ALL {
                if choice(
                    ui,
                    (tune::quantity(shown), tune::SHOWN_TIP),
                    self.shown == shown,
                ) {
                    self.shown = shown;
                }
            }
            ui.add_space(theme::PAD);
            for (align, text) in [
                (Align::Command, tune::ON_COMMAND),
                (Align::Contact, tune::ON_CONTACT),
            ] {
                if choice(ui, (text, tune::ALIGN_TIP), self.align == align) {
                    self.align = align;
                    self.chart.time.follow();
                }
            }
            let picture = self.picture.as_ref().map(|(_, picture)| picture);
            if let Some(few) = picture.filter(|picture| picture.lines.len() < picture.all) {
                let text = format!(
                    "{} {} {}",
                    few.lines.len(),
                    look.say(compare::OF_ALL),
                    few.all
                );
                Label::new(&text, look.palette.warn).small().ui(ui);
            }
        });
    }
}

impl<'a> DrawnTrials<'a> {
    fn row(&self, key: RowKey) -> Option<ComparedRow<'a>> {
        self.comparison.row(&self.pane.state.trials, key)
    }

    fn is_of(&self, key: RowKey, trial: Option<TrialKey>) -> bool {
        let seen = self.row(key).filter(|_| trial.is_some());
        seen.is_some_and(|seen| trial == Some((seen.session.id, seen.trial.number)))
    }

    fn style(&self, seen: ComparedRow<'_>) -> LineStyle {
        compare_list::style(self.comparison.sessions(), seen.session.id)
    }

    /// The lines with the colours of their settings, joints or sessions.
    pub(crate) fn curves(self) -> impl Iterator<Item = (&'a ComparedLine, Curve<'a>)> {
        self.picture.lines.iter().filter_map(move |own| {
            let seen = self.row(own.key)?;
            let color = color(self.pane, self.comparison, own.key, seen);
            let mut curve = Curve::new(Points::Own(&own.points), Stroke::new(theme::LINE, color));
            curve.style = self.style(seen);
            Some((own, curve))
        })
    }

    /// The thresholds that were tried.
    pub(crate) fn levels(&self) -> Vec<(f64, Color32)> {
        let forces = self.comparison.settings.iter();
        let mut levels: Vec<f64> = forces.map(|own| f64::from(own.force.get())).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let color = self.pane.look.palette.muted;
        levels.into_iter().map(|level| (level, color)).collect()
    }

    /// The trial that stands out, with all its points: it may not be among the lines, or thinned.
    fn whole(&self, shown: TrialQuantity, strong: Option<TrialKey>) -> Vec<ComparedLine> {
        let line = |key: &RowKey| {
            let line = self.comparison.line(&self.pane.state.trials, *key)?;
            Some(ComparedLine {
                key: *key,
                contact_s: line.contact_s,
                points: line.points(shown).to_vec(),
            })
        };
        let keys = self.comparison.rows.iter();
        keys.filter(|key| self.is_of(**key, strong))
            .filter_map(line)
            .collect()
    }

    /// The trial that is meant, or every line if few are drawn, or what colours and strokes stand for.
    fn legend(&self, ui: &Ui, pointed: Option<RowKey>, strong: Option<TrialKey>) -> Vec<Key> {
        let mut drawn = self.picture.lines.iter().map(|line| line.key);
        let meant = pointed.or_else(|| drawn.find(|key| self.is_of(*key, strong)));
        let look = self.pane.look;
        let key = |key: RowKey, is_meant: bool| {
            let seen = self.row(key)?;
            let setting = setting_words(seen.trial.setting);
            let (session, number) = (seen.session.id, seen.trial.number);
            let words = if is_meant {
                let (name, trial) = (
                    compare_list::name(look, session),
                    look.say(tune::COLUMN_TRIAL),
                );
                let joint = look.say(words::dof(seen.joint.dof));
                format!("{name}  {trial} {number}  {setting}  {joint}")
            } else if self.comparison.sessions().len() > 1 {
                format!("{}: {number}  {setting}", session.0)
            } else {
                format!("{number}  {setting}")
            };
            Some(Key {
                words,
                color: color(self.pane, self.comparison, key, seen),
                style: self.style(seen),
            })
        };
        if let Some(meant) = meant.and_then(|meant| key(meant, true)) {
            return vec![meant];
        }
        let few = self.picture.lines.iter().take(LINES_NAMED + 1);
        let every: Vec<Key> = few.filter_map(|line| key(line.key, false)).collect();
        match every.len() <= LINES_NAMED && !every.is_empty() && fits(ui, &every) {
            true => every,
            false => self.keys(),
        }
    }

    /// A key for each stroke, then for each colour.
    pub(crate) fn keys(&self) -> Vec<Key> {
        let look = self.pane.look;
        let mut keys = Vec::new();
        if self.comparison.sessions().len() > 1 {
            keys.extend(self.comparison.sessions().rev().map(|id| Key {
                words: compare_list::name(look, id),
                color: look.palette.text,
                style: compare_list::style(self.comparison.sessions(), id),
            }));
        }
        let mut groups: Vec<LineGroup> = Vec::new();
        for line in &self.picture.lines {
            let group = self
                .row(line.key)
                .map(|seen| self.comparison.group(line.key, seen));
            groups.extend(group.filter(|group| !groups.contains(group)));
        }
        for group in groups {
            let words = match group {
                LineGroup::Joint(dof) => look.say(words::dof(dof)).to_owned(),
                LineGroup::Setting(at) => {
                    let setting = self.comparison.settings.get(at);
                    setting.map_or_else(String::new, |own| setting_words(*own))
                }
                LineGroup::Session(_) => continue,
            };
            keys.push(Key {
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
    let (at, count) = match group {
        LineGroup::Joint(dof) => return palette.dof[dof],
        LineGroup::Setting(at) => (at, comparison.settings.len()),
        LineGroup::Session(at) => (at, comparison.sessions().len()),
    };
    let number = |count: usize| u8::try_from(count).unwrap_or(u8::MAX);
    palette.setting(number(at), number(count))
}

/// The colour of a line: of its setting, its joint or its session.
pub(crate) fn color(
    pane: &Pane<'_>,
    comparison: &Comparison,
    place: RowKey,
    seen: ComparedRow<'_>,
) -> Color32 {
    group_color(pane, comparison, comparison.group(place, seen))
}
