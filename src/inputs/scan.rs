//! Tokenizer for text that may be JSON or nearly so: finds content that a JSON parser would reject. Pure.

use serde_json::Value;
use std::borrow::Cow;
use std::iter::from_fn;

/// A token of a text that may be JSON.
pub(crate) enum Token<'a> {
    /// A string, a number, a word.
    Text(TextToken<'a>),
    /// One of `{}[]:=,`.
    Mark(u8),
}

pub(crate) struct TextToken<'a> {
    text: &'a [u8],
    is_quoted: bool,
    /// Something follows it.
    pub(crate) is_ended: bool,
}

impl TextToken<'_> {
    /// Lower case, trimmed.
    pub(crate) fn lower(&self) -> String {
        self.plain().trim().to_ascii_lowercase()
    }

    fn value(&self) -> Value {
        let plain = self.plain();
        match serde_json::from_str(&plain) {
            Ok(value) if !self.is_quoted => value,
            _ => Value::String(plain),
        }
    }

    fn plain(&self) -> String {
        let text = String::from_utf8_lossy(self.text);
        let read = serde_json::from_str(&format!("\"{text}\""));
        read.unwrap_or_else(|_odd| text.into_owned())
    }
}

/// Splits a text into tokens.
pub(crate) fn pieces(text: &[u8]) -> Vec<Token<'_>> {
    tokens(unmarked(text)).collect()
}

/// The outermost name whose number is NaN or infinite, which JSON cannot express.
pub(crate) fn not_finite_at(text: &[u8]) -> Option<Option<String>> {
    let all = pieces(text);
    let (mut depth, mut outer) = (0_usize, None);
    for (nth, token) in all.iter().enumerate() {
        match token {
            Token::Mark(b'{' | b'[') => depth += 1,
            Token::Mark(b'}' | b']') => depth = depth.saturating_sub(1),
            Token::Text(name) if depth == 1 && is_name(all.get(nth + 1)) => {
                outer = Some(name.lower());
            }
            Token::Text(word) if !word.is_quoted && is_not_finite(&word.lower()) => {
                return Some(outer);
            }
            _ => {}
        }
    }
    None
}

/// The number or string under a name of the outermost object, as far as it can be read; else `null`.
pub fn value_at(text: &[u8], name: &str) -> Value {
    let all = pieces(text);
    let mut depth = 0_usize;
    for (nth, token) in all.iter().enumerate() {
        match token {
            Token::Mark(b'{' | b'[') => depth += 1,
            Token::Mark(b'}' | b']') => depth = depth.saturating_sub(1),
            Token::Text(own) if depth == 1 && is_name(all.get(nth + 1)) => {
                if own.plain() == name
                    && let Some(Token::Text(value)) = all.get(nth + 2)
                    && value.is_ended
                {
                    return value.value();
                }
            }
            _ => {}
        }
    }
    Value::Null
}

/// Strips leading and trailing extras that some systems add: byte order mark, whitespace, zero bytes.
pub fn unmarked(text: &[u8]) -> &[u8] {
    let is_before =
        |byte: &u8| byte.is_ascii_whitespace() || b"\0\xef\xbb\xbf\xff\xfe".contains(byte);
    let begin = text.iter().position(|byte| !is_before(byte));
    let text = begin
        .and_then(|begin| text.get(begin..))
        .unwrap_or_default();
    let is_after = |byte: &u8| byte.is_ascii_whitespace() || *byte == 0;
    let end = text.iter().rposition(|byte| !is_after(byte));
    end.and_then(|end| text.get(..=end)).unwrap_or_default()
}

/// Removes zero bytes, as UTF-16 text has them in between.
pub(crate) fn without_zeros(text: &[u8]) -> Cow<'_, [u8]> {
    if text.contains(&0) {
        text.iter().copied().filter(|byte| *byte != 0).collect()
    } else {
        text.into()
    }
}

fn is_name(next: Option<&Token<'_>>) -> bool {
    matches!(next, Some(Token::Mark(b':' | b'=')))
}

fn is_not_finite(word: &str) -> bool {
    word.parse().is_ok_and(|number: f64| !number.is_finite())
}

fn tokens(text: &[u8]) -> impl Iterator<Item = Token<'_>> {
    let mut rest = text;
    from_fn(move || {
        rest = rest.trim_ascii_start();
        let (first, behind) = rest.split_first()?;
        match first {
            b'{' | b'}' | b'[' | b']' | b':' | b'=' | b',' => {
                rest = behind;
                Some(Token::Mark(*first))
            }
            b'"' | b'\'' => {
                let len = string_len(behind, *first);
                let (text, after) = behind.split_at(len);
                rest = after.get(1..).unwrap_or_default();
                Some(Token::Text(TextToken {
                    text,
                    is_quoted: true,
                    is_ended: !after.is_empty(),
                }))
            }
            _ => {
                let ends = |byte: &u8| byte.is_ascii_whitespace() || b"{}[]:=,\"'".contains(byte);
                let len = rest.iter().position(ends).unwrap_or(rest.len());
                let (text, after) = rest.split_at(len);
                rest = after;
                Some(Token::Text(TextToken {
                    text,
                    is_quoted: false,
                    is_ended: !after.is_empty(),
                }))
            }
        }
    })
}

/// Length of a string up to its closing quote; a quote after a backslash does not close it.
fn string_len(text: &[u8], quote: u8) -> usize {
    let mut is_escaped = false;
    let end = text.iter().position(|byte| {
        let ends = !is_escaped && *byte == quote;
        is_escaped = !is_escaped && *byte == b'\\';
        ends
    });
    end.unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_number_that_is_not_finite_is_found_with_its_name() {
        for (text, at) in [
            (r#"{"seq":1,"right":[1,NaN]}"#, Some(Some("right"))),
            (
                r#"{"right":[1,1],"grip_mm":-Infinity}"#,
                Some(Some("grip_mm")),
            ),
            (r#"{"x":{"y":1e999}}"#, Some(Some("x"))),
            (r#"{"why":"NaN"}"#, None),
            (r#"{"right":[1,1]}"#, None),
            ("[NaN]", Some(None)),
        ] {
            let found = not_finite_at(text.as_bytes());
            assert_eq!(found.as_ref().map(Option::as_deref), at, "{text}");
        }
    }

    #[test]
    fn a_value_is_found_in_text_that_is_no_json() {
        for (text, value) in [
            (r#"{"id":7,"right":[NaN]}"#, json!(7)),
            (r#"{"right":[NaN],"id":"a\"b"}"#, json!("a\"b")),
            (r#"{"right":{"id":7}}"#, Value::Null),
            (r#"{"id":7"#, Value::Null),
            (r#"{"id":[7]}"#, Value::Null),
        ] {
            assert_eq!(value_at(text.as_bytes(), "id"), value, "{text}");
        }
    }
}
