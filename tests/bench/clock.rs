//! Stopwatches: wall time, and the time that we had the processor, which other programs do not lengthen.

use std::time::{Duration, Instant};

/// Whose processor time.
#[derive(Clone, Copy)]
enum Whose {
    Thread,
    Process,
}

/// Processor time, where the system tells; wall time elsewhere.
#[cfg(unix)]
fn cpu(whose: Whose) -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let clock = match whose {
        Whose::Thread => ClockId::CLOCK_THREAD_CPUTIME_ID,
        Whose::Process => ClockId::CLOCK_PROCESS_CPUTIME_ID,
    };
    clock_gettime(clock).map_or_else(|_| wall(), Duration::from)
}

#[cfg(not(unix))]
fn cpu(_whose: Whose) -> Duration {
    wall()
}

/// Page faults of this process so far that needed no disk; 0 where the system does not tell.
pub(crate) fn page_faults() -> u64 {
    // The name in parentheses may hold spaces; the count is the eighth field after it (man proc_pid_stat).
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit_once(')').map(|(_, fields)| fields);
    let count = fields.and_then(|fields| fields.split_whitespace().nth(7));
    count.and_then(|count| count.parse().ok()).unwrap_or(0)
}

fn wall() -> Duration {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// Processor milliseconds that `work` takes on this thread, and what it gives.
pub(crate) fn cpu_ms<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begun = cpu(Whose::Thread);
    let result = work();
    (millis(cpu(Whose::Thread).saturating_sub(begun)), result)
}

/// Milliseconds that `work` takes: by the wall, and of the processor in all threads together.
pub(crate) fn wall_and_cpu_ms<T>(work: impl FnOnce() -> T) -> ([f64; 2], T) {
    let (begun, cpu_begun) = (wall(), cpu(Whose::Process));
    let result = work();
    let took = wall().saturating_sub(begun);
    let cpu_took = cpu(Whose::Process).saturating_sub(cpu_begun);
    ([millis(took), millis(cpu_took)], result)
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
