//! Zero points of the tactile channels: the first reading of an untouched fingertip, or one chosen by the user. Readings
//! themselves are unchanged.

use crate::hand::{Finger, HandSample, Moment, PerFinger};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;

/// Normal force in newtons from which a fingertip counts as touched; its noise stays below.
pub const TOUCHED_N: f32 = 0.3;

/// Zero point of one fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TareZero {
    /// The eight channels, counts.
    pub raw: [u32; 8],
    /// Time at which the reading was received.
    pub at: Moment,
    pub source: TareSource,
}

/// Source of a fingertip's zero point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TareSource {
    /// First reading of the untouched fingertip.
    First,
    /// Tared by the user.
    User,
    /// Tared by the user in an earlier session, this long before [`TareZero::at`].
    Stored(Duration),
}

/// Persistent form of a tare.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct StoredTare {
    /// Time of the tare in seconds since 1970.
    pub unix_s: u64,
    /// The eight channels of each tared fingertip in counts, by the finger's name.
    pub tips: BTreeMap<String, [u32; 8]>,
}

/// A stored tare, and its age when the hand was found.
#[derive(Debug, Clone, PartialEq, Eq)]
struct TareOffer {
    stored: StoredTare,
    age: Duration,
    at: Moment,
}

/// Zero points of all fingertips, and those before the last tare.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tare {
    zeros: PerFinger<Option<TareZero>>,
    before: Option<PerFinger<Option<TareZero>>>,
    /// `None` until the stored tare has been looked up for this connection.
    offer: Option<Option<TareOffer>>,
}

impl Tare {
    /// Zero point of this fingertip; `None` before it was read untouched.
    pub fn zero(&self, finger: Finger) -> Option<TareZero> {
        self.zeros[finger]
    }

    /// Time of the user's last tare; `None` if there was none or it was undone.
    pub fn chosen_at(&self) -> Option<Moment> {
        let chosen = self.zeros.iter().filter_map(|(_, zero)| *zero);
        let chosen = chosen.filter(|zero| zero.source == TareSource::User);
        chosen.map(|zero| zero.at).max()
    }

    /// True if there is a tare to undo.
    pub const fn can_undo(&self) -> bool {
        self.before.is_some()
    }

    /// Uses the first reading of each untouched fingertip as its zero point.
    pub(crate) fn begin(&mut self, sample: &HandSample) {
        for (finger, zero) in self.zeros.iter_mut() {
            if zero.is_none() && load(sample, finger).is_none() {
                *zero = reading(sample, finger, TareSource::First);
            }
        }
    }

    /// Tares these fingertips to their newest readings. A fingertip without a reading keeps its zero point. If one is
    /// touched, nothing changes and the error holds that finger and its force in newtons.
    pub(crate) fn tare(
        &mut self,
        fingers: impl IntoIterator<Item = Finger>,
        sample: &HandSample,
    ) -> Result<(), (Finger, f32)> {
        self.count_from(fingers, sample, |finger| {
            reading(sample, finger, TareSource::User)
        })
    }

    fn count_from(
        &mut self,
        fingers: impl IntoIterator<Item = Finger>,
        sample: &HandSample,
        zero: impl Fn(Finger) -> Option<TareZero>,
    ) -> Result<(), (Finger, f32)> {
        let mut zeros = self.zeros;
        for finger in fingers {
            if let Some(newtons) = load(sample, finger) {
                return Err((finger, newtons));
            }
            zeros[finger] = zero(finger).or(zeros[finger]);
        }
        if self.zeros != zeros {
            self.before = Some(std::mem::replace(&mut self.zeros, zeros));
        }
        Ok(())
    }

    /// True once the stored tare has been looked up.
    pub(crate) const fn was_offered(&self) -> bool {
        self.offer.is_some()
    }

    /// Offers the stored tare of the hand, if any. `since_1970` and `now` are the same moment.
    pub(crate) fn offer(&mut self, stored: Option<StoredTare>, since_1970: Duration, now: Moment) {
        let offer = |stored: StoredTare| TareOffer {
            age: since_1970.saturating_sub(Duration::from_secs(stored.unix_s)),
            stored,
            at: now,
        };
        self.offer = Some(stored.map(offer));
    }

    /// Age of the offered tare; `None` if none is offered.
    pub fn offered(&self, now: Moment) -> Option<Duration> {
        let offer = self.offer.as_ref()?.as_ref()?;
        Some(offer.age + now.since(offer.at))
    }

    /// Tares these fingertips to the stored values, if any. If one is touched, nothing changes and the error holds that
    /// finger and its force in newtons.
    pub(crate) fn apply_stored(
        &mut self,
        fingers: impl IntoIterator<Item = Finger>,
        sample: &HandSample,
        now: Moment,
    ) -> Result<(), (Finger, f32)> {
        let (Some(Some(offer)), Some(age)) = (&self.offer, self.offered(now)) else {
            return Ok(());
        };
        let tips = offer.stored.tips.clone();
        self.count_from(fingers, sample, |finger| {
            Some(TareZero {
                raw: *tips.get(finger.name())?,
                at: now,
                source: TareSource::Stored(age),
            })
        })
    }

    /// Tare to store: the user's, else the one stored before. `since_1970` and `now` are the same moment.
    pub(crate) fn to_keep(&self, since_1970: Duration, now: Moment) -> Option<StoredTare> {
        let Some(at) = self.chosen_at() else {
            let offer = self.offer.as_ref()?.as_ref();
            return offer.map(|offer| offer.stored.clone());
        };
        let zeros = self.zeros.iter().filter_map(|(finger, zero)| {
            let zero = zero.filter(|zero| zero.source != TareSource::First)?;
            Some((finger.name().to_owned(), zero.raw))
        });
        Some(StoredTare {
            unix_s: since_1970.saturating_sub(now.since(at)).as_secs(),
            tips: zeros.collect(),
        })
    }

    /// Undoes the last tare, once.
    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.zeros = before;
        }
    }
}

/// Normal force on a touched fingertip in newtons; `None` if untouched.
fn load(sample: &HandSample, finger: Finger) -> Option<f32> {
    let normal = sample.tactile[finger]?.value.normal()?;
    (normal >= TOUCHED_N).then_some(normal)
}

fn reading(sample: &HandSample, finger: Finger, source: TareSource) -> Option<TareZero> {
    let block = sample.tactile[finger]?;
    Some(TareZero {
        raw: block.value.raw,
        at: block.received,
        source,
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
        tare.zero(Finger::Index).map(|zero| zero.raw[0])
    }

    #[test]
    fn the_first_reading_stays_until_a_person_tares() {
        let mut tare = Tare::default();
        tare.begin(&sample(100, 1));
        tare.begin(&sample(200, 2));
        assert_eq!((counted_from(&tare), tare.chosen_at()), (Some(100), None));
        tare.tare(Finger::ALL, &sample(300, 3)).unwrap();
        assert_eq!(counted_from(&tare), Some(300));
        assert_eq!(tare.chosen_at(), Some(Moment::from_micros(3000)));
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
    fn what_was_kept_is_offered_and_taken_only_where_nothing_presses() {
        let mut former = Tare::default();
        let at = |secs: u64| Moment::from_micros(secs * 1_000_000);
        assert_eq!(former.to_keep(Duration::from_secs(1000), at(0)), None);
        former.tare([Finger::Index], &sample(300, 3)).unwrap();
        let stored = former.to_keep(Duration::from_secs(1000), at(0)).unwrap();
        let mut tare = Tare::default();
        tare.begin(&sample(100, 1));
        tare.offer(Some(stored), Duration::from_secs(1060), at(5));
        assert_eq!(counted_from(&tare), Some(100), "only offered");
        assert_eq!(tare.offered(at(7)), Some(Duration::from_secs(62)));
        let mut pressed = sample(900, 8);
        if let Some(block) = &mut pressed.tactile[Finger::Index] {
            block.value.normal_n = 4.5;
        }
        let refused = tare.apply_stored(Finger::ALL, &pressed, at(8));
        assert_eq!(refused, Err((Finger::Index, 4.5)));
        assert_eq!(counted_from(&tare), Some(100));
        tare.apply_stored(Finger::ALL, &sample(400, 8), at(8))
            .unwrap();
        let zero = tare.zero(Finger::Index).unwrap();
        let source = TareSource::Stored(Duration::from_secs(63));
        assert_eq!((zero.raw[0], zero.source), (300, source));
        assert_eq!(tare.chosen_at(), None, "not chosen in this session");
        tare.undo();
        assert_eq!(counted_from(&tare), Some(100));
        let again = tare.to_keep(Duration::from_secs(2000), at(9)).unwrap();
        assert_eq!(again.unix_s, 1000, "what was kept before");
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
        assert_eq!(tare.zero(Finger::Thumb), None);
        assert!(!tare.can_undo());
    }
}
