//! Files for packages and shells: manual pages, and shell completions.

use crate::cli::out::Out;
use anyhow::Context as _;
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

/// Prints the completions for a shell.
pub(crate) fn completions(
    out: &mut Out,
    args: &CompletionsArgs,
    mut program: Command,
) -> anyhow::Result<()> {
    let mut text = Vec::new();
    generate(args.shell, &mut program, "handscope", &mut text);
    let text = String::from_utf8_lossy(&text);
    text.lines().try_for_each(|line| out.line(line))
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
