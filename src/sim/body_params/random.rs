//! Random bodies between the two hands with published measurements, for tests and benches.
//!
//! One is smorales' RH56DFTP (latency 66 ms, 99 of 100 below 70; 3.04 counts/s per unit of speed; contacts that scatter by 7.5
//! counts; zeros up to 241 g), the other the damaged RH56DFX of arXiv 2603.08988.

use crate::hand::{Finger, PerDof};
use crate::sim::body_params::{BodyParams, JointBody};

/// Draws the body of this seed. Each hand has its own overshoot characteristic; its joints differ slightly.
pub fn random(seed: u64) -> BodyParams {
    let mut rng = fastrand::Rng::with_seed(seed ^ 0xB0D7);
    // A separate generator, so that all other values stay as they were before this one was added.
    let mut kept = fastrand::Rng::with_seed(seed ^ 0x6B65_7074);
    let run_on = rng.f64();
    let mut between = |least: f64, most: f64| least + (most - least) * rng.f64();
    let mut body = BodyParams::default();
    body.supply.sag = between(0.0, 0.2);
    body.joints = PerDof::from_fn(|_| JointBody {
        stiffness_factor: between(0.7, 1.4),
        contact_offset: between(-20.0, 20.0),
        contact_scatter: between(3.0, 9.0),
        latency_ms: between(58.0, 72.0),
        latency_scatter_ms: between(1.0, 3.0),
        run_on: (run_on + between(-0.1, 0.1)).clamp(0.0, 1.0),
        kept_overshoot: kept.f64(),
        force_noise_g: between(2.0, 8.0),
        force_zero_g: between(-50.0, 240.0),
        friction_ma: between(90.0, 200.0),
        opening_friction_ma: between(90.0, 200.0),
        friction_ma_per_speed: between(0.0, 0.1),
        backlash: between(0.0, 6.0),
        counts_per_speed: between(2.9, 3.4),
        heating: between(0.35, 0.6),
        cooling_s: between(50.0, 90.0),
        warmer_by_c: between(-5.0, 8.0),
    });
    for finger in Finger::ALL {
        for drift in &mut body.fingertips[finger].drift {
            *drift = between(-200.0, 200.0);
        }
    }
    body
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::body_params::file::{parse, print};

    #[test]
    fn a_seed_gives_one_body_and_all_are_in_range() {
        assert_eq!(random(3), random(3));
        assert_ne!(random(3), random(4));
        for seed in 0..50 {
            let body = random(seed);
            assert_eq!(parse(&print(&body)), Ok(body));
        }
    }
}
