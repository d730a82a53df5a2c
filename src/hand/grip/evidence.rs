//! Evidence for the state of one finger, extracted from a sample: fresh and plausible, or absent.

use crate::hand::dof::{Dof, Finger};
use crate::hand::feedback::group::{Group, Groups};
use crate::hand::feedback::reading::CurrentReading;
use crate::hand::feedback::sample::HandSample;
use crate::hand::feedback::status::Status;
use crate::hand::feedback::tactile::TactileBlock;
use crate::hand::grip::contact::STILL_TOUCHES;
use crate::hand::grip::slip::HeldMoment;
use crate::hand::grip::thresholds::GripThresholds;
use crate::hand::moment::{Moment, Timed};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Grams-force per newton.
const G_PER_N: f32 = 102.0;
/// Joints of the thumb; the other fingers have one.
pub(super) const JOINTS_MAX: usize = 2;

/// One joint of a finger.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointEvidence {
    pub(super) dof: Dof,
    /// Angle, 0..=1000.
    pub(super) angle: i16,
    /// Force as the sensor reports it, including its zero error, g.
    pub(super) force_g: i16,
    /// Motor current, mA; `None` if it is not known or out of range.
    pub(super) current_ma: Option<i16>,
    pub(super) status: Status,
}

/// A fingertip.
#[derive(Debug, Clone, Copy)]
pub(super) struct TipEvidence {
    /// Normal force, N.
    pub(super) normal_n: f32,
    /// Its channels.
    pub(super) raw: [u32; 8],
    /// Reading for the slip detector; `None` if it is not new.
    pub(super) news: Option<HeldMoment>,
}

impl TipEvidence {
    /// The normal force, g.
    pub(super) const fn normal_g(&self) -> f32 {
        self.normal_n * G_PER_N
    }
}

/// Evidence for one finger at one reading.
#[derive(Debug, Clone)]
pub(super) struct FingerEvidence {
    pub(super) joints: ArrayVec<JointEvidence, JOINTS_MAX>,
    /// `None` where fingertips are not read or read too rarely.
    pub(super) tip: Option<TipEvidence>,
    /// Time at which the angles were received.
    pub(super) angle_at: Moment,
    /// Request time of the oldest part.
    pub(super) asked: Moment,
}

/// Time of a reading, the groups that are new in it, and the allowed age of its parts.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReadingAt {
    pub(super) at: Moment,
    pub(super) fresh: Groups,
    pub(super) fresh_for: Duration,
}

impl FingerEvidence {
    /// Extracts the evidence for a finger; `None` if angle, force or status are missing, old or implausible.
    pub(super) fn of(sample: &HandSample, finger: Finger, reading: ReadingAt) -> Option<Self> {
        let angle = reading.known(sample.angle)?;
        let force = reading.known(sample.force)?;
        let status = reading.known(sample.status)?;
        let current = reading.known(sample.current);
        let tip = reading.known(sample.tactile[finger]);
        let mut joints = ArrayVec::new();
        for dof in Dof::ALL.into_iter().filter(|dof| dof.finger() == finger) {
            joints.push(JointEvidence {
                dof,
                angle: angle.value[dof].hold()?.get(),
                force_g: force.value[dof].documented()?,
                current_ma: current.and_then(|six| CurrentReading::documented(six.value[dof])),
                status: status.value[dof],
            });
        }
        let normal = tip.and_then(|tip| Some((tip, tip.value.normal()?)));
        let tip_asked = normal.map_or(angle.asked, |(tip, _)| tip.asked);
        let asked = [angle.asked, force.asked, status.asked, tip_asked];
        Some(Self {
            joints,
            tip: normal.map(|(tip, normal_n)| TipEvidence {
                normal_n,
                raw: tip.value.raw,
                news: held(&tip).filter(|_| reading.fresh.contains(Group::Tactile(finger))),
            }),
            angle_at: angle.received,
            asked: asked.into_iter().min().unwrap_or(angle.asked),
        })
    }

    /// Returns true if the fingertip touches nothing or is not read.
    pub(super) fn is_tip_free(&self, thresholds: &GripThresholds) -> bool {
        let least = thresholds.contact_n * STILL_TOUCHES;
        self.tip.is_none_or(|tip| tip.normal_n < least)
    }

    /// Returns the joint that bends the finger.
    pub(super) fn bend(&self) -> Option<&JointEvidence> {
        let is_bend = |joint: &&JointEvidence| joint.dof == joint.dof.finger().bend();
        self.joints.iter().find(is_bend)
    }
}

impl ReadingAt {
    fn known<T: Copy>(&self, read: Option<Timed<T>>) -> Option<Timed<T>> {
        read.filter(|read| read.age(self.at) <= self.fresh_for)
    }
}

fn held(tip: &Timed<TactileBlock>) -> Option<HeldMoment> {
    let normal = f64::from(tip.value.normal()?);
    let tangential = f64::from(tip.value.tangential()?);
    Some(HeldMoment {
        t: tip.received.secs(),
        ratio: tangential / normal.max(f64::EPSILON),
        direction: tip.value.direction_deg().map(f64::from),
        spot_mm: None,
    })
}
