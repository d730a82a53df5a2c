//! What a hold shows of its conditions: forces, stiffness, friction and load, as one close or as a grasp to be saved. Pure.

use crate::hand::hold_forces::HoldForces;
use crate::hand::statistics::median;
use crate::hand::{Angle, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger};
use crate::motion::grasp::saved::{
    FrictionSeen, Grasp, GraspClaim, GraspClose, GraspFinger, GraspResult, round,
};
use crate::motion::hold::{HoldClose, HoldEnd, HoldPhase, HoldRun};
use crate::motion::program::{Ended, Program as _};
use crate::record::Abort;
use crate::transport::Endpoint;
use std::collections::VecDeque;
use std::time::Duration;

/// Readings over which forces and ratios are filtered.
const RECENT: usize = 3;
/// Force on all fingertips below which a ratio says nothing, N.
const RATIO_FROM_N: f64 = 0.6;
/// Age up to which a reading of a fingertip shows its load now.
const FRESH: Duration = Duration::from_millis(500);
/// Shortest hold that can be saved.
pub(super) const HELD_LEAST: Duration = Duration::from_secs(2);

/// What a finger that holds showed in one close.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FingerSeen {
    /// Angle at which it last held.
    pub angle: Angle,
    /// Largest force until it held, g of the hand.
    pub close_peak_g: f64,
    /// Largest force, g of the hand.
    pub peak_g: f64,
    /// Mean force while it held, g of the hand.
    pub force_g: f64,
    /// Stiffness of the contact, g of the hand for each unit of angle; `None` if it moved too little to show it.
    pub stiffness_g: Option<f64>,
}

/// What one close showed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloseSeen {
    /// The fingers that held.
    pub fingers: PerFinger<Option<FingerSeen>>,
    /// Its friction.
    pub friction: FrictionSeen,
    /// Largest load along the fingertips, N; `None` if a fingertip that held was not read.
    pub load_n: Option<f64>,
    /// *At most* did not suffice.
    pub was_short: bool,
}

/// What the user says about a grasp that is saved, and what is known of the hand.
#[derive(Debug, Clone)]
pub struct GraspLabel {
    /// Its name.
    pub name: String,
    /// The user's text.
    pub note: String,
    /// Today.
    pub day: String,
    /// The hand.
    pub hand: Endpoint,
    /// Name of the pose that it closes to.
    pub pose: Option<String>,
    /// Newtons for a gram of each joint, where they were measured.
    pub newtons: PerDof<Option<f64>>,
    /// Tune's claim.
    pub claim: Option<GraspClaim>,
}

/// Reason why a hold is not saved.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoGrasp {
    /// It failed.
    #[error("it did not end well")]
    Failed,
    /// It was too short.
    #[error("it held for {held_s:.1} s: hold for {} s or more", HELD_LEAST.as_secs())]
    Short {
        /// Time for which it held, s.
        held_s: f64,
    },
    /// At most did not suffice.
    #[error("at most did not suffice at times: raise it, and hold again")]
    CouldNotHold,
    /// The hand held the object already.
    #[error(
        "it took over what the hand held, so how it closes is not known: open the hand, and name a pose or a gap"
    )]
    TookOver,
    /// No finger was seen to hold.
    #[error("no finger that holds was read")]
    NotRead,
}

#[derive(Debug, Clone, Default)]
struct FingerWatch {
    forces: VecDeque<f64>,
    close_peak_g: f64,
    peak_g: f64,
    /// Sum of the forces while it held, and their number.
    held: (f64, f64),
    angle: Option<Angle>,
    stiffness_g: Option<f64>,
}

/// Watches one hold.
#[derive(Debug, Clone)]
pub(super) struct GraspWatch {
    fingers: PerFinger<FingerWatch>,
    ratios: VecDeque<f64>,
    loads: VecDeque<f64>,
    /// Time at which all fingertips that hold were last read.
    loads_at: Option<Moment>,
    friction: FrictionSeen,
    load_n: Option<f64>,
    was_short: bool,
}

impl GraspWatch {
    pub(super) fn new() -> Self {
        Self {
            fingers: PerFinger::from_fn(|_| FingerWatch::default()),
            ratios: VecDeque::new(),
            loads: VecDeque::new(),
            loads_at: None,
            friction: FrictionSeen::default(),
            load_n: None,
            was_short: false,
        }
    }

    /// Applies a reading that the hold has applied.
    pub(super) fn read(&mut self, hold: &HoldRun, sample: &HandSample, fresh: Groups, now: Moment) {
        let view = hold.view(now);
        let is_held = hold.held_for(now).is_some();
        if fresh.contains(Group::Force) {
            self.read_forces(hold, sample, view.force_g.map(|g| g.is_some() && is_held));
        }
        if is_held && fresh.has_tactile() {
            self.read_tips(sample, view.force_g.map(|g| g.is_some()), now);
        }
        self.was_short |= view.phase == HoldPhase::CannotHold;
    }

    fn read_forces(&mut self, hold: &HoldRun, sample: &HandSample, holds: PerFinger<bool>) {
        let stiffness = hold.stiffness_g();
        for (finger, own) in self.fingers.iter_mut() {
            let Some(force_g) = hold.force_g(sample, finger.bend()) else {
                continue;
            };
            let force_g = filtered(&mut own.forces, force_g);
            own.peak_g = own.peak_g.max(force_g);
            if !holds[finger] {
                own.close_peak_g = own.peak_g;
                continue;
            }
            own.held.0 += force_g;
            own.held.1 += 1.0;
            own.stiffness_g = stiffness[finger];
            let angle = sample
                .angle
                .and_then(|angle| angle.value[finger.bend()].hold());
            own.angle = angle.or(own.angle);
        }
    }

    fn read_tips(&mut self, sample: &HandSample, holds: PerFinger<bool>, now: Moment) {
        let holding = holds.iter().filter(|(_, holds)| **holds);
        let tips: Option<Vec<(f64, f64)>> = holding
            .map(|(finger, _)| {
                let tip = sample.tactile[finger].filter(|tip| tip.age(now) <= FRESH)?;
                let tip = tip.value;
                Some((f64::from(tip.normal()?), f64::from(tip.tangential()?)))
            })
            .collect();
        let Some(tips) = tips.filter(|tips| !tips.is_empty()) else {
            return;
        };
        let normal_n: f64 = tips.iter().map(|tip| tip.0).sum();
        let load_n = filtered(&mut self.loads, tips.iter().map(|tip| tip.1).sum());
        self.loads_at = Some(now);
        self.load_n = Some(self.load_n.unwrap_or_default().max(load_n));
        if normal_n < RATIO_FROM_N {
            return;
        }
        let ratio = filtered(&mut self.ratios, load_n / normal_n);
        let slid = self.friction.slid_ratio;
        if slid.is_none_or(|slid| ratio < slid) {
            let held = self.friction.held_ratio.unwrap_or_default();
            self.friction.held_ratio = Some(held.max(ratio));
        }
    }

    /// Notes that the object slid on a finger.
    pub(super) fn slid(&mut self) {
        if let Some(ratio) = self.ratios.back() {
            let slid = self.friction.slid_ratio.unwrap_or(*ratio);
            self.friction.slid_ratio = Some(slid.min(*ratio));
        }
    }

    /// Load along the fingertips now, N; `None` if one that holds is not read.
    pub(super) fn load_now_n(&self, now: Moment) -> Option<f64> {
        self.loads_at.filter(|at| now.since(*at) <= FRESH)?;
        median(&self.loads.iter().copied().collect::<Vec<f64>>())
    }

    pub(super) const fn load_n(&self) -> Option<f64> {
        self.load_n
    }

    /// What it has shown so far.
    pub(super) fn seen(&self) -> CloseSeen {
        CloseSeen {
            fingers: PerFinger::from_fn(|finger| self.fingers[finger].seen()),
            friction: self.friction,
            load_n: self.load_n,
            was_short: self.was_short,
        }
    }
}

impl FingerWatch {
    fn seen(&self) -> Option<FingerSeen> {
        let (sum_g, count) = self.held;
        let angle = self.angle.filter(|_| count > 0.0)?;
        Some(FingerSeen {
            angle,
            close_peak_g: self.close_peak_g,
            peak_g: self.peak_g,
            force_g: sum_g / count,
            stiffness_g: self.stiffness_g,
        })
    }
}

/// Adds a value, and returns the median of the recent ones.
fn filtered(recent: &mut VecDeque<f64>, value: f64) -> f64 {
    if recent.len() >= RECENT {
        recent.pop_front();
    }
    recent.push_back(value);
    median(recent.make_contiguous()).unwrap_or(value)
}

/// What is needed to save a hold.
pub(super) struct Ending<'a> {
    pub(super) end: Ended<HoldEnd>,
    pub(super) held: Option<Duration>,
    pub(super) has_closed: bool,
    pub(super) tightened: u32,
    pub(super) close: HoldClose,
    pub(super) forces: HoldForces,
    pub(super) reading_per_g: &'a PerDof<f64>,
}

impl Ending<'_> {
    /// Checks that the hold can be saved.
    pub(super) fn worked(&self, seen: &CloseSeen) -> Result<(), NoGrasp> {
        if !matches!(self.end, Ok(HoldEnd::Held) | Err(Abort::Person)) {
            return Err(NoGrasp::Failed);
        }
        let held = self.held.unwrap_or_default();
        if held < HELD_LEAST {
            let held_s = held.as_secs_f64();
            return Err(NoGrasp::Short { held_s });
        }
        if !self.has_closed {
            return Err(NoGrasp::TookOver);
        }
        if seen.was_short {
            return Err(NoGrasp::CouldNotHold);
        }
        let is_read = seen.fingers.as_array().iter().any(Option::is_some);
        is_read.then_some(()).ok_or(NoGrasp::NotRead)
    }
}

/// The grasp of a hold that worked.
pub(super) fn grasp(
    seen: &CloseSeen,
    ending: &Ending<'_>,
    about: GraspLabel,
) -> Result<Grasp, NoGrasp> {
    ending.worked(seen)?;
    let fingers = PerFinger::from_fn(|finger: Finger| {
        let own = seen.fingers[finger]?;
        Some(GraspFinger {
            angle: own.angle,
            force_g: round(own.force_g),
            reading_per_g: round(ending.reading_per_g[finger.bend()]),
            newtons_per_g: about.newtons[finger.bend()].map(round),
            stiffness_g: own.stiffness_g.map(round),
        })
    });
    Ok(Grasp {
        name: about.name,
        note: about.note,
        made: about.day,
        hand: about.hand,
        close: GraspClose {
            pose: about.pose,
            way: ending.close,
        },
        forces: ending.forces,
        fingers,
        friction: FrictionSeen {
            held_ratio: seen.friction.held_ratio.map(round),
            slid_ratio: seen.friction.slid_ratio.map(round),
        },
        load_n: seen.load_n.map(round),
        claim: about.claim,
        result: GraspResult {
            held_s: round(ending.held.unwrap_or_default().as_secs_f64()),
            tightened: ending.tightened,
        },
    })
}
