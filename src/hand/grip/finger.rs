//! The state of one finger, reading by reading.

use crate::hand::dof::PerDof;
use crate::hand::feedback::status::Status;
use crate::hand::grip::evidence::{FingerEvidence, JointEvidence, TipEvidence};
use crate::hand::grip::motion::JointMotion;
use crate::hand::grip::slip::{HELD_N, SlipDetector};
use crate::hand::grip::state::{GripEstimate, GripState};
use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::moment::Moment;

/// Share of each newer force that the zero takes on while a finger is open and free.
const ZERO_SHARE: f32 = 0.05;
/// A finger that opened so far since its last contact let go by itself, units of angle.
const LETS_GO: i16 = 8;
/// Share of a contact threshold above which a finger that touched still does.
const STILL_TOUCHES: f32 = 0.5;
/// A slip is told for so long after it was last seen, s.
const SLIP_TOLD_S: f64 = 0.15;
/// A grip that was too hard is not any more below this share of the threshold.
const SOFTER: f32 = 0.9;

/// What a finger held, until it opens or touches something else.
#[derive(Debug, Clone, Copy)]
struct HeldAt {
    /// Angle of the finger when it was last in contact.
    angle: i16,
    /// When contact was first missed.
    gone: Option<Moment>,
}

/// One finger, and what must be remembered of it.
#[derive(Debug, Clone)]
pub(super) struct FingerEstimator {
    motion: PerDof<JointMotion>,
    zero_g: PerDof<Option<f32>>,
    touches: bool,
    slip: SlipDetector,
    held: Option<HeldAt>,
    pub(super) estimate: GripEstimate,
}

impl FingerEstimator {
    pub(super) fn new(thresholds: &GripThresholds) -> Self {
        Self {
            motion: PerDof::from_fn(|_| JointMotion::default()),
            zero_g: PerDof::splat(None),
            touches: false,
            slip: SlipDetector::new(thresholds),
            held: None,
            estimate: GripEstimate::default(),
        }
    }

    /// Judges slips by other thresholds from now on.
    pub(super) const fn judge_by(&mut self, thresholds: &GripThresholds) {
        self.slip.judge_by(thresholds);
    }

    /// Without evidence nothing is known, and what was held may be gone. The zero of the force sensor stays.
    pub(super) fn forget(&mut self, at: Moment, thresholds: &GripThresholds) {
        self.motion = PerDof::from_fn(|_| JointMotion::default());
        self.touches = false;
        self.slip = SlipDetector::new(thresholds);
        self.held = None;
        let asked = self.estimate.asked;
        self.estimate.become_state(GripState::Unknown, at, asked);
    }

    /// Takes what is known of the finger at this moment.
    pub(super) fn take(
        &mut self,
        evidence: &FingerEvidence,
        at: Moment,
        thresholds: &GripThresholds,
    ) {
        for joint in &evidence.joints {
            self.motion[joint.dof].take(evidence.angle_at, joint.angle);
        }
        self.feel(evidence.tip, thresholds);
        let Some(now) = self.look(evidence, at, thresholds) else {
            self.forget(at, thresholds);
            return;
        };
        if !now.is_moving && now.is_open(thresholds) && self.is_free(evidence.tip, thresholds) {
            self.learn_zero(evidence);
        }
        let state = self.state(&now, thresholds);
        self.estimate.become_state(state, at, Some(evidence.asked));
    }

    fn look(
        &mut self,
        evidence: &FingerEvidence,
        at: Moment,
        thresholds: &GripThresholds,
    ) -> Option<FingerNow> {
        let bend = evidence.bend()?;
        let joints = evidence.joints.iter();
        let load_g = |joint: &JointEvidence| {
            f32::from(joint.force_g) - self.zero_g[joint.dof].unwrap_or_default()
        };
        let is_zero_known = |joint: &JointEvidence| self.zero_g[joint.dof].is_some();
        let felt_g = joints.clone().filter(|joint| is_zero_known(joint));
        let felt_g = felt_g.map(load_g).reduce(f32::max);
        let normal_n = evidence.tip.map(|tip| tip.normal_n);
        let share = if self.touches { STILL_TOUCHES } else { 1.0 };
        let reaches = |value: f32, least: f32| value >= least * share;
        let by_force = felt_g.map(|g| reaches(g, f32::from(thresholds.contact_g)));
        let by_tip = normal_n.map(|n| reaches(n, thresholds.contact_n));
        let contact = match (by_tip, by_force) {
            (None, None) => None,
            (tip, force) => Some(tip.unwrap_or(false) || force.unwrap_or(false)),
        };
        self.touches = contact == Some(true);
        let tip_g = evidence.tip.map_or(0.0, |tip| tip.normal_g());
        let drives = |is: fn(Status) -> bool| joints.clone().any(|joint| is(joint.status));
        Some(FingerNow {
            at,
            angle: bend.angle,
            is_moving: joints
                .clone()
                .any(|joint| self.motion[joint.dof].is_moving(at, joint.status)),
            is_releasing: bend.status == Status::Releasing,
            is_stopped_by_force: bend.status == Status::ForceReached,
            is_blocked: drives(Status::is_protective),
            is_overloaded: drives(|status| status == Status::CurrentProtection),
            is_force_known: by_force.is_some(),
            contact,
            load_g: joints.clone().map(load_g).fold(tip_g, f32::max),
            current_ma: joints.clone().filter_map(|joint| joint.current_ma).max(),
        })
    }

    /// The slip detector begins anew with each contact.
    fn feel(&mut self, tip: Option<TipEvidence>, thresholds: &GripThresholds) {
        let Some(tip) = tip else {
            return;
        };
        if f64::from(tip.normal_n) < HELD_N {
            self.slip = SlipDetector::new(thresholds);
        } else if let Some(moment) = tip.news {
            self.slip.take(moment);
        }
    }

    fn is_free(&self, tip: Option<TipEvidence>, thresholds: &GripThresholds) -> bool {
        tip.is_none_or(|tip| tip.normal_n < thresholds.contact_n * STILL_TOUCHES)
    }

    fn learn_zero(&mut self, evidence: &FingerEvidence) {
        for joint in &evidence.joints {
            let force = f32::from(joint.force_g);
            let zero = self.zero_g[joint.dof].get_or_insert(force);
            *zero += (force - *zero) * ZERO_SHARE;
        }
    }

    fn state(&mut self, now: &FingerNow, thresholds: &GripThresholds) -> GripState {
        let Some(touches) = now.contact else {
            return if now.is_moving {
                GripState::Moving
            } else {
                GripState::Unknown
            };
        };
        if touches {
            return self.touching(now, thresholds);
        }
        match self.held {
            Some(held) if now.is_let_go(held.angle) => self.held = None,
            Some(held) => return self.missing(held, now, thresholds),
            None => {}
        }
        match now {
            now if now.is_moving => GripState::Moving,
            now if now.is_open(thresholds) => GripState::Open,
            // Something stopped it, which the fingertip alone does not feel.
            now if now.is_blocked && !now.is_force_known => GripState::Unknown,
            _ => GripState::Empty,
        }
    }

    fn touching(&mut self, now: &FingerNow, thresholds: &GripThresholds) -> GripState {
        // Touched by somebody, not gripping.
        let is_idle = now.is_open(thresholds) && !now.is_stopped_by_force && !now.is_moving;
        if now.is_releasing || is_idle {
            self.held = None;
        }
        let is_held = self.held.is_some() || !(now.is_moving || is_idle);
        let slips = |last: f64| now.at.secs() - last <= SLIP_TOLD_S;
        let is_slipping = self.held.is_some() && self.slip.last().is_some_and(slips);
        if is_held && !now.is_releasing {
            self.held = Some(HeldAt {
                angle: now.angle,
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

    /// Contact is missed at a finger that did not open: for a moment that may be noise, then what it held is lost.
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

/// One finger at one reading, as far as its state needs it.
#[derive(Debug, Clone, Copy)]
struct FingerNow {
    at: Moment,
    /// Of the joint that bends it.
    angle: i16,
    is_moving: bool,
    is_releasing: bool,
    is_stopped_by_force: bool,
    /// A drive stopped to protect itself.
    is_blocked: bool,
    is_overloaded: bool,
    /// The zero of its force sensors is known.
    is_force_known: bool,
    /// `None` if no fingertip tells, and the zero of the force sensor was not learnt yet.
    contact: Option<bool>,
    /// The largest of fingertip and joints.
    load_g: f32,
    current_ma: Option<i16>,
}

impl FingerNow {
    fn is_open(&self, thresholds: &GripThresholds) -> bool {
        i32::from(self.angle) >= i32::from(thresholds.open_from)
    }

    /// Whether it opens, or opened since it was at this angle.
    fn is_let_go(&self, from: i16) -> bool {
        self.is_releasing || self.angle - from >= LETS_GO
    }
}
