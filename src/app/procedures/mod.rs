//! What is done to a hand only under a card: a change of its place, a return to the factory's parameters, a calibration.

pub mod procedure;
pub mod work;

pub use crate::app::procedures::procedure::{
    CalibrateProcedure, PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, Procedures,
    ResetProcedure,
};
