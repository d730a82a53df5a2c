//! The file of an exhibition as TOML, version 1 (assets/manual/exhibit.md). It is accepted as a whole or rejected.

use crate::exhibit::pin::{BadPin, DIGITS, Pin};
use crate::exhibit::plan::{
    AttractLoop, BothWords, ExhibitPiece, ExhibitPlan, MotionLimits, TILES, open_plan,
};
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Force, Speed};
use crate::poses::library::PoseLibrary;
use crate::poses::starter::starter;
use crate::store::{FileCause, FileError, FileText};
use serde::Deserialize;
use std::ops::{Range, RangeInclusive};
use std::path::{Component, Path, PathBuf};
use std::time::Duration;
use toml::Spanned;

/// The `format` value of such a file.
pub const FORMAT: &str = "handscope-exhibit";
/// Maximum length of the line above the hand, characters.
const TITLE_CHARS_MAX: usize = 60;
/// Range of visit and attract loop times, seconds.
const SECONDS: RangeInclusive<u64> = 5..=3600;
/// Maximum length of a wrong value in an error, characters.
const QUOTED_CHARS: usize = 40;
/// Maximum number of pieces in the attract loop.
const ATTRACT_MAX: usize = 40;
/// The exhibition used without a file.
const BUILT_IN: &str = include_str!("../../assets/exhibit.toml");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ExhibitRow {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: i64,
    #[serde(default)]
    title: Option<Spanned<String>>,
    #[serde(default)]
    title_zh: Option<Spanned<String>>,
    #[serde(default)]
    logo: Option<Spanned<PathBuf>>,
    #[serde(default)]
    poses: Option<Spanned<PathBuf>>,
    /// Any value: an error of the TOML parser would repeat a wrong PIN.
    #[serde(default)]
    pin: Option<Spanned<toml::Value>>,
    tiles: Spanned<Vec<Spanned<String>>>,
    #[serde(default)]
    speed: Option<Spanned<Speed>>,
    #[serde(default)]
    force: Option<Spanned<Force>>,
    #[serde(default)]
    visit_s: Option<Spanned<i64>>,
    #[serde(default)]
    visitor_restart: bool,
    #[serde(default)]
    attract: Option<AttractRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AttractRow {
    pieces: Spanned<Vec<Spanned<String>>>,
    #[serde(default)]
    after_s: Option<Spanned<i64>>,
    #[serde(default)]
    play_s: Option<Spanned<i64>>,
    #[serde(default)]
    rest_s: Option<Spanned<i64>>,
}

/// The exhibition used without a file.
pub fn built_in() -> Option<ExhibitPlan> {
    let file = ExhibitFile::parse(BUILT_IN, Path::new(""));
    let plan = file.and_then(|file| file.plan(&PoseLibrary::default()));
    debug_assert!(plan.is_ok(), "{plan:?}");
    plan.ok()
}

/// The text of such a file, and the folder that it is in.
pub struct ExhibitFile<'a> {
    source: FileText<'a>,
    row: ExhibitRow,
    folder: &'a Path,
}

/// A file referenced by an exhibition file.
#[derive(Debug, Clone)]
pub struct NamedFile<'a> {
    pub path: PathBuf,
    source: FileText<'a>,
    at: Range<usize>,
    field: &'static str,
}

impl NamedFile<'_> {
    /// The error of the referring file, caused by an error of this one.
    pub fn refused(&self, why: FileError) -> FileError {
        let cause = why.of_named(self.path.display().to_string()).cause;
        self.source.blame(self.at.clone(), self.field, cause)
    }

    /// The error of the referring file if this one is outside its folder.
    pub fn outside(&self) -> FileError {
        let got = quoted(&self.path.display().to_string());
        let cause = FileCause::Outside { got };
        self.source.blame(self.at.clone(), self.field, cause)
    }
}

impl<'a> ExhibitFile<'a> {
    /// Parses a text; unknown fields are errors.
    ///
    /// # Errors
    /// [`FileError`] with line and field.
    pub fn parse(text: &'a str, folder: &'a Path) -> Result<Self, FileError> {
        let source = FileText::of(text, FORMAT)?;
        let row = source.parse()?;
        Ok(Self {
            source,
            row,
            folder,
        })
    }

    /// The referenced pose file.
    ///
    /// # Errors
    /// [`FileError`] with line and field if the path leaves the folder.
    pub fn poses(&self) -> Result<Option<NamedFile<'a>>, FileError> {
        let poses = self.row.poses.as_ref();
        poses.map(|named| self.named("poses", named)).transpose()
    }

    /// The referenced logo.
    ///
    /// # Errors
    /// [`FileError`] with line and field if the name does not end in .png or the path leaves the folder.
    pub fn logo(&self) -> Result<Option<NamedFile<'a>>, FileError> {
        let Some(logo) = &self.row.logo else {
            return Ok(None);
        };
        let path = logo.get_ref();
        let is_png = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("png");
        if !path.extension().is_some_and(is_png) {
            let cause = FileCause::Value {
                got: quoted(&path.display().to_string()),
                allowed: "a file that ends in .png".into(),
            };
            return Err(self.source.blame(logo.span(), "logo", cause));
        }
        self.named("logo", logo).map(Some)
    }

    fn named(
        &self,
        field: &'static str,
        file: &Spanned<PathBuf>,
    ) -> Result<NamedFile<'a>, FileError> {
        let named = NamedFile {
            path: self.folder.join(file.get_ref()),
            source: self.source,
            at: file.span(),
            field,
        };
        let mut parts = file.get_ref().components();
        let is_inside = parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if is_inside {
            Ok(named)
        } else {
            Err(named.outside())
        }
    }

    /// Builds the exhibition. Tile names refer to entries of `own`, then to shipped ones.
    ///
    /// # Errors
    /// [`FileError`] with line and field; a bad text is rejected as a whole.
    pub fn plan(&self, own: &PoseLibrary) -> Result<ExhibitPlan, FileError> {
        let source = self.source;
        ExhibitReader { source, own }.plan(&self.row)
    }
}

/// Builds an exhibition from a parsed text.
#[derive(Clone, Copy)]
struct ExhibitReader<'a> {
    source: FileText<'a>,
    own: &'a PoseLibrary,
}

impl ExhibitReader<'_> {
    fn plan(self, row: &ExhibitRow) -> Result<ExhibitPlan, FileError> {
        let limits = MotionLimits {
            speed: self.moving("speed", row.speed.as_ref(), Speed::nearest(300), Speed::MIN)?,
            force: self.moving("force", row.force.as_ref(), Force::nearest(800), Force::MIN)?,
        };
        self.count("tiles", &row.tiles, TILES)?;
        let title = BothWords {
            en: self.line("title", row.title.as_ref())?,
            zh: self.line("title_zh", row.title_zh.as_ref())?,
        };
        let attract = row.attract.as_ref();
        Ok(ExhibitPlan {
            title,
            pin: self.pin(row.pin.as_ref())?,
            limits,
            tiles: self.pieces("tiles", row.tiles.get_ref(), limits)?,
            open: open_plan(limits),
            visit: self.seconds("visit_s", row.visit_s.as_ref(), 120)?,
            attract: attract.map(|row| self.attract(row, limits)).transpose()?,
            visitor_restart: row.visitor_restart,
        })
    }

    /// Checks the length of a list of names.
    fn count(
        self,
        field: &str,
        names: &Spanned<Vec<Spanned<String>>>,
        allowed: RangeInclusive<usize>,
    ) -> Result<(), FileError> {
        let count = names.get_ref().len();
        if allowed.contains(&count) {
            return Ok(());
        }
        let (least, most) = (allowed.start(), allowed.end());
        let cause = FileCause::Value {
            got: format!("{count}"),
            allowed: format!("a number of {field} from {least} to {most}"),
        };
        Err(self.source.blame(names.span(), field, cause))
    }

    fn attract(self, row: &AttractRow, limits: MotionLimits) -> Result<AttractLoop, FileError> {
        self.count("pieces", &row.pieces, 1..=ATTRACT_MAX)?;
        Ok(AttractLoop {
            pieces: self.pieces("pieces", row.pieces.get_ref(), limits)?,
            after: self.seconds("after_s", row.after_s.as_ref(), 60)?,
            play: self.seconds("play_s", row.play_s.as_ref(), 45)?,
            rest: self.seconds("rest_s", row.rest_s.as_ref(), 120)?,
        })
    }

    fn pieces(
        self,
        field: &str,
        names: &[Spanned<String>],
        limits: MotionLimits,
    ) -> Result<Vec<ExhibitPiece>, FileError> {
        let mut pieces: Vec<ExhibitPiece> = Vec::with_capacity(names.len());
        for name in names {
            let Some(piece) = self.piece(name.get_ref(), limits) else {
                let cause = FileCause::Value {
                    got: quoted(name.get_ref()),
                    allowed: "the name of a pose, sequence or reaction".into(),
                };
                return Err(self.source.blame(name.span(), field, cause));
            };
            if field == "tiles" && pieces.iter().any(|other| other.name == piece.name) {
                let cause = FileCause::Twice {
                    name: name.get_ref().clone(),
                };
                return Err(self.source.blame(name.span(), field, cause));
            }
            let is_above = |forces: HoldForces| forces.at_most() > limits.force;
            if piece.plan.cues().any(|cue| cue.hold.is_some_and(is_above)) {
                let least = HoldForces::LEAST + HoldForces::ROOM;
                let cause = FileCause::Value {
                    got: quoted(name.get_ref()),
                    allowed: format!("possible with this `force`: a hold needs {least} g"),
                };
                return Err(self.source.blame(name.span(), field, cause));
            }
            pieces.push(piece);
        }
        Ok(pieces)
    }

    /// The pose, else the sequence, else the reaction with this name, first from the file's own library.
    fn piece(self, name: &str, limits: MotionLimits) -> Option<ExhibitPiece> {
        [self.own, starter()].into_iter().find_map(|library| {
            let mut entries = library.entries();
            let is_it = |entry: &_| library.named(*entry).is_some_and(|own| own.text == name);
            let entry = entries.find(is_it)?;
            let (names, mut plan) = (library.named(entry)?, library.plan(entry)?);
            let again = std::mem::take(&mut plan.looped);
            let zh = if names.zh.is_empty() {
                names.text
            } else {
                names.zh
            };
            (!plan.cues.is_empty()).then(|| ExhibitPiece {
                name: BothWords {
                    en: names.text.into(),
                    zh: zh.into(),
                },
                plan: limits.limited(&plan),
                again,
            })
        })
    }

    /// A limit above zero, so that the hand can move.
    fn moving<T: Copy + PartialEq>(
        self,
        field: &str,
        got: Option<&Spanned<T>>,
        usual: T,
        none: T,
    ) -> Result<T, FileError> {
        let Some(got) = got else { return Ok(usual) };
        if *got.get_ref() == none {
            let cause = FileCause::Value {
                got: "0".into(),
                allowed: "allowed here: nothing could move".into(),
            };
            return Err(self.source.blame(got.span(), field, cause));
        }
        Ok(*got.get_ref())
    }

    fn seconds(
        self,
        field: &str,
        got: Option<&Spanned<i64>>,
        usual: u64,
    ) -> Result<Duration, FileError> {
        let Some(got) = got else {
            return Ok(Duration::from_secs(usual));
        };
        match u64::try_from(*got.get_ref()) {
            Ok(seconds) if SECONDS.contains(&seconds) => Ok(Duration::from_secs(seconds)),
            _ => {
                let cause = FileCause::Value {
                    got: format!("{}", got.get_ref()),
                    allowed: format!("a time from {} to {} s", SECONDS.start(), SECONDS.end()),
                };
                Err(self.source.blame(got.span(), field, cause))
            }
        }
    }

    fn line(self, field: &str, got: Option<&Spanned<String>>) -> Result<String, FileError> {
        let Some(got) = got else {
            return Ok(String::new());
        };
        let text = got.get_ref();
        if text.chars().count() > TITLE_CHARS_MAX || text.chars().any(char::is_control) {
            let cause = FileCause::Value {
                got: quoted(text),
                allowed: format!("one line of at most {TITLE_CHARS_MAX} characters"),
            };
            return Err(self.source.blame(got.span(), field, cause));
        }
        Ok(text.clone())
    }

    /// Reads the PIN; an error never repeats the value.
    fn pin(self, got: Option<&Spanned<toml::Value>>) -> Result<Option<Pin>, FileError> {
        let Some(got) = got else { return Ok(None) };
        let pin = match got.get_ref() {
            toml::Value::String(text) => Pin::try_from(text.clone()),
            _ => Err(BadPin),
        };
        pin.map(Some).map_err(|BadPin| {
            let cause = FileCause::Value {
                got: "this".into(),
                allowed: format!(
                    "a PIN: {} to {} digits in quotation marks",
                    DIGITS.start(),
                    DIGITS.end()
                ),
            };
            self.source.blame(got.span(), "pin", cause)
        })
    }
}

/// The start of a text, escaped to one line.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(QUOTED_CHARS).collect();
    let more = if start.len() < text.len() { "…" } else { "" };
    format!("\"{}{more}\"", start.escape_debug())
}
