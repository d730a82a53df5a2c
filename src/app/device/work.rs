//! What is read and written when: one request at a time, each to its end. Reads before it writes, so that nothing is written on the
//! strength of an old value; asks before what could hurt; sends no SAVE without a backup.

use crate::app::desk::Desk;
use crate::app::device::book::{Doing, Question, SaveEnd, Wanted};
use crate::app::device::keeper::{Before, FileJob};
use crate::app::device::wish::DeviceWish;
use crate::app::params::danger::{Danger, worse};
use crate::app::params::plan::{self, Plan, RowEnd, RowVerdict};
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::{Params, SPANS};
use crate::hand::{Dof, Moment};
use crate::link::{Outcome, Request, RequestError, SaveDoubt, Saved, Ticket, Verdict, Written};
use std::time::Duration;

/// Tries to read a group: a late answer may have to be waited out.
const READ_TRIES: u8 = 4;
/// Between two tries.
const AGAIN_AFTER: Duration = Duration::from_millis(200);
/// Speed and force in force are read all the time; older ones are not copied.
const COPY_WITHIN: Duration = Duration::from_secs(5);

/// What is under way, and the ticket that it waits for.
#[derive(Debug, Default)]
pub(crate) struct DeviceWork {
    ticket: Option<Ticket>,
    task: Task,
    /// Work for the files, taken by the keeper.
    pub(crate) files: Option<FileJob>,
}

#[derive(Debug, Default)]
enum Task {
    #[default]
    Nothing,
    Read {
        next: usize,
        tries: u8,
        again_at: Option<Moment>,
        got: Params,
        then: Then,
    },
    Write {
        plan: Plan,
        before: Params,
        next: usize,
        ends: Vec<RowEnd>,
    },
    /// The backup is being written.
    BackUp,
    Save,
    /// The result is being noted.
    Note(Saved),
}

/// What follows a reading.
#[derive(Debug)]
enum Then {
    Nothing,
    Write(Wanted, Vec<Danger>),
    /// Some writes could not be verified: judge them by what is read now.
    Judge(Vec<RowEnd>),
}

impl Desk {
    /// Stages a value or takes it back. Writes nothing.
    pub(crate) fn stage(&mut self, id: ParamId, value: Option<Value>) {
        self.state.device.stage(id, value);
    }

    /// Carries out what a person asked for, except what is done with files.
    pub(crate) fn device(&mut self, wish: &DeviceWish, now: Moment) {
        match wish {
            DeviceWish::Read if self.state.read_refusal().is_none() => {
                self.read_rows(Then::Nothing, now);
            }
            DeviceWish::Apply if self.state.apply_refusal().is_none() => {
                let wanted = Wanted::Apply(self.state.device.to_apply());
                self.read_rows(Then::Write(wanted, Vec::new()), now);
            }
            DeviceWish::Undo if self.state.undo_refusal().is_none() => {
                let undo = self.state.device.undo.clone();
                self.stage_all(&undo);
                self.read_rows(Then::Write(Wanted::Apply(undo), Vec::new()), now);
            }
            DeviceWish::Save if self.state.save_refusal().is_none() => {
                self.read_rows(Then::Write(Wanted::Save, Vec::new()), now);
            }
            DeviceWish::Agree if self.state.write_refusal().is_none() => {
                if let Some(question) = self.state.device.question.take() {
                    self.read_rows(Then::Write(question.what, question.dangers), now);
                }
            }
            DeviceWish::Decline => self.state.device.question = None,
            DeviceWish::CopyLive(dof) => self.copy_live(*dof),
            DeviceWish::UnstageAll => self.state.device.unstage_all(),
            DeviceWish::Tick(id) => {
                if let Some(compared) = &mut self.state.device.compared {
                    compared.tick(*id);
                }
            }
            DeviceWish::StageTicked => {
                if let Some(compared) = self.state.device.compared.take() {
                    self.stage_all(&compared.chosen());
                }
            }
            DeviceWish::CloseFile => self.state.device.compared = None,
            _ => {}
        }
    }

    fn stage_all(&mut self, params: &Params) {
        for (id, value) in params.iter() {
            self.stage(id, Some(value));
        }
    }

    fn copy_live(&mut self, dof: Option<Dof>) {
        let (sample, now) = (self.state.sample, self.state.now);
        let young = |asked: Moment| now.since(asked) <= COPY_WITHIN;
        let is_live = self.state.link.state.is_live();
        let speeds = sample.speed_set.filter(|all| is_live && young(all.asked));
        let forces = sample.force_set.filter(|all| is_live && young(all.asked));
        for dof in Dof::ALL
            .into_iter()
            .filter(|each| dof.is_none_or(|dof| dof == *each))
        {
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

    fn read_rows(&mut self, then: Then, now: Moment) {
        let book = &mut self.state.device;
        book.is_asked = true;
        book.trouble = None;
        // What was asked about is still meant when the rows are only read again; before a write it is judged anew.
        if matches!(then, Then::Write(..)) {
            book.question = None;
        }
        book.doing = match &then {
            Then::Nothing => Doing::Reading,
            Then::Write(Wanted::Save, _) => Doing::BackingUp,
            Then::Write(Wanted::Apply(_), _) | Then::Judge(_) => Doing::Applying,
        };
        self.work.task = Task::Read {
            next: 0,
            tries: READ_TRIES,
            again_at: None,
            got: Params::default(),
            then,
        };
        self.go_on(now);
    }

    /// Asks again where a first try got no answer. Called every frame.
    pub(crate) fn tick_device(&mut self, now: Moment) {
        let due = matches!(&self.work.task, Task::Read { again_at: Some(at), .. } if *at <= now);
        if due && self.work.ticket.is_none() {
            self.go_on(now);
        }
    }

    /// Sends the next request of what is under way.
    fn go_on(&mut self, now: Moment) {
        let request = match &self.work.task {
            Task::Read { next, .. } => SPANS.get(*next).map(|span| Request::Read(*span)),
            Task::Write { plan, next, .. } => plan.settings.get(*next).map(|it| Request::Set(*it)),
            Task::Save => Some(Request::Save),
            Task::Nothing | Task::BackUp | Task::Note(_) => return,
        };
        let Some(request) = request else {
            return self.finished(now);
        };
        let asked = match &self.link {
            Some(link) => link.ask(request),
            None => Err(RequestError::NotConnected),
        };
        match asked {
            Ok(ticket) => self.work.ticket = Some(ticket),
            Err(error) => self.not_asked(error, now),
        }
    }

    /// Nothing was sent.
    fn not_asked(&mut self, error: RequestError, now: Moment) {
        match &self.work.task {
            Task::Save => self.save_ended(SaveEnd::NotAsked(error), now),
            Task::Read { .. } => self.read_failed(error, now),
            _ => {
                self.state.device.trouble = Some(error);
                self.finished(now);
            }
        }
    }

    /// The end of a request; false if it is none of these.
    pub(crate) fn device_done(
        &mut self,
        ticket: Ticket,
        result: &Result<Outcome, RequestError>,
        now: Moment,
    ) -> bool {
        if self.work.ticket != Some(ticket) {
            return false;
        }
        self.work.ticket = None;
        match (&mut self.work.task, result) {
            (
                Task::Read {
                    next,
                    tries,
                    again_at,
                    got,
                    ..
                },
                Ok(Outcome::Memory { span, bytes }),
            ) => {
                (*next, *tries, *again_at) = (*next + 1, READ_TRIES, None);
                got.take(*span, bytes);
                self.state.device.take(*span, bytes, now);
                self.go_on(now);
            }
            (Task::Read { .. }, Err(error)) => self.read_failed(error.clone(), now),
            (Task::Write { .. }, Ok(Outcome::Written(written))) => self.written(written, now),
            (Task::Write { .. }, Err(error)) => {
                self.state.device.trouble = Some(error.clone());
                self.finished(now);
            }
            (Task::Save, Ok(Outcome::Saved(saved))) => self.saved(saved.clone()),
            (Task::Save, Err(_)) => {
                let why = SaveDoubt::LinkLost;
                self.saved(Saved::Unknown { why });
            }
            _ => {}
        }
        true
    }

    /// A group could not be read: once more after a while, or on to the next one.
    fn read_failed(&mut self, error: RequestError, now: Moment) {
        let Task::Read {
            next,
            tries,
            again_at,
            ..
        } = &mut self.work.task
        else {
            return;
        };
        let is_final = matches!(
            error,
            RequestError::Refused { .. } | RequestError::TooLong { .. }
        );
        *tries = tries.saturating_sub(1);
        *again_at = Some(now.plus(AGAIN_AFTER));
        if !is_final && *tries > 0 {
            return;
        }
        (*next, *tries, *again_at) = (*next + 1, READ_TRIES, None);
        self.state.device.trouble = Some(error);
        self.go_on(now);
    }

    fn written(&mut self, written: &Written, now: Moment) {
        let Task::Write {
            plan,
            before,
            next,
            ends,
        } = &mut self.work.task
        else {
            return;
        };
        if let Some(setting) = plan.settings.get(*next) {
            ends.extend(plan::ends(plan, before, setting, written));
        }
        *next += 1;
        if let Some(bytes) = &written.holds {
            self.state.device.take(written.span, bytes, now);
        }
        // What did not go out because a person armed meanwhile does not go out for the next group either.
        match written.verdict {
            Verdict::NotSent(_) => self.finished(now),
            _ => self.go_on(now),
        }
    }

    /// A task came to its end.
    fn finished(&mut self, now: Moment) {
        self.work.ticket = None;
        match std::mem::take(&mut self.work.task) {
            Task::Read { got, then, .. } => self.all_read(&got, then, now),
            Task::Write { ends, .. } => self.all_written(ends, now),
            _ => self.state.device.doing = Doing::Nothing,
        }
    }

    fn all_read(&mut self, got: &Params, then: Then, now: Moment) {
        let book = &mut self.state.device;
        if !got.is_empty() {
            book.read_at = Some(now);
        }
        book.doing = Doing::Nothing;
        match then {
            Then::Nothing => {}
            Then::Judge(ends) => self.judged(ends, got),
            Then::Write(what, agreed) => self.write_wanted(what, &agreed, got, now),
        }
    }

    /// The rows are known as they are now: ask about what could hurt, or begin.
    fn write_wanted(&mut self, what: Wanted, agreed: &[Danger], got: &Params, now: Moment) {
        let wanted = match &what {
            Wanted::Apply(wanted) => wanted.clone(),
            Wanted::Save => Params::default(),
        };
        let needs = |id: &ParamId| what == Wanted::Save || wanted.get(*id).is_some();
        let is_missing = |id: ParamId| got.get(id).is_none();
        // Why it is missing stands in the book already.
        if ParamId::all().into_iter().filter(needs).any(is_missing) {
            return;
        }
        let dangers = match &what {
            Wanted::Apply(wanted) => {
                let mut after = got.clone();
                wanted.iter().for_each(|(id, value)| after.put(id, value));
                worse(got, &after)
            }
            Wanted::Save => {
                let saved = self.state.device.known.saved.as_ref();
                worse(
                    &saved.map(|file| file.params.clone()).unwrap_or_default(),
                    got,
                )
            }
        };
        if dangers.iter().any(|danger| !agreed.contains(danger)) {
            self.state.device.question = Some(Question { what, dangers });
            return;
        }
        match what {
            Wanted::Apply(_) => self.write_rows(&wanted, got, now),
            Wanted::Save => {
                self.state.device.doing = Doing::BackingUp;
                self.state.device.save = None;
                self.work.task = Task::BackUp;
                self.work.files = Some(FileJob::Before(got.clone()));
            }
        }
    }

    fn write_rows(&mut self, wanted: &Params, before: &Params, now: Moment) {
        let plan = plan::plan(wanted, before);
        let held = wanted.only(|id| plan.rows.get(id).is_none());
        let ends = held.iter().map(|(id, wanted)| RowEnd {
            id,
            wanted,
            before: before.get(id),
            holds: before.get(id),
            verdict: RowVerdict::Applied,
        });
        let ends = ends.collect();
        let book = &mut self.state.device;
        book.forget_ends();
        book.doing = Doing::Applying;
        self.work.task = Task::Write {
            plan,
            before: before.clone(),
            next: 0,
            ends,
        };
        self.go_on(now);
    }

    fn all_written(&mut self, ends: Vec<RowEnd>, now: Moment) {
        let book = &mut self.state.device;
        book.doing = Doing::Nothing;
        book.undo = plan::undo(&ends);
        book.ended(ends);
        let doubtful = book.unverified();
        if !doubtful.is_empty() {
            self.read_rows(Then::Judge(doubtful), now);
        }
    }

    /// What could not be verified at once is judged by what was read afterwards.
    fn judged(&mut self, ends: Vec<RowEnd>, got: &Params) {
        let known = ends.into_iter().filter_map(|end| {
            let holds = got.get(end.id)?;
            let verdict = match holds {
                holds if holds == end.wanted => RowVerdict::Applied,
                holds if Some(holds) == end.before => RowVerdict::Dropped,
                _ => RowVerdict::Altered,
            };
            let holds = Some(holds);
            Some(RowEnd {
                verdict,
                holds,
                ..end
            })
        });
        let known: Vec<RowEnd> = known.collect();
        let undone = |end: &RowEnd| end.holds == end.before;
        let book = &mut self.state.device;
        for end in known.iter().filter(|end| undone(end)) {
            book.undo.forget(end.id);
        }
        book.ended(known);
    }

    /// What came of the backup and the note before a SAVE.
    pub(crate) fn backed_up(&mut self, before: Before, now: Moment) {
        if !matches!(self.work.task, Task::BackUp) {
            return;
        }
        match before {
            Err(end) => self.save_ended(end, now),
            // Whatever a person did meanwhile goes first; the link asks the same.
            Ok(_) => {
                self.state.device.doing = Doing::Saving;
                self.work.task = Task::Save;
                self.go_on(now);
            }
        }
    }

    fn saved(&mut self, saved: Saved) {
        self.work.files = Some(FileJob::After(saved.clone()));
        self.work.task = Task::Note(saved);
    }

    /// What came of noting the result.
    pub(crate) fn noted(&mut self, noted: Result<(), String>, now: Moment) {
        let Task::Note(saved) = &self.work.task else {
            return;
        };
        let end = match noted {
            Ok(()) => SaveEnd::Told(saved.clone()),
            Err(message) => SaveEnd::NotNoted(saved.clone(), message),
        };
        self.save_ended(end, now);
    }

    fn save_ended(&mut self, end: SaveEnd, now: Moment) {
        // Nothing was sent: the note of the attempt must not say that its result is not known.
        if let SaveEnd::NotAsked(error) = &end {
            let reason = error.to_string();
            self.work.files = Some(FileJob::After(Saved::Refused { reason }));
        }
        self.work.task = Task::Nothing;
        self.state.device.doing = Doing::Nothing;
        self.state.device.save = Some((end, now));
    }

    /// Another hand, or none: nothing of the old one counts for it. What is staged was meant for the old one.
    pub(crate) fn device_replaced(&mut self) {
        self.work = DeviceWork::default();
        self.state.device = crate::app::device::book::DeviceBook::default();
    }
}
