//! A command as the bytes it becomes on each wire, and as code that a person can paste. Sends nothing.

use crate::codec::modbus::{ModbusWrite, words_from_write};
use crate::codec::modbus_rtu::crc16;
use crate::codec::{can, rs485, slcan, usbcan};
use crate::hand::{HandCommand, HandId, RegisterWrite};
use crate::transport::Endpoint;
use std::fmt::Write as _;

/// A wire that a hand can be reached over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RecipeWire {
    /// Private framing (manual 2.2).
    Rs485,
    /// Modbus RTU (manual 2.4).
    Rtu,
    /// Modbus TCP (manual 2.5).
    Tcp,
    /// CAN frames (manual 2.3).
    Can,
    /// The same through a serial adapter.
    Slcan,
    /// The same through the maker's adapter.
    UsbCan,
}

impl RecipeWire {
    /// All, in the order of the endpoints.
    pub const ALL: [Self; 6] = [
        Self::Rs485,
        Self::Rtu,
        Self::Tcp,
        Self::Can,
        Self::Slcan,
        Self::UsbCan,
    ];

    /// The wire of an endpoint; the built-in hand speaks RS485.
    #[must_use]
    pub const fn of(endpoint: &Endpoint) -> Self {
        match endpoint {
            Endpoint::Sim { .. } | Endpoint::Rs485(_) => Self::Rs485,
            Endpoint::Rtu(_) => Self::Rtu,
            Endpoint::Tcp { .. } => Self::Tcp,
            Endpoint::Can { .. } => Self::Can,
            Endpoint::Slcan { .. } => Self::Slcan,
            Endpoint::UsbCan { .. } => Self::UsbCan,
        }
    }

    /// Its usual name, the same in all languages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rs485 => "RS485",
            Self::Rtu => "Modbus RTU",
            Self::Tcp => "Modbus TCP",
            Self::Can => "CAN",
            Self::Slcan => "slcan",
            Self::UsbCan => "USB-CAN",
        }
    }
}

/// A way to write the bytes down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RecipeForm {
    /// Hexadecimal digits, one frame a line; CAN as `id#data`.
    Hex,
    /// Python: pyserial, a socket, or python-can.
    Python,
    /// C: arrays of bytes.
    C,
    /// Rust: arrays of bytes.
    Rust,
}

impl RecipeForm {
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
pub struct RecipeFrame {
    /// The 29-bit identifier.
    pub can_id: Option<u32>,
    /// The bytes in the order in which they go out.
    pub bytes: Vec<u8>,
}

/// The frames of a command on one wire, in order; each is sent after the answer to the one before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recipe {
    wire: RecipeWire,
    place: Place,
    /// The frames.
    pub frames: Vec<RecipeFrame>,
}

/// What the code names to reach the hand.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Place {
    port: String,
    baud: u32,
    id: u16,
}

impl Place {
    /// From the endpoint if it is of this wire, else as the maker delivers.
    fn of(wire: RecipeWire, endpoint: Option<&Endpoint>) -> Self {
        let usual = |port: &str, id: u16| Self {
            port: port.into(),
            baud: 115_200,
            id,
        };
        match (wire, endpoint) {
            (RecipeWire::Rs485, Some(Endpoint::Rs485(line)))
            | (RecipeWire::Rtu, Some(Endpoint::Rtu(line))) => Self {
                port: line.port.clone(),
                baud: line.baud,
                id: line.id.into(),
            },
            (RecipeWire::Tcp, Some(endpoint @ Endpoint::Tcp { unit, .. })) => {
                usual(&endpoint.place(), (*unit).into())
            }
            (RecipeWire::Can, Some(Endpoint::Can { interface, id })) => usual(interface, *id),
            (RecipeWire::Slcan, Some(Endpoint::Slcan { port, id, .. })) => usual(port, *id),
            (RecipeWire::UsbCan, Some(Endpoint::UsbCan { port, baud, id })) => Self {
                baud: *baud,
                ..usual(port, *id)
            },
            (RecipeWire::Rs485 | RecipeWire::Rtu | RecipeWire::UsbCan, _) => {
                usual("/dev/ttyUSB0", 1)
            }
            (RecipeWire::Tcp, _) => usual("192.168.11.210:6000", 255),
            (RecipeWire::Can, _) => usual("can0", 1),
            (RecipeWire::Slcan, _) => usual("/dev/ttyACM0", 1),
        }
    }
}

impl Recipe {
    /// The recipe of a command. Its id is the endpoint's where the endpoint is of this wire, else the usual one.
    #[must_use]
    pub fn new(command: &HandCommand, wire: RecipeWire, endpoint: Option<&Endpoint>) -> Self {
        let place = Place::of(wire, endpoint);
        let frames = command
            .writes()
            .iter()
            .flat_map(|write| frames(write, wire, place.id))
            .collect();
        Self {
            wire,
            place,
            frames,
        }
    }

    /// The recipe of one frame that passed over the wire of this endpoint; none on CAN, where the bytes hold more than
    /// the frame.
    #[must_use]
    pub fn passed(bytes: &[u8], endpoint: &Endpoint) -> Option<Self> {
        let wire = RecipeWire::of(endpoint);
        if matches!(wire, RecipeWire::Can) {
            return None;
        }
        let frame = RecipeFrame {
            can_id: None,
            bytes: bytes.into(),
        };
        Some(Self {
            wire,
            place: Place::of(wire, Some(endpoint)),
            frames: vec![frame],
        })
    }

    /// The recipe written down.
    #[must_use]
    pub fn text(&self, form: RecipeForm) -> String {
        match form {
            RecipeForm::Hex => self.hex(),
            RecipeForm::Python => self.python(),
            RecipeForm::C => self.arrays("static const uint8_t FRAME_{n}[] = {{b}};", "{", "}"),
            RecipeForm::Rust => self.arrays("const FRAME_{n}: [u8; {len}] = {{b}};", "[", "]"),
        }
    }

    fn hex(&self) -> String {
        let line = |frame: &RecipeFrame| match (self.wire, frame.can_id) {
            (RecipeWire::Slcan, _) => text_line(&frame.bytes),
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
        let Place { port, baud, id } = &self.place;
        let (host, tcp_port) = port.rsplit_once(':').unwrap_or((port, "6000"));
        let (mut code, send) = match self.wire {
            RecipeWire::Rs485 | RecipeWire::Rtu | RecipeWire::Slcan | RecipeWire::UsbCan => (
                format!(
                    "import serial  # pyserial\nport = serial.Serial({port:?}, {baud}, timeout=0.2)\n"
                ),
                "port.write",
            ),
            RecipeWire::Tcp => (
                format!(
                    "import socket\nhand = socket.create_connection(({host:?}, {tcp_port}), timeout=1)\n"
                ),
                "hand.sendall",
            ),
            RecipeWire::Can => (
                format!(
                    "import can  # python-can, hand {id}\nbus = can.Bus({port:?}, interface=\"socketcan\")\n"
                ),
                "",
            ),
        };
        let read = match self.wire {
            RecipeWire::Tcp => "print(hand.recv(260).hex(\" \"))",
            RecipeWire::Can => "print(bus.recv(0.2))",
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

fn frames(write: &RegisterWrite, wire: RecipeWire, id: u16) -> Vec<RecipeFrame> {
    let plain = |bytes: Vec<u8>| RecipeFrame {
        can_id: None,
        bytes,
    };
    match wire {
        RecipeWire::Rs485 => HandId::new(id)
            .map(|id| plain(rs485::client::encode_write(id, write).to_vec()))
            .into_iter()
            .collect(),
        RecipeWire::Rtu => {
            let mut bytes = vec![low(id)];
            bytes.extend(pdu(write));
            bytes.extend(crc16(&bytes).to_le_bytes());
            vec![plain(bytes)]
        }
        RecipeWire::Tcp => {
            let pdu = pdu(write);
            let rest = u16::try_from(pdu.len() + 1).unwrap_or_default();
            let mut bytes = vec![0, 1, 0, 0];
            bytes.extend(rest.to_be_bytes());
            bytes.push(low(id));
            bytes.extend(pdu);
            vec![plain(bytes)]
        }
        RecipeWire::Can => can_frames(write, id)
            .map(|frame| RecipeFrame {
                can_id: Some(frame.id),
                bytes: frame.data.to_vec(),
            })
            .collect(),
        RecipeWire::Slcan => can_frames(write, id)
            .filter_map(|frame| slcan::encode_command(&slcan::SlcanCommand::Send(frame)))
            .map(|line| plain(line.to_vec()))
            .collect(),
        RecipeWire::UsbCan => can_frames(write, id)
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

    fn hex(command: &HandCommand, wire: RecipeWire) -> String {
        Recipe::new(command, wire, None).text(RecipeForm::Hex)
    }

    #[test]
    fn the_bytes_are_those_of_the_manual_and_of_other_encoders() {
        let words = "03 E8 03 E8 03 E8 03 E8 03 E8 03 E8";
        for (command, wire, frames) in [
            // Manual 2.2.2, and its example for 1486.
            (
                open_hand(),
                RecipeWire::Rs485,
                "EB 90 01 0F 12 CE 05 E8 03 E8 03 E8 03 E8 03 E8 03 E8 03 77".into(),
            ),
            (
                HandCommand::Save,
                RecipeWire::Rs485,
                "EB 90 01 04 12 ED 03 01 08".into(),
            ),
            // The sum is that of an independent CRC.
            (
                open_hand(),
                RecipeWire::Rtu,
                format!("01 10 05 CE 00 06 0C {words} 22 EF"),
            ),
            (
                open_hand(),
                RecipeWire::Tcp,
                format!("00 01 00 00 00 13 FF 10 05 CE 00 06 0C {words}"),
            ),
            (
                HandCommand::ClearErrors,
                RecipeWire::Tcp,
                "00 01 00 00 00 06 FF 06 03 EC 00 01".into(),
            ),
            (
                open_hand(),
                RecipeWire::Can,
                "05738001#E803E803E803E803\n05758001#E803E803".into(),
            ),
            (index_force(), RecipeWire::Can, "05780001#F401".into()),
            (index_force(), RecipeWire::Slcan, "T057800012F401\\r".into()),
            (
                index_force(),
                RecipeWire::UsbCan,
                "AA AA 01 00 78 05 F4 01 00 00 00 00 00 00 02 00 01 00 76 55 55".into(),
            ),
        ] {
            assert_eq!(hex(&command, wire), frames, "{wire:?} {command:?}");
        }
    }

    #[test]
    fn the_code_holds_the_same_bytes_and_the_persons_own_port() {
        let endpoint: Endpoint = "rs485:/dev/ttyUSB3?baud=57600&id=2".parse().unwrap();
        let recipe = Recipe::new(&index_force(), RecipeWire::Rs485, Some(&endpoint));
        let hex = "EB 90 02 05 12 E0 05 F4 01 F3";
        assert_eq!(recipe.text(RecipeForm::Hex), hex);
        let python = recipe.text(RecipeForm::Python);
        assert!(python.contains(&format!("port.write(bytes.fromhex(\"{hex}\"))")));
        assert!(python.contains("serial.Serial(\"/dev/ttyUSB3\", 57600"));
        let c = "static const uint8_t FRAME_1[] = {0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3};\n";
        assert_eq!(recipe.text(RecipeForm::C), c);
        let rust = "const FRAME_1: [u8; 10] = [0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3];\n";
        assert_eq!(recipe.text(RecipeForm::Rust), rust);
    }

    #[test]
    fn code_for_can_names_the_identifier() {
        let recipe = Recipe::new(&index_force(), RecipeWire::Can, None);
        assert!(
            recipe
                .text(RecipeForm::C)
                .contains("// CAN id 0x05780001, 29 bits, 2 bytes")
        );
        assert!(
            recipe
                .text(RecipeForm::Python)
                .contains("arbitration_id=0x05780001")
        );
    }
}
