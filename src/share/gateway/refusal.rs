//! Reasons for a gateway's refusal, as text for the user and as Modbus exceptions.

use crate::hand::{ModbusException, Refusal};
use crate::link::RequestError;
use crate::record::ArmRefusal;

/// Reason why a client's write was not carried out.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WriteRefusal {
    /// The user has not granted control of this hand to any client.
    #[error("no client has control of the hand: the user has to grant it")]
    NotGranted,
    /// Another controller has control.
    #[error("another controller has control")]
    Taken,
    /// This connection had control earlier.
    #[error("the control of this client has ended: it has to reconnect")]
    Over,
    /// The hand could not be armed.
    #[error("the hand could not be armed: {0}")]
    NotArmed(ArmRefusal),
    /// The hand's present speed or force is not a valid setting, so the hand cannot be armed with it.
    #[error("the current speeds and forces of the hand are implausible")]
    Limits,
    /// Not a register that clients may write.
    #[error("clients may not write {words} words at address {address}")]
    Address {
        /// Address of the first byte.
        address: u16,
        words: usize,
    },
    /// The number of words differs from the announced one, or exceeds a message.
    #[error("the request does not contain the {count} words that it announces")]
    Count { count: u16 },
    /// Outside the manual's range.
    #[error("a value for address {address} is outside the manual's range")]
    Value {
        /// Address of the first byte.
        address: u16,
    },
    /// The link or the hand did not accept it.
    #[error(transparent)]
    Request(#[from] RequestError),
}

impl WriteRefusal {
    /// Exception sent to the client.
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

/// Exception sent to a client for a failed request.
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

/// The hand's own exception is forwarded. The rule against unsafe writes has no exception code of its own.
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
        let answer = |reason| {
            let address = 1000;
            exception_reply(exception(&RequestError::Refused { address, reason }), 3)
        };
        for code in [1, 2, 3, 4, 5, 6, 8, 10, 11, 7, 0xC8] {
            let own = Refusal::Exception(ModbusException::of(code));
            assert_eq!(answer(own), [0x83, code]);
        }
        for rule in [
            Refusal::PackingUnknown,
            Refusal::PackingUnsafe,
            Refusal::NotIdentified,
        ] {
            assert_eq!(answer(rule), [0x83, 4], "{rule}");
        }
    }
}
