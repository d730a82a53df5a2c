//! SAVE: writes the hand's parameters to its flash, with a backup first and notes of the attempt and its result (manual 2.6.4).

use crate::hand::overshoot::OvershootMap;
use crate::link::{LinkHandle, RequestError};
use crate::params::backups::Backups;
use crate::params::danger::worse;
use crate::params::values::Params;
use crate::record::{SaveDoubt, Saved};
use crate::store::calendar::since_1970;
use crate::store::on_thread;
use crate::system::SystemError;
use crate::tasks::hand::once_at_rest;
use crate::tasks::{BackupError, Question, Risks, TaskError, TaskStep, User, read};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use tokio::time::sleep;

/// The result of a SAVE may arrive this late; another program must not mistake it for the result of its own.
const APART: Duration = Duration::from_secs(6);

/// Requirements of a SAVE.
#[derive(Debug, Clone)]
pub struct Save {
    /// Location of backup and notes.
    pub backups: Backups,
    /// Parameters with which the hand would start so far: the user is asked about joints that would hit harder than with these.
    pub before: Params,
    /// Risks that the user confirmed already.
    pub agreed: Risks,
    /// Overshoot of the hand, as measured by trials.
    pub overshoot: Arc<OvershootMap>,
}

/// Outcome of a SAVE, with the backup made before it.
#[derive(Debug, Clone, PartialEq)]
pub struct SaveReport {
    /// Parameters read before SAVE.
    pub params: Params,
    /// Path of the backup.
    pub backup: PathBuf,
    /// Result of SAVE: state of flash, as far as it is known.
    pub saved: Saved,
    /// Error if the result could not be noted.
    pub not_noted: Option<SystemError>,
}

/// Saves the parameters to flash.
///
/// # Errors
/// [`TaskError`]: no SAVE was sent.
pub async fn save(
    hand: &LinkHandle,
    task: &Save,
    user: &mut impl User,
    mut notify: impl FnMut(TaskStep),
) -> Result<SaveReport, TaskError> {
    let on_read = |span, bytes: &[u8]| notify(TaskStep::Read(span, bytes.to_vec()));
    let params = read::rows(hand, on_read).await.with(|_| true)?;
    let risks = Risks {
        dangers: worse(&task.before, &params, &task.overshoot),
        ..Risks::default()
    };
    if !task.agreed.contain(&risks) && !user.ask(Question::Save(risks.clone())).await {
        return Err(TaskError::Declined(risks));
    }
    notify(TaskStep::BackingUp);
    let backup = back_up(&task.backups, &params, "before save").await?;
    if let Some(ago) = task.backups.since_attempt(SystemTime::now()) {
        sleep(APART.saturating_sub(ago)).await;
    }
    let (saved, not_noted) = save_noted(hand, &task.backups, &params, || {
        notify(TaskStep::Saving);
    })
    .await?;
    Ok(SaveReport {
        params,
        backup,
        saved,
        not_noted,
    })
}

/// Writes a backup of the parameters of a hand.
pub(crate) async fn back_up(
    backups: &Backups,
    params: &Params,
    why: &'static str,
) -> Result<PathBuf, TaskError> {
    let (backups, params) = (backups.clone(), params.clone());
    on_thread(move || backups.back_up(&params, why, since_1970()))
        .await
        .map_err(no_backup)
}

/// Notes the attempt, sends SAVE, and notes the result; also returns the error if the result could not be noted.
pub(crate) async fn save_noted(
    hand: &LinkHandle,
    backups: &Backups,
    params: &Params,
    goes_out: impl FnOnce(),
) -> Result<(Saved, Option<SystemError>), TaskError> {
    let (noting, attempt) = (backups.clone(), params.clone());
    on_thread(move || noting.note_attempt(&attempt, since_1970()))
        .await
        .map_err(no_backup)?;
    goes_out();
    let not_sent = |saved: &Saved| match saved {
        Saved::NotSent(why) => Some(*why),
        _ => None,
    };
    let ended = once_at_rest(|| hand.save(), not_sent).await;
    let result = match ended {
        Err(RequestError::LinkLost) => Ok(Saved::Unknown {
            why: SaveDoubt::LinkLost,
        }),
        other => other,
    };
    let (noting, noted) = (backups.clone(), result.clone().ok());
    let not_noted = on_thread(move || match noted {
        Some(saved) => noting.note_result(&saved),
        // An attempt that was not sent must not be noted as having an unknown result.
        None => noting.note_not_done(),
    });
    let not_noted = not_noted.await.err();
    Ok((result?, not_noted.map(SystemError::from)))
}

fn no_backup(error: io::Error) -> TaskError {
    TaskError::NoBackup(BackupError::System(error.into()))
}
