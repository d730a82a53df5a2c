//! What each action does to a hand or to the window, in one list without a rest; when it passes follows from that.

use crate::app::action::Action;
use crate::app::checkup::CheckupAction;
use crate::app::hand::HoldKey;
use crate::app::hands::list::HandsAction;
use crate::app::inputs::InputAction;
use crate::app::params::state::ParamAction;
use crate::app::procedures::procedure::ProcedureAction;
use crate::app::trials::state::TrialAction;
use crate::poses::Play;

/// What an action does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Holds every hand.
    StopsAll,
    /// Stops or disarms a hand, or takes the right to move it away.
    Stops,
    /// Moves a hand, or lets the user or a program move it.
    Moves,
    /// Sets how a hand moves once something moves it, or clears its errors.
    Adjusts,
    /// Writes what a hand keeps, or lets it calibrate itself.
    WritesKept,
    /// Opens or answers a card. Nothing is sent because of it but what the card asked for before.
    Asks,
    /// Looks for hands, takes or leaves one, opens or closes a way for programs, of which none may move it yet.
    Connects,
    /// Changes what this program knows, keeps or shows of a live hand. Nothing is sent but reads.
    Keeps,
    /// Is about recordings.
    Records,
    /// Belongs to an exhibition, which has rules of its own.
    Exhibits,
    /// Chooses what is on the screen, or makes a file of that.
    Shows,
    /// Sets the theme or the language.
    Dresses,
}

impl Effect {
    /// True for what is carried out while a series of trials runs. All else would come between it and the hand.
    pub const fn passes_in_series(self) -> bool {
        matches!(
            self,
            Self::StopsAll
                | Self::Stops
                | Self::Asks
                | Self::Connects
                | Self::Keeps
                | Self::Records
                | Self::Exhibits
                | Self::Shows
                | Self::Dresses
        )
    }

    /// True for what is carried out while a recording is shown: a stop, what is done with recordings, and how the window looks. All
    /// else is about a live hand, and is refused.
    const fn passes_in_replay(self) -> bool {
        matches!(
            self,
            Self::StopsAll | Self::Records | Self::Shows | Self::Dresses
        )
    }

    /// True for what is carried out during an exhibition: nothing on its page asks for more.
    pub const fn passes_in_exhibit(self) -> bool {
        matches!(self, Self::StopsAll | Self::Exhibits | Self::Dresses)
    }

    /// True for what may still be carried out after a stop that was asked for in the same frame: nothing that moves a hand or
    /// writes what it keeps.
    pub const fn passes_with_stop(self) -> bool {
        matches!(
            self,
            Self::Stops
                | Self::Adjusts
                | Self::Asks
                | Self::Connects
                | Self::Keeps
                | Self::Records
                | Self::Shows
                | Self::Dresses
        )
    }
}

impl Action {
    /// True for what can be asked for while a recording is shown: a note is one of the recording then, and a message is one of its.
    pub const fn passes_in_replay(&self) -> bool {
        matches!(self, Self::Note(..) | Self::Dismiss(_)) || self.effect().passes_in_replay()
    }

    /// What this does.
    #[expect(clippy::too_many_lines, reason = "one list of all actions")]
    pub const fn effect(&self) -> Effect {
        match self {
            Self::Stop => Effect::StopsAll,
            Self::Disarm
            | Self::HoldToRun(true)
            | Self::HoldKey(HoldKey::LetGo)
            | Self::Play(Play::Pause | Play::End)
            | Self::Input(InputAction::TakeBack)
            | Self::Hands(HandsAction::StopOne(_)) => Effect::Stops,
            Self::Arm
            | Self::HoldKey(HoldKey::Pressed)
            | Self::Target(..)
            | Self::Preset(_)
            | Self::Pinch(_)
            | Self::Gesture(_)
            | Self::Recall(_)
            | Self::Play(Play::Start(_) | Play::Step(_) | Play::Resume)
            | Self::Input(InputAction::Grant(_) | InputAction::GrantClient(_))
            | Self::Trial(TrialAction::Start(_) | TrialAction::ArmAndStart(_))
            | Self::Checkup(CheckupAction::Start(_) | CheckupAction::ArmAndStart(_)) => {
                Effect::Moves
            }
            Self::HoldToRun(false)
            | Self::Force(..)
            | Self::Speed(..)
            | Self::Lock(..)
            | Self::Input(InputAction::Limit(_))
            | Self::ClearErrors => Effect::Adjusts,
            Self::Param(
                ParamAction::Apply
                | ParamAction::Undo
                | ParamAction::Save
                | ParamAction::SaveWith(_)
                | ParamAction::Agree,
            )
            | Self::Procedure(
                ProcedureAction::Begin | ProcedureAction::GoBack | ProcedureAction::Save,
            ) => Effect::WritesKept,
            Self::ChangePlace(..)
            | Self::FactoryReset
            | Self::CalibrateForce
            | Self::Procedure(
                ProcedureAction::Keep | ProcedureAction::LeaveUnsaved | ProcedureAction::Close,
            )
            | Self::Stay
            | Self::Leave => Effect::Asks,
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
            ) => Effect::Connects,
            // Still held: nothing changes by it.
            Self::HoldKey(HoldKey::Held)
            | Self::DisarmIdle(_)
            | Self::Capture(_)
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
                | ParamAction::Decline
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
            | Self::Stage(..) => Effect::Keeps,
            Self::Recording(_) => Effect::Records,
            Self::Exhibit(_) => Effect::Exhibits,
            Self::Save(_)
            | Self::SavePicture(_)
            | Self::Layout(_)
            | Self::Zoom(_)
            | Self::AngleUnit(_)
            | Self::PlotWindow(_)
            | Self::ShowPlot(..)
            | Self::GrowPlot(_) => Effect::Shows,
            Self::Theme(_) | Self::Language(_) => Effect::Dresses,
        }
    }
}
