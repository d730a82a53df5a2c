//! Icons of the window, by meaning. Drawn with [`crate::ui::theme::icon`].

use egui_material_icons::icons;

/// A character of the icon font.
pub(crate) type Icon = &'static str;

/// To the left: collapses a panel at the left, expands one at the right.
pub(crate) const TO_LEFT: Icon = icons::ICON_CHEVRON_LEFT.codepoint;
/// To the right.
pub(crate) const TO_RIGHT: Icon = icons::ICON_CHEVRON_RIGHT.codepoint;
/// Upwards.
pub(crate) const TO_TOP: Icon = icons::ICON_KEYBOARD_ARROW_UP.codepoint;
/// Downwards.
pub(crate) const TO_BOTTOM: Icon = icons::ICON_KEYBOARD_ARROW_DOWN.codepoint;
/// Opens a menu.
pub(crate) const MENU: Icon = icons::ICON_MENU.codepoint;
/// Locked: the joint does not move.
pub(crate) const LOCKED: Icon = icons::ICON_LOCK.codepoint;
/// Unlocked: the joint may move.
pub(crate) const UNLOCKED: Icon = icons::ICON_LOCK_OPEN.codepoint;
/// Settings.
pub(crate) const TUNE: Icon = icons::ICON_TUNE.codepoint;
/// Joints that move together.
pub(crate) const LINKED: Icon = icons::ICON_LINK.codepoint;
/// Needs attention.
pub(crate) const WARNING: Icon = icons::ICON_WARNING.codepoint;
/// Removes or closes.
pub(crate) const CLOSE: Icon = icons::ICON_CLOSE.codepoint;
/// Pauses.
pub(crate) const PAUSE: Icon = icons::ICON_PAUSE.codepoint;
/// Resumes.
pub(crate) const PLAY: Icon = icons::ICON_PLAY_ARROW.codepoint;
/// Starred: kept when other recordings are deleted.
pub(crate) const STAR: Icon = icons::ICON_BOOKMARK_ADDED.codepoint;
/// Not starred.
pub(crate) const NO_STAR: Icon = icons::ICON_BOOKMARK.codepoint;
/// The best of several.
pub(crate) const BEST: Icon = icons::ICON_STAR.codepoint;
/// Opens further options.
pub(crate) const MORE: Icon = icons::ICON_MORE_VERT.codepoint;

/// Deletes the last character.
pub(crate) const BACKSPACE: Icon = icons::ICON_BACKSPACE.codepoint;

#[cfg(test)]
pub(crate) const ALL: [Icon; 18] = [
    TO_LEFT, TO_RIGHT, TO_TOP, TO_BOTTOM, MENU, LOCKED, UNLOCKED, TUNE, LINKED, WARNING, CLOSE,
    PAUSE, PLAY, STAR, NO_STAR, BEST, MORE, BACKSPACE,
];
