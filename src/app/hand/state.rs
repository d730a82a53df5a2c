//! Everything about one hand in one value: its link, the newest readings, what was measured, faults, setpoints, tasks.

use crate::app::hand::held_key::HeldKey;
use crate::app::hand::joint::JointControl;
use crate::app::hand::open::{Leaving, OpenLink, Pending};
use crate::app::hand::sequence::SequenceRun;
use crate::app::hand::slot::{HandLabel, place_name};
use crate::app::inputs::HandInputs;
use crate::app::params::state::ParamsState;
use crate::app::procedures::procedure::Procedure;
use crate::app::procedures::reach::GoRequest;
use crate::app::readings::fault_recorder::FaultRecorder;
use crate::app::readings::faults::FaultList;
use crate::app::readings::pace::ReadingPace;
use crate::app::readings::peaks::ForcePeaks;
use crate::app::readings::tare::Tare;
use crate::app::sessions::recording::HandRecording;
use crate::app::settings::Settings;
use crate::app::trials::run::SeriesRun;
use crate::hand::kinematics::Side;
use crate::hand::{Angle, AngleReading, Finger, Gesture, HandSample, Moment, PerDof, PerFinger};
use crate::history::History;
use crate::link::session::motion::arm_refusal;
use crate::link::{LinkStats, LinkStatus, Traffic};
use crate::record::{ArmRefusal, LinkState};
use crate::transport::Endpoint;
use tokio::sync::mpsc;

/// How much a shown value can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freshness {
    /// Never read on this connection: shown as "-".
    Unknown,
    /// From a live link and young.
    Live,
    /// Older than about three readings of this wire take, or the link is gone: greyed out, with its age.
    Stale,
}

/// Everything about one hand.
#[derive(Debug, Default)]
pub struct HandState {
    /// The time of this frame.
    pub now: Moment,
    /// Which of several, and what it is called.
    pub label: HandLabel,
    /// Left or right, as the person says: no register does.
    pub side: Side,
    /// The hand that is wanted; `None` after a disconnect.
    pub endpoint: Option<Endpoint>,
    /// Where the link stands.
    pub link: LinkStatus,
    /// What the link measured of itself.
    pub stats: LinkStats,
    /// The newest of everything the hand said, with its times. Kept when the link is lost, and then old.
    pub sample: HandSample,
    /// How often angles, and with them what else tells the motion, are read.
    pub pace: ReadingPace,
    /// How often a fingertip is read.
    pub tip_pace: PerFinger<ReadingPace>,
    /// What the tactile channels are counted from.
    pub tare: Tare,
    /// The highest forces of the last seconds.
    pub peaks: ForcePeaks,
    /// The six joints as a person sets them.
    pub joints: PerDof<JointControl>,
    /// What was measured over the last minutes.
    pub history: History,
    /// Faults now and before.
    pub faults: FaultList,
    /// What happened around them.
    pub recorder: FaultRecorder,
    /// The stored gesture that was started last, unless it failed.
    pub gesture: Option<Gesture>,
    /// What besides the window may move the hand, and who uses it.
    pub inputs: HandInputs,
    /// The sequence that runs, or ran last.
    pub sequence: Option<SequenceRun>,
    /// What the hand keeps, and what of it is to be changed.
    pub params: ParamsState,
    /// What is done under a card.
    pub procedure: Option<Procedure>,
    /// The series of trials that runs.
    pub series: Option<SeriesRun>,
    /// The session that is recorded of it.
    pub recording: Option<HandRecording>,
    /// What went over the wire, as far as it was looked at.
    pub traffic: Traffic,
    /// Where the task under the card wants the link.
    pub(crate) requested: Option<mpsc::UnboundedReceiver<GoRequest>>,
    pub(crate) open: Option<OpenLink>,
    /// The hand is being left: it was told to hold.
    pub(crate) leaving: Option<Leaving>,
    /// Requests whose end is awaited.
    pub(crate) asked: Vec<Pending>,
    /// Sliders that show where the joint was sent; the others show the actual angle.
    pub(crate) steered: PerDof<bool>,
    /// No arming from before this moment counts, whatever the link still says.
    pub(crate) disarmed_at: Option<Moment>,
    /// What a person holds to let the hand move.
    pub(crate) held: HeldKey,
    /// Something was sent on this connection that may move the hand.
    pub(crate) commanded: bool,
    /// Angles received before this belong to a connection that is gone.
    pub(crate) seen_from: Option<Moment>,
    pub(crate) was_live: bool,
    /// Its slot goes as soon as it is left.
    pub(crate) is_removed: bool,
    /// The hand whose files were looked at last.
    pub(crate) listed: Option<Endpoint>,
    /// The hand that the history is of.
    pub(crate) measured: Option<Endpoint>,
}

impl HandState {
    /// Whether it is the built-in hand.
    pub fn is_simulated(&self) -> bool {
        self.endpoint.as_ref().is_some_and(Endpoint::is_sim)
    }

    /// How fresh a value asked for at `asked` is now.
    pub fn freshness(&self, asked: Option<Moment>) -> Freshness {
        self.freshness_at(asked, self.pace)
    }

    /// The same for a reading of a fingertip.
    pub fn tip_freshness(&self, finger: Finger) -> Freshness {
        let asked = self.sample.tactile[finger].map(|block| block.asked);
        self.freshness_at(asked, self.tip_pace[finger])
    }

    fn freshness_at(&self, asked: Option<Moment>, pace: ReadingPace) -> Freshness {
        match asked {
            None => Freshness::Unknown,
            Some(_) if !self.link.state.is_live() => Freshness::Stale,
            Some(at) if self.now.since(at) > pace.stale_after() => Freshness::Stale,
            Some(_) => Freshness::Live,
        }
    }

    /// The pose that the hand has, if all six angles are known, live and fresh.
    pub fn pose_now(&self) -> Option<PerDof<Angle>> {
        let angle = self.sample.angle?;
        let live = self.freshness(Some(angle.asked)) == Freshness::Live;
        let angles = angle.value.map(AngleReading::hold).all();
        angles.filter(|_| live)
    }

    /// The hand's name in files and lists; empty without one.
    pub fn name(&self) -> String {
        self.endpoint
            .as_ref()
            .map(ToString::to_string)
            .unwrap_or_default()
    }

    /// Takes its name and side from what is kept of it.
    pub(crate) fn apply_settings(&mut self, settings: &Settings) {
        self.side = settings.side_of(self.endpoint.as_ref());
        let name = match &self.endpoint {
            Some(endpoint) => match settings.hand_name(endpoint) {
                Some(name) => name.to_owned(),
                None => place_name(endpoint),
            },
            None => String::new(),
        };
        if *self.label.name != *name {
            self.label.name = name.into();
        }
    }

    /// Lets the recorder go on.
    pub(crate) fn record(&mut self) {
        let hand = self.name();
        self.recorder.tick(&self.history, &hand, self.now);
    }

    /// True while setpoints pass.
    pub fn is_armed(&self) -> bool {
        self.link.state == LinkState::Armed
    }

    /// True while a series of trials may send something.
    pub const fn runs_series(&self) -> bool {
        self.series.is_some()
    }

    /// Why the hand cannot be armed now; `None` if it can or already is. The link asks the same again.
    pub fn arm_refusal(&self) -> Option<ArmRefusal> {
        let saves = self.link.state.is_live() && self.params.is_saving();
        let busy = saves.then_some(ArmRefusal::HandBusy);
        let refusal = || arm_refusal(self.link.state, &self.sample, self.now);
        let is_let_go = !self.is_armed() && self.held.is_let_go(self.now);
        let let_go = is_let_go.then_some(ArmRefusal::LetGo);
        busy.or_else(refusal).or(let_go)
    }
}
