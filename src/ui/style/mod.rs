//! What texts and controls are made of: sentences in two languages, numbers as people read them, the colours of a frame.

pub(crate) mod format;
mod look;
pub(crate) mod phrase;

pub(crate) use look::Look;
pub(crate) use phrase::Text;
