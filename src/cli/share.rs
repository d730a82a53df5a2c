//! `share`: a Modbus TCP gateway, through which several programs use one hand, until a person ends it.

use crate::cli::interrupt::Interrupt;
use crate::cli::out::{Out, say};
use crate::cli::session;
use crate::cli::wires::address;
use crate::link::{Clock, LinkHandle, LinkTrouble, PollRates};
use crate::share::gateway::Gateway;
use crate::transport::Endpoint;
use anyhow::anyhow;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::interval;

/// How often there may be something to tell.
const LOOK_EACH: Duration = Duration::from_millis(100);

#[derive(Debug, clap::Args)]
pub(crate) struct ShareArgs {
    /// The hand to share
    #[arg(long, value_name = "URL")]
    hand: Endpoint,
    /// Serve Modbus TCP here, for example 127.0.0.1:6001; port 0 takes any free one
    #[arg(long, value_name = "ADDR:PORT", value_parser = address)]
    tcp: SocketAddr,
    /// Read as fast as the wire allows, instead of 100 states and 30 touch sweeps a second
    #[arg(long)]
    full_rate: bool,
}

/// Shares the hand until a person ends it.
pub(crate) async fn run(out: &mut Out, args: &ShareArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let rates = match args.full_rate {
        true => PollRates::FULL,
        false => PollRates::default(),
    };
    let link = session::open(&args.hand, rates, Clock::start());
    tokio::select! {
        biased;
        () = interrupt.wished() => return Ok(()),
        answered = session::answered(&link, &args.hand) => answered?,
    }
    let gateway = open(&link, args)?;
    out.line(&format!("ready tcp {}", gateway.address()))?;
    out.flush()?;
    tokio::select! {
        biased;
        () = interrupt.wished() => {}
        () = tell(&link, &gateway, &args.hand) => {}
    }
    Ok(())
}

fn open(link: &LinkHandle, args: &ShareArgs) -> anyhow::Result<Gateway> {
    let address = args.tcp;
    let gateway = Gateway::open(link.clone(), address, &Handle::current()).map_err(|error| {
        anyhow!("cannot serve on {address}: {error}; choose another address or port")
    })?;
    let bound = gateway.address();
    if !bound.ip().is_loopback() {
        say(&format!(
            "warning: anyone in the network can reach {bound} and read this hand; 127.0.0.1 keeps it to this computer"
        ));
    }
    Ok(gateway)
}

/// Tells what a person has to know, for as long as it is shared.
async fn tell(link: &LinkHandle, gateway: &Gateway, hand: &Endpoint) {
    let mut told = Told::default();
    let mut tick = interval(LOOK_EACH);
    loop {
        tick.tick().await;
        told.link(link, hand);
        told.turned_away(gateway);
    }
}

/// What was told already.
#[derive(Default)]
struct Told {
    trouble: Option<LinkTrouble>,
    turned_away: bool,
}

impl Told {
    fn link(&mut self, link: &LinkHandle, hand: &Endpoint) {
        let status = link.status();
        match session::trouble(&status) {
            Some(trouble) if self.trouble.as_ref() != Some(trouble) => {
                say(&format!("link to {hand} lost: {trouble}; trying again"));
                self.trouble = Some(trouble.clone());
            }
            None if status.state.is_live() && self.trouble.take().is_some() => {
                say("the hand answers again");
            }
            _ => {}
        }
    }

    fn turned_away(&mut self, gateway: &Gateway) {
        if gateway.turned_away() > 0 && !std::mem::replace(&mut self.turned_away, true) {
            say("there are as many clients as there may be: more are turned away");
        }
    }
}
