//! A frame byte by byte: the meaning of its bytes, and their faults. The views provide the wording.

use crate::codec::usbcan::split_escapes;
use crate::link::traffic::frame::{Frame, FrameFormat, Kind, Wrong};
use crate::link::traffic::values;
use crate::record::Direction;
use std::ops::Range;

/// Meaning of some bytes of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FieldName {
    /// The two bytes at the start of a frame (manual 2.2).
    Header,
    /// The hand's id.
    Id,
    /// The Modbus unit.
    Unit,
    /// Length of the rest.
    Length,
    /// 0x11 read, 0x12 write.
    Command,
    /// Modbus function.
    Function,
    /// Byte address in the hand's memory.
    Address,
    /// Number of bytes requested.
    Wanted,
    /// Number of words requested or written.
    Words,
    /// Bytes of memory.
    Data,
    /// 1 = accepted.
    Acknowledge,
    /// Reason code of a refusal.
    Code,
    /// Sum over the frame.
    Checksum,
    /// CRC over the frame.
    Crc,
    /// Modbus TCP: number of the request.
    Transaction,
    /// Modbus TCP: always 0.
    Protocol,
    /// CAN identifier.
    CanId,
    /// Padding of Linux's CAN frame, or of a packet of the maker's CAN adapter.
    Filler,
    /// Channel, 29 or 11 bits, data or remote frame: in a packet of the maker's CAN adapter.
    FrameKind,
    /// The two bytes at the end of such a packet.
    Tail,
    /// Text of a serial CAN adapter.
    Text,
    /// Bytes of unknown meaning.
    Unknown,
}

/// One field of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Byte range in the frame.
    pub at: Range<usize>,
    /// Meaning of the bytes.
    pub name: FieldName,
    /// The register that they belong to, as the manual names it.
    pub register: Option<String>,
    /// Their value, as a number or numbers; empty if none.
    pub value: String,
    /// Fault of these bytes.
    pub wrong: Option<Wrong>,
}

impl Frame {
    /// All fields, in order and without gaps.
    pub fn fields(&self) -> Vec<Field> {
        let mut parts = Parts {
            frame: self,
            at: 0,
            fields: Vec::new(),
        };
        let is_broken = self
            .wrong
            .is_some_and(|wrong| wrong.is_damage() && !is_sum(wrong));
        match self.form {
            _ if is_broken || self.kind == Kind::Noise => {}
            FrameFormat::Rs485 => rs485(&mut parts),
            FrameFormat::Rtu => rtu(&mut parts),
            FrameFormat::Tcp => tcp(&mut parts),
            FrameFormat::Can => record(&mut parts),
            FrameFormat::Slcan => parts.put(self.bytes.len(), FieldName::Text),
            FrameFormat::UsbCan => packet(&mut parts),
        }
        parts.rest();
        parts.fields
    }
}

const fn is_sum(wrong: Wrong) -> bool {
    matches!(wrong, Wrong::Checksum { .. } | Wrong::Crc { .. })
}

struct Parts<'a> {
    frame: &'a Frame,
    at: usize,
    fields: Vec<Field>,
}

impl Parts<'_> {
    fn bytes(&self, at: &Range<usize>) -> &[u8] {
        self.frame.bytes.get(at.clone()).unwrap_or_default()
    }

    fn left(&self) -> usize {
        self.frame.bytes.len().saturating_sub(self.at)
    }

    /// Appends a field of the next `len` bytes, or of the rest.
    fn put(&mut self, len: usize, name: FieldName) {
        let len = len.min(self.left());
        if len == 0 {
            return;
        }
        let at = self.at..self.at + len;
        let value = value(self.frame, name, self.bytes(&at));
        self.at += len;
        self.fields.push(Field {
            wrong: self.frame.wrong.filter(|wrong| blames(*wrong, name)),
            at,
            name,
            register: None,
            value,
        });
    }

    /// As [`Self::put`], including the escape bytes A5 before them.
    fn put_escaped(&mut self, len: usize, name: FieldName) {
        let whole = self.escaped(len);
        self.put(whole, name);
    }

    /// Number of bytes that the next `len` take, including the escape bytes A5.
    fn escaped(&self, len: usize) -> usize {
        let left = self.bytes(&(self.at..self.frame.bytes.len()));
        split_escapes(left).take(len).map(|(taken, _)| taken).sum()
    }

    /// Appends the next `len` bytes as memory: one field per register.
    fn memory(&mut self, len: usize) {
        let end = self.at + len.min(self.left());
        let (Some(span), true) = (self.frame.span, self.frame.memory.len() == len) else {
            return self.put(len, FieldName::Data);
        };
        let start = self.at;
        for held in values::held(span, &self.frame.memory) {
            let from = start + usize::from(held.span.address - span.address);
            if from > self.at {
                self.put(from - self.at, FieldName::Data);
            }
            let to = (from + usize::from(held.span.len)).min(end);
            self.fields.push(Field {
                at: from..to,
                name: FieldName::Data,
                register: Some(held.name()),
                value: [held.numbers.as_str(), held.row.unit]
                    .join(" ")
                    .trim()
                    .to_owned(),
                wrong: None,
            });
            self.at = to;
        }
        self.put(end.saturating_sub(self.at), FieldName::Data);
    }

    fn rest(&mut self) {
        self.put(self.left(), FieldName::Unknown);
        let blamed = self.fields.iter().any(|field| field.wrong.is_some());
        if let Some(field) = self.fields.first_mut().filter(|_| !blamed) {
            field.wrong = self.frame.wrong;
        }
    }
}

/// True for the field at which a fault is shown; it is shown at the first if none matches.
const fn blames(wrong: Wrong, name: FieldName) -> bool {
    matches!(
        (wrong, name),
        (Wrong::Checksum { .. }, FieldName::Checksum)
            | (Wrong::Crc { .. }, FieldName::Crc)
            | (
                Wrong::ForeignId { .. },
                FieldName::Id | FieldName::Unit | FieldName::CanId
            )
            | (Wrong::Refused { .. }, FieldName::Code)
            | (Wrong::NotTaken { .. }, FieldName::Acknowledge)
            | (Wrong::Address { .. }, FieldName::Address)
            | (Wrong::Amount { .. }, FieldName::Length)
            | (Wrong::Transaction { .. }, FieldName::Transaction)
    )
}

fn value(frame: &Frame, name: FieldName, bytes: &[u8]) -> String {
    let plain: Vec<u8> = match frame.form {
        FrameFormat::UsbCan => split_escapes(bytes).map(|(_, byte)| byte).collect(),
        _ => bytes.to_vec(),
    };
    let number = |little: bool| {
        let fold = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
        if little {
            plain.iter().rev().fold(0, fold)
        } else {
            plain.iter().fold(0, fold)
        }
    };
    let is_little = matches!(frame.form, FrameFormat::Rs485 | FrameFormat::UsbCan);
    match name {
        FieldName::Header
        | FieldName::Data
        | FieldName::Filler
        | FieldName::FrameKind
        | FieldName::Tail
        | FieldName::Unknown => String::new(),
        FieldName::Checksum => format!("{:02X}", number(true)),
        FieldName::Crc => format!("{:04X}", number(true)),
        FieldName::CanId => {
            let is_little = is_little || cfg!(target_endian = "little");
            format!("{:08X}", number(is_little) & 0x1FFF_FFFF)
        }
        FieldName::Text => String::from_utf8_lossy(bytes)
            .trim_end()
            .escape_debug()
            .to_string(),
        FieldName::Address => {
            let address = u16::try_from(number(is_little)).unwrap_or_default();
            let row = crate::hand::register::by_address(address);
            row.map_or_else(
                || address.to_string(),
                |row| format!("{address} {}", row.name),
            )
        }
        FieldName::Command | FieldName::Function => format!("{:02X}h", number(true)),
        _ => number(is_little).to_string(),
    }
}

fn rs485(parts: &mut Parts<'_>) {
    use FieldName as F;
    for (len, name) in [
        (2, F::Header),
        (1, F::Id),
        (1, F::Length),
        (1, F::Command),
        (2, F::Address),
    ] {
        parts.put(len, name);
    }
    let data = parts.left().saturating_sub(1);
    match parts.frame.kind {
        Kind::Read => parts.put(data, F::Wanted),
        Kind::WriteReply | Kind::SaveResult => parts.put(data, F::Acknowledge),
        _ => parts.memory(data),
    }
    parts.put(1, F::Checksum);
}

fn rtu(parts: &mut Parts<'_>) {
    parts.put(1, FieldName::Unit);
    pdu(parts, 2);
    parts.put(2, FieldName::Crc);
}

fn tcp(parts: &mut Parts<'_>) {
    use FieldName as F;
    for (len, name) in [
        (2, F::Transaction),
        (2, F::Protocol),
        (2, F::Length),
        (1, F::Unit),
    ] {
        parts.put(len, name);
    }
    pdu(parts, 0);
}

/// Function and its data, up to `behind` bytes before the end.
fn pdu(parts: &mut Parts<'_>, behind: usize) {
    use FieldName as F;
    let function = parts.frame.bytes.get(parts.at).copied().unwrap_or_default();
    parts.put(1, F::Function);
    let is_request = parts.frame.direction == Direction::ToHand || parts.frame.kind == Kind::Read;
    let left = |parts: &Parts<'_>| parts.left().saturating_sub(behind);
    match (function, is_request) {
        (3, true) => {
            parts.put(2, F::Address);
            parts.put(2, F::Words);
        }
        (3, false) => {
            parts.put(1, F::Length);
            parts.memory(left(parts));
        }
        (6, _) => {
            parts.put(2, F::Address);
            let rest = left(parts);
            parts.put(rest, F::Data);
        }
        (16, _) => {
            parts.put(2, F::Address);
            parts.put(2, F::Words);
            if left(parts) > 0 {
                parts.put(1, F::Length);
                parts.memory(left(parts));
            }
        }
        (0x80..=0xFF, _) => parts.put(1, F::Code),
        _ => {}
    }
}

fn record(parts: &mut Parts<'_>) {
    use FieldName as F;
    parts.put(4, F::CanId);
    let len = usize::from(parts.frame.bytes.get(4).copied().unwrap_or_default()).min(8);
    parts.put(1, F::Length);
    parts.put(3, F::Filler);
    match parts.frame.kind {
        Kind::Read => parts.put(len, F::Wanted),
        Kind::WriteReply => parts.put(len, F::Acknowledge),
        Kind::ReadReply | Kind::Write => parts.memory(len),
        _ => parts.put(len, F::Unknown),
    }
    let rest = parts.left();
    parts.put(rest, F::Filler);
}

fn packet(parts: &mut Parts<'_>) {
    use FieldName as F;
    parts.put(2, F::Header);
    parts.put_escaped(4, F::CanId);
    // The length follows the data.
    let at = parts.at + parts.escaped(8);
    let len = usize::from(parts.frame.bytes.get(at).copied().unwrap_or_default()).min(8);
    match parts.frame.kind {
        Kind::Read => parts.put_escaped(len, F::Wanted),
        Kind::WriteReply => parts.put_escaped(len, F::Acknowledge),
        Kind::ReadReply | Kind::Write if parts.escaped(len) == len => parts.memory(len),
        Kind::ReadReply | Kind::Write => parts.put_escaped(len, F::Data),
        _ => parts.put_escaped(len, F::Unknown),
    }
    parts.put(at.saturating_sub(parts.at), F::Filler);
    parts.put(1, F::Length);
    parts.put(3, F::FrameKind);
    parts.put_escaped(1, F::Checksum);
    parts.put(2, F::Tail);
}
