//! The shape of walls, for pictures and other programs.

use super::{Revolved, Wall, WallSurface};
use crate::particles::vector::Vector;

/// Corners of a circle.
const CORNERS: usize = 72;

/// Lines along the surface of a tube or a cone, from rim to rim.
const STRAIGHTS: usize = 4;

impl Wall {
    /// Its edges and rims as lines from point to point (m). Endless surfaces have none.
    pub fn outline(&self) -> Vec<Vec<Vector>> {
        match &self.surface {
            WallSurface::Parallelogram(plate) => {
                let [a, b, c, d] = plate.corners();
                vec![vec![a, b, c, d, a]]
            }
            WallSurface::Revolved(surface) if surface.ends.iter().all(|end| end.is_finite()) => {
                let rims = surface.ends.map(|end| surface.rim(end));
                let straights = (0..STRAIGHTS).map(|which| {
                    let corner = which * CORNERS / STRAIGHTS;
                    rims.each_ref().map(|rim| rim[corner]).to_vec()
                });
                let is_flat = surface.direction[1] == 0.0;
                let straights: Vec<_> = straights.filter(|_| !is_flat).collect();
                // The centre of a disc and the tip of a cone are no rims.
                let is_wide = |rim: &Vec<Vector>| rim.windows(2).any(|two| two[0] != two[1]);
                let rims = rims.into_iter().filter(is_wide);
                rims.chain(straights).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Its surface as polygons of three or four corners (m), each in its order around. Endless
    /// surfaces have none.
    pub fn polygons(&self) -> Vec<Vec<Vector>> {
        match &self.surface {
            WallSurface::Parallelogram(_) => {
                let outline = self.outline().into_iter();
                outline.map(|line| line[..4].to_vec()).collect()
            }
            WallSurface::Revolved(surface) if surface.ends.iter().all(|end| end.is_finite()) => {
                let [from, to] = surface.ends.map(|end| surface.rim(end));
                let between = |corner: usize| {
                    let mut corners = vec![from[corner], from[corner + 1], to[corner + 1]];
                    corners.push(to[corner]);
                    corners.dedup();
                    corners
                };
                (0..CORNERS).map(between).collect()
            }
            _ => Vec::new(),
        }
    }
}

impl Revolved {
    /// The circle (m) of its line's point at a length (m) along the line, back to its first corner.
    fn rim(&self, length: f64) -> Vec<Vector> {
        let [radius, height] = self.profile_at(length);
        let radius = radius.max(0.0);
        let across = match self.axis.z.abs() > 0.9 {
            true => Vector::new(1.0, 0.0, 0.0),
            false => Vector::new(0.0, 0.0, 1.0),
        };
        let one = across.perpendicular_to(self.axis).unit();
        let other = self.axis.cross(one);
        let corner = |corner: usize| {
            // Back to the first corner to the last bit.
            let share = (corner % CORNERS) as f64 / CORNERS as f64;
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * share);
            self.base + self.axis * height + (one * cosine + other * sine) * radius
        };
        (0..=CORNERS).map(corner).collect()
    }
}
