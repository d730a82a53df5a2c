//! Calendar time: in UTC for files and their names, and in local time for display. Only this module reads the wall clock for
//! them.

use chrono::{DateTime, Local};
use std::time::{Duration, SystemTime};

/// Current time since 1970; zero if the clock is set to an earlier date.
pub fn since_1970() -> Duration {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.unwrap_or_default()
}

/// Formats the UTC date of a time since 1970: `2026-11-21`.
pub fn day(since_1970: Duration) -> String {
    // Days to a date as in Hinnant's "chrono-compatible low-level date algorithms".
    let days = since_1970.as_secs() / 86_400 + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 {
        march_month + 3
    } else {
        march_month - 9
    };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Formats a time since 1970 in UTC: `2026-11-21T09:30:00Z`.
pub fn stamp(since_1970: Duration) -> String {
    let seconds = since_1970.as_secs() % 86_400;
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{}T{hour:02}:{minute:02}:{second:02}Z", day(since_1970))
}

/// Local date and time of a time since 1970: `2026-11-21` and `10:30`.
pub fn local(since_1970: Duration) -> (String, String) {
    let seconds = i64::try_from(since_1970.as_secs()).unwrap_or(i64::MAX);
    let utc = DateTime::from_timestamp(seconds, 0).unwrap_or_default();
    let here = utc.with_timezone(&Local);
    (
        here.format("%Y-%m-%d").to_string(),
        here.format("%H:%M").to_string(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_795_219_199, "2026-11-20"),
            (1_795_219_200, "2026-11-21"),
        ] {
            assert_eq!(day(Duration::from_secs(seconds)), expected);
        }
    }

    #[test]
    fn a_stamp_is_of_the_calendar_and_sorts_as_time_does() {
        let at = |seconds| stamp(Duration::from_secs(seconds));
        assert_eq!(at(1_795_219_199), "2026-11-20T23:59:59Z");
        assert_eq!(at(1_795_219_200), "2026-11-21T00:00:00Z");
        assert!(at(999_999_999) < at(1_000_000_000));
    }
}
