//! Assignment of a gamepad's controls. Exactly one control is the dead-man and one is STOP, whatever the user changes.

use crate::inputs::pad::control::{ControlKind, PadControl};
use std::collections::BTreeMap;

/// Longest name of a pose, characters.
pub const POSE_CHARS_MAX: usize = 64;

/// Action of a control.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum PadAction {
    Nothing,
    /// While held, the hand follows the gamepad. On release it stops.
    DeadMan,
    /// Stops the hand, whether the dead-man is held or not.
    Stop,
    /// While held, the hand moves to the pose of this name.
    Pose(String),
    /// Bends the chosen fingers, by amount.
    CloseFingers,
    /// Bends the thumb, by amount.
    BendThumb,
    /// Closes thumb and index to a gap, by amount; released is the widest. Overrides the other triggers and sticks.
    CloseGap,
    /// Left and right rotate the thumb while the stick is pushed.
    RotateThumb,
    /// Chooses the fingers to close.
    ChooseFingers,
}

/// Actions of all controls.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadMap {
    /// Controls not listed do nothing. Without [`PadAction::Nothing`].
    actions: BTreeMap<PadControl, PadAction>,
}

/// Reason why an action cannot be assigned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PadMapError {
    /// The control is of the wrong type, such as a button for an action by amount.
    #[error("this control cannot do that")]
    WrongKind,
    /// The control is the only dead-man or STOP.
    #[error("one control must do this: give it to another one, which takes it away here")]
    OneMust,
}

impl PadAction {
    /// Actions available to this type of control, except poses.
    pub const fn choices(kind: ControlKind) -> &'static [Self] {
        match kind {
            ControlKind::Button => &[Self::Nothing, Self::DeadMan, Self::Stop],
            ControlKind::Trigger => &[
                Self::Nothing,
                Self::CloseFingers,
                Self::BendThumb,
                Self::CloseGap,
            ],
            ControlKind::Stick => &[Self::Nothing, Self::ChooseFingers, Self::RotateThumb],
        }
    }

    /// True if this type of control can do it.
    pub fn fits(&self, kind: ControlKind) -> bool {
        match self {
            Self::Pose(_) => kind == ControlKind::Button,
            plain => Self::choices(kind).contains(plain),
        }
    }

    /// True if exactly one control must do it.
    pub const fn is_single(&self) -> bool {
        matches!(self, Self::DeadMan | Self::Stop)
    }
}

impl PadMap {
    /// Default assignment, with built-in poses.
    pub fn usual() -> Self {
        let pose = |name: &str| PadAction::Pose(name.into());
        Self {
            actions: BTreeMap::from([
                (PadControl::RightTrigger, PadAction::CloseFingers),
                (PadControl::LeftTrigger, PadAction::BendThumb),
                (PadControl::RightStick, PadAction::RotateThumb),
                (PadControl::LeftStick, PadAction::ChooseFingers),
                (PadControl::LeftBumper, PadAction::DeadMan),
                (PadControl::East, PadAction::Stop),
                (PadControl::South, pose("Pinch")),
                (PadControl::West, pose("Point")),
                (PadControl::North, pose("Open")),
            ]),
        }
    }

    /// Creates a map; `None` unless one control is the dead-man and one is STOP, and each action fits its control.
    pub fn of(actions: BTreeMap<PadControl, PadAction>) -> Option<Self> {
        let count = |wanted: &PadAction| {
            let all = actions.values();
            all.filter(|action| *action == wanted).count()
        };
        let has_each = count(&PadAction::DeadMan) == 1 && count(&PadAction::Stop) == 1;
        let fit = |(control, action): (&PadControl, &PadAction)| action.fits(control.kind());
        let fits = actions.iter().all(fit);
        (has_each && fits).then(|| {
            let mut actions = actions;
            actions.retain(|_, action| *action != PadAction::Nothing);
            Self { actions }
        })
    }

    /// Action of a control.
    pub fn action(&self, control: PadControl) -> &PadAction {
        self.actions.get(&control).unwrap_or(&PadAction::Nothing)
    }

    /// Names of the poses assigned to its buttons.
    pub fn poses(&self) -> impl Iterator<Item = &str> {
        self.actions.values().filter_map(|action| match action {
            PadAction::Pose(name) => Some(name.as_str()),
            _ => None,
        })
    }

    /// Controls with this action.
    pub fn doing(&self, action: &PadAction) -> impl Iterator<Item = PadControl> {
        let all = self.actions.iter();
        all.filter_map(move |(control, own)| (own == action).then_some(*control))
    }

    /// Returns the map with another action for one control. The dead-man and STOP swap places with its former action.
    ///
    /// # Errors
    /// [`PadMapError`] if the action does not fit the control, or would leave no dead-man or no STOP.
    pub fn with(&self, control: PadControl, action: PadAction) -> Result<Self, PadMapError> {
        if !action.fits(control.kind()) {
            return Err(PadMapError::WrongKind);
        }
        let before = self.action(control).clone();
        if before == action {
            return Ok(self.clone());
        }
        let mut actions = self.actions.clone();
        let other = action.is_single().then(|| self.doing(&action).next());
        match other.flatten() {
            Some(other) => actions.insert(other, before),
            None if before.is_single() => return Err(PadMapError::OneMust),
            None => None,
        };
        actions.insert(control, action);
        Self::of(actions).ok_or(PadMapError::OneMust)
    }
}
