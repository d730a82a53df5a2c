//! `share`: shares one hand with several programs (Modbus TCP, DDS) and live viewers, until the user ends it.

pub(crate) mod dds;
pub(crate) mod fleet;
mod stdio;

use crate::cli::listen;
use crate::cli::out::{Out, notify};
use crate::cli::parse::{number, side};
use crate::cli::recordings::beside::SideRecording;
use crate::cli::session;
use crate::cli::share::dds::DdsArgs;
use crate::cli::share::stdio::StdioHand;
use crate::hand::kinematics::Side;
use crate::link::{Clock, LeaseRefusal, LinkHandle, LinkTrouble, PollRates};
use crate::record::file::Opening;
use crate::record::{Disarmed, LinkState};
use crate::share::dds::SharedOnDds;
use crate::share::fleet::FleetCard;
use crate::share::foxglove::{FoxgloveConfig, FoxgloveServer};
use crate::share::gateway::{
    ClientLease, Gateway, GatewayClient, GatewayConfig, MoverChange, MoverEvent, SILENCE, Writers,
};
use crate::shell::interrupt::Interrupt;
use crate::store::calendar;
use crate::transport::Endpoint;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::interval;

/// Polling interval for status reports.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("way out").required(true).multiple(true).args(["tcp", "dds", "foxglove", "stdio"]))]
pub(crate) struct ShareArgs {
    /// The hand to share
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    hand: Endpoint,
    /// Serve Modbus TCP here, for example 127.0.0.1:6001; port 0 takes any free one
    #[arg(long, value_name = "ADDR:PORT", value_parser = listen::address)]
    tcp: Option<SocketAddr>,
    /// Show what a recording would hold to Foxglove, PlotJuggler and their like here, for example 127.0.0.1:8765
    #[arg(long, value_name = "ADDR:PORT", value_parser = listen::address)]
    foxglove: Option<SocketAddr>,
    /// Let the program that starts this one watch and move the hand, by lines of JSON on standard input and output; the hand is
    /// stopped when standard input ends
    #[arg(long)]
    stdio: bool,
    #[command(flatten)]
    dds: DdsArgs,
    /// Which hand it is, right or left, as --dds, --stdio and --record tell it
    #[arg(long, value_name = "SIDE", default_value = "right", value_parser = side)]
    side: Side,
    /// With --tcp: let the first client that writes move the hand, until it disconnects or falls silent
    #[arg(long, requires = "tcp")]
    writers: bool,
    /// With --writers: after so many seconds without a request the client may no longer move the hand [default: 10]
    #[arg(long, value_name = "SECONDS", requires = "writers", value_parser = silence)]
    silence: Option<Duration>,
    /// Read as fast as the wire allows, instead of 100 states and 30 touch sweeps a second
    #[arg(long)]
    full_rate: bool,
    /// Record meanwhile, as 'handscope record' does; what clients write is recorded as it passes
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
}

/// Shares the hand until the user ends it.
pub(crate) async fn run(out: &mut Out, args: &ShareArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let rates = if args.full_rate {
        PollRates::FULL
    } else {
        PollRates::default()
    };
    let link = session::open(&args.hand, rates, Clock::start());
    tokio::select! {
        biased;
        () = interrupt.wished() => return Ok(()),
        answered = session::answered(&link, &args.hand) => answered?,
    }
    let recording = args.record.as_deref();
    let recording = SideRecording::begin(recording, &link, &args.hand, args.side)?;
    let shared = serve(out, args, &link, &mut interrupt).await;
    drop(link);
    SideRecording::and(shared, recording.end().await)
}

/// Shares a hand that answers.
async fn serve(
    out: &mut Out,
    args: &ShareArgs,
    link: &LinkHandle,
    interrupt: &mut Interrupt,
) -> anyhow::Result<()> {
    let mut ways = Vec::new();
    let gateway = args.tcp.map(|at| open(link, at, args)).transpose()?;
    ways.extend(gateway.iter().map(|gateway| ("tcp", gateway.address())));
    let viewers = args.foxglove.map(|at| show(link, at, args));
    let viewers = viewers.transpose()?;
    ways.extend(viewers.iter().map(|server| ("foxglove", server.address())));
    let announced = ways.into_iter().filter(|_| !args.stdio);
    for (way, address) in announced {
        out.line(&format!("ready {way} {address}"))?;
    }
    let card = FleetCard {
        side: args.side,
        at: gateway.as_ref().map(Gateway::address),
        first_may_move: args.writers,
        ..args.dds.card(&args.hand)
    };
    let node = args.dds.join("read this hand")?;
    let dds = node.map(|node| SharedOnDds::open(node, link, card));
    if let Some(dds) = dds.as_ref().filter(|_| !args.stdio) {
        out.line(&dds::ready(dds))?;
    }
    out.flush()?;
    let hand = StdioHand {
        link,
        endpoint: &args.hand,
        side: args.side,
        gateway: gateway.as_ref().map(Gateway::address),
    };
    let served = async {
        if args.stdio {
            return stdio::serve(out, hand, interrupt.wished()).await;
        }
        interrupt.wished().await;
        Ok(())
    };
    let done = tokio::select! {
        biased;
        done = served => done,
        () = report_status(link, gateway.as_ref(), &args.hand) => Ok(()),
    };
    let may_move = gateway.is_some_and(|gateway| close(link, gateway));
    // With --stdio, the hand was stopped before.
    let is_stopping = !args.stdio && link.status().state == LinkState::Holding;
    if may_move || is_stopping {
        return done.and(session::stopped(link).await);
    }
    done
}

/// Closes the gateway. Returns true if a client could move the hand, which must then be stopped.
fn close(link: &LinkHandle, gateway: Gateway) -> bool {
    let is_held = |client: &GatewayClient| matches!(client.lease, ClientLease::Held(_));
    let may_move = gateway.clients().iter().any(is_held);
    report_movers(&gateway, link);
    may_move
}

fn open(link: &LinkHandle, address: SocketAddr, args: &ShareArgs) -> anyhow::Result<Gateway> {
    let config = GatewayConfig {
        address,
        writers: if args.writers {
            Writers::First
        } else {
            Writers::Granted
        },
        silence: args.silence.unwrap_or(SILENCE),
    };
    let gateway = Gateway::open(link.clone(), config, &Handle::current())
        .map_err(|error| listen::refused(address, &error))?;
    let can = if args.writers {
        "move this hand"
    } else {
        "read this hand"
    };
    listen::warn_if_reachable(gateway.address(), can);
    Ok(gateway)
}

/// Shows the hand to viewers.
fn show(
    link: &LinkHandle,
    address: SocketAddr,
    args: &ShareArgs,
) -> anyhow::Result<FoxgloveServer> {
    let moments = (link.clock().now(), calendar::since_1970());
    let config = FoxgloveConfig {
        address,
        opening: Opening::begin(args.hand.to_string(), moments, args.side)
            .with_newtons(session::newtons_per_g(&args.hand)),
    };
    let mut server = FoxgloveServer::open(config, &Handle::current())
        .map_err(|error| listen::refused(address, &error))?;
    listen::warn_if_reachable(server.address(), "watch this hand");
    server.show(link);
    Ok(server)
}

/// Reports status changes to the user while the hand is shared.
async fn report_status(link: &LinkHandle, gateway: Option<&Gateway>, hand: &Endpoint) {
    let mut reporter = StatusReporter::default();
    let mut tick = interval(POLL_INTERVAL);
    loop {
        tick.tick().await;
        reporter.link(link, hand);
        if let Some(gateway) = gateway {
            reporter.turned_away(gateway);
            report_movers(gateway, link);
        }
    }
}

/// Status reported so far.
#[derive(Default)]
struct StatusReporter {
    trouble: Option<LinkTrouble>,
    turned_away: bool,
}

impl StatusReporter {
    fn link(&mut self, link: &LinkHandle, hand: &Endpoint) {
        let status = link.status();
        match session::trouble(&status) {
            Some(trouble) if self.trouble.as_ref() != Some(trouble) => {
                notify(&format!("link to {hand} lost: {trouble}; trying again"));
                self.trouble = Some(trouble.clone());
            }
            None if status.state.is_live() && self.trouble.take().is_some() => {
                notify("the hand answers again");
            }
            _ => {}
        }
    }

    fn turned_away(&mut self, gateway: &Gateway) {
        if gateway.turned_away() > 0 && !std::mem::replace(&mut self.turned_away, true) {
            notify("the maximum number of clients is connected: more are rejected");
        }
    }
}

/// Reports each client that gets or loses control of the hand.
fn report_movers(gateway: &Gateway, link: &LinkHandle) {
    for MoverEvent { client, change } in gateway.movers() {
        notify(&match change {
            MoverChange::Began => format!("{client} may move the hand"),
            MoverChange::Left => {
                format!("{client}, which had control, has disconnected: the hand is being stopped")
            }
            MoverChange::Ended(end) => {
                let by_other = end == LeaseRefusal::Ended(Disarmed::OtherController);
                let foreign = link.status().foreign_setpoint.filter(|_| by_other);
                let why = foreign.map_or_else(
                    || ended(end),
                    |foreign| {
                        format!("another controller wrote {foreign}, and the hand is being stopped")
                    },
                );
                format!("{client} may no longer move the hand: {why}")
            }
        });
    }
}

fn ended(end: LeaseRefusal) -> String {
    match end {
        LeaseRefusal::Taken(_) => "another controller has control".into(),
        LeaseRefusal::Ended(why @ (Disarmed::LinkLost | Disarmed::Resume)) => {
            format!("{why}, and the hand may still finish its move")
        }
        LeaseRefusal::Ended(why) => format!("{why}, and the hand is being stopped"),
    }
}

fn silence(text: &str) -> Result<Duration, String> {
    let what = "a time between 1 and 3600 seconds";
    number(text, 1.0..=3600.0, what).map(Duration::from_secs_f64)
}
