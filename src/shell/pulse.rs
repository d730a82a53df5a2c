//! Lets a series of trials go on whether the window is drawn or not. Systems keep frames back from windows that nobody
//! sees, for 100 to 250 ms at a time; a limit must not wait for that. Draws nothing.

use crate::link::{Clock, Wake};
use crate::shell::Cockpit;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use tokio::sync::Notify;

/// The program and its window, for the thread that draws and the one of the links.
pub type Shared = Arc<Mutex<Cockpit>>;

/// Takes hold of it. Whoever broke off in the middle left a program that still has to hold a hand: it goes on.
pub fn hold(cockpit: &Mutex<Cockpit>) -> MutexGuard<'_, Cockpit> {
    cockpit.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a link calls when something happened: the window is woken, and so is what runs off it.
#[derive(Debug, Clone, Default)]
pub struct Pulse(Arc<Notify>);

impl Pulse {
    /// A pulse that nothing follows yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A wake that also does this.
    #[must_use]
    pub fn wake(&self, window: impl Fn() + Send + Sync + 'static) -> Wake {
        let notify = Arc::clone(&self.0);
        Arc::new(move || {
            window();
            notify.notify_one();
        })
    }

    /// While a series runs, takes in what happened as soon as it did, until the program is gone. To be spawned on the
    /// thread of the links. While a frame is drawn there is nothing to do: it took everything in itself, and what came
    /// since is looked at with the next reply.
    pub fn follow(
        &self,
        cockpit: &Shared,
        clock: Clock,
    ) -> impl Future<Output = ()> + Send + use<> {
        let notify = Arc::clone(&self.0);
        let cockpit = Arc::downgrade(cockpit);
        async move {
            loop {
                notify.notified().await;
                if !beat(&cockpit, clock) {
                    return;
                }
            }
        }
    }
}

/// False once the program is gone.
fn beat(cockpit: &Weak<Mutex<Cockpit>>, clock: Clock) -> bool {
    let Some(cockpit) = cockpit.upgrade() else {
        return false;
    };
    if let Ok(mut cockpit) = cockpit.try_lock()
        && cockpit.state().tuner.is_running()
    {
        cockpit.logic(clock.now());
    }
    true
}
