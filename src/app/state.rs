//! Everything the window shows, as plain values. Changed only by the program; draws nothing, opens nothing.

use crate::app::exhibit::ExhibitState;
use crate::app::fleet::FleetState;
use crate::app::hands::Hand;
use crate::app::hands::list::HandList;
use crate::app::notices::Notices;
use crate::app::poses::PoseState;
use crate::app::recordings::{BesideRecording, RecordingsState, Timeline};
use crate::app::scan::ScanState;
use crate::app::settings::Settings;
use crate::app::trials::TrialsState;
use crate::hand::Moment;
use crate::transport::PortFound;

/// What would be lost if the window closed now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LeaveQuestion {
    /// A series of trials runs: it would end.
    pub series: bool,
    /// Staged values that were not applied.
    pub edits: usize,
}

/// Everything the window shows.
#[derive(Debug, Default)]
pub struct State {
    /// The time of this frame.
    pub now: Moment,
    /// The hands. There is always one, connected or not.
    pub hands: HandList,
    /// What the user should read.
    pub notices: Notices,
    /// The user's own poses and sequences.
    pub poses: PoseState,
    /// Grasp trials: the plan, and the sessions.
    pub trials: TrialsState,
    /// Serial ports found when last looked.
    pub ports: Vec<PortFound>,
    /// The newest scan for hands.
    pub scan: ScanState,
    /// The hands that other Handscopes share.
    pub fleet: FleetState,
    /// Recordings.
    pub recordings: RecordingsState,
    /// What would be lost if the window closed now, once the user tried to.
    pub leave: Option<LeaveQuestion>,
    /// The exhibition that is shown in place of the window.
    pub exhibit: Option<ExhibitState>,
    /// The time line of the recording that is replayed; `None` while hands are live.
    pub timeline: Option<Timeline>,
    /// A second recording, drawn over the replayed one.
    pub beside: Option<BesideRecording>,
    /// What is kept from one start to the next.
    pub settings: Settings,
}

impl State {
    /// The hand that is shown.
    pub fn hand(&self) -> &Hand {
        self.hands.shown()
    }

    /// The same, to be changed.
    pub fn hand_mut(&mut self) -> &mut Hand {
        self.hands.shown_mut()
    }
}
