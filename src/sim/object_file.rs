//! Objects as TOML files: read entirely or not at all, and printed with units and ranges.

use crate::hand::{Dof, PerDof};
use crate::sim::object::{
    Friction, HandTurn, Harder, LIFT_AFTER_S, LOADS_MAX, Loads, NamedObject, Object, Obstacle,
    PullLoad, RandomPulls, listed,
};
use crate::sim::scenario::Scenario;
use crate::store::toml_file::load;
use crate::store::{FileCause, FileError, FileText};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Size limit of an object file, bytes; a printed object takes some two thousand.
const BYTES_MAX: u64 = 1 << 18;

/// Error for an object that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ObjectError {
    /// Not a name, and not a valid file.
    #[error(
        "the object {} cannot be used: {why}; write cup, egg, sponge, block, tube, can or a file as printed by 'handscope sim --print-object cup'",
        path.display()
    )]
    File {
        path: PathBuf,
        /// Error with its position.
        why: FileError,
    },
    /// The scenario does not let the hand hold an object.
    #[error(
        "an object cannot be used in the scenario {got}: choose idle, free, rigid, fragile or grasp"
    )]
    Scenario {
        /// Name of the scenario.
        got: &'static str,
    },
}

/// True for the scenarios in which an object can lie between the fingers.
pub const fn fits_scenario(scenario: Scenario) -> bool {
    match scenario {
        Scenario::Idle | Scenario::Free | Scenario::Rigid | Scenario::Fragile | Scenario::Grasp => {
            true
        }
        Scenario::Touched | Scenario::Faults | Scenario::Extremes | Scenario::Frozen => false,
    }
}

/// Returns the named object, or the one of this file.
///
/// # Errors
/// [`ObjectError::File`]: no such name or file, an unknown key, or a value out of range.
pub fn named_or_file(text: &str) -> Result<Object, ObjectError> {
    if let Some(named) = NamedObject::by_name(text) {
        return Ok(named.object());
    }
    let path = Path::new(text);
    load(path, BYTES_MAX, parse).map_err(|why| ObjectError::File {
        path: path.to_owned(),
        why,
    })
}

/// The same for a hand in this scenario.
///
/// # Errors
/// [`ObjectError`].
pub fn in_scenario(text: &str, scenario: Scenario) -> Result<Object, ObjectError> {
    if fits_scenario(scenario) {
        named_or_file(text)
    } else {
        let got = scenario.name();
        Err(ObjectError::Scenario { got })
    }
}

/// A number of the file: its key, range and meaning.
struct NumberKey {
    name: &'static str,
    least: f64,
    most: f64,
    about: &'static str,
}

const fn key(name: &'static str, least: f64, most: f64, about: &'static str) -> NumberKey {
    NumberKey {
        name,
        least,
        most,
        about,
    }
}

const CONTACT: NumberKey = key("contact", 0.0, 1000.0, "angle at which the joint touches");
const SIZE: NumberKey = key("size_mm", 3.0, 120.0, "mm between thumb and index");
const STIFFNESS: NumberKey = key("stiffness", 0.05, 500.0, "g for each position count");
const HARDER_FROM: NumberKey = key(
    "harder_from",
    0.0,
    2000.0,
    "position counts from which harder_stiffness counts",
);
const HARDER_STIFFNESS: NumberKey = key(
    "harder_stiffness",
    0.05,
    500.0,
    "g for each position count, of a deeper compression",
);
const YIELDS: NumberKey = key(
    "yields_at_g",
    1.0,
    20_000.0,
    "g of one finger that dent it for good",
);
const BREAKS: NumberKey = key(
    "breaks_at_g",
    1.0,
    20_000.0,
    "g of one finger that break it",
);
const MASS: NumberKey = key("mass_g", 1.0, 10_000.0, "g");
const FRICTION: NumberKey = key("friction", 0.0, 3.0, "coefficient of static friction");
const SLIDING: NumberKey = key("sliding_ratio", 0.05, 1.0, "sliding over static friction");
const DRAG: NumberKey = key(
    "drag_per_mm_s",
    0.0,
    1.0,
    "share by which sliding friction grows for each mm/s",
);
const SCATTER: NumberKey = key(
    "friction_scatter",
    0.0,
    0.5,
    "standard deviation of a fingertip's friction, as a share of it",
);
const TAPER: NumberKey = key(
    "taper_per_mm",
    0.0,
    0.5,
    "share of the normal force lost for each mm that it slides",
);
const LIFT: NumberKey = key(
    "lift_after_s",
    0.0,
    3600.0,
    "s from a grip by two fingers to the lift",
);
const TAKEN: NumberKey = key("taken_away_at_s", 0.0, 3600.0, "s after the lift");
const BACK: NumberKey = key("put_back_at_s", 0.0, 3600.0, "s after the lift");
const AT: NumberKey = key("at_s", 0.0, 3600.0, "s after the lift");
const DIRECTION: NumberKey = key(
    "direction_deg",
    -3600.0,
    3600.0,
    "degrees in the plane of the pads",
);
const SHARE: NumberKey = key("share", 0.0, 1.0, "share of the weight along the pads");
const FORCE: NumberKey = key("force_g", 0.0, 20_000.0, "g");
const RISE: NumberKey = key("rise_ms", 0.0, 60_000.0, "ms in which it grows");
const LASTS: NumberKey = key("lasts_ms", 0.0, 3_600_000.0, "ms at full force");
const EVERY: NumberKey = key("every_s", 0.05, 3600.0, "s");

type Number = Spanned<f64>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectRow {
    size_mm: Option<Number>,
    #[serde(default)]
    contact: BTreeMap<Dof, Number>,
    stiffness: Number,
    harder_from: Option<Number>,
    harder_stiffness: Option<Number>,
    yields_at_g: Option<Number>,
    breaks_at_g: Option<Number>,
    mass_g: Number,
    friction: Number,
    sliding_ratio: Option<Number>,
    drag_per_mm_s: Option<Number>,
    friction_scatter: Option<Number>,
    taper_per_mm: Option<Number>,
    lift_after_s: Option<Number>,
    stays_on_table: Option<bool>,
    taken_away_at_s: Option<Number>,
    put_back_at_s: Option<Number>,
    #[serde(default)]
    turn: Vec<Spanned<TurnRow>>,
    #[serde(default)]
    pull: Vec<Spanned<PullRow>>,
    random_pulls: Option<RandomRow>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TurnRow {
    at_s: Number,
    direction_deg: Number,
    share: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PullRow {
    at_s: Number,
    force_g: Number,
    direction_deg: Number,
    rise_ms: Number,
    lasts_ms: Number,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RandomRow {
    every_s: Number,
    force_g: Spanned<[f64; 2]>,
    rise_ms: Spanned<[f64; 2]>,
}

/// Parses an object.
///
/// # Errors
/// [`FileError`] with line and field.
pub fn parse(text: &str) -> Result<Object, FileError> {
    let source = FileText::plain(text);
    let row: ObjectRow = source.parse()?;
    let obstacle = obstacle(source, &row)?;
    let optional = |number: &Option<Number>, key: &NumberKey| match number {
        Some(number) => fits(source, number, key).map(Some),
        None => Ok(None),
    };
    Ok(Object {
        contacts: contacts(source, &row, obstacle)?,
        mass_g: fits(source, &row.mass_g, &MASS)?,
        friction: Friction {
            sticking: fits(source, &row.friction, &FRICTION)?,
            sliding_ratio: optional(&row.sliding_ratio, &SLIDING)?.unwrap_or(0.8),
            drag_per_mm_s: optional(&row.drag_per_mm_s, &DRAG)?.unwrap_or(0.0),
            scatter: optional(&row.friction_scatter, &SCATTER)?.unwrap_or(0.05),
        },
        taper_per_mm: optional(&row.taper_per_mm, &TAPER)?.unwrap_or(0.0),
        loads: Loads {
            lift_after_s: match optional(&row.lift_after_s, &LIFT)? {
                _ if row.stays_on_table == Some(true) => None,
                given => given.or(Some(LIFT_AFTER_S)),
            },
            turns: turns(source, &row.turn)?,
            pulls: pulls(source, &row.pull)?,
            random_pulls: match &row.random_pulls {
                Some(random) => Some(random_pulls(source, random)?),
                None => None,
            },
            taken_away_at_s: optional(&row.taken_away_at_s, &TAKEN)?,
            put_back_at_s: optional(&row.put_back_at_s, &BACK)?,
        },
    })
}

fn contacts(
    source: FileText<'_>,
    row: &ObjectRow,
    obstacle: Obstacle,
) -> Result<PerDof<Option<Obstacle>>, FileError> {
    let Some(size_mm) = &row.size_mm else {
        if row.contact.is_empty() {
            let cause = FileCause::Malformed(
                "it is missing: add it, or the angles of the joints under [contact]".into(),
            );
            return Err(source.blame(0..0, SIZE.name, cause));
        }
        let mut contacts = PerDof::splat(None);
        for (dof, angle) in &row.contact {
            contacts[*dof] = Some(Obstacle {
                angle: fits(source, angle, &CONTACT)?,
                ..obstacle
            });
        }
        return Ok(contacts);
    };
    if !row.contact.is_empty() {
        let cause = FileCause::Both { other: "contact" };
        return Err(source.blame(size_mm.span(), SIZE.name, cause));
    }
    let size_mm = fits(source, size_mm, &SIZE)?;
    Ok(Object::contacts_of_size(size_mm, obstacle))
}

fn obstacle(source: FileText<'_>, row: &ObjectRow) -> Result<Obstacle, FileError> {
    let harder = match (&row.harder_from, &row.harder_stiffness) {
        (Some(from), Some(stiffness)) => Some(Harder {
            from_counts: fits(source, from, &HARDER_FROM)?,
            stiffness: fits(source, stiffness, &HARDER_STIFFNESS)?,
        }),
        (None, None) => None,
        (Some(one), None) | (None, Some(one)) => {
            let cause = FileCause::Malformed("needs both harder_from and harder_stiffness".into());
            return Err(source.blame(one.span(), "harder_stiffness", cause));
        }
    };
    let optional = |number: &Option<Number>, key: &NumberKey| match number {
        Some(number) => fits(source, number, key).map(Some),
        None => Ok(None),
    };
    let stiffness = fits(source, &row.stiffness, &STIFFNESS)?;
    if let (Some(harder), Some(given)) = (harder, &row.harder_stiffness)
        && harder.stiffness < stiffness
    {
        let cause = FileCause::Value {
            got: harder.stiffness.to_string(),
            allowed: format!("a number from {stiffness}, the first stiffness"),
        };
        return Err(source.blame(given.span(), HARDER_STIFFNESS.name, cause));
    }
    Ok(Obstacle {
        angle: 0.0,
        stiffness,
        harder,
        yields_at_g: optional(&row.yields_at_g, &YIELDS)?,
        breaks_at_g: optional(&row.breaks_at_g, &BREAKS)?,
    })
}

fn turns(
    source: FileText<'_>,
    rows: &[Spanned<TurnRow>],
) -> Result<[Option<HandTurn>; LOADS_MAX], FileError> {
    few(source, rows, "turn")?;
    let mut turns: Vec<HandTurn> = Vec::with_capacity(rows.len());
    for row in rows {
        let row = row.get_ref();
        let at_s = fits(source, &row.at_s, &AT)?;
        if let Some(before) = turns.last().filter(|before| before.at_s > at_s) {
            let cause = FileCause::Value {
                got: at_s.to_string(),
                allowed: format!("a time from {} s, that of the turn before", before.at_s),
            };
            return Err(source.blame(row.at_s.span(), AT.name, cause));
        }
        turns.push(HandTurn {
            at_s,
            direction_deg: fits(source, &row.direction_deg, &DIRECTION)?,
            share: match &row.share {
                Some(share) => fits(source, share, &SHARE)?,
                None => 1.0,
            },
        });
    }
    Ok(listed(&turns))
}

fn pulls(
    source: FileText<'_>,
    rows: &[Spanned<PullRow>],
) -> Result<[Option<PullLoad>; LOADS_MAX], FileError> {
    few(source, rows, "pull")?;
    let pull = |row: &Spanned<PullRow>| {
        let row = row.get_ref();
        Ok(PullLoad {
            at_s: fits(source, &row.at_s, &AT)?,
            force_g: fits(source, &row.force_g, &FORCE)?,
            direction_deg: fits(source, &row.direction_deg, &DIRECTION)?,
            rise_ms: fits(source, &row.rise_ms, &RISE)?,
            lasts_ms: fits(source, &row.lasts_ms, &LASTS)?,
        })
    };
    let pulls: Result<Vec<PullLoad>, FileError> = rows.iter().map(pull).collect();
    Ok(listed(&pulls?))
}

fn random_pulls(source: FileText<'_>, row: &RandomRow) -> Result<RandomPulls, FileError> {
    let range = |pair: &Spanned<[f64; 2]>, key: &NumberKey| {
        let [low, high] = *pair.get_ref();
        let allowed = key.least..=key.most;
        if low <= high && allowed.contains(&low) && allowed.contains(&high) {
            return Ok([low, high]);
        }
        let cause = FileCause::Value {
            got: format!("[{low}, {high}]"),
            allowed: format!(
                "a lowest and a highest number from {} to {}",
                key.least, key.most
            ),
        };
        Err(source.blame(pair.span(), key.name, cause))
    };
    Ok(RandomPulls {
        every_s: fits(source, &row.every_s, &EVERY)?,
        force_g: range(&row.force_g, &FORCE)?,
        rise_ms: range(&row.rise_ms, &RISE)?,
    })
}

/// Refuses more loads than an object can have.
fn few<T>(source: FileText<'_>, rows: &[Spanned<T>], name: &str) -> Result<(), FileError> {
    let Some(extra) = rows.get(LOADS_MAX) else {
        return Ok(());
    };
    let cause = FileCause::Malformed(format!("at most {LOADS_MAX} of them can be used"));
    Err(source.blame(extra.span(), name, cause))
}

fn fits(source: FileText<'_>, number: &Number, key: &NumberKey) -> Result<f64, FileError> {
    let value = *number.get_ref();
    if (key.least..=key.most).contains(&value) {
        return Ok(value);
    }
    let cause = FileCause::Value {
        got: value.to_string(),
        allowed: format!("a number from {} to {}", key.least, key.most),
    };
    Err(source.blame(number.span(), key.name, cause))
}

/// Formats the object as a file, each number with its unit and its range. All its contacts give alike.
pub fn print(object: &Object) -> String {
    let mut text = String::from(
        "# An object between the fingers of a simulated hand: 'handscope sim --object FILE', or 'sim:?object=FILE'.\n\
         # size_mm = 40.0 (mm between thumb and index, 3 to 120) may replace [contact].\n",
    );
    let first = object.contacts.iter().find_map(|(_, contact)| *contact);
    let obstacle = first.unwrap_or(Obstacle::at(0.0, 1.0));
    let loads = &object.loads;
    put(&mut text, &STIFFNESS, Some(obstacle.stiffness), "1.0");
    let harder = obstacle.harder;
    let from = harder.map(|harder| harder.from_counts);
    put(&mut text, &HARDER_FROM, from, "10.0");
    let stiffness = harder.map(|harder| harder.stiffness);
    put(&mut text, &HARDER_STIFFNESS, stiffness, "40.0");
    put(&mut text, &YIELDS, obstacle.yields_at_g, "800.0");
    put(&mut text, &BREAKS, obstacle.breaks_at_g, "700.0");
    put(&mut text, &MASS, Some(object.mass_g), "100.0");
    put(&mut text, &FRICTION, Some(object.friction.sticking), "0.6");
    let sliding = Some(object.friction.sliding_ratio);
    put(&mut text, &SLIDING, sliding, "0.8");
    put(&mut text, &DRAG, Some(object.friction.drag_per_mm_s), "0.0");
    put(&mut text, &SCATTER, Some(object.friction.scatter), "0.05");
    put(&mut text, &TAPER, Some(object.taper_per_mm), "0.0");
    put(&mut text, &LIFT, loads.lift_after_s, "1.5");
    let stays = loads.lift_after_s.is_none();
    // Writing to a string cannot fail.
    let _written = writeln!(
        text,
        "stays_on_table = {stays} # true: never lifted, and without loads"
    );
    put(&mut text, &TAKEN, loads.taken_away_at_s, "5.0");
    put(&mut text, &BACK, loads.put_back_at_s, "8.0");
    let _written = writeln!(
        text,
        "\n[contact] # joints that touch it, and the angle at which they do, 0 to 1000"
    );
    for (dof, contact) in object.contacts.iter() {
        if let Some(contact) = contact {
            let _written = writeln!(text, "{} = {:?}", dof.name(), contact.angle);
        }
    }
    put_loads(&mut text, loads);
    text
}

fn put_loads(text: &mut String, loads: &Loads) {
    *text += "\n# The hand turns evenly from one of these directions of the weight to the next.\n";
    let example = HandTurn {
        at_s: 3.0,
        direction_deg: 360.0,
        share: 1.0,
    };
    let turns: Vec<HandTurn> = loads.turns.iter().flatten().copied().collect();
    for (sign, turn) in shown(&turns, example) {
        *text += &format!("{sign}[[turn]]\n");
        put_load(text, sign, &AT, turn.at_s);
        put_load(text, sign, &DIRECTION, turn.direction_deg);
        put_load(text, sign, &SHARE, turn.share);
    }
    *text += "\n";
    let example = PullLoad {
        at_s: 4.0,
        force_g: 200.0,
        direction_deg: 270.0,
        rise_ms: 300.0,
        lasts_ms: 500.0,
    };
    let pulls: Vec<PullLoad> = loads.pulls.iter().flatten().copied().collect();
    for (sign, pull) in shown(&pulls, example) {
        *text += &format!("{sign}[[pull]]\n");
        put_load(text, sign, &AT, pull.at_s);
        put_load(text, sign, &FORCE, pull.force_g);
        put_load(text, sign, &DIRECTION, pull.direction_deg);
        put_load(text, sign, &RISE, pull.rise_ms);
        put_load(text, sign, &LASTS, pull.lasts_ms);
    }
    let example = RandomPulls {
        every_s: 2.0,
        force_g: [50.0, 300.0],
        rise_ms: [50.0, 500.0],
    };
    let random: Vec<RandomPulls> = loads.random_pulls.into_iter().collect();
    for (sign, random) in shown(&random, example) {
        *text += &format!(
            "\n{sign}[random_pulls] # one in each interval, in any direction\n\
             {sign}every_s = {:?} # s; {} to {}\n\
             {sign}force_g = {:?} # g, lowest and highest; {} to {}\n\
             {sign}rise_ms = {:?} # ms, shortest and longest; {} to {}\n",
            random.every_s,
            EVERY.least,
            EVERY.most,
            random.force_g,
            FORCE.least,
            FORCE.most,
            random.rise_ms,
            RISE.least,
            RISE.most,
        );
    }
}

/// The loads, or the example as a comment.
fn shown<T: Copy>(loads: &[T], example: T) -> Vec<(&'static str, T)> {
    if loads.is_empty() {
        return vec![("# ", example)];
    }
    loads.iter().map(|load| ("", *load)).collect()
}

fn put_load(text: &mut String, sign: &str, key: &NumberKey, value: f64) {
    let (name, least, most, about) = (key.name, key.least, key.most, key.about);
    let _written = writeln!(
        text,
        "{sign}{name} = {value:?} # {about}; {least} to {most}"
    );
}

/// Writes a number, or an example of it as a comment.
fn put(text: &mut String, key: &NumberKey, value: Option<f64>, example: &str) {
    let (name, least, most, about) = (key.name, key.least, key.most, key.about);
    let _written = match value {
        Some(value) => writeln!(text, "{name} = {value:?} # {about}; {least} to {most}"),
        None => writeln!(text, "# {name} = {example} # {about}; {least} to {most}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn full() -> Object {
        let mut object = NamedObject::Sponge.object();
        let turn = |at_s, direction_deg| HandTurn {
            at_s,
            direction_deg,
            share: 0.5,
        };
        object.loads = Loads {
            lift_after_s: Some(0.25),
            turns: listed(&[turn(1.0, 270.0), turn(2.5, -90.0)]),
            pulls: listed(&[PullLoad {
                at_s: 3.0,
                force_g: 120.0,
                direction_deg: 45.0,
                rise_ms: 20.0,
                lasts_ms: 300.0,
            }]),
            random_pulls: Some(RandomPulls {
                every_s: 2.0,
                force_g: [10.0, 90.0],
                rise_ms: [5.0, 600.0],
            }),
            taken_away_at_s: Some(9.0),
            put_back_at_s: Some(12.0),
        };
        object
    }

    #[test]
    fn what_is_printed_reads_back() {
        let mut all: Vec<Object> = NamedObject::ALL.map(NamedObject::object).to_vec();
        all.extend([full(), Object::rigid(400.0), Object::soft_ball()]);
        for object in all {
            let text = print(&object);
            assert_eq!(parse(&text), Ok(object), "{text}");
        }
    }

    #[test]
    fn the_examples_in_the_comments_are_valid() {
        let text = print(&NamedObject::Block.object());
        let uncommented: Vec<&str> = text
            .lines()
            .skip(2)
            .filter(|line| !line.starts_with("# The hand turns"))
            .map(|line| line.strip_prefix("# ").unwrap_or(line))
            .collect();
        let object = parse(&uncommented.join("\n")).unwrap();
        assert!(object.loads.random_pulls.is_some());
        assert_eq!(object.loads.put_back_at_s, Some(8.0));
    }

    #[test]
    fn a_short_file_takes_its_place_from_its_size() {
        let object = parse("size_mm = 40\nstiffness = 30\nmass_g = 60\nfriction = 0.45\n").unwrap();
        let egg = NamedObject::Egg.object();
        let place = |object: &Object| object.contacts.map(|contact| contact.map(|on| on.angle));
        assert_eq!(place(&object), place(&egg));
        assert_eq!(object.friction, egg.friction);
        assert_eq!(object.loads.lift_after_s, Some(LIFT_AFTER_S));
    }

    #[test]
    fn a_wrong_file_is_refused_with_line_and_reason() {
        let usual = "stiffness = 30\nmass_g = 60\nfriction = 0.45\n";
        let sized = format!("size_mm = 40\n{usual}");
        for (text, words) in [
            (usual.to_owned(), "`size_mm`: it is missing"),
            (format!("{sized}colour = 3\n"), "colour"),
            (
                "size_mm = 40\nstiffness = 30\nfriction = 1\n".into(),
                "mass_g",
            ),
            (format!("{sized}mass_g = 2\n"), "duplicate key"),
            (
                format!("size_mm = 200\n{usual}"),
                "line 1, `size_mm`: 200 is not a number from 3 to 120",
            ),
            (format!("{sized}breaks_at_g = nan\n"), "NaN is not a number"),
            (format!("{sized}taper_per_mm = inf\n"), "inf is not"),
            (
                format!("{sized}[contact]\nindex = 4\n"),
                "conflicts with `contact`",
            ),
            (format!("{usual}[contact]\nwrist = 4\n"), "wrist"),
            (format!("{usual}[contact]\nindex = 1001\n"), "0 to 1000"),
            (format!("{sized}harder_from = 4\n"), "needs both"),
            (
                format!("{sized}harder_from = 4\nharder_stiffness = 2\n"),
                "a number from 30, the first stiffness",
            ),
            (
                format!(
                    "{sized}[[turn]]\nat_s = 2\ndirection_deg = 0\n[[turn]]\nat_s = 1\ndirection_deg = 0\n"
                ),
                "line 9, `at_s`: 1 is not a time from 2 s",
            ),
            (format!("{sized}[[pull]]\nat_s = 2\n"), "force_g"),
            (
                format!(
                    "{sized}{}",
                    "[[turn]]\nat_s = 2\ndirection_deg = 0\n".repeat(17)
                ),
                "at most 16",
            ),
            (
                format!("{sized}[random_pulls]\nevery_s = 2\nforce_g = [5, 2]\nrise_ms = [5, 9]\n"),
                "a lowest and a highest number",
            ),
            ("not toml".into(), "line 1"),
        ] {
            let error = parse(&text).unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
            assert!(!error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn neither_a_name_nor_a_file_is_refused_with_the_names() {
        for named in NamedObject::ALL {
            assert_eq!(named_or_file(named.name()), Ok(named.object()));
            let error = named_or_file("/nowhere/egg.toml").unwrap_err().to_string();
            assert!(error.contains(named.name()) && error.contains("/nowhere/egg.toml"));
        }
        let error = in_scenario("egg", Scenario::Faults).unwrap_err();
        assert!(error.to_string().contains("faults"));
        assert!(in_scenario("egg", Scenario::Rigid).is_ok());
    }
}
