//! What a gamepad says of itself when it is found, and which of its axes moves what.

use crate::inputs::pad::control::axis;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What a gamepad says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadFacts {
    /// The name that the device gives itself.
    pub name: String,
    /// Its device file.
    pub path: PathBuf,
    /// Who made it, by the list of USB.
    pub vendor: u16,
    /// What it is, by the vendor's list.
    pub product: u16,
    /// Its axes by the kernel's numbers.
    pub axes: BTreeMap<u16, AxisRange>,
    /// How its driver names the upper and the left face button.
    pub face: FaceOrder,
}

/// The ends of an axis, as the device names them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisRange {
    /// At the left, at the top, or let go.
    pub min: i32,
    /// At the right, at the bottom, or pressed.
    pub max: i32,
    /// How far from the middle it may rest.
    pub flat: i32,
}

/// How a driver names the upper and the left face button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceOrder {
    /// As the kernel asks for it: BTN_NORTH is above.
    ByPlace,
    /// By the letters of an Xbox pad, where X, at the left, is BTN_NORTH. So does the driver xpad.
    ByLetter,
}

/// What an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AxisUse {
    LeftX,
    LeftY,
    RightX,
    RightY,
    LeftTrigger,
    RightTrigger,
    CrossX,
    CrossY,
}

impl PadFacts {
    /// What each of its axes moves. Pads differ in where the right stick and the triggers are: most follow the kernel's own
    /// order, older and Bluetooth ones that of the USB tables.
    pub(crate) fn uses(&self) -> BTreeMap<u16, (AxisUse, AxisRange)> {
        let has = |code: u16| self.axes.contains_key(&code);
        let stick_is_rx = has(axis::RX) && has(axis::RY);
        let right = if stick_is_rx {
            [axis::RX, axis::RY]
        } else {
            [axis::Z, axis::RZ]
        };
        let candidates = [
            [axis::BRAKE, axis::GAS],
            [axis::HAT2Y, axis::HAT2X],
            [axis::Z, axis::RZ],
        ];
        let triggers = candidates.into_iter().find(|pair| {
            let is_free = stick_is_rx || *pair != right;
            is_free && pair.iter().all(|code| has(*code))
        });
        let [left_x, left_y] = [axis::X, axis::Y];
        let [right_x, right_y] = right;
        let mut wanted = vec![
            (left_x, AxisUse::LeftX),
            (left_y, AxisUse::LeftY),
            (right_x, AxisUse::RightX),
            (right_y, AxisUse::RightY),
            (axis::HAT0X, AxisUse::CrossX),
            (axis::HAT0Y, AxisUse::CrossY),
        ];
        if let Some([left, right]) = triggers {
            wanted.extend([(left, AxisUse::LeftTrigger), (right, AxisUse::RightTrigger)]);
        }
        let there = wanted.into_iter().filter_map(|(code, what)| {
            let range = self.axes.get(&code)?;
            Some((code, (what, *range)))
        });
        there.collect()
    }
}
