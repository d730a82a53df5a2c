//! What moves the hand now, so that every view can tell it.

use crate::app::hand::RecordedMover;
use crate::app::hands::Hand;
use crate::app::procedures::Procedure;
use crate::app::readings::Freshness;
use crate::hand::{Gesture, Moment};
use crate::link::{LinkStatus, Owner};
use crate::poses::library::EntryId;
use crate::record::{Hold, LinkState, Rest};

/// What moves the hand now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// Stop was pressed; feedback does not show rest yet.
    Stop,
    /// A calibration of its force sensors.
    Calibration,
    /// A series of trials: the trial, and how many there are.
    Series(usize, usize),
    /// A check-up: its step, and how many there are.
    Checkup(usize, usize),
    /// An entry of the library that is played, and its step, 0 the first.
    Playing(EntryId, usize),
    /// A stored gesture.
    Gesture(Gesture),
    /// Another than this window, which the user let.
    Outside(Owner),
    /// Setpoints of the user.
    Setpoints,
    /// A task of this program that a recording does not name.
    Task,
    /// An exhibition, in a recording.
    Exhibition,
    /// In a recording: nobody that it names.
    Unrecorded,
    /// Nothing that this program asked for.
    Unknown,
}

impl Mover {
    /// What moves a hand now; `None` while it rests and nothing is about to move it, or nothing is known of it.
    pub fn of(hand: &Hand, now: Moment) -> Option<Self> {
        let connection = &hand.connection;
        let link = &connection.status;
        if !link.state.is_live() {
            return None;
        }
        if link.state == LinkState::Holding || matches!(link.hold, Hold::Asked { .. }) {
            return Some(Self::Stop);
        }
        if let Some(Procedure::Calibrate(card)) = &hand.procedures.card
            && card.stage.is_doing()
        {
            return Some(Self::Calibration);
        }
        if let Some(owner) = connection.outside_owner() {
            return Some(Self::Outside(owner));
        }
        if let Some(then) = hand.recorded {
            return recorded_mover(then, link);
        }
        if let Some(run) = hand.running.series() {
            return Some(Self::Series(run.view.number, run.view.total));
        }
        if let Some(run) = hand.running.checkup_run() {
            return Some(Self::Checkup(run.view.done + 1, run.view.total));
        }
        if let Some(run) = hand.running.sequence().filter(|run| run.is_running()) {
            return Some(Self::Playing(run.entry, run.view.at));
        }
        if link.rest != Rest::Moving || connection.commanded && came_to_rest(hand, now) {
            return None;
        }
        // A gesture lets all sliders follow the hand; whatever else is sent takes its own joints from it.
        let gesture = hand.controls.gesture;
        let gesture = gesture.filter(|_| hand.controls.all_follow());
        let is_other = link.foreign_setpoint.is_some() && link.armed.is_none();
        Some(match gesture {
            // What another controller wrote last counts, where this window may send nothing any more.
            _ if !connection.commanded || is_other => Self::Unknown,
            Some(gesture) => Self::Gesture(gesture),
            None => Self::Setpoints,
        })
    }
}

/// What moved the hand of a recording, as far as that tells.
fn recorded_mover(then: RecordedMover, link: &LinkStatus) -> Option<Mover> {
    if let Some((number, of)) = then.trial {
        return Some(Mover::Series(number, of));
    }
    (link.rest == Rest::Moving).then(|| match link.holder.map(|holder| holder.owner) {
        Some(Owner::Person) => Mover::Setpoints,
        Some(Owner::Task) => Mover::Task,
        Some(Owner::Exhibition) => Mover::Exhibition,
        Some(owner) => Mover::Outside(owner),
        None => Mover::Unrecorded,
    })
}

/// True if nothing moves the hand for certain, and nothing may: a hand that was never heard does not count as one.
pub fn rests(hand: &Hand, now: Moment) -> bool {
    let link = &hand.connection.status;
    if !link.state.is_live() {
        return hand.readings.sample.angle.is_none();
    }
    let armed = hand.connection.is_armed() || link.armed.is_some();
    !armed && link.rest == Rest::Resting && Mover::of(hand, now).is_none()
}

/// True if no setpoint passes any more and each drive says that it stopped: the link tells rest a second later, as a
/// hand acts late.
fn came_to_rest(hand: &Hand, now: Moment) -> bool {
    let status = hand.readings.sample.status;
    let Some(status) = status.filter(|_| hand.connection.status.armed.is_none()) else {
        return false;
    };
    let is_live = hand.connection.is_live();
    let is_live = hand.readings.freshness(Some(status.asked), is_live, now) == Freshness::Live;
    is_live && status.value.iter().all(|(_, status)| status.is_stopped())
}
