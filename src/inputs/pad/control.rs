//! Controls of a gamepad by their location, and their names in the Linux kernel.

use serde::{Deserialize, Serialize};

/// A control of a gamepad. Letters are those of an Xbox pad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PadControl {
    /// Lowest face button: A, cross.
    South,
    /// Right face button: B, circle.
    East,
    /// Left face button: X, square.
    West,
    /// Top face button: Y, triangle.
    North,
    /// Above the left trigger: LB, L1.
    LeftBumper,
    /// RB, R1.
    RightBumper,
    /// LT, L2.
    LeftTrigger,
    /// RT, R2.
    RightTrigger,
    /// The left stick, tilted.
    LeftStick,
    /// The right stick, tilted.
    RightStick,
    /// The left stick, pressed: L3.
    LeftStickPress,
    /// R3.
    RightStickPress,
    /// Up on the D-pad.
    DpadUp,
    /// Down on the D-pad.
    DpadDown,
    /// Left on the D-pad.
    DpadLeft,
    /// Right on the D-pad.
    DpadRight,
    /// Back, Share, View.
    Select,
    /// Start, Options, Menu.
    Start,
    /// The logo button in the middle.
    Home,
}

/// Type of a control's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlKind {
    /// Down or up.
    Button,
    /// From 0 to 1, returns to 0 when released.
    Trigger,
    /// Two axes from -1 to 1, returns to the centre when released.
    Stick,
}

impl PadControl {
    /// All controls, in table order.
    pub const ALL: [Self; 19] = [
        Self::South,
        Self::East,
        Self::West,
        Self::North,
        Self::LeftBumper,
        Self::RightBumper,
        Self::LeftTrigger,
        Self::RightTrigger,
        Self::LeftStick,
        Self::RightStick,
        Self::LeftStickPress,
        Self::RightStickPress,
        Self::DpadUp,
        Self::DpadDown,
        Self::DpadLeft,
        Self::DpadRight,
        Self::Select,
        Self::Start,
        Self::Home,
    ];

    /// Type of its motion.
    pub const fn kind(self) -> ControlKind {
        match self {
            Self::LeftTrigger | Self::RightTrigger => ControlKind::Trigger,
            Self::LeftStick | Self::RightStick => ControlKind::Stick,
            _ => ControlKind::Button,
        }
    }

    /// Stable lower-case name for files and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::South => "south",
            Self::East => "east",
            Self::West => "west",
            Self::North => "north",
            Self::LeftBumper => "left_bumper",
            Self::RightBumper => "right_bumper",
            Self::LeftTrigger => "left_trigger",
            Self::RightTrigger => "right_trigger",
            Self::LeftStick => "left_stick",
            Self::RightStick => "right_stick",
            Self::LeftStickPress => "left_stick_press",
            Self::RightStickPress => "right_stick_press",
            Self::DpadUp => "dpad_up",
            Self::DpadDown => "dpad_down",
            Self::DpadLeft => "dpad_left",
            Self::DpadRight => "dpad_right",
            Self::Select => "select",
            Self::Start => "start",
            Self::Home => "home",
        }
    }

    /// Returns the control with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.name() == name)
    }
}

/// Buttons and axes by the names and numbers of linux/input-event-codes.h. The kernel's numbers never change.
const KERNEL_NAMES: [(&str, u16); 31] = [
    ("BTN_SOUTH", key::SOUTH),
    ("BTN_EAST", key::EAST),
    ("BTN_NORTH", key::NORTH),
    ("BTN_WEST", key::WEST),
    ("BTN_TL", key::TL),
    ("BTN_TR", key::TR),
    ("BTN_TL2", key::TL2),
    ("BTN_TR2", key::TR2),
    ("BTN_SELECT", key::SELECT),
    ("BTN_START", key::START),
    ("BTN_MODE", key::MODE),
    ("BTN_THUMBL", key::THUMBL),
    ("BTN_THUMBR", key::THUMBR),
    ("BTN_DPAD_UP", key::DPAD_UP),
    ("BTN_DPAD_DOWN", key::DPAD_DOWN),
    ("BTN_DPAD_LEFT", key::DPAD_LEFT),
    ("BTN_DPAD_RIGHT", key::DPAD_RIGHT),
    ("ABS_X", axis::X),
    ("ABS_Y", axis::Y),
    ("ABS_Z", axis::Z),
    ("ABS_RX", axis::RX),
    ("ABS_RY", axis::RY),
    ("ABS_RZ", axis::RZ),
    ("ABS_GAS", axis::GAS),
    ("ABS_BRAKE", axis::BRAKE),
    ("ABS_HAT0X", axis::HAT0X),
    ("ABS_HAT0Y", axis::HAT0Y),
    ("ABS_HAT1X", axis::HAT1X),
    ("ABS_HAT1Y", axis::HAT1Y),
    ("ABS_HAT2X", axis::HAT2X),
    ("ABS_HAT2Y", axis::HAT2Y),
];

/// The kernel's code of a button or axis name.
pub fn kernel_code(name: &str) -> Option<u16> {
    let known = KERNEL_NAMES.into_iter().find(|(own, _)| *own == name);
    known.map(|(_, code)| code)
}

/// The kernel's codes of a gamepad's buttons.
pub(crate) mod key {
    pub(crate) const SOUTH: u16 = 0x130;
    pub(crate) const EAST: u16 = 0x131;
    pub(crate) const NORTH: u16 = 0x133;
    pub(crate) const WEST: u16 = 0x134;
    pub(crate) const TL: u16 = 0x136;
    pub(crate) const TR: u16 = 0x137;
    pub(crate) const TL2: u16 = 0x138;
    pub(crate) const TR2: u16 = 0x139;
    pub(crate) const SELECT: u16 = 0x13a;
    pub(crate) const START: u16 = 0x13b;
    pub(crate) const MODE: u16 = 0x13c;
    pub(crate) const THUMBL: u16 = 0x13d;
    pub(crate) const THUMBR: u16 = 0x13e;
    pub(crate) const DPAD_UP: u16 = 0x220;
    pub(crate) const DPAD_DOWN: u16 = 0x221;
    pub(crate) const DPAD_LEFT: u16 = 0x222;
    pub(crate) const DPAD_RIGHT: u16 = 0x223;
}

/// The kernel's codes of a gamepad's axes.
pub(crate) mod axis {
    pub(crate) const X: u16 = 0x00;
    pub(crate) const Y: u16 = 0x01;
    pub(crate) const Z: u16 = 0x02;
    pub(crate) const RX: u16 = 0x03;
    pub(crate) const RY: u16 = 0x04;
    pub(crate) const RZ: u16 = 0x05;
    pub(crate) const GAS: u16 = 0x09;
    pub(crate) const BRAKE: u16 = 0x0a;
    pub(crate) const HAT0X: u16 = 0x10;
    pub(crate) const HAT0Y: u16 = 0x11;
    pub(crate) const HAT1X: u16 = 0x12;
    pub(crate) const HAT1Y: u16 = 0x13;
    pub(crate) const HAT2X: u16 = 0x14;
    pub(crate) const HAT2Y: u16 = 0x15;
}
