//! Procedures guided by a card: change of the hand's address, reset to factory parameters, calibration.

pub mod procedure;
pub mod work;

pub use crate::app::procedures::procedure::{
    CalibrateProcedure, PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, Procedures,
    ResetProcedure,
};
