//! Proves the history of a hand: nothing measured is lost from sight, nothing is invented, everything is bounded.

#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "a test may"
)]

use crate::hand::{
    AngleReading, CurrentReading, Dof, Finger, ForceReading, Group, Groups, HandSample, Moment,
    PerDof, PerFinger, Status, TactileBlock, Timed,
};
use crate::hand::{Quantity, Touch};
use crate::history::mark::{MARKS_MAX, MarkKind};
use crate::history::series::{CHANNEL_ROWS, HISTORY_ROWS, HISTORY_SECONDS, History, Series};
use crate::history::trace::Trace;

const FORCE: Series = Series::Joint(Quantity::Force, Dof::Index);

fn group<T: Copy>(value: T, millis: u64) -> Option<Timed<PerDof<T>>> {
    let at = Moment::from_micros(millis * 1000);
    Some(Timed {
        value: PerDof::splat(value),
        asked: at,
        received: at,
    })
}

fn force(history: &mut History, millis: u64, grams: i16) {
    let sample = HandSample {
        force: group(ForceReading::new(grams), millis),
        ..HandSample::default()
    };
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Force);
    history.push(&sample, fresh);
}

fn trace(history: &History, from_s: f64, to_s: f64) -> Trace {
    let mut out = Trace::default();
    history.trace(FORCE, from_s, to_s, 800, &mut out);
    out
}

#[test]
fn one_spike_in_an_hour_is_still_seen() {
    let mut history = History::new();
    for tick in 0..HISTORY_ROWS as u64 {
        force(
            &mut history,
            tick * 5,
            if tick == 377_777 { 1234 } else { 10 },
        );
    }
    let seen = trace(&history, 0.0, 3600.0);
    assert!(seen.decimated);
    assert_eq!(seen.segments.len(), 1);
    assert!(seen.points().count() <= 4 * 802);
    let peaks: Vec<_> = seen.points().filter(|point| point[1] > 1000.0).collect();
    assert_eq!(peaks.len(), 1);
    assert!((peaks[0][0] - 377_777.0 * 0.005).abs() < 4.5, "{peaks:?}");
    assert!(
        seen.points()
            .zip(seen.points().skip(1))
            .all(|(one, two)| one[0] <= two[0])
    );
}

#[test]
fn a_short_window_shows_every_value() {
    let mut history = History::new();
    for tick in 0..100 {
        force(&mut history, tick * 10, 5);
    }
    let seen = trace(&history, 0.0, 1.0);
    assert!(!seen.decimated);
    assert_eq!(seen.points().count(), 100);
}

#[test]
fn lost_links_and_long_silences_break_the_line_at_every_zoom() {
    let mut history = History::new();
    for tick in 0..10_000 {
        force(&mut history, tick * 5, 5);
    }
    history.gap(Moment::from_micros(50_000_000));
    for tick in 0..10_000 {
        force(&mut history, 50_200 + tick * 5, 5);
    }
    for tick in 0..10_000 {
        force(&mut history, 101_000 + tick * 5, 5);
    }
    for (from_s, to_s) in [(0.0, 600.0), (0.0, 160.0), (40.0, 110.0)] {
        let seen = trace(&history, from_s, to_s);
        assert_eq!(seen.segments.len(), 3, "{from_s}..{to_s}");
        assert!(seen.segments.iter().all(|segment| !segment.is_empty()));
        let ends = seen.segments[0].last().map(|point| point[0]);
        assert!(ends.is_some_and(|end| end <= 50.0));
    }
}

#[test]
fn the_state_of_a_drive_is_unknown_in_each_silence_that_breaks_the_lines() {
    let mut history = History::new();
    let fresh = Groups::from_iter([Group::Current, Group::Status]);
    let tick = |history: &mut History, millis: u64| {
        let sample = HandSample {
            current: group(CurrentReading::new(7), millis),
            status: group(Status::PositionReached, millis),
            ..HandSample::default()
        };
        history.push(&sample, fresh);
    };
    for begin in [0, 1400, 3000] {
        (0..10).for_each(|step| tick(&mut history, begin + step * 100));
    }
    let runs = history.status(Dof::Index, 0.0, 10.0);
    let runs: Vec<_> = runs.map(|run| (run.from_s, run.until_s)).collect();
    assert_eq!(runs, [(0.0, 2.3), (3.0, 3.9)], "0.5 s are no silence yet");
    let mut seen = Trace::default();
    let current = Series::Joint(Quantity::Current, Dof::Index);
    history.trace(current, 0.0, 10.0, 1000, &mut seen);
    assert_eq!(seen.segments.len(), runs.len());
}

#[test]
fn values_outside_the_manual_are_gaps_and_never_zero() {
    let mut history = History::new();
    for tick in 0..10 {
        force(&mut history, tick * 10, if tick == 5 { 9999 } else { 100 });
    }
    let seen = trace(&history, 0.0, 1.0);
    assert_eq!(seen.segments.len(), 2);
    assert!(seen.points().all(|point| (point[1] - 100.0).abs() < 1e-9));
}

#[test]
fn a_tip_that_is_not_a_number_is_a_gap() {
    let mut history = History::new();
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Tactile(Finger::Thumb));
    for (millis, normal_n) in [(0, 1.0), (30, f32::NAN), (60, 2.0)] {
        let mut block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
        block.normal_n = normal_n;
        let at = Moment::from_micros(millis * 1000);
        let mut sample = HandSample::default();
        sample.tactile[Finger::Thumb] = Some(Timed {
            value: block,
            asked: at,
            received: at,
        });
        history.push(&sample, fresh);
    }
    let mut out = Trace::default();
    history.trace(
        Series::Tip(Touch::Normal, Finger::Thumb),
        0.0,
        1.0,
        800,
        &mut out,
    );
    assert_eq!(out.segments, [vec![[0.0, 1.0]], vec![[0.06, 2.0]]]);
    history.trace(
        Series::Tip(Touch::Normal, Finger::Index),
        0.0,
        1.0,
        800,
        &mut out,
    );
    assert!(out.segments.is_empty());
}

#[test]
fn only_fresh_groups_are_taken() {
    let mut history = History::new();
    let sample = HandSample {
        angle: group(AngleReading::new(5), 1),
        ..HandSample::default()
    };
    history.push(&sample, Groups::NONE);
    assert_eq!(history.last_secs(), None);
}

#[test]
fn history_is_bounded_in_rows_and_memory() {
    let mut history = History::new();
    let block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
    let mut sample = HandSample::default();
    let mut fresh = Groups::from_iter([
        Group::Angle,
        Group::Force,
        Group::Current,
        Group::Temperature,
        Group::AngleSet,
    ]);
    for finger in Finger::ALL {
        fresh.insert(Group::Tactile(finger));
    }
    for tick in 0..HISTORY_ROWS as u64 + 5000 {
        let at = Moment::from_micros(tick * 5000);
        sample.angle = group(AngleReading::new(1), tick * 5);
        sample.force = group(ForceReading::new(1), tick * 5);
        sample.current = group(crate::hand::CurrentReading::new(1), tick * 5);
        sample.temperature = group(crate::hand::TemperatureReading::new(1), tick * 5);
        sample.angle_set = group(None, tick * 5);
        sample.tactile = PerFinger::splat(Some(Timed {
            value: block,
            asked: at,
            received: at,
        }));
        history.push(&sample, fresh);
    }
    assert!(history.bytes() <= 240_000_000, "{}", history.bytes());
    assert!(
        history
            .first_secs()
            .is_some_and(|first| (first - 25.0).abs() < 0.1)
    );
}

#[test]
fn marks_are_bounded_and_found_by_time() {
    let mut history = History::new();
    for second in 0..4000 {
        history.mark(Moment::from_micros(second * 1_000_000), MarkKind::Stop);
    }
    assert_eq!(history.marks(0.0, 4000.0).count(), MARKS_MAX);
    assert_eq!(history.marks(3990.0, 3994.0).count(), 5);
}

/// A force that differs from joint to joint and from row to row, with values outside the manual in between.
fn jagged(rows: u64) -> (History, Vec<Option<f32>>) {
    let mut history = History::new();
    let mut values = Vec::new();
    for tick in 0..rows {
        let raw = if tick % 977 == 500 {
            9999
        } else {
            (tick * 7919 % 1013) as i16
        };
        force(&mut history, tick * 10, raw);
        values.push((raw < 9999).then_some(f32::from(raw)));
    }
    (history, values)
}

#[test]
fn each_column_of_pixels_shows_the_extremes_of_its_measurements() {
    let (history, values) = jagged(200_000);
    for (from_s, to_s) in [
        (0.0, 2000.0),
        (100.0, 1900.0),
        (500.0, 560.0),
        (1999.0, 2005.0),
    ] {
        let seen = trace(&history, from_s, to_s);
        let within = |time_s: f64| (from_s..=to_s).contains(&time_s);
        let all = values
            .iter()
            .enumerate()
            .filter(|(row, _)| within(*row as f64 * 0.01));
        let known: Vec<f32> = all.filter_map(|(_, value)| *value).collect();
        let (low, high) = known
            .iter()
            .fold((f32::MAX, f32::MIN), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
        let drawn: Vec<f64> = seen.points().map(|point| point[1]).collect();
        assert!(drawn.contains(&f64::from(low)) && drawn.contains(&f64::from(high)));
        for point in seen.points() {
            let near = (point[0] * 100.0).round() as usize;
            let step = ((to_s - from_s) / 800.0 * 150.0) as usize + 2;
            let rows = near.saturating_sub(step)..(near + step).min(values.len());
            let is = values[rows]
                .iter()
                .flatten()
                .any(|value| f64::from(*value) == point[1]);
            assert!(is, "{point:?} was measured nowhere near");
        }
    }
}

#[test]
fn summaries_are_those_of_all_measurements_and_not_of_the_drawn_ones() {
    let (history, values) = jagged(200_000);
    for (from, to) in [(0, 199_999), (123, 98_765), (50_000, 50_063), (500, 500)] {
        let known: Vec<f32> = values[from..=to].iter().flatten().copied().collect();
        let summary = history.summary(FORCE, from as f64 / 100.0, to as f64 / 100.0);
        let Some(summary) = summary else {
            assert!(known.is_empty());
            continue;
        };
        let mean = known.iter().copied().map(f64::from).sum::<f64>() / known.len() as f64;
        assert_eq!(summary.count as usize, known.len());
        assert!((summary.mean - mean).abs() < 1e-9);
        assert_eq!(summary.max, known.iter().copied().fold(f32::MIN, f32::max));
        assert_eq!(summary.min, known.iter().copied().fold(f32::MAX, f32::min));
    }
}

#[test]
fn a_reading_is_the_nearest_measurement_and_there_is_none_in_a_gap() {
    let mut history = History::new();
    for (millis, grams) in [(0, 1), (100, 2), (200, 3), (5000, 4)] {
        force(&mut history, millis, grams);
    }
    let at = |time_s| history.reading(FORCE, time_s).map(|reading| reading.value);
    assert_eq!(at(0.04), Some(1.0));
    assert_eq!(at(0.06), Some(2.0));
    assert_eq!(at(0.1), Some(2.0));
    assert_eq!(at(2.0), None);
    assert_eq!(at(0.201), None, "no line leads on");
    assert_eq!(at(4.99), None, "what came later says nothing of it");
    assert_eq!(at(5.0), Some(4.0));
    assert_eq!(at(5.4), Some(4.0), "the newest holds on");
    assert_eq!(at(5.6), None);
    assert_eq!(at(-3.0), None);
}

#[test]
fn lines_of_other_groups_never_share_a_cut() {
    let mut history = History::new();
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Force);
    fresh.insert(Group::Angle);
    for tick in 0..5000_u64 {
        let sample = HandSample {
            force: group(ForceReading::new(7), tick * 10),
            angle: group(AngleReading::new(500), tick * 10 + 3),
            ..HandSample::default()
        };
        history.push(&sample, fresh);
    }
    let angle = Series::Joint(Quantity::Angle, Dof::Index);
    let (mut shared, mut alone) = (Trace::default(), Trace::default());
    history.trace(FORCE, 0.0, 50.0, 100, &mut shared);
    history.trace(angle, 0.0, 50.0, 100, &mut shared);
    history.trace(angle, 0.0, 50.0, 100, &mut alone);
    assert_eq!(shared.segments, alone.segments);
    force(&mut history, 50_000, 900);
    history.trace(FORCE, 0.0, 50.5, 100, &mut shared);
    assert!(shared.points().any(|point| point[1] > 800.0));
}

#[test]
fn notes_are_one_line_and_stand_in_the_order_of_their_moments() {
    let mut history = History::new();
    history.mark(Moment::from_micros(5_000_000), MarkKind::Stop);
    let note = MarkKind::note("  slips here\nand more ").unwrap();
    history.mark(Moment::from_micros(3_000_000), note.clone());
    let kinds: Vec<_> = history
        .marks(0.0, 9.0)
        .map(|mark| mark.kind.clone())
        .collect();
    assert_eq!(kinds, [note, MarkKind::Stop]);
    assert_eq!(kinds[0].words(), "note: slips here");
    assert_eq!(MarkKind::note("  "), None);
}

#[test]
fn an_hour_at_100_hz_with_fingertips_at_30_hz_fits_in_100_megabytes() {
    let mut history = History::new();
    let block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
    let (mut state, mut touch) = (Groups::NONE, Groups::NONE);
    for group in [
        Group::Angle,
        Group::Force,
        Group::Current,
        Group::Temperature,
    ] {
        state.insert(group);
    }
    Finger::ALL
        .into_iter()
        .for_each(|finger| touch.insert(Group::Tactile(finger)));
    for tick in 0..u64::from(HISTORY_SECONDS) * 100 {
        let at = Moment::from_micros(tick * 10_000);
        let sample = HandSample {
            angle: group(AngleReading::new(1), tick * 10),
            force: group(ForceReading::new(1), tick * 10),
            current: group(crate::hand::CurrentReading::new(1), tick * 10),
            temperature: group(crate::hand::TemperatureReading::new(1), tick * 10),
            tactile: PerFinger::splat(Some(Timed {
                value: block,
                asked: at,
                received: at,
            })),
            ..HandSample::default()
        };
        history.push(&sample, state);
        if tick % 10 % 3 == 0 {
            history.push(&sample, touch);
        }
    }
    let first = history.first_secs().unwrap();
    assert!(
        first < 0.1 && history.last_secs().unwrap() > 3599.0,
        "{first}"
    );
    assert!(history.bytes() <= 100_000_000, "{}", history.bytes());
    let channels = history.channel_bytes();
    assert!((4_000_000..7_000_000).contains(&channels), "{channels}");
}

#[test]
fn channels_are_kept_for_ten_minutes_and_tell_their_mean_and_swing() {
    let mut history = History::new();
    let mut touch = Groups::NONE;
    touch.insert(Group::Tactile(Finger::Ring));
    let mut block = TactileBlock::decode(&[0; 58]).expect("58 bytes");
    for tick in 0..30 * 900u64 {
        let at = Moment::from_micros(tick * 100_000 / 3);
        block.raw[2] = 3_000_000 + if tick % 2 == 0 { 100 } else { 0 };
        let mut sample = HandSample::default();
        sample.tactile[Finger::Ring] = Some(Timed {
            value: block,
            asked: at,
            received: at,
        });
        history.push(&sample, touch);
    }
    let series = Series::Channel(2, Finger::Ring);
    let rows = history.rows(&[series], 0.0, 1000.0);
    assert_eq!(rows, CHANNEL_ROWS);
    assert!(history.reading(series, 290.0).is_none() && history.reading(series, 310.0).is_some());
    let last = history.summary(series, 898.0, 899.0).unwrap();
    assert!((last.mean - 3_000_050.0).abs() < 3.0, "{last:?}");
    assert!((last.max - last.min - 100.0).abs() < 1.0, "{last:?}");
    let quiet = history.summary(Series::Channel(0, Finger::Ring), 898.0, 899.0);
    assert_eq!(quiet.map(|quiet| quiet.max - quiet.min), Some(0.0));
    assert_eq!(history.summary(series, 2000.0, 2001.0), None);
}
