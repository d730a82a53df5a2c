//! Building blocks of every view: texts, controls, cards, lists, borders.

mod card;
#[cfg(test)]
mod card_tests;
mod controls;
pub(crate) mod dash;
mod drive_words;
mod field;
mod pane;
pub(crate) mod path_field;
pub(crate) mod reorder;
mod sentence;
mod start;

pub(crate) use crate::ui::style::{Look, format};
pub(crate) use card::{ButtonRole, Card, CardButton, CardView};
pub(crate) use controls::{
    Button, Label, Pick, Weight, bare, card_ui, cell_ui, choose_ui, click_if, edit_ui, entry_ui,
    focus_ring, full_card_ui, head_ui, lamp, lamp_ui, lasting_popup, left_ui, named_field,
    popup_above, pressed, progress_ui, put_scroll_bar_in_margin, right_ui, set_accessible_name,
    share, sign, small_text_ui, table, text_width, tick_ui, translated_edit_ui, warning_ui,
    wide_ui,
};
pub(crate) use drive_words::DriveWords;
pub(crate) use field::{NumberField, TextField};
pub(crate) use pane::{Pane, Typing, ViewRequest};
pub(crate) use sentence::Sentence;
pub(crate) use start::{StartButton, StartWish, start_refused};
