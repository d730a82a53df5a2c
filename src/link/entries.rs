//! All events of a link, as the entries of a session: its records, its wire traffic, and its status. Files and live
//! viewers use the same entries.

use crate::hand::Moment;
use crate::link::{Clock, LinkObserver, LinkStatus};
use crate::record::file::recorder::RecorderInput;
use crate::record::{Entry, LinkReport};
use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::{Interval, MissedTickBehavior, interval};

/// Interval at which the traffic and the link's state are polled.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// In virtual time the recorder is awaited after this many entries: far fewer than its queue holds, and about a second
/// of one hand.
const SYNC_ENTRIES: usize = 2048;
/// Interval at which the link's statistics are reported.
const FIGURES_INTERVAL: Duration = Duration::from_secs(1);

/// The entries of one link, from the moment it was observed.
#[derive(Debug)]
pub struct LinkEntries {
    observed: LinkObserver,
    clock: Clock,
    tick: Interval,
    /// Entries from the last poll that were not returned yet: at most as many as the tap holds.
    ready: VecDeque<Entry>,
    is_over: bool,
    next_piece: u64,
    lost_records: u64,
    missed: u64,
    figures_at: Option<Moment>,
    /// The status as last reported.
    status: Option<LinkStatus>,
}

impl LinkEntries {
    /// Entries of this link. Must be called within a tokio runtime.
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

    /// The next entry. `None` once the link's session has ended and all its entries were returned.
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
                        self.collect();
                        self.is_over = true;
                    }
                },
                _ = self.tick.tick() => self.collect(),
            }
        }
    }

    /// Number of entries lost since the last call, because this reader was too slow.
    pub fn take_missed(&mut self) -> u64 {
        std::mem::take(&mut self.missed)
    }

    fn collect(&mut self) {
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

    /// Reports the status when it changed, and the statistics once per second.
    fn report(&mut self) -> Option<LinkReport> {
        let now = self.clock.now();
        // A closed link has nothing new, but its last status may not have been reported.
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

/// Records all entries until the link's session ends. In virtual time, which passes as fast as the computer can, the
/// recorder keeps up; in real time nothing waits for it.
pub async fn record(observed: LinkObserver, input: RecorderInput, clock: Clock) {
    let mut entries = LinkEntries::new(observed, clock);
    let mut given = 0_usize;
    while let Some(entry) = entries.next().await {
        report_missed(&mut entries, &input);
        given = given.wrapping_add(1);
        if clock.is_virtual() && given.is_multiple_of(SYNC_ENTRIES) {
            input.push_in_step(entry);
        } else {
            input.push(entry);
        }
    }
    report_missed(&mut entries, &input);
}

fn report_missed(entries: &mut LinkEntries, input: &RecorderInput) {
    let missed = entries.take_missed();
    if missed > 0 {
        input.missed(missed);
    }
}
