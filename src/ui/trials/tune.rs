//! The view of grasp trials: the plan at the left, what it means and the series that runs at the right. Holds text in
//! progress only.

use crate::app::action::Action;
use crate::app::trials::{StartRefusal, TrialAction};
use crate::hand::impact::NOTABLE_G;
use crate::trials::estimate;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_top};
use crate::ui::kit::format;
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::text::{tune, words};
use crate::ui::theme;
use crate::ui::trials::tune_form::TuneForm;
use crate::ui::trials::tune_live;
use crate::ui::trials::tune_result::ResultView;
use crate::ui::view::View;
use egui::{Id, Rect, Ui};

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct TuneView {
    form: TuneForm,
    result: ResultView,
}

impl TuneView {
    /// Draws the view. The view that was asked for, if one was.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) -> Option<View> {
        let look = pane.look;
        let width = (rect.width() * theme::PLAN_SHARE).clamp(theme::PLAN_LEAST, theme::PLAN_MOST);
        let mut rest = rect;
        let plan = take_left(&mut rest, width);
        let (_, body) = controls::titled_card(ui, look, plan, look.say(tune::PLAN));
        self.form.ui(ui, body, pane);
        let (_, body) = controls::titled_card(ui, look, rest, look.say(tune::SERIES));
        series_ui(ui, body, pane, &mut self.result)
    }
}

fn series_ui(
    ui: &mut Ui,
    mut body: Rect,
    pane: &mut Pane<'_>,
    result: &mut ResultView,
) -> Option<View> {
    let trials = &pane.state.trials;
    if pane.state.hand().runs_series() {
        tune_live::live_ui(ui, body, pane, &mut result.chart);
        return None;
    }
    let last = trials.last.and_then(|id| trials.session(id));
    start_ui(ui, take_top(&mut body, theme::CONTROL_LARGE), pane);
    let (height, words) = (body.height(), theme::RESULT_WORDS);
    let curves = (height - words).max(height * theme::RESULT_SHARE);
    if let Some(session) = last.filter(|_| curves >= theme::TRIAL_PLOT_LEAST) {
        let (above, below) = body.split_top_bottom_at_y(body.bottom() - curves);
        body = above.with_max_y(above.bottom() - theme::GAP);
        result.curves_ui(ui, below, pane, session);
    }
    let mut asked = None;
    list::scroll_ui(ui, body, "trial series", |ui, width| {
        let look = pane.look;
        if let Some(reason) = refusal(pane) {
            list::wrapped_ui(ui, width, 0.0, &reason, look.palette.warn);
            list::piece(ui, width, theme::STEP);
        }
        if let Some(session) = last {
            asked = result.lines_ui(ui, width, pane, session);
            list::piece(ui, width, theme::GAP);
        }
        meaning_ui(ui, width, pane);
        if last.is_none() {
            list::piece(ui, width, theme::GAP);
            first_ui(ui, width, pane);
        }
    });
    asked
}

/// Why the series cannot begin, in words.
fn refusal(pane: &Pane<'_>) -> Option<String> {
    let look = pane.look;
    let state = pane.state;
    if !state.hand().link.state.is_live() {
        return Some(look.say(tune::NEED_HAND).into());
    }
    if state.trials.plan.check().is_err() {
        return Some(look.say(tune::PLAN_WRONG).into());
    }
    state
        .hand()
        .start_refusal(&state.trials.plan)
        .map(|why| match why {
            StartRefusal::NotArmed => look.say(tune::NEED_ARM).into(),
            StartRefusal::Runs => look.say(tune::RUNS).into(),
            StartRefusal::Locked(dof) => {
                let joint = look.say(words::dof(dof));
                format!("{joint} {}", look.say(tune::NEED_FREE))
            }
        })
}

fn start_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let reason = refusal(pane);
    let button = Button::new(
        look.say(tune::START_BUTTON),
        look.say(tune::START_BUTTON_TIP),
    )
    .disabled(reason.as_deref())
    .weight(Weight::Strong);
    if button
        .put(ui, look, rect, Id::unique("start trials"))
        .clicked()
    {
        pane.actions.push(Action::Trial(TrialAction::Start));
    }
}

/// What will happen, and how hard it may hit.
fn meaning_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>) {
    let look = pane.look;
    let plan = &pane.state.trials.plan;
    if plan.check().is_err() {
        return;
    }
    let (count, time) = estimate::series(plan);
    let joints: Vec<&str> = plan.joints().map(|dof| look.say(words::dof(dof))).collect();
    let text = format!(
        "{} {}. {} {count}, {} {}.",
        look.say(tune::WILL_CLOSE),
        joints.join(", "),
        look.say(tune::WILL),
        look.say(tune::WILL_TAKE),
        format::duration(time)
    );
    list::wrapped_ui(ui, width, 0.0, &text, look.palette.text);
    if count > plan.grid.settings().len() {
        let probe = look.say(tune::WILL_PROBE);
        list::wrapped_ui(ui, width, 0.0, probe, look.palette.muted);
    }
    if let Some((setting, peak)) = plan.expected() {
        let rough = peak >= NOTABLE_G;
        let color = if rough {
            look.palette.warn
        } else {
            look.palette.muted
        };
        let text = format!(
            "{} {peak:.0} g ({} {}, {} {} g).",
            look.say(tune::EXPECT),
            look.say(tune::SPEED),
            setting.speed.get(),
            look.say(tune::THRESHOLD),
            setting.force.get()
        );
        list::wrapped_ui(ui, width, 0.0, &text, color);
        if rough {
            let why = look.say(tune::EXPECT_WHY);
            list::wrapped_ui(ui, width, 0.0, why, look.palette.muted);
        }
    }
    list::wrapped_ui(ui, width, 0.0, look.say(tune::ANY_KEY), look.palette.muted);
}

/// Before the first series: what to do.
fn first_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>) {
    let look = pane.look;
    let title = list::piece(ui, width, theme::TITLE_LINE);
    Label::new(look.say(tune::IDLE_TITLE), look.palette.text).put(ui, title);
    let body = look.say(tune::IDLE_BODY);
    list::wrapped_ui(ui, width, 0.0, body, look.palette.muted);
}
