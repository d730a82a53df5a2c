//! The current mover of a hand, for display in every view.

use crate::app::activity::RecordedMover;
use crate::app::hand::Hand;
use crate::app::procedures::Procedure;
use crate::app::readings::Freshness;
use crate::hand::{Gesture, Moment};
use crate::link::{LinkStatus, Owner};
use crate::poses::library::EntryId;
use crate::record::{Hold, LinkState, Rest};

/// Party or program that moves the hand now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// Stop was pressed; feedback does not show rest yet.
    Stop,
    /// A calibration of its force sensors.
    Calibration,
    /// A series of trials: number of the trial, and of all trials.
    Series(usize, usize),
    /// A check-up: number of the step, and of all steps.
    Checkup(usize, usize),
    /// An entry of the library, with the index of its step, from 0.
    Playing(EntryId, usize),
    /// A hold between two forces.
    Hold,
    /// A calibration with a kitchen scale.
    Scale,
    /// A stored gesture.
    Gesture(Gesture),
    /// A party outside this window, to which the user granted control.
    Outside(Owner),
    /// Setpoints of the user.
    Setpoints,
    /// In a recording: a pose, a sequence, a demo or a hold, named by [`Hand::recorded_play`].
    Recorded,
    /// A task of this program that a recording does not name.
    Task,
    /// An exhibition, in a recording.
    Exhibition,
    /// In a recording: a mover that it does not name.
    Unrecorded,
    /// Nothing that this program commanded.
    Unknown,
}

impl Mover {
    /// Current mover of a hand; `None` while it rests and no motion is pending, or its state is not known.
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
        if let Some(then) = &hand.recorded {
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
        if hand.running.holds() {
            return Some(Self::Hold);
        }
        if hand.running.calibrates() {
            return Some(Self::Scale);
        }
        if link.rest != Rest::Moving || connection.commanded && came_to_rest(hand, now) {
            return None;
        }
        // A gesture makes all sliders follow the hand; any other setpoint takes its own joints out of that.
        let gesture = hand.controls.gesture;
        let gesture = gesture.filter(|_| hand.controls.all_follow());
        let is_other = link.foreign_setpoint.is_some() && link.armed.is_none();
        Some(match gesture {
            // After a setpoint of another controller, the mover is unknown if this window may no longer send.
            _ if !connection.commanded || is_other => Self::Unknown,
            Some(gesture) => Self::Gesture(gesture),
            None => Self::Setpoints,
        })
    }
}

/// Mover of the hand of a recording, as far as the recording contains it.
fn recorded_mover(then: &RecordedMover, link: &LinkStatus) -> Option<Mover> {
    if let Some((number, of)) = then.trial {
        return Some(Mover::Series(number, of));
    }
    // It also plays while the hand presses, or waits at a pose.
    if then.playing().is_some() {
        return Some(Mover::Recorded);
    }
    (link.rest == Rest::Moving).then(|| match link.holder.map(|holder| holder.owner) {
        Some(Owner::Person) => Mover::Setpoints,
        Some(Owner::Task) => Mover::Task,
        Some(Owner::Exhibition) => Mover::Exhibition,
        Some(owner) => Mover::Outside(owner),
        None => Mover::Unrecorded,
    })
}

/// True if the hand certainly rests and nothing may move it: a hand that never answered counts as resting.
pub fn rests(hand: &Hand, now: Moment) -> bool {
    let link = &hand.connection.status;
    if !link.state.is_live() {
        return hand.readings.sample.angle.is_none();
    }
    let armed = hand.connection.is_armed() || link.armed.is_some();
    !armed && link.rest == Rest::Resting && Mover::of(hand, now).is_none()
}

/// True if no setpoint passes and each drive reports that it stopped: the link reports rest a second later, because a hand acts late.
fn came_to_rest(hand: &Hand, now: Moment) -> bool {
    let status = hand.readings.sample.status;
    let Some(status) = status.filter(|_| hand.connection.status.armed.is_none()) else {
        return false;
    };
    let is_live = hand.connection.is_live();
    let is_live = hand.readings.freshness(Some(status.asked), is_live, now) == Freshness::Live;
    is_live && status.value.iter().all(|(_, status)| status.is_stopped())
}
