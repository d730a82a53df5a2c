//! `sim --quirk NAME=VALUE`: what the simulated hand does where the manual leaves a choice. The switches live in
//! [`crate::sim`].

use crate::sim::{Personality, SWITCHES};
use std::fmt::Write as _;

/// A switch and a position that it has.
pub(crate) type Quirk = (String, String);

/// Reads `NAME=VALUE`.
pub(crate) fn quirk(text: &str) -> Result<Quirk, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("'{text}' is not a quirk: write NAME=VALUE"))?;
    let known = Personality::default().set(name, value);
    known.map_err(|error| error.to_string())?;
    Ok((name.into(), value.into()))
}

/// A hand with these quirks; where a switch is set twice, the last one counts.
pub(crate) fn personality(quirks: &[Quirk]) -> Personality {
    let mut personality = Personality::default();
    for (name, value) in quirks {
        let known = personality.set(name, value);
        debug_assert!(known.is_ok(), "it was looked up when it was read");
    }
    personality
}

/// All switches and positions, for the help text.
pub(crate) fn list() -> String {
    let mut text = String::from(
        "Quirks: what the hand does where the manual leaves a choice. The first value of each is the default.\n",
    );
    for switch in SWITCHES {
        let values = switch.values.join("|");
        // Writing to a string cannot fail.
        let _written = writeln!(text, "  {}={values}\n      {}", switch.name, switch.about);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::GapAnswer;

    #[test]
    fn quirks_are_read_by_name_and_wrong_ones_say_what_there_is() {
        let all = [
            quirk("gap=refused").unwrap(),
            quirk("doubles=some").unwrap(),
        ];
        assert_eq!(personality(&all).gap, GapAnswer::Refused);
        for (text, part) in [
            ("gap", "NAME=VALUE"),
            ("gap=ajar", "through, refused"),
            ("warp=9", "no quirk 'warp'"),
        ] {
            let error = quirk(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        for switch in SWITCHES {
            assert!(list().contains(switch.name));
        }
    }
}
