//! What must come of a cell, judged by what reached the hand and by where its joints truly went.

use crate::seams::hand::ANGLE_SET;
use crate::seams::process::NEW_DEFAULT;
use handscope::hand::Moment;
use handscope::sim::JournalEntry;
use std::time::Duration;

/// POS_SET, and the end of ANGLE_SET (manual 2.6): what lies between moves joints.
const TARGETS: std::ops::Range<u16> = 1474..1498;
/// A write of a number there starts a stored gesture.
const GESTURE: u16 = 1008;
/// A target so near to where the joint is holds it, also on a slow line and with a drive's dead time.
const NEAR: i16 = 70;
/// What joints at rest may still move.
const STILL: i16 = 8;
/// A joint on its way stops within this after it was told.
const BRAKES_WITHIN: Duration = Duration::from_millis(400);
/// What goes on comes so much closer within the time that it is looked at.
const GOES_ON: i16 = 150;
/// Closer is the fist.
const FIST: i16 = 40;
/// Who insists says it so often.
const INSISTS: usize = 4;
/// The index finger: it moves in every row that moves joints.
pub(super) const INDEX: usize = 3;

/// What must come of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// A hold reaches the hand within so many milliseconds, and its joints stay where they then are.
    Held(u64),
    /// After so many milliseconds nothing that moves the hand reaches it any more. What it was told before, it finishes.
    NothingMore(u64),
    /// The joints stay where they are from now on, and nothing is sent that would move them.
    Rests,
    /// The hand goes on to where it was told to go.
    GoesOn,
    /// It goes on, or is held; whatever it is told is where it was to go, or where it is.
    NothingWrong,
    /// No joint moves, and nothing is told that would move one.
    Still,
    /// Held as with [`Self::Held`], and the program ends.
    HeldAtTheEnd(u64),
    /// The hand is told again and again to stay where it was when that began, though it does not.
    Insists,
    /// The program ends, and the hand rests then.
    Ends,
    /// Each default is as before or as it was to be, and the program ends.
    Settled,
}

/// What was seen of a cell from the event on.
pub(super) struct Seen {
    pub(super) event: Moment,
    /// Where the joints truly were, over and over.
    pub(super) points: Vec<(Moment, [i16; 6])>,
    /// What reached the hand.
    pub(super) writes: Vec<JournalEntry>,
    pub(super) said: String,
    /// Its process is over.
    pub(super) has_ended: bool,
    /// What all drives wake up with.
    pub(super) defaults: Vec<u8>,
}

/// The targets of a write, and the joint of the first.
fn targets(write: &JournalEntry) -> Vec<(usize, i16)> {
    if !TARGETS.contains(&write.address) {
        return Vec::new();
    }
    let first = usize::from(write.address.saturating_sub(ANGLE_SET) / 2);
    let (pairs, _) = write.bytes.as_chunks::<2>();
    let shorts = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
    let told = shorts.enumerate().map(|(at, to)| (first + at, to));
    told.filter(|(_, to)| *to >= 0).collect()
}

impl Seen {
    /// Where the joints were seen nearest to this moment: nobody looks while a process sleeps.
    fn angles_at(&self, at: Moment) -> [i16; 6] {
        let apart = |(when, _): &&(Moment, [i16; 6])| when.since(at).max(at.since(*when));
        self.points.iter().min_by_key(apart).unwrap().1
    }

    /// What would move a joint away from where it was then.
    fn moves(&self, write: &JournalEntry) -> bool {
        let angles = self.angles_at(write.at);
        write.address == GESTURE
            || targets(write)
                .iter()
                .any(|(joint, to)| angles[*joint].abs_diff(*to) > NEAR.unsigned_abs())
    }

    fn after(&self, ms: u64) -> Moment {
        self.event.plus(Duration::from_millis(ms))
    }

    fn last(&self) -> [i16; 6] {
        self.points.last().unwrap().1
    }

    fn stay_from(&self, from: Moment) -> Result<(), String> {
        let there = self.angles_at(from);
        for (at, angles) in self.points.iter().filter(|(at, _)| *at >= from) {
            let way = there
                .iter()
                .zip(angles)
                .map(|(one, two)| one.abs_diff(*two));
            if way.max().unwrap() > STILL.unsigned_abs() {
                let late = at.since(self.event);
                return Err(format!(
                    "{late:?} after the event {there:?} had become {angles:?}"
                ));
            }
        }
        Ok(())
    }

    fn nothing_moves_after(&self, ms: u64) -> Result<(), String> {
        let from = self.after(ms);
        let mut late = self.writes.iter().filter(|write| write.at >= from);
        match late.find(|write| self.moves(write)) {
            None => {}
            Some(write) => {
                let (angles, at) = (self.angles_at(write.at), write.at.since(self.event));
                return Err(format!(
                    "{at:?} after the event the hand was told {:?} at {angles:?}",
                    targets(write)
                ));
            }
        }
        self.is_not_led_on_after(ms)
    }

    /// Small steps are a way, too.
    fn is_not_led_on_after(&self, ms: u64) -> Result<(), String> {
        let from = self.after(ms);
        let late = self.writes.iter().filter(|write| write.at >= from);
        let told = late.flat_map(targets).filter(|(joint, _)| *joint == INDEX);
        let told: Vec<i16> = told.map(|(_, to)| to).collect();
        let (least, most) = (told.iter().min(), told.iter().max());
        if let (Some(least), Some(most)) = (least, most)
            && most - least > NEAR
        {
            return Err(format!("the index was led on from {most} to {least}"));
        }
        Ok(())
    }

    fn held(&self, ms: u64) -> Result<(), String> {
        let by = self.after(ms);
        let mut told = self
            .writes
            .iter()
            .filter(|write| !targets(write).is_empty());
        if !told.any(|write| write.at <= by && !self.moves(write)) {
            return Err(format!("no hold within {ms} ms: {:?}", self.writes));
        }
        self.nothing_moves_after(ms)?;
        self.stay_from(by.plus(BRAKES_WITHIN))?;
        if self.last()[INDEX] <= FIST {
            return Err("it was a fist before it was held".into());
        }
        Ok(())
    }

    /// For whoever looks into it.
    pub(super) fn summary(&self) -> String {
        let at = |at: Moment| at.since(self.event).as_millis();
        let mut points: Vec<String> = Vec::new();
        for step in self
            .points
            .iter()
            .filter(|(at, _)| *at >= self.event)
            .step_by(25)
        {
            points.push(format!("{}:{}", at(step.0), step.1[INDEX]));
        }
        let mut writes: Vec<String> = Vec::new();
        for write in &self.writes {
            let told = targets(write);
            let what = match told.is_empty() {
                true => format!("{} {:?}", write.address, write.bytes),
                false => format!("{told:?}"),
            };
            let moves = if self.moves(write) { "!" } else { "" };
            writes.push(format!("{}{moves}:{what}", at(write.at)));
        }
        writes.truncate(8);
        let count = self.writes.len();
        format!(
            "{} -> {:?} of {count} {writes:?} said {}",
            points.join(" "),
            self.last(),
            self.said
        )
    }

    fn has_ended(&self) -> Result<(), String> {
        match self.has_ended {
            true => Ok(()),
            false => Err(format!("the program goes on: {}", self.said)),
        }
    }

    pub(super) fn judge(&self, verdict: Verdict, words: &str) -> Result<(), String> {
        match verdict {
            Verdict::Held(ms) => self.held(ms)?,
            Verdict::NothingMore(ms) => self.nothing_moves_after(ms)?,
            Verdict::Rests => {
                self.nothing_moves_after(0)?;
                self.stay_from(self.after(0).plus(BRAKES_WITHIN))?;
            }
            Verdict::GoesOn => {
                let from = self.angles_at(self.event);
                let went = |(_, angles): &(Moment, [i16; 6])| {
                    let mut joints = from.iter().zip(angles);
                    joints.any(|(from, now)| *now < (from - GOES_ON).max(FIST))
                };
                if !self.points.iter().any(went) {
                    return Err(format!("it did not go on: {:?}", self.last()));
                }
            }
            Verdict::NothingWrong => {
                let strange = |write: &&JournalEntry| {
                    let far = self.moves(write);
                    far && targets(write).iter().any(|(_, to)| (1..900).contains(to))
                };
                if let Some(write) = self.writes.iter().find(strange) {
                    return Err(format!("nobody asked for {:?}", targets(write)));
                }
            }
            Verdict::Still => {
                self.nothing_moves_after(0)?;
                self.stay_from(self.event)?;
            }
            Verdict::HeldAtTheEnd(ms) => {
                self.held(ms)?;
                self.has_ended()?;
            }
            Verdict::Insists => {
                let told = self
                    .writes
                    .iter()
                    .filter(|write| !targets(write).is_empty());
                if told.count() < INSISTS {
                    return Err(format!("it was hardly told to stay: {:?}", self.writes));
                }
                self.is_not_led_on_after(500)?;
            }
            Verdict::Ends => {
                self.has_ended()?;
                let rested = Duration::from_millis(800).as_micros() as u64;
                let (last, _) = self.points.last().unwrap();
                self.stay_from(Moment::from_micros(last.micros() - rested))?;
            }
            Verdict::Settled => {
                self.has_ended()?;
                let (pairs, _) = self.defaults.as_chunks::<2>();
                let kept = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
                let odd = kept
                    .clone()
                    .find(|kept| ![NEW_DEFAULT, 500, 1000].contains(kept));
                if let Some(odd) = odd {
                    return Err(format!(
                        "a default is {odd}: {:?}",
                        kept.collect::<Vec<_>>()
                    ));
                }
            }
        }
        match words.split('|').all(|word| self.said.contains(word)) {
            true => Ok(()),
            false => Err(format!("'{words}' was not said: {}", self.said)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was seen of a hand whose joints went so, each 20 ms from 1 s on, where the event was; it was told these targets then.
    fn seen(angle: impl Fn(u64) -> i16, told: &[(u64, i16)]) -> Seen {
        let at = |ms: u64| Moment::from_micros((1000 + ms) * 1000);
        let points = (0..200).map(|nth| (at(nth * 20), [angle(nth * 20); 6]));
        let write = |(ms, target): &(u64, i16)| JournalEntry {
            at: at(*ms),
            address: ANGLE_SET,
            bytes: target.to_le_bytes().repeat(6),
        };
        Seen {
            event: at(0),
            points: points.collect(),
            writes: told.iter().map(write).collect(),
            said: "ended: held".into(),
            has_ended: true,
            defaults: 500_i16.to_le_bytes().repeat(6),
        }
    }

    /// Closes at 100 counts in 100 ms.
    fn closes(ms: u64) -> i16 {
        (900 - i16::try_from(ms).unwrap()).max(0)
    }

    fn stays_at(angle: i16) -> impl Fn(u64) -> i16 {
        move |ms| closes(ms).max(angle)
    }

    #[test]
    fn what_goes_well_is_called_so() {
        let holds = [(20, 850), (60, 820), (100, 800), (140, 800)];
        let held = seen(stays_at(800), &holds);
        for verdict in [
            Verdict::Held(100),
            Verdict::HeldAtTheEnd(100),
            Verdict::NothingMore(0),
            Verdict::NothingWrong,
            Verdict::Insists,
            Verdict::Ends,
            Verdict::Settled,
        ] {
            assert_eq!(held.judge(verdict, "ended|held"), Ok(()), "{verdict:?}");
        }
        let rests = seen(|_| 900, &[]);
        for verdict in [Verdict::Rests, Verdict::Still] {
            assert_eq!(rests.judge(verdict, ""), Ok(()), "{verdict:?}");
        }
        assert_eq!(seen(closes, &[]).judge(Verdict::GoesOn, ""), Ok(()));
    }

    #[test]
    fn what_goes_wrong_is_noticed() {
        let runs = || seen(closes, &[]);
        let late = || seen(stays_at(800), &[(20, 880), (2000, 300)]);
        let led_on = || {
            let steps: Vec<(u64, i16)> = (0..20).map(|nth| (nth * 100, closes(nth * 50))).collect();
            seen(|ms| closes(ms / 2), &steps)
        };
        let goes_on = Seen {
            has_ended: false,
            ..seen(stays_at(800), &[(20, 880)])
        };
        let odd = Seen {
            defaults: 7_i16.to_le_bytes().repeat(6),
            ..runs()
        };
        for (what, seen, verdict, words) in [
            ("runs to the fist", runs(), Verdict::Held(1000), ""),
            ("runs to the fist", runs(), Verdict::Rests, ""),
            ("runs to the fist", runs(), Verdict::Still, ""),
            ("is told nothing", runs(), Verdict::Insists, ""),
            ("is told late", late(), Verdict::Held(1000), ""),
            ("is told late", late(), Verdict::NothingMore(1000), ""),
            (
                "is told what nobody asked for",
                late(),
                Verdict::NothingWrong,
                "",
            ),
            ("is led on", led_on(), Verdict::NothingMore(500), ""),
            ("is led on", led_on(), Verdict::Insists, ""),
            ("does not end", goes_on, Verdict::HeldAtTheEnd(100), ""),
            ("stays", seen(|_| 900, &[]), Verdict::GoesOn, ""),
            ("keeps an odd default", odd, Verdict::Settled, ""),
            ("says nothing of it", runs(), Verdict::GoesOn, "held|lost"),
        ] {
            assert!(seen.judge(verdict, words).is_err(), "{what}: {verdict:?}");
        }
    }
}
