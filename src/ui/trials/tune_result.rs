//! What came out of the last series: how it ended, the gentlest setting, its curves, and what to do next. Writes nothing.

use crate::app::action::Action;
use crate::app::trials::{ComparedLines, Comparison, TrialQuantity, TrialSession};
use crate::params::rows::{ParamId, Value};
use crate::trials::Criterion;
use crate::trials::best::{Score, best};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Weight, take_left};
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::plots::chart::{Chart, ChartView};
use crate::ui::plots::legend::legend_ui;
use crate::ui::text::{Text, trials, tune};
use crate::ui::theme;
use crate::ui::trials::compare_best::staging;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_curves::DrawnTrials;
use crate::ui::trials::plot::trial_chart_ui;
use crate::ui::view::View;
use egui::{Color32, Id, Rect, Ui, UiBuilder};

/// What is kept between frames: figures and curves are not reckoned for each of them.
#[derive(Debug, Default)]
pub(crate) struct ResultView {
    seen: Option<(Comparison, ComparedLines)>,
    /// What is shown of the curves.
    pub(crate) chart: ChartView,
}

impl ResultView {
    /// How it ended, the best and the next step, as lines of a list. The view that was asked for, if one was.
    pub(crate) fn lines_ui(
        &mut self,
        ui: &mut Ui,
        width: f32,
        pane: &mut Pane<'_>,
        session: &TrialSession,
    ) -> Option<View> {
        let (text, color) = outcome(pane, session);
        list::wrapped_ui(ui, width, 0.0, &text, color);
        let (comparison, _) = self.seen(pane, session);
        let gentlest = Criterion::LeastOvershoot { steady_g: 0.0 };
        let score = best(&comparison.scores, gentlest).cloned();
        let joints = comparison.joints.to_vec();
        let look = pane.look;
        let words = score.as_ref().map_or_else(
            || look.say(tune::BEST_NONE).to_owned(),
            |score| best_words(pane, score),
        );
        list::wrapped_ui(ui, width, 0.0, &words, look.palette.text);
        let staged = score.as_ref().is_some_and(|score| {
            let speed = Value::Number(score.setting.speed.get().into());
            let force = Value::Number(score.setting.force.get().into());
            joints.iter().all(|dof| {
                let device = &pane.state.hand().params;
                device.staged(ParamId::DefaultSpeed(*dof)) == Some(speed)
                    && device.staged(ParamId::DefaultForce(*dof)) == Some(force)
            })
        });
        if staged {
            let next = look.say(tune::STAGED_NEXT);
            list::wrapped_ui(ui, width, 0.0, next, look.palette.ok);
        }
        list::piece(ui, width, theme::STEP);
        let mut row = list::piece(ui, width, theme::CONTROL);
        let mut asked = None;
        if button_ui(
            ui,
            &mut row,
            pane,
            (tune::SEE_COMPARE, tune::SEE_COMPARE_TIP),
        ) {
            asked = Some(View::Compare);
        }
        if staged {
            if button_ui(ui, &mut row, pane, (tune::SEE_DEVICE, tune::SEE_DEVICE_TIP)) {
                asked = Some(View::Device);
            }
        } else if let Some(score) = score
            && button_ui(ui, &mut row, pane, (tune::PROMOTE, tune::PROMOTE_TIP))
        {
            let all = joints.iter().flat_map(|dof| staging(*dof, score.setting));
            pane.actions.extend(all.collect::<Vec<Action>>());
        }
        asked
    }

    /// The force of all its trials over each other, and what their colours stand for.
    pub(crate) fn curves_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        session: &TrialSession,
    ) {
        let look = pane.look;
        let mut chart = std::mem::take(&mut self.chart);
        let (comparison, picture) = self.seen(pane, session);
        let drawn = DrawnTrials {
            pane,
            comparison,
            picture,
        };
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            legend_ui(ui, look, &drawn.keys());
            let force = Chart {
                curves: drawn.curves().map(|(_, curve)| curve).collect(),
                levels: drawn.levels(),
                empty: tune::CURVES_EMPTY,
                ..Chart::new(look, tune::SHOW_FORCE, ui.available_height())
            };
            trial_chart_ui(ui, force, &mut chart);
        });
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

fn button_ui(ui: &mut Ui, row: &mut Rect, pane: &Pane<'_>, (text, tip): (Text, Text)) -> bool {
    let look = pane.look;
    let (words, tip) = (look.say(text), look.say(tip));
    let room = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
    let weight = match text == tune::SEE_DEVICE {
        true => Weight::Strong,
        false => Weight::Normal,
    };
    let button = Button::new(words, tip).named(tip).weight(weight);
    let place = take_left(row, room);
    let id = Id::unique(("series result", text.en));
    button.put(ui, look, place, id).clicked()
}

fn best_words(pane: &Pane<'_>, score: &Score) -> String {
    let look = pane.look;
    let setting = setting_words(score.setting);
    let over = score.overshoot_g.map_or_else(
        || "-".to_owned(),
        |spread| match spread.max - spread.min < 1.0 {
            true => format!("{:.0}", spread.max),
            false => format!("{:.0}..{:.0}", spread.min, spread.max),
        },
    );
    let (best, above) = (look.say(tune::LEAST_OVER), look.say(tune::ABOVE));
    format!("{best}: {setting}, {above} {over} g")
}

fn outcome(pane: &Pane<'_>, session: &TrialSession) -> (String, Color32) {
    let look = pane.look;
    let last = look.say(tune::LAST);
    match &session.head.aborted {
        None => {
            let done = look.say(tune::ALL_DONE);
            (format!("{last} {done}"), look.palette.ok)
        }
        Some(why) => {
            let why = trials::ended(look, why);
            (format!("{last} {why}"), look.palette.warn)
        }
    }
}
