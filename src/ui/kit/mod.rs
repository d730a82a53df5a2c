//! What every view is built from: texts, controls, cards, lists, borders.

pub(crate) mod card;
#[cfg(test)]
pub(crate) mod card_tests;
pub(crate) mod controls;
pub(crate) mod dash;
pub(crate) mod format;
pub(crate) mod look;
pub(crate) mod number;
pub(crate) mod path_field;
pub(crate) mod reorder;
pub(crate) mod text_field;
