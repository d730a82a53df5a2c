//! Endpoints: the address of a hand, in one spelling for command line, config, window and files. Opens nothing.
pub mod error;
mod parse;
pub mod route;
pub mod typed;

use crate::hand::register::BytePacking;
pub use crate::transport::endpoint::error::EndpointError;
use std::fmt;

/// Default baud rate of a hand (manual 2.2).
pub const DEFAULT_BAUD: u32 = 115_200;
/// Port of the hand's Modbus TCP server (manual 1.3.2).
pub const DEFAULT_TCP_PORT: u16 = 6000;
/// Unit id that the manual prints for Modbus TCP (2.5).
pub const DEFAULT_UNIT: u8 = 255;
/// Default CAN bit rate (manual 2.3).
pub const DEFAULT_BITRATE: u32 = 1_000_000;
/// Default bus id of a hand (manual 2.6.1).
pub const DEFAULT_ID: u8 = 1;
/// Scenario of the built-in hand when none is named.
pub const DEFAULT_SCENARIO: &str = "idle";
/// Scenarios of the built-in hand.
pub const SCENARIOS: [&str; 9] = [
    DEFAULT_SCENARIO,
    "free",
    "rigid",
    "fragile",
    "grasp",
    "touched",
    "faults",
    "extremes",
    "frozen",
];
/// Scenarios in which an object can be chosen.
pub const OBJECT_SCENARIOS: [&str; 5] = [DEFAULT_SCENARIO, "free", "rigid", "fragile", "grasp"];

/// Address and protocol of a hand. The spelling is that of [`fmt::Display`] and `FromStr`.
///
/// ```
/// use handscope_core::transport::Endpoint;
///
/// let hand: Endpoint = "tcp:192.168.11.210".parse()?;
/// assert_eq!(hand.to_string(), "tcp:192.168.11.210:6000?unit=255");
/// assert!("tcp:192.168.11.210?baud=115200".parse::<Endpoint>().is_err());
/// # Ok::<(), handscope_core::transport::EndpointError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Endpoint {
    /// `sim:?seed=7&scenario=grasp&body=worn.toml&object=cup`: the built-in hand, in this process.
    Sim {
        /// Seed of its random numbers.
        seed: u64,
        /// Its scenario.
        scenario: String,
        /// File of its body; `None` for the default body.
        body: Option<String>,
        /// Name or file of the object between its fingers; `None` for that of the scenario.
        object: Option<String>,
    },
    /// `rs485:/dev/ttyUSB0?baud=115200&id=1`: private framing.
    Rs485(SerialLine),
    /// `rtu:/dev/ttyUSB0?baud=115200&id=1`: Modbus RTU.
    Rtu(SerialLine),
    /// `rtu+tcp:192.168.11.7:4001?baud=115200&id=1`: Modbus RTU through a serial device server, whose address and TCP
    /// port replace the serial port.
    RtuTcp(SerialLine),
    /// `tcp:192.168.11.210:6000?unit=255`: Modbus TCP.
    Tcp {
        /// Name or address, without brackets.
        host: String,
        /// TCP port.
        port: u16,
        /// Modbus unit id.
        unit: u8,
        /// Packing of single bytes in words; `None` if the link should detect it.
        packing: Option<BytePacking>,
    },
    /// `can:can0?id=1`: SocketCAN.
    Can {
        /// Network interface.
        interface: String,
        /// Hand id, 1..=16383.
        id: u16,
    },
    /// `slcan:/dev/ttyACM0?bitrate=1000000&id=1`: CAN over a serial adapter.
    Slcan {
        /// Serial port of the adapter.
        port: String,
        /// CAN bit rate.
        bitrate: u32,
        /// Hand id, 1..=16383.
        id: u16,
    },
    /// `usbcan:/dev/ttyUSB0?baud=115200&id=1`: CAN over the maker's own adapter.
    UsbCan {
        /// Serial port of the adapter.
        port: String,
        /// Bits per second on its serial side. Its bit rate on CAN is configured in the adapter.
        baud: u32,
        /// Hand id, 1..=16383.
        id: u16,
    },
}

/// A serial port, its speed and the id of the hand on it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SerialLine {
    /// Path or name of the port.
    pub port: String,
    /// Bits per second.
    pub baud: u32,
    /// Hand id, 1..=254.
    pub id: u8,
    /// As in [`Endpoint::Tcp`]; never in `rs485:`, which has no words.
    pub packing: Option<BytePacking>,
}

impl Endpoint {
    /// The built-in hand with its defaults.
    pub fn sim() -> Self {
        Self::Sim {
            seed: 1,
            scenario: DEFAULT_SCENARIO.into(),
            body: None,
            object: None,
        }
    }

    /// True for the built-in hand.
    pub const fn is_sim(&self) -> bool {
        matches!(self, Self::Sim { .. })
    }

    /// Place and id for persistent files: the endpoint without the id, and the id or unit.
    pub fn place_and_id(&self) -> (String, u16) {
        let place = format!("{}:{}", self.kind(), self.place());
        let place = match self {
            Self::Sim { seed, body, .. } => {
                format!("sim:?seed={seed}{}", text_key("body", body.as_deref()))
            }
            Self::Slcan { bitrate, .. } => format!("{place}?bitrate={bitrate}"),
            _ => match self.baud() {
                Some(baud) => format!("{place}?baud={baud}"),
                None => place,
            },
        };
        (place, self.id_or_unit())
    }

    /// The id or unit of requests to the hand.
    pub fn id_or_unit(&self) -> u16 {
        match self {
            Self::Tcp { unit, .. } => u16::from(*unit),
            _ => self.bus_id().unwrap_or(1),
        }
    }

    /// The same as a file name that is unique to the hand, without extension.
    pub fn file_stem(&self) -> String {
        let (place, id) = self.place_and_id();
        let plain = |letter: char| match letter {
            letter if letter.is_ascii_alphanumeric() || letter == '.' => letter.to_string(),
            letter => format!("_{:x}", u32::from(letter)),
        };
        let place: String = place.chars().map(plain).collect();
        format!("{place}-id{id}")
    }

    /// True if the hand is on a CAN bus.
    pub const fn is_can(&self) -> bool {
        matches!(
            self,
            Self::Can { .. } | Self::Slcan { .. } | Self::UsbCan { .. }
        )
    }

    /// The place for the user to check when it fails: the port, the address, the interface.
    pub fn place(&self) -> String {
        match self {
            Self::Sim { .. } => "the simulated hand".into(),
            Self::Rs485(line) | Self::Rtu(line) | Self::RtuTcp(line) => line.port.clone(),
            Self::Tcp { host, port, .. } if host.contains(':') => format!("[{host}]:{port}"),
            Self::Tcp { host, port, .. } => format!("{host}:{port}"),
            Self::Can { interface, .. } => interface.clone(),
            Self::Slcan { port, .. } | Self::UsbCan { port, .. } => port.clone(),
        }
    }

    /// The serial port; `None` if it has none.
    pub fn port(&self) -> Option<&str> {
        match self {
            Self::Rs485(line) | Self::Rtu(line) => Some(&line.port),
            Self::Slcan { port, .. } | Self::UsbCan { port, .. } => Some(port),
            Self::Sim { .. } | Self::Tcp { .. } | Self::RtuTcp(_) | Self::Can { .. } => None,
        }
    }

    /// The same hand through another serial port. Endpoints without one are unchanged.
    pub fn through(&self, path: &str) -> Self {
        let mut moved = self.clone();
        match &mut moved {
            Self::Rs485(line) | Self::Rtu(line) => path.clone_into(&mut line.port),
            Self::Slcan { port, .. } | Self::UsbCan { port, .. } => path.clone_into(port),
            Self::Sim { .. } | Self::Tcp { .. } | Self::RtuTcp(_) | Self::Can { .. } => {}
        }
        moved
    }

    /// The network interface of a CAN bus; `None` for other endpoints.
    pub fn interface(&self) -> Option<&str> {
        match self {
            Self::Can { interface, .. } => Some(interface),
            _ => None,
        }
    }

    /// Bits per second of the serial line to the hand or to the maker's adapter; `None` for other endpoints.
    pub const fn baud(&self) -> Option<u32> {
        match self {
            Self::Rs485(line) | Self::Rtu(line) | Self::RtuTcp(line) => Some(line.baud),
            Self::UsbCan { baud, .. } => Some(*baud),
            Self::Sim { .. } | Self::Tcp { .. } | Self::Can { .. } | Self::Slcan { .. } => None,
        }
    }

    /// The id by which a hand on a bus is addressed; `None` for the built-in hand and over Modbus TCP.
    pub fn bus_id(&self) -> Option<u16> {
        match self {
            Self::Rs485(line) | Self::Rtu(line) | Self::RtuTcp(line) => Some(u16::from(line.id)),
            Self::Can { id, .. } | Self::Slcan { id, .. } | Self::UsbCan { id, .. } => Some(*id),
            Self::Sim { .. } | Self::Tcp { .. } => None,
        }
    }

    /// A hand with another id on the same bus; `None` where hands are not addressed by an id.
    pub fn with_bus_id(&self, id: u8) -> Option<Self> {
        let mut other = self.clone();
        match &mut other {
            Self::Rs485(line) | Self::Rtu(line) | Self::RtuTcp(line) => line.id = id,
            Self::Can { id: at, .. } | Self::Slcan { id: at, .. } | Self::UsbCan { id: at, .. } => {
                *at = u16::from(id);
            }
            Self::Sim { .. } | Self::Tcp { .. } => return None,
        }
        Some(other)
    }

    /// Host and TCP port; `None` if it is not on a network.
    pub fn host(&self) -> Option<(&str, u16)> {
        match self {
            Self::Tcp { host, port, .. } => Some((host, *port)),
            Self::RtuTcp(line) => {
                let (host, port) = line.port.rsplit_once(':')?;
                let host = host.strip_prefix('[').unwrap_or(host);
                Some((host.strip_suffix(']').unwrap_or(host), port.parse().ok()?))
            }
            _ => None,
        }
    }

    /// The part before the colon.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Sim { .. } => "sim",
            Self::Rs485(_) => "rs485",
            Self::Rtu(_) => "rtu",
            Self::RtuTcp(_) => "rtu+tcp",
            Self::Tcp { .. } => "tcp",
            Self::Can { .. } => "can",
            Self::Slcan { .. } => "slcan",
            Self::UsbCan { .. } => "usbcan",
        }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sim {
                seed,
                scenario,
                body,
                object,
            } => {
                let body = text_key("body", body.as_deref());
                let object = text_key("object", object.as_deref());
                write!(f, "sim:?seed={seed}&scenario={scenario}{body}{object}")
            }
            Self::Rs485(line) | Self::Rtu(line) | Self::RtuTcp(line) => {
                write!(
                    f,
                    "{}:{}?baud={}&id={}",
                    self.kind(),
                    line.port,
                    line.baud,
                    line.id
                )?;
                packing_key(f, line.packing)
            }
            Self::Tcp { unit, packing, .. } => {
                write!(f, "tcp:{}?unit={unit}", self.place())?;
                packing_key(f, *packing)
            }
            Self::Can { interface, id } => write!(f, "can:{interface}?id={id}"),
            Self::Slcan { port, bitrate, id } => {
                write!(f, "slcan:{port}?bitrate={bitrate}&id={id}")
            }
            Self::UsbCan { port, baud, id } => write!(f, "usbcan:{port}?baud={baud}&id={id}"),
        }
    }
}

fn text_key(key: &str, text: Option<&str>) -> String {
    text.map(|text| format!("&{key}={text}"))
        .unwrap_or_default()
}

fn packing_key(f: &mut fmt::Formatter<'_>, packing: Option<BytePacking>) -> fmt::Result {
    packing.map_or(Ok(()), |packing| write!(f, "&packing={}", packing.key()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_reads_back_as_itself() {
        for (text, full) in [
            ("sim:", "sim:?seed=1&scenario=idle"),
            ("sim:?seed=7&scenario=grasp", "sim:?seed=7&scenario=grasp"),
            (
                "sim:?body=/tmp/a worn=hand.toml",
                "sim:?seed=1&scenario=idle&body=/tmp/a worn=hand.toml",
            ),
            (
                "sim:?body=b.toml&scenario=rigid&seed=3",
                "sim:?seed=3&scenario=rigid&body=b.toml",
            ),
            (
                "sim:?object=egg&body=b.toml",
                "sim:?seed=1&scenario=idle&body=b.toml&object=egg",
            ),
            (
                "sim:?scenario=grasp&object=/tmp/my can.toml",
                "sim:?seed=1&scenario=grasp&object=/tmp/my can.toml",
            ),
            ("rs485:/dev/ttyUSB0", "rs485:/dev/ttyUSB0?baud=115200&id=1"),
            ("rs485:COM5?id=7&baud=921600", "rs485:COM5?baud=921600&id=7"),
            (
                "rtu:/dev/ttyUSB0?baud=19200",
                "rtu:/dev/ttyUSB0?baud=19200&id=1",
            ),
            ("tcp:192.168.11.210", "tcp:192.168.11.210:6000?unit=255"),
            ("tcp:127.0.0.1:6001?unit=1", "tcp:127.0.0.1:6001?unit=1"),
            ("tcp:[::1]:6001", "tcp:[::1]:6001?unit=255"),
            ("tcp:::1", "tcp:[::1]:6000?unit=255"),
            (
                "tcp:127.0.0.1?packing=high",
                "tcp:127.0.0.1:6000?unit=255&packing=high",
            ),
            (
                "rtu:COM3?packing=one&id=2",
                "rtu:COM3?baud=115200&id=2&packing=one",
            ),
            (
                "tcp:[::1]?packing=low",
                "tcp:[::1]:6000?unit=255&packing=low",
            ),
            (
                "rtu+tcp:192.168.11.7:4001",
                "rtu+tcp:192.168.11.7:4001?baud=115200&id=1",
            ),
            (
                "rtu+tcp:[fe80::1%eth0]:4001?id=3&packing=low",
                "rtu+tcp:[fe80::1%eth0]:4001?baud=115200&id=3&packing=low",
            ),
            ("can:can0?id=16383", "can:can0?id=16383"),
            (
                "slcan:/dev/ttyACM0?bitrate=500000",
                "slcan:/dev/ttyACM0?bitrate=500000&id=1",
            ),
            ("usbcan:COM4?id=7", "usbcan:COM4?baud=115200&id=7"),
        ] {
            let endpoint: Endpoint = text.parse().unwrap();
            assert_eq!(endpoint.to_string(), full);
            assert_eq!(full.parse::<Endpoint>().unwrap(), endpoint);
        }
    }

    #[test]
    fn text_after_sim_that_is_not_a_setting_is_refused() {
        for text in ["sim:foo", "sim:seed=7&scenario=grasp", "sim:scenario=bogus"] {
            let Err(EndpointError::Key { key, kind, .. }) = text.parse::<Endpoint>() else {
                panic!("{text}");
            };
            assert_eq!((format!("sim:{key}").as_str(), kind), (text, "sim"));
        }
    }

    #[test]
    fn the_place_is_what_a_person_looks_at() {
        for (text, place) in [
            ("sim:", "the simulated hand"),
            ("rs485:/dev/ttyUSB0", "/dev/ttyUSB0"),
            ("tcp:[::1]:6001?unit=1", "[::1]:6001"),
            ("tcp:127.0.0.1", "127.0.0.1:6000"),
            ("can:can0?id=3", "can0"),
        ] {
            assert_eq!(text.parse::<Endpoint>().unwrap().place(), place);
        }
    }

    #[test]
    fn wrong_spellings_say_what_is_wrong() {
        for (text, part) in [
            ("", "does not name a kind"),
            ("/dev/ttyUSB0", "does not name a kind"),
            ("usb:/dev/ttyUSB0", "does not name a kind"),
            ("rs485:", "is incomplete"),
            ("rs485:/dev/x?id=0", "1 to 254"),
            ("rs485:/dev/x?id=255", "1 to 254"),
            ("rs485:/dev/x?speed=1", "is not a setting"),
            ("rs485:/dev/x?baud=fast", "invalid value"),
            ("tcp::6000", "is incomplete"),
            ("tcp:::1]6000", "is incomplete"),
            ("tcp:host:99999", "1 to 65535"),
            ("tcp:host:0", "1 to 65535"),
            ("tcp:host?unit=256", "0 to 255"),
            ("tcp:host?packing=middle", "low, high or one"),
            ("tcp:host?packing=", "low, high or one"),
            ("rs485:/dev/x?packing=high", "is not a setting"),
            ("rtu+tcp:", "is incomplete"),
            ("rtu+tcp:host", "is incomplete"),
            ("rtu+tcp:host:0", "1 to 65535"),
            ("rtu+tcp:host:4001?unit=1", "is not a setting"),
            ("can:can0?id=16384", "16383"),
            ("slcan:/dev/x?bitrate=83333", "800000 or 1000000"),
            ("usbcan:", "is incomplete"),
            ("usbcan:/dev/x?bitrate=500000", "is not a setting"),
            ("usbcan:/dev/x?baud=9", "300 to 4000000"),
            ("sim:?seed=-1", "whole number"),
            ("sim:?scenario=nope", "idle, free, rigid"),
            ("sim:?scenario=", "idle, free, rigid"),
            ("sim:?object=", "--print-object"),
            ("sim:?object=cup&object=egg", "duplicate key 'object'"),
            (
                "sim:?object=cup&scenario=touched",
                "idle, free, rigid, fragile or grasp where an object is given",
            ),
            ("sim:?seed=1&seed=1", "duplicate key 'seed'"),
            (
                "sim:?scenario=idle&seed=1&scenario=free",
                "duplicate key 'scenario'",
            ),
            ("rs485:/dev/x?id=1&baud=9600&id=2", "duplicate key 'id'"),
            (
                "rtu:/dev/x?packing=low&packing=low",
                "duplicate key 'packing'",
            ),
            ("tcp:host?unit=1&unit=2", "duplicate key 'unit'"),
            ("can:can0?id=1&id=2", "duplicate key 'id'"),
            ("slcan:/dev/x?bitrate=500000&bitrate=500000", "'bitrate'"),
            ("usbcan:/dev/x?baud=9600&baud=9600", "duplicate key 'baud'"),
        ] {
            let error = text.parse::<Endpoint>().unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
