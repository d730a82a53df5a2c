//! The segments as capsules that occlude light: they darken folds and cast shadows. Computed four at a time.

use crate::figure::camera::Camera;
use arrayvec::ArrayVec;
use glam::{Vec3, Vec4};
use handscope_core::hand::kinematics::{Segment, SegmentFrames};

use Segment::{
    Index1, Index2, Little1, Little2, Middle1, Middle2, Ring1, Ring2, Thumb2, Thumb3, Thumb4,
};

/// Distance up to which a bar darkens the sky, and the share of sky that a bar touching the surface blocks.
const NEAR_MM: f32 = 16.0;
const FOLD_PART: f32 = 0.95;
/// Growth of a shadow's soft edge with the distance to the occluder.
const SOFT_PART: f32 = 0.22;
/// Bones of one finger touch: below the first distance they cast no shadow on each other, beyond the second a full one.
const OWN_MM: [f32; 2] = [4.0, 16.0];
/// Radius of an unused lane: far from everything.
const NO_BAR_MM: f32 = -1e9;

/// Start and end in the segment's frame, and radius; mm.
const BARS: [(Segment, [f32; 3], [f32; 3], f32); 11] = [
    (Little1, [0.0, 0.0, -6.6], [-3.0, 31.0, -6.6], 8.6),
    (Little2, [0.0, 2.0, -6.1], [-1.0, 36.7, -6.1], 7.4),
    (Ring1, [0.0, 0.0, -6.6], [-3.0, 31.0, -6.6], 8.6),
    (Ring2, [0.0, 2.0, -6.1], [-1.0, 46.6, -6.1], 7.8),
    (Middle1, [0.0, 0.0, -6.6], [-3.0, 31.0, -6.6], 8.6),
    (Middle2, [0.0, 2.0, -6.1], [-1.0, 50.0, -6.1], 7.8),
    (Index1, [0.0, 0.0, -6.6], [-3.0, 31.0, -6.6], 8.6),
    (Index2, [0.0, 2.0, -6.1], [-1.0, 46.6, -6.1], 7.8),
    (Thumb2, [2.0, 4.0, -7.2], [29.0, 20.0, -7.2], 10.0),
    (Thumb3, [0.0, 0.0, -7.2], [21.9, 12.8, -7.2], 9.0),
    (Thumb4, [0.0, 0.0, -7.2], [27.0, 9.0, -7.2], 8.4),
];

/// One bar in eye coordinates.
#[derive(Debug, Clone, Copy)]
struct RoundBar {
    segment: Segment,
    from: Vec3,
    along: Vec3,
    radius: f32,
}

/// All bars of a hand, and the direction to the key light.
#[derive(Debug)]
pub(crate) struct Bars {
    bars: ArrayVec<RoundBar, 11>,
    key: Vec3,
}

/// The bars that can darken one part.
#[derive(Debug)]
pub(crate) struct Near {
    fours: ArrayVec<Four, 3>,
    key: Vec3,
}

/// Four vectors, each in a lane.
#[derive(Debug, Clone, Copy)]
struct Vec3x4([Vec4; 3]);

/// Four bars, each in a lane.
#[derive(Debug, Clone, Copy)]
struct Four {
    from: Vec3x4,
    along: Vec3x4,
    radius: Vec4,
    /// Reciprocal of the squared length.
    per_length_sq: Vec4,
    radius_sq: Vec4,
    /// Falloff value at which the sky's darkening begins.
    least: Vec4,
    /// Component of the axis towards the key light, and the reciprocal square of the part across it.
    to_key: Vec4,
    per_aside_sq: Vec4,
    /// 1 for a bar of the same finger.
    own: Vec4,
}

impl Bars {
    /// Bars of a hand in this pose.
    pub(crate) fn new(camera: &Camera, pose: &SegmentFrames, key: Vec3) -> Self {
        let bars = BARS.into_iter().map(|(segment, from, to, radius)| {
            let frame = camera.hand * pose.frame(segment);
            let from = frame.transform_point3(from.into());
            let along = frame.transform_point3(to.into()) - from;
            RoundBar {
                segment,
                from,
                along,
                radius,
            }
        });
        Self {
            bars: bars.collect(),
            key,
        }
    }

    /// Bars that can darken any point of a sphere around a part; `segment` is `None` for parts that are not of the hand.
    pub(crate) fn near(&self, segment: Option<Segment>, middle: Vec3, radius: f32) -> Near {
        let others = self.bars.iter().filter(|bar| Some(bar.segment) != segment);
        let near: ArrayVec<RoundBar, 11> = others
            .filter(|bar| bar.matters(middle, radius, self.key))
            .copied()
            .collect();
        let fours = near
            .chunks(4)
            .map(|bars| Four::new(bars, self.key, segment));
        Near {
            fours: fours.collect(),
            key: self.key,
        }
    }
}

impl RoundBar {
    /// True if it can darken any point of a sphere.
    fn matters(&self, middle: Vec3, radius: f32, key: Vec3) -> bool {
        let four = Four::new(std::slice::from_ref(self), key, None);
        let (reach, to) = (radius + self.radius + NEAR_MM, four.to(middle));
        let nearest = four.nearest(&to);
        let (passed, forth) = four.passed(&to, key);
        let beside_sq = passed.dot(&passed).x - forth.x * forth.x;
        nearest.dot(&nearest).x < reach * reach || (forth.x > -radius && beside_sq < reach * reach)
    }
}

impl Near {
    /// Distance from a point to the surface of the nearest bar in mm, negative within it.
    pub(crate) fn apart(&self, at: Vec3) -> f32 {
        let least = self.fours.iter().map(|four| {
            let way = four.nearest(&four.to(at));
            (way.dot(&way).map(f32::sqrt) - four.radius).min_element()
        });
        least.fold(f32::MAX, f32::min)
    }

    /// The shares of sky and key light that reach a point with this normal.
    pub(crate) fn left(&self, at: Vec3, normal: Vec3) -> (f32, f32) {
        let (mut sky, mut lit) = (Vec4::ONE, Vec4::ONE);
        let is_lit = normal.dot(self.key) > -0.15;
        for four in &self.fours {
            let to = four.to(at);
            sky *= four.sky(&to, normal);
            if is_lit {
                lit = lit.min(four.lit(&to, self.key));
            }
        }
        (sky.x * sky.y * sky.z * sky.w, lit.min_element())
    }
}

impl Four {
    fn new(bars: &[RoundBar], key: Vec3, segment: Option<Segment>) -> Self {
        let bar = |lane: usize| bars.get(lane);
        let lanes = |part: &dyn Fn(&RoundBar) -> f32, none: f32| {
            Vec4::from_array(std::array::from_fn(|lane| bar(lane).map_or(none, part)))
        };
        let from = Vec3x4::from_lanes(|lane| bar(lane).map_or(Vec3::ZERO, |bar| bar.from));
        let along = Vec3x4::from_lanes(|lane| bar(lane).map_or(Vec3::ZERO, |bar| bar.along));
        let (length_sq, to_key) = (along.dot(&along), along.dot_all(key));
        let finger = segment.and_then(Segment::finger);
        let own = |bar: &RoundBar| f32::from(u8::from(finger == bar.segment.finger()));
        Self {
            from,
            along,
            radius: lanes(&|bar| bar.radius, NO_BAR_MM),
            per_length_sq: length_sq.max(Vec4::ONE).recip(),
            radius_sq: lanes(&|bar| bar.radius.powi(2), 0.0),
            least: lanes(&|bar| (bar.radius / (bar.radius + NEAR_MM)).powi(2), 0.0),
            to_key,
            per_aside_sq: (length_sq - to_key * to_key).max(Vec4::ONE).recip(),
            own: lanes(&own, 0.0),
        }
    }

    /// Vectors from the starts of the bars to a point.
    fn to(&self, at: Vec3) -> Vec3x4 {
        Vec3x4::splat(at).minus(&self.from)
    }

    /// Vectors from a point to the nearest point of each axis; `to` is that of [`Self::to`].
    fn nearest(&self, to: &Vec3x4) -> Vec3x4 {
        let part = to.dot(&self.along) * self.per_length_sq;
        self.along
            .times(part.clamp(Vec4::ZERO, Vec4::ONE))
            .minus(to)
    }

    /// Vectors from a point to where the ray to the key light passes each axis, and the distance along the ray.
    fn passed(&self, to: &Vec3x4, key: Vec3) -> (Vec3x4, Vec4) {
        let part = (to.dot(&self.along) - self.to_key * to.dot_all(key)) * self.per_aside_sq;
        let way = self
            .along
            .times(part.clamp(Vec4::ZERO, Vec4::ONE))
            .minus(to);
        (way, way.dot_all(key))
    }

    /// The share of sky that each bar leaves to a surface.
    fn sky(&self, to: &Vec3x4, normal: Vec3) -> Vec4 {
        let way = self.nearest(to);
        let per_apart_sq = way.dot(&way).max(Vec4::ONE).recip();
        let towards = way.dot_all(normal).max(Vec4::ZERO) * per_apart_sq.map(f32::sqrt);
        let near = (self.radius_sq * per_apart_sq).min(Vec4::ONE) - self.least;
        Vec4::ONE - FOLD_PART * towards * near.max(Vec4::ZERO)
    }

    /// The share of the key light that each bar leaves to a point.
    fn lit(&self, to: &Vec3x4, key: Vec3) -> Vec4 {
        let (way, forth) = self.passed(to, key);
        let beside_sq = (way.dot(&way) - forth * forth).max(Vec4::ZERO);
        let soft = 2.0 + SOFT_PART * forth.max(Vec4::ZERO);
        let beside = beside_sq.map(f32::sqrt) - self.radius;
        let open = smooth((beside + soft) / (2.0 * soft));
        let [near, far] = OWN_MM;
        let own = smooth((forth - near) / (far - near));
        let dark = (1.0 - open) * (1.0 - self.own * (1.0 - own));
        let dark = Vec4::select(forth.cmpgt(Vec4::ZERO), dark, Vec4::ZERO);
        Vec4::ONE - dark
    }
}

impl Vec3x4 {
    fn from_lanes(lane: impl Fn(usize) -> Vec3) -> Self {
        let [a, b, c, d] = std::array::from_fn(lane);
        Self([
            Vec4::new(a.x, b.x, c.x, d.x),
            Vec4::new(a.y, b.y, c.y, d.y),
            Vec4::new(a.z, b.z, c.z, d.z),
        ])
    }

    fn splat(all: Vec3) -> Self {
        Self(all.to_array().map(Vec4::splat))
    }

    fn dot(&self, other: &Self) -> Vec4 {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        x * a + y * b + z * c
    }

    fn dot_all(&self, other: Vec3) -> Vec4 {
        let [x, y, z] = self.0;
        x * other.x + y * other.y + z * other.z
    }

    fn minus(&self, other: &Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x - a, y - b, z - c])
    }

    fn times(&self, by: Vec4) -> Self {
        Self(self.0.map(|part| part * by))
    }
}

/// Smoothstep from 0 to 1.
fn smooth(part: Vec4) -> Vec4 {
    let part = part.clamp(Vec4::ZERO, Vec4::ONE);
    part * part * (3.0 - 2.0 * part)
}
