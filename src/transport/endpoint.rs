//! Endpoints: where a hand is, in one spelling for command line, config, window and files. Opens nothing.

pub use crate::transport::endpoint_error::EndpointError;
use crate::transport::packing::Packing;
use std::fmt;
use std::str::FromStr;

/// Serial speed of a hand as delivered (manual 2.2).
pub const DEFAULT_BAUD: u32 = 115_200;
/// Port of the hand's Modbus TCP server (manual 1.3.2).
pub const DEFAULT_TCP_PORT: u16 = 6000;
/// Unit id that the manual prints for Modbus TCP (2.5).
pub const DEFAULT_UNIT: u8 = 255;
/// CAN bit rate as delivered (manual 2.3).
pub const DEFAULT_BITRATE: u32 = 1_000_000;
/// CAN bit rates that serial adapters have a code for (Lawicel `S0` to `S8`).
const SLCAN_BITRATES: [u32; 9] = [
    10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000,
];
/// Bus id of a hand as delivered (manual 2.6.1).
pub const DEFAULT_ID: u8 = 1;
/// Scenario of the built-in hand when none is named.
pub const DEFAULT_SCENARIO: &str = "idle";
/// The same in words.
const SLCAN_WANT: &str =
    "10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000 or 1000000 bits a second";
/// Largest id on a CAN bus (manual 2.3).
const CAN_ID_MAX: u16 = 16_383;

/// Where a hand is and how it is spoken to. The spelling is that of [`fmt::Display`] and [`FromStr`].
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Endpoint {
    /// `sim:?seed=7&scenario=grasp`: the built-in hand, in this process.
    Sim {
        /// Seed of everything random in it.
        seed: u64,
        /// What it does.
        scenario: String,
    },
    /// `rs485:/dev/ttyUSB0?baud=115200&id=1`: private framing.
    Rs485(SerialLine),
    /// `rtu:/dev/ttyUSB0?baud=115200&id=1`: Modbus RTU.
    Rtu(SerialLine),
    /// `tcp:192.168.11.210:6000?unit=255`: Modbus TCP.
    Tcp {
        /// Name or address, without brackets.
        host: String,
        /// TCP port.
        port: u16,
        /// Modbus unit id.
        unit: u8,
        /// How single bytes stand in words, where a person says so; else the link finds out.
        packing: Option<Packing>,
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
}

/// A serial port, its speed and the id of the hand on it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SerialLine {
    /// Path or name of the port.
    pub port: String,
    /// Bits a second.
    pub baud: u32,
    /// Hand id, 1..=254.
    pub id: u8,
    /// As in [`Endpoint::Tcp`]; never in `rs485:`, which has no words.
    pub packing: Option<Packing>,
}

impl Endpoint {
    /// The built-in hand with its defaults.
    #[must_use]
    pub fn sim() -> Self {
        Self::Sim {
            seed: 1,
            scenario: DEFAULT_SCENARIO.into(),
        }
    }

    /// True for the built-in hand.
    #[must_use]
    pub const fn is_sim(&self) -> bool {
        matches!(self, Self::Sim { .. })
    }

    /// What a person looks at when it fails: the port, the address, the interface.
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Sim { .. } => "the simulated hand".into(),
            Self::Rs485(line) | Self::Rtu(line) => line.port.clone(),
            Self::Tcp { host, port, .. } if host.contains(':') => format!("[{host}]:{port}"),
            Self::Tcp { host, port, .. } => format!("{host}:{port}"),
            Self::Can { interface, .. } => interface.clone(),
            Self::Slcan { port, .. } => port.clone(),
        }
    }

    /// The serial port it is reached through, if it is.
    #[must_use]
    pub fn port(&self) -> Option<&str> {
        match self {
            Self::Rs485(line) | Self::Rtu(line) => Some(&line.port),
            Self::Slcan { port, .. } => Some(port),
            Self::Sim { .. } | Self::Tcp { .. } | Self::Can { .. } => None,
        }
    }

    /// The same hand through another serial port. Endpoints without one stay as they are.
    #[must_use]
    pub fn through(&self, path: &str) -> Self {
        let mut moved = self.clone();
        match &mut moved {
            Self::Rs485(line) | Self::Rtu(line) => path.clone_into(&mut line.port),
            Self::Slcan { port, .. } => path.clone_into(port),
            Self::Sim { .. } | Self::Tcp { .. } | Self::Can { .. } => {}
        }
        moved
    }

    /// The part before the colon.
    #[must_use]
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Sim { .. } => "sim",
            Self::Rs485(_) => "rs485",
            Self::Rtu(_) => "rtu",
            Self::Tcp { .. } => "tcp",
            Self::Can { .. } => "can",
            Self::Slcan { .. } => "slcan",
        }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sim { seed, scenario } => write!(f, "sim:?seed={seed}&scenario={scenario}"),
            Self::Rs485(line) | Self::Rtu(line) => {
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
        }
    }
}

fn packing_key(f: &mut fmt::Formatter<'_>, packing: Option<Packing>) -> fmt::Result {
    packing.map_or(Ok(()), |packing| write!(f, "&packing={packing}"))
}

impl FromStr for Endpoint {
    type Err = EndpointError;

    fn from_str(text: &str) -> Result<Self, EndpointError> {
        let unknown = || EndpointError::Kind { text: text.into() };
        let (kind, rest) = text.trim().split_once(':').ok_or_else(unknown)?;
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        let keys = Query {
            text,
            place,
            pairs: query,
        };
        match kind {
            "sim" => keys.sim(),
            "rs485" => Ok(Self::Rs485(keys.serial("rs485", "rs485:/dev/ttyUSB0")?)),
            "rtu" => Ok(Self::Rtu(keys.serial("rtu", "rtu:/dev/ttyUSB0")?)),
            "tcp" => keys.tcp(),
            "can" => keys.can(),
            "slcan" => keys.slcan(),
            _ => Err(unknown()),
        }
    }
}

/// The parts of an endpoint's text.
struct Query<'a> {
    text: &'a str,
    place: &'a str,
    pairs: &'a str,
}

impl Query<'_> {
    fn pairs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.pairs
            .split('&')
            .filter(|pair| !pair.is_empty())
            .map(|pair| pair.split_once('=').unwrap_or((pair, "")))
    }

    fn place(&self, kind: &'static str, example: &'static str) -> Result<String, EndpointError> {
        if self.place.is_empty() {
            return Err(EndpointError::Place {
                text: self.text.into(),
                kind,
                example,
            });
        }
        Ok(self.place.into())
    }

    fn sim(&self) -> Result<Endpoint, EndpointError> {
        let (mut seed, mut scenario) = (1, DEFAULT_SCENARIO.to_owned());
        for (key, value) in self.pairs() {
            match key {
                "seed" => seed = number(key, value, "a whole number")?,
                "scenario" if !value.is_empty() => value.clone_into(&mut scenario),
                _ => return Err(unknown_key(key, "sim", "seed and scenario")),
            }
        }
        Ok(Endpoint::Sim { seed, scenario })
    }

    fn serial(
        &self,
        kind: &'static str,
        example: &'static str,
    ) -> Result<SerialLine, EndpointError> {
        let mut line = SerialLine {
            port: self.place(kind, example)?,
            baud: DEFAULT_BAUD,
            id: DEFAULT_ID,
            packing: None,
        };
        let known = if kind == "rtu" {
            "baud, id and packing"
        } else {
            "baud and id"
        };
        for (key, value) in self.pairs() {
            match key {
                "packing" if kind == "rtu" => {
                    line.packing = Some(number(key, value, Packing::WANT)?);
                }
                "baud" => {
                    line.baud =
                        in_range(key, value, 300..=4_000_000, "a speed from 300 to 4000000")?
                }
                "id" => line.id = in_range(key, value, 1..=254, "a whole number from 1 to 254")?,
                _ => return Err(unknown_key(key, kind, known)),
            }
        }
        Ok(line)
    }

    fn tcp(&self) -> Result<Endpoint, EndpointError> {
        let place = self.place("tcp", "tcp:192.168.11.210:6000")?;
        let (host, port) = split_host(&place);
        let port = match port {
            Some(port) => in_range("port", port, 1..=65_535, "a whole number from 1 to 65535")?,
            None => DEFAULT_TCP_PORT,
        };
        if host.is_empty() || host.contains(['[', ']']) {
            return Err(EndpointError::Place {
                text: self.text.into(),
                kind: "tcp",
                example: "tcp:192.168.11.210:6000",
            });
        }
        let (mut unit, mut packing) = (DEFAULT_UNIT, None);
        for (key, value) in self.pairs() {
            match key {
                "unit" => unit = number(key, value, "a whole number from 0 to 255")?,
                "packing" => packing = Some(number(key, value, Packing::WANT)?),
                _ => return Err(unknown_key(key, "tcp", "unit and packing")),
            }
        }
        Ok(Endpoint::Tcp {
            host: host.into(),
            port,
            unit,
            packing,
        })
    }

    fn can(&self) -> Result<Endpoint, EndpointError> {
        let interface = self.place("can", "can:can0")?;
        let mut id = u16::from(DEFAULT_ID);
        for (key, value) in self.pairs() {
            match key {
                "id" => {
                    id = in_range(key, value, 1..=CAN_ID_MAX, "a whole number from 1 to 16383")?
                }
                _ => return Err(unknown_key(key, "can", "id")),
            }
        }
        Ok(Endpoint::Can { interface, id })
    }

    fn slcan(&self) -> Result<Endpoint, EndpointError> {
        let port = self.place("slcan", "slcan:/dev/ttyACM0")?;
        let (mut bitrate, mut id) = (DEFAULT_BITRATE, u16::from(DEFAULT_ID));
        for (key, value) in self.pairs() {
            match key {
                "bitrate" => {
                    bitrate = number(key, value, SLCAN_WANT)?;
                    if !SLCAN_BITRATES.contains(&bitrate) {
                        return Err(wrong_value(key, value, SLCAN_WANT));
                    }
                }
                "id" => {
                    id = in_range(key, value, 1..=CAN_ID_MAX, "a whole number from 1 to 16383")?
                }
                _ => return Err(unknown_key(key, "slcan", "bitrate and id")),
            }
        }
        Ok(Endpoint::Slcan { port, bitrate, id })
    }
}

/// Splits `host:port`, `[v6]:port`, `host` and a bare `v6`.
fn split_host(place: &str) -> (&str, Option<&str>) {
    if let Some(rest) = place.strip_prefix('[') {
        let (host, port) = rest.split_once(']').unwrap_or((rest, ""));
        return (host, port.strip_prefix(':'));
    }
    match place.rsplit_once(':') {
        Some((host, port)) if !host.contains(':') => (host, Some(port)),
        _ => (place, None),
    }
}

fn unknown_key(key: &str, kind: &'static str, known: &'static str) -> EndpointError {
    EndpointError::Key {
        key: key.into(),
        kind,
        known,
    }
}

fn number<T: FromStr>(key: &str, value: &str, want: &'static str) -> Result<T, EndpointError> {
    value
        .parse()
        .map_err(|_not_one| wrong_value(key, value, want))
}

fn wrong_value(key: &str, value: &str, want: &'static str) -> EndpointError {
    EndpointError::Value {
        key: key.into(),
        value: value.into(),
        want,
    }
}

fn in_range<T: FromStr + PartialOrd>(
    key: &str,
    value: &str,
    range: std::ops::RangeInclusive<T>,
    want: &'static str,
) -> Result<T, EndpointError> {
    let parsed: T = number(key, value, want)?;
    if range.contains(&parsed) {
        return Ok(parsed);
    }
    Err(wrong_value(key, value, want))
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        reason = "a test may"
    )]
    use super::*;

    #[test]
    fn every_spelling_reads_back_as_itself() {
        for (text, full) in [
            ("sim:", "sim:?seed=1&scenario=idle"),
            ("sim:?seed=7&scenario=grasp", "sim:?seed=7&scenario=grasp"),
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
            ("can:can0?id=16383", "can:can0?id=16383"),
            (
                "slcan:/dev/ttyACM0?bitrate=500000",
                "slcan:/dev/ttyACM0?bitrate=500000&id=1",
            ),
        ] {
            let endpoint: Endpoint = text.parse().unwrap();
            assert_eq!(endpoint.to_string(), full);
            assert_eq!(full.parse::<Endpoint>().unwrap(), endpoint);
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
            ("", "names no kind"),
            ("/dev/ttyUSB0", "names no kind"),
            ("usb:/dev/ttyUSB0", "names no kind"),
            ("rs485:", "lacks what follows"),
            ("rs485:/dev/x?id=0", "1 to 254"),
            ("rs485:/dev/x?id=255", "1 to 254"),
            ("rs485:/dev/x?speed=1", "no setting"),
            ("rs485:/dev/x?baud=fast", "not possible"),
            ("tcp::6000", "lacks what follows"),
            ("tcp:::1]6000", "lacks what follows"),
            ("tcp:host:99999", "1 to 65535"),
            ("tcp:host:0", "1 to 65535"),
            ("tcp:host?unit=256", "0 to 255"),
            ("tcp:host?packing=middle", "low, high or one"),
            ("tcp:host?packing=", "low, high or one"),
            ("rs485:/dev/x?packing=high", "no setting"),
            ("can:can0?id=16384", "16383"),
            ("slcan:/dev/x?bitrate=83333", "800000 or 1000000"),
            ("sim:?seed=-1", "whole number"),
        ] {
            let error = text.parse::<Endpoint>().unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
