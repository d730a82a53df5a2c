//! The window against what is committed in `tests/it/looks`: for each state a list of labels (role, name, value), and a few
//! small pictures with a tolerance.
//!
//! After a wanted change, `RENEW=1 cargo test --test it looks` writes what differs; look at the difference before you commit
//! it. `RENEW=screenshots` draws the README's pictures as well: do that seldom, each one stays in the history for good.

use crate::setup::recorded;
use handscope::app::action::Action;
use handscope::app::hand::hold::HoldAction;
use handscope::app::recordings::RecordingAction;
use handscope::app::settings::{Language, Theme};
use handscope::hand::Moment;
use handscope::motion::hold::HoldClose;
use handscope::poses::starter::starter;
use handscope::shell::headless::canvas::Picture;
use handscope::shell::headless::cards::SceneCard;
use handscope::shell::headless::driver::{Driver, Scene};
use handscope::store::calendar;
use handscope::transport::Endpoint;
use handscope::ui::View;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

const SIZE: (u32, u32) = (1440, 900);
/// The README's pictures are 960 pixels wide.
const README_SCALE: f32 = 2.0 / 3.0;
/// Small pictures have a quarter of the window's width and height.
const SHRINK: usize = 4;
/// What is kept of a channel: few shades make small files, and the tolerance is larger.
const COLOUR_BITS: u8 = 0b1111_0000;
/// A channel of a pixel (0 to 255) may be off by this much.
const CHANNEL_TOLERANCE: u8 = 48;
/// So many pixels of a thousand may be off by more: a number that changed passes, a missing instrument does not.
const PIXELS_OFF_PER_MILLE: usize = 5;
const LISTS_MAX_BYTES: u64 = 300_000;
const PICTURES_MAX: usize = 11;
const PICTURES_MAX_BYTES: u64 = 400_000;
const SCREENSHOTS_MAX: usize = 8;
const SCREENSHOTS_MAX_BYTES: u64 = 1_000_000;

/// When the recordings of the list began, seconds since 1970.
const BEGAN: [u64; 3] = [1_795_248_000, 1_793_692_800, 1_793_520_000];

/// A state of the program from which several views are drawn.
struct Stage {
    scenario: &'static str,
    at_s: u64,
    /// A small series of grasps is run first.
    trials: bool,
    /// The hand holds what is before it.
    holds: bool,
    card: Option<SceneCard>,
    /// Names of the files, and the views.
    shots: &'static [(&'static str, View)],
}

const fn watching(
    scenario: &'static str,
    at_s: u64,
    shots: &'static [(&'static str, View)],
) -> Stage {
    Stage {
        scenario,
        at_s,
        trials: false,
        holds: false,
        card: None,
        shots,
    }
}

const fn card(card: SceneCard, shots: &'static [(&'static str, View)]) -> Stage {
    Stage {
        card: Some(card),
        ..watching("idle", 1, shots)
    }
}

/// The grasp is looked at while it holds; the faults when two drives have one.
const STAGES: [Stage; 9] = [
    watching(
        "grasp",
        3,
        &[
            ("live", View::Live),
            ("touch", View::Touch),
            ("poses", View::Poses),
            ("device", View::Device),
            ("connection", View::Connection),
            ("traffic", View::Traffic),
        ],
    ),
    Stage {
        trials: true,
        ..watching(
            "rigid",
            1,
            &[("tune", View::Tune), ("compare", View::Compare)],
        )
    },
    watching(
        "faults",
        11,
        &[("live-fault", View::Live), ("faults", View::Faults)],
    ),
    card(SceneCard::Reset, &[("card-reset", View::Device)]),
    card(SceneCard::Calibrate, &[("card-calibrate", View::Device)]),
    card(SceneCard::Address, &[("card-address", View::Device)]),
    card(SceneCard::Keep, &[("card-keep", View::Device)]),
    card(SceneCard::Danger, &[("card-danger", View::Device)]),
    Stage {
        scenario: "free",
        ..card(SceneCard::Exhibit, &[("exhibit", View::Live)])
    },
];

/// What has a small picture.
const PICTURES: [&str; 11] = [
    "live",
    "live-light",
    "touch",
    "tune",
    "compare",
    "faults",
    "device-zh",
    "card-danger",
    "exhibit",
    "sessions",
    "replay-zh",
];

/// The pictures of the README.
const SCREENSHOTS: [&str; 5] = ["live", "touch", "tune", "compare", "live-zh-light"];

const DRESSES: [(Theme, Language, &str); 4] = [
    (Theme::Dark, Language::En, ""),
    (Theme::Light, Language::En, "-light"),
    (Theme::Dark, Language::Zh, "-zh"),
    (Theme::Light, Language::Zh, "-zh-light"),
];

/// The built-in hand in a dark, English window.
fn scene(scenario: &str, scale: f32) -> Scene {
    Scene {
        endpoint: Endpoint::Sim {
            seed: 1,
            scenario: scenario.into(),
            body: None,
            object: None,
        },
        size: SIZE,
        scale,
        theme: Theme::Dark,
        language: Language::En,
    }
}

/// Draws a stage in each dress, and calls `take` with each name that it wants.
fn draw(
    stage: &Stage,
    scale: f32,
    wants: impl Fn(&str) -> bool,
    mut take: impl FnMut(String, &Picture),
) {
    let named = |name: &str, of_dress: &str| format!("{name}{of_dress}");
    let scene = scene(stage.scenario, scale);
    let mut driver = match stage.card.and_then(SceneCard::line) {
        Some(line) => Driver::start_on_line(&scene, line).unwrap(),
        None => Driver::start(&scene).unwrap(),
    };
    driver.connect().unwrap();
    driver.run_for(Duration::from_secs(stage.at_s));
    if stage.trials {
        driver.try_grasps();
    }
    if stage.holds {
        hold(&mut driver);
    }
    if let Some(card) = stage.card {
        driver.open_card(card);
    }
    for (theme, language, of_dress) in DRESSES {
        driver.dress(theme, language);
        for (name, view) in stage.shots {
            let name = named(name, of_dress);
            if wants(&name) {
                take(name, &driver.picture(*view));
            }
        }
    }
}

/// A person arms the hand and lets it hold what is before it.
fn hold(driver: &mut Driver) {
    let pose = starter().pose_named("Power grasp").unwrap();
    let close = HoldClose::To(pose.targets());
    for action in [Action::Arm, Action::Hold(HoldAction::Start(close))] {
        driver.act(action);
        driver.run_for(Duration::from_millis(300));
    }
    driver.run_for(Duration::from_secs(20));
}

/// Draws the view of sessions, and one of them replayed, in each dress.
fn draw_sessions(wants: impl Fn(&str) -> bool, mut take: impl FnMut(String, &Picture)) {
    let folder = tempfile::tempdir().unwrap();
    let [_, faulty, _] = recorded::three(folder.path());
    let scene = Scene {
        endpoint: Endpoint::sim(),
        size: SIZE,
        scale: 1.0,
        theme: Theme::Dark,
        language: Language::En,
    };
    let mut driver = Driver::start(&scene).unwrap();
    driver.connect().unwrap();
    let now = driver.now();
    let choose = RecordingAction::ChooseFolder(Some(folder.path().into()));
    driver
        .desktop_app()
        .app()
        .act(Action::Recording(choose), now);
    driver.run_for(Duration::from_secs(2));
    assert_eq!(driver.desktop_app().state().recordings.items.len(), 3);
    let mut shoot = |driver: &mut Driver, name: &str, view| {
        for (theme, language, of_dress) in DRESSES {
            let name = format!("{name}{of_dress}");
            if wants(&name) {
                driver.dress(theme, language);
                let mut picture = driver.picture(view);
                let labels = picture.labels.to_string();
                let mut labels = labels.replace(folder.path().to_str().unwrap(), "FOLDER");
                // The list is the same in every time zone.
                for since_1970 in BEGAN.map(Duration::from_secs) {
                    let (day, time) = calendar::local(since_1970);
                    let utc = calendar::stamp(since_1970).replace('T', " ");
                    labels = labels.replace(&format!("{day} {time}"), &utc[..16]);
                }
                picture.labels = labels.parse().unwrap();
                take(name, &picture);
            }
        }
    };
    shoot(&mut driver, "sessions", View::Recordings);
    let stretch = [10, 20].map(|second| Moment::from_micros(second * 1_000_000));
    driver.replay(faulty, stretch.into()).unwrap();
    shoot(&mut driver, "replay", View::Live);
}

/// A small picture: RGB, row by row.
#[derive(PartialEq)]
struct Small {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Small {
    /// Each pixel is the mean of a square of pixels.
    fn of(picture: &Picture) -> Self {
        let wide = usize::try_from(picture.size.0).unwrap();
        let (width, height) = (
            wide / SHRINK,
            usize::try_from(picture.size.1).unwrap() / SHRINK,
        );
        let mut rgb = Vec::with_capacity(width * height * 3);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            for channel in 0..3 {
                let square = (0..SHRINK * SHRINK).map(|at| {
                    let (row, column) = (y * SHRINK + at / SHRINK, x * SHRINK + at % SHRINK);
                    usize::from(picture.rgb[(row * wide + column) * 3 + channel])
                });
                let mean = square.sum::<usize>() / (SHRINK * SHRINK);
                rgb.push(u8::try_from(mean).unwrap() & COLOUR_BITS);
            }
        }
        Self { width, height, rgb }
    }

    fn read(path: &Path) -> Option<Self> {
        let file = std::io::BufReader::new(fs::File::open(path).ok()?);
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        let (width, height) = (
            info.width.try_into().unwrap(),
            info.height.try_into().unwrap(),
        );
        Some(Self { width, height, rgb })
    }

    /// Pixels of a thousand that are off, rounded up; all of them where the sizes differ.
    fn off_per_mille(&self, other: &Self) -> usize {
        if (self.width, self.height) != (other.width, other.height) {
            return 1000;
        }
        let pairs = self.rgb.chunks_exact(3).zip(other.rgb.chunks_exact(3));
        let off = |(a, b): &(&[u8], &[u8])| {
            a.iter()
                .zip(*b)
                .any(|(a, b)| a.abs_diff(*b) > CHANNEL_TOLERANCE)
        };
        (pairs.filter(off).count() * 1000).div_ceil(self.width * self.height)
    }
}

fn write_png(path: &Path, rgb: &[u8], (width, height): (usize, usize)) {
    let (width, height) = (width.try_into().unwrap(), height.try_into().unwrap());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(rgb).unwrap();
    writer.finish().unwrap();
    fs::write(path, bytes).unwrap();
}

/// One line for each thing on screen: role, name, value, and whether it is on or disabled. Of a view behind a dialog
/// nothing: it has a list of its own.
fn list(labels: &Value) -> String {
    let all = labels.as_array().unwrap();
    let is_dialog = |entry: &Value| entry["role"].as_str().unwrap().ends_with("dialog");
    let front = all.iter().position(is_dialog).unwrap_or_default();
    let mut text = String::new();
    for entry in &all[front..] {
        let word = |key: &str| match &entry[key] {
            Value::Null => String::new(),
            Value::String(word) => word.trim().replace('\n', "\\n"),
            // Noise in the last digits of a number is no change.
            number => format!(
                "{}",
                (number.as_f64().unwrap_or_default() * 1e3).round() / 1e3
            ),
        };
        let _written = write!(text, "{} \"{}\"", word("role"), word("name"));
        let value = word("value");
        if !value.is_empty() {
            let _written = write!(text, " = {value}");
        }
        text.push_str(match &entry["toggled"] {
            Value::Bool(true) => ", on",
            Value::Bool(false) => ", off",
            _ => "",
        });
        text.push_str(if entry["disabled"] == true {
            ", disabled\n"
        } else {
            "\n"
        });
    }
    text
}

/// Lines that only one of two texts has, at most so many as a person reads.
fn difference(committed: &str, drawn: &str) -> String {
    let mut count: BTreeMap<&str, i32> = BTreeMap::new();
    drawn
        .lines()
        .for_each(|line| *count.entry(line).or_default() += 1);
    committed
        .lines()
        .for_each(|line| *count.entry(line).or_default() -= 1);
    let sides = count.iter().filter(|(_, more)| **more != 0);
    let lines = sides.map(|(line, more)| format!("  {} {line}", if *more > 0 { '+' } else { '-' }));
    let lines: Vec<String> = lines.take(12).collect();
    if lines.is_empty() {
        "  the same lines in another order".into()
    } else {
        lines.join("\n")
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &str, kind: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == kind));
    files.sort();
    files
}

fn bytes(files: &[PathBuf]) -> u64 {
    files
        .iter()
        .map(|path| fs::metadata(path).unwrap().len())
        .sum()
}

fn renews() -> bool {
    std::env::var_os("RENEW").is_some()
}

/// Compares a file with what it should be; writes it instead if it is to be renewed.
fn check_list(path: &Path, drawn: &str, wrong: &mut Vec<String>) {
    let committed = fs::read_to_string(path).unwrap_or_default();
    if committed == drawn {
        return;
    }
    if renews() {
        return fs::write(path, drawn).unwrap();
    }
    wrong.push(format!(
        "{}:\n{}",
        path.display(),
        difference(&committed, drawn)
    ));
}

fn check_picture(path: &Path, drawn: &Small, wrong: &mut Vec<String>) {
    let off = Small::read(path).map_or(1000, |committed| committed.off_per_mille(drawn));
    if off <= PIXELS_OFF_PER_MILLE {
        return;
    }
    if renews() {
        return write_png(path, &drawn.rgb, (drawn.width, drawn.height));
    }
    let other = std::env::temp_dir().join(format!("drawn-{}", path.file_name().unwrap().display()));
    write_png(&other, &drawn.rgb, (drawn.width, drawn.height));
    wrong.push(format!(
        "{}: {off} pixels of a thousand differ; drawn now: {}",
        path.display(),
        other.display()
    ));
}

#[test]
fn the_window_looks_as_it_is_committed() {
    let folder = root().join("tests/it/looks");
    fs::create_dir_all(&folder).unwrap();
    let (mut wrong, mut names) = (Vec::new(), Vec::new());
    // Colours change no label.
    let wants = |name: &str| !name.ends_with("-light") || PICTURES.contains(&name);
    let mut take = |name: String, picture: &Picture| {
        if !name.ends_with("-light") {
            let path = folder.join(format!("{name}.txt"));
            check_list(&path, &list(&picture.labels), &mut wrong);
            names.push(path);
        }
        if PICTURES.contains(&name.as_str()) {
            let path = folder.join(format!("{name}.png"));
            check_picture(&path, &Small::of(picture), &mut wrong);
            names.push(path);
        }
    };
    for stage in &STAGES {
        draw(stage, 1.0, wants, &mut take);
    }
    draw_sessions(wants, &mut take);
    for kind in ["txt", "png"] {
        for path in files("tests/it/looks", kind)
            .iter()
            .filter(|path| !names.contains(path))
        {
            if renews() {
                fs::remove_file(path).unwrap();
            } else {
                wrong.push(format!("{}: nothing draws this any more", path.display()));
            }
        }
    }
    check_sizes();
    assert!(
        wrong.is_empty(),
        "{}\n\nIf that is wanted: RENEW=1 cargo test --test it looks",
        wrong.join("\n")
    );
}

#[test]
fn the_readme_has_few_small_pictures() {
    let folder = root().join("screenshots");
    if std::env::var("RENEW").is_ok_and(|what| what == "screenshots") {
        let held = Stage {
            holds: true,
            ..watching("idle", 3, &[("live", View::Live)])
        };
        for stage in STAGES.iter().chain([&held]) {
            let wants = |name: &str| SCREENSHOTS.contains(&name);
            draw(stage, README_SCALE, wants, |name, picture| {
                let size = (picture.size.0 as usize, picture.size.1 as usize);
                write_png(&folder.join(format!("{name}.png")), &picture.rgb, size);
            });
        }
    }
    let pictures = files("screenshots", "png");
    assert_eq!(
        fs::read_dir(&folder).unwrap().count(),
        pictures.len(),
        "pictures only"
    );
    assert!(
        pictures.len() <= SCREENSHOTS_MAX,
        "{} pictures",
        pictures.len()
    );
    assert!(
        bytes(&pictures) <= SCREENSHOTS_MAX_BYTES,
        "{} bytes",
        bytes(&pictures)
    );
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    for path in pictures {
        let name = path.file_name().unwrap().display().to_string();
        assert!(
            readme.contains(&format!("(screenshots/{name})")),
            "README.md does not show {name}"
        );
    }
}

fn check_sizes() {
    let (lists, pictures) = (
        files("tests/it/looks", "txt"),
        files("tests/it/looks", "png"),
    );
    assert!(
        bytes(&lists) <= LISTS_MAX_BYTES,
        "{} bytes of lists",
        bytes(&lists)
    );
    assert!(
        pictures.len() <= PICTURES_MAX,
        "{} pictures",
        pictures.len()
    );
    assert!(
        bytes(&pictures) <= PICTURES_MAX_BYTES,
        "{} bytes of pictures",
        bytes(&pictures)
    );
}

#[test]
fn a_missing_instrument_is_off_and_a_changed_number_is_not() {
    let flat = |width: usize, height: usize| Small {
        width,
        height,
        rgb: vec![20; width * height * 3],
    };
    let painted = |count: usize, colour: u8| {
        let mut small = flat(480, 300);
        small.rgb[..count * 3].fill(colour);
        small
    };
    let plain = flat(480, 300);
    for (other, passes) in [
        (painted(0, 0), true),
        (painted(480 * 300, 20 + CHANNEL_TOLERANCE), true),
        (painted(60, 255), true),
        (painted(1000, 255), false),
        (flat(480, 301), false),
    ] {
        assert_eq!(plain.off_per_mille(&other) <= PIXELS_OFF_PER_MILLE, passes);
    }
}

/// Number of areas in the colour of a main button, each as large as a small button.
fn main_buttons(picture: &Picture) -> usize {
    const MAIN: [u8; 3] = [0x4C, 0x9B, 0xFF];
    const BUTTON_PIXELS: usize = 800;
    let wide = usize::try_from(picture.size.0).unwrap();
    let mut is_main: Vec<bool> = (picture.rgb.chunks_exact(3))
        .map(|pixel| pixel == MAIN)
        .collect();
    let mut buttons = 0;
    while let Some(start) = is_main.iter().position(|is_main| *is_main) {
        let mut open = vec![start];
        let mut area = 0;
        while let Some(at) = open.pop() {
            if std::mem::take(&mut is_main[at]) {
                area += 1;
                let near = [
                    at.checked_sub(wide),
                    at.checked_sub(1),
                    Some(at + 1),
                    Some(at + wide),
                ];
                open.extend(near.into_iter().flatten().filter(|at| *at < is_main.len()));
            }
        }
        buttons += usize::from(area >= BUTTON_PIXELS);
    }
    buttons
}

#[test]
fn no_view_has_two_main_buttons() {
    let mut driver = Driver::start(&scene("rigid", 1.0)).unwrap();
    driver.connect().unwrap();
    let check = |driver: &mut Driver, when: &str| {
        let counts = View::ALL.map(|view| (view.name(), main_buttons(&driver.picture(view))));
        for (name, buttons) in counts {
            assert!(buttons <= 1, "{name} has {buttons} main buttons {when}");
        }
        counts
    };
    let counts = check(&mut driver, "at rest");
    // The measure sees the buttons.
    assert!(counts.contains(&("live", 1)) && counts.contains(&("tune", 1)));
    driver.try_grasps();
    check(&mut driver, "after trials");
}
