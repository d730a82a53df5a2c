//! Everything a person can ask for, as one closed list. Says nothing about how it is done.

use crate::app::device::wish::DeviceWish;
use crate::app::faults::FaultKind;
use crate::app::guard::GuardStep;
use crate::app::layout::Layout;
use crate::app::params::table::{ParamId, Value};
use crate::app::poses::edit::LibraryEdit;
use crate::app::poses::library::{PoseId, SequenceId};
use crate::app::recorder::RecordingId;
use crate::app::save::Content;
use crate::app::scan::ScanWish;
use crate::app::settings::{AngleUnit, Language, PlotKind, PlotWindow, Theme};
use crate::app::tuner::TrialWish;
use crate::hand::{
    Angle, Dof, Finger, Force, Gesture, GestureRoute, GestureStore, Moment, PerDof, Speed,
    UserGesture,
};
use crate::transport::Endpoint;

/// Poses that need no library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Preset {
    /// Every joint open.
    Open,
    /// Fingers and thumb half bent; the thumb's rotation stays.
    Half,
    /// Fingers and thumb bent; the thumb's rotation stays.
    Close,
}

impl Preset {
    /// Where this joint goes, if it moves at all.
    #[must_use]
    pub fn angle(self, dof: Dof) -> Option<Angle> {
        match (self, dof) {
            (Self::Open, _) => Some(Angle::MAX),
            (Self::Half | Self::Close, Dof::ThumbRotate) => None,
            (Self::Half, _) => Some(Angle::nearest(500)),
            (Self::Close, _) => Some(Angle::MIN),
        }
    }
}

/// What a person does with a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Play {
    /// Run it from its start. Needs arming.
    Start(SequenceId),
    /// Take one step, then wait. Needs arming.
    Step(SequenceId),
    /// Hold where the hand is, until resumed.
    Pause,
    /// Go on where it was paused.
    Resume,
    /// End it and hold where the hand is.
    End,
    /// Show it on the drawn hand; nothing is sent.
    Dry(SequenceId),
    /// Show it no more.
    EndDry,
}

/// One thing a person asked for. Returned by the views, carried out by `App::act`.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Hold now, from anywhere, armed or not.
    Stop,
    /// Let setpoints pass.
    Arm,
    /// Let none pass any more; the hand keeps what it was told.
    Disarm,
    /// Where a joint should go. Ignored unless armed and the joint is not locked.
    Target(Dof, Angle),
    /// Force threshold of a joint: sent when armed, kept for arming otherwise.
    Force(Dof, Force),
    /// Speed of a joint: sent when armed, kept for arming otherwise.
    Speed(Dof, Speed),
    /// Leave a joint alone, or not.
    Lock(Dof, bool),
    /// All joints that are not locked towards open or bent, none faster than is gentle. Needs arming.
    Preset(Preset),
    /// Force threshold of all joints.
    ForceOfAll(Force),
    /// Speed of all joints.
    SpeedOfAll(Speed),
    /// Take a stored pose. Needs arming.
    Gesture(Gesture),
    /// Store six angles under a number of the user's, and read them back.
    StoreGesture(UserGesture, PerDof<Angle>),
    /// Read what is stored under a number of the user's.
    ReadGesture(UserGesture),
    /// Keep the pose that the hand has now, by this name or the next free one.
    Capture(String),
    /// Put the pose that the hand has now in the place of this one.
    Recapture(PoseId),
    /// Change poses or sequences. Sends nothing.
    Library(LibraryEdit),
    /// Take a pose of the library, within its speed and force. Needs arming.
    Recall(PoseId),
    /// Go to six angles at a gentle speed. Needs arming.
    TryAngles(PerDof<Angle>),
    /// Run a sequence, pause it, end it.
    Play(Play),
    /// What is asked about grasp trials.
    Trial(TrialWish),
    /// Ask for a file of poses and add what it holds.
    ImportPoses,
    /// Ask where the poses should go, and write them.
    ExportPoses,
    /// Give a gesture a name; empty takes it away.
    NameGesture(Gesture, String),
    /// How gestures are started.
    GestureRoute(GestureRoute),
    /// Where the poses of the user's gestures are stored.
    GestureStore(GestureStore),
    /// Clear what can be cleared; the pose is held first.
    ClearErrors,
    /// Change what the hand is found by: its id, serial speed or IP address. Asks first, under a card.
    ChangePlace(ParamId, Value),
    /// Return to the factory's parameters. Asks first, under a card.
    FactoryReset,
    /// Calibrate the force sensors. Checks first, under a card.
    CalibrateForce,
    /// What a person decides on such a card.
    Guard(GuardStep),
    /// Talk to this hand from now on.
    Connect(Endpoint),
    /// Talk to no hand.
    Disconnect,
    /// Look for serial ports again.
    FindPorts,
    /// Look for hands. Reads only.
    Scan(ScanWish),
    /// Look no further; what was found stays.
    CancelScan,
    /// This fault was seen by a person.
    SeenFault(Dof, FaultKind),
    /// All faults were seen by a person.
    SeenFaults,
    /// A recording was looked at.
    OpenedRecording(RecordingId),
    /// Forget faults that are over and seen.
    ForgetFaults,
    /// Ask where a file should go, and write it.
    Save(Content),
    /// Make a picture of the plots in this size (width, height in points), and save it. Carried out by the shell, as
    /// the program itself draws nothing.
    SavePicture((u32, u32)),
    /// A notice was read.
    Dismiss(u64),
    /// Dark or light.
    Theme(Theme),
    /// English or Chinese.
    Language(Language),
    /// Divide the window like this.
    Layout(Layout),
    /// How angles are written and typed.
    AngleUnit(AngleUnit),
    /// Seconds that the plots show.
    PlotWindow(PlotWindow),
    /// Show a plot or hide it; the last one stays.
    ShowPlot(PlotKind, bool),
    /// Put a note of these words into the history at a moment; of no words, none.
    Note(Moment, String),
    /// Count the channels of these fingertips from now: one, or all.
    Tare(Option<Finger>),
    /// What a kept row is to hold once it is applied, or nothing any more. Writes nothing.
    Stage(ParamId, Option<Value>),
    /// Read, write and save what the hand keeps.
    Device(DeviceWish),
    /// Take the last taring back.
    UndoTare,
    /// Let the plots stand still; nothing is lost meanwhile.
    PausePlots(bool),
}

impl Action {
    /// True for what would come between a series of trials and the hand. It is refused while one runs.
    #[must_use]
    pub const fn disturbs_series(&self) -> bool {
        match self {
            Self::Arm
            | Self::Target(..)
            | Self::Force(..)
            | Self::Speed(..)
            | Self::Lock(..)
            | Self::Preset(_)
            | Self::ForceOfAll(_)
            | Self::SpeedOfAll(_)
            | Self::Gesture(_)
            | Self::StoreGesture(..)
            | Self::ReadGesture(_)
            | Self::Recall(_)
            | Self::TryAngles(_)
            | Self::ClearErrors => true,
            Self::Device(wish) => matches!(
                wish,
                DeviceWish::Apply | DeviceWish::Undo | DeviceWish::Save | DeviceWish::Agree
            ),
            Self::Play(play) => !matches!(play, Play::Dry(_) | Play::EndDry),
            _ => false,
        }
    }
}
