//! The process that holds a hand if this one dies: the same program, connected by a pipe, which reports when the hand
//! may move and when it rests; a pipe that breaks in between means that this process died. This module itself holds
//! nothing.

use crate::transport::Endpoint;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// The subcommand that starts the holder, before `--hand` and the endpoint.
pub const COMMAND: &str = "guard";
/// Sent through the pipe: the hand may move from now on.
pub const MOVES: u8 = b'm';
/// Sent through the pipe: the hand rests, and nothing is armed.
pub const RESTS: u8 = b'r';

/// Consecutive failures of the process, to start or by an early exit, before they are reported.
const FAILURES_MAX: u32 = 3;
/// Delay between the end of a process and the start of the next, and its maximum if processes repeatedly end early: the
/// hand is unguarded for no longer than that.
const RESTART_DELAY: Duration = Duration::from_millis(20);
const RESTART_DELAY_MAX: Duration = Duration::from_millis(200);
/// A process that ran for this long counts as started.
const LASTING: Duration = Duration::from_secs(1);

/// Creation flag of Windows: the new process has no console.
#[cfg(windows)]
const DETACHED_PROCESS: u32 = 8;

/// The program to start; unset in a process that is not this program, such as a test.
static PROGRAM: OnceLock<(PathBuf, Complain)> = OnceLock::new();

/// Reports a message to the user.
type Complain = fn(&str);

/// Makes this process start a holder, a copy of its own program, for each hand that it arms. `complain` reports failures.
pub fn use_this_program(complain: Complain) {
    let own = std::env::current_exe().ok().filter(|path| path.exists());
    // A program that was replaced while it runs has no path, but Linux still knows it.
    let _set_before = PROGRAM.set((own.unwrap_or_else(|| "/proc/self/exe".into()), complain));
}

/// Message to the user if no holder could be started.
pub fn unguarded(why: &str) -> String {
    format!(
        "cannot start the process that stops the hand if this program is killed ({why}): then only the 24 V switch stops it"
    )
}

/// State of the process that holds the hand if this one dies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum HolderState {
    /// The process is being started.
    Starting,
    /// The process runs, or is not needed.
    Ready,
    /// There is no process; carries the reason.
    Missing(String),
}

/// This process's end of the pipe. Dropping it releases the holder; it holds the hand if the last message was that the
/// hand may move.
#[derive(Debug)]
pub(crate) struct HolderTie {
    endpoint: Endpoint,
    pipe: Arc<Mutex<HolderPipe>>,
    state: watch::Receiver<HolderState>,
}

#[derive(Debug)]
struct HolderPipe {
    /// The last message to the holder, or the first once it runs.
    word: u8,
    /// `None` while there is no process.
    to: Option<ChildStdin>,
    /// No holder is needed now, or none can be started.
    is_closed: bool,
}

impl HolderTie {
    /// Starts a holder on its own thread: the thread of the links waits for no process. None is started for a built-in
    /// hand, which dies with this process.
    pub(crate) fn start(endpoint: &Endpoint) -> Option<Self> {
        let (program, complain) = PROGRAM.get()?;
        if matches!(endpoint, Endpoint::Sim { .. }) {
            return None;
        }
        let mut command = Command::new(program);
        let hand = endpoint.to_string();
        command.args([COMMAND, "--hand", &hand]);
        command.stdin(Stdio::piped()).stdout(Stdio::null());
        // Signals of a terminal to this program's group must not reach it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        // Without a console it ends neither by Ctrl-C nor with the console.
        #[cfg(windows)]
        std::os::windows::process::CommandExt::creation_flags(&mut command, DETACHED_PROCESS);
        Some(Self::guarded(endpoint, command, *complain))
    }

    fn guarded(endpoint: &Endpoint, command: Command, complain: Complain) -> Self {
        let pipe = Arc::new(Mutex::new(HolderPipe {
            word: MOVES,
            to: None,
            is_closed: false,
        }));
        let (sender, state) = watch::channel(HolderState::Starting);
        let sender = Arc::new(sender);
        let watcher = Watcher {
            command,
            pipe: Arc::clone(&pipe),
            sender: Arc::clone(&sender),
            complain,
        };
        let thread = std::thread::Builder::new().name("holder".into());
        if let Err(error) = thread.spawn(move || watcher.run()) {
            let why = format!("cannot start a thread: {error}");
            lock(&pipe).is_closed = true;
            complain(&unguarded(&why));
            sender.send_replace(HolderState::Missing(why));
        }
        Self {
            endpoint: endpoint.clone(),
            pipe,
            state,
        }
    }

    /// Reports that the hand at this endpoint may move; false if this holder is for another, or has ended.
    pub(crate) fn moves(&self, endpoint: &Endpoint) -> bool {
        self.endpoint == *endpoint && self.send(MOVES)
    }

    /// Reports that the hand rests.
    pub(crate) fn rests(&self) {
        self.send(RESTS);
    }

    /// Receiver of the process's state.
    pub(crate) fn state(&self) -> watch::Receiver<HolderState> {
        self.state.clone()
    }

    fn send(&self, word: u8) -> bool {
        let mut pipe = lock(&self.pipe);
        pipe.word = word;
        // A pipe buffers thousands of messages before a write could block. If it is broken, its process has ended, and
        // the next one receives this message.
        if let Some(to) = &mut pipe.to {
            let _ended = to.write_all(&[word]);
        }
        !pipe.is_closed
    }
}

impl Drop for HolderTie {
    fn drop(&mut self) {
        let mut pipe = lock(&self.pipe);
        pipe.is_closed = true;
        pipe.to = None;
    }
}

/// The thread that starts the process, waits for its end, and starts another while the hand may move.
struct Watcher {
    command: Command,
    pipe: Arc<Mutex<HolderPipe>>,
    sender: Arc<watch::Sender<HolderState>>,
    complain: Complain,
}

/// Reason why a holder ended.
enum Gone {
    NotNeeded,
    /// By a signal, not by its own failure: the next one may live.
    Killed,
    Failed(String),
}

impl Watcher {
    fn run(mut self) {
        let (mut failures, mut delay) = (0, RESTART_DELAY);
        loop {
            let begun = Instant::now();
            let gone = self.one();
            if begun.elapsed() >= LASTING {
                (failures, delay) = (0, RESTART_DELAY);
            }
            match gone {
                Gone::NotNeeded => return,
                Gone::Killed => {}
                Gone::Failed(why) => {
                    failures += u32::from(begun.elapsed() < LASTING);
                    if failures >= FAILURES_MAX {
                        lock(&self.pipe).is_closed = true;
                        (self.complain)(&unguarded(&why));
                        self.sender.send_replace(HolderState::Missing(why));
                        return;
                    }
                }
            }
            std::thread::sleep(delay);
            delay = (2 * delay).min(RESTART_DELAY_MAX);
        }
    }

    /// Starts one process and waits for its end, so that no zombie remains.
    fn one(&mut self) -> Gone {
        let mut child = match self.command.spawn() {
            Ok(child) => child,
            Err(error) => return Gone::Failed(error.to_string()),
        };
        if let Some(mut stdin) = child.stdin.take() {
            let mut pipe = lock(&self.pipe);
            let _ended = stdin.write_all(&[pipe.word]);
            if !pipe.is_closed {
                pipe.to = Some(stdin);
            }
        }
        self.sender.send_replace(HolderState::Ready);
        let ended = child.wait();
        let mut pipe = lock(&self.pipe);
        pipe.to = None;
        if pipe.word == RESTS {
            // The next arming starts another.
            pipe.is_closed = true;
        }
        if pipe.is_closed {
            return Gone::NotNeeded;
        }
        #[cfg(unix)]
        if let Ok(status) = &ended
            && std::os::unix::process::ExitStatusExt::signal(status).is_some()
        {
            return Gone::Killed;
        }
        Gone::Failed(match ended {
            Ok(status) => format!("it exited immediately each time: {status}"),
            Err(error) => error.to_string(),
        })
    }
}

fn lock(pipe: &Mutex<HolderPipe>) -> MutexGuard<'_, HolderPipe> {
    pipe.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;
    use std::path::Path;

    /// A holder that records its process and its messages, as lines of two files.
    fn noting(folder: &Path) -> Command {
        let mut command = Command::new("/bin/sh");
        let note = "echo $$ >> pids; while read -r word; do echo $word >> words; done";
        // Messages have no line ends.
        command.args(["-c", &format!("head -c 1 >> words; {note}")]);
        command.current_dir(folder).stdin(Stdio::piped());
        command
    }

    fn silent(_words: &str) {}

    fn endpoint() -> Endpoint {
        "tcp:127.0.0.1:1".parse().unwrap()
    }

    fn waits_for<T>(mut look: impl FnMut() -> Option<T>) -> T {
        let begun = Instant::now();
        loop {
            if let Some(found) = look() {
                return found;
            }
            assert!(begun.elapsed() < Duration::from_secs(20), "it never came");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    fn pids(folder: &Path, count: usize) -> Vec<i32> {
        waits_for(|| {
            let text = std::fs::read_to_string(folder.join("pids")).ok()?;
            let pids: Vec<i32> = text.lines().map(|line| line.parse().unwrap()).collect();
            (pids.len() >= count).then_some(pids)
        })
    }

    #[test]
    fn a_holder_that_dies_while_the_hand_may_move_is_replaced_and_told_so() {
        let folder = tempfile::tempdir().unwrap();
        let tie = HolderTie::guarded(&endpoint(), noting(folder.path()), silent);
        let first = pids(folder.path(), 1)[0];
        std::thread::sleep(LASTING);
        kill(Pid::from_raw(first), Signal::SIGKILL).unwrap();
        let second = pids(folder.path(), 2)[1];
        waits_for(|| (std::fs::read(folder.path().join("words")).ok()? == b"mm").then_some(()));
        assert_eq!(*tie.state().borrow(), HolderState::Ready);
        // A holder that is not needed is not replaced.
        tie.rests();
        kill(Pid::from_raw(second), Signal::SIGKILL).unwrap();
        waits_for(|| lock(&tie.pipe).is_closed.then_some(()));
        assert!(!tie.moves(&endpoint()));
        assert_eq!(pids(folder.path(), 2).len(), 2);
    }

    #[test]
    fn a_holder_that_is_killed_again_and_again_is_replaced_each_time() {
        let folder = tempfile::tempdir().unwrap();
        let tie = HolderTie::guarded(&endpoint(), noting(folder.path()), silent);
        for nth in 0..8 {
            let newest = pids(folder.path(), nth + 1)[nth];
            kill(Pid::from_raw(newest), Signal::SIGKILL).unwrap();
        }
        assert_eq!(pids(folder.path(), 9).len(), 9);
        assert_eq!(*tie.state().borrow(), HolderState::Ready);
        assert!(tie.moves(&endpoint()));
    }

    #[test]
    fn a_holder_that_cannot_run_is_told_after_some_tries() {
        static REPORTED: Mutex<Vec<String>> = Mutex::new(Vec::new());
        let complain = |words: &str| REPORTED.lock().unwrap().push(words.to_owned());
        for program in ["/nothing/there", "/bin/false"] {
            let mut command = Command::new(program);
            command.stdin(Stdio::piped());
            let tie = HolderTie::guarded(&endpoint(), command, complain);
            let why = waits_for(|| match tie.state().borrow().clone() {
                HolderState::Missing(why) => Some(why),
                HolderState::Starting | HolderState::Ready => None,
            });
            let reported = REPORTED.lock().unwrap().pop().unwrap();
            assert!(
                reported.contains(&why) && reported.contains("24 V"),
                "{reported}"
            );
            assert!(REPORTED.lock().unwrap().is_empty(), "told once");
            assert!(!tie.moves(&endpoint()));
        }
    }
}
