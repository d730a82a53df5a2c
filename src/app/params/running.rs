//! Tasks and file work for what a hand keeps, while they run.

use crate::app::running::Running;
use crate::hand::Span;
use crate::params::backups::{Backup, Backups, Known};
use crate::params::file::ParamsFileError;
use crate::params::values::Params;
use crate::tasks::TaskError;
use crate::tasks::apply::{Applied, ApplyStep};
use crate::tasks::read::Rows;
use crate::tasks::save::{SaveReport, SaveStep};
use std::io;

/// What runs.
#[derive(Debug)]
pub(crate) enum ParamsTask {
    Read(Running<(Span, Vec<u8>), Rows>),
    Apply(Params, Running<ApplyStep, Result<Applied, TaskError>>),
    Save(Running<SaveStep, Result<SaveReport, TaskError>>),
}

/// What the files of a hand hold.
#[derive(Debug)]
pub(crate) struct FilesRead {
    pub(crate) files: Backups,
    pub(crate) known: Result<Known, ParamsFileError>,
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
