//! Shared reads that add no load on the hand: a recent poll of the session serves all clients, and an unpolled range is
//! requested once, at a limited rate, for all who wait.

use crate::hand::Span;
use crate::link::clock::Clock;
use crate::link::handle::LinkHandle;
use crate::link::image::{ImageLookup, RegisterImage};
use crate::link::poll::window::ReadPart;
use crate::link::request::RequestError;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{Mutex, watch};
use tokio::time::{Instant, sleep_until, timeout};

/// Time after which a waiting client gets a timeout.
pub const RECENT_WINDOW: Duration = Duration::from_secs(3);
/// Pause after an extra read, as a multiple of its duration: such reads take 4% of the link's time.
const PAUSE_TIMES: u32 = 24;
/// The shortest such pause after a range that is never polled: however fast the wire is, clients that read scattered
/// ranges cost it a few requests per second.
const PAUSE_MIN: Duration = Duration::from_millis(200);
/// Number of such reads allowed in a burst after an idle time: a program that explores the hand requests a few, each of
/// which takes no longer than the hand does.
const AT_ONCE: u32 = 8;
/// The longest such pause, so that one slow reply does not delay all others.
const PAUSE_MAX: Duration = Duration::from_millis(500);

/// Recent reads of one hand. Copies share their requests.
#[derive(Debug, Clone)]
pub struct RecentReads {
    link: LinkHandle,
    image: watch::Receiver<RegisterImage>,
    clock: Clock,
    /// For parts that the session polls, and for other ranges.
    turns: [Arc<ReadSlot>; 2],
}

/// The turn to send an extra read, and the time of the next if all came evenly.
type ReadSlot = Mutex<Option<Instant>>;

impl RecentReads {
    /// Recent reads of the hand at this link.
    pub fn of(link: &LinkHandle) -> Self {
        Self {
            image: link.image(),
            clock: link.clock(),
            link: link.clone(),
            turns: Default::default(),
        }
    }

    /// Returns memory that is at most one poll period old, or reads it now.
    ///
    /// # Errors
    /// As [`LinkHandle::read`], and [`RequestError::Timeout`] after [`RECENT_WINDOW`].
    pub async fn read(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        let read = timeout(RECENT_WINDOW, self.wait_for(span)).await;
        read.unwrap_or_else(|_late| {
            Err(RequestError::Timeout {
                address: span.address,
                after_ms: u64::try_from(RECENT_WINDOW.as_millis()).unwrap_or(u64::MAX),
            })
        })
    }

    /// The last bytes of a polled range, however old, also of a hand that is lost.
    pub(crate) fn newest(&self, span: Span) -> Option<Vec<u8>> {
        self.image.borrow().newest(span)
    }

    async fn wait_for(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        let since = self.clock.now();
        let mut image = self.image.clone();
        loop {
            let seen = image
                .borrow_and_update()
                .look_up(span, since, self.clock.now());
            match seen {
                ImageLookup::Bytes(bytes) => return Ok(bytes),
                ImageLookup::Failed(error) => return Err(error),
                ImageLookup::Offline => return Err(RequestError::NotConnected),
                ImageLookup::Missing(part) => self.request(part).await?,
                ImageLookup::Soon(until) => {
                    let over = sleep_until(self.clock.instant(until));
                    tokio::select! {
                        biased;
                        changed = image.changed() => changed.map_err(|_gone| RequestError::NotConnected)?,
                        () = over => {}
                    }
                }
            }
        }
    }

    /// Reads from the hand, one range at a time and at a limited rate, unless another client did so meanwhile. The
    /// session stores the reply in the image.
    async fn request(&self, span: Span) -> Result<(), RequestError> {
        let [parts, others] = &self.turns;
        let is_part = ReadPart::ALL.into_iter().any(|part| part.span() == span);
        let (turn, pause_min) = if is_part {
            (parts, Duration::ZERO)
        } else {
            (others, PAUSE_MIN)
        };
        let since = self.clock.now();
        let mut turn = turn.lock().await;
        let ahead = pause_min * (AT_ONCE - 1);
        if let Some(due) = turn.and_then(|next| next.checked_sub(ahead)) {
            sleep_until(due).await;
        }
        let now = self.clock.now();
        if !matches!(
            self.image.borrow().look_up(span, since, now),
            ImageLookup::Missing(_)
        ) {
            return Ok(());
        }
        let asked = Instant::now();
        let read = self.link.read(span).await;
        let pause = asked.elapsed() * PAUSE_TIMES;
        let pause = pause.clamp(pause_min, PAUSE_MAX);
        let now = Instant::now();
        *turn = Some(turn.map_or(now, |next| next.max(now)) + pause);
        read.map(drop)
    }
}
