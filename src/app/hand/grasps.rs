//! The grasps of the pose library, and which of them a slot's hand confirmed: read when the hand is opened, and stored when one is saved
//! or confirmed, off the window's thread.

use crate::app::env::Ctx;
use crate::app::notices::NoticeKind;
use crate::hand::{Force, PerDof};
use crate::motion::grasp::confirm::Agreement;
use crate::motion::grasp::confirmed_file::{self, Confirmed};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::file::{self, EXTENSION};
use crate::motion::grasp::run::Unconfirmed;
use crate::motion::grasp::saved::Grasp;
use crate::store::calendar::{day, since_1970};
use crate::store::{FileError, JobKind, Jobs, on_thread};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};

/// Number of grasps that are read; more than a popup can show.
const GRASPS_MAX: usize = 50;

/// Grasps for one hand.
#[derive(Debug, Default)]
pub struct HandGrasps {
    of: Option<Endpoint>,
    all: Vec<Grasp>,
    confirmed: Vec<Confirmed>,
    jobs: Jobs<GraspsJob>,
}

/// Reading or keeping the files; one at a time.
#[derive(Debug, PartialEq, Eq)]
struct GraspsJob;

impl JobKind for GraspsJob {
    type State = HandGrasps;
    type Ctx<'a> = Ctx<'a>;
}

/// What the files hold, and those that could not be read.
struct GraspsRead {
    all: Vec<Grasp>,
    confirmed: io::Result<Vec<Confirmed>>,
    refused: Vec<(PathBuf, FileError)>,
}

/// Something to store before the files are read again.
enum Kept {
    New(Box<Grasp>),
    Confirmed(Box<Grasp>, Agreement),
}

/// A grasp that a hold repeats on this hand.
#[derive(Debug, Clone)]
pub(crate) struct RepeatedGrasp {
    pub(crate) grasp: Grasp,
    /// Reading of each joint for one gram of its forces.
    pub(crate) reading_per_g: PerDof<f64>,
    /// What the hand confirms first.
    pub(crate) unconfirmed: Option<Unconfirmed>,
}

/// A grasp for display.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownGrasp {
    /// Its name.
    pub name: String,
    /// The hand that made it.
    pub hand: String,
    /// Its forces, g of that hand.
    pub at_least: Force,
    /// As [`at_least`](Self::at_least).
    pub at_most: Force,
    /// Whether this hand may use it.
    pub state: GraspState,
}

/// Use of a grasp on this hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GraspState {
    /// It was made here.
    Own,
    /// This hand confirmed it.
    Trusted,
    /// This hand confirms it first.
    New,
    /// It cannot be confirmed.
    Doubted(GraspDoubt),
}

impl HandGrasps {
    /// All grasps as they are shown, with these newtons for a gram of the hand's joints.
    pub fn shown(&self, newtons: PerDof<Option<f64>>) -> Vec<ShownGrasp> {
        let shown = self.all.iter().map(|grasp| ShownGrasp {
            name: grasp.name.clone(),
            hand: grasp.hand.to_string(),
            at_least: grasp.forces.at_least(),
            at_most: grasp.forces.at_most(),
            state: match self.repeated(grasp, newtons) {
                Err(doubt) => GraspState::Doubted(doubt),
                Ok(own) if own.unconfirmed.is_some() => GraspState::New,
                Ok(_) if self.is_own(grasp) => GraspState::Own,
                Ok(_) => GraspState::Trusted,
            },
        });
        shown.collect()
    }

    fn is_own(&self, grasp: &Grasp) -> bool {
        self.of.as_ref().is_some_and(|hand| grasp.is_of(hand))
    }

    /// All grasps of the library, by name.
    pub fn all(&self) -> &[Grasp] {
        &self.all
    }

    /// How this hand would repeat a grasp.
    ///
    /// # Errors
    /// [`GraspDoubt`]: its forces cannot be converted for this hand.
    pub(crate) fn repeated(
        &self,
        grasp: &Grasp,
        newtons: PerDof<Option<f64>>,
    ) -> Result<RepeatedGrasp, GraspDoubt> {
        let is_own = self.is_own(grasp);
        let reading_per_g = match is_own {
            true => grasp.reading_per_g(),
            false => grasp.reading_per_g_on(&newtons)?,
        };
        let is_trusted = is_own || confirmed_file::of(&self.confirmed, grasp).is_some();
        let grasp = grasp.clone();
        let unconfirmed = (!is_trusted).then(|| Unconfirmed {
            grasp: grasp.clone(),
            newtons,
        });
        Ok(RepeatedGrasp {
            grasp,
            reading_per_g,
            unconfirmed,
        })
    }

    /// Switches to this hand if it changed.
    pub(crate) fn tick(&mut self, endpoint: Option<&Endpoint>, ctx: &mut Ctx<'_>) {
        if self.of.as_ref() != endpoint {
            *self = Self {
                of: endpoint.cloned(),
                ..Self::default()
            };
            self.store(None, ctx);
        }
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
    }

    /// Saves a grasp as a new file of the library.
    pub(crate) fn save(&mut self, grasp: Grasp, ctx: &Ctx<'_>) {
        self.store(Some(Kept::New(Box::new(grasp))), ctx);
    }

    /// Stores that this hand confirmed a grasp.
    pub(crate) fn confirm(&mut self, grasp: Grasp, agreement: Agreement, ctx: &Ctx<'_>) {
        self.store(Some(Kept::Confirmed(Box::new(grasp), agreement)), ctx);
    }

    fn store(&mut self, kept: Option<Kept>, ctx: &Ctx<'_>) {
        let Some((settings, hand)) = ctx.env.settings_path.clone().zip(self.of.clone()) else {
            return;
        };
        let folder = file::folder_of(&settings);
        let work = on_thread(move || {
            keep(kept, &settings, &hand)?;
            Ok(read(&settings, &hand))
        });
        let background = ctx.env.background();
        self.jobs
            .start(GraspsJob, background, work, move |own, ctx, known| {
                own.apply(known, folder, ctx);
            });
    }

    fn apply(&mut self, known: io::Result<GraspsRead>, folder: PathBuf, ctx: &mut Ctx<'_>) {
        let read = match known {
            Ok(read) => read,
            Err(error) => return ctx.notify(NoticeKind::not_saved(folder, &error)),
        };
        self.all = read.all;
        for (path, error) in read.refused {
            ctx.notify(NoticeKind::FileRefused { path, error });
        }
        match read.confirmed {
            Ok(confirmed) => self.confirmed = confirmed,
            Err(error) => ctx.notify(NoticeKind::not_saved(folder, &error)),
        }
    }
}

fn keep(kept: Option<Kept>, settings: &Path, hand: &Endpoint) -> io::Result<()> {
    match kept {
        None => Ok(()),
        Some(Kept::New(grasp)) => file::save(&file::library_file(settings, &grasp.name), &grasp),
        Some(Kept::Confirmed(grasp, agreement)) => {
            let Some(file) = confirmed_file::file_of(settings, hand) else {
                return Ok(());
            };
            let today = day(since_1970());
            confirmed_file::add(&file, &grasp, agreement, &today).map(|_all| ())
        }
    }
}

fn read(settings: &Path, hand: &Endpoint) -> GraspsRead {
    let (mut all, mut refused) = (Vec::new(), Vec::new());
    let entries = std::fs::read_dir(file::folder_of(settings));
    let entries = entries.into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| is_grasp(path)).collect();
    paths.sort();
    for path in paths.into_iter().take(GRASPS_MAX) {
        match file::read_file(&path) {
            Ok(grasp) => all.push(grasp),
            Err(error) => refused.push((path, error)),
        }
    }
    let confirmed = confirmed_file::file_of(settings, hand);
    GraspsRead {
        all,
        confirmed: confirmed.map_or(Ok(Vec::new()), |file| confirmed_file::read(&file)),
        refused,
    }
}

fn is_grasp(path: &Path) -> bool {
    path.to_string_lossy().ends_with(EXTENSION)
}
