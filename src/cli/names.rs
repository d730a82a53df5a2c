//! Names that a person types: registers by the manual's names, and the known names nearest to a mistyped one.

use crate::hand::register::{self, REGISTERS, Register};

/// How many known names are suggested for a wrong one.
const SUGGESTED: usize = 3;

/// The register of this name, in any letter case. The error names those that look most like it.
pub(crate) fn register(name: &str) -> Result<&'static Register, String> {
    let known = || REGISTERS.iter().map(|row| row.name);
    register::by_name(name).ok_or_else(|| {
        format!(
            "the hand has no register of this name; nearest are {}; 'handscope registers' lists all",
            nearest(name, known()).join(", ")
        )
    })
}

/// The known names that look most like this one, best first.
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

/// Letters to change, with a bonus for names that hold each other.
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
