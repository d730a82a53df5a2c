//! Plays poses in order: time and angles in, targets out. Sends nothing and reads no clock.

use crate::hand::gap::Gap;
use crate::hand::grip::{GripEstimate, GripState, GripThresholds};
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Dof, Force, Moment, PerDof, Speed};
use crate::poses::library::{
    EntryId, LibraryPose, Millis, PoseLibrary, SequenceId, SequenceStep, StepGoal, UntilHolding,
};
use crate::poses::reaction::TouchForce;
use crate::poses::way::{Targets, WayPart, pinch_way, way};
use crate::record::Abort;
use std::collections::VecDeque;
use std::time::Duration;

/// Duration after which an empty grip counts as empty, and not as a finger just about to touch.
const EMPTY_DURATION: Duration = Duration::from_millis(300);
/// Time until readings show the effect of a target: the hand takes 66 ms, and is read every 25 ms.
const REACTION_TIME: Duration = Duration::from_millis(150);

/// Time that a grip by size played alone may take beyond the stroke at its speed.
const SPARE: Duration = Duration::from_secs(4);

/// One step with all its data: an edit of the pose during playback has no effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Cue {
    /// Target of each joint; `None` leaves a joint unchanged.
    pub targets: Targets,
    /// Gap to which these targets belong, in a grip by size.
    pub gap: Option<Gap>,
    /// Speed of the motion; in a grip by size, speed of the fastest joint.
    pub speed: Speed,
    /// Force threshold.
    pub force: Force,
    /// Time at the pose.
    pub dwell: Duration,
    /// Time after which a pose, or a leg of its path, counts as reached.
    pub limit: Duration,
    /// Grip to wait for before the dwell, if any.
    pub until: Option<UntilHolding>,
    /// Thresholds of the grip estimate; `None` for the defaults.
    pub thresholds: Option<GripThresholds>,
    /// Forces of the hold that closes to the targets and lasts for the dwell, for ever if that is the longest duration. Without targets
    /// it takes over what the hand holds. The hold has its own speeds, at most `speed`, and its own thresholds.
    pub hold: Option<HoldForces>,
}

/// Steps of a sequence in its current version.
pub fn cues(library: &PoseLibrary, sequence: SequenceId) -> Vec<Cue> {
    let steps = library.sequence(sequence).into_iter();
    let steps = steps.flat_map(|own| &own.steps);
    steps.filter_map(|step| library.cue(step)).collect()
}

impl Cue {
    /// A pose played alone, at its own speed.
    pub fn of(pose: &LibraryPose) -> Self {
        let limit = Millis::LIMIT.duration();
        Self {
            targets: pose.targets(),
            gap: pose.gap,
            speed: pose.speed,
            force: pose.force,
            dwell: pose.hold.map_or(Duration::ZERO, |_| Duration::MAX),
            // A grip that opens first and counts as reached too early would not close.
            limit: pose.gap.map_or(limit, |_| pose.speed.stroke() + SPARE),
            until: None,
            thresholds: pose.thresholds,
            hold: pose.hold,
        }
    }

    /// A grip by size at this speed.
    fn of_gap(gap: Gap, speed: Speed, force: Force) -> Self {
        let pose = LibraryPose::at(gap.angles());
        Self {
            gap: Some(gap),
            speed,
            force,
            ..Self::of(&pose)
        }
    }

    /// A hold of what the hand has.
    fn of_hold(forces: HoldForces) -> Self {
        Self {
            targets: PerDof::splat(None),
            hold: Some(forces),
            ..Self::of(&LibraryPose::at(PerDof::splat(Angle::MAX)))
        }
    }

    /// Legs of its path from these angles, in order.
    pub(crate) fn parts(&self, from: &PerDof<Option<i16>>) -> Vec<WayPart> {
        if let Some(gap) = self.gap {
            let moves = self.targets.map(|target| target.is_some());
            return pinch_way(from, gap, self.speed, &moves);
        }
        let straight = way(from, &self.targets);
        let parts = straight.into_iter().map(|targets| WayPart {
            targets,
            speeds: PerDof::splat(self.speed),
            is_pinching: false,
        });
        parts.collect()
    }

    /// Opens the joints that the step moves. The thumb keeps its rotation, which the next attempt needs.
    fn opening(&self) -> Self {
        if self.gap.is_some() {
            let open = Gap::MAX.angles();
            return Self {
                targets: PerDof::from_fn(|dof| self.targets[dof].map(|_| open[dof])),
                gap: Some(Gap::MAX),
                ..self.clone()
            };
        }
        let opens = |dof: Dof| self.targets[dof].filter(|_| dof != Dof::ThumbRotate);
        Self {
            targets: PerDof::from_fn(|dof| opens(dof).map(|_| Angle::MAX)),
            ..self.clone()
        }
    }
}

/// An entry of the library with all data needed to play it: an edit during playback has no effect.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayPlan {
    pub entry: EntryId,
    /// Poses in order.
    pub cues: Vec<Cue>,
    /// True if it repeats from the start.
    pub looped: bool,
    /// Reaction of touched fingers once the hand is at its first pose.
    pub reaction: Option<ReactionCue>,
}

impl PlayPlan {
    /// All cues that it may send. The opening before a retry moves only joints of its own step.
    pub fn cues(&self) -> impl Iterator<Item = &Cue> {
        let touched = self.reaction.iter().map(|reaction| &reaction.touched);
        self.cues.iter().chain(touched)
    }
}

/// Reaction of a touched finger.
#[derive(Debug, Clone, PartialEq)]
pub struct ReactionCue {
    /// Cue of a touched finger; on release it returns to the first pose.
    pub touched: Cue,
    /// Force from which a finger counts as touched.
    pub threshold: TouchForce,
}

impl PoseLibrary {
    /// Cue of a step; `None` if its pose is not in this library.
    fn cue(&self, step: &SequenceStep) -> Option<Cue> {
        let cue = match step.goal {
            StepGoal::Pose(pose) => Cue::of(self.pose(pose)?),
            StepGoal::Gap { gap, force } => Cue::of_gap(gap, step.speed, force),
            StepGoal::Hold(forces) => Cue::of_hold(forces),
        };
        Some(Cue {
            hold: step.hold.or(cue.hold),
            speed: step.speed,
            dwell: step.dwell.duration(),
            limit: step.limit.duration(),
            until: step.until,
            ..cue
        })
    }

    /// Plan of an entry; `None` if it is not in this library.
    pub fn plan(&self, entry: EntryId) -> Option<PlayPlan> {
        let plan = |cues, looped, reaction| PlayPlan {
            entry,
            cues,
            looped,
            reaction,
        };
        Some(match entry {
            EntryId::Pose(id) => plan(vec![Cue::of(self.pose(id)?)], false, None),
            EntryId::Sequence(id) => plan(cues(self, id), self.sequence(id)?.looped, None),
            EntryId::Reaction(id) => {
                let reaction = self.reaction(id)?;
                // Fingers that answer a touch hold nothing.
                let pose = |id| {
                    Some(Cue {
                        hold: None,
                        ..Cue::of(self.pose(id)?)
                    })
                };
                let mut rest = pose(reaction.rest)?;
                rest.dwell = Duration::MAX;
                let touched = ReactionCue {
                    touched: pose(reaction.touched)?,
                    threshold: reaction.threshold,
                };
                plan(vec![rest], false, Some(touched))
            }
        })
    }
}

/// Outcome of a sequence that was not aborted. The hand stays armed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PlayEnd {
    /// Every step was played.
    Finished,
    /// The user ended it.
    Person,
    /// The grip that a step waited for did not occur in time, or its hold ended early; this was the grip then.
    NotHolding(GripState),
    /// A joint that the grip by size needs is locked.
    Locked,
}

/// Phase of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlayPhase {
    /// Moving to a pose.
    Moving { since: Moment },
    /// At a pose, until the hand holds something.
    Waiting { since: Moment },
    /// The hand closed on nothing, and opens to close again.
    Opening { since: Moment },
    /// Closing for a hold, or holding, until [`Player::held`].
    Holding { since: Moment },
    /// At a pose.
    Dwelling { since: Moment },
    /// Paused by the user, or the single requested step is done.
    Paused,
    /// Ended. Only the user starts it again.
    Ended(Result<PlayEnd, Abort>),
}

/// Playback mode of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlayMode {
    /// Step after step.
    Through,
    /// One step, then a pause.
    OneStep,
}

/// Progress of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlayView {
    /// Index of the step, from 0.
    pub at: usize,
    /// Phase of the step.
    pub phase: PlayPhase,
    /// Steps that ran into their time limit.
    pub late: u32,
    /// Retries of the step.
    pub retries: u8,
}

impl PlayView {
    /// The first step at its start.
    pub const fn first(now: Moment) -> Self {
        Self {
            at: 0,
            phase: PlayPhase::Moving { since: now },
            late: 0,
            retries: 0,
        }
    }
}

/// A running sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Player {
    cues: Vec<Cue>,
    looped: bool,
    pace: PlayMode,
    view: PlayView,
    /// Remaining legs to the current pose; the first was sent.
    parts: VecDeque<WayPart>,
    /// The next leg has to be sent.
    due: bool,
    /// The current pose was reached or its time limit expired, and the grip it waits for is present.
    arrived: bool,
}

impl Player {
    /// Starts with the first step. Without steps it ends immediately.
    pub fn start(cues: Vec<Cue>, looped: bool, pace: PlayMode, now: Moment) -> Self {
        let mut player = Self {
            parts: VecDeque::new(),
            due: false,
            cues,
            looped,
            pace,
            view: PlayView::first(now),
            arrived: false,
        };
        if player.cues.is_empty() {
            player.view.phase = PlayPhase::Ended(Ok(PlayEnd::Finished));
        } else {
            player.begin(now);
        }
        player
    }

    /// Targets of the current step.
    pub fn targets(&self) -> PerDof<Option<Angle>> {
        self.goal().map_or(PerDof::splat(None), |cue| cue.targets)
    }

    fn goal(&self) -> Option<Cue> {
        let cue = self.cue()?;
        Some(match self.view.phase {
            PlayPhase::Opening { .. } => cue.opening(),
            _ => cue.clone(),
        })
    }

    /// Current step.
    pub fn cue(&self) -> Option<&Cue> {
        self.cues.get(self.view.at)
    }

    fn until(&self) -> Option<UntilHolding> {
        self.cue()?.until
    }

    /// True if a step is a hold.
    pub fn has_hold(&self) -> bool {
        self.cues.iter().any(|cue| cue.hold.is_some())
    }

    /// True if this step or a later one is a hold.
    pub fn will_hold(&self) -> bool {
        let ahead = self.cues.iter().skip(self.view.at);
        !self.is_over() && ahead.into_iter().any(|cue| cue.hold.is_some())
    }

    /// Current progress.
    pub const fn view(&self) -> PlayView {
        self.view
    }

    /// True once nothing further is sent.
    pub const fn is_over(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Ended(_))
    }

    /// True while the user can resume it.
    pub const fn is_paused(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Paused)
    }

    /// Advances the time. Returns the leg to send now, if one is due.
    ///
    /// `seen`: the fresh angle of each joint that takes part; joints without a target in the cue are ignored. `grasp` as it is known
    /// at `now`.
    pub fn tick(
        &mut self,
        now: Moment,
        seen: &PerDof<Option<i16>>,
        grasp: &GripEstimate,
    ) -> Option<WayPart> {
        match self.view.phase {
            PlayPhase::Moving { since } if !self.due && self.has_grasped(since, grasp) => {
                self.arrive(now);
            }
            PlayPhase::Moving { since } | PlayPhase::Opening { since } if !self.due => {
                self.moving(since, now, seen);
            }
            PlayPhase::Waiting { since } => self.waiting(since, now, grasp),
            PlayPhase::Dwelling { since } => self.dwelling(since, now),
            _ => {}
        }
        let moves = matches!(
            self.view.phase,
            PlayPhase::Moving { .. } | PlayPhase::Opening { .. }
        );
        if !self.due || !moves {
            return None;
        }
        self.due = false;
        if self.parts.pop_front().is_none() || self.parts.is_empty() {
            self.parts = self.goal()?.parts(seen).into();
        }
        self.parts.front().copied()
    }

    /// True if the grip that the step waits for has ended its motion: fingers that close on an object never reach their target. A grip
    /// from before the step does not count.
    fn has_grasped(&self, since: Moment, grasp: &GripEstimate) -> bool {
        let is_new = grasp.since >= since.plus(REACTION_TIME);
        let is_held = grasp.state.is_still() && is_new;
        let closes = |part: &WayPart| part.is_pinching || self.parts.len() == 1;
        is_held && self.until().is_some() && self.parts.front().is_some_and(closes)
    }

    /// Marks the pose of the step as reached, including the grip it waits for.
    const fn arrive(&mut self, now: Moment) {
        self.arrived = true;
        self.view.phase = PlayPhase::Dwelling { since: now };
    }

    fn moving(&mut self, since: Moment, now: Moment, seen: &PerDof<Option<i16>>) {
        let (Some(part), Some(cue)) = (self.parts.front(), self.cue()) else {
            return;
        };
        let there = |dof: Dof| match part.targets[dof] {
            None => true,
            Some(target) => seen[dof].is_some_and(|seen| target.is_reached_at(seen)),
        };
        let is_there = Dof::ALL.into_iter().all(there);
        let too_late = now.since(since) >= cue.limit;
        if !is_there && !too_late {
            return;
        }
        if is_there && self.parts.len() > 1 {
            // Each leg has the full time limit.
            if let PlayPhase::Moving { since } | PlayPhase::Opening { since } = &mut self.view.phase
            {
                *since = now;
            }
            self.due = true;
            return;
        }
        if matches!(self.view.phase, PlayPhase::Opening { .. }) {
            self.begin(now);
            return;
        }
        self.view.late += u32::from(!is_there);
        if self.until().is_some() {
            self.view.phase = PlayPhase::Waiting { since: now };
        } else {
            self.arrive(now);
        }
    }

    fn waiting(&mut self, since: Moment, now: Moment, grasp: &GripEstimate) {
        let Some(until) = self.until() else {
            return;
        };
        let is_empty = grasp.state == GripState::Empty && now.since(grasp.since) >= EMPTY_DURATION;
        if grasp.state.is_still() {
            self.arrive(now);
        } else if is_empty && self.view.retries < until.retries.get() {
            self.view.retries += 1;
            self.parts.clear();
            self.view.phase = PlayPhase::Opening { since: now };
            self.due = true;
        } else if now.since(since) >= until.within.duration() {
            self.end(Ok(PlayEnd::NotHolding(grasp.state)));
        }
    }

    fn dwelling(&mut self, since: Moment, now: Moment) {
        let dwell = self.cue().map(|cue| cue.dwell);
        if dwell.is_none_or(|dwell| now.since(since) >= dwell) {
            self.step_done(now);
        }
    }

    /// Notes that the hold of the step has lasted for its time.
    pub fn held(&mut self, now: Moment) {
        if matches!(self.view.phase, PlayPhase::Holding { .. }) {
            self.arrived = true;
            self.step_done(now);
        }
    }

    fn step_done(&mut self, now: Moment) {
        match self.pace {
            PlayMode::Through => self.advance(now),
            PlayMode::OneStep => self.view.phase = PlayPhase::Paused,
        }
    }

    fn advance(&mut self, now: Moment) {
        let next = self.view.at + 1;
        if next < self.cues.len() {
            self.view.at = next;
        } else if self.looped {
            self.view.at = 0;
        } else {
            self.view.phase = PlayPhase::Ended(Ok(PlayEnd::Finished));
            return;
        }
        self.view.retries = 0;
        self.begin(now);
    }

    fn begin(&mut self, now: Moment) {
        self.parts.clear();
        self.due = self.cue().is_none_or(|cue| cue.hold.is_none());
        self.view.phase = if self.due {
            PlayPhase::Moving { since: now }
        } else {
            PlayPhase::Holding { since: now }
        };
        self.arrived = false;
    }

    /// Pauses until the user resumes. True if it was running.
    pub const fn pause(&mut self) -> bool {
        let ran = matches!(
            self.view.phase,
            PlayPhase::Moving { .. }
                | PlayPhase::Waiting { .. }
                | PlayPhase::Opening { .. }
                | PlayPhase::Holding { .. }
                | PlayPhase::Dwelling { .. }
        );
        if ran {
            self.view.phase = PlayPhase::Paused;
        }
        ran
    }

    /// Resumes: to the same pose if it was not reached, else to the next one.
    pub fn resume(&mut self, pace: PlayMode, now: Moment) {
        if !self.is_paused() {
            return;
        }
        self.pace = pace;
        if self.arrived {
            self.advance(now);
        } else {
            self.begin(now);
        }
    }

    /// Ends playback. The first reason is final.
    pub const fn end(&mut self, how: Result<PlayEnd, Abort>) {
        if !self.is_over() {
            self.view.phase = PlayPhase::Ended(how);
            self.due = false;
        }
    }
}
