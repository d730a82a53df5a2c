//! Known state of a hand's persistent parameters: read, staged, saved, and the outcomes of the last writes. Sends nothing.

use crate::app::env::Ctx;
use crate::app::env::running::{Running, TaskEffect};
use crate::app::notices::NoticeKind;
use crate::app::readings::Freshness;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Moment, Span};
use crate::link::{LinkStatus, RequestError};
use crate::params::backups::{Backup, Backups, Known};
use crate::params::changes::{RowOutcome, RowVerdict};
use crate::params::danger::{Danger, worse};
use crate::params::file::ParamsFile;
use crate::params::rows::{ParamId, Value};
use crate::params::values::{ParamDifference, Params};
use crate::record::{LinkState, Rest};
use crate::store::{FileError, JobKind, Jobs};
use crate::tasks::save::SaveReport;
use crate::tasks::{Question, TaskError, TaskStep};
use crate::transport::Endpoint;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// Age from which a value is shown as stale: another client may have changed it since.
pub const OUTDATED_AGE: Duration = Duration::from_secs(60);
/// Minimum time before opening the view reads the same rows again.
pub const REREAD_DELAY: Duration = Duration::from_secs(2);

/// Opening the view after at least this long without it counts as a new visit.
const VIEW_GAP_MAX: Duration = Duration::from_millis(500);

/// Current operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Doing {
    #[default]
    Nothing,
    /// A question to the user is open; nothing is sent meanwhile.
    Asking,
    /// Rows are being read.
    Reading,
    /// Staged rows are being written and read back.
    Applying,
    /// The backup is being written.
    BackingUp,
    /// SAVE was sent; its result is pending.
    Saving,
}

/// Known state of a hand's persistent parameters.
#[derive(Debug, Default)]
pub struct ParamsState {
    live: BTreeMap<ParamId, (Value, Moment)>,
    /// Values of the first read, before any change by this program.
    first: Params,
    pub(crate) staged: Params,
    pub(crate) outcomes: BTreeMap<ParamId, RowOutcome>,
    /// Time of the last complete read.
    pub read_at: Option<Moment>,
    /// True once a read has been started since the hand was found.
    pub(crate) is_asked: bool,
    pub(crate) lost_at: Option<Moment>,
    viewed_at: Option<Moment>,
    /// Current operation.
    pub doing: Doing,
    /// Reason why the last read is incomplete.
    pub trouble: Option<RequestError>,
    /// Values that undo the last apply.
    pub undo: Params,
    /// Result and time of the last SAVE in this session.
    pub save: Option<(Result<SaveReport, TaskError>, Moment)>,
    /// Files of this hand; `None` if nothing is stored.
    pub files: Option<Backups>,
    /// Last save by this program.
    pub known: Known,
    /// Reason why `known` could not be read.
    pub unreadable: Option<FileError>,
    /// Backups, oldest first.
    pub backups: Vec<Backup>,
    /// File that is compared with the hand.
    pub compared: Option<FileComparison>,
    /// Reason why the last file was not opened.
    pub file_refused: Option<NoticeKind>,
    /// Running task.
    pub(crate) task: Option<Running<TaskStep, TaskEffect<Self>>>,
    /// Hand whose files were listed last.
    pub(crate) listed: Option<Endpoint>,
    pub(crate) jobs: Jobs<ParamsJob>,
}

/// Background jobs of a hand's parameters.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum ParamsJob {
    /// List the files of the hand.
    List,
    /// Choose and read a file to compare.
    Open,
}

impl JobKind for ParamsJob {
    type State = ParamsState;
    type Ctx<'a> = Ctx<'a>;
}

impl ParamsState {
    /// Resets the state for the next connection.
    pub(crate) fn at_next_connection(self) -> Self {
        Self {
            listed: self.listed,
            ..Self::default()
        }
    }

    /// Reason why the rows cannot be read now.
    pub fn read_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        if link.state.is_live() {
            self.is_busy().then_some(ParamRefusal::Busy)
        } else {
            Some(ParamRefusal::NoHand)
        }
    }

    /// Reason why persistent parameters cannot be written now.
    pub fn write_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let busy = || self.is_busy().then_some(ParamRefusal::Busy);
        rest_refusal(link).or_else(busy)
    }

    /// Reason why the staged rows cannot be applied now.
    pub fn apply_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let nothing = self.to_apply().is_empty();
        self.write_refusal(link)
            .or_else(|| nothing.then_some(ParamRefusal::NothingStaged))
    }

    /// Reason why the last apply cannot be undone now.
    pub fn undo_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let nothing = self.undo.is_empty();
        self.write_refusal(link)
            .or_else(|| nothing.then_some(ParamRefusal::NothingToUndo))
    }

    /// Reason why the hand's parameters cannot be saved to its flash now.
    pub fn save_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        self.save_refusal_with(&Params::default(), link)
    }

    /// The same if these values are staged first.
    pub fn save_refusal_with(&self, more: &Params, link: &LinkStatus) -> Option<ParamRefusal> {
        // A SAVE with a doubtful result may be repeated, and without a known save the flash may differ from the hand.
        let is_known = self.known.saved.is_some() && self.known.doubtful.is_none();
        let before = self.before_changes(&self.live_params());
        let after = self.to_save().with(more);
        let nothing = is_known && before.differences(&after).is_empty();
        let refusals = [
            (self.files.is_none(), ParamRefusal::NoFolder),
            (self.live.is_empty(), ParamRefusal::NothingRead),
            (nothing, ParamRefusal::NothingToSave),
        ];
        let refused = refusals.into_iter().find(|(is_so, _)| *is_so);
        self.write_refusal(link).or(refused.map(|(_, why)| why))
    }

    /// Freshness of a row's value on a link that is live or not.
    pub fn freshness(&self, id: ParamId, is_live: bool, now: Moment) -> Freshness {
        let Some((_, at)) = self.live(id) else {
            return Freshness::Unknown;
        };
        let before_loss = self.lost_at.is_some_and(|lost| at <= lost);
        if is_live && !before_loss && now.since(at) <= OUTDATED_AGE {
            Freshness::Live
        } else {
            Freshness::Stale
        }
    }

    /// Last value read on this connection and its time; `None` if the row was not read.
    pub fn live(&self, id: ParamId) -> Option<(Value, Moment)> {
        self.live.get(&id).copied()
    }

    /// All values read.
    pub fn live_params(&self) -> Params {
        let mut params = Params::default();
        for (id, (value, _)) in &self.live {
            params.put(*id, *value);
        }
        params
    }

    /// Replaces the read values by those of a recording.
    pub(crate) fn set_recorded(&mut self, params: &Params, at: Moment) {
        let known = |id: ParamId| Some((id, (params.get(id)?, at)));
        self.live = ParamId::all().into_iter().filter_map(known).collect();
    }

    /// Staged value of a row, if any.
    pub fn staged(&self, id: ParamId) -> Option<Value> {
        self.staged.get(id)
    }

    /// All staged values.
    pub const fn all_staged(&self) -> &Params {
        &self.staged
    }

    /// Rows that Apply would write. Rows that determine the hand's address are changed in a dialog instead.
    pub fn to_apply(&self) -> Params {
        self.staged.only(|id| !id.is_place())
    }

    /// Rows that a SAVE would write: the hand's values with the staged ones.
    pub fn to_save(&self) -> Params {
        self.live_params().with(&self.to_apply())
    }

    /// Presumed power-up values: those last saved by this program, else those first read. For rows that were never read,
    /// the values in `holds`.
    pub fn before_changes(&self, holds: &Params) -> Params {
        let saved = self.known.saved.as_ref().map(|file| &file.params);
        let read = holds.with(&self.first);
        saved.map_or_else(|| read.clone(), |saved| read.with(saved))
    }

    /// Rows that a SAVE would change for the next power-up, as far as this program knows.
    pub fn unsaved(&self) -> Vec<ParamDifference> {
        let before = self.before_changes(&self.live_params());
        before.differences(&self.to_save())
    }

    /// Joints that would close harder after the next power-up, or immediately.
    pub(crate) fn save_dangers(&self, overshoot: &OvershootMap) -> Vec<Danger> {
        let (live, after) = (self.live_params(), self.to_save());
        let mut all = worse(&self.before_changes(&live), &after, overshoot);
        for danger in worse(&live, &after, overshoot) {
            if !all.contains(&danger) {
                all.push(danger);
            }
        }
        all
    }

    /// Value last saved by this program.
    pub fn saved(&self, id: ParamId) -> Option<Value> {
        self.known.saved.as_ref()?.params.get(id)
    }

    /// Outcome of the last write of a row.
    pub fn outcome(&self, id: ParamId) -> Option<&RowOutcome> {
        self.outcomes.get(&id)
    }

    /// True while an operation is running.
    pub fn is_busy(&self) -> bool {
        self.doing != Doing::Nothing
    }

    /// True if the known values of a row differ.
    pub fn differs(&self, id: ParamId) -> bool {
        let live = self.live(id).map(|(value, _)| value);
        let others = [self.staged(id), self.saved(id), id.factory()];
        let differs = |other: &Value| live.is_none_or(|live| live != *other);
        others.iter().flatten().any(differs)
    }

    /// Notes that the user is viewing the rows. Returns true if they should be read now: when the view is opened, and when a
    /// hand is found while it is open.
    pub(crate) fn note_viewed(&mut self, now: Moment) -> bool {
        let before = self.viewed_at.replace(now);
        let comes = before.is_none_or(|at| now.since(at) > VIEW_GAP_MAX);
        !self.is_asked || comes && self.is_due(now)
    }

    /// True if the rows should be read again.
    pub fn is_due(&self, now: Moment) -> bool {
        let lost = self.lost_at;
        let young = |at: Moment| now.since(at) < REREAD_DELAY && lost.is_none_or(|lost| lost < at);
        !self.is_asked || !self.read_at.is_some_and(young)
    }

    /// Stages a value, or removes it with `None`. Values that must not be written are not staged.
    pub(crate) fn stage(&mut self, id: ParamId, value: Option<Value>) {
        match value {
            None => self.staged.forget(id),
            Some(value) if id.allows(value) => self.staged.put(id, value),
            Some(_) => return,
        }
        self.outcomes.remove(&id);
    }

    pub(crate) fn unstage_all(&mut self) {
        self.staged = Params::default();
        self.outcomes.clear();
    }

    /// Applies a block of values that was read.
    pub(crate) fn apply_read(&mut self, span: Span, bytes: &[u8], at: Moment) {
        let mut read = Params::default();
        read.apply(span, bytes);
        for (id, value) in read.iter() {
            if self.first.get(id).is_none() {
                self.first.put(id, value);
            }
            self.live.insert(id, (value, at));
        }
    }

    /// Applies the outcome of writing a row. A row that the hand rejected, ignored or changed shows the hand's value
    /// again; an unverified one stays staged, and its live value becomes unknown.
    pub(crate) fn written(&mut self, row: RowOutcome, at: Moment) {
        match (&row.verdict, row.holds) {
            (RowVerdict::NotSent(_), _) => {}
            (RowVerdict::Unverified(_), _) => {
                self.live.remove(&row.id);
            }
            (_, holds) => {
                self.staged.forget(row.id);
                if let Some(holds) = holds {
                    self.live.insert(row.id, (holds, at));
                }
            }
        }
        self.outcomes.insert(row.id, row);
    }

    /// The question of the running task, if it waits for the user's answer.
    pub fn question(&self) -> Option<&Question> {
        let (question, _) = self.task.as_ref()?.question()?;
        Some(question)
    }

    /// True while a SAVE is in progress.
    pub fn is_saving(&self) -> bool {
        self.doing == Doing::Saving
    }

    /// Marks earlier readings as stale: after reconnecting, the hand may be a different one or have been power-cycled.
    pub(crate) const fn link_lost(&mut self, now: Moment) {
        self.lost_at = Some(now);
        self.is_asked = false;
    }
}

/// A user request.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ParamAction {
    /// Read all rows. Writes nothing.
    Read,
    /// Write the staged rows, except those that determine the hand's address, and read them back.
    Apply,
    /// Restore the rows that the last apply changed, in the same way.
    Undo,
    /// Save the hand's parameters to its flash, after a backup.
    Save,
    /// Stage these values and save. If the user declines, they are unstaged.
    SaveWith(Params),
    /// Stage the hand's current speeds and forces as the power-up defaults. Writes nothing.
    CopyLive,
    /// Unstage everything.
    UnstageAll,
    /// Ask for a path, and write a parameter file there.
    Dump,
    /// Compare a parameter file with the hand: at the given path, else ask the user for one. Writes nothing.
    Open(Option<PathBuf>),
    /// Toggle the selection of a row of the file.
    Tick(ParamId),
    /// Stage the selected rows. Writes nothing.
    StageTicked,
    CloseFile,
}

/// Reason for a refusal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamRefusal {
    /// No hand answers.
    NoHand,
    /// The hand is armed.
    Armed,
    /// A stop is being confirmed.
    Holding,
    /// A joint is moving.
    Moving,
    /// It is unknown if the hand is at rest.
    RestUnknown,
    /// An operation is in progress.
    Busy,
    /// No staged row can be applied.
    NothingStaged,
    /// The last apply changed nothing, or there was none.
    NothingToUndo,
    /// The hand's values equal those last saved.
    NothingToSave,
    /// There is no folder for the backup.
    NoFolder,
    /// No row was read.
    NothingRead,
}

/// Reason why an operation is refused that requires a connected, disarmed hand at rest.
pub const fn rest_refusal(link: &LinkStatus) -> Option<ParamRefusal> {
    match (link.state, link.rest) {
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

/// File compared with the hand.
#[derive(Debug, Clone, PartialEq)]
pub struct FileComparison {
    pub name: String,
    /// Contents of the file.
    pub file: ParamsFile,
    ticked: BTreeSet<ParamId>,
}

impl FileComparison {
    /// Selects the rows in which the hand differs. Address rows are specific to one hand, so only the user selects them.
    pub fn new(name: String, file: ParamsFile, live: &Params) -> Self {
        let differ = live.differences(&file.params).into_iter();
        let ticked = differ.map(|row| row.id).filter(|id| !id.is_place());
        Self {
            ticked: ticked.collect(),
            name,
            file,
        }
    }

    /// True if a row is selected.
    pub fn is_ticked(&self, id: ParamId) -> bool {
        self.ticked.contains(&id)
    }

    /// Toggles the selection of a row that the file contains.
    pub fn tick(&mut self, id: ParamId) {
        if self.file.params.get(id).is_some() && !self.ticked.remove(&id) {
            self.ticked.insert(id);
        }
    }

    /// Selected rows.
    pub fn chosen(&self) -> Params {
        self.file.params.only(|id| self.is_ticked(id))
    }
}

/// Contents of a hand's files.
#[derive(Debug)]
pub(crate) struct FilesRead {
    pub(crate) files: Backups,
    pub(crate) known: Result<Known, FileError>,
    pub(crate) backups: io::Result<Vec<Backup>>,
}

impl FilesRead {
    pub(crate) fn of(files: Backups) -> Self {
        Self {
            known: files.known(),
            backups: files.backups(),
            files,
        }
    }
}
