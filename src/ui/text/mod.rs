//! Every sentence of the window, in English and Chinese. No layout, no numbers.

pub(crate) mod cards;
pub(crate) mod checkup;
pub(crate) mod device;
pub(crate) mod errors;
pub(crate) mod exhibit;
pub(crate) mod hold;
pub(crate) mod inputs;
pub(crate) mod main;
pub(crate) mod notices;
pub(crate) mod panels;
pub(crate) mod poses;
pub(crate) mod recordings;
pub(crate) mod scan;
pub(crate) mod traffic;
pub(crate) mod tune;
pub(crate) mod window;
pub(crate) mod words;

pub(crate) use crate::ui::style::Text;
