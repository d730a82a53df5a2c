//! What moves the hand now, so that every view can tell it.

use crate::app::hand::{Freshness, HandState};
use crate::app::procedures::procedure::Procedure;
use crate::hand::Gesture;
use crate::link::Owner;
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
    /// An entry of the library that is played, and its step, 0 the first.
    Playing(EntryId, usize),
    /// A stored gesture.
    Gesture(Gesture),
    /// Another than this window, which a person let.
    Outside(Owner),
    /// Setpoints of a person.
    Setpoints,
    /// Nothing that this program asked for.
    Unknown,
}

impl HandState {
    /// What moves the hand now; `None` while it rests and nothing is about to move it, or nothing is known of it.
    pub fn mover(&self) -> Option<Mover> {
        if !self.link.state.is_live() {
            return None;
        }
        if self.link.state == LinkState::Holding || matches!(self.link.hold, Hold::Asked { .. }) {
            return Some(Mover::Stop);
        }
        if let Some(Procedure::Calibrate(card)) = &self.procedure
            && card.stage.is_doing()
        {
            return Some(Mover::Calibration);
        }
        if let Some(owner) = self.outside_owner() {
            return Some(Mover::Outside(owner));
        }
        if let Some(run) = &self.series {
            return Some(Mover::Series(run.view.number, run.view.total));
        }
        if let Some(run) = self.sequence.as_ref().filter(|run| run.is_running()) {
            return Some(Mover::Playing(run.entry, run.view.at));
        }
        if self.link.rest != Rest::Moving || self.commanded && self.came_to_rest() {
            return None;
        }
        // A gesture lets all sliders follow the hand; whatever else is sent takes its own joints from it.
        let follows = self.steered.iter().all(|(_, steered)| !steered);
        let gesture = self.gesture.filter(|_| follows);
        Some(match gesture {
            _ if !self.commanded => Mover::Unknown,
            Some(gesture) => Mover::Gesture(gesture),
            None => Mover::Setpoints,
        })
    }
    /// True if nothing moves the hand for certain, and nothing may: a hand that was never heard does not count as one.
    pub fn rests(&self) -> bool {
        if !self.link.state.is_live() {
            return self.sample.angle.is_none();
        }
        let armed = self.is_armed() || self.link.armed.is_some();
        !armed && self.link.rest == Rest::Resting && self.mover().is_none()
    }

    /// True if no setpoint passes any more and each drive says that it stopped: the link tells rest a second later, as a
    /// hand acts late.
    fn came_to_rest(&self) -> bool {
        let Some(status) = self.sample.status.filter(|_| self.link.armed.is_none()) else {
            return false;
        };
        let is_live = self.freshness(Some(status.asked)) == Freshness::Live;
        is_live && status.value.iter().all(|(_, status)| status.is_stopped())
    }
}
