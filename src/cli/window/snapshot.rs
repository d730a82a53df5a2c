//! `snapshot`: pictures of the window, and lists of their contents, as files.

use crate::app::settings::{Language, Theme};
use crate::cli::out::{Out, WrongUsage};
use crate::cli::parse::{number, seconds};
use crate::shell::headless::canvas::Picture;
use crate::shell::headless::cards::SceneCard;
use crate::shell::headless::driver::{Driver, Scene};
use crate::shell::headless::png;
use crate::sim::Scenario;
use crate::transport::Endpoint;
use crate::ui::View;
use anyhow::Context as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug, clap::Args)]
pub(crate) struct SnapshotArgs {
    /// The hand to show [default: the built-in one]
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    hand: Option<Endpoint>,
    /// What the built-in hand does: idle, free, rigid, fragile, grasp, touched, faults, extremes, frozen
    #[arg(long, value_name = "NAME", conflicts_with = "hand")]
    scenario: Option<Scenario>,
    /// Seed of the built-in hand
    #[arg(long, default_value_t = 1, conflicts_with = "hand")]
    seed: u64,
    /// Seconds after connecting
    #[arg(long, value_name = "SECONDS", default_value = "3", value_parser = seconds)]
    at: Duration,
    #[arg(long, value_name = "NAME", default_value = "window", value_parser = views, help = views_help())]
    view: Views,
    /// A dialog to show over the view; the files take its name. keep, danger and exhibit need the built-in hand
    #[arg(long, value_parser = CARDS.map(|(name, _)| name))]
    card: Option<String>,
    /// Width x height in points
    #[arg(long, value_name = "WxH", default_value = "1440x900", value_parser = size)]
    size: (u32, u32),
    /// Pixels per point
    #[arg(long, default_value = "1", value_parser = scale)]
    scale: f32,
    /// Colours; with 'all', names of light pictures end in -light
    #[arg(long, default_value = "dark", value_parser = ["dark", "light", "all"])]
    theme: String,
    /// Language of the window; with 'all', names of Chinese pictures end in -zh
    #[arg(long, default_value = "en", value_parser = ["en", "zh", "all"])]
    lang: String,
    /// Folder for the files; created if missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Pictures to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Views {
    /// The window as it opens.
    Window,
    /// The window with this view open.
    One(View),
    /// Each view, and the window as it opens.
    All,
}

/// The dialogs that can be shown.
const CARDS: [(&str, SceneCard); 7] = [
    ("reset", SceneCard::Reset),
    ("calibrate", SceneCard::Calibrate),
    ("address", SceneCard::Address),
    ("keep", SceneCard::Keep),
    ("danger", SceneCard::Danger),
    ("exhibit", SceneCard::Exhibit),
    ("exhibit-pin", SceneCard::ExhibitPin),
];
const THEMES: [(&str, Theme); 2] = [("dark", Theme::Dark), ("light", Theme::Light)];
const LANGUAGES: [(&str, Language); 2] = [("en", Language::En), ("zh", Language::Zh)];

/// The chosen values, with the suffixes of their file names.
fn chosen<T: Copy>(name: &str, both: [(&str, T); 2]) -> Vec<(T, String)> {
    let [(_, first), (second_name, second)] = both;
    match name {
        "all" => vec![(first, String::new()), (second, format!("-{second_name}"))],
        name if name == second_name => vec![(second, String::new())],
        _ => vec![(first, String::new())],
    }
}

/// Draws the pictures and prints the name of each file.
pub(crate) fn run(out: &mut Out, args: &SnapshotArgs) -> anyhow::Result<()> {
    let named = |(name, _): &(&str, SceneCard)| Some(*name) == args.card.as_deref();
    let card = CARDS.into_iter().find(named).map(|(_, card)| card);
    let mut driver = start(args, card)?;
    driver.connect()?;
    driver.run_for(args.at);
    if args.hand.is_none() && shows_trials(args) {
        driver.try_grasps();
    }
    if let Some(card) = card {
        driver.open_card(card);
    }
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    for (language, of_language) in chosen(&args.lang, LANGUAGES) {
        for (number, (theme, of_theme)) in chosen(&args.theme, THEMES).iter().enumerate() {
            driver.dress(*theme, language);
            for (name, view) in pictures(args.view) {
                let card = args.card.as_ref();
                let name = card.map_or(name.into(), |card| format!("card-{card}"));
                let picture = driver.picture(view);
                let labels = args.out.join(format!("{name}{of_language}.json"));
                let image = args.out.join(format!("{name}{of_language}{of_theme}.png"));
                png::save(&image, &picture.rgb, picture.size)?;
                out.line(&image.display().to_string())?;
                // The positions do not depend on colours.
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
    if card.is_some_and(SceneCard::needs_built_in) && !scene.endpoint.is_sim() {
        let why = "this dialog is drawn only with the built-in hand, because it writes to the hand";
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
        body: None,
        object: None,
    })
}

/// Trials are run only on a hand that does not move by itself.
fn shows_trials(args: &SnapshotArgs) -> bool {
    let still = matches!(
        args.scenario.unwrap_or_default(),
        Scenario::Idle | Scenario::Rigid | Scenario::Fragile
    );
    still && matches!(args.view, Views::One(View::Tune | View::Compare))
}

/// Names and views of the pictures to draw.
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

fn save_labels(path: &Path, picture: &Picture) -> anyhow::Result<()> {
    let list = serde_json::to_string_pretty(&picture.labels)?;
    fs::write(path, list + "\n").with_context(|| format!("cannot write {}", path.display()))
}

fn known_views() -> String {
    View::ALL.map(View::name).join(", ")
}

fn views_help() -> String {
    let known = known_views();
    format!("A view ({known}), 'window' for the window as it opens, or 'all'")
}

fn views(text: &str) -> Result<Views, String> {
    match text {
        "window" => Ok(Views::Window),
        "all" => Ok(Views::All),
        name => View::by_name(name).map(Views::One).ok_or_else(|| {
            let known = known_views();
            format!("there is no such view: choose {known}, window or all")
        }),
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let size = text.split_once(['x', 'X']);
    let size = size.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    size.filter(|(width, height)| (640..=7680).contains(width) && (400..=4320).contains(height))
        .ok_or_else(|| {
            format!("'{text}' is not a size: write WIDTHxHEIGHT, from 640x400 to 7680x4320")
        })
}

fn scale(text: &str) -> Result<f32, String> {
    number(text, 0.5..=4.0, "a scale: write a number from 0.5 to 4")
}
