//! A hand that answers bytes: memory, body, fingertips, scripts, servers. Knows no link and no window.

pub mod body;
pub mod drive;
mod extremes;
pub mod gesture;
pub mod hand;
mod live;
pub mod memory;
mod number;
pub mod personality;
pub mod scenario;
pub mod serve;
pub mod touch;

pub use body::{Body, Object};
pub use drive::Contact;
pub use hand::{JournalEntry, SaveFrame, SimConfig, SimHand, WriteEffect};
pub use memory::Refusal;
pub use personality::{ByteWords, MinusOne, OutOfRangeWrite, Personality, SaveAnswer, SpeedZero};
pub use scenario::{Scenario, UnknownScenario};
pub use serve::{Hands, SharedHand};
