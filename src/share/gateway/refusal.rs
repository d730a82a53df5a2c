//! Why a gateway does not do what a client asks, in words for the user and as a Modbus exception.

use crate::hand::{ModbusException, Refusal};
use crate::link::RequestError;
use crate::record::ArmRefusal;

/// Why a write of a client was not done.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WriteRefusal {
    /// Nobody granted a client the right to move this hand.
    #[error("no client may move the hand: a person has to grant it")]
    NotGranted,
    /// Another has the right.
    #[error("another may move the hand now")]
    Taken,
    /// This connection had the right once.
    #[error("this client could move the hand, and that ended: it has to connect again")]
    Over,
    /// The hand could not be armed.
    #[error("the hand could not be armed: {0}")]
    NotArmed(ArmRefusal),
    /// The hand holds a speed or a force that cannot be set, so it cannot be armed with what it has.
    #[error("the speeds and forces that the hand has now make no sense")]
    Limits,
    /// Not a register that clients may write.
    #[error("clients may not write {words} words at address {address}")]
    Address {
        /// First byte.
        address: u16,
        words: usize,
    },
    /// Fewer or more words than were announced, or than a message has.
    #[error("the request does not have the {count} words that it announces")]
    Count { count: u16 },
    /// Outside the manual's range.
    #[error("a value for address {address} is outside the manual's range")]
    Value {
        /// First byte.
        address: u16,
    },
    /// The link or the hand did not take it.
    #[error(transparent)]
    Request(#[from] RequestError),
}

impl WriteRefusal {
    /// What the client is told.
    pub(crate) fn exception(&self) -> ModbusException {
        match self {
            Self::NotGranted | Self::Taken | Self::Over | Self::NotArmed(_) | Self::Limits => {
                ModbusException::Busy
            }
            Self::Address { .. } => ModbusException::IllegalAddress,
            Self::Value { .. } | Self::Count { .. } => ModbusException::IllegalValue,
            Self::Request(error) => exception(error),
        }
    }
}

/// What a client is told of a failed request.
pub(crate) fn exception(error: &RequestError) -> ModbusException {
    match error {
        RequestError::NotConnected => ModbusException::NoPath,
        RequestError::LinkLost | RequestError::Timeout { .. } | RequestError::Ambiguous { .. } => {
            ModbusException::NoAnswer
        }
        RequestError::Refused { reason, .. } => refused(*reason),
        RequestError::NotArmed
        | RequestError::NotOwner(_)
        | RequestError::NotNow(_)
        | RequestError::Full { .. } => ModbusException::Busy,
        RequestError::TooLong { .. } | RequestError::OutOfRange(_) => ModbusException::IllegalValue,
        RequestError::WrongLength { .. } => ModbusException::Failure,
    }
}

/// The hand's own exception passes as it is. What the rule against unsafe writes keeps back has no code of its own.
const fn refused(reason: Refusal) -> ModbusException {
    match reason {
        Refusal::Exception(own) => own,
        Refusal::PackingUnknown | Refusal::PackingUnsafe | Refusal::NotIdentified => {
            ModbusException::Failure
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::pdu::exception_reply;

    #[test]
    fn a_hands_own_exception_reaches_the_client_with_its_code() {
        let told = |reason| {
            let address = 1000;
            exception_reply(exception(&RequestError::Refused { address, reason }), 3)
        };
        for code in [1, 2, 3, 4, 5, 6, 8, 10, 11, 7, 0xC8] {
            let own = Refusal::Exception(ModbusException::of(code));
            assert_eq!(told(own), [0x83, code]);
        }
        for rule in [
            Refusal::PackingUnknown,
            Refusal::PackingUnsafe,
            Refusal::NotIdentified,
        ] {
            assert_eq!(told(rule), [0x83, 4], "{rule}");
        }
    }
}
