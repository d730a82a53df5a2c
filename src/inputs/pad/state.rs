//! Present state of one gamepad's controls. Amounts are whole thousandths; the device's own numbers stay in this file.

use crate::inputs::pad::control::{PadControl, key};
use crate::inputs::pad::facts::{AxisRange, AxisUse, FaceOrder, PadFacts};
use crate::inputs::pad::report::KernelEvent;
use std::collections::{BTreeMap, BTreeSet};

/// A full amount, in thousandths.
pub const FULL: i16 = 1000;
/// Dead zone of a stick around its centre, thousandths: worn sticks do not return fully. A device may specify more.
const STICK_REST: i64 = 120;
/// Dead zone of a trigger at either end, thousandths.
const TRIGGER_REST: i64 = 40;

/// State of a gamepad's controls.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PadState {
    uses: BTreeMap<u16, (AxisUse, AxisRange)>,
    is_by_letter: bool,
    has_trigger_axes: bool,
    held: BTreeSet<PadControl>,
    sticks: [StickPlace; 2],
    triggers: [i16; 2],
}

/// Position of a stick, in thousandths.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StickPlace {
    /// -1000 at the left, 1000 at the right.
    pub right: i16,
    /// -1000 at the bottom, 1000 at the top.
    pub up: i16,
}

impl PadState {
    /// Initial state of this gamepad, with nothing held.
    pub fn of(facts: &PadFacts) -> Self {
        let uses = facts.uses();
        let is_trigger = |(what, _): &(AxisUse, AxisRange)| *what == AxisUse::RightTrigger;
        Self {
            has_trigger_axes: uses.values().any(is_trigger),
            uses,
            is_by_letter: facts.face == FaceOrder::ByLetter,
            ..Self::default()
        }
    }

    /// State of the same gamepad with all controls released.
    pub fn released(&self) -> Self {
        Self {
            held: BTreeSet::new(),
            sticks: Default::default(),
            triggers: Default::default(),
            ..self.clone()
        }
    }

    /// Applies an event. Events of unknown controls are ignored.
    pub fn apply(&mut self, event: KernelEvent) {
        match event {
            KernelEvent::Key { code, is_down } => self.button(code, is_down),
            KernelEvent::Axis { code, value } => {
                if let Some((what, range)) = self.uses.get(&code).copied() {
                    self.axis(what, range, value);
                }
            }
        }
    }

    /// Buttons that are down.
    pub const fn held(&self) -> &BTreeSet<PadControl> {
        &self.held
    }

    /// True if a button is down.
    pub fn is_held(&self, button: PadControl) -> bool {
        self.held.contains(&button)
    }

    /// Amount by which a trigger is pressed, 0 to 1000; 0 if it is not a trigger.
    pub const fn trigger(&self, trigger: PadControl) -> i16 {
        let [left, right] = self.triggers;
        match trigger {
            PadControl::LeftTrigger => left,
            PadControl::RightTrigger => right,
            _ => 0,
        }
    }

    /// Position of a stick; the centre if it is not a stick.
    pub const fn stick(&self, stick: PadControl) -> StickPlace {
        let [left, right] = self.sticks;
        match stick {
            PadControl::LeftStick => left,
            PadControl::RightStick => right,
            _ => StickPlace { right: 0, up: 0 },
        }
    }

    fn button(&mut self, code: u16, is_down: bool) {
        let [left, right] = &mut self.triggers;
        let control = match code {
            // Pads with analog triggers send these as well.
            key::TL2 | key::TR2 if self.has_trigger_axes => return,
            key::TL2 => {
                *left = if is_down { FULL } else { 0 };
                return;
            }
            key::TR2 => {
                *right = if is_down { FULL } else { 0 };
                return;
            }
            _ => button_of(code, self.is_by_letter),
        };
        if let Some(control) = control {
            self.set(control, is_down);
        }
    }

    fn axis(&mut self, what: AxisUse, range: AxisRange, value: i32) {
        let [left, right] = &mut self.sticks;
        let [left_trigger, right_trigger] = &mut self.triggers;
        match what {
            AxisUse::LeftX => left.right = off_middle(range, value),
            AxisUse::LeftY => left.up = -off_middle(range, value),
            AxisUse::RightX => right.right = off_middle(range, value),
            AxisUse::RightY => right.up = -off_middle(range, value),
            AxisUse::LeftTrigger => *left_trigger = pressed(range, value),
            AxisUse::RightTrigger => *right_trigger = pressed(range, value),
            AxisUse::CrossX => {
                let way = off_middle(range, value).signum();
                self.set(PadControl::DpadLeft, way < 0);
                self.set(PadControl::DpadRight, way > 0);
            }
            AxisUse::CrossY => {
                let way = off_middle(range, value).signum();
                self.set(PadControl::DpadUp, way < 0);
                self.set(PadControl::DpadDown, way > 0);
            }
        }
    }

    fn set(&mut self, control: PadControl, is_down: bool) {
        if is_down {
            self.held.insert(control)
        } else {
            self.held.remove(&control)
        };
    }
}

/// The button with this code.
const fn button_of(code: u16, is_by_letter: bool) -> Option<PadControl> {
    Some(match code {
        key::SOUTH => PadControl::South,
        key::EAST => PadControl::East,
        key::NORTH if is_by_letter => PadControl::West,
        key::WEST if is_by_letter => PadControl::North,
        key::NORTH => PadControl::North,
        key::WEST => PadControl::West,
        key::TL => PadControl::LeftBumper,
        key::TR => PadControl::RightBumper,
        key::SELECT => PadControl::Select,
        key::START => PadControl::Start,
        key::MODE => PadControl::Home,
        key::THUMBL => PadControl::LeftStickPress,
        key::THUMBR => PadControl::RightStickPress,
        key::DPAD_UP => PadControl::DpadUp,
        key::DPAD_DOWN => PadControl::DpadDown,
        key::DPAD_LEFT => PadControl::DpadLeft,
        key::DPAD_RIGHT => PadControl::DpadRight,
        _ => return None,
    })
}

/// Deflection of an axis from its centre, -1000 to 1000; 0 in the dead zone.
fn off_middle(range: AxisRange, value: i32) -> i16 {
    let (min, max) = (i64::from(range.min), i64::from(range.max));
    let whole = max - min;
    if whole <= 0 {
        return 0;
    }
    // Twice the distance, so that the middle of an odd number of steps is exact.
    let off = (2 * i64::from(value) - min - max).clamp(-whole, whole);
    // A device that reports half its range or more as rest is mistaken.
    let flat = (2 * i64::from(range.flat.max(0))).min(whole / 2);
    let rest = flat.max(whole * STICK_REST / i64::from(FULL));
    let beyond = (off.abs() - rest).max(0);
    let amount = thousandths(beyond, whole - rest);
    if off < 0 { -amount } else { amount }
}

/// Amount by which a trigger is pressed, 0 to 1000.
fn pressed(range: AxisRange, value: i32) -> i16 {
    let whole = i64::from(range.max) - i64::from(range.min);
    if whole <= 0 {
        return 0;
    }
    let rest = whole * TRIGGER_REST / i64::from(FULL);
    let way = (i64::from(value) - i64::from(range.min) - rest).clamp(0, whole - 2 * rest);
    thousandths(way, whole - 2 * rest)
}

/// A share in thousandths, rounded down.
fn thousandths(part: i64, whole: i64) -> i16 {
    let full = i64::from(FULL);
    let share = (part * full).checked_div(whole).unwrap_or(0);
    i16::try_from(share.clamp(0, full)).unwrap_or(0)
}
