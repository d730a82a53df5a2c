//! Reads that many may ask for without asking the hand more often: what the session read just now serves all, and what it
//! does not read by itself is asked for once, seldom, for all who wait.

use crate::hand::Span;
use crate::link::clock::Clock;
use crate::link::handle::LinkHandle;
use crate::link::image::{RegisterImage, Seen};
use crate::link::poll::window::ReadPart;
use crate::link::request::RequestError;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{Mutex, watch};
use tokio::time::{Instant, sleep_until, timeout};

/// Whoever waits so long is told that the hand did not answer.
pub const RECENT_WINDOW: Duration = Duration::from_secs(3);
/// After a read that the session would not have made, so many times its length go by until the next: they take the link
/// 4 of 100 parts of its time.
const PAUSE_TIMES: u32 = 24;
/// The shortest such pause after a stretch that the session never reads: however fast the wire is, clients that read here and there
/// cost it a few requests a second.
const PAUSE_MIN: Duration = Duration::from_millis(200);
/// So many such reads go at once after a while without: a program that gets to know the hand asks for a few, each of which it waits
/// for no longer than a hand takes.
const AT_ONCE: u32 = 8;
/// The longest such pause, so that one slow answer does not keep all others waiting.
const PAUSE_MAX: Duration = Duration::from_millis(500);

/// Recent reads of one hand. Copies share what they ask for.
#[derive(Debug, Clone)]
pub struct RecentReads {
    link: LinkHandle,
    image: watch::Receiver<RegisterImage>,
    clock: Clock,
    /// For parts that the session reads by itself, and for other stretches.
    turns: [Arc<Turn>; 2],
}

/// Who has the turn at asking the hand, and when the next may if all came evenly.
type Turn = Mutex<Option<Instant>>;

impl RecentReads {
    /// Of the hand at this link.
    pub fn of(link: &LinkHandle) -> Self {
        Self {
            image: link.image(),
            clock: link.clock(),
            link: link.clone(),
            turns: Default::default(),
        }
    }

    /// Memory that is not older than the session's reads of it are apart, or that is read now.
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

    /// What was read last of a stretch that the session reads by itself, however old that is, also of a hand that is lost.
    pub(crate) fn newest(&self, span: Span) -> Option<Vec<u8>> {
        self.image.borrow().newest(span)
    }

    async fn wait_for(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        let since = self.clock.now();
        let mut image = self.image.clone();
        loop {
            let seen = image
                .borrow_and_update()
                .look(span, since, self.clock.now());
            match seen {
                Seen::Bytes(bytes) => return Ok(bytes),
                Seen::Failed(error) => return Err(error),
                Seen::Offline => return Err(RequestError::NotConnected),
                Seen::Missing(part) => self.ask(part).await?,
                Seen::Soon(until) => {
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

    /// Asks the hand, one at a time and seldom, unless somebody else did meanwhile. The session puts the answer into the image.
    async fn ask(&self, span: Span) -> Result<(), RequestError> {
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
        if !matches!(self.image.borrow().look(span, since, now), Seen::Missing(_)) {
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
