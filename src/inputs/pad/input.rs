//! One gamepad that a hand follows: reports in, targets out. It never uses a state that is no longer certain.

use crate::hand::gap::Gap;
use crate::hand::{Angle, Dof, Moment, PerDof};
use crate::inputs::offer::{Offer, OfferLimits};
use crate::inputs::pad::control::{ControlKind, PadControl};
use crate::inputs::pad::map::{PadAction, PadMap};
use crate::inputs::pad::report::{KernelEvent, PadId, PadNews, PadReport};
use crate::inputs::pad::state::{FULL, PadState, StickPlace};
use crate::poses::library::LibraryPose;
use crate::poses::starter::starter;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// Time since the last report up to which a dead-man counts: four alive reports.
pub const HEARD_TIMEOUT: Duration = Duration::from_millis(200);
/// Deflection of a stick that chooses a finger, thousandths, and the one below which it releases the choice.
const CHOOSE_AT: i16 = 500;
const CHOOSE_UNTIL: i16 = 350;
/// Thumb rotation at full deflection, counts per second: the full range in two seconds.
const ROTATE_A_SECOND: i64 = 500;
/// Longest time between two offers that counts as pushing, microseconds.
const PUSH_STEP_MAX_US: i64 = 100_000;
/// Subdivision of a count of the thumb's angle.
const PARTS: i64 = 1_000_000;

/// Poses assigned to buttons, by name.
pub type PadPoses = BTreeMap<String, PadAim>;

/// Target of a gamepad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PadAim {
    /// Targets of the joints; `None` leaves a joint alone.
    pub joints: PerDof<Option<Angle>>,
    /// Target gap, if the target is one; the joints are then its angles.
    pub gap: Option<Gap>,
}

impl PadAim {
    /// No target.
    const NOTHING: Self = Self::joints(PerDof::splat(None));

    /// These joints, each independently.
    pub const fn joints(joints: PerDof<Option<Angle>>) -> Self {
        Self { joints, gap: None }
    }

    /// Pose of a library.
    pub fn of(pose: &LibraryPose) -> Self {
        Self {
            joints: pose.targets(),
            gap: pose.gap,
        }
    }
}

/// An event besides the targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PadEvent {
    /// STOP was pressed. It counts without the dead-man.
    Stop,
    /// A gamepad was found.
    Found,
    /// Events were lost; the dead-man must be pressed again.
    Lost,
    /// The gamepad was disconnected.
    Gone,
}

/// The fingers that a trigger closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FingerChoice {
    /// Stick centred: all four fingers.
    #[default]
    All,
    /// Stick held to one side: left, up, right, down are index to little finger.
    One(Dof),
}

/// One gamepad as a source of motion. Of several it follows the one found first.
#[derive(Debug)]
pub struct PadInput {
    map: PadMap,
    poses: PadPoses,
    actual: PerDof<Option<Angle>>,
    pad: Option<PadId>,
    state: PadState,
    /// Gamepads that are not followed: their STOP counts. Limited by the number that is read at once.
    others: BTreeMap<PadId, PadState>,
    last_report: Option<Moment>,
    /// The dead-man was seen released since the gamepad was found, events were lost, or STOP was pressed.
    may_hold: bool,
    pose: Option<PadControl>,
    fingers: FingerChoice,
    push: Option<ThumbPush>,
}

/// Thumb rotation set by a stick.
#[derive(Debug, Clone, Copy)]
struct ThumbPush {
    at: Moment,
    /// Target in millionths of a count.
    aim: i64,
}

impl PadInput {
    /// Creates an input without a gamepad.
    pub fn new(map: PadMap) -> Self {
        Self {
            map,
            poses: PadPoses::new(),
            actual: PerDof::splat(None),
            pad: None,
            state: PadState::default(),
            others: BTreeMap::new(),
            last_report: None,
            may_hold: false,
            pose: None,
            fingers: FingerChoice::All,
            push: None,
        }
    }

    /// Creates an input without a gamepad whose buttons use the built-in poses.
    pub fn starting(map: PadMap) -> Self {
        let poses = starter().poses.iter();
        let poses = poses.map(|pose| (pose.name.clone(), PadAim::of(pose)));
        let mut input = Self::new(map);
        input.set_poses(poses.collect());
        input
    }

    /// Sets the poses of the buttons. A button whose pose is missing does nothing. If the pose of a held button changes or
    /// disappears, all held controls must be pressed again.
    pub fn set_poses(&mut self, poses: PadPoses) {
        let before = self.held_pose();
        self.poses = poses;
        if self.held_pose() != before {
            self.release_all();
            self.update_held();
        }
    }

    /// Sets the actual angles. A stick rotates the thumb from there; a thumb at an unknown angle is left alone.
    pub fn set_actual(&mut self, actual: PerDof<Option<Angle>>) {
        self.actual = actual;
    }

    /// Changes the assignment of the controls. All held controls must be pressed again.
    pub fn set_map(&mut self, map: PadMap) {
        self.map = map;
        self.release_all();
        self.update_held();
    }

    /// Assignment of the controls.
    pub const fn map(&self) -> &PadMap {
        &self.map
    }

    /// State of the controls.
    pub const fn state(&self) -> &PadState {
        &self.state
    }

    /// The gamepad that is followed.
    pub const fn pad(&self) -> Option<PadId> {
        self.pad
    }

    /// Fingers that a trigger closes now.
    pub const fn fingers(&self) -> FingerChoice {
        self.fingers
    }

    /// Applies a report. Of gamepads that are not followed only STOP counts, and STOP counts wherever it is seen down:
    /// even when a gamepad is found with STOP down, or events were lost around it.
    pub fn receive(&mut self, report: &PadReport) -> Option<PadEvent> {
        if self.sees_stop(report) {
            self.apply(report);
            self.release_all();
            self.update_held();
            return Some(PadEvent::Stop);
        }
        self.apply(report)
    }

    /// Updates the state of other gamepads; returns true if a report shows STOP down that was not down before.
    fn sees_stop(&mut self, report: &PadReport) -> bool {
        let (pad, mut state, is_certain) = match &report.news {
            PadNews::Found { pad, facts, .. } => (*pad, PadState::of(facts), true),
            PadNews::Moved { pad, .. } => (*pad, self.state_of(*pad), true),
            PadNews::Doubtful { pad, .. } => (*pad, self.state_of(*pad), false),
            PadNews::Lost { pad, .. } => (*pad, self.state_of(*pad).released(), true),
            PadNews::Gone(pad) => {
                self.others.remove(pad);
                return false;
            }
            PadNews::Alive(_) | PadNews::Trouble(_) => return false,
        };
        let stop = self.map.doing(&PadAction::Stop).next();
        let is_down = |state: &PadState| stop.is_some_and(|stop| state.is_held(stop));
        let was_down = is_down(&state);
        match &report.news {
            PadNews::Found { now, .. } | PadNews::Lost { now, .. } => {
                now.iter().for_each(|event| state.apply(*event));
            }
            PadNews::Moved { event, .. } | PadNews::Doubtful { event, .. } => state.apply(*event),
            _ => {}
        }
        let stops = is_down(&state) && !was_down;
        let is_first = self.pad.is_none() && matches!(report.news, PadNews::Found { .. });
        if is_certain && self.pad != Some(pad) && !is_first {
            self.others.insert(pad, state);
        }
        stops
    }

    /// Known state of a gamepad's controls.
    fn state_of(&self, pad: PadId) -> PadState {
        if self.pad == Some(pad) {
            return self.state.clone();
        }
        self.others.get(&pad).cloned().unwrap_or_default()
    }

    fn apply(&mut self, report: &PadReport) -> Option<PadEvent> {
        let of_ours = |pad: &PadId| self.pad == Some(*pad);
        match &report.news {
            PadNews::Found { pad, facts, now } if self.pad.is_none() => {
                self.pad = Some(*pad);
                self.last_report = Some(report.at);
                self.state = PadState::of(facts);
                self.read_anew(now);
                Some(PadEvent::Found)
            }
            PadNews::Lost { pad, now } if of_ours(pad) => {
                self.last_report = Some(report.at);
                self.read_anew(now);
                Some(PadEvent::Lost)
            }
            PadNews::Moved { pad, event } if of_ours(pad) => {
                self.last_report = Some(report.at);
                self.moved(*event);
                None
            }
            PadNews::Alive(pad) if of_ours(pad) => {
                self.last_report = Some(report.at);
                None
            }
            PadNews::Gone(pad) if of_ours(pad) => {
                self.pad = None;
                self.state = PadState::default();
                self.release_all();
                Some(PadEvent::Gone)
            }
            _ => None,
        }
    }

    /// True if the dead-man is held at this time.
    pub fn is_held(&self, now: Moment) -> bool {
        let is_near = |last_report: Moment| now.since(last_report) <= HEARD_TIMEOUT;
        self.may_hold && self.is_dead_man_down() && self.last_report.is_some_and(is_near)
    }

    /// Target of the gamepad at this time; `None` before the first gamepad. Empty while the dead-man is not held.
    pub fn offer(&mut self, now: Moment) -> Option<Offer> {
        let at = self.last_report?;
        let is_held = self.is_held(now);
        let aim = if is_held {
            self.aim(now)
        } else {
            self.push = None;
            PadAim::NOTHING
        };
        Some(Offer {
            at,
            aims: aim.joints,
            gap: aim.gap,
            hold: None,
            limits: OfferLimits::NONE,
            held: Some(is_held),
            // Controls held still are not frozen tracking.
            mark: None,
        })
    }

    /// Ignores everything that was held before.
    fn release_all(&mut self) {
        self.may_hold = false;
        self.pose = None;
        self.push = None;
        self.fingers = FingerChoice::All;
    }

    fn read_anew(&mut self, now: &[KernelEvent]) {
        self.state = self.state.released();
        self.release_all();
        for event in now {
            self.state.apply(*event);
        }
        self.update_held();
    }

    fn moved(&mut self, event: KernelEvent) {
        let before = self.state.held().clone();
        self.state.apply(event);
        self.update_held();
        let pressed: BTreeSet<_> = self.state.held().difference(&before).copied().collect();
        for control in pressed {
            if let PadAction::Pose(_) = self.map.action(control) {
                self.pose = Some(control);
            }
        }
    }

    /// Updates the states that need no press: the released dead-man and the chosen fingers.
    fn update_held(&mut self) {
        self.may_hold |= !self.is_dead_man_down();
        let choosing = self.map.doing(&PadAction::ChooseFingers);
        let mut places = choosing.map(|stick| self.state.stick(stick));
        let fingers = places.find_map(|place| choice(self.fingers, place));
        self.fingers = fingers.unwrap_or_default();
    }

    fn is_dead_man_down(&self) -> bool {
        let mut dead_man = self.map.doing(&PadAction::DeadMan);
        dead_man.any(|control| self.state.is_held(control))
    }

    fn aim(&mut self, now: Moment) -> PadAim {
        let gap = self.map.doing(&PadAction::CloseGap).next();
        let gap = gap.map(|trigger| gap_of(self.state.trigger(trigger)));
        if let Some(aim) = self.held_pose().or(gap) {
            self.push = None;
            return aim;
        }
        let mut aims = PerDof::splat(None);
        for control in PadControl::ALL {
            if control.kind() != ControlKind::Trigger {
                continue;
            }
            let bent = Some(Angle::nearest(FULL - self.state.trigger(control)));
            match (self.map.action(control), self.fingers) {
                (PadAction::BendThumb, _) => aims[Dof::ThumbBend] = bent,
                (PadAction::CloseFingers, FingerChoice::One(finger)) => aims[finger] = bent,
                (PadAction::CloseFingers, FingerChoice::All) => {
                    for finger in [Dof::Little, Dof::Ring, Dof::Middle, Dof::Index] {
                        aims[finger] = bent;
                    }
                }
                _ => {}
            }
        }
        aims[Dof::ThumbRotate] = self.rotated(now);
        PadAim::joints(aims)
    }

    /// Pose of the held button: the one pressed last, else any.
    fn held_pose(&self) -> Option<PadAim> {
        let last = self.pose.filter(|control| self.state.is_held(*control));
        let mut all = last.into_iter().chain(self.state.held().iter().copied());
        all.find_map(|control| match self.map.action(control) {
            PadAction::Pose(name) => self.poses.get(name).copied(),
            _ => None,
        })
    }

    /// Thumb rotation set by the stick; `None` while no stick is pushed.
    fn rotated(&mut self, now: Moment) -> Option<Angle> {
        let sticks = self.map.doing(&PadAction::RotateThumb);
        let pushes = sticks.map(|stick| self.state.stick(stick).right);
        let push: i64 = pushes.map(i64::from).sum();
        let push = push.clamp(-i64::from(FULL), i64::from(FULL));
        let actual = self.actual[Dof::ThumbRotate];
        let before = match self.push {
            Some(before) => before,
            None => ThumbPush {
                at: now,
                aim: i64::from(actual?.get()) * PARTS,
            },
        };
        if push == 0 {
            self.push = None;
            return None;
        }
        let step = i64::try_from(now.since(before.at).as_micros());
        let step = step.unwrap_or(PUSH_STEP_MAX_US).min(PUSH_STEP_MAX_US);
        // Thousandths of the push, counts per second, microseconds: millionths of a count.
        let aim = before.aim + push * ROTATE_A_SECOND * step / i64::from(FULL);
        let aim = aim.clamp(0, i64::from(Angle::MAX.get()) * PARTS);
        self.push = Some(ThumbPush { at: now, aim });
        Some(Angle::nearest(aim / PARTS))
    }
}

/// Gap of a trigger: the widest while it is released.
fn gap_of(pressed: i16) -> PadAim {
    let share = f32::from(pressed) / f32::from(FULL);
    let gap = Gap::nearest(Gap::MAX.mm() + share * (Gap::MIN.mm() - Gap::MAX.mm()));
    PadAim {
        joints: gap.angles().map(Some),
        gap: Some(gap),
    }
}

/// Finger to which a stick points; `None` at its centre. A finger stays chosen until the stick is well away from it.
fn choice(before: FingerChoice, place: StickPlace) -> Option<FingerChoice> {
    let sides = [
        (Dof::Index, -place.right),
        (Dof::Middle, place.up),
        (Dof::Ring, place.right),
        (Dof::Little, -place.up),
    ];
    let kept = |(dof, far): &(Dof, i16)| before == FingerChoice::One(*dof) && *far > CHOOSE_UNTIL;
    let (finger, _) = match sides.into_iter().find(kept) {
        Some(kept) => Some(kept),
        None => sides
            .into_iter()
            .filter(|(_, far)| *far > CHOOSE_AT)
            .max_by_key(|(_, far)| *far),
    }?;
    Some(FingerChoice::One(finger))
}
