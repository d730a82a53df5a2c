//! Tests of the poll plan, on a line that is nothing but its cost model.
use crate::hand::{Finger, Moment, RateClass, Span};
use crate::link::poll::cost::WireCost;
use crate::link::poll::plan::{PollPlan, PollPriority, PollRates, Tempo};
use crate::link::poll::window::ReadPart;
use crate::link::quirks::GapRead;
use std::time::Duration;

const MS: Duration = Duration::from_millis(1);
const SECONDS: u64 = 10;

/// What a run gave.
struct Run {
    asked: Vec<Span>,
    /// Reads of each part a second, in the order of `ReadPart::ALL`.
    hz: [f64; ReadPart::ALL.len()],
}

impl Run {
    fn of(&self, part: ReadPart) -> f64 {
        self.hz[ReadPart::ALL.iter().position(|each| *each == part).unwrap()]
    }

    fn check_all(&self, least: f64) {
        for (part, hz) in ReadPart::ALL.iter().zip(self.hz) {
            assert!(hz >= least, "{part:?} is read {hz} times a second");
        }
    }
}

/// Reads by plan for ten seconds, each question in its first form that is not the last one asked.
fn run(cost: WireCost, turnaround: Duration, rates: PollRates, tempo: Tempo) -> Run {
    read(PollPlan::new(rates, cost, Moment::ZERO), turnaround, tempo)
}

fn read(plan: PollPlan, turnaround: Duration, tempo: Tempo) -> Run {
    read_from(Moment::ZERO, plan, turnaround, tempo)
}

fn read_from(mut now: Moment, mut plan: PollPlan, turnaround: Duration, tempo: Tempo) -> Run {
    let (cost, end) = (*plan.cost(), now.plus(Duration::from_secs(SECONDS)));
    let (mut asked, mut counts) = (Vec::<Span>::new(), [0_u32; ReadPart::ALL.len()]);
    while now < end {
        let Some(question) = plan.next(now, tempo) else {
            now = plan.next_due(now, tempo);
            continue;
        };
        let window = *question
            .shapes
            .iter()
            .find(|shape| Some(*shape) != asked.last())
            .unwrap();
        let took = cost.read(window.len, turnaround);
        plan.answered(window, now, took);
        now = now.plus(took);
        asked.push(window);
        for (count, part) in counts.iter_mut().zip(ReadPart::ALL) {
            *count += u32::from(window.covers(part.span()));
        }
    }
    Run {
        asked,
        hz: counts.map(|count| f64::from(count) / 10.0),
    }
}

fn rs485(baud: u32) -> WireCost {
    WireCost::rs485(Some(baud))
}

#[test]
fn rates_are_kept_where_the_line_allows() {
    for cost in [WireCost::rs485(None), WireCost::tcp()] {
        let run = run(cost, MS / 5, PollRates::default(), Tempo::Rest);
        for part in [ReadPart::Angle, ReadPart::Force, ReadPart::Drives] {
            assert!((99.0..=101.0).contains(&run.of(part)), "{}", run.of(part));
        }
        assert!((29.0..=31.0).contains(&run.of(ReadPart::Tip(Finger::ALL[3]))));
        assert!((4.9..=6.0).contains(&run.of(ReadPart::Temperature)));
        assert!((1.9..=2.5).contains(&run.of(ReadPart::Speeds)));
    }
}

#[test]
fn nothing_starves_at_any_speed_of_the_line_and_the_hand_at_rest_or_moving() {
    for baud in [19_200, 57_600, 115_200, 921_600] {
        for turnaround in [MS, MS * 6, MS * 15] {
            for rates in [PollRates::default(), PollRates::FULL] {
                for tempo in [Tempo::Rest, Tempo::Motion] {
                    let run = run(rs485(baud), turnaround, rates, tempo);
                    run.check_all(0.3);
                }
            }
        }
    }
}

#[test]
fn while_something_moves_every_second_read_is_motion_and_a_stop_is_in_time_behind_each() {
    for cost in [rs485(115_200), WireCost::rtu(115_200, MS * 7 / 4)] {
        for rates in [PollRates::default(), PollRates::FULL] {
            let run = run(cost, MS * 15, rates, Tempo::Motion);
            for pair in run.asked.windows(2) {
                let motion = |span: &Span| span.covers(ReadPart::Angle.span());
                assert!(pair.iter().any(motion), "{pair:?}");
            }
            let slowest = run.asked.iter().map(|span| cost.read(span.len, MS * 15));
            let hold = Duration::from_micros(1823);
            assert!(slowest.max().unwrap() + hold <= MS * 30);
            let rest = self::run(cost, MS * 15, rates, Tempo::Rest);
            assert!(
                run.of(ReadPart::Angle) > rest.of(ReadPart::Angle),
                "motion comes first"
            );
        }
    }
}

#[test]
fn while_something_moves_touch_comes_at_10_hz_and_more_often_where_it_comes_first() {
    let run = |first| {
        let mut plan = PollPlan::new(PollRates::default(), rs485(115_200), Moment::ZERO);
        plan.prefer(first);
        read(plan, MS * 6, Tempo::Motion)
    };
    let (force, touch) = (run(PollPriority::Force), run(PollPriority::Touch));
    assert!(force.of(ReadPart::Angle) >= 25.0 && force.of(ReadPart::Drives) >= 25.0);
    assert!(
        force.of(ReadPart::Tip(Finger::ALL[4])) >= 10.0,
        "{}",
        force.of(ReadPart::Tip(Finger::ALL[4]))
    );
    assert!(
        touch.of(ReadPart::Tip(Finger::ALL[4])) >= 14.0,
        "{}",
        touch.of(ReadPart::Tip(Finger::ALL[4]))
    );
    assert!(
        touch.of(ReadPart::Angle) >= 15.0,
        "{}",
        touch.of(ReadPart::Angle)
    );
    touch.check_all(0.3);
}

#[test]
fn at_full_rate_and_rest_a_cycle_is_one_state_and_two_reads_of_fingertips() {
    let run = run(rs485(115_200), MS * 6, PollRates::FULL, Tempo::Rest);
    let late = &run.asked[200..];
    let states = late
        .iter()
        .filter(|span| span.covers(ReadPart::Drives.span()))
        .count();
    let tips = late.iter().filter(|span| span.address >= 2950).count();
    assert!(
        states.abs_diff(tips / 2) <= states / 10,
        "{states} {tips} {:?}",
        &late[..12]
    );
    // What is read seldom, and forms that differ, take no more than 3 % of the line.
    let cost = |len| rs485(115_200).read(len, MS * 6).as_secs_f64();
    let cycle = cost(72) + cost(232) + cost(58);
    let all: f64 = late.iter().map(|span| cost(span.len)).sum();
    let cycles = f64::from(u32::try_from(states).unwrap());
    assert!(cycles * cycle > all * 0.975, "{}", cycles * cycle / all);
}

#[test]
fn fingertips_at_the_ends_that_were_read_alone_are_not_read_alone_for_ever() {
    let cost = WireCost::rtu(115_200, MS * 7 / 4);
    let mut plan = PollPlan::new(PollRates::FULL, cost, Moment::ZERO);
    let mut now = Moment::ZERO;
    // So often that the turnaround is known, and with it how much one read may hold.
    for _ in 0..32 {
        for (tip, together) in [(1, 3), (4, 1), (0, 1)] {
            let window = Span::new(
                ReadPart::Tip(Finger::ALL[tip]).span().address,
                58 * together,
            );
            let took = cost.read(window.len, MS * 6);
            plan.answered(window, now, took);
            now = now.plus(took);
        }
        let state = Span::new(1546, 72);
        plan.answered(state, now, cost.read(72, MS * 6));
        now = now.plus(cost.read(72, MS * 6));
    }
    let run = read_from(now, plan, MS * 6, Tempo::Rest);
    let late = run.asked.iter().skip(20);
    let tips: Vec<_> = late.filter(|span| span.address >= 2950).collect();
    assert!(
        tips.iter().all(|span| span.len >= 2 * 58),
        "{:?}",
        &tips[..9]
    );
}

#[test]
fn no_form_of_a_window_is_asked_for_again_within_three_questions() {
    for tempo in [Tempo::Rest, Tempo::Motion, Tempo::Stopping] {
        let run = run(rs485(115_200), MS * 3, PollRates::FULL, tempo);
        // One fingertip alone has one form only, and is one of many.
        for four in run.asked.windows(4).filter(|four| four[0].len != 58) {
            assert!(!four[1..].contains(&four[0]), "{tempo:?} {four:?}");
        }
    }
}

#[test]
fn while_a_stop_is_confirmed_only_motion_and_faults_are_read() {
    let run = run(
        rs485(115_200),
        MS * 15,
        PollRates::default(),
        Tempo::Stopping,
    );
    assert!(
        run.asked
            .iter()
            .all(|span| span.covers(ReadPart::Angle.span()) || span.covers(ReadPart::Drives.span()))
    );
    assert!(run.of(ReadPart::Angle) > 20.0 && run.of(ReadPart::Drives) > 15.0);
}

#[test]
fn the_motion_state_has_forms_enough_for_a_line_with_late_replies() {
    for (cost, forms, lens) in [(rs485(115_200), 14, 8), (WireCost::rtu(115_200, MS), 10, 8)] {
        let plan = PollPlan::new(PollRates::FULL, cost, Moment::ZERO);
        for tempo in [Tempo::Rest, Tempo::Motion, Tempo::Stopping] {
            let shapes = plan.motion(Moment::ZERO, tempo).shapes;
            let mut seen: Vec<u16> = shapes.iter().map(|shape| shape.len).collect();
            seen.sort_unstable();
            seen.dedup();
            assert!(
                shapes.len() >= forms && seen.len() >= lens,
                "{tempo:?} {shapes:?}"
            );
            assert!(
                shapes
                    .iter()
                    .all(|shape| shape.covers(ReadPart::Angle.span()))
            );
        }
    }
}

#[test]
fn a_hand_that_is_not_to_be_read_is_asked_for_nothing_again() {
    let none = PollRates {
        state_hz: 0.0,
        tactile_hz: 0.0,
        settings_hz: 0.0,
    };
    let run = run(rs485(115_200), MS, none, Tempo::Rest);
    assert!(run.asked.len() <= 8, "{:?}", run.asked);
}

#[test]
fn what_the_wire_could_give_is_the_cost_model_turned_round() {
    let cost = rs485(115_200);
    let mut plan = PollPlan::new(PollRates::FULL, cost, Moment::ZERO);
    assert!(plan.could_hz(RateClass::Motion) < f64::EPSILON);
    for n in 0..100_u64 {
        let at = Moment::from_micros(n * 20_000);
        plan.answered(Span::new(1546, 48), at, cost.read(48, MS * 6));
    }
    let alone = |len| 1.0 / cost.read(len, MS * 6).as_secs_f64();
    assert!((plan.could_hz(RateClass::Motion) / alone(48) - 1.0).abs() < 0.01);
    let sweep = cost.read(232, MS * 6) + cost.read(58, MS * 6);
    let sweeps = 1.0 / sweep.as_secs_f64();
    assert!((plan.could_hz(RateClass::Tactile) / sweeps - 1.0).abs() < 0.01);
}

#[test]
fn a_hand_known_to_refuse_the_gap_is_never_asked_through_it() {
    let cost = rs485(115_200);
    let mut plan = PollPlan::new(PollRates::FULL, cost, Moment::ZERO);
    plan.set_gap_read(GapRead::Split);
    let mut now = Moment::ZERO;
    let mut seen = [0_u32; 2];
    for _ in 0..300 {
        let window = plan.next(now, Tempo::Rest).unwrap().shapes[0];
        assert!(window.end() <= 1558 || window.address >= 1582, "{window:?}");
        seen[0] += u32::from(window.covers(ReadPart::Angle.span()));
        seen[1] += u32::from(window.covers(ReadPart::Force.span()));
        let took = cost.read(window.len, MS * 6);
        plan.answered(window, now, took);
        now = now.plus(took);
    }
    assert!(seen.iter().all(|reads| *reads > 50), "{seen:?}");
}
