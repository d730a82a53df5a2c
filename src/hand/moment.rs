//! Points in time as plain numbers, so that time is always passed in as an argument. Reads no clock.

use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Microseconds since program start, from a monotonic clock.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
)]
#[serde(transparent)]
pub struct Moment(u64);

impl Moment {
    /// Origin of the program's clock.
    pub const ZERO: Self = Self(0);

    /// Creates a moment from microseconds since the start.
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// Creates a moment from a duration since the start, truncated to microseconds.
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

    /// Returns this moment moved forward by `step`.
    #[must_use]
    pub fn plus(self, step: Duration) -> Self {
        Self(self.0.saturating_add(Self::from_duration(step).0))
    }
}

/// A value with the times of its request and its reply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed<T> {
    /// Decoded value.
    pub value: T,
    /// Time at which the request was sent: the value cannot be older than this.
    pub asked: Moment,
    /// Time at which the whole reply had arrived.
    pub received: Moment,
}

impl<T> Timed<T> {
    /// Age at `now`, counted from the request, so that it is never too small.
    pub const fn age(&self, now: Moment) -> Duration {
        now.since(self.asked)
    }
}
