//! Reasons for a refused request: the hand's own exception (manual 2.4, 2.5), or the rule against unsafe writes.

/// Modbus exception with the standard's code. Unknown codes are preserved.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error, serde::Serialize, serde::Deserialize,
)]
pub enum ModbusException {
    /// 1: the function is not supported.
    #[error("Illegal function")]
    IllegalFunction,
    /// 2: the address does not allow this operation.
    #[error("Illegal data address")]
    IllegalAddress,
    /// 3: a value or a count is out of range.
    #[error("Illegal data value")]
    IllegalValue,
    /// 4: the operation failed.
    #[error("Server device failure")]
    Failure,
    /// 5: accepted, but not done yet.
    #[error("Acknowledge")]
    Acknowledge,
    /// 6: reserved by another client, or overloaded.
    #[error("Server device busy")]
    Busy,
    /// 8: the memory failed a parity check.
    #[error("Memory parity error")]
    MemoryParity,
    /// 10: the gateway has no path to the device at present.
    #[error("Gateway path unavailable")]
    NoPath,
    /// 11: the device behind the gateway does not answer.
    #[error("Gateway target device failed to respond")]
    NoAnswer,
    /// A code that the standard does not define; see [`Self::of`].
    #[error("Custom")]
    Other(u8),
}

impl ModbusException {
    /// Returns the exception with this code.
    pub const fn of(code: u8) -> Self {
        match code {
            1 => Self::IllegalFunction,
            2 => Self::IllegalAddress,
            3 => Self::IllegalValue,
            4 => Self::Failure,
            5 => Self::Acknowledge,
            6 => Self::Busy,
            8 => Self::MemoryParity,
            10 => Self::NoPath,
            11 => Self::NoAnswer,
            other => Self::Other(other),
        }
    }

    /// The exception code on the wire (manual 2.4).
    pub const fn code(self) -> u8 {
        match self {
            Self::IllegalFunction => 1,
            Self::IllegalAddress => 2,
            Self::IllegalValue => 3,
            Self::Failure => 4,
            Self::Acknowledge => 5,
            Self::Busy => 6,
            Self::MemoryParity => 8,
            Self::NoPath => 10,
            Self::NoAnswer => 11,
            Self::Other(code) => code,
        }
    }
}

/// Presence of a hand, as shown by an exception. An exception is an answer to a request, never feedback.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// The hand itself refused: it is present.
    Answers,
    /// The device that refused is overloaded. If that persists, the hand counts as not answering.
    Busy,
    /// A gateway answered in place of a hand that does not.
    Absent,
}

impl ModbusException {
    /// Presence of the hand, as shown by this exception.
    pub const fn presence(self) -> Presence {
        match self {
            Self::IllegalFunction
            | Self::IllegalAddress
            | Self::IllegalValue
            | Self::MemoryParity
            | Self::Other(_) => Presence::Answers,
            Self::Acknowledge | Self::Busy => Presence::Busy,
            Self::Failure | Self::NoPath | Self::NoAnswer => Presence::Absent,
        }
    }
}

/// Reason why the hand, or the rule against unsafe writes, refused a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Refusal {
    /// Exception from the hand. Only Modbus has any.
    #[error(transparent)]
    Exception(#[from] ModbusException),
    /// Nothing was sent: it is not known how this hand packs single bytes into words.
    #[error(
        "it is not known how this hand puts single bytes into words; 'packing=low' in its address (in the window: Modbus bytes, Connection) says that it is low byte first"
    )]
    PackingUnknown,
    /// Nothing was sent: the write of a single byte could change its neighbour.
    #[error(
        "this hand does not put single bytes into words low byte first, and writing them is not known to be safe"
    )]
    PackingUnsafe,
    /// Nothing was sent: too little was read to identify this as a hand of the manual's series.
    #[error(
        "whether this is a hand of this series is not known yet; nothing is written until it is"
    )]
    NotIdentified,
}

impl Refusal {
    /// True if the hand itself refused.
    pub fn is_by_the_hand(self) -> bool {
        matches!(self, Self::Exception(exception) if exception.presence() == Presence::Answers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_kept_and_known_ones_have_words() {
        for code in 0..=u8::MAX {
            let words = match code {
                1 => "Illegal function",
                2 => "Illegal data address",
                3 => "Illegal data value",
                4 => "Server device failure",
                5 => "Acknowledge",
                6 => "Server device busy",
                8 => "Memory parity error",
                10 => "Gateway path unavailable",
                11 => "Gateway target device failed to respond",
                _ => "Custom",
            };
            let exception = ModbusException::of(code);
            assert_eq!(exception.code(), code);
            assert_eq!(exception.to_string(), words);
            assert_eq!(Refusal::from(exception).to_string(), words);
        }
    }

    #[test]
    fn what_gateways_say_for_a_hand_is_no_answer_of_the_hand() {
        for code in 0..=u8::MAX {
            let presence = match code {
                4 | 10 | 11 => Presence::Absent,
                5 | 6 => Presence::Busy,
                _ => Presence::Answers,
            };
            assert_eq!(ModbusException::of(code).presence(), presence, "{code}");
        }
    }
}
