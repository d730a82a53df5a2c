//! Claims about sessions side by side.

use crate::app::trials::comparison::{
    Comparison, LINES_MAX, LineGroup, POINTS_MAX, SHOWN_MAX, SessionDifference,
};
use crate::app::trials::state::{
    ROWS_MAX, SESSIONS_MAX, SessionId, SessionOrigin, TrialQuantity, TrialsState,
};
use crate::hand::{Angle, Dof, Force, Moment, PerDof, PerFinger, Speed};
use crate::trials::measure::curve::JointCurves;
use crate::trials::measure::metrics::{DwellSpan, measure_joint};
use crate::trials::recording::SampleRow;
use crate::trials::session::SessionHead;
use crate::trials::{
    Approach, Trial, TrialKind, TrialPlan, TrialRecording, TrialSetting, TrialSummary, Until,
};
use std::time::Duration;

fn setting(speed: i16) -> TrialSetting {
    TrialSetting {
        speed: Speed::nearest(speed),
        force: Force::nearest(500),
    }
}

/// Forces of all joints, one reading each 10 ms, with one peak in the middle.
fn recording(rows: u64, peak: i16) -> TrialRecording {
    let mut recording = TrialRecording::default();
    for row in 0..rows {
        let at = Moment::ZERO.plus(Duration::from_millis(10 * row));
        let force = if row == rows / 2 { peak } else { 3 };
        recording.push_row(SampleRow {
            at,
            angle: None,
            force: Some(PerDof::splat(force)),
            current: None,
            status: None,
            faults: None,
            temperature: None,
            tips: PerFinger::splat(None),
        });
    }
    recording
}

fn trial(number: usize, setting: TrialSetting, joints: &[Dof], recording: TrialRecording) -> Trial {
    let span = DwellSpan {
        slow_s: None,
        end_s: 1.0,
        threshold_g: 0.0,
    };
    let measured = |dof: &Dof| {
        let mut joint = measure_joint(*dof, &JointCurves::default(), span);
        joint.overshoot_g = Some(10.0);
        joint.steady_force_g = Some(400.0);
        joint
    };
    let summary = TrialSummary {
        number,
        kind: TrialKind::Trial,
        repeat: Some(number),
        setting,
        aborted: None,
        samples: None,
        rows: recording.rows().len(),
        rows_lost: 0,
        repeated: false,
        stall_s: None,
        joints: joints.iter().map(measured).collect(),
        others: toml::Table::new(),
    };
    Trial { summary, recording }
}

fn begin(trials: &mut TrialsState, hand: &str, plan: TrialPlan) -> SessionId {
    let head = SessionHead {
        hand: hand.into(),
        ..SessionHead::begin(plan, Duration::ZERO)
    };
    trials.add(head, SessionOrigin::Unsaved, Vec::new())
}

/// One session for each plan, each of one trial.
fn sessions(plans: Vec<(&str, TrialPlan)>) -> (TrialsState, Vec<SessionId>) {
    let mut trials = TrialsState::default();
    let mut ids = Vec::new();
    for (hand, plan) in plans {
        let joints: Vec<Dof> = plan.joints().collect();
        let id = begin(&mut trials, hand, plan);
        trials.add_trial(id, trial(1, setting(25), &joints, recording(20, 90)));
        ids.push(id);
    }
    (trials, ids)
}

fn plan(change: impl Fn(&mut TrialPlan)) -> TrialPlan {
    let mut plan = TrialPlan::default();
    change(&mut plan);
    plan
}

#[test]
fn settings_are_judged_over_all_sessions_that_were_alike() {
    let alike = || ("tcp:10.0.0.1", plan(|_| {}));
    let (trials, ids) = sessions(vec![alike(), alike()]);
    let both = Comparison::of(&trials, &ids, ids[1]);
    assert!(both.differences.is_empty());
    assert_eq!(both.scores.len(), 1);
    assert_eq!(both.scores[0].trials, 2);
    assert_eq!(both.rows.len(), 2);
    let one = Comparison::of(&trials, &ids[..1], ids[0]);
    assert_eq!(one.scores[0].trials, 1);
}

#[test]
fn sessions_that_were_not_alike_are_judged_apart_and_say_why() {
    let first = || ("tcp:10.0.0.1", plan(|_| {}));
    for (other, why) in [
        (("tcp:10.0.0.2", plan(|_| {})), SessionDifference::Hand),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| {
                    own.close[Dof::Ring] = Some(Angle::MIN);
                    own.start[Dof::Ring] = Some(Angle::MAX);
                }),
            ),
            SessionDifference::Joints,
        ),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| own.start[Dof::Index] = Some(Angle::nearest(600))),
            ),
            SessionDifference::Way,
        ),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| {
                    own.approach = Approach::TwoStage {
                        fast: Speed::nearest(250),
                        until: Until::Angle(Angle::nearest(600)),
                    };
                }),
            ),
            SessionDifference::Approach,
        ),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| own.dwell = Duration::from_secs(3)),
            ),
            SessionDifference::Dwell,
        ),
    ] {
        let (trials, ids) = sessions(vec![first(), other]);
        let both = Comparison::of(&trials, &ids, ids[1]);
        assert!(both.differences.contains(&why), "{why:?}");
        let own: usize = both.scores.iter().map(|score| score.trials).sum();
        assert_eq!(own, 1, "{why:?}: of the one at hand alone");
    }
}

#[test]
fn one_setting_is_told_apart_by_session_and_several_by_setting() {
    let alike = || ("tcp:10.0.0.1", plan(|_| {}));
    let (mut trials, ids) = sessions(vec![alike(), alike()]);
    let both = Comparison::of(&trials, &ids, ids[1]);
    let last = both.rows[1];
    let group = both.group(last, both.row(&trials, last).unwrap());
    assert_eq!(group, LineGroup::Session(1));
    trials.add_trial(
        ids[1],
        trial(2, setting(250), &[Dof::Index], recording(9, 9)),
    );
    assert!(!both.is_current(&trials, &ids, ids[1]), "a trial was added");
    let both = Comparison::of(&trials, &ids, ids[1]);
    let last = both.rows[2];
    let group = both.group(last, both.row(&trials, last).unwrap());
    assert_eq!(group, LineGroup::Setting(1));
}

#[test]
fn however_many_trials_there_are_little_is_drawn_and_every_peak_of_it() {
    let mut trials = TrialsState::default();
    let mut ids = Vec::new();
    for _ in 0..SHOWN_MAX + 1 {
        let id = begin(&mut trials, "tcp:10.0.0.1", plan(|_| {}));
        for number in 1..=40 {
            let own = trial(number, setting(25), &Dof::ALL, recording(900, 777));
            trials.add_trial(id, own);
        }
        ids.push(id);
    }
    let all = Comparison::of(&trials, &ids, ids[0]);
    assert_eq!(all.sessions().len(), SHOWN_MAX);
    assert_eq!(all.rows.len(), SHOWN_MAX * 40 * 6);
    let picture = all.lines(&trials, TrialQuantity::Force, None);
    assert_eq!(picture.all, SHOWN_MAX * 40 * 6);
    assert_eq!(picture.lines.len(), LINES_MAX);
    let points: usize = picture.lines.iter().map(|line| line.points.len()).sum();
    assert!(points <= POINTS_MAX, "{points}");
    for line in &picture.lines {
        let peak = line.points.iter().map(|[_, v]| *v).fold(0.0, f64::max);
        assert!((peak - 777.0).abs() < 1e-9, "{peak}");
    }
    let of = |session| {
        picture
            .lines
            .iter()
            .filter(move |own| own.key.session == session)
    };
    assert!((0..SHOWN_MAX).all(|session| of(session).count() == LINES_MAX / SHOWN_MAX));
}

#[test]
fn samples_in_files_go_first_and_what_was_lost_is_counted() {
    let mut trials = TrialsState::default();
    let old = begin(&mut trials, "tcp:10.0.0.1", plan(|_| {}));
    let saved = begin(&mut trials, "tcp:10.0.0.1", plan(|_| {}));
    let rows = u64::try_from(ROWS_MAX / 3).unwrap();
    let own = |number| trial(number, setting(25), &[], recording(rows, 9));
    trials.add_trial(old, own(1));
    trials.add_trial(saved, own(1));
    trials.add_trial(old, own(2));
    trials.session_mut(saved).unwrap().origin = SessionOrigin::Saved("/tmp/saved".into());
    let lost = |trials: &TrialsState| [old, saved].map(|id| trials.session(id).unwrap().lost);
    trials.add_trial(old, own(3));
    assert_eq!(lost(&trials), [0, 0], "they lie in files");
    trials.add_trial(old, own(4));
    assert_eq!(lost(&trials), [1, 0], "the oldest is gone");
    let first = &trials.session(old).unwrap().trials[0];
    assert_eq!(first.recording.lost(), rows);
    assert_eq!((first.summary.rows, first.summary.rows_lost), (0, rows));
}

#[test]
fn nothing_is_asked_about_a_session_that_made_room() {
    let mut trials = TrialsState::default();
    let first = begin(&mut trials, "tcp:10.0.0.1", plan(|_| {}));
    trials.request_forget(first);
    assert_eq!(trials.to_confirm, Some(first));
    for _ in 1..=SESSIONS_MAX {
        begin(&mut trials, "tcp:10.0.0.1", plan(|_| {}));
    }
    assert_eq!((trials.session(first), trials.to_confirm), (None, None));
}
