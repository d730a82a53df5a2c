//! Measured values as the hand reports them: raw numbers together with the manual's range.

use crate::hand::dof::Dof;
use crate::hand::feedback::fault::Faults;
use crate::hand::feedback::status::Status;
use crate::hand::units::{Angle, Force, Speed, Target};

/// One joint's value in a register.
pub(crate) trait JointValue: Copy {
    /// Bytes per joint in the register.
    const BYTES: usize = 2;

    /// Decodes the number that the hand sent.
    fn decode(raw: i16) -> Self;

    /// Returns the number that the hand sent; `None` if it was not stored.
    fn sent(self) -> Option<i16>;

    /// True if the value is outside the manual's range.
    fn is_out_of_range(self) -> bool;
}

macro_rules! reading {
    ($(#[$doc:meta])* $name:ident($inner:ty), $min:literal ..= $max:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name($inner);

        impl $name {
            /// The documented range.
            pub const RANGE: std::ops::RangeInclusive<$inner> = $min..=$max;

            /// Wraps the number that the hand sent.
            pub const fn new(raw: $inner) -> Self {
                Self(raw)
            }

            /// Returns the number that the hand sent, even if it is out of range.
            pub const fn raw(self) -> $inner {
                self.0
            }

            /// Returns the number if it is in the documented range. Only this may feed logic.
            pub fn documented(self) -> Option<$inner> {
                Self::RANGE.contains(&self.0).then_some(self.0)
            }
        }

        impl JointValue for $name {
            const BYTES: usize = size_of::<$inner>();

            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a register of bytes gives 0 to 255"
            )]
            fn decode(raw: i16) -> Self {
                Self(raw as $inner)
            }

            fn sent(self) -> Option<i16> {
                Some(self.0.into())
            }

            fn is_out_of_range(self) -> bool {
                self.documented().is_none()
            }
        }
    };
}

/// A set value, stored only if it is in range.
macro_rules! set_value {
    ($name:ty, $decode:expr, $raw:expr) => {
        impl JointValue for Option<$name> {
            fn decode(raw: i16) -> Self {
                $decode(raw)
            }

            fn sent(self) -> Option<i16> {
                self.map($raw)
            }

            fn is_out_of_range(self) -> bool {
                self.is_none()
            }
        }
    };
}

set_value!(Target, Target::from_raw, Target::raw);
set_value!(Force, |raw| Force::new(raw).ok(), Force::get);
set_value!(Speed, |raw| Speed::new(raw).ok(), Speed::get);

/// A byte without invalid values.
macro_rules! byte {
    ($name:ty) => {
        impl JointValue for $name {
            const BYTES: usize = 1;

            fn decode(raw: i16) -> Self {
                Self::from_raw(raw.to_le_bytes()[0])
            }

            fn sent(self) -> Option<i16> {
                Some(self.raw().into())
            }

            fn is_out_of_range(self) -> bool {
                false
            }
        }
    };
}

byte!(Faults);
byte!(Status);

reading!(
    /// ANGLE_ACT: 0 = bent, 1000 = open (manual 2.6.15).
    AngleReading(i16), 0..=1000
);
reading!(
    /// POS_ACT: 0 = open, 2000 = bent (manual 2.6.14). Real hands exceed the range slightly.
    PositionReading(i16), 0..=2000
);
reading!(
    /// FORCE_ACT in grams (manual 2.6.16).
    ForceReading(i16), -4000..=4000
);
reading!(
    /// CURRENT in milliamperes (manual 2.6.17).
    CurrentReading(i16), 0..=2000
);
reading!(
    /// TEMP in degrees Celsius (manual 2.6.20). 255 means that the hand does not know the temperature.
    TemperatureReading(u8), 0..=100
);

impl AngleReading {
    /// Distance outside 0..=1000 that a real hand may report at its end stop.
    const END_STOP_SLACK: i16 = 50;

    /// Target that keeps the joint where it is; `None` if the reading is implausible.
    pub fn hold(self) -> Option<Angle> {
        (-Self::END_STOP_SLACK..=1000 + Self::END_STOP_SLACK)
            .contains(&self.0)
            .then(|| Angle::nearest(self.0))
    }

    /// Angle of this joint in degrees; `None` if the reading is out of range.
    pub fn degrees(self, dof: Dof) -> Option<f32> {
        let angle = Angle::new(self.documented()?).ok()?;
        Some(angle.degrees(dof))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_is_kept_raw_but_not_documented() {
        for raw in i16::MIN..=i16::MAX {
            let reading = AngleReading::new(raw);
            assert_eq!(reading.raw(), raw);
            assert_eq!(reading.documented().is_some(), (0..=1000).contains(&raw));
            if let Some(hold) = reading.hold() {
                assert!((i32::from(hold.get()) - i32::from(raw)).abs() <= 50);
            }
        }
        assert_eq!(TemperatureReading::new(255).documented(), None);
        assert_eq!(ForceReading::new(-33).documented(), Some(-33));
    }
}
