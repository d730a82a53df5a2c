//! A command as the bytes it becomes on each wire, and as code that a person can paste. Sends nothing.

use crate::codec::modbus::{ModbusWrite, words_from_write};
use crate::codec::modbus_rtu::crc16;
use crate::codec::{can, rs485, slcan, usbcan};
use crate::hand::{HandCommand, HandId, RegisterWrite};
use crate::link::traffic::frame::FrameFormat;
use crate::transport::Endpoint;
use std::fmt::Write as _;

/// A way to write the bytes down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SnippetFormat {
    /// Hexadecimal digits, one frame a line; CAN as `id#data`.
    Hex,
    /// Python: pyserial, a socket, or python-can.
    Python,
    /// C: arrays of bytes.
    C,
    /// Rust: arrays of bytes.
    Rust,
}

impl SnippetFormat {
    /// All.
    pub const ALL: [Self; 4] = [Self::Hex, Self::Python, Self::C, Self::Rust];

    /// Its name, the same in all languages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hex => "Hex",
            Self::Python => "Python",
            Self::C => "C",
            Self::Rust => "Rust",
        }
    }
}

/// One frame: bytes, and on CAN the identifier before them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SnippetFrame {
    /// The 29-bit identifier.
    pub can_id: Option<u32>,
    /// The bytes in the order in which they go out.
    pub bytes: Vec<u8>,
}

/// The frames of a command on one wire, in order; each is sent after the answer to the one before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameSnippet {
    wire: FrameFormat,
    address: SnippetAddress,
    /// The frames.
    pub frames: Vec<SnippetFrame>,
}

/// What the code names to reach the hand.
#[derive(Debug, Clone, PartialEq, Eq)]
struct SnippetAddress {
    port: String,
    baud: u32,
    id: u16,
}

impl SnippetAddress {
    /// From the endpoint if it is of this wire, else as the maker delivers.
    fn of(wire: FrameFormat, endpoint: Option<&Endpoint>) -> Self {
        let usual = |port: &str, id: u16| Self {
            port: port.into(),
            baud: 115_200,
            id,
        };
        match (wire, endpoint) {
            (FrameFormat::Rs485, Some(Endpoint::Rs485(line)))
            | (FrameFormat::Rtu, Some(Endpoint::Rtu(line))) => Self {
                port: line.port.clone(),
                baud: line.baud,
                id: line.id.into(),
            },
            (FrameFormat::Tcp, Some(endpoint @ Endpoint::Tcp { unit, .. })) => {
                usual(&endpoint.place(), (*unit).into())
            }
            (FrameFormat::Can, Some(Endpoint::Can { interface, id })) => usual(interface, *id),
            (FrameFormat::Slcan, Some(Endpoint::Slcan { port, id, .. })) => usual(port, *id),
            (FrameFormat::UsbCan, Some(Endpoint::UsbCan { port, baud, id })) => Self {
                baud: *baud,
                ..usual(port, *id)
            },
            (FrameFormat::Rs485 | FrameFormat::Rtu | FrameFormat::UsbCan, _) => {
                usual("/dev/ttyUSB0", 1)
            }
            (FrameFormat::Tcp, _) => usual("192.168.11.210:6000", 255),
            (FrameFormat::Can, _) => usual("can0", 1),
            (FrameFormat::Slcan, _) => usual("/dev/ttyACM0", 1),
        }
    }
}

impl FrameSnippet {
    /// The snippet of a command. Its id is the endpoint's where the endpoint is of this wire, else the usual one.
    #[must_use]
    pub fn new(command: &HandCommand, wire: FrameFormat, endpoint: Option<&Endpoint>) -> Self {
        let address = SnippetAddress::of(wire, endpoint);
        let frames = command
            .writes()
            .iter()
            .flat_map(|write| frames(write, wire, address.id))
            .collect();
        Self {
            wire,
            address,
            frames,
        }
    }

    /// The snippet of one frame that passed over the wire of this endpoint; none on CAN, where the bytes hold more than
    /// the frame.
    #[must_use]
    pub fn passed(bytes: &[u8], endpoint: &Endpoint) -> Option<Self> {
        let wire = FrameFormat::of(endpoint);
        if matches!(wire, FrameFormat::Can) {
            return None;
        }
        let frame = SnippetFrame {
            can_id: None,
            bytes: bytes.into(),
        };
        Some(Self {
            wire,
            address: SnippetAddress::of(wire, Some(endpoint)),
            frames: vec![frame],
        })
    }

    /// The snippet written down.
    #[must_use]
    pub fn text(&self, form: SnippetFormat) -> String {
        match form {
            SnippetFormat::Hex => self.hex(),
            SnippetFormat::Python => self.python(),
            SnippetFormat::C => self.arrays("static const uint8_t FRAME_{n}[] = {{b}};", "{", "}"),
            SnippetFormat::Rust => self.arrays("const FRAME_{n}: [u8; {len}] = {{b}};", "[", "]"),
        }
    }

    fn hex(&self) -> String {
        let line = |frame: &SnippetFrame| match (self.wire, frame.can_id) {
            (FrameFormat::Slcan, _) => text_line(&frame.bytes),
            (_, Some(id)) => format!(
                "{id:08X}#{}",
                joined(&frame.bytes, "", |b| format!("{b:02X}"))
            ),
            (_, None) => joined(&frame.bytes, " ", |byte| format!("{byte:02X}")),
        };
        let lines: Vec<String> = self.frames.iter().map(line).collect();
        lines.join("\n")
    }

    fn python(&self) -> String {
        let SnippetAddress { port, baud, id } = &self.address;
        let (host, tcp_port) = port.rsplit_once(':').unwrap_or((port, "6000"));
        let (mut code, send) = match self.wire {
            FrameFormat::Rs485 | FrameFormat::Rtu | FrameFormat::Slcan | FrameFormat::UsbCan => (
                format!(
                    "import serial  # pyserial\nport = serial.Serial({port:?}, {baud}, timeout=0.2)\n"
                ),
                "port.write",
            ),
            FrameFormat::Tcp => (
                format!(
                    "import socket\nhand = socket.create_connection(({host:?}, {tcp_port}), timeout=1)\n"
                ),
                "hand.sendall",
            ),
            FrameFormat::Can => (
                format!(
                    "import can  # python-can, hand {id}\nbus = can.Bus({port:?}, interface=\"socketcan\")\n"
                ),
                "",
            ),
        };
        let read = match self.wire {
            FrameFormat::Tcp => "print(hand.recv(260).hex(\" \"))",
            FrameFormat::Can => "print(bus.recv(0.2))",
            _ => "print(port.read(64).hex(\" \"))",
        };
        for frame in &self.frames {
            let hex = joined(&frame.bytes, " ", |byte| format!("{byte:02X}"));
            let line = match frame.can_id {
                Some(can_id) => format!(
                    "bus.send(can.Message(arbitration_id=0x{can_id:08X}, is_extended_id=True, data=bytes.fromhex(\"{hex}\")))\n{read}\n"
                ),
                None => format!("{send}(bytes.fromhex(\"{hex}\"))\n{read}\n"),
            };
            code.push_str(&line);
        }
        code
    }

    /// One array a frame. On CAN a comment gives the identifier, which travels beside the bytes.
    fn arrays(&self, template: &str, open: &str, close: &str) -> String {
        let mut out = String::new();
        for (n, frame) in self.frames.iter().enumerate() {
            if let Some(id) = frame.can_id {
                // Writing to a String cannot fail.
                let _written = writeln!(
                    out,
                    "// CAN id 0x{id:08X}, 29 bits, {} bytes",
                    frame.bytes.len()
                );
            }
            let bytes = joined(&frame.bytes, ", ", |byte| format!("0x{byte:02X}"));
            let line = template
                .replace("{n}", &(n + 1).to_string())
                .replace("{len}", &frame.bytes.len().to_string())
                .replace("{{b}}", &format!("{open}{bytes}{close}"));
            out.push_str(&line);
            out.push('\n');
        }
        out
    }
}

fn frames(write: &RegisterWrite, wire: FrameFormat, id: u16) -> Vec<SnippetFrame> {
    let plain = |bytes: Vec<u8>| SnippetFrame {
        can_id: None,
        bytes,
    };
    match wire {
        FrameFormat::Rs485 => HandId::new(id)
            .map(|id| plain(rs485::client::encode_write(id, write).to_vec()))
            .into_iter()
            .collect(),
        FrameFormat::Rtu => {
            let mut bytes = vec![low(id)];
            bytes.extend(pdu(write));
            bytes.extend(crc16(&bytes).to_le_bytes());
            vec![plain(bytes)]
        }
        FrameFormat::Tcp => {
            let pdu = pdu(write);
            let rest = u16::try_from(pdu.len() + 1).unwrap_or_default();
            let mut bytes = vec![0, 1, 0, 0];
            bytes.extend(rest.to_be_bytes());
            bytes.push(low(id));
            bytes.extend(pdu);
            vec![plain(bytes)]
        }
        FrameFormat::Can => can_frames(write, id)
            .map(|frame| SnippetFrame {
                can_id: Some(frame.id),
                bytes: frame.data.to_vec(),
            })
            .collect(),
        FrameFormat::Slcan => can_frames(write, id)
            .filter_map(|frame| slcan::encode_command(&slcan::SlcanCommand::Send(frame)))
            .map(|line| plain(line.to_vec()))
            .collect(),
        FrameFormat::UsbCan => can_frames(write, id)
            .map(|frame| plain(usbcan::encode(&frame).to_vec()))
            .collect(),
    }
}

fn can_frames(write: &RegisterWrite, id: u16) -> impl Iterator<Item = can::CanFrame> {
    can::write_requests(id, write).into_iter().flatten()
}

/// Function code and what follows it.
fn pdu(write: &RegisterWrite) -> Vec<u8> {
    match words_from_write(write) {
        ModbusWrite::Single { address, value } => {
            let mut pdu = vec![6];
            pdu.extend(address.to_be_bytes());
            pdu.extend(value.to_be_bytes());
            pdu
        }
        ModbusWrite::Multiple { address, words } => {
            let count = u16::try_from(words.len()).unwrap_or_default();
            let mut pdu = vec![16];
            pdu.extend(address.to_be_bytes());
            pdu.extend(count.to_be_bytes());
            pdu.push(low(count * 2));
            pdu.extend(words.iter().flat_map(|word| word.to_be_bytes()));
            pdu
        }
    }
}

const fn low(word: u16) -> u8 {
    let [low, _] = word.to_le_bytes();
    low
}

fn joined(bytes: &[u8], between: &str, each: impl Fn(&u8) -> String) -> String {
    let all: Vec<String> = bytes.iter().map(each).collect();
    all.join(between)
}

/// A line of text with its carriage return made visible.
fn text_line(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).replace('\r', "\\r")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, Dof, Force, PerDof, Target};

    fn open_hand() -> HandCommand {
        HandCommand::Angles(PerDof::splat(Target::Go(Angle::MAX)))
    }

    fn index_force() -> HandCommand {
        let mut forces = PerDof::splat(None);
        forces[Dof::Index] = Some(Force::GENTLE);
        HandCommand::Forces(forces)
    }

    fn hex(command: &HandCommand, wire: FrameFormat) -> String {
        FrameSnippet::new(command, wire, None).text(SnippetFormat::Hex)
    }

    #[test]
    fn the_bytes_are_those_of_the_manual_and_of_other_encoders() {
        let words = "03 E8 03 E8 03 E8 03 E8 03 E8 03 E8";
        for (command, wire, frames) in [
            // Manual 2.2.2, and its example for 1486.
            (
                open_hand(),
                FrameFormat::Rs485,
                "EB 90 01 0F 12 CE 05 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 77".into(),
            ),
            (
                HandCommand::Save,
                FrameFormat::Rs485,
                "EB 90 01 04 12 ED 03 01 08".into(),
            ),
            // The sum is that of an independent CRC.
            (
                open_hand(),
                FrameFormat::Rtu,
                format!("01 10 05 CE 00 06 0C {words} 22 EF"),
            ),
            (
                open_hand(),
                FrameFormat::Tcp,
                format!("00 01 00 00 00 13 FF 10 05 CE 00 06 0C {words}"),
            ),
            (
                HandCommand::ClearErrors,
                FrameFormat::Tcp,
                "00 01 00 00 00 06 FF 06 03 EC 00 01".into(),
            ),
            (
                open_hand(),
                FrameFormat::Can,
                "05738001#E803E803E803E803\n05758001#E803E803".into(),
            ),
            (index_force(), FrameFormat::Can, "05780001#F401".into()),
            (
                index_force(),
                FrameFormat::Slcan,
                "T057800012F401\\r".into(),
            ),
            (
                index_force(),
                FrameFormat::UsbCan,
                "AA AA 01 00 78 05 F4 01 00 00 00 00 00 00 02 00 01 00 76 55 55".into(),
            ),
        ] {
            assert_eq!(hex(&command, wire), frames, "{wire:?} {command:?}");
        }
    }

    #[test]
    fn the_code_holds_the_same_bytes_and_the_persons_own_port() {
        let endpoint: Endpoint = "rs485:/dev/ttyUSB3?baud=57600&id=2".parse().unwrap();
        let snippet = FrameSnippet::new(&index_force(), FrameFormat::Rs485, Some(&endpoint));
        let hex = "EB 90 02 05 12 E0 05 F4 01 F3";
        assert_eq!(snippet.text(SnippetFormat::Hex), hex);
        let python = snippet.text(SnippetFormat::Python);
        assert!(python.contains(&format!("port.write(bytes.fromhex(\"{hex}\"))")));
        assert!(python.contains("serial.Serial(\"/dev/ttyUSB3\", 57600"));
        let c = "static const uint8_t FRAME_1[] = {0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3};\n";
        assert_eq!(snippet.text(SnippetFormat::C), c);
        let rust = "const FRAME_1: [u8; 10] = [0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3];\n";
        assert_eq!(snippet.text(SnippetFormat::Rust), rust);
    }

    #[test]
    fn code_for_can_names_the_identifier() {
        let snippet = FrameSnippet::new(&index_force(), FrameFormat::Can, None);
        assert!(
            snippet
                .text(SnippetFormat::C)
                .contains("// CAN id 0x05780001, 29 bits, 2 bytes")
        );
        assert!(
            snippet
                .text(SnippetFormat::Python)
                .contains("arbitration_id=0x05780001")
        );
    }
}
