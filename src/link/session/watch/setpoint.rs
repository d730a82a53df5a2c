//! Compares one group of setpoints, as read back, with what was written, to attribute the values. Pure; others act on it.
//!
//! A joint may hold its previous value, the last write, or an earlier write within the time that a write may take, in
//! this order. Any other value is foreign, unless it looks like the hand's own rounding or limiting. A value that is
//! overwritten before it is read cannot be detected.

use crate::hand::feedback::sample::SET_OUT_OF_RANGE;
use crate::hand::{Dof, Moment, PerDof};
use crate::link::bus::late_replies::LATE_HORIZON;
use crate::record::{SetpointConflict, SetpointRegister};
use arrayvec::ArrayVec;
use std::collections::VecDeque;
use std::time::Duration;

/// This many readings of a foreign value …
const MISSES: usize = 3;
/// … within this time indicate another controller while this program keeps writing. One may be wrong.
const WITHIN: Duration = Duration::from_secs(1);
/// Maximum writes kept: as many as setpoint rounds fit into the time that a write may take.
const WRITES_MAX: usize = 512;
/// "No action" (manual 2.6.11).
const LEAVE: i16 = -1;
/// The value that some hands clamp it to.
const CLAMPED_LEAVE: i16 = 1000;
/// Tolerance, counts, for the position of a joint left alone, given that readings of a moving joint lag.
const LEFT_TOLERANCE: i16 = 50;

/// The value that one write has for one joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wrote {
    /// The write does not cover the joint.
    Nothing,
    /// Leave the joint unchanged: the hand decides the value it then holds.
    Leave,
    /// A target value.
    Value(i16),
}

#[derive(Debug, Clone, Copy)]
struct OwnWrite {
    number: u64,
    at: Moment,
    values: PerDof<Wrote>,
}

#[derive(Debug, Clone, Copy, Default)]
struct JointSetpoint {
    /// The last value held that was explained.
    held: Option<i16>,
    /// Writes before this number can no longer take effect.
    open_from: u64,
    /// The newest write that must have taken effect by now, if it was not seen to.
    due: Option<(u64, Wrote)>,
    /// The newest write through a previous wire that must have taken effect by now, at an unknown time.
    stale: Option<Wrote>,
    /// The minimum and maximum value seen: a hand that limits values holds none beyond.
    held_within: Option<(i16, i16)>,
    /// The last value this program wrote.
    wrote: Option<i16>,
}

impl JointSetpoint {
    /// Records a value that the joint was seen to hold.
    fn saw(&mut self, value: i16) {
        if value != LEAVE && value != SET_OUT_OF_RANGE {
            let (least, most) = self.held_within.unwrap_or((value, value));
            self.held_within = Some((least.min(value), most.max(value)));
        }
    }

    /// True if a hand that limits values could show this value: it never held a value beyond.
    fn limits(&self, wrote: Wrote, read: i16) -> bool {
        let Wrote::Value(wrote) = wrote else {
            return false;
        };
        self.held_within.is_none_or(|(least, most)| {
            if wrote > read {
                most <= read
            } else {
                least >= read
            }
        })
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ValueOrigin {
    Ours,
    /// Not written by this program, and no write of ours is pending.
    Changed,
    /// Not written by this program, while a write of ours may still take effect.
    Strange,
    /// The hand altered or ignored our value.
    NotTaken,
}

/// Result of a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SetpointCheck {
    /// Nothing unusual.
    Usual,
    /// Not proven by one reading: read again soon.
    Doubtful,
    /// Another controller's value.
    Foreign(SetpointConflict),
    /// The hand holds another value than it was sent, without any sign of another writer.
    NotTaken(SetpointConflict),
}

/// Watches one group of six setpoints.
#[derive(Debug)]
pub(crate) struct SetpointWatch {
    register: SetpointRegister,
    writes: VecDeque<OwnWrite>,
    next: u64,
    /// Writes before this number were sent through a previous wire: they may take effect late, in any order.
    reopened: u64,
    joints: PerDof<JointSetpoint>,
    /// The previous reading had an unexplained value.
    doubted: bool,
    misses: ArrayVec<Moment, MISSES>,
    /// The hand may set its own values until then.
    hand_decides_until: Option<Moment>,
    /// This hand was never seen to store a -1 unchanged.
    clamps_leave: bool,
}

impl SetpointWatch {
    pub(crate) fn new(register: SetpointRegister) -> Self {
        Self {
            register,
            writes: VecDeque::new(),
            next: 0,
            reopened: 0,
            joints: PerDof::splat(JointSetpoint::default()),
            doubted: false,
            misses: ArrayVec::new(),
            hand_decides_until: None,
            clamps_leave: true,
        }
    }

    /// Starts a fresh session: the values held before are forgotten, and our writes may still take effect.
    pub(crate) fn begin(&mut self) {
        self.reopened = self.next;
        for (_, joint) in self.joints.iter_mut() {
            *joint = JointSetpoint {
                open_from: self.next,
                ..JointSetpoint::default()
            };
        }
        self.doubted = false;
        self.misses.clear();
    }

    /// Records a write that was sent, or may have been.
    pub(crate) fn wrote(&mut self, values: PerDof<Wrote>, now: Moment) {
        for (dof, value) in values.iter() {
            if let Wrote::Value(value) = value {
                self.joints[dof].wrote = Some(*value);
            }
        }
        self.forget_old(now);
        if let Some(last) = self.writes.back_mut().filter(|last| last.values == values) {
            last.at = now;
            return;
        }
        if self.writes.len() == WRITES_MAX {
            self.forget_oldest();
        }
        self.writes.push_back(OwnWrite {
            number: self.next,
            at: now,
            values,
        });
        self.next += 1;
    }

    /// Accepts any value from now on, for as long as a write may take.
    pub(crate) fn hand_decides(&mut self, now: Moment) {
        self.hand_decides_until = Some(now.plus(LATE_HORIZON));
    }

    fn forget_old(&mut self, now: Moment) {
        while let Some(first) = self.writes.front()
            && now.since(first.at) >= LATE_HORIZON
        {
            self.forget_oldest();
        }
    }

    fn forget_oldest(&mut self) {
        let Some(write) = self.writes.pop_front() else {
            return;
        };
        for (dof, value) in write.values.iter() {
            let joint = &mut self.joints[dof];
            if *value == Wrote::Nothing {
                continue;
            }
            if write.number < self.reopened {
                joint.stale = Some(*value);
            } else if write.number >= joint.open_from {
                joint.due = Some((write.number, *value));
            }
        }
    }

    /// Judges a reading; `angles` are the joint positions read last.
    pub(crate) fn read(
        &mut self,
        values: &PerDof<i16>,
        angles: Option<PerDof<i16>>,
        asked: Moment,
    ) -> SetpointCheck {
        self.forget_old(asked);
        if self.hand_decides_until.is_some_and(|until| asked < until) {
            self.accept(values);
            return SetpointCheck::Usual;
        }
        let verdicts = PerDof::from_fn(|dof| {
            let angle = angles.map(|angles| angles[dof]);
            self.judge(dof, values[dof], angle)
        });
        let first = |wanted: &[ValueOrigin]| {
            let mut all = verdicts.iter();
            let found = all.find(|(_, verdict)| wanted.contains(verdict))?;
            Some(self.conflict(found.0, values))
        };
        let foreign = first(&[ValueOrigin::Changed, ValueOrigin::Strange]);
        let not_taken = first(&[ValueOrigin::NotTaken]);
        let is_changed = verdicts
            .iter()
            .any(|(_, seen)| *seen == ValueOrigin::Changed);
        let was_doubted = std::mem::replace(&mut self.doubted, is_changed);
        let Some(foreign) = foreign else {
            return not_taken.map_or(SetpointCheck::Usual, SetpointCheck::NotTaken);
        };
        if self.misses.is_full() {
            self.misses.remove(0);
        }
        self.misses.push(asked);
        let oldest = self.misses.first().filter(|_| self.misses.is_full());
        let many = oldest.is_some_and(|at| asked.since(*at) <= WITHIN);
        if !(many || is_changed && was_doubted) {
            return SetpointCheck::Doubtful;
        }
        self.misses.clear();
        self.doubted = false;
        self.accept(values);
        SetpointCheck::Foreign(foreign)
    }

    fn conflict(&self, dof: Dof, values: &PerDof<i16>) -> SetpointConflict {
        SetpointConflict {
            register: self.register,
            dof,
            holds: Some(values[dof]).filter(|value| *value != SET_OUT_OF_RANGE),
            wrote: self.joints[dof].wrote,
        }
    }

    /// Marks the values held now as explained, whoever wrote them.
    fn accept(&mut self, values: &PerDof<i16>) {
        for (dof, value) in values.iter() {
            let joint = &mut self.joints[dof];
            joint.held = Some(*value);
            joint.saw(*value);
            joint.open_from = self.next;
            joint.due = None;
        }
    }

    fn judge(&mut self, dof: Dof, read: i16, angle: Option<i16>) -> ValueOrigin {
        let joint = self.joints[dof];
        let open = self.open(dof);
        if joint.held == Some(read) {
            if !open.is_empty() && open.iter().all(|(_, wrote)| *wrote == Wrote::Value(read)) {
                self.joints[dof].saw(read);
                self.settle(dof, read, self.next);
                return ValueOrigin::Ours;
            }
            let says_this =
                |value| matches!(value, Wrote::Value(_)) && self.may_be(value, read, angle);
            let is_late = |(_, value)| matches!(value, Wrote::Value(_)) && !says_this(value);
            // The value held before may equal a later write.
            let is_newer = || self.writes.iter().any(|write| says_this(write.values[dof]));
            return if joint.due.is_some_and(is_late) && !is_newer() {
                ValueOrigin::NotTaken
            } else {
                ValueOrigin::Ours
            };
        }
        let is_this = |(_, value): &&(u64, Wrote)| self.may_be(*value, read, angle);
        if let Some((number, value)) = open.iter().find(is_this).copied() {
            self.clamps_leave &= !(value == Wrote::Leave && read == LEAVE);
            // A value near ours may come from an earlier write that still takes effect.
            let is_rounded = matches!(value, Wrote::Value(value) if value != read);
            self.settle(dof, read, number + u64::from(!is_rounded));
            if matches!(value, Wrote::Value(_)) {
                self.joints[dof].saw(read);
            }
            return ValueOrigin::Ours;
        }
        let earlier = self
            .writes
            .iter()
            .filter(|write| write.number < self.reopened);
        let mut earlier = earlier.map(|write| write.values[dof]).chain(joint.stale);
        if joint.held.is_none() || earlier.any(|value| self.may_be(value, read, angle)) {
            self.joints[dof].held = Some(read);
            self.joints[dof].saw(read);
            return ValueOrigin::Ours;
        }
        let is_limit = |(_, wrote): &&(u64, Wrote)| joint.limits(*wrote, read);
        match open.iter().find(is_limit).copied() {
            Some((number, _)) => {
                self.settle(dof, read, number + 1);
                self.joints[dof].saw(read);
                ValueOrigin::NotTaken
            }
            None if open.is_empty() => ValueOrigin::Changed,
            None => ValueOrigin::Strange,
        }
    }

    /// A joint's writes that may still take effect, in order, with their numbers.
    fn open(&self, dof: Dof) -> Vec<(u64, Wrote)> {
        let joint = self.joints[dof];
        let under_way = self.writes.iter();
        let under_way = under_way.filter(|write| write.number >= joint.open_from);
        let under_way = under_way.map(|write| (write.number, write.values[dof]));
        let all = joint.due.into_iter().chain(under_way);
        all.filter(|(_, value)| *value != Wrote::Nothing).collect()
    }

    /// Writes before this number have taken effect, or no longer can.
    fn settle(&mut self, dof: Dof, read: i16, open_from: u64) {
        let joint = &mut self.joints[dof];
        joint.held = Some(read);
        joint.open_from = open_from;
        joint.due = joint.due.filter(|(due, _)| *due >= open_from);
        joint.stale = None;
    }

    /// True if a hand that received this write may show this value.
    fn may_be(&self, wrote: Wrote, read: i16, angle: Option<i16>) -> bool {
        let near = |value: i16, within: i16| value.abs_diff(read) <= within.unsigned_abs();
        match wrote {
            Wrote::Nothing => false,
            Wrote::Leave => {
                let is_clamped = self.clamps_leave && read == CLAMPED_LEAVE;
                let is_there = angle.is_some_and(|angle| near(angle, LEFT_TOLERANCE));
                read == LEAVE || is_clamped || is_there
            }
            Wrote::Value(value) => near(value, self.register.rounds_by()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value that a hand holds after a write, given the value before.
    type Takes = fn(written: Wrote, holds: i16) -> i16;

    fn value(written: Wrote, holds: i16) -> i16 {
        match written {
            Wrote::Value(value) => value,
            Wrote::Nothing | Wrote::Leave => holds,
        }
    }

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    /// Streams to a hand for 20 s, at 50 or 1 per second, and reads ten times per second; returns all unusual results.
    fn streamed(takes: Takes, tells: fn(u64) -> Wrote, late_ms: u64) -> Vec<SetpointCheck> {
        let mut all = Vec::new();
        for every in [20, 1000] {
            let mut watch = SetpointWatch::new(SetpointRegister::AngleSet);
            let (mut holds, mut under_way) = (takes(Wrote::Value(1000), 1000), VecDeque::new());
            for t in 0..20_000 {
                if t > 500 && t % every == 0 {
                    watch.wrote(PerDof::splat(tells(t)), ms(t));
                    under_way.push_back((t + late_ms, tells(t)));
                }
                while let Some((_, written)) = under_way.pop_front_if(|(due, _)| *due <= t) {
                    holds = takes(written, holds);
                }
                if t % 97 == 0 {
                    let at = Some(PerDof::splat(holds));
                    let seen = watch.read(&PerDof::splat(holds), at, ms(t));
                    all.extend(Some(seen).filter(|seen| *seen != SetpointCheck::Usual));
                }
            }
        }
        all
    }

    fn sweep(t: u64) -> Wrote {
        let phase = i16::try_from(t % 4000).unwrap() / 2;
        Wrote::Value(if phase < 1000 {
            1000 - phase
        } else {
            phase - 1000
        })
    }

    #[test]
    fn whatever_a_hand_makes_of_what_it_is_told_is_no_other_controller() {
        let ways: [(&str, Takes, bool); 6] = [
            ("as told", value, false),
            (
                "rounds",
                |written, holds| value(written, holds) / 16 * 16,
                false,
            ),
            (
                "limits",
                |written, holds| value(written, holds).min(600),
                true,
            ),
            (
                "limits below",
                |written, holds| value(written, holds).max(400),
                true,
            ),
            (
                "both",
                |written, holds| value(written, holds).clamp(300, 700),
                true,
            ),
            ("ignores", |_, holds| holds, true),
        ];
        for (name, takes, is_reported) in ways {
            for late_ms in [0, 30, 300, 1900] {
                let seen = streamed(takes, sweep, late_ms);
                let foreign = seen
                    .iter()
                    .find(|seen| matches!(seen, SetpointCheck::Foreign(_)));
                assert_eq!(foreign, None, "{name}, {late_ms} ms late");
                let is_seen = seen
                    .iter()
                    .any(|seen| matches!(seen, SetpointCheck::NotTaken(_)));
                assert_eq!(is_seen, is_reported, "{name}, {late_ms} ms late: {seen:?}");
            }
        }
        let leaves: [(&str, Takes); 3] = [
            ("keeps -1", |written, holds| {
                if written == Wrote::Leave {
                    -1
                } else {
                    value(written, holds)
                }
            }),
            ("keeps the target", value),
            ("takes it for 1000", |written, holds| {
                if written == Wrote::Leave {
                    1000
                } else {
                    value(written, holds)
                }
            }),
        ];
        for (name, takes) in leaves {
            let tells = |t: u64| {
                if t % 700 < 300 {
                    Wrote::Leave
                } else {
                    sweep(t)
                }
            };
            assert_eq!(streamed(takes, tells, 20), [], "{name}");
        }
    }

    #[test]
    fn a_value_from_before_a_write_that_is_near_to_it_is_not_taken_for_it() {
        for (held, written) in [(800, 810), (810, 800), (800, 800)] {
            let mut watch = SetpointWatch::new(SetpointRegister::AngleSet);
            watch.wrote(PerDof::splat(Wrote::Value(written)), ms(100));
            for (value, t) in [(held, 101), (written, 150), (written, 200), (written, 5000)] {
                let seen = watch.read(&PerDof::splat(value), None, ms(t));
                assert_eq!(
                    seen,
                    SetpointCheck::Usual,
                    "{held}, {written}: {value} at {t}"
                );
            }
            watch.read(&PerDof::splat(held + 100), None, ms(5050));
            let foreign = watch.read(&PerDof::splat(held + 100), None, ms(5100));
            assert!(
                matches!(foreign, SetpointCheck::Foreign(_)),
                "{held}, {written}"
            );
        }
    }

    /// A foreign value arrives before ours is read back.
    #[test]
    fn a_value_beyond_what_the_hand_held_or_to_a_joint_that_stays_is_no_limit_of_the_hand() {
        for (held, written, foreign) in [
            (1000, 1000, 500),
            (500, 500, 900),
            (1000, 600, 300),
            (300, 600, 900),
            (0, 500, 700),
        ] {
            let mut watch = SetpointWatch::new(SetpointRegister::AngleSet);
            let read = |watch: &mut SetpointWatch, value, t| {
                watch.read(&PerDof::splat(value), None, ms(t))
            };
            assert_eq!(read(&mut watch, held, 0), SetpointCheck::Usual);
            watch.wrote(PerDof::splat(Wrote::Value(written)), ms(100));
            let seen = (0..10).map(|nth| read(&mut watch, foreign, 110 + 40 * nth));
            let foreign = seen.collect::<Vec<_>>();
            let is_foreign = |seen: &SetpointCheck| matches!(seen, SetpointCheck::Foreign(_));
            assert!(
                foreign[..3].iter().any(is_foreign),
                "{held}, {written}: {foreign:?}"
            );
        }
    }

    #[test]
    fn one_wrong_reading_is_doubtful_and_another_controllers_values_are_not() {
        let mut watch = SetpointWatch::new(SetpointRegister::AngleSet);
        let read =
            |watch: &mut SetpointWatch, value, t| watch.read(&PerDof::splat(value), None, ms(t));
        let write = |watch: &mut SetpointWatch, value, t| {
            watch.wrote(PerDof::splat(Wrote::Value(value)), ms(t));
        };
        assert_eq!(read(&mut watch, 1000, 0), SetpointCheck::Usual);
        for (nth, value) in (0..200).map(|nth| (nth, 900 - 4 * i16::try_from(nth).unwrap())) {
            write(&mut watch, value, 100 + 20 * nth);
            if nth % 5 == 0 {
                // Some readings are wrong.
                let seen = if nth % 100 == 50 { 7 } else { value };
                let check = read(&mut watch, seen, 105 + 20 * nth);
                assert_eq!(check == SetpointCheck::Usual, seen == value, "{nth}");
                assert!(!matches!(check, SetpointCheck::Foreign(_)), "{nth}");
            }
        }
        // Another controller streams as well: every other reading shows its values.
        let foreign = (0..20).find_map(|nth| {
            let t = 5000 + 100 * nth;
            write(&mut watch, 300, t);
            write(&mut watch, 330, t + 5);
            match read(&mut watch, if nth % 2 == 0 { 800 } else { 330 }, t + 10) {
                SetpointCheck::Foreign(conflict) => Some((nth, conflict)),
                _ => None,
            }
        });
        let conflict = SetpointConflict {
            register: SetpointRegister::AngleSet,
            dof: Dof::Little,
            holds: Some(800),
            wrote: Some(330),
        };
        assert_eq!(foreign, Some((4, conflict)));
        assert_eq!(conflict.to_string(), "ANGLE_SET: little 800, we wrote 330");
    }
}
