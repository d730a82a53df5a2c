//! Splits a byte stream into lines. A stop is reported before its line feed arrives, and even in a line that is too long. Pure.

use crate::inputs::line::begins_message;
use crate::inputs::scan::{Token, pieces, unmarked};
use crate::inputs::stop::{Completeness, is_stop};

/// Longest line that is buffered as a whole: a stop may be anywhere in it.
pub const LONGEST: usize = 64 * 1024;
/// Up to this length an incomplete line is scanned whenever more of it arrives, and an object may span several lines.
/// For longer lines this would cost too much: a sender that sends them byte by byte must not delay the hand.
const SHORT: usize = 2048;
/// New bytes after which a longer line is scanned again; also the tail of an overlong line in which a split stop is still found.
const KEPT: usize = 256;

/// Output of the cutter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LineEvent {
    /// A line without its line feed, or the beginning of one that exceeds the limit. An object whose first line is `{` alone
    /// is one line, no matter on how many it is written.
    Line {
        text: Vec<u8>,
        /// It was reported as [`Self::Stop`] before.
        has_stopped: bool,
    },
    /// A stop in a line that is incomplete or was too long.
    Stop,
}

/// Splits bytes into lines.
#[derive(Debug)]
pub struct LineCutter {
    longest: usize,
    rest: Vec<u8>,
    has_stopped: bool,
    /// Number of bytes scanned so far.
    scanned: usize,
    /// Skips the rest of a line that was too long.
    skips: bool,
}

impl LineCutter {
    /// Creates a cutter for lines of at most `longest` bytes.
    pub const fn new(longest: usize) -> Self {
        Self {
            longest,
            rest: Vec::new(),
            has_stopped: false,
            scanned: 0,
            skips: false,
        }
    }

    /// Adds bytes and returns the cuts that they complete, in order.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<LineEvent> {
        let mut cuts = Vec::new();
        for piece in bytes.split_inclusive(|byte| *byte == b'\n') {
            let is_whole = piece.ends_with(b"\n");
            if self.rest.ends_with(b"\n") && piece.starts_with(b"{") {
                let cut = self.cut();
                // A brace alone cannot be wrong.
                let is_brace =
                    matches!(&cut, LineEvent::Line { text, .. } if unmarked(text) == b"{");
                cuts.extend((!is_brace).then_some(cut));
            }
            self.rest.extend_from_slice(piece);
            if self.skips {
                // The scan may start in the middle of a string, where quotes mean nothing.
                self.find_stop(Completeness::Whole, &mut cuts);
                let old = self.rest.len().saturating_sub(KEPT);
                self.rest.drain(..old);
                if is_whole {
                    self.skips = false;
                    self.has_stopped = false;
                    self.rest.clear();
                }
            } else if self.rest.len() > self.longest {
                cuts.push(self.cut());
                self.skips = !is_whole;
            } else if is_whole && !self.is_open_object() {
                cuts.push(self.cut());
            }
        }
        let is_short = self.rest.len() <= SHORT;
        let is_due = is_short || self.rest.len() >= self.scanned + KEPT;
        if !self.skips && is_due && begins_message(&self.rest) {
            self.scanned = self.rest.len();
            self.find_stop(Completeness::MayGoOn, &mut cuts);
        }
        cuts
    }

    /// The incomplete line.
    pub(crate) fn unfinished(&self) -> &[u8] {
        if self.skips { &[] } else { &self.rest }
    }

    /// Ends the stream: a stop counts without the end of its line.
    pub fn end(mut self) -> Option<LineEvent> {
        is_stop(self.unfinished(), Completeness::Whole).then(|| self.cut())
    }

    fn find_stop(&mut self, end: Completeness, cuts: &mut Vec<LineEvent>) {
        if !self.has_stopped && is_stop(&self.rest, end) {
            self.has_stopped = true;
            cuts.push(LineEvent::Stop);
        }
    }

    fn cut(&mut self) -> LineEvent {
        let mut text = std::mem::take(&mut self.rest);
        self.scanned = 0;
        if text.ends_with(b"\n") {
            text.pop();
        }
        LineEvent::Line {
            text,
            has_stopped: std::mem::take(&mut self.has_stopped),
        }
    }

    /// True at the beginning of a pretty-printed object: its first line is a brace, and others follow.
    fn is_open_object(&self) -> bool {
        let first = self.rest.split(|byte| *byte == b'\n').next();
        if self.rest.len() > SHORT || first.map(unmarked) != Some(b"{") {
            return false;
        }
        let depth = |depth: usize, token: &Token<'_>| match token {
            Token::Mark(b'{' | b'[') => depth + 1,
            Token::Mark(b'}' | b']') => depth.saturating_sub(1),
            _ => depth,
        };
        pieces(&self.rest).iter().fold(0, depth) > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::stop::tests::odd_stops;

    fn line(text: &str) -> LineEvent {
        LineEvent::Line {
            text: text.into(),
            has_stopped: false,
        }
    }

    fn stopped(text: &str) -> LineEvent {
        LineEvent::Line {
            text: text.into(),
            has_stopped: true,
        }
    }

    fn cuts(text: &str) -> Vec<LineEvent> {
        let mut cutter = LineCutter::new(100);
        let mut cuts = cutter.push(text.as_bytes());
        cuts.extend(cutter.end());
        cuts
    }

    #[test]
    fn lines_are_cut_wherever_their_bytes_come_apart() {
        let text = "{\"a\":1}\n\nno\n{\n \"b\": [\n  1\n ]\n}\n{\"c\":2}\n";
        let expected = [
            line("{\"a\":1}"),
            line(""),
            line("no"),
            line("{\n \"b\": [\n  1\n ]\n}"),
            line("{\"c\":2}"),
        ];
        for at in 0..=text.len() {
            let mut cutter = LineCutter::new(100);
            let (before, behind) = text.split_at(at);
            let mut all = cutter.push(before.as_bytes());
            all.extend(cutter.push(behind.as_bytes()));
            assert_eq!(all, expected, "{at}");
            assert_eq!(cutter.unfinished(), b"");
        }
    }

    #[test]
    fn a_stop_is_told_before_its_line_is_whole() {
        let pretty = "{\n  \"v\": 1,\n  \"stop\": true\n";
        let whole = format!("{pretty}}}");
        let mut cutter = LineCutter::new(100);
        assert_eq!(cutter.push(pretty.as_bytes()), [LineEvent::Stop]);
        assert_eq!(cutter.push(b"}\n"), [stopped(&whole)]);
        assert_eq!(cutter.push(b"{\"stop\":true"), [LineEvent::Stop]);
        assert_eq!(cutter.push(b",\"seq\":1"), []);
        assert_eq!(
            cutter.push(b"}\n{\"seq\":2}\n"),
            [stopped("{\"stop\":true,\"seq\":1}"), line("{\"seq\":2}")]
        );
        // At the end of all a value need not be whole.
        assert_eq!(cuts("stop"), [line("stop")]);
        assert_eq!(cuts("{\"stop\":t"), [line("{\"stop\":t")]);
        assert_eq!(cuts("{\"stop\":f"), []);
    }

    #[test]
    fn an_object_that_is_never_closed_ends_with_the_next_one() {
        let text = "{\n\"seq\": 1,\n{\"seq\":2}\n";
        assert_eq!(cuts(text), [line("{\n\"seq\": 1,"), line("{\"seq\":2}")]);
        assert_eq!(cuts("{\n{\"seq\":2}\n"), [line("{\"seq\":2}")]);
        // A line that ends too early is not waited for.
        assert_eq!(cuts("{\"seq\":1,\n"), [line("{\"seq\":1,")]);
    }

    #[test]
    fn a_line_that_is_too_long_is_told_once_and_may_still_stop() {
        let long = format!("{{\"x\":\"{}", "y".repeat(100));
        let behind = format!("{}\",\"stop\":true}}\n{{\"seq\":1}}\n", "y".repeat(3000));
        let mut cutter = LineCutter::new(100);
        assert_eq!(cutter.push(long.as_bytes()), [line(&long)]);
        let mut all = Vec::new();
        for piece in behind.as_bytes().chunks(7) {
            all.extend(cutter.push(piece));
        }
        assert_eq!(all, [LineEvent::Stop, line("{\"seq\":1}")]);
    }

    #[test]
    fn a_long_line_that_comes_byte_by_byte_is_seldom_looked_through_again() {
        let mut cutter = LineCutter::new(LONGEST);
        let (mut scans, mut scanned) = (0, 0);
        let text = format!("{{\"x\":\"{}", "y".repeat(LONGEST - 1000));
        for byte in text.bytes() {
            assert_eq!(cutter.push(&[byte]), []);
            scans += usize::from(cutter.scanned != scanned);
            scanned = cutter.scanned;
        }
        assert!(scans <= SHORT + LONGEST / KEPT, "{scans}");
        assert_eq!(cutter.push(b"\",\"stop\":true"), []);
        assert_eq!(cutter.push(&[b' '; KEPT]), [LineEvent::Stop]);
        // An object on several lines is not waited for without end.
        let mut cutter = LineCutter::new(LONGEST);
        let cuts = cutter.push(format!("{{{}", "\n".repeat(SHORT + 1)).as_bytes());
        assert_eq!(cuts.len(), 2);
    }

    #[test]
    fn every_odd_stop_is_told_without_the_end_of_its_line() {
        for text in odd_stops() {
            let mut cutter = LineCutter::new(64 * 1024);
            let mut told = cutter.push(&text);
            told.extend(cutter.end());
            let is_told = |cut: &LineEvent| match cut {
                LineEvent::Stop => true,
                LineEvent::Line { text, .. } => is_stop(text, Completeness::Whole),
            };
            let shown = String::from_utf8_lossy(&text).into_owned();
            assert!(told.iter().any(is_told), "{shown}: {told:?}");
        }
    }
}
