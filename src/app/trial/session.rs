//! A series of trials in a folder of its own, readable without this program. Never writes over another session.
//!
//! | file | what |
//! |---|---|
//! | `session.toml` | what was planned, the hand, and for each trial its setting and what was measured ([`SessionFile`]) |
//! | `trial-001.csv` … | what was read, [`crate::app::trial::recording::Recording::csv`]: `time_s` from the closing command, an empty cell where nothing was read |
//! | `report.html` | all of it for a person, in one file without links ([`crate::app::trial::report`]) |
//!
//! Each file is whole at any moment: it is written beside its place and then put there. After each trial the session is
//! complete up to it. A value that is not known has no key in TOML. Keys of a later version survive.

use crate::app::calendar::day;
use crate::app::quirk_sheet::QuirkSheet;
use crate::app::trial::best::{Criterion, scores};
use crate::app::trial::metrics::JointMetrics;
use crate::app::trial::plan::{Approach, TrialPlan, Until};
use crate::app::trial::report;
use crate::app::trial::series::{Kind, Trial};
use crate::app::trial::watch::Abort;
use crate::hand::{Angle, Dof, PerDof};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What a session says it is.
pub const FORMAT: &str = "handscope-trials";
/// The version that is written, and the newest that is read.
pub const VERSION: i64 = 1;
/// A thousand trials of six joints are a tenth of this; anything longer is not ours.
const FILE_LEN_MAX: u64 = 64 * 1024 * 1024;
/// The names of the files.
pub const SESSION_FILE: &str = "session.toml";
const REPORT_FILE: &str = "report.html";

/// What is known before the first trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Head {
    /// The endpoint.
    pub hand: String,
    /// Whether it is the built-in hand.
    pub simulated: bool,
    /// When it began, since 1970.
    pub begun: Duration,
    /// In the words of a person.
    pub note: String,
    /// Words to find it by.
    pub tags: Vec<String>,
    /// What was found about the hand.
    pub quirks: Option<QuirkSheet>,
}

/// `session.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionFile {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: i64,
    /// The endpoint.
    pub hand: String,
    /// Whether it is the built-in hand.
    pub simulated: bool,
    /// Day of its beginning, `2026-11-21`, in universal time.
    pub day: String,
    /// Its beginning, seconds since 1970.
    pub begun_unix_s: u64,
    /// In the words of a person.
    #[serde(default)]
    pub note: String,
    /// Words to find it by.
    #[serde(default)]
    pub tags: Vec<String>,
    /// Why it ended early.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aborted: Option<String>,
    /// What was planned.
    pub plan: PlanRow,
    /// What was found about the hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quirks: Option<QuirkSheet>,
    /// The trials in their order.
    #[serde(default, rename = "trial", skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<TrialRow>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

/// A plan as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanRow {
    /// Speeds at the contact.
    pub speeds: Vec<i16>,
    /// Force thresholds, g.
    pub forces_g: Vec<i16>,
    /// Trials of each setting.
    pub repeats: usize,
    /// Time held, s.
    pub dwell_s: f64,
    /// Time between, s.
    pub rest_s: f64,
    /// Force that ends it, g.
    pub ceiling_g: i16,
    /// Temperature that ends it, °C.
    pub stop_c: u8,
    /// Temperature below which a trial begins, °C.
    pub start_c: u8,
    /// Speed of the fast stage; not there with one stage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fast_speed: Option<i16>,
    /// `angle`, `measured`, `proximity` or `touch_g`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<String>,
    /// Its number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_value: Option<i32>,
    /// Where joints stand before.
    pub start: BTreeMap<String, i16>,
    /// Where joints close to.
    pub close: BTreeMap<String, i16>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

/// One trial as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialRow {
    /// 1 the first.
    pub number: usize,
    /// `probe` or `trial`.
    pub kind: String,
    /// How often this setting was tried, this one included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<usize>,
    /// Speed at the contact.
    pub speed: i16,
    /// Force threshold, g.
    pub force_threshold_g: i16,
    /// Why it ended early.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aborted: Option<String>,
    /// The file of its samples.
    pub samples: String,
    /// Rows in it that hold readings.
    pub rows: usize,
    /// Rows that had no place.
    pub rows_lost: u64,
    /// What was measured, joint by joint.
    #[serde(default, rename = "joint", skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<JointMetrics>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

fn named(angles: &PerDof<Option<Angle>>) -> BTreeMap<String, i16> {
    let known =
        |(dof, angle): (Dof, &Option<Angle>)| Some((dof.name().to_owned(), (*angle)?.get()));
    angles.iter().filter_map(known).collect()
}

impl PlanRow {
    /// Of a plan.
    #[must_use]
    pub fn of(plan: &TrialPlan) -> Self {
        let (fast_speed, until) = match plan.approach {
            Approach::OneStage => (None, None),
            Approach::TwoStage { fast, until } => (Some(fast.get()), Some(until)),
        };
        let until = until.map(|until| match until {
            Until::Angle(angle) => ("angle", i32::from(angle.get())),
            Until::Measured { margin } => ("measured", i32::from(margin)),
            Until::Proximity(counts) => ("proximity", counts),
            Until::Touch(force) => ("touch_g", i32::from(force.get())),
        });
        Self {
            speeds: plan.grid.speeds.iter().map(|speed| speed.get()).collect(),
            forces_g: plan.grid.forces.iter().map(|force| force.get()).collect(),
            repeats: plan.grid.repeats,
            dwell_s: plan.dwell.as_secs_f64(),
            rest_s: plan.grid.rest.as_secs_f64(),
            ceiling_g: plan.limits.ceiling_g,
            stop_c: plan.limits.stop_c,
            start_c: plan.limits.start_c,
            fast_speed,
            until: until.map(|(name, _)| name.into()),
            until_value: until.map(|(_, value)| value),
            start: named(&plan.start),
            close: named(&plan.close),
            others: toml::Table::new(),
        }
    }
}

impl TrialRow {
    fn of(trial: &Trial) -> Self {
        let (kind, repeat) = match trial.kind {
            Kind::Probe => ("probe", None),
            Kind::Trial { repeat } => ("trial", Some(repeat)),
        };
        Self {
            number: trial.number,
            kind: kind.into(),
            repeat,
            speed: trial.setting.speed.get(),
            force_threshold_g: trial.setting.force.get(),
            aborted: trial.aborted.map(|why| why.to_string()),
            samples: samples_file(trial.number),
            rows: trial.recording.rows().len(),
            rows_lost: trial.recording.lost(),
            joints: trial.metrics.joints.clone(),
            others: toml::Table::new(),
        }
    }
}

fn samples_file(number: usize) -> String {
    format!("trial-{number:03}.csv")
}

/// A session that is being kept.
#[derive(Debug)]
pub struct Keeper {
    folder: PathBuf,
    file: SessionFile,
    page: report::Page,
    bare: Vec<Trial>,
    criterion: Option<Criterion>,
}

impl Keeper {
    /// Makes the folder and writes what is known before the first trial.
    ///
    /// # Errors
    /// What the system says; a folder that holds anything is not taken.
    pub fn create(
        folder: &Path,
        head: &Head,
        plan: &TrialPlan,
        criterion: Option<Criterion>,
    ) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        if std::fs::read_dir(folder)?.next().is_some() {
            let kind = io::ErrorKind::AlreadyExists;
            return Err(io::Error::new(kind, "the folder is not empty"));
        }
        let keeper = Self {
            folder: folder.to_owned(),
            file: SessionFile {
                format: FORMAT.into(),
                version: VERSION,
                hand: head.hand.clone(),
                simulated: head.simulated,
                day: day(head.begun),
                begun_unix_s: head.begun.as_secs(),
                note: head.note.clone(),
                tags: head.tags.clone(),
                aborted: None,
                plan: PlanRow::of(plan),
                quirks: head.quirks.clone(),
                trials: Vec::new(),
                others: toml::Table::new(),
            },
            page: report::Page::default(),
            bare: Vec::new(),
            criterion,
        };
        keeper.write_session()?;
        Ok(keeper)
    }

    /// Keeps one trial.
    ///
    /// # Errors
    /// What the system says.
    pub fn keep(&mut self, trial: &Trial) -> io::Result<()> {
        let samples = self.folder.join(samples_file(trial.number));
        put(&samples, trial.recording.csv().as_bytes())?;
        self.page.add(trial);
        self.file.trials.push(TrialRow::of(trial));
        self.bare.push(Trial {
            recording: crate::app::trial::recording::Recording::default(),
            ..trial.clone()
        });
        self.write_session()
    }

    /// Says how it ended and writes the report.
    ///
    /// # Errors
    /// What the system says.
    pub fn close(mut self, aborted: Option<Abort>) -> io::Result<()> {
        self.file.aborted = aborted.map(|why| why.to_string());
        self.write_session()?;
        let scores = scores(&self.bare);
        let text = self.page.text(&self.file, &scores, self.criterion);
        put(&self.folder.join(REPORT_FILE), text.as_bytes())
    }

    fn write_session(&self) -> io::Result<()> {
        let text = toml::to_string(&self.file).map_err(io::Error::other)?;
        put(&self.folder.join(SESSION_FILE), text.as_bytes())
    }
}

/// Reads a session's `session.toml`.
///
/// # Errors
/// What the system or the reader of the format says; another format, or a later version.
pub fn load(folder: &Path) -> io::Result<SessionFile> {
    let path = folder.join(SESSION_FILE);
    if std::fs::metadata(&path)?.len() > FILE_LEN_MAX {
        return Err(io::Error::other("the file is too long for a session"));
    }
    let text = std::fs::read_to_string(&path)?;
    let file: SessionFile = toml::from_str(&text).map_err(io::Error::other)?;
    if file.format != FORMAT || file.version > VERSION {
        let what = format!("format {} version {}", file.format, file.version);
        return Err(io::Error::other(format!("{what} cannot be read")));
    }
    Ok(file)
}

/// Writes a file beside its place and puts it there when it is whole.
fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let new = path.with_extension("new");
    let mut file = std::fs::File::create(&new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    drop(file);
    std::fs::rename(&new, path)
}
