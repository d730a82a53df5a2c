//! What passes of all that was asked for in one frame in which somebody wants to stop.

use crate::app::action::Action;
use crate::app::hand::Play;
use crate::app::hand::held_key::HoldKey;
use crate::app::inputs::InputAction;
use crate::app::params::action::ParamAction;
use crate::app::procedures::ProcedureAction;
use crate::app::trials::TrialAction;

/// Stop goes ahead of everything, and nothing that moves the hand passes in the same frame.
pub(super) fn stop_first(mut actions: Vec<Action>, stopped: bool) -> Vec<Action> {
    if !stopped && !actions.contains(&Action::Stop) {
        return actions;
    }
    actions.retain(|action| {
        !matches!(
            action,
            Action::Stop
                | Action::Arm
                | Action::HoldKey(HoldKey::Pressed)
                | Action::Input(
                    InputAction::GrantStream
                        | InputAction::GrantDds
                        | InputAction::GrantPad
                        | InputAction::GrantMirror
                        | InputAction::GrantClient(_)
                )
                | Action::Target(..)
                | Action::Preset(_)
                | Action::Gesture(_)
                | Action::Recall(_)
                | Action::Param(
                    ParamAction::Apply | ParamAction::Undo | ParamAction::Save | ParamAction::Agree
                )
                | Action::Trial(TrialAction::Start)
                | Action::Procedure(ProcedureAction::Begin | ProcedureAction::Save)
                | Action::Play(Play::Start(_) | Play::Step(_) | Play::Resume)
        )
    });
    actions.insert(0, Action::Stop);
    actions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::hand::Preset;
    use crate::hand::{Angle, Dof, Gesture};
    use crate::poses::library::{EntryId, PoseId, SequenceId};

    #[test]
    fn a_stop_goes_first_and_nothing_moves_in_the_same_frame() {
        let moves = || {
            vec![
                Action::Arm,
                Action::HoldKey(HoldKey::Pressed),
                Action::Input(InputAction::GrantStream),
                Action::Input(InputAction::GrantPad),
                Action::Input(InputAction::GrantDds),
                Action::Input(InputAction::GrantMirror),
                Action::Target(Dof::Index, Angle::MAX),
                Action::Preset(Preset::Open),
                Action::Gesture(Gesture::MIN),
                Action::Recall(PoseId(1)),
                Action::Procedure(ProcedureAction::Begin),
                Action::Trial(TrialAction::Start),
                Action::Play(Play::Start(EntryId::Sequence(SequenceId(1)))),
                Action::Play(Play::Step(SequenceId(1))),
                Action::Play(Play::Resume),
                Action::Param(ParamAction::Apply),
                Action::Param(ParamAction::Undo),
                Action::Param(ParamAction::Save),
                Action::Param(ParamAction::Agree),
                Action::FindPorts,
            ]
        };
        let stopped = [Action::Stop, Action::FindPorts];
        assert_eq!(stop_first(moves(), true), stopped);
        let mut with_button = moves();
        with_button.push(Action::Stop);
        assert_eq!(stop_first(with_button, false), stopped);
        assert_eq!(stop_first(moves(), false), moves());
    }
}
