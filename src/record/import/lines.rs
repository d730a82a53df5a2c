//! Reads text tables line by line, in bounded memory: cells separated by commas, semicolons or tabs, quoted cells, which may
//! contain line breaks, and a line count for errors. The crate `csv` reads the same, but without a limit on the line length.

use std::io::{self, BufRead, Read as _};

/// Maximum bytes of one line with all its quoted line breaks: more than the longest note.
pub(crate) const LINE_MAX: usize = 1024 * 1024;
/// Maximum number of cells of one line.
pub(crate) const CELLS_MAX: usize = 4096;

/// Reason why the cells of a line cannot be separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CsvLineFault {
    #[error("it is longer than {} KiB", LINE_MAX / 1024)]
    TooLong,
    #[error("it has more than {CELLS_MAX} cells")]
    TooManyCells,
    /// Not UTF-8.
    #[error("it is not UTF-8 text")]
    NotText,
    /// The file ends within quotation marks, or text follows them.
    #[error("unmatched quote")]
    Unquoted,
}

/// Reason why there is no line: the system's error, or an invalid line.
#[derive(Debug)]
pub(crate) enum LineError {
    System(io::Error),
    Fault(CsvLineFault),
}

impl From<io::Error> for LineError {
    fn from(error: io::Error) -> Self {
        Self::System(error)
    }
}

/// Possible cell separators, the most likely first.
const SEPARATORS: [char; 3] = [',', ';', '\t'];
/// Prefix of a line before the header, in which spreadsheets name the separator.
const NAMED: &str = "sep=";

/// The lines of a file.
#[derive(Debug)]
pub(crate) struct CsvLines<R> {
    from: R,
    /// Cell separator, once the first line was read.
    separator: Option<char>,
    /// Number of the current line, and of the one after it.
    number: u64,
    next: u64,
    bytes: Vec<u8>,
}

impl<R: BufRead> CsvLines<R> {
    pub(crate) const fn new(from: R) -> Self {
        Self {
            from,
            separator: None,
            number: 0,
            next: 1,
            bytes: Vec::new(),
        }
    }

    /// Line number from 1, as in editors.
    pub(crate) const fn number(&self) -> u64 {
        self.number
    }

    /// True if the comma is not the separator, and may be a decimal comma.
    pub(crate) fn has_free_comma(&self) -> bool {
        self.separator.is_some_and(|separator| separator != ',')
    }

    /// Reads the cells of the next line that is not empty; `None` at the end.
    pub(crate) fn next(&mut self, cells: &mut Vec<String>) -> Result<Option<()>, LineError> {
        loop {
            self.number = self.next;
            if !self.read()? {
                return Ok(None);
            }
            if self.bytes.is_empty() {
                continue;
            }
            let text = std::str::from_utf8(&self.bytes);
            let text = text.map_err(|_utf8| LineError::Fault(CsvLineFault::NotText))?;
            // Spreadsheets mark UTF-8 with a byte order mark.
            let text = text.strip_prefix('\u{feff}').unwrap_or(text);
            let separator = match self.separator {
                Some(separator) => separator,
                None => {
                    let named = text
                        .strip_prefix(NAMED)
                        .and_then(|rest| rest.chars().next());
                    self.separator = named.or_else(|| Some(separator(text)));
                    if named.is_some() {
                        continue;
                    }
                    separator(text)
                }
            };
            split(text, separator, cells).map_err(LineError::Fault)?;
            return Ok(Some(()));
        }
    }

    /// Reads up to a line break outside quotation marks; false at the end.
    fn read(&mut self) -> Result<bool, LineError> {
        self.bytes.clear();
        let mut is_quoted = false;
        loop {
            let begin = self.bytes.len();
            let room = u64::try_from(LINE_MAX + 1 - begin).unwrap_or_default();
            let mut from = self.from.by_ref().take(room);
            let read = from.read_until(b'\n', &mut self.bytes)?;
            if self.bytes.len() > LINE_MAX {
                return Err(LineError::Fault(CsvLineFault::TooLong));
            }
            let new = self.bytes.get(begin..).unwrap_or_default();
            let marks = new.iter().filter(|byte| **byte == b'"').count();
            is_quoted ^= marks % 2 == 1;
            let is_broken = new.last() == Some(&b'\n');
            self.next += u64::from(is_broken);
            if is_quoted && read == 0 {
                return Err(LineError::Fault(CsvLineFault::Unquoted));
            }
            if !is_quoted {
                if is_broken {
                    self.bytes.pop();
                }
                if self.bytes.last() == Some(&b'\r') {
                    self.bytes.pop();
                }
                return Ok(read > 0);
            }
        }
    }
}

/// Guesses the separator of a header line: the one that occurs most often.
fn separator(line: &str) -> char {
    let count = |separator: &char| line.matches(*separator).count();
    // On a tie `max_by_key` returns the last.
    let found = SEPARATORS.into_iter().rev().max_by_key(count);
    found.unwrap_or(',')
}

fn split(line: &str, separator: char, cells: &mut Vec<String>) -> Result<(), CsvLineFault> {
    cells.clear();
    let mut rest = line;
    loop {
        if cells.len() >= CELLS_MAX {
            return Err(CsvLineFault::TooManyCells);
        }
        let (cell, after) = match rest.strip_prefix('"') {
            Some(quoted) => unquoted(quoted)?,
            None => {
                let end = rest.find(separator).unwrap_or(rest.len());
                let (cell, after) = rest.split_at(end);
                if cell.contains('"') {
                    return Err(CsvLineFault::Unquoted);
                }
                (cell.to_owned(), after)
            }
        };
        cells.push(cell);
        match after.strip_prefix(separator) {
            Some(next) => rest = next,
            None if after.is_empty() => return Ok(()),
            None => return Err(CsvLineFault::Unquoted),
        }
    }
}

/// The text up to the closing quote, and the rest. Two quotes encode one.
fn unquoted(mut rest: &str) -> Result<(String, &str), CsvLineFault> {
    let mut text = String::new();
    while let Some((part, after)) = rest.split_once('"') {
        text.push_str(part);
        match after.strip_prefix('"') {
            Some(more) => {
                text.push('"');
                rest = more;
            }
            None => return Ok((text, after)),
        }
    }
    Err(CsvLineFault::Unquoted)
}
