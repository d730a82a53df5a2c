//! Stopwatches: wall time, and the time that this thread had the processor, which other programs do not lengthen.

use std::time::{Duration, Instant};

/// Processor time of the calling thread, where the system tells; wall time elsewhere.
#[cfg(unix)]
fn cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or_else(|_| wall(), Duration::from)
}

#[cfg(not(unix))]
fn cpu() -> Duration {
    wall()
}

fn wall() -> Duration {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// Processor milliseconds that `work` takes on this thread, and what it gives.
pub(crate) fn cpu_ms<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begun = cpu();
    let result = work();
    (millis(cpu().saturating_sub(begun)), result)
}

pub(crate) fn millis(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// Some measurements of one thing, sorted.
pub(crate) struct Sorted(Vec<f64>);

impl Sorted {
    pub(crate) fn new(mut figures: Vec<f64>) -> Self {
        figures.sort_by(f64::total_cmp);
        Self(figures)
    }

    /// The figure below which so many of a hundred lie; NaN of none.
    pub(crate) fn percentile(&self, percent: usize) -> f64 {
        let last = self.0.len().saturating_sub(1);
        self.0
            .get(last * percent / 100)
            .copied()
            .unwrap_or(f64::NAN)
    }

    pub(crate) fn median(&self) -> f64 {
        self.percentile(50)
    }
}
