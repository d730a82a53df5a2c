//! Collects what the system reports and what the hand answers, by reading only.

use crate::cli::doctor::checkup::{Checkup, Measured, Place, Window};
use crate::cli::interrupt::Interrupt;
use crate::cli::session;
use crate::hand::{Span, register};
use crate::link::{Clock, LinkHandle, PollRates, RequestError, Ticks};
use crate::transport::{Endpoint, Sysfs, port_facts, route};
use std::time::Duration;
use tokio::time::{Instant, sleep, sleep_until};

/// Besides what is measured, only the setpoints are read: they show whether someone else changes them.
const RATES: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 2.0,
};
/// Where a late reply is possible, the next request waits this long.
const AMBIGUOUS_WAIT: Duration = Duration::from_millis(50);
/// The fingertips in the first of the two reads that cover all five.
const TIPS: Span = Span::new(register::TOUCH.address, 232);
const LAST_TIP: Span = Span::new(register::TOUCH.address + TIPS.len, 58);

/// Checks the connection, then the hand, until the time is up or a person ends it.
pub(crate) async fn check(hand: &Endpoint, length: Duration) -> anyhow::Result<Checkup> {
    let interrupt = Interrupt::listen()?;
    let place = place(hand).await;
    Ok(Checkup {
        answer: answer(hand, length, interrupt).await,
        endpoint: hand.clone(),
        place,
    })
}

async fn place(endpoint: &Endpoint) -> Place {
    match endpoint {
        Endpoint::Sim { .. } => Place::BuiltIn,
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
            Place::Port(port_facts(&line.port, &Sysfs::default()))
        }
        Endpoint::Slcan { port, .. } | Endpoint::UsbCan { port, .. } => {
            Place::Port(port_facts(port, &Sysfs::default()))
        }
        // A name that cannot be resolved is told again, with its reason, when it is dialled.
        Endpoint::Tcp { host, port, .. } => Place::Net(route(host, *port).await.ok()),
        #[cfg(target_os = "linux")]
        Endpoint::Can { interface, .. } => Place::Can(crate::transport::can::facts::can_facts(
            interface,
            std::path::Path::new("/sys"),
        )),
        #[cfg(not(target_os = "linux"))]
        Endpoint::Can { .. } => Place::NoCan,
    }
}

async fn answer(
    hand: &Endpoint,
    length: Duration,
    mut interrupt: Interrupt,
) -> Result<Measured, String> {
    let begun = Instant::now();
    let link = session::open(hand, RATES, Clock::start());
    let answered = session::answered(&link, hand);
    tokio::select! {
        biased;
        () = interrupt.wished() => return Err("ended before the hand answered".into()),
        answered = answered => answered.map_err(|error| error.to_string())?,
    }
    let answered_after = begun.elapsed();
    let mut look = Look::new(hand);
    let until = Instant::now() + length;
    tokio::select! {
        biased;
        () = interrupt.wished() => {}
        () = sleep_until(until) => {}
        () = look.ask_on(&link) => {}
    }
    let status = link.status();
    let lost = session::trouble(&status).map(ToString::to_string);
    Ok(Measured {
        answered_after,
        lost: lost.or_else(|| look.is_lost.then(|| "the link was lost".into())),
        stats: link.stats(),
        status,
        windows: look.windows,
        ticks_seen: look.ticks.are_seen(),
    })
}

/// Reads the windows in turn, one request at a time.
struct Look {
    windows: Vec<Window>,
    ticks: Ticks,
    is_lost: bool,
}

impl Look {
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
                .map(|(name, span)| Window::new(name, span, endpoint))
                .into(),
            ticks: Ticks::default(),
            is_lost: false,
        }
    }

    /// Asks until the link is lost.
    async fn ask_on(&mut self, link: &LinkHandle) {
        loop {
            for window in &mut self.windows {
                let asked = Instant::now();
                match link.read(window.span).await {
                    Ok(_bytes) => {
                        let trip = asked.elapsed();
                        window.took(trip);
                        self.ticks.took(window.span.len, trip);
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
