//! The system's file manager, started to show a file where it lies. Changes no file.

use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

/// What could not begin has ended by then; a manager that runs on in the foreground has not.
const START_TIMEOUT: Duration = Duration::from_secs(3);
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Starts the file manager at a file. Waits until it is known whether that worked.
pub(crate) fn show(file: &Path) -> io::Result<()> {
    let mut command = command(file);
    command.stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    begin(&mut command)
}

/// Explorer selects the file, as the Finder does; other systems only know how to open its folder.
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

/// Explorer ends with 1 where it did what was asked.
fn judge(status: ExitStatus) -> io::Result<()> {
    if status.success() || cfg!(windows) {
        Ok(())
    } else {
        Err(io::Error::other(status.to_string()))
    }
}

/// Waits for the end of what runs on, so that no dead process stays behind.
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
