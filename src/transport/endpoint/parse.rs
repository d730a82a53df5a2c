//! Parses the text of an endpoint. Opens nothing.

use crate::hand::register::BytePacking;
use crate::transport::endpoint::error::{EndpointError, Want};
use crate::transport::endpoint::{
    DEFAULT_BAUD, DEFAULT_BITRATE, DEFAULT_ID, DEFAULT_SCENARIO, DEFAULT_TCP_PORT, DEFAULT_UNIT,
    Endpoint, OBJECT_SCENARIOS, SCENARIOS, SerialLine,
};
use std::str::FromStr;

/// CAN bit rates that serial adapters have a code for (Lawicel `S0` to `S8`).
const SLCAN_BITRATES: [u32; 9] = [
    10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000,
];
/// The same in words.
const SLCAN_WANT: Want =
    Want::OneOf("10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000 or 1000000");
/// [`SCENARIOS`] in words.
const SCENARIO_WANT: Want =
    Want::OneOf("idle, free, rigid, fragile, grasp, touched, faults, extremes or frozen");
/// Permitted values of `body`.
const BODY_WANT: Want =
    Want::OneOf("the file of a body; 'handscope sim --print-body' writes one to start from");
/// Permitted values of `object`, and of `scenario` beside it.
const OBJECT_WANT: Want = Want::OneOf(
    "cup, egg, sponge, block, tube, can or the file of an object; 'handscope sim --print-object cup' writes one to start from",
);
const OBJECT_SCENARIO_WANT: Want =
    Want::OneOf("idle, free, rigid, fragile or grasp where an object is given");
/// Largest id on a CAN bus (manual 2.3).
const CAN_ID_MAX: u16 = 16_383;

impl FromStr for Endpoint {
    type Err = EndpointError;

    fn from_str(text: &str) -> Result<Self, EndpointError> {
        let unknown = || EndpointError::Kind { text: text.into() };
        let (kind, rest) = text.trim().split_once(':').ok_or_else(unknown)?;
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        let keys = EndpointText {
            text,
            place,
            pairs: query,
        };
        keys.are_single()?;
        match kind {
            "sim" => keys.sim(),
            "rs485" => Ok(Endpoint::Rs485(keys.serial("rs485", "rs485:/dev/ttyUSB0")?)),
            "rtu" => Ok(Endpoint::Rtu(keys.serial("rtu", "rtu:/dev/ttyUSB0")?)),
            "rtu+tcp" => keys.rtu_tcp(),
            "tcp" => keys.tcp(),
            "can" => keys.can(),
            "slcan" => keys.slcan(),
            "usbcan" => keys.usbcan(),
            _ => Err(unknown()),
        }
    }
}

/// The parts of an endpoint's text.
struct EndpointText<'a> {
    text: &'a str,
    place: &'a str,
    pairs: &'a str,
}

impl EndpointText<'_> {
    fn pairs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.pairs
            .split('&')
            .filter(|pair| !pair.is_empty())
            .map(|pair| pair.split_once('=').unwrap_or((pair, "")))
    }

    /// Rejects duplicate keys.
    fn are_single(&self) -> Result<(), EndpointError> {
        let earlier = |nth: usize, key: &str| self.pairs().take(nth).any(|(own, _)| own == key);
        let mut all = self.pairs().enumerate();
        match all.find(|(nth, (key, _))| earlier(*nth, key)) {
            Some((_, (key, _))) => Err(EndpointError::Twice { key: key.into() }),
            None => Ok(()),
        }
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
        if !self.place.is_empty() {
            return Err(unknown_key(
                self.place,
                "sim",
                "seed, scenario, body and object, after a '?'",
            ));
        }
        let (mut seed, mut scenario) = (1, DEFAULT_SCENARIO.to_owned());
        let (mut body, mut object) = (None, None);
        for (key, value) in self.pairs() {
            match key {
                "seed" => seed = number(key, value, Want::Whole)?,
                "scenario" if SCENARIOS.contains(&value) => value.clone_into(&mut scenario),
                "scenario" => return Err(wrong_value(key, value, SCENARIO_WANT)),
                "body" if !value.is_empty() => body = Some(value.to_owned()),
                "body" => return Err(wrong_value(key, value, BODY_WANT)),
                "object" if !value.is_empty() => object = Some(value.to_owned()),
                "object" => return Err(wrong_value(key, value, OBJECT_WANT)),
                _ => return Err(unknown_key(key, "sim", "seed, scenario, body and object")),
            }
        }
        if object.is_some() && !OBJECT_SCENARIOS.contains(&scenario.as_str()) {
            return Err(wrong_value("scenario", &scenario, OBJECT_SCENARIO_WANT));
        }
        Ok(Endpoint::Sim {
            seed,
            scenario,
            body,
            object,
        })
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
        let has_words = kind != "rs485";
        let known = if has_words {
            "baud, id and packing"
        } else {
            "baud and id"
        };
        for (key, value) in self.pairs() {
            match key {
                "packing" if has_words => {
                    line.packing = Some(chosen_packing(key, value)?);
                }
                "baud" => line.baud = serial_speed(key, value)?,
                "id" => line.id = in_range(key, value, 1..=254, Want::Between(1, 254))?,
                _ => return Err(unknown_key(key, kind, known)),
            }
        }
        Ok(line)
    }

    /// Serial device servers have no default port, so it is required.
    fn rtu_tcp(&self) -> Result<Endpoint, EndpointError> {
        let (kind, example) = ("rtu+tcp", "rtu+tcp:192.168.11.7:4001");
        let mut line = self.serial(kind, example)?;
        let (host, Some(port)) = split_host(&line.port) else {
            return Err(self.incomplete(kind, example));
        };
        if host.is_empty() || host.contains(['[', ']']) {
            return Err(self.incomplete(kind, example));
        }
        let port: u16 = in_range("port", port, 1..=65_535, Want::Between(1, 65_535))?;
        line.port = if host.contains(':') {
            format!("[{host}]:{port}")
        } else {
            format!("{host}:{port}")
        };
        Ok(Endpoint::RtuTcp(line))
    }

    fn incomplete(&self, kind: &'static str, example: &'static str) -> EndpointError {
        let text = self.text.into();
        EndpointError::Place {
            text,
            kind,
            example,
        }
    }

    fn tcp(&self) -> Result<Endpoint, EndpointError> {
        let place = self.place("tcp", "tcp:192.168.11.210:6000")?;
        let (host, port) = split_host(&place);
        let port = match port {
            Some(port) => in_range("port", port, 1..=65_535, Want::Between(1, 65_535))?,
            None => DEFAULT_TCP_PORT,
        };
        if host.is_empty() || host.contains(['[', ']']) {
            return Err(self.incomplete("tcp", "tcp:192.168.11.210:6000"));
        }
        let (mut unit, mut packing) = (DEFAULT_UNIT, None);
        for (key, value) in self.pairs() {
            match key {
                "unit" => unit = number(key, value, Want::Between(0, 255))?,
                "packing" => packing = Some(chosen_packing(key, value)?),
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
                "id" => id = can_id(key, value)?,
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
                "id" => id = can_id(key, value)?,
                _ => return Err(unknown_key(key, "slcan", "bitrate and id")),
            }
        }
        Ok(Endpoint::Slcan { port, bitrate, id })
    }

    fn usbcan(&self) -> Result<Endpoint, EndpointError> {
        let port = self.place("usbcan", "usbcan:/dev/ttyUSB0")?;
        let (mut baud, mut id) = (DEFAULT_BAUD, u16::from(DEFAULT_ID));
        for (key, value) in self.pairs() {
            match key {
                "baud" => baud = serial_speed(key, value)?,
                "id" => id = can_id(key, value)?,
                _ => return Err(unknown_key(key, "usbcan", "baud and id")),
            }
        }
        Ok(Endpoint::UsbCan { port, baud, id })
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

fn number<T: FromStr>(key: &str, value: &str, want: Want) -> Result<T, EndpointError> {
    value
        .parse()
        .map_err(|_not_one| wrong_value(key, value, want))
}

fn wrong_value(key: &str, value: &str, want: Want) -> EndpointError {
    EndpointError::Value {
        key: key.into(),
        value: value.into(),
        want,
    }
}

fn serial_speed(key: &str, value: &str) -> Result<u32, EndpointError> {
    in_range(key, value, 300..=4_000_000, Want::Speed(300, 4_000_000))
}

fn chosen_packing(key: &str, value: &str) -> Result<BytePacking, EndpointError> {
    let want = Want::OneOf("low, high or one");
    BytePacking::by_key(value).ok_or_else(|| wrong_value(key, value, want))
}

fn can_id(key: &str, value: &str) -> Result<u16, EndpointError> {
    in_range(
        key,
        value,
        1..=CAN_ID_MAX,
        Want::Between(1, CAN_ID_MAX.into()),
    )
}

fn in_range<T: FromStr + PartialOrd>(
    key: &str,
    value: &str,
    range: std::ops::RangeInclusive<T>,
    want: Want,
) -> Result<T, EndpointError> {
    let parsed: T = number(key, value, want)?;
    if range.contains(&parsed) {
        return Ok(parsed);
    }
    Err(wrong_value(key, value, want))
}
