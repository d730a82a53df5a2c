//! Everything the window shows, as plain values. Changed only by `update`; draws nothing, opens nothing.

use crate::app::device::book::{DeviceBook, Doing};
use crate::app::faults::FaultBook;
use crate::app::gestures::GestureBook;
use crate::app::guard::Guarded;
use crate::app::history::History;
use crate::app::notices::Notices;
use crate::app::peaks::ForcePeaks;
use crate::app::poses::book::PoseBook;
use crate::app::quirk_sheet::QuirkSheet;
use crate::app::recorder::Recorder;
use crate::app::scan::ScanBook;
use crate::app::settings::Settings;
use crate::app::tare::Tare;
use crate::app::tuner::TunerBook;
use crate::hand::{Angle, Force, HandSample, Moment, PerDof, Speed};
use crate::link::motion::arm_refusal;
use crate::link::{ArmRefusal, LinkState, LinkStats, LinkStatus, Traffic};
use crate::transport::Endpoint;
use std::time::Duration;

/// A value older than this is shown as old: two poll periods, and never less than a quarter second.
pub const STALE_AFTER: Duration = Duration::from_millis(250);

/// Everything the window shows.
#[derive(Debug, Clone)]
pub struct State {
    /// The time of this frame.
    pub now: Moment,
    /// The hand that is wanted; `None` after a disconnect.
    pub endpoint: Option<Endpoint>,
    /// Where the link stands.
    pub link: LinkStatus,
    /// What the link measured of itself.
    pub stats: LinkStats,
    /// The newest of everything the hand said, with its times. Kept when the link is lost, and then old.
    pub sample: HandSample,
    /// What the tactile channels are counted from.
    pub tare: Tare,
    /// The highest forces of the last seconds.
    pub peaks: ForcePeaks,
    /// The six joints as a person sets them.
    pub joints: PerDof<Joint>,
    /// What was measured over the last minutes.
    pub history: History,
    /// Faults now and before.
    pub faults: FaultBook,
    /// What happened around them.
    pub recorder: Recorder,
    /// What a person should read.
    pub notices: Notices,
    /// Gestures and their names.
    pub gestures: GestureBook,
    /// The person's own poses and sequences.
    pub poses: PoseBook,
    /// What the hand keeps, and what of it is to be changed.
    pub device: DeviceBook,
    /// Grasp trials.
    pub tuner: TunerBook,
    /// What went over the wire, as far as it was looked at.
    pub traffic: Traffic,
    /// Serial ports found when last looked.
    pub ports: Vec<PortChoice>,
    /// The newest scan for hands.
    pub scan: ScanBook,
    /// What is kept about this hand; `None` for the built-in one, and until it was kept.
    pub sheet: Option<QuirkSheet>,
    /// What is done under a card now.
    pub guard: Option<Guarded>,
    /// What is kept from one start to the next.
    pub settings: Settings,
}

/// One joint as a person sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joint {
    /// Where the slider stands: the actual angle while not armed, the person's wish while armed. `None` = not known.
    pub target: Option<Angle>,
    /// Force threshold; sent at arming and when changed while armed.
    pub force: Force,
    /// Speed; sent at arming and when changed while armed.
    pub speed: Speed,
    /// Leave this joint alone.
    pub locked: bool,
}

/// One serial port that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortChoice {
    /// Path or name to open.
    pub path: String,
    /// Maker, product and serial number, if it is a USB adapter.
    pub about: Option<String>,
}

/// How much a shown value can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freshness {
    /// Never read on this connection: shown as "-".
    Unknown,
    /// From a live link and young.
    Live,
    /// Older than [`STALE_AFTER`], or the link is gone: greyed out, with its age.
    Stale,
}

impl State {
    /// Whether the built-in hand is shown.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.endpoint.as_ref().is_some_and(Endpoint::is_sim)
    }

    /// How fresh a value asked for at `asked` is now.
    #[must_use]
    pub fn freshness(&self, asked: Option<Moment>) -> Freshness {
        match asked {
            None => Freshness::Unknown,
            Some(_) if !self.link.state.is_live() => Freshness::Stale,
            Some(at) if self.now.since(at) > STALE_AFTER => Freshness::Stale,
            Some(_) => Freshness::Live,
        }
    }

    /// The pose that the hand has, if all six angles are known, live and fresh.
    #[must_use]
    pub fn pose_now(&self) -> Option<PerDof<Angle>> {
        let angle = self.sample.angle?;
        let live = self.freshness(Some(angle.asked)) == Freshness::Live;
        let angles = angle.value.map(crate::hand::AngleReading::hold).all();
        angles.filter(|_| live)
    }

    /// The hand's name in files and lists; empty without one.
    #[must_use]
    pub fn hand_name(&self) -> String {
        self.endpoint
            .as_ref()
            .map(ToString::to_string)
            .unwrap_or_default()
    }

    /// Lets the recorder go on.
    pub(crate) fn record(&mut self) {
        let hand = self.hand_name();
        self.recorder.tick(&self.history, &hand, self.now);
    }

    /// True while setpoints pass.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.link.state == LinkState::Armed
    }

    /// Why the hand cannot be armed now; `None` if it can or already is. The link asks the same again.
    #[must_use]
    pub fn arm_refusal(&self) -> Option<ArmRefusal> {
        let saves = self.link.state.is_live() && self.device.doing == Doing::Saving;
        let busy = saves.then_some(ArmRefusal::HandBusy);
        busy.or_else(|| arm_refusal(self.link.state, &self.sample, self.now))
    }
}
