//! The register map of manual 2.6 as one table, shared by codec, planner, simulator and reference; it makes no decisions.

use serde::Serialize;
use std::fmt;

/// A range of bytes in the hand's memory, by byte address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// Address of the first byte.
    pub address: u16,
    /// Number of bytes, at least 1.
    pub len: u16,
}

impl Span {
    /// Creates a range of `len` bytes from `address`.
    pub const fn new(address: u16, len: u16) -> Self {
        Self { address, len }
    }

    /// Address after the last byte.
    pub const fn end(self) -> u32 {
        self.address as u32 + self.len as u32
    }

    /// True if `inner` lies entirely inside.
    pub const fn covers(self, inner: Self) -> bool {
        self.address <= inner.address && inner.end() <= self.end()
    }

    /// Returns the part of `bytes` that covers `inner`; `bytes` are the contents of this range.
    pub fn slice(self, bytes: &[u8], inner: Self) -> Option<&[u8]> {
        let from = usize::from(inner.address.checked_sub(self.address)?);
        bytes.get(from..from + usize::from(inner.len))
    }
}

/// Type of one element of a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Element {
    /// An unsigned byte.
    Byte,
    /// A signed 16-bit number, low byte first.
    Short,
    /// A 58-byte fingertip block.
    Tactile,
}

/// Access of a register: read only, or read and write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Access {
    /// Read only.
    #[serde(rename = "r")]
    Read,
    /// Read and write.
    #[serde(rename = "rw")]
    ReadWrite,
}

/// Persistence of a value at power-off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Persistence {
    /// Lost at power-off.
    #[serde(rename = "no")]
    Volatile,
    /// Persistent after SAVE.
    #[serde(rename = "by SAVE")]
    Saved,
    /// Measured anew with each reading.
    #[serde(rename = "live")]
    Live,
}

/// Source of the knowledge about a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The manual's table.
    Manual,
    /// Third-party drivers; not in the manual's table.
    Field,
}

/// One row of the register map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Register {
    /// Name as printed in the manual.
    pub name: &'static str,
    /// Address of the first byte.
    pub address: u16,
    /// Length of the whole register in bytes.
    #[serde(rename = "bytes")]
    pub len: u16,
    /// Type of one element: byte, 16-bit value, fingertip block.
    pub element: Element,
    /// Access: read, or read and write.
    pub access: Access,
    /// Smallest and largest value of an element; `None` where the manual gives none.
    pub range: Option<(i32, i32)>,
    /// Allowed value outside the range (-1 = no action); `None` if there is none.
    pub also: Option<i32>,
    /// Factory value; `None` if the manual gives none.
    pub default: Option<i32>,
    /// Unit; empty if there is none.
    pub unit: &'static str,
    /// Persistence at power-off.
    #[serde(rename = "kept")]
    pub persistence: Persistence,
    /// Section of the manual.
    pub section: &'static str,
    /// Source: the manual's table, or only programs in the field.
    #[serde(skip)]
    pub origin: Origin,
    /// Meaning in one sentence, for `handscope registers`.
    pub meaning: &'static str,
}

impl Register {
    /// Range of bytes that it covers.
    pub const fn span(&self) -> Span {
        Span::new(self.address, self.len)
    }

    /// Bytes per element.
    pub const fn element_len(&self) -> u16 {
        match self.element {
            Element::Byte => 1,
            Element::Short => 2,
            Element::Tactile => 58,
        }
    }

    /// Number of elements.
    pub const fn count(&self) -> u16 {
        self.len / self.element_len()
    }

    /// True if one element may hold `value`.
    pub fn allows(&self, value: i32) -> bool {
        self.also == Some(value)
            || self
                .range
                .is_none_or(|(min, max)| (min..=max).contains(&value))
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, self.address)
    }
}

const fn byte(name: &'static str, address: u16, section: &'static str) -> Register {
    Register {
        name,
        address,
        len: 1,
        element: Element::Byte,
        access: Access::ReadWrite,
        range: Some((0, 1)),
        also: None,
        default: Some(0),
        unit: "",
        persistence: Persistence::Volatile,
        section,
        origin: Origin::Manual,
        meaning: "",
    }
}

const fn six(
    name: &'static str,
    address: u16,
    range: (i32, i32),
    section: &'static str,
) -> Register {
    Register {
        name,
        address,
        len: 12,
        element: Element::Short,
        access: Access::Read,
        range: Some(range),
        also: None,
        default: None,
        unit: "",
        persistence: Persistence::Live,
        section,
        origin: Origin::Manual,
        meaning: "",
    }
}

const fn ip(name: &'static str, address: u16, default: i32, meaning: &'static str) -> Register {
    Register {
        range: Some((0, 255)),
        default: Some(default),
        persistence: Persistence::Saved,
        meaning,
        ..byte(name, address, "2.6")
    }
}

const fn touch(name: &'static str, address: u16, meaning: &'static str) -> Register {
    Register {
        len: 58,
        element: Element::Tactile,
        range: None,
        meaning,
        ..six(name, address, (0, 0), "2.6.21")
    }
}

/// HAND_ID.
pub const HAND_ID: Register = Register {
    range: Some((1, 254)),
    default: Some(1),
    persistence: Persistence::Saved,
    meaning: "Id on the bus.",
    ..byte("HAND_ID", 1000, "2.6.1")
};
/// REDU_RATIO.
pub const REDU_RATIO: Register = Register {
    // Manual: printed as 0 to 4; the codes explained are 0 to 3 (RS485) and 0 to 1 (CAN).
    range: Some((0, 3)),
    persistence: Persistence::Saved,
    meaning: "Speed code. RS485: 0 = 115200, 1 = 57600, 2 = 19200, 3 = 921600. CAN: 0 = 1000K, 1 = 500K.",
    ..byte("REDU_RATIO", 1002, "2.6.2")
};
/// CLEAR_ERROR.
pub const CLEAR_ERROR: Register = Register {
    meaning: "1 clears stall, over-current, motor and communication faults; over-temperature ends by itself.",
    ..byte("CLEAR_ERROR", 1004, "2.6.3")
};
/// SAVE.
pub const SAVE: Register = Register {
    meaning: "1 writes the present parameters to flash.",
    ..byte("SAVE", 1005, "2.6.4")
};
/// RESET_PARA.
pub const RESET_PARA: Register = Register {
    meaning: "1 resets all parameters to the factory values.",
    ..byte("RESET_PARA", 1006, "2.6.5")
};
/// GESTURE_NO_SET, whose address the manual does not give.
pub const GESTURE_NO_SET: Register = Register {
    range: Some((1, 40)),
    default: Some(255),
    origin: Origin::Field,
    meaning: "Moves the hand to a stored pose: 1 to 13 fixed, 14 to 40 the user's. Address not in the manual's table.",
    ..byte("GESTURE_NO_SET", 1008, "2.6.7")
};
/// GESTURE_FORCE_CLB.
pub const GESTURE_FORCE_CLB: Register = Register {
    meaning: "1 calibrates the force sensors; the hand must be open and touch nothing.",
    ..byte("GESTURE_FORCE_CLB", 1009, "2.6.6")
};
/// DEFAULT_SPEED_SET(m).
pub const DEFAULT_SPEED_SET: Register = Register {
    access: Access::ReadWrite,
    persistence: Persistence::Saved,
    meaning: "Speeds after power-up.",
    ..six("DEFAULT_SPEED_SET", 1032, (0, 1000), "2.6.8")
};
/// DEFAULT_FORCE_SET(m).
pub const DEFAULT_FORCE_SET: Register = Register {
    access: Access::ReadWrite,
    unit: "g",
    persistence: Persistence::Saved,
    meaning: "Force thresholds after power-up.",
    ..six("DEFAULT_FORCE_SET", 1044, (0, 3000), "2.6.9")
};
/// USER_DEF_ANGLE(K, m), which the manual mentions without an address.
pub const USER_DEF_ANGLE: Register = Register {
    len: 27 * 12,
    access: Access::ReadWrite,
    // The manual does not say whether SAVE stores them; assumed to be persistent, like the other parameters.
    persistence: Persistence::Saved,
    origin: Origin::Field,
    meaning: "Six angles for each of the user's gestures 14 to 40. Address not in the manual's table.",
    ..six("USER_DEF_ANGLE", 1066, (0, 1000), "2.6.7")
};
/// POS_SET(m). The manual advises against it; nothing here writes it.
pub const POS_SET: Register = Register {
    access: Access::ReadWrite,
    also: Some(-1),
    persistence: Persistence::Volatile,
    meaning: "Target drive positions, 0 open to 2000 bent, -1 no action. The manual advises against writing it.",
    ..six("POS_SET", 1474, (0, 2000), "2.6.10")
};
/// ANGLE_SET(m).
pub const ANGLE_SET: Register = Register {
    access: Access::ReadWrite,
    also: Some(-1),
    persistence: Persistence::Volatile,
    meaning: "Target angles, 0 bent to 1000 open, -1 no action; acts at once.",
    ..six("ANGLE_SET", 1486, (0, 1000), "2.6.11")
};
/// FORCE_SET(m).
pub const FORCE_SET: Register = Register {
    access: Access::ReadWrite,
    unit: "g",
    persistence: Persistence::Volatile,
    meaning: "Force thresholds at which a joint stops.",
    ..six("FORCE_SET", 1498, (0, 3000), "2.6.12")
};
/// SPEED_SET(m).
pub const SPEED_SET: Register = Register {
    access: Access::ReadWrite,
    // Manual: 2.6.13 says "can be saved" beside DEFAULT_SPEED_SET; assumed to be lost at power-off.
    persistence: Persistence::Volatile,
    meaning: "Speeds; 1000 = full stroke in 600 ms without load.",
    ..six("SPEED_SET", 1522, (0, 1000), "2.6.13")
};
/// POS_ACT(m).
pub const POS_ACT: Register = Register {
    meaning: "Drive positions, 0 open to 2000 bent.",
    ..six("POS_ACT", 1534, (0, 2000), "2.6.14")
};
/// ANGLE_ACT(m).
pub const ANGLE_ACT: Register = Register {
    meaning: "Angles, 0 bent to 1000 open.",
    ..six("ANGLE_ACT", 1546, (0, 1000), "2.6.15")
};
/// FORCE_ACT(m).
pub const FORCE_ACT: Register = Register {
    unit: "g",
    meaning: "Forces on the fingers.",
    ..six("FORCE_ACT", 1582, (-4000, 4000), "2.6.16")
};
/// CURRENT(m).
pub const CURRENT: Register = Register {
    unit: "mA",
    meaning: "Drive currents.",
    ..six("CURRENT", 1594, (0, 2000), "2.6.17")
};
/// ERROR(m).
pub const ERROR: Register = Register {
    len: 6,
    element: Element::Byte,
    range: None,
    meaning: "Fault bits: 0 stall, 1 over-temperature, 2 over-current, 3 motor, 4 communication.",
    ..six("ERROR", 1606, (0, 0), "2.6.18")
};
/// STATUS(m).
pub const STATUS: Register = Register {
    len: 6,
    element: Element::Byte,
    range: None,
    meaning: "0 opening, 1 closing, 2 in position, 3 force reached, 5 current limit, 6 stalled, 7 drive fault.",
    ..six("STATUS", 1612, (0, 0), "2.6.19")
};
/// TEMP(m).
pub const TEMP: Register = Register {
    len: 6,
    element: Element::Byte,
    range: Some((0, 100)),
    unit: "°C",
    meaning: "Drive temperatures.",
    ..six("TEMP", 1618, (0, 100), "2.6.20")
};

/// ACTION_SEQ_INDEX, which newer hands use to choose a stored gesture.
pub const ACTION_SEQ_INDEX: Register = Register {
    range: Some((1, 40)),
    default: None,
    origin: Origin::Field,
    meaning: "Chooses a stored action on hands that keep gestures there; not in the manual.",
    ..byte("ACTION_SEQ_INDEX", 2320, "2.6.7")
};
/// ACTION_SEQ_RUN, which starts the chosen one.
pub const ACTION_SEQ_RUN: Register = Register {
    origin: Origin::Field,
    meaning: "1 runs the chosen action; clears itself; not in the manual.",
    ..byte("ACTION_SEQ_RUN", 2322, "2.6.7")
};

/// The whole map, by address: manual 2.6, and the registers known from third-party drivers that this program uses ([`Origin::Field`]).
pub const REGISTERS: [Register; 32] = [
    HAND_ID,
    REDU_RATIO,
    CLEAR_ERROR,
    SAVE,
    RESET_PARA,
    GESTURE_NO_SET,
    GESTURE_FORCE_CLB,
    DEFAULT_SPEED_SET,
    DEFAULT_FORCE_SET,
    USER_DEF_ANGLE,
    POS_SET,
    ANGLE_SET,
    FORCE_SET,
    SPEED_SET,
    POS_ACT,
    ANGLE_ACT,
    FORCE_ACT,
    CURRENT,
    ERROR,
    STATUS,
    TEMP,
    ip(
        "IP_PART1",
        1700,
        192,
        "First part of the IP address; takes effect at power-up.",
    ),
    ip(
        "IP_PART2",
        1701,
        168,
        "Second part of the IP address; takes effect at power-up.",
    ),
    ip(
        "IP_PART3",
        1702,
        11,
        "Third part of the IP address; takes effect at power-up.",
    ),
    ip(
        "IP_PART4",
        1703,
        210,
        "Last part of the IP address; takes effect at power-up.",
    ),
    ACTION_SEQ_INDEX,
    ACTION_SEQ_RUN,
    touch(
        "FINGERONE_TOUCH",
        3000,
        "Fingertip block of the little finger.",
    ),
    touch(
        "FINGERTWO_TOUCH",
        3058,
        "Fingertip block of the ring finger.",
    ),
    touch(
        "FINGERTHE_TOUCH",
        3116,
        "Fingertip block of the middle finger.",
    ),
    touch(
        "FINGERFOR_TOUCH",
        3174,
        "Fingertip block of the index finger.",
    ),
    touch("FINGERFIV_TOUCH", 3232, "Fingertip block of the thumb."),
];

/// All five fingertip blocks.
pub const TOUCH: Span = Span::new(3000, 290);
/// Angles to temperatures: the whole live state except the drive positions (manual 2.6.15 to 2.6.20).
pub const STATE: Span = Span::new(1546, 78);
/// ANGLE_SET to SPEED_SET: the setpoints stored in the hand.
pub const SETPOINTS: Span = Span::new(1486, 48);

/// Returns the row with this name, ignoring case.
pub fn by_name(name: &str) -> Option<&'static Register> {
    REGISTERS
        .iter()
        .find(|row| row.name.eq_ignore_ascii_case(name))
}

/// Returns the row that covers this byte address.
pub fn by_address(address: u16) -> Option<&'static Register> {
    REGISTERS
        .iter()
        .find(|row| row.span().covers(Span::new(address, 1)))
}

/// Packing of the one-byte groups (ERROR, STATUS, TEMP) into Modbus words.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
pub enum BytePacking {
    /// Two per word, the low byte has the lower address.
    // Manual: silent; most drivers of real hands assume it.
    #[default]
    LowFirst,
    /// Two per word, the high byte has the lower address.
    HighFirst,
    /// One per word, in six words.
    OnePerWord,
}

impl BytePacking {
    /// All byte packings.
    pub const ALL: [Self; 3] = [Self::LowFirst, Self::HighFirst, Self::OnePerWord];

    /// Name in an endpoint address.
    pub const fn key(self) -> &'static str {
        match self {
            Self::LowFirst => "low",
            Self::HighFirst => "high",
            Self::OnePerWord => "one",
        }
    }

    /// Returns the packing with this name.
    pub fn by_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|packing| packing.key() == key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_by_address_and_do_not_overlap() {
        for pair in REGISTERS.windows(2) {
            assert!(
                pair[0].span().end() <= u32::from(pair[1].address),
                "{} {}",
                pair[0],
                pair[1]
            );
        }
    }

    #[test]
    fn rows_agree_with_the_manuals_printed_table() {
        // Address, name, bytes, writable, as printed in manual 2.6.
        let printed = [
            (1000, "HAND_ID", 1, true),
            (1002, "REDU_RATIO", 1, true),
            (1004, "CLEAR_ERROR", 1, true),
            (1005, "SAVE", 1, true),
            (1006, "RESET_PARA", 1, true),
            (1009, "GESTURE_FORCE_CLB", 1, true),
            (1032, "DEFAULT_SPEED_SET", 12, true),
            (1044, "DEFAULT_FORCE_SET", 12, true),
            (1474, "POS_SET", 12, true),
            (1486, "ANGLE_SET", 12, true),
            (1498, "FORCE_SET", 12, true),
            (1522, "SPEED_SET", 12, true),
            (1534, "POS_ACT", 12, false),
            (1546, "ANGLE_ACT", 12, false),
            (1582, "FORCE_ACT", 12, false),
            (1594, "CURRENT", 12, false),
            (1606, "ERROR", 6, false),
            (1612, "STATUS", 6, false),
            (1618, "TEMP", 6, false),
            (1700, "IP_PART1", 1, true),
            (1701, "IP_PART2", 1, true),
            (1702, "IP_PART3", 1, true),
            (1703, "IP_PART4", 1, true),
            (3000, "FINGERONE_TOUCH", 58, false),
            (3058, "FINGERTWO_TOUCH", 58, false),
            (3116, "FINGERTHE_TOUCH", 58, false),
            (3174, "FINGERFOR_TOUCH", 58, false),
            (3232, "FINGERFIV_TOUCH", 58, false),
        ];
        let of_manual = REGISTERS.iter().filter(|row| row.origin == Origin::Manual);
        assert_eq!(of_manual.count(), printed.len());
        for (address, name, len, writable) in printed {
            let row = by_name(name).unwrap();
            assert_eq!((row.address, row.len), (address, len), "{name}");
            assert_eq!(row.access == Access::ReadWrite, writable, "{name}");
            assert_eq!(by_address(address), Some(row));
            assert_eq!(by_address(address + len - 1), Some(row));
            assert!(
                !row.meaning.is_empty() && row.section.starts_with("2.6"),
                "{name}"
            );
        }
    }

    #[test]
    fn the_gap_belongs_to_no_register() {
        for address in 1558..=1581 {
            assert_eq!(by_address(address), None);
        }
    }
}
