//! Rigid shapes as triangles: lofts through rings and patches on them, welded, with smooth normals. Built once, never per frame.

use glam::{Affine3, Vec3};
use std::collections::HashMap;
use std::f32::consts::TAU;

/// Material of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Skin {
    Metal,
    /// The plate in the palm.
    Plate,
    /// Dark metal of hinges.
    Hinge,
    /// Dark rubber.
    Rubber,
    /// A fingertip's sensor.
    Pad,
    /// The colour of its coat: an object, an arrow.
    Plain,
}

/// One ring of a loft: position along the path, offset to the front, half widths to the front, to the back and to each side, and
/// exponent of the superellipse (2 = an ellipse).
pub(crate) type LoftRing = [f32; 6];

#[derive(Debug, Clone, Copy)]
pub struct Corner {
    pub at: Vec3,
    pub(crate) normal: Vec3,
    pub(crate) skin: Skin,
}

#[derive(Debug, Clone, Copy)]
pub struct Face {
    pub(crate) corners: [u16; 3],
    /// The adjacent faces of the same skin; [`NONE`] where there is none.
    pub(crate) beyond: [u16; 3],
    /// Visible from an eye position whose dot product with this exceeds `offset`.
    pub normal: Vec3,
    pub offset: f32,
    /// See [`Shard`].
    pub(crate) lift: f32,
    pub(crate) aside: Vec3,
}

/// A finished shape in the frame of its segment, with its bounding sphere.
#[derive(Debug)]
pub struct Solid {
    pub corners: Vec<Corner>,
    pub faces: Vec<Face>,
    pub middle: Vec3,
    pub(crate) radius: f32,
}

pub(crate) const NONE: u16 = u16::MAX;
/// Surfaces whose normals have a smaller cosine form an edge.
const EDGE_COS: f32 = 0.35;

/// A triangle under construction, counter-clockwise as seen from outside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shard {
    pub(crate) at: [Vec3; 3],
    pub(crate) skin: Skin,
    /// Depth bias towards the eye: patches on a surface are drawn over it.
    pub(crate) lift: f32,
    /// Lateral depth bias: of two plates, the nearer is drawn over the parts between them, the farther under them.
    pub(crate) aside: Vec3,
}

/// Triangles under construction. A small soup, for small pictures, has a third of them.
#[derive(Debug)]
pub(crate) struct Soup {
    shards: Vec<Shard>,
    pub(crate) is_small: bool,
}

impl Soup {
    pub(crate) const fn new(is_small: bool) -> Self {
        Self {
            shards: Vec::new(),
            is_small,
        }
    }

    /// Adds a closed tube through rings. `base` has x to the side, y along, z to the front. Each list of rings has its own skin
    /// and continues where the previous one ended.
    pub(crate) fn loft(
        &mut self,
        base: &Affine3,
        around: u8,
        bands: &[(Skin, &[LoftRing])],
    ) -> &mut [Shard] {
        let (around, each) = if self.is_small {
            (around - around / 3, 2)
        } else {
            (around, 1)
        };
        // Both ends of a band stay, regardless of the rings omitted between them.
        let left = |(skin, rings): &(Skin, &[LoftRing])| -> Vec<(Skin, LoftRing)> {
            let kept = rings.iter().enumerate();
            let kept = kept.filter(|(at, _)| at % each == 0 || at + 1 == rings.len());
            kept.map(|(_, ring)| (*skin, *ring)).collect()
        };
        let rings: Vec<(Skin, LoftRing)> = bands.iter().flat_map(left).collect();
        let row = |(skin, ring): &(Skin, LoftRing)| {
            let turn = |step: u8| (f32::from(step) + 0.5) / f32::from(around);
            let places = (0..=around).map(|step| base.transform_point3(point(ring, turn(step))));
            (*skin, places.collect::<Vec<_>>())
        };
        let end = |ring: Option<&(Skin, LoftRing)>| {
            ring.map(|(skin, [along, rise, ..])| {
                let middle = base.transform_point3(Vec3::new(0.0, *along, *rise));
                (*skin, vec![middle; usize::from(around) + 1])
            })
        };
        let rows = end(rings.first()).into_iter().chain(rings.iter().map(row));
        self.grid(rows.chain(end(rings.last())))
    }

    /// Adds a sheet: `place` returns a point for each pair of shares from -1 to 1, along and across in the directions of a loft.
    pub(crate) fn sheet(
        &mut self,
        steps: u8,
        skin: Skin,
        place: impl Fn(f32, f32) -> Vec3,
    ) -> &mut [Shard] {
        let steps = if self.is_small { steps / 2 } else { steps };
        let share = |step: u8| f32::from(step) / f32::from(steps) * 2.0 - 1.0;
        let row = |along: u8| {
            (0..=steps)
                .map(|across| place(share(along), share(across)))
                .collect()
        };
        self.grid((0..=steps).map(|along| (skin, row(along))))
    }

    /// Adds the triangles between rows of points; a strip has the skin of its second row.
    fn grid(&mut self, rows: impl Iterator<Item = (Skin, Vec<Vec3>)>) -> &mut [Shard] {
        let (first, mut before) = (self.shards.len(), Vec::new());
        for (skin, row) in rows {
            for (one, two) in before.windows(2).zip(row.windows(2)) {
                if let (&[a, b], &[c, d]) = (one, two) {
                    let shard = |at| Shard {
                        at,
                        skin,
                        lift: 0.0,
                        aside: Vec3::ZERO,
                    };
                    self.shards.extend([shard([a, d, b]), shard([a, c, d])]);
                }
            }
            before = row;
        }
        self.shards.get_mut(first..).unwrap_or_default()
    }

    /// Welds the triangles, smooths their normals and finds neighbours. Triangles without area are dropped.
    pub(crate) fn solid(self) -> Solid {
        let shards = self.shards.iter();
        let shards: Vec<_> = shards
            .filter(|shard| shard.area().length() > 1e-3)
            .collect();
        let mut places: HashMap<PlaceKey, Vec<(Vec3, Vec3)>> = HashMap::new();
        let mut edges = HashMap::new();
        for (shard, number) in shards.iter().zip(0u16..) {
            for (from, to) in shard.sides() {
                let area = shard.area();
                let near = places.entry(from).or_default();
                near.push((area, area.normalize_or_zero()));
                edges.insert((from, to, shard.skin), number);
            }
        }
        let (mut corners, mut known) = (Vec::new(), HashMap::new());
        let faces = shards.iter().map(|shard| {
            let own = shard.area().normalize_or_zero();
            let numbers = shard.at.map(|at| {
                let near = places.get(&key(at)).into_iter().flatten();
                let smooth = near.filter(|(_, other)| other.dot(own) > EDGE_COS);
                let normal: Vec3 = smooth.map(|(area, _)| *area).sum();
                let normal = normal.normalize_or_zero();
                *known
                    .entry((key(at), key(normal), shard.skin))
                    .or_insert_with(|| {
                        corners.push(Corner {
                            at,
                            normal,
                            skin: shard.skin,
                        });
                        u16::try_from(corners.len() - 1).unwrap_or(NONE)
                    })
            });
            let beyond = shard
                .sides()
                .map(|(from, to)| edges.get(&(to, from, shard.skin)).copied());
            let [a, ..] = shard.at;
            Face {
                corners: numbers,
                beyond: beyond.map(|face| face.unwrap_or(NONE)),
                normal: own,
                offset: own.dot(a),
                lift: shard.lift,
                aside: shard.aside,
            }
        });
        let faces = faces.collect();
        let (low, high) = corners
            .iter()
            .fold((Vec3::MAX, Vec3::MIN), |(low, high), corner| {
                (low.min(corner.at), high.max(corner.at))
            });
        Solid {
            corners,
            faces,
            middle: low.midpoint(high),
            radius: low.distance(high) / 2.0,
        }
    }
}

impl Shard {
    /// Normal of the triangle, of length twice its area.
    pub(crate) fn area(&self) -> Vec3 {
        let [a, b, c] = self.at;
        (b - a).cross(c - a)
    }

    fn sides(&self) -> [(PlaceKey, PlaceKey); 3] {
        let [a, b, c] = self.at.map(key);
        [(a, b), (b, c), (c, a)]
    }
}

/// A point on a ring; `turn` runs from 0 to 1, from one side over the front (0.25).
pub(crate) fn point(ring: &LoftRing, turn: f32) -> Vec3 {
    let [along, rise, front, back, side, square] = *ring;
    let (sin, cos) = (turn * TAU).sin_cos();
    let out = (sin.abs().powf(square) + cos.abs().powf(square)).powf(-1.0 / square);
    let reach = if sin > 0.0 { front } else { back };
    Vec3::new(out * cos * side, along, rise + out * sin * reach)
}

/// Quantised coordinates, to compare points.
type PlaceKey = [i32; 3];

/// Points closer than a hundredth of a millimetre are equal.
fn key(at: Vec3) -> PlaceKey {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a hand is smaller than 21 km"
    )]
    let whole = |part: f32| (part * 100.0).round() as i32;
    at.to_array().map(whole)
}
