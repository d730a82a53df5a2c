//! Unitree's message to both hands of a robot as twelve motors, `unitree_go::msg::dds_::MotorCmds_`, as its DFX service accepts it:
//! motors 0 to 5 are the right hand's joints in register order, 6 to 11 the left hand's; only `q` of a motor is used, 0 bent to
//! 1 open. An error in the hand's own half refuses the message as a whole.

use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, PerDof};
use crate::inputs::dds::ctrl::{CtrlFault, CtrlMessage};
use crate::inputs::line::angle_of;
use crate::inputs::offer::OfferLimits;
use crate::record::file::format::cdr;
use crate::transport::dds::DdsTopic;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Limit of a message's length: twelve motors of 36 bytes and the header, with room for fields of later versions.
const BYTES_MAX: usize = 1024;

/// Topic for commands to both hands.
pub fn topic() -> DdsTopic {
    DdsTopic {
        name: "rt/inspire/cmd".into(),
        type_name: "unitree_go::msg::dds_::MotorCmds_".into(),
    }
}

/// The type, field by field.
#[derive(serde::Deserialize)]
struct MotorCmds {
    cmds: Vec<MotorCmd>,
}

#[derive(serde::Deserialize)]
struct MotorCmd {
    _mode: u8,
    q: f32,
    /// Speed, torque and gains of a motor, which this hand does not have.
    _others: [f32; 4],
    _reserve: [u32; 3],
}

/// Parses a message in CDR with its header for the hand of this side.
///
/// # Errors
/// [`CtrlFault`]; the message is refused as a whole. The other hand's motors are not checked.
pub fn parse(bytes: &[u8], side: Side) -> Result<CtrlMessage, CtrlFault> {
    if bytes.len() > BYTES_MAX {
        return Err(CtrlFault::Malformed);
    }
    let raw: MotorCmds = cdr::decode(bytes).ok_or(CtrlFault::Malformed)?;
    if raw.cmds.len() != Side::MOTORS {
        return Err(CtrlFault::Motors);
    }
    let mut aims: PerDof<Option<Angle>> = PerDof::splat(None);
    let mut hasher = DefaultHasher::new();
    for (dof, motor) in Dof::ALL
        .into_iter()
        .zip(raw.cmds.iter().skip(side.first_motor()))
    {
        aims[dof] = Some(angle_of(f64::from(motor.q)).ok_or(CtrlFault::Range)?);
        motor.q.to_bits().hash(&mut hasher);
    }
    Ok(CtrlMessage {
        aims,
        limits: OfferLimits::NONE,
        mark: hasher.finish(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// As CDR has it, by hand: `mode` and three bytes of padding, five numbers, three spare words.
    fn message(q: &[f32]) -> Vec<u8> {
        let mut all = vec![0, 1, 0, 0];
        all.extend(u32::try_from(q.len()).unwrap().to_le_bytes());
        for q in q {
            all.extend([1, 0, 0, 0]);
            all.extend(q.to_le_bytes());
            all.extend([7.5_f32; 4].iter().flat_map(|other| other.to_le_bytes()));
            all.extend([9_u32; 3].iter().flat_map(|spare| spare.to_le_bytes()));
        }
        all
    }

    /// CycloneDDS 11 wrote this of two motors at 0 and 0.25.
    const CYCLONE: &str = "000100000200000001000000000000000000f0400000f0400000f0400000f040090000000900000009000000010000000000803e0000f0400000f0400000f0400000f040090000000900000009000000";

    #[test]
    fn the_layout_is_that_of_cyclonedds() {
        let hex = message(&[0.0, 0.25]).into_iter();
        let hex = hex.map(|byte| format!("{byte:02x}"));
        assert_eq!(hex.collect::<String>(), CYCLONE);
    }

    const RIGHT: [f32; 6] = [0.0, 1.0, 0.5, 0.25, 1.000_000_1, 0.1];
    const LEFT: [f32; 6] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.4];

    fn counts(aims: &PerDof<Option<Angle>>) -> [i16; 6] {
        *aims.map(|aim| aim.unwrap().get()).as_array()
    }

    #[test]
    fn each_hand_takes_its_own_six_motors() {
        let both = message(&[RIGHT, LEFT].concat());
        let right = parse(&both, Side::Right).unwrap();
        assert_eq!(counts(&right.aims), [0, 1000, 500, 250, 1000, 100]);
        let left = parse(&both, Side::Left).unwrap();
        assert_eq!(counts(&left.aims), [1000, 900, 800, 700, 600, 400]);
        assert_ne!(right.mark, left.mark);
        assert_eq!(right.limits, OfferLimits::NONE);
        // The other hand's motors may be anything.
        let half = message(&[RIGHT, [f32::NAN; 6]].concat());
        assert!(parse(&half, Side::Right).is_ok());
        assert_eq!(parse(&half, Side::Left), Err(CtrlFault::Range));
    }

    #[test]
    fn what_is_wrong_is_refused_whole() {
        for wrong in [f32::NAN, f32::INFINITY, -0.01, 1.01, 500.0] {
            let mut right = RIGHT;
            right[3] = wrong;
            let refused = parse(&message(&[right, LEFT].concat()), Side::Right);
            assert_eq!(refused, Err(CtrlFault::Range), "{wrong}");
        }
        for motors in [&[][..], &RIGHT, &[0.5; 13]] {
            let refused = parse(&message(motors), Side::Right);
            assert_eq!(refused, Err(CtrlFault::Motors), "{motors:?}");
        }
        let whole = message(&[RIGHT, LEFT].concat());
        for cut in [0, 3, 7, 40, whole.len() - 1] {
            let refused = parse(&whole[..cut], Side::Right);
            assert_eq!(refused, Err(CtrlFault::Malformed), "{cut}");
        }
        let long = [whole, vec![0; 1000]].concat();
        assert_eq!(parse(&long, Side::Right), Err(CtrlFault::Malformed));
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
            let _either = parse(&bytes, Side::Left);
        }
    }
}
