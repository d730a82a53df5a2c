//! Where motion comes from besides the window.

mod pad_picture;
mod pad_places;
mod pad_table;
#[cfg(test)]
mod tests;
mod view;

pub(crate) use pad_picture::{PadShown, PoseName, pad_picture_ui};
pub(crate) use pad_table::pad_table_ui;
pub(crate) use view::{InputsView, owner_words};
