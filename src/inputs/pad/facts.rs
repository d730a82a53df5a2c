//! Properties of a gamepad on detection, and the assignment of its axes.

use crate::inputs::pad::control::axis;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Properties of a gamepad.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadFacts {
    /// Name that the device reports.
    pub name: String,
    /// Its device file.
    pub path: PathBuf,
    /// USB vendor id.
    pub vendor: u16,
    /// USB product id.
    pub product: u16,
    /// Axes by the kernel's code.
    pub axes: BTreeMap<u16, AxisRange>,
    /// Naming of the top and the left face button by its driver.
    pub face: FaceOrder,
}

/// Range of an axis, as the device reports it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisRange {
    /// Left, top, or released.
    pub min: i32,
    /// Right, bottom, or pressed.
    pub max: i32,
    /// Distance from the centre within which it may rest.
    pub flat: i32,
}

/// Naming of the top and the left face button by a driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceOrder {
    /// As the kernel specifies: BTN_NORTH is the top one.
    ByPlace,
    /// By the letters of an Xbox pad, where X, on the left, is BTN_NORTH. The xpad driver does this.
    ByLetter,
}

/// Assignment of an axis.
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
    /// Assigns each axis. Pads differ in the axes of the right stick and the triggers: most follow the kernel's order,
    /// older and Bluetooth ones that of the USB tables.
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
