//! A plate without thickness between four edges.

use super::{ContactSurface, WallContact};
use crate::particles::vector::Vector;

/// A parallelogram, which spheres touch from both sides and at its edges.
///
/// The contact is with the nearest point: the foot of the perpendicular if this lies inside, else
/// the nearest point of the four edges. The contact laws treat an edge as flat, like all walls.
#[derive(Clone, Copy, Debug)]
pub struct Parallelogram {
    /// One of its corners (m).
    pub corner: Vector,
    /// The two edges from there (m).
    pub edges: [Vector; 2],
    /// Vectors whose scalar products with an offset from the corner are its coordinates along the
    /// edges, in edges (1/m).
    dual: [Vector; 2],
    /// 1 / the squared lengths of the edges (1/m2).
    inverse_squares: [f64; 2],
}

impl Parallelogram {
    /// The parallelogram between two edges from a corner (m), which are not parallel.
    pub fn new(corner: Vector, edges: [Vector; 2]) -> Self {
        let [a, b] = edges;
        let (aa, ab, bb) = (a.norm_squared(), a.dot(b), b.norm_squared());
        let inverse = 1.0 / (aa * bb - ab * ab);
        Self {
            corner,
            edges,
            dual: [(a * bb - b * ab) * inverse, (b * aa - a * ab) * inverse],
            inverse_squares: [1.0 / aa, 1.0 / bb],
        }
    }

    /// Its four corners (m), in their order around.
    pub fn corners(&self) -> [Vector; 4] {
        let ([a, b], corner) = (self.edges, self.corner);
        [corner, corner + a, corner + a + b, corner + b]
    }

    /// Unit normal, on the side from which the way from the first edge to the second is
    /// counter-clockwise.
    pub fn normal(&self) -> Vector {
        let [a, b] = self.edges;
        a.cross(b).unit()
    }

    /// Its four edges: where each begins, and from there to its end.
    pub(super) fn edges_from(&self) -> [(Vector, Vector); 4] {
        let ([a, b], corner) = (self.edges, self.corner);
        [(corner, a), (corner + b, a), (corner, b), (corner + a, b)]
    }

    /// The part of a line in its plane that lies on it or within `tolerance` (m) of it: where it
    /// begins and ends along the unit vector `along` from a point.
    pub(super) fn part_of_line(
        &self,
        from: Vector,
        along: Vector,
        tolerance: f64,
    ) -> Option<[f64; 2]> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for dual in self.dual {
            let (start, rate) = ((from - self.corner).dot(dual), along.dot(dual));
            // How many edges the tolerance is.
            let margin = tolerance * dual.norm();
            if rate.abs() < 1e-9 * dual.norm() {
                if start < -margin || start > 1.0 + margin {
                    return None;
                }
                continue;
            }
            let ends = [(-margin - start) / rate, (1.0 + margin - start) / rate];
            low = low.max(ends[0].min(ends[1]));
            high = high.min(ends[0].max(ends[1]));
        }
        (low <= high).then_some([low, high])
    }

    /// The offset (m) of a place from the nearest point.
    #[inline(always)]
    fn offset(&self, place: Vector) -> Vector {
        let ([a, b], from_corner) = (self.edges, place - self.corner);
        let [along_a, along_b] = self.dual.map(|dual| from_corner.dot(dual));
        let within_edge = 0.0..=1.0;
        let inside = within_edge.contains(&along_a) & within_edge.contains(&along_b);
        let mut least = from_corner - a * along_a - b * along_b;
        let mut squared = if inside {
            least.norm_squared()
        } else {
            f64::INFINITY
        };
        let [of_a, of_b] = self.inverse_squares;
        for (from_edge, edge, inverse_square) in [
            (from_corner, a, of_a),
            (from_corner - b, a, of_a),
            (from_corner, b, of_b),
            (from_corner - a, b, of_b),
        ] {
            let along = within(from_edge.dot(edge) * inverse_square, 0.0, 1.0);
            let offset = from_edge - edge * along;
            let is_nearer = offset.norm_squared() < squared;
            squared = select(is_nearer, offset.norm_squared(), squared);
            least = Vector::new(
                select(is_nearer, offset.x, least.x),
                select(is_nearer, offset.y, least.y),
                select(is_nearer, offset.z, least.z),
            );
        }
        least
    }
}

#[inline(always)]
fn select(first: bool, one: f64, other: f64) -> f64 {
    if first { one } else { other }
}

/// The value, or the bound that it passes. Selects, which loops over contacts turn into vector
/// instructions.
#[inline(always)]
pub(super) fn within(value: f64, least: f64, most: f64) -> f64 {
    let value = if value < least { least } else { value };
    if value > most { most } else { value }
}

impl ContactSurface for Parallelogram {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        WallContact::with_point(self.offset(centre), radius)
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        let reach = radius + margin;
        !(self.offset(centre).norm_squared() >= reach * reach)
    }
}
