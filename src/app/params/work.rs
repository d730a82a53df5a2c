//! Handling of parameter requests, and the tasks that carry them out. Reads before it writes; asks before dangerous
//! changes.

use crate::app::ctx::Ctx;
use crate::app::env::Env;
use crate::app::env::running::{Running, Steps};
use crate::app::files::open::open;
use crate::app::hand::Connection;
use crate::app::params::state::{
    Doing, FileComparison, FilesRead, ParamAction, ParamsEnd, ParamsJob, ParamsState, SaveEnd,
    WriteQuestion, WriteRequest,
};
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Dof, HandSample, Moment};
use crate::link::{LinkHandle, LinkStatus};
use crate::params::backups::{Backups, Known, folder_beside};
use crate::params::changes;
use crate::params::danger::Danger;
use crate::params::file::{self, ParamsFile};
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::store::on_thread;
use crate::tasks::apply::{Applied, Apply, Otherwise, apply};
use crate::tasks::read::{ReadRows, rows};
use crate::tasks::save::{Save, SaveReport, save};
use crate::tasks::{Consent, ParamStep, TaskError};
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
            ParamAction::Apply => self.apply_rows(self.to_apply(), Vec::new(), hand),
            ParamAction::Undo if self.undo_refusal(link).is_some() => {}
            ParamAction::Undo => {
                let undo = self.undo.clone();
                self.stage_all(&undo);
                self.apply_rows(undo, Vec::new(), hand);
            }
            ParamAction::Save if self.save_refusal(link).is_some() => {}
            ParamAction::Save => self.ask_save(self.staged.clone(), hand.overshoot),
            ParamAction::SaveWith(values) => {
                if self.save_refusal_with(&values, link).is_none() {
                    let before = self.staged.clone();
                    self.stage_all(&values);
                    self.ask_save(before, hand.overshoot);
                }
            }
            ParamAction::Agree if self.write_refusal(link).is_some() => {}
            ParamAction::Agree => {
                let Some(WriteQuestion { what, dangers, .. }) = self.question.take() else {
                    return;
                };
                match what {
                    WriteRequest::Apply(wanted) => self.apply_rows(wanted, dangers, hand),
                    WriteRequest::Save if self.to_apply().is_empty() => {
                        self.save(dangers, hand);
                    }
                    WriteRequest::Save => {
                        self.apply_rows(self.to_apply(), dangers.clone(), hand);
                        self.save_next = Some(dangers);
                    }
                }
            }
            ParamAction::Decline => {
                if let Some(declined) = self.question.take() {
                    self.staged = declined.staged_before;
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

    /// Starts a task that reads or writes rows, if there is a link.
    fn start<F>(
        &mut self,
        doing: Doing,
        hand: ParamsHand<'_>,
        task: impl FnOnce(LinkHandle, Steps<ParamStep>) -> F,
    ) where
        F: Future<Output = ParamsEnd> + Send + 'static,
    {
        if let Some(link) = hand.connection.link().cloned() {
            self.begin(doing);
            self.task = Some(Running::start(hand.env, |steps| task(link, steps)));
        }
    }

    fn read_rows(&mut self, hand: ParamsHand<'_>) {
        self.start(Doing::Reading, hand, |link, steps| async move {
            let report = |span, bytes: &[u8]| steps.send(ParamStep::Read(span, bytes.to_vec()));
            ParamsEnd::Read(rows(&link, report).await)
        });
    }

    fn apply_rows(&mut self, wanted: Params, agreed: Vec<Danger>, hand: ParamsHand<'_>) {
        let task = Apply {
            wanted,
            consent: Consent::To(agreed),
            backups: None,
            otherwise: Otherwise::Stay,
            overshoot: Arc::clone(hand.overshoot),
        };
        self.start(Doing::Applying, hand, |link, steps| async move {
            let end = apply(&link, &task, |step| steps.send(step)).await;
            ParamsEnd::Applied(task.wanted, end)
        });
    }

    /// Asks the user to confirm a SAVE, with its dangers.
    fn ask_save(&mut self, staged_before: Params, overshoot: &OvershootMap) {
        self.question = Some(WriteQuestion {
            what: WriteRequest::Save,
            dangers: self.save_dangers(overshoot),
            staged_before,
        });
    }

    fn save(&mut self, agreed: Vec<Danger>, hand: ParamsHand<'_>) {
        let Some(backups) = self.files.clone() else {
            return;
        };
        let task = Save {
            backups,
            before: self.before_changes(&Params::default()),
            consent: Consent::To(agreed),
            overshoot: Arc::clone(hand.overshoot),
        };
        self.start(Doing::BackingUp, hand, |link, steps| async move {
            ParamsEnd::Saved(save(&link, &task, |step| steps.send(step)).await)
        });
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
        let connection = hand.connection;
        let (link, now) = (&connection.status, ctx.now);
        self.apply_task(now);
        if !self.is_busy()
            && let Some(agreed) = self.save_next.take()
            && self.question.is_none()
        {
            if self.is_applied() && self.save_refusal(link).is_none() {
                self.save(agreed, hand);
            } else {
                self.save = Some((SaveEnd::NotApplied, now));
            }
        }
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
        self.list_files(connection.endpoint.as_ref(), ctx.env);
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

impl ParamsState {
    fn begin(&mut self, doing: Doing) {
        self.is_asked = true;
        (self.trouble, self.doing) = (None, doing);
        if doing != Doing::Reading {
            self.question = None;
        }
        match doing {
            Doing::Applying => self.outcomes.clear(),
            Doing::BackingUp => self.save = None,
            _ => {}
        }
    }

    fn apply_task(&mut self, now: Moment) {
        let Some(task) = &mut self.task else { return };
        let (steps, end) = task.news();
        for (at, step) in steps {
            match step {
                ParamStep::Read(span, bytes) => self.apply_read(span, &bytes, at),
                ParamStep::Row(row) => self.written(row, at),
                ParamStep::Saving => self.doing = Doing::Saving,
                ParamStep::BackingUp | ParamStep::Meant(_) | ParamStep::Writing => {}
            }
        }
        let Some(end) = end else { return };
        (self.task, self.doing) = (None, Doing::Nothing);
        match end {
            ParamsEnd::Read(rows) => self.rows_read(rows, now),
            ParamsEnd::Applied(wanted, end) => self.rows_applied(wanted, end, now),
            ParamsEnd::Saved(end) => self.save_ended(end, now),
        }
    }

    fn rows_read(&mut self, rows: ReadRows, now: Moment) {
        if !rows.params.is_empty() {
            self.read_at = Some(now);
        }
        self.trouble = rows.troubles.into_iter().next_back();
    }

    fn rows_applied(&mut self, wanted: Params, end: Result<Applied, TaskError>, now: Moment) {
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
            Err(error) => self.refused(WriteRequest::Apply(wanted), error),
        }
    }

    fn save_ended(&mut self, end: Result<SaveReport, TaskError>, now: Moment) {
        let end = match end {
            Ok(report) => match report.not_noted {
                None => SaveEnd::Reported(report.saved),
                Some(error) => SaveEnd::NotNoted(report.saved, error),
            },
            Err(TaskError::NoBackup(why)) => SaveEnd::NoBackup(why),
            Err(TaskError::NotAsked(error)) => SaveEnd::NotAsked(error),
            Err(error) => return self.refused(WriteRequest::Save, error),
        };
        self.files = None;
        self.save = Some((end, now));
    }

    fn refused(&mut self, what: WriteRequest, error: TaskError) {
        match error {
            TaskError::NotMeant(risks) => {
                self.question = Some(WriteQuestion {
                    what,
                    dangers: risks.dangers,
                    staged_before: self.staged.clone(),
                });
            }
            TaskError::NotRead { why, .. } | TaskError::NotAsked(why) => self.trouble = Some(why),
            TaskError::NotReached | TaskError::NoBackup { .. } => {}
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
