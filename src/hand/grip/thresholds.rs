//! Thresholds of the grip states: one named number per decision.

use crate::hand::units::decimal;
use std::time::Duration;

/// Limits between the states of a grip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripThresholds {
    /// Angle from which a finger at rest is open, 0..=1000; below it the finger is closed.
    pub open_from: u16,
    /// Force over the joint's own zero from which the joint touches something, g. Contact ends below half of it.
    pub contact_g: u16,
    /// Normal force of the fingertip from which it touches something, N. Contact ends below half of it.
    pub contact_n: f32,
    /// Force from which a finger presses too hard, g; also applied to the fingertip's force.
    pub too_hard_g: u16,
    /// Current from which a drive with contact presses too hard, mA.
    pub too_hard_ma: u16,
    /// Rise of the ratio of tangential to normal force that is a slip, relative to the half second before or to the start of creeping.
    pub slip_ratio: f64,
    /// Turn of the tangential force with which a smaller rise is a slip, degrees. A turn alone is none: the wrist turns, too.
    pub slip_turn_deg: f64,
    /// Absence of contact after which contact is lost, if the finger did not open, ms.
    pub lost_after_ms: u16,
    /// Age beyond which a reading is no evidence, ms.
    pub fresh_ms: u16,
    /// Number of fingers that must hold for the grasp to hold, 1..=5; 2 for a pinch.
    pub least_fingers: u8,
}

/// Identifies one field of [`GripThresholds`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GripThreshold {
    /// [`GripThresholds::open_from`].
    OpenFrom,
    /// [`GripThresholds::contact_g`].
    ContactForce,
    /// [`GripThresholds::contact_n`].
    ContactTip,
    /// [`GripThresholds::too_hard_g`].
    HardForce,
    /// [`GripThresholds::too_hard_ma`].
    HardCurrent,
    /// [`GripThresholds::slip_ratio`].
    SlipRatio,
    /// [`GripThresholds::slip_turn_deg`].
    SlipTurn,
    /// [`GripThresholds::lost_after_ms`].
    LostAfter,
    /// [`GripThresholds::fresh_ms`].
    Fresh,
    /// [`GripThresholds::least_fingers`].
    LeastFingers,
}

impl GripThreshold {
    /// All thresholds.
    pub const ALL: [Self; 10] = [
        Self::OpenFrom,
        Self::ContactForce,
        Self::ContactTip,
        Self::HardForce,
        Self::HardCurrent,
        Self::SlipRatio,
        Self::SlipTurn,
        Self::LostAfter,
        Self::Fresh,
        Self::LeastFingers,
    ];

    /// Stable name, as in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::OpenFrom => "open_from",
            Self::ContactForce => "contact_g",
            Self::ContactTip => "contact_n",
            Self::HardForce => "too_hard_g",
            Self::HardCurrent => "too_hard_ma",
            Self::SlipRatio => "slip_ratio",
            Self::SlipTurn => "slip_turn_deg",
            Self::LostAfter => "lost_after_ms",
            Self::Fresh => "fresh_ms",
            Self::LeastFingers => "least_fingers",
        }
    }

    /// Returns the threshold with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.name() == name)
    }

    /// Allowed minimum and maximum, in the threshold's unit.
    pub const fn range(self) -> (f64, f64) {
        match self {
            Self::OpenFrom => (100.0, 1000.0),
            Self::ContactForce => (10.0, 1000.0),
            Self::ContactTip => (0.05, 20.0),
            Self::HardForce => (100.0, 3000.0),
            Self::HardCurrent => (100.0, 3000.0),
            Self::SlipRatio => (0.02, 2.0),
            Self::SlipTurn => (2.0, 180.0),
            Self::LostAfter => (10.0, 1000.0),
            Self::Fresh => (100.0, 2000.0),
            Self::LeastFingers => (1.0, 5.0),
        }
    }

    /// Returns its value in `all`.
    pub fn of(self, all: &GripThresholds) -> f64 {
        match self {
            Self::OpenFrom => all.open_from.into(),
            Self::ContactForce => all.contact_g.into(),
            Self::ContactTip => decimal(all.contact_n),
            Self::HardForce => all.too_hard_g.into(),
            Self::HardCurrent => all.too_hard_ma.into(),
            Self::SlipRatio => all.slip_ratio,
            Self::SlipTurn => all.slip_turn_deg,
            Self::LostAfter => all.lost_after_ms.into(),
            Self::Fresh => all.fresh_ms.into(),
            Self::LeastFingers => all.least_fingers.into(),
        }
    }

    /// Sets its value in `all`. Returns false, and sets nothing, if `to` is out of range or a fraction where a whole number is needed.
    pub fn set(self, all: &mut GripThresholds, to: f64) -> bool {
        let (least, most) = self.range();
        let is_whole = !matches!(self, Self::ContactTip | Self::SlipRatio | Self::SlipTurn);
        if !(least..=most).contains(&to) || is_whole && to.fract() != 0.0 {
            return false;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and in a range of small numbers"
        )]
        let whole = to as u16;
        match self {
            Self::OpenFrom => all.open_from = whole,
            Self::ContactForce => all.contact_g = whole,
            #[expect(clippy::cast_possible_truncation, reason = "a force of at most 20 N")]
            Self::ContactTip => all.contact_n = to as f32,
            Self::HardForce => all.too_hard_g = whole,
            Self::HardCurrent => all.too_hard_ma = whole,
            Self::SlipRatio => all.slip_ratio = to,
            Self::SlipTurn => all.slip_turn_deg = to,
            Self::LostAfter => all.lost_after_ms = whole,
            Self::Fresh => all.fresh_ms = whole,
            Self::LeastFingers => all.least_fingers = u8::try_from(whole).unwrap_or(u8::MAX),
        }
        true
    }
}

impl GripThresholds {
    /// Thresholds that differ from the default, with their values.
    pub fn unusual(&self) -> impl Iterator<Item = (GripThreshold, f64)> {
        let usual = Self::default();
        let all = GripThreshold::ALL.into_iter();
        let both = all.map(move |one| (one, one.of(self), one.of(&usual)));
        both.filter_map(|(one, own, usual)| (own != usual).then_some((one, own)))
    }
}

impl Default for GripThresholds {
    fn default() -> Self {
        Self {
            open_from: 900,
            contact_g: 60,
            contact_n: 0.2,
            too_hard_g: 2000,
            too_hard_ma: 1900,
            slip_ratio: 0.12,
            slip_turn_deg: 25.0,
            lost_after_ms: 40,
            fresh_ms: 500,
            least_fingers: 1,
        }
    }
}

impl GripThresholds {
    /// Age up to which a reading counts.
    pub const fn fresh_for(&self) -> Duration {
        Duration::from_millis(self.fresh_ms as u64)
    }

    /// Absence of contact after which contact is lost.
    pub const fn lost_after(&self) -> Duration {
        Duration::from_millis(self.lost_after_ms as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_named_set_within_its_range_and_read_back() {
        for one in GripThreshold::ALL {
            assert_eq!(GripThreshold::named(one.name()), Some(one));
            let usual = GripThresholds::default();
            let (least, most) = one.range();
            assert!((least..=most).contains(&one.of(&usual)), "{one:?}");
            for to in [least, most] {
                let mut all = usual;
                assert!(one.set(&mut all, to), "{one:?} {to}");
                assert_eq!(one.of(&all), to);
                let others = GripThreshold::ALL.into_iter().filter(|other| *other != one);
                for other in others {
                    assert_eq!(other.of(&all), other.of(&usual), "{one:?}");
                }
            }
            for to in [least - 0.01, most + 1.0, f64::NAN, f64::INFINITY] {
                let mut all = usual;
                assert!(!one.set(&mut all, to), "{one:?} {to}");
                assert_eq!(all, usual);
            }
        }
        let mut all = GripThresholds::default();
        assert!(!GripThreshold::LeastFingers.set(&mut all, 1.5));
    }
}
