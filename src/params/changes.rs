//! Turns new values into writes, and the results of writes into a verdict on each row. Sends nothing.

use crate::hand::{Dof, Force, HandId, PerDof, Refusal, SerialSpeed, Setting, Speed};
use crate::params::rows::{ParamId, Value};
use crate::params::values::{Params, decoded};
use crate::record::{Doubt, NotSent, Verdict, Written};

/// The writes for a set of values, in order. Rows that the hand already holds are not written.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct WritePlan {
    /// Rows and their new values.
    pub rows: Params,
    /// One write per group: defaults first, rows that change the hand's address last.
    pub settings: Vec<Setting>,
}

/// Verdict on writing one row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RowVerdict {
    /// Read back as written.
    Applied,
    /// Refused by the hand, or by the rule against unsafe writes.
    Refused { reason: Refusal },
    /// Not refused, but the hand still holds its old value.
    Dropped,
    /// The hand holds a third value, neither the written nor the old one.
    Altered,
    /// Applied, then reverted because other rows failed: the hand holds its old value.
    PutBack,
    /// The hand's value is unknown.
    Unverified(Doubt),
    /// Not written.
    NotSent(NotSent),
}

impl RowVerdict {
    /// Stable name in files and JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Applied => "applied",
            Self::Refused { .. } => "refused",
            Self::Dropped => "dropped",
            Self::Altered => "altered",
            Self::PutBack => "put_back",
            Self::Unverified(_) => "unverified",
            Self::NotSent(_) => "not_sent",
        }
    }
}

/// Outcome of writing one row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowOutcome {
    pub id: ParamId,
    pub wanted: Value,
    /// The value before; `None` if it was unknown.
    pub before: Option<Value>,
    /// The value now; `None` if it could not be read back.
    pub holds: Option<Value>,
    pub verdict: RowVerdict,
}

/// The writes that change a hand from `live` to `wanted`, for the rows in `wanted`. Values out of range are left out; files with
/// such values are rejected earlier.
pub fn plan_writes(wanted: &Params, live: &Params) -> WritePlan {
    let rows = wanted.only(|id| {
        let value = wanted.get(id);
        value != live.get(id) && value.is_some_and(|value| id.allows(value))
    });
    let number = |id| match rows.get(id) {
        Some(Value::Number(number)) => Some(i64::from(number)),
        _ => None,
    };
    let speeds =
        PerDof::from_fn(|dof| number(ParamId::DefaultSpeed(dof)).and_then(|n| Speed::new(n).ok()));
    let forces =
        PerDof::from_fn(|dof| number(ParamId::DefaultForce(dof)).and_then(|n| Force::new(n).ok()));
    let mut settings = Vec::new();
    if Dof::ALL.iter().any(|dof| speeds[*dof].is_some()) {
        settings.push(Setting::DefaultSpeeds(speeds));
    }
    if Dof::ALL.iter().any(|dof| forces[*dof].is_some()) {
        settings.push(Setting::DefaultForces(forces));
    }
    if let Some(Value::Address(address)) = rows.get(ParamId::IpAddress) {
        settings.push(Setting::IpAddress(address));
    }
    let speed = number(ParamId::ReduRatio).and_then(SerialSpeed::of_code);
    settings.extend(speed.map(Setting::SerialSpeed));
    let id = number(ParamId::HandId).and_then(|id| HandId::new(id).ok());
    settings.extend(id.map(Setting::Id));
    WritePlan { rows, settings }
}

/// Outcomes of the rows that the hand already holds and that are not written.
pub fn held_already(wanted: &Params, plan: &WritePlan, before: &Params) -> Vec<RowOutcome> {
    let held = wanted.only(|id| plan.rows.get(id).is_none());
    let outcomes = held.iter().map(|(id, wanted)| RowOutcome {
        id,
        wanted,
        before: before.get(id),
        holds: before.get(id),
        verdict: RowVerdict::Applied,
    });
    outcomes.collect()
}

/// Outcomes of the rows that a setting writes.
pub fn outcomes(
    plan: &WritePlan,
    before: &Params,
    setting: &Setting,
    written: &Written,
) -> Vec<RowOutcome> {
    let rows = plan.rows.iter().filter(|(id, _)| belongs(*id, setting));
    let ends = rows.map(|(id, wanted)| {
        let before = before.get(id);
        let bytes = written.holds.as_deref();
        let holds = bytes.and_then(|bytes| decoded(id, written.span, bytes));
        RowOutcome {
            id,
            wanted,
            before,
            holds,
            verdict: judged(wanted, before, holds, &written.verdict),
        }
    });
    ends.collect()
}

fn judged(
    wanted: Value,
    before: Option<Value>,
    holds: Option<Value>,
    verdict: &Verdict,
) -> RowVerdict {
    match (verdict, holds) {
        (Verdict::NotSent(why), _) => RowVerdict::NotSent(*why),
        (_, Some(holds)) if holds == wanted => RowVerdict::Applied,
        (Verdict::Refused { reason }, _) => RowVerdict::Refused { reason: *reason },
        (Verdict::Unverified { why }, _) => RowVerdict::Unverified(*why),
        (_, None) => RowVerdict::Unverified(Doubt::NotReadBack),
        (_, Some(_)) if holds == before => RowVerdict::Dropped,
        (_, Some(_)) => RowVerdict::Altered,
    }
}

const fn belongs(id: ParamId, setting: &Setting) -> bool {
    matches!(
        (id, setting),
        (ParamId::HandId, Setting::Id(_))
            | (ParamId::ReduRatio, Setting::SerialSpeed(_))
            | (ParamId::IpAddress, Setting::IpAddress(_))
            | (ParamId::DefaultSpeed(_), Setting::DefaultSpeeds(_))
            | (ParamId::DefaultForce(_), Setting::DefaultForces(_))
    )
}

/// The values to write back to restore the hand: those of rows that changed, or may have.
pub fn undo_of(outcomes: &[RowOutcome]) -> Params {
    let mut wanted = Params::default();
    for end in outcomes {
        let is_changed = end.holds != end.before && !matches!(end.verdict, RowVerdict::NotSent(_));
        if let Some(before) = end.before.filter(|_| is_changed) {
            wanted.put(end.id, before);
        }
    }
    wanted
}

/// Updates the outcome of a row after its old value was written back; `holds` is the value read then.
pub fn after_undo(row: &mut RowOutcome, holds: Option<Value>) {
    row.holds = holds;
    if row.verdict != RowVerdict::Applied {
        return;
    }
    row.verdict = match holds {
        None => RowVerdict::Unverified(Doubt::NotReadBack),
        Some(holds) if Some(holds) == row.before => RowVerdict::PutBack,
        Some(holds) if holds == row.wanted => RowVerdict::Applied,
        Some(_) => RowVerdict::Altered,
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::DEFAULT_SPEED_SET;

    const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);
    const RING: ParamId = ParamId::DefaultSpeed(Dof::Ring);

    fn params(rows: &[(ParamId, i32)]) -> Params {
        let mut params = Params::default();
        for (id, number) in rows {
            params.put(*id, Value::Number(*number));
        }
        params
    }

    #[test]
    fn only_rows_that_differ_are_written_and_where_the_hand_is_comes_last() {
        let live = params(&[(INDEX, 1000), (RING, 200), (ParamId::HandId, 1)]);
        let wanted = params(&[(INDEX, 300), (RING, 200), (ParamId::HandId, 7)]);
        let plan = plan_writes(&wanted, &live);
        let mut speeds = PerDof::splat(None);
        speeds[Dof::Index] = Some(Speed::nearest(300));
        let id = HandId::nearest(7);
        assert_eq!(
            plan.settings,
            [Setting::DefaultSpeeds(speeds), Setting::Id(id)]
        );
        assert_eq!(plan.rows, params(&[(INDEX, 300), (ParamId::HandId, 7)]));
        assert_eq!(plan_writes(&live, &live), WritePlan::default());
    }

    #[test]
    fn what_may_not_be_written_is_in_no_plan() {
        let wanted = params(&[(INDEX, 1001), (ParamId::HandId, 0), (ParamId::ReduRatio, 4)]);
        assert_eq!(
            plan_writes(&wanted, &Params::default()),
            WritePlan::default()
        );
    }

    #[test]
    fn each_row_has_its_own_verdict_and_undo_wants_only_what_changed() {
        let before = params(&[(INDEX, 1000), (RING, 1000)]);
        let plan = plan_writes(&params(&[(INDEX, 700), (RING, 400)]), &before);
        let span = DEFAULT_SPEED_SET.span();
        let mut bytes = 1000i16.to_le_bytes().repeat(6);
        bytes[6..8].copy_from_slice(&500i16.to_le_bytes());
        bytes[2..4].copy_from_slice(&400i16.to_le_bytes());
        let setting = plan.settings[0];
        let end = |verdict, holds| {
            let written = Written {
                span,
                verdict,
                holds,
            };
            outcomes(&plan, &before, &setting, &written)
        };
        let told = end(Verdict::Differs, Some(bytes));
        let verdicts: Vec<_> = told
            .iter()
            .map(|end| (end.id, end.verdict.name()))
            .collect();
        assert_eq!(verdicts, [(RING, "applied"), (INDEX, "altered")]);
        assert_eq!(undo_of(&told), before);

        let dropped = end(Verdict::Differs, Some(1000i16.to_le_bytes().repeat(6)));
        assert!(dropped.iter().all(|end| end.verdict == RowVerdict::Dropped));
        assert!(undo_of(&dropped).is_empty());

        let why = Doubt::LinkLost;
        let unknown = end(Verdict::Unverified { why }, None);
        assert!(
            unknown
                .iter()
                .all(|end| end.verdict == RowVerdict::Unverified(why))
        );
        assert_eq!(
            undo_of(&unknown),
            before,
            "what is not known may have changed"
        );

        let armed = end(Verdict::NotSent(NotSent::Armed), None);
        assert!(undo_of(&armed).is_empty());
    }
}
