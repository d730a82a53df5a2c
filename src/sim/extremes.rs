//! Values that no hand should send, written over the memory in the `extremes` scenario. Changes nothing else.

use crate::hand::register::{ANGLE_ACT, CURRENT, ERROR, FORCE_ACT, POS_ACT, STATUS, TEMP};
use crate::hand::{Finger, Group, TactileBlock};
use crate::sim::memory::Memory;

/// Time for which a set of values stays before it moves to the next finger, ms.
const STAY_MS: u64 = 1000;

/// Overwrites the live values with impossible ones.
pub(crate) fn overlay(memory: &mut Memory, now_ms: u64) {
    let turn = usize::try_from(now_ms / STAY_MS % 6).unwrap_or_default();
    let shorts = [
        (&POS_ACT, [-120, 2000, -1, 2047, i16::MIN, 0]),
        (&ANGLE_ACT, [1013, -7, 1000, 0, i16::MAX, 500]),
        (&FORCE_ACT, [4000, -4000, 4001, -4100, i16::MAX, i16::MIN]),
        (&CURRENT, [2000, 2001, -3, i16::MAX, 0, i16::MIN]),
    ];
    for (row, mut values) in shorts {
        values.rotate_right(turn);
        for (element, value) in (0..).zip(values) {
            memory.put_short(row, element, value);
        }
    }
    let bytes = [
        (&ERROR, [0x20, 0x40, 0x80, 0xE0, 0xFF, 0x1F]),
        (&STATUS, [4, 255, 8, 254, 7, 3]),
        (&TEMP, [255, 0, 100, 101, 128, 85]),
    ];
    for (row, mut values) in bytes {
        values.rotate_right(turn);
        memory.put(row.address, &values);
    }
    for finger in Finger::ALL {
        memory.put(Group::Tactile(finger).span().address, &block(finger));
    }
}

fn block(finger: Finger) -> [u8; 58] {
    let plain = TactileBlock {
        raw: [u32::MAX; 8],
        normal_n: 20.0,
        normal_delta: i32::MAX,
        tangential_n: 20.0,
        tangential_delta: i32::MIN,
        direction_raw: 359,
        proximity: 16_000_000,
        check: 0,
        sum: 0,
        reserved: [0xFF; 2],
    };
    let odd = match finger {
        Finger::Little => TactileBlock {
            normal_n: f32::NAN,
            direction_raw: 360,
            ..plain
        },
        Finger::Ring => TactileBlock {
            normal_n: f32::INFINITY,
            tangential_n: f32::NEG_INFINITY,
            ..plain
        },
        Finger::Middle => TactileBlock {
            raw: [0; 8],
            normal_n: -1.0e-40,
            tangential_n: f32::MAX,
            proximity: i32::MIN,
            ..plain
        },
        Finger::Index => TactileBlock {
            raw: [0, u32::MAX, 1, 16_000_000, 0, u32::MAX, 0, 3_000_000],
            direction_raw: 65534,
            proximity: -1,
            ..plain
        },
        Finger::Thumb => plain,
    };
    let mut bytes = odd.encode();
    // The ring finger's check word does not match its bytes.
    if let (Finger::Ring, Some(check)) = (finger, bytes.get_mut(54)) {
        *check ^= 0x5A;
    }
    bytes
}
