//! Recognises an address as typed by the user, with or without the kind of link before it. Opens and sends nothing.

use crate::transport::endpoint::{Endpoint, EndpointError};
use crate::transport::found::PortFound;
use std::net::Ipv4Addr;

/// The parts before the colon of an endpoint.
const KINDS: [&str; 8] = [
    "sim", "rs485", "rtu", "rtu+tcp", "tcp", "can", "slcan", "usbcan",
];

/// Reason why a typed text is not a valid address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TypedError {
    /// Digits and dots that are not an address.
    #[error(
        "'{text}' is not an IP address: write four numbers from 0 to 255, such as 192.168.11.210"
    )]
    Ip {
        /// The typed text.
        text: String,
    },
    /// Neither a host nor a port nor an interface.
    #[error(
        "'{text}' is not an address: type for example 192.168.11.210, /dev/ttyUSB0, COM3 or can0"
    )]
    Unknown {
        /// The typed text.
        text: String,
    },
    /// The kind of link is known but the rest is wrong.
    #[error(transparent)]
    Endpoint(#[from] EndpointError),
}

/// Returns the most likely endpoint of a typed text; `ports` are those that the system lists.
///
/// ```
/// use handscope_core::transport::endpoint::typed::recognise;
///
/// let hand = recognise("192.168.11.210", &[])?;
/// assert_eq!(hand.to_string(), "tcp:192.168.11.210:6000?unit=255");
/// # Ok::<(), handscope_core::transport::endpoint::typed::TypedError>(())
/// ```
///
/// # Errors
/// [`TypedError`] describes what is wrong, with a valid example.
pub fn recognise(typed: &str, ports: &[PortFound]) -> Result<Endpoint, TypedError> {
    Ok(spell(typed, ports)?.parse()?)
}

/// The same in the spelling of endpoints; the part after the kind of link may still be invalid.
///
/// # Errors
/// [`TypedError::Ip`] or [`TypedError::Unknown`].
pub fn spell(typed: &str, ports: &[PortFound]) -> Result<String, TypedError> {
    let text = typed.trim();
    if let Some((kind, rest)) = text.split_once(':') {
        let kind = kind.to_lowercase();
        if KINDS.contains(&kind.as_str()) {
            return Ok(format!("{kind}:{rest}"));
        }
    }
    if text == "sim" {
        return Ok("sim:".into());
    }
    if let Some(port) = serial_port(text, ports) {
        let path = path_of(&port);
        let mut listed = ports.iter().filter(|listed| listed.path == path);
        let usb = listed.find_map(|listed| listed.usb.as_ref());
        let kind = match usb {
            Some(usb) if usb.looks_like_can() => "slcan",
            _ => "rs485",
        };
        return Ok(format!("{kind}:{port}"));
    }
    if is_interface(text) {
        return Ok(format!("can:{text}"));
    }
    host(text)
}

/// The alternative kind of link of a serial port: the protocol of a hand is not visible from outside.
pub fn other_kind(endpoint: &Endpoint) -> Option<&'static str> {
    match endpoint {
        Endpoint::Rs485(_) => Some("rtu"),
        Endpoint::Rtu(_) | Endpoint::Slcan { .. } | Endpoint::UsbCan { .. } => Some("rs485"),
        Endpoint::Sim { .. }
        | Endpoint::Tcp { .. }
        | Endpoint::RtuTcp(_)
        | Endpoint::Can { .. } => None,
    }
}

/// The shortest text that is recognised as this endpoint.
pub fn shortest(endpoint: &Endpoint, ports: &[PortFound]) -> String {
    let of_kind = match endpoint {
        Endpoint::Sim { .. } => "sim:".to_owned(),
        _ => format!("{}:{}", endpoint.kind(), endpoint.place()),
    };
    let means = |text: &String| recognise(text, ports).as_ref() == Ok(endpoint);
    let short = [endpoint.place(), of_kind].into_iter().find(means);
    short.unwrap_or_else(|| endpoint.to_string())
}

/// The part before the settings.
fn path_of(text: &str) -> &str {
    text.split_once('?').map_or(text, |(path, _)| path)
}

/// The serial port that the text means, with its folder, if any.
fn serial_port(text: &str, ports: &[PortFound]) -> Option<String> {
    let place = path_of(text);
    let is_com = place
        .split_at_checked(3)
        .is_some_and(|(com, number)| com.eq_ignore_ascii_case("com") && is_number(number));
    let is_listed = ports.iter().any(|port| port.path == place);
    let is_path = place.len() > 1 && place.starts_with('/') || place.starts_with(r"\\.\");
    if is_com || is_listed || is_path {
        return Some(text.into());
    }
    let is_device = place.starts_with("tty") || place.starts_with("cu.");
    is_device.then(|| format!("/dev/{text}"))
}

/// True for names that CAN interfaces have.
fn is_interface(text: &str) -> bool {
    let place = path_of(text);
    let mut names = ["can", "vcan", "slcan"].into_iter();
    names.any(|name| place.strip_prefix(name).is_some_and(is_number))
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit())
}

fn host(text: &str) -> Result<String, TypedError> {
    let place = path_of(text);
    let may_stand = |sign: char| sign.is_alphanumeric() || ".-_:[]%".contains(sign);
    if place.is_empty() || !place.chars().all(may_stand) {
        return Err(TypedError::Unknown { text: text.into() });
    }
    let (host, _) = place.split_once(':').unwrap_or((place, ""));
    let is_plain = |sign: char| sign.is_ascii_digit() || sign == '.';
    if !host.is_empty() && host.chars().all(is_plain) && host.parse::<Ipv4Addr>().is_err() {
        return Err(TypedError::Ip { text: host.into() });
    }
    Ok(format!("tcp:{text}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::found::UsbFound;

    fn canable(path: &str) -> PortFound {
        let usb = UsbFound {
            product: Some("CANable".into()),
            ..UsbFound::default()
        };
        PortFound {
            path: path.into(),
            usb: Some(usb),
        }
    }

    #[test]
    fn every_kind_of_address_is_recognised() {
        for (typed, full) in [
            ("192.168.11.210", "tcp:192.168.11.210:6000?unit=255"),
            (" 127.0.0.1:7601 ", "tcp:127.0.0.1:7601?unit=255"),
            ("10.0.0.7?unit=3", "tcp:10.0.0.7:6000?unit=3"),
            ("hand.local", "tcp:hand.local:6000?unit=255"),
            ("localhost:6001", "tcp:localhost:6001?unit=255"),
            ("[::1]:6001", "tcp:[::1]:6001?unit=255"),
            ("::1", "tcp:[::1]:6000?unit=255"),
            ("/dev/ttyUSB0", "rs485:/dev/ttyUSB0?baud=115200&id=1"),
            ("ttyUSB0", "rs485:/dev/ttyUSB0?baud=115200&id=1"),
            ("/dev/ttyUSB0?id=4", "rs485:/dev/ttyUSB0?baud=115200&id=4"),
            ("COM3", "rs485:COM3?baud=115200&id=1"),
            (r"\\.\COM12", r"rs485:\\.\COM12?baud=115200&id=1"),
            ("com12", "rs485:com12?baud=115200&id=1"),
            ("/dev/ttyACM7", "slcan:/dev/ttyACM7?bitrate=1000000&id=1"),
            ("can0", "can:can0?id=1"),
            ("vcan1?id=9", "can:vcan1?id=9"),
            ("sim", "sim:?seed=1&scenario=idle"),
            ("sim:?scenario=grasp", "sim:?seed=1&scenario=grasp"),
            ("RTU:/dev/ttyUSB0", "rtu:/dev/ttyUSB0?baud=115200&id=1"),
            ("tcp:10.0.0.1", "tcp:10.0.0.1:6000?unit=255"),
            ("RTU+TCP:box:4001", "rtu+tcp:box:4001?baud=115200&id=1"),
            ("can:can0", "can:can0?id=1"),
            ("slcan:COM5", "slcan:COM5?bitrate=1000000&id=1"),
            ("usbcan:COM5", "usbcan:COM5?baud=115200&id=1"),
        ] {
            let endpoint = recognise(typed, &[canable("/dev/ttyACM7")]);
            assert_eq!(endpoint.unwrap().to_string(), full, "{typed}");
        }
    }

    #[test]
    fn a_wrong_text_says_what_is_wrong_with_a_right_one() {
        for (typed, words) in [
            ("", "'' is not an address: type for example 192.168.11.210"),
            ("usb:/dev/ttyUSB0", "is not an address"),
            ("http://10.0.0.1", "is not an address"),
            ("a hand", "is not an address"),
            (
                "192.168.11",
                "'192.168.11' is not an IP address: write four numbers",
            ),
            (
                "192.168.11.999:6000",
                "'192.168.11.999' is not an IP address",
            ),
            ("10.0.0.1:99999", "1 to 65535"),
            ("rs485:", "is incomplete"),
            ("rs485:/dev/x?id=0", "1 to 254"),
            ("can0?id=99999", "16383"),
        ] {
            let error = recognise(typed, &[]).unwrap_err().to_string();
            assert!(error.contains(words), "{typed}: {error}");
        }
    }

    #[test]
    fn the_shortest_text_means_the_same_endpoint() {
        for (full, short) in [
            ("tcp:10.0.0.7:6000?unit=255", "10.0.0.7:6000"),
            ("tcp:10.0.0.7:6000?unit=3", "tcp:10.0.0.7:6000?unit=3"),
            ("rs485:/dev/ttyUSB0?baud=115200&id=1", "/dev/ttyUSB0"),
            ("rtu:/dev/ttyUSB0?baud=115200&id=1", "rtu:/dev/ttyUSB0"),
            ("can:can0?id=1", "can0"),
            ("sim:?seed=1&scenario=idle", "sim:"),
            ("sim:?seed=1&scenario=free", "sim:?seed=1&scenario=free"),
        ] {
            let endpoint: Endpoint = full.parse().unwrap();
            assert_eq!(shortest(&endpoint, &[]), short);
            assert_eq!(recognise(short, &[]).unwrap(), endpoint);
        }
    }
}
