//! Waits with a resolution below a millisecond, for the timing of a serial line. The runtime's own timers are up to two
//! milliseconds late.

use tokio::time::{Instant, sleep_until};

/// Waits for one moment after another: on Linux through a system timer; elsewhere, and if the runtime's clock is a
/// test's, through the runtime.
#[derive(Debug, Default)]
pub struct Timer {
    #[cfg(target_os = "linux")]
    exact: Exact,
}

impl Timer {
    /// Waits until this moment; returns at once if it has passed.
    pub async fn until(&mut self, at: Instant) {
        #[cfg(target_os = "linux")]
        self.exact.until(at).await;
        // Never before the moment by the runtime's clock.
        if Instant::now() < at {
            sleep_until(at).await;
        }
    }
}

#[cfg(target_os = "linux")]
#[derive(Debug, Default)]
enum Exact {
    /// Not created yet.
    #[default]
    Unknown,
    Ready(tokio::io::unix::AsyncFd<Fd>),
    /// The runtime's clock is paused, or the system provides no timer.
    Absent,
}

#[cfg(target_os = "linux")]
#[derive(Debug)]
struct Fd(nix::sys::timerfd::TimerFd);

#[cfg(target_os = "linux")]
impl std::os::fd::AsRawFd for Fd {
    fn as_raw_fd(&self) -> std::os::fd::RawFd {
        use std::os::fd::AsFd as _;
        self.0.as_fd().as_raw_fd()
    }
}

#[cfg(target_os = "linux")]
impl Exact {
    async fn until(&mut self, at: Instant) {
        use nix::sys::timerfd::{Expiration, TimerSetTimeFlags};
        if matches!(self, Self::Unknown) {
            *self = Self::make();
        }
        let Self::Ready(timer) = self else { return };
        let left = at.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return;
        }
        let once = Expiration::OneShot(left.into());
        if timer
            .get_ref()
            .0
            .set(once, TimerSetTimeFlags::empty())
            .is_err()
        {
            return;
        }
        // A cancelled wait may have left a stale readiness, which does not count for this one.
        while Instant::now() < at
            && let Ok(mut ready) = timer.readable().await
        {
            ready.clear_ready();
        }
    }

    fn make() -> Self {
        use nix::sys::timerfd::{ClockId, TimerFd, TimerFlags};
        if is_clock_paused() {
            return Self::Absent;
        }
        let flags = TimerFlags::TFD_NONBLOCK | TimerFlags::TFD_CLOEXEC;
        let Ok(timer) = TimerFd::new(ClockId::CLOCK_MONOTONIC, flags) else {
            return Self::Absent;
        };
        #[expect(
            deprecated,
            reason = "its successor is unsafe, for types whose descriptor may change; that of a timer does not"
        )]
        let ready = tokio::io::unix::AsyncFd::new(Fd(timer));
        ready.map_or(Self::Absent, Self::Ready)
    }
}

/// True if the runtime's clock does not advance by itself, as in tests that pause it.
#[cfg(target_os = "linux")]
fn is_clock_paused() -> bool {
    let (real, runtime) = (std::time::Instant::now(), Instant::now());
    while real.elapsed().as_micros() < 1 {
        std::hint::spin_loop();
    }
    Instant::now() == runtime
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[tokio::test]
    async fn a_moment_is_never_missed_to_the_early_side() {
        let mut timer = Timer::default();
        for micros in [0, 1, 300, 1750, 2500, 700] {
            let at = Instant::now() + Duration::from_micros(micros);
            timer.until(at).await;
            assert!(Instant::now() >= at, "{micros}");
        }
        timer.until(Instant::now() - Duration::from_millis(1)).await;
    }

    #[tokio::test(start_paused = true)]
    async fn a_paused_clock_is_waited_for_as_well() {
        let mut timer = Timer::default();
        let at = Instant::now() + Duration::from_secs(3600);
        timer.until(at).await;
        assert!(Instant::now() >= at);
    }
}
