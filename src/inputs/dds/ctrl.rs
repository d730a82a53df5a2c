//! Unitree's message to a hand, `inspire::inspire_hand_ctrl` (`handscope help dds`). A message with an error is refused as a whole
//! and counted, never clamped into range.

use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Force, OutOfRange, PerDof, Speed};
use crate::inputs::offer::OfferLimits;
use crate::link::ArmRequest;
use crate::record::file::format::cdr;
use crate::transport::dds::DdsTopic;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Limit of a message's length: four lists of six numbers, the mode and the header are shorter.
const BYTES_MAX: usize = 80;
/// Queue of messages: two thirds of a second of them, so that no much older one is followed.
pub const KEPT: u16 = 64;
/// Bits of the mode, each of which enables one list.
const ANGLE: u8 = 1;
const POSITION: u8 = 2;
const FORCE: u8 = 4;
const SPEED: u8 = 8;

/// Topic for commands to the hand of this side.
pub fn topic(side: Side) -> DdsTopic {
    let side = match side {
        Side::Left => 'l',
        Side::Right => 'r',
    };
    DdsTopic {
        name: format!("rt/inspire_hand/ctrl/{side}"),
        type_name: "inspire::inspire_hand_ctrl".into(),
    }
}

/// Contents of one message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CtrlMessage {
    /// Targets of the joints.
    pub aims: PerDof<Option<Angle>>,
    /// Requested speeds and forces.
    pub limits: OfferLimits,
    /// Equal for equal targets.
    pub mark: u64,
}

/// Reason for refusing a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum CtrlFault {
    /// Not a message of the topic's type.
    #[error("not a message of its topic's type in CDR")]
    Malformed,
    /// The mode has a bit that the type does not define.
    #[error("its mode has bits other than angle 1, force 4 and speed 8")]
    Mode,
    /// The mode enables positions of the drives.
    #[error("it sets positions of the drives, mode 2: only angles, forces and speeds are accepted")]
    Position,
    /// Not six values.
    #[error("a hand has six joints")]
    Length,
    /// A value outside the range of the register or the joint.
    #[error("a value is outside the range of the register or the joint")]
    Range,
    /// Not the motors of two hands.
    #[error("two hands have twelve motors")]
    Motors,
    /// Not one position for each named joint.
    #[error("each named joint needs one position")]
    Unpaired,
    /// A joint of no or another hand, one named twice, or no driven one.
    #[error(
        "it names a joint that this hand does not have, one twice, or none of the six driven ones"
    )]
    UnknownJoint,
    /// A trajectory of several points.
    #[error("it has several points: send each as a message of its own when it is due")]
    Points,
    /// A point that is due later than a stream may be silent.
    #[error("its point is not due within 200 ms: send it when it is due")]
    Timing,
    /// A speed or force above the limits set by the user who granted control.
    #[error("a speed or force is above --speed or --force")]
    AboveLimit,
    /// Another sender is being followed.
    #[error("another sender is followed until it is silent")]
    OtherSender,
}

impl CtrlFault {
    /// Name in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Malformed => "malformed",
            Self::Mode => "mode",
            Self::Position => "position",
            Self::Length => "length",
            Self::Range => "range",
            Self::Motors => "motors",
            Self::Unpaired => "unpaired",
            Self::UnknownJoint => "unknown_joint",
            Self::Points => "points",
            Self::Timing => "timing",
            Self::AboveLimit => "above_limit",
            Self::OtherSender => "other_sender",
        }
    }
}

impl From<OutOfRange> for CtrlFault {
    fn from(_out: OutOfRange) -> Self {
        Self::Range
    }
}

/// The type, field by field.
#[derive(Debug, serde::Deserialize)]
struct Raw {
    pos_set: Vec<i16>,
    angle_set: Vec<i16>,
    force_set: Vec<i16>,
    speed_set: Vec<i16>,
    mode: u8,
}

/// True if a message requests a stop: it enables speeds, and all of them are 0. Its other lists, their lengths, other
/// bits of its mode and any trailing bytes are irrelevant.
pub fn is_stop(bytes: &[u8]) -> bool {
    let raw: Option<Raw> = cdr::decode(bytes);
    raw.is_some_and(|raw| {
        let is_still = raw.speed_set.iter().all(|speed| *speed == 0);
        raw.mode & SPEED != 0 && is_still && !raw.speed_set.is_empty()
    })
}

impl CtrlMessage {
    /// Parses a message in CDR with its header, within the user's limits.
    ///
    /// # Errors
    /// [`CtrlFault`]; the message is refused as a whole.
    pub fn parse(bytes: &[u8], allowed: &ArmRequest) -> Result<Self, CtrlFault> {
        if bytes.len() > BYTES_MAX {
            return Err(CtrlFault::Malformed);
        }
        let raw: Raw = cdr::decode(bytes).ok_or(CtrlFault::Malformed)?;
        if raw.mode & !(ANGLE | POSITION | FORCE | SPEED) != 0 {
            return Err(CtrlFault::Mode);
        }
        if raw.mode & POSITION != 0 {
            return Err(CtrlFault::Position);
        }
        // Lists that the mode does not enable are ignored, but must fit the type.
        if raw.pos_set.len() > Dof::ALL.len() {
            return Err(CtrlFault::Length);
        }
        let has = |bit: u8| raw.mode & bit != 0;
        let aims = six(&raw.angle_set, has(ANGLE), angle)?;
        let limits = OfferLimits {
            force: six(&raw.force_set, has(FORCE), |raw| Force::new(raw).map(Some))?,
            speed: six(&raw.speed_set, has(SPEED), |raw| Speed::new(raw).map(Some))?,
        };
        if !limits.within(allowed) {
            return Err(CtrlFault::AboveLimit);
        }
        let mut hasher = DefaultHasher::new();
        aims.map(|aim| aim.map(Angle::get))
            .as_array()
            .hash(&mut hasher);
        Ok(Self {
            aims,
            limits,
            mark: hasher.finish(),
        })
    }
}

/// The manual's "no action" (2.6.11) leaves a joint alone.
fn angle(raw: i16) -> Result<Option<Angle>, OutOfRange> {
    match raw {
        -1 => Ok(None),
        raw => Angle::new(raw).map(Some),
    }
}

/// Values of a list for each joint, if the mode enables it.
fn six<T: Copy>(
    list: &[i16],
    is_meant: bool,
    read: impl Fn(i16) -> Result<Option<T>, OutOfRange>,
) -> Result<PerDof<Option<T>>, CtrlFault> {
    let mut values = PerDof::splat(None);
    let is_long_enough = !is_meant || list.len() == Dof::ALL.len();
    if list.len() > Dof::ALL.len() || !is_long_enough {
        return Err(CtrlFault::Length);
    }
    if is_meant {
        for (dof, raw) in Dof::ALL.into_iter().zip(list) {
            values[dof] = read(*raw)?;
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// CycloneDDS 0.10.2 wrote these: `Ctrl([0]*6, [1000,-1,500,0,1,999], [0]*6, [0]*6, 1)`, and with the other lists empty.
    const CYCLONE: &str = "000100000600000000000000000000000000000006000000e803fffff40100000100e703060000000000000000000000000000000600000000000000000000000000000001";
    const EMPTY: &str = "000100000000000006000000e803fffff40100000100e703000000000000000001";

    fn allowed() -> ArmRequest {
        ArmRequest {
            speed: PerDof::splat(Speed::nearest(600)),
            force: PerDof::splat(Force::nearest(500)),
        }
    }

    fn bytes(hex: &str) -> Vec<u8> {
        let digits = hex.as_bytes().chunks(2);
        digits
            .map(|two| u8::from_str_radix(str::from_utf8(two).unwrap(), 16).unwrap())
            .collect()
    }

    /// As CDR has it, by hand: each list aligned to its length.
    fn message(lists: [&[i16]; 4], mode: u8) -> Vec<u8> {
        let mut all = vec![0, 1, 0, 0];
        for list in lists {
            all.resize(all.len().next_multiple_of(4), 0);
            all.extend(u32::try_from(list.len()).unwrap().to_le_bytes());
            all.extend(list.iter().flat_map(|value| value.to_le_bytes()));
        }
        all.push(mode);
        all
    }

    fn parse(lists: [&[i16]; 4], mode: u8) -> Result<CtrlMessage, CtrlFault> {
        CtrlMessage::parse(&message(lists, mode), &allowed())
    }

    #[test]
    fn what_cyclonedds_writes_is_read() {
        let angles = [1000, -1, 500, 0, 1, 999];
        assert_eq!(
            bytes(CYCLONE),
            message([&[0; 6], &angles, &[0; 6], &[0; 6]], 1)
        );
        for hex in [CYCLONE, EMPTY] {
            // Padding at the end belongs to the wire.
            let padded = [bytes(hex), vec![0; 3]].concat();
            let read = CtrlMessage::parse(&padded, &allowed()).unwrap();
            let counts = read.aims.map(|aim| aim.map(Angle::get));
            let want = angles.map(|angle| Some(angle).filter(|angle| *angle >= 0));
            assert_eq!(*counts.as_array(), want, "{hex}");
            assert_eq!(read.limits, OfferLimits::NONE);
        }
    }

    #[test]
    fn the_other_byte_order_is_read_too() {
        let mut big = vec![0, 0, 0, 0];
        for (len, value) in [(0, 0), (6, 258i16), (0, 0), (0, 0)] {
            big.extend(u32::to_be_bytes(len));
            big.extend((0..len).flat_map(|_| value.to_be_bytes()));
        }
        big.push(1);
        let read = CtrlMessage::parse(&big, &allowed()).unwrap();
        assert_eq!(read.aims, PerDof::splat(Some(Angle::nearest(258))));
    }

    #[test]
    fn what_is_wrong_is_refused_whole_and_never_bent() {
        let (six, none): (&[i16], &[i16]) = (&[500; 6], &[]);
        for (lists, mode, fault) in [
            ([six, six, six, six], 2, CtrlFault::Position),
            ([six, six, six, six], 3, CtrlFault::Position),
            ([six, six, six, six], 15, CtrlFault::Position),
            ([six, six, six, six], 16, CtrlFault::Mode),
            ([six, six, six, six], 129, CtrlFault::Mode),
            ([none, none, none, none], 1, CtrlFault::Length),
            ([none, &[500; 5], none, none], 1, CtrlFault::Length),
            ([none, &[500; 7], none, none], 1, CtrlFault::Length),
            ([none, six, &[500; 7], none], 1, CtrlFault::Length),
            ([&[500; 7], six, none, none], 1, CtrlFault::Length),
            ([none, six, none, none], 5, CtrlFault::Length),
            (
                [none, &[1001, 0, 0, 0, 0, 0], none, none],
                1,
                CtrlFault::Range,
            ),
            (
                [none, &[-2, 0, 0, 0, 0, 0], none, none],
                1,
                CtrlFault::Range,
            ),
            ([none, &[i16::MIN; 6], none, none], 1, CtrlFault::Range),
            ([none, none, &[3001; 6], none], 4, CtrlFault::Range),
            ([none, none, &[-1; 6], none], 4, CtrlFault::Range),
            ([none, none, none, &[1001; 6]], 8, CtrlFault::Range),
            ([none, six, &[501; 6], none], 5, CtrlFault::AboveLimit),
            ([none, six, none, &[601; 6]], 9, CtrlFault::AboveLimit),
        ] {
            assert_eq!(parse(lists, mode), Err(fault), "{lists:?} {mode}");
        }
        for cut in [0, 3, 4, 20, 40] {
            let whole = message([six; 4], 1);
            let refused = CtrlMessage::parse(&whole[..cut], &allowed());
            assert_eq!(refused, Err(CtrlFault::Malformed), "{cut}");
        }
        let long = [message([six; 4], 1), vec![0; 200]].concat();
        let refused = CtrlMessage::parse(&long, &allowed());
        assert_eq!(refused, Err(CtrlFault::Malformed));
    }

    #[test]
    fn speeds_of_zero_are_a_stop_whatever_else_is_in_the_message() {
        let (six, zero, none): (&[i16], &[i16], &[i16]) = (&[500; 6], &[0; 6], &[]);
        for (lists, mode, stops) in [
            ([none, none, none, zero], 8, true),
            ([none, six, none, zero], 9, true),
            ([none, zero, none, zero], 9, true),
            // Positions, other bits, values out of range, lists of another length.
            ([six, six, six, zero], 15, true),
            ([six, six, six, zero], 0x88, true),
            ([none, &[-7, 2000], &[9999; 6], zero], 13, true),
            ([&[1; 9], none, none, &[0; 5]], 8, true),
            ([none, none, none, &[0; 7]], 8, true),
            // Speeds that are not meant, as xr_teleoperate sends them.
            ([zero, six, zero, zero], 1, false),
            ([none, none, none, none], 8, false),
            ([none, six, none, &[0, 0, 0, 1, 0, 0]], 9, false),
        ] {
            let whole = message(lists, mode);
            assert_eq!(is_stop(&whole), stops, "{lists:?} {mode}");
            let longer = [whole.clone(), vec![7; 90]].concat();
            assert_eq!(is_stop(&longer), stops, "of a later version: {lists:?}");
            assert!(!is_stop(&whole[..whole.len() - 1]), "nobody knows its mode");
        }
    }

    #[test]
    fn the_mode_says_what_is_meant() {
        let six: &[i16] = &[500; 6];
        let force = PerDof::splat(Some(Force::nearest(500)));
        let speed = PerDof::splat(Some(Speed::nearest(500)));
        for (mode, aims, forces, speeds) in [
            (0, false, false, false),
            (1, true, false, false),
            (4, false, true, false),
            (9, true, false, true),
            (13, true, true, true),
        ] {
            let read = parse([&[], six, six, six], mode).unwrap();
            assert_eq!(read.aims[Dof::Index].is_some(), aims, "{mode}");
            assert_eq!(read.limits.force == force, forces, "{mode}");
            assert_eq!(read.limits.speed == speed, speeds, "{mode}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..120)) {
            let _either = (CtrlMessage::parse(&bytes, &allowed()), is_stop(&bytes));
        }
    }
}
