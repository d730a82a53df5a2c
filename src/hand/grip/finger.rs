//! State estimator of one finger, updated with each reading.

use crate::hand::dof::{Dof, PerDof};
use crate::hand::feedback::status::Status;
use crate::hand::feedback::tactile::spot_mm;
use crate::hand::grip::contact::{Contact, Felt};
use crate::hand::grip::evidence::{FingerEvidence, JOINTS_MAX, JointEvidence, TipEvidence};
use crate::hand::grip::free::{FreeClose, FreeForce};
use crate::hand::grip::motion::JointMotion;
use crate::hand::grip::slip::{HELD_N, HeldMoment, SlipDetector};
use crate::hand::grip::state::{GripEstimate, GripState};
use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::moment::Moment;
use arrayvec::ArrayVec;
use std::time::Duration;

/// Weight of each new force in the running zero while a finger is open and touches nothing.
const ZERO_SHARE: f32 = 0.05;
/// Opening since the last contact from which a finger has released on its own, units of angle.
const LETS_GO: i16 = 8;
/// A slip is reported for this long after it was last seen, s.
const SLIP_TOLD_S: f64 = 0.15;
/// A grip that was too hard stays so down to this share of the threshold.
const SOFTER: f32 = 0.9;
/// The force at the end of a free close is used for this long; after that the sensor's zero drifts.
const ARRIVED_DURATION: Duration = Duration::from_millis(500);

/// Contact of a finger, remembered until the finger opens or touches something else.
#[derive(Debug, Clone, Copy)]
struct HeldAt {
    /// Angle of the finger at its last contact.
    angle: i16,
    /// The fingertip was in contact.
    by_tip: bool,
    /// Time at which contact was first missing.
    gone: Option<Moment>,
}

/// A close under way that has not touched anything yet.
#[derive(Debug, Clone, Default)]
struct FreeWay {
    joints: ArrayVec<(Dof, FreeClose), JOINTS_MAX>,
    /// Time at which it reached its target.
    arrived: Option<Moment>,
}

/// Context in which a finger is judged, besides its own evidence.
#[derive(Debug, Clone, Copy)]
pub(super) struct FingerContext<'a> {
    pub(super) at: Moment,
    pub(super) thresholds: &'a GripThresholds,
    pub(super) free: &'a FreeForce,
    /// All fingertips are read and none touches anything.
    pub(super) is_hand_free: bool,
}

/// Estimator of one finger with its history.
#[derive(Debug, Clone)]
pub(super) struct FingerEstimator {
    motion: PerDof<JointMotion>,
    zero_g: PerDof<Option<f32>>,
    touches: bool,
    slip: SlipDetector,
    /// Channels of the fingertip when it touched nothing last.
    free_channels: Option<[u32; 8]>,
    held: Option<HeldAt>,
    way: Option<FreeWay>,
    /// Completed free closes, for the hand's estimator to collect.
    pub(super) learned: ArrayVec<(Dof, FreeClose), JOINTS_MAX>,
    pub(super) estimate: GripEstimate,
}

impl FingerEstimator {
    pub(super) fn new(thresholds: &GripThresholds) -> Self {
        Self {
            motion: PerDof::from_fn(|_| JointMotion::default()),
            zero_g: PerDof::splat(None),
            touches: false,
            slip: SlipDetector::new(thresholds),
            free_channels: None,
            held: None,
            way: None,
            learned: ArrayVec::new(),
            estimate: GripEstimate::default(),
        }
    }

    /// Uses other slip thresholds from now on.
    pub(super) const fn judge_by(&mut self, thresholds: &GripThresholds) {
        self.slip.judge_by(thresholds);
    }

    /// Resets the state to unknown and drops what was held, as there is no evidence. The zero of the force sensor stays.
    pub(super) fn forget(&mut self, at: Moment, thresholds: &GripThresholds) {
        self.motion = PerDof::from_fn(|_| JointMotion::default());
        self.touches = false;
        self.slip = SlipDetector::new(thresholds);
        self.held = None;
        self.way = None;
        let asked = self.estimate.asked;
        self.estimate.become_state(GripState::Unknown, at, asked);
    }

    /// Updates the state with the evidence of one reading.
    pub(super) fn apply(&mut self, evidence: &FingerEvidence, scene: FingerContext<'_>) {
        for joint in &evidence.joints {
            self.motion[joint.dof].push(evidence.angle_at, joint.angle);
        }
        self.feel(evidence.tip, scene.thresholds);
        let Some(now) = self.assess(evidence, scene) else {
            self.forget(scene.at, scene.thresholds);
            return;
        };
        let is_open = now.is_open(scene.thresholds);
        if !now.is_moving && is_open && evidence.is_tip_free(scene.thresholds) {
            self.learn_zero(evidence);
        }
        self.watch_way(evidence, &now, scene);
        let state = self.state(&now, scene.thresholds);
        let asked = Some(evidence.asked);
        self.estimate.become_state(state, scene.at, asked);
    }

    fn assess(&mut self, evidence: &FingerEvidence, scene: FingerContext<'_>) -> Option<FingerNow> {
        let bend = evidence.bend()?;
        let joints = evidence.joints.iter();
        let felt = self.felt(evidence, bend.status == Status::ForceReached, scene);
        let contact = Contact::of(&felt, scene.thresholds);
        self.touches = contact == Contact::Touching;
        let load_g = |joint: &JointEvidence| {
            f32::from(joint.force_g) - self.zero_g[joint.dof].unwrap_or_default()
        };
        let tip_g = evidence.tip.map_or(0.0, |tip| tip.normal_g());
        let drives = |is: fn(Status) -> bool| joints.clone().any(|joint| is(joint.status));
        Some(FingerNow {
            at: scene.at,
            angle: bend.angle,
            is_moving: joints
                .clone()
                .any(|joint| self.motion[joint.dof].is_moving(scene.at, joint.status)),
            is_releasing: bend.status == Status::Releasing,
            is_stopped_by_force: bend.status == Status::ForceReached,
            is_stopped: drives(|status| status.is_protective() || status == Status::ForceReached),
            is_overloaded: drives(|status| status == Status::CurrentProtection),
            is_force_known: felt.over_g.is_some(),
            contact,
            by_tip: felt.tip_n.is_some_and(|n| n >= scene.thresholds.contact_n),
            load_g: joints.clone().map(load_g).fold(tip_g, f32::max),
            current_ma: joints.clone().filter_map(|joint| joint.current_ma).max(),
        })
    }

    fn felt(&self, evidence: &FingerEvidence, is_stopped: bool, scene: FingerContext<'_>) -> Felt {
        let over = |joint: &JointEvidence| {
            let load_g = f32::from(joint.force_g) - self.zero_g[joint.dof]?;
            let free = scene.free.at(joint.dof, joint.angle);
            Some((load_g - free.unwrap_or_default(), free.is_some()))
        };
        let joints = evidence.joints.iter().filter_map(over);
        let most = joints.reduce(|most, own| if own.0 > most.0 { own } else { most });
        Felt {
            tip_n: evidence.tip.map(|tip| tip.normal_n),
            over_g: most.map(|(over_g, _)| over_g),
            // A finger at rest that touches nothing has met no friction.
            is_free_known: most.is_some_and(|(_, is_known)| is_known)
                || self.estimate.state == GripState::Empty,
            is_stopped_by_force: is_stopped,
            touched: self.touches,
            held_by_tip: self.held.map(|held| held.by_tip),
        }
    }

    /// Feeds the slip detector, which restarts with each contact.
    fn feel(&mut self, tip: Option<TipEvidence>, thresholds: &GripThresholds) {
        let Some(tip) = tip else {
            return;
        };
        if f64::from(tip.normal_n) < HELD_N {
            self.slip = SlipDetector::new(thresholds);
            self.free_channels = Some(tip.raw);
        } else if let Some(moment) = tip.news {
            let free = self.free_channels;
            self.slip.push(HeldMoment {
                spot_mm: free.and_then(|free| spot_mm(&tip.raw, &free)),
                ..moment
            });
        }
    }

    fn learn_zero(&mut self, evidence: &FingerEvidence) {
        for joint in &evidence.joints {
            let force = f32::from(joint.force_g);
            let zero = self.zero_g[joint.dof].get_or_insert(force);
            *zero += (force - *zero) * ZERO_SHARE;
        }
    }

    /// Follows a close in which nothing is touched. Its measurement counts only once it is over: no close excuses its own force.
    fn watch_way(&mut self, evidence: &FingerEvidence, now: &FingerNow, scene: FingerContext<'_>) {
        let is_open = now.is_open(scene.thresholds);
        if now.is_releasing || is_open && !now.is_moving {
            let arrived = self.way.take().filter(|way| way.arrived.is_some());
            self.learned = arrived.map_or_else(ArrayVec::new, |way| way.joints);
            self.way = (is_open && !now.is_moving).then(FreeWay::default);
            return;
        }
        if !scene.is_hand_free || now.is_stopped {
            self.way = None;
        }
        let Some(way) = &mut self.way else {
            return;
        };
        if !now.is_moving {
            way.arrived.get_or_insert(now.at);
        }
        if way
            .arrived
            .is_some_and(|at| now.at.since(at) > ARRIVED_DURATION)
        {
            return;
        }
        for joint in &evidence.joints {
            let Some(zero_g) = self.zero_g[joint.dof] else {
                continue;
            };
            if way.joints.iter().all(|(dof, _)| *dof != joint.dof) {
                let _full = way.joints.try_push((joint.dof, FreeClose::default()));
            }
            let own = way.joints.iter_mut().find(|(dof, _)| *dof == joint.dof);
            if let Some((_, close)) = own {
                close.push(joint.angle, f32::from(joint.force_g) - zero_g);
            }
        }
    }

    fn state(&mut self, now: &FingerNow, thresholds: &GripThresholds) -> GripState {
        if self.held.is_some_and(|held| now.is_let_go(held.angle))
            && now.contact != Contact::Touching
        {
            self.held = None;
        }
        match (now.contact, self.held) {
            (Contact::Touching, _) => self.touching(now, thresholds),
            (Contact::Nothing, Some(held)) => self.missing(held, now, thresholds),
            (Contact::Nothing | Contact::Unclear | Contact::Unknown, _) if now.is_moving => {
                GripState::Moving
            }
            (Contact::Unknown, _) => GripState::Unknown,
            (Contact::Nothing | Contact::Unclear, _) if now.is_open(thresholds) => GripState::Open,
            (Contact::Unclear, _) if self.is_too_hard(now, thresholds) => GripState::TooHard,
            (Contact::Unclear, _) => GripState::Unknown,
            // Something stopped it that the fingertip alone does not feel.
            (Contact::Nothing, None) if now.is_stopped && !now.is_force_known => GripState::Unknown,
            (Contact::Nothing, None) => GripState::Empty,
        }
    }

    fn touching(&mut self, now: &FingerNow, thresholds: &GripThresholds) -> GripState {
        if now.is_releasing {
            self.held = None;
        }
        // The user touches the finger; it does not grip. What an open finger has closed on, it holds by its position as well.
        let is_idle = self.held.is_none()
            && now.is_open(thresholds)
            && !now.is_stopped_by_force
            && !now.is_moving;
        let is_held = self.held.is_some() || !(now.is_moving || is_idle);
        let slips = |last: f64| now.at.secs() - last <= SLIP_TOLD_S;
        let is_slipping = self.held.is_some() && self.slip.last().is_some_and(slips);
        if is_held && !now.is_releasing {
            self.held = Some(HeldAt {
                angle: now.angle,
                by_tip: now.by_tip || self.held.is_some_and(|held| held.by_tip),
                gone: None,
            });
        }
        match now {
            _ if is_slipping => GripState::Slipping,
            now if self.is_too_hard(now, thresholds) => GripState::TooHard,
            now if now.is_moving => GripState::Moving,
            _ if is_idle => GripState::Open,
            _ => GripState::Holding,
        }
    }

    fn is_too_hard(&self, now: &FingerNow, thresholds: &GripThresholds) -> bool {
        let was_too_hard = self.estimate.state == GripState::TooHard;
        let share = if was_too_hard { SOFTER } else { 1.0 };
        let draws = |ma: i16| i32::from(ma) >= i32::from(thresholds.too_hard_ma);
        now.load_g >= f32::from(thresholds.too_hard_g) * share
            || now.is_overloaded
            || now.current_ma.is_some_and(draws)
    }

    /// Contact is missing at a finger that did not open: at first that may be noise, after the delay the object counts as lost.
    fn missing(&mut self, held: HeldAt, now: &FingerNow, thresholds: &GripThresholds) -> GripState {
        let gone = held.gone.unwrap_or(now.at);
        self.held = Some(HeldAt {
            gone: Some(gone),
            ..held
        });
        if now.at.since(gone) >= thresholds.lost_after() {
            return GripState::Lost;
        }
        self.estimate.state
    }
}

/// One finger at one reading, reduced to what its state depends on.
#[derive(Debug, Clone, Copy)]
struct FingerNow {
    at: Moment,
    /// Angle of the joint that bends the finger.
    angle: i16,
    is_moving: bool,
    is_releasing: bool,
    is_stopped_by_force: bool,
    /// A drive stopped at its force threshold or to protect itself.
    is_stopped: bool,
    is_overloaded: bool,
    /// The zero of its force sensors has been learned.
    is_force_known: bool,
    contact: Contact,
    /// The fingertip touches.
    by_tip: bool,
    /// Largest load of the fingertip and the joints.
    load_g: f32,
    current_ma: Option<i16>,
}

impl FingerNow {
    fn is_open(&self, thresholds: &GripThresholds) -> bool {
        i32::from(self.angle) >= i32::from(thresholds.open_from)
    }

    /// Returns true if the finger opens, or has opened since it was at angle `from`.
    fn is_let_go(&self, from: i16) -> bool {
        self.is_releasing || self.angle - from >= LETS_GO
    }
}
