//! What is known of the rows that a hand keeps: read back, staged, saved, and what came of the last writes. Sends nothing.

use crate::app::device::compared::Compared;
use crate::app::params::danger::Danger;
use crate::app::params::file::ParamsFileError;
use crate::app::params::plan::{RowEnd, RowVerdict};
use crate::app::params::record::{Backup, Known};
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::Params;
use crate::app::state::{Freshness, State};
use crate::hand::{Moment, Span};
use crate::link::{RequestError, Saved};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

/// A value read this long ago may have been changed by somebody else meanwhile; it is shown as old.
pub const OLD_AFTER: Duration = Duration::from_secs(60);
/// A person who goes from view to view does not make the hand read the same again so soon.
pub const READ_AGAIN_AFTER: Duration = Duration::from_secs(2);

/// Whoever did not look for so long comes to look anew.
const LOOKED_AWAY: Duration = Duration::from_millis(500);

/// What is being done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Doing {
    /// Nothing.
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

/// What waits for a person's yes.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// What would be done.
    pub what: Wanted,
    /// Why it is asked.
    pub dangers: Vec<Danger>,
}

/// What a person wants written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Wanted {
    /// These rows, into the hand's memory.
    Apply(Params),
    /// What the hand holds, into its flash.
    Save,
}

/// How a SAVE ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SaveEnd {
    /// By what the hand said, or did not say.
    Told(Saved),
    /// The backup or the note could not be written: no SAVE was sent.
    NoBackup {
        /// The system's words.
        message: String,
    },
    /// There was no hand any more: no SAVE was sent.
    NotAsked(RequestError),
    /// It ended so, and this could not be noted.
    NotNoted(Saved, String),
}

/// What the Device view shows.
#[derive(Debug, Clone, Default)]
pub struct DeviceBook {
    live: BTreeMap<ParamId, (Value, Moment)>,
    staged: Params,
    ends: BTreeMap<ParamId, RowEnd>,
    /// When all rows were read last.
    pub read_at: Option<Moment>,
    /// Whether a reading was begun since the hand was found.
    pub(crate) is_asked: bool,
    lost_at: Option<Moment>,
    looked_at: Option<Moment>,
    /// What is being done.
    pub doing: Doing,
    /// Why the last reading is not whole.
    pub trouble: Option<RequestError>,
    /// What waits for a person's yes.
    pub question: Option<Question>,
    /// What to stage and apply so that the last apply is undone.
    pub undo: Params,
    /// How the last SAVE of this session ended, and when.
    pub save: Option<(SaveEnd, Moment)>,
    /// Where the record of this hand lies; none where nothing is kept.
    pub folder: Option<PathBuf>,
    /// What this program saved last.
    pub known: Known,
    /// Why that could not be read.
    pub unreadable: Option<ParamsFileError>,
    /// Backups, oldest first.
    pub backups: Vec<Backup>,
    /// A file that is looked at.
    pub compared: Option<Compared>,
}

impl DeviceBook {
    /// What was read last, if anything was on this connection, and when.
    #[must_use]
    pub fn live(&self, id: ParamId) -> Option<(Value, Moment)> {
        self.live.get(&id).copied()
    }

    /// All that was read.
    #[must_use]
    pub fn live_params(&self) -> Params {
        let mut params = Params::default();
        for (id, (value, _)) in &self.live {
            params.put(*id, *value);
        }
        params
    }

    /// What a person wants a row to hold; none where nothing is staged.
    #[must_use]
    pub fn staged(&self, id: ParamId) -> Option<Value> {
        self.staged.get(id)
    }

    /// All that is staged.
    #[must_use]
    pub const fn all_staged(&self) -> &Params {
        &self.staged
    }

    /// What Apply would write: rows that say where the hand is found go another way.
    #[must_use]
    pub fn to_apply(&self) -> Params {
        self.staged.only(|id| !id.is_place())
    }

    /// What this program saved last.
    #[must_use]
    pub fn saved(&self, id: ParamId) -> Option<Value> {
        self.known.saved.as_ref()?.params.get(id)
    }

    /// What came of the last write of a row.
    #[must_use]
    pub fn end(&self, id: ParamId) -> Option<&RowEnd> {
        self.ends.get(&id)
    }

    /// True while anything is under way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.doing != Doing::Nothing
    }

    /// True if a row differs in any of what is known of it.
    #[must_use]
    pub fn differs(&self, id: ParamId) -> bool {
        let live = self.live(id).map(|(value, _)| value);
        let others = [self.staged(id), self.saved(id), id.factory()];
        let differs = |other: &Value| live.is_none_or(|live| live != *other);
        others.iter().flatten().any(differs)
    }

    /// Notes that a person looks at the rows; true if they should be read for it: when they come to look, and when a hand is found
    /// while they do.
    pub(crate) fn look(&mut self, now: Moment) -> bool {
        let before = self.looked_at.replace(now);
        let comes = before.is_none_or(|at| now.since(at) > LOOKED_AWAY);
        !self.is_asked || comes && self.is_due(now)
    }

    /// True if the rows are worth reading again.
    #[must_use]
    pub fn is_due(&self, now: Moment) -> bool {
        let young = |at: Moment| now.since(at) < READ_AGAIN_AFTER;
        !self.is_asked || !self.read_at.is_some_and(young)
    }

    /// Stages a value, or takes it back. What may not be written is not staged.
    pub(crate) fn stage(&mut self, id: ParamId, value: Option<Value>) {
        match value {
            None => self.staged.forget(id),
            Some(value) if id.allows(value) => self.staged.put(id, value),
            Some(_) => return,
        }
        self.ends.remove(&id);
    }

    pub(crate) fn unstage_all(&mut self) {
        self.staged = Params::default();
        self.ends.clear();
    }

    /// Takes what was read.
    pub(crate) fn take(&mut self, span: Span, bytes: &[u8], at: Moment) {
        let mut read = Params::default();
        read.take(span, bytes);
        for (id, value) in read.iter() {
            self.live.insert(id, (value, at));
        }
    }

    /// What came of some rows. A row that the hand refused, dropped or took otherwise shows the hand's value again; one of which nothing
    /// is known stays staged and is not known any more.
    pub(crate) fn ended(&mut self, ends: Vec<RowEnd>) {
        for end in ends {
            match end.verdict {
                RowVerdict::NotSent(_) => {}
                RowVerdict::Unverified(_) => {
                    self.live.remove(&end.id);
                }
                _ => self.staged.forget(end.id),
            }
            self.ends.insert(end.id, end);
        }
    }

    /// The files of this hand were changed by others: they are read again.
    pub(crate) fn forget_record(&mut self) {
        self.folder = None;
    }

    pub(crate) fn forget_ends(&mut self) {
        self.ends.clear();
    }

    /// Rows of which it is not known what the hand holds.
    pub(crate) fn unverified(&self) -> Vec<RowEnd> {
        let doubtful = |end: &&RowEnd| matches!(end.verdict, RowVerdict::Unverified(_));
        self.ends.values().filter(doubtful).cloned().collect()
    }

    /// The hand may be another one when it comes back, or have been switched off: what was read is old.
    pub(crate) const fn link_lost(&mut self, now: Moment) {
        self.lost_at = Some(now);
        self.is_asked = false;
    }
}

impl State {
    /// How fresh a row's value is.
    #[must_use]
    pub fn param_freshness(&self, id: ParamId) -> Freshness {
        let Some((_, at)) = self.device.live(id) else {
            return Freshness::Unknown;
        };
        let before_loss = self.device.lost_at.is_some_and(|lost| at <= lost);
        let old = self.now.since(at) > OLD_AFTER;
        match self.link.state.is_live() && !before_loss && !old {
            true => Freshness::Live,
            false => Freshness::Stale,
        }
    }
}
