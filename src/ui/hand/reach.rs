//! Where the hand gets to in all poses: a picture that holds these places never jumps while the hand moves.

use crate::hand::kinematics::{Segment, SegmentFrames, Side, tip_pad};
use crate::hand::{Dof, Finger, PerDof};
use crate::ui::hand::shape;
use glam::Vec3;
use std::sync::LazyLock;

/// Steps from bent to open in which poses are tried, and room around the ends of the fingers.
const STEPS: u8 = 4;
const ROUND_MM: f32 = 10.0;

/// Where a right hand gets to in all poses: a picture that holds these never jumps while the hand moves.
pub(crate) static REACH: LazyLock<Vec<Vec3>> = LazyLock::new(|| {
    let palm = [
        [30.0, -24.0, -13.0],
        [30.0, 20.0, -13.0],
        [45.0, -21.0, 50.0],
        [45.0, -18.0, 110.0],
        [45.0, 14.0, 140.0],
        [36.0, 36.0, 54.0],
    ];
    let both = palm
        .iter()
        .flat_map(|[x, y, z]| [[*x, *y, *z], [-x, *y, *z]]);
    let mut reach: Vec<Vec3> = both.map(Vec3::from).collect();
    let shares = || (0..=STEPS).map(|step| f32::from(step) / f32::from(STEPS));
    for (bend, swing) in shares().flat_map(|bend| shares().map(move |swing| (bend, swing))) {
        let pose = PerDof::from_fn(|dof| if dof == Dof::ThumbRotate { swing } else { bend });
        let pose = SegmentFrames::of_shares(Side::Right, &pose);
        for finger in Finger::ALL {
            let [out, up] = shape::pad_ways(finger);
            let (pad, frame) = (tip_pad(finger) + up * 3.0, pose.frame(Segment::tip(finger)));
            let back = pad - out * 2.0 * ROUND_MM;
            let (middle, aside) = (pad - (out + up) * ROUND_MM, out.cross(up) * ROUND_MM);
            let places = [pad, back, -out * ROUND_MM, middle - aside, middle + aside];
            reach.extend(places.map(|at| frame.transform_point3(at)));
        }
        let joint = pose.frame(Segment::Thumb3);
        reach.extend([Vec3::Z, Vec3::NEG_Y].map(|way| joint.transform_point3(way * ROUND_MM)));
    }
    reach
});
