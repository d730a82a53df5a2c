//! Serial ports: lists and opens them. Independent of the protocol.
pub mod adapter;
pub(crate) mod holder;
pub mod port_facts;
pub mod sysfs;
pub mod timer;

use crate::system::SystemError;
use crate::transport::endpoint::SerialLine;

use crate::transport::found::{PortFound, UsbFound};
use crate::transport::permission::remedy;
use crate::transport::serial::sysfs::Sysfs;
use crate::transport::wire::TransportError;
use std::path::Path;
use tokio_serial::{
    ClearBuffer, DataBits, ErrorKind, FlowControl, Parity, SerialPort as _,
    SerialPortBuilderExt as _, SerialPortType, SerialStream, StopBits,
};

/// The ports that the system lists, by path; empty if it cannot. Pseudo-terminals and some platform ports are never
/// listed, so typed paths must be possible too.
pub fn ports() -> Vec<PortFound> {
    ports_by(&Sysfs::default())
}

fn ports_by(sysfs: &Sysfs) -> Vec<PortFound> {
    // On Linux serialport reads that folder, and panics if it cannot.
    if cfg!(target_os = "linux") && !sysfs.has_ports() {
        return Vec::new();
    }
    let mut ports: Vec<_> = tokio_serial::available_ports()
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

/// Opens a port with 8 data bits, no parity, 1 stop bit (manual 2.2), exclusively, and discards old input.
///
/// The stream forwards the system's results: a read of 0 bytes, `EIO` or `BrokenPipe` means that the adapter was
/// unplugged or the other side hung up, and that nothing further will come. Modem lines are unchanged after opening; a
/// port without them opens as well. Must be called within a tokio runtime.
///
/// # Errors
/// `Missing`, `NotAPort`, `Permission`, `Busy`, or `Io` with the system's message.
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
            _ => io_error(&place(), error.into()),
        }),
    }
}

#[cfg(not(unix))]
fn refuse_what_is_no_port(_place: &str) -> Result<(), TransportError> {
    Ok(())
}

/// False if it opens but is not a terminal, such as `/dev/null`.
#[cfg(unix)]
fn may_be_port(place: &str) -> bool {
    use nix::fcntl::OFlag;
    use std::io::IsTerminal as _;
    use std::os::unix::fs::OpenOptionsExt as _;
    let flags = OFlag::O_NONBLOCK | OFlag::O_NOCTTY;
    let mut options = std::fs::OpenOptions::new();
    let file = options.read(true).custom_flags(flags.bits()).open(place);
    file.map_or(true, |file| file.is_terminal())
}

#[cfg(not(unix))]
const fn may_be_port(_place: &str) -> bool {
    true
}

/// A pseudo-terminal remains marked exclusive until its master closes, so that only root could open it a second time:
/// the mark is removed there. The file lock remains (as a shared one, which still excludes exclusive openers).
#[cfg(unix)]
fn free_for_reopening(stream: &mut SerialStream, place: &str) {
    let real = std::fs::canonicalize(place);
    if real.is_ok_and(|path| path.starts_with("/dev/pts")) {
        // The port works even if this fails; only a second opening may be refused.
        drop(stream.set_exclusive(false));
    }
}

#[cfg(not(unix))]
fn free_for_reopening(_stream: &mut SerialStream, _place: &str) {}

fn open_error(place: &str, error: &tokio_serial::Error) -> TransportError {
    use std::io::ErrorKind::{NotFound, PermissionDenied};
    let text = || place.to_owned();
    match error.kind {
        // The port exists, so "no device" means that the lock was not available.
        ErrorKind::NoDevice if cfg!(unix) => TransportError::Busy {
            place: text(),
            holder: holder::find(Path::new(place)),
        },
        ErrorKind::NoDevice | ErrorKind::Io(NotFound) => TransportError::Missing { place: text() },
        // Windows reports "access denied" for a port in use.
        ErrorKind::Io(PermissionDenied) if cfg!(windows) => TransportError::Busy {
            place: text(),
            holder: None,
        },
        ErrorKind::Io(PermissionDenied) => denied(text()),
        // serialport preserves only the message of the system's error.
        ErrorKind::Unknown if !may_be_port(place) => TransportError::NotAPort { place: text() },
        kind => io_error(
            place,
            SystemError {
                kind: match kind {
                    ErrorKind::Io(kind) => kind,
                    ErrorKind::InvalidInput => std::io::ErrorKind::InvalidInput,
                    ErrorKind::NoDevice | ErrorKind::Unknown => std::io::ErrorKind::Other,
                },
                code: None,
                words: error.description.clone(),
            },
        ),
    }
}

fn denied(place: String) -> TransportError {
    TransportError::Permission {
        remedy: remedy(&place),
        place,
    }
}

fn io_error(place: &str, error: SystemError) -> TransportError {
    TransportError::Io {
        place: place.into(),
        failure: error.into(),
    }
}

#[cfg(test)]
mod tests {
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

    #[cfg(target_os = "linux")]
    #[test]
    fn where_sys_is_not_mounted_there_are_no_ports() {
        let empty = tempfile::tempdir().unwrap();
        assert_eq!(ports_by(&Sysfs::at(empty.path())), []);
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
            io_error(
                "/dev/x",
                SystemError {
                    kind: std::io::ErrorKind::Other,
                    code: None,
                    words: "Input/output error".into(),
                }
            )
        );
    }
}
