//! Visible time range: the newest, or one chosen by the user. Independent of curves and pixels.

/// Minimum range: two measurements of a fast link.
const SHORTEST_S: f64 = 0.02;
/// Maximum range: the whole history.
const LONGEST_S: f64 = 3600.0;
/// Share of the view that always shows a time within the history.
const STAYS: f64 = 0.1;

/// From and to, in seconds.
pub(crate) type TimeSpan = (f64, f64);

/// Visible part of the time between the oldest and the newest measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeWindow {
    held: Option<TimeSpan>,
    /// Time of the oldest measurement and of this frame.
    bounds: TimeSpan,
    /// Seconds shown while the plots follow.
    window_s: f64,
}

impl Default for TimeWindow {
    fn default() -> Self {
        Self {
            held: None,
            bounds: (0.0, 0.0),
            window_s: 10.0,
        }
    }
}

impl TimeWindow {
    /// Sets the bounds for this frame.
    pub(crate) const fn advance(&mut self, bounds: TimeSpan, window_s: f64) {
        self.bounds = bounds;
        self.window_s = window_s;
    }

    /// Visible time range.
    pub(crate) fn span(&self) -> TimeSpan {
        let newest = self.bounds.1;
        self.held.unwrap_or((newest - self.window_s, newest))
    }

    /// True while the newest values are not followed.
    pub(crate) const fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Freezes the range.
    pub(crate) fn hold(&mut self) {
        self.held = Some(self.span());
    }

    /// Toggles between holding and following.
    pub(crate) fn toggle(&mut self) {
        if self.is_held() {
            self.follow();
        } else {
            self.hold();
        }
    }

    /// Follows the newest values again.
    pub(crate) const fn follow(&mut self) {
        self.held = None;
    }

    /// Shows exactly this range, even beyond the measurements.
    pub(crate) const fn pin(&mut self, span: TimeSpan) {
        self.held = Some(span);
    }

    /// Shows this range, limited to the measurements.
    pub(crate) fn show(&mut self, (from, to): TimeSpan) {
        let width = (to - from).clamp(SHORTEST_S, LONGEST_S);
        let (first, newest) = self.bounds;
        let earliest = (first + width * STAYS).min(newest);
        let to = (from + width).clamp(earliest, newest);
        self.held = Some((to - width, to));
    }

    /// Centres the range on a moment, with unchanged width.
    pub(crate) fn center(&mut self, at_s: f64) {
        let (from, to) = self.span();
        let half = (to - from) / 2.0;
        self.show((at_s - half, at_s + half));
    }

    /// Sets the width in seconds, with an unchanged end.
    pub(crate) fn resize(&mut self, width_s: f64) {
        if let Some((_, to)) = self.held {
            self.show((to - width_s, to));
        }
    }

    /// Scales the range by `factor`, with `at_s` at an unchanged position.
    pub(crate) fn zoom(&mut self, at_s: f64, factor: f64) {
        let (from, to) = self.span();
        let width = (to - from).max(SHORTEST_S);
        let factor = factor.clamp(SHORTEST_S / width, LONGEST_S / width);
        self.show((at_s - (at_s - from) * factor, at_s + (to - at_s) * factor));
    }

    /// Shifts the range by this many seconds.
    pub(crate) fn pan(&mut self, by_s: f64) {
        let (from, to) = self.span();
        self.show((from + by_s, to + by_s));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time() -> TimeWindow {
        let mut time = TimeWindow::default();
        time.advance((100.0, 1000.0), 10.0);
        time
    }

    fn width_s(time: TimeWindow) -> f64 {
        time.span().1 - time.span().0
    }

    fn same(one: TimeSpan, two: TimeSpan) {
        let apart = (one.0 - two.0).abs().max((one.1 - two.1).abs());
        assert!(apart < 1e-6, "{one:?} {two:?}");
    }

    #[test]
    fn it_follows_until_it_is_held_and_then_stays() {
        let mut time = time();
        same(time.span(), (990.0, 1000.0));
        time.advance((100.0, 1001.0), 10.0);
        same(time.span(), (991.0, 1001.0));
        time.hold();
        time.advance((100.0, 2000.0), 10.0);
        same(time.span(), (991.0, 1001.0));
        time.follow();
        same(time.span(), (1990.0, 2000.0));
    }

    #[test]
    fn zooming_keeps_what_is_under_the_pointer() {
        let mut time = time();
        time.show((400.0, 500.0));
        time.zoom(425.0, 0.5);
        same(time.span(), (412.5, 462.5));
        time.zoom(425.0, 2.0);
        same(time.span(), (400.0, 500.0));
    }

    #[test]
    fn nothing_leads_beyond_now_or_before_what_is_held() {
        let mut time = time();
        time.pan(50.0);
        same(time.span(), (990.0, 1000.0));
        time.pan(-1e9);
        same(time.span(), (91.0, 101.0));
        time.zoom(95.0, 1e9);
        assert!((width_s(time) - LONGEST_S).abs() < 1e-6);
        time.zoom(95.0, 1e-12);
        assert!((width_s(time) - SHORTEST_S).abs() < 1e-6);
    }

    #[test]
    fn a_moment_is_shown_in_the_middle_where_there_is_room() {
        let mut time = time();
        time.center(500.0);
        same(time.span(), (495.0, 505.0));
        time.center(999.0);
        same(time.span(), (990.0, 1000.0));
    }

    #[test]
    fn another_window_ends_where_the_held_one_ended() {
        let mut time = time();
        time.show((400.0, 500.0));
        time.resize(30.0);
        same(time.span(), (470.0, 500.0));
        time.follow();
        time.resize(60.0);
        assert!(!time.is_held());
    }
}
