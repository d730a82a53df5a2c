//! The simulated hand's memory as Modbus sees it, over a socket or a serial line (manual 2.4, 2.5). Serves nothing.

use crate::hand::Span;
use crate::hand::register::{ERROR, STATUS, TEMP};
use crate::sim::memory::Refusal;
use crate::sim::personality::ByteWords;
use crate::sim::serve::shared::SharedHand;
use tokio_modbus::{ExceptionCode, Request, Response};

/// Most words of one read (manual 2.5, function 03).
const READ_WORDS_MAX: u16 = 125;
/// Most words of one write (manual 2.5, function 16).
const WRITE_WORDS_MAX: usize = 0x7B;
/// Answers requests out of the memory of one hand.
pub(crate) struct Memory {
    hand: SharedHand,
}

impl Memory {
    pub(crate) const fn new(hand: SharedHand) -> Self {
        Self { hand }
    }

    pub(crate) const fn hand(&self) -> &SharedHand {
        &self.hand
    }

    /// Does what the request asks for, at the hand's time now.
    ///
    /// # Errors
    /// Functions other than 03, 06 and 16, runs that the memory refuses, too many words.
    pub(crate) fn answer(&self, request: &Request<'_>) -> Result<Response, ExceptionCode> {
        match request {
            Request::ReadHoldingRegisters(address, count) => self
                .read(*address, *count)
                .map(Response::ReadHoldingRegisters),
            Request::WriteSingleRegister(address, word) => {
                self.write(*address, &[*word])?;
                Ok(Response::WriteSingleRegister(*address, *word))
            }
            Request::WriteMultipleRegisters(address, words) => {
                self.write(*address, words)?;
                let count = u16::try_from(words.len()).unwrap_or_default();
                Ok(Response::WriteMultipleRegisters(*address, count))
            }
            _ => Err(ExceptionCode::IllegalFunction),
        }
    }

    // Manual: 2.5 does not say how bytes become words; a word is byte[A] + 256 * byte[A + 1].
    fn read(&self, address: u16, count: u16) -> Result<Vec<u16>, ExceptionCode> {
        if !(1..=READ_WORDS_MAX).contains(&count) {
            return Err(ExceptionCode::IllegalDataValue);
        }
        let span = Span::new(address, 2 * count);
        let bytes = self
            .hand
            .with(|hand, now| hand.read(span, now))
            .map_err(exception)?;
        let own_words =
            self.hand.with(|hand, _| hand.personality().byte_words) == ByteWords::OnePerWord;
        if own_words && [ERROR.address, STATUS.address, TEMP.address].contains(&address) {
            return Ok(bytes
                .iter()
                .take(usize::from(count))
                .map(|byte| u16::from(*byte))
                .collect());
        }
        let (pairs, _) = bytes.as_chunks::<2>();
        Ok(pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect())
    }

    fn write(&self, address: u16, words: &[u16]) -> Result<(), ExceptionCode> {
        if words.is_empty() || words.len() > WRITE_WORDS_MAX {
            return Err(ExceptionCode::IllegalDataValue);
        }
        let bytes: Vec<u8> = match words {
            // Manual: 1000 to 1009 are single bytes side by side; one word there is one of them.
            [word] if (1000..=1009).contains(&address) => match u8::try_from(*word) {
                Ok(value) => vec![value],
                Err(_) => return Ok(()),
            },
            _ => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        };
        self.hand.with(|hand, now| {
            let effect = hand.write(address, &bytes, now).map_err(exception)?;
            if effect.result_follows {
                hand.cancel_newest_save_result();
            }
            Ok(())
        })
    }
}

const fn exception(refusal: Refusal) -> ExceptionCode {
    match refusal {
        Refusal::Unmapped { .. } | Refusal::Gap => ExceptionCode::IllegalDataAddress,
        Refusal::Empty { .. } => ExceptionCode::IllegalDataValue,
    }
}
