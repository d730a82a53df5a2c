//! The report of an exhibition's day, from the first visitor to the file.

use crate::program::Bench;
use handscope::app::action::Action;
use handscope::app::exhibit::{ExhibitAction, StaffPanel};
use handscope::app::notices::NoticeKind;
use handscope::exhibit::report::{DayReport, file};
use handscope::exhibit::stage::{ExhibitStage, ExhibitWish};
use handscope::store::calendar;
use std::path::PathBuf;

impl Bench {
    fn exhibit(&mut self, action: ExhibitAction) {
        self.act(Action::Exhibit(action));
    }

    fn stage(&self) -> Option<ExhibitStage> {
        let exhibit = self.state().exhibit.as_ref();
        exhibit.map(|exhibit| exhibit.view.stage)
    }

    /// Staff begin and arm, one visitor plays the second tile, and somebody presses STOP.
    async fn visit(&mut self) {
        self.exhibit(ExhibitAction::Enter);
        // Nobody arms on a page that was not drawn.
        self.run(100).await;
        self.exhibit(ExhibitAction::Pin("4711".into()));
        self.exhibit(ExhibitAction::Pin("4711".into()));
        self.exhibit(ExhibitAction::Wish(ExhibitWish::Arm));
        let is_idle = |stage| stage == Some(ExhibitStage::Idle);
        for _ in 0..100 {
            self.run(100).await;
            if is_idle(self.stage()) && !self.hand().connection.is_armed() {
                break;
            }
        }
        assert!(is_idle(self.stage()), "{:?}", self.stage());
        self.exhibit(ExhibitAction::Wish(ExhibitWish::Press(1)));
        self.exhibit(ExhibitAction::Wish(ExhibitWish::Release));
        self.run(3000).await;
        self.act(Action::Stop);
        self.run(1000).await;
    }

    /// Staff leave, and what was counted is written.
    async fn leave(&mut self) {
        self.exhibit(ExhibitAction::AskPin);
        self.exhibit(ExhibitAction::Pin("4711".into()));
        let panel = self.state().exhibit.as_ref().map(|exhibit| &exhibit.staff);
        assert!(matches!(panel, Some(StaffPanel::Open { .. })), "{panel:?}");
        self.exhibit(ExhibitAction::Leave);
        self.run(1000).await;
        assert!(self.state().exhibit.is_none());
    }

    /// Where the report of the only day lies.
    fn report_path(&self) -> PathBuf {
        let days = self.folder.path().join("documents/Handscope");
        let day = std::fs::read_dir(days).unwrap().next().unwrap().unwrap();
        let name = format!("exhibit-{}.toml", day.file_name().to_str().unwrap());
        day.path().join(name)
    }

    fn report(&self) -> DayReport {
        let path = self.report_path();
        let text = std::fs::read_to_string(&path).unwrap();
        let day = path.parent().unwrap().file_name().unwrap();
        file::read(&text, day.to_str().unwrap()).unwrap()
    }
}

#[tokio::test(start_paused = true)]
async fn what_visitors_do_is_in_the_report_of_the_day_and_the_next_exhibition_counts_on() {
    let mut bench = Bench::live().await;
    bench.visit().await;
    bench.leave().await;
    let report = bench.report();
    assert_eq!((report.visits, report.stops), (1, 1));
    assert_eq!(report.pieces.get("Fist"), Some(&1), "{report:?}");
    assert!(report.hands.iter().any(|hand| hand.starts_with("rs485:x")));
    let hottest: Vec<_> = report.hottest.values().collect();
    assert!(hottest[0].iter().all(|(_, celsius)| celsius.is_some()));
    let page = std::fs::read_to_string(bench.report_path().with_extension("html")).unwrap();
    assert!(page.contains("<td>Fist</td><td>1</td>"), "{page}");
    bench.visit().await;
    // The window is closed before the exhibition is left, as by the end of a session.
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    let report = bench.report();
    assert_eq!((report.visits, report.stops), (2, 2));
}

#[tokio::test(start_paused = true)]
async fn a_report_that_cannot_be_written_is_told_once_at_the_end() {
    let mut bench = Bench::live().await;
    // A folder where the new file would be made.
    let day = calendar::day(calendar::since_1970());
    let folder = bench.folder.path().join("documents/Handscope").join(&day);
    std::fs::create_dir_all(folder.join(format!("exhibit-{day}.new.toml"))).unwrap();
    bench.visit().await;
    bench.run(200_000).await;
    let not_saved = |bench: &Bench| {
        let told = bench.told().into_iter();
        told.filter(|what| matches!(what, NoticeKind::NotSaved { path, .. } if path.to_string_lossy().contains("exhibit-")))
            .count()
    };
    assert_eq!(not_saved(&bench), 0, "nobody reads notices there");
    let exhibit = bench.state().exhibit.as_ref().unwrap();
    assert_eq!(exhibit.report.troubles().count(), 1, "staff may see it");
    bench.leave().await;
    assert_eq!(not_saved(&bench), 1);
}
