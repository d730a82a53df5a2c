//! Newtons of one hand's joints, in a file per hand: written by the calibration with a kitchen scale, and read wherever forces are
//! shown.

use crate::checkup::hand_file;
use crate::hand::newtons::{JointPoints, NewtonsMap, ScalePoint};
use crate::hand::{Dof, Force};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};

/// The file of the hand at an endpoint, beside the settings; `None` for the built-in hand, which differs on each start.
pub fn file_of(settings: &Path, hand: &Endpoint) -> Option<PathBuf> {
    hand_file::file_of(settings, "newtons", hand)
}

/// Reads the stored points; the default if there is no file.
///
/// # Errors
/// An I/O error, or the file does not parse.
pub fn read(file: &Path) -> io::Result<NewtonsMap> {
    hand_file::read(file)
}

/// Replaces the stored points.
///
/// # Errors
/// The I/O error.
pub fn keep(file: &Path, newtons: &NewtonsMap) -> io::Result<()> {
    hand_file::keep(file, newtons)
}

/// Replaces the points of one joint; without points, removes it.
///
/// # Errors
/// As [`read`] and [`keep`].
pub fn put(file: &Path, dof: Dof, joint: JointPoints) -> io::Result<()> {
    if joint.points.is_empty() {
        return remove(file, dof);
    }
    let mut known = read(file)?;
    known.put(dof, joint);
    keep(file, &known)
}

/// Removes one joint.
///
/// # Errors
/// As [`read`] and [`keep`].
pub fn remove(file: &Path, dof: Dof) -> io::Result<()> {
    let mut known = read(file)?;
    known.forget(dof);
    keep(file, &known)
}

/// Deletes the file; a missing one is no error.
///
/// # Errors
/// The I/O error.
pub fn forget(file: &Path) -> io::Result<()> {
    match std::fs::remove_file(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        ended => ended,
    }
}

/// All points as a CSV table. Newtons are empty for a joint that is not complete.
pub fn csv(newtons: &NewtonsMap) -> String {
    let head = "joint,day,limit_g,load,hand_g,scale_g,fingertip_n,newtons_per_g,bound\n";
    let line = |dof: Dof, joint: &JointPoints, own: &ScalePoint| {
        let scale = joint.scale().ok();
        let per_g = scale.map(|scale| format!("{:.6},{:.4}", scale.newtons_per_g, scale.bound));
        let tip = own.tip_n.map(|newtons| format!("{newtons:.3}"));
        let (load, limit): (usize, Force) = (own.load + 1, joint.limit);
        format!(
            "{},{},{},{load},{:.1},{},{},{}\n",
            dof.name(),
            joint.day,
            limit.get(),
            own.hand_g,
            own.scale_g,
            tip.unwrap_or_default(),
            per_g.unwrap_or_else(|| ",".into())
        )
    };
    let mut text = head.to_owned();
    for (dof, joint) in newtons.joints() {
        let lines = joint.points.iter().map(|own| line(dof, joint, own));
        text.extend(lines);
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::newtons::N_PER_G;

    fn joint(loads: usize) -> JointPoints {
        let point = |load: usize| {
            let hand_g = [150.0, 210.0, 270.0, 330.0, 390.0][load];
            ScalePoint {
                load,
                hand_g,
                scale_g: hand_g * 0.7,
                tip_n: (load > 0).then_some(1.0),
            }
        };
        JointPoints {
            limit: Force::nearest(400),
            day: "2026-11-30".into(),
            points: (0..loads).map(point).collect(),
        }
    }

    #[test]
    fn each_joint_is_stored_exported_and_forgotten_by_itself() {
        let folder = tempfile::tempdir().unwrap();
        let settings = folder.path().join("settings.toml");
        let of = |hand: &str| file_of(&settings, &hand.parse().unwrap());
        assert_eq!(of("sim:"), None);
        let file = of("rtu:/dev/x?id=1").unwrap();
        assert_ne!(of("rtu:/dev/x?id=2").unwrap(), file);
        assert!(read(&file).unwrap().is_empty());
        put(&file, Dof::Index, joint(5)).unwrap();
        put(&file, Dof::Ring, joint(1)).unwrap();
        let known = read(&file).unwrap();
        assert_eq!(known.points(Dof::Index), Some(&joint(5)));
        let per_g = known.per_g();
        assert!((per_g[Dof::Index].unwrap() - 0.7 * N_PER_G).abs() < 1e-9);
        assert_eq!(per_g[Dof::Ring], None, "it is not complete");
        let table = csv(&known);
        assert_eq!(table.lines().count(), 7, "{table}");
        assert!(table.contains("\nring,2026-11-30,400,1,150.0,105,,,\n"));
        assert!(table.contains("\nindex,2026-11-30,400,2,210.0,147,1.000,0.006865,"));
        put(&file, Dof::Ring, joint(0)).unwrap();
        assert_eq!(read(&file).unwrap().joints().count(), 1);
        forget(&file).unwrap();
        forget(&file).unwrap();
        assert!(read(&file).unwrap().is_empty());
        std::fs::write(&file, r#"{"joints":{"palm":{}}}"#).unwrap();
        read(&file).unwrap_err();
    }
}
