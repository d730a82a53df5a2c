//! Why nothing can be read, written or saved now, as a reason that the user is told. The link asks the same again.

use crate::link::LinkStatus;
use crate::record::{LinkState, Rest};

/// Why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamRefusal {
    /// No hand answers.
    NoHand,
    /// Setpoints pass.
    Armed,
    /// A stop is being confirmed.
    Holding,
    /// A joint moves.
    Moving,
    /// Whether the hand rests is not known.
    RestUnknown,
    /// Something is under way.
    Busy,
    /// Nothing is staged that can be applied.
    NothingStaged,
    /// The last apply changed nothing, or there was none.
    NothingToUndo,
    /// The hand holds what was saved last.
    NothingToSave,
    /// There is no folder for the backup.
    NoFolder,
    /// No row was read.
    NothingRead,
}

/// Why nothing may be done now that needs a hand that is there, disarmed and at rest.
pub const fn rest_refusal(link: &LinkStatus) -> Option<ParamRefusal> {
    match (link.state, link.rest) {
        (LinkState::Offline | LinkState::Identifying, _) => Some(ParamRefusal::NoHand),
        (LinkState::Armed, _) => Some(ParamRefusal::Armed),
        (LinkState::Holding, _) => Some(ParamRefusal::Holding),
        (LinkState::Monitoring | LinkState::Fault, Rest::Moving) => Some(ParamRefusal::Moving),
        (LinkState::Monitoring | LinkState::Fault, Rest::Unknown) => {
            Some(ParamRefusal::RestUnknown)
        }
        (LinkState::Monitoring | LinkState::Fault, Rest::Resting) => None,
    }
}
