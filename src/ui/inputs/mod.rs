//! Inputs besides the window that may move the hand, and readers of its data.

mod cards;
mod mirror_card;
mod owner;
mod pad_card;
mod pad_picture;
mod pad_places;
mod pad_table;
mod source;
#[cfg(test)]
mod tests;
mod view;

pub(crate) use owner::owner_words;
pub(crate) use view::InputsView;
