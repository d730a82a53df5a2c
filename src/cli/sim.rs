//! `sim`: simulated hands on the wires that other programs can open. Runs until it is ended; how a hand behaves is not
//! decided here.

use crate::cli::args::SimArgs;
use crate::cli::interrupt::{Interrupt, PowerCut};
use crate::cli::out::{Out, say};
use crate::cli::sim_quirks;
use crate::sim::serve::modbus_tcp;
#[cfg(unix)]
use crate::sim::serve::pty;
use crate::sim::{Hands, SharedHand, SimConfig, SimHand};
use crate::transport::LinePace;
#[cfg(unix)]
use crate::transport::TransportError;
use anyhow::{Context as _, anyhow};
use futures::future::BoxFuture;
use std::io;
use std::net::SocketAddr;
use std::path::Path;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::time::{Instant, interval};

/// The hand lives on when nobody asks, so that its first answer after an hour does not have to catch up on it.
const LIVE_EACH: Duration = Duration::from_millis(10);

/// A wire being served; it resolves only if it fails.
type Served = BoxFuture<'static, anyhow::Error>;

/// How long a hand that is switched off and on stays silent: its own start is said nowhere, a person's hand takes as long.
const STARTS_UP: Duration = Duration::from_secs(1);

/// Serves the hand until the person ends it.
pub(crate) fn run(out: &mut Out, args: &SimArgs) -> anyhow::Result<()> {
    tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("cannot start the simulated hand")?
        .block_on(serve(out, args))
}

async fn serve(out: &mut Out, args: &SimArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let power = PowerCut::listen()?;
    let hands = hands(args).context("no hand to simulate")?;
    let pace = args.baud.map(|baud| LinePace {
        baud,
        turnaround: args.turnaround,
    });
    // All wires are there before any is announced: who waits for one may use all.
    let mut ready = Vec::new();
    let tcp = match args.tcp {
        Some(address) => {
            let (served, bound) = serve_tcp(&hands, address).await?;
            ready.push(format!("ready tcp {bound}"));
            served
        }
        None => Box::pin(std::future::pending()),
    };
    let rs485 = match &args.rs485 {
        Some(link) => {
            let served = serve_rs485(&hands, link, pace)?;
            ready.push(format!("ready rs485 {}", link.display()));
            served
        }
        None => Box::pin(std::future::pending()),
    };
    let rtu = match &args.rtu {
        Some(link) => {
            let served = serve_rtu(&hands, link, pace)?;
            ready.push(format!("ready rtu {}", link.display()));
            served
        }
        None => Box::pin(std::future::pending()),
    };
    let slcan = match &args.slcan {
        Some(link) => {
            let served = serve_slcan(&hands, link)?;
            ready.push(format!("ready slcan {}", link.display()));
            served
        }
        None => Box::pin(std::future::pending()),
    };
    let can = match &args.can {
        Some(interface) => {
            let served = serve_can(&hands, interface)?;
            ready.push(format!("ready can {interface}"));
            served
        }
        None => Box::pin(std::future::pending()),
    };
    for line in &ready {
        out.line(line)?;
    }
    out.flush()?;
    tokio::select! {
        biased;
        () = interrupt.wished() => Ok(()),
        error = tcp => Err(error),
        error = rs485 => Err(error),
        error = rtu => Err(error),
        error = slcan => Err(error),
        error = can => Err(error),
        error = lose_power(out, power, &hands) => Err(error),
        () = live(&hands) => Ok(()),
    }
}

/// Switches all hands off and on at each wish, and says so once they answer again.
async fn lose_power(out: &mut Out, mut power: PowerCut, hands: &Hands) -> anyhow::Error {
    loop {
        power.wished().await;
        hands.with_each(SimHand::switch_off);
        tokio::time::sleep(STARTS_UP).await;
        hands.with_each(SimHand::power_cycle);
        if let Err(error) = out.line("power cycled").and_then(|()| out.flush()) {
            return error;
        }
    }
}

/// Each a hand of its own, with memory, body and chance of its own.
fn hands(args: &SimArgs) -> Option<Hands> {
    let begun = Instant::now();
    let seeds = (0..).map(|nth| args.seed.wrapping_add(nth));
    let mut hands = args.id.iter().zip(seeds).map(|(id, seed)| {
        let hand = SimHand::new(SimConfig {
            seed,
            id: id.get(),
            scenario: args.scenario,
            personality: sim_quirks::personality(&args.quirks),
        });
        SharedHand::new(hand, begun)
    });
    let first = hands.next()?;
    Some(Hands::new(first, hands.collect()))
}

async fn live(hands: &Hands) {
    let mut tick = interval(LIVE_EACH);
    loop {
        tick.tick().await;
        hands.with_each(SimHand::advance_to);
    }
}

async fn serve_tcp(hands: &Hands, address: SocketAddr) -> anyhow::Result<(Served, SocketAddr)> {
    let listener = TcpListener::bind(address)
        .await
        .map_err(|error| anyhow!("cannot serve on {address}: {}", bind_words(&error)))?;
    let bound = listener
        .local_addr()
        .context("cannot tell the address served on")?;
    if !bound.ip().is_loopback() {
        say(&format!(
            "warning: anyone in the network can reach {bound} and move the simulated hand; 127.0.0.1 keeps it to this computer"
        ));
    }
    let hands = hands.clone();
    let served = async move {
        match modbus_tcp::serve(hands, listener).await {
            Ok(()) => anyhow!("the server on {bound} ended"),
            Err(error) => anyhow!("the server on {bound} failed: {error}"),
        }
    };
    Ok((Box::pin(served), bound))
}

fn bind_words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            "another program listens there already; end it or choose another port".into()
        }
        io::ErrorKind::AddrNotAvailable => {
            "this computer does not have that address; 127.0.0.1 is always there".into()
        }
        io::ErrorKind::PermissionDenied => {
            "the system does not allow it; choose a port from 1024 up".into()
        }
        _ => error.to_string(),
    }
}

#[cfg(unix)]
fn serve_rs485(hands: &Hands, link: &Path, pace: Option<LinePace>) -> anyhow::Result<Served> {
    let served =
        pty::serve_rs485(hands.clone(), link, pace).map_err(|error| link_words(link, &error))?;
    Ok(until_closed(link, served))
}

#[cfg(unix)]
fn serve_slcan(hands: &Hands, link: &Path) -> anyhow::Result<Served> {
    let served = pty::serve_slcan(hands.clone(), link).map_err(|error| link_words(link, &error))?;
    Ok(until_closed(link, served))
}

#[cfg(unix)]
fn serve_rtu(hands: &Hands, link: &Path, pace: Option<LinePace>) -> anyhow::Result<Served> {
    let place = link.display().to_string();
    let served =
        pty::serve_rtu(hands.clone(), link, pace).map_err(|error| link_words(link, &error))?;
    Ok(Box::pin(async move {
        match served.await {
            Ok(()) => anyhow!("the pseudo-terminal behind {place} was closed"),
            Err(error) => anyhow!("the server on {place} failed: {error}"),
        }
    }))
}

#[cfg(unix)]
fn until_closed(link: &Path, served: impl Future<Output = ()> + Send + 'static) -> Served {
    let place = link.display().to_string();
    Box::pin(async move {
        served.await;
        anyhow!("the pseudo-terminal behind {place} was closed")
    })
}

#[cfg(unix)]
fn link_words(link: &Path, error: &TransportError) -> anyhow::Error {
    let place = link.display();
    match error {
        TransportError::NotAPort { .. } => {
            anyhow!(
                "cannot make the link {place}: something that is no link stands there; choose another path"
            )
        }
        TransportError::Missing { .. } => {
            anyhow!("cannot make the link {place}: its folder does not exist; make it first")
        }
        TransportError::Permission { .. } => {
            anyhow!("cannot make the link {place}: you may not write to its folder; choose another")
        }
        other => anyhow!("cannot make the link {place}: {other}"),
    }
}

#[cfg(target_os = "linux")]
fn serve_can(hands: &Hands, interface: &str) -> anyhow::Result<Served> {
    use crate::sim::serve::can;
    let wire = crate::transport::can::open(interface, None)
        .map_err(|error| anyhow!("cannot serve on {interface}: {error}"))?;
    let (hands, place) = (hands.clone(), interface.to_owned());
    Ok(Box::pin(async move {
        match can::serve(hands, wire).await {
            Ok(()) => anyhow!("the CAN interface {place} was closed"),
            Err(error) => anyhow!("cannot go on serving on {place}: {error}"),
        }
    }))
}

#[cfg(not(target_os = "linux"))]
fn serve_can(_hands: &Hands, _interface: &str) -> anyhow::Result<Served> {
    Err(anyhow!(crate::transport::TransportError::LinuxOnly))
}

#[cfg(not(unix))]
fn serve_rs485(_hands: &Hands, link: &Path, _pace: Option<LinePace>) -> anyhow::Result<Served> {
    Err(no_links(link))
}

#[cfg(not(unix))]
fn serve_rtu(_hands: &Hands, link: &Path, _pace: Option<LinePace>) -> anyhow::Result<Served> {
    Err(no_links(link))
}

#[cfg(not(unix))]
fn no_links(link: &Path) -> anyhow::Error {
    anyhow!(
        "cannot make {}: pseudo-terminals need Linux or macOS; use --tcp here",
        link.display()
    )
}

#[cfg(not(unix))]
fn serve_slcan(hands: &Hands, link: &Path) -> anyhow::Result<Served> {
    serve_rs485(hands, link, None)
}
