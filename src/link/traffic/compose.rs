//! Converts a recorded frame to code that the user can paste. Sends nothing.

use crate::link::traffic::frame::hex;
use crate::transport::Endpoint;

/// Format of a snippet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SnippetFormat {
    /// Hexadecimal digits.
    Hex,
    /// Python: pyserial or a socket.
    Python,
    /// C: an array of bytes.
    C,
    /// Rust: an array of bytes.
    Rust,
}

impl SnippetFormat {
    /// All formats, in menu order.
    pub const ALL: [Self; 4] = [Self::Hex, Self::Python, Self::C, Self::Rust];

    /// Name of the format, the same in all UI languages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hex => "Hex",
            Self::Python => "Python",
            Self::C => "C",
            Self::Rust => "Rust",
        }
    }

    /// The text of one frame of this endpoint. On CAN only hexadecimal: the bytes there contain more than the frame.
    pub fn text(self, bytes: &[u8], endpoint: Option<&Endpoint>) -> Option<String> {
        if endpoint.is_some_and(|endpoint| endpoint.interface().is_some()) && self != Self::Hex {
            return None;
        }
        let len = bytes.len();
        let listed: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02X}")).collect();
        let listed = listed.join(", ");
        Some(match self {
            Self::Hex => hex(bytes),
            Self::Python => python(&hex(bytes), endpoint),
            Self::C => format!("static const uint8_t FRAME[] = {{{listed}}};\n"),
            Self::Rust => format!("const FRAME: [u8; {len}] = [{listed}];\n"),
        })
    }
}

fn python(hex: &str, endpoint: Option<&Endpoint>) -> String {
    let (port, baud) = match endpoint {
        Some(tcp @ (Endpoint::Tcp { .. } | Endpoint::RtuTcp(_))) => {
            let place = tcp.place();
            let (host, port) = place.rsplit_once(':').unwrap_or((&place, "6000"));
            return format!(
                "import socket\nhand = socket.create_connection(({host:?}, {port}), timeout=1)\n\
                 hand.sendall(bytes.fromhex(\"{hex}\"))\nprint(hand.recv(260).hex(\" \"))\n"
            );
        }
        other => {
            let port = other.and_then(Endpoint::port).unwrap_or("/dev/ttyUSB0");
            (port, other.and_then(Endpoint::baud).unwrap_or(115_200))
        }
    };
    format!(
        "import serial  # pyserial\nport = serial.Serial({port:?}, {baud}, timeout=0.2)\n\
         port.write(bytes.fromhex(\"{hex}\"))\nprint(port.read(64).hex(\" \"))\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_code_holds_the_same_bytes_and_the_persons_own_port() {
        let endpoint: Endpoint = "rs485:/dev/ttyUSB3?baud=57600&id=2".parse().unwrap();
        let bytes = [0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3];
        let text = |format: SnippetFormat| format.text(&bytes, Some(&endpoint)).unwrap();
        let hex = "EB 90 02 05 12 E0 05 F4 01 F3";
        assert_eq!(text(SnippetFormat::Hex), hex);
        let python = text(SnippetFormat::Python);
        assert!(python.contains(&format!("port.write(bytes.fromhex(\"{hex}\"))")));
        assert!(python.contains("serial.Serial(\"/dev/ttyUSB3\", 57600"));
        let listed = "0xEB, 0x90, 0x02, 0x05, 0x12, 0xE0, 0x05, 0xF4, 0x01, 0xF3";
        let c = format!("static const uint8_t FRAME[] = {{{listed}}};\n");
        assert_eq!(text(SnippetFormat::C), c);
        let rust = format!("const FRAME: [u8; 10] = [{listed}];\n");
        assert_eq!(text(SnippetFormat::Rust), rust);
        let tcp: Endpoint = "tcp:192.168.11.210".parse().unwrap();
        let python = SnippetFormat::Python.text(&bytes, Some(&tcp)).unwrap();
        assert!(python.contains("create_connection((\"192.168.11.210\", 6000)"));
    }

    #[test]
    fn on_can_only_the_digits_are_offered() {
        let can: Endpoint = "can:can0?id=1".parse().unwrap();
        let offered = |format: &SnippetFormat| format.text(&[1], Some(&can)).is_some();
        let offered: Vec<_> = SnippetFormat::ALL.into_iter().filter(offered).collect();
        assert_eq!(offered, [SnippetFormat::Hex]);
    }
}
