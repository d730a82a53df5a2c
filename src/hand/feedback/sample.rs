//! The newest of everything that a hand has told us, each group with its own times. Decoding from memory bytes; no history.

use crate::hand::dof::{Finger, PerDof, PerFinger};
use crate::hand::feedback::fault::Faults;
use crate::hand::feedback::reading::{
    AngleReading, CurrentReading, ForceReading, PositionReading, TemperatureReading,
};
use crate::hand::feedback::status::Status;
use crate::hand::feedback::tactile::TactileBlock;
use crate::hand::moment::{Moment, Timed};
use crate::hand::register::{self, Register, Span};
use crate::hand::units::{Angle, Force, Speed, Target};

/// Stands in [`HandSample::memory`] for a set value outside its range, as it is outside of every range.
pub const SET_OUT_OF_RANGE: i16 = i16::MIN;

/// The groups of a sample, as a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Groups(u16);

/// One group of registers that is read as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Group {
    /// ANGLE_SET.
    AngleSet,
    /// FORCE_SET.
    ForceSet,
    /// SPEED_SET.
    SpeedSet,
    /// POS_ACT.
    Position,
    /// ANGLE_ACT.
    Angle,
    /// FORCE_ACT.
    Force,
    /// CURRENT.
    Current,
    /// ERROR.
    Faults,
    /// STATUS.
    Status,
    /// TEMP.
    Temperature,
    /// One fingertip.
    Tactile(Finger),
}

impl Group {
    /// Where it stands in the hand's memory.
    pub const fn span(self) -> Span {
        match self {
            Self::AngleSet => register::ANGLE_SET.span(),
            Self::ForceSet => register::FORCE_SET.span(),
            Self::SpeedSet => register::SPEED_SET.span(),
            Self::Position => register::POS_ACT.span(),
            Self::Angle => register::ANGLE_ACT.span(),
            Self::Force => register::FORCE_ACT.span(),
            Self::Current => register::CURRENT.span(),
            Self::Faults => register::ERROR.span(),
            Self::Status => register::STATUS.span(),
            Self::Temperature => register::TEMP.span(),
            Self::Tactile(finger) => touch_span(finger),
        }
    }

    /// All, joints first.
    pub fn all() -> impl Iterator<Item = Self> {
        [
            Self::AngleSet,
            Self::ForceSet,
            Self::SpeedSet,
            Self::Position,
            Self::Angle,
            Self::Force,
            Self::Current,
            Self::Faults,
            Self::Status,
            Self::Temperature,
        ]
        .into_iter()
        .chain(Finger::ALL.map(Self::Tactile))
    }

    const fn bit(self) -> u16 {
        match self {
            Self::AngleSet => 1,
            Self::ForceSet => 1 << 1,
            Self::SpeedSet => 1 << 2,
            Self::Position => 1 << 3,
            Self::Angle => 1 << 4,
            Self::Force => 1 << 5,
            Self::Current => 1 << 6,
            Self::Faults => 1 << 7,
            Self::Status => 1 << 8,
            Self::Temperature => 1 << 9,
            Self::Tactile(finger) => 1 << (10 + finger as u16),
        }
    }
}

impl FromIterator<Group> for Groups {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        let mut all = Self::NONE;
        groups.into_iter().for_each(|group| all.insert(group));
        all
    }
}

impl Groups {
    /// No group.
    pub const NONE: Self = Self(0);

    /// Adds a group.
    pub const fn insert(&mut self, group: Group) {
        self.0 |= group.bit();
    }

    /// True if the group is in the set.
    pub const fn contains(self, group: Group) -> bool {
        self.0 & group.bit() != 0
    }

    /// The groups of both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True if no group is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True if any fingertip is in the set.
    pub const fn has_tactile(self) -> bool {
        self.0 >> 10 != 0
    }
}

/// The newest of everything the hand has told us. `None` = never read on this connection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HandSample {
    /// ANGLE_SET as the hand holds it; an element outside the manual's range is `None`.
    pub angle_set: Option<Timed<PerDof<Option<Target>>>>,
    /// FORCE_SET as the hand holds it.
    pub force_set: Option<Timed<PerDof<Option<Force>>>>,
    /// SPEED_SET as the hand holds it.
    pub speed_set: Option<Timed<PerDof<Option<Speed>>>>,
    /// POS_ACT.
    pub position: Option<Timed<PerDof<PositionReading>>>,
    /// ANGLE_ACT.
    pub angle: Option<Timed<PerDof<AngleReading>>>,
    /// FORCE_ACT.
    pub force: Option<Timed<PerDof<ForceReading>>>,
    /// CURRENT.
    pub current: Option<Timed<PerDof<CurrentReading>>>,
    /// ERROR.
    pub faults: Option<Timed<PerDof<Faults>>>,
    /// STATUS.
    pub status: Option<Timed<PerDof<Status>>>,
    /// TEMP.
    pub temperature: Option<Timed<PerDof<TemperatureReading>>>,
    /// The fingertip blocks; two reads fill them, so their times differ.
    pub tactile: PerFinger<Option<Timed<TactileBlock>>>,
}

/// A piece of the hand's memory as it was read.
#[derive(Debug, Clone, Copy)]
pub struct Reply<'a> {
    /// The bytes' place.
    pub span: Span,
    /// The bytes, `span.len` of them.
    pub bytes: &'a [u8],
    /// When the request left.
    pub asked: Moment,
    /// When the whole reply was there.
    pub received: Moment,
}

impl HandSample {
    /// Takes every group that the reply covers whole, and says which. Groups covered in part are left as they were.
    pub fn take(&mut self, reply: &Reply<'_>) -> Groups {
        let taken = self.take_set(reply).into_iter();
        let taken = taken.chain(self.take_actual(reply));
        let there = taken.filter(|(_, there)| *there);
        let mut fresh: Groups = there.map(|(group, _)| group).collect();
        for finger in Finger::ALL {
            let block = part(reply, touch_span(finger)).and_then(TactileBlock::decode);
            if let Some(value) = block {
                fresh.insert(Group::Tactile(finger));
                self.tactile[finger] = Some(timed(reply, value));
            }
        }
        fresh
    }

    /// Takes what is set, and says of each group whether it was there.
    fn take_set(&mut self, reply: &Reply<'_>) -> [(Group, bool); 3] {
        let force = |raw| Force::new(raw).ok();
        let speed = |raw| Speed::new(raw).ok();
        [
            (
                Group::AngleSet,
                shorts(reply, &register::ANGLE_SET, &mut self.angle_set, target),
            ),
            (
                Group::ForceSet,
                shorts(reply, &register::FORCE_SET, &mut self.force_set, force),
            ),
            (
                Group::SpeedSet,
                shorts(reply, &register::SPEED_SET, &mut self.speed_set, speed),
            ),
        ]
    }

    /// Takes what is measured, and says of each group whether it was there.
    fn take_actual(&mut self, reply: &Reply<'_>) -> [(Group, bool); 7] {
        [
            (
                Group::Position,
                shorts(
                    reply,
                    &register::POS_ACT,
                    &mut self.position,
                    PositionReading::new,
                ),
            ),
            (
                Group::Angle,
                shorts(
                    reply,
                    &register::ANGLE_ACT,
                    &mut self.angle,
                    AngleReading::new,
                ),
            ),
            (
                Group::Force,
                shorts(
                    reply,
                    &register::FORCE_ACT,
                    &mut self.force,
                    ForceReading::new,
                ),
            ),
            (
                Group::Current,
                shorts(
                    reply,
                    &register::CURRENT,
                    &mut self.current,
                    CurrentReading::new,
                ),
            ),
            (
                Group::Faults,
                bytes(reply, &register::ERROR, &mut self.faults, Faults::from_raw),
            ),
            (
                Group::Status,
                bytes(reply, &register::STATUS, &mut self.status, Status::from_raw),
            ),
            (
                Group::Temperature,
                bytes(
                    reply,
                    &register::TEMP,
                    &mut self.temperature,
                    TemperatureReading::new,
                ),
            ),
        ]
    }

    /// When the request for a group left, and when its reply was there; `None` if it was never read.
    pub fn times(&self, group: Group) -> Option<(Moment, Moment)> {
        fn of<T>(read: &Option<Timed<T>>) -> Option<(Moment, Moment)> {
            read.as_ref().map(|read| (read.asked, read.received))
        }
        match group {
            Group::AngleSet => of(&self.angle_set),
            Group::ForceSet => of(&self.force_set),
            Group::SpeedSet => of(&self.speed_set),
            Group::Position => of(&self.position),
            Group::Angle => of(&self.angle),
            Group::Force => of(&self.force),
            Group::Current => of(&self.current),
            Group::Faults => of(&self.faults),
            Group::Status => of(&self.status),
            Group::Temperature => of(&self.temperature),
            Group::Tactile(finger) => of(&self.tactile[finger]),
        }
    }

    /// The bytes of a group as the hand sent them, in memory order; `None` if it was never read. Of set values outside their range the
    /// hand's own number is not kept: [`SET_OUT_OF_RANGE`] stands in its place.
    pub fn memory(&self, group: Group) -> Option<Vec<u8>> {
        fn shorts<T: Copy>(
            read: &Option<Timed<PerDof<T>>>,
            raw: impl Fn(T) -> i16,
        ) -> Option<Vec<u8>> {
            let six = read.as_ref()?.value.as_array();
            let bytes = six.iter().flat_map(|value| raw(*value).to_le_bytes());
            Some(bytes.collect())
        }
        fn bytes<T: Copy>(
            read: &Option<Timed<PerDof<T>>>,
            raw: impl Fn(T) -> u8,
        ) -> Option<Vec<u8>> {
            let six = read.as_ref()?.value.as_array();
            Some(six.iter().map(|value| raw(*value)).collect())
        }
        match group {
            Group::AngleSet => shorts(&self.angle_set, |set| {
                set.map_or(SET_OUT_OF_RANGE, Target::raw)
            }),
            Group::ForceSet => shorts(&self.force_set, |set| {
                set.map_or(SET_OUT_OF_RANGE, Force::get)
            }),
            Group::SpeedSet => shorts(&self.speed_set, |set| {
                set.map_or(SET_OUT_OF_RANGE, Speed::get)
            }),
            Group::Position => shorts(&self.position, PositionReading::raw),
            Group::Angle => shorts(&self.angle, AngleReading::raw),
            Group::Force => shorts(&self.force, ForceReading::raw),
            Group::Current => shorts(&self.current, CurrentReading::raw),
            Group::Faults => bytes(&self.faults, Faults::raw),
            Group::Status => bytes(&self.status, Status::raw),
            Group::Temperature => bytes(&self.temperature, TemperatureReading::raw),
            Group::Tactile(finger) => {
                self.tactile[finger].map(|block| block.value.as_sent().to_vec())
            }
        }
    }

    /// When the newest of these groups was received.
    pub fn newest(&self, groups: Groups) -> Option<Moment> {
        let of = Group::all().filter(|group| groups.contains(*group));
        of.filter_map(|group| self.times(group))
            .map(|times| times.1)
            .max()
    }

    /// True if every joint's angle is known and no older than `limit` at `now`.
    pub fn angles_fresh(&self, now: Moment, limit: std::time::Duration) -> bool {
        self.angle.is_some_and(|angle| angle.age(now) <= limit)
    }

    /// The targets that keep every joint where it was last seen; joints without a sensible reading are left alone.
    pub fn hold_targets(&self) -> PerDof<Target> {
        PerDof::from_fn(|dof| {
            self.angle
                .and_then(|angle| angle.value[dof].hold())
                .map_or(Target::Leave, Target::Go)
        })
    }

    /// True if any drive reports a fault.
    pub fn has_fault(&self) -> bool {
        self.faults
            .is_some_and(|faults| faults.value.iter().any(|(_, faults)| !faults.is_empty()))
    }
}

/// Where a finger's block lies (manual 2.6).
pub const fn touch_span(finger: Finger) -> Span {
    Span::new(register::TOUCH.address + 58 * finger as u16, 58)
}

fn target(raw: i16) -> Option<Target> {
    match raw {
        -1 => Some(Target::Leave),
        raw => Angle::new(raw).ok().map(Target::Go),
    }
}

fn part<'a>(reply: &Reply<'a>, inner: Span) -> Option<&'a [u8]> {
    reply.span.slice(reply.bytes, inner)
}

const fn timed<T>(reply: &Reply<'_>, value: T) -> Timed<T> {
    Timed {
        value,
        asked: reply.asked,
        received: reply.received,
    }
}

fn shorts<T>(
    reply: &Reply<'_>,
    row: &Register,
    into: &mut Option<Timed<PerDof<T>>>,
    decode: impl Fn(i16) -> T,
) -> bool {
    let Some(raw) = part(reply, row.span()) else {
        return false;
    };
    let (pairs, _) = raw.as_chunks::<2>();
    let Ok(pairs) = <[[u8; 2]; 6]>::try_from(pairs) else {
        return false;
    };
    *into = Some(timed(
        reply,
        PerDof::new(pairs.map(|pair| decode(i16::from_le_bytes(pair)))),
    ));
    true
}

fn bytes<T>(
    reply: &Reply<'_>,
    row: &Register,
    into: &mut Option<Timed<PerDof<T>>>,
    decode: impl Fn(u8) -> T,
) -> bool {
    let Some(raw) = part(reply, row.span()) else {
        return false;
    };
    let Ok(raw) = <[u8; 6]>::try_from(raw) else {
        return false;
    };
    *into = Some(timed(reply, PerDof::new(raw.map(decode))));
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::Dof;

    fn reply(span: Span, bytes: &[u8]) -> Reply<'_> {
        Reply {
            span,
            bytes,
            asked: Moment::from_micros(1000),
            received: Moment::from_micros(2000),
        }
    }

    #[test]
    fn the_manuals_angle_reply_decodes_to_its_numbers() {
        // Manual 2.2.1: 100, 100, 100, 100, 2000, 0. The fifth is outside ANGLE_ACT's own range.
        let data = [0x64, 0, 0x64, 0, 0x64, 0, 0x64, 0, 0xD0, 0x07, 0, 0];
        let mut sample = HandSample::default();
        let fresh = sample.take(&reply(register::ANGLE_ACT.span(), &data));
        assert!(fresh.contains(Group::Angle) && !fresh.contains(Group::Force));
        let angle = sample.angle.unwrap();
        assert_eq!(
            angle.value.map(AngleReading::raw),
            PerDof::new([100, 100, 100, 100, 2000, 0])
        );
        assert_eq!(angle.value[Dof::ThumbBend].documented(), None);
        assert_eq!(sample.hold_targets()[Dof::ThumbBend], Target::Leave);
        assert_eq!(
            sample.hold_targets()[Dof::ThumbRotate],
            Target::Go(Angle::MIN)
        );
    }

    #[test]
    fn a_group_covered_in_part_is_left_as_it_was() {
        let span = Span::new(1546, 77);
        let mut sample = HandSample::default();
        let fresh = sample.take(&reply(span, &[0; 77]));
        assert!(fresh.contains(Group::Status) && !fresh.contains(Group::Temperature));
        assert!(sample.temperature.is_none() && sample.position.is_none());
    }

    #[test]
    fn a_reply_shorter_than_its_span_gives_nothing_that_is_not_there() {
        for len in 0..78 {
            let mut sample = HandSample::default();
            let bytes = vec![0; len];
            let fresh = sample.take(&reply(register::STATE, &bytes));
            assert_eq!(fresh.contains(Group::Angle), len >= 12);
            assert!(!fresh.contains(Group::Temperature));
        }
    }

    #[test]
    fn each_finger_has_its_own_block() {
        let mut memory = [0u8; 290];
        for finger in 0..5u8 {
            memory[usize::from(finger) * 58] = finger + 1;
        }
        let mut sample = HandSample::default();
        sample.take(&reply(Span::new(3000, 232), &memory[..232]));
        assert!(sample.tactile[Finger::Thumb].is_none());
        sample.take(&reply(Span::new(3232, 58), &memory[232..]));
        for (finger, block) in sample.tactile.iter() {
            assert_eq!(block.unwrap().value.raw[0], finger as u32 + 1);
        }
    }
}
