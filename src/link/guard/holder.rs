//! The process that holds a hand if this one dies: the same program, tied to this one by a pipe. It is told when the hand may
//! move and when it rests; a pipe that breaks in between is a death. Holds nothing itself.

use crate::transport::Endpoint;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use tokio::sync::oneshot;

/// The command of the program that becomes the holder, before `--hand` and the endpoint.
pub const COMMAND: &str = "hold";
/// Told through the pipe: from now on the hand may move.
pub const MOVES: u8 = b'm';
/// Told through the pipe: it rests, and nothing is armed.
pub const RESTS: u8 = b'r';

/// A new process of Windows has no console then.
#[cfg(windows)]
const DETACHED_PROCESS: u32 = 8;

/// The program that is started; none in a process that is not this program, such as a test.
static PROGRAM: OnceLock<(PathBuf, Complain)> = OnceLock::new();

/// Tells the user something.
type Complain = fn(&str);

/// From now on this process has a holder started for each hand that it arms: itself once more. Where that fails, it is told.
pub fn use_this_program(complain: Complain) {
    let own = std::env::current_exe().ok().filter(|path| path.exists());
    // A program that was replaced while it runs has no path any more, but Linux still knows it.
    let _set_before = PROGRAM.set((own.unwrap_or_else(|| "/proc/self/exe".into()), complain));
}

/// What the user is told where no holder could be started.
pub fn unguarded(why: &str) -> String {
    format!(
        "no process could be started that stops the hand if this program is killed ({why}): then only the 24 V switch does"
    )
}

/// Resolves once the holder runs, or says why it does not.
pub(crate) type Started = oneshot::Receiver<Result<(), String>>;

/// The end of the pipe that is here. Dropping it lets the holder go; it holds if it was last told that the hand may move.
#[derive(Debug)]
pub(crate) struct HolderTie {
    endpoint: Endpoint,
    pipe: Arc<Mutex<HolderPipe>>,
}

#[derive(Debug)]
enum HolderPipe {
    /// The process is being started; this is to be told then.
    Starts(u8),
    Open(ChildStdin),
    /// The process ended, or is not needed any more.
    Closed,
}

impl HolderTie {
    /// Starts a holder on a thread of its own: the thread of the links waits for no process. None is started for a built-in
    /// hand, which dies with this process.
    pub(crate) fn start(endpoint: &Endpoint) -> Option<(Self, Started)> {
        let (program, complain) = PROGRAM.get()?;
        if matches!(endpoint, Endpoint::Sim { .. }) {
            return None;
        }
        let mut command = Command::new(program);
        let hand = endpoint.to_string();
        command.args([COMMAND, "--hand", &hand]);
        command.stdin(Stdio::piped()).stdout(Stdio::null());
        // What a terminal tells this program's group is not meant for it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        // Without a console it ends neither by Ctrl-C nor with the console.
        #[cfg(windows)]
        std::os::windows::process::CommandExt::creation_flags(&mut command, DETACHED_PROCESS);
        let pipe = Arc::new(Mutex::new(HolderPipe::Starts(MOVES)));
        let (tell, started) = oneshot::channel();
        let shared = Arc::clone(&pipe);
        let thread = std::thread::Builder::new().name("holder".into());
        let spawned = thread.spawn(move || {
            look_after(command, &shared, |end| {
                if let Err(why) = &end {
                    complain(&unguarded(why));
                }
                let _told = tell.send(end);
            })
        });
        // Its end of the channel is gone then, which says that nothing was started.
        drop(spawned);
        let endpoint = endpoint.clone();
        Some((Self { endpoint, pipe }, started))
    }

    /// Says that the hand at this endpoint may move; false if this holder is for another, or runs no more.
    pub(crate) fn moves(&self, endpoint: &Endpoint) -> bool {
        self.endpoint == *endpoint && self.tell(MOVES)
    }

    /// Says that the hand rests.
    pub(crate) fn rests(&self) {
        self.tell(RESTS);
    }

    fn tell(&self, word: u8) -> bool {
        match &mut *lock(&self.pipe) {
            HolderPipe::Starts(first) => *first = word,
            // A pipe takes thousands of them before it could make anybody wait.
            HolderPipe::Open(pipe) => return pipe.write_all(&[word]).is_ok(),
            HolderPipe::Closed => return false,
        }
        true
    }
}

impl Drop for HolderTie {
    fn drop(&mut self) {
        *lock(&self.pipe) = HolderPipe::Closed;
    }
}

/// Starts the process, and waits for its end so that nothing of it stays.
fn look_after(
    mut command: Command,
    pipe: &Mutex<HolderPipe>,
    tell: impl FnOnce(Result<(), String>),
) {
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => {
            *lock(pipe) = HolderPipe::Closed;
            tell(Err(error.to_string()));
            return;
        }
    };
    if let Some(mut stdin) = child.stdin.take() {
        let mut pipe = lock(pipe);
        if let HolderPipe::Starts(word) = *pipe {
            let _written = stdin.write_all(&[word]);
            *pipe = HolderPipe::Open(stdin);
        }
    }
    tell(Ok(()));
    let _status = child.wait();
    *lock(pipe) = HolderPipe::Closed;
}

fn lock(pipe: &Mutex<HolderPipe>) -> MutexGuard<'_, HolderPipe> {
    pipe.lock().unwrap_or_else(PoisonError::into_inner)
}
