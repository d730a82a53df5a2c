//! A pseudo-terminal with a link to it, so that other programs can open the simulated hand like a serial port.
//! Independent of the protocol.

#[cfg(target_os = "linux")]
use crate::system::SystemError;
use crate::transport::openers::Openers;
use crate::transport::permission::remedy;
use crate::transport::wire::TransportError;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::pty::openpty;
use nix::sys::termios::{FlushArg, SetArg, cfmakeraw, tcflush, tcgetattr, tcsetattr};
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::os::fd::OwnedFd;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use tokio::io::unix::AsyncFd;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// Limit of bytes written since the last data from a client. More than this many replies without a request means that
/// no client listens: unread data is discarded before the next bytes, so that no later client gets it.
const UNHEARD_MAX: usize = 2048;

/// The master of a pseudo-terminal; the slave is reached through a symbolic link. Clients may open and close it repeatedly.
#[derive(Debug)]
pub struct PtyLink {
    master: AsyncFd<File>,
    /// Kept open: without any slave a read of the master fails with `EIO` and never recovers in the reactor.
    slave: OwnedFd,
    slave_path: PathBuf,
    link_path: PathBuf,
    unheard: usize,
    /// `None` if the system does not report who has the slave open.
    #[cfg(target_os = "linux")]
    openers: Option<Openers>,
    /// The only baud rate understood; `None` = any.
    baud: Option<u32>,
    garbled: Vec<u8>,
}

impl PtyLink {
    /// Opens a pseudo-terminal in raw mode and creates a link to it at `link_path`, replacing an old link. Dropping it
    /// removes the link and hangs up on the client. Must be called within a tokio runtime.
    ///
    /// # Errors
    /// `NotAPort` if `link_path` exists and is not a link; `Permission`, `Missing` (no such folder) or `Io`.
    pub fn create(link_path: &Path) -> Result<Self, TransportError> {
        let failed = |error: io::Error| link_error(link_path, &error);
        let (master, slave) = open_raw().map_err(failed)?;
        let slave_path = nix::unistd::ttyname(&slave).map_err(|error| failed(error.into()))?;
        replace_link(&slave_path, link_path)?;
        #[cfg(target_os = "linux")]
        let openers = Openers::watch(&slave_path).ok();
        let undo = |error| {
            remove_link(&slave_path, link_path);
            failed(error)
        };
        #[expect(
            deprecated,
            reason = "its successor is unsafe, for types whose descriptor may change; that of a File does not"
        )]
        let master = AsyncFd::new(File::from(master)).map_err(undo)?;
        Ok(Self {
            master,
            slave,
            slave_path: slave_path.clone(),
            link_path: link_path.to_path_buf(),
            unheard: 0,
            #[cfg(target_os = "linux")]
            openers,
            baud: None,
            garbled: Vec::new(),
        })
    }

    /// Understands this baud rate only, as a real line does: a client that has set another receives garbage.
    #[must_use]
    pub const fn at_baud(mut self, baud: u32) -> Self {
        self.baud = Some(baud);
        self
    }

    /// True if the client has set another baud rate. The slave's settings are the client's.
    fn is_misheard(&self) -> bool {
        let set = rustix::termios::tcgetattr(&self.slave).map(|settings| settings.output_speed());
        self.baud
            .is_some_and(|baud| set.is_ok_and(|set| set != baud))
    }

    /// The device that the link points to.
    pub fn slave_path(&self) -> &Path {
        &self.slave_path
    }

    pub fn link_path(&self) -> &Path {
        &self.link_path
    }

    /// Behaves like a USB port: data that the last client has not read when it closes is discarded, and so is data
    /// written while no client has it open. True if none has, where the system reports that.
    #[cfg(target_os = "linux")]
    fn poll_is_idle(&mut self, cx: &mut Context<'_>) -> io::Result<bool> {
        let Some(openers) = &mut self.openers else {
            return Ok(false);
        };
        if openers.poll_left(cx)? {
            tcflush(&self.slave, FlushArg::TCIFLUSH)?;
            self.unheard = 0;
        }
        Ok(!openers.are_there())
    }

    #[cfg(not(target_os = "linux"))]
    fn poll_is_idle(&mut self, _cx: &mut Context<'_>) -> io::Result<bool> {
        Ok(false)
    }

    fn forget_the_unheard(&mut self, coming: usize) -> io::Result<()> {
        if self.unheard.saturating_add(coming) > UNHEARD_MAX && self.unheard > 0 {
            tcflush(&self.slave, FlushArg::TCIFLUSH)?;
            self.unheard = 0;
        }
        Ok(())
    }
}

impl Drop for PtyLink {
    fn drop(&mut self) {
        remove_link(&self.slave_path, &self.link_path);
    }
}

fn open_raw() -> io::Result<(OwnedFd, OwnedFd)> {
    let pty = openpty(None, None)?;
    let mut settings = tcgetattr(&pty.slave)?;
    cfmakeraw(&mut settings);
    tcsetattr(&pty.slave, SetArg::TCSANOW, &settings)?;
    fcntl(&pty.master, FcntlArg::F_SETFL(OFlag::O_NONBLOCK))?;
    Ok((pty.master, pty.slave))
}

/// Creates the link under another name first, so that a client always finds one.
fn replace_link(slave_path: &Path, link_path: &Path) -> Result<(), TransportError> {
    let failed = |error: io::Error| link_error(link_path, &error);
    match fs::symlink_metadata(link_path) {
        Ok(found) if !found.file_type().is_symlink() => {
            return Err(TransportError::NotAPort {
                place: link_path.display().to_string(),
            });
        }
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return symlink(slave_path, link_path).map_err(failed);
        }
        Err(error) => return Err(failed(error)),
    }
    let mut name = link_path.as_os_str().to_owned();
    name.push(format!(".{}", std::process::id()));
    let fresh = PathBuf::from(name);
    symlink(slave_path, &fresh)
        .and_then(|()| fs::rename(&fresh, link_path))
        .map_err(failed)
}

/// Removes the link unless another program replaced it.
fn remove_link(slave_path: &Path, link_path: &Path) {
    let ours = fs::read_link(link_path).is_ok_and(|target| target == slave_path);
    if ours {
        // A link that cannot be removed dangles; the next start replaces it.
        drop(fs::remove_file(link_path));
    }
}

fn link_error(link_path: &Path, error: &io::Error) -> TransportError {
    let place = link_path.display().to_string();
    match error.kind() {
        io::ErrorKind::NotFound => TransportError::Missing { place },
        io::ErrorKind::PermissionDenied => TransportError::Permission {
            remedy: remedy(&place),
            place,
        },
        _ => TransportError::Io {
            place,
            failure: SystemError::from(error).into(),
        },
    }
}

impl AsyncRead for PtyLink {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.poll_is_idle(cx)?;
        let got = loop {
            let mut guard = ready!(self.master.poll_read_ready(cx))?;
            let rest = buf.initialize_unfilled();
            match guard.try_io(|master| master.get_ref().read(rest)) {
                Ok(got) => break got?,
                Err(_would_block) => {}
            }
        };
        buf.advance(got);
        if got > 0 {
            self.unheard = 0;
            #[cfg(target_os = "linux")]
            if let Some(openers) = &mut self.openers {
                openers.are_heard();
            }
        }
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for PtyLink {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<io::Result<usize>> {
        if self.poll_is_idle(cx)? {
            return Poll::Ready(Ok(buf.len()));
        }
        self.forget_the_unheard(buf.len())?;
        // Bits sampled at another rate are shifted.
        self.garbled.clear();
        if self.is_misheard() {
            let bytes = buf.iter().map(|byte| byte.rotate_left(3) ^ 0x5A);
            self.garbled.extend(bytes);
        }
        let this = self.as_mut().get_mut();
        let sent = if this.garbled.is_empty() {
            buf
        } else {
            &this.garbled
        };
        let put = loop {
            let mut guard = ready!(this.master.poll_write_ready(cx))?;
            match guard.try_io(|master| master.get_ref().write(sent)) {
                Ok(put) => break put?,
                Err(_would_block) => {}
            }
        };
        self.unheard = self.unheard.saturating_add(put);
        Poll::Ready(Ok(put))
    }

    fn poll_flush(self: Pin<&mut Self>, _cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::endpoint::SerialLine;
    use crate::transport::serial;
    use std::time::Duration;
    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::time::timeout;
    use tokio_serial::SerialStream;

    const SOON: Duration = Duration::from_secs(2);

    fn line(path: &Path) -> SerialLine {
        SerialLine {
            port: path.to_str().unwrap().into(),
            baud: 115_200,
            id: 1,
            packing: None,
        }
    }

    async fn round_trip(hand: &mut PtyLink, client: &mut SerialStream) {
        let all: Vec<u8> = (0..=255).collect();
        AsyncWriteExt::write_all(client, &all).await.unwrap();
        let mut got = vec![0; 256];
        timeout(SOON, hand.read_exact(&mut got))
            .await
            .unwrap()
            .unwrap();
        assert_eq!(got, all);
        hand.write_all(&all).await.unwrap();
        got.fill(0);
        timeout(SOON, AsyncReadExt::read_exact(client, &mut got))
            .await
            .unwrap()
            .unwrap();
        assert_eq!(got, all);
    }

    #[tokio::test]
    async fn all_bytes_pass_both_ways_for_one_client_after_another() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let mut hand = PtyLink::create(&path).unwrap();
        for _ in 0..3 {
            let mut client = serial::open(&line(&path)).unwrap();
            round_trip(&mut hand, &mut client).await;
        }
    }

    #[tokio::test]
    async fn opening_twice_is_busy_and_once_closed_it_is_free() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let _hand = PtyLink::create(&path).unwrap();
        let client = serial::open(&line(&path)).unwrap();
        let error = serial::open(&line(&path)).unwrap_err();
        assert!(matches!(error, TransportError::Busy { .. }), "{error}");
        assert!(error.to_string().contains("another program"), "{error}");
        drop(client);
        serial::open(&line(&path)).unwrap();
    }

    #[tokio::test]
    async fn what_was_written_to_nobody_does_not_reach_the_next_client() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let mut hand = PtyLink::create(&path).unwrap();
        for _ in 0..1000 {
            timeout(SOON, hand.write_all(&[0x90; 260]))
                .await
                .unwrap()
                .unwrap();
        }
        let mut client = serial::open(&line(&path)).unwrap();
        round_trip(&mut hand, &mut client).await;
    }

    /// Opens the port without discarding data, as `cat` does.
    #[cfg(target_os = "linux")]
    fn plain(path: &Path) -> File {
        use std::os::unix::fs::OpenOptionsExt as _;
        let flags = (OFlag::O_NONBLOCK | OFlag::O_NOCTTY).bits();
        let mut options = File::options();
        let options = options.read(true).write(true).custom_flags(flags);
        options.open(path).unwrap()
    }

    #[cfg(target_os = "linux")]
    #[tokio::test]
    async fn what_a_client_did_not_read_before_it_closed_is_gone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let mut hand = PtyLink::create(&path).unwrap();
        let mut one = [0];
        for late in [false, true] {
            let mut client = plain(&path);
            client.write_all(b"?").unwrap();
            hand.read_exact(&mut one).await.unwrap();
            let answer = async |hand: &mut PtyLink| hand.write_all(b"!").await.unwrap();
            if !late {
                answer(&mut hand).await;
                // Another client that opens and closes it meanwhile discards nothing.
                let mut byte = [0];
                drop(plain(&path));
                assert!(
                    timeout(Duration::from_millis(50), hand.read(&mut byte))
                        .await
                        .is_err()
                );
                assert_eq!((&client).read(&mut byte).unwrap(), 1);
                answer(&mut hand).await;
            }
            drop(client);
            if late {
                answer(&mut hand).await;
            }
            assert!(
                timeout(Duration::from_millis(50), hand.read(&mut one))
                    .await
                    .is_err()
            );
            let next = (&plain(&path)).read(&mut one);
            assert_eq!(
                next.unwrap_err().kind(),
                io::ErrorKind::WouldBlock,
                "{late}"
            );
        }
    }

    #[tokio::test]
    async fn closing_is_noticed_at_once_and_takes_the_link_away() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let hand = PtyLink::create(&path).unwrap();
        let mut client = serial::open(&line(&path)).unwrap();
        drop(hand);
        let mut byte = [0];
        let got = timeout(SOON, AsyncReadExt::read(&mut client, &mut byte))
            .await
            .unwrap();
        assert!(matches!(got, Ok(0) | Err(_)));
        assert!(fs::symlink_metadata(&path).is_err());
    }

    #[tokio::test]
    async fn an_old_link_is_replaced_and_anything_else_is_not() {
        let dir = tempfile::tempdir().unwrap();
        let old = dir.path().join("old");
        symlink("/dev/pts/no-such", &old).unwrap();
        let hand = PtyLink::create(&old).unwrap();
        assert_eq!(fs::read_link(&old).unwrap(), hand.slave_path());
        let file = dir.path().join("file");
        fs::write(&file, b"precious").unwrap();
        for path in [file.as_path(), dir.path()] {
            let error = PtyLink::create(path).unwrap_err();
            assert!(matches!(error, TransportError::NotAPort { .. }), "{error}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"precious");
        let lost = PtyLink::create(&dir.path().join("no/hand")).unwrap_err();
        assert!(matches!(lost, TransportError::Missing { .. }), "{lost}");
    }

    #[tokio::test]
    async fn a_link_that_another_took_over_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hand");
        let first = PtyLink::create(&path).unwrap();
        let second = PtyLink::create(&path).unwrap();
        drop(first);
        assert_eq!(fs::read_link(&path).unwrap(), second.slave_path());
    }
}
