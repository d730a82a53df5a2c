//! Everything the user can ask for, as one closed list. Says nothing about how it is done.

use crate::app::checkup::CheckupAction;
use crate::app::exhibit::ExhibitAction;
use crate::app::files::export::Export;
use crate::app::hand::HoldKey;
use crate::app::hands::list::HandsAction;
use crate::app::inputs::InputAction;
use crate::app::layout::Layout;
use crate::app::params::state::ParamAction;
use crate::app::poses::PoseState;
use crate::app::procedures::procedure::ProcedureAction;
use crate::app::readings::fault_recorder::PersonAct;
use crate::app::readings::faults::FaultKind;
use crate::app::recordings::RecordingAction;
use crate::app::scan::ScanTarget;
use crate::app::settings::{AngleUnit, Language, PlotKind, PlotWindow, Theme, Zoom};
use crate::app::trials::state::TrialAction;
use crate::hand::gap::Gap;
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Finger, Force, Gesture, GestureRoute, Moment, Speed};
use crate::history::Mark;
use crate::link::PollPriority;
use crate::params::rows::{ParamId, Value};
use crate::poses::edit::LibraryEdit;
use crate::poses::library::{PoseId, SequenceId};
use crate::poses::{Play, Preset};
use crate::transport::Endpoint;
use std::path::PathBuf;

/// One thing the user asked for. Returned by the views, carried out by `App::act`.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum Action {
    /// Hold every hand now, from anywhere, armed or not.
    Stop,
    /// Let setpoints pass.
    Arm,
    /// Let none pass any more; the hand keeps what it was told.
    Disarm,
    /// Let the hand move only while the key for it is held, or whenever it is armed.
    HoldToRun(bool),
    /// What is done with the key for it.
    HoldKey(HoldKey),
    /// Disarm hands that are asked nothing for some minutes, or not.
    DisarmIdle(bool),
    /// Where a joint should go. Ignored unless armed and the joint is not locked.
    Target(Dof, Angle),
    /// Force threshold of one joint or of all: sent when armed, kept for arming otherwise.
    Force(Option<Dof>, Force),
    /// Speed of one joint or of all: sent when armed, kept for arming otherwise.
    Speed(Option<Dof>, Speed),
    /// Leave a joint alone, or not.
    Lock(Dof, bool),
    /// All joints that are not locked towards open or bent, at the speeds that are set. Needs arming.
    Preset(Preset),
    /// Close or open thumb and index to this gap; where they could meet on the way, open them for it and no more. Needs arming.
    Pinch(Gap),
    /// What thumb and index hold now is a block of this size, mm: keep it, to correct the sizes that are told of this hand.
    MeasureBlock(f32),
    /// Forget the blocks that were measured with this hand.
    ForgetBlocks,
    /// Take a stored pose. Needs arming.
    Gesture(Gesture),
    /// Keep the pose that the hand has now, by this name or the next free one.
    Capture(String),
    /// Put the pose that the hand has now in the place of this one.
    Recapture(PoseId),
    /// Change poses or sequences. Sends nothing.
    Library(LibraryEdit),
    /// Take a pose of the library, within its speed and force. Needs arming.
    Recall(PoseId),
    /// Run a sequence, pause it, end it.
    Play(Play),
    /// Show what is shipped by this name no more, or show it again. Sends nothing.
    HideShipped(String, bool),
    /// Show a sequence on the drawn hand, or none any more; nothing is sent.
    DryRun(Option<SequenceId>),
    /// What is asked about recordings.
    Recording(RecordingAction),
    /// What the user does at an exhibition, or to begin one.
    Exhibit(ExhibitAction),
    /// What is asked of inputs and of the gateway.
    Input(InputAction),
    /// What is asked about grasp trials.
    Trial(TrialAction),
    /// What is asked about check-ups.
    Checkup(CheckupAction),
    /// Add what a file of poses holds: one at a place that was typed, else one that is asked for.
    ImportPoses(Option<PathBuf>),
    /// Ask where the poses should go, and write them.
    ExportPoses,
    /// Give a gesture a name; empty takes it away.
    NameGesture(Gesture, String),
    /// How gestures are started.
    GestureRoute(GestureRoute),
    /// Clear what can be cleared; the pose is held first.
    ClearErrors,
    /// Change what the hand is found by: its id, serial speed or IP address. Asks first, under a card.
    ChangePlace(ParamId, Value),
    /// Return to the factory's parameters. Asks first, under a card.
    FactoryReset,
    /// Calibrate the force sensors. Checks first, under a card.
    CalibrateForce,
    /// What the user decides on such a card.
    Procedure(ProcedureAction),
    /// Talk to this hand from now on.
    Connect(Endpoint),
    /// Talk to no hand.
    Disconnect,
    /// What is done with the list of hands.
    Hands(HandsAction),
    /// Look for serial ports again.
    FindPorts,
    /// Look for hands. Reads only.
    Scan(ScanTarget),
    /// Look no further; what was found stays.
    CancelScan,
    /// Listen for hands that other Handscopes share, at this network interface, or no more.
    FindShared(Option<String>),
    /// This fault was seen by the user.
    SeenFault(Dof, FaultKind),
    /// All faults were seen by the user.
    SeenFaults,
    /// Ask where a file should go, and write it.
    Save(Export),
    /// Make a picture of the plots in this size (width, height in points), and save it. Carried out by the shell, as
    /// the program itself draws nothing.
    SavePicture((u32, u32)),
    /// Do not close the window after all.
    Stay,
    /// Close the window, whatever is lost.
    Leave,
    /// A notice was read.
    Dismiss(u64),
    /// Dark or light.
    Theme(Theme),
    /// Draw the right hand or the left one.
    Side(Side),
    /// English or Chinese.
    Language(Language),
    /// Divide the window like this.
    Layout(Layout),
    /// Draw everything so much larger than designed.
    Zoom(Zoom),
    /// Read this first while something moves.
    ReadFirst(PollPriority),
    /// How angles are written and typed.
    AngleUnit(AngleUnit),
    /// Seconds that the plots show.
    PlotWindow(PlotWindow),
    /// Show a plot or hide it; the last one stays.
    ShowPlot(PlotKind, bool),
    /// Draw a plot tall; the one that was grown before the last becomes a sparkline.
    GrowPlot(PlotKind),
    /// Put a note of these words into the history at a moment; of no words, none.
    Note(Moment, String),
    /// Take a note out of the history again.
    RemoveMark(Mark),
    /// Count the channels of these fingertips from now: one, or all.
    Tare(Option<Finger>),
    /// What a kept row is to hold once it is applied, or nothing any more. Writes nothing.
    Stage(ParamId, Option<Value>),
    /// Read, write and save what the hand keeps.
    Param(ParamAction),
    /// Take the last taring back.
    UndoTare,
    /// Count the fingertips from the taring that was kept of this hand.
    TakeKeptTare,
}

impl Action {
    /// What this does to the hand, for the record of what happened; `None` if it does nothing to it. Arming, stopping,
    /// gestures and notes are in the history already.
    pub fn person_act(&self, is_armed: bool, poses: &PoseState) -> Option<PersonAct> {
        let act = match self {
            Self::Disarm => return Some(PersonAct::Disarm),
            Self::ClearErrors => return Some(PersonAct::ClearErrors),
            Self::Target(dof, angle) => PersonAct::Target(*dof, *angle),
            Self::Force(dof, force) => PersonAct::Force(*dof, *force),
            Self::Speed(dof, speed) => PersonAct::Speed(*dof, *speed),
            Self::Lock(dof, locked) => PersonAct::Lock(*dof, *locked),
            Self::Preset(preset) => PersonAct::Preset(*preset),
            Self::Recall(id) => PersonAct::Pose(poses.pose(*id)?.name.as_str().into()),
            Self::Pinch(gap) => PersonAct::Pose(format!("pinch {:.0} mm", gap.mm()).into()),
            Self::Play(play) => PersonAct::Play(*play),
            Self::Stop
            | Self::Arm
            | Self::HoldToRun(_)
            | Self::HoldKey(_)
            | Self::DisarmIdle(_)
            | Self::Gesture(_)
            | Self::Capture(_)
            | Self::Recapture(_)
            | Self::Library(_)
            | Self::HideShipped(..)
            | Self::DryRun(_)
            | Self::Recording(_)
            | Self::Exhibit(_)
            | Self::Input(_)
            | Self::Trial(_)
            | Self::Checkup(_)
            | Self::ImportPoses(_)
            | Self::ExportPoses
            | Self::NameGesture(..)
            | Self::MeasureBlock(_)
            | Self::ForgetBlocks
            | Self::GestureRoute(_)
            | Self::ChangePlace(..)
            | Self::FactoryReset
            | Self::CalibrateForce
            | Self::Procedure(_)
            | Self::Connect(_)
            | Self::Disconnect
            | Self::Hands(_)
            | Self::FindPorts
            | Self::Scan(_)
            | Self::CancelScan
            | Self::FindShared(_)
            | Self::SeenFault(..)
            | Self::SeenFaults
            | Self::Save(_)
            | Self::SavePicture(_)
            | Self::Stay
            | Self::Leave
            | Self::Dismiss(_)
            | Self::Theme(_)
            | Self::Side(_)
            | Self::Language(_)
            | Self::Layout(_)
            | Self::Zoom(_)
            | Self::ReadFirst(_)
            | Self::AngleUnit(_)
            | Self::PlotWindow(_)
            | Self::ShowPlot(..)
            | Self::GrowPlot(_)
            | Self::Note(..)
            | Self::RemoveMark(_)
            | Self::Tare(_)
            | Self::Stage(..)
            | Self::Param(_)
            | Self::UndoTare
            | Self::TakeKeptTare => return None,
        };
        // The rest passes only while armed.
        is_armed.then_some(act)
    }
}
