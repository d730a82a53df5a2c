//! Number formats: fixed width, units, and "-" for unknown values. No colours.

use std::time::Duration;

/// Text of an unknown value.
pub(crate) const UNKNOWN: &str = "-";

/// Converts bytes to gigabytes.
#[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
pub(crate) fn giga(bytes: u64) -> f64 {
    bytes as f64 / 1e9
}

/// Total size of several files, `345.6 MB` or `1.23 GB`.
pub(crate) fn size(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => megabytes(bytes),
        _ => format!("{:.2} GB", giga(bytes)),
    }
}

/// Size of a file, `3.4 MB`.
pub(crate) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", giga(bytes) * 1000.0)
}

/// A whole number, right-aligned in `width`, or "-".
pub(crate) fn whole(value: Option<i64>, width: usize) -> String {
    value.map_or_else(
        || format!("{UNKNOWN:>width$}"),
        |value| format!("{value:>width$}"),
    )
}

/// A whole number with its unit, or "-" with it.
pub(crate) fn with_unit(value: Option<i64>, width: usize, unit: &str) -> String {
    format!("{} {unit}", whole(value, width))
}

/// Degrees with one decimal, or "-".
pub(crate) fn degrees(value: Option<f32>) -> String {
    value.map_or_else(|| format!("{UNKNOWN:>6}"), |value| format!("{value:>5.1}°"))
}

/// Percent of the way from bent (0) to open (1000), or "-".
pub(crate) fn percent(angle: Option<i16>) -> String {
    angle.map_or_else(
        || format!("{UNKNOWN:>6}"),
        |angle| format!("{:>5.1}%", f32::from(angle) / 10.0),
    )
}

/// Newtons as received, including "NaN", "inf" and numbers too long for the column.
pub(crate) fn newtons(value: Option<f32>) -> String {
    match value {
        None => UNKNOWN.into(),
        Some(value) if value.is_nan() => "NaN".into(),
        Some(value) if value.is_infinite() => if value > 0.0 { "+inf" } else { "-inf" }.into(),
        Some(value) if value.abs() >= 1000.0 => format!("{value:.0e}"),
        Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
        Some(value) => format!("{value:.2}"),
    }
}

/// Counts, abbreviated: 1 234, 56.7k, 8.90M.
pub(crate) fn counts(value: Option<i64>) -> String {
    let Some(value) = value else {
        return UNKNOWN.into();
    };
    let size = value.unsigned_abs();
    let sign = if value < 0 { "-" } else { "" };
    match size {
        0..10_000 => format!("{sign}{size}"),
        10_000..1_000_000 => format!("{sign}{}.{}k", size / 1000, size % 1000 / 100),
        _ => format!(
            "{sign}{}.{:02}M",
            size / 1_000_000,
            size % 1_000_000 / 10_000
        ),
    }
}

/// A rate in hertz, or "-" for none.
pub(crate) fn hertz(value: f64) -> String {
    match value {
        1.0..f64::INFINITY => format!("{value:.0} Hz"),
        f64::MIN_POSITIVE..1.0 => "<1 Hz".into(),
        _ => format!("{UNKNOWN} Hz"),
    }
}

/// A round trip in milliseconds.
pub(crate) fn millis(value: Option<Duration>) -> String {
    value.map_or_else(
        || UNKNOWN.into(),
        |value| format!("{:.1}", value.as_secs_f64() * 1000.0),
    )
}

/// An age: 350 ms, 2.4 s, 3 min.
pub(crate) fn age(value: Duration) -> String {
    match value.as_secs() {
        0 => format!("{} ms", value.as_millis()),
        1..60 => format!("{:.1} s", value.as_secs_f64()),
        60..3600 => format!("{} min", value.as_secs() / 60),
        _ => format!("{} h", value.as_secs() / 3600),
    }
}

/// A duration: 45 s, 4 min 20 s, 2 h 5 min.
pub(crate) fn duration(value: Duration) -> String {
    let seconds = value.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// An error's text as a sentence: with a leading capital, unless it begins with the name of a port or an address, and a
/// full stop.
pub(crate) fn sentence(text: &str) -> String {
    let is_word = text
        .split(' ')
        .next()
        .is_some_and(|first| first.chars().all(char::is_alphabetic));
    let mut signs = text.chars();
    let mut out: String = match signs.next() {
        Some(first) if is_word => first.to_uppercase().collect(),
        first => first.into_iter().collect(),
    };
    out.push_str(signs.as_str());
    if !out.ends_with(['.', '!', '?', '。']) {
        out.push('.');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_begins_with_a_capital_but_a_port_keeps_its_name() {
        assert_eq!(sentence("no answer from id 1"), "No answer from id 1.");
        assert_eq!(sentence("can0 is down"), "can0 is down.");
        assert_eq!(
            sentence("localhost:6000 refused."),
            "localhost:6000 refused."
        );
        assert_eq!(sentence(""), ".");
    }

    #[test]
    fn unknown_is_a_dash_and_never_a_zero() {
        assert_eq!(whole(None, 4), "   -");
        assert_eq!(with_unit(None, 4, "g"), "   - g");
        assert_eq!(degrees(None).trim(), "-");
        assert_eq!(newtons(None), "-");
        assert_eq!(counts(None), "-");
        assert_eq!(hertz(0.0), "- Hz");
        assert_eq!((hertz(0.3), hertz(0.5)), ("<1 Hz".into(), "<1 Hz".into()));
        assert_eq!(millis(None), "-");
    }

    #[test]
    fn strange_numbers_are_shown_as_they_are() {
        assert_eq!(newtons(Some(f32::NAN)), "NaN");
        assert_eq!(newtons(Some(f32::NEG_INFINITY)), "-inf");
        assert_eq!(newtons(Some(3.0e38)), "3e38");
        assert_eq!(newtons(Some(-0.5)), "-0.50");
    }

    #[test]
    fn counts_are_shortened_without_changing_their_sign() {
        for (value, text) in [
            (0, "0"),
            (-9_999, "-9999"),
            (12_345, "12.3k"),
            (8_901_234, "8.90M"),
            (-16_000_000, "-16.00M"),
        ] {
            assert_eq!(counts(Some(value)), text);
        }
    }

    #[test]
    fn ages_grow_in_units() {
        for (millis, text) in [(350, "350 ms"), (2400, "2.4 s"), (181_000, "3 min")] {
            assert_eq!(age(Duration::from_millis(millis)), text);
        }
    }
}
