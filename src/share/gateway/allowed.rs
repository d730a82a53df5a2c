//! Writes allowed to a client of the gateway: targets and their limits. Everything else is refused here, for every client; values
//! that outlast power-off or disconnect the hand cannot be expressed. Pure.

use crate::hand::register::{ANGLE_SET, CLEAR_ERROR, FORCE_SET, GESTURE_NO_SET, SPEED_SET};
use crate::hand::{
    Angle, Dof, Force, Gesture, GestureRoute, HandCommand, ModbusException, OutOfRange, PerDof,
    Register, Speed, Target,
};

/// Converts words written at this address to a command.
///
/// # Errors
/// `IllegalAddress` for every register except ANGLE_SET, FORCE_SET, SPEED_SET, CLEAR_ERROR and GESTURE_NO_SET, and for a
/// write that extends beyond one of them; `IllegalValue` for values outside the manual's range.
pub(crate) fn command(address: u16, words: &[u16]) -> Result<HandCommand, ModbusException> {
    let wrong = |_range: OutOfRange| ModbusException::IllegalValue;
    if let Some(values) = joints(&ANGLE_SET, address, words) {
        let target = |value| match value {
            // The manual's "no action" (2.6.11).
            -1 => Ok(Target::Leave),
            angle => Angle::new(angle).map(Target::Go),
        };
        return checked(values, target)
            .map(HandCommand::Angles)
            .map_err(wrong);
    }
    if let Some(values) = joints(&FORCE_SET, address, words) {
        return checked(values, Force::new)
            .map(HandCommand::Forces)
            .map_err(wrong);
    }
    if let Some(values) = joints(&SPEED_SET, address, words) {
        return checked(values, Speed::new)
            .map(HandCommand::Speeds)
            .map_err(wrong);
    }
    match (address, words) {
        // Manual: adjacent single bytes; one word there is one of them.
        (at, [1]) if at == CLEAR_ERROR.address => Ok(HandCommand::ClearErrors),
        (at, [_]) if at == CLEAR_ERROR.address => Err(ModbusException::IllegalValue),
        (at, [number]) if at == GESTURE_NO_SET.address => Gesture::new(*number)
            .map(|gesture| HandCommand::Gesture(gesture, GestureRoute::Register1008))
            .map_err(wrong),
        _ => Err(ModbusException::IllegalAddress),
    }
}

/// Raw values of a function 16 request for all six joints of ANGLE_SET: the check for a stop comes before the checks of
/// its length, its other contents and its values. `None` if it does not contain all six.
pub(crate) fn all_angles(pdu: &[u8]) -> Option<PerDof<i16>> {
    let [16, high, low, _, _, _, words @ ..] = pdu else {
        return None;
    };
    let ahead = ANGLE_SET
        .address
        .checked_sub(u16::from_be_bytes([*high, *low]))?;
    let (words, _odd) = words.get(usize::from(ahead)..)?.as_chunks::<2>();
    let six: &[[u8; 2]; Dof::ALL.len()] = words.first_chunk()?;
    let is_whole = ahead.is_multiple_of(2);
    is_whole.then(|| PerDof::new(six.map(i16::from_be_bytes)))
}

/// Joint values of words at this address; `None` unless all words lie entirely in this register.
fn joints(register: &Register, address: u16, words: &[u16]) -> Option<PerDof<Option<i16>>> {
    let offset = address.checked_sub(register.address)?;
    let first = usize::from(offset / 2);
    let is_inside = offset.is_multiple_of(2) && first + words.len() <= Dof::ALL.len();
    if !is_inside || words.is_empty() {
        return None;
    }
    let mut values = PerDof::splat(None);
    for (dof, word) in Dof::ALL.into_iter().skip(first).zip(words) {
        values[dof] = Some(word.cast_signed());
    }
    Some(values)
}

fn checked<T: Copy>(
    values: PerDof<Option<i16>>,
    check: impl Fn(i16) -> Result<T, OutOfRange>,
) -> Result<PerDof<Option<T>>, OutOfRange> {
    let mut all = PerDof::splat(None);
    for (dof, value) in values.iter() {
        all[dof] = value.map(&check).transpose()?;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::RegisterWrite;
    use crate::hand::register::REGISTERS;
    use proptest::prelude::*;

    #[test]
    fn words_become_what_they_mean_for_the_joints_they_are_written_to() {
        let index = Some(Target::Go(Angle::nearest(500)));
        let mut angles = PerDof::splat(None);
        angles[Dof::Index] = index;
        assert_eq!(command(1492, &[500]), Ok(HandCommand::Angles(angles)));
        let mut angles = PerDof::splat(Some(Target::Leave));
        angles[Dof::Index] = index;
        let all = [0xFFFF, 0xFFFF, 0xFFFF, 500, 0xFFFF, 0xFFFF];
        assert_eq!(command(1486, &all), Ok(HandCommand::Angles(angles)));
        let mut forces = PerDof::splat(None);
        forces[Dof::Little] = Some(Force::MAX);
        forces[Dof::Ring] = Some(Force::MIN);
        assert_eq!(command(1498, &[3000, 0]), Ok(HandCommand::Forces(forces)));
        let speeds = PerDof::splat(Some(Speed::MAX));
        assert_eq!(command(1522, &[1000; 6]), Ok(HandCommand::Speeds(speeds)));
        assert_eq!(command(1004, &[1]), Ok(HandCommand::ClearErrors));
        let gesture = HandCommand::Gesture(Gesture::nearest(40), GestureRoute::Register1008);
        assert_eq!(command(1008, &[40]), Ok(gesture));
    }

    #[test]
    fn what_is_out_of_range_or_not_for_clients_is_refused() {
        use ModbusException::{IllegalAddress, IllegalValue};
        for (address, words, refused) in [
            (1486, &[1001][..], IllegalValue),
            (1486, &[0xFFFE], IllegalValue),
            (1498, &[3001], IllegalValue),
            (1498, &[0xFFFF], IllegalValue),
            (1522, &[0xFFFF], IllegalValue),
            (1004, &[0], IllegalValue),
            (1004, &[0x0100], IllegalValue),
            (1008, &[0], IllegalValue),
            (1008, &[41], IllegalValue),
            // Beyond the register, or into the middle of a joint.
            (1486, &[500; 7], IllegalAddress),
            (1496, &[500; 2], IllegalAddress),
            (1487, &[500], IllegalAddress),
            // CLEAR_ERROR and what stands beside it: SAVE, RESET_PARA.
            (1004, &[1, 1], IllegalAddress),
            (1000, &[1], IllegalAddress),
            (1002, &[0], IllegalAddress),
            (1005, &[1], IllegalAddress),
            (1006, &[1], IllegalAddress),
            (1009, &[1], IllegalAddress),
            (1032, &[500], IllegalAddress),
            (1044, &[500], IllegalAddress),
            (1066, &[500], IllegalAddress),
            (1474, &[500], IllegalAddress),
            (1546, &[500], IllegalAddress),
            (1700, &[0xA8C0, 0xD20B], IllegalAddress),
            (2320, &[1], IllegalAddress),
            (1020, &[500], IllegalAddress),
        ] {
            assert_eq!(command(address, words), Err(refused), "{address} {words:?}");
        }
    }

    #[test]
    fn every_register_that_clients_may_write_is_lost_with_the_power() {
        use crate::hand::register::Persistence;
        for row in REGISTERS {
            if command(row.address, &[1]).is_ok() {
                assert_eq!(row.persistence, Persistence::Volatile, "{row}");
            }
        }
    }

    #[test]
    fn six_angles_are_found_whatever_stands_around_them() {
        let six: [i16; 6] = [1003, -2, -1, 32767, 500, 0];
        let write = |address: u16, count: u16, words: &[i16]| {
            let len = u8::try_from(2 * count).unwrap_or(u8::MAX);
            let bytes = words.iter().flat_map(|word| word.to_be_bytes());
            let head = [address.to_be_bytes(), count.to_be_bytes()].concat();
            [[16].as_slice(), &head, &[len], &bytes.collect::<Vec<u8>>()].concat()
        };
        let longer = [&[7, 8][..], &six, &[9]].concat();
        for (pdu, found) in [
            (write(1486, 6, &six), true),
            (write(1482, 9, &longer), true),
            // It announces more, or less, than it has.
            (write(1486, 12, &six), true),
            (write(1486, 0, &six), true),
            (write(1486, 5, &six[..5]), false),
            (write(1488, 6, &six), false),
            (write(1485, 6, &six), false),
            (vec![6, 5, 206, 0, 0], false),
            (vec![16, 5], false),
        ] {
            let wanted = found.then_some(PerDof::new(six));
            assert_eq!(all_angles(&pdu), wanted, "{pdu:?}");
        }
    }

    proptest! {
        #[test]
        fn what_is_allowed_writes_those_registers_and_no_other(
            address in prop_oneof![any::<u16>(), 990..1720u16],
            words in prop::collection::vec(prop_oneof![any::<u16>(), 0..50u16], 0..14),
        ) {
            let writes = command(address, &words).map(|command| command.writes());
            for write in writes.iter().flatten() {
                let known = [ANGLE_SET, FORCE_SET, SPEED_SET, CLEAR_ERROR, GESTURE_NO_SET];
                let is_known = |write: &RegisterWrite| known.iter().any(|row| row.span().covers(write.span()));
                prop_assert!(is_known(write), "{write:?}");
            }
        }
    }
}
