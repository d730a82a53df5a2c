//! A grasp as a TOML file, version 1 (assets/manual/hold.md): read as a whole or rejected. Values that follow from others are written for
//! the reader, and must agree with them.

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::units::decimal;
use crate::hand::{Angle, Dof, Finger, Force, PerDof, PerFinger};
use crate::motion::grasp::saved::{
    FrictionSeen, Grasp, GraspClaim, GraspClose, GraspFinger, GraspResult, round,
};
use crate::motion::hold::HoldClose;
use crate::poses::library::{NAME_CHARS_MAX, clean};
use crate::store::toml_file::{VERSION, load};
use crate::store::{FileCause, FileError, FileText, create_folder, write_new};
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::Spanned;

/// The `format` value of a grasp file.
pub const FORMAT: &str = "handscope-grasp";
/// End of the name of a grasp file.
pub const EXTENSION: &str = ".grasp.toml";
/// Maximum size of a grasp file, bytes.
const FILE_MAX: u64 = 64 << 10;
/// Maximum length of a note, characters.
pub const NOTE_CHARS_MAX: usize = 400;
/// Maximum length of a wrong text that an error repeats, characters.
const QUOTED_CHARS: usize = 40;
/// Share by which a value may differ from those that it follows from: files are rounded by hand.
const ROUNDING: f64 = 0.02;

/// Possible forces, g of a hand, and loads, N.
const FORCES_G: RangeInclusive<f64> = 0.0..=10_000.0;
const LOADS_N: RangeInclusive<f64> = 0.0..=100.0;
/// Possible factors between the readings of two hands, newtons of a gram, and ratios of friction.
const READINGS: RangeInclusive<f64> = 0.05..=20.0;
const NEWTONS: RangeInclusive<f64> = 0.001..=0.1;
const RATIOS: RangeInclusive<f64> = 0.0..=10.0;
/// Possible stiffness, g for each unit of angle, and N/mm.
const STIFFNESS: RangeInclusive<f64> = 0.0..=10_000.0;
/// Possible times, s.
const TIMES_S: RangeInclusive<f64> = 0.0..=10_000_000.0;

type Number = Spanned<f64>;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GraspRow {
    format: String,
    version: i64,
    name: Spanned<String>,
    #[serde(default)]
    note: Option<Spanned<String>>,
    made: Spanned<String>,
    hand: Spanned<String>,
    at_least_g: Spanned<Force>,
    at_most_g: Force,
    #[serde(skip_serializing_if = "Option::is_none")]
    load_n: Option<Number>,
    close: Spanned<CloseRow>,
    finger: Spanned<BTreeMap<Finger, FingerRow>>,
    #[serde(default)]
    friction: FrictionRow,
    #[serde(skip_serializing_if = "Option::is_none")]
    tune: Option<ClaimRow>,
    result: ResultRow,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CloseRow {
    #[serde(skip_serializing_if = "Option::is_none")]
    pose: Option<Spanned<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gap_mm: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angles: Option<BTreeMap<Dof, Angle>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FingerRow {
    angle: Angle,
    force_g: Number,
    reading_per_g: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness_g_per_angle: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    newtons_per_g: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    force_n: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness_n_per_mm: Option<Number>,
}

#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrictionRow {
    #[serde(skip_serializing_if = "Option::is_none")]
    held_ratio: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slid_ratio: Option<Number>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ClaimRow {
    claim: Spanned<String>,
    peak_bound_g: Number,
    speed: i64,
    force_threshold_g: i64,
    closes: i64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ResultRow {
    held_s: Number,
    tightened: u32,
}

/// The folder of the pose library's grasps, beside the settings.
pub fn folder_of(settings: &Path) -> PathBuf {
    settings.with_file_name("grasps")
}

/// The file of a grasp in the pose library: by its name, in which other characters than letters and digits are `_`.
pub fn library_file(settings: &Path, name: &str) -> PathBuf {
    let plain = |letter: char| {
        if letter.is_alphanumeric() {
            letter
        } else {
            '_'
        }
    };
    let stem: String = name.chars().map(plain).collect();
    folder_of(settings).join(stem + EXTENSION)
}

/// Reads a file.
///
/// # Errors
/// [`FileError`] with line and field.
pub fn read_file(path: &Path) -> Result<Grasp, FileError> {
    load(path, FILE_MAX, read)
}

/// Writes a new file; creates its folder if missing.
///
/// # Errors
/// The system's error. An existing file is unchanged.
pub fn save(path: &Path, grasp: &Grasp) -> io::Result<()> {
    let text = write(grasp).map_err(io::Error::other)?;
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    write_new(path, text.as_bytes())
}

/// Formats a grasp.
///
/// # Errors
/// An error of the TOML writer; a grasp of this program never causes one.
pub fn write(grasp: &Grasp) -> Result<String, toml::ser::Error> {
    let fingers = grasp.fingers.iter();
    let fingers =
        fingers.filter_map(|(finger, own)| Some((finger, finger_row(grasp, finger, (*own)?))));
    toml::to_string(&GraspRow {
        format: FORMAT.into(),
        version: VERSION,
        name: unplaced(grasp.name.clone()),
        note: Some(unplaced(grasp.note.clone())),
        made: unplaced(grasp.made.clone()),
        hand: unplaced(grasp.hand.to_string()),
        at_least_g: unplaced(grasp.forces.at_least()),
        at_most_g: grasp.forces.at_most(),
        load_n: grasp.load_n.map(rounded),
        close: unplaced(close_row(&grasp.close)),
        finger: unplaced(fingers.collect()),
        friction: FrictionRow {
            held_ratio: grasp.friction.held_ratio.map(rounded),
            slid_ratio: grasp.friction.slid_ratio.map(rounded),
        },
        tune: grasp.claim.as_ref().map(|claim| ClaimRow {
            claim: unplaced(claim.words.clone()),
            peak_bound_g: rounded(claim.peak_bound_g),
            speed: claim.speed,
            force_threshold_g: claim.force_threshold_g,
            closes: claim.closes,
        }),
        result: ResultRow {
            held_s: rounded(grasp.result.held_s),
            tightened: grasp.result.tightened,
        },
    })
}

fn close_row(close: &GraspClose) -> CloseRow {
    let (gap_mm, angles) = match close.way {
        HoldClose::Pinch(gap) => (Some(unplaced(decimal(gap.mm()))), None),
        HoldClose::To(targets) => {
            let all = targets.iter().filter_map(|(dof, to)| Some((dof, (*to)?)));
            (None, Some(all.collect()))
        }
        HoldClose::TakeOver => (None, None),
    };
    CloseRow {
        pose: close.pose.clone().map(unplaced),
        gap_mm,
        angles,
    }
}

fn finger_row(grasp: &Grasp, finger: Finger, own: GraspFinger) -> FingerRow {
    FingerRow {
        angle: own.angle,
        force_g: rounded(own.force_g),
        reading_per_g: rounded(own.reading_per_g),
        stiffness_g_per_angle: own.stiffness_g.map(rounded),
        newtons_per_g: own.newtons_per_g.map(rounded),
        force_n: own.force_n().map(rounded),
        stiffness_n_per_mm: grasp.stiffness_n_per_mm(finger).map(rounded),
    }
}

/// Parses a grasp.
///
/// # Errors
/// [`FileError`] with line and field; a bad text is rejected as a whole.
pub fn read(text: &str) -> Result<Grasp, FileError> {
    let source = FileText::of(text, FORMAT)?;
    GraspReader(source).grasp(source.parse()?)
}

/// Builds a grasp from a parsed text.
#[derive(Clone, Copy)]
struct GraspReader<'a>(FileText<'a>);

impl GraspReader<'_> {
    fn grasp(self, row: GraspRow) -> Result<Grasp, FileError> {
        let forces = HoldForces::new(*row.at_least_g.get_ref(), row.at_most_g);
        let forces = forces.map_err(|why| {
            let cause = FileCause::Malformed(why.to_string());
            self.0.blame(row.at_least_g.span(), "at_least_g", cause)
        })?;
        let place = row.finger.span();
        let mut fingers = PerFinger::splat(None);
        for (finger, own) in row.finger.get_ref() {
            fingers[*finger] = Some(self.finger(own)?);
        }
        if row.finger.get_ref().is_empty() {
            return Err(self.0.blame(place, "finger", FileCause::Empty));
        }
        let friction = FrictionSeen {
            held_ratio: self.optional(row.friction.held_ratio.as_ref(), "held_ratio", RATIOS)?,
            slid_ratio: self.optional(row.friction.slid_ratio.as_ref(), "slid_ratio", RATIOS)?,
        };
        let grasp = Grasp {
            name: self.name(&row.name, "name")?,
            note: self.note(row.note.as_ref())?,
            made: self.day(&row.made)?,
            hand: self.hand(&row.hand)?,
            close: self.close(&row.close)?,
            forces,
            fingers,
            friction,
            load_n: self.optional(row.load_n.as_ref(), "load_n", LOADS_N)?,
            claim: self.claim(row.tune.as_ref())?,
            result: GraspResult {
                held_s: self.number(&row.result.held_s, "held_s", TIMES_S)?,
                tightened: row.result.tightened,
            },
        };
        for (finger, own) in row.finger.get_ref() {
            self.follows(
                own.force_n.as_ref(),
                "force_n",
                fingers[*finger].and_then(|own| own.force_n()),
            )?;
            let per_mm = own.stiffness_n_per_mm.as_ref();
            self.follows(
                per_mm,
                "stiffness_n_per_mm",
                grasp.stiffness_n_per_mm(*finger),
            )?;
        }
        Ok(grasp)
    }

    fn close(self, row: &Spanned<CloseRow>) -> Result<GraspClose, FileError> {
        let own = row.get_ref();
        let wrong = |field, cause| Err(self.0.blame(row.span(), field, cause));
        let way = match (&own.gap_mm, &own.angles) {
            (Some(gap_mm), None) => {
                let range = f64::from(Gap::MIN.mm())..=f64::from(Gap::MAX.mm());
                let mm = self.number(gap_mm, "gap_mm", range)?;
                #[expect(clippy::cast_possible_truncation, reason = "3 to 120 mm")]
                let gap = Gap::nearest(mm as f32);
                HoldClose::Pinch(gap)
            }
            (None, Some(angles)) if angles.is_empty() => return wrong("angles", FileCause::Empty),
            (None, Some(angles)) => HoldClose::To(PerDof::from_fn(|dof| angles.get(&dof).copied())),
            (Some(_), Some(_)) => return wrong("gap_mm", FileCause::Both { other: "angles" }),
            (None, None) => return wrong("angles", FileCause::Missing),
        };
        let pose = own.pose.as_ref().map(|pose| self.name(pose, "pose"));
        Ok(GraspClose {
            pose: pose.transpose()?,
            way,
        })
    }

    fn finger(self, row: &FingerRow) -> Result<GraspFinger, FileError> {
        let stiffness = row.stiffness_g_per_angle.as_ref();
        Ok(GraspFinger {
            angle: row.angle,
            force_g: self.number(&row.force_g, "force_g", FORCES_G)?,
            reading_per_g: self.number(&row.reading_per_g, "reading_per_g", READINGS)?,
            newtons_per_g: self.optional(row.newtons_per_g.as_ref(), "newtons_per_g", NEWTONS)?,
            stiffness_g: self.optional(stiffness, "stiffness_g_per_angle", STIFFNESS)?,
        })
    }

    fn claim(self, row: Option<&ClaimRow>) -> Result<Option<GraspClaim>, FileError> {
        let Some(row) = row else {
            return Ok(None);
        };
        Ok(Some(GraspClaim {
            words: self.words(&row.claim, "claim")?,
            peak_bound_g: self.number(&row.peak_bound_g, "peak_bound_g", FORCES_G)?,
            speed: row.speed,
            force_threshold_g: row.force_threshold_g,
            closes: row.closes,
        }))
    }

    fn name(self, name: &Spanned<String>, field: &str) -> Result<String, FileError> {
        let text = name.get_ref();
        if text.is_empty() || clean(text) != *text {
            let allowed = format!("a name of 1 to {NAME_CHARS_MAX} characters on one line");
            return Err(self.wrong(name, field, allowed));
        }
        Ok(text.clone())
    }

    fn note(self, note: Option<&Spanned<String>>) -> Result<String, FileError> {
        note.map_or_else(|| Ok(String::new()), |note| self.words(note, "note"))
    }

    fn words(self, text: &Spanned<String>, field: &str) -> Result<String, FileError> {
        if is_note(text.get_ref()) {
            Ok(text.get_ref().clone())
        } else {
            let allowed = format!("a text of at most {NOTE_CHARS_MAX} characters on one line");
            Err(self.wrong(text, field, allowed))
        }
    }

    fn day(self, day: &Spanned<String>) -> Result<String, FileError> {
        let is_digit = |at: usize, byte: u8| match at {
            4 | 7 => byte == b'-',
            _ => byte.is_ascii_digit(),
        };
        let text = day.get_ref();
        let mut bytes = text.bytes().enumerate();
        if text.len() == 10 && bytes.all(|(at, byte)| is_digit(at, byte)) {
            Ok(text.clone())
        } else {
            Err(self.wrong(day, "made", "a date such as 2026-11-30".into()))
        }
    }

    fn hand(self, hand: &Spanned<String>) -> Result<Endpoint, FileError> {
        let parsed = hand.get_ref().parse();
        parsed.map_err(|_why| {
            let allowed = "the URL of a hand, such as tcp:192.168.11.210".into();
            self.wrong(hand, "hand", allowed)
        })
    }

    fn wrong(self, got: &Spanned<String>, field: &str, allowed: String) -> FileError {
        let start: String = got.get_ref().chars().take(QUOTED_CHARS).collect();
        let got_words = format!("\"{}\"", start.escape_debug());
        let cause = FileCause::Value {
            got: got_words,
            allowed,
        };
        self.0.blame(got.span(), field, cause)
    }

    fn optional(
        self,
        number: Option<&Number>,
        field: &str,
        range: RangeInclusive<f64>,
    ) -> Result<Option<f64>, FileError> {
        let number = number.map(|number| self.number(number, field, range));
        number.transpose()
    }

    fn number(
        self,
        number: &Number,
        field: &str,
        range: RangeInclusive<f64>,
    ) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if range.contains(&value) {
            return Ok(value);
        }
        Err(self.out_of(number.span(), field, value, &range))
    }

    fn out_of(
        self,
        at: Range<usize>,
        field: &str,
        value: f64,
        range: &RangeInclusive<f64>,
    ) -> FileError {
        let cause = FileCause::Range {
            got: value.to_string(),
            range: format!("{} to {}", range.start(), range.end()),
        };
        self.0.blame(at, field, cause)
    }

    /// Checks a value that follows from others.
    fn follows(
        self,
        number: Option<&Number>,
        field: &str,
        expected: Option<f64>,
    ) -> Result<(), FileError> {
        let Some(number) = number else {
            return Ok(());
        };
        let value = *number.get_ref();
        let expected = expected.map(round);
        let agrees =
            |expected: f64| (value - expected).abs() <= ROUNDING * expected.abs().max(0.01);
        if expected.is_some_and(agrees) {
            return Ok(());
        }
        let allowed = expected.map_or_else(
            || "possible without newtons_per_g: remove it".to_owned(),
            |expected| format!("{expected}, which follows from the other values: remove it"),
        );
        let cause = FileCause::Value {
            got: value.to_string(),
            allowed,
        };
        Err(self.0.blame(number.span(), field, cause))
    }
}

/// True if a note can be stored: one line of at most [`NOTE_CHARS_MAX`] characters.
pub fn is_note(text: &str) -> bool {
    text.chars().count() <= NOTE_CHARS_MAX && !text.chars().any(char::is_control)
}

fn rounded(value: f64) -> Number {
    unplaced(round(value))
}

/// A value without a position in a file.
fn unplaced<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::hold_forces::NoRoom;
    use crate::motion::grasp::confirm::Agreement;
    use crate::motion::grasp::confirmed_file::{add, file_of, of};
    use crate::motion::grasp::doubt::GraspDoubt;

    fn finger(newtons_per_g: Option<f64>) -> GraspFinger {
        GraspFinger {
            angle: Angle::nearest(612),
            force_g: 131.2,
            reading_per_g: 1.0,
            newtons_per_g,
            stiffness_g: Some(12.37),
        }
    }

    fn grasp(close: HoldClose) -> Grasp {
        let mut fingers = PerFinger::splat(None);
        fingers[Finger::Index] = Some(finger(Some(0.0071)));
        fingers[Finger::Thumb] = Some(finger(Some(0.0129)));
        Grasp {
            name: "egg".into(),
            note: "brown, \"fresh\"".into(),
            made: "2026-11-30".into(),
            hand: "tcp:192.168.11.210".parse().unwrap(),
            close: GraspClose {
                pose: None,
                way: close,
            },
            forces: HoldForces::new(Force::nearest(120), Force::nearest(300)).unwrap(),
            fingers,
            friction: FrictionSeen {
                held_ratio: Some(0.3123),
                slid_ratio: None,
            },
            load_n: Some(0.84),
            claim: Some(GraspClaim {
                words: "index on this object: closes in 0.51 s".into(),
                peak_bound_g: 281.0,
                speed: 250,
                force_threshold_g: 200,
                closes: 59,
            }),
            result: GraspResult {
                held_s: 20.01,
                tightened: 2,
            },
        }
    }

    fn pinch() -> Grasp {
        grasp(HoldClose::Pinch(Gap::nearest(20.5)))
    }

    #[test]
    fn what_is_written_reads_back() {
        let bends = PerDof::from_fn(|dof| (dof != Dof::ThumbRotate).then_some(Angle::MIN));
        let mut all = vec![pinch(), grasp(HoldClose::To(bends))];
        let mut bare = pinch();
        bare.fingers[Finger::Thumb] = Some(GraspFinger {
            stiffness_g: None,
            ..finger(None)
        });
        (bare.claim, bare.load_n, bare.friction) = (None, None, FrictionSeen::default());
        all.push(bare);
        for grasp in all {
            let text = write(&grasp).unwrap();
            assert_eq!(read(&text).as_ref(), Ok(&grasp), "{text}");
            assert!(text.contains("force_n = 0.9315"), "{text}");
            assert!(text.contains("stiffness_n_per_mm = "), "{text}");
        }
    }

    #[test]
    fn a_wrong_file_is_refused_with_line_and_reason() {
        let text = write(&pinch()).unwrap();
        for (right, wrong, words) in [
            ("-grasp\"", "-poses\"", "another kind of file"),
            ("version = 1", "version = 2", "version 2 cannot be read"),
            (
                "name = \"egg\"",
                "name = \"\"",
                "a name of 1 to 32 characters",
            ),
            ("\"2026-11-30\"", "\"today\"", "a date such as 2026-11-30"),
            ("tcp:192.168.11.210", "my hand", "the URL of a hand"),
            (
                "at_least_g = 120",
                "at_least_g = 290",
                "leave no room for a hold",
            ),
            ("at_least_g = 120", "at_least_g = -1", "`at_least_g`"),
            ("gap_mm = 20.5", "gap_mm = 2", "2 is outside 3 to 120"),
            ("gap_mm = 20.5", "", "`angles`: it is missing"),
            (
                "gap_mm = 20.5",
                "gap_mm = 20\nangles = { index = 3 }",
                "conflicts with `angles`",
            ),
            ("gap_mm = 20.5", "angles = { index = 2000 }", "2000"),
            (
                "held_ratio = 0.3123",
                "held_ratio = nan",
                "NaN is outside 0 to 10",
            ),
            (
                "force_n = 0.9315",
                "force_n = 3.1",
                "3.1 is not 0.9315, which follows",
            ),
            (
                "newtons_per_g = 0.0071",
                "",
                "without newtons_per_g: remove it",
            ),
            (
                "[finger.index]",
                "[finger.palm]",
                "\"palm\" is unknown here",
            ),
            ("tightened = 2", "tightened = 2\ncolour = 3", "unknown key"),
            ("held_s = 20.01", "", "`held_s`: it is missing"),
        ] {
            assert!(text.contains(right), "{right} {text}");
            let wrong = text.replacen(right, wrong, 1);
            let error = read(&wrong).unwrap_err().to_string();
            assert!(error.contains(words), "{wrong} {error}");
            assert!(!error.contains('\n'), "{error}");
        }
        let error = read_file(Path::new("/nowhere/egg.grasp.toml")).unwrap_err();
        assert!(error.to_string().contains("no such file"), "{error}");
    }

    #[test]
    fn forces_are_converted_by_the_newtons_of_both_hands() {
        let grasp = pinch();
        let all = |newtons: f64| PerDof::splat(Some(newtons));
        let here = grasp.reading_per_g_on(&all(0.01)).unwrap();
        assert!((here[Dof::Index] - 0.71).abs() < 1e-9);
        assert!((here[Dof::ThumbBend] - 1.29).abs() < 1e-9);
        assert!(
            (here[Dof::Ring] - 1.0).abs() < 1e-9,
            "the mean of the others"
        );
        let mut newtons = all(0.01);
        newtons[Dof::ThumbBend] = None;
        let finger = Finger::Thumb;
        assert_eq!(
            grasp.reading_per_g_on(&newtons),
            Err(GraspDoubt::NoNewtonsHere { finger })
        );
        newtons[Dof::Ring] = None;
        newtons[Dof::ThumbBend] = Some(0.01);
        assert!(
            grasp.reading_per_g_on(&newtons).is_ok(),
            "the ring did not hold"
        );
        let finger = Finger::Index;
        let why = NoRoom {
            at_least: 24,
            at_most: 61,
        };
        let room = GraspDoubt::NoRoom { finger, why };
        assert_eq!(grasp.reading_per_g_on(&all(0.035)), Err(room));
        let mut bare = grasp;
        bare.fingers[Finger::Index] = Some(super::tests::finger(None));
        let there = GraspDoubt::NoNewtonsThere { finger };
        assert_eq!(bare.reading_per_g_on(&all(0.01)), Err(there));
        assert!(there.to_string().contains("handscope scale --joint index"));
    }

    #[test]
    fn a_hand_confirms_a_grasp_once_and_a_changed_one_again() {
        let folder = tempfile::tempdir().unwrap();
        let settings = folder.path().join("settings.toml");
        let hand: Endpoint = "tcp:192.168.11.211".parse().unwrap();
        let file = file_of(&settings, &hand).unwrap();
        let agreement = Agreement {
            closes: 5,
            peak_share: 0.7,
            stiffness_ratio: None,
            friction: 0.4,
            load_n: 0.8,
        };
        let all = add(&file, &pinch(), agreement, "2026-11-30").unwrap();
        assert_eq!(of(&all, &pinch()).unwrap().agreement, agreement);
        let mut changed = pinch();
        changed.forces = HoldForces::new(Force::nearest(120), Force::nearest(400)).unwrap();
        assert_eq!(of(&all, &changed), None);
        let all = add(&file, &changed, agreement, "2026-11-30").unwrap();
        assert_eq!(
            add(&file, &changed, agreement, "2026-12-01").unwrap().len(),
            all.len()
        );
        assert!(!pinch().is_of(&hand));
        assert!(pinch().is_of(&"tcp:192.168.11.210".parse().unwrap()));
    }
}
