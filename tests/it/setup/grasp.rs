//! A grasp that another hand made, in the library of a user who measured the newtons of the hand that repeats it.

use handscope::checkup::newtons_file;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::newtons::{JointPoints, N_PER_G, NewtonsMap, ScalePoint};
use handscope::hand::{Angle, Finger, Force, PerDof, PerFinger};
use handscope::motion::grasp::file;
use handscope::motion::grasp::saved::{FrictionSeen, Grasp, GraspClose, GraspFinger, GraspResult};
use handscope::motion::hold::HoldClose;
use handscope::transport::Endpoint;
use std::path::Path;

/// Stores the newtons of this hand, and the grasp `name` of another one that closes all fingers, beside these settings.
pub(crate) fn store(settings: &Path, hand: &str, name: &str) {
    let hand: Endpoint = hand.parse().unwrap();
    let newtons = newtons_file::file_of(settings, &hand).unwrap();
    newtons_file::keep(&newtons, &measured()).unwrap();
    let grasp = Grasp {
        name: name.into(),
        ..of_another()
    };
    file::save(&file::library_file(settings, name), &grasp).unwrap();
}

const BENT: Option<Angle> = Some(Angle::MIN);

/// A hand that reads true grams.
fn measured() -> NewtonsMap {
    let point = |(load, hand_g): (usize, f64)| ScalePoint {
        load,
        hand_g,
        scale_g: hand_g,
        tip_n: None,
    };
    let loads = [150.0, 210.0, 270.0, 330.0, 390.0];
    let mut known = NewtonsMap::default();
    for finger in Finger::ALL {
        let joint = JointPoints {
            limit: Force::nearest(400),
            day: "2026-11-30".into(),
            points: loads.into_iter().enumerate().map(point).collect(),
        };
        known.put(finger.bend(), joint);
    }
    known
}

fn of_another() -> Grasp {
    Grasp {
        name: String::new(),
        note: String::new(),
        made: "2026-11-30".into(),
        hand: "can:can7".parse().unwrap(),
        close: GraspClose {
            pose: None,
            way: HoldClose::To(PerDof::new([BENT, BENT, BENT, BENT, BENT, None])),
        },
        forces: HoldForces::new(Force::nearest(150), Force::nearest(400)).unwrap(),
        fingers: PerFinger::splat(Some(GraspFinger {
            angle: Angle::nearest(900),
            force_g: 160.0,
            reading_per_g: 1.0,
            newtons_per_g: Some(N_PER_G),
            stiffness_g: Some(10.0),
        })),
        friction: FrictionSeen::default(),
        load_n: Some(1.0),
        claim: None,
        result: GraspResult {
            held_s: 10.0,
            tightened: 0,
        },
    }
}
