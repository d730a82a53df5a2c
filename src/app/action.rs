//! All user actions, as one closed list, independent of how they are carried out.

use crate::app::checkup::CheckupAction;
use crate::app::controls::HoldKey;
use crate::app::exhibit::ExhibitAction;
use crate::app::files::export::Export;
use crate::app::hand::hold::HoldAction;
use crate::app::hand::list::HandsAction;
use crate::app::hand::scale::ScaleAction;
use crate::app::inputs::InputAction;
use crate::app::layout::Layout;
use crate::app::params::state::ParamAction;
use crate::app::poses::PoseState;
use crate::app::procedures::procedure::ProcedureAction;
use crate::app::readings::fault_recorder::UserAct;
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
use crate::tasks::Question;
use crate::transport::Endpoint;
use std::path::PathBuf;

/// A user action. Returned by the views, carried out by `App::act`.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum Action {
    /// Hold every hand now, from anywhere, armed or not.
    Stop,
    /// Arm the hand: setpoints are sent from now on.
    Arm,
    /// Disarm the hand: no further setpoints are sent; the hand keeps the last ones.
    Disarm,
    /// Allow motion only while the hold-to-run key is pressed (true), or whenever armed.
    HoldToRun(bool),
    /// State of the hold-to-run key.
    HoldKey(HoldKey),
    /// Disarm hands that receive no commands for some minutes, or not.
    DisarmIdle(bool),
    /// Set the target angle of a joint. Ignored unless armed and the joint is not locked.
    Target(Dof, Angle),
    /// Force threshold of one joint (`None` = all): sent when armed, else stored for arming.
    Force(Option<Dof>, Force),
    /// Speed of one joint (`None` = all): sent when armed, else stored for arming.
    Speed(Option<Dof>, Speed),
    /// Lock or unlock a joint.
    Lock(Dof, bool),
    /// Open or bend all joints that are not locked, at the speeds that are set. Needs arming.
    Preset(Preset),
    /// Move thumb and index to this gap; if they could collide on the way, open them first, only as far as needed. Needs
    /// arming.
    Pinch(Gap),
    /// Measure the block of this size in mm between thumb and index, to correct the sizes shown for this hand.
    MeasureBlock(f32),
    /// Forget the blocks that were measured with this hand.
    ForgetBlocks,
    /// An action on a hold between two forces.
    Hold(HoldAction),
    /// Calibrate the force of a joint of the shown hand with a kitchen scale.
    Scale(ScaleAction),
    /// Start a gesture stored in the hand. Needs arming.
    Gesture(Gesture),
    /// Store the current pose of the hand, by this name or the next unused one.
    Capture(String),
    /// Replace this pose by the current pose of the hand.
    Recapture(PoseId),
    /// Change poses or sequences. Sends nothing.
    Library(LibraryEdit),
    /// Move to a pose of the library, within its speed and force. Needs arming.
    Recall(PoseId),
    /// Start, step, pause or end a sequence.
    Play(Play),
    /// Hide a shipped entry by name (true), or show it again. Sends nothing.
    HideShipped(String, bool),
    /// Show a sequence on the drawn hand, or end that. Sends nothing.
    DryRun(Option<SequenceId>),
    /// An action on recordings.
    Recording(RecordingAction),
    /// An action at an exhibition, or to start one.
    Exhibit(ExhibitAction),
    /// An action on inputs or the gateway.
    Input(InputAction),
    /// An action on grasp trials.
    Trial(TrialAction),
    /// An action on check-ups.
    Checkup(CheckupAction),
    /// Import a pose file at the typed path, else ask the user for one.
    ImportPoses(Option<PathBuf>),
    /// Ask for a path, and export the poses.
    ExportPoses,
    /// Name a gesture; an empty name removes it.
    NameGesture(Gesture, String),
    /// Set how gestures are started.
    GestureRoute(GestureRoute),
    /// Clear the errors that can be cleared; the pose is held first.
    ClearErrors,
    /// Change an address row of the hand: its ID, serial speed or IP address. Asks first, on a card.
    ChangePlace(ParamId, Value),
    /// Reset to factory parameters. Asks first, on a card.
    FactoryReset,
    /// Calibrate the force sensors. Checks the preconditions first, on a card.
    CalibrateForce,
    /// A decision on such a card.
    Procedure(ProcedureAction),
    /// Answer a question of the shown hand's task. Ignored if it is not the open one.
    Answer(Question, bool),
    /// Connect to this hand.
    Connect(Endpoint),
    /// Disconnect from the hand.
    Disconnect,
    /// An action on the list of hands.
    Hands(HandsAction),
    /// Search for serial ports again.
    FindPorts,
    /// Scan for hands. Reads only.
    Scan(ScanTarget),
    /// Cancel the scan; the hands found so far stay listed.
    CancelScan,
    /// Listen on this network interface for hands shared by other Handscopes; `None` ends that.
    FindShared(Option<String>),
    /// Mark this fault as seen.
    SeenFault(Dof, FaultKind),
    /// Mark all faults as seen.
    SeenFaults,
    /// Ask for a path, and write the export there.
    Save(Export),
    /// Save a picture of the plots in this size (width, height in points). Carried out by the shell, as the program
    /// itself draws nothing.
    SavePicture((u32, u32)),
    /// Keep the window open after all.
    Stay,
    /// Close the window despite unsaved changes.
    Leave,
    /// Dismiss a notice.
    Dismiss(u64),
    Theme(Theme),
    /// Set the side of the hand that is drawn.
    Side(Side),
    Language(Language),
    /// Set the layout of the window.
    Layout(Layout),
    /// Set the zoom factor.
    Zoom(Zoom),
    /// Set the group that is polled first during motion.
    ReadFirst(PollPriority),
    /// Set the unit in which angles are shown and entered.
    AngleUnit(AngleUnit),
    /// Set the time span of the plots.
    PlotWindow(PlotWindow),
    /// Show or hide a plot; the last one stays.
    ShowPlot(PlotKind, bool),
    /// Enlarge a plot; of the two enlarged before, the older becomes a sparkline.
    GrowPlot(PlotKind),
    /// Add a note to the history at a moment; an empty text adds none.
    Note(Moment, String),
    /// Remove a note from the history.
    RemoveMark(Mark),
    /// Tare one fingertip, or all.
    Tare(Option<Finger>),
    /// Stage a value for a persistent row, or unstage it. Writes nothing.
    Stage(ParamId, Option<Value>),
    /// Read, write and save the hand's persistent parameters.
    Param(ParamAction),
    /// Undo the last tare.
    UndoTare,
    /// Apply the stored tare of this hand.
    TakeKeptTare,
}

impl Action {
    /// The action as an event for the fault recorder; `None` if it does not affect the hand. Arming, stopping, gestures
    /// and notes are in the history already.
    pub fn user_act(&self, is_armed: bool, poses: &PoseState) -> Option<UserAct> {
        let act = match self {
            Self::Disarm => return Some(UserAct::Disarm),
            Self::ClearErrors => return Some(UserAct::ClearErrors),
            Self::Target(dof, angle) => UserAct::Target(*dof, *angle),
            Self::Force(dof, force) => UserAct::Force(*dof, *force),
            Self::Speed(dof, speed) => UserAct::Speed(*dof, *speed),
            Self::Lock(dof, locked) => UserAct::Lock(*dof, *locked),
            Self::Preset(preset) => UserAct::Preset(*preset),
            Self::Recall(id) => UserAct::Pose(poses.pose(*id)?.name.as_str().into()),
            Self::Pinch(gap) => UserAct::Pose(format!("pinch {:.0} mm", gap.mm()).into()),
            Self::Play(play) => UserAct::Play(*play),
            Self::Hold(HoldAction::Start(_) | HoldAction::Repeat(_)) => {
                UserAct::Pose("hold".into())
            }
            Self::Scale(ScaleAction::Start(..)) => UserAct::Pose("calibration on a scale".into()),
            Self::Stop
            | Self::Scale(_)
            | Self::Arm
            | Self::HoldToRun(_)
            | Self::HoldKey(_)
            | Self::DisarmIdle(_)
            | Self::Hold(_)
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
            | Self::Answer(..)
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
        // The other actions have an effect only while armed.
        is_armed.then_some(act)
    }
}
