//! Stage of an exhibition as its page shows it, user input, and the events of the day's report.

use crate::hand::{Fault, Moment};
use std::time::Duration;

/// A page that was not drawn for this long shows no STOP: the hand is held.
pub const DRAWN_TIMEOUT: Duration = Duration::from_secs(1);
/// A tile that is held this long arms again, where visitors may.
pub const HOLD_DURATION: Duration = Duration::from_secs(2);

/// Why the hand stands still until staff come, or a visitor holds a tile where that is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HaltReason {
    /// Nobody armed it since the program started.
    NotArmed,
    /// No hand answers.
    NoHand,
    /// It answers again, after it did not.
    LinkLost,
    /// What it told grew old, or stood still though motion was asked for.
    NoFeedback,
    /// Somebody pressed STOP.
    Stopped,
    /// A fault that only the user can end, or too many.
    Fault,
    /// Another controller talks to the hand.
    OtherController,
    /// This computer slept.
    Slept,
    /// The page was not drawn for a while: nobody could have seen or pressed STOP.
    NotShown,
}

/// What goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitStage {
    /// Nothing moves, and nothing may.
    Halted(HaltReason),
    /// Nobody is there; the hand is open, or opens.
    Idle,
    /// Nobody is there, and the hand shows what it can do.
    Attract,
    /// Somebody plays, until then at most.
    Visit {
        /// When the next one may.
        until: Moment,
    },
    /// A visitor's time is over; the next one may play then.
    NextVisitor { at: Moment },
    /// The hand rests open because it grew warm, about until then.
    Cooling {
        /// About when.
        until: Moment,
    },
    /// A temperature is unknown, so nothing is played.
    HeatUnknown,
    /// A fault is being cleared.
    Clearing,
}

/// What the page shows of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExhibitView {
    /// What goes on.
    pub stage: ExhibitStage,
    /// The tile that is played.
    pub tile: Option<usize>,
    /// The tile that is held, and since when.
    pub held: Option<(usize, Moment)>,
    /// The hand goes slowly because it is warm.
    pub is_slow: bool,
}

impl Default for ExhibitView {
    fn default() -> Self {
        Self {
            stage: ExhibitStage::Halted(HaltReason::NoHand),
            tile: None,
            held: None,
            is_slow: false,
        }
    }
}

/// What the user does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExhibitWish {
    /// Touches the page, anywhere.
    Touch,
    /// Presses a tile.
    Press(usize),
    /// Lets go.
    Release,
    /// Stops the hand.
    Stop,
    /// Staff, with the PIN: arms for the exhibition.
    Arm,
    /// Staff, with the PIN: arms no more.
    Disarm,
}

/// What the day's report counts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExhibitEvent {
    /// Somebody began to play.
    Visit,
    /// A visitor started a piece of this name.
    Piece(String),
    /// A drive reported this.
    Fault(Fault),
    /// The hand had to rest for its heat.
    Rest,
    /// Somebody pressed STOP.
    Stop,
    LinkLost,
}
