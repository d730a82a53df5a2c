//! `snapshot`: pictures of the window and lists of what stands in it, as files. Draws nothing itself.

use crate::cli::args::{SnapshotArgs, Views};
use crate::cli::out::{Out, say};
use crate::headless::driver::{Driver, Scene};
use crate::headless::png;
use crate::transport::Endpoint;
use crate::ui::View;
use anyhow::Context as _;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// A person who waits is told how far it is.
const TELL_EACH: Duration = Duration::from_secs(1);

/// Draws the pictures and prints the name of each file.
pub(crate) fn run(out: &mut Out, args: &SnapshotArgs) -> anyhow::Result<()> {
    let mut driver = Driver::start(&Scene {
        endpoint: endpoint(args),
        size: args.size,
        scale: args.scale,
        theme: args.theme.into(),
        language: args.lang.into(),
    })?;
    driver.connect()?;
    driver.run_for(args.at, progress(args.at));
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    for (name, view) in pictures(args.view) {
        for path in save(&mut driver, view, &args.out.join(name))? {
            out.line(&path)?;
        }
        out.flush()?;
    }
    Ok(())
}

fn endpoint(args: &SnapshotArgs) -> Endpoint {
    args.hand.clone().unwrap_or_else(|| Endpoint::Sim {
        seed: args.seed,
        scenario: args.scenario.unwrap_or_default().name().into(),
    })
}

/// Names and views of the wanted pictures.
fn pictures(views: Views) -> Vec<(&'static str, View)> {
    let window = ("window", View::default());
    match views {
        Views::Window => vec![window],
        Views::One(view) => vec![(view.name(), view)],
        Views::All => {
            let each = View::ALL.map(|view| (view.name(), view));
            each.into_iter().chain([window]).collect()
        }
    }
}

/// Says each second of waiting how far it is.
fn progress(whole: Duration) -> impl FnMut(Duration) {
    let mut told = Instant::now();
    move |done| {
        if told.elapsed() >= TELL_EACH {
            told = Instant::now();
            say(&format!(
                "{:.0} of {:.0} s",
                done.as_secs_f64(),
                whole.as_secs_f64()
            ));
        }
    }
}

fn save(driver: &mut Driver, view: View, stem: &Path) -> anyhow::Result<[String; 2]> {
    let picture = driver.picture(view);
    let (image, labels) = (stem.with_extension("png"), stem.with_extension("json"));
    png::save(&image, &picture.rgba, picture.size)?;
    let list = serde_json::to_string_pretty(&picture.labels)?;
    fs::write(&labels, list + "\n")
        .with_context(|| format!("cannot write {}", labels.display()))?;
    Ok([image, labels].map(|path| path.display().to_string()))
}
