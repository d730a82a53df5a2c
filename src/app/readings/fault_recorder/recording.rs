//! One recording: all measurements around a fault, independent of the history that they came from; and the events between
//! them, which are user actions and changes of a drive's status and faults.

use crate::app::readings::faults::FaultKind;
use crate::hand::{
    Angle, Dof, Faults, Finger, Force, Moment, PerDof, Quantity, Speed, Status, Touch,
};
use crate::history::{History, Series, Table, TableGroup};
use crate::poses::{Play, Preset};
use std::sync::Arc;

/// ID of a recording, unique in this run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaultRecordingId(pub u64);

/// A fault that occurred during the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultAt {
    pub at: Moment,
    pub dof: Dof,
    pub what: FaultKind,
}

/// State of one drive; `None` = not read yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DriveState {
    pub status: Option<Status>,
    /// ERROR register.
    pub faults: Option<Faults>,
}

/// All measurements and events around a fault.
#[derive(Debug, Clone)]
pub struct FaultRecording {
    pub id: FaultRecordingId,
    /// Endpoint of the hand, as text.
    pub hand: String,
    /// Faults, oldest first; at least one.
    pub faults: Vec<FaultAt>,
    /// Start of the recording; measurements may start later.
    pub from: Moment,
    /// End of the recording.
    pub to: Moment,
    /// Measurements, with the marks.
    pub history: History,
    /// Drive states at the start.
    pub before: PerDof<DriveState>,
    /// User actions and drive changes, oldest first.
    pub events: Vec<FaultEvent>,
    /// Number of events that were dropped for lack of space.
    pub events_lost: u64,
}

impl FaultRecording {
    /// The fault that triggered the recording.
    pub fn fault(&self) -> Option<FaultAt> {
        self.faults.first().copied()
    }

    /// True if the recording contains this fault of this joint, started at this moment.
    pub fn holds(&self, dof: Dof, what: FaultKind, since: Moment) -> bool {
        let mut all = self.faults.iter();
        all.any(|fault| fault.dof == dof && fault.what == what && fault.at == since)
    }

    /// Exports the recording as one table: all measurements, status and fault byte of each drive at each change, and
    /// the events.
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
            FaultEventKind::UserAct(act) => Some((event.at.secs(), act.words())),
            FaultEventKind::Status(..) | FaultEventKind::Faults(..) => None,
        });
        table.with(self.drives(), acts.collect())
    }

    /// Status and fault byte of all drives, one row per change.
    fn drives(&self) -> TableGroup {
        let mut now = self.before;
        let mut rows = vec![(self.from, now)];
        for event in &self.events {
            match event.what {
                FaultEventKind::Status(dof, status) => now[dof].status = Some(status),
                FaultEventKind::Faults(dof, faults) => now[dof].faults = Some(faults),
                FaultEventKind::UserAct(_) => continue,
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

/// A user action that sends something to the hand, or ends the sending.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UserAct {
    /// The hand was disarmed.
    Disarm,
    /// A target angle was set for a joint.
    Target(Dof, Angle),
    /// The force threshold of one joint (`None` = all) was set.
    Force(Option<Dof>, Force),
    /// The speed of one joint (`None` = all) was set.
    Speed(Option<Dof>, Speed),
    /// A joint was locked (true) or unlocked.
    Lock(Dof, bool),
    /// A preset was started: open, half or close.
    Preset(Preset),
    /// A pose of the library was started, by name.
    Pose(Arc<str>),
    /// A sequence was started, stepped, paused or ended.
    Play(Play),
    /// Clearing of errors was requested.
    ClearErrors,
}

impl UserAct {
    /// True if both change the same control, so that the later one of a rapid series replaces the earlier.
    pub(crate) fn is_same_knob(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Target(one, _), Self::Target(two, _)) => one == two,
            (Self::Force(one, _), Self::Force(two, _))
            | (Self::Speed(one, _), Self::Speed(two, _)) => one == two,
            _ => false,
        }
    }

    /// Stable lower-case text for files.
    pub fn words(&self) -> String {
        let joints = |dof: &Option<Dof>| dof.map_or("of all", Dof::name);
        match self {
            Self::Disarm => "disarmed".into(),
            Self::Target(dof, angle) => format!("target {} {}", dof.name(), angle.get()),
            Self::Force(dof, force) => format!("force threshold {} {}", joints(dof), force.get()),
            Self::Speed(dof, speed) => format!("speed {} {}", joints(dof), speed.get()),
            Self::Lock(dof, true) => format!("lock {}", dof.name()),
            Self::Lock(dof, false) => format!("unlock {}", dof.name()),
            Self::Preset(Preset::Open) => "open all".into(),
            Self::Preset(Preset::Half) => "half".into(),
            Self::Preset(Preset::Close) => "close".into(),
            Self::Pose(name) => format!("pose {name}"),
            Self::Play(Play::Start(_)) => "sequence start".into(),
            Self::Play(Play::Step(_)) => "sequence step".into(),
            Self::Play(Play::Pause) => "sequence pause".into(),
            Self::Play(Play::Resume) => "sequence resume".into(),
            Self::Play(Play::End) => "sequence end".into(),
            Self::ClearErrors => "clear errors".into(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FaultEventKind {
    /// A user action.
    UserAct(UserAct),
    /// The status of a drive changed.
    Status(Dof, Status),
    /// The fault bits of a drive changed.
    Faults(Dof, Faults),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaultEvent {
    pub at: Moment,
    pub what: FaultEventKind,
}
