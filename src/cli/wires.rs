//! Wires on which a hand is served to other programs: the command line, and a server per wire.

use crate::cli::listen;
use crate::cli::parse::number;
use crate::sim::SimHands;
use crate::sim::serve::modbus_tcp;
#[cfg(unix)]
use crate::sim::serve::pty;
use crate::transport::LinePace;
#[cfg(unix)]
use crate::transport::TransportError;
use anyhow::{Context as _, anyhow, ensure};
#[cfg(unix)]
use futures::FutureExt;
use futures::future::{BoxFuture, select_all};
use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::net::TcpListener;

/// The wires of a hand; at least one.
#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("wire").required(true).multiple(true).args(["tcp", "rs485", "rtu", "slcan", "usbcan", "can"]))]
pub(crate) struct WireArgs {
    /// Serve Modbus TCP here, for example 127.0.0.1:6000
    #[arg(long, value_name = "ADDR:PORT", value_parser = listen::address)]
    tcp: Option<SocketAddr>,
    /// Create a pseudo-terminal linked here, and serve RS485 in the maker's framing on it
    #[arg(long, value_name = "LINK")]
    rs485: Option<PathBuf>,
    /// Create a pseudo-terminal linked here, and serve Modbus RTU on it
    #[arg(long, value_name = "LINK")]
    rtu: Option<PathBuf>,
    /// Give --rs485 and --rtu the timing of a line at this speed; a client at another speed receives noise
    /// [default: no delay, and any speed]
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(1200..=4_000_000))]
    baud: Option<u32>,
    /// With --baud: milliseconds from the end of a request to the reply
    #[arg(long = "turnaround-ms", value_name = "MS", default_value = "6", requires = "baud", value_parser = turnaround)]
    turnaround: Duration,
    /// Create a pseudo-terminal linked here that acts as a serial CAN adapter (slcan) with the hand on its bus
    #[arg(long, value_name = "LINK")]
    slcan: Option<PathBuf>,
    /// Make a pseudo-terminal and link it here; be the maker's own USB-CAN adapter with the hand on its bus
    #[arg(long, value_name = "LINK")]
    usbcan: Option<PathBuf>,
    /// Answer on this CAN interface, for example vcan0 (Linux)
    #[arg(long, value_name = "INTERFACE")]
    can: Option<String>,
}

/// A wire being served.
pub(crate) struct ServedWire {
    /// Kind and place, as announced.
    name: String,
    /// Resolves only on failure.
    served: BoxFuture<'static, anyhow::Error>,
}

impl ServedWire {
    /// Line that reports readiness.
    pub(crate) fn ready(&self) -> String {
        format!("ready {}", self.name)
    }

    /// `closed` is the error text of a server that ends without an error.
    fn new(
        kind: &str,
        place: String,
        closed: String,
        served: impl Future<Output = io::Result<()>> + Send + 'static,
    ) -> Self {
        Self {
            name: format!("{kind} {place}"),
            served: Box::pin(async move {
                match served.await {
                    Ok(()) => anyhow!(closed),
                    Err(error) => anyhow!("the server on {place} failed: {error}"),
                }
            }),
        }
    }
}

/// Protocol on a pseudo-terminal.
#[derive(Clone, Copy)]
enum PtyProtocol {
    Rs485,
    Rtu,
    Slcan,
    UsbCan,
}

/// Resolves when a server fails.
pub(crate) async fn failed(wires: Vec<ServedWire>) -> anyhow::Error {
    select_all(wires.into_iter().map(|wire| wire.served))
        .await
        .0
}

impl WireArgs {
    /// Serves the hands on all wires.
    pub(crate) async fn serve(&self, hands: &SimHands) -> anyhow::Result<Vec<ServedWire>> {
        let mut wires = Vec::new();
        if let Some(address) = self.tcp {
            wires.push(serve_tcp(hands, address).await?);
        }
        let pace = self.baud.map(|baud| LinePace {
            baud,
            turnaround: self.turnaround,
        });
        for (protocol, link) in [
            (PtyProtocol::Rs485, &self.rs485),
            (PtyProtocol::Rtu, &self.rtu),
            (PtyProtocol::Slcan, &self.slcan),
            (PtyProtocol::UsbCan, &self.usbcan),
        ] {
            if let Some(link) = link {
                wires.push(serve_link(hands, protocol, link, pace)?);
            }
        }
        if let Some(interface) = &self.can {
            wires.push(serve_can(hands, interface)?);
        }
        ensure!(!wires.is_empty(), "no wire to serve the hand on");
        Ok(wires)
    }
}

async fn serve_tcp(hands: &SimHands, address: SocketAddr) -> anyhow::Result<ServedWire> {
    let listener = TcpListener::bind(address)
        .await
        .map_err(|error| listen::refused(address, &error))?;
    let bound = listener
        .local_addr()
        .context("cannot read back the address that is served")?;
    listen::warn_if_reachable(bound, "move the simulated hand");
    let closed = format!("the server on {bound} ended");
    let served = modbus_tcp::serve(hands.clone(), listener);
    Ok(ServedWire::new("tcp", bound.to_string(), closed, served))
}

#[cfg(unix)]
fn serve_link(
    hands: &SimHands,
    protocol: PtyProtocol,
    link: &Path,
    pace: Option<LinePace>,
) -> anyhow::Result<ServedWire> {
    let hands = hands.clone();
    let (kind, served) = match protocol {
        PtyProtocol::Rs485 => ("rs485", pty::serve_rs485(hands, link, pace).map(endless)),
        PtyProtocol::Rtu => ("rtu", pty::serve_rtu(hands, link, pace).map(endless)),
        PtyProtocol::Slcan => ("slcan", pty::serve_slcan(hands, link).map(endless)),
        PtyProtocol::UsbCan => ("usbcan", pty::serve_usbcan(hands, link).map(endless)),
    };
    let served = served.map_err(|error| link_words(link, &error))?;
    let place = link.display().to_string();
    let closed = format!("the pseudo-terminal behind {place} was closed");
    Ok(ServedWire::new(kind, place, closed, served))
}

/// A server that fails only by ending.
#[cfg(unix)]
fn endless(
    served: impl Future<Output = ()> + Send + 'static,
) -> BoxFuture<'static, io::Result<()>> {
    served.map(Ok).boxed()
}

#[cfg(unix)]
fn link_words(link: &Path, error: &TransportError) -> anyhow::Error {
    let why = match error {
        TransportError::NotAPort { .. } => {
            "a file that is not a link is in the way; choose another path".into()
        }
        TransportError::Missing { .. } => "its folder does not exist; create it first".into(),
        TransportError::Permission { .. } => {
            "you may not write to its folder; choose another".into()
        }
        other => other.to_string(),
    };
    anyhow!("cannot create the link {}: {why}", link.display())
}

#[cfg(target_os = "linux")]
fn serve_can(hands: &SimHands, interface: &str) -> anyhow::Result<ServedWire> {
    let wire = crate::transport::can::open(interface, None)
        .map_err(|error| anyhow!("cannot serve on {interface}: {error}"))?;
    let closed = format!("the CAN interface {interface} was closed");
    let served = crate::sim::serve::can::serve(hands.clone(), wire);
    Ok(ServedWire::new("can", interface.to_owned(), closed, served))
}

#[cfg(not(target_os = "linux"))]
fn serve_can(_hands: &SimHands, interface: &str) -> anyhow::Result<ServedWire> {
    Err(anyhow!(
        "cannot serve on {interface}: CAN interfaces need Linux; use --tcp here"
    ))
}

#[cfg(not(unix))]
fn serve_link(
    _hands: &SimHands,
    _protocol: PtyProtocol,
    link: &Path,
    _pace: Option<LinePace>,
) -> anyhow::Result<ServedWire> {
    Err(anyhow!(
        "cannot create {}: pseudo-terminals need Linux or macOS; use --tcp here",
        link.display()
    ))
}

fn turnaround(text: &str) -> Result<Duration, String> {
    let what = "a time between 0 and 1000 milliseconds";
    number(text, 0.0..=1000.0, what).map(|ms: f64| Duration::from_secs_f64(ms / 1000.0))
}
