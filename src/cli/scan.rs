//! `scan`: finds hands on this computer's ports and interfaces, or on named ones, and at named network addresses.
//! Writes nothing to any hand.

use crate::app::connect::SimDial;
use crate::cli::out::{AlreadyReported, Out, WrongUsage, notify};
use crate::cli::parse::{HandIds, hand_ids};
use crate::hand::HandId;
use crate::link::Clock;
use crate::link::scan::{
    FoundHand, HOSTS_MAX, Hosts, Local, ScanConfig, ScanEvent, ScanHandle, ScanPort, ScanProgress,
    ScanSummary, Speaks, start,
};
use crate::shell::interrupt::Interrupt;
use anyhow::bail;
use clap::builder::NonEmptyStringValueParser;
use serde_json::{Value, json};
use std::fmt::Display;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::{MissedTickBehavior, interval};

/// Interval of progress reports.
const REPORT_INTERVAL: Duration = Duration::from_secs(5);
/// Number of IDs tried by default: a bus seldom has more hands, and each ID costs about half a second per port.
const IDS_UP_TO: u8 = 10;

#[derive(Debug, clap::Args)]
pub(crate) struct ScanArgs {
    /// Check this serial port; may be repeated
    #[arg(long, value_name = "PORT", value_parser = NonEmptyStringValueParser::new())]
    serial: Vec<String>,
    /// Check this address, or every address of a range, for example 192.168.11.210 or 192.168.11.0/24; may be repeated
    #[arg(long, value_name = "HOST[:PORT]|CIDR")]
    tcp: Vec<Hosts>,
    /// Check this CAN interface; may be repeated
    #[arg(long, value_name = "INTERFACE", value_parser = NonEmptyStringValueParser::new())]
    can: Vec<String>,
    /// Check the bus behind the serial CAN adapter on this port; may be repeated
    #[arg(long, value_name = "PORT", value_parser = NonEmptyStringValueParser::new())]
    slcan: Vec<String>,
    /// Look behind the maker's own USB-CAN adapter on this port; several times
    #[arg(long, value_name = "PORT", value_parser = NonEmptyStringValueParser::new())]
    usbcan: Vec<String>,
    /// Ids to ask on every bus, for example 1-10 or 1,2,7 [default: 1-10]
    #[arg(long, value_name = "IDS", value_parser = hand_ids, conflicts_with = "all_ids")]
    ids: Option<HandIds>,
    /// Ask all ids, 1 to 254
    #[arg(long)]
    all_ids: bool,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
}

impl ScanArgs {
    fn local(&self) -> Local {
        let named = [&self.serial, &self.can, &self.slcan, &self.usbcan];
        if self.tcp.is_empty() && named.iter().all(|list| list.is_empty()) {
            return Local::Listed;
        }
        let wish = |port: &String, speaks| ScanPort {
            port: port.clone(),
            usb: None,
            speaks,
        };
        let serial = self.serial.iter().map(|port| {
            let has_both = self.slcan.contains(port);
            wish(
                port,
                if has_both {
                    Speaks::Either
                } else {
                    Speaks::Hand
                },
            )
        });
        let slcan = self.slcan.iter().map(|port| wish(port, Speaks::CanAdapter));
        let usbcan = self
            .usbcan
            .iter()
            .map(|port| wish(port, Speaks::MakersAdapter));
        Local::Named {
            ports: serial.chain(slcan).chain(usbcan).collect(),
            can: self.can.clone(),
        }
    }

    fn ids(&self) -> Vec<HandId> {
        match &self.ids {
            Some(ids) => ids.0.clone(),
            None if self.all_ids => HandId::all().collect(),
            None => HandId::all().take(usize::from(IDS_UP_TO)).collect(),
        }
    }

    /// Several ranges together have the same limit as one.
    fn check_hosts(&self) -> anyhow::Result<()> {
        let hosts: usize = self.tcp.iter().map(Hosts::count).sum();
        if hosts <= HOSTS_MAX {
            Ok(())
        } else {
            Err(WrongUsage::error(format!(
                "--tcp names {hosts} addresses; at most {HOSTS_MAX} can be checked"
            )))
        }
    }
}

/// Scans. Fails if nothing was found and a place could not be checked.
pub(crate) async fn run(out: &mut Out, args: &ScanArgs) -> anyhow::Result<()> {
    args.check_hosts()?;
    let interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let config = ScanConfig {
        local: args.local(),
        hosts: args.tcp.clone(),
        ids: args.ids(),
        held: Vec::new(),
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let printer = ScanPrinter {
        out,
        args,
        handle: start(config, &Handle::current()),
        found: 0,
    };
    printer.run(interrupt).await
}

struct ScanPrinter<'a> {
    out: &'a mut Out,
    args: &'a ScanArgs,
    handle: ScanHandle,
    found: usize,
}

impl ScanPrinter<'_> {
    async fn run(mut self, mut interrupt: Interrupt) -> anyhow::Result<()> {
        let mut tick = interval(REPORT_INTERVAL);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        // The first tick comes at once, when nothing is known yet.
        tick.tick().await;
        let summary = loop {
            let event = tokio::select! {
                biased;
                () = interrupt.wished() => break None,
                event = self.handle.event() => event,
                _ = tick.tick() => {
                    notify(&progress_text(self.handle.progress(), self.found));
                    continue;
                }
            };
            match event {
                Some(ScanEvent::Done(summary)) => break Some(summary),
                Some(event) => self.handle_event(event)?,
                None => break None,
            }
        };
        self.end(summary)
    }

    fn handle_event(&mut self, event: ScanEvent) -> anyhow::Result<()> {
        match event {
            ScanEvent::Found(found) => {
                self.found += 1;
                let (object, line) = (found_json(&found), found_text(&found));
                self.out.result(self.args.json, &object, [line])?;
            }
            ScanEvent::Trouble { place, error } => {
                self.report_problem("trouble", &place, &error)?
            }
            ScanEvent::Hint(hint) => self.report_problem("hint", &hint.place(), &hint)?,
            ScanEvent::Begun { .. } | ScanEvent::Held { .. } | ScanEvent::Done(_) => {}
        }
        self.out.flush()
    }

    /// Reports a problem at a place.
    fn report_problem(
        &mut self,
        what: &str,
        place: &str,
        words: &impl Display,
    ) -> anyhow::Result<()> {
        let words = words.to_string();
        notify(&words);
        if !self.args.json {
            return Ok(());
        }
        let trouble = json!({ "place": place, "words": words });
        self.out.object(&json!({ what: trouble }))
    }

    /// Reports the outcome; without a summary, the user ended the scan.
    fn end(self, summary: Option<ScanSummary>) -> anyhow::Result<()> {
        let found = self.found;
        if self.args.json {
            self.out.object(&summary_json(found, summary))?;
        }
        self.out.flush()?;
        match summary {
            _ if found > 0 => Ok(()),
            None => bail!("the scan was ended before it found a hand"),
            Some(summary) if summary.failed > 0 => Err(AlreadyReported.into()),
            Some(summary) if summary.places == 0 => bail!(
                "there is nothing to scan: the system lists no serial port and no CAN interface; plug the adapter in, or name what to scan with --serial, --can, --slcan, --usbcan or --tcp"
            ),
            Some(summary) => {
                let (asked, took_s) = (summary.asked, summary.took.as_secs_f64());
                let more = if self.args.all_ids {
                    ""
                } else {
                    "; --all-ids asks all ids"
                };
                notify(&format!(
                    "no hand answered ({asked} questions, {took_s:.1} s): check power and cable{more}"
                ));
                Ok(())
            }
        }
    }
}

fn progress_text(progress: ScanProgress, found: usize) -> String {
    format!(
        "scan: {} of {} questions, {found} found, about {} s left",
        progress.tried,
        progress.total,
        progress.left.as_secs() + 1
    )
}

fn found_text(found: &FoundHand) -> String {
    let about = found.usb.as_ref().map(ToString::to_string);
    format!(
        "{}  HAND_ID {}  {:.1} ms  {}",
        found.endpoint,
        found.hand_id,
        found.round_trip.as_secs_f64() * 1e3,
        about.unwrap_or_default()
    )
    .trim_end()
    .to_owned()
}

fn found_json(found: &FoundHand) -> Value {
    json!({ "hand": {
        "url": found.endpoint.to_string(),
        "kind": found.endpoint.kind(),
        "place": found.endpoint.place(),
        "hand_id": found.hand_id,
        "round_trip_ms": found.round_trip.as_secs_f64() * 1e3,
        "usb": found.usb.as_ref().map(|usb| json!({
            "vendor_id": format!("{:04x}", usb.vendor_id),
            "product_id": format!("{:04x}", usb.product_id),
            "serial": usb.serial,
            "maker": usb.maker,
            "product": usb.product,
        })),
    }})
}

fn summary_json(found: usize, summary: Option<ScanSummary>) -> Value {
    json!({ "summary": {
        "found": found,
        "complete": summary.is_some(),
        "places": summary.map(|summary| summary.places),
        "failed": summary.map(|summary| summary.failed),
        "questions": summary.map(|summary| summary.asked),
        "took_s": summary.map(|summary| summary.took.as_secs_f64()),
    }})
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::UsbFound;

    fn found(usb: Option<UsbFound>) -> FoundHand {
        FoundHand {
            endpoint: "rs485:/dev/ttyUSB0?id=3".parse().unwrap(),
            hand_id: 3,
            round_trip: Duration::from_micros(9_870),
            usb,
        }
    }

    fn adapter() -> UsbFound {
        UsbFound {
            vendor_id: 0x0403,
            product_id: 0x6001,
            serial: Some("A50285BI".into()),
            maker: Some("FTDI".into()),
            product: Some("FT232R".into()),
            location: None,
            latency_timer_ms: None,
        }
    }

    #[test]
    fn a_hand_is_told_with_vendor_product_and_serial_number_of_its_adapter() {
        let bare = UsbFound {
            serial: None,
            maker: None,
            product: None,
            ..adapter()
        };
        let line = "rs485:/dev/ttyUSB0?baud=115200&id=3  HAND_ID 3  9.9 ms";
        for (usb, words) in [
            (None, line.to_owned()),
            (Some(bare), format!("{line}  USB 0403:6001")),
            (
                Some(adapter()),
                format!("{line}  FTDI FT232R A50285BI USB 0403:6001"),
            ),
        ] {
            assert_eq!(found_text(&found(usb)), words);
        }
        let told = found_json(&found(Some(adapter())));
        let usb = json!({
            "vendor_id": "0403", "product_id": "6001", "serial": "A50285BI", "maker": "FTDI", "product": "FT232R",
        });
        assert_eq!(told["hand"]["usb"], usb);
        assert_eq!(told["hand"]["place"], "/dev/ttyUSB0");
        assert_eq!(found_json(&found(None))["hand"]["usb"], Value::Null);
    }

    #[test]
    fn the_progress_line_names_what_is_done_and_what_is_left() {
        let progress = ScanProgress {
            tried: 34,
            total: 80,
            left: Duration::from_millis(2870),
        };
        let words = "scan: 34 of 80 questions, 1 found, about 3 s left";
        assert_eq!(progress_text(progress, 1), words);
    }

    #[test]
    fn without_places_all_listed_ones_are_looked_at_and_never_an_address() {
        use clap::Parser as _;
        #[derive(clap::Parser)]
        struct Line {
            #[command(flatten)]
            args: ScanArgs,
        }
        let parsed = |text: &str| Line::parse_from(text.split(' ')).args;
        let plain = parsed("scan");
        assert_eq!(plain.local(), Local::Listed);
        assert!(plain.tcp.is_empty());
        assert_eq!(plain.ids().len(), 10);
        assert_eq!(parsed("scan --all-ids").ids().len(), 254);
        for named in [
            "scan --tcp 127.0.0.1",
            "scan --can can0",
            "scan --slcan COM3",
            "scan --usbcan COM3",
        ] {
            assert_ne!(parsed(named).local(), Local::Listed, "{named}");
        }
        let Local::Named { ports, .. } =
            parsed("scan --serial a --slcan a --slcan b --usbcan c").local()
        else {
            unreachable!("ports were named");
        };
        let speaks: Vec<_> = ports.iter().map(|wish| wish.speaks).collect();
        // The second mention of a port is joined to the first by the plan.
        assert_eq!(
            speaks,
            [
                Speaks::Either,
                Speaks::CanAdapter,
                Speaks::CanAdapter,
                Speaks::MakersAdapter
            ]
        );
    }
}
