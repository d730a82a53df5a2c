//! Dates and times as they stand in files: of the calendar, in UTC, to the second. Reads no clock.

use crate::app::quirk_sheet::day;
use std::time::Duration;

/// `2026-11-21T09:30:00Z`, for the time since 1970.
#[must_use]
pub fn stamp(since_1970: Duration) -> String {
    let seconds = since_1970.as_secs() % 86_400;
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{}T{hour:02}:{minute:02}:{second:02}Z", day(since_1970))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_of_the_calendar_and_sorts_as_time_does() {
        let at = |seconds| stamp(Duration::from_secs(seconds));
        assert_eq!(at(1_795_219_199), "2026-11-20T23:59:59Z");
        assert_eq!(at(1_795_219_200), "2026-11-21T00:00:00Z");
        assert!(at(999_999_999) < at(1_000_000_000));
    }
}
