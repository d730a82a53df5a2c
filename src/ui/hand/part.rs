//! What is drawn: solids, each with its place and its coat.

use crate::hand::kinematics::Segment;
use crate::ui::hand::solid::Solid;
use egui::Color32;
use glam::Affine3;

/// One solid to be drawn.
#[derive(Debug)]
pub(crate) struct Part<'a> {
    pub(crate) solid: &'a Solid,
    /// Whose it is: for the pointer and the shadows. None for what is no part of the hand.
    pub(crate) segment: Option<Segment>,
    pub(crate) frame: Affine3,
    pub(crate) coat: Coat,
}

/// How a part is coated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Coat {
    /// How much it covers where one looks straight onto it; 0 stands for all.
    pub(crate) glass: f32,
    /// Light of this colour in it, and how much.
    pub(crate) glow: Option<(Color32, f32)>,
    /// Heat of its pad, and how much of the pad's own colour that covers.
    pub(crate) heat: Option<(Color32, f32)>,
    /// The colour of what is plain.
    pub(crate) color: Option<Color32>,
}
