//! Gamepads from the kernel's event devices.

use crate::inputs::pad::control::key;
use crate::inputs::pad::facts::{AxisRange, FaceOrder, PadFacts};
use crate::inputs::pad::reader::{DeviceSays, OpenPad, PadDevice};
use crate::inputs::pad::report::KernelEvent;
use evdev::raw_stream::RawDevice;
use evdev::{AbsoluteAxisCode, EventSummary, KeyCode, SynchronizationCode};
use nix::libc::{ENOTTY, O_NONBLOCK};
use std::fs::{OpenOptions, read_link};
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;

/// USB vendor id of Microsoft.
const MICROSOFT: u16 = 0x045e;

/// Opens the event devices of the system.
#[derive(Debug)]
pub(crate) struct SystemPads;

impl OpenPad for SystemPads {
    fn open(&self, path: &Path) -> io::Result<Option<Box<dyn PadDevice>>> {
        let mut options = OpenOptions::new();
        let file = options.read(true).custom_flags(O_NONBLOCK).open(path)?;
        let device = match RawDevice::try_from(file) {
            Ok(device) => device,
            // Another file with such a name.
            Err(error) if error.raw_os_error() == Some(ENOTTY) => return Ok(None),
            Err(error) => return Err(error),
        };
        let keys = device.supported_keys();
        if !keys.is_some_and(|keys| keys.contains(KeyCode(key::SOUTH))) {
            return Ok(None);
        }
        let facts = facts(path, &device)?;
        Ok(Some(Box::new(SystemPad { device, facts })))
    }
}

#[derive(Debug)]
struct SystemPad {
    device: RawDevice,
    facts: PadFacts,
}

impl PadDevice for SystemPad {
    fn facts(&self) -> &PadFacts {
        &self.facts
    }

    fn fd(&self) -> BorrowedFd<'_> {
        self.device.as_fd()
    }

    fn now(&mut self) -> io::Result<Vec<KernelEvent>> {
        let down = self.device.get_key_state()?;
        let keys = down.iter().map(|key| KernelEvent::Key {
            code: key.code(),
            is_down: true,
        });
        let axes = self.device.get_absinfo()?;
        let axes = axes.map(|(axis, info)| KernelEvent::Axis {
            code: axis.0,
            value: info.value(),
        });
        Ok(keys.chain(axes).collect())
    }

    fn read(&mut self) -> io::Result<Vec<DeviceSays>> {
        let events = match self.device.fetch_events() {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(Vec::new()),
            events => events?,
        };
        let events = events.filter_map(|event| match event.destructure() {
            EventSummary::Key(_, key, value) => Some(DeviceSays::Event(KernelEvent::Key {
                code: key.code(),
                is_down: value != 0,
            })),
            EventSummary::AbsoluteAxis(_, axis, value) => {
                let code = axis.0;
                Some(DeviceSays::Event(KernelEvent::Axis { code, value }))
            }
            EventSummary::Synchronization(_, SynchronizationCode::SYN_DROPPED, _) => {
                Some(DeviceSays::Dropped)
            }
            EventSummary::Synchronization(_, SynchronizationCode::SYN_REPORT, _) => {
                Some(DeviceSays::Whole)
            }
            _ => None,
        });
        Ok(events.collect())
    }
}

fn facts(path: &Path, device: &RawDevice) -> io::Result<PadFacts> {
    let range = |(axis, info): (AbsoluteAxisCode, evdev::AbsInfo)| {
        let range = AxisRange {
            min: info.minimum(),
            max: info.maximum(),
            flat: info.flat(),
        };
        (axis.0, range)
    };
    let id = device.input_id();
    let is_by_letter = id.vendor() == MICROSOFT || has_driver(path, "xpad");
    Ok(PadFacts {
        name: device.name().unwrap_or("gamepad").to_owned(),
        path: path.to_owned(),
        vendor: id.vendor(),
        product: id.product(),
        axes: device.get_absinfo()?.map(range).collect(),
        face: if is_by_letter {
            FaceOrder::ByLetter
        } else {
            FaceOrder::ByPlace
        },
    })
}

/// True if this driver serves the device of this file.
fn has_driver(path: &Path, driver: &str) -> bool {
    let Some(name) = path.file_name() else {
        return false;
    };
    let device = Path::new("/sys/class/input").join(name);
    let found = read_link(device.join("device/device/driver"));
    found.is_ok_and(|found| found.ends_with(driver))
}
