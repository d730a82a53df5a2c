//! The channels of the fingertips: their readings at rest, and their answers to a press.

use crate::hand::statistics::mean;
use crate::hand::{Finger, HandSample, PerFinger};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A channel is dead if it never changes in this many readings.
const READINGS: usize = 20;
/// Standard deviation between successive readings beyond which a channel is noisy, counts: ten times the measured one.
const NOISY: f64 = 2000.0;
/// A fingertip is pressed if a channel is this far from its rest, counts: about half a newton right above it.
const PRESSED: f64 = 20_000.0;
/// A channel answers a press if it moves this far from its rest, counts, and this many times its noise.
const ANSWERS: f64 = 1000.0;
const ANSWERS_NOISE: f64 = 6.0;
/// The channels under the pad; the eighth is the reference of the others and feels no press.
const UNDER_PAD: usize = 7;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(from = "Vec<u8>", into = "Vec<u8>")]
pub struct ChannelSet(u8);

impl ChannelSet {
    /// The channels whose index (0 to 7) satisfies the predicate.
    pub(crate) fn of(is_so: impl Fn(usize) -> bool) -> Self {
        let chosen = (0..8_usize).filter(|nth| is_so(*nth));
        Self(chosen.fold(0, |set, nth| set | 1 << nth))
    }

    pub const fn is_empty(&self) -> bool {
        self.0 == 0
    }

    /// The number of channels.
    pub fn count(self) -> f64 {
        self.0.count_ones().into()
    }

    /// The channel numbers, 1 to 8.
    pub fn numbers(self) -> impl Iterator<Item = u8> {
        (1..=8).filter(move |number| self.0 >> (number - 1) & 1 == 1)
    }
}

impl From<Vec<u8>> for ChannelSet {
    fn from(numbers: Vec<u8>) -> Self {
        Self::of(|nth| numbers.iter().any(|number| usize::from(*number) == nth + 1))
    }
}

impl From<ChannelSet> for Vec<u8> {
    fn from(set: ChannelSet) -> Self {
        set.numbers().collect()
    }
}

impl fmt::Display for ChannelSet {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<String> = self.numbers().map(|number| number.to_string()).collect();
        to.write_str(&numbers.join(", "))
    }
}

/// The channels of one fingertip at one time, counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TipReading {
    pub(crate) at_s: f64,
    pub(crate) finger: Finger,
    pub(crate) raw: [u32; 8],
}

impl TipReading {
    pub(crate) fn of(sample: &HandSample, finger: Finger) -> Option<Self> {
        let block = sample.tactile[finger]?;
        Some(Self {
            // Time of the values: midway between request and reply.
            at_s: f64::midpoint(block.asked.secs(), block.received.secs()),
            finger,
            raw: block.value.raw,
        })
    }
}

/// Readings of the channels while nothing moves.
#[derive(Debug, Clone)]
pub(crate) struct TipsAtRest {
    pub(crate) at_s: f64,
    tips: PerFinger<[Option<ChannelRest>; 8]>,
}

#[derive(Debug, Clone, Copy)]
struct ChannelRest {
    mean: f64,
    /// Between successive readings, so that drift does not count.
    noise: f64,
    is_dead: bool,
}

impl TipsAtRest {
    /// `begun_s`: start of the rest.
    pub(crate) fn of(readings: &[TipReading], begun_s: f64) -> Self {
        let times: Vec<f64> = readings.iter().map(|tip| tip.at_s).collect();
        let channel = |finger: Finger, nth: usize| {
            let own = readings.iter().filter(|tip| tip.finger == finger);
            let counts: Vec<f64> = own
                .filter_map(|tip| tip.raw.get(nth).copied().map(f64::from))
                .collect();
            let steps: Vec<f64> = counts
                .windows(2)
                .filter_map(|pair| Some((pair.last()? - pair.first()?).powi(2)))
                .collect();
            Some(ChannelRest {
                mean: mean(&counts)?,
                noise: (mean(&steps).unwrap_or_default() / 2.0).sqrt(),
                is_dead: counts.len() >= READINGS && steps.iter().all(|step| *step == 0.0),
            })
        };
        Self {
            at_s: mean(&times).unwrap_or(begun_s),
            tips: PerFinger::from_fn(|finger| std::array::from_fn(|nth| channel(finger, nth))),
        }
    }

    fn channels(&self, finger: Finger, is_so: fn(&ChannelRest) -> bool) -> Option<ChannelSet> {
        let all: Option<Vec<ChannelRest>> = self.tips[finger].iter().copied().collect();
        let all = all?;
        Some(ChannelSet::of(|nth| all.get(nth).is_some_and(is_so)))
    }

    /// Channels that never change; `None` without readings.
    pub(crate) fn dead(&self, finger: Finger) -> Option<ChannelSet> {
        self.channels(finger, |channel| channel.is_dead)
    }

    /// Channels that scatter; `None` without readings.
    pub(crate) fn noisy(&self, finger: Finger) -> Option<ChannelSet> {
        self.channels(finger, |channel| channel.noise > NOISY)
    }

    /// The fastest drift of a channel until a later rest, counts per second.
    pub(crate) fn drift(&self, later: &Self, finger: Finger) -> Option<f64> {
        let each = (0..8).filter_map(|nth| self.slope(later, finger, nth));
        each.map(f64::abs).reduce(f64::max)
    }

    fn slope(&self, later: &Self, finger: Finger, nth: usize) -> Option<f64> {
        let mean = |own: &Self| own.tips[finger].get(nth).copied().flatten();
        Some((mean(later)?.mean - mean(self)?.mean) / (later.at_s - self.at_s))
    }
}

/// Expected readings of untouched fingertips, from two rests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unpressed<'a> {
    pub(crate) first: &'a TipsAtRest,
    pub(crate) last: &'a TipsAtRest,
}

impl Unpressed<'_> {
    /// Distance of each channel from its expected reading, counts; `None` if that is unknown.
    fn away(&self, tip: &TipReading) -> [Option<f64>; 8] {
        std::array::from_fn(|nth| {
            let rest = self.last.tips[tip.finger].get(nth).copied().flatten()?;
            let slope = self.first.slope(self.last, tip.finger, nth)?;
            let expected = rest.mean + slope * (tip.at_s - self.last.at_s);
            Some((f64::from(*tip.raw.get(nth)?) - expected).abs())
        })
    }

    /// True if the fingertip is pressed in this reading.
    pub(crate) fn is_pressed(&self, tip: &TipReading) -> bool {
        let under_pad = self.away(tip).into_iter().take(UNDER_PAD);
        under_pad.flatten().any(|away| away >= PRESSED)
    }

    /// Channels under the pad that did not answer; `None` if the fingertip was not pressed.
    pub(crate) fn silent(&self, readings: &[TipReading], finger: Finger) -> Option<ChannelSet> {
        let own = readings.iter().filter(|tip| tip.finger == finger);
        let pressed: Vec<[Option<f64>; 8]> = own
            .filter(|tip| self.is_pressed(tip))
            .map(|tip| self.away(tip))
            .collect();
        if pressed.is_empty() {
            return None;
        }
        let answers = |nth: usize| {
            let rest = self.last.tips[finger].get(nth).copied().flatten();
            let noise = rest.map_or(0.0, |rest| rest.noise);
            let least = ANSWERS.max(ANSWERS_NOISE * noise);
            let mut all = pressed
                .iter()
                .filter_map(|away| away.get(nth).copied().flatten());
            all.any(|away| away >= least)
        };
        Some(ChannelSet::of(|nth| nth < UNDER_PAD && !answers(nth)))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    const FINGER: Finger = Finger::Index;

    /// Readings 20 ms apart, of one channel at `counts(nth reading)`, and all others at rest with a little noise.
    fn readings(from_s: f64, channel: usize, counts: impl Fn(u32) -> u32) -> Vec<TipReading> {
        let reading = |nth: u32| {
            let mut raw = [2_900_000 + nth % 2 * 100; 8];
            raw[channel] = counts(nth);
            TipReading {
                at_s: from_s + 0.02 * f64::from(nth),
                finger: FINGER,
                raw,
            }
        };
        (0..60).map(reading).collect()
    }

    #[test]
    fn dead_and_noisy_channels_are_named_and_drift_is_no_noise() {
        let named = |counts: fn(u32) -> u32| {
            let rest = TipsAtRest::of(&readings(0.0, 3, counts), 0.0);
            let [dead, noisy] = [rest.dead(FINGER), rest.noisy(FINGER)];
            [dead.unwrap().to_string(), noisy.unwrap().to_string()]
        };
        assert_eq!(named(|_| 0), ["4", ""]);
        assert_eq!(named(|nth| 2_900_000 + nth % 2 * 6000), ["", "4"]);
        assert_eq!(named(|nth| 2_900_000 + nth * 60), ["", ""]);
        let rest = TipsAtRest::of(&[], 0.0);
        assert_eq!(rest.dead(FINGER), None, "nothing was read");
    }

    #[test]
    fn a_press_is_answered_by_the_channels_that_leave_what_they_would_drift_to() {
        let drifting = |nth: u32| 2_900_000 + nth * 60;
        let first = TipsAtRest::of(&readings(0.0, 3, drifting), 0.0);
        let last = TipsAtRest::of(&readings(1.2, 3, |nth| drifting(60 + nth)), 1.2);
        let unpressed = Unpressed {
            first: &first,
            last: &last,
        };
        let left = readings(2.4, 3, |nth| drifting(120 + nth));
        assert_eq!(unpressed.silent(&left, FINGER), None, "nobody pressed");
        let mut pressed = left;
        for tip in &mut pressed {
            // The third is under the finger, the fourth only drifts.
            tip.raw[2] += 60_000;
            for nth in [0, 1, 4, 5] {
                tip.raw[nth] += 4000;
            }
        }
        let silent = unpressed.silent(&pressed, FINGER).unwrap();
        assert_eq!((silent.count(), silent.to_string().as_str()), (2.0, "4, 7"));
        assert_eq!(ChannelSet::from(vec![4, 7]), silent);
    }
}
