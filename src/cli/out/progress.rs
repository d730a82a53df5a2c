//! Progress of a long command, on a terminal.

use crate::cli::out::messages::show;
use std::cell::Cell;
use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

/// Shorter operations report no progress.
const QUIET_DURATION: Duration = Duration::from_secs(2);
/// Minimum interval between two reports.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Reports the progress of a command in one line of standard error that is erased at the end; silent if that is not a
/// terminal.
#[derive(Debug)]
pub(crate) struct ProgressLine {
    began: Instant,
    reported: Cell<Option<Instant>>,
    is_read: bool,
}

impl ProgressLine {
    pub(crate) fn new() -> Self {
        Self {
            began: Instant::now(),
            reported: Cell::new(None),
            is_read: io::stderr().is_terminal(),
        }
    }

    /// Reports the completed share, 0 to 1.
    pub(crate) fn report(&self, share: f64) {
        let now = Instant::now();
        let is_due = self
            .reported
            .get()
            .is_none_or(|at| now - at >= REPORT_INTERVAL);
        if !self.is_read || !is_due {
            return;
        }
        if let Some(words) = words(share, now - self.began) {
            self.reported.set(Some(now));
            show(&format!("\r\x1b[K{words}"));
        }
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        if self.reported.get().is_some() {
            show("\r\x1b[K");
        }
    }
}

/// Text after this time; `None` if it is too early.
fn words(share: f64, since: Duration) -> Option<String> {
    if since < QUIET_DURATION {
        return None;
    }
    let percent = 100.0 * share;
    if share < 0.01 {
        return Some(format!("{percent:.0} %"));
    }
    let left_s = since.as_secs_f64() * (1.0 - share) / share;
    let (minutes, seconds) = ((left_s / 60.0).floor(), left_s % 60.0);
    Some(if minutes < 1.0 {
        format!("{percent:.0} %, {seconds:.0} s left")
    } else {
        format!("{percent:.0} %, {minutes:.0} min {seconds:.0} s left")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_over_two_seconds_tells_how_far_it_is_and_how_long_it_takes() {
        for (share, since_s, wanted) in [
            (0.5, 1.9, None),
            (0.0, 2.0, Some("0 %")),
            (0.25, 5.0, Some("25 %, 15 s left")),
            (0.1, 30.0, Some("10 %, 4 min 30 s left")),
            (1.0, 60.0, Some("100 %, 0 s left")),
        ] {
            let text = words(share, Duration::from_secs_f64(since_s));
            assert_eq!(text.as_deref(), wanted, "{share} after {since_s} s");
        }
    }
}
