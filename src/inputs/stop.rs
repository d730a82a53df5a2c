//! Detects a stop in a text message, however the rest of the message is written. The scan needs no valid JSON and no known version:
//! a stop is obeyed first, and errors in its message are reported afterwards. Pure.
//!
//! A message is a stop if a name `stop`, at any depth, has a value other than `false`, `0`, `null` and their like, if a name `do`
//! has the value `stop`, or if the word `stop` is all there is. Upper case, single quotes, missing quotes, zero bytes, text
//! before or after it and a truncated text change nothing. In a text that is not JSON quotes are ignored:
//! a surplus one would hide a stop. A name `stop` within a string counts there, too.

use crate::inputs::scan::{Token, pieces, unmarked, without_zeros};
use serde::de::IgnoredAny;

/// Values of `stop` that request none. Zero numbers request none either.
const NO: [&str; 8] = ["false", "null", "none", "nil", "undefined", "no", "off", ""];

/// A request that ends a motion, the strongest last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum EndWord {
    /// The sender gives up control of the hand.
    Disarm,
    /// The same, and the hand stops unless another sender moves it.
    Release,
    /// The hand stops, no matter which sender moves it.
    Stop,
}

/// Completeness of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completeness {
    /// The text is complete.
    Whole,
    /// More text may follow, so a value at the end may be incomplete.
    MayGoOn,
}

/// True if a message requests a stop.
pub(crate) fn is_stop(text: &[u8], end: Completeness) -> bool {
    end_word(text, end) == Some(EndWord::Stop)
}

/// Returns the strongest request of a message that ends a motion.
pub fn end_word(text: &[u8], end: Completeness) -> Option<EndWord> {
    let text = without_zeros(text);
    let found = word_in(&text, end);
    // A surplus quote makes a name part of a string. Complete JSON has none.
    if end == Completeness::MayGoOn || serde_json::from_slice::<IgnoredAny>(unmarked(&text)).is_ok()
    {
        return found;
    }
    found.max(word_in(&unquoted(&text), end))
}

/// Returns the text without quotes and backslashes.
fn unquoted(text: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    text.replace(['"', '\'', '\\', '\u{201c}', '\u{201d}'], " ")
        .into_bytes()
}

fn word_in(text: &[u8], end: Completeness) -> Option<EndWord> {
    let all = pieces(text);
    if let [Token::Text(only)] = all.as_slice() {
        return (end == Completeness::Whole && only.lower() == "stop").then_some(EndWord::Stop);
    }
    let mut found = None;
    // Truncated after its name.
    if end == Completeness::Whole
        && let [.., Token::Mark(b'{' | b','), Token::Text(name)] = all.as_slice()
        && name.is_ended
        && name.lower() == "stop"
    {
        found = Some(EndWord::Stop);
    }
    for (nth, token) in all.iter().enumerate() {
        let (Token::Text(name), Some(Token::Mark(b':' | b'='))) = (token, all.get(nth + 1)) else {
            continue;
        };
        let value = all.get(nth + 2);
        let word = match name.lower().as_str() {
            "stop" => is_yes(value, end).then_some(EndWord::Stop),
            "do" => value.and_then(|value| order(value, end)),
            _ => None,
        };
        found = found.max(word);
    }
    found
}

/// True if a message releases the dead-man, whatever else is wrong with it.
pub fn lets_go(text: &[u8]) -> bool {
    let text = without_zeros(text);
    let all = pieces(&text);
    all.windows(3).any(|three| match three {
        [
            Token::Text(name),
            Token::Mark(b':' | b'='),
            Token::Text(value),
        ] if name.lower() == "held" => {
            let value_is = value.lower();
            // A complete word at the truncation counts, too; a truncated number does not.
            is_no(&value_is) && (value.is_ended || value_is == "false")
        }
        _ => false,
    })
}

/// True if the value of `stop` requests one. A missing value does.
fn is_yes(value: Option<&Token<'_>>, end: Completeness) -> bool {
    match (value, end) {
        (None, end) => end == Completeness::Whole,
        (Some(Token::Mark(_)), _) => true,
        (Some(Token::Text(text)), Completeness::MayGoOn) if !text.is_ended => {
            text.lower() == "true"
        }
        (Some(Token::Text(text)), _) => {
            let word = text.lower();
            let is_begun = !text.is_ended && !word.is_empty();
            let begins_no = ["false", "null"].iter().any(|no| no.starts_with(&word));
            !(is_no(&word) || is_begun && begins_no)
        }
    }
}

fn is_no(word: &str) -> bool {
    let is_zero = word.parse().is_ok_and(|number: f64| number == 0.0);
    is_zero || NO.contains(&word)
}

fn order(value: &Token<'_>, end: Completeness) -> Option<EndWord> {
    let Token::Text(text) = value else {
        return None;
    };
    if end == Completeness::MayGoOn && !text.is_ended {
        return None;
    }
    match text.lower().as_str() {
        "stop" => Some(EndWord::Stop),
        "release" => Some(EndWord::Release),
        "disarm" => Some(EndWord::Disarm),
        _ => None,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    include!("../../tests/odd_stops.rs");

    #[test]
    fn a_stop_is_recognised_whatever_is_odd_about_it() {
        for text in odd_stops() {
            let shown = String::from_utf8_lossy(&text).into_owned();
            assert!(is_stop(&text, Completeness::Whole), "{shown}");
        }
    }

    #[test]
    fn what_asks_for_no_stop_is_none() {
        for text in [
            "",
            "{",
            "stopped",
            "do not stop",
            r#"{"stop":false}"#,
            r#"{"stop":False,"right":[1,1,1,1,1,1]}"#,
            r#"{"stop":0}"#,
            r#"{"stop":-0.0}"#,
            r#"{"stop":null}"#,
            r#"{"stop":"false"}"#,
            r#"{"stop":""}"#,
            r#"{"stop":None}"#,
            r#"{"stop":fal"#,
            r#"{"stop":"off"}"#,
            r#"{"stopped":true}"#,
            r#"{"nonstop":true}"#,
            r#"{"why":"stop"}"#,
            r#"{"why":"say \"stop\":true to end"}"#,
            r#"{"keys":["stop","go"]}"#,
            r#"{"do":"move","angle":[0,0,0,0,0,0]}"#,
            r#"{"do":"stopping"}"#,
            "POST / HTTP/1.1",
        ] {
            assert!(!is_stop(text.as_bytes(), Completeness::Whole), "{text}");
        }
    }

    #[test]
    fn text_that_may_go_on_is_a_stop_only_once_its_value_is_there() {
        for (text, is) in [
            (r#"{"stop":true"#, true),
            (r#"{"stop":true}"#, true),
            (r#"{"stop":1,"#, true),
            (r#"{"stop":"#, false),
            (r#"{"stop":t"#, false),
            (r#"{"stop":1"#, false),
            (r#"{"stop":0"#, false),
            (r#"{"stop":"tr"#, false),
            (r#"{"do":"stop"#, false),
            (r#"{"do":"stop""#, true),
            (r#"{"do":"stop"}"#, true),
            ("stop", false),
        ] {
            assert_eq!(
                is_stop(text.as_bytes(), Completeness::MayGoOn),
                is,
                "{text}"
            );
        }
    }

    #[test]
    fn the_strongest_word_counts_and_a_dead_man_is_let_go_by_no_alone() {
        for (text, word) in [
            (r#"{"do":"release","t":NaN}"#, Some(EndWord::Release)),
            (r#"{"do":"Disarm","v":1}"#, Some(EndWord::Disarm)),
            (r#"{"do":"disarm","do":"release"}"#, Some(EndWord::Release)),
            (r#"{"do":"release","stop":true}"#, Some(EndWord::Stop)),
            (r#"{"do":"move","do":"stop"}"#, Some(EndWord::Stop)),
            (r#"{"do":"arm"}"#, None),
        ] {
            assert_eq!(
                end_word(text.as_bytes(), Completeness::Whole),
                word,
                "{text}"
            );
        }
        for (text, lets) in [
            (r#"{"held":false}"#, true),
            (r#"{"held":false,"right":[NaN]}"#, true),
            (r#"{"held":0,"v":2}"#, true),
            (r#"{"held":true}"#, false),
            (r#"{"held":"#, false),
            (r#"{"held":fals"#, false),
            (r#"{"v":1,"held":false"#, true),
            (r#"{"held":0"#, false),
            (r#"{"right":[1]}"#, false),
        ] {
            assert_eq!(lets_go(text.as_bytes()), lets, "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_scanned(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            for end in [Completeness::Whole, Completeness::MayGoOn] {
                let _any = (end_word(&bytes, end), lets_go(&bytes));
            }
        }

        #[test]
        fn whatever_stands_around_a_stop_it_is_one(before in "[^\"'\\\\]{0,40}", after in ".{0,80}") {
            let text = format!("{{{before}\"stop\":true,{after}");
            prop_assert!(is_stop(text.as_bytes(), Completeness::Whole), "{}", text);
        }
    }
}
