//! What is to be seen of the hand: where its joints are and shall be, what its fingertips feel, what it holds.

use crate::draw::figure::light::{Coat, Part};
use crate::draw::figure::shape::{self, Held};
use crate::hand::kinematics::{Segment, SegmentFrames, Side};
use crate::hand::{Dof, Finger, PerDof, PerFinger};
use crate::ui::theme::Palette;
use arrayvec::ArrayVec;
use egui::Color32;
use glam::{Affine3, Mat3};

/// A target this near to the actual angle, as a share of the way, has no ghost.
const OFF_TARGET_PART: f32 = 0.03;
/// Length of a force's arrow, and the least force that has one.
const ARROW_MM_PER_N: f32 = 4.0;
const ARROW_MAX_MM: f32 = 60.0;
const ARROW_MIN_N: f32 = 0.1;
/// How much a shell covers where one looks straight onto it, and what is held.
const SHELL_PART: f32 = 0.1;
const HELD_PART: f32 = 0.2;

/// How much light covers what is pointed at, has a fault, is a little warm (twice that if hot), or matters.
const LIT_PART: f32 = 0.5;
const BAD_PART: f32 = 0.65;
const WARM_PART: f32 = 0.3;
const MARKED_PART: f32 = 0.85;

/// What one fingertip feels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct TipLoad {
    /// Heat of its hottest pad, 0..=1.
    pub(crate) heat: Option<f32>,
    /// Newtons out of the pad, towards the tip, and to the right of who looks onto the pad with the tip up.
    pub(crate) force: Option<[f32; 3]>,
}

/// What hurts a drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Hurt {
    /// It has a fault, or protects itself.
    pub(crate) is_bad: bool,
    /// From not warm (0) to hot (1).
    pub(crate) heat: f32,
}

/// What is to be seen. Angles are shares of the way from bent (0) to open (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HandPicture {
    /// Which hand.
    pub(crate) side: Side,
    /// Where the joints are. A finger of which one is unknown is a grey shell, open.
    pub(crate) actual: PerDof<Option<f32>>,
    /// Where they are to go: a ghost where they are not there.
    pub(crate) target: PerDof<Option<f32>>,
    /// Draws everything pale: the values are old.
    pub(crate) is_stale: bool,
    /// Heat and force of the fingertips.
    pub(crate) tips: PerFinger<TipLoad>,
    /// What the simulated hand has before it.
    pub(crate) held: Option<Held>,
    /// What hurts the drives.
    pub(crate) hurts: PerDof<Hurt>,
    /// The fingers that the pose is about.
    pub(crate) marked: PerFinger<bool>,
    /// The joint that is pointed at somewhere else.
    pub(crate) lit: Option<Dof>,
}

impl HandPicture {
    /// A pose and nothing else.
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

    /// Where the segments are; what is unknown is open.
    pub(crate) fn pose(&self) -> SegmentFrames {
        SegmentFrames::of_shares(self.side, &self.actual.map(|share| share.unwrap_or(1.0)))
    }

    /// Whether all angles of a finger are known.
    pub(crate) fn is_known(&self, finger: Finger) -> bool {
        let mut own = Dof::ALL.into_iter().filter(|dof| dof.finger() == finger);
        own.all(|dof| self.actual[dof].is_some())
    }

    fn is_off(&self, dof: Dof) -> bool {
        let pair = self.target[dof].zip(self.actual[dof]);
        pair.is_some_and(|(target, actual)| (target - actual).abs() > OFF_TARGET_PART)
    }

    /// Whether a segment is moved by this drive; the thumb's rotation moves all of it.
    fn follows(segment: Segment, dof: Dof) -> bool {
        let whole = dof == Dof::ThumbRotate && segment.finger() == Some(Finger::Thumb);
        whole || segment.dof() == Some(dof)
    }

    /// All that is drawn, and the pose it is drawn in.
    pub(crate) fn parts(
        &self,
        palette: &Palette,
        is_small: bool,
    ) -> (SegmentFrames, ArrayVec<Part<'static>, 32>) {
        let pose = self.pose();
        let mut parts = ArrayVec::new();
        let part = |segment| {
            Some(Part {
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
            Some(Part {
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
        parts.extend(self.held.map(|held| Part {
            solid: shape::held(held),
            segment: None,
            frame: self.side.frame(),
            coat: Coat {
                color: Some(palette.simulated),
                glass: HELD_PART,
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
            // What is not touched keeps the colour of the sensor.
            heat: heat.map(|heat| (palette.heat(heat), (heat * 4.0).clamp(0.0, 1.0))),
            glow: self.glow(segment, lit, palette),
            ..Coat::default()
        }
    }

    /// What a segment shines with: what hurts first.
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

    /// The force of a fingertip: out of the pad, leaning as the tangential force does.
    fn arrow(
        &self,
        pose: &SegmentFrames,
        finger: Finger,
        palette: &Palette,
    ) -> Option<Part<'static>> {
        let [normal, tipwards, right] = self.tips[finger].force?;
        let turn = pose.frame(Segment::tip(finger)).matrix3;
        let [out, up] = shape::pad_ways(finger).map(|way| turn * way);
        let force = out * normal + up * tipwards + up.cross(out) * right;
        let newtons = force.length();
        if newtons < ARROW_MIN_N || !newtons.is_finite() {
            return None;
        }
        let along = force / newtons;
        let length = (newtons * ARROW_MM_PER_N).min(ARROW_MAX_MM);
        let (side, front) = along.any_orthonormal_pair();
        let thick = length.clamp(12.0, 34.0);
        let shape = Mat3::from_cols(front * thick, along * length, side * thick);
        Some(Part {
            solid: shape::arrow(),
            segment: None,
            frame: Affine3::from_mat3_translation(shape, pose.tip(finger)),
            coat: Coat {
                color: Some(palette.accent),
                glow: Some((palette.accent, 0.7)),
                ..Coat::default()
            },
        })
    }
}

/// What is not there, but would be: only its rim is seen well.
fn shell(color: Color32) -> Coat {
    Coat {
        glow: Some((color, 1.0)),
        glass: SHELL_PART,
        ..Coat::default()
    }
}
