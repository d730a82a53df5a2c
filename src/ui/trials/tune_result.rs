//! What came out of the last series: how it ended, the gentlest setting, its curves, and what to do next. Writes nothing.

use crate::app::trials::{ComparedLines, Comparison, TrialQuantity, TrialSession};
use crate::params::rows::{ParamId, Value};
use crate::trials::Criterion;
use crate::trials::best::{Score, best};
use crate::ui::kit::{self, Button, Opens, Pane, Weight};
use crate::ui::plots::chart::{Chart, ChartView};
use crate::ui::plots::legend::legend_ui;
use crate::ui::text::tune;
use crate::ui::trials::compare;
use crate::ui::trials::compare_best::staging;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_curves::DrawnTrials;
use crate::ui::trials::plot::trial_chart_ui;
use crate::ui::view::View;
use egui::Ui;

/// What is kept between frames: figures and curves are not reckoned for each of them.
#[derive(Debug, Default)]
pub(crate) struct ResultView {
    seen: Option<(Comparison, ComparedLines)>,
    /// What is shown of the curves.
    chart: ChartView,
}

impl ResultView {
    /// How it ended, where it lies, the best and the next step.
    pub(crate) fn lines_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, session: &TrialSession) {
        let (look, palette) = (pane.look, pane.look.palette);
        let (ended, color) = match &session.head.aborted {
            None => (look.say(tune::ALL_DONE).to_owned(), palette.ok),
            Some(why) => (tune::ended(look, why), palette.warn),
        };
        kit::say_ui(ui, &look.fill(tune::LAST, &[&ended]), color);
        let (told, color) = compare::told(pane.state, look, Some(session));
        kit::say_ui(ui, &told, color);
        let (comparison, _) = self.seen(pane, session);
        let gentlest = Criterion::LeastOvershoot { steady_g: 0.0 };
        let score = best(&comparison.scores, gentlest);
        let none = || look.say(tune::BEST_NONE).to_owned();
        let words = score.map_or_else(none, |score| best_words(pane, score));
        kit::say_ui(ui, &words, palette.text);
        let device = &pane.state.hand().params;
        let is_staged = score.is_some_and(|score| {
            let number = |number: i16| Some(Value::Number(number.into()));
            let (speed, force) = (score.setting.speed.get(), score.setting.force.get());
            comparison.joints.iter().all(|dof| {
                device.staged(ParamId::DefaultSpeed(*dof)) == number(speed)
                    && device.staged(ParamId::DefaultForce(*dof)) == number(force)
            })
        });
        if is_staged {
            kit::say_ui(ui, look.say(tune::STAGED_NEXT), palette.ok);
        }
        let button_ui = |ui: &mut Ui, text, weight| {
            let button = Button::said(look, text).named(look.tip(text));
            button.weight(weight).ui(ui, look).clicked()
        };
        ui.horizontal_wrapped(|ui| {
            if button_ui(ui, tune::SEE_COMPARE, Weight::Normal) {
                pane.open(Opens::View(View::Compare));
            }
            if is_staged {
                if button_ui(ui, tune::SEE_DEVICE, Weight::Strong) {
                    pane.open(Opens::View(View::Device));
                }
            } else if let Some(score) = score
                && button_ui(ui, tune::PROMOTE, Weight::Normal)
            {
                let joints = comparison.joints.iter();
                let all = joints.flat_map(|dof| staging(*dof, score.setting));
                pane.actions.extend(all);
            }
        });
    }

    /// The force of all its trials over each other, and what their colours stand for.
    pub(crate) fn curves_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, session: &TrialSession) {
        let look = pane.look;
        let mut chart = std::mem::take(&mut self.chart);
        let (comparison, picture) = self.seen(pane, session);
        let drawn = DrawnTrials {
            pane,
            comparison,
            picture,
        };
        legend_ui(ui, look, &drawn.keys());
        let force = Chart {
            curves: drawn.curves().map(|(_, curve)| curve).collect(),
            levels: drawn.levels(),
            empty: tune::CURVES_EMPTY,
            ..Chart::new(
                look,
                tune::quantity(TrialQuantity::Force),
                ui.available_height(),
            )
        };
        trial_chart_ui(ui, force, &mut chart);
        self.chart = chart;
    }

    fn seen(&mut self, pane: &Pane<'_>, session: &TrialSession) -> &(Comparison, ComparedLines) {
        let trials = &pane.state.trials;
        let own = [session.id];
        let stands = |seen: &(Comparison, ComparedLines)| seen.0.stands(trials, &own, session.id);
        if !self.seen.as_ref().is_some_and(stands) {
            self.seen = None;
        }
        self.seen.get_or_insert_with(|| {
            let comparison = Comparison::of(trials, &own, session.id);
            let picture = comparison.lines(trials, TrialQuantity::Force);
            (comparison, picture)
        })
    }
}

fn best_words(pane: &Pane<'_>, score: &Score) -> String {
    let over = score.overshoot_g.map_or_else(
        || "-".to_owned(),
        |spread| match spread.max - spread.min < 1.0 {
            true => format!("{:.0}", spread.max),
            false => format!("{:.0}..{:.0}", spread.min, spread.max),
        },
    );
    let setting = setting_words(score.setting);
    pane.look.fill(tune::BEST_OF, &[&setting, &over])
}
