//! The judgement of five closes on another hand: whether its forces, the stiffness and the friction agree with those of the grasp.
//! Pure.

use crate::hand::statistics::{count, mean, median, spread};
use crate::hand::{Finger, PerDof};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::saved::{Grasp, GraspFinger};
use crate::motion::grasp::seen::{CloseSeen, FingerSeen};
use crate::trials::search::tolerance::{Assurance, tolerance_factor};
use serde::{Deserialize, Serialize};

/// Number of closes that confirm a grasp.
pub const CLOSES: usize = 5;
/// Force by which a peak while it holds may exceed *at most*, g: the noise of the noisiest sensors, filtered.
const NOISE_G: f64 = 20.0;
/// Factor by which the stiffness may differ: hands of the family differ by 2 among themselves, and each figure by a quarter.
const STIFFNESS_FACTOR: f64 = 3.0;
/// Share of the ratio at which it held, or slid, on the first hand, below which it must not slide.
const SLIDES_BELOW: f64 = 0.8;
/// Share of the largest ratio that held in the closes that is taken as the friction: it scatters from grip to grip.
const FRICTION_SHARE: f64 = 0.85;
/// Factor by which the load may exceed that of the first hand.
const LOAD_FACTOR: f64 = 1.25;

/// How the closes of a hand agree with a grasp.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Number of closes.
    pub closes: usize,
    /// Largest bound of a force as a share of *at most*: the peaks of 95 of 100 closes stay below it, 95 % sure.
    pub peak_share: f64,
    /// Stiffness in newtons over that of the first hand; `None` if neither hand shows it: the object is too stiff.
    pub stiffness_ratio: Option<f64>,
    /// Friction that the closes show at least.
    pub friction: f64,
    /// Largest load, N.
    pub load_n: f64,
}

/// A hand that confirms a grasp.
#[derive(Debug, Clone, Copy)]
pub(super) struct ConfirmingHand<'a> {
    pub(super) grasp: &'a Grasp,
    /// Newtons for a gram of each joint.
    pub(super) newtons: &'a PerDof<Option<f64>>,
    /// Reading of each joint for one gram of the forces.
    pub(super) reading_per_g: &'a PerDof<f64>,
}

impl ConfirmingHand<'_> {
    /// Judges one close by itself, so that a hopeless confirmation ends early. `nth` counts from 1.
    pub(super) fn judge_close(&self, nth: usize, seen: &CloseSeen) -> Result<(), GraspDoubt> {
        if seen.was_short {
            return Err(GraspDoubt::CouldNotHold { close: nth });
        }
        let missing = self
            .fingers()
            .find(|(finger, _)| seen.fingers[*finger].is_none());
        if let Some((finger, _)) = missing {
            return Err(GraspDoubt::NotHeld { finger });
        }
        let there = self.grasp.friction;
        let bounds = [there.held_ratio, there.slid_ratio].into_iter().flatten();
        let held = bounds.reduce(f64::min);
        if let Some((slid, held)) = seen.friction.slid_ratio.zip(held)
            && slid < SLIDES_BELOW * held
        {
            return Err(GraspDoubt::Slid { slid, held });
        }
        let (there_n, here_n) = (
            self.grasp.load_n.ok_or(GraspDoubt::LoadUnknown)?,
            seen.load_n,
        );
        let here_n = here_n.ok_or(GraspDoubt::NoLoad { close: nth })?;
        if here_n > LOAD_FACTOR * there_n {
            return Err(GraspDoubt::Heavier { here_n, there_n });
        }
        Ok(())
    }

    /// Judges all closes, each of which was judged by itself.
    pub(super) fn judge(&self, closes: &[CloseSeen]) -> Result<Agreement, GraspDoubt> {
        let mut peak_share: f64 = 0.0;
        for (finger, _) in self.fingers() {
            peak_share = peak_share.max(self.peak_share(finger, closes)?);
        }
        let stiffness_ratio = self.stiffness_ratio(closes)?;
        Ok(Agreement {
            closes: closes.len(),
            peak_share,
            stiffness_ratio,
            friction: self.friction(closes)?,
            load_n: largest(closes.iter().filter_map(|close| close.load_n)).unwrap_or_default(),
        })
    }

    fn fingers(&self) -> impl Iterator<Item = (Finger, GraspFinger)> {
        let fingers = self.grasp.fingers;
        Finger::ALL
            .into_iter()
            .filter_map(move |finger| Some((finger, fingers[finger]?)))
    }

    fn at_most_g(&self, finger: Finger) -> f64 {
        f64::from(self.grasp.forces.at_most().get()) * self.reading_per_g[finger.bend()]
    }

    fn peak_share(&self, finger: Finger, closes: &[CloseSeen]) -> Result<f64, GraspDoubt> {
        let at_most_g = self.at_most_g(finger);
        let seen = || closes.iter().filter_map(|close| close.fingers[finger]);
        let peaks: Vec<f64> = seen().map(|own| own.close_peak_g).collect();
        let bound_g = upper_bound(&peaks);
        let highest_g = largest(seen().map(|own| own.peak_g)).unwrap_or_default();
        let bound_g = bound_g.max(highest_g - NOISE_G);
        if bound_g > at_most_g {
            return Err(GraspDoubt::Peak {
                finger,
                bound_g,
                at_most_g,
            });
        }
        Ok(bound_g / at_most_g)
    }

    fn stiffness_ratio(&self, closes: &[CloseSeen]) -> Result<Option<f64>, GraspDoubt> {
        let (mut ratios, mut is_known_once) = (Vec::new(), false);
        for (finger, there) in self.fingers() {
            let seen = closes.iter().filter_map(|close| close.fingers[finger]);
            let here: Vec<f64> = seen.filter_map(|own: FingerSeen| own.stiffness_g).collect();
            let newtons = self.newtons[finger.bend()];
            let here_n = median(&here).zip(newtons).map(|(g, newtons)| g * newtons);
            is_known_once |= here_n.is_some() || there.stiffness_g.is_some();
            if let Some((here_n, there_n)) = here_n.zip(there.stiffness_n()) {
                ratios.push(here_n / there_n);
            }
        }
        match median(&ratios) {
            Some(ratio) if (1.0 / STIFFNESS_FACTOR..=STIFFNESS_FACTOR).contains(&ratio) => {
                Ok(Some(ratio))
            }
            Some(ratio) => Err(GraspDoubt::Stiffness { ratio }),
            None if is_known_once => Err(GraspDoubt::NoStiffness),
            None => Ok(None),
        }
    }

    fn friction(&self, closes: &[CloseSeen]) -> Result<f64, GraspDoubt> {
        let held = closes.iter().filter_map(|close| close.friction.held_ratio);
        let shown = FRICTION_SHARE * largest(held).unwrap_or_default();
        let newtons = |finger: Finger| self.newtons[finger.bend()].unwrap_or_default();
        let fingers = self.fingers().map(|(finger, _)| finger);
        let most_n: f64 = fingers
            .map(|finger| self.at_most_g(finger) * newtons(finger))
            .sum();
        let needed = self.grasp.load_n.unwrap_or_default() / most_n;
        if shown < needed {
            return Err(GraspDoubt::NoFriction { shown, needed });
        }
        Ok(shown)
    }
}

/// Bound below which 95 of 100 values stay, 95 % sure, if they are normally distributed.
fn upper_bound(values: &[f64]) -> f64 {
    let mean = mean(values).unwrap_or_default();
    let freedom = (count(values) - 1.0).max(1.0);
    let deviation = (spread(values) / freedom).sqrt();
    let factor = tolerance_factor(values.len(), Assurance::USUAL);
    mean + factor.unwrap_or(f64::INFINITY) * deviation
}

fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.reduce(f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::gap::Gap;
    use crate::hand::hold_forces::HoldForces;
    use crate::hand::{Angle, Force, PerFinger};
    use crate::motion::grasp::saved::{FrictionSeen, GraspClose, GraspResult};
    use crate::motion::hold::HoldClose;

    const NEWTONS: f64 = 0.01;

    /// A pinch with 200 to 400 g on a hand of the same newtons.
    fn grasp() -> Grasp {
        let finger = |finger: Finger| {
            matches!(finger, Finger::Index | Finger::Thumb).then_some(GraspFinger {
                angle: Angle::nearest(600),
                force_g: 210.0,
                reading_per_g: 1.0,
                newtons_per_g: Some(NEWTONS),
                stiffness_g: Some(10.0),
            })
        };
        Grasp {
            name: "block".into(),
            note: String::new(),
            made: "2026-11-30".into(),
            hand: "tcp:192.168.11.210".parse().unwrap(),
            close: GraspClose {
                pose: None,
                way: HoldClose::Pinch(Gap::MIN),
            },
            forces: HoldForces::new(Force::nearest(200), Force::nearest(400)).unwrap(),
            fingers: PerFinger::from_fn(finger),
            friction: FrictionSeen {
                held_ratio: Some(0.4),
                slid_ratio: None,
            },
            load_n: Some(2.0),
            claim: None,
            result: GraspResult {
                held_s: 10.0,
                tightened: 0,
            },
        }
    }

    /// A close that agrees with it.
    fn close() -> CloseSeen {
        let finger = FingerSeen {
            angle: Angle::nearest(605),
            close_peak_g: 230.0,
            peak_g: 260.0,
            force_g: 215.0,
            stiffness_g: Some(12.0),
        };
        let fingers = grasp().fingers.map(|own| own.map(|_| finger));
        CloseSeen {
            fingers,
            friction: FrictionSeen {
                held_ratio: Some(0.35),
                slid_ratio: None,
            },
            load_n: Some(1.5),
            was_short: false,
        }
    }

    fn judged(closes: &[CloseSeen], newtons: f64) -> Result<Agreement, GraspDoubt> {
        let hand = ConfirmingHand {
            grasp: &grasp(),
            newtons: &PerDof::splat(Some(newtons)),
            reading_per_g: &PerDof::splat(NEWTONS / newtons),
        };
        let mut each = closes.iter().enumerate();
        each.try_for_each(|(nth, close)| hand.judge_close(nth + 1, close))?;
        hand.judge(closes)
    }

    #[test]
    fn five_closes_that_agree_are_trusted() {
        let agreement = judged(&[close(); CLOSES], NEWTONS).unwrap();
        assert_eq!(agreement.closes, CLOSES);
        assert!((agreement.stiffness_ratio.unwrap() - 1.2).abs() < 1e-9);
        assert!((agreement.peak_share - 0.6).abs() < 1e-9, "{agreement:?}");
        // The same on a hand that reads half as much.
        let mut halved = close();
        for (_, finger) in halved.fingers.iter_mut() {
            if let Some(own) = finger {
                (own.close_peak_g, own.peak_g, own.force_g) = (115.0, 130.0, 107.0);
                own.stiffness_g = Some(6.0);
            }
        }
        let other = judged(&[halved; CLOSES], 2.0 * NEWTONS).unwrap();
        assert!((other.stiffness_ratio.unwrap() - 1.2).abs() < 1e-9);
        assert!((other.peak_share - 0.6).abs() < 0.03, "{other:?}");
    }

    #[test]
    fn what_differs_is_doubted_with_its_reason() {
        type Change = fn(&mut CloseSeen);
        let cases: [(Change, &str); 8] = [
            (
                |own| own.was_short = true,
                "at most did not suffice in close 2",
            ),
            (
                |own| own.fingers[Finger::Thumb] = None,
                "the thumb held on the first hand",
            ),
            (
                |own| own.friction.slid_ratio = Some(0.3),
                "slid at a load of 0.30 of the force",
            ),
            (
                |own| own.load_n = Some(2.6),
                "the load was 2.6 N, and 2.0 N on",
            ),
            (|own| own.load_n = None, "no load came and went in close 2"),
            (
                |own| {
                    for (_, finger) in own.fingers.iter_mut() {
                        if let Some(own) = finger {
                            own.close_peak_g = 330.0;
                        }
                    }
                },
                "may press with",
            ),
            (
                |own| {
                    for (_, finger) in own.fingers.iter_mut() {
                        if let Some(own) = finger {
                            own.peak_g = 450.0;
                        }
                    }
                },
                "may press with 430 g, and at most is 400 g",
            ),
            (|_| {}, ""),
        ];
        for (change, words) in cases {
            let mut closes = [close(); CLOSES];
            closes.iter_mut().skip(1).take(1).for_each(change);
            let doubt = judged(&closes, NEWTONS).err();
            let said = doubt.map_or(String::new(), |doubt| doubt.to_string());
            assert!(
                said.contains(words) && said.is_empty() == words.is_empty(),
                "{said}"
            );
        }
    }

    #[test]
    fn another_stiffness_and_too_little_friction_are_doubted() {
        let all = |change: fn(&mut CloseSeen)| {
            let mut closes = [close(); CLOSES];
            closes.iter_mut().for_each(change);
            judged(&closes, NEWTONS)
        };
        let stiff = |own: &mut CloseSeen| {
            let fingers = own.fingers.iter_mut();
            fingers.for_each(|(_, own)| {
                if let Some(own) = own {
                    own.stiffness_g = Some(40.0);
                }
            });
        };
        assert_eq!(all(stiff), Err(GraspDoubt::Stiffness { ratio: 4.0 }));
        let unknown = |own: &mut CloseSeen| {
            let fingers = own.fingers.iter_mut();
            fingers.for_each(|(_, own)| {
                if let Some(own) = own {
                    own.stiffness_g = None;
                }
            });
        };
        assert_eq!(all(unknown), Err(GraspDoubt::NoStiffness));
        // 2 N on two fingers of 4 N need a quarter.
        let smooth = all(|own| own.friction.held_ratio = Some(0.28));
        let Err(GraspDoubt::NoFriction { shown, needed }) = smooth else {
            panic!("{smooth:?}");
        };
        assert!((shown - 0.238).abs() < 1e-9 && (needed - 0.25).abs() < 1e-9);
    }
}
