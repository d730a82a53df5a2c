//! Dragging a finger in the picture: finds the joint angle that brings the grabbed point to the pointer.

use crate::draw::figure::camera::Camera;
use crate::draw::figure::render::SeenPlace;
use crate::hand::Dof;
use crate::hand::kinematics::{Segment, SegmentFrames};
use crate::ui::hand::scene::HandPicture;
use egui::Pos2;
use glam::Vec3;

/// Steps from bent to open in the search along the point's path, and bisections of the last step.
const STEPS: u8 = 40;
const HALVINGS: u8 = 10;
/// Weight of the error across the path. It is low: else a finger that bends towards the viewer would lag, and then jump.
const ACROSS_PART: f32 = 0.05;
/// Maximum speed of the point along its path relative to the pointer: where the path turns back, it catches up smoothly.
const CATCH_UP: f32 = 3.0;

/// A point of a finger that the user is dragging.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FingerDrag {
    /// Joint that is dragged.
    pub(crate) dof: Dof,
    segment: Segment,
    /// The grabbed point in the segment's frame.
    at: Vec3,
    /// Last share sent to the joint, and the pointer position at that time.
    share: f32,
    pointer: Pos2,
}

impl FingerDrag {
    /// Grabs the point at `place` below the pointer. `None` if no joint moves it or the joint's angle is unknown.
    pub(crate) fn new(
        camera: &Camera,
        picture: &HandPicture,
        place: SeenPlace,
        pointer: Pos2,
    ) -> Option<Self> {
        let dof = place.segment.dof()?;
        let frame = camera.hand * picture.pose().frame(place.segment);
        let seen = camera.seen_at(pointer, place.depth);
        Some(Self {
            dof,
            segment: place.segment,
            at: frame.inverse().transform_point3(seen),
            share: picture.actual[dof]?,
            pointer,
        })
    }

    /// Returns the share of the way to open (0..=1) at which the point is nearest to the pointer.
    pub(crate) fn follow(&mut self, camera: &Camera, picture: &HandPicture, pointer: Pos2) -> f32 {
        let mut shares = picture.actual.map(|share| share.unwrap_or(1.0));
        let mut place = |share: f32| {
            shares[self.dof] = share;
            let pose = SegmentFrames::of_shares(picture.side, &shares);
            let at = pose.frame(self.segment).transform_point3(self.at);
            camera.place(at)
        };
        let step = 1.0 / f32::from(STEPS);
        let way: Vec<Pos2> = (0..=STEPS).map(|at| place(f32::from(at) * step)).collect();
        let (first, last) = (place(0.0), place(1.0));
        let along = (last - first).normalized();
        let off = |at: Pos2| {
            let off = pointer - at;
            let forth = off.dot(along).powi(2);
            forth + ACROSS_PART * (off.length_sq() - forth)
        };
        let tried = way.iter().zip(0_u8..);
        let nearest = tried.min_by(|(one, _), (other, _)| off(**one).total_cmp(&off(**other)));
        let mut best = nearest.map_or(self.share, |(_, at)| f32::from(at) * step);
        let mut span = step / 2.0;
        for _ in 0..HALVINGS {
            for tried in [best - span, best + span].map(|share| share.clamp(0.0, 1.0)) {
                if off(place(tried)) < off(place(best)) {
                    best = tried;
                }
            }
            span /= 2.0;
        }
        let length: f32 = way
            .windows(2)
            .map(|pair| pair.first().zip(pair.last()))
            .map(|ends| ends.map_or(0.0, |(one, other)| one.distance(*other)))
            .sum();
        let most = CATCH_UP * pointer.distance(self.pointer) / length.max(1.0);
        self.pointer = pointer;
        self.share = best.clamp(self.share - most, self.share + most);
        self.share
    }
}
