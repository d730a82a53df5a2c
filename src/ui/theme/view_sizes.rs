//! Lengths of the single views in points: tiles, columns, rows. No colours, no fonts.

/// Size of the number on a tab.
pub(crate) const FAULT_BADGE: f32 = 16.0;
/// Width of the readings: least and most.
pub(crate) const TIP_READINGS: (f32, f32) = (150.0, 230.0);
/// Height from which the forces find room over the channels.
pub(crate) const TIP_BOTH_PLOTS: f32 = 270.0;
/// Smallest height of the chosen frame's card.
pub(crate) const FRAME_DETAIL_LEAST: f32 = 150.0;
/// Width of the filter's field.
pub(crate) const TRAFFIC_FILTER: f32 = 220.0;
/// Height of a field's row.
pub(crate) const FIELD_ROW: f32 = 17.0;
/// Height of a row.
pub(crate) const FRAME_ROW: f32 = 19.0;
/// Width of the scroll bar.
pub(crate) const FRAME_BAR: f32 = 12.0;
/// Width of a ring.
pub(crate) const RING_LINE: f32 = 1.6;
/// Least and greatest length of the head of an arrow.
pub(crate) const ARROW_HEAD: (f32, f32) = (3.0, 8.0);
/// Width of the line of a force.
pub(crate) const ARROW_LINE: f32 = 2.5;
/// Least and greatest width of the list of recordings.
pub(crate) const RECORDINGS_LIST: (f32, f32) = (168.0, 300.0);
/// Room of the word that says where the fingertip's end is.
pub(crate) const COMPASS_WORD: egui::Vec2 = egui::vec2(40.0, 12.0);
/// The bar of the heat scale.
pub(crate) const HEAT_BAR: egui::Vec2 = egui::vec2(64.0, 8.0);
/// The sign of a frame with something wrong.
pub(crate) const FRAME_WRONG: egui::Vec2 = egui::vec2(12.0, 11.0);
/// Room inside a number field.
pub(crate) const NUMBER_INSET: egui::Margin = egui::Margin::symmetric(6, 0);
/// Room inside a text field.
pub(crate) const FIELD_INSET: egui::Margin = egui::Margin::symmetric(8, 2);
