//! Points in time as plain numbers, so that everything above can be given one. Reads no clock.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Microseconds since the program's own start, from a clock that never goes back.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct Moment(u64);

impl Moment {
    /// The start of the program's clock.
    pub const ZERO: Self = Self(0);

    /// From microseconds since the start.
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// From a duration since the start, cut to microseconds.
    pub fn from_duration(since_start: Duration) -> Self {
        Self(u64::try_from(since_start.as_micros()).unwrap_or(u64::MAX))
    }

    /// Microseconds since the start.
    pub const fn micros(self) -> u64 {
        self.0
    }

    /// Seconds since the start, for axes and files.
    pub fn secs(self) -> f64 {
        self.since(Self::ZERO).as_secs_f64()
    }

    /// Time passed since `earlier`; zero if `earlier` is in fact later.
    pub const fn since(self, earlier: Self) -> Duration {
        Duration::from_micros(self.0.saturating_sub(earlier.0))
    }

    /// This moment moved on by `step`.
    #[must_use]
    pub fn plus(self, step: Duration) -> Self {
        Self(self.0.saturating_add(Self::from_duration(step).0))
    }
}

/// A value with the moments its request left and its reply arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed<T> {
    /// The value as it was decoded.
    pub value: T,
    /// When the request left: the value cannot be older than this.
    pub asked: Moment,
    /// When the whole reply was there.
    pub received: Moment,
}

impl<T> Timed<T> {
    /// Age at `now`, counted from the request, so that it is never too small.
    pub const fn age(&self, now: Moment) -> Duration {
        now.since(self.asked)
    }
}
