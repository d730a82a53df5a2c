//! Facts that Linux reports about a serial port under `/sys`: its USB position, its driver, its latency timer. Opens no
//! port; other systems report nothing.

use std::fs;
use std::path::{Path, PathBuf};

/// Linux's tree of devices; a test provides its own.
#[derive(Debug, Clone)]
pub struct Sysfs {
    root: PathBuf,
}

impl Default for Sysfs {
    fn default() -> Self {
        Self::at("/sys")
    }
}

impl Sysfs {
    /// The tree under this folder.
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// True if the system's ports can be looked up here; false in a container without `/sys`.
    pub fn has_ports(&self) -> bool {
        fs::read_dir(self.root.join("class/tty")).is_ok()
    }

    /// Bus, port path and interface on USB, such as `1-2.3:1.0`; `None` for ports that are not on USB.
    pub fn usb_location(&self, port: &str) -> Option<String> {
        let device = fs::canonicalize(self.tty(port)?.join("device")).ok()?;
        let parts = device.components().rev();
        let mut names = parts.filter_map(|part| part.as_os_str().to_str());
        names.find(|name| is_interface(name)).map(str::to_owned)
    }

    /// The kernel's driver, such as `ftdi_sio`.
    pub fn driver(&self, port: &str) -> Option<String> {
        let driver = fs::canonicalize(self.tty(port)?.join("device/driver")).ok()?;
        Some(driver.file_name()?.to_str()?.to_owned())
    }

    /// Latency timer of the adapter in milliseconds; `None` if its driver does not report it.
    pub fn latency_timer_ms(&self, port: &str) -> Option<u16> {
        let name = device_name(port)?;
        let file = self.root.join("bus/usb-serial/devices").join(name);
        let text = fs::read_to_string(file.join("latency_timer")).ok()?;
        text.trim().parse().ok()
    }

    fn tty(&self, port: &str) -> Option<PathBuf> {
        Some(self.root.join("class/tty").join(device_name(port)?))
    }
}

/// Device name such as `ttyUSB0`, also for a link such as those under `/dev/serial/by-id`.
fn device_name(port: &str) -> Option<String> {
    let real = fs::canonicalize(port).unwrap_or_else(|_not_there| PathBuf::from(port));
    Some(Path::new(&real).file_name()?.to_str()?.to_owned())
}

/// Linux names USB interfaces `bus-port.port:configuration.interface`.
fn is_interface(name: &str) -> bool {
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let Some((device, interface)) = name.split_once(':') else {
        return false;
    };
    let Some((bus, ports)) = device.split_once('-') else {
        return false;
    };
    is_digits(bus) && ports.split('.').all(is_digits) && interface.split('.').all(is_digits)
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    /// A tree like that of an FTDI adapter in the second port of the first bus.
    fn tree(timer: &str) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path();
        let device = root.join("devices/pci0/usb1/1-2/1-2:1.0/ttyUSB7");
        let driver = root.join("bus/usb-serial/drivers/ftdi_sio");
        for folder in [
            &device,
            &driver,
            &root.join("class/tty/ttyUSB7"),
            &root.join("bus/usb-serial/devices"),
        ] {
            fs::create_dir_all(folder).unwrap();
        }
        symlink(&device, root.join("class/tty/ttyUSB7/device")).unwrap();
        symlink(&device, root.join("bus/usb-serial/devices/ttyUSB7")).unwrap();
        symlink(&driver, device.join("driver")).unwrap();
        fs::write(device.join("latency_timer"), timer).unwrap();
        dir
    }

    #[test]
    fn place_driver_and_timer_are_read_from_the_tree() {
        let dir = tree("16\n");
        let sysfs = Sysfs::at(dir.path());
        let port = "/dev/ttyUSB7";
        assert_eq!(sysfs.usb_location(port).as_deref(), Some("1-2:1.0"));
        assert_eq!(sysfs.driver(port).as_deref(), Some("ftdi_sio"));
        assert_eq!(sysfs.latency_timer_ms(port), Some(16));
        assert!(sysfs.has_ports() && !Sysfs::at(port).has_ports());
    }

    #[test]
    fn what_is_not_there_or_no_number_is_not_known() {
        let dir = tree("often");
        let sysfs = Sysfs::at(dir.path());
        assert_eq!(sysfs.latency_timer_ms("/dev/ttyUSB7"), None);
        assert_eq!(sysfs.latency_timer_ms("/dev/ttyUSB8"), None);
        assert_eq!(sysfs.usb_location("/dev/ttyS0"), None);
        assert_eq!(sysfs.driver("/"), None);
        for (name, is) in [("1-2:1.0", true), ("10-1.4.2:1.3", true), ("usb1", false)] {
            assert_eq!(is_interface(name), is, "{name}");
        }
        for name in ["1-:1.0", "1-2", "0000:00:14.0", "a-2:1.0"] {
            assert!(!is_interface(name), "{name}");
        }
    }
}
