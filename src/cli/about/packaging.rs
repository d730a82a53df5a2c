//! Files for packages and shells: manual pages, and shell completions.

use crate::cli::out::Out;
use crate::hand::Dof;
use crate::hand::register::REGISTERS;
use crate::manual::TOPICS;
use anyhow::Context as _;
use clap::builder::PossibleValuesParser;
use clap::{Args, Command};
use clap_complete::{Shell, generate};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell that is to complete commands and options
    #[arg(value_name = "SHELL")]
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The folder that the pages go to; it is made if it is not there
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

/// Kinds of hands, as the beginning of their URLs.
const HANDS: [&str; 8] = [
    "sim:", "rs485:", "rtu:", "rtu+tcp:", "tcp:", "slcan:", "usbcan:", "can:",
];

/// Prints the completions for a shell.
pub(crate) fn completions(
    out: &mut Out,
    args: &CompletionsArgs,
    program: Command,
) -> anyhow::Result<()> {
    let mut text = Vec::new();
    let mut program = with_values(program);
    generate(args.shell, &mut program, "handscope", &mut text);
    let text = String::from_utf8_lossy(&text);
    text.lines().try_for_each(|line| out.line(line))
}

/// The command line with the values that a shell can offer: hands, joints, registers, and what there is help on. For completion
/// only: the program itself accepts more, such as several joints at once.
fn with_values(program: Command) -> Command {
    let commands = program.get_subcommands().filter(|sub| !sub.is_hide_set());
    // Clap wants names that last as long as the program, which ends after this.
    let commands = commands.map(|sub| &*sub.get_name().to_owned().leak());
    let topics = TOPICS.iter().map(|topic| topic.name);
    let helped: Vec<&'static str> = commands.chain(topics).collect();
    offering(program, &helped)
}

fn offering(command: Command, helped: &[&'static str]) -> Command {
    let subs = command
        .get_subcommands()
        .map(|sub| sub.get_name().to_owned());
    let subs: Vec<String> = subs.collect();
    let command = subs.into_iter().fold(command, |command, sub| {
        command.mut_subcommand(sub, |sub| offering(sub, helped))
    });
    let name = command.get_name().to_owned();
    command.mut_args(|arg| {
        let bending = Dof::ALL.into_iter().filter(|dof| *dof != Dof::ThumbRotate);
        let values = match (name.as_str(), arg.get_id().as_str()) {
            (_, "hand") => HANDS.to_vec(),
            // The thumb does not press by rotation.
            ("scale", "joint") => bending.map(Dof::name).collect(),
            (_, "joint") => Dof::ALL.map(Dof::name).to_vec(),
            ("read", "names") => REGISTERS.iter().map(|row| row.name).collect(),
            ("help", "words") => helped.to_vec(),
            _ => return arg,
        };
        arg.value_parser(PossibleValuesParser::new(values))
    })
}

/// Writes a page for the program and one per command.
pub(crate) fn man(out: &mut Out, args: &ManArgs, mut program: Command) -> anyhow::Result<()> {
    let folder = &args.out;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    program.build();
    let mut pages = Vec::new();
    page(program, "handscope", folder, &mut pages)?;
    out.line(&format!("{} pages in {}", pages.len(), folder.display()))
}

fn page(
    command: Command,
    name: &str,
    folder: &Path,
    pages: &mut Vec<PathBuf>,
) -> anyhow::Result<()> {
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        page(
            sub.clone(),
            &format!("{name}-{}", sub.get_name()),
            folder,
            pages,
        )?;
    }
    let file = folder.join(format!("{name}.1"));
    let mut text = Vec::new();
    let page = clap_mangen::Man::new(command.display_name(name)).title(name);
    let written = page.render(&mut text);
    written
        .and_then(|()| std::fs::write(&file, text))
        .with_context(|| format!("cannot write {}", file.display()))?;
    pages.push(file);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::Cli;
    use crate::transport::Endpoint;
    use clap::CommandFactory as _;

    #[test]
    fn a_shell_offers_hands_joints_registers_and_topics() {
        // Clap completes only options for fish.
        for (shell, values) in [
            (
                Shell::Bash,
                &["usbcan:", "thumb_rotate", "GESTURE_NO_SET", "wiring"][..],
            ),
            (
                Shell::Zsh,
                &["usbcan\\:", "thumb_rotate", "GESTURE_NO_SET", "wiring"],
            ),
            (Shell::Fish, &["usbcan:", "thumb_rotate"]),
        ] {
            let mut text = Vec::new();
            let mut program = with_values(Cli::command());
            generate(shell, &mut program, "handscope", &mut text);
            let text = String::from_utf8(text).unwrap();
            for value in values {
                assert!(text.contains(value), "{shell}: {value}");
            }
        }
    }

    #[test]
    fn each_kind_of_hand_is_offered_once() {
        let known = [
            "sim:",
            "rs485:/dev/x",
            "rtu:/dev/x",
            "rtu+tcp:127.0.0.1:6000",
            "tcp:127.0.0.1",
            "slcan:/dev/x",
            "usbcan:/dev/x",
            "can:can0",
        ];
        let kinds = known.map(|url| url.parse::<Endpoint>().unwrap().kind());
        assert_eq!(HANDS.map(|hand| hand.trim_end_matches(':')), kinds);
    }
}
