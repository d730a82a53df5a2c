//! The simulated hand's stored poses. The manual gives no list, so these are our own.

use crate::hand::PerDof;

/// ANGLE_SET of a stored pose; `None` for user gestures (14 to 40) and for numbers outside 1 to 40.
// Manual: 2.6.7 names "open, two-finger pinch, fist" among 1 to 13, without numbers.
pub fn pose(number: u8) -> Option<PerDof<i16>> {
    let angles = match number {
        1 => [1000; 6],
        2 => [0, 0, 0, 0, 300, 300],
        3 => [1000, 1000, 1000, 420, 420, 200],
        4 => [1000, 1000, 420, 420, 420, 200],
        5 => [0, 0, 0, 1000, 300, 300],
        6 => [0, 0, 1000, 1000, 300, 300],
        7 => [0, 0, 0, 0, 1000, 1000],
        8 => [1000, 0, 0, 0, 1000, 1000],
        9 => [1000, 0, 0, 1000, 300, 300],
        10 => [1000, 1000, 1000, 1000, 0, 0],
        11 => [400, 400, 400, 400, 450, 200],
        12 => [500; 6],
        13 => [0, 0, 0, 0, 1000, 0],
        _ => return None,
    };
    Some(PerDof::new(angles))
}
