//! Frames as lines: English text, JSON, CSV, for the terminal and for files. Their formats are a contract, documented
//! in `assets/manual/json.md`.

use crate::link::traffic::frame::{Frame, FrameFormat, Kind};
use crate::link::traffic::values;
use serde::Serialize;
use std::fmt::Write as _;

/// The first line of a CSV file.
pub const CSV_HEAD: &str =
    "number,time_s,direction,kind,id,address,length,meaning,wrong,took_ms,hex";

impl Kind {
    /// Stable lower-case name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Opened => "opened",
            Self::Closed => "closed",
            Self::Broken => "broken",
            Self::Gap => "gap",
            Self::Read => "read",
            Self::ReadReply => "read_reply",
            Self::Write => "write",
            Self::WriteReply => "write_reply",
            Self::Refusal => "refusal",
            Self::SaveResult => "save_result",
            Self::Adapter => "adapter",
            Self::AdapterReply => "adapter_reply",
            Self::Noise => "noise",
        }
    }
}

/// One frame as JSON.
#[derive(Serialize)]
struct FrameJson<'a> {
    number: u64,
    time_s: f64,
    direction: &'static str,
    kind: &'static str,
    id: Option<u16>,
    address: Option<u16>,
    length: Option<u16>,
    meaning: String,
    wrong: Option<String>,
    took_ms: Option<f64>,
    hex: &'a str,
}

impl Frame {
    /// Register names, with their numbers if it carries any. Text of an adapter is unchanged.
    pub fn meaning(&self) -> String {
        if self.form == FrameFormat::Slcan
            && matches!(self.kind, Kind::Adapter | Kind::AdapterReply)
        {
            let text = String::from_utf8_lossy(&self.bytes);
            return text.escape_debug().to_string();
        }
        let Some(span) = self.span else {
            return String::new();
        };
        let held = values::held(span, &self.memory);
        if held.is_empty() {
            return values::names(span);
        }
        let mut text = String::new();
        for one in held {
            let gap = if text.is_empty() { "" } else { "  " };
            // Writing to a string cannot fail.
            let _written = write!(text, "{gap}{} {}", one.name(), one.numbers);
        }
        text
    }

    /// One line of text for the user.
    pub fn text_line(&self) -> String {
        let id = self.hand.map(|id| format!("id {id}")).unwrap_or_default();
        let mut line = format!(
            "{:>12.6} {} {:<13} {id:<6} {}",
            self.at.secs(),
            self.direction.arrow(),
            self.kind.name(),
            self.meaning()
        );
        line.truncate(line.trim_end().len());
        if let Some(wrong) = self.wrong {
            let _written = write!(line, "  !! {wrong}");
        }
        if !self.bytes.is_empty() {
            let _written = write!(line, "  [{}]", self.hex());
        }
        line
    }

    /// One JSON object.
    pub fn json_line(&self) -> String {
        let hex = self.hex();
        let line = FrameJson {
            number: self.number,
            time_s: self.at.secs(),
            direction: self.direction.name(),
            kind: self.kind.name(),
            id: self.hand,
            address: self.span.map(|span| span.address),
            length: self.span.map(|span| span.len),
            meaning: self.meaning(),
            wrong: self.wrong.map(|wrong| wrong.to_string()),
            took_ms: self.took.map(|took| took.as_secs_f64() * 1000.0),
            hex: &hex,
        };
        // Numbers and strings only: it always serializes.
        serde_json::to_string(&line).unwrap_or_default()
    }

    /// One line of CSV, below [`CSV_HEAD`].
    pub fn csv_line(&self) -> String {
        let number = |value: Option<u16>| value.map(|n| n.to_string()).unwrap_or_default();
        let took = self
            .took
            .map(|took| format!("{:.3}", took.as_secs_f64() * 1000.0));
        let wrong = self.wrong.map(|wrong| wrong.to_string());
        [
            self.number.to_string(),
            format!("{:.6}", self.at.secs()),
            self.direction.name().into(),
            self.kind.name().into(),
            number(self.hand),
            number(self.span.map(|span| span.address)),
            number(self.span.map(|span| span.len)),
            quoted(&self.meaning()),
            quoted(&wrong.unwrap_or_default()),
            took.unwrap_or_default(),
            self.hex(),
        ]
        .join(",")
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}
