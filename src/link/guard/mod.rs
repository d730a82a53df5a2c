//! What stops the hands when this program ends, however it ends: one call tells every open link to hold, and a process of its
//! own holds a hand whose program died. Lists the links of this process, as it ends as a whole.

pub mod holder;

use crate::link::guard::holder::{HolderState, HolderTie};
use crate::link::wanted::PendingControl;
use crate::record::Disarmed;
use crate::transport::Endpoint;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// How often it is looked whether all hands rest.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// The open links of this process.
static OPEN: Mutex<Vec<Weak<MotionGuard>>> = Mutex::new(Vec::new());

/// Whether the hand of one link may move because of this program, and what holds it if that ends.
#[derive(Debug)]
pub(crate) struct MotionGuard {
    wanted: Arc<watch::Sender<PendingControl>>,
    /// Since it was armed it was not seen to rest.
    moves: AtomicBool,
    reaches: AtomicBool,
    tie: Mutex<Option<HolderTie>>,
}

impl MotionGuard {
    /// For a link that opens.
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

    /// The hand is about to be armed at this endpoint. Starts the process that holds it if this one dies, if none runs.
    pub(crate) fn moves(&self, endpoint: &Endpoint) {
        self.moves.store(true, Ordering::Relaxed);
        let mut tie = lock(&self.tie);
        if !tie.as_ref().is_some_and(|tie| tie.moves(endpoint)) {
            *tie = HolderTie::start(endpoint);
        }
    }

    /// How it is about that process; `None` where none is needed.
    pub(crate) fn holder(&self) -> Option<watch::Receiver<HolderState>> {
        lock(&self.tie).as_ref().map(HolderTie::state)
    }

    /// Why there is no such process, if there should be one.
    pub(crate) fn unguarded(&self) -> Option<String> {
        match &*self.holder()?.borrow() {
            HolderState::Missing(why) => Some(why.clone()),
            HolderState::Starting | HolderState::Ready => None,
        }
    }

    /// The hand rests by feedback, or is left in good order: also where its feedback froze and it was told all that can be told.
    pub(crate) fn rests(&self) {
        if self.moves.swap(false, Ordering::Relaxed)
            && let Some(tie) = lock(&self.tie).as_ref()
        {
            tie.rests();
        }
    }

    /// Whether this process can reach the hand now.
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

/// Tells every hand to hold that may move because of this program, before anything else. Waits for nothing.
pub fn hold_all() {
    moving().iter().for_each(|link| link.stop());
}

/// The same, and waits until feedback shows that they rest, or for so long. Not for a thread that links run on.
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
