//! Gives everything that happens on a link to a recorder: what the link tells, what goes over the wire, and where the link stands.

use crate::hand::Moment;
use crate::link::{Clock, LinkObserver};
use crate::record::file::recorder::RecorderInput;
use crate::record::{Entry, LinkReport};
use serde::Serialize;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// How often the wire and the state of the link are looked at.
const LOOK_EACH: Duration = Duration::from_millis(50);
/// How often the link's figures are recorded.
const FIGURES_EACH: Duration = Duration::from_secs(1);

/// Records until the link's session ends, and what was left then.
pub async fn record(observed: LinkObserver, input: RecorderInput, clock: Clock) {
    Pump {
        observed,
        input,
        clock,
        next_piece: 0,
        lost: 0,
        figures_at: None,
        status: String::new(),
    }
    .run()
    .await;
}

struct Pump {
    observed: LinkObserver,
    input: RecorderInput,
    clock: Clock,
    next_piece: u64,
    lost: u64,
    figures_at: Option<Moment>,
    status: String,
}

impl Pump {
    async fn run(mut self) {
        let mut tick = interval(LOOK_EACH);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                record = self.observed.records.next() => match record {
                    Some(record) => self.input.push(Entry::Heard(record)),
                    None => break,
                },
                _ = tick.tick() => self.look(),
            }
        }
        self.look();
    }

    fn look(&mut self) {
        let lost = self.observed.records.lost();
        self.missed(lost - self.lost);
        self.lost = lost;
        loop {
            let got = self.observed.tap.after(self.next_piece);
            self.next_piece = got.next;
            self.missed(got.lost);
            for piece in got.pieces {
                self.input.push(Entry::Wire(piece));
            }
            if !got.more {
                break;
            }
        }
        self.tell_link();
    }

    fn missed(&self, entries: u64) {
        if entries > 0 {
            self.input.missed(entries);
        }
    }

    /// The status when it changed, the figures once a second.
    fn tell_link(&mut self) {
        let now = self.clock.now();
        let status = self.observed.status.borrow().clone();
        let mut text = json(&status);
        match text == self.status {
            true => text.clear(),
            false => self.status.clone_from(&text),
        }
        let is_due = self
            .figures_at
            .is_none_or(|at| now.since(at) >= FIGURES_EACH);
        if text.is_empty() && !is_due {
            return;
        }
        let mut figures = String::new();
        if is_due {
            self.figures_at = Some(now);
            figures = json(&*self.observed.stats.borrow());
        }
        let trouble = status.trouble.as_ref().map(ToString::to_string);
        self.input.push(Entry::Link(LinkReport {
            at: now,
            state: status.state,
            trouble: trouble.unwrap_or_default(),
            status: text,
            figures,
        }));
    }
}

fn json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
