//! A sequence that runs, or ran last, and what the user does with one.

use crate::app::env::running::Running;
use crate::hand::Setpoints;
use crate::hand::grip::GripThresholds;
use crate::motion::play::{PlayCommand, PlayStep};
use crate::motion::program::Ended;
use crate::poses::library::EntryId;
use crate::poses::player::{PlayEnd, PlayPhase, PlayView};
use crate::record::Abort;
use tokio::sync::mpsc;

/// A sequence, a reaction, or a pose whose way has several parts, that runs or ran last.
#[derive(Debug)]
pub struct SequenceRun {
    pub entry: EntryId,
    /// Where it stands.
    pub view: PlayView,
    /// `None` once the user moves the hand in another way.
    pub(crate) commands: Option<mpsc::Sender<PlayCommand>>,
    pub(crate) task: Option<Running<PlayStep, Ended<PlayEnd>>>,
    /// What the grip of each step is told by; none once the user moves the hand in another way.
    pub(crate) thresholds: Vec<Option<GripThresholds>>,
}

impl SequenceRun {
    /// True while it may send something.
    pub const fn is_running(&self) -> bool {
        !matches!(self.view.phase, PlayPhase::Ended(_))
    }

    /// True while it waits for the user.
    pub const fn is_paused(&self) -> bool {
        matches!(self.view.phase, PlayPhase::Paused)
    }

    /// What the grip is told by, as long as its step is what was asked for.
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
            // One that cannot be taken any more has ended.
            let _taken = commands.try_send(command);
        }
    }

    /// It does not move the hand any more.
    pub(crate) fn leave(&mut self) {
        self.thresholds.clear();
        if self.is_running() {
            self.commands = None;
            self.view.phase = PlayPhase::Ended(Err(Abort::TakenOver));
        }
    }

    /// Takes in what its task did; gives what was sent. Nothing of one that does not move the hand any more.
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
