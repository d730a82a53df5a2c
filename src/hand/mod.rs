//! What the device is: registers, values, samples, commands. No bytes on a wire, no clock, no egui.
//!
//! Everything that reaches a hand is a [`HandCommand`], a [`Setting`] or a [`Trigger`]; everything that comes back
//! passes [`sample::HandSample`]. Both are built from the one table in [`register`].
#![warn(missing_docs)]

pub mod column;
pub mod command;
pub mod dof;
pub mod fault;
pub mod heat;
pub mod impact;
pub mod kinematics;
pub mod moment;
pub mod quantity;
pub mod reading;
pub mod refusal;
pub mod register;
pub mod sample;
pub mod setpoints;
pub mod setting;
pub mod status;
pub mod tactile;
pub mod undocumented;
pub mod units;

pub use command::{GestureRoute, HandCommand, RegisterWrite, Writes};
pub use dof::{Dof, Finger, PerDof, PerFinger};
pub use fault::{Fault, Faults};
pub use heat::DriveHeat;
pub use moment::{Moment, Timed};
pub use quantity::{Quantity, QuantityRow, Touch};
pub use reading::{
    AngleReading, CurrentReading, ForceReading, PositionReading, TemperatureReading,
};
pub use refusal::{ModbusException, Refusal};
pub use register::{REGISTERS, Register, Span};
pub use sample::{Group, Groups, HandSample, Reply};
pub use setpoints::{ArmEpoch, Setpoints};
pub use setting::{Setting, Trigger};
pub use status::{Status, Words};
pub use tactile::TactileBlock;
pub use undocumented::Undocumented;
pub use units::{
    Angle, Force, Gesture, HandId, OutOfRange, SerialSpeed, Speed, Target, UserGesture,
};
