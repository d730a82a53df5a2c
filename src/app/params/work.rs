//! What a person asks about the rows that a hand keeps, and the tasks that do it. Reads before it writes; asks before what
//! could hurt.

use crate::app::env::Env;
use crate::app::files::open::open;
use crate::app::hand::HandState;
use crate::app::notices::Notices;
use crate::app::params::action::ParamAction;
use crate::app::params::compared::Compared;
use crate::app::params::running::{FilesRead, ParamsEnd};
use crate::app::params::state::{Doing, ParamsState, SaveEnd, WriteQuestion, WriteRequest};
use crate::app::running::{Running, Steps};
use crate::hand::{Dof, Moment};
use crate::link::LinkHandle;
use crate::params::backups::{Backups, Known, folder_beside};
use crate::params::changes;
use crate::params::danger::Danger;
use crate::params::file::{self, ParamsFile};
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::store::{BackgroundJob, on_thread};
use crate::tasks::apply::{Applied, Apply, Otherwise, apply};
use crate::tasks::read::{ReadRows, rows};
use crate::tasks::save::{Save, SaveReport, save};
use crate::tasks::{Consent, ParamStep, TaskError};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Speed and force in force are read all the time; older ones are not copied.
const COPY_WITHIN: Duration = Duration::from_secs(5);

impl HandState {
    /// Carries out what a person asked for.
    pub(crate) fn param_action(&mut self, action: ParamAction, env: &Env) {
        match action {
            ParamAction::Read if self.read_refusal().is_some() => {}
            ParamAction::Read => self.read_rows(env),
            ParamAction::Apply if self.apply_refusal().is_some() => {}
            ParamAction::Apply => self.apply_rows(self.params.to_apply(), Vec::new(), env),
            ParamAction::Undo if self.undo_refusal().is_some() => {}
            ParamAction::Undo => {
                let undo = self.params.undo.clone();
                self.stage_all(&undo);
                self.apply_rows(undo, Vec::new(), env);
            }
            ParamAction::Save if self.save_refusal().is_some() => {}
            ParamAction::Save => self.ask_save(env),
            ParamAction::Agree if self.write_refusal().is_some() => {}
            ParamAction::Agree => {
                let Some(WriteQuestion { what, dangers }) = self.params.question.take() else {
                    return;
                };
                match what {
                    WriteRequest::Apply(wanted) => self.apply_rows(wanted, dangers, env),
                    WriteRequest::Save if self.params.to_apply().is_empty() => {
                        self.save(dangers, env);
                    }
                    WriteRequest::Save => {
                        self.apply_rows(self.params.to_apply(), dangers.clone(), env);
                        self.params.save_next = Some(dangers);
                    }
                }
            }
            ParamAction::Decline => self.params.question = None,
            ParamAction::CopyLive => self.copy_live(),
            ParamAction::UnstageAll => self.params.unstage_all(),
            ParamAction::Open(typed) => self.open_params(typed, env),
            ParamAction::Tick(id) => {
                if let Some(compared) = &mut self.params.compared {
                    compared.tick(id);
                }
            }
            ParamAction::StageTicked => {
                if let Some(compared) = self.params.compared.take() {
                    self.stage_all(&compared.chosen());
                }
            }
            ParamAction::CloseFile => self.params.compared = None,
            // Carried out by the program, which has the files.
            ParamAction::Dump => {}
        }
    }

    fn stage_all(&mut self, params: &Params) {
        for (id, value) in params.iter() {
            self.params.stage(id, Some(value));
        }
    }

    fn copy_live(&mut self) {
        let (sample, now) = (self.sample, self.now);
        let young = |asked: Moment| now.since(asked) <= COPY_WITHIN;
        let is_live = self.link.state.is_live();
        let speeds = sample.speed_set.filter(|all| is_live && young(all.asked));
        let forces = sample.force_set.filter(|all| is_live && young(all.asked));
        for dof in Dof::ALL {
            if let Some(speed) = speeds.and_then(|all| all.value[dof]) {
                let value = Value::Number(i32::from(speed.get()));
                self.params.stage(ParamId::DefaultSpeed(dof), Some(value));
            }
            if let Some(force) = forces.and_then(|all| all.value[dof]) {
                let value = Value::Number(i32::from(force.get()));
                self.params.stage(ParamId::DefaultForce(dof), Some(value));
            }
        }
    }

    /// Reads the rows because somebody looks at them, if it is due.
    pub(crate) fn look_at_params(&mut self, env: &Env) {
        let now = self.now;
        if self.params.look(now) {
            self.param_action(ParamAction::Read, env);
        }
    }

    /// Starts what reads or writes rows, if there is a link.
    fn start_params<F>(
        &mut self,
        doing: Doing,
        env: &Env,
        task: impl FnOnce(LinkHandle, Steps<ParamStep>) -> F,
    ) where
        F: Future<Output = ParamsEnd> + Send + 'static,
    {
        if let Some(open) = &self.open {
            let link = open.link.clone();
            self.params.begin(doing);
            self.params.task = Some(Running::start(env, |steps| task(link, steps)));
        }
    }

    fn read_rows(&mut self, env: &Env) {
        self.start_params(Doing::Reading, env, |link, steps| async move {
            let took = |span, bytes: &[u8]| steps.tell(ParamStep::Read(span, bytes.to_vec()));
            ParamsEnd::Read(rows(&link, took).await)
        });
    }

    fn apply_rows(&mut self, wanted: Params, agreed: Vec<Danger>, env: &Env) {
        let task = Apply {
            wanted,
            consent: Consent::To(agreed),
            backups: None,
            otherwise: Otherwise::Stay,
        };
        self.start_params(Doing::Applying, env, |link, steps| async move {
            let end = apply(&link, &task, |step| steps.tell(step)).await;
            ParamsEnd::Applied(task.wanted, end)
        });
    }

    /// Shows what a SAVE would change; where that is nothing, it is done at once.
    fn ask_save(&mut self, env: &Env) {
        let params = &mut self.params;
        if params.unsaved().is_empty() {
            return self.save(Vec::new(), env);
        }
        params.question = Some(WriteQuestion {
            what: WriteRequest::Save,
            dangers: params.save_dangers(),
        });
    }

    fn save(&mut self, agreed: Vec<Danger>, env: &Env) {
        let Some(backups) = self.params.files.clone() else {
            return;
        };
        let task = Save {
            backups,
            before: self.params.before_changes(&Params::default()),
            consent: Consent::To(agreed),
        };
        self.start_params(Doing::BackingUp, env, |link, steps| async move {
            ParamsEnd::Saved(save(&link, &task, |step| steps.tell(step)).await)
        });
    }

    fn open_params(&mut self, typed: Option<PathBuf>, env: &Env) {
        if self.params.opening.is_none() {
            self.params.file_refused = None;
            let read = |path: &Path| Ok((path.to_owned(), file::load(path)?));
            self.params.opening = Some(open(typed, file::FILE_NAME, env, read));
        }
    }

    /// Takes in what tasks and files gave, and keeps the files of the hand of now at hand.
    pub(crate) fn tick_params(&mut self, env: &Env, notices: &mut Notices) {
        let now = self.now;
        self.params.take_task(now);
        if !self.params.is_busy()
            && let Some(agreed) = self.params.save_next.take()
            && self.params.question.is_none()
        {
            if self.params.is_applied() && self.save_refusal().is_none() {
                self.save(agreed, env)
            } else {
                self.params.save = Some((SaveEnd::NotApplied, now))
            }
        }
        if let Some(read) = BackgroundJob::take_from(&mut self.params.listing) {
            self.params.show_files(read);
        }
        match BackgroundJob::take_from(&mut self.params.opening) {
            None => {}
            Some(Ok((path, file))) => self.params.show_file(&path, file),
            Some(Err(refused)) => {
                self.params.file_refused = Some(refused.clone());
                notices.push(now, refused);
            }
        }
        self.list_files(env);
    }

    fn list_files(&mut self, env: &Env) {
        let Some(hand) = &self.endpoint else {
            self.listed = None;
            return;
        };
        let Some(folder) = env.settings_path.as_deref().map(folder_beside) else {
            return;
        };
        if self.params.files.is_some() || self.params.listing.is_some() {
            return;
        }
        let files = Backups::new(&folder, hand);
        // The built-in hand begins as it was delivered: whatever was saved in an earlier one is gone.
        let forgets = hand.is_sim() && self.listed.as_ref() != Some(hand);
        self.listed = Some(hand.clone());
        let list = on_thread(move || {
            if forgets {
                // What cannot be forgotten is shown with its date.
                let _forgotten = files.forget_saved();
            }
            Ok(FilesRead::of(files))
        });
        let list = async move { list.await.ok() };
        self.params.listing = Some(BackgroundJob::start_fallible(&env.runtime, &env.wake, list));
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

    fn take_task(&mut self, now: Moment) {
        let Some(task) = &mut self.task else { return };
        let (steps, end) = task.news();
        for (at, step) in steps {
            match step {
                ParamStep::Read(span, bytes) => self.take(span, &bytes, at),
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
                None => SaveEnd::Told(report.saved),
                Some(message) => SaveEnd::NotNoted(report.saved, message),
            },
            Err(TaskError::NoBackup { message }) => SaveEnd::NoBackup { message },
            Err(TaskError::NotAsked(error)) => SaveEnd::NotAsked(error),
            Err(error) => return self.refused(WriteRequest::Save, error),
        };
        self.files = None;
        self.save = Some((end, now));
    }

    fn refused(&mut self, what: WriteRequest, error: TaskError) {
        match error {
            TaskError::NotMeant(risks) => {
                let dangers = risks.dangers;
                self.question = Some(WriteQuestion { what, dangers });
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
        self.compared = Some(Compared::new(name, file, &self.live_params()));
    }
}
