//! The search for settings: what is wanted as a sentence whose figures are fields, how far it is, and what it came to with what
//! is done with it. Every change is one action with the whole goal.

use crate::app::action::Action;
use crate::app::params::{ParamAction, ParamRefusal};
use crate::app::trials::{Search, TrialAction};
use crate::hand::{Angle, Dof, PerDof, Speed};
use crate::params::values::Params;
use crate::poses::edit::LibraryEdit;
use crate::poses::library::LibraryPose;
use crate::trials::search::goal::whole;
use crate::trials::search::{Claim, FoundApproach, SearchGoal};
use crate::ui::kit::{self, Button, Label, NumberField, Pane, Weight, format};
use crate::ui::text::tune::search;
use crate::ui::text::{Text, device, main, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_best::{defaults, kept_ui};
use crate::ui::trials::tune_form::CAPTION;
use egui::{ScrollArea, Ui, vec2};
use std::ops::RangeInclusive;

/// Draws it over all of `ui`.
pub(crate) fn ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let hand = pane.state.hand();
    let runs = hand.series.is_some() || hand.series_asked.is_some();
    ScrollArea::vertical()
        .id_salt("search")
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.add_enabled_ui(!runs, |ui| wish_ui(ui, pane, runs));
            if let Some(search) = &pane.state.trials.search {
                ui.add_space(theme::GAP);
                search_ui(ui, pane, search);
            }
        });
}

fn wish_ui(ui: &mut Ui, pane: &mut Pane<'_>, runs: bool) {
    let look = pane.look;
    let mut goal = pane.state.trials.goal.clone();
    let disabled = runs.then(|| look.say(main::SERIES_RUNS));
    kit::say_ui(ui, look.say(search::OBJECT), look.palette.muted);
    row_ui(ui, pane, tune::JOINTS, |ui, pane| {
        joints_ui(ui, pane, &mut goal, disabled)
    });
    if let Some(limit) = number_ui(ui, pane, search::LIMIT, (30..=2000, goal.limit_g)) {
        let was_usual = goal.hold_g == SearchGoal::usual_hold_g(goal.limit_g);
        goal.limit_g = limit;
        if was_usual {
            goal.hold_g = SearchGoal::usual_hold_g(limit);
        }
    }
    if let Some(hold) = number_ui(ui, pane, search::HOLD, (0..=1600, goal.hold_g)) {
        goal.hold_g = hold;
    }
    let closes = i16::try_from(goal.closes).unwrap_or(i16::MAX);
    if let Some(closes) = number_ui(ui, pane, search::CLOSES, (5..=100, closes)) {
        goal.closes = usize::try_from(closes).unwrap_or(goal.closes);
    }
    row_ui(ui, pane, Text::new("", ""), |ui, _| {
        let tick = ui.checkbox(&mut goal.distribution_free, look.say(search::FREE));
        tick.on_hover_text(look.tip(search::FREE));
    });
    if let Err(wrong) = goal.check() {
        kit::say_ui(ui, &search::wish_error(look, wrong), look.palette.bad);
    }
    if goal != pane.state.trials.goal && !runs {
        pane.actions
            .push(Action::Trial(TrialAction::Goal(Box::new(goal))));
    }
}

fn joints_ui(ui: &mut Ui, pane: &Pane<'_>, goal: &mut SearchGoal, disabled: Option<&str>) {
    let look = pane.look;
    let width = (ui.available_width() - theme::STEP) / 2.0;
    ui.vertical(|ui| {
        for pair in Dof::ALL.chunks(2) {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = theme::STEP;
                for dof in pair.iter().copied() {
                    let takes_part = goal.close[dof].is_some();
                    let joint = look.say(words::dof(dof));
                    let name = look.fill(tune::JOINT_NAME, &[&joint]);
                    let button = Button::new(joint, look.say(tune::JOINT_TIP)).named(&name);
                    let button = button.disabled(disabled).switch(takes_part);
                    let (id, place) = ui.allocate_space(vec2(width, theme::CONTROL));
                    if button.put(ui, look, place, id).clicked() {
                        goal.start[dof] = (!takes_part).then_some(Angle::MAX);
                        goal.close[dof] = (!takes_part).then_some(Angle::MIN);
                    }
                }
            });
        }
    });
}

/// A number in a row of its own; it, once one that can be taken was typed.
fn number_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    name: Text,
    (range, value): (RangeInclusive<i16>, i16),
) -> Option<i16> {
    let look = pane.look;
    let (least, most) = range.into_inner();
    let field = NumberField::new(look.say(name), look.tip(name), least.into()..=most.into());
    let typed = row_ui(ui, pane, name, |ui, pane| {
        field.whole_ui(ui, pane, Some(value))
    });
    typed.and_then(|typed| i16::try_from(typed).ok())
}

fn row_ui<R>(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    caption: Text,
    field: impl FnOnce(&mut Ui, &mut Pane<'_>) -> R,
) -> R {
    let (caption, muted) = (pane.look.say(caption), pane.look.palette.muted);
    let row = ui.horizontal_top(|ui| {
        kit::cell_ui(ui, vec2(CAPTION, theme::CONTROL), |ui| {
            Label::new(caption, muted).small().ui(ui);
        });
        field(ui, pane)
    });
    row.inner
}

/// How far it is, or what it came to.
fn search_ui(ui: &mut Ui, pane: &mut Pane<'_>, search: &Search) {
    let (look, palette) = (pane.look, pane.look.palette);
    let runs = pane.state.trials.running == Some(search.session);
    match (&search.finding, &search.progress) {
        (Some(finding), _) => {
            match &finding.result {
                Ok(claim) => claim_ui(ui, pane, search, claim),
                Err(why) => {
                    kit::say_ui(ui, &search::no_claim(look, *why), palette.warn);
                }
            }
            if !finding.untold.is_empty() {
                let untold = finding
                    .untold
                    .iter()
                    .map(|what| search::untold(look, *what));
                let untold: Vec<String> = untold.collect();
                let untold: Vec<&str> = untold.iter().map(String::as_str).collect();
                let words = look.fill(search::UNTOLD, &[&look.list(&untold)]);
                kit::say_ui(ui, &words, palette.muted);
            }
        }
        (None, Some(progress)) if runs => {
            kit::say_ui(ui, &search::stage(look, progress.stage), palette.text);
            let counts: [&dyn std::fmt::Display; 2] =
                [&progress.tried.len(), &progress.closes_left];
            let left = look.fill(search::LEFT, &counts);
            let time = look.fill(tune::LEFT, &[&format::duration(progress.left)]);
            kit::say_ui(ui, &format!("{left} {time}"), palette.muted);
        }
        (None, _) if !runs => {
            kit::say_ui(ui, look.say(search::NONE), palette.muted);
        }
        (None, _) => {}
    }
}

/// The claim, and what is done with it.
fn claim_ui(ui: &mut Ui, pane: &mut Pane<'_>, search: &Search, claim: &Claim) {
    let (look, palette) = (pane.look, pane.look.palette);
    kit::say_ui(ui, &search::claim(look, claim), palette.ok);
    let setting = claim.setting;
    let (speed, force) = (setting.speed.get(), setting.force.get());
    let words = match claim.approach {
        FoundApproach::OneStage => look.fill(search::SETTING, &[&speed, &force]),
        FoundApproach::TwoStage { fast_speed, margin } => {
            look.fill(search::TWO, &[&fast_speed, &margin, &speed, &force])
        }
    };
    kit::say_ui(ui, &words, palette.text);
    let mut values = Params::default();
    for joint in &claim.joints {
        for (id, value) in defaults(joint.dof, setting) {
            values.put(id, value);
        }
    }
    let hand = pane.state.hand();
    let refusal = hand
        .params
        .save_refusal_with(&values, &hand.connection.status);
    // A hand that was just tried is soon seen to rest: only who asks is told.
    let passes = refusal == Some(ParamRefusal::Moving);
    let refusal = refusal.map(|why| look.say(device::refusal(why)));
    let refusal = pane.recorded().or(refusal);
    let is_full = !pane.state.poses.library.has_room();
    let full = is_full.then(|| look.say(search::FULL));
    ui.horizontal_wrapped(|ui| {
        let button = Button::said(look, search::AS_DEFAULT).weight(Weight::Strong);
        if button.disabled(refusal).ui(ui, look).clicked() {
            let staged = values.iter();
            let staged = staged.map(|(id, value)| Action::Stage(id, Some(value)));
            pane.actions.extend(staged);
            pane.actions.push(Action::Param(ParamAction::Save));
        }
        let text = match claim.approach {
            FoundApproach::OneStage => search::AS_POSE,
            FoundApproach::TwoStage { .. } => search::AS_SEQUENCE,
        };
        let button = Button::said(look, text).disabled(full);
        let poses = poses(pane, search, claim);
        button.on_click(ui, pane, Action::Library(LibraryEdit::Add(poses)));
    });
    kept_ui(ui, pane, &values, refusal.filter(|_| !passes));
}

/// The close that was found as poses: where it has two stages, the fast one first.
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
