//! Common code for Modbus over a socket and over a serial line (manual 2.4, 2.5): converts spans and writes to
//! requests, responses to memory, and the library's errors to ours. Sends nothing.

use crate::codec::modbus::{
    ModbusWrite, READ_WORDS_MAX, bytes_from_words, words_for, words_from_write,
};
use crate::codec::modbus::{group_bytes, words_per_group};
use crate::hand::register::BytePacking;
use crate::hand::{ModbusException, RegisterWrite, Span};

use crate::link::bus::error::{BusError, Bytes, lost};
use crate::transport::{TransportError, WireFailure};
use std::borrow::Cow;
use tokio_modbus::{Error, ExceptionCode, Request, Response};

/// The request to read a span, function 03.
///
/// # Errors
/// `TooLong` for none or more than 125 words.
pub(crate) fn read_request(span: Span) -> Result<Request<'static>, BusError> {
    let words = words_for(span);
    if words.count > READ_WORDS_MAX || words.count == 0 {
        return Err(BusError::TooLong);
    }
    Ok(Request::ReadHoldingRegisters(words.address, words.count))
}

/// The memory bytes of a response to [`read_request`].
pub(crate) fn read_response(
    span: Span,
    response: &Response,
    packing: BytePacking,
) -> Result<Bytes, BusError> {
    let want = usize::from(span.len);
    let Response::ReadHoldingRegisters(got) = response else {
        return Err(BusError::WrongLength { got: 0, want });
    };
    // The library checks the number of words only in debug builds.
    if got.len() != usize::from(words_for(span).count) {
        let got = got.len() * 2;
        return Err(BusError::WrongLength { got, want });
    }
    let bytes = bytes_from_words(span.address, got, packing);
    let bytes = bytes
        .iter()
        .copied()
        .take(want)
        .take(Bytes::new().capacity());
    Ok(bytes.collect())
}

/// The request to read words: a group of single bytes with one byte per word, or words that reveal the packing.
pub(crate) const fn words_request(address: u16, count: u16) -> Request<'static> {
    Request::ReadHoldingRegisters(address, count)
}

/// The words of a response to [`words_request`].
pub(crate) fn words_response(count: u16, response: Response) -> Result<Vec<u16>, BusError> {
    let want = usize::from(count) * 2;
    match response {
        Response::ReadHoldingRegisters(words) if words.len() == usize::from(count) => Ok(words),
        Response::ReadHoldingRegisters(words) => Err(BusError::WrongLength {
            got: words.len() * 2,
            want,
        }),
        _ => Err(BusError::WrongLength { got: 0, want }),
    }
}

/// Appends the requested bytes of a group of six that is stored with one byte per word.
pub(crate) fn append_group(
    bytes: &mut Bytes,
    words: &[u16],
    skip: usize,
    take: usize,
) -> Result<(), BusError> {
    let group = group_bytes(BytePacking::OnePerWord, words);
    let group = group.ok_or(BusError::WrongLength {
        got: words.len() * 2,
        want: 2 * usize::from(words_per_group(BytePacking::OnePerWord)),
    })?;
    bytes.extend(group.into_iter().skip(skip).take(take));
    Ok(())
}

/// The request for a write, function 06 or 16.
pub(crate) fn write_request(write: &RegisterWrite) -> Request<'static> {
    match words_from_write(write) {
        ModbusWrite::Single { address, value } => Request::WriteSingleRegister(address, value),
        ModbusWrite::Multiple { address, words } => {
            Request::WriteMultipleRegisters(address, Cow::Owned(words.to_vec()))
        }
    }
}

/// Checks that a response acknowledges the write.
pub(crate) fn write_response(write: &RegisterWrite, response: &Response) -> Result<(), BusError> {
    match (response, write_request(write)) {
        // Manual: 2.4.2 prints zeros in the reply to FC06 where the standard echoes; both pass.
        (Response::WriteSingleRegister(..), Request::WriteSingleRegister(..)) => Ok(()),
        (
            Response::WriteMultipleRegisters(at, count),
            Request::WriteMultipleRegisters(address, words),
        ) if *at == address && usize::from(*count) == words.len() => Ok(()),
        _ => Err(BusError::WrongLength {
            got: 0,
            want: write.bytes().len(),
        }),
    }
}

/// Converts the result of a library call. `closed`: the other side closed the wire.
pub(crate) fn outcome(
    called: Result<Result<Response, ExceptionCode>, Error>,
    place: &str,
    closed: bool,
) -> Result<Response, BusError> {
    let place = || place.to_owned();
    match called {
        Ok(Ok(response)) => Ok(response),
        Ok(Err(exception)) => Err(BusError::Refused {
            reason: ModbusException::of(exception.into()).into(),
        }),
        Err(Error::Protocol(error)) => Err(BusError::Lost(TransportError::Io {
            place: place(),
            failure: WireFailure::Protocol(error.to_string()),
        })),
        // If the other side closes, the library returns the system's last error, whatever it was.
        Err(Error::Transport(_)) if closed => {
            Err(BusError::Lost(TransportError::HungUp { place: place() }))
        }
        Err(Error::Transport(error)) => Err(lost(&place(), &error)),
    }
}
