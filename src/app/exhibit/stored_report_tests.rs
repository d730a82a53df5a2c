#![allow(clippy::unwrap_used, reason = "a test may")]
use crate::app::env::day_folder::of_day;
use crate::app::exhibit::StoredReport;
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::exhibit::report::{DayReport, file};
use crate::exhibit::stage::ExhibitEvent;
use crate::hand::{Dof, HandSample, Moment, PerDof, TemperatureReading, Timed};
use crate::record::LinkState;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::runtime::Handle;

const DAY: &str = "2026-11-23";
/// Nine o'clock of that day.
const NINE: u64 = 1_795_219_200 + 2 * 86_400 + 9 * 3600;

/// A report at a hand, and the time they live in.
struct Booth {
    report: StoredReport,
    hand: Hand,
    /// Seconds after nine o'clock.
    second: u64,
}

impl Booth {
    async fn open(documents: Option<&Path>) -> Self {
        let mut hand = Hand::default();
        hand.connection.endpoint = Some("tcp:10.0.0.9".parse().unwrap());
        hand.connection.status.state = LinkState::Monitoring;
        let report = StoredReport::new(documents.map(Path::to_owned), Handle::current());
        let mut booth = Self {
            report,
            hand,
            second: 0,
        };
        booth.at(0).await;
        booth
    }

    fn now(&self) -> Moment {
        Moment::from_micros(self.second * 1_000_000)
    }

    fn tick(&mut self) {
        let since_1970 = Duration::from_secs(NINE + self.second);
        self.report.tick(&self.hand, since_1970, self.now());
    }

    /// The program looks so many seconds after nine, until nothing is read or written any more.
    async fn at(&mut self, second: u64) {
        self.second = second;
        self.tick();
        while self.report.is_busy() {
            tokio::task::yield_now().await;
            self.tick();
        }
    }

    fn visit(&mut self) {
        self.report.count(&ExhibitEvent::Visit);
    }

    fn heat(&mut self, celsius: u8) {
        let at = self.now();
        self.hand.readings.sample = HandSample {
            temperature: Some(Timed {
                value: PerDof::splat(TemperatureReading::new(celsius)),
                asked: at,
                received: at,
            }),
            ..HandSample::default()
        };
    }

    async fn leave(&mut self) {
        while !self.report.flush(self.now()) {
            tokio::task::yield_now().await;
        }
    }
}

fn path(documents: &Path, day: &str) -> PathBuf {
    of_day(documents, day).join(format!("exhibit-{day}.toml"))
}

fn on_disk(documents: &Path, day: &str) -> DayReport {
    let text = std::fs::read_to_string(path(documents, day)).unwrap();
    file::read(&text, day).unwrap()
}

#[tokio::test]
async fn a_report_is_written_once_a_minute_and_at_the_end_with_its_page() {
    let folder = tempfile::tempdir().unwrap();
    let documents = folder.path();
    let mut booth = Booth::open(Some(documents)).await;
    let first = on_disk(documents, DAY);
    assert_eq!(
        first.hands,
        ["tcp:10.0.0.9:6000?unit=255".to_owned()].into()
    );
    booth.visit();
    booth.at(59).await;
    assert_eq!(on_disk(documents, DAY).visits, 0);
    booth.heat(41);
    booth.at(60).await;
    let kept = on_disk(documents, DAY);
    assert_eq!((kept.visits, kept.hottest[&9][Dof::Index]), (1, Some(41)));
    booth.visit();
    booth.at(70).await;
    booth.leave().await;
    assert_eq!(on_disk(documents, DAY), *booth.report.today());
    let page = std::fs::read_to_string(path(documents, DAY).with_extension("html")).unwrap();
    assert!(page.contains("<td>Visits</td><td>2</td>"), "{page}");
    assert_eq!(booth.report.troubles().count(), 0);
}

#[tokio::test]
async fn a_restart_counts_on_and_what_happens_before_the_file_is_read_counts_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut booth = Booth::open(Some(folder.path())).await;
    booth.visit();
    booth.heat(48);
    booth.at(1).await;
    booth.leave().await;
    let mut booth = Booth::open(None).await;
    booth.report = StoredReport::new(Some(folder.path().into()), Handle::current());
    booth.tick();
    booth.visit();
    booth.at(61).await;
    booth.leave().await;
    let kept = on_disk(folder.path(), DAY);
    assert_eq!((kept.visits, kept.hottest[&9][Dof::Ring]), (2, Some(48)));
}

#[tokio::test]
async fn a_new_day_has_a_report_of_its_own_and_the_old_one_is_whole() {
    const MIDNIGHT: u64 = 15 * 3600;
    let folder = tempfile::tempdir().unwrap();
    let mut booth = Booth::open(Some(folder.path())).await;
    booth.visit();
    booth.at(MIDNIGHT - 1).await;
    booth.visit();
    booth.at(MIDNIGHT).await;
    booth.heat(33);
    booth.at(MIDNIGHT + 1).await;
    booth.leave().await;
    assert_eq!(on_disk(folder.path(), DAY).visits, 2);
    let next = on_disk(folder.path(), "2026-11-24");
    assert_eq!((next.visits, next.hottest.len()), (0, 1));
    assert_eq!(next.hottest[&0][Dof::Index], Some(33));
}

#[tokio::test]
async fn an_unreadable_file_of_the_day_is_set_aside_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = path(folder.path(), DAY);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    for bad in [
        &b"half a fi"[..],
        b"\xFF\xFE",
        b"format = \"x\"\nversion = 1",
    ] {
        std::fs::write(&path, bad).unwrap();
        let mut booth = Booth::open(Some(folder.path())).await;
        booth.visit();
        booth.leave().await;
        let told: Vec<_> = booth.report.troubles().collect();
        let [
            NoticeKind::FileIgnored {
                kept_as: Some(aside),
                ..
            },
        ] = told[..]
        else {
            panic!("{told:?}")
        };
        assert_eq!(std::fs::read(aside).unwrap(), bad);
        assert_eq!(on_disk(folder.path(), DAY).visits, 1);
    }
}

#[tokio::test]
async fn a_failed_write_is_told_once_and_no_more_when_a_later_one_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let path = path(folder.path(), DAY);
    // A folder where the new file would be made.
    let in_the_way = path.with_extension("new.toml");
    std::fs::create_dir_all(&in_the_way).unwrap();
    let mut booth = Booth::open(Some(folder.path())).await;
    for minute in 1..4 {
        booth.visit();
        booth.at(minute * 60).await;
    }
    booth.leave().await;
    let told: Vec<_> = booth.report.troubles().cloned().collect();
    assert!(matches!(&told[..], [NoticeKind::NotSaved { path: own, .. }] if *own == path));
    std::fs::remove_dir(&in_the_way).unwrap();
    booth.visit();
    booth.at(300).await;
    assert_eq!(booth.report.troubles().count(), 0);
    assert_eq!(on_disk(folder.path(), DAY).visits, 4);
    std::fs::create_dir(path.with_extension("new.html")).unwrap();
    booth.visit();
    booth.leave().await;
    let told: Vec<_> = booth.report.troubles().collect();
    let page = path.with_extension("html");
    assert!(matches!(&told[..], [NoticeKind::NotSaved { path: own, .. }] if *own == page));
}

#[tokio::test]
async fn without_documents_nothing_is_kept_and_nothing_is_told() {
    let mut booth = Booth::open(None).await;
    booth.visit();
    booth.at(60).await;
    booth.leave().await;
    assert_eq!(booth.report.today().visits, 1);
    assert_eq!(booth.report.troubles().count(), 0);
}
