//! The one visual language: colours, sizes, type, icons. Nothing here knows what is drawn with them.

mod fonts;
mod icons;
mod palette;
mod sizes;
mod style;

pub(crate) use fonts::*;
pub(crate) use icons::*;
pub(crate) use palette::Palette;
pub(crate) use sizes::*;
pub(crate) use style::style;
