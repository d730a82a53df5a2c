//! Slip margin of a fingertip's grip, for a friction coefficient chosen by the user. Draws nothing.

use crate::hand::TactileBlock;

/// Normal force in newtons below which the ratio of forces is meaningless.
const CONTACT_N: f32 = 0.2;
/// Margin up to which a grip counts as close to slipping.
pub(crate) const NEAR: f32 = 0.2;
/// A state is left only when the margin exceeds its entry limit by this amount.
const HYSTERESIS: f32 = 0.06;

/// Ratio of the forces of a grip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FrictionUse {
    /// No reading.
    Unknown,
    /// The normal force is too small for a ratio.
    Loose,
    /// Tangential divided by normal force.
    Ratio(f32),
}

/// Slip state of a grip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum FrictionState {
    /// No reading.
    #[default]
    Unknown,
    /// No contact.
    Loose,
    /// Far from slipping.
    Firm,
    /// Close to slipping.
    Near,
    /// Beyond the friction: the alarm.
    Slips,
}

impl FrictionUse {
    /// Computes the ratio from the newest block.
    pub(crate) fn of(block: Option<&TactileBlock>) -> Self {
        let forces = block.and_then(|block| block.normal().zip(block.tangential()));
        match forces {
            None => Self::Unknown,
            Some((normal, _)) if normal < CONTACT_N => Self::Loose,
            Some((normal, tangential)) => Self::Ratio(tangential.abs() / normal),
        }
    }

    /// Remaining share of the friction: 1 = all, below 0 = exceeded.
    pub(crate) fn margin(self, friction: f32) -> Option<f32> {
        match self {
            Self::Ratio(ratio) if friction > 0.0 => Some(1.0 - ratio / friction),
            _ => None,
        }
    }
}

impl FrictionState {
    /// Next state. Hysteresis prevents the alarm from flickering when the margin varies around a limit.
    pub(crate) fn next(self, grip: FrictionUse, friction: f32) -> Self {
        let Some(margin) = grip.margin(friction) else {
            return match grip {
                FrictionUse::Loose => Self::Loose,
                _ => Self::Unknown,
            };
        };
        let stay = |is_so: bool| if is_so { HYSTERESIS } else { 0.0 };
        if margin <= stay(self == Self::Slips) {
            Self::Slips
        } else if margin <= NEAR + stay(matches!(self, Self::Slips | Self::Near)) {
            Self::Near
        } else {
            Self::Firm
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(normal_n: f32, tangential_n: f32) -> TactileBlock {
        let mut block = TactileBlock::decode(&[0; 58]).unwrap();
        block.normal_n = normal_n;
        block.tangential_n = tangential_n;
        block
    }

    #[test]
    fn the_margin_is_what_friction_leaves() {
        let grip = FrictionUse::of(Some(&block(4.0, 1.0)));
        assert_eq!(grip, FrictionUse::Ratio(0.25));
        assert_eq!(grip.margin(0.5), Some(0.5));
        assert!(grip.margin(0.2).unwrap() < 0.0);
        assert_eq!(grip.margin(0.0), None);
    }

    #[test]
    fn without_contact_or_sense_there_is_no_margin() {
        assert_eq!(FrictionUse::of(Some(&block(0.05, 1.0))), FrictionUse::Loose);
        assert_eq!(
            FrictionUse::of(Some(&block(f32::NAN, 1.0))),
            FrictionUse::Unknown
        );
        assert_eq!(FrictionUse::of(None).margin(0.5), None);
        assert_eq!(
            FrictionState::Slips.next(FrictionUse::Loose, 0.5),
            FrictionState::Loose
        );
        assert_eq!(
            FrictionState::Slips.next(FrictionUse::Unknown, 0.5),
            FrictionState::Unknown
        );
    }

    #[test]
    fn a_margin_that_wavers_around_the_limit_gives_one_alarm() {
        let (mut hold, mut changes) = (FrictionState::Firm, 0);
        for step in 0..100u8 {
            // Friction 0.5: the margin wavers between -0.02 and 0.02.
            let ratio = if step % 2 == 0 { 0.51 } else { 0.49 };
            let next = hold.next(FrictionUse::Ratio(ratio), 0.5);
            changes += u32::from(next != hold);
            hold = next;
        }
        assert_eq!((hold, changes), (FrictionState::Slips, 1));
        assert_eq!(
            hold.next(FrictionUse::Ratio(0.45), 0.5),
            FrictionState::Near
        );
        assert_eq!(hold.next(FrictionUse::Ratio(0.2), 0.5), FrictionState::Firm);
    }
}
