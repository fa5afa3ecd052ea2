//! The order of many spheres in memory: near in space, near in memory.
//!
//! A pair reads its partners from memory. If spheres are in the random order of their scene,
//! partners may be anywhere in memory. A bed of 55,000 spheres then takes three times as long per
//! sphere as a bed of 256, which fits into the caches. So spheres of large scenes are sorted by
//! cells as wide as the largest sphere, and sorted again when they have mixed.
//!
//! Forces are summed in the order of indices. So this order must follow from the motion alone: it
//! is checked after fixed numbers of steps, and is part of a checkpoint.

use crate::particles::Particles;
use crate::particles::vector::Vector;

/// From this number on, spheres are sorted. Fewer spheres fit into the caches of a processor, and
/// keep the order of the scene.
pub const MANY: usize = 4096;

/// Steps between two checks of the order.
pub(super) const INTERVAL: u64 = 250;

/// Spheres are sorted again when one in this number lies in a cell before its predecessor's cell.
const TOLERATED: usize = 64;

/// Rows of cells in a strip. A strip is traversed layer by layer before the next strip. One layer
/// of it is still in the cache when the layer above is computed.
const ROWS: u64 = 16;

/// Cells along an axis; spheres beyond share the last one.
const MOST: u64 = (1 << 20) - 1;

/// The indices of all spheres in a new order, or `None` while the present order is good enough.
/// Fixed spheres keep their places. Spheres of one cell are sorted by their coordinates, so that
/// the order does not depend on their numbers in the scene.
pub(super) fn found_anew(particles: &Particles) -> Option<Vec<u32>> {
    let moving = particles.fixed..particles.len();
    let position = &particles.position;
    let width = 2.0 * particles.largest_radius();
    let place = |i: usize| particles.domain.wrapped(position[i]);
    let low = moving.clone().map(place).fold(
        Vector::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        |low, at| Vector::new(low.x.min(at.x), low.y.min(at.y), low.z.min(at.z)),
    );
    let cell = |offset: f64| ((offset / width) as u64).min(MOST);
    let key = |i: usize| {
        let offset = place(i) - low;
        let (column, row, layer) = (cell(offset.x), cell(offset.y), cell(offset.z));
        ((row / ROWS) << 44) | (layer << 24) | ((row % ROWS) << 20) | column
    };
    let mut keys: Vec<(u64, u32)> = moving.map(|i| (key(i), i as u32)).collect();
    let disorder = keys.windows(2).filter(|two| two[1].0 < two[0].0).count();
    if disorder * TOLERATED <= keys.len() {
        return None;
    }
    keys.sort_unstable_by(|(one, i), (other, j)| {
        let (a, b) = (position[*i as usize], position[*j as usize]);
        one.cmp(other)
            .then_with(|| a.x.total_cmp(&b.x))
            .then_with(|| a.y.total_cmp(&b.y))
            .then_with(|| a.z.total_cmp(&b.z))
            .then_with(|| i.cmp(j))
    });
    let fixed = 0..particles.fixed as u32;
    Some(fixed.chain(keys.into_iter().map(|(_, i)| i)).collect())
}

/// The order that turns the numbering `from` into `to`. Fixed spheres keep their places.
pub(super) fn between(from: &[u32], to: &[u32], fixed: usize) -> Vec<u32> {
    let moving = |numbers: &[u32]| -> Vec<u32> {
        let numbers = numbers[fixed..].iter();
        numbers.map(|number| number + fixed as u32).collect()
    };
    let all = |numbers: &[u32]| -> Vec<u32> { (0..fixed as u32).chain(moving(numbers)).collect() };
    let mut order = all(to);
    let places = places(&all(from));
    for number in &mut order {
        *number = places[*number as usize];
    }
    order
}

/// Whether the numbers of the moving spheres are a permutation of 0, 1, 2, ...
pub(super) fn is_one(numbers: &[u32], fixed: usize) -> bool {
    let numbers = numbers.get(fixed..).unwrap_or_default();
    let mut known = vec![false; numbers.len()];
    let mut is_new = |&number: &u32| {
        let known = known.get_mut(number as usize);
        known.is_some_and(|known| !std::mem::replace(known, true))
    };
    numbers.iter().all(&mut is_new)
}

/// Whether no two of the moving spheres have the same number.
pub(super) fn are_distinct(numbers: &[u32], fixed: usize) -> bool {
    let mut numbers = numbers.get(fixed..).unwrap_or_default().to_vec();
    numbers.sort_unstable();
    numbers.windows(2).all(|two| two[0] < two[1])
}

/// The place that each index has in an order.
pub(super) fn places(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    for (place, &i) in order.iter().enumerate() {
        places[i as usize] = place as u32;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::reorder::reorder;

    /// Spheres at random places, in random order.
    fn spheres(count: usize) -> Particles {
        let place = |i: usize, by: usize| (i * by % count) as f64 / count as f64;
        Particles {
            position: (0..count)
                .map(|i| Vector::new(place(i, 31), place(i, 57), place(i, 71)))
                .collect(),
            radius: vec![0.03; count],
            ..Particles::default()
        }
    }

    #[test]
    fn spheres_are_sorted_once_and_their_numbers_do_not_matter() {
        let mut one = spheres(997);
        let mut other = spheres(997);
        other.position.reverse();
        for particles in [&mut one, &mut other] {
            let order = found_anew(particles).expect("they are in disorder");
            reorder(&mut particles.position, &order);
            assert!(found_anew(particles).is_none());
        }
        assert_eq!(one.position, other.position);
    }

    #[test]
    fn fixed_spheres_keep_their_places() {
        let mut particles = spheres(997);
        particles.fixed = 10;
        let order = found_anew(&particles).expect("they are in disorder");
        assert!(order[..10].iter().copied().eq(0..10));
        let mut back = places(&order);
        reorder(&mut back, &order);
        assert!(back.iter().copied().eq(0..997));
    }
}
