//! Answers a client's request to a gateway, from the link's last readings or with the hand's acknowledgement.

use crate::codec::mbap::Adu;
use crate::codec::modbus::READ_WORDS_MAX;
use crate::codec::pdu::{self, ModbusRole, Pdu};
use crate::hand::{HandCommand, ModbusException, Span};
use crate::share::gateway::allowed;
use crate::share::gateway::clients::{Client, ClientId};
use crate::share::gateway::leases::ClientLeases;
use crate::share::gateway::refusal::{WriteRefusal, exception};

/// Size of the hand's address space: twelve bits, as in CAN ids. Beyond it a hand on RS485 would only be silent.
const MEMORY_LEN: u32 = 4096;
/// Most words of one write (manual 2.5, function 16).
const WRITE_WORDS_MAX: usize = 123;

/// Serves all clients of one gateway.
#[derive(Debug, Clone)]
pub(crate) struct Service {
    pub(crate) leases: ClientLeases,
}

impl Service {
    /// Returns the whole message that answers a request. Any unit id is answered: there is one hand.
    pub(crate) async fn answer(&self, client: ClientId, asked: &Adu) -> Vec<u8> {
        let now = self.leases.link.clock().now();
        self.note(client, |row| row.count_request(now));
        let function = asked.function();
        let answer = match self.handle(client, asked.pdu()).await {
            Ok(answer) => [&[function], answer.as_slice()].concat(),
            Err(exception) => pdu::exception_reply(exception, function).to_vec(),
        };
        asked.reply(asked.unit, &answer)
    }

    /// Returns the answer without its function code.
    async fn handle(&self, client: ClientId, request: &[u8]) -> Result<Vec<u8>, ModbusException> {
        match pdu::parse(ModbusRole::Client, request) {
            Pdu::Read { address, count } => {
                let words = self.read(address, count).await?;
                self.note(client, Client::read);
                Ok(words)
            }
            Pdu::WriteOne { address, value } => {
                let command = command(address, &[value]);
                self.write(client, request, command).await?;
                Ok([address, value].map(u16::to_be_bytes).concat())
            }
            Pdu::Write {
                address,
                count,
                words,
            } => {
                let command = words_of(count, words).and_then(|words| command(address, &words));
                self.write(client, request, command).await?;
                Ok([address, count].map(u16::to_be_bytes).concat())
            }
            _ => match self.leases.handle_stop(client, request).await {
                // A stop counts even if its length is wrong.
                Some(Ok(())) => Ok(request.get(1..5).unwrap_or_default().to_vec()),
                Some(Err(refusal)) => Err(refusal.exception()),
                // A known function with a wrong length.
                None if matches!(request, [3 | 6 | 16, ..]) => Err(ModbusException::IllegalValue),
                None => Err(ModbusException::IllegalFunction),
            },
        }
    }

    async fn read(&self, address: u16, count: u16) -> Result<Vec<u8>, ModbusException> {
        if !(1..=READ_WORDS_MAX).contains(&count) {
            return Err(ModbusException::IllegalValue);
        }
        let span = Span::new(address, 2 * count);
        if span.end() > MEMORY_LEN {
            return Err(ModbusException::IllegalAddress);
        }
        let bytes = self.leases.reads.read(span).await;
        let bytes = bytes.map_err(|error| exception(&error))?;
        // Manual: 2.5 does not say how bytes become words; a word is byte[A] + 256 * byte[A + 1], high byte first.
        let (pairs, _) = bytes.as_chunks::<2>();
        let words = pairs.iter().flat_map(|[low, high]| [*high, *low]);
        let len = u8::try_from(bytes.len()).unwrap_or(u8::MAX);
        Ok([len].into_iter().chain(words).collect())
    }

    /// Writes the command of a request. A stop that is invalid as a write is still a stop.
    async fn write(
        &self,
        client: ClientId,
        request: &[u8],
        command: Result<HandCommand, WriteRefusal>,
    ) -> Result<(), ModbusException> {
        let written = match command {
            Ok(command) => self.leases.write(client, command, request).await,
            Err(odd) => match self.leases.handle_stop(client, request).await {
                Some(Ok(())) => {
                    self.note(client, |row| row.note_odd_stop(odd));
                    return Ok(());
                }
                Some(Err(lost)) => Err(lost),
                None => Err(odd),
            },
        };
        let result = written.as_ref().map_err(WriteRefusal::exception).copied();
        self.note(client, |row| row.wrote(written));
        result
    }

    fn note(&self, client: ClientId, what: impl FnOnce(&mut Client)) {
        self.leases.table.with(|table| table.row(client).map(what));
    }
}

/// Converts words written at this address to a command, or returns the reason why clients may not write them.
fn command(address: u16, words: &[u16]) -> Result<HandCommand, WriteRefusal> {
    allowed::command(address, words).map_err(|exception| match exception {
        ModbusException::IllegalValue => WriteRefusal::Value { address },
        _ => WriteRefusal::Address {
            address,
            words: words.len(),
        },
    })
}

/// Decodes the words of function 16, if there are as many as announced.
fn words_of(count: u16, bytes: &[u8]) -> Result<Vec<u16>, WriteRefusal> {
    let (pairs, odd) = bytes.as_chunks::<2>();
    let is_whole = odd.is_empty() && pairs.len() == usize::from(count);
    if !is_whole || !(1..=WRITE_WORDS_MAX).contains(&pairs.len()) {
        return Err(WriteRefusal::Count { count });
    }
    Ok(pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect())
}
