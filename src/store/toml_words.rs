//! Translates messages of the TOML parser into plain words.

use crate::store::file_error::{FileCause, ValueKind};

/// Returns the named key, if any, and the cause.
pub(super) fn plain(message: &str) -> (Option<String>, FileCause) {
    let message = message.trim().replace('\n', " ");
    if let Some(key) = message.strip_prefix("missing field ") {
        return (names(key).next(), FileCause::Missing);
    }
    if let Some((key, known)) = named(&message, "unknown field ") {
        return (Some(key), FileCause::Unknown { known });
    }
    if let Some((got, known)) = named(&message, "unknown variant ") {
        return (None, FileCause::Choice { got, known });
    }
    (
        None,
        kind(&message)
            .or_else(|| range(&message))
            .unwrap_or(FileCause::Malformed(message)),
    )
}

/// Returns the invalid word and the known ones.
fn named(message: &str, start: &str) -> Option<(String, String)> {
    let mut names = names(message.strip_prefix(start)?);
    let got = names.next()?;
    Some((got, names.collect::<Vec<_>>().join(", ")))
}

/// Words in backticks.
fn names(message: &str) -> impl Iterator<Item = String> {
    message.split('`').skip(1).step_by(2).map(str::to_owned)
}

fn kind(message: &str) -> Option<FileCause> {
    let (got, wanted) = message
        .strip_prefix("invalid ")?
        .split_once(", expected ")?;
    let (_, got) = got.split_once(": ")?;
    let wanted = match wanted {
        "a boolean" => ValueKind::Truth,
        "a string" | "string" => ValueKind::Text,
        "a sequence" => ValueKind::List,
        "a map" | "a table" => ValueKind::Table,
        "f32" | "f64" => ValueKind::Number,
        _ if wanted.starts_with("struct ") => ValueKind::Table,
        _ if wanted.starts_with(['i', 'u']) => ValueKind::Whole,
        _ => return None,
    };
    let got = match got.split_once(' ') {
        Some((_, text)) if text.starts_with('"') => text.to_owned(),
        _ => names(got).next().unwrap_or_else(|| match got {
            "sequence" => "a list".into(),
            "map" => "a table".into(),
            other => other.to_owned(),
        }),
    };
    Some(FileCause::Kind { got, wanted })
}

fn range(message: &str) -> Option<FileCause> {
    let (got, range) = message.split_once(" is outside ")?;
    let numbers = range
        .rsplit_once(": ")
        .map_or(range, |(_, numbers)| numbers);
    Some(FileCause::Range {
        got: got.into(),
        range: numbers.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_the_reader_are_said_plainly() {
        for (message, key, words) in [
            ("missing field `x`", Some("x"), "it is missing: add it"),
            (
                "unknown field `retry`, expected one of `grip`, `retries`",
                Some("retry"),
                "unknown key, known here: grip, retries; correct it, or remove it",
            ),
            (
                "unknown variant `open`, expected `holding`",
                None,
                "\"open\" is unknown here, known: holding",
            ),
            (
                "invalid type: string \"a, b\", expected i16",
                None,
                "\"a, b\" is not a whole number that is allowed here",
            ),
            (
                "invalid value: integer `70000`, expected i16",
                None,
                "70000 is not a whole number that is allowed here",
            ),
            (
                "invalid type: floating point `1.5`, expected a boolean",
                None,
                "1.5 is not true or false",
            ),
            (
                "invalid type: map, expected a sequence",
                None,
                "a table is not a list in [brackets]",
            ),
            (
                "invalid type: integer `3`, expected struct UntilRow",
                None,
                "3 is not a table of keys and values",
            ),
            ("21 is outside 0 to 20", None, "21 is outside 0 to 20"),
            (
                "1001 is outside the manual's range for ANGLE_SET: 0 to 1000",
                None,
                "1001 is outside 0 to 1000",
            ),
            ("\"é\" is no key", None, "\"é\" is no key"),
        ] {
            let (named, cause) = plain(message);
            assert_eq!((named.as_deref(), cause.to_string().as_str()), (key, words));
        }
    }
}
