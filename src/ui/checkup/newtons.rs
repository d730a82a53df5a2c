//! The calibration of a joint's force with a kitchen scale: what is known of each finger, and the loads while one is measured. Stores the
//! chosen finger and the limit only; every change is an action.

use crate::app::action::Action;
use crate::app::hand::scale::{ScaleAction, ScaleMotion};
use crate::hand::newtons::{LEAST_LIMIT_G, LOADS, MOST_LIMIT_G, READING_MAX_G};
use crate::hand::{Dof, Finger, Force};
use crate::ui::kit::{self, Button, Label, NumberField, Pane, Weight};
use crate::ui::text::{checkup, words};
use crate::ui::theme;
use egui::{Ui, vec2};

/// View state.
#[derive(Debug)]
pub(super) struct NewtonsPanel {
    dof: Dof,
    limit: Force,
}

impl Default for NewtonsPanel {
    fn default() -> Self {
        Self {
            dof: Dof::Index,
            limit: Force::nearest(400),
        }
    }
}

impl NewtonsPanel {
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.separator();
        let title = Label::text(look, checkup::NEWTONS).ui(ui);
        title.on_hover_text(look.tr(checkup::NEWTONS_ABOUT));
        if pane.hand().running.calibrates() {
            running_ui(ui, pane);
            return;
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
            for dof in Finger::ALL.map(Finger::bend) {
                let tip = known(pane, dof);
                let name = look.tr(words::finger(dof.finger()));
                let button = Button::new(name, &tip).switch(dof == self.dof);
                let response = button.ui(ui, look);
                if kit::pressed(ui, &response) {
                    self.dof = dof;
                }
            }
        });
        let chosen = look.pair(
            look.tr(words::finger(self.dof.finger())),
            &known(pane, self.dof),
        );
        Label::new(&chosen, look.palette.text).wrap().ui(ui);
        self.start_ui(ui, pane);
        end_ui(ui, pane);
    }

    fn start_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal(|ui| {
            Label::muted(look, checkup::SCALE_LIMIT).ui(ui);
            let (name, tip) = (
                look.tr(checkup::SCALE_LIMIT),
                look.tip(checkup::SCALE_LIMIT),
            );
            let range = f64::from(LEAST_LIMIT_G)..=f64::from(MOST_LIMIT_G);
            let limit = NumberField::new(name, tip, range);
            if let Some(typed) = limit.whole_ui(ui, pane, Some(self.limit.get())) {
                self.limit = Force::nearest(typed);
            }
        });
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
            let start = Button::text(look, checkup::SCALE_START).disabled(pane.unready());
            let action = ScaleAction::Start(self.dof, self.limit);
            start.on_click(ui, pane, Action::Scale(action));
            if pane.hand().newtons.points(self.dof).is_some() {
                let forget = Button::text(look, checkup::SCALE_FORGET);
                forget.on_click(ui, pane, Action::Scale(ScaleAction::Forget(self.dof)));
            }
        });
    }
}

/// What is known of a joint.
fn known(pane: &Pane<'_>, dof: Dof) -> String {
    let look = pane.look;
    let Some(points) = pane.hand().newtons.points(dof) else {
        return look.tr(checkup::SCALE_NONE).to_owned();
    };
    match points.scale() {
        Ok(scale) => look.fill(
            checkup::SCALE_KNOWN,
            &[
                &format!("{:.2}", 100.0 * scale.newtons_per_g),
                &format!("{:.1}", 100.0 * scale.bound),
                &points.day,
            ],
        ),
        Err(_) => look.fill(checkup::SCALE_PART, &[&points.points.len(), &LOADS]),
    }
}

/// Draws the load that is measured.
fn running_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let Some(run) = pane.hand().running.scale() else {
        return;
    };
    let joint = look.tr(words::finger(run.dof.finger()));
    let (done, asked, doubt) = (run.points.len(), run.asked, run.doubt);
    let words = match asked {
        Some((load, hand_g)) => {
            let grams = format!("{hand_g:.0}");
            look.fill(checkup::SCALE_ASK, &[&(load + 1), &LOADS, &joint, &grams])
        }
        None => look.fill(checkup::SCALE_PRESSING, &[&joint]),
    };
    Label::new(&words, palette.text).wrap().ui(ui);
    if doubt.is_some() {
        kit::small_text_ui(ui, look.tr(checkup::SCALE_DOUBT), palette.warn);
    }
    kit::progress_ui(ui, look, look.tr(checkup::NEWTONS), kit::share(done, LOADS));
    let waits = asked.is_none().then(|| look.tr(checkup::SCALE_WAITS));
    ui.horizontal(|ui| {
        let (name, tip) = (
            look.tr(checkup::SCALE_SHOWS),
            look.tip(checkup::SCALE_SHOWS),
        );
        Label::muted(look, checkup::SCALE_SHOWS).ui(ui);
        let field = NumberField::new(name, tip, 0.0..=READING_MAX_G)
            .needs_enter()
            .decimals(1)
            .disabled(waits);
        if let Some(grams) = field.ui(ui, pane, None) {
            pane.actions
                .push(Action::Scale(ScaleAction::Reading(grams)));
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
        for (text, action) in [
            (checkup::SCALE_AGAIN, ScaleAction::Again),
            (checkup::SCALE_SKIP, ScaleAction::Skip),
        ] {
            let button = Button::text(look, text).disabled(waits);
            button.on_click(ui, pane, Action::Scale(action));
        }
        let finish = Button::text(look, checkup::SCALE_FINISH).weight(Weight::Strong);
        finish.on_click(ui, pane, Action::Scale(ScaleAction::Finish));
    });
}

/// Draws how the last calibration ended.
fn end_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let run: Option<&ScaleMotion> = pane.hand().running.scale();
    let Some((run, end)) = run.and_then(|run| Some((run, run.end?))) else {
        return;
    };
    let words = look.pair(
        look.tr(words::finger(run.dof.finger())),
        &checkup::scale_end(look, end),
    );
    let color = if end.is_ok() {
        palette.text
    } else {
        palette.warn
    };
    kit::small_text_ui(ui, &words, color);
}
