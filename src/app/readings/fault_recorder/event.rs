//! What the recorder notes between measurements: what the user did, and how a drive's status and faults changed.

use crate::hand::{Angle, Dof, Faults, Force, Moment, Speed, Status};
use crate::poses::Play;
use crate::poses::Preset;
use std::sync::Arc;

/// Something the user did that was sent to the hand, or that ends what is sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PersonAct {
    /// Setpoints were let through no more.
    Disarm,
    /// A joint was sent somewhere.
    Target(Dof, Angle),
    /// The force threshold of one joint or of all.
    Force(Option<Dof>, Force),
    /// The speed of one joint or of all.
    Speed(Option<Dof>, Speed),
    /// A joint was locked, or freed.
    Lock(Dof, bool),
    /// Open, half or close.
    Preset(Preset),
    /// A pose of the library, by name.
    Pose(Arc<str>),
    /// A sequence was started, stepped, paused or ended.
    Play(Play),
    /// Errors were to be cleared.
    ClearErrors,
}

impl PersonAct {
    /// True if both turn the same knob, so that the later one of a quick row stands for it.
    pub(crate) fn is_same_knob(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Target(one, _), Self::Target(two, _)) => one == two,
            (Self::Force(one, _), Self::Force(two, _))
            | (Self::Speed(one, _), Self::Speed(two, _)) => one == two,
            _ => false,
        }
    }

    /// Stable lower-case words for files.
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

/// What happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FaultEventKind {
    /// The user did something.
    PersonAct(PersonAct),
    /// A drive says something else.
    Status(Dof, Status),
    /// A drive's fault bits changed.
    Faults(Dof, Faults),
}

/// What happened, and when.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaultEvent {
    pub at: Moment,
    pub what: FaultEventKind,
}
