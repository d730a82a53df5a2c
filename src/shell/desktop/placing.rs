//! Size of the window when it opens: maximised as before, and never larger than its screen. Window managers ignore or lose requests
//! of a window that they do not show yet, so each is repeated until it was obeyed. Opens no window.

use crate::hand::Moment;
use egui::{Vec2, ViewportInfo};
use std::time::Duration;

/// Interval at which a request is repeated.
pub(crate) const REQUEST_INTERVAL: Duration = Duration::from_millis(500);
/// Maximum number of requests: a window manager that obeys none of them does not obey at all.
const REQUESTS_MAX: u8 = 6;

/// Restores the maximised state of the last run.
#[derive(Debug)]
pub(crate) struct Maximizing {
    /// Number of requests left.
    left: u8,
    requested: Option<Moment>,
    /// True once the first frame was drawn: the window is not on the screen before, and a request is lost.
    is_shown: bool,
}

impl Maximizing {
    /// Restores the state if the window was maximised.
    pub(crate) const fn new(was_maximized: bool) -> Self {
        Self {
            left: if was_maximized { REQUESTS_MAX } else { 0 },
            requested: None,
            is_shown: false,
        }
    }

    /// True until the window is maximised again or every request was ignored: its state is not the user's wish meanwhile.
    pub(crate) const fn is_pending(&self) -> bool {
        self.left > 0
    }

    /// True if a request is due in this frame.
    pub(crate) fn is_due(&mut self, view: &ViewportInfo, now: Moment) -> bool {
        if view.maximized == Some(true) {
            self.left = 0;
        }
        let was_shown = std::mem::replace(&mut self.is_shown, true);
        let waits = |at| now.since(at) < REQUEST_INTERVAL;
        if self.left == 0 || !was_shown || self.requested.is_some_and(waits) {
            return false;
        }
        self.requested = Some(now);
        self.left -= 1;
        true
    }
}

/// Shrinks a window that exceeds its screen.
#[derive(Debug, Default)]
pub(crate) struct Fitting {
    requests: u8,
    requested: Option<Moment>,
}

impl Fitting {
    /// Inner size to request now. Once the window fitted after a request, its size is the user's.
    pub(crate) fn size(&mut self, view: &ViewportInfo, now: Moment) -> Option<Vec2> {
        let waits = |at| now.since(at) < REQUEST_INTERVAL;
        if self.requests >= REQUESTS_MAX || self.requested.is_some_and(waits) {
            return None;
        }
        let (inner, outer, screen) = (view.inner_rect?, view.outer_rect?, view.monitor_size?);
        let size = fitting(inner.size(), outer.size(), screen);
        match size {
            Some(_) => {
                self.requests += 1;
                self.requested = Some(now);
            }
            None if self.requests > 0 => self.requests = REQUESTS_MAX,
            None => {}
        }
        size
    }
}

/// Inner size at which the window fits on the screen with its frame; `None` if it already fits.
fn fitting(inner: Vec2, outer: Vec2, screen: Vec2) -> Option<Vec2> {
    let over = (outer - screen).max(Vec2::ZERO);
    (over != Vec2::ZERO).then(|| inner - over)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Pos2, Rect, vec2};

    fn at(millis: u64) -> Moment {
        Moment::from_micros(millis * 1000)
    }

    #[test]
    fn a_window_that_is_larger_than_its_screen_is_made_to_fit_with_its_frame() {
        let (screen, first) = (vec2(1440.0, 900.0), vec2(1440.0, 900.0));
        assert_eq!(fitting(first, first, screen), None, "no frame");
        let framed = first + vec2(2.0, 37.0);
        assert_eq!(fitting(first, framed, screen), Some(vec2(1438.0, 863.0)));
        let small = vec2(1366.0, 768.0);
        assert_eq!(fitting(first, framed, small), Some(vec2(1364.0, 731.0)));
        let large = vec2(2560.0, 1440.0);
        assert_eq!(fitting(first, framed, large), None);
    }

    #[test]
    fn a_request_to_fit_that_was_lost_is_repeated_until_the_window_fits_and_no_longer() {
        let screen = vec2(1366.0, 768.0);
        let view = |inner: Vec2| ViewportInfo {
            inner_rect: Some(Rect::from_min_size(Pos2::new(1.0, 20.0), inner)),
            outer_rect: Some(Rect::from_min_size(Pos2::ZERO, inner + vec2(2.0, 20.0))),
            monitor_size: Some(screen),
            ..ViewportInfo::default()
        };
        let fits = screen - vec2(2.0, 20.0);
        let mut all = Fitting::default();
        assert_eq!(all.size(&ViewportInfo::default(), at(0)), None, "unknown");
        assert_eq!(all.size(&view(screen), at(20)), Some(fits));
        assert_eq!(all.size(&view(screen), at(40)), None, "it takes a moment");
        assert_eq!(all.size(&view(screen), at(600)), Some(fits), "it was lost");
        assert_eq!(all.size(&view(fits), at(1200)), None);
        let wide = all.size(&view(screen), at(9000));
        assert_eq!(wide, None, "the user makes it larger");
    }

    #[test]
    fn a_maximised_window_is_maximised_again_and_not_forgotten_before() {
        let view = |maximized| ViewportInfo {
            maximized: Some(maximized),
            ..ViewportInfo::default()
        };
        let mut none = Maximizing::new(false);
        assert!(!none.is_pending() && !none.is_due(&view(false), at(0)));
        let mut all = Maximizing::new(true);
        assert!(!all.is_due(&view(false), at(0)), "not on the screen yet");
        assert!(all.is_due(&view(false), at(20)));
        assert!(!all.is_due(&view(false), at(40)), "it takes a moment");
        assert!(all.is_pending(), "not obeyed yet");
        assert!(!all.is_due(&view(true), at(700)) && !all.is_pending());
        assert!(!all.is_due(&view(false), at(9000)), "the user changed it");
        let mut ignored = Maximizing::new(true);
        let due = (0..100).filter(|step| ignored.is_due(&view(false), at(step * 500)));
        assert_eq!(due.count(), usize::from(REQUESTS_MAX));
        assert!(!ignored.is_pending(), "what the user does next is kept");
    }
}
