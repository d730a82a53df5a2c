//! Masses of the links: those of their shapes at one density, because the parts' own are not published.

use crate::hand::model::Shape;
use glam::Vec3;
use std::f64::consts::PI;

/// Density of all shapes, kg/m³: between those of plastic and aluminium, of which no share is published. The hand weighs 0.82 kg.
pub const DENSITY: f64 = 1500.0;

/// Mass of a link, and its moments of inertia about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass in kg.
    pub mass: f64,
    /// Moments about the shape's own x, y and z in kg·m²; a rod lies along z.
    pub moments: [f64; 3],
}

/// Inertia of a shape. A rod has round ends, as in MJCF.
pub fn inertia(shape: &Shape) -> Inertia {
    match shape {
        Shape::Block(block) => {
            let [x, y, z] = block.edges.map(|mm| f64::from(mm) / 1000.0);
            let mass = DENSITY * x * y * z;
            let of = |one: f64, other: f64| mass * (one * one + other * other) / 12.0;
            Inertia {
                mass,
                moments: [of(y, z), of(x, z), of(x, y)],
            }
        }
        Shape::Rod(rod) => {
            let [from, to] = rod.ends.map(Vec3::from);
            let long = f64::from(from.distance(to)) / 1000.0;
            let radius = f64::from(rod.radius) / 1000.0;
            let square = radius * radius;
            let middle = DENSITY * PI * square * long;
            // Both ends together are a ball, whose halves are apart by the length.
            let ends = DENSITY * PI * square * radius * 4.0 / 3.0;
            let along = middle * square / 2.0 + ends * square * 0.4;
            let across = middle * (3.0 * square + long * long) / 12.0
                + ends * (square * 0.4 + long * long / 4.0 + long * radius * 0.375);
            Inertia {
                mass: middle + ends,
                moments: [across, across, along],
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::model::{Cuboid, Rod};

    /// Mass and moments of thin slices across z, each of which is a disc.
    fn sliced(long: f64, radius: f64) -> Inertia {
        const SLICES: i32 = 20_000;
        let thick = (long + 2.0 * radius) / f64::from(SLICES);
        let mut sum = Inertia {
            mass: 0.0,
            moments: [0.0; 3],
        };
        for slice in 0..SLICES {
            let z = (f64::from(slice) + 0.5) * thick - long / 2.0 - radius;
            let beyond = (z.abs() - long / 2.0).max(0.0);
            let square = radius * radius - beyond * beyond;
            let mass = DENSITY * PI * square * thick;
            sum.mass += mass;
            let [x, y, along] = &mut sum.moments;
            *along += mass * square / 2.0;
            *x += mass * (square / 4.0 + z * z);
            *y = *x;
        }
        sum
    }

    #[test]
    fn a_rod_is_the_sum_of_its_slices() {
        for (end, radius) in [
            ([30.0, 40.0, 0.0], 8.0_f32),
            ([0.0; 3], 5.0),
            ([0.0, 0.0, 9.0], 20.0),
        ] {
            let rod = Shape::Rod(Rod {
                ends: [[0.0; 3], end],
                radius,
            });
            let long = f64::from(Vec3::from(end).length()) / 1000.0;
            let (whole, sum) = (inertia(&rod), sliced(long, f64::from(radius) / 1000.0));
            assert!((whole.mass / sum.mass - 1.0).abs() < 1e-6, "{end:?}");
            for (own, sliced) in whole.moments.into_iter().zip(sum.moments) {
                assert!((own / sliced - 1.0).abs() < 1e-6, "{end:?}: {own} {sliced}");
            }
        }
    }

    #[test]
    fn a_block_turns_hardest_about_its_shortest_edge() {
        let block = Shape::Block(Cuboid {
            middle: [5.0; 3],
            edges: [20.0, 100.0, 200.0],
        });
        let Inertia { mass, moments } = inertia(&block);
        assert!((mass - 0.6).abs() < 1e-6, "{mass}");
        // m (b² + c²) / 12.
        for (own, wanted) in moments.into_iter().zip([0.0025, 0.00202, 0.00052]) {
            assert!((own - wanted).abs() < 1e-8, "{moments:?}");
        }
    }
}
