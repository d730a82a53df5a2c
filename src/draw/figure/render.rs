//! Projects solids to the screen: culls back faces, sorts by depth, smooths edges. Yields one plain mesh.

use crate::figure::camera::{Camera, EYE_MM};
use crate::figure::light::{Light, PlacedSolid};
use crate::figure::solid::Face;
use egui::epaint::{Vertex, WHITE_UV};
use egui::{Color32, Mesh, Pos2};
use glam::{Mat3, Vec3};
use handscope_core::hand::kinematics::Segment;

/// Depth range before and behind the centre that is resolved, and steps per millimetre.
const DEPTH_MM: f32 = 300.0;
const DEPTH_STEPS: f32 = 100.0;
/// Vertex number of a corner that no visible face has used yet.
const UNSEEN: u32 = u32::MAX;

/// A visible triangle.
#[derive(Debug, Clone, Copy)]
struct VisibleTriangle {
    corners: [u32; 3],
    segment: Option<Segment>,
    /// Bit n: side n has no visible neighbour in the same shape.
    edges: u8,
}

/// A visible point of the hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPlace {
    pub segment: Segment,
    /// Depth in eye coordinates; larger is nearer.
    pub depth: f32,
}

/// The scene to draw.
#[derive(Debug, Clone, Copy)]
pub struct Model<'a> {
    pub camera: &'a Camera,
    pub light: &'a Light,
    pub parts: &'a [PlacedSolid<'a>],
    /// Width of a soft edge in points.
    pub feather: f32,
}

/// Draws parts into a mesh; reuses its buffers between frames.
#[derive(Debug, Clone, Default)]
pub struct Sketch {
    seen: Vec<VisibleTriangle>,
    /// Depth in the upper half, triangle number in the lower.
    order: Vec<u32>,
    /// Depth of each vertex; larger is nearer.
    depths: Vec<f32>,
    /// For the current part: visibility of its faces, and vertex numbers of its corners.
    fronts: Vec<bool>,
    vertices: Vec<u32>,
}

impl Sketch {
    /// Draws all parts into the mesh, the farthest triangles first.
    pub fn draw(&mut self, model: Model<'_>, mesh: &mut Mesh) {
        mesh.clear();
        self.seen.clear();
        self.order.clear();
        self.depths.clear();
        for part in model.parts {
            self.part(model.camera, model.light, part, mesh);
        }
        self.order.sort_unstable();
        for number in &self.order {
            let Some(face) = self.seen.get((number & 0xFFFF) as usize) else {
                continue;
            };
            let [a, b, c] = face.corners;
            for (side, ends) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
                if face.edges & (1 << side) != 0 {
                    soft_edge(mesh, ends, model.feather);
                }
            }
            mesh.indices.extend([a, b, c]);
        }
    }

    fn part(&mut self, camera: &Camera, light: &Light, part: &PlacedSolid<'_>, mesh: &mut Mesh) {
        let frame = camera.hand * part.frame;
        let eye = frame.inverse().transform_point3(Vec3::Z * EYE_MM);
        let faces = part.solid.faces.iter();
        let fronts = faces.map(|face| face.normal.dot(eye) > face.offset);
        self.fronts.clear();
        self.fronts.extend(fronts);
        self.vertices.clear();
        self.vertices.resize(part.solid.corners.len(), UNSEEN);
        let shade = light.on(part, &frame);
        let Mat3 {
            x_axis,
            y_axis,
            z_axis,
        } = frame.matrix3;
        let turn = Mat3::from_cols(x_axis.normalize(), y_axis.normalize(), z_axis.normalize());
        let near = frame.matrix3.row(2);
        let faces = part.solid.faces.iter().zip(&self.fronts);
        for (face, _) in faces.filter(|(_, front)| **front) {
            let mut depth = 0.0;
            let corners = face.corners.map(|number| {
                let vertex = self.vertices.get_mut(usize::from(number));
                let corner = part.solid.corners.get(usize::from(number));
                let Some((vertex, corner)) = vertex.zip(corner) else {
                    return 0;
                };
                if *vertex == UNSEEN {
                    let (at, normal) = (frame.transform_point3(corner.at), turn * corner.normal);
                    *vertex = u32::try_from(mesh.vertices.len()).unwrap_or(0);
                    mesh.vertices.push(Vertex {
                        pos: camera.project(at),
                        uv: WHITE_UV,
                        color: shade.color(corner.skin, at, normal),
                    });
                    self.depths.push(at.z);
                }
                depth += self.depths.get(*vertex as usize).copied().unwrap_or(0.0);
                *vertex
            });
            let number = u32::try_from(self.seen.len()).unwrap_or(0) & 0xFFFF;
            let depth = depth / 3.0 + face.lift + near.dot(face.aside);
            self.order.push(depth_steps(depth) << 16 | number);
            self.seen.push(VisibleTriangle {
                corners,
                segment: part.segment,
                edges: self.edges(face),
            });
        }
    }

    fn edges(&self, face: &Face) -> u8 {
        let goes_on = |beyond: u16| self.fronts.get(usize::from(beyond)) == Some(&true);
        let sides = face.beyond.into_iter().enumerate();
        sides
            .map(|(side, beyond)| u8::from(!goes_on(beyond)) << side)
            .sum()
    }

    /// Returns the part of the hand that is visible at a position of the last mesh.
    pub fn segment_at(&self, mesh: &Mesh, place: Pos2) -> Option<SeenPlace> {
        let corner = |at: u32| {
            let vertex = mesh.vertices.get(at as usize);
            vertex.map_or(Pos2::ZERO, |vertex| vertex.pos)
        };
        let depth = |at: u32| self.depths.get(at as usize).copied().unwrap_or(0.0);
        let found = |seen: &VisibleTriangle| {
            let [a, b, c] = seen.corners.map(corner);
            let side = |from: Pos2, to: Pos2| (to - from).rot90().dot(place - from);
            // Each is proportional to the weight of the opposite corner.
            let sides = [side(b, c), side(c, a), side(a, b)];
            let is_in =
                sides.iter().all(|side| *side <= 0.0) || sides.iter().all(|side| *side >= 0.0);
            let whole: f32 = sides.iter().sum();
            let depths = seen.corners.map(depth).into_iter().zip(sides);
            let depth = depths.map(|(depth, part)| depth * part).sum::<f32>() / whole;
            let segment = seen.segment?;
            (is_in && whole != 0.0).then_some(SeenPlace { segment, depth })
        };
        let nearest_first = self.order.iter().rev();
        let seen = nearest_first.filter_map(|number| self.seen.get((number & 0xFFFF) as usize));
        seen.filter(|seen| seen.segment.is_some()).find_map(found)
    }
}

/// Depth as a 16-bit number; the nearest is the largest.
fn depth_steps(near_mm: f32) -> u32 {
    let steps = ((near_mm + DEPTH_MM) * DEPTH_STEPS).clamp(0.0, f32::from(u16::MAX));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 16 bits"
    )]
    let steps = steps as u32;
    steps
}

/// Adds a fading seam along the side between the first two corners, away from the third: a mesh has no other antialiasing.
fn soft_edge(mesh: &mut Mesh, corners: [u32; 3], feather: f32) {
    let [from, to, _] = corners;
    let found = corners.map(|at| mesh.vertices.get(at as usize).copied());
    let [Some(one), Some(two), Some(three)] = found else {
        return;
    };
    let out = (two.pos - one.pos).rot90();
    let out = out * (feather / out.length_sq().sqrt().max(f32::MIN_POSITIVE));
    let out = if out.dot(three.pos - one.pos) > 0.0 {
        -out
    } else {
        out
    };
    let faded = |vertex: Vertex| Vertex {
        pos: vertex.pos + out,
        color: Color32::TRANSPARENT,
        ..vertex
    };
    let first = u32::try_from(mesh.vertices.len()).unwrap_or(0);
    mesh.vertices.extend([faded(one), faded(two)]);
    mesh.indices.extend([from, first, to, to, first, first + 1]);
}
