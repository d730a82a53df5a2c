//! The end of the window as the system wants it: a signal holds every hand at once, whether or not the window still answers, and
//! then asks the window to close. One that shows no sign of life is ended with the program.

use crate::hand::Moment;
use crate::link::{Clock, guard};
use crate::shell::interrupt::Interrupt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// So long hands get to rest when the program ends.
pub(crate) const END_TIMEOUT: Duration = Duration::from_secs(1);
/// A window that gives no sign of life for so long is not waited for: the slowest frames take a part of it.
const FREEZE_TIMEOUT: Duration = Duration::from_secs(3);
/// How often it is looked whether the window still lives.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// What the window and whoever ends it from outside know of each other.
#[derive(Debug)]
pub(crate) struct Ending {
    clock: Clock,
    wanted: AtomicBool,
    /// The window has ended, and with it whatever could freeze.
    gone: AtomicBool,
    /// When the window last took in what happened, in microseconds.
    lived_us: AtomicU64,
    window: OnceLock<egui::Context>,
}

impl Ending {
    pub(crate) fn new(clock: Clock) -> Arc<Self> {
        Arc::new(Self {
            clock,
            wanted: AtomicBool::new(false),
            gone: AtomicBool::new(false),
            lived_us: AtomicU64::new(clock.now().micros()),
            window: OnceLock::new(),
        })
    }

    /// This window is to be woken when the program is to end.
    pub(crate) fn wakes(&self, window: &egui::Context) {
        let _set_before = self.window.set(window.clone());
    }

    /// The window lives.
    pub(crate) fn lives(&self, now: Moment) {
        self.lived_us.store(now.micros(), Ordering::Relaxed);
    }

    /// The window has ended by itself.
    pub(crate) fn ended(&self) {
        self.gone.store(true, Ordering::Relaxed);
    }

    /// True if the window is to close, whatever it shows.
    pub(crate) fn is_wanted(&self) -> bool {
        self.wanted.load(Ordering::Relaxed)
    }

    fn want(&self) {
        // From now on it has to show that it lives.
        self.lives(self.clock.now());
        self.wanted.store(true, Ordering::Relaxed);
        if let Some(window) = self.window.get() {
            window.request_repaint();
        }
    }

    fn is_frozen(&self) -> bool {
        let lived = Moment::from_micros(self.lived_us.load(Ordering::Relaxed));
        !self.gone.load(Ordering::Relaxed) && self.clock.now().since(lived) >= FREEZE_TIMEOUT
    }
}

/// Waits for a signal that ends the program, on the thread of the links, which no window keeps waiting.
pub(crate) async fn on_signals(ending: Arc<Ending>) {
    let Ok(mut interrupt) = Interrupt::listen() else {
        return;
    };
    let status = interrupt.status().await;
    guard::hold_all();
    ending.want();
    loop {
        tokio::time::sleep(POLL_INTERVAL).await;
        if ending.is_frozen() {
            // The link task goes on beside this one until all hands rest.
            let held = tokio::task::spawn_blocking(|| guard::hold_all_within(END_TIMEOUT));
            let _held = held.await;
            std::process::exit(status);
        }
    }
}
