//! The files of what is done under a card: backups, notes of a SAVE, and the record of a hand that goes to another place. One at a
//! time, off the window's thread. Decides nothing about the hand.

use crate::app::calendar::since_1970;
use crate::app::guard::guarded::Guarded;
use crate::app::params::guard::Place;
use crate::app::params::record::{Record, folder_beside};
use crate::link::{Saved, Wake};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::sync::oneshot;

/// What came of work on a file: where it lies, or what the system says.
pub(crate) type Filed = Result<Option<PathBuf>, String>;

/// Works on the records of hands.
pub(crate) struct GuardFiles {
    folder: Option<PathBuf>,
    runtime: tokio::runtime::Handle,
    wake: Wake,
    filing: Option<oneshot::Receiver<Filed>>,
}

impl GuardFiles {
    /// Keeps the records beside the settings; without settings nowhere.
    pub(crate) fn new(
        settings: Option<&Path>,
        runtime: tokio::runtime::Handle,
        wake: Wake,
    ) -> Self {
        Self {
            folder: settings.map(folder_beside),
            runtime,
            wake,
            filing: None,
        }
    }

    /// Waits for nothing any more. What was begun comes to its end.
    pub(crate) fn forget(&mut self) {
        self.filing = None;
    }

    /// True until what came of the work was taken.
    pub(crate) const fn is_busy(&self) -> bool {
        self.filing.is_some()
    }

    /// Works on the files of a hand, off the window's thread; false if there is no folder for them.
    pub(crate) fn begin(
        &mut self,
        hand: &Endpoint,
        work: impl FnOnce(&Record, Duration) -> io::Result<Option<PathBuf>> + Send + 'static,
    ) -> bool {
        let Some(folder) = &self.folder else {
            return false;
        };
        let record = Record::new(folder, hand);
        let (done, filing) = oneshot::channel();
        let wake = Wake::clone(&self.wake);
        self.runtime.spawn_blocking(move || {
            let filed = work(&record, since_1970());
            // A receiver that is gone means that the window is gone: no one is left to tell.
            let _told = done.send(filed.map_err(|error| error.to_string()));
            wake();
        });
        self.filing = Some(filing);
        true
    }

    /// Notes what came of a SAVE, also for where the hand may be once it is switched off and on.
    pub(crate) fn note_saved(&mut self, guarded: &Guarded, at: Place, saved: Saved) {
        let other = guarded.endpoint(at.other()).clone();
        let stays = at == Place::New && saved == Saved::Confirmed;
        self.begin(guarded.endpoint(at), move |record, _| {
            record.end(&saved)?;
            if !stays {
                record.beside(&other).adopt(record)?;
            }
            Ok(None)
        });
    }

    /// What is known of the hand is found at its new place too.
    pub(crate) fn adopt(&mut self, old: &Endpoint, new: &Endpoint) {
        let new = new.clone();
        self.begin(old, move |record, _| {
            record.beside(&new).adopt(record).map(|()| None)
        });
    }

    /// What came of the work on a file, once.
    pub(crate) fn done(&mut self) -> Option<Filed> {
        let filed = match self.filing.as_mut()?.try_recv() {
            Err(oneshot::error::TryRecvError::Empty) => return None,
            Err(oneshot::error::TryRecvError::Closed) => Err("the program is ending".into()),
            Ok(filed) => filed,
        };
        self.filing = None;
        Some(filed)
    }
}
