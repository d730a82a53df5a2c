//! `check`: a check-up of an empty hand. It moves the hand, so it requires `--arm`.

mod args;
mod output;

pub(crate) use args::CheckArgs;

use crate::app::env::day_folder;
use crate::app::files::settings_file;
use crate::checkup::free_file;
use crate::checkup::subject::Grade;
use crate::checkup::{Checkup, CheckupPlan, expected};
use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, end};
use crate::cli::trial::drive::ArmedHand;
use crate::link::ArmRequest;
use crate::motion::checkup::{CheckupFiles, EndedCheckup};
use crate::motion::program::Progress;
use crate::store::{self, on_thread};
use anyhow::{Context as _, bail};
use std::path::Path;

/// Runs the check-up. Fails if it ended early, or if a figure requires action.
pub(crate) async fn run(out: &mut Out, args: &CheckArgs) -> anyhow::Result<()> {
    let plan = CheckupPlan { press: args.press };
    if !args.arm {
        return Err(FailureKind::NotArmed.error(format!(
            "nothing was moved: a check-up bends and opens each joint of the hand at {} for about {} seconds; when the hand is empty and nothing is in its way, add --arm",
            args.hand,
            expected(CheckupPlan::default()).as_secs()
        )));
    }
    let files = files(args)?;
    prepare(&files)?;
    let mut hand = ArmedHand::ready(&args.hand, ArmRequest::GENTLE).await?;
    let recording = match files.record(hand.link.observe(), hand.armed.clock) {
        Ok(recording) => recording,
        Err(error) => {
            hand.disarm().await;
            bail!("the check-up cannot be recorded: {error}");
        }
    };
    let checkup = Checkup::start(hand.armed.epoch, plan);
    let driven = hand
        .run(checkup, |progress| {
            if let Progress::View(view) = progress
                && !args.json
            {
                output::progress(view);
            }
            true
        })
        .await;
    let ended = EndedCheckup { driven, recording };
    let done = on_thread(move || Ok(files.conclude(ended))).await?;
    let report = done.report;
    out.result(args.json, &report.json(), output::lines(&report))?;
    out.flush()?;
    if let Some(Err(error)) = done.written {
        bail!("the report cannot be written: {error}");
    }
    match &report.aborted_words {
        Some(why) => bail!("the check-up ended early, its report is partial: {why}"),
        None => end(report.count(Grade::Act) == 0),
    }
}

fn files(args: &CheckArgs) -> anyhow::Result<CheckupFiles> {
    if let Some(folder) = args.recordings.as_deref().filter(|folder| !folder.is_dir()) {
        bail!(
            "{} is not a folder: nothing was done; name the folder of recordings with --recordings, or omit the option",
            folder.display()
        );
    }
    let settings = settings_file::default_path();
    let beside = || settings.as_ref().map(|path| path.with_file_name("checks"));
    let folder = args.folder.clone().or_else(beside);
    let folder = folder.context("no home folder for check-ups: name one with --folder")?;
    let as_in_window = || {
        let settings = settings_file::load(settings.as_deref()?).settings;
        settings.recordings_folder(day_folder::documents().as_deref())
    };
    Ok(CheckupFiles {
        hand: args.hand.clone(),
        free_force: settings
            .as_ref()
            .and_then(|settings| free_file::file_of(settings, &args.hand)),
        kept: CheckupFiles::kept_in(&folder, &args.hand),
        report: args.out.clone(),
        recordings: args.recordings.clone().or_else(as_in_window),
    })
}

/// Prepares the destination folders. The hand does not move if the check-up could not be stored or its report not
/// written.
fn prepare(files: &CheckupFiles) -> anyhow::Result<()> {
    files.earlier().with_context(|| {
        let name = name(files.kept.as_deref());
        format!("the earlier check-ups of this hand in {name} cannot be read; move the file away, or name another folder with --folder")
    })?;
    files.prepare().with_context(|| {
        let name = name(files.kept.as_deref().and_then(Path::parent));
        format!("check-ups cannot be stored in {name}; name another folder with --folder")
    })?;
    if let Some(folder) = &files.report {
        store::create_empty_folder(folder)
            .with_context(|| format!("cannot store the report in {}", folder.display()))?;
    }
    Ok(())
}

fn name(path: Option<&Path>) -> String {
    path.unwrap_or(Path::new("")).display().to_string()
}
