//! The newest reading of each group of a hand, each with its own times. Decoding from memory bytes; no history.

use crate::hand::dof::{Dof, PerDof, PerFinger};
use crate::hand::feedback::fault::Faults;
use crate::hand::feedback::group::{Group, Groups};
use crate::hand::feedback::reading::{
    AngleReading, CurrentReading, ForceReading, JointValue, PositionReading, TemperatureReading,
};
use crate::hand::feedback::status::Status;
use crate::hand::feedback::tactile::TactileBlock;
use crate::hand::moment::{Moment, Timed};
use crate::hand::register::Span;
use crate::hand::units::{Force, Speed, Target};
use arrayvec::ArrayVec;

/// Placeholder in [`HandSample::memory`] for a set value outside its range; this number is outside every range.
pub const SET_OUT_OF_RANGE: i16 = i16::MIN;

/// Calls `$six` on the values of a joint group or `$tip` on the block of a fingertip.
macro_rules! of_group {
    ($sample:ident, $group:expr, $six:expr, $tip:expr) => {
        match $group {
            Group::AngleSet => $six($sample.angle_set),
            Group::ForceSet => $six($sample.force_set),
            Group::SpeedSet => $six($sample.speed_set),
            Group::Position => $six($sample.position),
            Group::Angle => $six($sample.angle),
            Group::Force => $six($sample.force),
            Group::Current => $six($sample.current),
            Group::Faults => $six($sample.faults),
            Group::Status => $six($sample.status),
            Group::Temperature => $six($sample.temperature),
            Group::Tactile(finger) => $tip($sample.tactile[finger]),
        }
    };
}

/// The newest reading of each group. `None` = never read on this connection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HandSample {
    /// ANGLE_SET as stored in the hand; an element outside the manual's range is `None`.
    pub angle_set: Option<Timed<PerDof<Option<Target>>>>,
    /// FORCE_SET as stored in the hand.
    pub force_set: Option<Timed<PerDof<Option<Force>>>>,
    /// SPEED_SET as stored in the hand.
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
    /// The fingertip blocks; they come from two reads, so their times differ.
    pub tactile: PerFinger<Option<Timed<TactileBlock>>>,
}

/// Contents of a range of the hand's memory, as read.
#[derive(Debug, Clone, Copy)]
pub struct Reply<'a> {
    /// Address range of the bytes.
    pub span: Span,
    /// Contents, `span.len` bytes.
    pub bytes: &'a [u8],
    /// Time at which the request was sent.
    pub asked: Moment,
    /// Time at which the whole reply had arrived.
    pub received: Moment,
}

impl HandSample {
    /// Decodes every group that the reply covers entirely, and returns those groups. Partly covered groups are unchanged.
    pub fn apply(&mut self, reply: &Reply<'_>) -> Groups {
        let is_held = |group: &Group| {
            let Some(bytes) = reply.span.slice(reply.bytes, group.span()) else {
                return false;
            };
            match *group {
                Group::AngleSet => store_six(&mut self.angle_set, reply, bytes),
                Group::ForceSet => store_six(&mut self.force_set, reply, bytes),
                Group::SpeedSet => store_six(&mut self.speed_set, reply, bytes),
                Group::Position => store_six(&mut self.position, reply, bytes),
                Group::Angle => store_six(&mut self.angle, reply, bytes),
                Group::Force => store_six(&mut self.force, reply, bytes),
                Group::Current => store_six(&mut self.current, reply, bytes),
                Group::Faults => store_six(&mut self.faults, reply, bytes),
                Group::Status => store_six(&mut self.status, reply, bytes),
                Group::Temperature => store_six(&mut self.temperature, reply, bytes),
                Group::Tactile(finger) => store(
                    &mut self.tactile[finger],
                    reply,
                    TactileBlock::decode(bytes),
                ),
            }
        };
        Group::ALL.into_iter().filter(is_held).collect()
    }

    /// Request and receive time of a group; `None` if it was never read.
    pub fn times(&self, group: Group) -> Option<(Moment, Moment)> {
        fn of<T>(read: Option<Timed<T>>) -> Option<(Moment, Moment)> {
            read.map(|read| (read.asked, read.received))
        }
        of_group!(self, group, of, of)
    }

    /// The bytes of a group as the hand sent them, in memory order; `None` if it was never read. Set values outside their range are not
    /// stored; they are replaced by [`SET_OUT_OF_RANGE`].
    pub fn memory(&self, group: Group) -> Option<Vec<u8>> {
        fn six<T: JointValue>(read: Option<Timed<PerDof<T>>>) -> Option<Vec<u8>> {
            let sent = |value: &T| value.sent().unwrap_or(SET_OUT_OF_RANGE).to_le_bytes();
            let six = read?.value;
            let bytes = six.as_array().iter();
            Some(
                bytes
                    .flat_map(|value| sent(value).into_iter().take(T::BYTES))
                    .collect(),
            )
        }
        let tip = |read: Option<Timed<TactileBlock>>| Some(read?.value.as_sent().to_vec());
        of_group!(self, group, six, tip)
    }

    /// Returns the sent number, if stored, of a value outside the manual's range; `None` if it is in range, has none or was never read.
    pub fn out_of_range(&self, group: Group, dof: Dof) -> Option<Option<i16>> {
        fn of<T: JointValue>(read: Option<Timed<PerDof<T>>>, dof: Dof) -> Option<Option<i16>> {
            let value = read?.value[dof];
            value.is_out_of_range().then(|| value.sent())
        }
        of_group!(self, group, |read| of(read, dof), |_tip| None)
    }

    /// Receive time of the most recently received of these groups; `None` if none was read.
    pub fn newest(&self, groups: Groups) -> Option<Moment> {
        let of = Group::ALL
            .into_iter()
            .filter(|group| groups.contains(*group));
        of.filter_map(|group| self.times(group))
            .map(|times| times.1)
            .max()
    }

    /// True if every joint's angle is known and no older than `limit` at `now`.
    pub fn angles_fresh(&self, now: Moment, limit: std::time::Duration) -> bool {
        self.angle.is_some_and(|angle| angle.age(now) <= limit)
    }

    /// Targets that keep every joint at its last reading; joints without a plausible reading get [`Target::Leave`].
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

fn store_six<T: JointValue>(
    into: &mut Option<Timed<PerDof<T>>>,
    reply: &Reply<'_>,
    bytes: &[u8],
) -> bool {
    let value = |raw: &[u8]| {
        T::decode(match raw {
            [low, high] => i16::from_le_bytes([*low, *high]),
            raw => raw.first().copied().unwrap_or_default().into(),
        })
    };
    let six: ArrayVec<T, { Dof::ALL.len() }> = bytes.chunks_exact(T::BYTES).map(value).collect();
    store(into, reply, six.into_inner().ok().map(PerDof::new))
}

fn store<T>(into: &mut Option<Timed<T>>, reply: &Reply<'_>, value: Option<T>) -> bool {
    let is_there = value.is_some();
    if let Some(value) = value {
        *into = Some(Timed {
            value,
            asked: reply.asked,
            received: reply.received,
        });
    }
    is_there
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::Finger;
    use crate::hand::register;
    use crate::hand::units::Angle;

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
        let fresh = sample.apply(&reply(register::ANGLE_ACT.span(), &data));
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
        let fresh = sample.apply(&reply(span, &[0; 77]));
        assert!(fresh.contains(Group::Status) && !fresh.contains(Group::Temperature));
        assert!(sample.temperature.is_none() && sample.position.is_none());
    }

    #[test]
    fn a_reply_shorter_than_its_span_gives_nothing_that_is_not_there() {
        for len in 0..78 {
            let mut sample = HandSample::default();
            let bytes = vec![0; len];
            let fresh = sample.apply(&reply(register::STATE, &bytes));
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
        sample.apply(&reply(Span::new(3000, 232), &memory[..232]));
        assert!(sample.tactile[Finger::Thumb].is_none());
        sample.apply(&reply(Span::new(3232, 58), &memory[232..]));
        for (finger, block) in sample.tactile.iter() {
            assert_eq!(block.unwrap().value.raw[0], finger as u32 + 1);
        }
    }
}
