//! The path between two poses on which thumb and index do not meet, and the path to a grip by size, at whose end they do.
//! Computed from angles only; the tests prove it with the geometry of the drawn hand, which feeds no motion.

use crate::hand::gap::{Gap, gap_on_path};
use crate::hand::{Angle, Dof, PerDof, Speed};

/// Angles of some joints; `None` leaves a joint where it is.
pub type Targets = PerDof<Option<Angle>>;

/// At this angle and above, the index is out of the thumb's reach.
const INDEX_CLEAR: i16 = 550;
/// At this bend the thumb is out of the index's reach at any rotation.
const BEND_CLEAR: i16 = 800;
/// The same at other bends: twice the bend plus the rotation.
const THUMB_CLEAR: i16 = 2 * BEND_CLEAR;

/// The targets to reach in turn on the way to `to`; the last is `to`, or the remaining part of it.
///
/// Where one of thumb and index closes while the other opens, the thumb first moves out of the way, and bends last. A joint of
/// unknown angle counts as bent, and one that has arrived counts as at its target.
pub fn way(from: &PerDof<Option<i16>>, to: &Targets) -> Vec<Targets> {
    let ends = |dof: Dof| {
        let from = from[dof].unwrap_or(0);
        let to = to[dof].map_or(from, Angle::get);
        if from.abs_diff(to) <= Angle::ARRIVED_TOLERANCE {
            (to, to)
        } else {
            (from, to)
        }
    };
    let [index, bend, rotate] = [Dof::Index, Dof::ThumbBend, Dof::ThumbRotate].map(ends);
    let nearest = [index, bend, rotate].map(|(from, to)| from.min(to));
    let is_end = nearest == [index.0, bend.0, rotate.0] || nearest == [index.1, bend.1, rotate.1];
    let [least_index, least_bend, least_rotate] = nearest;
    let is_clear = least_index >= INDEX_CLEAR || 2 * least_bend + least_rotate >= THUMB_CLEAR;
    let Some(bent) = to[Dof::ThumbBend].filter(|_| !is_end && !is_clear) else {
        return vec![*to];
    };
    let mut ways = Vec::with_capacity(3);
    let thumb = |angle: Angle| {
        let mut only: Targets = PerDof::splat(None);
        only[Dof::ThumbBend] = Some(angle);
        only
    };
    let out = Angle::nearest(BEND_CLEAR.max(bent.get()));
    if bend.0 < out.get() {
        ways.push(thumb(out));
    }
    let mut others = *to;
    others[Dof::ThumbBend] = None;
    ways.push(others);
    if bent != out || bend.0 > out.get() {
        ways.push(thumb(bent));
    }
    ways
}

/// A straight part of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayPart {
    /// Targets of the joints.
    pub targets: Targets,
    pub speeds: PerDof<Speed>,
    /// True while the pads of thumb and index face each other: an object that stops them may be held.
    pub is_pinching: bool,
}

/// The path to a gap: open first, unless the hand is already on the path, then along the path on which the pads meet. Other joints
/// move only if set in `moves`.
pub fn pinch_way(
    from: &PerDof<Option<i16>>,
    to: Gap,
    fastest: Speed,
    moves: &PerDof<bool>,
) -> Vec<WayPart> {
    let part = |angles: Targets| PerDof::from_fn(|dof| angles[dof].filter(|_| moves[dof]));
    // Joints that do not pinch are ignored.
    let counts = PerDof::from_fn(|dof| match Gap::JOINTS.contains(&dof) {
        true => from[dof].map(f32::from),
        false => Some(f32::from(Angle::MAX.get())),
    });
    let on_path = counts.all().and_then(|counts| gap_on_path(&counts));
    let mut parts = Vec::with_capacity(5);
    if on_path.is_none() {
        let opened = way(from, &part(Gap::MAX.angles().map(Some)));
        parts.extend(opened.into_iter().map(|targets| WayPart {
            targets,
            speeds: PerDof::splat(fastest),
            is_pinching: false,
        }));
    }
    let begins = on_path.map_or(Gap::MAX, Gap::nearest);
    parts.extend(begins.legs_to(to).into_iter().map(|leg| WayPart {
        targets: part(leg.to.map(Some)),
        speeds: leg.speeds(fastest),
        is_pinching: true,
    }));
    parts
}
