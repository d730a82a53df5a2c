//! What a hand keeps, as the window shows and changes it.

pub mod action;
pub mod compared;
pub mod refusal;
pub(crate) mod running;
pub mod state;
pub(crate) mod work;

pub use crate::app::params::action::ParamAction;
pub use crate::app::params::refusal::{ParamRefusal, rest_refusal};
pub use crate::app::params::state::ParamsState;
pub(crate) use crate::app::params::work::ParamsHand;
