//! Kinds of grip, and which of them can be commanded by gap.

use serde::{Deserialize, Serialize};

/// A kind of grip. This hand can do only one of them by size; [`GripKind::offered`] gives the reason for each other.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    strum::VariantNames,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum GripKind {
    /// Between the pads of thumb and index.
    Pinch,
    /// Thumb against index and middle finger.
    ThreeFingers,
    /// Thumb against all four fingers.
    AllFingers,
    /// Fingers and thumb around something in the palm.
    Around,
}

/// Reason why a grip is not available by size: in this hand no two pads face each other in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotOffered {
    /// The middle finger's pad stays beside the thumb's.
    #[error(
        "a grip of three fingers has no gap: the thumb faces the index only, and stays 25 mm beside the middle finger's pad"
    )]
    BesideMiddle,
    /// The pads of ring and little finger stay beside the thumb's.
    #[error(
        "a grip of all fingers has no gap: the thumb faces the index only, and stays 46 mm beside the ring finger's pad and 66 mm beside the little finger's"
    )]
    BesideOthers,
    /// The fingers close on the palm.
    #[error(
        "a grip around something has no gap: the fingers close on the palm, and how far they get depends on where the object lies"
    )]
    OnPalm,
}

impl GripKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [
        Self::Pinch,
        Self::ThreeFingers,
        Self::AllFingers,
        Self::Around,
    ];

    /// Name on the command line and in files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Checks that the grip is available by size.
    ///
    /// # Errors
    /// [`NotOffered`], the reason.
    pub const fn offered(self) -> Result<(), NotOffered> {
        match self {
            Self::Pinch => Ok(()),
            Self::ThreeFingers => Err(NotOffered::BesideMiddle),
            Self::AllFingers => Err(NotOffered::BesideOthers),
            Self::Around => Err(NotOffered::OnPalm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::{Dof, Finger, PerDof};
    use crate::hand::kinematics::{SegmentFrames, Side};

    /// Millimetres between the pads of the thumb and a finger at these angles.
    fn apart(finger: Finger, [bent, bend, rotate]: [f32; 3]) -> f32 {
        let mut shares = PerDof::splat(1.0);
        shares[finger.bend()] = bent / 1000.0;
        shares[Dof::ThumbBend] = bend / 1000.0;
        shares[Dof::ThumbRotate] = rotate / 1000.0;
        let frames = SegmentFrames::of_shares(Side::Right, &shares);
        frames.tip(finger).distance(frames.tip(Finger::Thumb))
    }

    /// The least that they come to: steps to the nearest neighbour, ever smaller.
    fn least(finger: Finger) -> f32 {
        let mut at: [f32; 3] = [500.0, 500.0, 200.0];
        let mut step = 128.0;
        while step > 0.1 {
            let moves = (0..3).flat_map(|joint| [-step, step].map(|by| (joint, by)));
            let moved = moves.map(|(joint, by)| {
                let mut to = at;
                to[joint] = (to[joint] + by).clamp(0.0, 1000.0);
                to
            });
            let nearer = moved.min_by(|a, b| apart(finger, *a).total_cmp(&apart(finger, *b)));
            match nearer.filter(|to| apart(finger, *to) < apart(finger, at) - 1e-4) {
                Some(to) => at = to,
                None => step /= 2.0,
            }
        }
        apart(finger, at)
    }

    #[test]
    fn only_the_index_meets_the_thumb_and_the_others_stay_as_far_as_is_said() {
        assert!(least(Finger::Index) < 3.1);
        for (finger, text, kind) in [
            (Finger::Middle, "25 mm", GripKind::ThreeFingers),
            (Finger::Ring, "46 mm", GripKind::AllFingers),
            (Finger::Little, "66 mm", GripKind::AllFingers),
        ] {
            let words = kind.offered().unwrap_err().to_string();
            assert_eq!(format!("{:.0} mm", least(finger)), text);
            assert!(words.contains(text), "{words}");
        }
        assert_eq!(GripKind::Pinch.offered(), Ok(()));
        GripKind::Around.offered().unwrap_err();
    }

    #[test]
    fn each_has_one_name_in_files_and_on_the_command_line() {
        for kind in GripKind::ALL {
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
        }
    }
}
