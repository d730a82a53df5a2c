//! Measures the delay of replies on a wire where a late reply is identified by its number. Pure.

use crate::link::bus::late_replies::{LateReply, REPLY_LIMIT_MIN, slow_limit};
use std::time::Duration;

/// A reply later than this is an outlier and predicts nothing about the next one.
const SLOWEST: Duration = Duration::from_millis(350);
/// After this many consecutive replies, each in less than half the slowest time, the link counts as fast again.
const QUICK_LEAST: u32 = 20;

/// The slowest recent reply, if it took longer than the minimum wait.
#[derive(Debug, Default)]
pub(crate) struct Slowness {
    slowest: Option<Duration>,
    quick: u32,
}

impl Slowness {
    /// Records a reply that came after its request had timed out.
    pub(crate) fn late(&mut self, reply: LateReply) {
        self.record(reply.took);
    }

    /// Records the round trip time of a reply.
    pub(crate) fn record(&mut self, took: Duration) {
        let Some(slowest) = self.slowest else {
            self.slowest = Some(took).filter(|took| is_slow(*took));
            return;
        };
        if took > slowest && took <= SLOWEST {
            self.slowest = Some(took);
        }
        if took * 2 >= slowest {
            self.quick = 0;
            return;
        }
        self.quick += 1;
        if self.quick >= QUICK_LEAST {
            *self = Self::default();
        }
    }

    /// The slowest recent round trip; `None` while replies are fast.
    pub(crate) const fn slowest(&self) -> Option<Duration> {
        self.slowest
    }

    /// The minimum time to wait for a reply.
    pub(crate) fn least_wait(&self) -> Duration {
        self.slowest.map_or(REPLY_LIMIT_MIN, slow_limit)
    }
}

fn is_slow(took: Duration) -> bool {
    took > REPLY_LIMIT_MIN && took <= SLOWEST
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn a_late_reply_lengthens_the_wait_and_quick_ones_shorten_it_again() {
        let mut slowness = Slowness::default();
        slowness.record(ms(20));
        assert_eq!(slowness.least_wait(), ms(50));
        let late = |took| LateReply {
            took,
            exception: None,
        };
        slowness.late(late(ms(300)));
        assert_eq!(slowness.least_wait(), ms(425));
        for _ in 0..100 {
            slowness.record(ms(290));
        }
        assert_eq!(slowness.slowest(), Some(ms(300)));
        for _ in 0..QUICK_LEAST {
            slowness.record(ms(4));
        }
        assert_eq!((slowness.slowest(), slowness.least_wait()), (None, ms(50)));
    }

    #[test]
    fn a_hiccup_teaches_nothing() {
        let mut slowness = Slowness::default();
        slowness.record(ms(900));
        assert_eq!(slowness.slowest(), None);
        slowness.record(ms(100));
        slowness.record(ms(5000));
        assert_eq!(slowness.slowest(), Some(ms(100)));
    }
}
