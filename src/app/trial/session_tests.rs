//! Sessions in folders: what is kept comes back, nothing is overwritten, and a page takes no orders from a note.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use crate::app::quirk_sheet::QuirkSheet;
use crate::app::trial::best::Criterion;
use crate::app::trial::metrics::measure;
use crate::app::trial::plan::{Approach, Grid, Limits, Setting, TrialPlan, Until};
use crate::app::trial::recording::{Recording, Row, What};
use crate::app::trial::series::{Kind, Trial};
use crate::app::trial::session::{Head, Keeper, load};
use crate::app::trial::watch::Abort;
use crate::hand::{Angle, Dof, Force, Moment, PerDof, Speed};
use std::time::Duration;

const EVIL: &str = "</style><script src=\"http://x/\">\u{7}'\"";

fn plan() -> TrialPlan {
    let mut plan = TrialPlan {
        start: PerDof::splat(None),
        close: PerDof::splat(None),
        approach: Approach::TwoStage {
            fast: Speed::MAX,
            until: Until::Measured { margin: 40 },
        },
        dwell: Duration::from_secs(1),
        grid: Grid::once(setting(25)),
        limits: Limits::default(),
    };
    plan.start[Dof::Index] = Some(Angle::MAX);
    plan.close[Dof::Index] = Some(Angle::MIN);
    plan
}

fn setting(speed: i16) -> Setting {
    Setting {
        speed: Speed::nearest(speed),
        force: Force::nearest(500),
    }
}

fn head() -> Head {
    Head {
        hand: format!("rs485:/dev/{EVIL}"),
        simulated: true,
        begun: Duration::from_secs(1_795_219_200),
        note: format!("egg & cup, 鸡蛋 & 杯 {EVIL}"),
        tags: vec!["egg".into(), EVIL.into()],
        quirks: Some(QuirkSheet {
            place: EVIL.into(),
            touch: Some("capacitive".into()),
            ..QuirkSheet::default()
        }),
    }
}

/// A finger that begins at 1000 and closes until it is stopped.
fn trial(number: usize, aborted: Option<Abort>) -> Trial {
    let mut recording = Recording::default();
    let at = |ms: u64| Moment::from_micros(5_000_000 + ms * 1000);
    recording.mark(at(0), What::Prepare);
    recording.mark(at(500), What::Close);
    for ms in (0..1500_u64).step_by(10) {
        let closed = i16::try_from(ms.saturating_sub(564) / 4).unwrap_or_default();
        recording.push_row(Row {
            at: at(ms),
            angle: Some(PerDof::splat(1000 - closed)),
            force: Some(PerDof::splat(-4)),
            ..Row::default()
        });
    }
    recording.mark(at(1490), What::Release);
    let setting = setting(25);
    let metrics = measure(&recording, &plan(), setting);
    Trial {
        number,
        kind: Kind::Trial { repeat: number },
        setting,
        recording,
        metrics,
        aborted,
    }
}

fn kept(folder: &std::path::Path) {
    let all = Criterion::LeastOvershoot { steady_g: 0.0 };
    let mut keeper = Keeper::create(folder, &head(), &plan(), Some(all)).unwrap();
    keeper.keep(&trial(1, None)).unwrap();
    keeper.keep(&trial(2, Some(Abort::Person))).unwrap();
    keeper.close(Some(Abort::Person)).unwrap();
}

#[test]
fn what_is_kept_comes_back_and_what_is_unknown_has_no_key() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("deep/session");
    kept(&place);
    let session = load(&place).unwrap();
    assert_eq!(
        (session.day.as_str(), session.simulated),
        ("2026-11-21", true)
    );
    assert_eq!(session.note, head().note);
    assert_eq!(session.aborted.as_deref(), Some("ended by a person"));
    assert_eq!(session.plan.until.as_deref(), Some("measured"));
    assert_eq!(session.plan.start["index"], 1000);
    assert_eq!(session.trials.len(), 2);
    assert_eq!(session.trials[0].joints, trial(1, None).metrics.joints);
    assert!(session.trials[0].joints[0].dead_time_s.is_some());
    let text = std::fs::read_to_string(place.join("session.toml")).unwrap();
    assert!(
        text.contains("dead_time_s") && !text.contains("overshoot_g"),
        "{text}"
    );
    let csv = std::fs::read_to_string(place.join("trial-001.csv")).unwrap();
    assert_eq!(csv, trial(1, None).recording.csv());
    let mut names: Vec<String> = std::fs::read_dir(&place)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "report.html",
            "session.toml",
            "trial-001.csv",
            "trial-002.csv"
        ]
    );
}

#[test]
fn keys_of_a_later_version_survive_and_a_later_version_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("s");
    kept(&place);
    let path = place.join("session.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("warp = 9\n{text}")).unwrap();
    let session = load(&place).unwrap();
    assert_eq!(session.others["warp"].as_integer(), Some(9));
    assert_eq!(
        toml::from_str::<toml::Table>(&toml::to_string(&session).unwrap()).unwrap()["warp"]
            .as_integer(),
        Some(9)
    );
    std::fs::write(&path, text.replace("version = 1", "version = 2")).unwrap();
    assert!(load(&place).is_err());
    std::fs::write(&path, text.replace("handscope-trials", "handscope-poses")).unwrap();
    assert!(load(&place).is_err());
}

#[test]
fn a_folder_that_holds_anything_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mine.txt"), "mine").unwrap();
    let error = Keeper::create(folder.path(), &head(), &plan(), None).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::AlreadyExists);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn the_page_is_whole_draws_the_curves_and_takes_no_orders() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("s");
    kept(&place);
    let page = std::fs::read_to_string(place.join("report.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    assert_eq!(page.matches("<svg").count(), 1 + 2 * 3);
    assert!(page.contains("<span class=\"key s3\">index</span>"));
    assert!(page.contains("<span class=\"key s0\">speed 25, threshold 500 g</span>"));
    assert_eq!(page.matches("class=\"key ").count(), 2);
    let (all, each) = page.split_once("<h2>Curves</h2>").unwrap();
    assert_eq!(all.matches("<polyline").count(), 2, "both over each other");
    assert_eq!(each.matches("<polyline").count(), 2 * 3);
    assert!(page.contains("<meta charset=\"utf-8\">"));
    assert!(page.contains("鸡蛋 &amp; 杯"), "letters of any script stay");
    assert!(page.contains("SIMULATED HAND"));
    assert!(page.contains("Ended early: ended by a person"));
    assert!(page.contains("egg &amp; cup"));
    for foreign in ["<script", "src=", "href=", "url(", "@import", "\u{7}"] {
        let quoted = page.replace("&lt;script src=", "");
        assert!(!quoted.contains(foreign), "{foreign}");
    }
    assert!(page.contains("no setting will do"));
}
