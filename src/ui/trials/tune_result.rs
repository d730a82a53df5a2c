//! What came out of the last series: how it ended, the gentlest setting, its curves, and what to do next. Writes nothing.

use crate::app::action::Action;
use crate::app::trials::{Comparison, TrialSession};
use crate::trials::Criterion;
use crate::trials::best::{Score, best};
use crate::ui::kit::{self, Button, Pane, ViewRequest, Weight};
use crate::ui::text::tune;
use crate::ui::trials::compare;
use crate::ui::trials::compare_best::staging;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_curves::CurvesView;
use crate::ui::view::View;
use egui::Ui;

/// What is kept between frames: figures and curves are not reckoned for each of them.
#[derive(Debug, Default)]
pub(crate) struct ResultView {
    comparison: Option<Comparison>,
    strong: Option<TrialKey>,
    /// What is shown of the curves.
    curves: CurvesView,
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
        let comparison = self.comparison(pane, session);
        let gentlest = Criterion::LeastOvershoot { steady_g: 0.0 };
        let score = best(&comparison.scores, gentlest);
        let none = || look.say(tune::BEST_NONE).to_owned();
        let words = score.map_or_else(none, |score| best_words(pane, score));
        kit::say_ui(ui, &words, palette.text);
        let device = &pane.state.hand().params;
        let staged = score.map(|score| {
            let joints = comparison.joints.iter();
            let staged = joints.flat_map(|dof| staging(*dof, score.setting));
            staged.collect::<Vec<Action>>()
        });
        let is_staged = staged.iter().flatten().all(
            |action| matches!(action, Action::Stage(id, value) if device.staged(*id) == *value),
        );
        let is_staged = is_staged && staged.is_some();
        if is_staged {
            kit::say_ui(ui, look.say(tune::STAGED_NEXT), palette.ok);
        }
        let button_ui = |ui: &mut Ui, text, weight| {
            let button = Button::said(look, text).named(look.tip(text));
            button.weight(weight).ui(ui, look).clicked()
        };
        ui.horizontal_wrapped(|ui| {
            if button_ui(ui, tune::SEE_COMPARE, Weight::Normal) {
                pane.open(ViewRequest::View(View::Compare));
            }
            if is_staged {
                if button_ui(ui, tune::SEE_DEVICE, Weight::Strong) {
                    pane.open(ViewRequest::View(View::Device));
                }
            } else if let Some(staged) = staged
                && button_ui(ui, tune::PROMOTE, Weight::Normal)
            {
                pane.actions.extend(staged);
            }
        });
        self.comparison = Some(comparison);
    }

    /// Draws the curves over each other.
    pub(crate) fn curves_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, session: &TrialSession) {
        let comparison = self.comparison(pane, session);
        self.curves
            .chart_ui(ui, pane, &comparison, &mut self.strong);
        self.comparison = Some(comparison);
    }

    /// The series alone, judged once.
    fn comparison(&mut self, pane: &Pane<'_>, session: &TrialSession) -> Comparison {
        let trials = &pane.state.trials;
        let own = [session.id];
        let former = self.comparison.take();
        if let Some(former) = former.filter(|seen| seen.stands(trials, &own, session.id)) {
            return former;
        }
        self.curves.forget();
        Comparison::of(trials, &own, session.id)
    }
}

fn best_words(pane: &Pane<'_>, score: &Score) -> String {
    let over = score.overshoot_g.map_or_else(
        || "-".to_owned(),
        |spread| {
            if spread.max - spread.min < 1.0 {
                format!("{:.0}", spread.max)
            } else {
                format!("{:.0}..{:.0}", spread.min, spread.max)
            }
        },
    );
    let setting = setting_words(score.setting);
    pane.look.fill(tune::BEST_OF, &[&setting, &over])
}
