//! Writing rows that a hand keeps: read first, then each group written at rest and read back.

use crate::hand::Setting;
use crate::hand::overshoot::OvershootMap;
use crate::link::{LinkHandle, RequestError};
use crate::params::backups::Backups;
use crate::params::changes::{self, RowOutcome, RowVerdict, WritePlan};
use crate::params::danger::worse;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::record::{NotSent, Verdict, Written};
use crate::tasks::hand::{REACH_TIMEOUT, answers, once_at_rest};
use crate::tasks::save::back_up;
use crate::tasks::{Consent, ParamStep, Risks, TaskError, read};
use std::path::PathBuf;
use std::sync::Arc;

/// What is to be written, and how.
#[derive(Debug, Clone)]
pub struct Apply {
    /// The rows and their new values.
    pub wanted: Params,
    /// What the user agreed to.
    pub consent: Consent,
    /// Where a backup goes before anything is written; none is made without.
    pub backups: Option<Backups>,
    /// What follows if not every row was applied.
    pub otherwise: Otherwise,
    /// What trials measured of the hand.
    pub overshoot: Arc<OvershootMap>,
}

/// What follows if not every row was applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Otherwise {
    /// Rows that were already written stay as they are.
    Stay,
    /// The hand gets back what it held.
    Undo,
}

/// Outcome of applying parameters, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// What the hand held before.
    pub before: Params,
    /// The backup, if one was asked for and something had to be written.
    pub backup: Option<PathBuf>,
    /// The rows that had to be written, or were as wanted already; with what the hand holds at the end, also after it was to get
    /// back what it held.
    pub rows: Vec<RowOutcome>,
    /// Whether the hand holds again what it held, if it was to get it back.
    pub undone: Option<bool>,
    /// Why the rest was not written, if the link could not take it.
    pub broken_off: Option<RequestError>,
}

impl Applied {
    /// True if every row is in force.
    pub fn is_whole(&self) -> bool {
        let applied = |row: &RowOutcome| row.verdict == RowVerdict::Applied;
        self.broken_off.is_none() && self.rows.iter().all(applied)
    }
}

/// Applies rows. Rows that the hand holds already are not written.
///
/// # Errors
/// [`TaskError`]: then nothing was written.
pub async fn apply(
    hand: &LinkHandle,
    task: &Apply,
    mut notify: impl FnMut(ParamStep),
) -> Result<Applied, TaskError> {
    let on_read = |span, bytes: &[u8]| notify(ParamStep::Read(span, bytes.to_vec()));
    let rows = read::rows(hand, on_read).await;
    let is_needed = |id| task.backups.is_some() || task.wanted.get(id).is_some();
    let before = rows.with(is_needed)?;
    let plan = changes::plan_writes(&task.wanted, &before);
    let risks = Risks {
        dangers: worse(&before, &before.with(&plan.rows), &task.overshoot),
        places: plan.rows.only(ParamId::is_place),
    };
    task.consent.check(&risks)?;
    notify(ParamStep::Meant(risks));
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
    notify(ParamStep::Writing);
    let (written, broken_off) = write(hand, &plan, &applied.before).await;
    for row in &written {
        notify(ParamStep::Row(row.clone()));
    }
    applied.rows.extend(written);
    applied.broken_off = broken_off;
    if !applied.is_whole() && task.otherwise == Otherwise::Undo {
        applied.undone = Some(undo(hand, &mut applied.rows).await);
    }
    Ok(applied)
}

/// Writes all settings of a plan. What did not go out because the user armed meanwhile does not go out for the next group
/// either.
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

/// Writes one group. If it is not known what the hand holds then, it is read once more, on a link that came back.
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

/// Puts back what changed or may have; true if the hand holds what it held before. What it holds then stands in the rows.
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
