//! Usage of the line's time over the last second. Counts only.

use crate::hand::{Moment, RateClass, Span};
use crate::link::poll::cost::WireCost;
use crate::link::poll::plan::PollPlan;
use crate::link::poll::window::ReadPart;
use crate::link::stats::{GroupUse, LineUse};
use std::time::Duration;

/// Averaging time of the figures, and the shorter one before the first of them.
const OVER: Duration = Duration::from_secs(1);
const FIRST_OVER: Duration = Duration::from_millis(200);

/// Accumulates the usage of one line.
#[derive(Debug, Default)]
pub(crate) struct LineMeter {
    since: Option<Moment>,
    busy: Duration,
    on_wire: Duration,
    writes: Duration,
    groups: [TimeSum; RateClass::ALL.len()],
    shown: bool,
}

#[derive(Debug, Clone, Copy, Default)]
struct TimeSum {
    time: Duration,
    parts: u32,
}

impl LineMeter {
    /// Records a window that was answered after `took`: its time is divided among its groups by their bytes.
    pub(crate) fn read(&mut self, cost: &WireCost, window: Span, took: Duration) {
        let took = took + cost.gap();
        self.busy += took;
        self.on_wire += cost.on_wire(window.len);
        let held = || {
            ReadPart::ALL
                .into_iter()
                .filter(|part| window.covers(part.span()))
        };
        let bytes: u32 = held().map(|part| u32::from(part.span().len)).sum();
        for part in held() {
            if let Some(sum) = self.groups.get_mut(part.rate() as usize) {
                sum.time += took * u32::from(part.span().len) / bytes.max(1);
                sum.parts += 1;
            }
        }
    }

    /// Records a write.
    pub(crate) fn wrote(&mut self, cost: &WireCost, written: Span, took: Duration) {
        let took = took + cost.gap();
        self.busy += took;
        self.writes += took;
        self.on_wire += cost.write_on_wire(written.len);
    }

    /// Records a failed read.
    pub(crate) fn failed(&mut self, took: Duration) {
        self.busy += took;
    }

    /// The figures, once per second.
    pub(crate) fn figures(&mut self, plan: &PollPlan, now: Moment) -> Option<LineUse> {
        let since = *self.since.get_or_insert(now);
        let over = now.since(since);
        if over < if self.shown { OVER } else { FIRST_OVER } {
            return None;
        }
        let share = |time: Duration| (time.as_secs_f64() / over.as_secs_f64()).min(1.0);
        let mut groups = [GroupUse::default(); RateClass::ALL.len()];
        for ((shown, sum), group) in groups.iter_mut().zip(&self.groups).zip(RateClass::ALL) {
            let whole = f64::from(sum.parts) / f64::from(parts_of(group));
            *shown = GroupUse {
                hz: whole / over.as_secs_f64(),
                share: share(sum.time),
                could_hz: plan.could_hz(group),
            };
        }
        let line = LineUse {
            utilisation: share(self.busy),
            on_wire: plan.cost().has_speed().then(|| share(self.on_wire)),
            turnaround: plan.turnaround().typical(),
            writes: share(self.writes),
            groups,
            split: plan.gaps_are_split(),
        };
        if self.shown || over >= OVER {
            *self = Self {
                since: Some(now),
                shown: true,
                ..Self::default()
            };
        }
        Some(line)
    }
}

fn parts_of(class: RateClass) -> u32 {
    let parts = ReadPart::ALL
        .into_iter()
        .filter(|part| part.rate() == class);
    u32::try_from(parts.count()).unwrap_or(1).max(1)
}
