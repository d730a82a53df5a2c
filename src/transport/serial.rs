//! Serial ports: which there are, and how one is opened. What is said over them is not known here.

use crate::transport::endpoint::SerialLine;
use crate::transport::holder;
use crate::transport::permission::remedy;
use crate::transport::sysfs::Sysfs;
use crate::transport::wire::TransportError;
use std::panic::catch_unwind;
use std::path::Path;
use tokio_serial::{
    ClearBuffer, DataBits, ErrorKind, FlowControl, Parity, SerialPort as _,
    SerialPortBuilderExt as _, SerialPortType, SerialStream, StopBits,
};

/// A USB adapter.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct UsbFound {
    /// USB vendor id.
    pub vendor_id: u16,
    /// USB product id.
    pub product_id: u16,
    /// Serial number, by which an adapter is known again under another path.
    pub serial: Option<String>,
    /// Maker's name.
    pub maker: Option<String>,
    /// Product's name.
    pub product: Option<String>,
    /// Place on the bus and interface, such as `1-2:1.0`, where the system tells (Linux).
    pub location: Option<String>,
    /// How long it may keep what it got, milliseconds, where its driver tells (Linux).
    pub latency_timer_ms: Option<u16>,
}

/// Vendor and product of USB adapters that bring CAN frames as text: CANable and its likes, CANtact, Lawicel's CANUSB.
const CAN_ADAPTERS: [(u16, u16); 4] = [
    (0x16D0, 0x117E),
    (0xAD50, 0x60C4),
    (0x04D8, 0x000A),
    (0x0403, 0xFFA8),
];
/// What such adapters call themselves.
const CAN_NAMES: [&str; 5] = ["slcan", "canable", "cantact", "canusb", "usbtin"];

impl UsbFound {
    /// True if it looks like an adapter that brings CAN frames as text, not a serial line.
    #[must_use]
    pub fn looks_like_can(&self) -> bool {
        let named = [&self.maker, &self.product].into_iter().flatten();
        let mut named = named.map(|name| name.to_lowercase());
        CAN_ADAPTERS.contains(&(self.vendor_id, self.product_id))
            || named.any(|name| CAN_NAMES.iter().any(|can| name.contains(can)))
    }
}

/// A serial port that the system lists.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortFound {
    /// Path or name.
    pub path: String,
    /// What it is, if it is on USB.
    pub usb: Option<UsbFound>,
}

/// The ports that the system lists, by path; empty if it cannot tell. Pseudo-terminals and some platform ports
/// are never listed, so a path typed by hand must be possible too.
#[must_use]
pub fn ports() -> Vec<PortFound> {
    // serialport panics where /sys is not mounted.
    let listed = catch_unwind(tokio_serial::available_ports);
    let sysfs = Sysfs::default();
    let mut ports: Vec<_> = listed
        .ok()
        .and_then(Result::ok)
        .unwrap_or_default()
        .into_iter()
        .map(|port| PortFound {
            usb: match port.port_type {
                SerialPortType::UsbPort(usb) => Some(UsbFound {
                    vendor_id: usb.vid,
                    product_id: usb.pid,
                    serial: usb.serial_number,
                    maker: usb.manufacturer,
                    product: usb.product,
                    location: sysfs.usb_location(&port.port_name),
                    latency_timer_ms: sysfs.latency_timer_ms(&port.port_name),
                }),
                _ => None,
            },
            path: port.port_name,
        })
        .collect();
    ports.sort_by(|a, b| a.path.cmp(&b.path));
    ports
}

/// Opens a port with 8 data bits, no parity, 1 stop bit (manual 2.2), for this program alone, with old input thrown away.
///
/// The stream passes on what the system says: a read of 0 bytes, `EIO` or `BrokenPipe` means that the adapter was
/// unplugged or the other side hung up, and nothing will come any more. Modem lines are not touched after opening;
/// a port without them opens as well. Must be called within a tokio runtime.
///
/// # Errors
/// `Missing`, `NotAPort`, `Permission`, `Busy`, or `Io` with the system's words.
pub fn open(line: &SerialLine) -> Result<SerialStream, TransportError> {
    let place = line.port.as_str();
    refuse_what_is_no_port(place)?;
    let mut stream = tokio_serial::new(place, line.baud)
        .data_bits(DataBits::Eight)
        .parity(Parity::None)
        .stop_bits(StopBits::One)
        .flow_control(FlowControl::None)
        .open_native_async()
        .map_err(|error| open_error(place, &error))?;
    free_for_reopening(&mut stream, place);
    stream
        .clear(ClearBuffer::Input)
        .map_err(|error| open_error(place, &error))?;
    Ok(stream)
}

#[cfg(unix)]
fn refuse_what_is_no_port(place: &str) -> Result<(), TransportError> {
    use std::io::ErrorKind::{NotFound, PermissionDenied};
    use std::os::unix::fs::FileTypeExt as _;
    let place = || place.to_owned();
    match std::fs::metadata(place()) {
        Ok(found) if found.file_type().is_char_device() => Ok(()),
        Ok(_) => Err(TransportError::NotAPort { place: place() }),
        Err(error) => Err(match error.kind() {
            NotFound => TransportError::Missing { place: place() },
            PermissionDenied => denied(place()),
            _ => io_error(&place(), &error.to_string()),
        }),
    }
}

#[cfg(not(unix))]
fn refuse_what_is_no_port(_place: &str) -> Result<(), TransportError> {
    Ok(())
}

/// A pseudo-terminal stays marked exclusive until its master closes, so that nobody but root could open it a second time:
/// there the mark is taken off again. The file lock stays (as a shared one, which still keeps exclusive openers out).
#[cfg(unix)]
fn free_for_reopening(stream: &mut SerialStream, place: &str) {
    let real = std::fs::canonicalize(place);
    if real.is_ok_and(|path| path.starts_with("/dev/pts")) {
        // The port works all the same if this fails; only a second opening may be refused.
        drop(stream.set_exclusive(false));
    }
}

#[cfg(not(unix))]
fn free_for_reopening(_stream: &mut SerialStream, _place: &str) {}

fn open_error(place: &str, error: &tokio_serial::Error) -> TransportError {
    use std::io::ErrorKind::{NotFound, PermissionDenied};
    let text = || place.to_owned();
    match error.kind {
        // The port was seen to exist, so "no device" means that a lock could not be had.
        ErrorKind::NoDevice if cfg!(unix) || error.description.contains("lock") => {
            TransportError::Busy {
                place: text(),
                holder: holder::find(Path::new(place)),
            }
        }
        ErrorKind::NoDevice | ErrorKind::Io(NotFound) => TransportError::Missing { place: text() },
        // Windows says "access denied" for a port in use.
        ErrorKind::Io(PermissionDenied) if cfg!(windows) => TransportError::Busy {
            place: text(),
            holder: None,
        },
        ErrorKind::Io(PermissionDenied) => denied(text()),
        _ if error.description.contains("Inappropriate ioctl")
            || error.description.contains("Not a typewriter") =>
        {
            TransportError::NotAPort { place: text() }
        }
        _ => io_error(place, &error.description),
    }
}

fn denied(place: String) -> TransportError {
    TransportError::Permission {
        remedy: remedy(&place),
        place,
    }
}

fn io_error(place: &str, message: &str) -> TransportError {
    TransportError::Io {
        place: place.into(),
        message: message.into(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn try_open(port: &Path) -> TransportError {
        let line = SerialLine {
            port: port.to_str().unwrap().into(),
            baud: 115_200,
            id: 1,
            packing: None,
        };
        open(&line).unwrap_err()
    }

    #[cfg(unix)]
    #[tokio::test]
    async fn missing_directory_and_file_have_their_own_words() {
        let dir = tempfile::tempdir().unwrap();
        let place = |path: &Path| path.to_str().unwrap().to_owned();
        let missing = dir.path().join("ttyUSB0");
        assert_eq!(
            try_open(&missing),
            TransportError::Missing {
                place: place(&missing)
            }
        );
        let file = dir.path().join("file");
        std::fs::write(&file, b"x").unwrap();
        for path in [dir.path(), &file, Path::new("/dev/null")] {
            assert_eq!(
                try_open(path),
                TransportError::NotAPort { place: place(path) }
            );
        }
    }

    #[test]
    fn listing_never_fails_and_is_sorted() {
        assert!(ports().is_sorted_by(|a, b| a.path <= b.path));
    }

    #[test]
    fn the_kinds_of_the_system_are_told_apart() {
        let of = |kind, text: &str| open_error("/dev/x", &tokio_serial::Error::new(kind, text));
        let place = || "/dev/x".to_owned();
        let lock = of(
            ErrorKind::NoDevice,
            "Unable to acquire exclusive lock on serial port",
        );
        assert!(matches!(lock, TransportError::Busy { .. }));
        let denied = ErrorKind::Io(std::io::ErrorKind::PermissionDenied);
        if cfg!(unix) {
            let error = of(denied, "Permission denied");
            assert!(matches!(error, TransportError::Permission { .. }));
        }
        assert_eq!(
            of(ErrorKind::Io(std::io::ErrorKind::NotFound), "gone"),
            TransportError::Missing { place: place() }
        );
        assert_eq!(
            of(ErrorKind::Unknown, "Input/output error"),
            io_error("/dev/x", "Input/output error")
        );
    }
}
