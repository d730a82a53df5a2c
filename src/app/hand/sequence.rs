//! The current or last sequence, and the user's commands to it.

use crate::app::env::running::Running;
use crate::hand::Setpoints;
use crate::hand::grip::GripThresholds;
use crate::motion::play::{PlayCommand, PlayStep};
use crate::motion::program::Ended;
use crate::poses::library::EntryId;
use crate::poses::player::{PlayEnd, PlayPhase, PlayView};
use crate::record::Abort;
use tokio::sync::mpsc;

/// The current or last sequence, reaction, or pose with a path of several legs.
#[derive(Debug)]
pub struct SequenceRun {
    pub entry: EntryId,
    /// Current progress.
    pub view: PlayView,
    /// `None` once the user moves the hand in another way.
    pub(crate) commands: Option<mpsc::Sender<PlayCommand>>,
    pub(crate) task: Option<Running<PlayStep, Ended<PlayEnd>>>,
    /// Thresholds of the grip estimate for each step; empty once the user moves the hand in another way.
    pub(crate) thresholds: Vec<Option<GripThresholds>>,
}

impl SequenceRun {
    /// True while it may send setpoints.
    pub const fn is_running(&self) -> bool {
        !matches!(self.view.phase, PlayPhase::Ended(_))
    }

    /// True while it waits for the user.
    pub const fn is_paused(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Paused)
    }

    /// Thresholds of the grip estimate for the current step; the defaults after an early end.
    pub(crate) fn thresholds(&self) -> GripThresholds {
        let is_asked = match self.view.phase {
            PlayPhase::Ended(end) => end == Ok(PlayEnd::Finished),
            _ => true,
        };
        let own = self.thresholds.get(self.view.at).copied().flatten();
        own.filter(|_| is_asked).unwrap_or_default()
    }

    pub(crate) fn command(&self, command: PlayCommand) {
        if let Some(commands) = &self.commands {
            // A closed channel means that it has ended.
            let _taken = commands.try_send(command);
        }
    }

    /// Marks that it has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        self.thresholds.clear();
        if self.is_running() {
            self.commands = None;
            self.view.phase = PlayPhase::Ended(Err(Abort::TakenOver));
        }
    }

    /// Applies the progress of its task and returns the setpoints sent; none after it lost control of the hand.
    pub(crate) fn news(&mut self) -> Vec<Setpoints> {
        let Some(task) = &mut self.task else {
            return Vec::new();
        };
        let (steps, end) = task.news();
        let moves = self.commands.is_some();
        let mut sent = Vec::new();
        for (_, step) in steps.into_iter().filter(|_| moves) {
            match step {
                PlayStep::View(view) => self.view = view,
                PlayStep::Sent(setpoints) => sent.push(setpoints),
            }
        }
        if let Some(end) = end {
            self.task = None;
            if self.is_running() {
                self.view.phase = PlayPhase::Ended(end);
            }
        }
        sent
    }
}
