//! What is known of the rows that a hand keeps: read back, staged, saved, and the outcomes of the last writes. Sends nothing.

use crate::app::env::running::Running;
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
use crate::record::{LinkState, Rest, Saved};
use crate::store::{BackgroundJob, FileError};
use crate::system::SystemError;
use crate::tasks::apply::Applied;
use crate::tasks::read::ReadRows;
use crate::tasks::save::SaveReport;
use crate::tasks::{BackupError, ParamStep, TaskError};
use crate::transport::Endpoint;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// A value read this long ago may have been changed by someone else since; it is shown as old.
pub const OUTDATED_AGE: Duration = Duration::from_secs(60);
/// Switching between views does not make the program read the same rows again within this time.
pub const REREAD_DELAY: Duration = Duration::from_secs(2);

/// After this long, opening the view counts as looking anew.
const LOOKED_AWAY: Duration = Duration::from_millis(500);

/// What is being done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Doing {
    #[default]
    Nothing,
    /// Rows are read.
    Reading,
    /// Staged rows are written and read back.
    Applying,
    /// The backup is written.
    BackingUp,
    /// SAVE was sent; its result is awaited.
    Saving,
}

/// What waits for the user's confirmation.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteQuestion {
    /// What would be done.
    pub what: WriteRequest,
    /// Why confirmation is needed.
    pub dangers: Vec<Danger>,
    /// What was staged before, and is again where it is declined.
    pub staged_before: Params,
}

/// What the user asked to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WriteRequest {
    /// These rows, into the hand's memory.
    Apply(Params),
    /// What the hand holds, into its flash; what is staged is applied first.
    Save,
}

/// How a SAVE ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SaveEnd {
    /// With this result from the hand, or without one.
    Told(Saved),
    /// The backup or the record could not be written: no SAVE was sent.
    NoBackup(BackupError),
    /// The hand was gone: no SAVE was sent.
    NotAsked(RequestError),
    /// What was staged did not all come into force: no SAVE was sent.
    NotApplied,
    /// With this result, which could not be recorded.
    NotNoted(Saved, SystemError),
}

/// What is known of the rows that a hand keeps.
#[derive(Debug, Default)]
pub struct ParamsState {
    live: BTreeMap<ParamId, (Value, Moment)>,
    /// What was read first, before this program changed anything.
    first: Params,
    pub(crate) staged: Params,
    pub(crate) outcomes: BTreeMap<ParamId, RowOutcome>,
    /// When all rows were read last.
    pub read_at: Option<Moment>,
    /// Whether a reading was begun since the hand was found.
    pub(crate) is_asked: bool,
    pub(crate) lost_at: Option<Moment>,
    looked_at: Option<Moment>,
    /// What is being done.
    pub doing: Doing,
    /// Why the last reading is incomplete.
    pub trouble: Option<RequestError>,
    /// What waits for the user's confirmation.
    pub question: Option<WriteQuestion>,
    /// The values that undo the last apply.
    pub undo: Params,
    /// How the last SAVE of this session ended, and when.
    pub save: Option<(SaveEnd, Moment)>,
    /// The files of this hand; none where nothing is kept.
    pub files: Option<Backups>,
    /// What this program saved last.
    pub known: Known,
    /// Why that could not be read.
    pub unreadable: Option<FileError>,
    /// Backups, oldest first.
    pub backups: Vec<Backup>,
    /// A file that is compared with the hand.
    pub compared: Option<Compared>,
    /// Why the last file was not opened.
    pub file_refused: Option<NoticeKind>,
    /// What is saved once the running apply is over, and with which dangers.
    pub(crate) save_next: Option<Vec<Danger>>,
    /// What runs.
    pub(crate) task: Option<Running<ParamStep, ParamsEnd>>,
    /// The files are being read.
    pub(crate) listing: Option<BackgroundJob<FilesRead>>,
    /// The hand whose files were looked at last.
    pub(crate) listed: Option<Endpoint>,
    /// A file that is looked at is being chosen and read.
    pub(crate) opening: Option<BackgroundJob<Result<(PathBuf, ParamsFile), NoticeKind>>>,
}

impl ParamsState {
    /// Nothing is known of the rows of the next connection.
    pub(crate) fn at_next_connection(self) -> Self {
        Self {
            listed: self.listed,
            ..Self::default()
        }
    }

    /// Why the rows cannot be read now.
    pub fn read_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        if link.state.is_live() {
            self.is_busy().then_some(ParamRefusal::Busy)
        } else {
            Some(ParamRefusal::NoHand)
        }
    }

    /// Why nothing that is kept may be written now.
    pub fn write_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let busy = || self.is_busy().then_some(ParamRefusal::Busy);
        rest_refusal(link).or_else(busy)
    }

    /// Why what is staged cannot be applied now.
    pub fn apply_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let nothing = self.to_apply().is_empty();
        self.write_refusal(link)
            .or_else(|| nothing.then_some(ParamRefusal::NothingStaged))
    }

    /// Why the last apply cannot be undone now.
    pub fn undo_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        let nothing = self.undo.is_empty();
        self.write_refusal(link)
            .or_else(|| nothing.then_some(ParamRefusal::NothingToUndo))
    }

    /// Why the hand's parameters cannot be written to its flash now.
    pub fn save_refusal(&self, link: &LinkStatus) -> Option<ParamRefusal> {
        self.save_refusal_with(&Params::default(), link)
    }

    /// The same where these values are staged first.
    pub fn save_refusal_with(&self, more: &Params, link: &LinkStatus) -> Option<ParamRefusal> {
        // A SAVE whose result is in doubt may be tried again, and what was never saved here may be elsewhere than in flash.
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

    /// How fresh a row's value is, on a link that is live or not.
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

    /// What was read last, if anything was on this connection, and when.
    pub fn live(&self, id: ParamId) -> Option<(Value, Moment)> {
        self.live.get(&id).copied()
    }

    /// All that was read.
    pub fn live_params(&self) -> Params {
        let mut params = Params::default();
        for (id, (value, _)) in &self.live {
            params.put(*id, *value);
        }
        params
    }

    /// Takes what a recording says was read.
    pub(crate) fn take_recorded(&mut self, params: &Params, at: Moment) {
        let known = |id: ParamId| Some((id, (params.get(id)?, at)));
        self.live = ParamId::all().into_iter().filter_map(known).collect();
    }

    /// The staged value of a row, if there is one.
    pub fn staged(&self, id: ParamId) -> Option<Value> {
        self.staged.get(id)
    }

    /// All that is staged.
    pub const fn all_staged(&self) -> &Params {
        &self.staged
    }

    /// What Apply would write. Rows that decide where the hand answers are changed in a dialog instead.
    pub fn to_apply(&self) -> Params {
        self.staged.only(|id| !id.is_place())
    }

    /// What a SAVE makes last: what the hand holds, with what is staged.
    pub fn to_save(&self) -> Params {
        self.live_params().with(&self.to_apply())
    }

    /// What the hand wakes up with as far as this program knows: what it saved last, else what it read first. Of rows that
    /// were never read it is what the hand holds.
    pub fn before_changes(&self, holds: &Params) -> Params {
        let saved = self.known.saved.as_ref().map(|file| &file.params);
        let read = holds.with(&self.first);
        saved.map_or_else(|| read.clone(), |saved| read.with(saved))
    }

    /// The rows that a SAVE would change for the next power-up, as far as this program knows.
    pub fn unsaved(&self) -> Vec<ParamDifference> {
        let before = self.before_changes(&self.live_params());
        before.differences(&self.to_save())
    }

    /// The joints that would wake up hitting harder than before, or harder at once.
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

    /// What this program saved last.
    pub fn saved(&self, id: ParamId) -> Option<Value> {
        self.known.saved.as_ref()?.params.get(id)
    }

    /// Outcome of the last write of a row.
    pub fn outcome(&self, id: ParamId) -> Option<&RowOutcome> {
        self.outcomes.get(&id)
    }

    /// True while something is running.
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

    /// Notes that the user looks at the rows. True if they should now be read: when the view is opened, and when a hand is found
    /// while it is open.
    pub(crate) fn look(&mut self, now: Moment) -> bool {
        let before = self.looked_at.replace(now);
        let comes = before.is_none_or(|at| now.since(at) > LOOKED_AWAY);
        !self.is_asked || comes && self.is_due(now)
    }

    /// True if the rows are worth reading again.
    pub fn is_due(&self, now: Moment) -> bool {
        let lost = self.lost_at;
        let young = |at: Moment| now.since(at) < REREAD_DELAY && lost.is_none_or(|lost| lost < at);
        !self.is_asked || !self.read_at.is_some_and(young)
    }

    /// Stages a value, or drops it. Values that may not be written are not staged.
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

    /// Takes values that were read.
    pub(crate) fn take(&mut self, span: Span, bytes: &[u8], at: Moment) {
        let mut read = Params::default();
        read.take(span, bytes);
        for (id, value) in read.iter() {
            if self.first.get(id).is_none() {
                self.first.put(id, value);
            }
            self.live.insert(id, (value, at));
        }
    }

    /// Takes the outcome of writing a row. A row that the hand refused, dropped or took otherwise shows the hand's value
    /// again; one of which nothing is known stays staged and is not known any more.
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

    /// True if all that was staged is in force.
    pub(crate) fn is_applied(&self) -> bool {
        let mut ends = self.outcomes.values();
        self.to_apply().is_empty() && ends.all(|end| end.verdict == RowVerdict::Applied)
    }

    /// True while a SAVE is under way.
    pub fn is_saving(&self) -> bool {
        self.doing == Doing::Saving
    }

    /// When the hand comes back it may be another one, or have been switched off: earlier readings are old.
    pub(crate) const fn link_lost(&mut self, now: Moment) {
        self.lost_at = Some(now);
        self.is_asked = false;
    }
}

/// One thing that the user asks for.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ParamAction {
    /// Read all rows. Writes nothing.
    Read,
    /// Write the staged rows, except those that decide where the hand answers, and read them back.
    Apply,
    /// Put back what the last apply changed, in the same way.
    Undo,
    /// Write the hand's parameters to its flash, after a backup.
    Save,
    /// Stage these values and ask for the same. Declined, they are not staged any more.
    SaveWith(Params),
    /// Confirm: go on in spite of the dangers shown.
    Agree,
    /// Decline: nothing is written.
    Decline,
    /// Stage the hand's current speeds and forces as the defaults after power-up. Writes nothing.
    CopyLive,
    /// Drop everything that is staged.
    UnstageAll,
    /// Ask for a path, and write a parameter file there.
    Dump,
    /// Compare a parameter file with the hand: a backup or one whose path was typed, else one that is asked for. Writes nothing.
    Open(Option<PathBuf>),
    /// Tick a row of the file, or not.
    Tick(ParamId),
    /// Stage the rows that are ticked. Writes nothing.
    StageTicked,
    CloseFile,
}

/// Why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamRefusal {
    /// No hand answers.
    NoHand,
    /// Setpoints pass.
    Armed,
    /// A stop is being confirmed.
    Holding,
    /// A joint moves.
    Moving,
    /// Whether the hand rests is not known.
    RestUnknown,
    /// Something is under way.
    Busy,
    /// Nothing is staged that can be applied.
    NothingStaged,
    /// The last apply changed nothing, or there was none.
    NothingToUndo,
    /// The hand holds what was saved last.
    NothingToSave,
    /// There is no folder for the backup.
    NoFolder,
    /// No row was read.
    NothingRead,
}

/// Why nothing may be done now that needs a hand that is there, disarmed and at rest.
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

/// A file that is compared with the hand.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    pub name: String,
    /// What it holds.
    pub file: ParamsFile,
    ticked: BTreeSet<ParamId>,
}

impl Compared {
    /// Ticks the rows in which the hand differs. A row that says where a hand is found belongs to one hand, so only the user ticks it.
    pub fn new(name: String, file: ParamsFile, live: &Params) -> Self {
        let differ = live.differences(&file.params).into_iter();
        let ticked = differ.map(|row| row.id).filter(|id| !id.is_place());
        Self {
            ticked: ticked.collect(),
            name,
            file,
        }
    }

    /// Whether a row is ticked.
    pub fn is_ticked(&self, id: ParamId) -> bool {
        self.ticked.contains(&id)
    }

    /// Ticks a row that the file holds, or takes the tick away.
    pub fn tick(&mut self, id: ParamId) {
        if self.file.params.get(id).is_some() && !self.ticked.remove(&id) {
            self.ticked.insert(id);
        }
    }

    /// The rows that are ticked.
    pub fn chosen(&self) -> Params {
        self.file.params.only(|id| self.is_ticked(id))
    }
}

/// How a task ended.
#[derive(Debug)]
pub(crate) enum ParamsEnd {
    Read(ReadRows),
    Applied(Params, Result<Applied, TaskError>),
    Saved(Result<SaveReport, TaskError>),
}

/// What the files of a hand hold.
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
