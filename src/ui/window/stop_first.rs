//! Filters the actions of a frame that contains a stop.

use crate::app::action::Action;

/// Puts the stop before all other actions, and drops those that must not pass with a stop, such as motion.
pub(super) fn stop_first(mut actions: Vec<Action>, stopped: bool) -> Vec<Action> {
    if !stopped && !actions.contains(&Action::Stop) {
        return actions;
    }
    actions.retain(|action| action.effect().passes_with_stop());
    actions.insert(0, Action::Stop);
    actions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, Dof};

    #[test]
    fn a_stop_goes_first_and_nothing_moves_in_the_same_frame() {
        let asked = || {
            vec![
                Action::Arm,
                Action::Target(Dof::Index, Angle::MAX),
                Action::FindPorts,
            ]
        };
        let stopped = [Action::Stop, Action::FindPorts];
        assert_eq!(stop_first(asked(), true), stopped);
        let mut with_button = asked();
        with_button.push(Action::Stop);
        assert_eq!(stop_first(with_button, false), stopped);
        assert_eq!(stop_first(asked(), false), asked());
    }
}
