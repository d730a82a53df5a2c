//! Everything that happens at a link, as the entries of a session: what it tells, what goes over the wire, and where it stands.
//! A file and live viewers take the same.

use crate::hand::Moment;
use crate::link::{Clock, LinkObserver, LinkStatus};
use crate::record::{Entry, LinkReport};
use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::{Interval, MissedTickBehavior, interval};

/// How often the wire and the state of the link are looked at.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// How often the link's figures are told.
const FIGURES_INTERVAL: Duration = Duration::from_secs(1);

/// The entries of one link, from the moment on at which it was observed.
#[derive(Debug)]
pub struct LinkEntries {
    observed: LinkObserver,
    clock: Clock,
    tick: Interval,
    /// What was seen at the last look and not yet taken: at most what the tap holds.
    ready: VecDeque<Entry>,
    is_over: bool,
    next_piece: u64,
    lost_records: u64,
    missed: u64,
    figures_at: Option<Moment>,
    /// As it was told last.
    status: Option<LinkStatus>,
}

impl LinkEntries {
    /// Of this link. Must be called within a tokio runtime.
    pub fn new(observed: LinkObserver, clock: Clock) -> Self {
        let mut tick = interval(POLL_INTERVAL);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        Self {
            observed,
            clock,
            tick,
            ready: VecDeque::new(),
            is_over: false,
            next_piece: 0,
            lost_records: 0,
            missed: 0,
            figures_at: None,
            status: None,
        }
    }

    /// The next entry. `None` once the link's session has ended and everything of it was taken.
    pub async fn next(&mut self) -> Option<Entry> {
        loop {
            if let Some(entry) = self.ready.pop_front() {
                return Some(entry);
            }
            if self.is_over {
                return None;
            }
            tokio::select! {
                record = self.observed.records.next() => match record {
                    Some(record) => return Some(Entry::Heard(record)),
                    None => {
                        self.look();
                        self.is_over = true;
                    }
                },
                _ = self.tick.tick() => self.look(),
            }
        }
    }

    /// Entries that were lost, because this reader was too slow, since it was asked last.
    pub fn take_missed(&mut self) -> u64 {
        std::mem::take(&mut self.missed)
    }

    fn look(&mut self) {
        let lost = self.observed.records.lost();
        self.missed += lost - self.lost_records;
        self.lost_records = lost;
        loop {
            let got = self.observed.tap.after(self.next_piece);
            self.next_piece = got.next;
            self.missed += got.lost;
            self.ready.extend(got.pieces.into_iter().map(Entry::Wire));
            if !got.more {
                break;
            }
        }
        let report = self.report();
        self.ready.extend(report.map(Entry::Link));
    }

    /// The status when it changed, the figures once a second.
    fn report(&mut self) -> Option<LinkReport> {
        let now = self.clock.now();
        // A link that is closed tells nothing new, and its last status may not have been seen.
        let may_be_new =
            self.observed.status.has_changed().unwrap_or(true) || self.status.is_none();
        let mut text = String::new();
        if may_be_new {
            let status = self.observed.status.borrow_and_update().clone();
            if self.status.as_ref() != Some(&status) {
                text = json(&status);
                self.status = Some(status);
            }
        }
        let is_due = self
            .figures_at
            .is_none_or(|at| now.since(at) >= FIGURES_INTERVAL);
        if text.is_empty() && !is_due {
            return None;
        }
        let mut figures = String::new();
        if is_due {
            self.figures_at = Some(now);
            figures = json(&*self.observed.stats.borrow());
        }
        let status = self.status.as_ref()?;
        let trouble = status.trouble.as_ref().map(ToString::to_string);
        Some(LinkReport {
            at: now,
            state: status.state,
            trouble: trouble.unwrap_or_default(),
            status: text,
            figures,
        })
    }
}

fn json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
