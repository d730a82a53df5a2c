//! Cards over the window, brought there as the user brings them. Draws nothing.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::params::state::ParamAction;
use crate::app::procedures::{Procedure, ProcedureAction, ProcedureStage};
use crate::app::state::State;
use crate::exhibit::run::ExhibitWish;
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::shell::headless::driver::{ANSWER_TIMEOUT, Driver};
use crate::tasks::place::PlaceStep;
use crate::transport::Endpoint;
use std::net::Ipv4Addr;
use std::time::Duration;

/// A card that can be shown over the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneCard {
    /// The question before the factory's parameters.
    Reset,
    /// The checks before a calibration of the force sensors.
    Calibrate,
    /// The question before another IP address.
    Address,
    /// The question whether a new id stays, while time runs.
    Keep,
    /// The question before defaults that hit hard.
    Danger,
    /// The page of an exhibition in place of the window: armed, and a visitor plays.
    Exhibit,
    /// The same with the pad on which staff choose a PIN.
    ExhibitPin,
}

/// A tile that shows more than a fist.
const PLAYED_TILE: usize = 3;
/// An address of this computer, so that the way to it is the same everywhere.
const OTHER_ADDRESS: Ipv4Addr = Ipv4Addr::new(127, 0, 0, 20);
/// A calibration wants the force steady for two seconds.
const CHECK_TIMEOUT: Duration = Duration::from_millis(2600);
/// A port that is nobody's: nothing is opened.
const LINE: &str = "rs485:/dev/ttyUSB0?baud=115200&id=1";
/// The id that the hand is given.
const OTHER_ID: i32 = 7;
/// A hand that changes its id is found long before.
const MOVE_TIMEOUT: Duration = Duration::from_secs(20);
/// Joints with thresholds that hit harder than the factory's.
const HARD: [(Dof, i32); 3] = [
    (Dof::Middle, 1500),
    (Dof::Index, 1500),
    (Dof::ThumbBend, 2500),
];

impl SceneCard {
    /// True if a hand has to be written to before it is shown, or might be: only the built-in one is.
    pub const fn wants_built_in(self) -> bool {
        matches!(self, Self::Keep | Self::Danger | Self::Exhibit)
    }

    /// The line that the built-in hand has to stand at, if it has to.
    pub fn line(self) -> Option<Endpoint> {
        match self {
            Self::Keep => LINE.parse().ok(),
            _ => None,
        }
    }
}

impl Driver {
    /// Opens a card, and lets its checks be made. The question on it is left open.
    pub fn open_card(&mut self, card: SceneCard) {
        match card {
            SceneCard::Reset => self.act(Action::FactoryReset),
            SceneCard::Calibrate => self.act(Action::CalibrateForce),
            SceneCard::Address => {
                self.read_rows();
                let address = Value::Address(OTHER_ADDRESS);
                self.act(Action::ChangePlace(ParamId::IpAddress, address));
            }
            SceneCard::Keep => self.change_id(),
            SceneCard::Danger => self.apply_hard_defaults(),
            SceneCard::Exhibit => self.play_at_exhibit(),
            SceneCard::ExhibitPin => self.act(Action::Exhibit(ExhibitAction::Enter)),
        }
        self.run_for(CHECK_TIMEOUT);
        self.hold_still();
    }

    fn change_id(&mut self) {
        self.read_rows();
        let id = Value::Number(OTHER_ID);
        self.act(Action::ChangePlace(ParamId::HandId, id));
        self.act(Action::Procedure(ProcedureAction::Begin));
        self.until(MOVE_TIMEOUT, is_kept_open);
    }

    fn play_at_exhibit(&mut self) {
        let pin = || ExhibitAction::Pin("0000".into());
        let (arm, press) = (ExhibitWish::Arm, ExhibitWish::Press(PLAYED_TILE));
        for (action, millis) in [
            (ExhibitAction::Enter, 500),
            (pin(), 100),
            (pin(), 500),
            (ExhibitAction::Wish(arm), 6000),
            (ExhibitAction::Wish(press), 200),
            (ExhibitAction::Wish(ExhibitWish::Release), 1400),
        ] {
            self.act(Action::Exhibit(action));
            self.run_for(Duration::from_millis(millis));
        }
    }

    fn apply_hard_defaults(&mut self) {
        self.read_rows();
        for (dof, grams) in HARD {
            let id = ParamId::DefaultForce(dof);
            self.act(Action::Stage(id, Some(Value::Number(grams))));
        }
        self.act(Action::Param(ParamAction::Apply));
        self.until(ANSWER_TIMEOUT, |state| {
            state.hand().params.question.is_some()
        });
    }
}

fn is_kept_open(state: &State) -> bool {
    let Some(Procedure::Place(run)) = &state.hand().procedures.card else {
        return false;
    };
    matches!(run.stage, ProcedureStage::Doing(PlaceStep::Keeping(_), _))
}
