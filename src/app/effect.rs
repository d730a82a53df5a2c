//! Effect of each action on a hand or the window, as one exhaustive list; it determines when an action is permitted.

use crate::app::action::Action;
use crate::app::checkup::CheckupAction;
use crate::app::controls::HoldKey;
use crate::app::hand::hold::HoldAction;
use crate::app::hand::list::HandsAction;
use crate::app::hand::scale::ScaleAction;
use crate::app::inputs::InputAction;
use crate::app::params::state::ParamAction;
use crate::app::procedures::procedure::ProcedureAction;
use crate::app::trials::state::TrialAction;
use crate::poses::Play;
use crate::tasks::Question;

/// Effect of an action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActionEffect {
    /// Holds every hand.
    StopAll,
    /// Stops or disarms a hand, or revokes control of it.
    Stop,
    /// Moves a hand, or permits the user or a program to move it.
    Motion,
    /// Changes the parameters of later motion, or clears errors.
    Adjustment,
    /// Writes persistent parameters, or starts a calibration.
    PersistentWrite,
    /// Opens or answers a card. Sends only what the card has asked about.
    Dialog,
    /// Scans for hands, connects or disconnects one, opens or closes an interface for programs, none of which has
    /// control yet.
    Connection,
    /// Changes the program's knowledge, storage or display of a live hand. Sends only reads.
    LocalState,
    /// Concerns recordings.
    Recording,
    /// Belongs to an exhibition, which has rules of its own.
    Exhibition,
    /// Changes the content of the screen, or exports it.
    View,
    /// Sets the theme or the language.
    Appearance,
}

impl ActionEffect {
    /// True for actions permitted while a series of trials runs. All others would interfere with its motion.
    pub const fn passes_in_series(self) -> bool {
        matches!(
            self,
            Self::StopAll
                | Self::Stop
                | Self::Dialog
                | Self::Connection
                | Self::LocalState
                | Self::Recording
                | Self::Exhibition
                | Self::View
                | Self::Appearance
        )
    }

    /// True for actions permitted while a recording is shown: a stop, operations on recordings, and the display. All others concern
    /// a live hand and are refused.
    const fn passes_in_replay(self) -> bool {
        matches!(
            self,
            Self::StopAll | Self::Recording | Self::View | Self::Appearance
        )
    }

    /// True for actions permitted during an exhibition; its page offers no others.
    pub const fn passes_in_exhibit(self) -> bool {
        matches!(self, Self::StopAll | Self::Exhibition | Self::Appearance)
    }

    /// True for actions permitted after a stop in the same frame: none that moves a hand or writes its persistent parameters.
    pub const fn passes_with_stop(self) -> bool {
        matches!(
            self,
            Self::Stop
                | Self::Adjustment
                | Self::Dialog
                | Self::Connection
                | Self::LocalState
                | Self::Recording
                | Self::View
                | Self::Appearance
        )
    }
}

impl Action {
    /// True for actions permitted while a recording is shown. Notes and notices belong to the recording then.
    pub const fn passes_in_replay(&self) -> bool {
        matches!(self, Self::Note(..) | Self::Dismiss(_)) || self.effect().passes_in_replay()
    }

    /// Effect of this action.
    #[expect(clippy::too_many_lines, reason = "one list of all actions")]
    pub const fn effect(&self) -> ActionEffect {
        match self {
            Self::Stop => ActionEffect::StopAll,
            Self::Disarm
            | Self::HoldToRun(true)
            | Self::HoldKey(HoldKey::LetGo)
            | Self::Play(Play::Pause | Play::End)
            | Self::Hold(HoldAction::End)
            | Self::Input(InputAction::TakeBack)
            | Self::Hands(HandsAction::StopOne(_)) => ActionEffect::Stop,
            Self::Arm
            | Self::HoldKey(HoldKey::Pressed)
            | Self::Target(..)
            | Self::Preset(_)
            | Self::Pinch(_)
            | Self::Hold(HoldAction::Start(_) | HoldAction::Repeat(_) | HoldAction::PutDown)
            | Self::Scale(
                ScaleAction::Start(..)
                | ScaleAction::Reading(_)
                | ScaleAction::Again
                | ScaleAction::Skip
                | ScaleAction::Finish,
            )
            | Self::Gesture(_)
            | Self::Recall(_)
            | Self::Play(Play::Start(_) | Play::Step(_) | Play::Resume)
            | Self::Input(InputAction::Grant(_) | InputAction::GrantClient(_))
            | Self::Trial(TrialAction::Start(_) | TrialAction::ArmAndStart(_))
            | Self::Checkup(CheckupAction::Start(_) | CheckupAction::ArmAndStart(_)) => {
                ActionEffect::Motion
            }
            Self::HoldToRun(false)
            | Self::Force(..)
            | Self::Speed(..)
            | Self::Lock(..)
            | Self::Hold(HoldAction::Forces(..) | HoldAction::Unit(_))
            | Self::Input(InputAction::Limit(_))
            | Self::ClearErrors => ActionEffect::Adjustment,
            Self::Param(
                ParamAction::Apply
                | ParamAction::Undo
                | ParamAction::Save
                | ParamAction::SaveWith(_),
            )
            | Self::Answer(Question::Apply(_) | Question::Save(_) | Question::SavePlace(_), true)
            // The previous address is written back.
            | Self::Answer(Question::KeepPlace(_), false)
            | Self::Procedure(ProcedureAction::Begin) => ActionEffect::PersistentWrite,
            Self::ChangePlace(..)
            | Self::FactoryReset
            | Self::CalibrateForce
            | Self::Answer(..)
            | Self::Procedure(ProcedureAction::Close)
            | Self::Stay
            | Self::Leave => ActionEffect::Dialog,
            Self::Connect(_)
            | Self::Disconnect
            | Self::Hands(HandsAction::Add | HandsAction::Show(_) | HandsAction::Remove(_))
            | Self::FindPorts
            | Self::Scan(_)
            | Self::CancelScan
            | Self::FindShared(_)
            | Self::Input(
                InputAction::Listen(_)
                | InputAction::ReadPad(_)
                | InputAction::Share(_)
                | InputAction::Show(_)
                | InputAction::JoinDds(_)
                | InputAction::Mirror(_),
            ) => ActionEffect::Connection,
            // A repeated press changes nothing.
            Self::HoldKey(HoldKey::Held)
            | Self::DisarmIdle(_)
            | Self::Capture(_)
            | Self::Hold(HoldAction::Save)
            | Self::Scale(ScaleAction::Forget(_))
            | Self::Recapture(_)
            | Self::Library(_)
            | Self::HideShipped(..)
            | Self::DryRun(_)
            | Self::Hands(HandsAction::Name(..) | HandsAction::PosesForAll(_))
            | Self::Input(InputAction::Map(_))
            | Self::Trial(
                TrialAction::Plan(_)
                | TrialAction::Goal(_)
                | TrialAction::Note(..)
                | TrialAction::Tags(..)
                | TrialAction::Forget(_)
                | TrialAction::ConfirmForget
                | TrialAction::CancelForget
                | TrialAction::ForgetOvershoot
                | TrialAction::ExportOvershoot
                | TrialAction::Open(_)
                | TrialAction::Save(..),
            )
            | Self::Param(
                ParamAction::Read
                | ParamAction::CopyLive
                | ParamAction::UnstageAll
                | ParamAction::Dump
                | ParamAction::Open(_)
                | ParamAction::Tick(_)
                | ParamAction::StageTicked
                | ParamAction::CloseFile,
            )
            | Self::ImportPoses(_)
            | Self::ExportPoses
            | Self::NameGesture(..)
            | Self::MeasureBlock(_)
            | Self::ForgetBlocks
            | Self::GestureRoute(_)
            | Self::SeenFault(..)
            | Self::SeenFaults
            | Self::Dismiss(_)
            | Self::Side(_)
            | Self::ReadFirst(_)
            | Self::Note(..)
            | Self::RemoveMark(_)
            | Self::Tare(_)
            | Self::UndoTare
            | Self::TakeKeptTare
            | Self::Stage(..) => ActionEffect::LocalState,
            Self::Recording(_) => ActionEffect::Recording,
            Self::Exhibit(_) => ActionEffect::Exhibition,
            Self::Save(_)
            | Self::SavePicture(_)
            | Self::Layout(_)
            | Self::Zoom(_)
            | Self::AngleUnit(_)
            | Self::PlotWindow(_)
            | Self::ShowPlot(..)
            | Self::GrowPlot(_) => ActionEffect::View,
            Self::Theme(_) | Self::Language(_) => ActionEffect::Appearance,
        }
    }
}
