//! The table of reading groups: registers read together, their address, poll rate and name in files.

use crate::hand::dof::Finger;
use crate::hand::register::{self, Register, Span};

/// A group of registers that are read together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::VariantNames)]
pub enum Group {
    /// ANGLE_SET.
    AngleSet,
    /// FORCE_SET.
    ForceSet,
    /// SPEED_SET.
    SpeedSet,
    /// POS_ACT.
    Position,
    /// ANGLE_ACT.
    Angle,
    /// FORCE_ACT.
    Force,
    /// CURRENT.
    Current,
    /// ERROR.
    Faults,
    /// STATUS.
    Status,
    /// TEMP.
    Temperature,
    /// One fingertip.
    Tactile(Finger),
}

/// Groups that share one poll rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RateClass {
    /// Angles and forces.
    Motion,
    /// Currents, faults and status.
    Drives,
    /// Temperatures.
    Temperature,
    /// All five fingertips.
    Tactile,
    /// The setpoints stored in the hand, and the drives' positions.
    Settings,
}

impl RateClass {
    /// All classes, in display order.
    pub const ALL: [Self; 5] = [
        Self::Motion,
        Self::Drives,
        Self::Temperature,
        Self::Tactile,
        Self::Settings,
    ];
}

/// One row of the table.
struct Row {
    /// Bit in [`Groups`].
    bit: u32,
    span: Span,
    rate: RateClass,
    name: &'static str,
}

/// Size of one fingertip's block, bytes.
pub const TIP_BYTES: u16 = 58;

impl Group {
    /// All groups, joints first, in the order of their bits.
    pub const ALL: [Self; 15] = [
        Self::AngleSet,
        Self::ForceSet,
        Self::SpeedSet,
        Self::Position,
        Self::Angle,
        Self::Force,
        Self::Current,
        Self::Faults,
        Self::Status,
        Self::Temperature,
        Self::Tactile(Finger::Little),
        Self::Tactile(Finger::Ring),
        Self::Tactile(Finger::Middle),
        Self::Tactile(Finger::Index),
        Self::Tactile(Finger::Thumb),
    ];

    /// Row of this group in the table.
    const fn row(self) -> Row {
        use RateClass::{Drives, Motion, Settings, Tactile, Temperature};
        match self {
            Self::AngleSet => Row::new(0, &register::ANGLE_SET, Settings, "angle_set"),
            Self::ForceSet => Row::new(1, &register::FORCE_SET, Settings, "force_set"),
            Self::SpeedSet => Row::new(2, &register::SPEED_SET, Settings, "speed_set"),
            Self::Position => Row::new(3, &register::POS_ACT, Settings, "position"),
            Self::Angle => Row::new(4, &register::ANGLE_ACT, Motion, "angle"),
            Self::Force => Row::new(5, &register::FORCE_ACT, Motion, "force"),
            Self::Current => Row::new(6, &register::CURRENT, Drives, "current"),
            Self::Faults => Row::new(7, &register::ERROR, Drives, "fault"),
            Self::Status => Row::new(8, &register::STATUS, Drives, "status"),
            Self::Temperature => Row::new(9, &register::TEMP, Temperature, "temperature"),
            Self::Tactile(finger) => {
                let at = register::TOUCH.address + TIP_BYTES * finger as u16;
                Row {
                    bit: 10 + finger as u32,
                    span: Span::new(at, TIP_BYTES),
                    rate: Tactile,
                    name: "tactile",
                }
            }
        }
    }

    /// Range in the hand's memory (manual 2.6).
    pub const fn span(self) -> Span {
        self.row().span
    }

    /// Poll rate class.
    pub const fn rate(self) -> RateClass {
        self.row().rate
    }

    /// Name in files; all fingertips share one name.
    pub const fn name(self) -> &'static str {
        self.row().name
    }
}

impl Row {
    const fn new(bit: u32, register: &Register, rate: RateClass, name: &'static str) -> Self {
        Self {
            bit,
            span: register.span(),
            rate,
            name,
        }
    }
}

/// A set of groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Groups(u16);

impl FromIterator<Group> for Groups {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        let mut all = Self::NONE;
        groups.into_iter().for_each(|group| all.insert(group));
        all
    }
}

impl Groups {
    /// No group.
    pub const NONE: Self = Self(0);

    /// Adds a group.
    pub const fn insert(&mut self, group: Group) {
        self.0 |= 1 << group.row().bit;
    }

    /// True if the group is in the set.
    pub const fn contains(self, group: Group) -> bool {
        self.0 & (1 << group.row().bit) != 0
    }

    /// Returns the union of both sets.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True if no group is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True if any fingertip is in the set.
    pub const fn has_tactile(self) -> bool {
        self.0 >> 10 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::VariantNames as _;

    #[test]
    fn the_table_has_each_group_in_its_place() {
        let joint_groups = Group::VARIANTS.len() - 1;
        assert_eq!(Group::ALL.len(), joint_groups + Finger::ALL.len());
        for (place, group) in Group::ALL.into_iter().enumerate() {
            assert_eq!(group.row().bit as usize, place);
        }
    }
}
