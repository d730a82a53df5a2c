//! Persistent parameters of a hand, as the window shows and changes them.

pub mod state;
pub(crate) mod work;

pub use crate::app::params::state::{ParamAction, ParamRefusal, ParamsState, rest_refusal};
pub(crate) use crate::app::params::work::ParamsHand;
