//! A sequence that runs, or ran last, and what a person does with one.

use crate::app::running::Running;
use crate::poses::library::{EntryId, SequenceId};
use crate::poses::player::{PlayEnd, PlayPhase, PlayView};
use crate::tasks::play::{PlayCommand, PlayStep};
use tokio::sync::mpsc;

/// What a person does with a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames, strum::IntoStaticStr)]
pub enum Play {
    /// Run a sequence or a reaction from its start. Needs arming.
    Start(EntryId),
    /// Take one step, then wait. Needs arming.
    Step(SequenceId),
    /// Hold where the hand is, until resumed.
    Pause,
    /// Go on where it was paused.
    Resume,
    /// End it and hold where the hand is.
    End,
}

/// A sequence, a reaction, or a pose whose way has several parts, that runs or ran last.
#[derive(Debug)]
pub struct SequenceRun {
    pub entry: EntryId,
    /// Where it stands.
    pub view: PlayView,
    /// `None` once a person moves the hand in another way.
    pub(crate) commands: Option<mpsc::Sender<PlayCommand>>,
    pub(crate) task: Option<Running<PlayStep, PlayEnd>>,
}

impl SequenceRun {
    /// True while it may send something.
    pub const fn is_running(&self) -> bool {
        !matches!(self.view.phase, PlayPhase::Ended(_))
    }

    /// True while it waits for a person.
    pub const fn is_paused(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Paused)
    }

    pub(crate) fn command(&self, command: PlayCommand) {
        if let Some(commands) = &self.commands {
            // One that cannot be taken any more has ended.
            let _taken = commands.try_send(command);
        }
    }

    /// It does not move the hand any more.
    pub(crate) fn leave(&mut self) {
        if self.is_running() {
            self.commands = None;
            self.view.phase = PlayPhase::Ended(PlayEnd::TakenOver);
        }
    }
}
