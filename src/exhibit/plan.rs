//! The plan of an exhibition: tiles, limits and times. Nothing outside it can be played.

use crate::exhibit::pin::Pin;
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::link::ArmRequest;
use crate::poses::library::{EntryId, LibraryPose};
use crate::poses::player::{Cue, PlayPlan};
use crate::poses::way::Targets;
use std::time::Duration;

/// Number of tiles on a page: fewer leave it empty, more would be too small to hit.
pub const TILES: std::ops::RangeInclusive<usize> = 6..=12;

/// Maximum speed and force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotionLimits {
    /// Maximum speed of every joint.
    pub speed: Speed,
    /// Maximum force threshold of every joint.
    pub force: Force,
}

/// A line of text in both languages.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct BothWords {
    pub en: String,
    pub zh: String,
}

/// One playable piece.
#[derive(Debug, Clone, PartialEq)]
pub struct ExhibitPiece {
    pub name: BothWords,
    /// The motion, played once, within the limits.
    pub plan: PlayPlan,
    /// True if it repeats.
    pub again: bool,
}

impl ExhibitPiece {
    /// Targets shown on the tile: the pose furthest from open.
    pub fn shown(&self) -> Targets {
        let cues = self.plan.cues.iter().map(|cue| &cue.targets);
        let touched = self.plan.reaction.iter().map(|cue| &cue.touched.targets);
        let bent = |targets: &&Targets| -> i32 {
            let angles = targets.iter().filter_map(|(_, to)| *to);
            angles
                .map(|to| i32::from(Angle::MAX.get() - to.get()))
                .sum()
        };
        let most = cues.chain(touched).max_by_key(bent);
        most.copied().unwrap_or(PerDof::splat(None))
    }
}

/// The pieces played while no visitor is present.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractLoop {
    /// Played in turn.
    pub pieces: Vec<ExhibitPiece>,
    /// Idle time before it begins.
    pub after: Duration,
    /// Playing time, …
    pub play: Duration,
    /// … followed by a rest of this length.
    pub rest: Duration,
}

/// A whole exhibition, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ExhibitPlan {
    /// The line above the hand.
    pub title: BothWords,
    /// The staff PIN; if `None`, staff choose one at the start.
    pub pin: Option<Pin>,
    /// Maximum speed and force.
    pub limits: MotionLimits,
    /// The pieces that visitors can start.
    pub tiles: Vec<ExhibitPiece>,
    /// Opens the hand; it rests open.
    pub open: PlayPlan,
    /// Play time of one visitor.
    pub visit: Duration,
    /// The attract loop; `None` for none.
    pub attract: Option<AttractLoop>,
    /// True if a visitor may arm the hand again by holding a tile after an end that otherwise only staff can clear.
    pub visitor_restart: bool,
}

impl MotionLimits {
    /// The limits that the link sets when it arms.
    pub const fn arm_request(self) -> ArmRequest {
        ArmRequest {
            speed: PerDof::splat(self.speed),
            force: PerDof::splat(self.force),
        }
    }

    /// The same with half the speed.
    #[must_use]
    pub fn slower(self) -> Self {
        Self {
            speed: Speed::nearest((self.speed.get() / 2).max(1)),
            ..self
        }
    }

    /// The plan limited to these. The time limit of a slowed step grows in proportion.
    pub fn limited(self, plan: &PlayPlan) -> PlayPlan {
        let mut plan = plan.clone();
        let touched = plan.reaction.iter_mut().map(|cue| &mut cue.touched);
        for cue in plan.cues.iter_mut().chain(touched) {
            self.limit_cue(cue);
        }
        plan
    }

    fn limit_cue(self, cue: &mut Cue) {
        let (wanted, given) = (cue.speed.get().max(1), self.speed.get().max(1));
        if given < wanted {
            cue.limit = cue.limit * wanted.unsigned_abs().into() / given.unsigned_abs().into();
        }
        cue.speed = cue.speed.min(self.speed);
        cue.force = cue.force.min(self.force);
        cue.hold = cue.hold.map(|forces| forces.limited(self.force));
    }
}

/// A gentle opening of all joints.
pub(crate) fn open_plan(limits: MotionLimits) -> PlayPlan {
    let pose = LibraryPose::at(PerDof::splat(Angle::MAX));
    limits.limited(&PlayPlan {
        entry: EntryId::Pose(pose.id),
        cues: vec![Cue::of(&pose)],
        looped: false,
        reaction: None,
    })
}
