//! What an exhibition may do: its tiles, limits and times. What is not in it cannot be played.

use crate::exhibit::pin::Pin;
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::link::ArmRequest;
use crate::poses::library::{EntryId, LibraryPose};
use crate::poses::player::{Cue, PlayPlan};
use crate::poses::way::Targets;
use std::time::Duration;

/// Tiles of a page: fewer leave it empty, more would be too small to hit.
pub const TILES: std::ops::RangeInclusive<usize> = 6..=12;

/// Speed and force that nothing passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotionLimits {
    /// Of every joint.
    pub speed: Speed,
    /// Force threshold of every joint.
    pub force: Force,
}

/// A line of words in both languages.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct BothWords {
    /// English.
    pub en: String,
    /// Chinese.
    pub zh: String,
}

/// One thing that can be played.
#[derive(Debug, Clone, PartialEq)]
pub struct ExhibitPiece {
    /// What it is called.
    pub name: BothWords,
    /// How it is played, once, within the limits.
    pub plan: PlayPlan,
    /// Whether it begins again at its end.
    pub again: bool,
}

impl ExhibitPiece {
    /// What its tile shows: a pose of it that says most, the one that is furthest from open.
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

/// What the hand does while nobody is there.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractLoop {
    /// One after the other.
    pub pieces: Vec<ExhibitPiece>,
    /// Nobody touched the page for this long before it begins.
    pub after: Duration,
    /// It plays for this long, …
    pub play: Duration,
    /// … then the hand rests for this long.
    pub rest: Duration,
}

/// A whole exhibition, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ExhibitPlan {
    /// What stands above the hand.
    pub title: BothWords,
    /// What staff type; without one they choose it at the start.
    pub pin: Option<Pin>,
    /// Speed and force that nothing passes.
    pub limits: MotionLimits,
    /// What visitors may press.
    pub tiles: Vec<ExhibitPiece>,
    /// Open, in which the hand rests.
    pub open: PlayPlan,
    /// Play time of one visitor.
    pub visit: Duration,
    /// What the hand does while nobody is there, if anything.
    pub attract: Option<AttractLoop>,
    /// Whether a tile that is held arms again after what only staff could end otherwise.
    pub visitor_restart: bool,
}

impl MotionLimits {
    /// What the link sets before anything moves.
    pub const fn arm_request(self) -> ArmRequest {
        ArmRequest {
            speed: PerDof::splat(self.speed),
            force: PerDof::splat(self.force),
        }
    }

    /// Half as fast.
    #[must_use]
    pub fn slower(self) -> Self {
        Self {
            speed: Speed::nearest((self.speed.get() / 2).max(1)),
            ..self
        }
    }

    /// A plan that keeps within them. What is slower then has so much longer to arrive.
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
    }
}

/// All joints open, gently.
pub(crate) fn open_plan(limits: MotionLimits) -> PlayPlan {
    let pose = LibraryPose::at(PerDof::splat(Angle::MAX));
    limits.limited(&PlayPlan {
        entry: EntryId::Pose(pose.id),
        cues: vec![Cue::of(&pose)],
        looped: false,
        reaction: None,
    })
}
