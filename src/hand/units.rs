//! Values that may be sent to the hand, as types that cannot leave the manual's ranges. Contains no measured values.

use crate::hand::dof::Dof;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A number outside the manual's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{got} is outside the manual's range for {what}: {min} to {max}")]
pub struct OutOfRange {
    /// Register family, as in the manual.
    pub what: &'static str,
    /// Value that was rejected.
    pub got: i64,
    /// Smallest allowed.
    pub min: i64,
    /// Largest allowed.
    pub max: i64,
}

macro_rules! bounded {
    ($(#[$doc:meta])* $name:ident($inner:ty), $what:literal, $min:literal ..= $max:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(try_from = "i64", into = "i64")]
        pub struct $name($inner);

        impl $name {
            /// Smallest value.
            pub const MIN: Self = Self($min);
            /// Largest value.
            pub const MAX: Self = Self($max);

            /// Checks the manual's range.
            ///
            /// # Errors
            /// [`OutOfRange`] with the value and the range.
            pub fn new(value: impl Into<i64>) -> Result<Self, OutOfRange> {
                let got = value.into();
                let out = OutOfRange { what: $what, got, min: $min, max: $max };
                match <$inner>::try_from(got) {
                    Ok(value) if ($min..=$max).contains(&value) => Ok(Self(value)),
                    _ => Err(out),
                }
            }

            /// Nearest value in range, for a slider or a ramp that may run past its end.
            pub fn nearest(value: impl Into<i64>) -> Self {
                let value = value.into().clamp($min, $max);
                Self::new(value).unwrap_or(Self::MIN)
            }

            /// Number as in the register.
            pub const fn get(self) -> $inner {
                self.0
            }
        }

        impl TryFrom<i64> for $name {
            type Error = OutOfRange;
            fn try_from(value: i64) -> Result<Self, OutOfRange> {
                Self::new(value)
            }
        }

        impl From<$name> for i64 {
            fn from(value: $name) -> i64 {
                value.0.into()
            }
        }
    };
}

bounded!(
    /// A target angle: 0 = bent (fist), 1000 = open (manual 2.6.11). It has no default: zero closes the hand.
    Angle(i16), "ANGLE_SET", 0..=1000
);
bounded!(
    /// A force threshold in grams (manual 2.6.12). It stops the drive; it does not regulate force.
    Force(i16), "FORCE_SET", 0..=3000
);
bounded!(
    /// A speed without unit; 1000 runs the full stroke in 600 ms without load (manual 2.6.13).
    Speed(i16), "SPEED_SET", 0..=1000
);
bounded!(
    /// The hand's id on its bus (manual 2.6.1).
    HandId(u8), "HAND_ID", 1..=254
);
bounded!(
    /// A gesture number: 1 to 13 fixed, 14 to 40 the user's (manual 2.6.7).
    Gesture(u8), "GESTURE_NO_SET", 1..=40
);

bounded!(
    /// A gesture number whose pose the user stores (manual 2.6.7).
    UserGesture(u8), "USER_DEF_ANGLE", 14..=40
);

impl Gesture {
    /// All forty gestures, in order (manual 2.6.7).
    pub fn all() -> impl Iterator<Item = Self> {
        (Self::MIN.0..=Self::MAX.0).map(Self)
    }
}

impl HandId {
    /// All ids, in ascending order.
    pub fn all() -> impl Iterator<Item = Self> {
        (Self::MIN.0..=Self::MAX.0).map(Self)
    }
}

impl Angle {
    /// Distance from the target, in counts, within which a joint has arrived.
    pub const ARRIVED_TOLERANCE: u16 = 20;

    /// True if a joint at this position has arrived at this target.
    pub const fn is_reached_at(self, position: i16) -> bool {
        position.abs_diff(self.0) <= Self::ARRIVED_TOLERANCE
    }

    /// Angle of this joint in degrees, by the linear map of [`Dof::degrees`].
    pub fn degrees(self, dof: Dof) -> f32 {
        let (low, high) = dof.degrees();
        low + (high - low) * f32::from(self.0) / 1000.0
    }
}

impl Force {
    /// The rated grip of a finger, 20 N (manual 1.2), in grams; more needs the user's consent.
    pub const RATED: Self = Self(2000);
    /// Default for the user: gentle.
    pub const GENTLE: Self = Self(500);
}

impl Speed {
    /// Default for the user: slow enough for the force threshold to be effective.
    pub const GENTLE: Self = Self(200);
    /// Lowest speed at which overshoot was measured ([`crate::hand::impact`]): a few grams.
    pub const SLOWEST_MEASURED: Self = Self(25);
    /// Counts of ANGLE_ACT per second for each unit of speed without load: half of the measured 3.04 of POS_ACT (manual 2.6.13
    /// says 1.67).
    pub const ANGLE_PER_UNIT: f64 = 1.52;

    /// Counts of ANGLE_ACT per second without load; speed 0 counts as 1.
    pub fn angle_per_s(self) -> f64 {
        Self::ANGLE_PER_UNIT * f64::from(self.0.max(1))
    }

    /// Duration of the full stroke without load.
    pub fn stroke(self) -> Duration {
        Duration::from_secs_f64(f64::from(Angle::MAX.0) / self.angle_per_s())
    }
}

/// Converts to `f64` with the shortest decimal representation, so that 0.2 stays 0.2.
pub fn decimal(number: f32) -> f64 {
    let digits = number.to_string().parse();
    digits.unwrap_or_else(|_never| f64::from(number))
}

/// Target of a joint. There is no default; leaving the joint alone is explicit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Target {
    /// Move to this angle at once.
    Go(Angle),
    /// No action (the manual's -1, §2.6.11).
    Leave,
}

impl Target {
    /// Decodes a number of ANGLE_SET; `None` outside -1..=1000.
    pub fn from_raw(raw: i16) -> Option<Self> {
        match raw {
            -1 => Some(Self::Leave),
            raw => Angle::new(raw).ok().map(Self::Go),
        }
    }

    /// Number as in ANGLE_SET.
    pub const fn raw(self) -> i16 {
        match self {
            Self::Go(angle) => angle.get(),
            Self::Leave => -1,
        }
    }

    /// Target angle; `None` if the joint is left alone.
    pub const fn angle(self) -> Option<Angle> {
        match self {
            Self::Go(angle) => Some(angle),
            Self::Leave => None,
        }
    }
}

/// Serial speeds by code (manual 2.6.2, RS485).
///
/// Manual: the range is printed as 0 to 4, but only 0 to 3 are explained; 4 cannot be expressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SerialSpeed {
    /// Code 0, the default.
    Baud115200,
    /// Code 1.
    Baud57600,
    /// Code 2.
    Baud19200,
    /// Code 3.
    Baud921600,
}

impl SerialSpeed {
    /// All four, by code.
    pub const ALL: [Self; 4] = [
        Self::Baud115200,
        Self::Baud57600,
        Self::Baud19200,
        Self::Baud921600,
    ];

    /// Code as in REDU_RATIO.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// Speed with this code in REDU_RATIO; `None` if it is not one of the four.
    pub fn of_code(code: i64) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|own| i64::from(own.code()) == code)
    }

    /// Bits per second.
    pub const fn baud(self) -> u32 {
        match self {
            Self::Baud115200 => 115_200,
            Self::Baud57600 => 57_600,
            Self::Baud19200 => 19_200,
            Self::Baud921600 => 921_600,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_domain<T: Copy + Into<i64>>(
        make: fn(i64) -> Result<T, OutOfRange>,
        near: fn(i64) -> T,
        range: std::ops::RangeInclusive<i64>,
    ) {
        let extremes = [i64::MIN, i64::MAX];
        for value in (i64::from(i16::MIN)..=i64::from(u16::MAX)).chain(extremes) {
            match make(value) {
                Ok(made) => assert!(range.contains(&value) && made.into() == value),
                Err(error) => assert!(!range.contains(&value) && error.got == value),
            }
            assert!(range.contains(&near(value).into()));
        }
    }

    #[test]
    fn nothing_outside_the_manuals_ranges_can_be_built() {
        check_domain(Angle::new, Angle::nearest, 0..=1000);
        check_domain(Force::new, Force::nearest, 0..=3000);
        check_domain(Speed::new, Speed::nearest, 0..=1000);
        check_domain(HandId::new, HandId::nearest, 1..=254);
        check_domain(Gesture::new, Gesture::nearest, 1..=40);
        check_domain(UserGesture::new, UserGesture::nearest, 14..=40);
    }

    #[test]
    fn degrees_run_over_the_documented_range() {
        assert!((Angle::MIN.degrees(Dof::Little) - 20.0).abs() < 1e-3);
        assert!((Angle::MAX.degrees(Dof::Little) - 176.0).abs() < 1e-3);
        assert!((Angle::MIN.degrees(Dof::ThumbBend) + 13.0).abs() < 1e-3);
        assert!((Angle::MAX.degrees(Dof::ThumbRotate) - 165.0).abs() < 1e-3);
    }
}
