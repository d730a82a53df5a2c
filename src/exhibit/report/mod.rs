//! What happened at an exhibition on one day, counted; its file and its page.

pub mod file;
pub mod page;

#[cfg(test)]
mod tests;

use crate::exhibit::run::ExhibitEvent;
use crate::hand::{HandSample, Moment, PerDof};

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// A temperature older than this belongs to no hour.
const MAX_AGE: Duration = Duration::from_secs(5);

/// One day of an exhibition.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DayReport {
    /// `2026-11-21`, in universal time.
    pub day: String,
    /// The hands that were shown, by their URLs.
    pub hands: BTreeSet<String>,
    /// Visitors that played.
    pub visits: u32,
    /// How often visitors started each piece, by its name.
    pub pieces: BTreeMap<String, u32>,
    /// How often drives reported each fault, by its name.
    pub faults: BTreeMap<String, u32>,
    /// Rests for heat.
    pub rests: u32,
    /// Presses of STOP.
    pub stops: u32,
    /// Lost links.
    pub link_losses: u32,
    /// The highest temperature of each drive in each hour, 0 to 23, °C; `None` where none was read.
    pub hottest: BTreeMap<u8, PerDof<Option<u8>>>,
}

impl DayReport {
    /// A day on which nothing happened yet.
    pub fn of(day: &str) -> Self {
        Self {
            day: day.into(),
            ..Self::default()
        }
    }

    /// Counts something.
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

    /// Takes in how warm the drives are in this hour. What is old, or what the manual does not know, is left out.
    pub fn warm(&mut self, sample: &HandSample, hour: u8, now: Moment) {
        let Some(read) = sample.temperature else {
            return;
        };
        let known = read.value.map(|celsius| celsius.documented());
        if read.age(now) <= MAX_AGE && known.iter().any(|(_, one)| one.is_some()) {
            self.hotter(hour, known);
        }
    }

    /// Adds what was counted earlier on the same day.
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
            // Nothing is less than any temperature.
            highest[dof] = highest[dof].max(*celsius);
        }
    }
}
