//! The device model: registers, values, samples, commands. No bytes on a wire, no clock, no egui.
//!
//! Everything sent to a hand is a [`HandCommand`], a [`Setting`] or a [`Trigger`]; everything received
//! goes into a [`HandSample`]. Both are built from the one table in [`register`].
#![warn(missing_docs)]

pub mod column;
pub mod command;
pub mod dof;
pub mod feedback;
pub mod gap;
pub mod grip;
pub mod heat;
pub mod hold_forces;
pub mod impact;
pub mod kinematics;
pub mod model;
pub mod moment;
pub mod newtons;
pub mod overshoot;
pub mod quantity;
pub mod refusal;
pub mod register;
pub mod setpoints;
pub mod setting;
pub mod statistics;
pub mod units;

pub use command::{GestureRoute, HandCommand, RegisterWrite, Writes};
pub use dof::{Dof, Finger, PerDof, PerFinger};
pub use feedback::fault::{Fault, Faults};
pub use feedback::group::{Group, Groups, RateClass};
pub use feedback::reading::{
    AngleReading, CurrentReading, ForceReading, PositionReading, TemperatureReading,
};
pub use feedback::sample::{HandSample, Reply};
pub use feedback::status::{Status, Words};
pub use feedback::tactile::TactileBlock;
pub use feedback::undocumented::Undocumented;
pub use heat::DriveHeat;
pub use moment::{Moment, Timed};
pub use quantity::{Quantity, QuantityRow, Touch};
pub use refusal::{ModbusException, Presence, Refusal};
pub use register::{REGISTERS, Register, Span};
pub use setpoints::{ArmEpoch, Setpoints};
pub use setting::{Setting, Trigger};
pub use units::{
    Angle, Force, Gesture, HandId, OutOfRange, SerialSpeed, Speed, Target, UserGesture,
};
