//! Building blocks of texts and controls: sentences in two languages, number formats, the colours of a frame.

pub(crate) mod format;
mod look;
pub(crate) mod phrase;

pub(crate) use look::Look;
pub(crate) use phrase::Text;
