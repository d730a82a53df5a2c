//! Shutdown by signal: a signal holds every hand at once, whether or not the window still responds, and then asks the window to
//! close. A frozen window is ended with the program.

use crate::hand::Moment;
use crate::link::{Clock, guard};
use crate::shell::interrupt::Interrupt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Time for the hands to come to rest when the program ends.
pub(crate) const END_TIMEOUT: Duration = Duration::from_secs(1);
/// Time without activity after which a window counts as frozen; well above the slowest frames.
const FREEZE_TIMEOUT: Duration = Duration::from_secs(3);
/// Interval of the checks for a frozen window.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// State shared between the window and the signal task.
#[derive(Debug)]
pub(crate) struct ShutdownState {
    clock: Clock,
    wanted: AtomicBool,
    /// True after the window has ended; it can no longer freeze.
    gone: AtomicBool,
    /// Time of the window's last activity, in microseconds.
    lived_us: AtomicU64,
    window: OnceLock<egui::Context>,
}

impl ShutdownState {
    pub(crate) fn new(clock: Clock) -> Arc<Self> {
        Arc::new(Self {
            clock,
            wanted: AtomicBool::new(false),
            gone: AtomicBool::new(false),
            lived_us: AtomicU64::new(clock.now().micros()),
            window: OnceLock::new(),
        })
    }

    /// Registers the window to wake when the program has to end.
    pub(crate) fn wakes(&self, window: &egui::Context) {
        let _set_before = self.window.set(window.clone());
    }

    /// Records activity of the window.
    pub(crate) fn lives(&self, now: Moment) {
        self.lived_us.store(now.micros(), Ordering::Relaxed);
    }

    /// Records that the window has ended by itself.
    pub(crate) fn ended(&self) {
        self.gone.store(true, Ordering::Relaxed);
    }

    /// True if the window must close, regardless of its state.
    pub(crate) fn is_wanted(&self) -> bool {
        self.wanted.load(Ordering::Relaxed)
    }

    fn request_end(&self) {
        // From now on the window has to show activity.
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

/// Waits for a signal that ends the program, on the links' runtime, which the window cannot block.
pub(crate) async fn on_signals(ending: Arc<ShutdownState>) {
    let Ok(mut interrupt) = Interrupt::listen() else {
        return;
    };
    let status = interrupt.status().await;
    guard::hold_all();
    ending.request_end();
    loop {
        tokio::time::sleep(POLL_INTERVAL).await;
        if ending.is_frozen() {
            // Meanwhile the link task continues until all hands rest.
            let held = tokio::task::spawn_blocking(|| guard::hold_all_within(END_TIMEOUT));
            let _held = held.await;
            std::process::exit(status);
        }
    }
}
