//! Reason why a port cannot be opened, and the command that changes it. Changes nothing itself.

use std::fmt;

/// Measure that permits the user to open a port.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Remedy {
    /// Become a member of the group that owns it.
    JoinGroup(String),
    /// The user is a member already, but not in this login session.
    LogInAgain(String),
    /// Its group has no access either: it must be granted.
    GiveRight(String),
    /// Windows and others: no known measure.
    Unknown,
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::JoinGroup(group) => write!(
                f,
                "run 'sudo usermod -aG {group} $USER', then log out and in again"
            ),
            Self::LogInAgain(group) => write!(
                f,
                "you are in its group {group}, but not since you logged in: log out and in again"
            ),
            Self::GiveRight(port) => write!(
                f,
                "run 'sudo chmod a+rw {port}' (until it is unplugged), or add a udev rule for it"
            ),
            Self::Unknown => write!(f, "start the program as someone who may"),
        }
    }
}

/// Owner and permissions of a port, and the user's membership; gathered by [`remedy`], or by a test.
#[cfg(unix)]
#[derive(Debug, Clone, PartialEq, Eq)]
struct Rights {
    /// The last nine bits, as `chmod` takes them.
    mode: u32,
    /// The group that owns it; `None` if it has no name or is root's own.
    group: Option<String>,
    /// True if the user is a listed member of that group.
    is_member: bool,
}

#[cfg(unix)]
impl Rights {
    fn remedy(&self, port: &str) -> Remedy {
        const GROUP_READS_AND_WRITES: u32 = 0o060;
        let may = self.mode & GROUP_READS_AND_WRITES == GROUP_READS_AND_WRITES;
        match &self.group {
            Some(group) if may && self.is_member => Remedy::LogInAgain(group.clone()),
            Some(group) if may => Remedy::JoinGroup(group.clone()),
            _ => Remedy::GiveRight(port.into()),
        }
    }
}

/// Measure that would permit this user to open the port, from the owner and the permissions of its device file.
#[cfg(unix)]
pub(crate) fn remedy(port: &str) -> Remedy {
    use nix::unistd::{Gid, Group, User, getuid};
    use std::os::unix::fs::MetadataExt as _;
    // A link's own permissions are irrelevant; those of an invisible file are unknown.
    let Ok(found) = std::fs::metadata(port) else {
        return Remedy::GiveRight(port.into());
    };
    let group = Group::from_gid(Gid::from_raw(found.gid())).ok().flatten();
    let group = group.filter(|group| group.gid.as_raw() != 0);
    let person = User::from_uid(getuid()).ok().flatten();
    let is_member = group
        .as_ref()
        .zip(person)
        .is_some_and(|(group, person)| person.gid == group.gid || group.mem.contains(&person.name));
    let rights = Rights {
        mode: found.mode() & 0o777,
        group: group.map(|group| group.name),
        is_member,
    };
    rights.remedy(port)
}

/// Other systems: unknown.
#[cfg(not(unix))]
pub(crate) fn remedy(_port: &str) -> Remedy {
    Remedy::Unknown
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_names_the_group_that_really_owns_the_port() {
        for (mode, group, is_member, wanted) in [
            (
                0o660,
                Some("dialout"),
                false,
                "sudo usermod -aG dialout $USER",
            ),
            (0o660, Some("uucp"), false, "sudo usermod -aG uucp $USER"),
            (0o660, Some("dialout"), true, "log out and in again"),
            (
                0o600,
                Some("dialout"),
                false,
                "sudo chmod a+rw /dev/ttyUSB0",
            ),
            (0o620, Some("tty"), false, "sudo chmod a+rw /dev/ttyUSB0"),
            (0o660, None, false, "sudo chmod a+rw /dev/ttyUSB0"),
        ] {
            let rights = Rights {
                mode,
                group: group.map(str::to_owned),
                is_member,
            };
            let words = rights.remedy("/dev/ttyUSB0").to_string();
            assert!(words.contains(wanted), "{rights:?}: {words}");
            assert_eq!(words.contains("usermod"), wanted.contains("usermod"));
        }
    }

    #[test]
    fn the_rights_of_a_real_file_are_read() {
        assert!(matches!(
            remedy("/no/such/port"),
            Remedy::GiveRight(port) if port == "/no/such/port"
        ));
    }
}
