//! The counts of one exhibition day, their file and their page.

pub mod file;
pub mod page;

#[cfg(test)]
mod tests;

use crate::exhibit::stage::ExhibitEvent;
use crate::hand::{HandSample, Moment, PerDof};

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// An older temperature is not assigned to an hour.
const MAX_AGE: Duration = Duration::from_secs(5);

/// One day of an exhibition.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DayReport {
    /// Date in UTC, `2026-11-21`.
    pub day: String,
    /// The hands on show, as endpoints.
    pub hands: BTreeSet<String>,
    /// Visitors who played.
    pub visits: u32,
    /// Number of starts by visitors, by name of the piece.
    pub pieces: BTreeMap<String, u32>,
    /// Number of reports by drives, by name of the fault.
    pub faults: BTreeMap<String, u32>,
    /// Rests due to heat.
    pub rests: u32,
    /// Presses of STOP.
    pub stops: u32,
    /// Lost links.
    pub link_losses: u32,
    /// Highest temperature of each drive in each hour, 0 to 23, °C; `None` without a reading.
    pub hottest: BTreeMap<u8, PerDof<Option<u8>>>,
}

impl DayReport {
    /// An empty report of this day.
    pub fn of(day: &str) -> Self {
        Self {
            day: day.into(),
            ..Self::default()
        }
    }

    /// Counts an event.
    pub fn count(&mut self, event: &ExhibitEvent) {
        let count = match event {
            ExhibitEvent::Visit => &mut self.visits,
            ExhibitEvent::Piece(name) => self.pieces.entry(name.clone()).or_default(),
            ExhibitEvent::Fault(fault) => self.faults.entry(fault.name().into()).or_default(),
            ExhibitEvent::Rest => &mut self.rests,
            ExhibitEvent::Stop => &mut self.stops,
            ExhibitEvent::LinkLost => &mut self.link_losses,
        };
        *count = count.saturating_add(1);
    }

    /// Records the drive temperatures in this hour; outdated and undocumented readings are ignored.
    pub fn warm(&mut self, sample: &HandSample, hour: u8, now: Moment) {
        let Some(read) = sample.temperature else {
            return;
        };
        let known = read.value.map(|celsius| celsius.documented());
        if read.age(now) <= MAX_AGE && known.iter().any(|(_, one)| one.is_some()) {
            self.hotter(hour, known);
        }
    }

    /// Adds the counts of an earlier report of the same day.
    pub fn add(&mut self, earlier: &Self) {
        self.hands.extend(earlier.hands.iter().cloned());
        for (count, before) in [
            (&mut self.visits, earlier.visits),
            (&mut self.rests, earlier.rests),
            (&mut self.stops, earlier.stops),
            (&mut self.link_losses, earlier.link_losses),
        ] {
            *count = count.saturating_add(before);
        }
        for (counts, before) in [
            (&mut self.pieces, &earlier.pieces),
            (&mut self.faults, &earlier.faults),
        ] {
            for (name, before) in before {
                let count = counts.entry(name.clone()).or_default();
                *count = count.saturating_add(*before);
            }
        }
        for (hour, drives) in &earlier.hottest {
            self.hotter(*hour, *drives);
        }
    }

    fn hotter(&mut self, hour: u8, drives: PerDof<Option<u8>>) {
        let highest = self.hottest.entry(hour).or_insert(PerDof::splat(None));
        for (dof, celsius) in drives.iter() {
            // `None` is less than any temperature.
            highest[dof] = highest[dof].max(*celsius);
        }
    }
}
