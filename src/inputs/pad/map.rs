//! What each control of a gamepad does. Exactly one is the dead-man and one is STOP, whatever is changed.

use crate::inputs::pad::control::{ControlKind, PadControl};
use std::collections::BTreeMap;

/// Characters of the name of a pose.
pub const POSE_CHARS_MAX: usize = 64;

/// What a control does.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum PadAction {
    Nothing,
    /// Held: the hand follows the gamepad. Let go: it stops.
    DeadMan,
    /// Stops the hand, whether the dead-man is held or not.
    Stop,
    /// Held: the hand goes to the pose of this name.
    Pose(String),
    /// Bends the fingers that are chosen, by amount.
    CloseFingers,
    /// Bends the thumb, by amount.
    BendThumb,
    /// Closes thumb and index to a gap, by amount: let go the widest. What other triggers and sticks ask does not count then.
    CloseGap,
    /// Left and right rotate the thumb as long as it is pushed.
    RotateThumb,
    /// Chooses which fingers are closed.
    ChooseFingers,
}

/// What every control does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadMap {
    /// What is not in here does nothing. Without [`PadAction::Nothing`].
    actions: BTreeMap<PadControl, PadAction>,
}

/// Why a control cannot do that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MapRefusal {
    /// A button does not know amounts, and so on.
    #[error("this control cannot do that")]
    WrongKind,
    /// It is the dead-man or STOP, and no other would be.
    #[error("one control must do this: give it to another one, which takes it away here")]
    OneMust,
}

impl PadAction {
    /// What a control of this kind can do, without the poses.
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

    /// Whether a control of this kind can do it.
    pub fn fits(&self, kind: ControlKind) -> bool {
        match self {
            Self::Pose(_) => kind == ControlKind::Button,
            plain => Self::choices(kind).contains(plain),
        }
    }

    /// Whether exactly one control does it.
    pub const fn is_single(&self) -> bool {
        matches!(self, Self::DeadMan | Self::Stop)
    }
}

impl PadMap {
    /// What a gamepad does before the user changes it. The poses are shipped ones.
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

    /// Of these actions; `None` unless one control is the dead-man and one is STOP, and each can do what it shall.
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

    /// What a control does.
    pub fn action(&self, control: PadControl) -> &PadAction {
        self.actions.get(&control).unwrap_or(&PadAction::Nothing)
    }

    /// The names of the poses that its buttons go to.
    pub fn poses(&self) -> impl Iterator<Item = &str> {
        self.actions.values().filter_map(|action| match action {
            PadAction::Pose(name) => Some(name.as_str()),
            _ => None,
        })
    }

    /// The controls that do this.
    pub fn doing(&self, action: &PadAction) -> impl Iterator<Item = PadControl> {
        let all = self.actions.iter();
        all.filter_map(move |(control, own)| (own == action).then_some(*control))
    }

    /// The same with another action for one control. The dead-man and STOP change places with what it did.
    ///
    /// # Errors
    /// [`MapRefusal`] if the control cannot do that, or nothing else would do what it does.
    pub fn with(&self, control: PadControl, action: PadAction) -> Result<Self, MapRefusal> {
        if !action.fits(control.kind()) {
            return Err(MapRefusal::WrongKind);
        }
        let before = self.action(control).clone();
        if before == action {
            return Ok(self.clone());
        }
        let mut actions = self.actions.clone();
        let other = action.is_single().then(|| self.doing(&action).next());
        match other.flatten() {
            Some(other) => actions.insert(other, before),
            None if before.is_single() => return Err(MapRefusal::OneMust),
            None => None,
        };
        actions.insert(control, action);
        Self::of(actions).ok_or(MapRefusal::OneMust)
    }
}
