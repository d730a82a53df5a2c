//! Everything the window shows, as plain values. Changed only by the program; draws and opens nothing.

use crate::app::exhibit::ExhibitState;
use crate::app::fleet::FleetState;
use crate::app::hand::Hand;
use crate::app::hand::list::HandList;
use crate::app::notices::Notices;
use crate::app::poses::PoseState;
use crate::app::recordings::{BesideRecording, RecordingsState, Timeline};
use crate::app::scan::ScanState;
use crate::app::settings::Settings;
use crate::app::trials::TrialsState;
use crate::hand::Moment;
use crate::transport::PortFound;

/// Unsaved work that closing the window would lose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LeaveQuestion {
    /// A running series of trials, which would end.
    pub series: bool,
    /// Staged values that were not applied.
    pub edits: usize,
}

impl LeaveQuestion {
    /// Question about the work of these hands; `None` if closing would lose nothing.
    pub(crate) fn of(hands: &HandList) -> Option<Self> {
        let series = hands.iter().any(Hand::runs_series);
        let staged = |hand: &Hand| hand.params.all_staged().iter().count();
        let edits = hands.iter().map(staged).sum();
        (series || edits > 0).then_some(Self { series, edits })
    }
}

/// Everything the window shows.
#[derive(Debug, Default)]
pub struct State {
    /// Time of this frame.
    pub now: Moment,
    /// Hands. There is always one, connected or not.
    pub hands: HandList,
    /// Notices for the user.
    pub notices: Notices,
    /// The user's own poses and sequences.
    pub poses: PoseState,
    /// Grasp trials: the plan, and the sessions.
    pub trials: TrialsState,
    /// Serial ports found by the last search.
    pub ports: Vec<PortFound>,
    /// The newest scan for hands.
    pub scan: ScanState,
    /// Hands that other instances of Handscope share.
    pub fleet: FleetState,
    /// Recordings.
    pub recordings: RecordingsState,
    /// Question shown after an attempt to close the window while work would be lost.
    pub leave: Option<LeaveQuestion>,
    /// Exhibition shown in place of the window.
    pub exhibit: Option<ExhibitState>,
    /// Timeline of the replayed recording; `None` while hands are live.
    pub timeline: Option<Timeline>,
    /// A second recording, drawn over the replayed one.
    pub beside: Option<BesideRecording>,
    /// Persistent settings.
    pub settings: Settings,
}

impl State {
    /// The shown hand.
    pub fn hand(&self) -> &Hand {
        self.hands.shown()
    }

    /// The shown hand, mutable.
    pub fn hand_mut(&mut self) -> &mut Hand {
        self.hands.shown_mut()
    }
}
