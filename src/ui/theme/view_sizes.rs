//! Lengths of the single views in points: tiles, columns, rows. No colours, no fonts.

/// Width from which six tiles stand in one row.
pub(crate) const DRIVE_TILES_ROW: f32 = 840.0;
/// Height of a tile without its cause.
pub(crate) const DRIVE_TILE_LOW: f32 = 52.0;
/// Height of the view from which tiles say the cause, too.
pub(crate) const DRIVE_TILES_ROOMY: f32 = 560.0;
/// Size of the number on a tab.
pub(crate) const FAULT_BADGE: f32 = 16.0;
/// Height of a finger's name with its number.
pub(crate) const HAND_HEAD: f32 = 34.0;
/// Size from which numbers find room.
pub(crate) const HAND_NUMBERS_ROOM: (f32, f32) = (240.0, 230.0);
/// Width of a message's age.
pub(crate) const MESSAGE_AGE: f32 = 52.0;
/// The filter's field has a row of its own where it would be narrower.
pub(crate) const MESSAGE_FIELD: f32 = 96.0;
/// Above and below the text of a message.
pub(crate) const MESSAGE_AIR: f32 = 3.0;
/// Width of a time in the list of events.
pub(crate) const RECORDINGS_TIME: f32 = 54.0;
/// The scan stands below the form if that leaves it so much: its controls and two hands.
pub(crate) const SCAN_LEAST: f32 = 260.0;
/// Height of one found hand: two lines.
pub(crate) const SCAN_HAND_ROW: f32 = 44.0;
/// Height of the bar that shows how far a scan is.
pub(crate) const SCAN_BAR: f32 = 4.0;
/// Width from which the force in space finds room beside the compass, and height from which below it.
pub(crate) const TIP_DETAIL_WIDE: f32 = 760.0;
/// Least side of the force seen from the side.
pub(crate) const TIP_SQUARE_LEAST: f32 = 118.0;
/// Width of the readings: least and most.
pub(crate) const TIP_READINGS: (f32, f32) = (150.0, 230.0);
/// Height from which the forces find room over the channels.
pub(crate) const TIP_BOTH_PLOTS: f32 = 270.0;
/// Heights of the drawn hand in the overview: less shows nothing, more would take the room of the faults.
pub(crate) const HAND_LEAST: f32 = 130.0;
/// Greatest width of the drawn hand.
pub(crate) const HAND_MOST: f32 = 340.0;
/// Height that the faults below keep.
pub(crate) const TOUCH_FAULTS_LEAST: f32 = 150.0;
/// Height of a fingertip's name, and of its forces.
pub(crate) const TIP_TITLE: f32 = 18.0;
/// Height of the two values below a fingertip.
pub(crate) const TIP_VALUES: f32 = 40.0;
/// Smallest height of the chosen frame's card.
pub(crate) const FRAME_DETAIL_LEAST: f32 = 150.0;
/// Width of the filter's field.
pub(crate) const TRAFFIC_FILTER: f32 = 220.0;
/// Height of a field's row.
pub(crate) const FIELD_ROW: f32 = 17.0;
/// Width of the place of a field's bytes in the frame.
pub(crate) const FIELD_PLACE: f32 = 58.0;
/// Width of a field's name.
pub(crate) const FIELD_NAME: f32 = 150.0;
/// Height of a row.
pub(crate) const FRAME_ROW: f32 = 19.0;
/// Height of the head.
pub(crate) const FRAME_HEAD: f32 = 20.0;
/// Width of the time: hours in seconds with three digits.
pub(crate) const FRAME_TIME: f32 = 78.0;
/// Width of the arrow.
pub(crate) const FRAME_ARROW: f32 = 16.0;
/// Width of the kind.
pub(crate) const FRAME_KIND: f32 = 92.0;
/// Width of the scroll bar.
pub(crate) const FRAME_BAR: f32 = 12.0;
/// Room for the sign that something is wrong.
pub(crate) const FRAME_SIGN: f32 = 16.0;
/// Room of a mark for what nobody has seen yet.
pub(crate) const UNSEEN_MARK: f32 = 12.0;
/// Width of a ring.
pub(crate) const RING_LINE: f32 = 1.6;
/// Width of the age of a message in the overview.
pub(crate) const MESSAGE_AGE_SHORT: f32 = 48.0;
/// What a message keeps from the next.
pub(crate) const MESSAGE_MARGIN: f32 = 6.0;
/// What the first line of a message has more than others.
pub(crate) const MESSAGE_LEAD: f32 = 5.0;
/// Where its words begin below its upper edge.
pub(crate) const MESSAGE_TEXT_TOP: f32 = 3.0;
/// Where the middle of the first line of a message is.
pub(crate) const MESSAGE_FIRST: f32 = 7.0;
/// Height of a line of small words.
pub(crate) const MESSAGE_LINE: f32 = 14.0;
/// Least and greatest length of the head of an arrow.
pub(crate) const ARROW_HEAD: (f32, f32) = (3.0, 8.0);
/// Width of the line of a force.
pub(crate) const ARROW_LINE: f32 = 2.5;
/// Least and greatest width of the list of recordings.
pub(crate) const RECORDINGS_LIST: (f32, f32) = (168.0, 300.0);
/// Room of the word that says where the fingertip's end is.
pub(crate) const COMPASS_WORD: egui::Vec2 = egui::vec2(40.0, 12.0);
/// Room of a word in the plot of channels.
pub(crate) const CHANNEL_WORD: egui::Vec2 = egui::vec2(60.0, 14.0);
/// Width of the captions beside the fingertips' numbers.
pub(crate) const TIP_NUMBERS_CAPTION: f32 = 44.0;
/// The bar of the heat scale.
pub(crate) const HEAT_BAR: egui::Vec2 = egui::vec2(64.0, 8.0);
/// Room of a sign before a wrong field of a frame.
pub(crate) const WRONG_SIGN: f32 = 13.0;
/// The sign of a frame with something wrong.
pub(crate) const FRAME_WRONG: egui::Vec2 = egui::vec2(12.0, 11.0);
/// Room inside a number field.
pub(crate) const NUMBER_INSET: egui::Margin = egui::Margin::symmetric(6, 0);
/// Room inside a text field.
pub(crate) const FIELD_INSET: egui::Margin = egui::Margin::symmetric(8, 2);
/// Room inside a text field in a low row.
pub(crate) const FIELD_INSET_LOW: egui::Margin = egui::Margin::symmetric(8, 0);
/// Height from which a drive's tile says the cause.
pub(crate) const CAUSE_LEAST: f32 = 26.0;
/// Least width of a message.
pub(crate) const MESSAGE_LEAST: f32 = 40.0;
