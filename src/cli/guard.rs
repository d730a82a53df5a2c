//! `guard`: the process that holds a hand if the program that moved it dies. It is started by that program and tied to it by its
//! standard input; users do not start it themselves.

use crate::cli::out::{AlreadyReported, notify};
use crate::cli::session;
use crate::link::guard::holder::MOVES;
use crate::link::{self, Clock, LinkConfig, LinkHandle, PollRates};
use crate::record::Hold;
use crate::transport::{BoxedWire, Dial, Endpoint, SystemDial, TransportError};
use futures::future::BoxFuture;
use std::io::Read;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{Instant, sleep, timeout};

/// Maximum time to reach the hand: its port may be busy, and its socket in use, until the system has cleaned up.
const REACH_TIMEOUT: Duration = Duration::from_secs(5);
/// Maximum time after that until feedback shows rest.
const REST_TIMEOUT: Duration = Duration::from_secs(5);
/// Retry interval for a busy port.
const DIAL_INTERVAL: Duration = Duration::from_millis(10);
/// Retry delay after a hand has closed the connection at once, and the number of such retries; then the delay for a hand that
/// accepts no connection for a while after the last one.
const RETRY_DELAY: Duration = Duration::from_millis(20);
const RETRIES_AT_ONCE: u32 = 25;
const RETRY_DELAY_LATER: Duration = Duration::from_millis(320);
/// Polling interval of the link state.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// Only the joint positions are read.
const MOTION_ONLY: PollRates = PollRates {
    state_hz: 200.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

#[derive(Debug, clap::Args)]
pub(crate) struct GuardArgs {
    /// The hand to hold
    #[arg(long, value_name = "URL")]
    hand: Endpoint,
}

/// Waits for the end of the program that started this one. Returns true if the hand must then be held because that
/// program did not.
pub(crate) fn is_needed() -> bool {
    live_on_the_pipe_alone();
    died_moving(std::io::stdin().lock())
}

/// Detaches from that program's end: blocks signals, and closes all inherited descriptors except the standard streams.
#[cfg(unix)]
fn live_on_the_pipe_alone() {
    // No other thread runs yet. A failure here does not prevent holding.
    let _blocked = nix::sys::signal::SigSet::all().thread_block();
    let open = std::fs::read_dir("/proc/self/fd").into_iter().flatten();
    let inherited: Vec<i32> = open
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok())
        .filter(|descriptor| *descriptor > 2)
        .collect();
    for descriptor in inherited {
        let _closed = nix::unistd::close(descriptor);
    }
}

#[cfg(not(unix))]
fn live_on_the_pipe_alone() {}

/// True if the pipe broke after the last message reported that the hand may move.
fn died_moving(mut pipe: impl Read) -> bool {
    let (mut moves, mut words) = (false, [0; 64]);
    loop {
        match pipe.read(&mut words) {
            Ok(0) => return moves,
            Ok(len) => {
                let last = len.checked_sub(1).and_then(|last| words.get(last));
                moves = last == Some(&MOVES);
            }
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(_broken) => return moves,
        }
    }
}

/// Holds until feedback shows rest, and reports the outcome.
pub(crate) async fn run(args: &GuardArgs) -> anyhow::Result<()> {
    let hand = &args.hand;
    let died = Instant::now();
    let config = LinkConfig {
        endpoint: hand.clone(),
        rates: MOTION_ONLY,
        clock: Clock::start(),
        dial: Arc::new(Insistent(SystemDial)),
        wake: Arc::new(|| ()),
    };
    let (link, _records) = link::open(config, &tokio::runtime::Handle::current());
    let how = match timeout(REACH_TIMEOUT, reached(&link)).await {
        Err(_late) => "could not be reached: switch off its 24 V supply if it moves",
        Ok(()) => match timeout(REST_TIMEOUT, held(&link)).await {
            Err(_late) => session::NOT_CONFIRMED,
            Ok(()) => {
                let ms = died.elapsed().as_millis();
                notify(&format!(
                    "the program that moved {hand} terminated unexpectedly; the hand was stopped and at rest {ms} ms later"
                ));
                return Ok(());
            }
        },
    };
    notify(&format!(
        "the program that moved {hand} terminated unexpectedly, and the hand: {how}"
    ));
    Err(AlreadyReported.into())
}

/// Waits until the hand answers. The stop is repeated: one sent before the hand answers is not retained.
async fn reached(link: &LinkHandle) {
    loop {
        link.stop();
        let status = link.status();
        if status.state.is_live() && status.hold != Hold::None {
            return;
        }
        sleep(POLL_INTERVAL).await;
    }
}

/// Waits until feedback shows rest. If the link was lost meanwhile, the stop is repeated.
async fn held(link: &LinkHandle) {
    loop {
        match link.status().hold {
            Hold::Confirmed { .. } => return,
            Hold::Asked { .. } | Hold::Alarm { .. } => {}
            Hold::None => drop(link.stop()),
        }
        sleep(POLL_INTERVAL).await;
    }
}

/// Redials a busy port at once; the link itself would wait.
struct Insistent(SystemDial);

impl Dial for Insistent {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let (system, endpoint) = (self.0, endpoint.clone());
        let until = Instant::now() + REACH_TIMEOUT;
        Box::pin(async move {
            loop {
                match system.dial(&endpoint).await {
                    Err(_) if Instant::now() < until => sleep(DIAL_INTERVAL).await,
                    dialled => return dialled,
                }
            }
        })
    }

    fn retry_delay(&self, attempt: u32) -> Option<Duration> {
        Some(if attempt <= RETRIES_AT_ONCE {
            RETRY_DELAY
        } else {
            RETRY_DELAY_LATER
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::guard::holder::RESTS;

    #[test]
    fn only_a_pipe_that_breaks_while_the_hand_may_move_is_a_death() {
        for (bytes, died) in [
            (vec![], false),
            (vec![MOVES], true),
            (vec![MOVES, RESTS], false),
            (vec![MOVES, RESTS, MOVES], true),
            ([MOVES, RESTS].repeat(100), false),
        ] {
            assert_eq!(died_moving(bytes.as_slice()), died, "{bytes:?}");
        }
    }
}
