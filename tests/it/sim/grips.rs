//! The told state of a grip against the truth: of the simulated hand's objects, and of grasps that know nothing of that hand.

#[path = "../../bench/grip_model.rs"]
mod grip_model;
#[path = "../../bench/grip_table.rs"]
mod grip_table;

use crate::setup::soak;
use grip_table::{GripTable, grasps};

/// Thresholds were adjusted with hands of seeds below this.
const UNSEEN: u64 = 70_000;

fn judged(table: &GripTable) -> String {
    let (fingers, grasps) = (&table.fingers, &table.grasps);
    let tables = [fingers, grasps].map(GripTable::text).join("\n");
    let told = format!("{}\n{tables}", table.line());
    eprintln!("{told}");
    told
}

#[test]
fn the_state_of_a_grip_is_the_objects_own() {
    let table = grasps(0..soak::times_at_least(6, 12));
    let told = judged(&table);
    assert!(GripTable::wrong(&table.fingers) <= 0.01, "{told}");
    assert!(GripTable::wrong(&table.grasps) <= 0.02, "{told}");
    assert!(table.losses_in_time() >= 0.98, "{told}");
    assert!(table.slides_told * 10 >= table.slides * 9, "{told}");
    assert!(table.calm_slips * 50 <= table.calm, "{told}");
}

#[test]
fn drift_friction_wrist_turns_and_slow_slips_of_unseen_hands_are_told_as_what_they_are() {
    let table = grip_model::grasps(UNSEEN..UNSEEN + soak::times_at_least(12, 24));
    let told = judged(&table);
    assert!(GripTable::wrong(&table.fingers) <= 0.01, "{told}");
    assert!(GripTable::wrong(&table.grasps) <= 0.01, "{told}");
    assert!(GripTable::unknown(&table.fingers) <= 0.02, "{told}");
    assert!(table.losses_in_time() >= 0.99, "{told}");
    assert!(table.slides > 80, "{told}");
    assert!(table.slides_told * 10 >= table.slides * 9, "{told}");
    assert!(table.turns > 60 && table.turn_slips == 0, "{told}");
    assert!(table.calm_slips * 100 <= table.calm, "{told}");
}
