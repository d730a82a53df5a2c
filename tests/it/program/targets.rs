//! A target's step never stands later in the history than the motion that it caused, on every wire.

use crate::program::Bench;
use crate::setup::hand;
use crate::setup::link::to_hand;
use handscope::app::action::Action;
use handscope::hand::{Angle, Dof, Quantity};
use handscope::history::Series;
use handscope::sim::SimConfig;

const WIRES: [&str; 6] = ["rs485:x", "rtu:x", "tcp:x", "can:x", "slcan:x", "usbcan:x"];
/// Counts by which a resting joint is read differently.
const NOISE: f64 = 5.0;

/// Times and values of one line of the history.
fn line(bench: &Bench, quantity: Quantity) -> Vec<(f64, f64)> {
    let series = Series::Joint(quantity, Dof::Index);
    let table = bench
        .hand()
        .measured
        .history
        .table(&[series], 0.0, f64::INFINITY);
    let csv = table.csv();
    let cells = csv.lines().skip(1).map(|line| line.split(','));
    let numbers = cells.filter_map(|mut cells| {
        let time = cells.next()?.parse().ok()?;
        Some((time, cells.next()?.parse().ok()?))
    });
    numbers.collect()
}

/// When a line first leaves what it was at `from_s` by more than `by`.
fn leaves(line: &[(f64, f64)], from_s: f64, by: f64) -> f64 {
    let before = line.iter().rfind(|(at, _)| *at <= from_s).unwrap().1;
    let mut later = line.iter().filter(|(at, _)| *at > from_s);
    let left = later.find(|(_, value)| (value - before).abs() > by);
    left.unwrap_or_else(|| panic!("it stays at {before} after {from_s}"))
        .0
}

#[tokio::test(start_paused = true)]
async fn a_target_steps_before_the_motion_that_it_caused_on_every_wire() {
    for wire in WIRES {
        let hand = hand::begin(hand::free(SimConfig::default()));
        let mut bench = Bench::on(to_hand(hand.clone()), hand, wire).await;
        bench.arm().await;
        let mut asked = Vec::new();
        for angle in [700, 900, 300] {
            // A step that stands at this very moment counts as later.
            asked.push(bench.clock.now().secs() - 0.005);
            let target = Angle::nearest(angle);
            bench.act(Action::Target(Dof::Index, target));
            bench.run(6000).await;
            assert_eq!(bench.target(Dof::Index), Some(angle), "{wire}");
        }
        let targets = line(&bench, Quantity::TargetAngle);
        let angles = line(&bench, Quantity::Angle);
        for at in asked {
            let (stepped, moved) = (leaves(&targets, at, 0.5), leaves(&angles, at, NOISE));
            assert!(
                stepped <= moved,
                "{wire}: motion at {moved}, target {stepped}"
            );
            assert!(stepped - at < 0.1, "{wire}: asked at {at}, {stepped}");
        }
    }
}
