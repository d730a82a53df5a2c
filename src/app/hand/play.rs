//! A sequence on the hand: starting it, what a person wants of it while it runs, and what it tells.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::sequence::{Play, SequenceRun};
use crate::app::poses::PoseState;
use crate::app::running::Running;
use crate::hand::PerDof;
use crate::history::MarkKind;
use crate::poses::library::EntryId;
use crate::poses::player::{PlayMode, PlayPhase, PlayPlan, PlayView};
use crate::tasks::play::{self, PlayCommand, PlayStart, PlayStep};
use tokio::sync::mpsc;

/// Wishes that may wait: a person cannot press faster than a task takes them.
const COMMANDS_MAX: usize = 16;

impl HandState {
    /// Starts, pauses or ends an entry of the library.
    pub(crate) fn play(&mut self, wanted: Play, poses: &PoseState, env: &Env) {
        let command = |command| {
            if let Some(run) = &self.sequence {
                run.command(command);
            }
        };
        match wanted {
            Play::Start(entry) => self.start(poses.plan(entry), PlayMode::Through, env),
            Play::Step(id) => {
                let entry = EntryId::Sequence(id);
                let waits = |run: &SequenceRun| run.entry == entry && run.is_paused();
                if self.sequence.as_ref().is_some_and(waits) {
                    command(PlayCommand::Resume(PlayMode::OneStep))
                } else {
                    self.start(poses.plan(entry), PlayMode::OneStep, env)
                }
            }
            Play::Pause => command(PlayCommand::Pause),
            Play::Resume => command(PlayCommand::Resume(PlayMode::Through)),
            Play::End => command(PlayCommand::End),
        }
    }

    /// True for a hand that takes a pose which is meant for all: it is armed, and the person at this window moves it.
    pub fn takes_poses(&self) -> bool {
        let is_ours = !self.runs_series() && self.outside_owner().is_none();
        self.is_armed() && is_ours && self.procedure.is_none() && self.leaving.is_none()
    }

    /// True if this hand does what a person asks of the shown one, where that is meant for all. `entry` is what the shown one plays:
    /// nothing else is resumed with it.
    pub(crate) fn plays_along(&self, play: Play, entry: Option<EntryId>) -> bool {
        match play {
            Play::Start(_) | Play::Step(_) => self.takes_poses(),
            Play::Resume => self.sequence.as_ref().map(|run| run.entry) == entry,
            Play::Pause | Play::End => true,
        }
    }

    /// Starts what a person wants played; without arming, nothing.
    pub(crate) fn start(&mut self, plan: Option<PlayPlan>, pace: PlayMode, env: &Env) {
        let Some((plan, epoch)) = plan.zip(self.link.armed.filter(|_| self.is_armed())) else {
            return;
        };
        let entry = plan.entry;
        self.take_over();
        let Some(open) = &mut self.open else { return };
        let start = PlayStart {
            plan,
            pace,
            epoch,
            lease: open.lend_lease(),
            locked: self.joints.map(|joint| joint.locked),
            seen: self.sample,
            clock: env.clock,
        };
        let (commands, wanted) = mpsc::channel(COMMANDS_MAX);
        let link = open.link.clone();
        let task = Running::start(env, |steps| async move {
            play::play(&link, start, wanted, |step| steps.tell(step)).await
        });
        self.sequence = Some(SequenceRun {
            entry,
            view: PlayView {
                at: 0,
                phase: PlayPhase::Moving { since: self.now },
                late: 0,
            },
            commands: Some(commands),
            task: Some(task),
        });
    }

    /// Joints that are locked now are left alone.
    pub(crate) fn tell_locks(&self) {
        if let Some(run) = &self.sequence {
            run.command(PlayCommand::Lock(self.joints.map(|joint| joint.locked)));
        }
    }

    /// Takes in what the sequence did.
    pub(crate) fn tick_sequence(&mut self) {
        let Some(run) = &mut self.sequence else {
            return;
        };
        let Some(task) = &mut run.task else { return };
        let (steps, end) = task.news();
        let taken_over = run.commands.is_none();
        let mut sent = Vec::new();
        for (_, step) in steps {
            match step {
                PlayStep::View(_) if taken_over => {}
                PlayStep::View(view) => run.view = view,
                PlayStep::Sent(setpoints) => sent.push(setpoints),
            }
        }
        if let Some(end) = end {
            run.task = None;
            if run.is_running() {
                run.view.phase = PlayPhase::Ended(end);
            }
        }
        if taken_over {
            return;
        }
        for setpoints in sent {
            self.commanded = true;
            self.show(&setpoints);
        }
    }

    /// A gesture of the hand's own was started.
    pub(crate) fn gesture_started(&mut self, number: u8) {
        self.history.mark(self.now, MarkKind::Gesture(number));
        self.commanded = true;
        self.steered = PerDof::default();
    }
}
