//! One gamepad that a hand follows: reports in, what it asks of the hand out. It never keeps what it no longer knows.

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

/// A dead-man counts as long as the gamepad was heard of this recently: four reports that it is alive.
pub const HEARD_TIMEOUT: Duration = Duration::from_millis(200);
/// How far a stick goes to choose fingers, thousandths, and how far back it lets go of them.
const CHOOSE_AT: i16 = 500;
const CHOOSE_UNTIL: i16 = 350;
/// How far a stick that is pushed whole rotates the thumb in a second: its whole way in two.
const ROTATE_A_SECOND: i64 = 500;
/// The longest time between two offers that counts as pushing, microseconds.
const PUSH_STEP_MAX_US: i64 = 100_000;
/// Parts of a count of the thumb's angle.
const PARTS: i64 = 1_000_000;

/// The poses that buttons go to, by name.
pub type PadPoses = BTreeMap<String, PadAim>;

/// Where a gamepad wants the hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PadAim {
    /// Where the joints go; `None` leaves one alone.
    pub joints: PerDof<Option<Angle>>,
    /// The gap that these are the angles of, where it is one that is wanted.
    pub gap: Option<Gap>,
}

impl PadAim {
    /// Nothing is asked.
    const NOTHING: Self = Self::joints(PerDof::splat(None));

    /// These joints, each by itself.
    pub const fn joints(joints: PerDof<Option<Angle>>) -> Self {
        Self { joints, gap: None }
    }

    /// A pose of a library.
    pub fn of(pose: &LibraryPose) -> Self {
        Self {
            joints: pose.targets(),
            gap: pose.gap,
        }
    }
}

/// What the user did that is no aim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PadEvent {
    /// STOP was pressed. It counts without the dead-man.
    Stop,
    /// The gamepad is there.
    Found,
    /// Events were lost; the dead-man must be pressed anew.
    Lost,
    /// The gamepad is gone.
    Gone,
}

/// The fingers that a trigger closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FingerChoice {
    /// The stick is in its middle: all four.
    #[default]
    All,
    /// It is held at one side: left, up, right, down are index to little finger.
    One(Dof),
}

/// One gamepad as a source of motion. Of several that are there it follows the one found first.
#[derive(Debug)]
pub struct PadInput {
    map: PadMap,
    poses: PadPoses,
    actual: PerDof<Option<Angle>>,
    pad: Option<PadId>,
    state: PadState,
    /// Gamepads that are not followed: their STOP counts. As many as are read at once.
    others: BTreeMap<PadId, PadState>,
    heard: Option<Moment>,
    /// The dead-man was seen up since the gamepad was found, since events were lost, since STOP.
    may_hold: bool,
    pose: Option<PadControl>,
    fingers: FingerChoice,
    push: Option<ThumbPush>,
}

/// Where a stick has rotated the thumb to.
#[derive(Debug, Clone, Copy)]
struct ThumbPush {
    at: Moment,
    /// The aim in millionths of a count.
    aim: i64,
}

impl PadInput {
    /// No gamepad yet.
    pub fn new(map: PadMap) -> Self {
        Self {
            map,
            poses: PadPoses::new(),
            actual: PerDof::splat(None),
            pad: None,
            state: PadState::default(),
            others: BTreeMap::new(),
            heard: None,
            may_hold: false,
            pose: None,
            fingers: FingerChoice::All,
            push: None,
        }
    }

    /// No gamepad yet; its buttons go to the poses that are built in.
    pub fn starting(map: PadMap) -> Self {
        let poses = starter().poses.iter();
        let poses = poses.map(|pose| (pose.name.clone(), PadAim::of(pose)));
        let mut input = Self::new(map);
        input.set_poses(poses.collect());
        input
    }

    /// Names the poses that buttons go to. A button whose pose is not among them does nothing. Where the pose of a button that is
    /// held is another now, or gone, whatever is held must be pressed anew.
    pub fn set_poses(&mut self, poses: PadPoses) {
        let before = self.held_pose();
        self.poses = poses;
        if self.held_pose() != before {
            self.let_go();
            self.look();
        }
    }

    /// Tells where the joints are. A stick rotates the thumb from there; a thumb that is nowhere is left alone.
    pub fn set_actual(&mut self, actual: PerDof<Option<Angle>>) {
        self.actual = actual;
    }

    /// Changes what the controls do. Whatever is held must be pressed anew.
    pub fn set_map(&mut self, map: PadMap) {
        self.map = map;
        self.let_go();
        self.look();
    }

    /// What the controls do.
    pub const fn map(&self) -> &PadMap {
        &self.map
    }

    /// Where the controls are.
    pub const fn state(&self) -> &PadState {
        &self.state
    }

    /// The gamepad that is followed.
    pub const fn pad(&self) -> Option<PadId> {
        self.pad
    }

    /// The fingers that a trigger closes now.
    pub const fn fingers(&self) -> FingerChoice {
        self.fingers
    }

    /// Takes in what happened at a gamepad. Of others than the one that is followed STOP alone counts, and it counts wherever it was
    /// seen down: also where a gamepad is found with it, or events were lost around it.
    pub fn take(&mut self, report: &PadReport) -> Option<PadEvent> {
        if self.sees_stop(report) {
            self.apply(report);
            self.let_go();
            self.look();
            return Some(PadEvent::Stop);
        }
        self.apply(report)
    }

    /// Notes where the controls of other gamepads are; true if a report says that STOP is down that was not down before.
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

    /// Where the controls of a gamepad are, as far as it is known.
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
                self.heard = Some(report.at);
                self.state = PadState::of(facts);
                self.read_anew(now);
                Some(PadEvent::Found)
            }
            PadNews::Lost { pad, now } if of_ours(pad) => {
                self.heard = Some(report.at);
                self.read_anew(now);
                Some(PadEvent::Lost)
            }
            PadNews::Moved { pad, event } if of_ours(pad) => {
                self.heard = Some(report.at);
                self.moved(*event);
                None
            }
            PadNews::Alive(pad) if of_ours(pad) => {
                self.heard = Some(report.at);
                None
            }
            PadNews::Gone(pad) if of_ours(pad) => {
                self.pad = None;
                self.state = PadState::default();
                self.let_go();
                Some(PadEvent::Gone)
            }
            _ => None,
        }
    }

    /// Whether the dead-man is held at this moment.
    pub fn is_held(&self, now: Moment) -> bool {
        let is_near = |heard: Moment| now.since(heard) <= HEARD_TIMEOUT;
        self.may_hold && self.is_dead_man_down() && self.heard.is_some_and(is_near)
    }

    /// What the gamepad asks of the hand at this moment; `None` before the first gamepad. Without the dead-man it asks nothing.
    pub fn offer(&mut self, now: Moment) -> Option<Offer> {
        let at = self.heard?;
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
            limits: OfferLimits::NONE,
            held: Some(is_held),
            // Controls that are held still are no frozen tracking.
            mark: None,
        })
    }

    /// Nothing that was held before counts.
    fn let_go(&mut self) {
        self.may_hold = false;
        self.pose = None;
        self.push = None;
        self.fingers = FingerChoice::All;
    }

    fn read_anew(&mut self, now: &[KernelEvent]) {
        self.state = self.state.released();
        self.let_go();
        for event in now {
            self.state.apply(*event);
        }
        self.look();
    }

    fn moved(&mut self, event: KernelEvent) {
        let before = self.state.held().clone();
        self.state.apply(event);
        self.look();
        let pressed: BTreeSet<_> = self.state.held().difference(&before).copied().collect();
        for control in pressed {
            if let PadAction::Pose(_) = self.map.action(control) {
                self.pose = Some(control);
            }
        }
    }

    /// Follows what needs no press: the dead-man that is up, the fingers that are chosen.
    fn look(&mut self) {
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

    /// The pose whose button is held: the one pressed last, else any.
    fn held_pose(&self) -> Option<PadAim> {
        let last = self.pose.filter(|control| self.state.is_held(*control));
        let mut all = last.into_iter().chain(self.state.held().iter().copied());
        all.find_map(|control| match self.map.action(control) {
            PadAction::Pose(name) => self.poses.get(name).copied(),
            _ => None,
        })
    }

    /// Where the stick that rotates the thumb has pushed it; `None` while no stick is pushed.
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
        // Thousandths of the push, counts a second, microseconds: millionths of a count.
        let aim = before.aim + push * ROTATE_A_SECOND * step / i64::from(FULL);
        let aim = aim.clamp(0, i64::from(Angle::MAX.get()) * PARTS);
        self.push = Some(ThumbPush { at: now, aim });
        Some(Angle::nearest(aim / PARTS))
    }
}

/// The gap of a trigger: the widest while it is let go.
fn gap_of(pressed: i16) -> PadAim {
    let share = f32::from(pressed) / f32::from(FULL);
    let gap = Gap::nearest(Gap::MAX.mm() + share * (Gap::MIN.mm() - Gap::MAX.mm()));
    PadAim {
        joints: gap.angles().map(Some),
        gap: Some(gap),
    }
}

/// The finger that a stick points at; `None` in its middle. It keeps to a finger until it is well away from it.
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
