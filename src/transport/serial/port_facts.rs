//! Facts about a serial port without opening it: adapter, driver, permissions, holder. Opens and changes nothing.

use crate::transport::found::UsbFound;
use crate::transport::serial::adapter::is_same_port;
use crate::transport::serial::holder;
use crate::transport::serial::ports;
use crate::transport::serial::sysfs::Sysfs;
use serde::Serialize;
use std::path::Path;

/// A serial port. A fact that the system does not report is `None`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct PortFacts {
    /// The device behind a link such as those under `/dev/serial/by-id`; `None` if it does not exist.
    pub device: Option<String>,
    /// The USB adapter.
    #[serde(rename = "adapter")]
    pub usb: Option<UsbFound>,
    /// The kernel's driver.
    pub driver: Option<String>,
    /// Permissions, owner and group, such as `crw-rw---- root dialout`.
    pub rights: Option<String>,
    /// Another program that has it open, with its process id.
    #[serde(rename = "held_by")]
    pub holder: Option<String>,
}

/// Looks up a port. Takes a few milliseconds on some systems.
pub fn port_facts(port: &str, sysfs: &Sysfs) -> PortFacts {
    let device = std::fs::canonicalize(port).ok();
    let listed = ports()
        .into_iter()
        .find(|found| is_same_port(port, &found.path));
    PortFacts {
        device: device.map(|path| path.display().to_string()),
        usb: listed.and_then(|found| found.usb),
        driver: sysfs.driver(port),
        rights: rights(Path::new(port)),
        holder: holder::find(Path::new(port)),
    }
}

#[cfg(unix)]
fn rights(port: &Path) -> Option<String> {
    use nix::unistd::{Gid, Group, Uid, User};
    use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _};
    let found = std::fs::metadata(port).ok()?;
    let (uid, gid) = (found.uid(), found.gid());
    let user = User::from_uid(Uid::from_raw(uid)).ok().flatten();
    let group = Group::from_gid(Gid::from_raw(gid)).ok().flatten();
    let kind = if found.file_type().is_char_device() {
        'c'
    } else if found.is_dir() {
        'd'
    } else {
        '-'
    };
    Some(format!(
        "{kind}{} {} {}",
        mode_words(found.mode()),
        user.map_or_else(|| uid.to_string(), |user| user.name),
        group.map_or_else(|| gid.to_string(), |group| group.name)
    ))
}

/// The last nine bits as `ls` shows them.
#[cfg(unix)]
fn mode_words(mode: u32) -> String {
    let bits = (0..9u32).rev().zip("rwxrwxrwx".chars());
    bits.map(|(bit, sign)| if mode >> bit & 1 == 1 { sign } else { '-' })
        .collect()
}

#[cfg(not(unix))]
fn rights(_port: &Path) -> Option<String> {
    None
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rights_read_as_the_system_shows_them() {
        assert_eq!(mode_words(0o660), "rw-rw----");
        assert_eq!(mode_words(0o20_604), "rw----r--");
        let facts = port_facts("/dev/null", &Sysfs::default());
        assert!(facts.rights.unwrap().starts_with("crw-rw-rw- root "));
        assert_eq!(facts.usb, None);
    }

    #[test]
    fn a_port_that_is_not_there_has_no_facts() {
        let facts = port_facts("/no/such/port", &Sysfs::default());
        assert_eq!(facts, PortFacts::default());
    }
}
