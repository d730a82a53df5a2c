//! Fingertip blocks: eight channels, force and proximity of a contact (manual 2.6.21). Moves nothing.

use crate::hand::feedback::tactile::PAD_CENTRES_MM;
use crate::hand::{Finger, PerFinger, TactileBlock};
use crate::sim::body_params::{BodyParams, FingertipBody};
use crate::sim::number;
use glam::DVec2;

/// Newtons per gram-force.
const N_PER_G: f64 = 0.0098;
/// Force from which the sensor reports contact, N.
const CONTACT_N: f64 = 0.05;
/// Noise amplitude of a channel, counts.
const CHANNEL_NOISE: f64 = 350.0;
/// Counts that one newton adds to a channel directly under the contact.
const COUNTS_PER_N: f64 = 42_000.0;
/// Width of the pressed spot, mm.
const SPOT_MM: f64 = 4.2;
/// Proximity counts just before the fingertip touches.
const PROXIMITY_NEAR: f64 = 240_000.0;
/// Position counts over which proximity falls to a third.
const PROXIMITY_RANGE: f64 = 130.0;
/// Noise amplitude of the proximity, counts.
const PROXIMITY_NOISE: f64 = 120.0;
/// Measuring interval of the sensor board, ms: 50 Hz.
pub const SENSOR_MS: u64 = 20;
/// Load on one fingertip, and its distance from the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Force, g.
    pub force_g: f64,
    /// Load along the surface, g.
    pub tangential_g: DVec2,
    /// Distance by which the contact slid, mm.
    pub slid_mm: DVec2,
    /// Position counts to the object; `None` = no object.
    pub gap: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
struct TipModel {
    rest: [f64; 8],
    noise: [f64; 8],
    proximity_noise: f64,
    phase: f64,
    heading: f64,
    /// Tangential force of a contact that carries no load, as a share of the normal force.
    crosstalk: f64,
    body: FingertipBody,
}

/// The five fingertip sensors.
#[derive(Debug, Clone)]
pub struct TouchSensors {
    tips: PerFinger<TipModel>,
}

impl TouchSensors {
    /// Creates sensors with random rest counts drawn from `rng`.
    pub fn new(body: &BodyParams, rng: &mut fastrand::Rng) -> Self {
        let mut between = |low: f64, high: f64| low + (high - low) * rng.f64();
        Self {
            tips: PerFinger::from_fn(|finger| TipModel {
                rest: [(); 8].map(|()| between(2_800_000.0, 3_000_000.0)),
                noise: [0.0; 8],
                proximity_noise: 0.0,
                phase: between(0.0, std::f64::consts::TAU),
                heading: between(0.0, 360.0),
                crosstalk: between(0.007, 0.015),
                body: body.fingertips[finger],
            }),
        }
    }

    /// Draws the noise of the next measurement; called every [`SENSOR_MS`].
    pub fn measure(&mut self, rng: &mut fastrand::Rng) {
        let mut around = |width: f64| (2.0 * rng.f64() - 1.0) * width;
        for (_, tip) in self.tips.iter_mut() {
            tip.noise = [(); 8].map(|()| around(CHANNEL_NOISE));
            tip.proximity_noise = around(PROXIMITY_NOISE);
        }
    }

    /// Returns the block of one fingertip at `t_s` seconds.
    pub fn block(&self, finger: Finger, press: Press, t_s: f64) -> TactileBlock {
        let tip = &self.tips[finger];
        let newtons = press.force_g * N_PER_G;
        let touches = newtons > CONTACT_N;
        let normal = if touches { newtons } else { 0.0 };
        let spot = tip.spot(press, t_s);
        let gains = PAD_CENTRES_MM.map(|pad| normal * COUNTS_PER_N * nearness(pad, spot));
        let mut raw = [0; 8];
        let whole = gains.iter().chain([&0.0]);
        for (((raw, rest), noise), gain) in raw.iter_mut().zip(tip.rest).zip(tip.noise).zip(whole) {
            *raw = number::counts(rest + noise + gain).unsigned_abs();
        }
        for ((raw, drift), dead) in raw.iter_mut().zip(tip.body.drift).zip(tip.body.dead) {
            let drifted = i64::from(*raw) + i64::from(number::counts(drift * t_s));
            let shown = u32::try_from(drifted.max(0)).unwrap_or(u32::MAX);
            *raw = if dead { 0 } else { shown };
        }
        let along = tip.tangential(press, t_s);
        let tangential = if touches { along.length() } else { 0.0 };
        let [first_noise, second_noise, ..] = tip.noise;
        TactileBlock {
            raw,
            normal_n: number::single(normal),
            normal_delta: number::counts(gains.iter().sum::<f64>() + first_noise),
            tangential_n: number::single(tangential),
            tangential_delta: number::counts(tangential * COUNTS_PER_N + second_noise),
            direction_raw: if touches {
                TipModel::direction(along)
            } else {
                u16::MAX
            },
            proximity: number::counts(tip.proximity(press)),
            check: 0,
            sum: 0,
            reserved: [0; 2],
        }
    }
}

impl TipModel {
    /// Position of the contact, mm: it drifts slightly, and slides with the object.
    fn spot(&self, press: Press, t_s: f64) -> (f64, f64) {
        let slid = self.turned(press.slid_mm);
        let x = 1.6 * (0.31 * t_s + self.phase).sin() + slid.x;
        let y = 0.5 + 2.0 * (0.23 * t_s + 2.0 * self.phase).cos() + slid.y;
        (x, y)
    }

    /// Tangential force in the sensor's own frame, N.
    fn tangential(&self, press: Press, t_s: f64) -> DVec2 {
        let wander = 6.0_f64.to_radians() * (0.7 * t_s + self.phase).sin();
        let share = self.crosstalk * (1.0 + 0.1 * (1.3 * t_s + self.phase).sin());
        let crosstalk = DVec2::from_angle(wander) * share * press.force_g;
        self.turned(press.tangential_g + crosstalk) * N_PER_G
    }

    /// Turns from the object's frame to the sensor's, which lies differently in each fingertip.
    fn turned(&self, vector: DVec2) -> DVec2 {
        DVec2::from_angle(self.heading.to_radians()).rotate(vector)
    }

    fn direction(along: DVec2) -> u16 {
        let degrees = along.to_angle().to_degrees().rem_euclid(360.0);
        number::word(degrees) % 360
    }

    /// Rises before the contact, because the field extends into the air.
    fn proximity(&self, press: Press) -> f64 {
        let near = press
            .gap
            .map_or(0.0, |gap| (-gap / PROXIMITY_RANGE).exp() * PROXIMITY_NEAR);
        near + press.force_g * 60.0 + self.proximity_noise
    }
}

fn nearness(pad: (f64, f64), spot: (f64, f64)) -> f64 {
    let (dx, dy) = (pad.0 - spot.0, pad.1 - spot.1);
    (-(dx * dx + dy * dy) / (2.0 * SPOT_MM * SPOT_MM)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(force_g: f64, gap: Option<f64>) -> TactileBlock {
        loaded(force_g, gap, DVec2::ZERO)
    }

    fn loaded(force_g: f64, gap: Option<f64>, tangential_g: DVec2) -> TactileBlock {
        let mut rng = fastrand::Rng::with_seed(3);
        let mut touch = TouchSensors::new(&BodyParams::default(), &mut rng);
        touch.measure(&mut rng);
        let press = Press {
            force_g,
            tangential_g,
            slid_mm: DVec2::ZERO,
            gap,
        };
        let block = touch.block(Finger::Index, press, 1.0);
        TactileBlock::decode(&block.encode()).unwrap()
    }

    #[test]
    fn proximity_rises_before_contact_and_forces_come_with_it() {
        let (far, near) = (block(0.0, Some(1200.0)), block(0.0, Some(40.0)));
        assert!(far.proximity.abs() < 400, "{far:?}");
        assert!(near.proximity > 100_000, "{near:?}");
        for free in [far, near, block(0.0, None)] {
            assert_eq!((free.normal_n, free.tangential_n), (0.0, 0.0));
            assert_eq!(free.direction_raw, 65535);
            assert!(free.check_ok());
        }
        let held = block(500.0, Some(0.0));
        assert!((held.normal_n - 4.9).abs() < 0.01);
        assert!(held.tangential_n > 0.0 && held.tangential_n < 0.1);
        assert!(held.direction_deg().is_some() && held.check_ok());
        assert!(held.normal_delta > 100_000);
        assert!(held.raw.iter().zip(far.raw).any(|(a, b)| *a > b + 50_000));
        assert!(
            far.raw
                .iter()
                .all(|raw| (2_799_000..3_001_000).contains(raw))
        );
    }

    #[test]
    fn the_tangential_force_is_the_load_and_turns_with_it() {
        let along = |degrees: f64| {
            let load = DVec2::from_angle(degrees.to_radians()) * 200.0;
            loaded(500.0, Some(0.0), load)
        };
        let (first, turned) = (along(10.0), along(100.0));
        for block in [first, turned] {
            assert!((block.tangential_n - 1.96).abs() < 0.1, "{block:?}");
        }
        let turn = i32::from(turned.direction_raw) - i32::from(first.direction_raw);
        assert!((85..=95).contains(&turn.rem_euclid(360)), "{turn}");
    }
}
