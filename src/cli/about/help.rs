//! `help`: the help of a command as clap writes it, or a page of the manual as plain text.

use crate::cli::out::{Out, ReaderGone, WrongUsage};
use crate::cli::parse;
use crate::manual::{self, HelpTopic, TOPICS};
use clap::{Args, Command};
use std::io::ErrorKind;

#[derive(Debug, Args)]
pub(crate) struct HelpArgs {
    /// A command or a topic; without one, the list of all
    #[arg(value_name = "COMMAND|TOPIC")]
    pub(crate) words: Vec<String>,
}

/// Prints the requested help: without arguments that of the whole program, else a topic or a command.
pub(crate) fn run(out: &mut Out, args: &HelpArgs, program: Command) -> anyhow::Result<()> {
    let words: Vec<String> = args.words.iter().map(|word| word.to_lowercase()).collect();
    if let [word, rest @ ..] = words.as_slice()
        && let Some(HelpTopic { name, text, .. }) = manual::topic(word)
    {
        if rest.is_empty() {
            return plain(text).iter().try_for_each(|line| out.line(line));
        }
        let words = format!("'{name}' is a topic: 'handscope help {name}' shows all of it");
        return Err(WrongUsage(words).into());
    }
    if let Some(word) = words.first()
        && program.find_subcommand(word).is_none()
    {
        return Err(unknown(word, &program).into());
    }
    let line = ["handscope"]
        .into_iter()
        .chain(words.iter().map(String::as_str));
    match program.try_get_matches_from(line.chain(["--help"])) {
        // Clap returns its help as an error; printing it through clap preserves colours and width.
        Err(help) if help.exit_code() == 0 => match help.print() {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(ReaderGone.into()),
            printed => Ok(printed?),
        },
        Err(wrong) => wrong.exit(),
        Ok(_) => Ok(()),
    }
}

/// List of topics, for the help of the whole program.
pub(crate) fn topics() -> String {
    let lines = TOPICS
        .iter()
        .map(|topic| format!("\n  {:9}  {}", topic.name, topic.about));
    lines.fold(
        "Topics of the manual, shown by 'handscope help TOPIC':".to_owned(),
        |all, line| all + &line,
    )
}

fn unknown(word: &str, program: &Command) -> WrongUsage {
    let commands = program.get_subcommands().map(Command::get_name);
    let known = commands.chain(TOPICS.iter().map(|topic| topic.name));
    let nearest = parse::nearest(word, known).join(", ");
    WrongUsage(format!(
        "there is no command or topic '{word}'; the nearest are {nearest}; 'handscope help' lists them all"
    ))
}

/// Columns of the narrowest common terminal.
const COLUMNS: usize = 80;

/// Formats a page of the manual as plain text: headings underlined, code indented, tables without bars.
fn plain(markdown: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut table = Vec::new();
    let mut in_code = false;
    for line in markdown.lines() {
        let row = line.strip_prefix('|').and_then(|row| row.strip_suffix('|'));
        if let Some(row) = row.filter(|_| !in_code) {
            table.push(row.split('|').map(|cell| inline(cell.trim())).collect());
            continue;
        }
        lines.extend(aligned(&std::mem::take(&mut table)));
        if line.starts_with("```") {
            in_code = !in_code;
        } else if in_code {
            lines.push(format!("  {line}").trim_end().to_owned());
        } else if let Some(title) = line.strip_prefix("# ") {
            lines.extend([title.to_owned(), "=".repeat(title.chars().count())]);
        } else if let Some(title) = line.strip_prefix("## ") {
            lines.extend([title.to_owned(), "-".repeat(title.chars().count())]);
        } else {
            lines.push(inline(line));
        }
    }
    lines.extend(aligned(&table));
    lines
}

/// The rows of a table with aligned columns, as far as they fit a terminal.
fn aligned(table: &[Vec<String>]) -> Vec<String> {
    let is_ruler = |row: &[String]| {
        row.iter()
            .all(|cell| cell.trim_matches(['-', ':']).is_empty())
    };
    let width = |column: usize| {
        let cells = table.iter().filter(|row| !is_ruler(row));
        let cells = cells.filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let written = |is_padded: bool| {
        let rows = table.iter().map(move |row| {
            let cells = row.iter().enumerate().map(|(column, cell)| {
                let width = if is_padded { width(column) } else { 0 };
                match is_ruler(row) {
                    true => "-".repeat(width.max(1)),
                    false => format!("{cell:width$}"),
                }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        });
        rows.collect::<Vec<_>>()
    };
    let padded = written(true);
    if padded.iter().all(|line| line.chars().count() <= COLUMNS) {
        return padded;
    }
    written(false)
}

/// Removes the marks for bold and emphasis; code is quoted, as in the program's other messages.
fn inline(line: &str) -> String {
    let (bullet, rest) = line
        .strip_prefix("* ")
        .map_or(("", line), |rest| ("* ", rest));
    let rest = rest.replace("**", "").replace('*', "\"").replace('`', "'");
    format!("{bullet}{rest}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "a test may")]
    use super::*;
    use crate::cli::args::Cli;
    use clap::error::ErrorKind;
    use clap::{CommandFactory as _, Parser as _};

    const README: &str = include_str!("../../../README.md");

    fn pages() -> impl Iterator<Item = (&'static str, &'static str)> {
        let topics = TOPICS.iter().map(|topic| (topic.name, topic.text));
        topics.chain([("README", README)])
    }

    #[test]
    fn every_topic_is_a_page_of_plain_text_that_fits_a_terminal() {
        for topic in TOPICS {
            let lines = plain(topic.text);
            assert!(lines.len() > 10, "{}", topic.name);
            assert!(
                lines.iter().any(|line| line.starts_with("====")),
                "{}",
                topic.name
            );
            for line in &lines {
                assert!(
                    line.chars().count() <= COLUMNS,
                    "{}: too long: {line}",
                    topic.name
                );
                for noise in ["```", "**", "](", "|--", "`"] {
                    assert!(!line.contains(noise), "{}: {line}", topic.name);
                }
            }
        }
    }

    #[test]
    fn the_markdown_is_rendered_lightly() {
        for (markdown, text) in [
            ("# Files", "Files\n====="),
            ("## Poses", "Poses\n-----"),
            (
                "* press **Arm**, then *Open all*",
                "* press Arm, then \"Open all\"",
            ),
            ("run `handscope scan`", "run 'handscope scan'"),
            ("```sh\nhandscope *\n```", "  handscope *"),
            (
                "| file  | holds |\n|-------|-------|\n| `a.b` | words |",
                "file   holds\n-----  -----\n'a.b'  words",
            ),
            (
                "| end | what it means |\n|---|---|\n| `held`| words |",
                "end     what it means\n------  -------------\n'held'  words",
            ),
        ] {
            assert_eq!(plain(markdown).join("\n"), text);
        }
    }

    #[test]
    fn a_topic_with_the_name_of_a_command_says_where_its_options_are() {
        let command = Cli::command();
        let same = |topic: &&HelpTopic| command.find_subcommand(topic.name).is_some();
        for topic in TOPICS.iter().filter(same) {
            let options = format!("`handscope {} --help`", topic.name);
            assert!(topic.text.contains(&options), "{}", topic.name);
        }
    }

    /// A line of a shell as words. Knows quotes and comments, and ends at a pipe.
    fn shell_words(line: &str) -> Vec<String> {
        let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
        for letter in line.chars() {
            match letter {
                '\'' => quoted = !quoted,
                '#' | '|' if !quoted && word.is_empty() => break,
                ' ' if !quoted => {
                    words.extend((!word.is_empty()).then(|| std::mem::take(&mut word)))
                }
                letter => word.push(letter),
            }
        }
        words.extend((!word.is_empty()).then_some(word));
        words
    }

    /// All commands of this program in a page; true for those in a code block.
    fn commands(page: &str) -> Vec<(String, bool)> {
        let mut found = Vec::new();
        for (number, part) in page.split("```").enumerate() {
            let is_block = number % 2 == 1;
            let pieces: Vec<&str> = if is_block {
                part.lines().collect()
            } else {
                part.split('`').skip(1).step_by(2).collect()
            };
            for piece in pieces {
                let words: Vec<&str> = piece.split_whitespace().collect();
                if words.first() == Some(&"handscope") {
                    found.push((words.join(" "), is_block));
                }
            }
        }
        found
    }

    #[test]
    fn every_command_in_the_manual_is_one_that_the_program_takes() {
        let mut count = 0;
        for (name, page) in pages() {
            for (command, is_block) in commands(page) {
                let line = command.replace("--hand URL", "--hand sim:");
                let Err(error) = Cli::try_parse_from(shell_words(&line)) else {
                    count += 1;
                    continue;
                };
                // A sentence may name a command without all that it needs, or its help.
                let named = [ErrorKind::MissingRequiredArgument, ErrorKind::DisplayHelp];
                let is_named = !is_block && named.contains(&error.kind());
                assert!(is_named, "{name}: {command}: {error}");
            }
        }
        assert!(count > 25, "only {count} commands found");
    }

    #[test]
    fn every_word_that_the_pages_send_a_reader_to_is_there() {
        for (name, page) in pages() {
            for (command, _) in commands(page) {
                let Some(words) = command.strip_prefix("handscope help ") else {
                    continue;
                };
                if ["TOPIC", "COMMAND"].contains(&words) || manual::topic(words).is_some() {
                    continue;
                }
                let mut named = Cli::command();
                for word in words.split(' ') {
                    let inner = named.find_subcommand(word);
                    let inner = inner.unwrap_or_else(|| panic!("{name}: {command}: {word}"));
                    named = inner.clone();
                }
            }
        }
    }
}
