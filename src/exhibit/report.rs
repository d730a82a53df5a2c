//! What happened at an exhibition on one day, counted.

use crate::exhibit::run::ExhibitEvent;
use crate::hand::PerDof;

use std::collections::BTreeMap;

/// The format that such a file names.
pub const FORMAT: &str = "handscope-exhibit-day";

/// One day of an exhibition.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DayReport {
    /// `2026-11-21`, in universal time.
    pub day: String,
    /// Visitors that played.
    pub visits: u64,
    /// How often visitors started each piece, by its name.
    pub pieces: BTreeMap<String, u64>,
    /// How often drives reported each fault, by its name.
    pub faults: BTreeMap<String, u64>,
    /// Rests for heat.
    pub rests: u64,
    /// Presses of STOP.
    pub stops: u64,
    /// Lost links.
    pub link_losses: u64,
    /// The highest temperature of each drive in each hour, 0 to 23, °C.
    pub hottest: BTreeMap<u8, PerDof<Option<u8>>>,
}

impl DayReport {
    /// Counts something.
    pub fn count(&mut self, event: &ExhibitEvent) {
        match event {
            ExhibitEvent::Visit => self.visits += 1,
            ExhibitEvent::Piece(name) => *self.pieces.entry(name.clone()).or_default() += 1,
            ExhibitEvent::Fault(fault) => {
                *self.faults.entry(fault.name().into()).or_default() += 1;
            }
            ExhibitEvent::Rest => self.rests += 1,
            ExhibitEvent::Stop => self.stops += 1,
            ExhibitEvent::LinkLost => self.link_losses += 1,
        }
    }
}
