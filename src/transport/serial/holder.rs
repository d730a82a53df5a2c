//! Finds the program that holds a port, where the system reports it. Opens nothing.

#[cfg(target_os = "linux")]
pub(crate) use linux::find;

/// Other systems do not report it.
#[cfg(not(target_os = "linux"))]
pub(crate) fn find(_place: &std::path::Path) -> Option<String> {
    None
}

#[cfg(target_os = "linux")]
mod linux {
    use std::fs;
    use std::os::linux::fs::MetadataExt as _;
    use std::path::Path;

    /// Maximum processes inspected, so that a busy machine does not delay the answer.
    const PROCESSES_MAX: usize = 4096;
    /// Devices that the creator of a pseudo-terminal has open.
    const MASTERS: [&str; 2] = ["/dev/ptmx", "/dev/pts/ptmx"];

    /// Name and id of another program that has this port open or locked.
    pub(crate) fn find(place: &Path) -> Option<String> {
        let real = fs::canonicalize(place).ok()?;
        let id = opener(&real).or_else(|| locker(&real))?;
        let name = fs::read_to_string(format!("/proc/{id}/comm")).unwrap_or_default();
        Some(format!("{} (process {id})", name.trim()))
    }

    /// A process of this user that has it open. Processes of other users do not show their files.
    fn opener(real: &Path) -> Option<u32> {
        let mut processes = fs::read_dir("/proc").ok()?.flatten().take(PROCESSES_MAX);
        processes.find_map(|process| {
            let id: u32 = process.file_name().to_str()?.parse().ok()?;
            let files = fs::read_dir(process.path().join("fd")).ok()?;
            let files: Vec<_> = files
                .flatten()
                .filter_map(|file| fs::read_link(file.path()).ok())
                .collect();
            // The creator of a pseudo-terminal keeps its other end open too, and is not the holder.
            let is_maker = real.starts_with("/dev/pts")
                && files
                    .iter()
                    .any(|file| MASTERS.iter().any(|master| file == Path::new(master)));
            let holds = id != std::process::id() && !is_maker;
            (holds && files.iter().any(|file| file == real)).then_some(id)
        })
    }

    /// The process that has locked it: the list of locks is readable by all users.
    fn locker(real: &Path) -> Option<u32> {
        let inode = fs::metadata(real).ok()?.st_ino();
        let locks = fs::read_to_string("/proc/locks").ok()?;
        locked_by(&locks, inode).filter(|id| *id != std::process::id())
    }

    /// A line reads `1: FLOCK ADVISORY WRITE 1234 00:18:5 0 EOF`: process, then device and inode.
    pub(super) fn locked_by(locks: &str, inode: u64) -> Option<u32> {
        let inode = inode.to_string();
        locks.lines().find_map(|line| {
            let mut words = line.split_whitespace().skip(1);
            if words.next()? != "FLOCK" {
                return None;
            }
            let id = words.nth(2)?.parse().ok()?;
            let file = words.next()?;
            (file.rsplit(':').next()? == inode).then_some(id)
        })
    }
}

#[cfg(target_os = "linux")]
#[cfg(test)]
mod tests {
    use super::linux::locked_by;

    #[test]
    fn the_list_of_locks_names_the_process() {
        let locks = "1: POSIX ADVISORY WRITE 77 00:18:5 0 EOF\n\
                     2: FLOCK  ADVISORY  WRITE 1234 00:18:5 0 EOF\n\
                     2: -> FLOCK ADVISORY WRITE 99 00:18:6 0 EOF\n";
        assert_eq!(locked_by(locks, 5), Some(1234));
        assert_eq!(locked_by(locks, 6), None);
        assert_eq!(locked_by("", 5), None);
    }
}
