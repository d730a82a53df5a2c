//! Stage of an exhibition as its page shows it, user input, and the events of the day's report.

use crate::hand::grip::Tightened;
use crate::hand::{Fault, Moment};
use std::time::Duration;

/// The hand is held if the page was not drawn for this long: it may show no STOP.
pub const DRAWN_TIMEOUT: Duration = Duration::from_secs(1);
/// A tile that is held this long arms again, if visitors may do that.
pub const HOLD_DURATION: Duration = Duration::from_secs(2);

/// Reason for a halt: the hand does not move until staff arm it, or a visitor holds a tile if that is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HaltReason {
    /// Staff have not armed it yet, or have disarmed it.
    NotArmed,
    /// No hand answers.
    NoHand,
    /// The hand answers again after a lost link.
    LinkLost,
    /// Feedback is too old, or frozen while motion is commanded.
    NoFeedback,
    /// STOP was pressed.
    Stopped,
    /// A fault that only the user can clear, or too many faults.
    Fault,
    /// Another controller writes to the hand.
    OtherController,
    /// This computer was suspended.
    Slept,
    /// The page was not drawn for a while, so STOP could not be seen or pressed.
    NotShown,
}

/// Stage of an exhibition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitStage {
    /// Nothing moves, and nothing may.
    Halted(HaltReason),
    /// No visitor; the hand is open, or opens.
    Idle,
    /// No visitor; the hand plays the attract loop.
    Attract,
    /// A visitor plays, until this time at most.
    Visit {
        /// End of the visit.
        until: Moment,
    },
    /// A visit ended; the next one may begin at this time.
    NextVisitor { at: Moment },
    /// The hand cools down open, until about this time.
    Cooling {
        /// Estimated end.
        until: Moment,
    },
    /// A temperature is unknown, so nothing is played.
    HeatUnknown,
    /// A fault is being cleared.
    Clearing,
}

/// A piece in which the hand holds what a visitor gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ExhibitHold {
    /// False before the hand holds something.
    pub is_held: bool,
    /// The allowed force does not suffice.
    pub is_short: bool,
    /// Mean force of the fingers that hold, g.
    pub force_g: Option<i16>,
    /// Number of times that a finger pressed harder.
    pub tightened: u32,
    /// The last finger that did, and why.
    pub last: Option<Tightened>,
}

/// State that the page shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExhibitView {
    /// Current stage.
    pub stage: ExhibitStage,
    /// Tile that is played.
    pub tile: Option<usize>,
    /// Tile that is held, and the time of the press.
    pub held: Option<(usize, Moment)>,
    /// The hand moves slowly because it is warm.
    pub is_slow: bool,
    /// What the piece holds, or will; `None` if it is not to hold anything from now on.
    pub hold: Option<ExhibitHold>,
}

impl Default for ExhibitView {
    fn default() -> Self {
        Self {
            stage: ExhibitStage::Halted(HaltReason::NoHand),
            tile: None,
            held: None,
            is_slow: false,
            hold: None,
        }
    }
}

/// User input of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitWish {
    /// Touches the page anywhere.
    Touch,
    /// Presses a tile.
    Press(usize),
    /// Releases a tile.
    Release,
    /// Stops the hand.
    Stop,
    /// Staff, with the PIN: arms for the exhibition.
    Arm,
    /// Staff, with the PIN: disarms the exhibition.
    Disarm,
}

/// Events that the day's report counts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExhibitEvent {
    /// A visit began.
    Visit,
    /// A visitor started a piece of this name.
    Piece(String),
    /// A drive reported this fault.
    Fault(Fault),
    /// The hand had to cool down.
    Rest,
    /// STOP was pressed.
    Stop,
    LinkLost,
}
