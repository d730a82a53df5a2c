//! A check-up as lines for a person. Measures and judges nothing.

use crate::cli::doctor::checkup::{Checkup, EDGES_MS, Measured, Place, Window};
use crate::cli::doctor::findings::Finding;
use crate::cli::out::Out;
use crate::transport::{PortFacts, Route, UsbFound};
use std::time::Duration;

/// Width of the captions.
const CAPTION: usize = 12;

/// Prints everything.
pub(crate) fn print(out: &mut Out, checkup: &Checkup, found: &[Finding]) -> anyhow::Result<()> {
    let mut page = Page(out);
    page.row("hand", &checkup.endpoint.to_string())?;
    page.place(&checkup.place)?;
    match &checkup.answer {
        Ok(measured) => page.measured(measured)?,
        Err(_) => page.row("answer", "none")?,
    }
    page.verdict(found)
}

struct Page<'a>(&'a mut Out);

impl Page<'_> {
    fn row(&mut self, caption: &str, value: &str) -> anyhow::Result<()> {
        self.0.line(&format!("{caption:<CAPTION$}{value}"))
    }

    /// A row whose value may not be known.
    fn known(&mut self, caption: &str, value: Option<&str>) -> anyhow::Result<()> {
        self.row(caption, value.unwrap_or("-"))
    }

    fn place(&mut self, place: &Place) -> anyhow::Result<()> {
        match place {
            Place::BuiltIn => self.row("place", "built into this program, over a wire in memory"),
            Place::Port(facts) => self.port(facts),
            Place::Net(way) => self.net(way.as_ref()),
            #[cfg(target_os = "linux")]
            Place::Can(facts) => self.can(facts),
            #[cfg(not(target_os = "linux"))]
            Place::NoCan => Ok(()),
        }
    }

    fn port(&mut self, facts: &PortFacts) -> anyhow::Result<()> {
        self.known("device", facts.device.as_deref())?;
        let adapter = facts.usb.as_ref().map(adapter);
        self.row(
            "adapter",
            &adapter.unwrap_or_else(|| "not on USB, or not listed by the system".into()),
        )?;
        self.known("driver", facts.driver.as_deref())?;
        self.known("rights", facts.rights.as_deref())?;
        self.row(
            "held by",
            facts
                .holder
                .as_deref()
                .unwrap_or("no other program that shows"),
        )?;
        let timer = facts.usb.as_ref().and_then(|usb| usb.latency_timer_ms);
        let timer = timer.map(|ms| format!("{ms} ms"));
        self.row("latency", &timer.unwrap_or_else(|| "no timer known".into()))
    }

    fn net(&mut self, way: Option<&Route>) -> anyhow::Result<()> {
        let Some(way) = way else {
            return self.row("route", "none: this computer knows no way there");
        };
        let interface = way.interface.as_deref().unwrap_or("an unknown interface");
        let prefix = way
            .prefix
            .map(|bits| format!("/{bits}"))
            .unwrap_or_default();
        let words = match way.is_direct() {
            Some(true) => ", in the same network",
            Some(false) => ", in another network",
            None => "",
        };
        self.row(
            "route",
            &format!(
                "from {}{prefix} on {interface} to {}{words}",
                way.from, way.to
            ),
        )
    }

    #[cfg(target_os = "linux")]
    fn can(&mut self, facts: &crate::transport::can_facts::CanFacts) -> anyhow::Result<()> {
        if !facts.exists {
            return self.row("interface", "not there");
        }
        let is = match (facts.is_can, facts.is_up) {
            (Some(false), _) => "not a CAN interface",
            (_, Some(false)) => "down",
            (_, Some(true)) => "up",
            (_, None) => "-",
        };
        self.row("interface", is)?;
        let rate = facts.bitrate.map(|rate| format!("{rate} bit/s"));
        self.known("bit rate", rate.as_deref())?;
        self.known("controller", facts.state.as_deref())?;
        let queue = facts.queue_len.map(|len| format!("{len} frames"));
        self.known("queue", queue.as_deref())
    }

    fn measured(&mut self, measured: &Measured) -> anyhow::Result<()> {
        self.row(
            "answer",
            &format!("after {} ms", millis(measured.answered_after)),
        )?;
        if let Some(port) = &measured.status.moved_to {
            self.row("now at", port)?;
        }
        self.row(
            "echo",
            if measured.status.echoes {
                "yes, left out"
            } else {
                "none"
            },
        )?;
        self.row(
            "others",
            if measured.status.rival {
                "another controller"
            } else {
                "none"
            },
        )?;
        self.errors(measured)?;
        self.0.line("")?;
        let edges = EDGES_MS
            .map(|edge| format!("{:>6}", format!("<{edge}")))
            .concat();
        self.0.line(&format!(
            "{:<17}{:>5}{:>8}{:>8}{:>8}{:>8}{:>8} |{edges}{:>6}",
            "round trips, ms", "bytes", "reads", "min", "50 %", "99 %", "max", "more"
        ))?;
        for window in &measured.windows {
            self.0.line(&trips(window))?;
        }
        self.0.line("")?;
        self.0.line(&format!(
            "{:<17}{:>12}{:>18}{:>9}",
            "reads a second", "reached", "the line alone", "share"
        ))?;
        for window in &measured.windows {
            self.0.line(&rate(window))?;
        }
        Ok(())
    }

    fn errors(&mut self, measured: &Measured) -> anyhow::Result<()> {
        let stats = &measured.stats;
        self.row(
            "errors",
            &format!(
                "of {} requests: {} without reply, {} wrong checksums, {} times noise, {} foreign replies, {} foreign requests, {} refused",
                measured.requests(),
                stats.timeouts,
                stats.checksum_errors,
                stats.resyncs,
                stats.foreign_replies,
                stats.foreign_requests,
                stats.refusals
            ),
        )
    }

    fn verdict(&mut self, found: &[Finding]) -> anyhow::Result<()> {
        self.0.line("")?;
        for finding in found {
            let caption = if finding.is_wrong { "WRONG" } else { "note" };
            self.row(caption, &finding.what)?;
            if !finding.advice.is_empty() {
                self.row("", &finding.advice)?;
            }
        }
        if found.iter().any(|finding| finding.is_wrong) {
            return Ok(());
        }
        self.row("verdict", "all is well")
    }
}

fn adapter(usb: &UsbFound) -> String {
    let mut words: Vec<String> = [&usb.maker, &usb.product]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    words.push(format!("{:04x}:{:04x}", usb.vendor_id, usb.product_id));
    if let Some(serial) = &usb.serial {
        words.push(format!("serial number {serial}"));
    }
    if let Some(location) = &usb.location {
        words.push(format!("at {location}"));
    }
    words.join(" ")
}

fn trips(window: &Window) -> String {
    let at = |percent| {
        window
            .percentile(percent)
            .map_or_else(|| "-".into(), millis)
    };
    let counts: String = window
        .histogram()
        .iter()
        .map(|count| format!("{count:>6}"))
        .collect();
    format!(
        "{:<17}{:>5}{:>8}{:>8}{:>8}{:>8}{:>8} |{counts}",
        window.name,
        window.span.len,
        window.reads(),
        at(0),
        at(50),
        at(99),
        at(100)
    )
}

fn rate(window: &Window) -> String {
    let hz = |value: Option<f64>| value.map_or_else(|| "-".into(), |hz| format!("{hz:.1}"));
    let share = window
        .hz()
        .zip(window.line_hz())
        .map(|(hz, line)| hz / line);
    let share = match share {
        // No real line: a pseudo-terminal takes no time.
        Some(share) if share > 1.0 => "> 100 %".into(),
        Some(share) => format!("{:.0} %", 100.0 * share),
        None => "-".into(),
    };
    format!(
        "{:<17}{:>12}{:>18}{share:>9}",
        window.name,
        hz(window.hz()),
        hz(window.line_hz())
    )
}

fn millis(value: Duration) -> String {
    format!("{:.2}", value.as_secs_f64() * 1000.0)
}
