//! Serial ports: which there are, and how one is opened. What is said over them is not known here.

use crate::transport::endpoint::SerialLine;
use crate::transport::wire::TransportError;
use std::panic::catch_unwind;
use std::path::Path;
use tokio_serial::{
    ClearBuffer, DataBits, ErrorKind, FlowControl, Parity, SerialPort as _,
    SerialPortBuilderExt as _, SerialPortType, SerialStream, StopBits,
};

/// A USB adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
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
    let mut ports: Vec<_> = listed
        .ok()
        .and_then(Result::ok)
        .unwrap_or_default()
        .into_iter()
        .map(|port| PortFound {
            path: port.port_name,
            usb: match port.port_type {
                SerialPortType::UsbPort(usb) => Some(UsbFound {
                    vendor_id: usb.vid,
                    product_id: usb.pid,
                    serial: usb.serial_number,
                    maker: usb.manufacturer,
                    product: usb.product,
                }),
                _ => None,
            },
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
            PermissionDenied => TransportError::Permission { place: place() },
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
        ErrorKind::Io(PermissionDenied) => TransportError::Permission { place: text() },
        _ if error.description.contains("Inappropriate ioctl")
            || error.description.contains("Not a typewriter") =>
        {
            TransportError::NotAPort { place: text() }
        }
        _ => io_error(place, &error.description),
    }
}

fn io_error(place: &str, message: &str) -> TransportError {
    TransportError::Io {
        place: place.into(),
        message: message.into(),
    }
}

/// Who holds a port.
#[cfg(target_os = "linux")]
mod holder {
    use std::fs;
    use std::path::Path;

    /// Processes looked at, so that a busy machine does not hold up the answer.
    const PROCESSES_MAX: usize = 4096;

    /// Name and id of a process that has this file open, if this person may see it.
    pub(super) fn find(place: &Path) -> Option<String> {
        let real = fs::canonicalize(place).ok()?;
        // The maker of a pseudo-terminal has it open too and is not the one meant.
        if real.starts_with("/dev/pts") {
            return None;
        }
        let process = fs::read_dir("/proc")
            .ok()?
            .flatten()
            .take(PROCESSES_MAX)
            .find(|process| {
                let open = fs::read_dir(process.path().join("fd"));
                open.is_ok_and(|open| {
                    open.flatten()
                        .any(|fd| fs::read_link(fd.path()).is_ok_and(|file| file == real))
                })
            })?;
        let name = fs::read_to_string(process.path().join("comm")).unwrap_or_default();
        let id = process.file_name();
        Some(format!(
            "{} (process {})",
            name.trim(),
            id.to_string_lossy()
        ))
    }
}

#[cfg(not(target_os = "linux"))]
mod holder {
    use std::path::Path;

    pub(super) fn find(_place: &Path) -> Option<String> {
        None
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
            assert_eq!(
                of(denied, "Permission denied"),
                TransportError::Permission { place: place() }
            );
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
