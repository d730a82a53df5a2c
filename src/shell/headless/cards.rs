//! Cards over the window, opened by the user's actions. Draws nothing.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::params::state::ParamAction;
use crate::app::procedures::{Procedure, ProcedureAction};
use crate::app::state::State;
use crate::exhibit::stage::ExhibitWish;
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::shell::headless::driver::{ANSWER_TIMEOUT, Driver};
use crate::tasks::Question;
use crate::transport::Endpoint;
use std::net::Ipv4Addr;
use std::time::Duration;

/// A card that can be shown over the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneCard {
    /// Confirmation of a factory reset.
    Reset,
    /// Checks before a calibration of the force sensors.
    Calibrate,
    /// Confirmation of another IP address.
    Address,
    /// Countdown during which a new id can be confirmed.
    Keep,
    /// Confirmation of defaults with a high force.
    Danger,
    /// The page of an exhibition in place of the window: armed, while a visitor plays.
    Exhibit,
    /// The page of an exhibition with the keypad on which staff choose a PIN.
    ExhibitPin,
}

/// A tile with more motion than a fist.
const PLAYED_TILE: usize = 3;
/// An address of this computer, so that the route to it is the same everywhere.
const OTHER_ADDRESS: Ipv4Addr = Ipv4Addr::new(127, 0, 0, 20);
/// A calibration requires a steady force for two seconds.
const CHECK_TIMEOUT: Duration = Duration::from_millis(2600);
/// A placeholder port, which is not opened.
const LINE: &str = "rs485:/dev/ttyUSB0?baud=115200&id=1";
/// The hand's new id.
const OTHER_ID: i32 = 7;
/// Upper limit: a hand with a changed id is found much earlier.
const MOVE_TIMEOUT: Duration = Duration::from_secs(20);
/// Joints with higher force thresholds than the factory's.
const HARD: [(Dof, i32); 3] = [
    (Dof::Middle, 1500),
    (Dof::Index, 1500),
    (Dof::ThumbBend, 2500),
];

impl SceneCard {
    /// True if the card writes to a hand, or might: only the built-in hand may be written to.
    pub const fn needs_built_in(self) -> bool {
        matches!(self, Self::Keep | Self::Danger | Self::Exhibit)
    }

    /// The line on which the built-in hand must be simulated; `None` if the card does not need one.
    pub fn line(self) -> Option<Endpoint> {
        match self {
            Self::Keep => LINE.parse().ok(),
            _ => None,
        }
    }
}

impl Driver {
    /// Opens a card and runs its checks. Its question stays open.
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
            state.hand().params.question().is_some()
        });
    }
}

fn is_kept_open(state: &State) -> bool {
    let Some(Procedure::Place(run)) = &state.hand().procedures.card else {
        return false;
    };
    matches!(run.question(), Some((Question::KeepPlace(_), _)))
}
