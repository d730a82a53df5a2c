//! The result of a search: a justified claim, or the reason for its absence; the closes tried, and open questions. Pure.

use crate::hand::newtons::newtons;
use crate::hand::{Dof, PerDof};
use crate::trials::plan::TrialSetting;
use crate::trials::search::offset::ThresholdReference;
use crate::trials::search::tolerance::Assurance;
use serde::Serialize;
use std::time::Duration;

/// Approach of a close in a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(tag = "stages")]
pub enum FoundApproach {
    /// At the setting's speed all the way.
    #[serde(rename = "one")]
    OneStage,
    /// Fast to just before the contact, then at the setting's speed.
    #[serde(rename = "two")]
    TwoStage {
        /// SPEED_SET of the first stage.
        fast_speed: i16,
        /// Start of the second stage before the mean contact, units of ANGLE_ACT.
        margin: i16,
    },
}

/// A close that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Trial number, from 1.
    pub number: usize,
    #[serde(flatten)]
    pub setting: TrialSetting,
    pub approach: FoundApproach,
    /// The highest peak of all joints, g.
    pub peak_g: Option<f64>,
    /// From the command to the last joint's stop, s.
    pub close_s: Option<f64>,
    /// True if its peak was over the limit.
    pub over_limit: bool,
    /// True if it counts for the claim.
    pub confirms: bool,
}

/// One joint's part of a claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointClaim {
    #[serde(rename = "joint")]
    pub dof: Dof,
    /// Mean angle at the contact, units of ANGLE_ACT.
    pub contact_angle: f64,
    /// Bound of the peak, g.
    pub peak_bound_g: f64,
    /// The peaks behind the bound, g.
    pub peaks_g: Vec<f64>,
    /// The lowest remaining grip, g.
    pub hold_g: f64,
    /// Stiffness, g per unit of ANGLE_ACT; `None` if the object gave too little to determine it.
    pub stiffness_g: Option<f64>,
}

/// The fastest confirmed close under the limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub setting: TrialSetting,
    pub approach: FoundApproach,
    pub joints: Vec<JointClaim>,
    /// Mean time from the command to the last joint's stop, s.
    pub close_s: f64,
    /// Closes behind the bound.
    pub closes: usize,
    /// Those of them made with this setting.
    pub here: usize,
    pub assurance: Assurance,
    /// True if the bound is the largest of them, whatever their distribution.
    pub distribution_free: bool,
}

impl Claim {
    /// The highest bound of its joints, g.
    pub fn peak_bound_g(&self) -> f64 {
        let bounds = self.joints.iter().map(|joint| joint.peak_bound_g);
        bounds.fold(0.0, f64::max)
    }

    /// The same in newtons, with these for a gram of each joint; `None` unless all of its joints were measured.
    pub fn peak_bound_n(&self, newtons_per_g: &PerDof<Option<f64>>) -> Option<f64> {
        let bound =
            |joint: &JointClaim| Some(newtons(joint.peak_bound_g, newtons_per_g[joint.dof]?));
        let bounds: Option<Vec<f64>> = self.joints.iter().map(bound).collect();
        bounds?.into_iter().reduce(f64::max)
    }
}

impl std::fmt::Display for Claim {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<&str> = self.joints.iter().map(|joint| title(joint.dof)).collect();
        let names = names.join(" and ");
        let verb = if self.joints.len() > 1 {
            "close"
        } else {
            "closes"
        };
        let Assurance {
            coverage,
            confidence,
        } = self.assurance;
        write!(
            f,
            "{names} on this object: {verb} in {:.2} s, peak at most {:.0} g in {:.0} of 100 closes ({:.0} % sure {}, {} closes)",
            self.close_s,
            self.peak_bound_g().ceil(),
            coverage * 100.0,
            confidence * 100.0,
            if self.distribution_free {
                "however the peaks vary"
            } else {
                "if the peaks vary normally"
            },
            self.closes,
        )
    }
}

/// A joint at the start of a sentence.
const fn title(dof: Dof) -> &'static str {
    match dof {
        Dof::Little => "Little",
        Dof::Ring => "Ring",
        Dof::Middle => "Middle",
        Dof::Index => "Index",
        Dof::ThumbBend => "Thumb bend",
        Dof::ThumbRotate => "Thumb rotate",
    }
}

/// Reason for a search without a claim.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoClaim {
    /// The joint never moved.
    #[error(
        "commanded to close, {} never moved: check STATUS, ERROR and the supply, and whether something blocks it", dof.name()
    )]
    Dead { dof: Dof },
    /// The fingertip pressed against something before the joint moved.
    #[error(
        "the fingertip of {} felt something before it moved: place the object so that no finger touches it when the hand is open", dof.name()
    )]
    Touching { dof: Dof },
    /// The joint met nothing on its full way.
    #[error(
        "{} met nothing on its way: put the object where it closes, or let it close further", dof.name()
    )]
    NoContact { dof: Dof },
    /// The joint met nothing at the place of the object.
    #[error(
        "{} no longer met anything where it had met the object: put it back, and make sure that it cannot move", dof.name()
    )]
    Lost { dof: Dof },
    /// The object became softer, or its force vanished.
    #[error(
        "the object yields under {}: its stiffness was {before_g:.0} g for each count before and is {now_g:.0} g now; check it for damage, and set a lower limit", dof.name()
    )]
    Gives {
        dof: Dof,
        /// g per unit of ANGLE_ACT.
        before_g: f64,
        now_g: f64,
    },
    /// The object moves from close to close.
    #[error(
        "the object creeps: {} meets it {:.1} counts {} with each close; fix it, or put it where it cannot move", dof.name(), counts.abs(), if *counts > 0.0 { "earlier" } else { "later" }
    )]
    Creeps {
        dof: Dof,
        /// Units of ANGLE_ACT per close.
        counts: f64,
    },
    /// The object slips even in the slowest close.
    #[error(
        "the object slips under {} even at a slow close: hold it with more, or place it better", dof.name()
    )]
    Slips { dof: Dof },
    /// The limit is too close to the noise of the sensor.
    #[error(
        "a limit of {limit_g} g cannot be distinguished from the noise of {}, which is {noise_g:.0} g: set at least {least_g:.0} g", dof.name()
    )]
    Noise {
        dof: Dof,
        limit_g: i16,
        noise_g: f64,
        least_g: f64,
    },
    /// Even the slowest close may be over the limit.
    #[error(
        "even at speed {speed} {} may peak at {peak_g:.0} g with the threshold that holds: raise the limit, or hold with less", dof.name()
    )]
    TooStrong { dof: Dof, speed: i16, peak_g: f64 },
    /// Too little of the grip remains.
    #[error(
        "{} holds with {holds_g:.0} g only under this limit, not with {wanted_g}: raise the limit, or hold with less", dof.name()
    )]
    HoldsTooLittle {
        dof: Dof,
        holds_g: f64,
        wanted_g: i16,
    },
    /// The peak could not be read.
    #[error(
        "the peak of {} could not be measured: its force readings are missing or too few", dof.name()
    )]
    NotMeasured { dof: Dof },
    /// The stop, or the force held after it, could not be read.
    #[error(
        "the stop of {} could not be seen: its angle, status or force readings after it are missing or too few", dof.name()
    )]
    NoStop { dof: Dof },
    /// The sensor reads so high at rest that the drive stops before it meets anything.
    #[error(
        "{} stops before it meets anything: its force sensor reads {offset_g:.0} g at rest, which its drive counts; calibrate the force sensors", dof.name()
    )]
    Offset { dof: Dof, offset_g: f64 },
    /// The search did not converge.
    #[error(
        "no setting could be confirmed in {trials} closes: the peaks scatter too much for this limit; the object may lie differently each time"
    )]
    NotConfirmed { trials: usize },
}

/// The reference of a drive's force threshold, as found by a search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ComparedThreshold {
    #[serde(rename = "joint")]
    pub dof: Dof,
    /// `None` if the closes do not determine it.
    pub compared: Option<ThresholdReference>,
    /// Reading of its force sensor at rest, g.
    pub offset_g: f64,
}

/// Smaller offsets, g, make no difference.
const NOTABLE_OFFSET_G: f64 = 10.0;

impl ComparedThreshold {
    /// True if the offset is worth reporting.
    pub fn is_notable(&self) -> bool {
        self.offset_g.abs() > NOTABLE_OFFSET_G
    }
}

impl std::fmt::Display for ComparedThreshold {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, offset) = (self.dof.name(), self.offset_g);
        match self.compared {
            Some(ThresholdReference::AsRead) => write!(
                f,
                "{name} compares its threshold with FORCE_ACT as read: it reads {offset:.0} g at rest, so a threshold stops it at that much less force above rest"
            ),
            Some(ThresholdReference::AboveRest) => write!(
                f,
                "{name} compares its threshold with the force above rest: the {offset:.0} g that it reads at rest do not count"
            ),
            Some(ThresholdReference::Unknown) | None => write!(
                f,
                "whether {name} counts the {offset:.0} g that it reads at rest in its threshold was not determined"
            ),
        }
    }
}

/// A question that the search could not answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OpenQuestion {
    #[error("whether the object slipped: the fingertip of {} reported too little", dof.name())]
    Slips { dof: Dof },
    #[error(
        "how stiff the object is under {}: it yielded less than an angle resolves", dof.name()
    )]
    Stiffness { dof: Dof },
    #[error(
        "peaks between two readings of {}: they were up to {:.0} ms apart", dof.name(), gap_s * 1000.0
    )]
    Gaps { dof: Dof, gap_s: f64 },
    #[error(
        "whether the drive of {} counts the {offset_g:.0} g that its force sensor reads at rest in its threshold", dof.name()
    )]
    Offset { dof: Dof, offset_g: f64 },
    #[error("whether the peaks are normally distributed, on which the bound rests")]
    Distribution,
    #[error(
        "whether stops are as late at this speed as at the others, at which {closes} of the closes were made"
    )]
    OtherSpeeds { closes: usize },
}

impl OpenQuestion {
    /// True for the same question about the same joint; figures may differ.
    pub(crate) fn is_of_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Slips { dof }, Self::Slips { dof: same })
            | (Self::Stiffness { dof }, Self::Stiffness { dof: same })
            | (Self::Offset { dof, .. }, Self::Offset { dof: same, .. })
            | (Self::Gaps { dof, .. }, Self::Gaps { dof: same, .. }) => dof == same,
            (Self::Distribution, Self::Distribution)
            | (Self::OtherSpeeds { .. }, Self::OtherSpeeds { .. }) => true,
            _ => false,
        }
    }
}

/// The complete result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The claim, or the reason for its absence.
    pub result: Result<Claim, NoClaim>,
    /// Every close, in order.
    pub tried: Vec<Tried>,
    pub open_questions: Vec<OpenQuestion>,
    /// The threshold references of the drives, in joint order.
    pub compared: Vec<ComparedThreshold>,
}

/// Activity of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchStage {
    /// Slow closes to find the contact.
    Probing,
    /// Increasing the speed.
    Rising,
    /// Repeating one setting.
    Confirming {
        /// Its finished closes.
        done: usize,
        of: usize,
    },
    /// Finished.
    Over,
}

/// Progress of a search, for display.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchProgress {
    pub stage: SearchStage,
    /// Every close so far.
    pub tried: Vec<Tried>,
    /// Estimated number of remaining closes.
    pub closes_left: usize,
    /// Their estimated duration.
    pub left: Duration,
}
