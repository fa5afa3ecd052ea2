//! All pairs of a few spheres, many of them tested at once. Below a few thousand spheres this is
//! faster than cells, and it finds the partners of a sphere in order.

use super::{Reach, WORD};
use crate::particles::Particles;
use crate::particles::domain::{Domain, OpenSpace, Space};
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

/// Up to this number of spheres all pairs are tested.
pub(super) const FEW: usize = 1024;

/// Spheres tested at once.
const LANES: usize = 8;

/// Centres and radii of a few spheres (m), one array per quantity.
#[derive(Clone, Debug, Default)]
pub(super) struct FewSpheres {
    domain: Domain,
    coordinates: [Vec<f64>; 3],
    radius: Vec<f64>,
}

impl FewSpheres {
    /// Copies the spheres, turned about the z axis by an angle of this sine and cosine.
    pub(super) fn fill(&mut self, particles: &Particles, (sine, cosine): (f64, f64)) {
        self.domain = particles.domain;
        // The arrays are padded with NaN, which no sphere is near.
        let padded = particles.len().next_multiple_of(WORD);
        let positions = || particles.position.iter();
        let [x, y, z] = &mut self.coordinates;
        for column in [&mut *x, &mut *y, &mut *z, &mut self.radius] {
            column.clear();
        }
        x.extend(positions().map(|centre| cosine * centre.x - sine * centre.y));
        y.extend(positions().map(|centre| sine * centre.x + cosine * centre.y));
        z.extend(positions().map(|centre| centre.z));
        self.radius.extend(&particles.radius);
        for column in [x, y, z, &mut self.radius] {
            column.resize(padded, f64::NAN);
        }
    }

    /// Adds the partners of sphere `i` from `first` on to a list, in order.
    pub(super) fn find(
        &self,
        level: Level,
        (i, first): (usize, usize),
        (reach, skin): (Reach, f64),
        found: &mut Vec<u32>,
    ) {
        fearless_simd::dispatch!(level, simd => match self.domain.is_open() {
            true => self.find_in::<OpenSpace, _>(simd, (i, first), (reach, skin), found),
            false => self.find_in::<Domain, _>(simd, (i, first), (reach, skin), found),
        });
    }

    #[inline(always)]
    fn find_in<D: Space, S: Simd>(
        &self,
        simd: S,
        (i, first): (usize, usize),
        (reach, skin): (Reach, f64),
        found: &mut Vec<u32>,
    ) {
        for word in first / WORD..self.radius.len() / WORD {
            let mut near = self.word::<D, S>(simd, i, word * WORD, reach, skin);
            if word * WORD < first {
                near &= u64::MAX << (first - word * WORD);
            }
            while near != 0 {
                found.push((word * WORD) as u32 + near.trailing_zeros());
                near &= near - 1;
            }
        }
    }

    /// Which of the spheres from `at` on are near sphere `i`.
    #[inline(always)]
    fn word<D: Space, S: Simd>(
        &self,
        simd: S,
        i: usize,
        at: usize,
        reach: Reach,
        skin: f64,
    ) -> u64 {
        let [x, y, z] = &self.coordinates;
        let all = at..at + WORD;
        let columns = x[all.clone()]
            .chunks_exact(LANES)
            .zip(y[all.clone()].chunks_exact(LANES))
            .zip(z[all.clone()].chunks_exact(LANES))
            .zip(self.radius[all].chunks_exact(LANES));
        let own = self.radius[i];
        let mut bits = 0;
        for (lane, (((x_of, y_of), z_of), radius)) in columns.enumerate() {
            let eight = |column: &[f64]| f64x8::from_slice(simd, column);
            let (dx, dy) = (eight(x_of) - x[i], eight(y_of) - y[i]);
            let radius = eight(radius);
            let near = match reach {
                Reach::Contact => {
                    let offset = [dx, dy, eight(z_of) - z[i]];
                    let [dx, dy, dz] = D::of(self.domain).nearest_of_eight(simd, offset);
                    let distance = radius + (own + skin);
                    (dx * dx + dy * dy + dz * dz).simd_lt(distance * distance)
                }
                Reach::Column => {
                    let distance = radius.max(f64x8::splat(simd, own)) * 2.0 + skin;
                    dx.abs().simd_lt(distance) & dy.abs().simd_lt(distance)
                }
            };
            bits |= near.to_bitmask() << (lane * LANES);
        }
        bits
    }
}
