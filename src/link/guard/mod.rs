//! Stops the hands when this program ends, in any way: one call requests a hold on every open link, and a separate
//! process holds a hand whose program died. Lists the links of this process, because it ends as a whole.

pub mod holder;

use crate::link::guard::holder::{HolderState, HolderTie};
use crate::link::wanted::PendingControl;
use crate::record::Disarmed;
use crate::transport::Endpoint;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// Interval at which the rest of all hands is checked.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// The open links of this process.
static OPEN: Mutex<Vec<Weak<MotionGuard>>> = Mutex::new(Vec::new());

/// Records whether the hand of one link may move because of this program, and owns the holder process.
#[derive(Debug)]
pub(crate) struct MotionGuard {
    wanted: Arc<watch::Sender<PendingControl>>,
    /// True since it was armed, until it was seen at rest.
    moves: AtomicBool,
    reaches: AtomicBool,
    tie: Mutex<Option<HolderTie>>,
}

impl MotionGuard {
    /// Registers a link that opens.
    pub(crate) fn enter(wanted: Arc<watch::Sender<PendingControl>>) -> Arc<Self> {
        let guard = Arc::new(Self {
            wanted,
            moves: AtomicBool::new(false),
            reaches: AtomicBool::new(false),
            tie: Mutex::default(),
        });
        let mut open = lock(&OPEN);
        open.retain(|link| link.strong_count() > 0);
        open.push(Arc::downgrade(&guard));
        guard
    }

    /// Called before the hand is armed at this endpoint. Starts the process that holds it if this one dies, if none runs.
    pub(crate) fn moves(&self, endpoint: &Endpoint) {
        self.moves.store(true, Ordering::Relaxed);
        let mut tie = lock(&self.tie);
        if !tie.as_ref().is_some_and(|tie| tie.moves(endpoint)) {
            *tie = HolderTie::start(endpoint);
        }
    }

    /// State of that process; `None` if none is needed.
    pub(crate) fn holder(&self) -> Option<watch::Receiver<HolderState>> {
        lock(&self.tie).as_ref().map(HolderTie::state)
    }

    /// Reason why there is no such process, if there should be one.
    pub(crate) fn unguarded(&self) -> Option<String> {
        match &*self.holder()?.borrow() {
            HolderState::Missing(why) => Some(why.clone()),
            HolderState::Starting | HolderState::Ready => None,
        }
    }

    /// Records that the hand rests by feedback, or was left in good order: also if its feedback froze and every
    /// possible hold was sent.
    pub(crate) fn rests(&self) {
        if self.moves.swap(false, Ordering::Relaxed)
            && let Some(tie) = lock(&self.tie).as_ref()
        {
            tie.rests();
        }
    }

    /// Sets whether this process can reach the hand now.
    pub(crate) fn reaches(&self, reaches: bool) {
        self.reaches.store(reaches, Ordering::Relaxed);
    }

    fn may_move(&self) -> bool {
        self.moves.load(Ordering::Relaxed) && self.reaches.load(Ordering::Relaxed)
    }

    fn stop(&self) {
        let why = Disarmed::Stop;
        self.wanted.send_modify(|wanted| {
            wanted.stop(why);
            wanted.book.end(why);
        });
    }
}

/// Requests a hold of every hand that may move because of this program, before anything else. Does not wait.
pub fn hold_all() {
    moving().iter().for_each(|link| link.stop());
}

/// The same, and waits until feedback shows that they rest, at most for `time`. Must not be called on a thread that
/// links run on.
pub fn hold_all_within(time: Duration) {
    let until = Instant::now() + time;
    hold_all();
    while !moving().is_empty() && Instant::now() < until {
        std::thread::sleep(POLL_INTERVAL);
    }
}

fn moving() -> Vec<Arc<MotionGuard>> {
    let open: Vec<_> = lock(&OPEN).iter().filter_map(Weak::upgrade).collect();
    open.into_iter().filter(|link| link.may_move()).collect()
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
