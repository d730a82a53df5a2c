//! `snapshot`: pictures of the window and lists of what stands in it, as files. Draws nothing itself.

use crate::app::settings::{Language, Theme};
use crate::cli::args::{CardArg, SnapshotArgs, Views};
use crate::cli::out::{Out, WrongUsage, say};
use crate::headless::canvas::Picture;
use crate::headless::cards::SceneCard;
use crate::headless::driver::{Driver, Scene};
use crate::headless::png;
use crate::sim::Scenario;
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
    let card = args.card.map(CardArg::card);
    let mut driver = start(args, card.map(|(card, _)| card))?;
    driver.connect()?;
    driver.run_for(args.at, progress(args.at));
    if args.hand.is_none() && shows_trials(args) {
        driver.try_grasps();
    }
    if let Some((card, _)) = card {
        driver.open_card(card);
    }
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    for (language, of_language) in args.lang.each() {
        for (number, (theme, of_theme)) in args.theme.each().iter().enumerate() {
            driver.dress(*theme, *language);
            for (name, view) in pictures(args.view) {
                let name = card.map_or(name, |(_, name)| name);
                let picture = driver.picture(view);
                let labels = args.out.join(format!("{name}{of_language}.json"));
                let image = args.out.join(format!("{name}{of_language}{of_theme}.png"));
                png::save(&image, &picture.rgba, picture.size)?;
                out.line(&image.display().to_string())?;
                // What stands where does not depend on colours.
                if number == 0 {
                    save_labels(&labels, &picture)?;
                    out.line(&labels.display().to_string())?;
                }
            }
            out.flush()?;
        }
    }
    Ok(())
}

fn start(args: &SnapshotArgs, card: Option<SceneCard>) -> anyhow::Result<Driver> {
    let scene = Scene {
        endpoint: endpoint(args),
        size: args.size,
        scale: args.scale,
        theme: Theme::default(),
        language: Language::default(),
    };
    if card.is_some_and(SceneCard::wants_built_in) && !scene.endpoint.is_sim() {
        let why = "this card is shown only with the built-in hand: a hand would be written to";
        return Err(WrongUsage(why.into()).into());
    }
    Ok(match card.and_then(SceneCard::line) {
        Some(line) => Driver::start_on_line(&scene, line)?,
        None => Driver::start(&scene)?,
    })
}

fn endpoint(args: &SnapshotArgs) -> Endpoint {
    args.hand.clone().unwrap_or_else(|| Endpoint::Sim {
        seed: args.seed,
        scenario: args.scenario.unwrap_or_default().name().into(),
    })
}

/// Trials are tried only where nothing else was asked for: on a hand that does nothing by itself.
fn shows_trials(args: &SnapshotArgs) -> bool {
    let still = matches!(
        args.scenario.unwrap_or_default(),
        Scenario::Idle | Scenario::Rigid | Scenario::Fragile
    );
    still && matches!(args.view, Views::One(View::Tune | View::Compare))
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

fn save_labels(path: &Path, picture: &Picture) -> anyhow::Result<()> {
    let list = serde_json::to_string_pretty(&picture.labels)?;
    fs::write(path, list + "\n").with_context(|| format!("cannot write {}", path.display()))
}
