//! Why nothing can be read, written or saved now, as a reason that a person is told. The link asks the same again.

use crate::app::hand::{Freshness, HandState};
use crate::app::params::state::OLD_AFTER;
use crate::params::rows::ParamId;
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
    /// There is no folder for the backup.
    NoFolder,
    /// No row was read.
    NothingRead,
}

impl HandState {
    /// Why nothing may be done now that needs a hand that is there, disarmed and at rest.
    pub const fn rest_refusal(&self) -> Option<ParamRefusal> {
        match (self.link.state, self.link.rest) {
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

    /// Why the rows cannot be read now.
    pub fn read_refusal(&self) -> Option<ParamRefusal> {
        if self.link.state.is_live() {
            self.params.is_busy().then_some(ParamRefusal::Busy)
        } else {
            Some(ParamRefusal::NoHand)
        }
    }

    /// Why nothing that is kept may be written now.
    pub fn write_refusal(&self) -> Option<ParamRefusal> {
        let busy = || self.params.is_busy().then_some(ParamRefusal::Busy);
        self.rest_refusal().or_else(busy)
    }

    /// Why what is staged cannot be applied now.
    pub fn apply_refusal(&self) -> Option<ParamRefusal> {
        let nothing = self.params.to_apply().is_empty();
        self.write_refusal()
            .or_else(|| nothing.then_some(ParamRefusal::NothingStaged))
    }

    /// Why the last apply cannot be undone now.
    pub fn undo_refusal(&self) -> Option<ParamRefusal> {
        let nothing = self.params.undo.is_empty();
        self.write_refusal()
            .or_else(|| nothing.then_some(ParamRefusal::NothingToUndo))
    }

    /// Why the hand's parameters cannot be written to its flash now.
    pub fn save_refusal(&self) -> Option<ParamRefusal> {
        let nowhere = self.params.files.is_none();
        self.write_refusal()
            .or_else(|| nowhere.then_some(ParamRefusal::NoFolder))
    }

    /// How fresh a row's value is.
    pub fn param_freshness(&self, id: ParamId) -> Freshness {
        let Some((_, at)) = self.params.live(id) else {
            return Freshness::Unknown;
        };
        let before_loss = self.params.lost_at.is_some_and(|lost| at <= lost);
        let old = self.now.since(at) > OLD_AFTER;
        if self.link.state.is_live() && !before_loss && !old {
            Freshness::Live
        } else {
            Freshness::Stale
        }
    }
}
