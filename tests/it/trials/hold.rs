//! Holds of random objects by random bodies, small: `cargo bench -- hold` has the table.

#[path = "../../bench/hold_table.rs"]
mod hold_table;

#[path = "../../bench/grasp_table.rs"]
mod grasp_table;

#[path = "../../bench/object_table.rs"]
mod object_table;

use crate::setup::soak::times_at_least;
use grasp_table::grasps;
use handscope::motion::hold::HoldEnd;
use hold_table::{Outcome, holds};
use object_table::objects;

/// Peaks above *at most*, g: what a drive at speed 25 may run on, on the hardest objects.
const PEAK_MAX_G: f64 = 150.0;

#[test]
fn objects_are_held_between_the_two_forces() {
    let table = holds(0..times_at_least(20, 60));
    let told = table.line();
    eprintln!("{told}");
    let seen = table.outcomes.len();
    assert!(30 * table.count(Outcome::is_missed) <= seen, "{told}");
    assert_eq!(table.count(|own| own.is_broken), 0, "{told}");
    for own in &table.outcomes {
        assert!(own.over_g <= PEAK_MAX_G, "{own:?}");
        if own.plan.is_quiet && own.plan.is_possible() {
            assert_eq!(own.end, HoldEnd::Held, "{own:?}");
            assert_eq!(own.reversals, 0, "{own:?}");
        }
    }
    assert!(table.count(|own| own.plan.is_quiet) * 8 >= seen, "{told}");
}

#[test]
fn what_is_in_the_hand_is_told_within_its_bounds() {
    let table = objects(0..40);
    let told = table.line();
    eprintln!("{told}");
    assert!(table.held >= 30, "{told}");
    assert!(table.size_mm.len() * 10 >= table.held * 9, "{told}");
    assert!(table.size_outside * 10 <= table.size_mm.len(), "{told}");
    assert!(table.class_share() >= 0.9, "{told}");
    assert!(table.weight.len() * 2 >= table.held, "{told}");
    assert_eq!(table.weight_outside, 0, "{told}");
    assert!(table.yield_wrong * 20 <= table.yield_right, "{told}");
}

#[test]
fn a_grasp_is_trusted_by_other_hands_only_where_it_works() {
    let table = grasps(2, 4);
    let told = table.line();
    eprintln!("{told}");
    for own in &table.used {
        eprintln!("{} {} {}", own.is_same_object, own.works, own.told);
    }
    assert!(table.trusted() * 4 >= table.used.len(), "{told}");
    assert_eq!(table.false_claims(), 0, "{told}");
}
