//! What comes from the gamepads of this computer, with the time at which it came in.

use crate::hand::Moment;
use crate::inputs::pad::control::kernel_code;
use crate::inputs::pad::facts::PadFacts;
use crate::system::SystemError;
use crate::transport::Remedy;
use std::path::PathBuf;
use std::sync::Arc;

/// A gamepad from when it is found until it is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PadId(pub u64);

/// A button or an axis has a new value, in the kernel's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KernelEvent {
    /// A button is down or up.
    Key {
        /// The kernel's number of the button.
        code: u16,
        /// Whether it is down.
        is_down: bool,
    },
    /// An axis moved.
    Axis {
        /// The kernel's number of the axis.
        code: u16,
        /// Where it is, between the ends that the device names.
        value: i32,
    },
}

impl KernelEvent {
    /// The event of a button or axis by its name in the kernel, such as `BTN_SOUTH` or `ABS_RZ`.
    pub fn named(name: &str, value: i32) -> Option<Self> {
        let code = kernel_code(name)?;
        Some(if name.starts_with("BTN_") {
            Self::Key {
                code,
                is_down: value != 0,
            }
        } else {
            Self::Axis { code, value }
        })
    }
}

/// What tells the time of a report.
pub type PadClock = Arc<dyn Fn() -> Moment + Send + Sync>;

/// What happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadReport {
    /// When it came in, by the program's clock.
    pub at: Moment,
    pub news: PadNews,
}

/// What happened at the gamepads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PadNews {
    Found {
        pad: PadId,
        /// What it says of itself.
        facts: PadFacts,
        /// Where its controls are.
        now: Vec<KernelEvent>,
    },
    /// A control moved.
    Moved {
        pad: PadId,
        /// What it did.
        event: KernelEvent,
    },
    /// A control is said to have moved, while events of its gamepad were dropped: it counts for nothing but a stop.
    Doubtful {
        pad: PadId,
        /// What it may have done.
        event: KernelEvent,
    },
    /// The kernel dropped events of one: nothing that was held before counts.
    Lost {
        pad: PadId,
        /// Where its controls are.
        now: Vec<KernelEvent>,
    },
    /// It is still there. Comes all the time, since a control that is held says nothing more.
    Alive(PadId),
    /// It was unplugged or switched off.
    Gone(PadId),
    /// Why none is found.
    Trouble(PadTrouble),
}

/// Why no gamepad is found.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PadTrouble {
    /// This system's gamepads are not read.
    #[error(
        "gamepads are read on Linux only: here another program can read one, and send what 'handscope help stream' describes"
    )]
    LinuxOnly,
    /// The folder of the devices cannot be listed.
    #[error("no gamepad can be looked for: {} cannot be listed: {why}", folder.display())]
    NoFolder {
        folder: PathBuf,
        /// What the system says.
        why: SystemError,
    },
    /// Devices that might be gamepads may not be opened.
    #[error(
        "no gamepad can be read: {} may not be opened{}; {remedy}",
        path.display(),
        others(*.count)
    )]
    MayNotOpen {
        /// The first of them.
        path: PathBuf,
        /// How many there are.
        count: usize,
        /// What lets the user open it.
        remedy: Remedy,
    },
    /// The thread that reads them did not start.
    #[error("gamepads cannot be read: {0}")]
    NoThread(SystemError),
}

fn others(count: usize) -> String {
    match count {
        0 | 1 => String::new(),
        2 => ", nor 1 other device".into(),
        more => format!(", nor {} other devices", more.saturating_sub(1)),
    }
}
