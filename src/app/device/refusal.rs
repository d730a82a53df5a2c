//! Why nothing can be read, written or saved now, as a reason a person is told. The link asks the same again.

use crate::app::state::State;
use crate::hand::Status;
use crate::link::LinkState;

/// Why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// No hand answers.
    NoHand,
    /// Setpoints pass.
    Armed,
    /// A stop is being confirmed.
    Holding,
    /// A joint moves.
    Moving,
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

impl State {
    /// Why the rows cannot be read now.
    #[must_use]
    pub fn read_refusal(&self) -> Option<Refusal> {
        match self.link.state.is_live() {
            false => Some(Refusal::NoHand),
            true => self.device.is_busy().then_some(Refusal::Busy),
        }
    }

    /// Why nothing that is kept may be written now: the hand has to be there, disarmed and still.
    #[must_use]
    pub fn write_refusal(&self) -> Option<Refusal> {
        let moves = |status: &Status| matches!(status, Status::Releasing | Status::Grasping);
        let is_moving = || {
            let all = self.sample.status;
            all.is_some_and(|all| all.value.iter().any(|(_, status)| moves(status)))
        };
        match self.link.state {
            state if !state.is_live() => Some(Refusal::NoHand),
            LinkState::Armed => Some(Refusal::Armed),
            LinkState::Holding => Some(Refusal::Holding),
            _ if is_moving() => Some(Refusal::Moving),
            _ => self.device.is_busy().then_some(Refusal::Busy),
        }
    }

    /// Why what is staged cannot be applied now.
    #[must_use]
    pub fn apply_refusal(&self) -> Option<Refusal> {
        let nothing = self.device.to_apply().is_empty();
        self.write_refusal()
            .or_else(|| nothing.then_some(Refusal::NothingStaged))
    }

    /// Why the last apply cannot be undone now.
    #[must_use]
    pub fn undo_refusal(&self) -> Option<Refusal> {
        let nothing = self.device.undo.is_empty();
        self.write_refusal()
            .or_else(|| nothing.then_some(Refusal::NothingToUndo))
    }

    /// Why the hand's parameters cannot be written to its flash now.
    #[must_use]
    pub fn save_refusal(&self) -> Option<Refusal> {
        let nowhere = self.device.folder.is_none();
        self.write_refusal()
            .or_else(|| nowhere.then_some(Refusal::NoFolder))
    }
}
