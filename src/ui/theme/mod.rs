//! The visual design: colours, sizes, fonts, icons. Independent of the content drawn.

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
