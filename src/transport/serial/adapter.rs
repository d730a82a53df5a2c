//! Identifies a USB serial adapter by what is unchanged when it is plugged in again: its serial number, else its place.
//! Lists and opens nothing.

use crate::transport::found::{PortFound, UsbFound};
use std::path::{Path, PathBuf};

/// Identity of an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter(UsbFound);

/// Present place of an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Whereabouts {
    /// At this port, unambiguously.
    At(String),
    /// Adapters of its kind at each of these ports, indistinguishable.
    Alike(Vec<String>),
    /// Not plugged in.
    Gone,
}

impl Adapter {
    /// The adapter at this port; `None` if the port is not on USB or not listed.
    pub fn at(port: &str, ports: &[PortFound]) -> Option<Self> {
        let real = real(port);
        let found = ports.iter().find(|found| Path::new(&found.path) == real)?;
        found.usb.clone().map(Self)
    }

    /// Finds the adapter among the present ports: by serial number wherever it is plugged in; without one only in the
    /// same USB port, because another of its kind would look the same elsewhere.
    pub fn find(&self, ports: &[PortFound]) -> Whereabouts {
        let Self(mine) = self;
        let alike = ports_where(ports, |usb| {
            (usb.vendor_id, usb.product_id, &usb.serial)
                == (mine.vendor_id, mine.product_id, &mine.serial)
        });
        let here = only(&alike, |usb| {
            usb.location.is_some() && usb.location == mine.location
        });
        let by_serial = match alike.as_slice() {
            [(path, _)] if mine.serial.is_some() => Some(*path),
            // An adapter with several ports has one serial number; the interface distinguishes them.
            _ if mine.serial.is_some() => only(&alike, |usb| {
                interface(usb).is_some() && interface(usb) == interface(mine)
            }),
            _ => None,
        };
        match here.or(by_serial) {
            Some(path) => Whereabouts::At(path.to_owned()),
            None if alike.is_empty() => Whereabouts::Gone,
            None => Whereabouts::Alike(alike.iter().map(|(path, _)| (*path).to_owned()).collect()),
        }
    }
}

/// True if a port's name refers to the device at `path`: names under `/dev/serial/by-id` are links.
pub fn is_same_port(port: &str, path: &str) -> bool {
    port == path || real(port) == real(path)
}

fn real(port: &str) -> PathBuf {
    std::fs::canonicalize(port).unwrap_or_else(|_not_there| PathBuf::from(port))
}

type Alike<'a> = Vec<(&'a str, &'a UsbFound)>;

fn ports_where(ports: &[PortFound], fits: impl Fn(&UsbFound) -> bool) -> Alike<'_> {
    ports
        .iter()
        .filter_map(|port| Some((port.path.as_str(), port.usb.as_ref()?)))
        .filter(|(_, usb)| fits(usb))
        .collect()
}

/// The only one that fits; `None` if several do.
fn only<'a>(alike: &Alike<'a>, fits: impl Fn(&UsbFound) -> bool) -> Option<&'a str> {
    let mut fitting = alike.iter().filter(|(_, usb)| fits(usb));
    let (path, _) = fitting.next()?;
    fitting.next().is_none().then_some(*path)
}

fn interface(usb: &UsbFound) -> Option<&str> {
    let location = usb.location.as_deref()?;
    location.split_once(':').map(|(_, interface)| interface)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(path: &str, serial: Option<&str>, location: Option<&str>) -> PortFound {
        let usb = UsbFound {
            vendor_id: 0x0403,
            product_id: 0x6001,
            serial: serial.map(str::to_owned),
            location: location.map(str::to_owned),
            ..UsbFound::default()
        };
        PortFound {
            path: path.into(),
            usb: Some(usb),
        }
    }

    fn check(mine: &PortFound, now: &[PortFound], wanted: &Whereabouts) {
        let adapter = Adapter::at(&mine.path, std::slice::from_ref(mine)).unwrap();
        assert_eq!(adapter.find(now), *wanted);
    }

    #[test]
    fn a_serial_number_is_followed_anywhere() {
        let mine = port("/dev/ttyT0", Some("A5"), Some("1-2:1.0"));
        let other = port("/dev/ttyT0", Some("B6"), Some("1-2:1.0"));
        let there = port("/dev/ttyT1", Some("A5"), Some("3-4:1.0"));
        let at = |path: &str| Whereabouts::At(path.into());
        check(&mine, &[other.clone(), there], &at("/dev/ttyT1"));
        check(&mine, std::slice::from_ref(&mine), &at("/dev/ttyT0"));
        check(&mine, &[other], &Whereabouts::Gone);
        check(&mine, &[], &Whereabouts::Gone);
    }

    #[test]
    fn without_a_serial_number_only_the_same_usb_port_counts() {
        let mine = port("/dev/ttyT0", None, Some("1-2:1.0"));
        let same = port("/dev/ttyT1", None, Some("1-2:1.0"));
        let elsewhere = port("/dev/ttyT2", None, Some("1-3:1.0"));
        let at = Whereabouts::At("/dev/ttyT1".into());
        check(&mine, &[same, elsewhere.clone()], &at);
        let alike = Whereabouts::Alike(vec!["/dev/ttyT2".into()]);
        check(&mine, &[elsewhere], &alike);
        let numbered = port("/dev/ttyT3", Some("A5"), Some("1-2:1.0"));
        check(&mine, &[numbered], &Whereabouts::Gone);
    }

    #[test]
    fn one_number_on_several_ports_is_told_apart_by_interface_then_asked() {
        let mine = port("/dev/ttyT1", Some("A5"), Some("1-2:1.1"));
        let moved = [
            port("/dev/ttyT4", Some("A5"), Some("1-3:1.0")),
            port("/dev/ttyT5", Some("A5"), Some("1-3:1.1")),
        ];
        check(&mine, &moved, &Whereabouts::At("/dev/ttyT5".into()));
        // Two adapters whose maker gave both the same number.
        let twins = [
            port("/dev/ttyT6", Some("A5"), Some("1-4:1.1")),
            port("/dev/ttyT7", Some("A5"), Some("1-5:1.1")),
        ];
        let both = vec!["/dev/ttyT6".into(), "/dev/ttyT7".into()];
        check(&mine, &twins, &Whereabouts::Alike(both));
    }

    #[test]
    fn ports_that_are_not_on_usb_are_no_adapters() {
        let plain = PortFound {
            path: "/dev/ttyS0".into(),
            usb: None,
        };
        assert_eq!(Adapter::at("/dev/ttyS0", &[plain]), None);
        assert_eq!(Adapter::at("/dev/ttyT0", &[]), None);
    }
}
