//! Where the tangential force of each fingertip pointed during the last second. Bounded; draws nothing.

use crate::hand::{Finger, HandSample, Moment, PerFinger};
use std::collections::VecDeque;

/// How long a trail is, in seconds.
const SECONDS: f64 = 1.0;
/// The most it holds: a second of the fastest readings.
const MOST: usize = 64;
/// Below this normal force a direction is noise, in newtons.
const CONTACT_N: f32 = 0.1;

/// One end of the arrow.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    at: Moment,
    /// Newtons and degrees; none without contact, which breaks the trail.
    shear: Option<(f32, f32)>,
}

/// The trails of the five fingertips.
#[derive(Debug, Clone, Default)]
pub(crate) struct Trails {
    ends: PerFinger<VecDeque<End>>,
}

impl Trails {
    /// Takes in what is new; the work does not grow with time.
    pub(crate) fn follow(&mut self, sample: &HandSample, now: Moment) {
        for finger in Finger::ALL {
            let ends = &mut self.ends[finger];
            let newest = ends.back().map(|end| end.at);
            if let Some(block) =
                sample.tactile[finger].filter(|block| Some(block.received) != newest)
            {
                let touches = block
                    .value
                    .normal()
                    .is_some_and(|normal| normal >= CONTACT_N);
                let shear = block.value.tangential().filter(|_| touches);
                ends.push_back(End {
                    at: block.received,
                    shear: shear.zip(block.value.direction_deg().map(f32::from)),
                });
            }
            while ends.len() > MOST || ends.front().is_some_and(|end| is_old(end.at, now)) {
                ends.pop_front();
            }
        }
    }

    /// Pairs of neighbouring ends, oldest first, each with its freshness: 1 = now, 0 = a second ago.
    pub(crate) fn steps(
        &self,
        finger: Finger,
        now: Moment,
    ) -> impl Iterator<Item = ((f32, f32), (f32, f32), f32)> {
        let ends = &self.ends[finger];
        ends.iter()
            .zip(ends.iter().skip(1))
            .filter_map(move |(from, to)| {
                #[expect(clippy::cast_possible_truncation, reason = "a share of a second")]
                let age = ((now.secs() - to.at.secs()) / SECONDS) as f32;
                Some((from.shear?, to.shear?, (1.0 - age).clamp(0.0, 1.0)))
            })
    }
}

fn is_old(at: Moment, now: Moment) -> bool {
    now.secs() - at.secs() > SECONDS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{TactileBlock, Timed};

    fn sample(millis: u64, newtons: f32) -> (HandSample, Moment) {
        let at = Moment::from_micros(millis * 1000);
        let block = TactileBlock::decode(&[0; 58]).map(|mut block| {
            block.normal_n = newtons;
            block.tangential_n = newtons / 4.0;
            block.direction_raw = 90;
            block
        });
        let mut sample = HandSample::default();
        sample.tactile[Finger::Index] = block.map(|value| Timed {
            value,
            asked: at,
            received: at,
        });
        (sample, at)
    }

    #[test]
    fn a_trail_lasts_a_second_and_stays_bounded() {
        let mut trails = Trails::default();
        for millis in 0..5000 {
            let (sample, now) = sample(millis, 4.0);
            trails.follow(&sample, now);
        }
        assert_eq!(trails.ends[Finger::Index].len(), MOST);
        let (_, later) = sample(9000, 4.0);
        trails.follow(&HandSample::default(), later);
        assert!(trails.ends[Finger::Index].is_empty());
    }

    #[test]
    fn the_same_reading_counts_once_and_lost_contact_breaks_the_trail() {
        let mut trails = Trails::default();
        for (millis, newtons) in [(0, 4.0), (30, 4.0), (30, 4.0), (60, 0.0), (90, 4.0)] {
            let (sample, now) = sample(millis, newtons);
            trails.follow(&sample, now);
        }
        let now = Moment::from_micros(90_000);
        assert_eq!(trails.ends[Finger::Index].len(), 4);
        assert_eq!(trails.steps(Finger::Index, now).count(), 1);
    }
}
