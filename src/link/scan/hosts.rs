//! Addresses to scan, as typed by the user: one host, or a range. Resolves no name, connects to nothing.

use crate::transport::endpoint::{DEFAULT_TCP_PORT, Endpoint, EndpointError};
use std::net::Ipv4Addr;
use std::str::FromStr;

/// Maximum hosts of one range: a /22. More would take minutes, and would hardly be one robot's network.
pub const HOSTS_MAX: usize = 1024;
/// The widest range, in leading bits.
const PREFIX_MIN: u32 = 22;

/// One host or a range of them, on one port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hosts {
    names: Vec<String>,
    port: u16,
    is_range: bool,
}

/// Reason why a text is not a valid host or range.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum HostsError {
    /// Not a host.
    #[error(
        "'{text}' is not a host: write an address such as 192.168.11.210, with :PORT if it is not 6000"
    )]
    Host {
        /// Text that was typed.
        text: String,
    },
    /// Not a port.
    #[error("'{port}' is not a port: write a number from 1 to 65535")]
    Port {
        /// Text that was typed.
        port: String,
    },
    /// Not a range.
    #[error("'{text}' is not an address range: write one such as 192.168.11.0/24")]
    Range {
        /// Text that was typed.
        text: String,
    },
    /// A range that is too wide.
    #[error(
        "a range of /{prefix} has more than {HOSTS_MAX} addresses: name one of /{PREFIX_MIN} to /32"
    )]
    TooWide {
        /// Length of the network prefix in bits.
        prefix: u32,
    },
    /// An address that no hand can have.
    #[error("no hand can have the address {address}: name the address of the hand")]
    Impossible {
        /// The address.
        address: Ipv4Addr,
    },
}

impl Hosts {
    /// Each host by name or address, without brackets.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Number of hosts.
    pub const fn count(&self) -> usize {
        self.names.len()
    }

    /// The TCP port.
    pub const fn port(&self) -> u16 {
        self.port
    }

    /// True if a range was typed: most of its addresses are expected to be unused.
    pub const fn is_range(&self) -> bool {
        self.is_range
    }
}

impl FromStr for Hosts {
    type Err = HostsError;

    fn from_str(text: &str) -> Result<Self, HostsError> {
        let text = text.trim();
        match text.split_once('/') {
            Some((first, rest)) => range(text, first, rest),
            None => one(text),
        }
    }
}

fn one(text: &str) -> Result<Hosts, HostsError> {
    let wrong = || HostsError::Host { text: text.into() };
    if text.contains(|sign: char| sign.is_whitespace() || "?&,;@".contains(sign)) {
        return Err(wrong());
    }
    let endpoint: Endpoint = format!("tcp:{text}").parse().map_err(|error| match error {
        EndpointError::Value { value, .. } => HostsError::Port { port: value },
        _ => wrong(),
    })?;
    let Endpoint::Tcp { host, port, .. } = endpoint else {
        return Err(wrong());
    };
    if let Ok(address) = host.parse() {
        refuse_impossible(address)?;
    }
    Ok(Hosts {
        names: vec![host],
        port,
        is_range: false,
    })
}

fn range(text: &str, first: &str, rest: &str) -> Result<Hosts, HostsError> {
    let wrong = || HostsError::Range { text: text.into() };
    let address: Ipv4Addr = first.parse().map_err(|_not_one| wrong())?;
    let (prefix, port) = rest.split_once(':').unwrap_or((rest, ""));
    let prefix: u32 = prefix.parse().map_err(|_not_one| wrong())?;
    let port = match port {
        "" if rest.ends_with(':') => {
            return Err(HostsError::Port {
                port: String::new(),
            });
        }
        "" => DEFAULT_TCP_PORT,
        port => match port.parse() {
            Ok(number @ 1..) => number,
            _ => return Err(HostsError::Port { port: port.into() }),
        },
    };
    if prefix > 32 {
        return Err(wrong());
    }
    if prefix < PREFIX_MIN {
        return Err(HostsError::TooWide { prefix });
    }
    refuse_impossible(address)?;
    let size = 1_u32 << (32 - prefix);
    let base = address.to_bits() & !(size - 1);
    // The first and the last address of a network belong to no host, but for the smallest two (RFC 3021).
    let edge = u32::from(size > 2);
    let names = (base + edge..=base + (size - 1) - edge)
        .map(|bits| Ipv4Addr::from_bits(bits).to_string())
        .collect();
    Ok(Hosts {
        names,
        port,
        is_range: true,
    })
}

fn refuse_impossible(address: Ipv4Addr) -> Result<(), HostsError> {
    if address.is_unspecified() || address.is_multicast() || address.is_broadcast() {
        return Err(HostsError::Impossible { address });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_or_a_range_with_or_without_port() {
        for (text, port, names) in [
            ("192.168.11.210", 6000, &["192.168.11.210"][..]),
            (" hand.local:6001 ", 6001, &["hand.local"]),
            ("[::1]:7", 7, &["::1"]),
            ("::1", 6000, &["::1"]),
            ("127.0.0.0/30", 6000, &["127.0.0.1", "127.0.0.2"]),
            ("127.0.0.3/30:6001", 6001, &["127.0.0.1", "127.0.0.2"]),
            ("127.0.0.1/32", 6000, &["127.0.0.1"]),
            ("127.0.0.4/31:9", 9, &["127.0.0.4", "127.0.0.5"]),
        ] {
            let hosts: Hosts = text.parse().unwrap();
            assert_eq!(hosts.port(), port, "{text}");
            assert_eq!(hosts.iter().collect::<Vec<_>>(), names, "{text}");
            assert_eq!(hosts.is_range(), text.contains('/'), "{text}");
        }
    }

    #[test]
    fn the_widest_range_stays_within_the_limit() {
        let hosts: Hosts = "10.1.7.9/22".parse().unwrap();
        assert_eq!(hosts.count(), HOSTS_MAX - 2);
        assert_eq!(hosts.iter().next(), Some("10.1.4.1"));
        assert_eq!(hosts.iter().last(), Some("10.1.7.254"));
        let last: Hosts = "239.255.255.255/32"
            .parse::<Hosts>()
            .unwrap_or_else(|_| hosts.clone());
        assert_eq!(last, hosts, "multicast is refused");
    }

    #[test]
    fn what_names_no_host_says_what_is_right() {
        for (text, words) in [
            ("", "is not a host"),
            (":6000", "is not a host"),
            ("a b", "is not a host"),
            ("host?unit=1", "is not a host"),
            ("1.2.3.4,1.2.3.5", "is not a host"),
            ("host:0", "'0' is not a port"),
            ("host:99999", "'99999' is not a port"),
            ("127.0.0.0/29:", "is not a port"),
            ("127.0.0.0/29:x", "'x' is not a port"),
            ("127.0.0.0/33", "is not an address range"),
            ("127.0.0/24", "is not an address range"),
            ("127.0.0.0/a", "is not an address range"),
            ("fe80::/64", "is not an address range"),
            ("127.0.0.0/21", "more than 1024"),
            ("0.0.0.0/0", "more than 1024"),
            ("0.0.0.0", "no hand can have"),
            ("255.255.255.255", "no hand can have"),
            ("224.0.0.0/24", "no hand can have"),
        ] {
            let error = text.parse::<Hosts>().unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
