//! Reports from the gamepads of this computer, with their receive time.

use crate::hand::Moment;
use crate::inputs::pad::control::kernel_code;
use crate::inputs::pad::facts::PadFacts;
use crate::system::SystemError;
use crate::transport::Remedy;
use std::path::PathBuf;
use std::sync::Arc;

/// Identifies a gamepad from detection to disconnection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PadId(pub u64);

/// New value of a button or an axis, with the kernel's code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KernelEvent {
    /// A button was pressed or released.
    Key {
        /// The kernel's code of the button.
        code: u16,
        /// True if it is down.
        is_down: bool,
    },
    /// An axis moved.
    Axis {
        /// The kernel's code of the axis.
        code: u16,
        /// Position within the range that the device reports.
        value: i32,
    },
}

impl KernelEvent {
    /// The event of a button or axis by its kernel name, such as `BTN_SOUTH` or `ABS_RZ`.
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

/// Clock for the times of reports.
pub type PadClock = Arc<dyn Fn() -> Moment + Send + Sync>;

/// A report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PadReport {
    /// Receive time, by the program's clock.
    pub at: Moment,
    pub news: PadNews,
}

/// Content of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PadNews {
    Found {
        pad: PadId,
        /// Its properties.
        facts: PadFacts,
        /// Present state of its controls.
        now: Vec<KernelEvent>,
    },
    /// A control moved.
    Moved {
        pad: PadId,
        /// New value.
        event: KernelEvent,
    },
    /// A control may have moved, as events of its gamepad were dropped: it counts only as a stop.
    Doubtful {
        pad: PadId,
        /// Possible new value.
        event: KernelEvent,
    },
    /// The kernel dropped events: controls held before do not count.
    Lost {
        pad: PadId,
        /// Present state of its controls.
        now: Vec<KernelEvent>,
    },
    /// It is still connected. Sent regularly, since a held control sends no events.
    Alive(PadId),
    /// It was unplugged or switched off.
    Gone(PadId),
    /// Reason why none is found.
    Trouble(PadTrouble),
}

/// Reason why no gamepad is found.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PadTrouble {
    /// Gamepads are not supported on this system.
    #[error(
        "gamepads are read on Linux only: here another program can read one, and send what 'handscope help stream' describes"
    )]
    LinuxOnly,
    /// The device folder cannot be listed.
    #[error("cannot look for gamepads: {} cannot be listed: {why}", folder.display())]
    NoFolder {
        folder: PathBuf,
        /// The system's error.
        why: SystemError,
    },
    /// The user may not open devices that may be gamepads.
    #[error(
        "no gamepad can be read: {} may not be opened{}; {remedy}",
        path.display(),
        others(*.count)
    )]
    MayNotOpen {
        /// The first of them.
        path: PathBuf,
        /// Number of such devices.
        count: usize,
        /// Step that allows the user to open it.
        remedy: Remedy,
    },
    /// The reader thread could not be started.
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
