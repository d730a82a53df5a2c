//! Writing persistent rows of a hand: all rows are read first, then each group is written at rest and read back.

use crate::hand::Setting;
use crate::hand::overshoot::OvershootMap;
use crate::link::{LinkHandle, RequestError};
use crate::params::backups::Backups;
use crate::params::changes::{self, RowOutcome, RowVerdict, WritePlan};
use crate::params::danger::worse;
use crate::params::place::WhichPlace;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::record::{NotSent, Verdict, Written};
use crate::tasks::hand::{REACH_TIMEOUT, answers, once_at_rest};
use crate::tasks::save::back_up;
use crate::tasks::{Question, Risks, TaskError, TaskStep, User, read};
use std::path::PathBuf;
use std::sync::Arc;

/// Rows to apply, with their conditions.
#[derive(Debug, Clone)]
pub struct Apply {
    /// Rows and their new values.
    pub wanted: Params,
    /// Risks that the user confirmed already.
    pub agreed: Risks,
    /// Location of the backup that precedes the first write; `None` makes no backup.
    pub backups: Option<Backups>,
    /// Reaction if not every row was applied.
    pub otherwise: Otherwise,
    /// Overshoot of the hand, as measured by trials.
    pub overshoot: Arc<OvershootMap>,
}

/// Reaction if not every row was applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Otherwise {
    /// Rows that were already written remain as they are.
    Stay,
    /// The hand gets its previous values back.
    Undo,
}

/// Outcome of applying parameters, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// Parameters before the first write.
    pub before: Params,
    /// Backup, if one was requested and a row had to be written.
    pub backup: Option<PathBuf>,
    /// Rows that had to be written, or already had the requested value; with the values that the hand holds at the end, also after an
    /// undo.
    pub rows: Vec<RowOutcome>,
    /// True if the hand holds its previous values again; `None` if there was no undo.
    pub undone: Option<bool>,
    /// Reason for which the remaining rows were not written, if the link refused a request.
    pub broken_off: Option<RequestError>,
}

impl Applied {
    /// True if every row is in force.
    pub fn is_whole(&self) -> bool {
        let applied = |row: &RowOutcome| row.verdict == RowVerdict::Applied;
        self.broken_off.is_none() && self.rows.iter().all(applied)
    }
}

/// Applies rows. Rows that already have the requested value are not written. The user is asked about risks, and again if reading the
/// hand once more shows others.
///
/// # Errors
/// [`TaskError`]: nothing was written.
pub async fn apply(
    hand: &LinkHandle,
    task: &Apply,
    user: &mut impl User,
    mut notify: impl FnMut(TaskStep),
) -> Result<Applied, TaskError> {
    let mut agreed = task.agreed.clone();
    let (before, plan) = loop {
        let on_read = |span, bytes: &[u8]| notify(TaskStep::Read(span, bytes.to_vec()));
        let rows = read::rows(hand, on_read).await;
        let is_needed = |id| task.backups.is_some() || task.wanted.get(id).is_some();
        let before = rows.with(is_needed)?;
        let plan = changes::plan_writes(&task.wanted, &before);
        let risks = Risks {
            dangers: worse(&before, &before.with(&plan.rows), &task.overshoot),
            places: plan.rows.only(ParamId::is_place),
        };
        if agreed.contain(&risks) {
            break (before, plan);
        }
        if !user.ask(Question::Apply(risks.clone())).await {
            return Err(TaskError::Declined(risks));
        }
        agreed = risks;
    };
    let mut applied = Applied {
        backup: None,
        rows: changes::held_already(&task.wanted, &plan, &before),
        undone: None,
        broken_off: None,
        before,
    };
    if plan.settings.is_empty() {
        return Ok(applied);
    }
    if let Some(backups) = &task.backups {
        applied.backup = Some(back_up(backups, &applied.before, "before apply").await?);
    }
    notify(TaskStep::Writing(WhichPlace::Old));
    let (written, broken_off) = write(hand, &plan, &applied.before).await;
    for row in &written {
        notify(TaskStep::Row(row.clone()));
    }
    applied.rows.extend(written);
    applied.broken_off = broken_off;
    if !applied.is_whole() && task.otherwise == Otherwise::Undo {
        applied.undone = Some(undo(hand, &mut applied.rows).await);
    }
    Ok(applied)
}

/// Writes all settings of a plan. After a setting that was not sent because the user armed meanwhile, no further group is sent.
async fn write(
    hand: &LinkHandle,
    plan: &WritePlan,
    before: &Params,
) -> (Vec<RowOutcome>, Option<RequestError>) {
    let mut rows = Vec::new();
    for setting in &plan.settings {
        let written = match write_one(hand, *setting).await {
            Ok(written) => written,
            Err(error) => return (rows, Some(error)),
        };
        rows.extend(changes::outcomes(plan, before, setting, &written));
        if written.verdict == Verdict::NotSent(NotSent::Armed) {
            break;
        }
    }
    (rows, None)
}

/// Writes one group. If its values are not known afterwards, the group is read once more, also after a reconnect.
async fn write_one(hand: &LinkHandle, setting: Setting) -> Result<Written, RequestError> {
    let not_sent = |written: &Written| match written.verdict {
        Verdict::NotSent(why) => Some(why),
        _ => None,
    };
    let written = once_at_rest(|| hand.set_kept(setting), not_sent).await?;
    if !matches!(written.verdict, Verdict::Unverified { .. }) {
        return Ok(written);
    }
    if !answers(hand, REACH_TIMEOUT).await {
        return Ok(written);
    }
    Ok(match read::group(hand, written.span).await {
        Ok(bytes) => Written {
            verdict: Verdict::Differs,
            holds: Some(bytes),
            ..written
        },
        Err(_) => written,
    })
}

/// Restores rows that changed or may have changed, and updates `rows` with the values read back; true if the hand holds its previous
/// values.
async fn undo(hand: &LinkHandle, rows: &mut [RowOutcome]) -> bool {
    let wanted = changes::undo_of(rows);
    if wanted.is_empty() {
        return true;
    }
    let live = read::rows(hand, |_, _| ()).await.params;
    let plan = if live.is_empty() {
        WritePlan::default()
    } else {
        changes::plan_writes(&wanted, &live)
    };
    let (put_back, _broken_off) = write(hand, &plan, &live).await;
    for row in rows.iter_mut().filter(|row| wanted.get(row.id).is_some()) {
        let written = put_back.iter().find(|back| back.id == row.id);
        let holds = match written.map(|back| (&back.verdict, back.holds)) {
            Some((RowVerdict::NotSent(_), _)) => live.get(row.id),
            Some((_, holds)) => holds,
            None => live.get(row.id).filter(|_| plan.rows.get(row.id).is_none()),
        };
        changes::after_undo(row, holds);
    }
    let is_back = |row: &RowOutcome| row.holds.is_some() && row.holds == row.before;
    let mut meant = rows.iter().filter(|row| wanted.get(row.id).is_some());
    meant.all(is_back)
}
