//! Counts the other openers of a device, as reported by Linux, and detects when the last of them closed it. Opens no device.

use nix::errno::Errno;
use nix::sys::inotify::{AddWatchFlags, InitFlags, Inotify};
use std::io;
use std::os::fd::{AsFd as _, AsRawFd, RawFd};
use std::path::Path;
use std::task::{Context, Poll};
use tokio::io::unix::AsyncFd;

/// Watches one device.
#[derive(Debug)]
pub(crate) struct Openers {
    notes: AsyncFd<Notes>,
    open: usize,
}

#[derive(Debug)]
struct Notes(Inotify);

impl AsRawFd for Notes {
    fn as_raw_fd(&self) -> RawFd {
        self.0.as_fd().as_raw_fd()
    }
}

impl Openers {
    /// Starts watching. Existing openers are not counted. Must be called within a tokio runtime.
    ///
    /// # Errors
    /// The system has no room for another watch.
    pub(crate) fn watch(device: &Path) -> io::Result<Self> {
        let notes = Inotify::init(InitFlags::IN_NONBLOCK | InitFlags::IN_CLOEXEC)?;
        let wanted = AddWatchFlags::IN_OPEN | AddWatchFlags::IN_CLOSE;
        notes.add_watch(device, wanted)?;
        #[expect(
            deprecated,
            reason = "its successor is unsafe, for types whose descriptor may change; that of an Inotify does not"
        )]
        let notes = AsyncFd::new(Notes(notes))?;
        Ok(Self { notes, open: 0 })
    }

    /// True if the device is open, as of the last [`Self::poll_left`].
    pub(crate) const fn are_there(&self) -> bool {
        self.open > 0
    }

    /// Records received data, which proves an opener whatever the count: two equal unread events are merged.
    pub(crate) fn are_heard(&mut self) {
        self.open = self.open.max(1);
    }

    /// Applies the events until now, and wakes the task on further ones. True if the last opener closed it meanwhile.
    pub(crate) fn poll_left(&mut self, cx: &mut Context<'_>) -> io::Result<bool> {
        let mut left = false;
        while let Poll::Ready(ready) = self.notes.poll_read_ready(cx) {
            let mut guard = ready?;
            let read = guard.try_io(|notes| notes.get_ref().0.read_events().map_err(Errno::into));
            let Ok(events) = read else { continue };
            for event in events? {
                if event.mask.contains(AddWatchFlags::IN_OPEN) {
                    self.open += 1;
                } else if event.mask.intersects(AddWatchFlags::IN_CLOSE) {
                    self.open = self.open.saturating_sub(1);
                    left |= self.open == 0;
                }
            }
        }
        Ok(left)
    }
}
