//! Numbers in which hands of the family differ: joints, fingertips and supply. A file of
//! them ([`file`]) is a body; [`random`] draws bodies between the two hands with published measurements. Moves nothing.
//!
//! The stiffness of an object is the object's; the body only multiplies it. Code that searches for settings must not read a body.

pub mod file;
pub mod random;
pub mod run_on;

use crate::hand::{PerDof, PerFinger};

/// Position when fully bent, counts.
pub const STROKE: f64 = 2000.0;
/// Position counts per second for each unit of SPEED_SET.
// Manual: 2.6.13 says 600 ms for the full stroke at 1000; 3.04 was measured on a sister hand.
pub const COUNTS_PER_SPEED: f64 = STROKE / 0.6 / 1000.0;
/// Delay between a command and the motion, ms (measured: 64 +- 8); the measured overshoot belongs to this latency.
pub const LATENCY_MS: f64 = 64.0;

/// One number of a body, as in the file.
#[derive(Debug, Clone, Copy)]
pub struct BodyKey<T> {
    /// Key in the file.
    pub name: &'static str,
    /// Description with unit.
    pub about: &'static str,
    /// Smallest allowed value.
    pub least: f64,
    /// Largest allowed value.
    pub most: f64,
    /// Reads the field.
    pub get: fn(&T) -> f64,
    /// Returns a mutable reference to the field.
    pub place: fn(&mut T) -> &mut f64,
}

/// Declares each number once: key, default, range and description.
macro_rules! numbers {
    ($(#[$doc:meta])* $Type:ident, $keys:ident { $($about:literal $field:ident = $default:expr, $least:literal..$most:literal;)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $Type {
            $(#[doc = $about] pub $field: f64,)+
        }

        impl Default for $Type {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl $Type {
            /// The keys of its numbers, in file order.
            pub const KEYS: &'static [BodyKey<Self>] = $keys;
        }

        const $keys: &[BodyKey<$Type>] = &[
            $(BodyKey {
                name: stringify!($field),
                about: $about,
                least: $least,
                most: $most,
                get: |own| own.$field,
                place: |own| &mut own.$field,
            },)+
        ];
    };
}

numbers! {
    /// One joint. Lengths are counts of POS_ACT, 0 open to 2000 bent.
    JointBody, JOINT_KEYS {
        "times the stiffness of the object" stiffness_factor = 1.0, 0.05..20.0;
        "counts, how much later than the object's place the contact begins" contact_offset = 0.0, -200.0..200.0;
        "counts, standard deviation of where the contact begins, drawn again at each close" contact_scatter = 0.0, 0.0..100.0;
        "ms from a command to the motion; the way past a force threshold grows in proportion" latency_ms = LATENCY_MS, 0.0..500.0;
        "ms, standard deviation of the latency" latency_scatter_ms = 0.0, 0.0..100.0;
        "way past a force threshold: 0 as the first published hand, 1 as the second, or between" run_on = 0.0, 0.0..1.0;
        "share of the force past its threshold that a grip keeps once it relaxed" kept_overshoot = 0.05, 0.0..1.0;
        "g either way, noise of the force sensor" force_noise_g = 3.0, 0.0..200.0;
        "g, added to the zero of the force sensor, which is drawn between -8 and 4" force_zero_g = 0.0, -1000.0..1000.0;
        "mA, friction: current that closing without load takes" friction_ma = 120.0, 0.0..1500.0;
        "mA, the same for opening" opening_friction_ma = 120.0, 0.0..1500.0;
        "mA more for each unit of speed" friction_ma_per_speed = 0.0, 0.0..1.5;
        "counts of backlash when the drive changes direction" backlash = 0.0, 0.0..100.0;
        "counts a second for each unit of SPEED_SET" counts_per_speed = COUNTS_PER_SPEED, 0.3..10.0;
        "degrees C a second for each A squared" heating = 0.44, 0.0..20.0;
        "s, time constant of cooling" cooling_s = 60.0, 1.0..3600.0;
        "degrees C, added to a room of 25 to 30" warmer_by_c = 0.0, -30.0..50.0;
    }
}

numbers! {
    /// The 24 V supply.
    SupplyBody, SUPPLY_KEYS {
        "share of its speed that each joint loses when all six move at once; fewer joints lose less" sag = 0.0, 0.0..0.9;
    }
}

/// Channels of a fingertip.
pub const CHANNELS: usize = 8;
/// Largest drift of a channel, counts per second.
pub const DRIFT_MAX: f64 = 1_000_000.0;

/// One fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FingertipBody {
    /// Channels that always read 0.
    pub dead: [bool; CHANNELS],
    /// Drift of each channel, counts per second.
    pub drift: [f64; CHANNELS],
}

/// A whole body. The default equals the simulated hand of versions without bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyParams {
    pub supply: SupplyBody,
    pub joints: PerDof<JointBody>,
    pub fingertips: PerFinger<FingertipBody>,
}

impl Default for BodyParams {
    fn default() -> Self {
        Self {
            supply: SupplyBody::default(),
            joints: PerDof::splat(JointBody::default()),
            fingertips: PerFinger::splat(FingertipBody::default()),
        }
    }
}
