//! What every view is built from: texts, controls, cards, lists, borders.

mod card;
#[cfg(test)]
mod card_tests;
mod controls;
pub(crate) mod dash;
pub(crate) mod format;
mod look;
mod number;
pub(crate) mod path_field;
pub(crate) mod reorder;
mod text_field;

pub(crate) use card::{Card, CardView, Choice, Manner};
pub(crate) use controls::{
    Button, Label, Weight, card_ui, choose_ui, edit_ui, focus_ring, full_card_ui, head_ui, lamp,
    named_field, paint_text, pick_ui, pressed, sign, take_left, take_top, text_width, warning_sign,
};
pub(crate) use look::{Explain, Look, Pane, Typing};
pub(crate) use number::NumberField;
pub(crate) use text_field::{TextField, refused_ui};
