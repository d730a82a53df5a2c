//! The journals as text: what stands at the beginning of a line is asked for, what is indented is what came of it.
//!
//! A case begins with `== title`; `on` names its wires, `quirk`, `scenario`, `ids` and `upset` say how the hand is, `keep`,
//! `angles` and `hide` what is printed. All other lines are steps, and `command` and `window` know them.
//!
//! What passed stands there a line a request, without the reads of the background: `R address length -> bytes`, `W address length
//! bytes -> ack`, on Modbus with the function behind the `W`, at an id other than 1 with `@id` before it. `none` is no answer,
//! `(late)` one that came after the next request, `heard` what nobody asked for, `xN` at the end: once or more often again.

use crate::journal::line::{Passed, Request};
use handscope::hand::Span;
use handscope::sim::SimConfig;
use std::path::Path;

const HAND_ID: u16 = 1000;
const ANGLE_SET: Span = Span::new(1486, 12);
const SETPOINTS: Span = Span::new(1474, 60);
/// All that the background plan reads: without a task of its own a read there is none of a task.
const POLLED: [Span; 2] = [Span::new(1474, 156), Span::new(3000, 290)];
/// What a link on CAN asks before the id, until something comes.
const PROBE: Span = Span::new(1546, 2);
/// Behind a run of lines that were repeated.
const MARK: &str = " xN";

/// One case: how it is set up, and its steps.
#[derive(Default)]
pub(crate) struct Case {
    pub(crate) title: String,
    /// All lines that were asked for, comments too.
    asked: Vec<String>,
    pub(crate) wires: Vec<String>,
    pub(crate) ids: Vec<u8>,
    pub(crate) config: SimConfig,
    pub(crate) upsets: Vec<String>,
    /// Reads at polled addresses that are the task's own.
    keeps: Vec<Span>,
    /// Nothing is left out.
    is_whole: bool,
    /// Angles that are printed; others depend on when the hand was looked at.
    angles: Option<Vec<i16>>,
    /// Numbers that are not printed: `measured` ones, which have a point, or all `numbers`.
    pub(crate) hides: String,
}

/// What came of one step.
#[derive(Default, Clone, PartialEq)]
pub(crate) struct Outcome {
    /// What the program says.
    pub(crate) said: Vec<String>,
    /// What passed on the wire.
    pub(crate) passed: Vec<String>,
}

impl Outcome {
    /// All of it.
    pub(crate) fn lines(&self) -> Vec<String> {
        let lines = self.said.iter().chain(&self.passed);
        lines.map(|line| line.trim_end().to_owned()).collect()
    }
}

/// The cases of a journal. Each begins with `== title`.
pub(crate) fn cases(text: &str) -> Vec<Case> {
    let mut all: Vec<Case> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with("  ")) {
        if let Some(title) = line.strip_prefix("== ") {
            let title = title.into();
            all.push(Case {
                title,
                ids: vec![1],
                ..Case::default()
            });
        }
        if let Some(case) = all.last_mut().filter(|_| !line.is_empty()) {
            case.asked.push(line.into());
            case.set_up(line);
        }
    }
    all
}

/// True for a line that says what a case is about, false for a step.
fn is_head(line: &str) -> bool {
    Case::default().set_up(line)
}

impl Case {
    /// Takes what a line says of the case; false for a step.
    fn set_up(&mut self, line: &str) -> bool {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let words = || rest.split(' ').map(str::to_owned);
        let numbers = || rest.split(' ').map(|word| word.parse::<u16>().unwrap());
        match word {
            "on" => self.wires = words().collect(),
            "ids" => self.ids = words().map(|word| word.parse().unwrap()).collect(),
            "scenario" => self.config.scenario = rest.parse().unwrap(),
            "quirk" => {
                let (name, value) = rest.split_once('=').unwrap();
                self.config.personality.set(name, value).unwrap();
            }
            "upset" => self.upsets.push(rest.into()),
            "keep" if rest == "all" => self.is_whole = true,
            "keep" => {
                let numbers: Vec<u16> = numbers().collect();
                self.keeps.push(Span::new(numbers[0], numbers[1]));
            }
            "angles" => self.angles = Some(words().map(|word| word.parse().unwrap()).collect()),
            "hide" => self.hides = rest.into(),
            "==" | "#" => {}
            _ => return false,
        }
        true
    }

    /// The steps, in order.
    pub(crate) fn steps(&self) -> impl Iterator<Item = &String> {
        self.asked.iter().filter(|line| !is_head(line))
    }

    /// What stands in the page of this case as come of its steps on a wire.
    pub(crate) fn stored(&self, page: &str, wire: &str) -> Vec<Vec<String>> {
        let (mut steps, mut is_meant) = (Vec::new(), true);
        for line in page.lines() {
            match line.strip_prefix("  ") {
                None if is_head(line) => {}
                None => (steps, is_meant) = ([steps, vec![Vec::new()]].concat(), true),
                Some(names) if self.wires.len() > 1 && names.starts_with('[') => {
                    let mut names = names.trim_matches(['[', ']']).split(' ');
                    is_meant = names.any(|name| name == wire);
                }
                Some(line) if is_meant => steps.last_mut().unwrap().push(line.to_owned()),
                Some(_) => {}
            }
        }
        steps
    }

    /// The case with what came of it on each wire.
    pub(crate) fn page(&self, outcomes: &[Vec<Outcome>]) -> String {
        let mut text = String::new();
        let mut nth = 0;
        for line in &self.asked {
            text += &format!("{line}\n");
            if !is_head(line) {
                for part in [
                    |of: &Outcome| of.said.clone(),
                    |of: &Outcome| of.passed.clone(),
                ] {
                    let of_step = outcomes.iter().map(|steps| part(&steps[nth]));
                    text += &self.grouped(&of_step.collect::<Vec<_>>());
                }
                nth += 1;
            }
        }
        text
    }

    /// The same lines once, with the wires that they are of.
    fn grouped(&self, of_wires: &[Vec<String>]) -> String {
        let mut text = String::new();
        for (nth, lines) in of_wires.iter().enumerate() {
            if lines.is_empty() || of_wires[..nth].contains(lines) {
                continue;
            }
            let alike = self.wires.iter().zip(of_wires);
            let alike = alike.filter(|(_, other)| *other == lines);
            let names: Vec<&str> = alike.map(|(wire, _)| wire.as_str()).collect();
            if self.wires.len() > 1 {
                text += &format!("  [{}]\n", names.join(" "));
            }
            for line in lines {
                text += &format!("  {}\n", line.trim_end());
            }
        }
        text
    }

    /// What passed, a line each, without the background's reads.
    pub(crate) fn lines(&self, passed: &[Passed]) -> Vec<String> {
        let lines = passed.iter().filter_map(|passed| match passed {
            Passed::Other(text) if text.starts_with("adapter") && !self.is_whole => None,
            Passed::Other(text) => Some(text.clone()),
            Passed::Request(request) => self.line(request),
        });
        without_repeats(lines)
    }

    fn line(&self, request: &Request) -> Option<String> {
        let Span { address, len } = request.span;
        let at = match request.id {
            1 | 255 => String::new(),
            id => format!("@{id} "),
        };
        let answer = request.answer.as_deref().unwrap_or("none");
        if request.writes {
            let function = request.function.map(|function| format!("{function:02}"));
            let (function, bytes) = (function.unwrap_or_default(), self.bytes(request));
            return Some(format!(
                "{at}W{function} {address} {len} {bytes} -> {answer}"
            ));
        }
        let is_polled = POLLED.iter().any(|all| all.covers(request.span));
        let is_probe = request.span == PROBE && request.answer.is_none();
        match is_polled && !is_probe && !self.keeps.contains(&request.span) {
            // What is measured differs each time.
            true => self.is_whole.then(|| format!("{at}R {address} {len}")),
            // Each try to find a hand asks for its id in another length; how many there are depends on time.
            false if address == HAND_ID && answer == "none" => {
                Some(format!("{at}R {address} -> none"))
            }
            false => Some(format!("{at}R {address} {len} -> {answer}")),
        }
    }

    fn bytes(&self, request: &Request) -> String {
        if !SETPOINTS.covers(request.span) {
            return compact(&request.bytes);
        }
        let (pairs, _) = request.bytes.as_chunks::<2>();
        let known = self
            .angles
            .as_ref()
            .filter(|_| ANGLE_SET.covers(request.span));
        let words = pairs.iter().map(|pair| match i16::from_le_bytes(*pair) {
            short if known.is_none_or(|known| known.contains(&short)) => short.to_string(),
            _ => "~".into(),
        });
        format!("[{}]", words.collect::<Vec<_>>().join(" "))
    }
}

/// Bytes in hex, four or more alike pairs once: `E803*12`.
pub(crate) fn compact(bytes: &[u8]) -> String {
    let hex = |pair: &[u8]| {
        pair.iter()
            .map(|byte| format!("{byte:02X}"))
            .collect::<String>()
    };
    let pairs: Vec<String> = bytes.chunks(2).map(hex).collect();
    let runs = pairs.chunk_by(|a, b| a == b);
    let runs = runs.flat_map(|run| match run.len() {
        ..4 => run.to_vec(),
        len => vec![format!("{}*{len}", run[0])],
    });
    runs.collect::<Vec<_>>().join(" ")
}

/// How often a stop is repeated, and how often a hand is looked for that is not there, depends on time: such lines stand there
/// once, marked `xN`.
fn without_repeats(lines: impl Iterator<Item = String>) -> Vec<String> {
    let is_look = |line: &str| {
        let is_asked = line.ends_with("R 1000 -> none") || line.ends_with("R 1546 2 -> none");
        is_asked || line.starts_with("open")
    };
    let is_hold = |line: &str| line.contains(" 1486 ") || line.contains(" 1494 ");
    // Lines, and where the run of now begins.
    let (mut kept, mut begins) = (Vec::<String>::new(), 0);
    for line in lines {
        let run = &kept[begins..];
        let last = run.last().map_or("", |last| last.trim_end_matches(MARK));
        let goes_on = is_look(&line) && is_look(last) || is_hold(&line) && is_hold(last);
        let is_there = run.iter().any(|other| other.trim_end_matches(MARK) == line);
        if goes_on && is_there {
            let last = kept.pop().unwrap();
            kept.push(last.trim_end_matches(MARK).to_owned() + MARK);
            continue;
        }
        if !goes_on || line.starts_with("open") {
            begins = kept.len();
        }
        kept.push(line);
    }
    kept
}

/// Text without what differs from run to run: names of folders and ports, moments, and numbers that are hidden.
pub(crate) fn masked(text: &str, names: &[(&str, &str)], hides: &str) -> String {
    let replaced = |text: String, (name, mask): &(&str, &str)| text.replace(name, mask);
    let text = names.iter().fold(text.to_owned(), replaced);
    let mut masked = String::new();
    let mut rest = text.as_str();
    while let Some(letter) = rest.chars().next() {
        let of_moment = |letter: char| letter.is_ascii_digit() || "-:.TZ".contains(letter);
        let of_number = |letter: char| letter.is_ascii_digit() || letter == '.';
        let token = |is_of: fn(char) -> bool| {
            let end = rest.find(|letter| !is_of(letter)).unwrap_or(rest.len());
            rest[..end].trim_end_matches(['-', ':', '.'])
        };
        let (moment, number) = (token(of_moment), token(of_number));
        let hidden = hides == "numbers" || hides == "measured" && number.contains('.');
        let (len, mask) = match letter {
            '0'..='9' if moment.len() > 18 && moment.contains('T') => (moment.len(), "MOMENT"),
            '0'..='9' if hidden => (number.len(), "#"),
            '0'..='9' => (number.len(), number),
            ' ' if masked.ends_with(' ') && hides == "numbers" => (1, ""),
            letter => (letter.len_utf8(), &rest[..letter.len_utf8()]),
        };
        masked += mask;
        rest = &rest[len..];
    }
    masked
}

/// Writes a file of a case: its name, then its lines with semicolons between.
pub(crate) fn write_file(folder: &Path, words: &[&str]) {
    let text = words[1..].join(" ").replace("; ", "\n");
    std::fs::write(folder.join(words[0]), text + "\n").unwrap();
}

/// Both texts line by line, where they differ.
pub(crate) fn difference(wanted: &str, got: &str) -> String {
    let (wanted, got): (Vec<&str>, Vec<&str>) = (wanted.lines().collect(), got.lines().collect());
    // Lengths of the longest common rest from each pair of lines.
    let mut common = vec![vec![0_usize; got.len() + 1]; wanted.len() + 1];
    for a in (0..wanted.len()).rev() {
        for b in (0..got.len()).rev() {
            common[a][b] = match wanted[a] == got[b] {
                true => common[a + 1][b + 1] + 1,
                false => common[a + 1][b].max(common[a][b + 1]),
            };
        }
    }
    let (mut a, mut b, mut text) = (0, 0, String::new());
    while a < wanted.len() || b < got.len() {
        let (old, new) = (wanted.get(a), got.get(b));
        if old == new {
            let is_asked = !wanted[a].starts_with(' ');
            text += &if is_asked {
                format!("  {}\n", wanted[a])
            } else {
                String::new()
            };
            (a, b) = (a + 1, b + 1);
        } else if old.is_some() && (new.is_none() || common[a + 1][b] >= common[a][b + 1]) {
            text += &format!("- {}\n", wanted[a]);
            a += 1;
        } else {
            text += &format!("+ {}\n", got[b]);
            b += 1;
        }
    }
    text
}
