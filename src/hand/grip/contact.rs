//! Contact of a finger, judged from its fingertip and the forces of its joints together.

use crate::hand::grip::thresholds::GripThresholds;

/// Share of a contact threshold above which a finger in contact stays in contact.
pub(super) const STILL_TOUCHES: f32 = 0.5;
/// Force at rest over the contact threshold that may still be a drift of the sensor's zero, or friction, g.
const UNSURE_G: f32 = 120.0;

/// Measurements of one reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Felt {
    /// Normal force of the fingertip, N; `None` where it is not read.
    pub(super) tip_n: Option<f32>,
    /// Largest force over a joint's zero and its known free motion, g; `None` before a zero was learned.
    pub(super) over_g: Option<f32>,
    /// The force of free motion of that joint is known at its angle.
    pub(super) is_free_known: bool,
    /// The drive reports that the force threshold stopped it.
    pub(super) is_stopped_by_force: bool,
    /// The finger was in contact at the previous reading.
    pub(super) touched: bool,
    /// `None` unless the finger holds something; true if its fingertip was in contact.
    pub(super) held_by_tip: Option<bool>,
}

/// Result of the judgement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    /// No fingertip reading and no known zero of the force.
    Unknown,
    /// No contact.
    Nothing,
    /// Force and fingertip contradict each other, or the force alone may be friction.
    Unclear,
    /// Contact.
    Touching,
}

impl Contact {
    /// A fingertip in contact is proof; one without contact outweighs any force that drift and friction can explain.
    pub(super) fn of(felt: &Felt, thresholds: &GripThresholds) -> Self {
        let share = if felt.touched { STILL_TOUCHES } else { 1.0 };
        let contact_g = f32::from(thresholds.contact_g);
        let tip = felt.tip_n.map(|n| n >= thresholds.contact_n * share);
        let Some(over_g) = felt.over_g else {
            return match tip {
                None => Self::Unknown,
                Some(true) => Self::Touching,
                Some(false) => Self::Nothing,
            };
        };
        let is_sure = over_g >= contact_g + UNSURE_G;
        match tip {
            Some(true) => Self::Touching,
            _ if over_g < contact_g * share => Self::Nothing,
            Some(false) if is_sure && felt.is_free_known => Self::Touching,
            Some(false) if is_sure => Self::Unclear,
            Some(false) => match felt.held_by_tip {
                Some(true) => Self::Nothing,
                None if felt.is_free_known => Self::Nothing,
                Some(false) | None => Self::Unclear,
            },
            None => {
                let is_reliable = felt.is_free_known || felt.is_stopped_by_force;
                if is_sure || is_reliable || felt.touched {
                    Self::Touching
                } else {
                    Self::Unclear
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fresh_fingertip_outweighs_force_at_rest_and_what_disagrees_is_unclear() {
        let nothing = Felt {
            tip_n: Some(0.0),
            over_g: Some(0.0),
            is_free_known: false,
            is_stopped_by_force: false,
            touched: false,
            held_by_tip: None,
        };
        let held = Felt {
            touched: true,
            held_by_tip: Some(true),
            ..nothing
        };
        let without = Felt {
            tip_n: None,
            ..nothing
        };
        let over = |felt: Felt, g: f32| Felt {
            over_g: Some(g),
            ..felt
        };
        let known = |felt: Felt| Felt {
            is_free_known: true,
            ..felt
        };
        let rows = [
            ("nothing", nothing, Contact::Nothing),
            ("87 g of friction", over(nothing, 87.0), Contact::Unclear),
            (
                "the same, learnt",
                known(over(nothing, 3.0)),
                Contact::Nothing,
            ),
            (
                "drift since then",
                known(over(nothing, 100.0)),
                Contact::Nothing,
            ),
            (
                "held by its side",
                known(over(nothing, 400.0)),
                Contact::Touching,
            ),
            (
                "the same, nothing learnt",
                over(nothing, 400.0),
                Contact::Unclear,
            ),
            ("lost", over(held, 0.0), Contact::Nothing),
            (
                "lost after a drift of 25 g",
                over(held, 25.0),
                Contact::Nothing,
            ),
            (
                "lost after a drift of 100 g",
                over(held, 100.0),
                Contact::Nothing,
            ),
            ("a fingertip that died", over(held, 400.0), Contact::Unclear),
            ("force alone", over(without, 87.0), Contact::Unclear),
            (
                "force alone, learnt",
                known(over(without, 87.0)),
                Contact::Touching,
            ),
            (
                "force alone, strong",
                over(without, 300.0),
                Contact::Touching,
            ),
            (
                "force alone that stopped the drive",
                Felt {
                    is_stopped_by_force: true,
                    ..over(without, 87.0)
                },
                Contact::Touching,
            ),
            (
                "neither",
                Felt {
                    over_g: None,
                    ..without
                },
                Contact::Unknown,
            ),
        ];
        for (name, felt, contact) in rows {
            let got = Contact::of(&felt, &GripThresholds::default());
            assert_eq!(got, contact, "{name}");
        }
    }
}
