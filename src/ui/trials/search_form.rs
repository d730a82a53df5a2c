//! The search for settings: the goal as a sentence with number fields, the progress, and the result with its actions. Every
//! change is one action with the whole goal.

use crate::app::action::Action;
use crate::app::trials::{Search, TrialAction};
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::poses::edit::LibraryEdit;
use crate::poses::library::LibraryPose;
use crate::trials::search::goal::{CLOSES_MAX, CLOSES_MIN, LIMIT_MIN_G, whole};
use crate::trials::search::{Claim, FoundApproach, SearchGoal};
use crate::ui::kit::{self, Button, NumberField, Pane, Sentence, Typing, format};
use crate::ui::text::tune::search;
use crate::ui::text::{Text, main, tune};
use crate::ui::theme;
use crate::ui::trials::promotion::Promotion;
use crate::ui::trials::tune_form::joints_ui;
use egui::{ScrollArea, Ui};
use std::ops::RangeInclusive;

pub(crate) fn ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let hand = pane.hand();
    let runs = hand.runs_series() || hand.running.awaits_arming();
    kit::put_scroll_bar_in_margin(ui);
    let area = ScrollArea::vertical().id_salt("search");
    area.auto_shrink(false).show(ui, |ui| {
        ui.add_enabled_ui(!runs, |ui| goal_ui(ui, pane, runs));
        if let Some(search) = &pane.state.trials.search {
            ui.add_space(theme::GAP);
            search_ui(ui, pane, search);
        }
    });
}

fn goal_ui(ui: &mut Ui, pane: &mut Pane<'_>, runs: bool) {
    let look = pane.look;
    let mut goal = pane.state.trials.goal.clone();
    let disabled = runs.then(|| look.tr(main::SERIES_RUNS));
    kit::small_text_ui(ui, look.tr(search::OBJECT), look.palette.muted);
    let takes_part = goal.close.map(|target| target.is_some());
    if let Some(dof) = joints_ui(ui, look, &takes_part, disabled) {
        goal.start[dof] = (!takes_part[dof]).then_some(Angle::MAX);
        goal.close[dof] = (!takes_part[dof]).then_some(Angle::MIN);
    }
    let rated = Force::RATED.get();
    let whole = |closes: usize| i16::try_from(closes).unwrap_or(i16::MAX);
    let sentence = Sentence::new(look.tr(search::GOAL), &[theme::FIELD; 3]);
    sentence.ui(ui, look, |ui, number| match number {
        0 => {
            let limit = GoalNumber(search::LIMIT, LIMIT_MIN_G..=rated);
            if let Some(limit) = limit.ui(ui, pane, goal.limit_g) {
                let was_usual = goal.hold_g == SearchGoal::usual_hold_g(goal.limit_g);
                goal.limit_g = limit;
                if was_usual {
                    goal.hold_g = SearchGoal::usual_hold_g(limit);
                }
            }
        }
        1 => {
            let holds = GoalNumber(search::HOLD, 0..=rated);
            goal.hold_g = holds.ui(ui, pane, goal.hold_g).unwrap_or(goal.hold_g);
        }
        _ => {
            let closes = GoalNumber(search::CLOSES, whole(CLOSES_MIN)..=whole(CLOSES_MAX));
            if let Some(closes) = closes.ui(ui, pane, whole(goal.closes)) {
                goal.closes = usize::try_from(closes).unwrap_or(goal.closes);
            }
        }
    });
    kit::tick_ui(ui, look, search::FREE, &mut goal.distribution_free);
    if let Err(wrong) = goal.check() {
        kit::small_text_ui(ui, &search::goal_error(look, wrong), look.palette.bad);
    }
    if goal != pane.state.trials.goal && !runs {
        *pane.typing = Typing::default();
        pane.actions
            .push(Action::Trial(TrialAction::Goal(Box::new(goal))));
    }
}

/// A number of the goal: its name and range.
struct GoalNumber(Text, RangeInclusive<i16>);

impl GoalNumber {
    /// Draws it. Returns a new number once a valid one was typed.
    fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>, value: i16) -> Option<i16> {
        let look = pane.look;
        let Self(name, range) = self;
        let (least, most) = range.into_inner();
        let field = NumberField::new(look.tr(name), look.tip(name), least.into()..=most.into());
        let typed = field.whole_ui(ui, pane, Some(value));
        typed.and_then(|typed| i16::try_from(typed).ok())
    }
}

/// Draws the progress, or the result.
fn search_ui(ui: &mut Ui, pane: &mut Pane<'_>, search: &Search) {
    let (look, palette) = (pane.look, pane.look.palette);
    let runs = pane.state.trials.running_search().is_some();
    match (&search.finding, &search.progress) {
        (Some(finding), _) => {
            match &finding.result {
                Ok(claim) => claim_ui(ui, pane, search, claim),
                Err(why) => {
                    kit::small_text_ui(ui, &search::no_claim(look, *why), palette.warn);
                }
            }
            for own in &finding.compared {
                if let Some(words) = search::compared(look, own) {
                    kit::small_text_ui(ui, &words, palette.muted);
                }
            }
            if !finding.open_questions.is_empty() {
                let untold = finding.open_questions.iter();
                let untold = untold.map(|what| search::untold(look, *what));
                let untold: Vec<String> = untold.collect();
                let words = look.fill(search::UNTOLD, &[&look.list(&untold)]);
                kit::small_text_ui(ui, &words, palette.muted);
            }
        }
        (None, Some(progress)) if runs => {
            kit::small_text_ui(ui, &search::stage(look, progress.stage), palette.text);
            let tried = progress.tried.len();
            let left = look.fill(search::LEFT, &[&tried, &progress.closes_left]);
            let time = look.fill(tune::LEFT, &[&format::duration(progress.left)]);
            kit::small_text_ui(ui, &format!("{left} {time}"), palette.muted);
        }
        (None, _) if !runs => {
            kit::small_text_ui(ui, look.tr(search::NONE), palette.muted);
        }
        (None, _) => {}
    }
}

/// Draws the result, with its actions.
fn claim_ui(ui: &mut Ui, pane: &mut Pane<'_>, search: &Search, claim: &Claim) {
    let (look, palette) = (pane.look, pane.look.palette);
    let newtons = claim.peak_bound_n(&pane.hand().newtons.all_per_g());
    kit::small_text_ui(ui, &search::claim(look, claim), palette.ok);
    if let Some(newtons) = newtons {
        let words = look.fill(search::CLAIM_N, &[&format!("{newtons:.1}")]);
        kit::small_text_ui(ui, &words, palette.muted);
    }
    let setting = claim.setting;
    let (speed, force) = (setting.speed.get(), setting.force.get());
    let words = match claim.approach {
        FoundApproach::OneStage => look.fill(search::SETTING, &[&speed, &force]),
        FoundApproach::TwoStage { fast_speed, margin } => {
            look.fill(search::TWO, &[&fast_speed, &margin, &speed, &force])
        }
    };
    kit::small_text_ui(ui, &words, palette.text);
    let joints = claim.joints.iter();
    let promotion = Promotion::of(pane, joints.map(|joint| (joint.dof, setting)), None);
    let is_full = !pane.state.poses.library.has_room();
    let full = is_full.then(|| look.tr(search::FULL));
    ui.horizontal_wrapped(|ui| {
        promotion.button_ui(ui, pane, search::AS_DEFAULT);
        let text = match claim.approach {
            FoundApproach::OneStage => search::AS_POSE,
            FoundApproach::TwoStage { .. } => search::AS_SEQUENCE,
        };
        let button = Button::text(look, text).disabled(full);
        let poses = poses(pane, search, claim);
        button.on_click(ui, pane, Action::Library(LibraryEdit::Add(poses)));
    });
    promotion.end_ui(ui, pane);
}

/// The best close as poses: with two stages, the fast one first.
fn poses(pane: &Pane<'_>, search: &Search, claim: &Claim) -> Vec<LibraryPose> {
    let (look, goal) = (pane.look, &search.goal);
    let pose = |name: Text, targets: PerDof<Option<Angle>>| LibraryPose {
        name: look.fill(name, &[&goal.limit_g]),
        leave: targets.map(|target| target.is_none()),
        force: claim.setting.force,
        ..LibraryPose::at(targets.map(|target| target.unwrap_or(Angle::MAX)))
    };
    let close = LibraryPose {
        speed: claim.setting.speed,
        ..pose(search::POSE, goal.close)
    };
    let FoundApproach::TwoStage { fast_speed, margin } = claim.approach else {
        return vec![close];
    };
    let near = PerDof::from_fn(|dof| {
        let joint = claim.joints.iter().find(|own| own.dof == dof)?;
        Some(Angle::nearest(whole(joint.contact_angle) + margin))
    });
    let near = LibraryPose {
        speed: Speed::nearest(fast_speed),
        ..pose(search::NEAR, near)
    };
    vec![near, close]
}
