//! Lines of kept columns against those of a fresh computation, whatever was pushed and shown before.

use crate::history::trace::Trace;
use crate::history::track::{HistoryTrack, Slice};
use proptest::prelude::*;

/// Rows held: few, so that they run out.
const ROOM: usize = 3000;

#[derive(Debug, Clone)]
enum Step {
    /// Rows so many milliseconds apart; each so many-th one is not known.
    Push {
        rows: u32,
        apart_ms: u32,
        unknown_each: u32,
    },
    /// The link is lost.
    Gap,
    /// So many seconds over so many columns, ending so far back.
    Show {
        width_s: f64,
        columns: u32,
        back_s: f64,
    },
}

fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        4 => (1..300_u32, 1..40_u32, 2..900_u32).prop_map(|(rows, apart_ms, unknown_each)| {
            Step::Push { rows, apart_ms, unknown_each }
        }),
        1 => Just(Step::Gap),
        2 => (-1.0..2.2_f64, 10..200_u32, prop_oneof![Just(0.0), 0.0..20.0_f64]).prop_map(
            |(size, columns, back_s)| Step::Show { width_s: 10_f64.powf(size), columns, back_s }
        ),
    ]
}

fn push(track: &mut HistoryTrack, tick: &mut u32, at_s: &mut f64, step: &Step) {
    if let Step::Push {
        rows,
        apart_ms,
        unknown_each,
    } = step
    {
        for _ in 0..*rows {
            *tick += 1;
            *at_s += f64::from(*apart_ms) / 1000.0;
            let known = !tick.is_multiple_of(*unknown_each);
            let value = f32::from(u16::try_from(*tick * 7919 % 1013).unwrap_or_default());
            track.push(*at_s, [known.then_some(value), Some(-value)]);
        }
    }
}

proptest! {
    #[test]
    fn kept_columns_draw_what_fresh_ones_draw(steps in prop::collection::vec(step(), 1..60)) {
        let mut track = HistoryTrack::new(0, 2, ROOM, 0.5);
        let (mut tick, mut at_s) = (0, 0.0);
        let mut view = (10.0, 60, 0.0);
        let mut kept = [Trace::default(), Trace::default()];
        for step in &steps {
            match step {
                Step::Push { .. } => push(&mut track, &mut tick, &mut at_s, step),
                Step::Gap => track.gap(at_s),
                Step::Show { width_s, columns, back_s } => view = (*width_s, *columns, *back_s),
            }
            let (width_s, columns, back_s) = view;
            let slice = Slice { from_s: at_s - back_s - width_s, to_s: at_s - back_s, columns };
            for (quantity, kept) in kept.iter_mut().enumerate() {
                let mut fresh = Trace::default();
                track.trace(quantity, slice, &mut fresh);
                track.trace(quantity, slice, kept);
                prop_assert_eq!(&kept.segments, &fresh.segments);
                prop_assert_eq!(kept.decimated, fresh.decimated);
            }
        }
    }
}

/// A ramp with one row that stands out, over a thousand seconds.
fn ramp(spike: usize) -> HistoryTrack {
    let mut track = HistoryTrack::new(0, 1, 100_000, 0.5);
    for row in 0..100_000_usize {
        let value = if row == spike { 5000.0 } else { 1.0 };
        track.push(
            f64::from(u32::try_from(row).unwrap_or_default()) * 0.01,
            [Some(value)],
        );
    }
    track
}

#[test]
fn one_measurement_that_stands_out_stays_until_it_leaves_the_window() {
    let track = ramp(40_000);
    let mut kept = Trace::default();
    for to in (500..1000_u32).step_by(3) {
        let slice = Slice {
            from_s: f64::from(to) - 500.0,
            to_s: f64::from(to),
            columns: 400,
        };
        track.trace(0, slice, &mut kept);
        let highest = kept.points().map(|point| point[1]).fold(0.0, f64::max);
        if !(901..905).contains(&to) {
            assert_eq!(highest > 4000.0, to <= 900, "{to}");
        }
    }
}

#[test]
fn columns_of_another_history_are_not_taken_for_ones_own() {
    let (one, mut two) = (ramp(10), HistoryTrack::new(0, 1, 100_000, 0.5));
    for row in 0..100_000_u32 {
        two.push(f64::from(row) * 0.01 + 0.001, [Some(7.0)]);
    }
    let slice = Slice {
        from_s: 0.0,
        to_s: 1000.0,
        columns: 400,
    };
    let (mut kept, mut fresh) = (Trace::default(), Trace::default());
    one.trace(0, slice, &mut kept);
    two.trace(0, slice, &mut kept);
    two.trace(0, slice, &mut fresh);
    assert_eq!(kept.segments, fresh.segments);
}
