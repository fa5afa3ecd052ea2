//! Spheres of which measures are known, for tests.

use super::Centres;
use crate::particles::vector::Vector;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// `side` spheres along each axis, at whole coordinates from 0.
pub(super) fn cubic(side: usize) -> Centres {
    let place = |index: usize| {
        let [x, y, z] = [index / (side * side), index / side % side, index % side];
        Vector::new(x as f64, y as f64, z as f64)
    };
    of((0..side * side * side).map(place).collect())
}

/// Spheres at random in a cube from 0, by the stream of that name.
pub(super) fn ideal_gas(count: usize, side: f64, stream: &str) -> Centres {
    let mut random = Pcg64::from_seed(*blake3::hash(stream.as_bytes()).as_bytes());
    let mut coordinate = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64 * side;
    let places = (0..count).map(|_| Vector::new(coordinate(), coordinate(), coordinate()));
    of(places.collect())
}

pub(super) fn of(place: Vec<Vector>) -> Centres {
    Centres {
        number: (0..place.len()).collect(),
        place,
    }
}
