//! The entries of a recording file.

use crate::hand::Moment;
use crate::record::heard::Record;
use crate::record::state::LinkState;
use crate::record::wire::Piece;

/// One entry of a recording file.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// A record from the link.
    Heard(Record),
    /// Bytes on the wire.
    Wire(Piece),
    /// State of the link.
    Link(LinkReport),
    /// Any other event.
    Event(Event),
}

impl Entry {
    /// Time at which it was received, sent, or happened.
    pub fn at(&self) -> Moment {
        match self {
            Self::Heard(record) => record.at(),
            Self::Wire(piece) => piece.at,
            Self::Link(report) => report.at,
            Self::Event(event) => event.at,
        }
    }
}

/// State of the link, recorded at each change, and with its statistics once a second.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkReport {
    pub at: Moment,
    pub state: LinkState,
    /// Reason why there was no live hand; empty if there was one.
    pub trouble: String,
    /// Its whole status, in JSON; empty if unchanged.
    pub status: String,
    /// Its statistics, in JSON; empty if not included.
    pub figures: String,
}

/// An event apart from the link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    pub at: Moment,
    pub kind: EventKind,
    /// Text; its content depends on the kind.
    pub words: String,
}

/// Kind of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// A note by the user.
    Note,
    /// The user removed a note.
    NoteRemoved,
    /// A user's action that was sent to the hand.
    Person,
    /// A grasp trial began; the text names it.
    Trial,
    /// A pose, a sequence, a demo or a hold began; the text names it: `pose Fist`.
    Play,
    /// What [`Self::Play`] named is over.
    PlayEnd,
    /// A finger of a hold pressed harder, or the hold does not suffice; the text says which.
    Hold,
    /// A setting of the program or of the hand was changed.
    Setting,
    /// The hand's stored parameters, in TOML.
    Parameters,
    /// The settings of the program, in TOML, without the window's layout.
    Settings,
    /// About the recording itself: missing entries, a changed clock.
    Recording,
    /// A drive reported a fault. Derived from the readings.
    Fault,
    /// Stop was pressed. Derived from the states of the link.
    Stop,
    /// The hand was armed. Derived.
    Armed,
    /// The hand was disarmed, other than by a stop, a fault or a lost link. Derived.
    Disarmed,
    /// The hand stopped answering. Derived.
    LinkLost,
    /// The hand answered again. Derived.
    Reconnected,
}

impl EventKind {
    /// Stable name in files.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::NoteRemoved => "note_removed",
            Self::Person => "person",
            Self::Trial => "trial",
            Self::Play => "play",
            Self::PlayEnd => "play_end",
            Self::Hold => "hold",
            Self::Setting => "setting",
            Self::Parameters => "parameters",
            Self::Settings => "settings",
            Self::Recording => "recording",
            Self::Fault => "fault",
            Self::Stop => "stop",
            Self::Armed => "armed",
            Self::Disarmed => "disarmed",
            Self::LinkLost => "link_lost",
            Self::Reconnected => "reconnected",
        }
    }

    /// Kind of a name in a file; `None` if it is unknown.
    pub fn by_key(key: &str) -> Option<Self> {
        const ALL: [EventKind; 17] = [
            EventKind::Note,
            EventKind::NoteRemoved,
            EventKind::Person,
            EventKind::Trial,
            EventKind::Play,
            EventKind::PlayEnd,
            EventKind::Hold,
            EventKind::Setting,
            EventKind::Parameters,
            EventKind::Settings,
            EventKind::Recording,
            EventKind::Fault,
            EventKind::Stop,
            EventKind::Armed,
            EventKind::Disarmed,
            EventKind::LinkLost,
            EventKind::Reconnected,
        ];
        ALL.into_iter().find(|kind| kind.key() == key)
    }

    /// True for kinds that lists of events show.
    pub const fn is_listed(self) -> bool {
        !matches!(
            self,
            Self::NoteRemoved | Self::Person | Self::Parameters | Self::Settings
        )
    }

    /// True for kinds that a reader derives from the other entries.
    pub const fn is_derived(self) -> bool {
        matches!(
            self,
            Self::Fault
                | Self::Stop
                | Self::Armed
                | Self::Disarmed
                | Self::LinkLost
                | Self::Reconnected
        )
    }
}
