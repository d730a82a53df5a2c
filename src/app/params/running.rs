//! What tasks and files give for what a hand keeps.

use crate::params::backups::{Backup, Backups, Known};
use crate::params::values::Params;
use crate::store::FileError;
use crate::tasks::TaskError;
use crate::tasks::apply::Applied;
use crate::tasks::read::ReadRows;
use crate::tasks::save::SaveReport;
use std::io;

/// How a task ended.
#[derive(Debug)]
pub(crate) enum ParamsEnd {
    Read(ReadRows),
    Applied(Params, Result<Applied, TaskError>),
    Saved(Result<SaveReport, TaskError>),
}

/// What the files of a hand hold.
#[derive(Debug)]
pub(crate) struct FilesRead {
    pub(crate) files: Backups,
    pub(crate) known: Result<Known, FileError>,
    pub(crate) backups: io::Result<Vec<Backup>>,
}

impl FilesRead {
    pub(crate) fn of(files: Backups) -> Self {
        Self {
            known: files.known(),
            backups: files.backups(),
            files,
        }
    }
}
