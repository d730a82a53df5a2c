//! Parsers of values on the command line. Clap prints the error as it is.

use crate::hand::kinematics::Side;
use crate::hand::register::{self, REGISTERS, Register};
use crate::hand::{Angle, Dof, Force, HandId, Speed};
use crate::sim::body_params::file;
use crate::sim::object_file;
use crate::transport::{Endpoint, EndpointError};
use std::ops::RangeInclusive;
use std::path::Path;
use std::str::FromStr;
use std::time::Duration;

/// Number of known names suggested for a wrong one.
const SUGGESTED: usize = 3;
/// Maximum time of an option in seconds: a day.
const SECONDS_MAX: f64 = 86_400.0;

pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text
        .parse()
        .map_err(|_not_one| format!("'{text}' is not a number of seconds"))?;
    if !(0.0..=SECONDS_MAX).contains(&seconds) {
        return Err(format!("{text} is not between 0 and {SECONDS_MAX} seconds"));
    }
    Ok(Duration::from_secs_f64(seconds))
}

/// A time in a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RecordingTime {
    /// Time after the start.
    FromStart(Duration),
    /// Time before the end.
    BeforeEnd(Duration),
}

/// Parses seconds from the start of a recording, or with a minus sign before its end.
pub(crate) fn recording_time(text: &str) -> Result<RecordingTime, String> {
    match text.strip_prefix('-') {
        Some(before) if !before.starts_with(['+', '-']) => {
            seconds(before).map(RecordingTime::BeforeEnd)
        }
        Some(_) => Err(format!("'{text}' is not a number of seconds")),
        None => seconds(text).map(RecordingTime::FromStart),
    }
}

/// Parses a number in a range; `what` describes the expected value.
pub(crate) fn number<T: FromStr + PartialOrd>(
    text: &str,
    range: RangeInclusive<T>,
    what: &str,
) -> Result<T, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("'{text}' is not {what}"))
}

/// Parses a hand's URL. The files of body and object that it names must be valid: otherwise the hand would fail to answer without an
/// explanation.
pub(crate) fn hand(text: &str) -> Result<Endpoint, String> {
    let endpoint: Endpoint = text
        .parse()
        .map_err(|error: EndpointError| error.to_string())?;
    if let Endpoint::Sim { body, object, .. } = &endpoint {
        if let Some(path) = body {
            file::read(Path::new(path)).map_err(|error| error.to_string())?;
        }
        if let Some(text) = object {
            object_file::named_or_file(text).map_err(|error| error.to_string())?;
        }
    }
    Ok(endpoint)
}

pub(crate) fn dof(text: &str) -> Result<Dof, String> {
    let named = Dof::ALL.into_iter().find(|dof| dof.name() == text);
    named.ok_or_else(|| {
        let known = Dof::ALL.map(Dof::name).join(", ");
        format!("'{text}' is not a joint: choose {known}")
    })
}

/// A speed other than 0.
pub(crate) fn moving(speed: Speed) -> Result<Speed, String> {
    if speed == Speed::MIN {
        return Err("at a speed of 0 nothing moves".into());
    }
    Ok(speed)
}

/// A force threshold within the rating, which needs no extra consent.
pub(crate) fn rated(force: Force) -> Result<Force, String> {
    if force > Force::RATED {
        let rated = Force::RATED.get();
        return Err(format!("a finger is rated for {rated} g (20 N)"));
    }
    Ok(force)
}

pub(crate) fn side(text: &str) -> Result<Side, String> {
    match text {
        "right" => Ok(Side::Right),
        "left" => Ok(Side::Left),
        _ => Err("write right or left".into()),
    }
}

pub(crate) fn whole(text: &str) -> Result<i64, String> {
    text.parse()
        .map_err(|_not_one| format!("'{text}' is not a whole number"))
}

pub(crate) fn angle(text: &str) -> Result<Angle, String> {
    Angle::new(whole(text)?).map_err(|error| error.to_string())
}

pub(crate) fn speed(text: &str) -> Result<Speed, String> {
    Speed::new(whole(text)?).map_err(|error| error.to_string())
}

pub(crate) fn moving_speed(text: &str) -> Result<Speed, String> {
    speed(text).and_then(moving)
}

pub(crate) fn rated_force(text: &str) -> Result<Force, String> {
    force(text).and_then(rated)
}

pub(crate) fn force(text: &str) -> Result<Force, String> {
    Force::new(whole(text)?).map_err(|error| error.to_string())
}

/// Hand IDs in the given order, without duplicates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct HandIds(pub(crate) Vec<HandId>);

/// Parses a list of hand IDs: `3`, `1,2,3`, `1-10`, or a mixture.
pub(crate) fn hand_ids(text: &str) -> Result<HandIds, String> {
    let mut ids: Vec<u8> = Vec::new();
    for part in text.split(',').map(str::trim) {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let (first, last) = (hand_id(first, text)?, hand_id(last, text)?);
        if first > last {
            return Err(format!("'{part}' goes backwards: write {last}-{first}"));
        }
        if let Some(id) = (first..=last).find(|id| ids.contains(id)) {
            return Err(format!(
                "id {id} is named twice: two hands of one id would both answer"
            ));
        }
        ids.extend(first..=last);
    }
    Ok(HandIds(ids.into_iter().map(HandId::nearest).collect()))
}

fn hand_id(text: &str, list: &str) -> Result<u8, String> {
    let id = text.trim().parse().ok();
    let id = id.and_then(|number: i64| HandId::new(number).ok());
    id.map(HandId::get).ok_or_else(|| {
        format!("'{list}' is not a list of ids: write numbers from 1 to 254, such as 1,2,3 or 1-10")
    })
}

/// Finds the register of this name, ignoring case. The error names the most similar ones.
pub(crate) fn register(name: &str) -> Result<&'static Register, String> {
    let known = || REGISTERS.iter().map(|row| row.name);
    register::by_name(name).ok_or_else(|| {
        format!(
            "the hand has no register of this name; nearest are {}; 'handscope registers' lists all",
            nearest(name, known()).join(", ")
        )
    })
}

/// The most similar known names, best first.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let name = name.to_uppercase();
    let mut ranked: Vec<(usize, &str)> = known
        .map(|one| (unlikeness(&name, &one.to_uppercase()), one))
        .collect();
    ranked.sort_by_key(|(unlike, _)| *unlike);
    ranked
        .into_iter()
        .take(SUGGESTED)
        .map(|(_, one)| one)
        .collect()
}

/// Edit distance, with a bonus if one name contains the other.
fn unlikeness(name: &str, known: &str) -> usize {
    let holds = name.len() > 2 && (known.contains(name) || name.contains(known));
    if holds {
        1
    } else {
        2 + strsim::levenshtein(name, known)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids(text: &str) -> Result<Vec<u8>, String> {
        hand_ids(text).map(|ids| ids.0.into_iter().map(HandId::get).collect())
    }

    #[test]
    fn lists_and_ranges_keep_their_order() {
        for (text, wanted) in [
            ("1", &[1][..]),
            ("254", &[254]),
            ("3,1,2", &[3, 1, 2]),
            ("1-4", &[1, 2, 3, 4]),
            (" 7 , 1-2 ", &[7, 1, 2]),
        ] {
            assert_eq!(ids(text).unwrap(), wanted, "{text}");
        }
    }

    #[test]
    fn bad_lists_get_one_clear_sentence() {
        for (text, words) in [
            ("", "not a list of ids"),
            ("0", "1 to 254"),
            ("255", "1 to 254"),
            ("1,,2", "not a list of ids"),
            ("1;2", "not a list of ids"),
            ("one", "not a list of ids"),
            ("-3", "not a list of ids"),
            ("1-2-3", "not a list of ids"),
            ("1-300", "1 to 254"),
            ("9-3", "write 3-9"),
            ("1,2,1", "id 1 is named twice"),
            ("1-5,3", "id 3 is named twice"),
        ] {
            let error = ids(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
            assert_eq!(error.lines().count(), 1);
        }
    }

    #[test]
    fn a_mistyped_register_is_met_with_the_right_one() {
        for (wrong, right) in [
            ("ANGLE_ATC", "ANGLE_ACT"),
            ("angle_act(m)", "ANGLE_ACT"),
            ("TEMPERATURE", "TEMP"),
            ("hand_ide", "HAND_ID"),
            ("SPEED", "SPEED_SET"),
        ] {
            let words = register(wrong).unwrap_err();
            assert!(words.contains(right), "{wrong}: {words}");
        }
    }

    #[test]
    fn every_register_is_found_in_any_letter_case() {
        for row in &REGISTERS {
            assert_eq!(register(&row.name.to_lowercase()).unwrap(), row);
        }
    }
}
