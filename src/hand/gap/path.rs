//! The path on which the pads of thumb and index face each other, parametrized by the distance between the pad centres.

use crate::hand::dof::{Dof, Finger, PerDof};
use crate::hand::feedback::reading::AngleReading;
use crate::hand::grip::Grip;
use crate::hand::kinematics::{Segment, SegmentFrames, Side};
use crate::hand::units::{Angle, Speed};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Index and thumb bend, in counts, at the corners of the path: where the pads meet, where the thumb is open, and where both
/// are open. The thumb stays rotated in front of the palm and the other fingers open. Between the first two corners both close so that
/// neither pad is turned sideways; one count further, thumb and index could cross.
const CORNERS: [[f32; 2]; 3] = [[412.0, 508.0], [660.0, 1000.0], [1000.0, 1000.0]];
/// Thumb rotation on the path: fully in front of the palm.
const ROTATED: Angle = Angle::MIN;
/// Bisection steps that locate a point of the path to less than a count.
const HALVINGS: u32 = 24;
/// Largest distance of a joint from the path, in counts, for a pinch; beyond it the pads are not in contact.
const ON_PATH_TOLERANCE: f32 = 80.0;

/// Gap below which the edges of the pads meet, mm.
const EDGES_MEET_MM: f32 = 8.0;
/// Contact of a ball at more than this distance from the pad's centre is on its edge, mm: real pads are some 15 mm wide.
const OFF_MIDDLE_MM: f32 = 5.0;
/// Direction of the thumb's pad in its last segment.
const THUMB_PAD: Vec3 = Vec3::new(28.99, 17.30, 0.0);

/// Gap and ball diameter according to the model, while the pads of thumb and index face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinchGap {
    /// Distance between the pad centres, mm.
    pub mm: f32,
    /// Diameter of the ball that touches both pads closest to their centres, mm. It is more than the gap, because the pads are tilted to
    /// each other: 67 degrees at 16 mm, 17 at 71 mm. `None` where it would touch their edges.
    pub ball_mm: Option<f32>,
}

/// A distance between the pads of thumb and index that lies on the path, in mm.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Gap(f32);

/// A gap outside the range of the path.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("a pinch opens from {} to {} mm, not {got} mm", Gap::MIN.mm(), Gap::MAX.mm())]
pub struct GapOutOfRange {
    /// Requested gap, mm.
    pub got: f32,
}

impl Gap {
    /// Pads in contact: their centres come no closer.
    pub const MIN: Self = Self(3.0);
    /// Beyond this gap the index turns its tip, not its pad, to the thumb.
    pub const MAX: Self = Self(120.0);

    /// Joints that pinch; the other fingers only stay out of the way.
    pub const JOINTS: [Dof; 3] = [Dof::Index, Dof::ThumbBend, Dof::ThumbRotate];

    /// Checks the range of a gap in mm.
    ///
    /// # Errors
    /// [`GapOutOfRange`].
    pub fn new(mm: f32) -> Result<Self, GapOutOfRange> {
        if (Self::MIN.0..=Self::MAX.0).contains(&mm) {
            Ok(Self(mm))
        } else {
            Err(GapOutOfRange { got: mm })
        }
    }

    /// Nearest gap on the path; the widest for NaN.
    pub fn nearest(mm: f32) -> Self {
        if mm.is_nan() {
            Self::MAX
        } else {
            Self(mm.clamp(Self::MIN.0, Self::MAX.0))
        }
    }

    /// Gap in mm.
    pub const fn mm(self) -> f32 {
        self.0
    }

    /// Angles of all six joints at this gap. Rounding to counts changes the gap by less than 0.2 mm.
    ///
    /// ```
    /// use handscope_core::hand::gap::{Gap, pad_distance};
    ///
    /// let angles = Gap::new(30.0)?.angles();
    /// let counts = angles.map(|angle| f32::from(angle.get()));
    /// assert!((pad_distance(&counts) - 30.0).abs() < 0.2);
    /// # Ok::<(), handscope_core::hand::gap::GapOutOfRange>(())
    /// ```
    pub fn angles(self) -> PerDof<Angle> {
        let [index, bend] = on_path(self.share());
        let mut angles = PerDof::splat(Angle::MAX);
        angles[Dof::Index] = rounded(index);
        angles[Dof::ThumbBend] = rounded(bend);
        angles[Dof::ThumbRotate] = ROTATED;
        angles
    }

    /// Legs of the path from this gap to another, in order.
    pub fn legs_to(self, to: Self) -> Vec<PinchLeg> {
        let corner = self.share().max(to.share()) > 1.0 && self.share().min(to.share()) < 1.0;
        let between = corner.then(|| Self(distance_at(1.0)));
        let mut legs = Vec::with_capacity(2);
        let mut from = self;
        for next in between.into_iter().chain([to]) {
            legs.push(from.straight_to(next));
            from = next;
        }
        legs
    }

    /// Straight leg to another gap; leaves the path if a corner lies between. For small steps.
    pub fn straight_to(self, to: Self) -> PinchLeg {
        let (start, to) = (self.angles(), to.angles());
        let ways = PerDof::from_fn(|dof| f32::from(start[dof].get().abs_diff(to[dof].get())));
        let longest = ways.as_array().iter().copied().fold(0.0, f32::max);
        let share = |way: f32| if way > 0.0 { way / longest } else { 1.0 };
        PinchLeg {
            to,
            shares: ways.map(share),
        }
    }

    /// Position along the path, in corners: 0 where the pads meet.
    fn share(self) -> f32 {
        let (mut near, mut far) = (0.0, 2.0);
        for _ in 0..HALVINGS {
            let middle = f32::midpoint(near, far);
            if distance_at(middle) < self.0 {
                near = middle;
            } else {
                far = middle;
            }
        }
        f32::midpoint(near, far)
    }
}

/// A gap is never NaN.
impl Eq for Gap {}

impl TryFrom<f32> for Gap {
    type Error = GapOutOfRange;
    fn try_from(mm: f32) -> Result<Self, GapOutOfRange> {
        Self::new(mm)
    }
}

impl From<Gap> for f32 {
    fn from(gap: Gap) -> Self {
        gap.0
    }
}

/// A straight leg of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinchLeg {
    /// Angles of all joints at its end.
    pub to: PerDof<Angle>,
    /// Travel of each joint relative to the joint that travels farthest, 0 to 1; 1 if no joint moves.
    shares: PerDof<f32>,
}

impl PinchLeg {
    /// Speeds at which all joints arrive together; the joint that travels farthest moves at `fastest`.
    pub fn speeds(&self, fastest: Speed) -> PerDof<Speed> {
        let least = fastest.min(Speed::nearest(1));
        self.shares
            .map(|share| nearest_speed(f32::from(fastest.get()) * share).max(least))
    }
}

/// Distance between the pad centres of thumb and index in mm, at any joint position in counts.
pub fn pad_distance(counts: &PerDof<f32>) -> f32 {
    let frames = SegmentFrames::of_shares(Side::Right, &counts.map(|count| count / 1000.0));
    frames
        .tip(Finger::Index)
        .distance(frames.tip(Finger::Thumb))
}

/// True if thumb and index can move from here to any gap without touching each other, whichever is faster.
pub fn is_open_for_pinch(counts: &PerDof<f32>) -> bool {
    let spare = f32::from(Angle::ARRIVED_TOLERANCE);
    let [[index, bend], ..] = CORNERS;
    counts[Dof::Index] >= index - spare
        && counts[Dof::ThumbBend] >= bend - spare
        && counts[Dof::ThumbRotate] <= f32::from(ROTATED.get()) + 2.0 * spare
}

/// Gap of a hand whose thumb and index are near the path, in mm; `None` where the pads do not face each other.
pub fn gap_on_path(counts: &PerDof<f32>) -> Option<f32> {
    let gap = pad_distance(counts);
    let meant = Gap::nearest(gap).angles();
    let is_near = |dof: Dof| (counts[dof] - f32::from(meant[dof].get())).abs() <= ON_PATH_TOLERANCE;
    Gap::JOINTS.into_iter().all(is_near).then_some(gap)
}

/// Pinch gap of a hand whose thumb and index are near the path; `None` where the pads do not face each other.
///
/// ```
/// use handscope_core::hand::gap::{Gap, pinch_gap};
///
/// let angles = Gap::new(24.5)?.angles();
/// let gap = pinch_gap(&angles.map(|angle| f32::from(angle.get()))).unwrap();
/// assert!((gap.mm - 24.5).abs() < 0.2);
/// assert!((gap.ball_mm.unwrap() - 28.0).abs() < 0.3);
/// # Ok::<(), handscope_core::hand::gap::GapOutOfRange>(())
/// ```
pub fn pinch_gap(counts: &PerDof<f32>) -> Option<PinchGap> {
    let mm = gap_on_path(counts)?;
    let ball_mm = ball(&pads(counts)).filter(|_| mm >= EDGES_MEET_MM);
    Some(PinchGap { mm, ball_mm })
}

/// Centre and normal of a pad.
type Pad = (Vec3, Vec3);

/// Pads of index and thumb.
fn pads(counts: &PerDof<f32>) -> [Pad; 2] {
    let frames = SegmentFrames::of_shares(Side::Right, &counts.map(|count| count / 1000.0));
    let out = Vec3::new(-THUMB_PAD.y, THUMB_PAD.x, 0.0).normalize();
    let index = frames.frame(Segment::Index2).matrix3 * Vec3::NEG_X;
    let thumb = frames.frame(Segment::Thumb4).matrix3 * out;
    [
        (frames.tip(Finger::Index), index),
        (frames.tip(Finger::Thumb), thumb),
    ]
}

/// Diameter of the ball that touches both pads closest to their centres; `None` if it would touch their edges.
fn ball([(one, one_looks), (two, two_looks)]: &[Pad; 2]) -> Option<f32> {
    let (apart, facing) = (two - one, one_looks - two_looks);
    let radius = apart.dot(facing) / facing.length_squared();
    let off_middle = (apart - facing * radius).length() / 2.0;
    (off_middle <= OFF_MIDDLE_MM).then_some(2.0 * radius)
}

/// Gap while thumb and index, and no other finger, hold an object; `None` otherwise, or where an angle is not known.
pub fn held_gap(grip: &Grip, angles: &PerDof<AngleReading>) -> Option<PinchGap> {
    let is_pinch = grip.fingers.iter().all(|(finger, estimate)| {
        estimate.state.is_held() == matches!(finger, Finger::Thumb | Finger::Index)
    });
    let counts = angles.map(|angle| angle.documented().map(f32::from));
    pinch_gap(&counts.all()?).filter(|_| is_pinch)
}

/// Index and thumb bend at this position along the path, in counts.
fn on_path(share: f32) -> [f32; 2] {
    let [met, open_thumb, open] = CORNERS;
    let (from, to, part) = if share < 1.0 {
        (met, open_thumb, share)
    } else {
        (open_thumb, open, share - 1.0)
    };
    let between = |(from, to): (f32, f32)| from + (to - from) * part;
    let ([index, bend], [to_index, to_bend]) = (from, to);
    [between((index, to_index)), between((bend, to_bend))]
}

fn distance_at(share: f32) -> f32 {
    let [index, bend] = on_path(share);
    let mut counts = PerDof::splat(1000.0);
    (counts[Dof::Index], counts[Dof::ThumbBend]) = (index, bend);
    counts[Dof::ThumbRotate] = f32::from(ROTATED.get());
    pad_distance(&counts)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "counts of the path, which lie within 0 to 1000"
)]
fn rounded(count: f32) -> Angle {
    Angle::nearest(count.round() as i16)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a share of a speed, which lies within 0 to 1000"
)]
fn nearest_speed(speed: f32) -> Speed {
    Speed::nearest(speed.round() as i16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::grip::GripState;
    use crate::hand::kinematics::RANGE;
    use glam::Mat3;

    /// 100 poses of the model, reckoned apart from this code.
    const POSES: &str = include_str!("../../../tests/geometry/forward-kinematics.csv");
    /// The axis about which the thumb is turned, mm.
    const THUMB_AXIS: Vec3 = Vec3::new(-26.9, 21.01, 0.0);

    /// The pads of index and thumb as functions of one angle each: from the file alone, by a cubic through its four nearest poses.
    struct FilePads {
        index: Vec<(f32, Vec3)>,
        /// The thumb not turned.
        thumb: Vec<(f32, Vec3)>,
    }

    impl FilePads {
        fn read() -> Self {
            let mut pads = Self {
                index: Vec::new(),
                thumb: Vec::new(),
            };
            let mut lines = POSES.lines();
            let names: Vec<&str> = lines.next().unwrap().split(',').collect();
            for line in lines {
                let cells: Vec<f32> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
                let cell = |name: &str| cells[names.iter().position(|own| *own == name).unwrap()];
                let place = |of: &str| {
                    Vec3::from(["x", "y", "z"].map(|axis| cell(&format!("{of}_{axis}_mm"))))
                };
                pads.index
                    .push((cell("index_1_rad"), place("index_force_sensor_3")));
                let turned = place("thumb_force_sensor_4") - THUMB_AXIS;
                let back = Mat3::from_rotation_z(cell("thumb_1_rad")) * turned;
                pads.thumb.push((cell("thumb_2_rad"), back + THUMB_AXIS));
            }
            for known in [&mut pads.index, &mut pads.thumb] {
                known.sort_by(|a, b| a.0.total_cmp(&b.0));
                known.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-3);
            }
            pads
        }

        fn distance(&self, counts: &PerDof<f32>) -> f32 {
            let radians = |dof: Dof| (1.0 - counts[dof] / 1000.0) * RANGE[dof];
            let index = through(&self.index, radians(Dof::Index));
            let straight = through(&self.thumb, radians(Dof::ThumbBend)) - THUMB_AXIS;
            let turn = Mat3::from_rotation_z(-radians(Dof::ThumbRotate));
            index.distance(turn * straight + THUMB_AXIS)
        }
    }

    /// The cubic through the four known points around an angle.
    fn through(known: &[(f32, Vec3)], at: f32) -> Vec3 {
        let above = known.partition_point(|(angle, _)| *angle < at);
        let first = above.saturating_sub(2).min(known.len() - 4);
        let near = &known[first..first + 4];
        let weight = |nth: usize| {
            let others = (0..4).filter(|other| *other != nth);
            let factors = others.map(|other| (at - near[other].0) / (near[nth].0 - near[other].0));
            factors.product::<f32>()
        };
        (0..4).map(|nth| near[nth].1 * weight(nth)).sum()
    }

    fn counts(gap: Gap) -> PerDof<f32> {
        gap.angles().map(|angle| f32::from(angle.get()))
    }

    fn all_gaps() -> impl Iterator<Item = Gap> {
        (30..=1200).map(|tenths: u16| Gap::new(f32::from(tenths) / 10.0).unwrap())
    }

    #[test]
    fn every_gap_is_that_of_the_independent_kinematics() {
        let file = FilePads::read();
        for gap in all_gaps() {
            let off = (file.distance(&counts(gap)) - gap.mm()).abs();
            assert!(off < 0.5, "{gap:?}: off by {off}");
        }
    }

    #[test]
    fn pads_are_as_far_apart_as_in_the_file_at_each_of_its_poses() {
        for line in POSES.lines().skip(1) {
            let cells: Vec<f32> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let radians = PerDof::new(<[f32; 6]>::try_from(&cells[..6]).unwrap());
            let counts = PerDof::from_fn(|dof| (1.0 - radians[dof] / RANGE[dof]) * 1000.0);
            let [index, thumb] = [36, 39].map(|at| Vec3::from_slice(&cells[at..at + 3]));
            assert!((pad_distance(&counts) - index.distance(thumb)).abs() < 0.1);
        }
    }

    #[test]
    fn what_is_gripped_is_read_back_from_the_angles_and_an_open_or_clenched_hand_has_no_gap() {
        for gap in all_gaps() {
            let read = gap_on_path(&counts(gap));
            // The last counts may round beyond an end.
            let Some(read) = read else {
                assert!(gap.mm() < 3.2 || gap.mm() > 119.8, "{gap:?}");
                continue;
            };
            assert!((read - gap.mm()).abs() < 0.2, "{gap:?}: {read}");
        }
        for elsewhere in [1000.0, 500.0, 0.0] {
            assert_eq!(gap_on_path(&PerDof::splat(elsewhere)), None);
        }
        let mut aside = counts(Gap::nearest(30.0));
        aside[Dof::ThumbRotate] = 200.0;
        assert_eq!(gap_on_path(&aside), None, "the thumb is beside the index");
    }

    #[test]
    fn only_what_thumb_and_index_alone_hold_has_a_size() {
        let angles = Gap::nearest(30.0)
            .angles()
            .map(|angle| AngleReading::new(angle.get()));
        let held = |fingers: &[Finger]| {
            let mut grip = Grip::default();
            for finger in fingers {
                grip.fingers[*finger].state = GripState::Holding;
            }
            held_gap(&grip, &angles)
        };
        let got = held(&[Finger::Index, Finger::Thumb]).unwrap();
        assert!((got.mm - 30.0).abs() < 0.2, "{got:?}");
        assert_eq!(held(&[Finger::Index]), None);
        assert_eq!(held(&[Finger::Index, Finger::Thumb, Finger::Middle]), None);
        assert_eq!(held(&[]), None);
    }

    #[test]
    fn closing_only_closes_and_ends_where_the_pads_meet() {
        let mut before = counts(Gap::MAX);
        for gap in all_gaps().collect::<Vec<_>>().into_iter().rev() {
            let now = counts(gap);
            for dof in Dof::ALL {
                assert!(now[dof] <= before[dof], "{gap:?} {dof:?}");
            }
            before = now;
        }
        let closed = counts(Gap::MIN);
        assert_eq!((closed[Dof::Index], closed[Dof::ThumbBend]), (412.0, 508.0));
    }

    /// Degrees between the line from pad to pad and where each pad looks: the index along its x, the thumb towards the palm.
    fn pad_angles(counts: &PerDof<f32>) -> [f32; 2] {
        let [(index, index_looks), (thumb, thumb_looks)] = pads(counts);
        let line = thumb - index;
        [
            index_looks.angle_between(line),
            thumb_looks.angle_between(-line),
        ]
        .map(f32::to_degrees)
    }

    #[test]
    fn a_ball_between_the_pads_is_as_large_as_an_independent_reckoning_has_it() {
        // Gap and ball, mm, by others' kinematics of the same public model.
        for (gap, ball) in [
            (8.2, 9.6),
            (16.1, 19.0),
            (24.5, 28.0),
            (33.3, 36.7),
            (42.4, 45.3),
        ] {
            let got = pinch_gap(&counts(Gap::nearest(gap))).unwrap();
            let off = got.ball_mm.unwrap() - ball;
            assert!(off.abs() < 0.3, "{got:?} {ball}");
        }
        for edges in [3.0, 5.0, 7.9, 120.0] {
            let got = pinch_gap(&counts(Gap::nearest(edges)));
            assert_eq!(got.and_then(|got| got.ball_mm), None, "{edges} mm");
        }
    }

    #[test]
    fn the_ball_touches_both_pads_near_their_middles() {
        for gap in all_gaps() {
            let pads = pads(&counts(gap));
            let Some(got) = pinch_gap(&counts(gap)).and_then(|got| got.ball_mm) else {
                continue;
            };
            let radius = got / 2.0;
            let middle = pads.iter().map(|(at, looks)| at + looks * radius);
            let middle = middle.sum::<Vec3>() / 2.0;
            for (at, looks) in pads {
                let depth = (middle - at).dot(looks);
                let aside = (middle - at - looks * depth).length();
                assert!(
                    (depth - radius).abs() < 1.0 && aside < 6.0,
                    "{gap:?}: {depth} {aside}"
                );
            }
        }
    }

    #[test]
    fn pads_face_each_other_on_the_whole_path() {
        for gap in all_gaps() {
            // Nearer than this the pads touch at their sides, where the 3 mm between their middles lie.
            let most = if gap.mm() < 8.0 { 100.0 } else { 46.0 };
            for away in pad_angles(&counts(gap)) {
                assert!(away < most, "{gap:?}: {away:.0} degrees");
            }
        }
    }

    #[test]
    fn on_each_part_of_the_path_both_joints_arrive_together() {
        let legs = Gap::MAX.legs_to(Gap::MIN);
        assert_eq!(legs.len(), 2);
        let speeds = legs.iter().map(|leg| leg.speeds(Speed::GENTLE));
        let speeds: Vec<_> = speeds.map(|all| all.map(Speed::get)).collect();
        assert_eq!(speeds[0][Dof::Index], 200);
        assert_eq!(speeds[1][Dof::ThumbBend], 200);
        assert_eq!(
            speeds[1][Dof::Index],
            101,
            "248 counts while the thumb goes 492"
        );
        assert_eq!(legs[1].to, Gap::MIN.angles());
        assert_eq!(Gap::nearest(60.0).legs_to(Gap::nearest(20.0)).len(), 1);
        assert_eq!(Gap::nearest(20.0).legs_to(Gap::MAX).len(), 2, "and back");
        let slow = legs[1].speeds(Speed::nearest(1)).map(Speed::get);
        assert_eq!(slow[Dof::Index], 1, "none stands still");
    }

    #[test]
    fn what_the_path_does_not_have_is_refused_in_one_sentence() {
        for wrong in [2.9, 120.1, -30.0, f32::NAN, f32::INFINITY] {
            let words = Gap::new(wrong).unwrap_err().to_string();
            assert!(
                words.starts_with("a pinch opens from 3 to 120 mm"),
                "{words}"
            );
        }
    }
}
