//! Starts the system's file manager to show a file in its folder. Changes no file.

use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

/// Time by which a failed start has ended; a manager that stays in the foreground has not.
const START_TIMEOUT: Duration = Duration::from_secs(3);
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Opens the file manager at a file. Waits until success or failure is known.
pub(crate) fn show(file: &Path) -> io::Result<()> {
    let mut command = command(file);
    command.stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    begin(&mut command)
}

/// Explorer and Finder select the file; other systems can only open its folder.
fn command(file: &Path) -> Command {
    if cfg!(windows) {
        let mut command = Command::new("explorer");
        command.arg("/select,").arg(file);
        return command;
    }
    if cfg!(target_os = "macos") {
        let mut command = Command::new("open");
        command.arg("-R").arg(file);
        return command;
    }
    let mut command = Command::new("xdg-open");
    command.arg(file.parent().unwrap_or(file));
    command
}

fn begin(command: &mut Command) -> io::Result<()> {
    let mut child = command.spawn()?;
    for _ in 0..START_TIMEOUT.as_millis() / POLL_INTERVAL.as_millis() {
        if let Some(status) = child.try_wait()? {
            return judge(status);
        }
        std::thread::sleep(POLL_INTERVAL);
    }
    reap(child);
    Ok(())
}

/// Explorer exits with 1 on success.
fn judge(status: ExitStatus) -> io::Result<()> {
    if status.success() || cfg!(windows) {
        Ok(())
    } else {
        Err(io::Error::other(status.to_string()))
    }
}

/// Waits for the child's end in a thread, so that no zombie process remains.
fn reap(mut child: Child) {
    std::thread::spawn(move || child.wait());
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    #[test]
    fn what_ends_well_worked_and_what_does_not_start_or_ends_badly_did_not() {
        assert!(begin(&mut Command::new("true")).is_ok());
        let refused = begin(&mut Command::new("false")).unwrap_err();
        assert!(refused.to_string().contains('1'), "{refused}");
        assert!(begin(&mut Command::new("no-such-program-at-all")).is_err());
    }
}
