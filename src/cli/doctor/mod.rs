//! `doctor`: diagnoses a hand and the connection to it, and gives advice. Only reads.

mod checkup;
mod findings;
mod json;
mod text;

use crate::cli::doctor::checkup::{BlockTiming, ConnectionFacts, Examination, LinkMeasurements};
use crate::cli::out::Out;
use crate::cli::parse::seconds;
use crate::cli::session;
use crate::hand::{Span, register};
use crate::link::{Clock, LinkHandle, PollRates, RequestError, Ticks};
use crate::shell::interrupt::Interrupt;
use crate::transport::can_facts::can_facts;
use crate::transport::{Endpoint, Sysfs, port_facts, route};
use anyhow::bail;
use serde_json::Value;
use std::path::Path;
use std::time::Duration;
use tokio::time::{Instant, sleep, sleep_until};

#[derive(Debug, clap::Args)]
pub(crate) struct DoctorArgs {
    /// The hand to examine
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Seconds to measure once it answers
    #[arg(long = "for", value_name = "SECONDS", default_value = "5", value_parser = seconds)]
    pub(crate) length: Duration,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Runs a check-up and prints it. Fails if something is wrong.
pub(crate) async fn run(out: &mut Out, args: &DoctorArgs) -> anyhow::Result<()> {
    let diagnosed = diagnose(&args.hand, args.length).await?;
    out.result(args.json, &diagnosed.object, &diagnosed.lines)?;
    match diagnosed.wrong {
        0 => Ok(()),
        1 => bail!("one thing is wrong with {}", args.hand),
        count => bail!("{count} things are wrong with {}", args.hand),
    }
}

/// A check-up in both forms.
pub(crate) struct Diagnosed {
    pub(crate) object: Value,
    pub(crate) lines: Vec<String>,
    /// Number of problems.
    pub(crate) wrong: usize,
    /// True if the hand answered.
    pub(crate) answers: bool,
}

/// Runs a check-up.
pub(crate) async fn diagnose(hand: &Endpoint, length: Duration) -> anyhow::Result<Diagnosed> {
    let checkup = check(hand, length).await?;
    let found = findings::judge(&checkup);
    Ok(Diagnosed {
        object: json::object(&checkup, &found),
        lines: text::lines(&checkup, &found),
        wrong: found.iter().filter(|finding| finding.is_wrong).count(),
        answers: checkup.answer.is_ok(),
    })
}

/// Besides the measurement, only the setpoints are polled: they show if another controller changes them.
const RATES: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 2.0,
};
/// Pause before the next request if a late reply is possible.
const AMBIGUOUS_WAIT: Duration = Duration::from_millis(50);
/// The fingertips covered by the first of the two reads for all five.
const TIPS: Span = Span::new(register::TOUCH.address, 232);
const LAST_TIP: Span = Span::new(register::TOUCH.address + TIPS.len, 58);

/// Checks the connection, then the hand, until the time is up or the user ends it.
async fn check(hand: &Endpoint, length: Duration) -> anyhow::Result<Examination> {
    let interrupt = Interrupt::listen()?;
    let connection = connection(hand).await;
    Ok(Examination {
        answer: answer(hand, length, interrupt).await,
        endpoint: hand.clone(),
        connection,
    })
}

async fn connection(endpoint: &Endpoint) -> ConnectionFacts {
    if let Some(port) = endpoint.port() {
        ConnectionFacts::Port(port_facts(port, &Sysfs::default()))
    } else if let Some((host, port)) = endpoint.host() {
        // A name that cannot be resolved is reported with its reason when it is dialled.
        ConnectionFacts::Net(route(host, port).await.ok())
    } else if let Some(interface) = endpoint.interface() {
        ConnectionFacts::Can(can_facts(interface, Path::new("/sys")))
    } else {
        ConnectionFacts::BuiltIn
    }
}

async fn answer(
    hand: &Endpoint,
    length: Duration,
    mut interrupt: Interrupt,
) -> Result<LinkMeasurements, String> {
    let begun = Instant::now();
    let link = session::open(hand, RATES, Clock::start());
    let answered = session::answered(&link, hand);
    tokio::select! {
        biased;
        () = interrupt.wished() => return Err("ended before the hand answered".into()),
        answered = answered => answered.map_err(|error| error.to_string())?,
    }
    let answered_after = begun.elapsed();
    let mut reader = BlockReader::new(hand);
    let until = Instant::now() + length;
    tokio::select! {
        biased;
        () = interrupt.wished() => {}
        () = sleep_until(until) => {}
        () = reader.send_requests(&link) => {}
    }
    let status = link.status();
    let lost = session::trouble(&status).map(ToString::to_string);
    Ok(LinkMeasurements {
        answered_after,
        lost: lost.or_else(|| reader.is_lost.then(|| "the link was lost".into())),
        stats: link.stats(),
        status,
        windows: reader.windows,
        ticks_seen: reader.ticks.are_seen(),
    })
}

/// Reads the blocks in turn, one request at a time.
struct BlockReader {
    windows: Vec<BlockTiming>,
    ticks: Ticks,
    is_lost: bool,
}

impl BlockReader {
    fn new(endpoint: &Endpoint) -> Self {
        let windows = [
            ("angles", register::ANGLE_ACT.span()),
            ("set-points", register::SETPOINTS),
            ("motion state", register::STATE),
            ("four fingertips", TIPS),
            ("one fingertip", LAST_TIP),
        ];
        Self {
            windows: windows
                .map(|(name, span)| BlockTiming::new(name, span, endpoint))
                .into(),
            ticks: Ticks::default(),
            is_lost: false,
        }
    }

    /// Sends requests until the link is lost.
    async fn send_requests(&mut self, link: &LinkHandle) {
        loop {
            for window in &mut self.windows {
                let asked = Instant::now();
                match link.read(window.span).await {
                    Ok(_bytes) => {
                        let trip = asked.elapsed();
                        window.add(trip);
                        self.ticks.record(window.span.len, trip);
                    }
                    Err(RequestError::Refused { .. } | RequestError::WrongLength { .. }) => {
                        window.refused += 1;
                    }
                    Err(RequestError::Ambiguous { .. }) => sleep(AMBIGUOUS_WAIT).await,
                    Err(RequestError::LinkLost | RequestError::NotConnected) => {
                        self.is_lost = true;
                        return;
                    }
                    Err(_) => window.failed += 1,
                }
            }
        }
    }
}
