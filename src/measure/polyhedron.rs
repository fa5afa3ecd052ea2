//! Convex polyhedra about the origin, cut by planes.

use crate::particles::vector::Vector;

/// A face: a plane n . x = offset, and the corners of the face in order around it.
#[derive(Clone, Debug)]
struct Face {
    normal: Vector,
    offset: f64,
    corners: Vec<Vector>,
}

/// A convex polyhedron that holds the origin.
#[derive(Clone, Debug)]
pub(super) struct Polyhedron {
    faces: Vec<Face>,
}

/// Corners nearer to a plane than this share of the polyhedron's size count as on it.
const ON_PLANE: f64 = 1e-12;

impl Polyhedron {
    /// The box between these coordinates along x, y and z, `low` negative and `high` positive.
    pub(super) fn of_box(low: [f64; 3], high: [f64; 3]) -> Self {
        let corner = |bits: [usize; 3]| {
            let side = |axis: usize| [low, high][bits[axis]][axis];
            Vector::new(side(0), side(1), side(2))
        };
        let mut faces = Vec::with_capacity(24);
        for axis in 0..3 {
            for end in 0..2 {
                let around = [[0, 0], [1, 0], [1, 1], [0, 1]];
                let corners = around.map(|[a, b]| {
                    let mut bits = [0; 3];
                    (bits[axis], bits[(axis + 1) % 3], bits[(axis + 2) % 3]) = (end, a, b);
                    corner(bits)
                });
                let mut normal = [0.0; 3];
                normal[axis] = if end == 0 { -1.0 } else { 1.0 };
                faces.push(Face {
                    normal: normal.into(),
                    offset: [-low[axis], high[axis]][end],
                    corners: corners.to_vec(),
                });
            }
        }
        Self { faces }
    }

    /// Square of the distance of the farthest corner from the origin.
    pub(super) fn reach_squared(&self) -> f64 {
        let corners = self.faces.iter().flat_map(|face| &face.corners);
        corners.map(|it| it.norm_squared()).fold(0.0, f64::max)
    }

    /// Volume: pyramids from the origin to the faces.
    pub(super) fn volume(&self) -> f64 {
        let pyramid = |face: &Face| {
            let first = face.corners[0];
            let pairs = face.corners[1..].windows(2);
            let doubled: f64 = pairs
                .map(|two| (two[0] - first).cross(two[1] - first).dot(face.normal))
                .sum();
            face.offset * doubled.abs() / 6.0
        };
        self.faces.iter().map(pyramid).sum()
    }

    /// Number of faces.
    pub(super) fn faces(&self) -> usize {
        self.faces.len()
    }

    /// Keeps the side n . x <= offset of a plane, with a unit vector n and an offset above 0.
    pub(super) fn cut(&mut self, normal: Vector, offset: f64) {
        let near = ON_PLANE * self.reach_squared().sqrt();
        let beyond = |it: &Vector| it.dot(normal) - offset > near;
        if !self.faces.iter().flat_map(|face| &face.corners).any(beyond) {
            return;
        }
        let mut cap = Vec::new();
        for face in &mut self.faces {
            if face.corners.iter().any(beyond) {
                face.cut(normal, offset, near, &mut cap);
            }
        }
        self.faces.retain(|face| face.corners.len() > 2);
        if let Some(corners) = around(cap, normal, near) {
            self.faces.push(Face {
                normal,
                offset,
                corners,
            });
        }
    }
}

impl Face {
    /// Cuts off what is beyond a plane, and adds the corners on the plane to `cap`.
    fn cut(&mut self, normal: Vector, offset: f64, near: f64, cap: &mut Vec<Vector>) {
        let mut kept = Vec::with_capacity(self.corners.len() + 1);
        let height = |it: &Vector| it.dot(normal) - offset;
        for (place, corner) in self.corners.iter().enumerate() {
            let next = &self.corners[(place + 1) % self.corners.len()];
            let (here, there) = (height(corner), height(next));
            if here <= near {
                kept.push(*corner);
                if here >= -near {
                    cap.push(*corner);
                }
            }
            // An edge that starts or ends on the plane crosses it there.
            if (here > near && there < -near) || (here < -near && there > near) {
                let crossing = *corner + (*next - *corner) * (here / (here - there));
                kept.push(crossing);
                cap.push(crossing);
            }
        }
        self.corners = kept;
    }
}

/// The corners of a face in order around its normal, each once; `None` if there are fewer than
/// three.
fn around(corners: Vec<Vector>, normal: Vector, near: f64) -> Option<Vec<Vector>> {
    if corners.len() < 3 {
        return None;
    }
    let middle = corners.iter().fold(Vector::ZERO, |sum, it| sum + *it);
    let middle = middle * (1.0 / corners.len() as f64);
    // Two directions in the plane.
    let across = match normal.x.abs() < 0.6 {
        true => Vector::new(1.0, 0.0, 0.0),
        false => Vector::new(0.0, 1.0, 0.0),
    };
    let one = normal.cross(across);
    let other = normal.cross(one);
    let angle = |it: &Vector| {
        let from = *it - middle;
        libm::atan2(from.dot(other), from.dot(one))
    };
    let mut sorted: Vec<(f64, Vector)> = corners.iter().map(|it| (angle(it), *it)).collect();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut corners: Vec<Vector> = sorted.into_iter().map(|(_, it)| it).collect();
    corners.dedup_by(|one, other| (*one - *other).norm() <= 2.0 * near);
    (corners.len() > 2).then_some(corners)
}
