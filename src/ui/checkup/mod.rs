//! The check-up of the hand: preconditions and progress at the left, results of the last one beside them. Stores check boxes
//! only; every change is an action.

mod newtons;
mod report;
mod table;

use crate::app::action::Action;
use crate::app::checkup::{CheckupAction, CheckupRun};
use crate::checkup::{CheckupPlan, expected};
use crate::ui::checkup::newtons::NewtonsPanel;
use crate::ui::checkup::report::ReportView;
use crate::ui::kit::{
    self, Button, Label, Look, Pane, StartButton, StartWish, Weight, format, start_refused,
};
use crate::ui::text::{checkup, tune, words};
use crate::ui::theme;
use egui::{Panel, Ui};

/// View state.
#[derive(Debug, Default)]
pub(crate) struct CheckupPanel {
    is_empty: bool,
    plan: CheckupPlan,
    start: StartButton,
    newtons: NewtonsPanel,
    report: ReportView,
}

impl CheckupPanel {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let width = (ui.available_width() * 0.22).clamp(232.0, 300.0);
        kit::bare(Panel::left("checkup"), width, theme::GAP_RIGHT).show(ui, |ui| {
            kit::full_card_ui(ui, look, |ui| {
                ui.spacing_mut().item_spacing.y = theme::GAP;
                kit::head_ui(ui, look, look.tr(checkup::TITLE), |_| ());
                match pane.hand().running.checkup_run() {
                    Some(run) => {
                        // The user's confirmation does not apply to the next check-up.
                        self.is_empty = false;
                        if progress_ui(ui, pane, run) {
                            pane.actions.push(Action::Stop);
                        }
                    }
                    None => {
                        kit::put_scroll_bar_in_margin(ui);
                        egui::ScrollArea::vertical().show(ui, |ui| {
                            self.begin_ui(ui, pane);
                            self.newtons.ui(ui, pane);
                        });
                    }
                }
            });
        });
        self.report.ui(ui, pane);
    }

    fn begin_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let (look, palette) = (pane.look, pane.look.palette);
        let time = format::duration(expected(self.plan));
        let about = kit::small_text_ui(ui, &look.fill(checkup::ABOUT, &[&time]), palette.muted);
        about.on_hover_text(look.tip(checkup::ABOUT));
        let ticks = [
            (&mut self.is_empty, checkup::EMPTY),
            (&mut self.plan.press, checkup::PRESS),
        ];
        for (is_on, text) in ticks {
            kit::tick_ui(ui, look, text, is_on);
        }
        let unsaid = (!self.is_empty).then_some(checkup::SAY_EMPTY);
        let refusal = pane.hand().series_refusal(None);
        let plan = self.plan;
        let all = [CheckupAction::Start(plan), CheckupAction::ArmAndStart(plan)];
        let [start, arm] = all.map(Action::Checkup);
        let wish = StartWish {
            refused: start_refused(pane, unsaid, refusal),
            start: (checkup::START, start),
            arm_and_start: (checkup::ARM_AND_START, arm),
        };
        self.start.ui(ui, pane, wish);
    }
}

/// Draws the progress. True if the user ends the check-up.
fn progress_ui(ui: &mut Ui, pane: &Pane<'_>, run: &CheckupRun) -> bool {
    let (look, palette) = (pane.look, pane.look.palette);
    let view = run.view;
    let name = look.tr(checkup::PROGRESS);
    let (step, total) = (view.done + 1, view.total);
    let words = look.fill(checkup::STEP, &[&step, &total, &doing(look, run)]);
    let label = Label::new(&words, palette.text).large().wrap();
    label.named(name).ui(ui);
    if let Some(finger) = view.press {
        let words = look.fill(checkup::PRESS_NOW, &[&look.tr(words::finger(finger))]);
        kit::small_text_ui(ui, &words, palette.accent);
    }
    kit::progress_ui(ui, look, name, kit::share(view.done, total));
    let left = format::duration(run.left(pane.state.now));
    kit::small_text_ui(ui, &look.fill(tune::LEFT, &[&left]), palette.muted);
    kit::small_text_ui(ui, look.tr(tune::ANY_KEY), palette.muted);
    let button = Button::text(look, checkup::END).weight(Weight::Danger);
    let response = button.large().ui(ui, look);
    kit::pressed(ui, &response)
}

/// The joint that moves now, or the fingertip to press.
fn doing(look: Look, run: &CheckupRun) -> &'static str {
    let joint = run.view.joint.map(words::dof);
    let finger = run.view.press.map(words::finger);
    look.tr(joint.or(finger).unwrap_or(checkup::ALL_JOINTS))
}
