//! Text by others as it may be shown in a line: nothing in it controls a terminal, ends the line or turns it round.

use std::borrow::Cow;
use std::fmt::Write as _;

/// True for a character that only shows itself. A tab is one; a line end, an escape and what reverses the line are not.
pub fn is_printable(letter: char) -> bool {
    let reorders = matches!(
        letter,
        '\u{61c}' | '\u{200e}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    letter == '\t' || !letter.is_control() && !reorders
}

/// The text with everything else escaped as Rust does: `\n`, `\u{1b}`, `\u{202e}`.
pub fn line(text: &str) -> Cow<'_, str> {
    escaped(text, |out, letter| out.extend(letter.escape_default()))
}

/// JSON with everything else escaped as JSON does. What it says stays the same.
pub fn json(text: &str) -> Cow<'_, str> {
    escaped(text, |out, letter| {
        for unit in letter.encode_utf16(&mut [0; 2]) {
            // Writing to a string does not fail.
            let _written = write!(out, "\\u{unit:04x}");
        }
    })
}

fn escaped(text: &str, escape: impl Fn(&mut String, char)) -> Cow<'_, str> {
    if text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if is_printable(letter) {
            out.push(letter);
        } else {
            escape(&mut out, letter);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_controls_a_terminal_or_reverses_the_line_is_escaped_and_nothing_else() {
        for (text, shown) in [
            (
                "plain: 21 °C, 手, \u{1f590}\tend",
                "plain: 21 °C, 手, \u{1f590}\tend",
            ),
            ("\u{1b}]0;owned\u{7}", "\\u{1b}]0;owned\\u{7}"),
            (
                "\u{1b}[2J\r\nhandscope: all is well",
                "\\u{1b}[2J\\r\\nhandscope: all is well",
            ),
            (
                "a\u{202e}b\u{2066}c\u{9b}2Jd\u{7f}",
                "a\\u{202e}b\\u{2066}c\\u{9b}2Jd\\u{7f}",
            ),
        ] {
            assert_eq!(line(text), shown);
        }
    }

    #[test]
    fn escaped_json_says_the_same() {
        let value = serde_json::json!({"topic": "a\u{1b}[2J\u{202e}b\u{9b}\u{7f}"});
        let text = value.to_string();
        let shown = json(&text);
        assert!(shown.chars().all(is_printable), "{shown}");
        assert_eq!(
            serde_json::from_str::<serde_json::Value>(&shown).unwrap(),
            value
        );
    }
}
