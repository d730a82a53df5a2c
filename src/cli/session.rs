//! A link for a terminal command: its clock, the wait for a hand that answers, and warnings of heat.

use crate::app::connect::SimDial;
use crate::app::files::settings_file;
use crate::checkup::free_file;
use crate::cli::out::say;
use crate::hand::grip::GripEstimator;
use crate::hand::heat::HOT;
use crate::link::{
    self, Clock, LinkConfig, LinkHandle, LinkObserver, LinkStatus, LinkTrouble, PollRates, Records,
    Stop,
};
use crate::record::{Disarmed, LinkState};
use crate::tasks::drive::STOP_LOST;
use crate::transport::Endpoint;
use anyhow::bail;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// A hand that is there answers long before; after this the user is told why nothing comes.
pub(crate) const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);
/// While something answers and is being identified, the wait lasts this long: a way to a hand may be slow.
const IDENTIFY_TIMEOUT: Duration = Duration::from_secs(6);
/// How often the wait checks.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// What is told where feedback does not show that a stopped hand rests, and where none comes any more.
pub(crate) const NOT_CONFIRMED: &str =
    "STOP NOT CONFIRMED: the hand may still move; switch off its 24 V supply";

/// A link that asks for nothing by itself: the line belongs to what a command asks.
pub(crate) const ONLY_WHAT_IS_ASKED: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

/// What tells the grip of a hand, with what is kept of its free motion. A file that cannot be read is as none.
pub(crate) fn grip_estimator(hand: &Endpoint) -> GripEstimator {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| free_file::file_of(&settings, hand));
    let known = file.and_then(|file| free_file::read(&file).ok());
    GripEstimator::knowing(known.unwrap_or_default())
}

/// Opens a link and waits for the hand. Must be called within a tokio runtime.
pub(crate) async fn reach(hand: &Endpoint, rates: PollRates) -> anyhow::Result<LinkHandle> {
    let link = open(hand, rates, Clock::start());
    answered(&link, hand).await?;
    Ok(link)
}

/// Opens a link. Must be called within a tokio runtime; reads only.
pub(crate) fn open(endpoint: &Endpoint, rates: PollRates, clock: Clock) -> LinkHandle {
    open_with_records(endpoint, rates, clock).0
}

/// The same, with everything that happens from the first moment on.
pub(crate) fn open_with_records(
    endpoint: &Endpoint,
    rates: PollRates,
    clock: Clock,
) -> (LinkHandle, Records) {
    let config = LinkConfig {
        endpoint: endpoint.clone(),
        rates,
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let runtime = tokio::runtime::Handle::current();
    let (link, records) = link::open(config, &runtime);
    runtime.spawn(warn_of_heat(link.observe()));
    (link, records)
}

/// Warns of a drive that is warm while the hand may move, and says where heat stopped it: each once for an arming.
async fn warn_of_heat(observer: LinkObserver) {
    let mut status = observer.status;
    let mut reported = HeatLevel::Unarmed;
    while status.changed().await.is_ok() {
        let seen = status.borrow_and_update().clone();
        let level = HeatLevel::of(&seen);
        if let Some(words) = level.words(&seen).filter(|_| level > reported) {
            say(&words);
        }
        reported = match level {
            HeatLevel::Unarmed => level,
            // It was armed again since.
            level if reported == HeatLevel::Stopped => level,
            level => level.max(reported),
        };
    }
}

/// What there is to report of the drives' heat, the gravest last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum HeatLevel {
    Unarmed,
    Cool,
    Warm,
    Stopped,
}

impl HeatLevel {
    fn of(status: &LinkStatus) -> Self {
        let is_ended = matches!(status.disarmed, Some(Disarmed::Hot | Disarmed::HeatUnknown));
        match status.armed {
            Some(_) if status.heat.is_some() => Self::Warm,
            Some(_) => Self::Cool,
            None if is_ended => Self::Stopped,
            None => Self::Unarmed,
        }
    }

    fn words(self, status: &LinkStatus) -> Option<String> {
        let heat = status.heat.map(|heat| heat.to_string());
        match self {
            Self::Unarmed | Self::Cool => None,
            Self::Warm => Some(format!(
                "warning: {}; from {HOT} °C on the hand is stopped",
                heat?
            )),
            Self::Stopped => {
                let heat = heat.or_else(|| Some(status.disarmed?.to_string()));
                Some(format!("{}: the hand is stopped", heat?))
            }
        }
    }
}

/// Waits until the hand answers. The error says why it does not.
pub(crate) async fn answered(link: &LinkHandle, endpoint: &Endpoint) -> anyhow::Result<()> {
    let begun = Instant::now();
    loop {
        let status = link.status();
        if status.state.is_live() {
            return Ok(());
        }
        if let Some(trouble) = status.trouble {
            bail!(no_hand(endpoint, &trouble));
        }
        if begun.elapsed() >= patience(&status) {
            bail!(unanswered(endpoint));
        }
        sleep(POLL_INTERVAL).await;
    }
}

/// How long a link in this state is waited for.
pub(crate) fn patience(status: &LinkStatus) -> Duration {
    match status.state {
        LinkState::Identifying => IDENTIFY_TIMEOUT,
        _ => ANSWER_TIMEOUT,
    }
}

/// Stops the hand, and waits until feedback shows that it rests. The error says what to do where it does not.
pub(crate) async fn stopped(link: &LinkHandle) -> anyhow::Result<()> {
    match link.stop().await {
        Stop::Confirmed { .. } => Ok(()),
        Stop::NotConfirmed => bail!(NOT_CONFIRMED),
        Stop::LinkLost => bail!(STOP_LOST),
    }
}

/// Why there is no hand, in one sentence that names it.
pub(crate) fn no_hand(endpoint: &Endpoint, trouble: &LinkTrouble) -> String {
    format!("no hand at {endpoint}: {trouble}")
}

/// The message where nothing at all was heard in time.
pub(crate) fn unanswered(endpoint: &Endpoint) -> String {
    format!(
        "no hand at {endpoint}: nothing came within {} s; check power, cable, address and id",
        ANSWER_TIMEOUT.as_secs()
    )
}

/// The trouble of a link that is not live.
pub(crate) fn trouble(status: &LinkStatus) -> Option<&LinkTrouble> {
    status.trouble.as_ref().filter(|_| !status.state.is_live())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::tcp::CONNECT_DEADLINE;

    #[test]
    fn the_cause_is_known_before_the_wait_is_over_and_the_wait_is_three_seconds() {
        // Three requests of a tenth of a second each, and the line's rest between them.
        let asked = Duration::from_millis(3 * (100 + 60));
        assert!(CONNECT_DEADLINE + asked < ANSWER_TIMEOUT);
        assert!(ANSWER_TIMEOUT <= Duration::from_secs(3));
    }
}
