//! The time that a test lives in.

use tokio::runtime::{Builder, Runtime};

/// Virtual time goes by only while the runtime is waited for, and at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Time {
    Virtual,
    Real,
}

impl Time {
    /// A runtime in which this time goes by.
    pub(crate) fn runtime(self) -> Runtime {
        let mut builder = match self {
            Self::Virtual => Builder::new_current_thread(),
            Self::Real => Builder::new_multi_thread(),
        };
        if self == Self::Virtual {
            builder.start_paused(true);
        }
        builder.worker_threads(1).enable_all().build().unwrap()
    }
}

/// Runs something to its end in virtual time, where a test has many of its kind.
pub(crate) fn in_virtual_time<T>(run: impl Future<Output = T>) -> T {
    let mut builder = Builder::new_current_thread();
    // Time alone: a third of each turn would be a question to the system about sockets that nobody has.
    let runtime = builder.enable_time().start_paused(true).build().unwrap();
    runtime.block_on(run)
}
