//! Handling of parameter requests, and the tasks that carry them out. Reads before it writes; asks before dangerous
//! changes.

use crate::app::connection::Connection;
use crate::app::env::Ctx;
use crate::app::env::Env;
use crate::app::env::running::{Running, Steps, TaskEffect};
use crate::app::files::open;
use crate::app::params::state::{
    Doing, FileComparison, FilesRead, ParamAction, ParamsJob, ParamsState,
};
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Dof, HandSample, Moment};
use crate::link::{LinkHandle, LinkStatus};
use crate::params::backups::{Backups, Known, folder_beside};
use crate::params::changes;
use crate::params::file::{self, ParamsFile};
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::store::on_thread;
use crate::tasks::apply::{Applied, Apply, Otherwise, apply};
use crate::tasks::read::{ReadRows, rows};
use crate::tasks::save::{Save, SaveReport, save};
use crate::tasks::{Question, Risks, TaskError, TaskStep, User as _};
use crate::transport::Endpoint;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Maximum age of speeds and forces to be copied; they are read continuously.
const COPY_TIMEOUT: Duration = Duration::from_secs(5);

/// The hand whose parameters are read or written, and the environment for its tasks.
#[derive(Clone, Copy)]
pub(crate) struct ParamsHand<'a> {
    pub(crate) connection: &'a Connection,
    /// Measured overshoot of the hand.
    pub(crate) overshoot: &'a Arc<OvershootMap>,
    pub(crate) env: &'a Env,
}

impl ParamsState {
    /// Handles a user request.
    pub(crate) fn act(
        &mut self,
        action: ParamAction,
        hand: ParamsHand<'_>,
        sample: &HandSample,
        now: Moment,
    ) {
        let link = &hand.connection.status;
        match action {
            ParamAction::Read if self.read_refusal(link).is_some() => {}
            ParamAction::Read => self.read_rows(hand),
            ParamAction::Apply if self.apply_refusal(link).is_some() => {}
            ParamAction::Apply => self.apply_rows(self.to_apply(), hand),
            ParamAction::Undo if self.undo_refusal(link).is_some() => {}
            ParamAction::Undo => {
                let undo = self.undo.clone();
                self.stage_all(&undo);
                self.apply_rows(undo, hand);
            }
            ParamAction::Save if self.save_refusal(link).is_some() => {}
            ParamAction::Save => self.save(self.staged.clone(), hand),
            ParamAction::SaveWith(values) => {
                if self.save_refusal_with(&values, link).is_none() {
                    let before = self.staged.clone();
                    self.stage_all(&values);
                    self.save(before, hand);
                }
            }
            ParamAction::CopyLive => self.copy_live(sample, link, now),
            ParamAction::UnstageAll => self.unstage_all(),
            ParamAction::Open(typed) => self.open_file(typed, hand.env),
            ParamAction::Tick(id) => {
                if let Some(compared) = &mut self.compared {
                    compared.tick(id);
                }
            }
            ParamAction::StageTicked => {
                if let Some(compared) = self.compared.take() {
                    self.stage_all(&compared.chosen());
                }
            }
            ParamAction::CloseFile => self.compared = None,
            // Handled by the program, which owns the files.
            ParamAction::Dump => {}
        }
    }

    fn stage_all(&mut self, params: &Params) {
        for (id, value) in params.iter() {
            self.stage(id, Some(value));
        }
    }

    fn copy_live(&mut self, sample: &HandSample, link: &LinkStatus, now: Moment) {
        let young = |asked: Moment| now.since(asked) <= COPY_TIMEOUT;
        let is_live = link.state.is_live();
        let speeds = sample.speed_set.filter(|all| is_live && young(all.asked));
        let forces = sample.force_set.filter(|all| is_live && young(all.asked));
        for dof in Dof::ALL {
            if let Some(speed) = speeds.and_then(|all| all.value[dof]) {
                let value = Value::Number(i32::from(speed.get()));
                self.stage(ParamId::DefaultSpeed(dof), Some(value));
            }
            if let Some(force) = forces.and_then(|all| all.value[dof]) {
                let value = Value::Number(i32::from(force.get()));
                self.stage(ParamId::DefaultForce(dof), Some(value));
            }
        }
    }

    /// Reads the rows when their view is shown, if due.
    pub(crate) fn read_if_due(&mut self, hand: ParamsHand<'_>, now: Moment) {
        if self.note_viewed(now) && self.read_refusal(&hand.connection.status).is_none() {
            self.read_rows(hand);
        }
    }

    /// Starts a task that reads or writes rows, if there is a link; the task ends with the effect of its result.
    fn start<F, E>(
        &mut self,
        doing: Doing,
        hand: ParamsHand<'_>,
        task: impl FnOnce(LinkHandle, Steps<TaskStep>) -> F,
    ) where
        F: Future<Output = E> + Send + 'static,
        E: FnOnce(&mut Self, Moment) + Send + 'static,
    {
        if let Some(link) = hand.connection.link().cloned() {
            self.begin(doing);
            self.task = Some(Running::start(hand.env, |steps| {
                let work = task(link, steps);
                async move { Box::new(work.await) as TaskEffect<Self> }
            }));
        }
    }

    fn read_rows(&mut self, hand: ParamsHand<'_>) {
        self.start(Doing::Reading, hand, |link, steps| async move {
            let report = |span, bytes: &[u8]| steps.send(TaskStep::Read(span, bytes.to_vec()));
            let read = rows(&link, report).await;
            move |params: &mut Self, now| params.rows_read(read, now)
        });
    }

    fn apply_rows(&mut self, wanted: Params, hand: ParamsHand<'_>) {
        let task = apply_task(wanted, Risks::default(), hand);
        self.start(Doing::Applying, hand, |link, steps| async move {
            let end = apply(&link, &task, &mut &steps, |step| steps.send(step)).await;
            move |params: &mut Self, now| params.rows_applied(end, now)
        });
    }

    /// Asks whether to save, applies the staged rows, and saves. If the user declines, the rows that were staged before are restored.
    fn save(&mut self, staged_before: Params, hand: ParamsHand<'_>) {
        let Some(backups) = self.files.clone() else {
            return;
        };
        let agreed = Risks {
            dangers: self.save_dangers(hand.overshoot),
            ..Risks::default()
        };
        let staged = self.to_apply();
        let staged = (!staged.is_empty()).then(|| apply_task(staged, agreed.clone(), hand));
        let task = Save {
            backups,
            before: self.before_changes(&Params::default()),
            agreed: agreed.clone(),
            overshoot: Arc::clone(hand.overshoot),
        };
        self.start(Doing::Asking, hand, |link, steps| async move {
            let report = |step| steps.send(step);
            let mut user = &steps;
            let is_meant = user.ask(Question::Save(agreed.clone())).await;
            let mut applied = None;
            let mut end = Err(TaskError::Declined(agreed));
            if is_meant {
                if let Some(staged) = &staged {
                    applied = Some(apply(&link, staged, &mut user, report).await);
                }
                end = match &applied {
                    Some(applied) if !applied.as_ref().is_ok_and(Applied::is_whole) => {
                        Err(TaskError::NotApplied)
                    }
                    _ => save(&link, &task, &mut user, report).await,
                };
            }
            move |params: &mut Self, now| {
                if let Some(applied) = applied {
                    params.rows_applied(applied, now);
                }
                if !is_meant {
                    params.staged = staged_before;
                }
                params.save_ended(end, now);
            }
        });
    }

    /// Passes the user's answer to the running task; true if it had asked that.
    pub(crate) fn answer(&mut self, question: &Question, yes: bool) -> bool {
        let task = self.task.as_mut();
        let is_open = task.is_some_and(|task| task.answer(question, yes));
        if is_open && yes {
            self.outcomes.clear();
            self.doing = match question {
                Question::Save(_) if self.to_apply().is_empty() => Doing::BackingUp,
                _ => Doing::Applying,
            };
        }
        is_open
    }

    fn open_file(&mut self, typed: Option<PathBuf>, env: &Env) {
        if self.jobs.is_running(&ParamsJob::Open) {
            return;
        }
        self.file_refused = None;
        let read = |path: &Path| Ok((path.to_owned(), file::load(path)?));
        let opened = open(typed, file::FILE_NAME, env, read);
        self.jobs.start(
            ParamsJob::Open,
            env.background(),
            opened,
            |params, ctx, opened| match opened {
                Ok((path, file)) => params.show_file(&path, file),
                Err(refused) => {
                    params.file_refused = Some(refused.clone());
                    ctx.notify(refused);
                }
            },
        );
    }

    /// Applies results of tasks and file reads, and lists the files of the current hand.
    pub(crate) fn tick(&mut self, hand: ParamsHand<'_>, ctx: &mut Ctx<'_>) {
        self.apply_task(ctx.now);
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
        self.list_files(hand.connection.endpoint.as_ref(), ctx.env);
    }

    fn list_files(&mut self, hand: Option<&Endpoint>, env: &Env) {
        let Some(hand) = hand else {
            self.listed = None;
            return;
        };
        let Some(folder) = env.settings_path.as_deref().map(folder_beside) else {
            return;
        };
        if self.files.is_some() || self.jobs.is_running(&ParamsJob::List) {
            return;
        }
        let files = Backups::new(&folder, hand);
        // The built-in hand starts with factory values: saves of an earlier one are void.
        let forgets = hand.is_sim() && self.listed.as_ref() != Some(hand);
        self.listed = Some(hand.clone());
        let list = on_thread(move || {
            if forgets {
                // A record that cannot be removed is shown with its date.
                let _forgotten = files.forget_saved();
            }
            Ok(FilesRead::of(files))
        });
        self.jobs.start(
            ParamsJob::List,
            env.background(),
            list,
            |params, _, read| {
                if let Ok(read) = read {
                    params.show_files(read);
                }
            },
        );
    }
}

/// Rows to write, with the risks that the user confirmed already.
fn apply_task(wanted: Params, agreed: Risks, hand: ParamsHand<'_>) -> Apply {
    Apply {
        wanted,
        agreed,
        backups: None,
        otherwise: Otherwise::Stay,
        overshoot: Arc::clone(hand.overshoot),
    }
}

impl ParamsState {
    fn begin(&mut self, doing: Doing) {
        self.is_asked = true;
        (self.trouble, self.doing) = (None, doing);
        match doing {
            Doing::Applying => self.outcomes.clear(),
            Doing::Asking => self.save = None,
            _ => {}
        }
    }

    fn apply_task(&mut self, now: Moment) {
        let Some(task) = &mut self.task else { return };
        let (steps, end) = task.news();
        let is_asking = task.question().is_some();
        for (at, step) in steps {
            match step {
                TaskStep::Read(span, bytes) => self.apply_read(span, &bytes, at),
                TaskStep::Row(row) => self.written(row, at),
                TaskStep::Writing(_) => self.doing = Doing::Applying,
                TaskStep::BackingUp => self.doing = Doing::BackingUp,
                TaskStep::Saving => self.doing = Doing::Saving,
                // Of other tasks.
                TaskStep::BackedUp(..)
                | TaskStep::Looking(_)
                | TaskStep::Returning
                | TaskStep::Kept(_)
                | TaskStep::Resetting
                | TaskStep::Calibrating
                | TaskStep::Measuring => {}
            }
        }
        if is_asking {
            self.doing = Doing::Asking;
        }
        if let Some(effect) = end {
            (self.task, self.doing) = (None, Doing::Nothing);
            effect(self, now);
        }
    }

    fn rows_read(&mut self, rows: ReadRows, now: Moment) {
        if !rows.params.is_empty() {
            self.read_at = Some(now);
        }
        self.trouble = rows.troubles.into_iter().next_back();
    }

    fn rows_applied(&mut self, end: Result<Applied, TaskError>, now: Moment) {
        match end {
            Ok(applied) => {
                self.read_at = Some(now);
                self.undo = changes::undo_of(&applied.rows);
                for row in applied.rows {
                    if self.outcome(row.id).is_none() {
                        self.written(row, now);
                    }
                }
                self.trouble = applied.broken_off;
            }
            Err(error) => self.not_begun(error),
        }
    }

    fn save_ended(&mut self, end: Result<SaveReport, TaskError>, now: Moment) {
        match end {
            Err(error @ (TaskError::NotRead { .. } | TaskError::Declined(_))) => {
                self.not_begun(error);
            }
            end => {
                self.files = None;
                self.save = Some((end, now));
            }
        }
    }

    fn not_begun(&mut self, error: TaskError) {
        if let TaskError::NotRead { why, .. } | TaskError::NotAsked(why) = error {
            self.trouble = Some(why);
        }
    }

    fn show_files(&mut self, read: FilesRead) {
        self.unreadable = None;
        self.files = Some(read.files);
        match read.known {
            Ok(known) => self.known = known,
            Err(error) => {
                self.known = Known::default();
                self.unreadable = Some(error);
            }
        }
        match read.backups {
            Ok(backups) => self.backups = backups,
            Err(error) => self.unreadable = Some(error.into()),
        }
    }

    fn show_file(&mut self, path: &Path, file: ParamsFile) {
        let name = path.file_name().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        self.compared = Some(FileComparison::new(name, file, &self.live_params()));
    }
}
