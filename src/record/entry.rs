//! What a recording file holds, one entry after the other.

use crate::hand::Moment;
use crate::record::heard::Record;
use crate::record::state::LinkState;
use crate::record::wire::Piece;

/// One entry of a recording file.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// What the link told.
    Heard(Record),
    /// What went over the wire.
    Wire(Piece),
    /// Where the link stood.
    Link(LinkReport),
    /// What else happened.
    Event(Event),
}

impl Entry {
    /// When it was received, sent, or happened.
    pub fn at(&self) -> Moment {
        match self {
            Self::Heard(record) => record.at(),
            Self::Wire(piece) => piece.at,
            Self::Link(report) => report.at,
            Self::Event(event) => event.at,
        }
    }
}

/// Where the link stood, told when that changed, and with its figures once a second.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkReport {
    pub at: Moment,
    /// Where it stood.
    pub state: LinkState,
    /// Why there was no live hand; empty if there was.
    pub trouble: String,
    /// All of its status, in JSON; empty if that did not change.
    pub status: String,
    /// Its figures, in JSON; empty if they are not told here.
    pub figures: String,
}

/// Something that happened beside the link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    pub at: Moment,
    pub kind: EventKind,
    /// In words; what they are depends on the kind.
    pub words: String,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// The user noted something.
    Note,
    /// The user took that note back.
    NoteRemoved,
    /// The user did something that was sent to the hand.
    Person,
    /// A grasp trial began; the words say which.
    Trial,
    /// A setting of the program or of the hand was changed.
    Setting,
    /// The parameters that the hand kept, in TOML.
    Parameters,
    /// The settings of the program, in TOML, without where its window stands.
    Settings,
    /// Something about the recording itself: entries that are missing, a clock that was set.
    Recording,
    /// A drive reported a fault. Derived from the readings.
    Fault,
    /// Stop was pressed. Derived from the states of the link.
    Stop,
    /// The hand was armed. Derived.
    Armed,
    /// The hand fell silent. Derived.
    LinkLost,
    /// The hand answered again. Derived.
    Reconnected,
}

impl EventKind {
    /// The stable word for it in files.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::NoteRemoved => "note_removed",
            Self::Person => "person",
            Self::Trial => "trial",
            Self::Setting => "setting",
            Self::Parameters => "parameters",
            Self::Settings => "settings",
            Self::Recording => "recording",
            Self::Fault => "fault",
            Self::Stop => "stop",
            Self::Armed => "armed",
            Self::LinkLost => "link_lost",
            Self::Reconnected => "reconnected",
        }
    }

    /// The kind of a word in a file.
    pub fn by_key(key: &str) -> Option<Self> {
        const ALL: [EventKind; 13] = [
            EventKind::Note,
            EventKind::NoteRemoved,
            EventKind::Person,
            EventKind::Trial,
            EventKind::Setting,
            EventKind::Parameters,
            EventKind::Settings,
            EventKind::Recording,
            EventKind::Fault,
            EventKind::Stop,
            EventKind::Armed,
            EventKind::LinkLost,
            EventKind::Reconnected,
        ];
        ALL.into_iter().find(|kind| kind.key() == key)
    }

    /// True for what stands in lists of what happened.
    pub const fn is_listed(self) -> bool {
        !matches!(
            self,
            Self::NoteRemoved | Self::Person | Self::Parameters | Self::Settings
        )
    }

    /// True for what a reader finds out by itself from the other entries.
    pub const fn is_derived(self) -> bool {
        matches!(
            self,
            Self::Fault | Self::Stop | Self::Armed | Self::LinkLost | Self::Reconnected
        )
    }
}
