//! One recording: everything that was measured and done around a fault, free of the history it came from.

use crate::app::readings::fault_recorder::event::{FaultEvent, FaultEventKind};
use crate::app::readings::faults::FaultKind;
use crate::hand::{Dof, Faults, Finger, Moment, PerDof, Status};
use crate::hand::{Quantity, Touch};
use crate::history::{History, Series, Table, TableGroup};

/// A recording for as long as the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaultRecordingId(pub u64);

/// A fault that came while it was recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultAt {
    pub at: Moment,
    /// Of which joint.
    pub dof: Dof,
    pub what: FaultKind,
}

/// What one drive says. `None` = not read yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DriveState {
    pub status: Option<Status>,
    /// ERROR.
    pub faults: Option<Faults>,
}

/// Everything around a fault.
#[derive(Debug, Clone)]
pub struct FaultRecording {
    /// To find it.
    pub id: FaultRecordingId,
    /// The hand, in the spelling of endpoints.
    pub hand: String,
    /// The faults, oldest first, at least one.
    pub faults: Vec<FaultAt>,
    /// From here; measurements may begin later.
    pub from: Moment,
    /// To here.
    pub to: Moment,
    /// What was measured, with the marks.
    pub history: History,
    /// What the drives said at first.
    pub before: PerDof<DriveState>,
    /// What was done and how the drives changed, oldest first.
    pub events: Vec<FaultEvent>,
    /// Events of this time that were not kept, because there were too many.
    pub events_lost: u64,
}

impl FaultRecording {
    /// The fault that began it.
    pub fn fault(&self) -> Option<FaultAt> {
        self.faults.first().copied()
    }

    /// True if it holds this fault of this joint, come at this moment.
    pub fn holds(&self, dof: Dof, what: FaultKind, since: Moment) -> bool {
        let mut all = self.faults.iter();
        all.any(|fault| fault.dof == dof && fault.what == what && fault.at == since)
    }

    /// Everything as one table: all measurements, status and fault byte of each drive where they changed, and what
    /// happened.
    pub fn table(&self) -> Table {
        let joints = Quantity::ALL.into_iter();
        let joints = joints.flat_map(|quantity| Dof::ALL.map(|dof| Series::Joint(quantity, dof)));
        let tips = Touch::ALL.into_iter();
        let tips = tips.flat_map(|touch| Finger::ALL.map(|finger| Series::Tip(touch, finger)));
        let series: Vec<Series> = joints.chain(tips).collect();
        let table = self
            .history
            .table(&series, self.from.secs(), self.to.secs());
        let acts = self.events.iter().filter_map(|event| match &event.what {
            FaultEventKind::PersonAct(act) => Some((event.at.secs(), act.words())),
            FaultEventKind::Status(..) | FaultEventKind::Faults(..) => None,
        });
        table.with(self.drives(), acts.collect())
    }

    /// Status and fault byte of all drives, a row for each change.
    fn drives(&self) -> TableGroup {
        let mut now = self.before;
        let mut rows = vec![(self.from, now)];
        for event in &self.events {
            match event.what {
                FaultEventKind::Status(dof, status) => now[dof].status = Some(status),
                FaultEventKind::Faults(dof, faults) => now[dof].faults = Some(faults),
                FaultEventKind::PersonAct(_) => continue,
            }
            rows.push((event.at, now));
        }
        let column = |name: &str, dof: Dof, raw: fn(DriveState) -> Option<u8>| {
            let values = rows
                .iter()
                .map(|(_, all)| raw(all[dof]).map_or(f32::NAN, f32::from));
            (format!("{name}_{}", dof.name()), values.collect())
        };
        let status = Dof::ALL.map(|dof| column("status", dof, |state| Some(state.status?.raw())));
        let faults = Dof::ALL.map(|dof| column("faults", dof, |state| Some(state.faults?.raw())));
        TableGroup {
            times: rows.iter().map(|(at, _)| at.secs()).collect(),
            columns: status.into_iter().chain(faults).collect(),
        }
    }
}
