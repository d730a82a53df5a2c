//! What came of writes and of SAVE, why something cannot be done, and what could hurt, as sentences in the window's language.

use crate::app::params::refusal::ParamRefusal;
use crate::app::params::state::{Doing, SaveEnd};
use crate::params::changes::{RowOutcome, RowVerdict};
use crate::params::rows::ParamId;
use crate::record::{Doubt, NotSent, SaveDoubt, Saved};
use crate::ui::kit::Look;
use crate::ui::text::phrase::Text;
use crate::ui::text::{device, errors, words};

/// What is going on; none where nothing is.
pub(crate) const fn doing(doing: Doing) -> Option<Text> {
    match doing {
        Doing::Nothing => None,
        Doing::Reading => Some(device::READING),
        Doing::Applying => Some(device::APPLYING),
        Doing::BackingUp => Some(device::BACKING_UP),
        Doing::Saving => Some(device::SAVING),
    }
}

/// A row's own name, in its group.
pub(crate) const fn name(id: ParamId) -> Text {
    match id {
        ParamId::HandId => device::HAND_ID,
        ParamId::ReduRatio => device::REDU_RATIO,
        ParamId::IpAddress => device::IP_ADDRESS,
        ParamId::DefaultSpeed(dof) | ParamId::DefaultForce(dof) => words::dof(dof),
    }
}

/// A row's name alone: `Index speed`.
pub(crate) fn whole_name(look: Look, id: ParamId) -> String {
    let own = look.say(name(id));
    match id {
        ParamId::DefaultSpeed(_) => format!("{own} {}", look.say(device::SPEED)),
        ParamId::DefaultForce(_) => format!("{own} {}", look.say(device::FORCE)),
        _ => own.to_owned(),
    }
}

/// What a row does.
pub(crate) const fn about(id: ParamId) -> Text {
    match id {
        ParamId::HandId => device::ABOUT_HAND_ID,
        ParamId::ReduRatio => device::ABOUT_REDU_RATIO,
        ParamId::IpAddress => device::ABOUT_IP,
        ParamId::DefaultSpeed(_) => device::ABOUT_SPEED,
        ParamId::DefaultForce(_) => device::ABOUT_FORCE,
    }
}

/// What came of a row.
pub(crate) fn row_end(look: Look, end: &RowOutcome) -> String {
    let say = |text| look.say(text);
    match &end.verdict {
        RowVerdict::Applied => say(device::APPLIED).into(),
        RowVerdict::Refused { reason } => format!(
            "{}: {} ({} {})",
            say(device::NOT_TAKEN),
            errors::reason(look, reason),
            say(device::WANTED),
            end.wanted
        ),
        RowVerdict::Dropped => format!(
            "{} ({} {})",
            say(device::DROPPED),
            say(device::WANTED),
            end.wanted
        ),
        RowVerdict::Altered => format!("{} {}", say(device::ALTERED), end.wanted),
        RowVerdict::Unverified(doubt) => {
            let why = match doubt {
                Doubt::NotReadBack => device::DOUBT_NOT_READ,
                Doubt::Ambiguous => device::DOUBT_AMBIGUOUS,
                Doubt::LinkLost => device::DOUBT_LINK,
            };
            format!("{}: {}", say(device::UNVERIFIED), say(why))
        }
        RowVerdict::NotSent(why) => {
            format!("{}: {}", say(device::NOT_WRITTEN), not_sent(look, *why))
        }
    }
}

fn not_sent(look: Look, why: NotSent) -> String {
    let text = match why {
        NotSent::Armed => device::refusal(ParamRefusal::Armed),
        NotSent::Holding => device::refusal(ParamRefusal::Holding),
        NotSent::Moving => device::refusal(ParamRefusal::Moving),
        NotSent::RestUnknown => device::refusal(ParamRefusal::RestUnknown),
        NotSent::TooSoon { wait } => {
            let wait = wait.as_secs_f64().ceil();
            return format!("{} {wait} s", look.say(device::TOO_SOON));
        }
    };
    look.say(text).into()
}

/// How a SAVE ended.
pub(crate) fn save_end(look: Look, end: &SaveEnd) -> String {
    match end {
        SaveEnd::Told(told) => saved(look, told),
        SaveEnd::NoBackup { message } => {
            let message = errors::system(look, message);
            format!("{} {message}", look.say(device::SAVE_NO_BACKUP))
        }
        SaveEnd::NotAsked(error) => format!(
            "{} {}",
            look.say(device::SAVE_NOT_SENT),
            errors::request(look, error)
        ),
        SaveEnd::NotApplied => look.say(device::SAVE_NOT_APPLIED).into(),
        SaveEnd::NotNoted(told, message) => format!(
            "{} {} {}",
            saved(look, told),
            look.say(device::SAVE_NOT_NOTED),
            errors::system(look, message)
        ),
    }
}

/// True if what was to be saved is saved, as far as the wire can tell.
pub(crate) const fn is_saved(end: &SaveEnd) -> bool {
    matches!(end, SaveEnd::Told(Saved::Confirmed | Saved::ReadBack))
}

fn saved(look: Look, saved: &Saved) -> String {
    let say = |text| look.say(text);
    match saved {
        Saved::Confirmed => say(device::SAVE_CONFIRMED).into(),
        Saved::ReadBack => say(device::SAVE_READ_BACK).into(),
        Saved::Failed { code } => format!("{} ({code})", say(device::SAVE_FAILED)),
        Saved::Unknown { why } => {
            let why = match why {
                SaveDoubt::NoResult => device::SAVE_NO_RESULT,
                SaveDoubt::Unanswered => device::SAVE_UNANSWERED,
                SaveDoubt::NotReadBack => device::SAVE_NOT_READ,
                SaveDoubt::LinkLost => device::SAVE_LINK,
            };
            format!(
                "{} {} {}",
                say(device::SAVE_UNKNOWN),
                say(why),
                say(device::SAVE_UNKNOWN_ADVICE)
            )
        }
        Saved::Refused { reason } => {
            format!(
                "{} {}",
                say(device::SAVE_REFUSED),
                errors::reason(look, reason)
            )
        }
        Saved::NotSent(why) => {
            format!("{} {}", say(device::SAVE_NOT_SENT), not_sent(look, *why))
        }
    }
}

/// Why a file was written; unknown words as they stand there.
pub(crate) fn why(look: Look, why: &str) -> String {
    let known = [
        device::WHY_DUMP,
        device::WHY_BEFORE_SAVE,
        device::WHY_BEFORE_APPLY,
        device::WHY_BEFORE_RESET,
    ];
    let known = known.into_iter().find(|text| text.en == why);
    known.map_or_else(|| why.to_owned(), |text| look.say(text).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::settings::{Language, Theme};
    use crate::ui::theme::Palette;
    use std::time::Duration;

    #[test]
    fn only_what_the_wire_can_tell_is_said_of_a_save() {
        let look = Look {
            palette: Palette::of(Theme::Dark),
            language: Language::En,
            side: crate::hand::kinematics::Side::Right,
        };
        let why = SaveDoubt::NoResult;
        let wait = Duration::from_millis(2100);
        for (saved, words, is_ok) in [
            (
                Saved::Confirmed,
                "the hand says that its parameters are in flash",
                true,
            ),
            (Saved::ReadBack, "Only the next power-up shows", true),
            (Saved::Failed { code: 255 }, "Not saved", false),
            (
                Saved::Unknown { why },
                "no result within 3 s. Switch the hand off",
                false,
            ),
            (Saved::NotSent(NotSent::TooSoon { wait }), "wait 3 s", false),
        ] {
            let end = SaveEnd::Told(saved);
            let told = save_end(look, &end);
            assert!(told.contains(words), "{told}");
            assert_eq!(is_saved(&end), is_ok, "{told}");
        }
    }
}
