//! What the user may ask about check-ups. Says nothing about how it is done.

use crate::checkup::CheckupPlan;

/// What the user asks for about check-ups. The hand is empty, they say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum CheckupAction {
    /// Run one, in the arming that is in force. Needs arming.
    Start(CheckupPlan),
    /// Arm the hand, and run one as soon as that holds.
    ArmAndStart(CheckupPlan),
}
