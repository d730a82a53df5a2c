//! `sim`: simulated hands on wires that other programs can open, until the program is ended. How a hand behaves is decided in
//! [`crate::sim`].
use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::parse::{HandIds, hand_ids, number};
use crate::sim::serve::modbus_tcp;
#[cfg(unix)]
use crate::sim::serve::pty;
use crate::sim::{Personality, SWITCHES, Scenario, SharedHand, SimConfig, SimHand, SimHands};
use crate::transport::LinePace;
#[cfg(unix)]
use crate::transport::TransportError;
use anyhow::{Context as _, anyhow, ensure};
#[cfg(unix)]
use futures::FutureExt;
use futures::future::{BoxFuture, select_all};
use std::fmt::Write as _;
use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::time::{Instant, interval};

/// The hand goes on when nobody asks, so that its first answer after an hour has nothing to catch up on.
const LIVE_EACH: Duration = Duration::from_millis(10);

/// A wire being served.
struct ServedWire {
    /// Kind and place, as they are announced.
    name: String,
    /// Resolves only on failure.
    served: BoxFuture<'static, anyhow::Error>,
}

impl ServedWire {
    /// `closed` is the error of a server that ends without one.
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

/// What is spoken on a pseudo-terminal.
#[derive(Clone, Copy)]
enum PtyProtocol {
    Rs485,
    Rtu,
    Slcan,
    UsbCan,
}

/// How long a hand stays silent during a power cycle. The manual gives no start-up time; a person at the switch takes about as
/// long.
const STARTS_UP: Duration = Duration::from_secs(1);

#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("wire").required(true).multiple(true).args(["tcp", "rs485", "rtu", "slcan", "usbcan", "can"]))]
pub(crate) struct SimArgs {
    /// Serve Modbus TCP here, for example 127.0.0.1:6000
    #[arg(long, value_name = "ADDR:PORT", value_parser = address)]
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
    /// Ids of the hands, 1 to 254, for example 1, 1,2,3 or 1-4
    #[arg(long, value_name = "IDS", default_value = "1", value_parser = few_ids)]
    id: HandIds,
    /// Random seed of the first hand; each further hand takes the next number
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// What the hand does: idle, free, rigid, fragile, grasp, faults, extremes
    #[arg(long, value_name = "NAME", default_value = "idle")]
    scenario: Scenario,
    /// What the hand does where the manual leaves a choice, from the list below; may be repeated
    #[arg(long = "quirk", value_name = "NAME=VALUE", value_parser = quirk)]
    quirks: Vec<Quirk>,
}

const SIM_HELP: &str = "\
Examples:\n  handscope sim --rs485 /tmp/hand --tcp 127.0.0.1:6000\n  handscope sim --rtu /tmp/hand-rtu\n  handscope sim --slcan /tmp/adapter --can vcan0\n  handscope sim --tcp 127.0.0.1:6000 --scenario grasp --seed 7\n  handscope sim --rs485 /tmp/bus --id 1,2,3\n\nIt runs until Ctrl-C. All wires lead to the same hands. On Unix, SIGUSR1 switches them off for a second, and 'power cycled' is printed once they are back; what was not saved is gone.
On Modbus TCP the unit id selects the hand; 255 means the first, and a single hand answers to every id.";

/// What stands under the list of switches.
pub(crate) fn help() -> String {
    format!("{SIM_HELP}\n\n{}", quirk_list())
}

/// Serves the hand until a person ends it.
pub(crate) async fn run(out: &mut Out, args: &SimArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let power = Interrupt::power_cut()?;
    let hands = hands(args).context("no hand to simulate")?;
    // All wires are there before any is announced: who waits for one may use all.
    let wires = wires(&hands, args).await?;
    ensure!(!wires.is_empty(), "no wire to serve the hand on");
    out.lines(wires.iter().map(|wire| format!("ready {}", wire.name)))?;
    out.flush()?;
    tokio::select! {
        biased;
        () = interrupt.wished() => Ok(()),
        (error, ..) = select_all(wires.into_iter().map(|wire| wire.served)) => Err(error),
        error = lose_power(out, power, &hands) => Err(error),
        () = live(&hands) => Ok(()),
    }
}

async fn wires(hands: &SimHands, args: &SimArgs) -> anyhow::Result<Vec<ServedWire>> {
    let mut wires = Vec::new();
    if let Some(address) = args.tcp {
        wires.push(serve_tcp(hands, address).await?);
    }
    let pace = args.baud.map(|baud| LinePace {
        baud,
        turnaround: args.turnaround,
    });
    for (protocol, link) in [
        (PtyProtocol::Rs485, &args.rs485),
        (PtyProtocol::Rtu, &args.rtu),
        (PtyProtocol::Slcan, &args.slcan),
        (PtyProtocol::UsbCan, &args.usbcan),
    ] {
        if let Some(link) = link {
            wires.push(serve_link(hands, protocol, link, pace)?);
        }
    }
    if let Some(interface) = &args.can {
        wires.push(serve_can(hands, interface)?);
    }
    Ok(wires)
}

/// Switches all hands off and on at each signal, and says so once they answer again.
async fn lose_power(out: &mut Out, mut power: Interrupt, hands: &SimHands) -> anyhow::Error {
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

/// Separate hands, each with its own memory, body and random numbers.
fn hands(args: &SimArgs) -> Option<SimHands> {
    let begun = Instant::now();
    let seeds = (0..).map(|nth| args.seed.wrapping_add(nth));
    let mut hands = args.id.0.iter().zip(seeds).map(|(id, seed)| {
        let hand = SimHand::new(SimConfig {
            seed,
            id: id.get(),
            scenario: args.scenario,
            personality: personality(&args.quirks),
        });
        SharedHand::new(hand, begun)
    });
    let first = hands.next()?;
    Some(SimHands::new(first, hands.collect()))
}

async fn live(hands: &SimHands) {
    let mut tick = interval(LIVE_EACH);
    loop {
        tick.tick().await;
        hands.with_each(SimHand::advance_to);
    }
}

async fn serve_tcp(hands: &SimHands, address: SocketAddr) -> anyhow::Result<ServedWire> {
    let listener = TcpListener::bind(address).await.map_err(|error| {
        anyhow!("cannot serve on {address}: {error}; choose another address or port")
    })?;
    let bound = listener
        .local_addr()
        .context("cannot read back the address that is served")?;
    if !bound.ip().is_loopback() {
        say(&format!(
            "warning: anyone in the network can reach {bound} and move the simulated hand; 127.0.0.1 keeps it to this computer"
        ));
    }
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
fn serve_can(_hands: &SimHands, _interface: &str) -> anyhow::Result<ServedWire> {
    Err(anyhow!(crate::transport::TransportError::LinuxOnly))
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

fn address(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_not_one| {
        "write an address in numbers and a port, for example 127.0.0.1:6000".to_owned()
    })
}

/// Hands that one process simulates: an RS485 bus carries 32 (TIA-485-A), and each costs computing time.
const SIM_HANDS_MAX: usize = 32;

fn few_ids(text: &str) -> Result<HandIds, String> {
    let ids = hand_ids(text)?;
    let asked = ids.0.len();
    if asked > SIM_HANDS_MAX {
        return Err(format!(
            "'{text}' asks for {asked} hands; at most {SIM_HANDS_MAX} can be simulated at once"
        ));
    }
    Ok(ids)
}

/// A switch and a position that it has.
type Quirk = (String, String);

/// Reads `NAME=VALUE`.
fn quirk(text: &str) -> Result<Quirk, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("'{text}' is not a quirk: write NAME=VALUE"))?;
    let known = Personality::default().set(name, value);
    known.map_err(|error| error.to_string())?;
    Ok((name.into(), value.into()))
}

/// A hand with these quirks; where a switch is set twice, the last one counts.
fn personality(quirks: &[Quirk]) -> Personality {
    let mut personality = Personality::default();
    for (name, value) in quirks {
        let known = personality.set(name, value);
        debug_assert!(known.is_ok(), "it was looked up when it was read");
    }
    personality
}

/// All switches and positions, for the help text.
fn quirk_list() -> String {
    let mut text = String::from(
        "Quirks: what the hand does where the manual leaves a choice. The first value of each is the default.\n",
    );
    for switch in SWITCHES {
        let values = switch.values.join("|");
        // Writing to a string cannot fail.
        let _written = writeln!(text, "  {}={values}\n      {}", switch.name, switch.about);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::GapAnswer;

    #[test]
    fn quirks_are_read_by_name_and_wrong_ones_say_what_there_is() {
        let all = [
            quirk("gap=refused").unwrap(),
            quirk("doubles=some").unwrap(),
        ];
        assert_eq!(personality(&all).gap, GapAnswer::Refused);
        for (text, part) in [
            ("gap", "NAME=VALUE"),
            ("gap=ajar", "through, refused"),
            ("warp=9", "no quirk 'warp'"),
        ] {
            let error = quirk(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        for switch in SWITCHES {
            assert!(quirk_list().contains(switch.name));
        }
    }
}
