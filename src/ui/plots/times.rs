//! Times of the charts: grid and labels.

use crate::ui::plots::scales;
use egui_plot::GridMark;
use std::ops::RangeInclusive;

/// Format of times.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Times {
    /// Clock time.
    Clock,
    /// Seconds from a moment, which has a label of its own.
    From(f64, &'static str),
}

/// Grid lines one step apart, one of them at `zero`.
pub(crate) fn marks((from, to): (f64, f64), zero: f64, step: f64) -> Vec<GridMark> {
    let first = ((from - zero) / step).ceil();
    // No valid step gives more; the limit guards against an invalid one.
    let marks = (0..64_u8).map(|n| GridMark {
        value: zero + (first + f64::from(n)) * step,
        step_size: step,
    });
    marks
        .take_while(|mark| mark.value <= to + step * 1e-6)
        .collect()
}

impl Times {
    /// Moment from which times are counted.
    pub(crate) const fn zero_s(self) -> f64 {
        match self {
            Self::Clock => 0.0,
            Self::From(at_s, _) => at_s,
        }
    }

    /// Label below a grid line.
    pub(crate) fn label(self, mark: GridMark, seen: &RangeInclusive<f64>) -> String {
        // At the left edge it would overlap the numbers of the values.
        let is_left = mark.value - seen.start() < (seen.end() - seen.start()) * 0.04;
        match self {
            _ if is_left => String::new(),
            Self::From(at_s, word) if (mark.value - at_s).abs() < mark.step_size * 1e-3 => {
                word.into()
            }
            _ => self.text(mark.value, mark.step_size),
        }
    }

    /// Formats a time, precise enough for steps of `step_s`.
    pub(crate) fn text(self, at_s: f64, step_s: f64) -> String {
        let digits = scales::digits(step_s);
        match self {
            Self::Clock => clock(at_s, step_s),
            Self::From(zero_s, _) if step_s >= 60.0 => {
                format!("{:+.0} min", (at_s - zero_s) / 60.0)
            }
            Self::From(zero_s, _) => format!("{:+.digits$} s", at_s - zero_s),
        }
    }
}

/// Formats a duration as in the choice of windows: `10 s`, `2.5 s`, `5 min`.
pub(crate) fn length(seconds: f64) -> String {
    let minutes = seconds / 60.0;
    match minutes >= 1.0 && (minutes - minutes.round()).abs() < 1e-3 {
        true => format!("{minutes:.0} min"),
        false => format!("{} s", (seconds * 100.0).round() / 100.0),
    }
}

/// Formats a program time as clock time, precise enough for steps of `step_s`.
pub(crate) fn clock(at_s: f64, step_s: f64) -> String {
    let digits = scales::digits(step_s);
    let unit = [1.0, 10.0, 100.0, 1000.0]
        .get(digits)
        .copied()
        .unwrap_or(1.0);
    // Rounded as a whole, so that 59.999 does not become 0:60.
    let at_s = (at_s.max(0.0) * unit).round() / unit;
    let (hours, minutes) = ((at_s / 3600.0).floor(), (at_s / 60.0).floor() % 60.0);
    let seconds = at_s % 60.0;
    let width = if digits == 0 { 2 } else { digits + 3 };
    if hours > 0.0 {
        format!("{hours:.0}:{minutes:02.0}:{seconds:0width$.digits$}")
    } else {
        format!("{minutes:.0}:{seconds:0width$.digits$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_is_as_fine_as_it_needs_to_be() {
        for (at_s, step_s, text) in [
            (5.25, 0.05, "0:05.25"),
            (59.999, 0.01, "1:00.00"),
            (3_725.0, 60.0, "1:02:05"),
            (65.1234, 0.005, "1:05.123"),
            (-1.0, 1.0, "0:00"),
        ] {
            assert_eq!(clock(at_s, step_s), text);
        }
    }

    #[test]
    fn a_length_has_the_digits_it_needs() {
        let lengths = [10.0, 2.504, 60.0, 90.0, 3600.0].map(length);
        assert_eq!(lengths, ["10 s", "2.5 s", "1 min", "90 s", "60 min"]);
    }

    #[test]
    fn times_are_told_from_their_zero_and_not_at_the_left_edge() {
        let times = Times::From(100.0, "now");
        let label = |value, step_size| times.label(GridMark { value, step_size }, &(90.0..=100.0));
        assert_eq!(label(100.0, 2.0), "now");
        assert_eq!(label(98.0, 2.0), "-2 s");
        assert_eq!(label(90.1, 2.0), "");
        assert_eq!(times.text(-500.0, 60.0), "-10 min");
        assert_eq!(times.text(100.25, 0.05), "+0.25 s");
    }
}
