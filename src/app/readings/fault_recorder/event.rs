//! Events that the recorder notes between measurements: user actions, and changes of a drive's status and faults.

use crate::hand::{Angle, Dof, Faults, Force, Moment, Speed, Status};
use crate::poses::Play;
use crate::poses::Preset;
use std::sync::Arc;

/// A user action that sends something to the hand, or ends the sending.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UserAct {
    /// The hand was disarmed.
    Disarm,
    /// A target angle was set for a joint.
    Target(Dof, Angle),
    /// The force threshold of one joint (`None` = all) was set.
    Force(Option<Dof>, Force),
    /// The speed of one joint (`None` = all) was set.
    Speed(Option<Dof>, Speed),
    /// A joint was locked (true) or unlocked.
    Lock(Dof, bool),
    /// A preset was started: open, half or close.
    Preset(Preset),
    /// A pose of the library was started, by name.
    Pose(Arc<str>),
    /// A sequence was started, stepped, paused or ended.
    Play(Play),
    /// Clearing of errors was requested.
    ClearErrors,
}

impl UserAct {
    /// True if both change the same control, so that the later one of a rapid series replaces the earlier.
    pub(crate) fn is_same_knob(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Target(one, _), Self::Target(two, _)) => one == two,
            (Self::Force(one, _), Self::Force(two, _))
            | (Self::Speed(one, _), Self::Speed(two, _)) => one == two,
            _ => false,
        }
    }

    /// Stable lower-case text for files.
    pub fn words(&self) -> String {
        let joints = |dof: &Option<Dof>| dof.map_or("of all", Dof::name);
        match self {
            Self::Disarm => "disarmed".into(),
            Self::Target(dof, angle) => format!("target {} {}", dof.name(), angle.get()),
            Self::Force(dof, force) => format!("force threshold {} {}", joints(dof), force.get()),
            Self::Speed(dof, speed) => format!("speed {} {}", joints(dof), speed.get()),
            Self::Lock(dof, true) => format!("lock {}", dof.name()),
            Self::Lock(dof, false) => format!("unlock {}", dof.name()),
            Self::Preset(Preset::Open) => "open all".into(),
            Self::Preset(Preset::Half) => "half".into(),
            Self::Preset(Preset::Close) => "close".into(),
            Self::Pose(name) => format!("pose {name}"),
            Self::Play(Play::Start(_)) => "sequence start".into(),
            Self::Play(Play::Step(_)) => "sequence step".into(),
            Self::Play(Play::Pause) => "sequence pause".into(),
            Self::Play(Play::Resume) => "sequence resume".into(),
            Self::Play(Play::End) => "sequence end".into(),
            Self::ClearErrors => "clear errors".into(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FaultEventKind {
    /// A user action.
    UserAct(UserAct),
    /// The status of a drive changed.
    Status(Dof, Status),
    /// The fault bits of a drive changed.
    Faults(Dof, Faults),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaultEvent {
    pub at: Moment,
    pub what: FaultEventKind,
}
