//! Finds the recording that contains a time range: the replayed one, or one recorded since the program started, which uses
//! the program's clock.

use crate::app::recordings::list::{RecordingAction, RecordingsState, Timeline};
use crate::hand::Moment;
use std::time::Duration;

/// Lead-in shown before the requested range.
const BEFORE: Duration = Duration::from_secs(2);

/// Action that replays a time range of a hand in a loop, with a short lead-in; `None` if no recording contains its start.
pub fn replay_of(
    recordings: &RecordingsState,
    replayed: Option<&Timeline>,
    hand: &str,
    (from, to): (Moment, Moment),
) -> Option<RecordingAction> {
    let before = Moment::from_duration(from.since(Moment::ZERO).saturating_sub(BEFORE));
    let (path, first) = match replayed {
        Some(line) => (line.first..=line.last)
            .contains(&from)
            .then_some((&line.path, line.first)),
        None => {
            let mut own = recordings.own.iter();
            let own = own.rfind(|own| own.holds(hand, from));
            own.map(|own| (&own.path, own.first))
        }
    }?;
    Some(RecordingAction::OpenAt(
        path.clone(),
        (before.max(first), to),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::recordings::list::OwnRecording;

    const fn second(at: u64) -> Moment {
        Moment::from_micros(at * 1_000_000)
    }

    #[test]
    fn the_session_that_holds_the_moment_of_that_hand_is_opened_two_seconds_before() {
        let own = |name: &str, hand: &str, first, last| OwnRecording {
            path: name.into(),
            hand: hand.into(),
            first: second(first),
            last: second(last),
        };
        let recordings = RecordingsState {
            own: vec![
                own("a", "x", 10, 20),
                own("b", "y", 10, 20),
                own("c", "x", 30, 40),
            ],
            ..RecordingsState::default()
        };
        let check = |hand: &str, from, wanted: Option<(&str, u64)>| {
            let stretch = (second(from), second(50));
            let wanted = wanted.map(|(name, first)| {
                RecordingAction::OpenAt(name.into(), (second(first), second(50)))
            });
            assert_eq!(
                replay_of(&recordings, None, hand, stretch),
                wanted,
                "{hand} {from}"
            );
        };
        check("x", 15, Some(("a", 13)));
        check("y", 15, Some(("b", 13)));
        check("x", 11, Some(("a", 10)));
        check("x", 25, None);
        check("x", 40, Some(("c", 38)));
        check("z", 15, None);
    }
}
