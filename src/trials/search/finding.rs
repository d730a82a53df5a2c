//! What a search came to: a claim that can be believed, or why there is none; what was tried, and what could not be told. Pure.

use crate::hand::Dof;
use crate::trials::plan::TrialSetting;
use crate::trials::search::offset::Compared;
use crate::trials::search::tolerance::Assurance;
use serde::Serialize;
use std::time::Duration;

/// How an object is come near in a close that was found.
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
        /// The second begins so far before the mean contact, units of ANGLE_ACT.
        margin: i16,
    },
}

/// A close that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Of the trial, from 1.
    pub number: usize,
    #[serde(flatten)]
    pub setting: TrialSetting,
    pub approach: FoundApproach,
    /// The highest peak of all joints, g.
    pub peak_g: Option<f64>,
    /// From the command to the last joint's stop, s.
    pub close_s: Option<f64>,
    /// Whether its peak was over the limit.
    pub over_limit: bool,
    /// Whether it counts for the claim.
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
    /// The peaks that it rests on, g.
    pub peaks_g: Vec<f64>,
    /// The least that was left of the grip, g.
    pub hold_g: f64,
    /// g for each unit of ANGLE_ACT; `None` where it gave too little to tell.
    pub stiffness_g: Option<f64>,
}

/// The fastest close that stays under the limit, as it was confirmed.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub setting: TrialSetting,
    pub approach: FoundApproach,
    pub joints: Vec<JointClaim>,
    /// From the command to the last joint's stop, mean, s.
    pub close_s: f64,
    /// Closes that the bound rests on.
    pub closes: usize,
    /// Those of them that were closed with this setting.
    pub here: usize,
    pub assurance: Assurance,
    /// Whether the bound is the largest of them, whatever their distribution.
    pub distribution_free: bool,
}

impl Claim {
    /// The highest bound of its joints, g.
    pub fn peak_bound_g(&self) -> f64 {
        let bounds = self.joints.iter().map(|joint| joint.peak_bound_g);
        bounds.fold(0.0, f64::max)
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

/// Why there is no claim.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoClaim {
    /// It never moved.
    #[error(
        "told to close, {} never moved: look at STATUS, ERROR and the supply, and whether something blocks it", dof.name()
    )]
    Dead { dof: Dof },
    /// It pressed against something before it moved.
    #[error(
        "the fingertip of {} felt something before it moved: place the object so that no finger touches it when the hand is open", dof.name()
    )]
    Touching { dof: Dof },
    /// It went all its way and met nothing.
    #[error(
        "{} met nothing on its way: put the object where it closes, or let it close further", dof.name()
    )]
    NoContact { dof: Dof },
    /// It met nothing where it had met the object.
    #[error(
        "{} met nothing any more where it had met the object: put it back, and see that it cannot move away", dof.name()
    )]
    Lost { dof: Dof },
    /// The object became softer, or its force went away.
    #[error(
        "the object gives under {}: it held {before_g:.0} g for each count before and {now_g:.0} g now; look whether it is damaged, and ask for a lower limit", dof.name()
    )]
    Gives {
        dof: Dof,
        /// g for each unit of ANGLE_ACT.
        before_g: f64,
        now_g: f64,
    },
    /// The object does not stay where it is.
    #[error(
        "the object creeps: {} meets it {:.1} counts {} with each close; fix it, or put it where it cannot move", dof.name(), counts.abs(), if *counts > 0.0 { "earlier" } else { "later" }
    )]
    Creeps {
        dof: Dof,
        /// Units of ANGLE_ACT from one close to the next.
        counts: f64,
    },
    /// The object slipped even at the slowest.
    #[error(
        "the object slips under {} even at a slow close: hold it with more, or place it better", dof.name()
    )]
    Slips { dof: Dof },
    /// The limit is not above what the sensor tells from its noise.
    #[error(
        "a limit of {limit_g} g cannot be told from the noise of {}, which is {noise_g:.0} g: ask for at least {least_g:.0} g", dof.name()
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
    /// Not enough is left of the grip.
    #[error(
        "{} holds with {holds_g:.0} g only under this limit, not with {wanted_g}: raise the limit, or hold with less", dof.name()
    )]
    HoldsTooLittle {
        dof: Dof,
        holds_g: f64,
        wanted_g: i16,
    },
    /// Something could not be read.
    #[error(
        "the peak of {} could not be measured: its force readings are missing or too few", dof.name()
    )]
    NotMeasured { dof: Dof },
    /// When it stopped, or what it held then, could not be read.
    #[error(
        "the stop of {} could not be seen: its angle, status or force readings after it are missing or too few", dof.name()
    )]
    NoStop { dof: Dof },
    /// Its sensor reads so much at rest that the drive stops before it meets anything.
    #[error(
        "{} stops before it meets anything: its force sensor reads {offset_g:.0} g at rest, which its drive counts; calibrate the force sensors", dof.name()
    )]
    Offset { dof: Dof, offset_g: f64 },
    /// It did not settle.
    #[error(
        "no setting could be confirmed in {trials} closes: the peaks scatter too much for this limit; the object may lie differently each time"
    )]
    NotConfirmed { trials: usize },
}

/// What a drive was found to compare its force threshold with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ComparedThreshold {
    #[serde(rename = "joint")]
    pub dof: Dof,
    /// `None` where the closes did not tell.
    pub compared: Option<Compared>,
    /// What its force sensor reads at rest, g.
    pub offset_g: f64,
}

/// An offset of less, g, makes no difference.
const NOTABLE_OFFSET_G: f64 = 10.0;

impl ComparedThreshold {
    /// Whether the offset is worth a word.
    pub fn is_notable(&self) -> bool {
        self.offset_g.abs() > NOTABLE_OFFSET_G
    }
}

impl std::fmt::Display for ComparedThreshold {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, offset) = (self.dof.name(), self.offset_g);
        match self.compared {
            Some(Compared::AsRead) => write!(
                f,
                "{name} compares its threshold with FORCE_ACT as read: it reads {offset:.0} g at rest, so a threshold stops it at that much less force above rest"
            ),
            Some(Compared::AboveRest) => write!(
                f,
                "{name} compares its threshold with the force above rest: the {offset:.0} g that it reads at rest do not count"
            ),
            Some(Compared::Unknown) | None => write!(
                f,
                "whether {name} counts the {offset:.0} g that it reads at rest in its threshold was not told"
            ),
        }
    }
}

/// What could not be told.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Untold {
    #[error("whether the object slipped: the fingertip of {} told too little", dof.name())]
    Slips { dof: Dof },
    #[error(
        "how stiff the object is under {}: it gave less than an angle can tell", dof.name()
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

impl Untold {
    /// Whether it is the same of the same joint; a figure may differ.
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

/// All that a search came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The claim, or why there is none.
    pub result: Result<Claim, NoClaim>,
    /// Every close, in order.
    pub tried: Vec<Tried>,
    pub untold: Vec<Untold>,
    /// What the drives compare their thresholds with, in the order of the joints.
    pub compared: Vec<ComparedThreshold>,
}

/// What a search does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchStage {
    /// Slow closes that look for the contact.
    Probing,
    /// Upwards from slow.
    Rising,
    /// A setting, again and again.
    Confirming {
        /// Closes of it that are done.
        done: usize,
        of: usize,
    },
    /// Nothing any more.
    Over,
}

/// Where a search stands, to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchProgress {
    pub stage: SearchStage,
    /// Every close so far.
    pub tried: Vec<Tried>,
    /// Closes that are still to come, about.
    pub closes_left: usize,
    /// How long they take, about.
    pub left: Duration,
}
