//! Commands that a hand accepts at any time, and the only way to a register write. No framing, no sending.

use crate::hand::dof::{Dof, PerDof};
use crate::hand::register::{self, Register, Span};
use crate::hand::units::{Force, Gesture, Speed, Target};
use arrayvec::ArrayVec;

/// Bytes in the longest write: six 16-bit values.
pub const WRITE_LEN_MAX: usize = 12;
/// Writes in the longest command: alternate joints, each a run of its own, or four IP octets.
pub const WRITES_MAX: usize = 6;

/// Register used to start gestures, as the manual gives GESTURE_NO_SET no address (protocol choice 10).
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum GestureRoute {
    /// Write the number to 1008, as older drivers do.
    #[default]
    Register1008,
    /// Write the number to 2320, then 1 to 2322, as the maker's newer demos do.
    ActionLibrary,
    /// Never write undocumented addresses.
    Off,
}

/// A command that a hand accepts at any time: motion, limits, clearing errors. Persistent values are
/// [`Setting`](crate::hand::Setting)s, functions at rest are [`Trigger`](crate::hand::Trigger)s.
///
/// ```
/// use handscope_core::hand::{Angle, Dof, HandCommand, PerDof, Target};
///
/// let mut targets = PerDof::splat(None);
/// targets[Dof::Index] = Some(Target::Go(Angle::new(500)?));
/// let writes = HandCommand::Angles(targets).writes();
/// assert_eq!(writes[0].address(), 1492);
/// assert_eq!(writes[0].bytes(), [0xF4, 0x01]);
/// # Ok::<(), handscope_core::hand::OutOfRange>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::VariantNames, strum::IntoStaticStr))]
pub enum HandCommand {
    /// Move the given joints now (manual 2.6.11). The other joints keep their target in the hand, where writes of another
    /// controller can be seen.
    Angles(PerDof<Option<Target>>),
    /// Set the force thresholds of the given joints (manual 2.6.12).
    Forces(PerDof<Option<Force>>),
    /// Set the speeds of the given joints (manual 2.6.13).
    Speeds(PerDof<Option<Speed>>),
    /// Move to a stored pose (manual 2.6.7); no write at all if the route is off.
    Gesture(Gesture, GestureRoute),
    /// Clear all clearable errors (manual 2.6.3).
    ClearErrors,
}

/// One write to the hand's memory. Only commands, settings and triggers create one, so all values are in the manual's ranges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegisterWrite {
    span: Span,
    bytes: ArrayVec<u8, WRITE_LEN_MAX>,
}

impl RegisterWrite {
    /// Range of the hand's memory that it writes.
    pub const fn span(&self) -> Span {
        self.span
    }

    /// Address of the first byte.
    pub const fn address(&self) -> u16 {
        self.span.address
    }

    /// The bytes in memory order, 1..=12.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// True if the write can move the hand.
    pub fn is_motion(&self) -> bool {
        [
            register::ANGLE_SET,
            register::GESTURE_NO_SET,
            register::ACTION_SEQ_INDEX,
            register::ACTION_SEQ_RUN,
        ]
        .iter()
        .any(|row| row.span().covers(self.span))
    }

    /// Value written to each joint, if the write lies within this row of six 16-bit values.
    pub fn shorts(&self, row: &Register) -> PerDof<Option<i16>> {
        let (pairs, _odd) = self.bytes.as_chunks::<2>();
        let first = usize::from(self.span.address.saturating_sub(row.address) / 2);
        PerDof::from_fn(|dof| {
            let nth = dof.index().checked_sub(first)?;
            pairs.get(nth).copied().map(i16::from_le_bytes)
        })
    }

    pub(super) fn byte(row: &Register, value: u8) -> Self {
        Self::run(row.address, [value])
    }

    pub(super) fn run(address: u16, bytes: impl IntoIterator<Item = u8>) -> Self {
        let bytes: ArrayVec<u8, WRITE_LEN_MAX> = bytes.into_iter().take(WRITE_LEN_MAX).collect();
        let len = u16::try_from(bytes.len()).unwrap_or_default();
        Self {
            span: Span::new(address, len),
            bytes,
        }
    }
}

/// Writes of one command, in the order they must be sent.
pub type Writes = ArrayVec<RegisterWrite, WRITES_MAX>;

impl HandCommand {
    /// True if the command can move the hand.
    pub fn is_motion(&self) -> bool {
        self.writes().iter().any(RegisterWrite::is_motion)
    }

    /// Returns the register writes in order. Joints without a value are not written.
    pub fn writes(&self) -> Writes {
        let mut out = Writes::new();
        match self {
            Self::Angles(targets) => runs(
                &register::ANGLE_SET,
                targets.map(|v| v.map(Target::raw)),
                &mut out,
            ),
            Self::Forces(values) => runs(
                &register::FORCE_SET,
                values.map(|v| v.map(Force::get)),
                &mut out,
            ),
            Self::Speeds(values) => runs(
                &register::SPEED_SET,
                values.map(|v| v.map(Speed::get)),
                &mut out,
            ),
            Self::Gesture(number, GestureRoute::Register1008) => {
                out.push(RegisterWrite::byte(&register::GESTURE_NO_SET, number.get()));
            }
            Self::Gesture(number, GestureRoute::ActionLibrary) => {
                out.push(RegisterWrite::byte(
                    &register::ACTION_SEQ_INDEX,
                    number.get(),
                ));
                out.push(RegisterWrite::byte(&register::ACTION_SEQ_RUN, 1));
            }
            Self::Gesture(_, GestureRoute::Off) => {}
            Self::ClearErrors => out.push(RegisterWrite::byte(&register::CLEAR_ERROR, 1)),
        }
        out
    }
}

/// Adds one write for each run of neighbouring joints that have a value.
pub(super) fn runs(row: &Register, values: PerDof<Option<i16>>, out: &mut Writes) {
    let mut run: Option<(Dof, ArrayVec<u8, WRITE_LEN_MAX>)> = None;
    let flush = |run: &mut Option<(Dof, ArrayVec<u8, WRITE_LEN_MAX>)>, out: &mut Writes| {
        if let Some((first, bytes)) = run.take() {
            out.push(RegisterWrite::run(row.address + 2 * first as u16, bytes));
        }
    };
    for (dof, value) in values.iter() {
        match value {
            Some(value) => {
                let (_, bytes) = run.get_or_insert_with(|| (dof, ArrayVec::new()));
                bytes.extend(value.to_le_bytes());
            }
            None => flush(&mut run, out),
        }
    }
    flush(&mut run, out);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::{Access, Element, by_address};
    use crate::hand::setting::{Setting, Trigger};
    use crate::hand::units::{Angle, HandId, OutOfRange, SerialSpeed};
    use proptest::prelude::*;
    use proptest::strategy::ValueTree as _;
    use proptest::test_runner::TestRunner;
    use std::collections::BTreeSet;
    use std::fmt::Debug;
    use strum::VariantNames as _;

    fn angles_from(raw: [i16; 6]) -> Result<PerDof<Angle>, OutOfRange> {
        let mut out = PerDof::splat(Angle::MAX);
        for ((_, angle), raw) in out.iter_mut().zip(raw) {
            *angle = Angle::new(raw)?;
        }
        Ok(out)
    }

    #[test]
    fn the_manuals_write_example_is_refused_where_it_leaves_the_range() {
        // Manual 2.2.2 writes 2000 to ANGLE_SET(4) although 2.6.11 allows -1 and 0 to 1000.
        assert!(angles_from([100, 100, 100, 100, 2000, 0]).is_err());
        let angles = angles_from([100, 100, 100, 100, 1000, 0]).unwrap();
        let writes = HandCommand::Angles(angles.map(Target::Go).map(Some)).writes();
        assert_eq!(writes[0].address(), 1486);
        assert_eq!(
            writes[0].bytes(),
            [0x64, 0, 0x64, 0, 0x64, 0, 0x64, 0, 0xE8, 0x03, 0, 0]
        );
    }

    #[test]
    fn leave_alone_is_minus_one() {
        let writes = HandCommand::Angles(PerDof::splat(Some(Target::Leave))).writes();
        assert_eq!(writes[0].bytes(), [0xFF; 12]);
    }

    #[test]
    fn only_joints_with_a_value_are_written() {
        let mut forces = PerDof::splat(None);
        forces[Dof::Ring] = Some(Force::GENTLE);
        forces[Dof::Middle] = Some(Force::RATED);
        forces[Dof::ThumbRotate] = Some(Force::MIN);
        let writes = HandCommand::Forces(forces).writes();
        let spans: Vec<_> = writes.iter().map(RegisterWrite::span).collect();
        assert_eq!(spans, [Span::new(1500, 4), Span::new(1508, 2)]);
        assert_eq!(writes[0].bytes(), [0xF4, 0x01, 0xD0, 0x07]);
        assert!(HandCommand::Forces(PerDof::splat(None)).writes().is_empty());
    }

    #[test]
    fn an_off_route_writes_nothing() {
        let gesture = HandCommand::Gesture(Gesture::MIN, GestureRoute::Off);
        assert!(gesture.writes().is_empty());
    }

    fn target() -> impl Strategy<Value = Target> {
        prop_oneof![
            Just(Target::Leave),
            any::<i16>().prop_map(|raw| Target::Go(Angle::nearest(raw))),
        ]
    }

    fn speeds() -> impl Strategy<Value = PerDof<Option<Speed>>> {
        let six = prop::array::uniform6(prop::option::of(any::<i16>()));
        six.prop_map(|six| PerDof::new(six).map(|speed| speed.map(Speed::nearest)))
    }

    fn forces() -> impl Strategy<Value = PerDof<Option<Force>>> {
        let six = prop::array::uniform6(prop::option::of(any::<i16>()));
        six.prop_map(|six| PerDof::new(six).map(|force| force.map(Force::nearest)))
    }

    fn route() -> impl Strategy<Value = GestureRoute> {
        prop_oneof![
            Just(GestureRoute::Register1008),
            Just(GestureRoute::ActionLibrary),
            Just(GestureRoute::Off),
        ]
    }

    fn commands() -> impl Strategy<Value = HandCommand> {
        let gesture = any::<u8>().prop_map(Gesture::nearest);
        prop_oneof![
            prop::array::uniform6(prop::option::of(target()))
                .prop_map(|t| HandCommand::Angles(PerDof::new(t))),
            forces().prop_map(HandCommand::Forces),
            speeds().prop_map(HandCommand::Speeds),
            (gesture, route()).prop_map(|(number, route)| HandCommand::Gesture(number, route)),
            Just(HandCommand::ClearErrors),
        ]
    }

    fn settings() -> impl Strategy<Value = Setting> {
        prop_oneof![
            forces().prop_map(Setting::DefaultForces),
            speeds().prop_map(Setting::DefaultSpeeds),
            any::<u8>().prop_map(|id| Setting::Id(HandId::nearest(id))),
            (0..4usize).prop_map(|i| Setting::SerialSpeed(SerialSpeed::ALL[i])),
            any::<[u8; 4]>().prop_map(|ip| Setting::IpAddress(ip.into())),
        ]
    }

    fn triggers() -> impl Strategy<Value = Trigger> {
        prop_oneof![
            Just(Trigger::Save),
            Just(Trigger::ResetParameters),
            Just(Trigger::CalibrateForce),
        ]
    }

    /// The names of what is drawn.
    fn drawn<T: Debug + Into<&'static str>>(
        from: impl Strategy<Value = T>,
    ) -> BTreeSet<&'static str> {
        let mut runner = TestRunner::deterministic();
        let mut draw = || from.new_tree(&mut runner).unwrap().current().into();
        (0..1000).map(|_| draw()).collect()
    }

    #[test]
    fn everything_that_can_be_written_is_drawn() {
        assert_eq!(drawn(commands()), names(HandCommand::VARIANTS));
        assert_eq!(drawn(settings()), names(Setting::VARIANTS));
        assert_eq!(drawn(triggers()), names(Trigger::VARIANTS));
    }

    fn names(all: &[&'static str]) -> BTreeSet<&'static str> {
        all.iter().copied().collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(u32::try_from(crate::soak::times(20_000)).unwrap()))]
        #[test]
        fn no_write_leaves_the_manuals_addresses_or_ranges(
            writes in prop_oneof![
                5 => commands().prop_map(|command| command.writes()),
                5 => settings().prop_map(|setting| setting.writes()),
                1 => triggers().prop_map(|trigger| Writes::from_iter([trigger.write()])),
            ]
        ) {
            for write in writes {
                let mut at = write.address();
                let mut rest = write.bytes();
                while !rest.is_empty() {
                    let row = by_address(at).expect("a listed address");
                    prop_assert_eq!(row.access, Access::ReadWrite);
                    let value = match row.element {
                        Element::Byte => i32::from(rest[0]),
                        Element::Short => i32::from(i16::from_le_bytes([rest[0], rest[1]])),
                        Element::Tactile => panic!("fingertips are read-only"),
                    };
                    prop_assert!(row.allows(value), "{row}: {value}");
                    let step = row.element_len();
                    rest = &rest[usize::from(step)..];
                    at += step;
                }
            }
        }
    }
}
