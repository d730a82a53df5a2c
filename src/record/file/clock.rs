//! Chooses the clock of a file: its log times are used. The stamps within its messages give the order and the intervals, and
//! reveal a log shifted by another program. ROS 2 counts a stamp's seconds in 31 bits, which end in January 2038.

use crate::record::file::format::message::Time;
use crate::record::file::format::topic::Topic;
use std::collections::BTreeMap;

/// Maximum number of messages per channel whose stamps are inspected.
const SAMPLES_MAX: usize = 256;
/// Bytes of a message before its first stamp, and of a stamp.
const HEAD: usize = 4;
const STAMP: usize = 8;
/// Positions in a message at which its stamp may be.
const STAMPS: usize = 2;

/// Differences between the log's clock and the stamps, collected before the channels' topics are known.
#[derive(Debug, Default)]
pub(crate) struct LogClock {
    differences: BTreeMap<u16, Vec<[Option<i64>; STAMPS]>>,
    /// Number of messages per channel without a log time.
    pub(crate) unlogged: BTreeMap<u16, u64>,
}

impl LogClock {
    /// Adds a message of this channel, with its log time.
    pub(crate) fn push(&mut self, channel: u16, log: u64, data: &[u8]) {
        if log == 0 {
            *self.unlogged.entry(channel).or_default() += 1;
            return;
        }
        let samples = self.differences.entry(channel).or_default();
        if samples.len() < SAMPLES_MAX {
            let differs = |nth| Some(difference(log, stamp(data, nth)?));
            samples.push([differs(0), differs(1)]);
        }
    }

    /// Median difference by which the log is ahead of the stamps, in nanoseconds.
    pub(crate) fn difference(&self, topics: &BTreeMap<u16, Topic>) -> i64 {
        let known = self.differences.iter();
        let known = known.filter_map(|(channel, samples)| Some((topics.get(channel)?, samples)));
        let all = known.flat_map(|(topic, samples)| {
            let at = place(*topic);
            samples.iter().filter_map(move |sample| *sample.get(at?)?)
        });
        let mut all: Vec<i64> = all.collect();
        all.sort_unstable();
        all.get(all.len() / 2).copied().unwrap_or_default()
    }
}

/// Time of receipt of a message: its log time, or if that is missing its stamp, converted to the log's clock.
pub(crate) fn received(topic: Topic, log: u64, data: &[u8], difference: i64) -> u64 {
    if log > 0 {
        return log;
    }
    let stamp = place(topic)
        .and_then(|at| stamp(data, at))
        .unwrap_or_default();
    stamp.saturating_add_signed(difference)
}

/// Index of the stamp that holds the time of receipt; `None` for messages that do not begin with one.
const fn place(topic: Topic) -> Option<usize> {
    match topic {
        // The first stamp is the time of the request.
        Topic::State | Topic::Touch(_) => Some(1),
        _ if topic.is_stamped() => Some(0),
        _ => None,
    }
}

/// A stamp in nanoseconds since 1970; `None` if it is missing or saturated at 2038.
fn stamp(data: &[u8], nth: usize) -> Option<u64> {
    let is_little = data.get(1)? & 1 == 1;
    let bytes: &[u8; STAMP] = data.get(HEAD + nth * STAMP..)?.first_chunk()?;
    let [a, b, c, d, e, f, g, h] = *bytes;
    let (sec, nanosec) = ([a, b, c, d], [e, f, g, h]);
    let time = if is_little {
        Time {
            sec: i32::from_le_bytes(sec),
            nanosec: u32::from_le_bytes(nanosec),
        }
    } else {
        Time {
            sec: i32::from_be_bytes(sec),
            nanosec: u32::from_be_bytes(nanosec),
        }
    };
    (!time.has_ended()).then(|| time.nanos())
}

fn difference(log: u64, stamp: u64) -> i64 {
    let difference = i128::from(log) - i128::from(stamp);
    i64::try_from(difference).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_difference_is_that_of_most_messages_of_our_topics() {
        let mut clock = LogClock::default();
        let mut take = |channel, log, stamps: [Time; 2]| {
            let stamps = stamps.map(|time| [time.sec.to_le_bytes(), time.nanosec.to_le_bytes()]);
            let data = [&[0, 1, 0, 0], stamps.concat().concat().as_slice()].concat();
            clock.push(channel, log, &data);
        };
        let at = |sec| Time { sec, nanosec: 5 };
        let second = 1_000_000_000;
        for nth in 0..9 {
            take(1, 1000 * second + 5 + nth, [at(3600), at(4600)]);
        }
        take(1, 77 * second, [at(0), at(4600)]);
        take(1, 0, [at(0), at(4600)]);
        take(2, 5 * second, [at(5), at(5)]);
        take(3, 3_000_000_000 * second, [at(i32::MAX), at(i32::MAX)]);
        let topics = BTreeMap::from([(1, Topic::State), (3, Topic::Event)]);
        assert_eq!(clock.difference(&topics), -3600 * 1_000_000_000 + 4);
        assert_eq!(clock.unlogged, BTreeMap::from([(1, 1)]));
    }
}
