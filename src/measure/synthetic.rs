//! Spheres with known measures, for tests.

use super::Centres;
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use ndarray::Array2;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

/// Random numbers of a stream with a name.
pub(super) struct Random(Pcg64);

impl Random {
    pub(super) fn new(stream: &str) -> Self {
        Self(Pcg64::from_seed(
            *blake3::hash(stream.as_bytes()).as_bytes(),
        ))
    }

    /// Uniform in 0 <= x < 1.
    pub(super) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normally distributed, of mean 0 and variance 1: Box and Muller, Annals of Mathematical
    /// Statistics 29, 610 (1958).
    pub(super) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(2.0 * PI * self.uniform())
    }

    /// Poisson distributed: how many exponential waiting times fit into the mean.
    pub(super) fn poisson(&mut self, mean: f64) -> f64 {
        let mut wait = || -libm::log(1.0 - self.uniform());
        let (mut count, mut time) = (0.0, wait());
        while time <= mean {
            count += 1.0;
            time += wait();
        }
        count
    }
}

/// Spheres at these places.
pub(super) fn snapshot(time: f64, places: &[[f64; 3]]) -> Snapshot {
    Snapshot {
        time,
        position: Array2::from_shape_fn((places.len(), 3), |(sphere, axis)| places[sphere][axis]),
        ..Snapshot::default()
    }
}

/// Two snapshots, half a second apart, of random spheres in a box with these sides that fall at a
/// speed that depends on the place. They are at that place half way.
pub(super) fn falling(
    random: &mut Random,
    count: usize,
    sides: [[f64; 2]; 3],
    speed: impl Fn([f64; 3], &mut Random) -> f64,
) -> [Snapshot; 2] {
    let interval = 0.5;
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let [x, y, z] = sides.map(|[low, high]| low + random.uniform() * (high - low));
        let half = 0.5 * interval * speed([x, y, z], random);
        before.push([x, y, z + half]);
        after.push([x, y, z - half]);
    }
    [snapshot(7.0, &before), snapshot(7.0 + interval, &after)]
}

/// `side` spheres along each axis, at whole coordinates from 0.
pub(super) fn cubic(side: usize) -> Centres {
    let place = |index: usize| {
        let [x, y, z] = [index / (side * side), index / side % side, index % side];
        Vector::new(x as f64, y as f64, z as f64)
    };
    of((0..side * side * side).map(place).collect())
}

/// The face-centred cubic lattice: corners of cubes of side 1, and the middles of their faces.
pub(super) fn face_centred(side: usize) -> Centres {
    let (none, half) = (0.0, 0.5);
    let basis = [
        [none, none, none],
        [none, half, half],
        [half, none, half],
        [half, half, none],
    ];
    let corners = cubic(side).place.into_iter();
    let places = corners.flat_map(|corner| basis.map(|it| corner + Vector::from(it)));
    of(places.collect())
}

/// Random spheres in a cube from 0, from the stream of this name.
pub(super) fn ideal_gas(count: usize, side: f64, stream: &str) -> Centres {
    let mut random = Random::new(stream);
    let mut coordinate = || random.uniform() * side;
    let places = (0..count).map(|_| Vector::new(coordinate(), coordinate(), coordinate()));
    of(places.collect())
}

pub(super) fn of(place: Vec<Vector>) -> Centres {
    Centres {
        number: (0..place.len()).collect(),
        place,
    }
}
