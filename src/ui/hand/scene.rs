//! Parts of the hand to draw: joint positions and targets, load on the fingertips, the object held.

use crate::draw::figure::light::{Coat, PlacedSolid};
use crate::draw::figure::shape::{self, HeldPlace};
use crate::hand::kinematics::{Segment, SegmentFrames, Side};
use crate::hand::{Dof, Finger, PerDof, PerFinger};
use crate::ui::theme::Palette;
use arrayvec::ArrayVec;
use egui::Color32;
use glam::{Affine3, Mat3};

/// A target this close to the actual angle, as a share of the way, has no ghost.
const OFF_TARGET_PART: f32 = 0.03;
/// Length of a force's arrow, and the minimum force that has one.
const ARROW_MM_PER_N: f32 = 4.0;
const ARROW_MAX_MM: f32 = 60.0;
const ARROW_MIN_N: f32 = 0.1;
/// Opacity of a shell seen frontally, and of the object held.
const SHELL_PART: f32 = 0.1;
const HELD_PART: f32 = 0.2;

/// Strength of the glow on a hovered part, a faulty one, a slightly warm one (twice that if hot), and a marked one.
const LIT_PART: f32 = 0.5;
const BAD_PART: f32 = 0.65;
const WARM_PART: f32 = 0.3;
const MARKED_PART: f32 = 0.85;

/// Load on one fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct TipLoad {
    /// Heat of the hottest pad, 0..=1.
    pub(crate) heat: Option<f32>,
    /// Newtons into the pad, towards the tip, and to the right as seen facing the pad with the tip up.
    pub(crate) force: Option<[f32; 3]>,
}

/// Fault and temperature of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Hurt {
    /// The drive has a fault, or protects itself.
    pub(crate) is_bad: bool,
    /// From not warm (0) to hot (1).
    pub(crate) heat: f32,
}

/// Content of the picture. Angles are shares of the way from bent (0) to open (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HandPicture {
    /// Side of the hand.
    pub(crate) side: Side,
    /// Actual positions. A finger with an unknown joint is an open grey shell.
    pub(crate) actual: PerDof<Option<f32>>,
    /// Target positions, drawn as a ghost where they differ from the actual ones.
    pub(crate) target: PerDof<Option<f32>>,
    /// Draws everything pale: the values are old.
    pub(crate) is_stale: bool,
    /// Heat and force of the fingertips.
    pub(crate) tips: PerFinger<TipLoad>,
    /// Object in front of the simulated hand.
    pub(crate) held: Option<HeldPlace>,
    /// Faults and temperatures of the drives.
    pub(crate) hurts: PerDof<Hurt>,
    /// Fingers that characterise the pose.
    pub(crate) marked: PerFinger<bool>,
    /// Joint hovered in another part of the window.
    pub(crate) lit: Option<Dof>,
}

impl HandPicture {
    /// A pose alone, without targets or load.
    pub(crate) fn of(side: Side, shares: &PerDof<Option<f32>>) -> Self {
        Self {
            side,
            actual: *shares,
            target: PerDof::splat(None),
            is_stale: false,
            tips: PerFinger::splat(TipLoad::default()),
            held: None,
            hurts: PerDof::splat(Hurt::default()),
            marked: PerFinger::splat(false),
            lit: None,
        }
    }

    /// Frames of the segments; unknown joints count as open.
    pub(crate) fn pose(&self) -> SegmentFrames {
        SegmentFrames::of_shares(self.side, &self.actual.map(|share| share.unwrap_or(1.0)))
    }

    /// True if all angles of a finger are known.
    pub(crate) fn is_known(&self, finger: Finger) -> bool {
        let mut own = Dof::ALL.into_iter().filter(|dof| dof.finger() == finger);
        own.all(|dof| self.actual[dof].is_some())
    }

    fn is_off(&self, dof: Dof) -> bool {
        let pair = self.target[dof].zip(self.actual[dof]);
        pair.is_some_and(|(target, actual)| (target - actual).abs() > OFF_TARGET_PART)
    }

    /// True if this drive moves the segment; the thumb's rotation moves all of its segments.
    fn follows(segment: Segment, dof: Dof) -> bool {
        let whole = dof == Dof::ThumbRotate && segment.finger() == Some(Finger::Thumb);
        whole || segment.dof() == Some(dof)
    }

    /// All parts to draw, and the pose of the hand.
    pub(crate) fn parts(
        &self,
        palette: &Palette,
        is_small: bool,
    ) -> (SegmentFrames, ArrayVec<PlacedSolid<'static>, 32>) {
        let pose = self.pose();
        let mut parts = ArrayVec::new();
        let part = |segment| {
            Some(PlacedSolid {
                solid: shape::solid(segment, is_small)?,
                segment: Some(segment),
                frame: pose.frame(segment),
                coat: self.coat(segment, palette),
            })
        };
        parts.extend(Segment::ALL.into_iter().filter_map(part));
        let wanted = PerDof::from_fn(|dof| self.target[dof].or(self.actual[dof]).unwrap_or(1.0));
        let wanted = SegmentFrames::of_shares(self.side, &wanted);
        let ghosts = Segment::ALL.into_iter().filter(|segment| {
            let off = |dof| self.is_off(dof) && Self::follows(*segment, dof);
            let known = segment.finger().is_some_and(|finger| self.is_known(finger));
            known && Dof::ALL.into_iter().any(off)
        });
        let ghost = |segment: Segment| {
            let color = segment.dof().map_or(palette.accent, |dof| palette.dof[dof]);
            Some(PlacedSolid {
                solid: shape::solid(segment, true)?,
                segment: None,
                frame: wanted.frame(segment),
                coat: shell(color),
            })
        };
        parts.extend(ghosts.filter_map(ghost));
        let known = Finger::ALL
            .into_iter()
            .filter(|finger| self.is_known(*finger));
        parts.extend(known.filter_map(|finger| self.arrow(&pose, finger, palette)));
        parts.extend(self.held.map(|held| PlacedSolid {
            solid: held.shape.solid(),
            segment: None,
            frame: self.side.frame() * held.frame,
            coat: Coat {
                color: Some(palette.simulated),
                glass: HELD_PART,
                is_held: true,
                ..Coat::default()
            },
        }));
        (pose, parts)
    }

    fn coat(&self, segment: Segment, palette: &Palette) -> Coat {
        let Some(finger) = segment.finger() else {
            return Coat::default();
        };
        if !self.is_known(finger) {
            return shell(palette.faint);
        }
        let heat = self.tips[finger].heat;
        let lit = self.lit.filter(|dof| Self::follows(segment, *dof));
        Coat {
            // Untouched pads have the colour of the sensor.
            heat: heat.map(|heat| (palette.heat(heat), (heat * 4.0).clamp(0.0, 1.0))),
            glow: self.glow(segment, lit, palette),
            ..Coat::default()
        }
    }

    /// Colour and strength of a segment's glow: a fault first, then hover, temperature and mark.
    fn glow(
        &self,
        segment: Segment,
        lit: Option<Dof>,
        palette: &Palette,
    ) -> Option<(Color32, f32)> {
        let dof = segment.dof()?;
        let hurt = self.hurts[dof];
        if hurt.is_bad {
            return Some((palette.bad, BAD_PART));
        }
        let marked = self.marked[dof.finger()].then_some((palette.accent, MARKED_PART));
        let color = palette.warn.lerp_to_gamma(palette.bad, hurt.heat);
        let warm = (hurt.heat > 0.0).then_some((color, WARM_PART + WARM_PART * hurt.heat));
        lit.map(|dof| (palette.dof[dof], LIT_PART))
            .or(warm)
            .or(marked)
    }

    /// Arrow of the force on a fingertip, with its head at the pad: into the pad, inclined by the tangential force.
    fn arrow(
        &self,
        pose: &SegmentFrames,
        finger: Finger,
        palette: &Palette,
    ) -> Option<PlacedSolid<'static>> {
        let [normal, tipwards, right] = self.tips[finger].force?;
        let turn = pose.frame(Segment::tip(finger)).matrix3;
        let [out, up] = shape::pad_ways(finger).map(|way| turn * way);
        let force = up * tipwards + up.cross(out) * right - out * normal;
        let newtons = force.length();
        if newtons < ARROW_MIN_N || !newtons.is_finite() {
            return None;
        }
        let along = force / newtons;
        let length = (newtons * ARROW_MM_PER_N).min(ARROW_MAX_MM);
        let (side, front) = along.any_orthonormal_pair();
        let thick = length.clamp(12.0, 34.0);
        let shape = Mat3::from_cols(front * thick, along * length, side * thick);
        let from = pose.tip(finger) - along * length;
        Some(PlacedSolid {
            solid: shape::arrow(),
            segment: None,
            frame: Affine3::from_mat3_translation(shape, from),
            coat: Coat {
                color: Some(palette.accent),
                glow: Some((palette.accent, 0.7)),
                ..Coat::default()
            },
        })
    }
}

/// Coat of a shell, for parts that are not really there: only its rim is clearly visible.
fn shell(color: Color32) -> Coat {
    Coat {
        glow: Some((color, 1.0)),
        glass: SHELL_PART,
        ..Coat::default()
    }
}
