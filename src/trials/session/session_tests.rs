//! Sessions in folders: what is written comes back, nothing is overwritten, and a page takes no orders from a note.

use crate::hand::{Angle, Dof, Force, Moment, PerDof, Speed};
use crate::record::Abort;
use crate::record::QuirkSheet;
use crate::trials::best::Criterion;
use crate::trials::measure::metrics::measure;
use crate::trials::plan::{Approach, Limits, TrialGrid, TrialPlan, TrialSetting, Until};
use crate::trials::recording::{SampleRow, TrialEvent, TrialRecording, csv};
use crate::trials::session::{SessionHead, load};
use crate::trials::session_writer::TrialSessionWriter;
use crate::trials::summary::{EarlyEnd, Trial, TrialKind, TrialSummary};
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
        grid: TrialGrid::once(setting(25)),
        limits: Limits::default(),
        ..TrialPlan::default()
    };
    plan.start[Dof::Index] = Some(Angle::MAX);
    plan.close[Dof::Index] = Some(Angle::MIN);
    plan
}

fn setting(speed: i16) -> TrialSetting {
    TrialSetting {
        speed: Speed::nearest(speed),
        force: Force::nearest(500),
    }
}

fn head() -> SessionHead {
    let plan = TrialPlan {
        note: format!("egg & cup, 鸡蛋 & 杯 {EVIL}"),
        tags: vec!["egg".into(), EVIL.into()],
        ..plan()
    };
    SessionHead {
        hand: format!("rs485:/dev/{EVIL}"),
        simulated: true,
        quirks: Some(QuirkSheet {
            place: EVIL.into(),
            touch: Some("capacitive".into()),
            ..QuirkSheet::default()
        }),
        ..SessionHead::begin(plan, Duration::from_secs(1_795_219_200))
    }
}

/// A finger that begins at 1000 and closes until it is stopped.
fn trial(number: usize, aborted: Option<Abort>) -> Trial {
    let mut recording = TrialRecording::default();
    let at = |ms: u64| Moment::from_micros(5_000_000 + ms * 1000);
    recording.mark(at(0), TrialEvent::Prepare);
    recording.mark(at(500), TrialEvent::Close);
    for ms in (0..1500_u64).step_by(10) {
        let closed = i16::try_from(ms.saturating_sub(564) / 4).unwrap_or_default();
        recording.push_row(SampleRow {
            at: at(ms),
            angle: Some(PerDof::splat(1000 - closed)),
            force: Some(PerDof::splat(-4)),
            ..SampleRow::default()
        });
    }
    recording.mark(at(1490), TrialEvent::Release);
    let setting = setting(25);
    let summary = TrialSummary {
        number,
        kind: TrialKind::Trial,
        repeat: Some(number),
        setting,
        aborted: aborted.map(EarlyEnd::Here),
        samples: None,
        rows: recording.rows().len(),
        rows_lost: recording.lost(),
        repeated: false,
        stall_s: None,
        joints: measure(&recording, &plan(), setting),
        others: toml::Table::new(),
    };
    Trial { summary, recording }
}

fn write(folder: &std::path::Path) {
    let all = Criterion::LeastOvershoot { steady_g: 0.0 };
    let mut writer = TrialSessionWriter::create(folder, head(), Some(all)).unwrap();
    for trial in [trial(1, None), trial(2, Some(Abort::Person))] {
        writer.add(&trial.summary, &trial.recording).unwrap();
    }
    writer.finish(Some(EarlyEnd::Here(Abort::Person))).unwrap();
}

#[test]
fn what_is_written_comes_back_and_what_is_unknown_has_no_key() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("deep/session");
    write(&place);
    let session = load(&place).unwrap();
    assert_eq!(
        (session.head.day.as_str(), session.head.simulated),
        ("2026-11-21", true)
    );
    assert_eq!(session.head.note, head().note);
    let why = EarlyEnd::FromFile("ended by the user".into());
    assert_eq!(session.head.aborted, Some(why));
    assert_eq!(session.head.plan, plan());
    assert_eq!(session.trials.len(), 2);
    assert_eq!(session.trials[0].joints, trial(1, None).summary.joints);
    assert!(session.trials[0].joints[0].dead_time_s.is_some());
    let text = std::fs::read_to_string(place.join("session.toml")).unwrap();
    assert!(
        text.contains("dead_time_s") && !text.contains("overshoot_g"),
        "{text}"
    );
    let samples = std::fs::read_to_string(place.join("trial-001.csv")).unwrap();
    assert_eq!(samples, csv::write(&trial(1, None).recording));
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
    write(&place);
    let path = place.join("session.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("warp = 9\n{text}")).unwrap();
    let session = load(&place).unwrap();
    assert_eq!(session.head.others["warp"].as_integer(), Some(9));
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
    let error = TrialSessionWriter::create(folder.path(), head(), None).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::AlreadyExists);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn the_page_is_whole_draws_the_curves_and_takes_no_orders() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("s");
    write(&place);
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
    assert!(page.contains("鸡蛋 &#38; 杯"), "letters of any script stay");
    assert!(page.contains("SIMULATED HAND"));
    assert!(page.contains("Ended early: ended by the user"));
    assert!(page.contains("egg &#38; cup"));
    for foreign in ["<script", "src=", "href=", "url(", "@import", "\u{7}"] {
        let quoted = page.replace("&#60;script src=", "");
        assert!(!quoted.contains(foreign), "{foreign}");
    }
    assert!(page.contains("no setting qualifies"));
}

#[test]
fn a_session_of_the_first_versions_is_still_read() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("first_version.toml");
    std::fs::write(folder.path().join("session.toml"), text).unwrap();
    let session = load(folder.path()).unwrap();
    let mut expected = TrialPlan {
        approach: Approach::TwoStage {
            fast: Speed::MAX,
            until: Until::Measured { margin: 40 },
        },
        dwell: Duration::from_millis(500),
        grid: TrialGrid {
            speeds: [25, 250].map(Speed::nearest).into(),
            forces: [250, 500].map(Force::nearest).into(),
            repeats: 1,
            rest: Duration::ZERO,
        },
        limits: Limits {
            ceiling_g: 4000,
            ..Limits::default()
        },
        start: PerDof::splat(None),
        close: PerDof::splat(None),
        ..TrialPlan::default()
    };
    for dof in [Dof::Index, Dof::Middle] {
        expected.start[dof] = Some(Angle::nearest(640));
        expected.close[dof] = Some(Angle::nearest(300));
    }
    expected.start[Dof::ThumbRotate] = Some(Angle::nearest(900));
    assert_eq!(session.head.plan, expected);
    assert_eq!(
        (session.head.note.as_str(), &session.head.tags[..]),
        ("egg & <cup>", &["a".to_owned(), "b".to_owned()][..])
    );
    assert_eq!(session.head.quirks.as_ref().unwrap().hand_id, Some(1));
    let [probe, trial] = &session.trials[..] else {
        panic!("two trials")
    };
    assert_eq!((probe.kind, probe.repeat), (TrialKind::Probe, None));
    assert_eq!((trial.kind, trial.repeat), (TrialKind::Trial, Some(1)));
    assert_eq!(trial.samples.as_deref(), Some("trial-002.csv"));
    assert_eq!(trial.joints.len(), 2);
    assert!(trial.joints[0].overshoot_g.is_some());
    // The same keys and values are written again, whatever their order.
    let tables = [text.to_owned(), toml::to_string(&session).unwrap()];
    let [old, new] = tables.map(|text| text.parse::<toml::Table>().unwrap());
    assert_eq!(old, new);
}
