//! Values as a person types them on the command line. The error is the sentence that clap shows.

use crate::hand::{Angle, Dof, Force, Speed};
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

/// The longest time an option takes, s: a day.
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

/// A number within bounds; `what` says what it should be.
pub(crate) fn number<T: FromStr + PartialOrd>(
    text: &str,
    range: RangeInclusive<T>,
    what: &str,
) -> Result<T, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("'{text}' is not {what}"))
}

pub(crate) fn dof(text: &str) -> Result<Dof, String> {
    let named = Dof::ALL.into_iter().find(|dof| dof.name() == text);
    named.ok_or_else(|| {
        let known = Dof::ALL.map(Dof::name).join(", ");
        format!("'{text}' is not a joint: choose {known}")
    })
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

pub(crate) fn force(text: &str) -> Result<Force, String> {
    Force::new(whole(text)?).map_err(|error| error.to_string())
}
