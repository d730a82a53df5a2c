//! `check`: a check-up of an empty hand. It moves the hand, so it requires `--arm`.

mod args;
mod output;

pub(crate) use args::CheckArgs;

use crate::app::files::settings_file;
use crate::checkup::check::Check;
use crate::checkup::kept::{self, Kept};
use crate::checkup::report::{ReportHead, html, summary};
use crate::checkup::subject::Light;
use crate::checkup::{Checkup, Measured};
use crate::cli::out::{Out, end, say};
use crate::cli::trial::drive::ArmedHand;
use crate::cli::trial::output::stop_words;
use crate::hand::{Force, PerDof, Speed};
use crate::link::ArmRequest;
use crate::store;
use crate::store::calendar::{since_1970, stamp};
use anyhow::{Context as _, bail};
use std::path::{Path, PathBuf};

/// Runs the check-up. Fails if it ended early, or if something is to be done.
pub(crate) async fn run(out: &mut Out, args: &CheckArgs) -> anyhow::Result<()> {
    if !args.arm {
        bail!(
            "nothing was moved: a check-up bends and opens each joint of the hand at {} for about 75 seconds; when the hand is empty and nothing is in its way, add --arm",
            args.hand
        );
    }
    let file = file(args)?;
    let earlier = earlier(file.as_deref())?;
    if let Some(folder) = &args.out {
        store::create_empty_folder(folder)
            .with_context(|| format!("cannot store the report in {}", folder.display()))?;
    }
    let limits = ArmRequest {
        speed: PerDof::splat(Speed::GENTLE),
        force: PerDof::splat(Force::GENTLE),
    };
    let mut hand = ArmedHand::ready(&args.hand, limits).await?;
    let mut told = None;
    let (checkup, ended) = hand
        .run(Checkup::start(hand.epoch), |checkup: &mut Checkup| {
            let view = checkup.view();
            if told.replace(view) != Some(view) && !args.json {
                output::progress(view);
            }
            true
        })
        .await;
    let figures = |nth: Option<&Kept>| nth.map(|kept| kept.figures.clone()).unwrap_or_default();
    let (first, last) = (figures(earlier.first()), figures(earlier.last()));
    let checks = checkup.checks(&first, &last);
    let aborted = ended
        .aborted
        .map(|why| format!("{why}{}", stop_words(ended.stop)));
    let head = ReportHead {
        hand: args.hand.to_string(),
        simulated: args.hand.is_sim(),
        at: stamp(since_1970()),
        aborted,
        earlier: earlier.len(),
        summary: summary(&checks),
    };
    if let (Some(file), None) = (&file, &head.aborted) {
        keep(file, &head, checkup.measured());
    }
    out.result(
        args.json,
        &output::json(&head, &checks),
        output::lines(&head, &checks),
    )?;
    out.flush()?;
    if let Some(folder) = &args.out {
        write(folder, &head, &checks)?;
    }
    match &head.aborted {
        Some(why) => bail!("the check-up ended early, its report is partial: {why}"),
        None => end(checks.iter().all(|check| check.light != Light::Act)),
    }
}

/// Where the check-ups of this hand are kept; nowhere for the built-in one, which is another each time.
fn file(args: &CheckArgs) -> anyhow::Result<Option<PathBuf>> {
    if args.hand.is_sim() {
        return Ok(None);
    }
    let beside = || settings_file::default_path().map(|path| path.with_file_name("checks"));
    let folder = args.folder.clone().or_else(beside);
    let folder = folder.context("no home folder for check-ups: name one with --folder")?;
    Ok(Some(kept::file_of(&folder, &args.hand)))
}

/// The earlier check-ups in a file, whose folder is made: nothing moves where a check-up could not be kept.
fn earlier(file: Option<&Path>) -> anyhow::Result<Vec<Kept>> {
    let Some(file) = file else {
        return Ok(Vec::new());
    };
    let earlier = kept::read(file).with_context(|| {
        let name = file.display();
        format!("the earlier check-ups of this hand in {name} cannot be read; move the file away, or name another folder with --folder")
    })?;
    let folder = file.parent().unwrap_or(file);
    store::create_folder(folder).with_context(|| {
        let name = folder.display();
        format!("check-ups cannot be kept in {name}; name another folder with --folder")
    })?;
    Ok(earlier)
}

/// Keeps a check-up that was done to its end. One that cannot be kept is told all the same.
fn keep(file: &Path, head: &ReportHead, figures: Vec<Measured>) {
    let own = Kept {
        at: head.at.clone(),
        hand: head.hand.clone(),
        figures,
    };
    if let Err(error) = kept::add(file, own) {
        let name = file.display();
        say(&format!("this check-up is not kept in {name}: {error}"));
    }
}

fn write(folder: &Path, head: &ReportHead, checks: &[Check]) -> anyhow::Result<()> {
    let page = html(head, checks)?;
    let json = format!("{}\n", output::json(head, checks));
    for (name, text) in [("report.html", page), ("check.json", json)] {
        let path = folder.join(name);
        store::replace(&path, text.as_bytes())
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}
