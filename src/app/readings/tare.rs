//! What the tactile channels are counted from: the first reading of an untouched fingertip, or the one that a person chose.
//! Changes no reading.

use crate::hand::{Finger, HandSample, Moment, PerFinger};

/// From this normal force on a fingertip counts as touched, in newtons: its own noise stays below.
pub const TOUCHED_N: f32 = 0.3;

/// The reading of one fingertip that its channels are counted from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rest {
    /// The eight channels, counts.
    pub raw: [u32; 8],
    /// When it was received.
    pub at: Moment,
    /// True if a person chose it, false for the first reading.
    pub chosen: bool,
}

/// The rests of all fingertips, and those before the last taring.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tare {
    rests: PerFinger<Option<Rest>>,
    before: Option<PerFinger<Option<Rest>>>,
}

impl Tare {
    /// What this fingertip is counted from; `None` before it was read untouched.
    #[must_use]
    pub fn rest(&self, finger: Finger) -> Option<Rest> {
        self.rests[finger]
    }

    /// Whether there is a taring to take back.
    #[must_use]
    pub const fn can_undo(&self) -> bool {
        self.before.is_some()
    }

    /// Takes the first reading of each untouched fingertip as its rest.
    pub(crate) fn begin(&mut self, sample: &HandSample) {
        for (finger, rest) in self.rests.iter_mut() {
            if rest.is_none() && load(sample, finger).is_none() {
                *rest = reading(sample, finger, false);
            }
        }
    }

    /// Counts these fingertips from their newest reading. A fingertip without reading keeps what it had. Nothing is
    /// changed where one is touched: that one, and what presses it in newtons.
    pub(crate) fn tare(
        &mut self,
        fingers: impl IntoIterator<Item = Finger>,
        sample: &HandSample,
    ) -> Result<(), (Finger, f32)> {
        let mut rests = self.rests;
        for finger in fingers {
            if let Some(newtons) = load(sample, finger) {
                return Err((finger, newtons));
            }
            rests[finger] = reading(sample, finger, true).or(rests[finger]);
        }
        if self.rests != rests {
            self.before = Some(std::mem::replace(&mut self.rests, rests));
        }
        Ok(())
    }

    /// Takes the last taring back, once.
    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.rests = before;
        }
    }
}

/// What presses a fingertip that is touched, in newtons.
fn load(sample: &HandSample, finger: Finger) -> Option<f32> {
    let normal = sample.tactile[finger]?.value.normal()?;
    (normal >= TOUCHED_N).then_some(normal)
}

fn reading(sample: &HandSample, finger: Finger, chosen: bool) -> Option<Rest> {
    let block = sample.tactile[finger]?;
    Some(Rest {
        raw: block.value.raw,
        at: block.received,
        chosen,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{TactileBlock, Timed};

    fn sample(raw: u32, millis: u64) -> HandSample {
        let at = Moment::from_micros(millis * 1000);
        let mut block = TactileBlock::decode(&[0; 58]);
        if let Some(block) = &mut block {
            block.raw = [raw; 8];
        }
        let mut sample = HandSample::default();
        sample.tactile[Finger::Index] = block.map(|value| Timed {
            value,
            asked: at,
            received: at,
        });
        sample
    }

    fn counted_from(tare: &Tare) -> Option<u32> {
        tare.rest(Finger::Index).map(|rest| rest.raw[0])
    }

    #[test]
    fn the_first_reading_stays_until_a_person_tares() {
        let mut tare = Tare::default();
        tare.begin(&sample(100, 1));
        tare.begin(&sample(200, 2));
        assert_eq!(counted_from(&tare), Some(100));
        assert!(tare.rest(Finger::Index).is_some_and(|rest| !rest.chosen));
        tare.tare(Finger::ALL, &sample(300, 3)).unwrap();
        assert_eq!(counted_from(&tare), Some(300));
        let rest = tare.rest(Finger::Index).expect("tared");
        assert_eq!((rest.chosen, rest.at), (true, Moment::from_micros(3000)));
    }

    #[test]
    fn a_touched_fingertip_gives_no_zero_and_is_not_tared() {
        let pressed = |millis| {
            let mut sample = sample(900, millis);
            if let Some(block) = &mut sample.tactile[Finger::Index] {
                block.value.normal_n = 4.5;
            }
            sample
        };
        let mut tare = Tare::default();
        tare.begin(&pressed(1));
        assert_eq!(counted_from(&tare), None);
        tare.begin(&sample(100, 2));
        assert_eq!(counted_from(&tare), Some(100));
        let refused = tare.tare(Finger::ALL, &pressed(3));
        assert_eq!(refused, Err((Finger::Index, 4.5)));
        assert_eq!((counted_from(&tare), tare.can_undo()), (Some(100), false));
    }

    #[test]
    fn a_taring_can_be_taken_back_once() {
        let mut tare = Tare::default();
        tare.begin(&sample(100, 1));
        tare.tare([Finger::Index], &sample(300, 3)).unwrap();
        assert!(tare.can_undo());
        tare.undo();
        assert_eq!((counted_from(&tare), tare.can_undo()), (Some(100), false));
    }

    #[test]
    fn a_fingertip_that_was_never_read_is_not_tared() {
        let mut tare = Tare::default();
        tare.tare([Finger::Thumb], &sample(300, 3)).unwrap();
        assert_eq!(tare.rest(Finger::Thumb), None);
        assert!(!tare.can_undo());
    }
}
