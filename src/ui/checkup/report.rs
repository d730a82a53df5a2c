//! Results of the last check-up.

use crate::app::action::Action;
use crate::app::checkup::ShownCheckup;
use crate::app::files::export::Export;
use crate::app::recordings::RecordingAction;
use crate::checkup::subject::Grade;
use crate::checkup::trend::day;
use crate::ui::checkup::table;
use crate::ui::hand::panel::StillHand;
use crate::ui::kit::{self, Button, Label, Pane};
use crate::ui::text::{checkup, tune};
use crate::ui::theme;
use crate::ui::touch::heat;
use egui::Ui;

/// View state of the report.
#[derive(Debug, Default)]
pub(super) struct ReportView {
    /// Only values that are not fine.
    only: bool,
    hand: StillHand,
}

impl ReportView {
    /// Draws the report over all of `ui`.
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let (look, state) = (pane.look, pane.state);
        let own = &state.hand().checkup;
        kit::full_card_ui(ui, look, |ui| {
            if let Some(recorded) = pane.recorded() {
                kit::small_text_ui(ui, recorded, look.palette.muted);
                return;
            }
            if let Some(run) = state.hand().running.checkup_run() {
                let tips = heat::tips(pane);
                self.hand.rest_ui(ui, pane, &tips, run.view.joint);
                return;
            }
            match (&own.last, &own.unread) {
                (Some(shown), _) => self.shown_ui(ui, pane, shown),
                (None, Some(error)) => {
                    let words = look.fill(checkup::UNREAD, &[error]);
                    kit::small_text_ui(ui, &words, look.palette.warn);
                }
                (None, None) if own.is_reading() => {
                    kit::small_text_ui(ui, look.tr(checkup::READING), look.palette.muted);
                }
                (None, None) => {
                    Label::text(look, checkup::NEVER).large().wrap().ui(ui);
                    kit::small_text_ui(ui, look.tip(checkup::NEVER), look.palette.muted);
                    self.hand.rest_ui(ui, pane, &heat::tips(pane), None);
                }
            }
        });
    }

    fn shown_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, shown: &ShownCheckup) {
        let (look, palette) = (pane.look, pane.look.palette);
        let report = &shown.report;
        let title = look.fill(checkup::OF, &[&moment(&report.at)]);
        kit::head_ui(ui, look, &title, |ui| {
            let save = Button::text(look, checkup::SAVE);
            let page = Export::Checkup(Box::new(report.clone()));
            save.on_click(ui, pane, Action::Save(page));
            let page = shown.page.clone();
            let none = page.is_none().then(|| look.tr(checkup::NO_REPORT));
            let reveal = RecordingAction::Reveal(page.unwrap_or_default());
            let show = Button::text(look, checkup::REPORT).disabled(none);
            show.on_click(ui, pane, Action::Recording(reveal));
        });
        let grades = [Grade::Fine, Grade::Watch, Grade::Act, Grade::Unknown];
        let [fine, watch, act, unknown] = grades.map(|grade| report.count(grade));
        let words = look.fill(checkup::LIGHTS, &[&fine, &watch, &act, &unknown]);
        let worst = report.checks.iter().map(|own| own.grade).max();
        let color = table::color(pane, worst.unwrap_or(Grade::Unknown));
        Label::new(&words, color).named(&title).ui(ui);
        if let Some(why) = report.aborted {
            let words = look.fill(checkup::PARTIAL, &[&tune::abort(look, why)]);
            kit::small_text_ui(ui, &words, palette.bad);
        }
        for words in checkup::remarks(look, report) {
            kit::small_text_ui(ui, &words, palette.warn);
        }
        let earlier = look.fill(checkup::EARLIER, &[&report.earlier]);
        let words = format!("{earlier}. {}", checkup::usage(look, report));
        kit::small_text_ui(ui, &words, palette.muted);
        let only = Button::text(look, checkup::ONLY).choice(self.only);
        only.toggle(ui, look, &mut self.only);
        ui.add_space(theme::STEP);
        table::ui(ui, pane, report, self.only);
    }
}

/// Formats a timestamp from a file as day and time.
fn moment(at: &str) -> String {
    let time = at.split_once('T').and_then(|(_, time)| time.get(..5));
    match time {
        Some(time) => format!("{} {time} UTC", day(at)),
        None => at.to_owned(),
    }
}
