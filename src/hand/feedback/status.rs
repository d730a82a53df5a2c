//! STATUS codes as text (manual 2.6.19), including the advice for each. Presentation is defined elsewhere.

/// State that a drive reports (manual 2.6.19).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// 0: 正在松开.
    Releasing,
    /// 1: 正在抓取.
    Grasping,
    /// 2: 位置到位停止.
    PositionReached,
    /// 3: 力控到位停止.
    ForceReached,
    /// 5: 电流保护停止.
    CurrentProtection,
    /// 6: 驱动器堵转停止.
    Stalled,
    /// 7: 驱动器故障停止.
    DriveFault,
    /// A code that the manual does not list. 255 was seen on joints not commanded since power-up.
    Unknown(u8),
}

impl Status {
    /// Decodes the register's byte; unlisted codes are preserved as [`Status::Unknown`].
    pub const fn from_raw(raw: u8) -> Self {
        match raw {
            0 => Self::Releasing,
            1 => Self::Grasping,
            2 => Self::PositionReached,
            3 => Self::ForceReached,
            5 => Self::CurrentProtection,
            6 => Self::Stalled,
            7 => Self::DriveFault,
            other => Self::Unknown(other),
        }
    }

    /// The register's byte.
    pub const fn raw(self) -> u8 {
        match self {
            Self::Releasing => 0,
            Self::Grasping => 1,
            Self::PositionReached => 2,
            Self::ForceReached => 3,
            Self::CurrentProtection => 5,
            Self::Stalled => 6,
            Self::DriveFault => 7,
            Self::Unknown(raw) => raw,
        }
    }

    /// Stable lower-case name for files and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Releasing => "releasing",
            Self::Grasping => "grasping",
            Self::PositionReached => "position_reached",
            Self::ForceReached => "force_reached",
            Self::CurrentProtection => "current_protection",
            Self::Stalled => "stalled",
            Self::DriveFault => "drive_fault",
            Self::Unknown(_) => "unknown",
        }
    }

    /// True if the drive reports that it has stopped; false for an unknown code.
    pub const fn is_stopped(self) -> bool {
        matches!(
            self,
            Self::PositionReached
                | Self::ForceReached
                | Self::CurrentProtection
                | Self::Stalled
                | Self::DriveFault
        )
    }

    /// True if the drive reports motion.
    pub const fn is_moving(self) -> bool {
        matches!(self, Self::Releasing | Self::Grasping)
    }

    /// True if the drive stopped to protect itself.
    pub const fn is_protective(self) -> bool {
        matches!(
            self,
            Self::CurrentProtection | Self::Stalled | Self::DriveFault
        )
    }

    /// English text: meaning and advice.
    pub const fn words(self) -> Words {
        match self {
            Self::Releasing => {
                Words::new("Opening", "The joint moves towards open.", "Nothing to do.")
            }
            Self::Grasping => {
                Words::new("Closing", "The joint moves towards bent.", "Nothing to do.")
            }
            Self::PositionReached => Words::new(
                "In position",
                "The joint reached its target angle.",
                "Nothing to do.",
            ),
            Self::ForceReached => Words::new(
                "At force",
                "The force met its threshold and the drive stopped.",
                "Nothing to do. Raise the threshold if the grip is too weak.",
            ),
            Self::CurrentProtection => Words::new(
                "Current limit",
                "The drive drew too much current and stopped.",
                "Take the load away or open the joint, then command it again more slowly.",
            ),
            Self::Stalled => Words::new(
                "Stalled",
                "The drive pushed and did not move.",
                "Open the joint or free what blocks it, then clear errors.",
            ),
            Self::DriveFault => Words::new(
                "Drive fault",
                "The drive stopped because of a fault.",
                "Read the fault list for the cause.",
            ),
            Self::Unknown(255) => Words::new(
                "Not reported",
                "Code 255, not in the manual. Seen on joints that were not commanded since power-up.",
                "Move the joint once. If it stays, note the code for the maker.",
            ),
            Self::Unknown(_) => Words::new(
                "Unknown code",
                "The manual does not list this code.",
                "Treat the joint as not ready. Note the code for the maker.",
            ),
        }
    }
}

/// A title, a cause and advice, each one short sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Words {
    /// Two or three words, for a badge or a heading.
    pub title: &'static str,
    /// Cause, as one sentence.
    pub cause: &'static str,
    /// Advice to the user.
    pub advice: &'static str,
}

impl Words {
    /// Combines the three texts.
    pub const fn new(title: &'static str, cause: &'static str, advice: &'static str) -> Self {
        Self {
            title,
            cause,
            advice,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding() {
        for raw in 0..=255 {
            let status = Status::from_raw(raw);
            assert_eq!(status.raw(), raw);
            let listed = matches!(raw, 0..=3 | 5..=7);
            assert_eq!(matches!(status, Status::Unknown(_)), !listed);
            assert!(!status.words().advice.is_empty());
        }
    }

    #[test]
    fn an_unknown_code_is_not_taken_for_a_stop() {
        assert!(!Status::from_raw(4).is_stopped());
        assert!(!Status::from_raw(255).is_stopped());
        assert!(Status::from_raw(2).is_stopped());
    }
}
