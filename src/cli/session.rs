//! The link of a terminal command: opening, the wait for a hand that answers, and warnings of heat.

use crate::app::connect::SimDial;
use crate::app::files::settings_file;
use crate::checkup::{free_file, newtons_file};
use crate::cli::out::failure::FailureKind;
use crate::cli::out::{AlreadyReported, ReaderGone, notify};
use crate::hand::PerDof;
use crate::hand::gap::SizeBlocks;
use crate::hand::grip::GripEstimator;
use crate::hand::heat::HOT;
use crate::link::{
    self, Clock, LinkConfig, LinkHandle, LinkObserver, LinkStatus, LinkTrouble, PollRates, Records,
    Stop,
};
use crate::motion::drive::{STOP_LOST, stop_words};
use crate::motion::program::Ended;
use crate::record::{Abort, Disarmed, LinkState};
use crate::transport::Endpoint;
use anyhow::bail;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// Maximum time until a hand answers; after it the user gets an explanation.
pub(crate) const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum time while a hand is being identified: its connection may be slow.
const IDENTIFY_TIMEOUT: Duration = Duration::from_secs(6);
/// Polling interval of the wait.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// Pause between closing a port and reopening it.
pub(crate) const PORT_RESTS: Duration = Duration::from_millis(300);

/// Message if feedback does not show that a stopped hand rests, or has ceased.
pub(crate) const NOT_CONFIRMED: &str =
    "STOP NOT CONFIRMED: the hand may still move; switch off its 24 V supply";

/// Disables polling: the line is reserved for the requests of a command.
pub(crate) const ONLY_WHAT_IS_ASKED: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

/// Grip estimator of a hand, with its stored free motion. An unreadable file counts as missing.
pub(crate) fn grip_estimator(hand: &Endpoint) -> GripEstimator {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| free_file::file_of(&settings, hand));
    let known = file.and_then(|file| free_file::read(&file).ok());
    GripEstimator::knowing(known.unwrap_or_default())
}

/// Blocks that the window measured with this hand, from its settings, which stay unchanged.
pub(crate) fn size_blocks(hand: &Endpoint) -> SizeBlocks {
    let known = settings_file::default_path().and_then(|path| settings_file::peek(&path));
    known.map_or_else(SizeBlocks::default, |known| known.size_blocks(Some(hand)))
}

/// Newtons of a gram of each joint of a hand; `None` where they were not measured. An unreadable file counts as missing.
pub(crate) fn newtons_per_g(hand: &Endpoint) -> PerDof<Option<f64>> {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| newtons_file::file_of(&settings, hand));
    let known = file.and_then(|file| newtons_file::read(&file).ok());
    known.unwrap_or_default().per_g()
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

/// The same, with all records from the start.
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

/// Warns of a warm drive while the hand may move, and reports a stop because of heat: once per arming each.
async fn warn_of_heat(observer: LinkObserver) {
    let mut status = observer.status;
    let mut reported = HeatStatus::Unarmed;
    while status.changed().await.is_ok() {
        let seen = status.borrow_and_update().clone();
        let level = HeatStatus::of(&seen);
        if let Some(words) = level.words(&seen).filter(|_| level > reported) {
            notify(&words);
        }
        reported = match level {
            HeatStatus::Unarmed => level,
            // The hand has been armed again since.
            level if reported == HeatStatus::Stopped => level,
            level => level.max(reported),
        };
    }
}

/// Reportable heat of the drives, in order of severity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum HeatStatus {
    Unarmed,
    Cool,
    Warm,
    Stopped,
}

impl HeatStatus {
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

/// Name of an early end, as in JSON.
pub(crate) const fn early_end(why: Abort) -> &'static str {
    match why {
        Abort::Person => "person",
        Abort::OtherController { .. } | Abort::TakenOver => "taken_over",
        Abort::Fault { .. } => "fault",
        Abort::LinkLost => "link_lost",
        // The other reasons disarm, or occur only in trials.
        _ => "disarmed",
    }
}

/// Waits until the hand answers. The error gives the reason if it does not.
pub(crate) async fn answered(link: &LinkHandle, endpoint: &Endpoint) -> anyhow::Result<()> {
    let begun = Instant::now();
    loop {
        let status = link.status();
        if status.state.is_live() {
            return Ok(());
        }
        if let Some(trouble) = status.trouble {
            return Err(FailureKind::NoHand.error(no_hand(endpoint, &trouble)));
        }
        if begun.elapsed() >= patience(&status) {
            return Err(FailureKind::NoHand.error(unanswered(endpoint)));
        }
        sleep(POLL_INTERVAL).await;
    }
}

/// Maximum waiting time for a link in this state.
pub(crate) fn patience(status: &LinkStatus) -> Duration {
    match status.state {
        LinkState::Identifying => IDENTIFY_TIMEOUT,
        _ => ANSWER_TIMEOUT,
    }
}

/// Stops the hand at once; awaiting it waits until feedback shows that it rests. If it does not, the error contains advice.
pub(crate) fn stopped(link: &LinkHandle) -> impl Future<Output = anyhow::Result<()>> + use<> {
    let stop = link.stop().into_future();
    async move {
        match stop.await {
            Stop::Confirmed { .. } => Ok(()),
            Stop::NotConfirmed => bail!(NOT_CONFIRMED),
            Stop::LinkLost => Err(FailureKind::LinkLost.error(STOP_LOST)),
        }
    }
}

/// Reason why there is no hand, in one sentence that names it.
pub(crate) fn no_hand(endpoint: &Endpoint, trouble: &LinkTrouble) -> String {
    format!("no hand at {endpoint}: {trouble}")
}

/// Error text if nothing was received in time.
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

/// Reports that the hand was stopped because its output is no longer read, unlike that of a command that only reads. Other errors
/// stay as they are.
pub(crate) fn unread(error: anyhow::Error, stop: Option<Stop>) -> anyhow::Error {
    if !error.is::<ReaderGone>() {
        return error;
    }
    notify(&format!("the output is no longer read{}", stop_words(stop)));
    AlreadyReported.into()
}

/// Passes on whether the result of a program was printed, or that the hand was stopped because it could not be.
pub(crate) fn printed<O>(
    printed: anyhow::Result<()>,
    end: Ended<O>,
    stop: Option<Stop>,
) -> anyhow::Result<()> {
    match end {
        Err(Abort::NotKept) => printed.map_err(|error| unread(error, stop)),
        _ => printed,
    }
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
