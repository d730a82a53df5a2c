//! Claims about sessions side by side.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]

use crate::app::trial::curve::JointCurves;
use crate::app::trial::metrics::{Span, TrialMetrics, measure_joint};
use crate::app::trial::recording::Row;
use crate::app::trial::session::Head;
use crate::app::trial::{Kind, Recording, Setting, Trial, TrialPlan};
use crate::app::tuner::book::{Origin, ROWS_MAX, SESSIONS_MAX, SessionId, TunerBook};
use crate::app::tuner::comparison::{
    Comparison, Difference, Group, LINES_MAX, POINTS_MAX, SHOWN_MAX,
};
use crate::app::tuner::draft::{Draft, Reach};
use crate::app::tuner::lines::Shown;
use crate::hand::{Angle, Dof, Force, Moment, PerDof, PerFinger, Speed};
use std::time::Duration;

fn setting(speed: i16) -> Setting {
    Setting {
        speed: Speed::nearest(speed),
        force: Force::nearest(500),
    }
}

/// Forces of all joints, one reading each 10 ms, with one peak in the middle.
fn recording(rows: u64, peak: i16) -> Recording {
    let mut recording = Recording::default();
    for row in 0..rows {
        let at = Moment::ZERO.plus(Duration::from_millis(10 * row));
        let force = if row == rows / 2 { peak } else { 3 };
        recording.push_row(Row {
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

fn trial(number: usize, setting: Setting, joints: &[Dof], recording: Recording) -> Trial {
    let span = Span {
        end_s: 1.0,
        threshold_g: 0.0,
    };
    let measured = |dof: &Dof| {
        let mut joint = measure_joint(*dof, &JointCurves::default(), span);
        joint.overshoot_g = Some(10.0);
        joint.steady_force_g = Some(400.0);
        joint
    };
    Trial {
        number,
        kind: Kind::Trial { repeat: number },
        setting,
        recording,
        metrics: TrialMetrics {
            joints: joints.iter().map(measured).collect(),
        },
        aborted: None,
    }
}

fn begin(book: &mut TunerBook, hand: &str, plan: TrialPlan) -> SessionId {
    let head = Head {
        hand: hand.into(),
        ..Head::default()
    };
    let origin = Origin::Here {
        plan: Box::new(plan),
        saved: None,
    };
    book.add(head, origin, Vec::new())
}

/// A book with one session for each plan, each of one trial.
fn book(plans: Vec<(&str, TrialPlan)>) -> (TunerBook, Vec<SessionId>) {
    let mut book = TunerBook::default();
    let mut ids = Vec::new();
    for (hand, plan) in plans {
        let joints: Vec<Dof> = plan.joints().collect();
        let id = begin(&mut book, hand, plan);
        book.keep(id, trial(1, setting(25), &joints, recording(20, 90)));
        ids.push(id);
    }
    (book, ids)
}

fn plan(change: impl Fn(&mut Draft)) -> TrialPlan {
    let mut draft = Draft::default();
    change(&mut draft);
    draft.plan()
}

#[test]
fn settings_are_judged_over_all_sessions_that_were_alike() {
    let alike = || ("tcp:10.0.0.1", plan(|_| {}));
    let (book, ids) = book(vec![alike(), alike()]);
    let both = Comparison::of(&book, &ids, ids[1]);
    assert!(both.differences().is_empty());
    assert_eq!(both.scores().len(), 1);
    assert_eq!(both.scores()[0].trials, 2);
    assert_eq!(both.rows().len(), 2);
    let one = Comparison::of(&book, &ids[..1], ids[0]);
    assert_eq!(one.scores()[0].trials, 1);
}

#[test]
fn sessions_that_were_not_alike_are_judged_apart_and_say_why() {
    let first = || ("tcp:10.0.0.1", plan(|_| {}));
    for (other, why) in [
        (("tcp:10.0.0.2", plan(|_| {})), Difference::Hand),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| {
                    own.joints[Dof::Ring] = true;
                    own.start[Dof::Ring] = Some(Angle::MAX);
                }),
            ),
            Difference::Joints,
        ),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| own.start[Dof::Index] = Some(Angle::nearest(600))),
            ),
            Difference::Way,
        ),
        (
            ("tcp:10.0.0.1", plan(|own| own.reach = Reach::Angle)),
            Difference::Approach,
        ),
        (
            (
                "tcp:10.0.0.1",
                plan(|own| own.dwell = Duration::from_secs(3)),
            ),
            Difference::Dwell,
        ),
    ] {
        let (book, ids) = book(vec![first(), other]);
        let both = Comparison::of(&book, &ids, ids[1]);
        assert!(both.differences().contains(&why), "{why:?}");
        let own: usize = both.scores().iter().map(|score| score.trials).sum();
        assert_eq!(own, 1, "{why:?}: of the one at hand alone");
    }
}

#[test]
fn one_setting_is_told_apart_by_session_and_several_by_setting() {
    let alike = || ("tcp:10.0.0.1", plan(|_| {}));
    let (mut book, ids) = book(vec![alike(), alike()]);
    let both = Comparison::of(&book, &ids, ids[1]);
    let last = both.rows()[1];
    let group = both.group(last, both.seen(&book, last).unwrap());
    assert_eq!(group, Group::Session(1));
    book.keep(
        ids[1],
        trial(2, setting(250), &[Dof::Index], recording(9, 9)),
    );
    assert!(!both.stands(&book, &ids, ids[1]), "a trial was added");
    let both = Comparison::of(&book, &ids, ids[1]);
    let last = both.rows()[2];
    let group = both.group(last, both.seen(&book, last).unwrap());
    assert_eq!(group, Group::Setting(1));
}

#[test]
fn however_many_trials_there_are_little_is_drawn_and_every_peak_of_it() {
    let mut book = TunerBook::default();
    let mut ids = Vec::new();
    for _ in 0..SHOWN_MAX + 1 {
        let id = begin(&mut book, "tcp:10.0.0.1", plan(|_| {}));
        for number in 1..=40 {
            let own = trial(number, setting(25), &Dof::ALL, recording(900, 777));
            book.keep(id, own);
        }
        ids.push(id);
    }
    let all = Comparison::of(&book, &ids, ids[0]);
    assert_eq!(all.sessions().len(), SHOWN_MAX);
    assert_eq!(all.rows().len(), SHOWN_MAX * 40 * 6);
    let picture = all.picture(&book, Shown::Force);
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
            .filter(move |own| own.place.session == session)
    };
    assert!((0..SHOWN_MAX).all(|session| of(session).count() == LINES_MAX / SHOWN_MAX));
}

#[test]
fn samples_in_files_go_first_and_what_was_lost_is_counted() {
    let mut book = TunerBook::default();
    let old = begin(&mut book, "tcp:10.0.0.1", plan(|_| {}));
    let kept = begin(&mut book, "tcp:10.0.0.1", plan(|_| {}));
    let rows = u64::try_from(ROWS_MAX / 3).unwrap();
    let own = |number| trial(number, setting(25), &[], recording(rows, 9));
    book.keep(old, own(1));
    book.keep(kept, own(1));
    book.keep(old, own(2));
    if let Origin::Here { saved, .. } = &mut book.session_mut(kept).unwrap().origin {
        *saved = Some("/tmp/kept".into());
    }
    let lost = |book: &TunerBook| [old, kept].map(|id| book.session(id).unwrap().lost);
    book.keep(old, own(3));
    assert_eq!(lost(&book), [0, 0], "they lie in files");
    book.keep(old, own(4));
    assert_eq!(lost(&book), [1, 0], "the oldest is gone");
    let first = book.session(old).unwrap().trials[0].whole.clone().unwrap();
    assert_eq!(first.recording.lost(), rows);
}

#[test]
fn nothing_is_asked_about_a_session_that_made_room() {
    let mut book = TunerBook::default();
    let first = begin(&mut book, "tcp:10.0.0.1", plan(|_| {}));
    book.ask_to_forget(first);
    assert_eq!(book.question, Some(first));
    for _ in 1..=SESSIONS_MAX {
        begin(&mut book, "tcp:10.0.0.1", plan(|_| {}));
    }
    assert_eq!((book.session(first), book.question), (None, None));
}
