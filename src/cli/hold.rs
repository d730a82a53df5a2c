//! `hold`: the process that holds a hand if the program that moved it dies. It is started by that program and tied to it by its
//! standard input; nobody starts it by hand.

use crate::cli::out::{AlreadyReported, say};
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

/// So long the hand is tried for: its port may be busy, and its socket taken, until the system has cleared up.
const REACH_TIMEOUT: Duration = Duration::from_secs(5);
/// So long feedback may take to show rest after that.
const REST_TIMEOUT: Duration = Duration::from_secs(5);
/// How often a port that is busy is tried again.
const DIAL_INTERVAL: Duration = Duration::from_millis(10);
/// A hand that closes the connection at once is dialled again after this, so many times; then as seldom as a hand needs that takes
/// no connection for a while after the last one.
const RETRY_DELAY: Duration = Duration::from_millis(20);
const RETRIES_AT_ONCE: u32 = 25;
const RETRY_DELAY_LATER: Duration = Duration::from_millis(320);
/// How often it is looked how far the link is.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// Only where the joints are is read.
const MOTION_ONLY: PollRates = PollRates {
    state_hz: 200.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

#[derive(Debug, clap::Args)]
pub(crate) struct HoldArgs {
    /// The hand to hold
    #[arg(long, value_name = "URL")]
    hand: Endpoint,
}

/// Waits for the end of the program that started this one. True if the hand is to be held then, as that program did not.
pub(crate) fn is_needed() -> bool {
    live_on_the_pipe_alone();
    died_moving(std::io::stdin().lock())
}

/// What ends that program must not end this one: signals do not count, and nothing of it is kept open but standard error.
#[cfg(unix)]
fn live_on_the_pipe_alone() {
    // No other thread runs yet. What cannot be done here was not needed to hold.
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

/// True if the pipe broke after the last word was that the hand may move.
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

/// Holds until feedback shows rest, and says how that went.
pub(crate) async fn run(args: &HoldArgs) -> anyhow::Result<()> {
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
                say(&format!(
                    "the program that moved {hand} ended without a word; the hand was stopped, and rests since {ms} ms after"
                ));
                return Ok(());
            }
        },
    };
    say(&format!(
        "the program that moved {hand} ended without a word, and the hand: {how}"
    ));
    Err(AlreadyReported.into())
}

/// Waits until the hand answers. It is told to stop again and again: what is said before it answers does not last.
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

/// Waits until feedback shows rest. A link that was lost meanwhile begins anew.
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

/// Dials again at once where the port is still busy: the link itself would wait.
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
        for (told, died) in [
            (vec![], false),
            (vec![MOVES], true),
            (vec![MOVES, RESTS], false),
            (vec![MOVES, RESTS, MOVES], true),
            ([MOVES, RESTS].repeat(100), false),
        ] {
            assert_eq!(died_moving(told.as_slice()), died, "{told:?}");
        }
    }
}
