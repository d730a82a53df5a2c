//! What a card of this kind shows, what a person may decide on it, and when it may begin. Plain values; asks nobody.

use crate::app::calibration::Calibration;
use crate::app::guard::change::Change;
use crate::app::guard::reset::FactoryReset;
use crate::app::params::danger::Danger;
use crate::app::params::guard::Place;
use crate::app::params::table::{ParamId, Value};
use crate::app::state::{Freshness, State};
use crate::hand::{HandCommand, HandId, SerialSpeed, Status};
use crate::link::LinkState;
use crate::transport::Endpoint;
use crate::transport::route::Route;
use std::path::PathBuf;

/// What a person decides on a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GuardStep {
    /// Do it.
    Begin,
    /// The hand is where it should be.
    Keep,
    /// Take it back.
    GoBack,
    /// Put it into flash.
    Save,
    /// Leave it out of flash.
    LeaveUnsaved,
    /// The card was read.
    Close,
}

/// What is done.
#[derive(Debug, Clone, PartialEq)]
pub enum Flow {
    /// A change of what the hand is found by.
    Change(Change),
    /// A return to the factory's parameters.
    Reset(FactoryReset),
    /// A calibration of the force sensors.
    Calibration(Calibration),
}

/// Where it stands before its own rules have the word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Doing {
    /// A person is asked.
    Asking,
    /// Its parameters are read and kept in a file.
    BackingUp,
    /// It is under way, or over.
    Running,
    /// No backup could be made. Nothing was written.
    NoBackup {
        /// What the link or the system says.
        why: String,
    },
}

/// The way to an address, as far as it was found out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WayTo {
    /// It is asked for.
    Asked,
    /// This.
    Known(Route),
    /// None.
    None,
}

/// What a card shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Guarded {
    /// What is done.
    pub flow: Flow,
    /// Where it stands.
    pub doing: Doing,
    /// Where the hand was.
    pub old: Endpoint,
    /// Where it will be; as old where this wire finds it by something else.
    pub new: Endpoint,
    /// The backup.
    pub backup: Option<PathBuf>,
    /// This computer's way to a new address.
    pub way: Option<WayTo>,
    /// What a SAVE would make last besides: it writes all that the hand holds.
    pub dangers: Vec<Danger>,
}

impl Guarded {
    /// The endpoint of a place.
    #[must_use]
    pub const fn endpoint(&self, place: Place) -> &Endpoint {
        match place {
            Place::Old => &self.old,
            Place::New => &self.new,
        }
    }
}

/// Why nothing may begin now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotNow {
    /// No hand answers.
    NoHand,
    /// It is armed.
    Armed,
    /// A stop is being confirmed.
    Holding,
    /// A joint moves, or nobody knows.
    Moving,
}

/// Why nothing of this kind may begin now; `None` if it may.
#[must_use]
pub fn not_now(state: &State) -> Option<NotNow> {
    let moves = |status: &Status| matches!(status, Status::Releasing | Status::Grasping);
    let fresh = |asked| state.freshness(Some(asked)) == Freshness::Live;
    match state.link.state {
        LinkState::Offline | LinkState::Identifying => return Some(NotNow::NoHand),
        LinkState::Armed => return Some(NotNow::Armed),
        LinkState::Holding => return Some(NotNow::Holding),
        LinkState::Monitoring | LinkState::Fault => {}
    }
    let rests = state
        .sample
        .status
        .is_some_and(|all| fresh(all.asked) && !all.value.iter().any(|(_, status)| moves(status)));
    (!rests).then_some(NotNow::Moving)
}

/// The command that writes a row by which a hand is found; none for other rows and for values outside the manual's ranges.
#[must_use]
pub fn command(id: ParamId, value: Value) -> Option<HandCommand> {
    match (id, value) {
        (ParamId::HandId, Value::Number(number)) => {
            HandId::new(i64::from(number)).ok().map(HandCommand::Id)
        }
        (ParamId::ReduRatio, Value::Number(number)) => {
            let mut speeds = SerialSpeed::ALL.into_iter();
            let speed = speeds.find(|speed| i32::from(speed.code()) == number);
            speed.map(HandCommand::SerialSpeed)
        }
        (ParamId::IpAddress, Value::Address(address)) => Some(HandCommand::IpAddress(address)),
        _ => None,
    }
}

/// What the hand holds in a row by which it is found: as read back last, else as it said when the link began.
pub(crate) fn held_now(state: &State, id: ParamId) -> Option<Value> {
    let told = match id {
        ParamId::HandId => state.link.quirks.hand_id,
        ParamId::ReduRatio => state.link.quirks.baud_code,
        _ => None,
    };
    let told = told.map(|byte| Value::Number(i32::from(byte)));
    let read = state.device.live(id).map(|(value, _)| value);
    read.or(told)
}
