//! The told state of a grip against the simulated object's own truth, on random bodies and objects.

#[path = "../../bench/grip_table.rs"]
mod grip_table;

use grip_table::{GripTable, grasps};

#[test]
fn the_state_of_a_grip_is_the_objects_own() {
    let bodies = std::env::var("GRIP_BODIES").ok();
    let bodies = bodies.and_then(|count| count.parse().ok()).unwrap_or(3);
    let table = grasps(0..bodies);
    let told = format!(
        "{} grasps, fingers wrong {:.4}, grasps wrong {:.4}, losses {} in time {:.4}, slides {} told {}, calm {} slips {}\n{}\n{}",
        table.count,
        GripTable::wrong(&table.fingers),
        GripTable::wrong(&table.grasps),
        table.losses.len(),
        table.losses_in_time(),
        table.slides,
        table.slides_told,
        table.calm,
        table.calm_slips,
        GripTable::text(&table.fingers),
        GripTable::text(&table.grasps),
    );
    eprintln!("{told}");
    assert!(GripTable::wrong(&table.fingers) <= 0.02, "{told}");
    assert!(GripTable::wrong(&table.grasps) <= 0.02, "{told}");
    assert!(table.losses_in_time() >= 0.98, "{told}");
    assert!(table.slides_told * 10 >= table.slides * 9, "{told}");
    assert!(table.calm_slips * 50 <= table.calm, "{told}");
}
