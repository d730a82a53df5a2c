//! `fleet`: lists hands that Handscopes share on DDS, and their changes. Connects to none of them.

use crate::cli::out::{Out, notify};
use crate::cli::parse::seconds;
use crate::cli::share::dds::{LOOPBACK, domain};
use crate::hand::kinematics::Side;
use crate::link::{Clock, Owner};
use crate::record::LinkState;
use crate::share::fleet::{FleetHand, FleetList};
use crate::shell::interrupt::Interrupt;
use crate::transport::dds::{DdsNode, DdsPlace};
use serde_json::json;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::sleep;

#[derive(Debug, clap::Args)]
pub(crate) struct FleetArgs {
    /// Look for hands at this network interface, by name or address; the default finds those of this computer
    #[arg(value_name = "INTERFACE", default_value = LOOPBACK)]
    interface: String,
    /// The domain of DDS, 0 to 232
    #[arg(long, value_name = "NUMBER", default_value = "0", value_parser = domain)]
    domain: u16,
    /// Seconds to look [default: until Ctrl-C]
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    /// Print the whole list as one JSON object a line, each time it changes
    #[arg(long)]
    json: bool,
}

/// Lists until the user ends it, or the time is up.
pub(crate) async fn run(out: &mut Out, args: &FleetArgs) -> anyhow::Result<()> {
    let mut interrupt = Interrupt::listen()?;
    let node = DdsNode::open(&DdsPlace {
        interface: args.interface.clone(),
        domain: args.domain,
    })?;
    let clock = Clock::start();
    let mut list = FleetList::open(&node, clock, Arc::new(|| ()));
    let over = async {
        match args.length {
            Some(length) => sleep(length).await,
            None => std::future::pending().await,
        }
    };
    let mut printer = FleetPrinter {
        out,
        as_json: args.json,
        hands: Vec::new(),
        is_any: false,
    };
    tokio::select! {
        biased;
        () = interrupt.wished() => {}
        () = over => {}
        failed = printer.run(&mut list, clock) => return failed,
    }
    if !printer.is_any {
        if args.json {
            printer.object(clock)?;
        }
        let interface = node.address();
        notify(&format!(
            "no hand is shared at {interface}: share one with 'handscope share --hand URL --tcp ADDR:PORT --dds', or name the network interface to listen on"
        ));
    }
    Ok(())
}

/// Hands reported so far.
struct FleetPrinter<'a> {
    out: &'a mut Out,
    as_json: bool,
    hands: Vec<FleetHand>,
    is_any: bool,
}

impl FleetPrinter<'_> {
    async fn run(&mut self, list: &mut FleetList, clock: Clock) -> anyhow::Result<()> {
        while let Some(hands) = list.changed().await {
            self.is_any |= !hands.is_empty();
            if !self.as_json {
                self.changes(&hands)?;
            }
            self.hands = hands;
            if self.as_json {
                self.object(clock)?;
            }
            self.out.flush()?;
        }
        Ok(())
    }

    fn object(&mut self, clock: Clock) -> anyhow::Result<()> {
        let seconds = clock.now().secs();
        let object = json!({"t": seconds, "hands": self.hands});
        self.out.stream_object(&object)
    }

    fn changes(&mut self, hands: &[FleetHand]) -> anyhow::Result<()> {
        let is_there = |old: &&FleetHand| hands.iter().any(|new| new.card == old.card);
        for gone in self.hands.iter().filter(|old| !is_there(old)) {
            let (host, name) = (&gone.card.host, &gone.card.name);
            self.out.stream_line(&format!("{host}  {name}  gone"))?;
        }
        let is_new = |new: &&FleetHand| !self.hands.contains(new);
        let mut new = hands.iter().filter(is_new).map(line);
        new.try_for_each(|line| self.out.stream_line(&line))
    }
}

/// A hand as one line.
fn line(hand: &FleetHand) -> String {
    let card = &hand.card;
    let at = match hand.endpoint() {
        Some(endpoint) => endpoint.to_string(),
        None => "no gateway".into(),
    };
    let state = match hand.state {
        LinkState::Offline | LinkState::Identifying => "no answer",
        LinkState::Monitoring => "watched",
        LinkState::Armed => "armed",
        LinkState::Holding => "stopping",
        LinkState::Fault => "fault",
    };
    let mover = match hand.owner {
        None => "nobody moves it".into(),
        Some(owner) => format!("moved by {}", owner_word(owner)),
    };
    let side = match card.side {
        Side::Left => "left",
        Side::Right => "right",
    };
    format!(
        "{}  {}  {side}  {state}  {mover}  {at}",
        card.host, card.name
    )
}

fn owner_word(owner: Owner) -> String {
    match owner {
        Owner::Person => "a user there".into(),
        Owner::Task => "a task there".into(),
        Owner::Exhibition => "an exhibition".into(),
        Owner::Gamepad => "a gamepad".into(),
        Owner::Stream(from) => format!("lines from {from}"),
        Owner::Dds => "a program on DDS".into(),
        Owner::Gateway(from) => format!("a client at {from}"),
        Owner::Mirror => "another hand".into(),
    }
}
