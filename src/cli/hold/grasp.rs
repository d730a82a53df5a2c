//! Grasps on the command line: the file that is saved after a hold that worked, the one that a hold repeats, and the user's word in a
//! confirmation.

use crate::app::files::settings_file;
use crate::cli::consent::{self, ConsentFrom, NoConsent};
use crate::cli::out::file::{check_folder, check_new_file, taken};
use crate::cli::out::{WrongUsage, notify};
use crate::hand::PerDof;
use crate::motion::grasp::confirm::Agreement;
use crate::motion::grasp::confirmed_file;
use crate::motion::grasp::file::{self, EXTENSION, NOTE_CHARS_MAX, is_note};
use crate::motion::grasp::run::{Confirming, Unconfirmed};
use crate::motion::grasp::saved::{Grasp, GraspClaim};
use crate::poses::library::{NAME_CHARS_MAX, clean};
use crate::store::calendar::{day, since_1970};
use crate::transport::Endpoint;
use crate::trials::session;
use anyhow::{Context as _, anyhow, bail};
use futures::{Stream, stream};
use serde::Serialize;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use tokio::sync::watch;

/// Where a grasp is: in the pose library, by its name, or in a file.
#[derive(Debug, Clone)]
pub(crate) enum GraspPlace {
    Library(String),
    File(PathBuf),
}

/// Parses a place: what ends as a grasp file is one, everything else is a name.
pub(crate) fn grasp_place(text: &str) -> Result<GraspPlace, String> {
    let is_file = text.ends_with(EXTENSION);
    let named = Path::new(text).file_name();
    let has_name = named.is_some_and(|name| name != EXTENSION);
    if is_file && has_name {
        return Ok(GraspPlace::File(text.into()));
    }
    if is_file || text.is_empty() || clean(text) != text || text.contains(['/', '\\']) {
        return Err(format!(
            "write a name of 1 to {NAME_CHARS_MAX} characters for the pose library, or a file that ends in {EXTENSION}"
        ));
    }
    Ok(GraspPlace::Library(text.into()))
}

/// Parses a note.
pub(crate) fn note(text: &str) -> Result<String, String> {
    let fits = is_note(text).then(|| text.to_owned());
    fits.ok_or_else(|| format!("write at most {NOTE_CHARS_MAX} characters on one line"))
}

impl GraspPlace {
    fn path(&self) -> anyhow::Result<PathBuf> {
        match self {
            Self::File(path) => Ok(path.clone()),
            Self::Library(name) => {
                let settings = settings_file::default_path();
                let settings = settings.context("no home folder with a pose library")?;
                Ok(file::library_file(&settings, name))
            }
        }
    }

    /// Name of the grasp that is saved here.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Library(name) => name.clone(),
            Self::File(path) => {
                let name = path.file_name().map(|name| name.to_string_lossy());
                let name = name.unwrap_or_default();
                let name = clean(name.strip_suffix(EXTENSION).unwrap_or(&name));
                if name.is_empty() {
                    "grasp".into()
                } else {
                    name
                }
            }
        }
    }

    /// Checks that it can be saved and overwrites nothing, before the hand moves.
    pub(crate) fn free(&self) -> anyhow::Result<PathBuf> {
        let path = self.path()?;
        check_new_file(&path, "--save")?;
        if matches!(self, Self::File(_)) {
            check_folder(&path, "--save")?;
        }
        Ok(path)
    }
}

/// Why a grasp may be used on a hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Trust {
    /// It was made on this hand.
    SameHand,
    /// This hand confirmed it.
    Confirmed,
    /// This hand confirms it first.
    NotConfirmed,
}

/// A grasp that a hold repeats.
pub(crate) struct ChosenGrasp {
    pub(crate) grasp: Grasp,
    pub(crate) trust: Trust,
    /// Reading of each joint of this hand for one gram of its forces.
    pub(crate) reading_per_g: PerDof<f64>,
    newtons: PerDof<Option<f64>>,
}

impl ChosenGrasp {
    /// Reads it, and finds out whether this hand may use it.
    ///
    /// # Errors
    /// The file is wrong, or its forces cannot be converted for this hand.
    pub(crate) fn read(
        place: &GraspPlace,
        hand: &Endpoint,
        newtons: PerDof<Option<f64>>,
    ) -> anyhow::Result<Self> {
        let path = place.path()?;
        if let (GraspPlace::Library(name), false) = (place, path.exists()) {
            return Err(WrongUsage::error(format!(
                "there is no grasp '{name}' in the pose library: 'handscope hold --save NAME' stores one"
            )));
        }
        let grasp = file::read_file(&path)
            .map_err(|error| anyhow!("the grasp {} cannot be used: {error}", path.display()))?;
        let (trust, reading_per_g) = if grasp.is_of(hand) {
            (Trust::SameHand, grasp.reading_per_g())
        } else {
            let reading_per_g = grasp.reading_per_g_on(&newtons).map_err(|doubt| {
                anyhow!(
                    "nothing was moved: '{}' was made on {}, and cannot be confirmed here: {doubt}",
                    grasp.name,
                    grasp.hand
                )
            })?;
            (trust(hand, &grasp)?, reading_per_g)
        };
        Ok(Self {
            grasp,
            trust,
            reading_per_g,
            newtons,
        })
    }

    /// What the hand confirms before it is trusted.
    pub(crate) fn unconfirmed(&self) -> Option<Unconfirmed> {
        (self.trust == Trust::NotConfirmed).then(|| Unconfirmed {
            grasp: self.grasp.clone(),
            newtons: self.newtons,
        })
    }

    /// Stores that the hand confirmed it.
    pub(crate) fn keep(&mut self, hand: &Endpoint, agreement: Agreement) {
        self.trust = Trust::Confirmed;
        let Some(file) = confirmed(hand) else {
            return;
        };
        let today = day(since_1970());
        if let Err(error) = confirmed_file::add(&file, &self.grasp, agreement, &today) {
            notify(&format!(
                "warning: the confirmation is not stored in {}: {error}",
                file.display()
            ));
        }
    }
}

/// A close that waits for the user to say that the object stands; `None` while none does.
pub(crate) type AskedClose = Option<Confirming>;

/// The user's word that the object stands, once for each close that waits for it. `ask` puts the question. Ends with the hold.
pub(crate) fn put_down(
    asked: watch::Receiver<AskedClose>,
    from: Option<ConsentFrom>,
    ask: impl Fn(Confirming),
) -> impl Stream<Item = Result<(), NoConsent>> {
    stream::unfold((asked, ask), move |(mut asked, ask)| async move {
        let word = word(&mut asked, from, &ask).await?;
        Some((word, (asked, ask)))
    })
}

async fn word(
    asked: &mut watch::Receiver<AskedClose>,
    from: Option<ConsentFrom>,
    ask: &impl Fn(Confirming),
) -> Option<Result<(), NoConsent>> {
    loop {
        asked.wait_for(Option::is_some).await.ok()?;
        if let Err(nobody) = consent::forget_earlier(from).await {
            return Some(Err(nobody));
        }
        let Some(close) = *asked.borrow() else {
            continue;
        };
        ask(close);
        match consent::answer().await {
            Err(nobody) => return Some(Err(nobody)),
            Ok(()) if asked.borrow().is_some() => return Some(Ok(())),
            // The object was lifted again meanwhile.
            Ok(()) => notify("that line came while the object was lifted, and is not used"),
        }
    }
}

fn confirmed(hand: &Endpoint) -> Option<PathBuf> {
    let settings = settings_file::default_path();
    settings.and_then(|settings| confirmed_file::file_of(&settings, hand))
}

fn trust(hand: &Endpoint, grasp: &Grasp) -> anyhow::Result<Trust> {
    let Some(file) = confirmed(hand) else {
        return Ok(Trust::NotConfirmed);
    };
    let all = confirmed_file::read(&file);
    let all = all.with_context(|| format!("cannot read {}; remove it", file.display()))?;
    Ok(match confirmed_file::of(&all, grasp) {
        Some(_) => Trust::Confirmed,
        None => Trust::NotConfirmed,
    })
}

/// Writes a grasp to a new file.
pub(crate) fn save(path: &Path, grasp: &Grasp) -> anyhow::Result<()> {
    match file::save(path, grasp) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(taken(path, "--save")),
        written => written.with_context(|| format!("cannot write {}", path.display())),
    }
}

/// The claim of the search whose results are in this folder.
///
/// # Errors
/// The folder has none, or it is of another hand.
pub(crate) fn claim(folder: &Path, hand: &Endpoint) -> anyhow::Result<GraspClaim> {
    let shown = folder.display();
    let session = session::load(folder).with_context(|| {
        let file = folder.join(session::SESSION_FILE);
        format!(
            "cannot read {}; --tuned is the --out folder of a 'handscope tune'",
            file.display()
        )
    })?;
    let head = session.head;
    let is_own = |other: Endpoint| other.place_and_id() == hand.place_and_id();
    if !head.hand.parse().is_ok_and(is_own) {
        return Err(WrongUsage::error(format!(
            "{shown} is of the hand at {}: name results of this hand with --tuned",
            head.hand
        )));
    }
    let found = head.others.get("tune").and_then(toml::Value::as_table);
    let found = found.and_then(claim_of);
    let Some(claim) = found else {
        bail!("{shown} has no claim: name the --out folder of a 'handscope tune' that made one");
    };
    Ok(claim)
}

fn claim_of(table: &toml::Table) -> Option<GraspClaim> {
    let words = table.get("result")?.as_str()?;
    let whole = |key: &str| table.get(key)?.as_integer();
    Some(GraspClaim {
        words: words.chars().take(NOTE_CHARS_MAX).collect(),
        peak_bound_g: table.get("peak_bound_g")?.as_float()?,
        speed: whole("speed")?,
        force_threshold_g: whole("force_threshold_g")?,
        closes: whole("closes")?,
    })
}
