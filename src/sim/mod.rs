//! A simulated hand at byte level: memory, body, fingertips, scripts, servers. Knows no link and no window.

pub mod body;
pub mod body_params;
pub mod drive;
mod effects;
mod extremes;
pub mod gesture;
pub mod hand;
pub mod held;
mod live;
pub mod memory;
mod number;
pub mod object;
pub mod object_file;
pub mod personality;
pub mod scenario;
pub mod serve;
mod supply;
pub mod touch;

pub use body::Body;
pub use body_params::BodyParams;
pub use hand::{JournalEntry, ReplyTiming, SaveFrame, SimConfig, SimHand, WriteEffect};
pub use held::{HeldFinger, HeldState, ObjectLoss};
pub use memory::AccessError;
pub use object::{NamedObject, Object, Obstacle};
pub use personality::{
    AnyId, BaudEffect, Beyond, ByteWords, Calibration, ChangeAck, ClearError, DefaultsWrite,
    Doubles, Effect, FlashWrite, ForceCompared, GapAnswer, InnerAddress, LongRead, MinusOne,
    NoSwitch, OutOfRangeWrite, Personality, Power, ReadOnlyWrite, ReplyUnit, RtuReplyGap, SWITCHES,
    SaveAnswer, SingleReply, SpeedZero, Switch, TactileCheck, TcpClients, Turnaround,
};
pub use scenario::{Scenario, UnknownScenario};
pub use serve::{SharedHand, SimHands};
